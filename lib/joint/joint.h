/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints: each is a list of primitives over the joint frames of two bodies; no algebra of its own.
 *
 * A joint has a point, an axis and a reference direction on each body; (ref, third, axis) is a
 * right-handed orthonormal triad in the body frame. Directions below are in the ground frame, P_i
 * and P_j are the joint points, d = P_j - P_i.  docs/theory/joints.md
 *
 * To add a joint: a row in SE3DI_JOINT_LIST, a file <name>.c with se3di_<name>_build, and its
 * declaration with SE3D_API in se3d/joint.h. */
#ifndef SE3DI_JOINT_H
#define SE3DI_JOINT_H

#include "model/model.h"

/* What a joint type has or needs. */
#define SE3DI_JOINT_ANGLE        1  /* coordinate: angle of ref_j from ref_i about axis_i */
#define SE3DI_JOINT_DISPLACEMENT 2  /* coordinate: axis_i . d */
#define SE3DI_JOINT_DISTANCE     4  /* def.distance > 0, or 0 for the one at the present pose */
#define SE3DI_JOINT_PITCH        8  /* def.pitch != 0; its last row holds at the present pose */
#define SE3DI_JOINT_OFFSET       16 /* def.distance >= 0 is that of the axes (last row) */

#define SE3DI_JOINT_LIST(X)                                                                        \
    X(fixed, 0)                                                                                    \
    X(revolute, SE3DI_JOINT_ANGLE)                                                                 \
    X(prismatic, SE3DI_JOINT_DISPLACEMENT)                                                         \
    X(cylindrical, SE3DI_JOINT_ANGLE | SE3DI_JOINT_DISPLACEMENT)                                   \
    X(spherical, 0)                                                                                \
    X(universal, 0)                                                                                \
    X(planar, SE3DI_JOINT_ANGLE)                                                                   \
    X(screw, SE3DI_JOINT_ANGLE | SE3DI_JOINT_DISPLACEMENT | SE3DI_JOINT_PITCH)                     \
    X(point_on_line, SE3DI_JOINT_DISPLACEMENT)                                                     \
    X(point_on_plane, 0)                                                                           \
    X(distance, SE3DI_JOINT_DISTANCE)                                                              \
    X(revolute_spherical, SE3DI_JOINT_DISTANCE)                                                    \
    X(revolute_cylindrical, SE3DI_JOINT_OFFSET)                                                    \
    X(parallel, SE3DI_JOINT_ANGLE)                                                                 \
    X(perpendicular, 0)                                                                            \
    X(orientation, 0)                                                                              \
    X(perpendicular1, SE3DI_JOINT_ANGLE)                                                           \
    X(perpendicular2, SE3DI_JOINT_DISPLACEMENT)

#define SE3DI_JOINT_ENUMERATOR(name, flags) SE3DI_JOINT_TYPE_##name,
typedef enum se3di_joint_type_id {
    SE3DI_JOINT_LIST(SE3DI_JOINT_ENUMERATOR) SE3DI_JOINT_TYPE_COUNT
} se3di_joint_type_id;
#undef SE3DI_JOINT_ENUMERATOR

/* Add the rows of a joint to a draft made by se3di_draft_init; `def` has been validated and its
 * distance resolved. */
typedef void (*se3di_joint_build)(const se3di_joint_frames *frames, const se3d_joint_def *def,
                                  se3di_draft *draft);

typedef struct se3di_joint_type {
    const char *name; /* as in the model file */
    se3di_joint_build build;
    uint32_t flags;
} se3di_joint_type;

/* Indexed by se3di_joint_type_id. */
extern const se3di_joint_type se3di_joint_types[SE3DI_JOINT_TYPE_COUNT];

#define SE3DI_JOINT_DECLARE(name, flags)                                                           \
    void se3di_##name##_build(const se3di_joint_frames *frames, const se3d_joint_def *def,         \
                              se3di_draft *draft);
SE3DI_JOINT_LIST(SE3DI_JOINT_DECLARE)
#undef SE3DI_JOINT_DECLARE

/* Complete a triad: `ref_out` is `ref` (NULL: chosen) made perpendicular to the unit vector `axis`
 * and of unit length, third = axis x ref. Returns 0 if ref is parallel to the axis. */
int se3di_joint_triad_build(const double axis[3], const double *ref, double ref_out[3],
                            double third[3]);

/* The same of a direction that the user gives: one that is of unit length and perpendicular to
 * rounding stays as it is, so that a triad that is given again is the same to the bit. */
int se3di_joint_triad_take(const double axis[3], const double *ref, double ref_out[3],
                           double third[3]);

/* The direction on body j, perpendicular to axis_j, at which the angle from ref_i about axis_i is
 * `angle` in the given poses. Uses axis_i, ref_i, third_i and axis_j of `frames`. */
void se3di_joint_ref_match(const se3di_joint_frames *frames, double angle, const se3di_frame *i,
                           const se3di_frame *j, double ref_j[3]);

/* The turn counter of a joint: angle = `offset` when ref_i and ref_j coincide; its start is the
 * value in the given poses nearest to `near`. */
void se3di_joint_angle_init(const se3di_joint_frames *frames, const uint32_t bodies[2],
                            double offset, se3di_angle *angle);
double se3di_joint_angle_start(const se3di_angle *angle, const se3di_frame *i, const se3di_frame *j,
                               double near);

#endif
