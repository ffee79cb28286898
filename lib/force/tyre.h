/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyres: where they touch the road, and what their laws make of it. docs/theory/tyre.md */
#ifndef SE3DI_FORCE_TYRE_H
#define SE3DI_FORCE_TYRE_H

#include "force/force.h"
#include "math/dual.h"

/* What forces depend on. */
enum {
    SE3DI_PATCH_DEFLECTION = 0, /* [m] */
    SE3DI_PATCH_RATE = 1,       /* of it [m/s] */
    SE3DI_PATCH_SPEED = 2,      /* of the contact point, forward [m/s] */
    SE3DI_PATCH_SIDE_SPEED = 3, /* of the wheel there, to the left [m/s] */
    SE3DI_PATCH_SINE = 4,       /* of the inclination */
    SE3DI_PATCH_SPIN = 5,       /* about the axis [rad/s] */
    SE3DI_PATCH_LAGGED = 6,     /* slip that lags, forward; to the side is the next one */
    SE3DI_PATCH_TURN = 8, /* rate of the wheel's plane about the normal, to the left [rad/s] */
    SE3DI_PATCH_INPUTS = SE3DI_DUALS
};

/* What a law is asked for. */
typedef struct se3di_tyre_slip {
    se3di_dual load;           /* Fz > 0 */
    se3di_dual rolling_radius; /* effective */
    se3di_dual ratio;          /* kappa = -V_sx / V */
    se3di_dual tangent;        /* tan alpha = V_sy / V */
    se3di_dual slide[2];       /* V_sx, V_sy */
    se3di_dual shear[2];       /* brush: V_sx, V_sy over the speed of rolling */
    se3di_dual roll;           /* |spin| times the rolling radius, regularised */
    se3di_dual speed;          /* V_x */
    se3di_dual reference;      /* V: |V_x|, regularised */
    se3di_dual way;            /* V_x / V: 1 ahead, -1 back */
    se3di_dual camber;         /* of the Magic Formula: the inclination */
    se3di_dual turn;           /* turning rate over V [1/m] */
    se3di_dual lean;           /* spin times sine over V [1/m] */
} se3di_tyre_slip;

/* Forces Fx, Fy, Fz and moments Mx, My (about the axis), Mz by the inputs. */
typedef struct se3di_tyre_forces {
    se3di_dual of[6];
} se3di_tyre_forces;

static inline int se3di_tyre_is_magic(const se3di_force *force)
{
    return force->tyre->law == SE3D_TYRE_MF52 || force->tyre->law == SE3D_TYRE_MF61;
}

/* The slips that the law follows: a place, where those that lag stand in for those of the
 * instant. */
static inline se3di_dual *se3di_tyre_followed(const se3di_force *force, se3di_tyre_slip *slip,
                                              int direction)
{
    if (force->tyre->law == SE3D_TYRE_BRUSH) {
        return &slip->shear[direction];
    }
    return direction ? &slip->tangent : &slip->ratio;
}

/* Slips of the instant, cosine: of the inclination, by the inputs of the patch. */
void se3di_tyre_take_slip(const se3di_force *force, double cosine, const double *in,
                          se3di_tyre_slip *slip);
/* Rates of both slips that lag. `slip`: of the instant. */
void se3di_tyre_find_rates(const se3di_force *force, const double *in, int touches,
                           se3di_tyre_slip *slip, se3di_dual rate[2]);
/* The same values; derivatives are not written. */
void se3di_tyre_take_slip_values(const se3di_force *force, double cosine, const double *in,
                                 se3di_tyre_slip *slip);
void se3di_tyre_find_rates_values(const se3di_force *force, const double *in, int touches,
                                  se3di_tyre_slip *slip, se3di_dual rate[2]);

/* Each law adds Fx, Fy, Mx, My, Mz; Fz is there. */
void se3di_tyre_brush(const se3di_force *force, const se3di_tyre_slip *slip,
                      se3di_tyre_forces *forces);
void se3di_tyre_fiala(const se3di_force *force, const se3di_tyre_slip *slip,
                      se3di_tyre_forces *forces);

void se3di_tyre_magic(const se3di_force *force, const se3di_tyre_slip *slip,
                      se3di_tyre_forces *forces);

/* What is computed: Fy always, Fx, moments (which need Fx), rates of slips that lag. */
enum {
    SE3DI_TYRE_WANTS_X = 1,
    SE3DI_TYRE_WANTS_MOMENTS = 2,
    SE3DI_TYRE_WANTS_RATES = 4,
    SE3DI_TYRE_WANTS_ALL = 7
};

/* The same values; derivatives stay as they are, what is not wanted is 0. */
void se3di_tyre_magic_values(const se3di_force *force, const se3di_tyre_slip *slip, int which,
                             se3di_tyre_forces *forces);
/* A slip that lags, z' = V (slip - z) / sigma, in one of the two directions. */
typedef struct se3di_tyre_lag {
    int32_t wants_derivative; /* set by the caller; 0: the rate only */
    double rate;              /* z' [1/s] */
    double own;               /* dz'/dz */
    double K[12];             /* dz' / d (dr, dtheta) of road and wheel */
    double D[12];             /* dz' / d (v, w) */
    double gain[12];          /* d wrench / dz */
} se3di_tyre_lag;

/* @return as se3di_force_eval */
se3d_status se3di_tyre_lag_eval(const se3di_model *model, const se3di_force *tyre, double t,
                                int direction, se3di_tyre_lag *lag);

/* An element without derivatives. */
typedef struct se3di_tyre_load {
    double wrench[12];
    double power[2];
    double rate[2];     /* of both slips that lag, 0 of one that does not */
    se3d_status status; /* as of se3di_force_eval; below 0 the others say nothing */
    int32_t reserved;
} se3di_tyre_load;

/* Of the first `count` tyres of a group, their dense indices. */
typedef struct se3di_tyre_loads {
    se3di_tyre_load of[4];
    uint32_t index[4];
    int32_t count, reserved;
} se3di_tyre_loads;

/* The loads of tyre `first`, which is not released, and of such ones that follow and are computed
 * with it (force/tyre_lanes.h). */
void se3di_tyre_eval_alike(const se3di_model *model, uint32_t first, double t,
                           se3di_tyre_loads *loads);

/* Its deflection [m] (< 0: it is above the road), the rate, the one that its damper has, which on
 * an uneven road is another [m/s], and the cosine of its inclination, at the present state. @return
 * as se3di_force_eval */
se3d_status se3di_tyre_find_deflection(const se3di_model *model, const se3di_force *force, double t,
                                       double deflection[4]);

/* In the order of se3d_tyre_value. */
typedef double se3di_tyre_values[SE3D_TYRE_VALUES];

/* What tyres tell at the present state, bit k of `which`: value k (se3d_tyre_value) of all of them;
 * the others may be left out. Tyres that are alike are computed side by side where they follow each
 * other. @return as se3di_force_eval */
se3d_status se3di_tyre_tell(const se3di_model *model, const se3di_force *const *tyres, size_t count,
                            uint32_t which, se3di_tyre_values *values);

#endif
