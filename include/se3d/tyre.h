/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyres: force elements between a wheel that turns and a road.
 *
 * Axes are those of ISO 8855 at the contact point: x forward in the road, along the wheel's plane,
 * y to the left in the road, z along the road's normal. Forces and moments act on the wheel.
 * Equations, signs and sources: docs/theory/tyre.md.
 *
 * Slip that lags is a state (se3d/state.h) of the tyre's own, one for each direction: it is
 * integrated with the motion, in every method, and counts among the states of the system.
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
    SE3D_TYRE_FIALA = 1, /* E. Fiala (1954), with mu falling from mu to mu_min */
    SE3D_TYRE_MF52 = 2,  /* Magic Formula 5.2, PAC2002 */
    SE3D_TYRE_MF61 = 3   /* Magic Formula 6.1 */
} se3d_tyre_law;

/* The side of the vehicle that a wheel is on. @since 0.1 */
typedef enum se3d_tyre_side { SE3D_TYRE_LEFT = 0, SE3D_TYRE_RIGHT = 1 } se3d_tyre_side;

/* Coefficients of the Magic Formula, X(NAME, number, value without it), named as in files (.tir):
 * loads [N], LONGVL [m/s], pressures [Pa], limits of slip angle and camber [rad], stiffnesses
 * [N/m], all others [1]. Limits and pressures that are 0 are not there. @since 0.1 */
/* clang-format off */
#define SE3D_TYRE_COEFFICIENT_LIST(X)                                                              \
    X(FNOMIN, 0, 0)                                                                                \
    X(LONGVL, 1, 16.7)                                                                             \
    X(NOMPRES, 2, 0)                                                                               \
    X(INFLPRES, 3, 0)                                                                              \
    X(FZMIN, 4, 0)                                                                                 \
    X(FZMAX, 5, 0)                                                                                 \
    X(KPUMIN, 6, 0)                                                                                \
    X(KPUMAX, 7, 0)                                                                                \
    X(ALPMIN, 8, 0)                                                                                \
    X(ALPMAX, 9, 0)                                                                                \
    X(CAMMIN, 10, 0)                                                                               \
    X(CAMMAX, 11, 0)                                                                               \
    X(BREFF, 12, 0)                                                                                \
    X(DREFF, 13, 0)                                                                                \
    X(FREFF, 14, 0)                                                                                \
    X(QRE0, 15, 1)                                                                                 \
    X(QV1, 16, 0)                                                                                  \
    X(LFZO, 17, 1)                                                                                 \
    X(LCX, 18, 1)                                                                                  \
    X(LMUX, 19, 1)                                                                                 \
    X(LEX, 20, 1)                                                                                  \
    X(LKX, 21, 1)                                                                                  \
    X(LHX, 22, 1)                                                                                  \
    X(LVX, 23, 1)                                                                                  \
    X(LGAX, 24, 1)                                                                                 \
    X(LXAL, 25, 1)                                                                                 \
    X(LCY, 26, 1)                                                                                  \
    X(LMUY, 27, 1)                                                                                 \
    X(LEY, 28, 1)                                                                                  \
    X(LKY, 29, 1)                                                                                  \
    X(LHY, 30, 1)                                                                                  \
    X(LVY, 31, 1)                                                                                  \
    X(LGAY, 32, 1)                                                                                 \
    X(LKYC, 33, 1)                                                                                 \
    X(LYKA, 34, 1)                                                                                 \
    X(LVYKA, 35, 1)                                                                                \
    X(LTR, 36, 1)                                                                                  \
    X(LRES, 37, 1)                                                                                 \
    X(LGAZ, 38, 1)                                                                                 \
    X(LKZC, 39, 1)                                                                                 \
    X(LS, 40, 1)                                                                                   \
    X(LMX, 41, 1)                                                                                  \
    X(LVMX, 42, 1)                                                                                 \
    X(LMY, 43, 1)                                                                                  \
    X(PCX1, 44, 0)                                                                                 \
    X(PDX1, 45, 0)                                                                                 \
    X(PDX2, 46, 0)                                                                                 \
    X(PDX3, 47, 0)                                                                                 \
    X(PEX1, 48, 0)                                                                                 \
    X(PEX2, 49, 0)                                                                                 \
    X(PEX3, 50, 0)                                                                                 \
    X(PEX4, 51, 0)                                                                                 \
    X(PKX1, 52, 0)                                                                                 \
    X(PKX2, 53, 0)                                                                                 \
    X(PKX3, 54, 0)                                                                                 \
    X(PHX1, 55, 0)                                                                                 \
    X(PHX2, 56, 0)                                                                                 \
    X(PVX1, 57, 0)                                                                                 \
    X(PVX2, 58, 0)                                                                                 \
    X(PPX1, 59, 0)                                                                                 \
    X(PPX2, 60, 0)                                                                                 \
    X(PPX3, 61, 0)                                                                                 \
    X(PPX4, 62, 0)                                                                                 \
    X(RBX1, 63, 0)                                                                                 \
    X(RBX2, 64, 0)                                                                                 \
    X(RBX3, 65, 0)                                                                                 \
    X(RCX1, 66, 0)                                                                                 \
    X(REX1, 67, 0)                                                                                 \
    X(REX2, 68, 0)                                                                                 \
    X(RHX1, 69, 0)                                                                                 \
    X(PCY1, 70, 0)                                                                                 \
    X(PDY1, 71, 0)                                                                                 \
    X(PDY2, 72, 0)                                                                                 \
    X(PDY3, 73, 0)                                                                                 \
    X(PEY1, 74, 0)                                                                                 \
    X(PEY2, 75, 0)                                                                                 \
    X(PEY3, 76, 0)                                                                                 \
    X(PEY4, 77, 0)                                                                                 \
    X(PEY5, 78, 0)                                                                                 \
    X(PKY1, 79, 0)                                                                                 \
    X(PKY2, 80, 0)                                                                                 \
    X(PKY3, 81, 0)                                                                                 \
    X(PKY4, 82, 2)                                                                                 \
    X(PKY5, 83, 0)                                                                                 \
    X(PKY6, 84, 0)                                                                                 \
    X(PKY7, 85, 0)                                                                                 \
    X(PHY1, 86, 0)                                                                                 \
    X(PHY2, 87, 0)                                                                                 \
    X(PHY3, 88, 0)                                                                                 \
    X(PVY1, 89, 0)                                                                                 \
    X(PVY2, 90, 0)                                                                                 \
    X(PVY3, 91, 0)                                                                                 \
    X(PVY4, 92, 0)                                                                                 \
    X(PPY1, 93, 0)                                                                                 \
    X(PPY2, 94, 0)                                                                                 \
    X(PPY3, 95, 0)                                                                                 \
    X(PPY4, 96, 0)                                                                                 \
    X(PPY5, 97, 0)                                                                                 \
    X(RBY1, 98, 0)                                                                                 \
    X(RBY2, 99, 0)                                                                                 \
    X(RBY3, 100, 0)                                                                                \
    X(RBY4, 101, 0)                                                                                \
    X(RCY1, 102, 0)                                                                                \
    X(REY1, 103, 0)                                                                                \
    X(REY2, 104, 0)                                                                                \
    X(RHY1, 105, 0)                                                                                \
    X(RHY2, 106, 0)                                                                                \
    X(RVY1, 107, 0)                                                                                \
    X(RVY2, 108, 0)                                                                                \
    X(RVY3, 109, 0)                                                                                \
    X(RVY4, 110, 0)                                                                                \
    X(RVY5, 111, 0)                                                                                \
    X(RVY6, 112, 0)                                                                                \
    X(QBZ1, 113, 0)                                                                                \
    X(QBZ2, 114, 0)                                                                                \
    X(QBZ3, 115, 0)                                                                                \
    X(QBZ4, 116, 0)                                                                                \
    X(QBZ5, 117, 0)                                                                                \
    X(QBZ9, 118, 0)                                                                                \
    X(QBZ10, 119, 0)                                                                               \
    X(QCZ1, 120, 0)                                                                                \
    X(QDZ1, 121, 0)                                                                                \
    X(QDZ2, 122, 0)                                                                                \
    X(QDZ3, 123, 0)                                                                                \
    X(QDZ4, 124, 0)                                                                                \
    X(QDZ6, 125, 0)                                                                                \
    X(QDZ7, 126, 0)                                                                                \
    X(QDZ8, 127, 0)                                                                                \
    X(QDZ9, 128, 0)                                                                                \
    X(QDZ10, 129, 0)                                                                               \
    X(QDZ11, 130, 0)                                                                               \
    X(QEZ1, 131, 0)                                                                                \
    X(QEZ2, 132, 0)                                                                                \
    X(QEZ3, 133, 0)                                                                                \
    X(QEZ4, 134, 0)                                                                                \
    X(QEZ5, 135, 0)                                                                                \
    X(QHZ1, 136, 0)                                                                                \
    X(QHZ2, 137, 0)                                                                                \
    X(QHZ3, 138, 0)                                                                                \
    X(QHZ4, 139, 0)                                                                                \
    X(PPZ1, 140, 0)                                                                                \
    X(PPZ2, 141, 0)                                                                                \
    X(SSZ1, 142, 0)                                                                                \
    X(SSZ2, 143, 0)                                                                                \
    X(SSZ3, 144, 0)                                                                                \
    X(SSZ4, 145, 0)                                                                                \
    X(QSX1, 146, 0)                                                                                \
    X(QSX2, 147, 0)                                                                                \
    X(QSX3, 148, 0)                                                                                \
    X(QSX4, 149, 0)                                                                                \
    X(QSX5, 150, 0)                                                                                \
    X(QSX6, 151, 0)                                                                                \
    X(QSX7, 152, 0)                                                                                \
    X(QSX8, 153, 0)                                                                                \
    X(QSX9, 154, 0)                                                                                \
    X(QSX10, 155, 0)                                                                               \
    X(QSX11, 156, 0)                                                                               \
    X(QSX12, 157, 0)                                                                               \
    X(QSX13, 158, 0)                                                                               \
    X(QSX14, 159, 0)                                                                               \
    X(PPMX1, 160, 0)                                                                               \
    X(QSY1, 161, 0)                                                                                \
    X(QSY2, 162, 0)                                                                                \
    X(QSY3, 163, 0)                                                                                \
    X(QSY4, 164, 0)                                                                                \
    X(QSY5, 165, 0)                                                                                \
    X(QSY6, 166, 0)                                                                                \
    X(QSY7, 167, 1)                                                                                \
    X(QSY8, 168, 1)                                                                                \
    X(PTX1, 169, 0)                                                                                \
    X(PTX2, 170, 0)                                                                                \
    X(PTX3, 171, 0)                                                                                \
    X(PTY1, 172, 0)                                                                                \
    X(PTY2, 173, 0)                                                                                \
    X(LSGKP, 174, 1)                                                                               \
    X(LSGAL, 175, 1)                                                                               \
    X(LONGITUDINAL_STIFFNESS, 176, 0)                                                              \
    X(LATERAL_STIFFNESS, 177, 0)                                                                   \
    X(PCFX1, 178, 0)                                                                               \
    X(PCFX2, 179, 0)                                                                               \
    X(PCFX3, 180, 0)                                                                               \
    X(PCFY1, 181, 0)                                                                               \
    X(PCFY2, 182, 0)                                                                               \
    X(PCFY3, 183, 0)                                                                               \
    X(PDXP1, 184, 0)                                                                               \
    X(PDXP2, 185, 0)                                                                               \
    X(PDXP3, 186, 0)                                                                               \
    X(PKYP1, 187, 0)                                                                               \
    X(PDYP1, 188, 0)                                                                               \
    X(PDYP2, 189, 0)                                                                               \
    X(PDYP3, 190, 0)                                                                               \
    X(PDYP4, 191, 0)                                                                               \
    X(PHYP1, 192, 0)                                                                               \
    X(PHYP2, 193, 0)                                                                               \
    X(PHYP3, 194, 0)                                                                               \
    X(PHYP4, 195, 0)                                                                               \
    X(PECP1, 196, 0)                                                                               \
    X(PECP2, 197, 0)                                                                               \
    X(QDTP1, 198, 0)                                                                               \
    X(QCRP1, 199, 0)                                                                               \
    X(QCRP2, 200, 0)                                                                               \
    X(QBRP1, 201, 0)                                                                               \
    X(QDRP1, 202, 0)                                                                               \
    X(QDRP2, 203, 0)                                                                               \
    X(LMP, 204, 1)
/* clang-format on */

/* See SE3D_TYRE_COEFFICIENT_LIST. @since 0.1 */
typedef enum se3d_tyre_coefficient {
#define SE3D_TYRE_COEFFICIENT(NAME, number, value) SE3D_TYRE_##NAME = number,
    SE3D_TYRE_COEFFICIENT_LIST(SE3D_TYRE_COEFFICIENT)
#undef SE3D_TYRE_COEFFICIENT
        SE3D_TYRE_COEFFICIENTS = 205
} se3d_tyre_coefficient;

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
    double mu;        /* coefficient of friction [1], > 0; Magic Formula: scales it, 0: 1 */
    double mu_min;    /* fiala: at full sliding [1], 0 to mu; 0: mu */
    double slip_stiffness;      /* dFx / d(slip ratio) at 0, > 0 [N] */
    double cornering_stiffness; /* -dFy / d(tan slip angle) at 0, > 0 [N] */
    double patch_length;        /* of the contact patch, >= 0 [m]; 0: no aligning moment */
    double rolling_resistance;  /* resistance over load [1], >= 0 */
    double rolling_radius;      /* effective, >= 0 [m]; 0: radius - deflection/3 */
    double low_speed;           /* below it slip is regularised, > 0 [m/s]; default 1 */
    const double *coefficients; /* [coefficient_count], copied, of a Magic Formula [N, m/s, Pa, rad,
                                   1]; its laws take neither mu_min, the stiffnesses in the road,
                                   patch_length nor rolling_resistance */
    size_t coefficient_count;   /* those behind it have their values of the list */
    int32_t measured_side;      /* se3d_tyre_side that the coefficients hold for */
    int32_t is_transient;   /* 1: slip lags by relaxation lengths, those below or, where they are 0,
                             those of a Magic Formula's coefficients; default 0 */
    double relaxation_x;    /* relaxation length of the slip ratio, >= 0 [m]; > 0: it lags */
    double relaxation_y;    /* of the slip angle, >= 0 [m]; > 0: it lags */
    se3d_road surface;      /* in place of point and normal, on the body `road` (which may be null
                             then); null: a plane */
    double envelope_length; /* over which obstacles are rolled, >= 0 [m]; 0: the tyre touches a
                               point, on a mesh 0.4 radius */
    double envelope_width;  /* the same across, >= 0 [m]; 0: the length */
    int32_t has_turn_slip;  /* 1: a Magic Formula knows of turning about the road's normal, by PDXP1
                               ... QDRP2; default 0 */
    int32_t reserved;       /* 0 */
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

/* Set coefficients to what holds without them.
 * @param[out] coefficients  [count], see SE3D_TYRE_COEFFICIENT_LIST [N, m/s, Pa, rad, 1]
 * @param[in] count          at most SE3D_TYRE_COEFFICIENTS are set
 * @since 0.1 */
SE3D_API void se3d_tyre_coefficients_init(double *coefficients, size_t count);

/* Find a coefficient by its name in files.
 * @param[in] name    "PCX1"
 * @param[out] index  se3d_tyre_coefficient
 * @return OK, NULL, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_tyre_coefficient_find(const char *name, size_t *index);

/* Create a tyre: a force element of the type "tyre". @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_tyre(se3d_system *system, const se3d_tyre_def *def,
                                            se3d_force *force);

/* Get the definition of a tyre. Set def->struct_size before the call.
 * @param[out] def  its name (NULL: none) and coefficients are valid until the system is edited
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an element of another type, struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_tyre(const se3d_system *system, se3d_force force,
                                         se3d_tyre_def *def);

/* Define a tyre again, with slips that lag if they did: see se3d_body_set_def.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of an element of another type).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_set_tyre(se3d_system *system, se3d_force force,
                                         const se3d_tyre_def *def);

/* What a tyre tells: X(NAME, number, name). Forces [N] and moments [N m] in the axes at the contact
 * point, on the wheel; MY is about the spin axis and what comes on top of the forces at the contact
 * point. SLIP_RATIO is positive in driving, SLIP_ANGLE [rad] as the wheel slips to the left,
 * INCLINATION [rad] as its top leans to the right. Off the road, forces and slips are 0 and
 * DEFLECTION is minus the gap [m]. SPEED is that of the contact point, forward [m/s]. CONTACT is in
 * the ground frame [m]. LAGGED_RATIO and LAGGED_ANGLE are the slips that the forces follow:
 * SLIP_RATIO and SLIP_ANGLE, or what lags behind them by the relaxation length. TURN_SLIP [1/m] is
 * the rate at which the wheel turns about the road's normal, to the left, over its speed.
 * @since 0.1 */
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
    X(CONTACT_Z, 15, contact_z)                                                                    \
    X(LAGGED_RATIO, 16, lagged_ratio)                                                              \
    X(LAGGED_ANGLE, 17, lagged_angle)                                                              \
    X(TURN_SLIP, 18, turn_slip)

/* See SE3D_TYRE_VALUE_LIST. @since 0.1 */
typedef enum se3d_tyre_value {
#define SE3D_TYRE_VALUE(NAME, number, name) SE3D_TYRE_##NAME = number,
    SE3D_TYRE_VALUE_LIST(SE3D_TYRE_VALUE)
#undef SE3D_TYRE_VALUE
        SE3D_TYRE_VALUES = 19
} se3d_tyre_value;

/* Get what a tyre tells in the present state.
 * @param[in] first    the first value, se3d_tyre_value
 * @param[in] count    of values from there on
 * @param[out] values  [count]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (first, count, or no tyre), NOT_FINITE,
 * CALLBACK (of the road).
 * @since 0.1 */
SE3D_API se3d_status se3d_tyre_get_values(const se3d_system *system, se3d_force force, size_t first,
                                          size_t count, double *values);

/* Get some of what a tyre tells in the present state: the same numbers, and no more than they need
 * is computed, as of forces without moments.
 * @param[in] which    bit k: value k, se3d_tyre_value
 * @param[out] values  [SE3D_TYRE_VALUES], 0 of what was not asked for
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (nothing asked for, unknown bits, or no tyre),
 * NOT_FINITE, CALLBACK (of the road).
 * @since 0.1 */
SE3D_API se3d_status se3d_tyre_get_some(const se3d_system *system, se3d_force force, uint32_t which,
                                        double *values);

/* The same of several tyres. Those that have the same data, but for their sides, are computed side
 * by side where they follow each other, in less time than one by one.
 * @param[in] count
 * @param[in] tyres    [count]
 * @param[in] which    as above, of each of them
 * @param[out] values  [count][SE3D_TYRE_VALUES]; undefined on failure
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (nothing asked for, unknown bits, or one is no
 * tyre), NOT_FINITE, CALLBACK (of the road).
 * @since 0.1 */
SE3D_API se3d_status se3d_tyre_get_several(const se3d_system *system, size_t count,
                                           const se3d_force *tyres, uint32_t which, double *values);

#ifdef __cplusplus
}
#endif
#endif
