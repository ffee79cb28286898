/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints and drivers. */
#ifndef SE3D_JOINT_H
#define SE3D_JOINT_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a joint between two bodies is made with: a point and an axis on each. @since 0.1 */
typedef struct se3d_joint_def {
    size_t struct_size;
    const char *name;  /* copied; NULL or unique among constraints */
    se3d_body body_i;  /* the reference */
    se3d_body body_j;  /* moves relative to body i */
    double point_i[3]; /* joint point, body frames [m] */
    double point_j[3];
    double axis_i[3]; /* joint axis, body frames; default (0,0,1); length is ignored, not zero */
    double axis_j[3];
    double ref_i[3]; /* the angle is from ref_i to ref_j about the axis; zero: a direction is
                        chosen. With */
    double ref_j[3]; /* ref_j zero, the angle at the present pose is angle0 */
    double angle0;   /* joint angle where ref_i and ref_j coincide (ref_j given) or at the present
                        pose */
    double pitch;    /* screw: advance per turn [m] */
    double distance; /* distance, revolute_spherical, revolute_cylindrical [m] */
} se3d_joint_def;

SE3D_API void se3d_joint_def_init(se3d_joint_def *def, size_t size);

static inline se3d_joint_def se3d_joint_def_default(void)
{
    se3d_joint_def def;
    se3d_joint_def_init(&def, sizeof def);
    return def;
}

/* Set points and axes of `def` from a point `at` [m] and a direction `axis`, ground frame, at the
 * present poses of its bodies; `ref` (NULL: chosen) is the zero direction of the angle. The joint
 * angle at the present pose is def->angle0. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT.
 * Reader. @since 0.1 */
SE3D_API se3d_status se3d_joint_def_set_frame(const se3d_system *system, se3d_joint_def *def,
                                              const double at[3], const double axis[3],
                                              const double *ref);

/* Create a joint. The equations and freedoms of each are in docs/theory/joints.md.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_fixed(se3d_system *system, const se3d_joint_def *def,
                                             se3d_constraint *joint);
SE3D_API se3d_status se3d_joint_create_revolute(se3d_system *system, const se3d_joint_def *def,
                                                se3d_constraint *joint);
SE3D_API se3d_status se3d_joint_create_prismatic(se3d_system *system, const se3d_joint_def *def,
                                                 se3d_constraint *joint);
SE3D_API se3d_status se3d_joint_create_cylindrical(se3d_system *system, const se3d_joint_def *def,
                                                   se3d_constraint *joint);
SE3D_API se3d_status se3d_joint_create_spherical(se3d_system *system, const se3d_joint_def *def,
                                                 se3d_constraint *joint);
/* axis_i and axis_j are the two axes of the cross, square to each other. */
SE3D_API se3d_status se3d_joint_create_universal(se3d_system *system, const se3d_joint_def *def,
                                                 se3d_constraint *joint);
/* The axis is the normal of the plane. */
SE3D_API se3d_status se3d_joint_create_planar(se3d_system *system, const se3d_joint_def *def,
                                              se3d_constraint *joint);
/* displacement = pitch * angle / (2 pi), counted from the present pose. */
SE3D_API se3d_status se3d_joint_create_screw(se3d_system *system, const se3d_joint_def *def,
                                             se3d_constraint *joint);
/* point_j stays on the line through point_i along axis_i. */
SE3D_API se3d_status se3d_joint_create_point_on_line(se3d_system *system, const se3d_joint_def *def,
                                                     se3d_constraint *joint);
/* point_j stays in the plane through point_i square to axis_i. */
SE3D_API se3d_status se3d_joint_create_point_on_plane(se3d_system *system,
                                                      const se3d_joint_def *def,
                                                      se3d_constraint *joint);
/* point_i and point_j keep `distance`: a massless link. */
SE3D_API se3d_status se3d_joint_create_distance(se3d_system *system, const se3d_joint_def *def,
                                                se3d_constraint *joint);
/* point_j keeps `distance` from point_i and stays in the plane square to axis_i through point_i: a
 * massless link with a revolute on body i and a ball on body j. */
SE3D_API se3d_status se3d_joint_create_revolute_spherical(se3d_system *system,
                                                          const se3d_joint_def *def,
                                                          se3d_constraint *joint);
/* axis_i and axis_j are square to each other at `distance`: a massless link with a revolute about
 * axis_i and a cylindrical joint along axis_j. */
SE3D_API se3d_status se3d_joint_create_revolute_cylindrical(se3d_system *system,
                                                            const se3d_joint_def *def,
                                                            se3d_constraint *joint);
/* axis_i and axis_j stay parallel (2 equations) / square to each other (1 equation). */
SE3D_API se3d_status se3d_joint_create_parallel(se3d_system *system, const se3d_joint_def *def,
                                                se3d_constraint *joint);
SE3D_API se3d_status se3d_joint_create_perpendicular(se3d_system *system, const se3d_joint_def *def,
                                                     se3d_constraint *joint);
/* No relative rotation (3 equations). */
SE3D_API se3d_status se3d_joint_create_orientation(se3d_system *system, const se3d_joint_def *def,
                                                   se3d_constraint *joint);
/* The intermediate constraints of ME751: the vector axis_j is square to the plane with normal
 * axis_i (2 DP1) / d_ij is square to that plane (2 DP2). */
SE3D_API se3d_status se3d_joint_create_perpendicular1(se3d_system *system,
                                                      const se3d_joint_def *def,
                                                      se3d_constraint *joint);
SE3D_API se3d_status se3d_joint_create_perpendicular2(se3d_system *system,
                                                      const se3d_joint_def *def,
                                                      se3d_constraint *joint);

/* Coordinates of a joint: of j relative to i, about or along its axis. */
typedef enum se3d_joint_coordinate {
    SE3D_JOINT_COORDINATE_ANGLE = 0,       /* [rad], counts turns */
    SE3D_JOINT_COORDINATE_DISPLACEMENT = 1 /* [m] */
} se3d_joint_coordinate;

/* Get a joint coordinate with its rate and acceleration. @return OK, STALE_HANDLE, INVALID_ARGUMENT
 * (the joint has no such coordinate). Reader. @since 0.1 */
SE3D_API se3d_status se3d_joint_get_coordinate(const se3d_system *system, se3d_constraint joint,
                                               se3d_joint_coordinate coordinate, double *value,
                                               double *rate, double *acceleration);

#define SE3D_COUPLER_TERMS_MAX 4

/* A linear relation of joint coordinates: sum_k ratio[k] coordinate[k] = value (or f(t)). What it
 * does to bodies: se3d_driver_get_effort, and the reactions of se3d_constraint_get_reaction on body
 * j of the first joint, at its point there. @since 0.1 */
typedef struct se3d_coupler_def {
    size_t struct_size;
    const char *name;
    se3d_constraint joint[SE3D_COUPLER_TERMS_MAX];
    int32_t coordinate[SE3D_COUPLER_TERMS_MAX]; /* se3d_joint_coordinate */
    double ratio[SE3D_COUPLER_TERMS_MAX];
    size_t count;           /* 1 .. SE3D_COUPLER_TERMS_MAX */
    double value;           /* where `function` is null */
    se3d_function function; /* f(t), or null */
} se3d_coupler_def;

SE3D_API void se3d_coupler_def_init(se3d_coupler_def *def, size_t size);

static inline se3d_coupler_def se3d_coupler_def_default(void)
{
    se3d_coupler_def def;
    se3d_coupler_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_joint_create_coupler(se3d_system *system, const se3d_coupler_def *def,
                                               se3d_constraint *joint);
/* Gear: ratio * angle of joint_1 + angle of joint_2 = constant, fixed at the present pose (ratio >
 * 0: they turn in opposite senses). Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_gear(se3d_system *system, const char *name,
                                            se3d_constraint joint_1, se3d_constraint joint_2,
                                            double ratio, se3d_constraint *joint);
/* Rack and pinion: displacement of `rack` = radius * angle of `pinion` + constant, fixed at the
 * present pose. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_rack_pinion(se3d_system *system, const char *name,
                                                   se3d_constraint pinion, se3d_constraint rack,
                                                   double radius, se3d_constraint *joint);

/* What a driver is made with: coordinate of `joint` = f(t). @since 0.1 */
typedef struct se3d_driver_def {
    size_t struct_size;
    const char *name;
    se3d_constraint joint;
    int32_t coordinate; /* se3d_joint_coordinate */
    int32_t reserved;
    double value;           /* f where `function` is null */
    se3d_function function; /* f(t), or null */
} se3d_driver_def;

SE3D_API void se3d_driver_def_init(se3d_driver_def *def, size_t size);

static inline se3d_driver_def se3d_driver_def_default(void)
{
    se3d_driver_def def;
    se3d_driver_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_driver_create(se3d_system *system, const se3d_driver_def *def,
                                        se3d_constraint *driver);
/* Get f at the present time, and the effort: the torque about the joint axis [N m] or the force
 * along it [N] with which the driver acts on body j. Also for any constraint of one equation (value
 * - f = 0): the generalised force -lambda. A coupler, gear or rack acts with ratio[k] times its
 * effort on coordinate k: on body j of that joint about or along its axis, on its body i with the
 * opposite. Reader. @since 0.1 */
SE3D_API se3d_status se3d_driver_get_value(const se3d_system *system, se3d_constraint driver,
                                           double *value);
SE3D_API se3d_status se3d_driver_get_effort(const se3d_system *system, se3d_constraint driver,
                                            double *effort);

#ifdef __cplusplus
}
#endif
#endif
