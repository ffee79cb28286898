/* SPDX-License-Identifier: BSD-3-Clause */
/* Wheels and what they measure of a suspension: camber, toe, steer axis, instant centres, motion
 * ratio, wheel rate. A wheel is a place on a body; it has no mass and no force of its own.
 * Definitions with signs and a figure: docs/theory/wheel.md.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_WHEEL_H
#define SE3D_WHEEL_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The definition of a wheel. @since 0.1 */
typedef struct se3d_wheel_def {
    size_t struct_size;
    const char *name;  /* copied; NULL or unique among wheels */
    se3d_body body;    /* that carries it: the upright */
    se3d_body chassis; /* to which it moves; its present pose counts as the given one */
    double center[3];  /* wheel centre, frame of the body [m] */
    double axis[3];    /* spin axis [1], out of the vehicle (left on a left wheel), frame of the
                                 body, not zero; default (0, 1, 0) */
    double forward[3]; /* of the vehicle [1], frame of the chassis, not zero; default
                                 (1, 0, 0) */
    double up[3];      /* of the vehicle [1], and the road's normal in the present pose, frame of
                                 the chassis, not zero; default (0, 0, 1) */
    double radius;     /* from the centre to the road, > 0 [m] */
    double width;      /* of the tread, >= 0 [m] */
    double steer_lower[3];  /* two points of the steer axis, frame of the body [m]; equal: found */
    double steer_upper[3];  /* from the motion; frame of the body [m] */
    se3d_constraint travel; /* what lifts the wheel; null: constraints of one equation between its
                                 body and a fixed one that is not the chassis */
    se3d_constraint steering; /* what prescribes the steering; may be null */
    se3d_force spring;        /* a tsda, for the motion ratio; may be null */
    se3d_wheel opposite;      /* the other wheel of the axle, if it exists already; each is then the
                                 other's */
    double wheelbase;         /* [m]; 0: unknown, for Ackermann and anti-features */
    double cg_height;         /* of the vehicle's mass above the road [m]; 0: unknown */
    double brake_share;       /* of the braking force at this axle, 0 to 1; default 0 */
    double drive_share;       /* of the driving force at this axle, 0 to 1; default 0 */
} se3d_wheel_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_wheel_def_default. @since 0.1 */
SE3D_API void se3d_wheel_def_init(se3d_wheel_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_wheel_def se3d_wheel_def_default(void)
{
    se3d_wheel_def def;
    se3d_wheel_def_init(&def, sizeof def);
    return def;
}

/* Create a wheel. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_wheel_create(se3d_system *system, const se3d_wheel_def *def,
                                       se3d_wheel *wheel);

/* Destroy a wheel. @return OK, NULL, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_wheel_destroy(se3d_system *system, se3d_wheel wheel);

/* Get the name of a wheel.
 * @param[out] name  "" if it has none; valid as long as the wheel lives
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_wheel_get_name(const se3d_system *system, se3d_wheel wheel,
                                         const char **name);

/* Get the definition of a wheel. Set def->struct_size before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_wheel_get_def(const se3d_system *system, se3d_wheel wheel,
                                        se3d_wheel_def *def);

/* Define a wheel again: see se3d_body_set_def. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_wheel_set_def(se3d_system *system, se3d_wheel wheel,
                                        const se3d_wheel_def *def);

/* Find a wheel by its name.
 * @param[in] name  UTF-8
 * @return OK, NULL, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_wheel_find(const se3d_system *system, const char *name,
                                     se3d_wheel *wheel);

/* Count the wheels of a system. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_wheels(const se3d_system *system);

/* Get a wheel of a system, in the order of creation.
 * @param[in] index  from 0, below se3d_system_count_wheels
 * @return OK, NULL, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_wheel(const se3d_system *system, size_t index,
                                           se3d_wheel *wheel);

/* What a wheel measures: X(NAME, number, name), in four groups that are computed together: the pose
 * (0 to 10), the steer axis (11 to 14), derivatives by wheel travel (15 to 27), loads (28 to 30).
 * Angles [rad], lengths [m], gradients per metre of travel. @since 0.1 */
#define SE3D_WHEEL_MEASURE_LIST(X)                                                                 \
    X(CAMBER, 0, camber)                                                                           \
    X(INCLINATION, 1, inclination)                                                                 \
    X(STEER, 2, steer)                                                                             \
    X(TOE, 3, toe)                                                                                 \
    X(TRAVEL, 4, travel)                                                                           \
    X(WHEELBASE_CHANGE, 5, wheelbase_change)                                                       \
    X(TRACK_CHANGE, 6, track_change)                                                               \
    X(ACKERMANN_ERROR, 7, ackermann_error)                                                         \
    X(CONTACT_X, 8, contact_x)                                                                     \
    X(CONTACT_Y, 9, contact_y)                                                                     \
    X(CONTACT_Z, 10, contact_z)                                                                    \
    X(CASTER, 11, caster)                                                                          \
    X(KINGPIN_INCLINATION, 12, kingpin_inclination)                                                \
    X(SCRUB_RADIUS, 13, scrub_radius)                                                              \
    X(MECHANICAL_TRAIL, 14, mechanical_trail)                                                      \
    X(CAMBER_GRADIENT, 15, camber_gradient)                                                        \
    X(TOE_GRADIENT, 16, toe_gradient)                                                              \
    X(TRACK_GRADIENT, 17, track_gradient)                                                          \
    X(WHEELBASE_GRADIENT, 18, wheelbase_gradient)                                                  \
    X(FRONT_SWING_ARM, 19, front_swing_arm)                                                        \
    X(FRONT_CENTER_HEIGHT, 20, front_center_height)                                                \
    X(SIDE_SWING_ARM, 21, side_swing_arm)                                                          \
    X(SIDE_CENTER_HEIGHT, 22, side_center_height)                                                  \
    X(ROLL_CENTER_HEIGHT, 23, roll_center_height)                                                  \
    X(ANTI_DIVE, 24, anti_dive)                                                                    \
    X(ANTI_LIFT, 25, anti_lift)                                                                    \
    X(ANTI_SQUAT, 26, anti_squat)                                                                  \
    X(MOTION_RATIO, 27, motion_ratio)                                                              \
    X(WHEEL_LOAD, 28, wheel_load)                                                                  \
    X(WHEEL_RATE, 29, wheel_rate)                                                                  \
    X(ROLL_RATE, 30, roll_rate)

/* See SE3D_WHEEL_MEASURE_LIST. @since 0.1 */
typedef enum se3d_wheel_measure {
#define SE3D_WHEEL_MEASURE(NAME, number, name) SE3D_WHEEL_##NAME = number,
    SE3D_WHEEL_MEASURE_LIST(SE3D_WHEEL_MEASURE)
#undef SE3D_WHEEL_MEASURE
        SE3D_WHEEL_MEASURES = 31
} se3d_wheel_measure;

/* Get what a wheel measures in the present state. Groups of which nothing is asked are not
 * computed. What the mechanism does not have is not a number: a steer axis where nothing steers, a
 * motion ratio without a spring. Centres at infinity are infinite. Exact: derivatives are those of
 * velocities and accelerations that the constraints allow, with the chassis at rest.
 * @param[in] first    the first measure, se3d_wheel_measure
 * @param[in] count    of measures from there on
 * @param[out] values  [count]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (first, count), NOT_FINITE, SINGULAR, CALLBACK,
 * NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_wheel_get_measures(const se3d_system *system, se3d_wheel wheel,
                                             size_t first, size_t count, double *values);

#ifdef __cplusplus
}
#endif
#endif
