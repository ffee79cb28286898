/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints and drivers.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_JOINT_H
#define SE3D_JOINT_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The definition of a joint between two bodies: a point and an axis on each. @since 0.1 */
typedef struct se3d_joint_def {
    size_t struct_size;
    const char *name;   /* copied; NULL or unique among constraints */
    se3d_body body_i;   /* the reference */
    se3d_body body_j;   /* moves relative to body i */
    double point_i[3];  /* joint point, frame of body i [m] */
    double point_j[3];  /* joint point, frame of body j [m] */
    double axis_i[3];   /* direction of the axis, frame of body i; not zero, default (0,0,1) */
    double axis_j[3];   /* direction of the axis, frame of body j; not zero, default (0,0,1) */
    double ref_i[3];    /* direction from which the angle counts, frame of body i; zero: chosen */
    double ref_j[3];    /* direction to which it counts, frame of body j; zero: so that the angle at
                          the present pose is angle0 */
    double angle0;      /* angle when ref_i and ref_j coincide or, without ref_j, at the present
                          pose [rad] */
    double pitch;       /* screw: advance per turn [m] */
    double distance;    /* distance, revolute_spherical, revolute_cylindrical [m] */
    double break_force; /* see se3d_joint_set_break [N]; 0: no limit */
    double break_moment; /* the same [N m] */
} se3d_joint_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_joint_def_default. @since 0.1 */
SE3D_API void se3d_joint_def_init(se3d_joint_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_joint_def se3d_joint_def_default(void)
{
    se3d_joint_def def;
    se3d_joint_def_init(&def, sizeof def);
    return def;
}

/* Set the points and axes of `def` from one point and one direction at the present poses of its
 * bodies. The joint angle at the present pose is then def->angle0.
 * @param[in] at    the joint point, ground frame [m]
 * @param[in] axis  direction of the joint axis, ground frame, not zero
 * @param[in] ref   [3] direction from which the angle counts, ground frame; NULL: chosen
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (not finite, or no direction).
 * @since 0.1 */
SE3D_API se3d_status se3d_joint_def_set_frame(const se3d_system *system, se3d_joint_def *def,
                                              const double at[3], const double axis[3],
                                              const double *ref);

/* Create a joint without relative motion. The equations and freedoms of each joint are in
 * docs/theory/joints.md. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_fixed(se3d_system *system, const se3d_joint_def *def,
                                             se3d_constraint *joint);

/* Create a hinge: rotation about the axis. @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_revolute(se3d_system *system, const se3d_joint_def *def,
                                                se3d_constraint *joint);

/* Create a slide: displacement along the axis. @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_prismatic(se3d_system *system, const se3d_joint_def *def,
                                                 se3d_constraint *joint);

/* Create a joint with rotation about the axis and displacement along it. @return as
 * se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_cylindrical(se3d_system *system, const se3d_joint_def *def,
                                                   se3d_constraint *joint);

/* Create a ball joint: the two points coincide. @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_spherical(se3d_system *system, const se3d_joint_def *def,
                                                 se3d_constraint *joint);

/* Create a universal joint. axis_i and axis_j are the two axes of its cross, perpendicular to
 * each other. @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_universal(se3d_system *system, const se3d_joint_def *def,
                                                 se3d_constraint *joint);

/* Create a joint that keeps point_j in the plane through point_i whose normal is the axis, and
 * the axes parallel. @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_planar(se3d_system *system, const se3d_joint_def *def,
                                              se3d_constraint *joint);

/* Create a screw: displacement = pitch * angle / (2 pi), counted from the present pose. @return
 * as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_screw(se3d_system *system, const se3d_joint_def *def,
                                             se3d_constraint *joint);

/* Create a joint that keeps point_j on the line through point_i along axis_i. @return as
 * se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_point_on_line(se3d_system *system, const se3d_joint_def *def,
                                                     se3d_constraint *joint);

/* Create a joint that keeps point_j in the plane through point_i perpendicular to axis_i.
 * @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_point_on_plane(se3d_system *system,
                                                      const se3d_joint_def *def,
                                                      se3d_constraint *joint);

/* Create a massless link: point_i and point_j keep `distance`. @return as
 * se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_distance(se3d_system *system, const se3d_joint_def *def,
                                                se3d_constraint *joint);

/* Create a massless link with a revolute joint on body i and a ball on body j: point_j keeps
 * `distance` from point_i and stays in the plane through point_i perpendicular to axis_i.
 * @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_revolute_spherical(se3d_system *system,
                                                          const se3d_joint_def *def,
                                                          se3d_constraint *joint);

/* Create a massless link with a revolute joint about axis_i and a cylindrical joint along
 * axis_j: the axes are perpendicular to each other at `distance`. @return as
 * se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_revolute_cylindrical(se3d_system *system,
                                                            const se3d_joint_def *def,
                                                            se3d_constraint *joint);

/* Create a joint that keeps axis_i and axis_j parallel (2 equations). @return as
 * se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_parallel(se3d_system *system, const se3d_joint_def *def,
                                                se3d_constraint *joint);

/* Create a joint that keeps axis_i and axis_j perpendicular (1 equation). @return as
 * se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_perpendicular(se3d_system *system, const se3d_joint_def *def,
                                                     se3d_constraint *joint);

/* Create a joint without relative rotation (3 equations). @return as se3d_joint_create_fixed.
 * @since 0.1 */
SE3D_API se3d_status se3d_joint_create_orientation(se3d_system *system, const se3d_joint_def *def,
                                                   se3d_constraint *joint);

/* Create the intermediate constraint perpendicular 1 of ME751: axis_j is perpendicular to the
 * plane with normal axis_i, by 2 DP1. @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_perpendicular1(se3d_system *system,
                                                      const se3d_joint_def *def,
                                                      se3d_constraint *joint);

/* Create the intermediate constraint perpendicular 2 of ME751: d_ij is perpendicular to the
 * plane with normal axis_i, by 2 DP2. @return as se3d_joint_create_fixed. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_perpendicular2(se3d_system *system,
                                                      const se3d_joint_def *def,
                                                      se3d_constraint *joint);

/* Get the definition of a joint, with which se3d_joint_create_<type> makes it again, to the bit, in
 * whatever pose its bodies are: reference directions and a distance that were chosen are given. An
 * exception is the advance of a screw, which counts from the pose at creation. Set
 * def->struct_size before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (no joint between two bodies, struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_joint_get_def(const se3d_system *system, se3d_constraint joint,
                                        se3d_joint_def *def);

/* Define a joint again, of the same type: see se3d_body_set_def. Force elements on it follow its
 * new frames; drivers and couplers of it are made of what it was, and go first. So do force
 * elements on it and functions with a signal of it if its bodies are other ones. A joint that is
 * broken stays so.
 * @return OK, NULL, STALE_HANDLE, IN_USE (by a driver or coupler; on other bodies also by a force
 *         element or a signal), INVALID_ARGUMENT (also of no joint between two bodies).
 * @since 0.1 */
SE3D_API se3d_status se3d_joint_set_def(se3d_system *system, se3d_constraint joint,
                                        const se3d_joint_def *def);

/* Set the limits at which a joint breaks: where the force or the moment of its reaction
 * (se3d_constraint_get_reaction) passes its limit in a run of dynamics, its equations are left out
 * from there on, and so are those of drivers and couplers of its coordinates; force elements on
 * them do nothing any more. The state goes on as it is; the bodies may touch each other once they
 * have been apart.
 * The event is found in time as those of se3d/event.h, at the end of a step by convex and in
 * systems with particle sets, is on the record of the solver and told to the log
 * (SE3D_LOG_BROKEN). Several joints break one after the other if the first one's load is too much
 * for the next. Kinematics and inverse dynamics are refused as long as a joint may break, and so
 * are batches and joints with an armature. docs/theory/events.md
 * @param[in] force   >= 0, 0: no limit [N]
 * @param[in] moment  >= 0, 0: no limit; about the joint point on body j [N m]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (no joint between two bodies, a limit), STATE
 * (within a callback). @since 0.1 */
SE3D_API se3d_status se3d_joint_set_break(se3d_system *system, se3d_constraint joint, double force,
                                          double moment);

/* Get whether a joint is broken; what acts on a broken joint is so, too (drivers, couplers).
 * @param[out] broken  1 or 0
 * @return OK, NULL, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_joint_get_broken(const se3d_system *system, se3d_constraint joint,
                                           int32_t *broken);

/* Break a joint as it is, or make it whole again: bodies that are apart by then come together when
 * the next analysis begins, as at any start. What was computed of forces and accelerations is void
 * until then. Snapshots, clones and checkpoints keep which joints are broken. Dynamics,
 * kinematics and inverse dynamics refuse a broken joint with an armature.
 * @param[in] broken  1 or 0
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (no joint between two bodies, another number),
 * STATE (within a callback). @since 0.1 */
SE3D_API se3d_status se3d_joint_set_broken(se3d_system *system, se3d_constraint joint,
                                           int32_t broken);

/* Coordinates of a joint: of j relative to i, about or along its axis. @since 0.1 */
typedef enum se3d_joint_coordinate {
    SE3D_JOINT_COORDINATE_ANGLE = 0,       /* [rad], counts turns */
    SE3D_JOINT_COORDINATE_DISPLACEMENT = 1 /* [m] */
} se3d_joint_coordinate;

/* Get a joint coordinate with its rate and its acceleration. NULL ones are skipped.
 * @param[out] value         [rad] or [m]
 * @param[out] rate          [rad/s] or [m/s]
 * @param[out] acceleration  that the last analysis computed [rad/s^2] or [m/s^2]
 * @return OK, NULL, STALE_HANDLE, STATE, INVALID_ARGUMENT (it has no such coordinate), NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_joint_get_coordinate(const se3d_system *system, se3d_constraint joint,
                                               se3d_joint_coordinate coordinate, double *value,
                                               double *rate, double *acceleration);

/* The most terms of a coupler. @since 0.1 */
#define SE3D_COUPLER_TERMS_MAX 4

/* A linear relation of joint coordinates: sum_k ratio[k] coordinate[k] = value (or f(t)). What it
 * does to bodies: se3d_driver_get_effort, and the reactions of se3d_constraint_get_reaction on body
 * j of the first joint, at its point there. @since 0.1 */
typedef struct se3d_coupler_def {
    size_t struct_size;
    const char *name;                              /* copied; NULL or unique among constraints */
    se3d_constraint joint[SE3D_COUPLER_TERMS_MAX]; /* [count] */
    int32_t coordinate[SE3D_COUPLER_TERMS_MAX];    /* se3d_joint_coordinate */
    double ratio[SE3D_COUPLER_TERMS_MAX];          /* [1, m/rad, rad/m], not zero */
    size_t count;                                  /* 1 .. SE3D_COUPLER_TERMS_MAX */
    double value;                                  /* if `function` is null [m, rad] */
    se3d_function function;                        /* f(t), or null */
} se3d_coupler_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_coupler_def_default. @since 0.1 */
SE3D_API void se3d_coupler_def_init(se3d_coupler_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_coupler_def se3d_coupler_def_default(void)
{
    se3d_coupler_def def;
    se3d_coupler_def_init(&def, sizeof def);
    return def;
}

/* Create a coupler: a linear relation of joint coordinates. @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_joint_create_coupler(se3d_system *system, const se3d_coupler_def *def,
                                               se3d_constraint *joint);

/* Create a pair of gears: ratio * angle of joint_1 + angle of joint_2 = constant, fixed at the
 * present pose.
 * @param[in] name   copied; NULL or unique among constraints
 * @param[in] ratio  > 0: they turn in opposite senses [1]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NOT_FINITE, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_joint_create_gear(se3d_system *system, const char *name,
                                            se3d_constraint joint_1, se3d_constraint joint_2,
                                            double ratio, se3d_constraint *joint);

/* Create a rack and pinion: displacement of `rack` = radius * angle of `pinion` + constant, fixed
 * at the present pose.
 * @param[in] name    copied; NULL or unique among constraints
 * @param[in] radius  of the pitch circle [m]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NOT_FINITE, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_joint_create_rack_pinion(se3d_system *system, const char *name,
                                                   se3d_constraint pinion, se3d_constraint rack,
                                                   double radius, se3d_constraint *joint);

/* Get the definition of a coupler, gear or rack and pinion as that of a coupler, with the value
 * that it keeps. Set def->struct_size before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (another constraint, struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_coupler_get_def(const se3d_system *system, se3d_constraint coupler,
                                          se3d_coupler_def *def);

/* Define a coupler, gear or rack and pinion again, with as many terms: see se3d_body_set_def.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of another constraint or structure).
 * @since 0.1 */
SE3D_API se3d_status se3d_coupler_set_def(se3d_system *system, se3d_constraint coupler,
                                          const se3d_coupler_def *def);

/* The definition of a driver: coordinate of `joint` = f(t), or f(t, s_1, s_2, ...), where the s_k
 * are signals of positions (se3d/function.h): coordinates of other joints, lengths and angles of
 * force elements, positions of points, Euler parameters. Such a driver ties the coordinate to the
 * signals as an ideal cam does: what moves them feels its effort, too, and it does work only if f
 * depends on the time. Its first bodies are those of the joint; with those of the signals they are
 * at most 8.
 *
 * With `is_rate` the rate of the coordinate = f(t, s_1, s_2, ...) with signals of any kind but that
 * rate itself, states and their outputs among them; the coordinate starts as it is. Such an
 * equation between velocities is part of dynamics alone (and of assemblies, for velocities):
 * kinematics, inverse dynamics, equilibria and modes, and the methods rattle, verlet and convex,
 * return UNSUPPORTED. It too acts on all bodies whose velocities f depends on, as a gear does; what
 * f depends on otherwise does not feel it. Outputs and inputs of states that f takes must be set
 * before, and stay. @since 0.1 */
typedef struct se3d_driver_def {
    size_t struct_size;
    const char *name;       /* copied; NULL or unique among constraints */
    se3d_constraint joint;  /* with that coordinate */
    int32_t coordinate;     /* se3d_joint_coordinate */
    int32_t is_rate;        /* not 0: f is the rate of the coordinate; it must have signals */
    double value;           /* f if `function` is null [m, rad] */
    se3d_function function; /* f, or null; with signals an expression whose only variable beside
                               them is the time */
} se3d_driver_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_driver_def_default. @since 0.1 */
SE3D_API void se3d_driver_def_init(se3d_driver_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_driver_def se3d_driver_def_default(void)
{
    se3d_driver_def def;
    se3d_driver_def_init(&def, sizeof def);
    return def;
}

/* Create a driver, which prescribes a joint coordinate. @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_driver_create(se3d_system *system, const se3d_driver_def *def,
                                        se3d_constraint *driver);

/* Get the definition of a driver. Set def->struct_size before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (another constraint, struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_driver_get_def(const se3d_system *system, se3d_constraint driver,
                                         se3d_driver_def *def);

/* Define a driver again, with another function, value or joint: see se3d_body_set_def. One whose
 * function has signals stays one with signals.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of another constraint or structure).
 * @since 0.1 */
SE3D_API se3d_status se3d_driver_set_def(se3d_system *system, se3d_constraint driver,
                                         const se3d_driver_def *def);

/* Get the prescribed value f of a driver, or of any constraint of one equation, at the present
 * time and positions; of a driver with `is_rate` the coordinate.
 * @param[out] value  as in the definition [rad, m]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (more than one equation), NOT_FINITE, SINGULAR
 * (the points of a length among its signals coincide), CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_driver_get_value(const se3d_system *system, se3d_constraint driver,
                                           double *value);

/* Get the effort with which a driver acts on body j, from the last analysis. For any other
 * constraint of one equation (value - f = 0) it is the generalised force -lambda. A coupler, gear
 * or rack acts with ratio[k] times its effort on coordinate k: on body j of that joint about or
 * along its axis, and on its body i with the opposite.
 * @param[out] effort  torque about the joint axis [N m] or force along it [N]
 * @return OK, NULL, STALE_HANDLE, STATE, INVALID_ARGUMENT (more than one equation).
 * @since 0.1 */
SE3D_API se3d_status se3d_driver_get_effort(const se3d_system *system, se3d_constraint driver,
                                            double *effort);

#ifdef __cplusplus
}
#endif
#endif
