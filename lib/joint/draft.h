/* SPDX-License-Identifier: BSD-3-Clause */
/* Constraints under construction. What comes in has been validated; what is drafted here goes to
 * se3di_model_add_constraint.
 *
 *     definition -> frames (checked) -> rows of terms -> model */
#ifndef SE3DI_JOINT_DRAFT_H
#define SE3DI_JOINT_DRAFT_H

#include "joint/joint.h"

/* The frames of a joint whose points and axes (of unit length) are set; reference directions are
 * NULL if they are chosen: ref_j such that the joint angle is `angle` in the present poses.
 * Returns 0, or 1 or 2 if ref_i or ref_j is parallel to its axis. */
int se3di_joint_frames_complete(const se3di_model *model, const uint32_t bodies[2], double angle,
                                const double *ref_i, const double *ref_j,
                                se3di_joint_frames *frames);
/* The distance of the joint points in the present poses; 0 if they coincide. */
double se3di_joint_present_distance(const se3di_model *model, const uint32_t bodies[2],
                                    const se3di_joint_frames *frames);
/* The rows of a joint: `draft` was made by se3di_draft_init, its frames are complete. */
void se3di_joint_draft(const se3di_model *model, const se3di_joint_type *type,
                       const se3d_joint_def *def, se3di_draft *draft);
/* Points, axes and references of a definition from a point, a direction of unit length and a
 * reference (NULL: chosen) in the ground frame. Returns 0 if they are parallel. */
int se3di_joint_def_place(const se3di_frame *i, const se3di_frame *j, const double at[3],
                          const double axis[3], const double *ref, se3d_joint_def *def);

/* One row, whose value or function of time (-1: none) is the user's: */
typedef struct se3di_prescribed {
    double value;
    int32_t function;
} se3di_prescribed;

/* a primitive, */
void se3di_primitive_draft(const char *name, const se3di_term *term, se3di_prescribed prescribed,
                           se3di_draft *draft);
/* the coordinate of a joint, */
void se3di_driver_draft(const se3di_model *model, uint32_t joint, int32_t coordinate,
                        const char *name, se3di_prescribed prescribed, se3di_draft *draft);
/* or a sum of joint coordinates, of which terms are added one by one. */
void se3di_coupler_draft(const char *type, const char *name, se3di_draft *draft);
void se3di_coupler_add_term(const se3di_model *model, uint32_t joint, const se3di_term *term,
                            double ratio, se3di_draft *draft);

/* The equations of a callback on `bodies`. */
void se3di_user_draft(const se3d_user_constraint_def *def, const uint32_t *bodies,
                      se3di_draft *draft);

/* The value of the last row with which it holds in the present poses. */
void se3di_draft_close(const se3di_model *model, se3di_draft *draft);

#endif
