/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyres: force elements between a wheel that turns and a road.
 *
 * Axes are those of ISO 8855 at the contact point: x forward in the road, along the wheel's plane,
 * y to the left in the road, z along the road's normal. Forces and moments act on the wheel.
 * Equations, signs and sources: docs/theory/tyre.md.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_TYRE_H
#define SE3D_TYRE_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Which formulas give the forces in the road from load and slip. @since 0.1 */
typedef enum se3d_tyre_law {
    SE3D_TYRE_BRUSH = 0, /* bristles under a parabolic pressure; combined slip */
    SE3D_TYRE_FIALA = 1  /* E. Fiala (1954), with mu falling from mu to mu_min */
} se3d_tyre_law;

/* The side of the vehicle that a wheel is on. @since 0.1 */
typedef enum se3d_tyre_side { SE3D_TYRE_LEFT = 0, SE3D_TYRE_RIGHT = 1 } se3d_tyre_side;

/* The definition of a tyre. @since 0.1 */
typedef struct se3d_tyre_def {
    size_t struct_size;
    const char *name; /* copied; NULL or unique among force elements */
    se3d_body road;   /* that the road is fixed to */
    se3d_body wheel;  /* that turns with the tyre, and must not be `road` */
    double point[3];  /* of the road's plane, frame of the road [m] */
    double normal[3]; /* of the road [1], up, frame of the road, not zero; default (0, 0, 1) */
    double center[3]; /* of the wheel, frame of the wheel [m] */
    double axis[3];   /* spin axis [1], out of the vehicle, frame of the wheel, not zero; default
                           (0, 1, 0) */
    int32_t side;     /* se3d_tyre_side: where out of the vehicle is */
    int32_t law;      /* se3d_tyre_law */
    double radius;    /* without load, > 0 [m] */
    double k;         /* vertical stiffness, > 0 [N/m] */
    double c;         /* vertical damping, >= 0 [N s/m] */
    double mu;        /* coefficient of friction [1], > 0 */
    double mu_min;    /* fiala: at full sliding [1], 0 to mu; 0: mu */
    double slip_stiffness;      /* dFx / d(slip ratio) at 0, > 0 [N] */
    double cornering_stiffness; /* -dFy / d(tan slip angle) at 0, > 0 [N] */
    double patch_length;        /* of the contact patch, >= 0 [m]; 0: no aligning moment */
    double rolling_resistance;  /* resistance over load [1], >= 0 */
    double rolling_radius;      /* effective, >= 0 [m]; 0: radius - deflection/3 */
    double low_speed;           /* below it slip is regularised, > 0 [m/s]; default 1 */
} se3d_tyre_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_tyre_def_default. @since 0.1 */
SE3D_API void se3d_tyre_def_init(se3d_tyre_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_tyre_def se3d_tyre_def_default(void)
{
    se3d_tyre_def def;
    se3d_tyre_def_init(&def, sizeof def);
    return def;
}

/* Create a tyre: a force element of the type "tyre". @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_tyre(se3d_system *system, const se3d_tyre_def *def,
                                            se3d_force *force);

/* What a tyre tells: X(NAME, number, name). Forces [N] and moments [N m] in the axes at the contact
 * point, on the wheel; MY is about the spin axis and what comes on top of the forces at the contact
 * point. SLIP_RATIO is positive in driving, SLIP_ANGLE [rad] as the wheel slips to the left,
 * INCLINATION [rad] as its top leans to the right. Off the road, forces and slips are 0 and
 * DEFLECTION is minus the gap [m]. SPEED is that of the contact point, forward [m/s]. CONTACT is in
 * the ground frame [m]. @since 0.1 */
#define SE3D_TYRE_VALUE_LIST(X)                                                                    \
    X(FX, 0, fx)                                                                                   \
    X(FY, 1, fy)                                                                                   \
    X(FZ, 2, fz)                                                                                   \
    X(MX, 3, mx)                                                                                   \
    X(MY, 4, my)                                                                                   \
    X(MZ, 5, mz)                                                                                   \
    X(SLIP_RATIO, 6, slip_ratio)                                                                   \
    X(SLIP_ANGLE, 7, slip_angle)                                                                   \
    X(INCLINATION, 8, inclination)                                                                 \
    X(DEFLECTION, 9, deflection)                                                                   \
    X(LOADED_RADIUS, 10, loaded_radius)                                                            \
    X(ROLLING_RADIUS, 11, rolling_radius)                                                          \
    X(SPEED, 12, speed)                                                                            \
    X(CONTACT_X, 13, contact_x)                                                                    \
    X(CONTACT_Y, 14, contact_y)                                                                    \
    X(CONTACT_Z, 15, contact_z)

/* See SE3D_TYRE_VALUE_LIST. @since 0.1 */
typedef enum se3d_tyre_value {
#define SE3D_TYRE_VALUE(NAME, number, name) SE3D_TYRE_##NAME = number,
    SE3D_TYRE_VALUE_LIST(SE3D_TYRE_VALUE)
#undef SE3D_TYRE_VALUE
        SE3D_TYRE_VALUES = 16
} se3d_tyre_value;

/* Get what a tyre tells in the present state.
 * @param[in] first    the first value, se3d_tyre_value
 * @param[in] count    of values from there on
 * @param[out] values  [count]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (first, count, or no tyre).
 * @since 0.1 */
SE3D_API se3d_status se3d_tyre_get_values(const se3d_system *system, se3d_force force, size_t first,
                                          size_t count, double *values);

#ifdef __cplusplus
}
#endif
#endif
