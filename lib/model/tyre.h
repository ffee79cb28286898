/* SPDX-License-Identifier: BSD-3-Clause */
/* What a tyre is made of. Data only; its forces are in force/tyre.c. */
#ifndef SE3DI_MODEL_TYRE_H
#define SE3DI_MODEL_TYRE_H

#include "se3d/tyre.h"

/* Beside what the force element has: the bodies (road i, wheel j), a point of the road s_i, the
 * wheel's centre s_j, the radius `rest`, k, c and mu. */
typedef struct se3di_tyre {
    int32_t law;           /* se3d_tyre_law */
    int32_t side;          /* se3d_tyre_side of the definition */
    int32_t mirrored;      /* 1: used on the other side than the one it was measured on */
    int32_t surface;       /* dense index of the road; -1: the plane through s_i with the normal */
    double normal[3];      /* unit, frame of the road */
    double axis[3];        /* unit, to the left of the vehicle, frame of the wheel */
    double rolling_radius; /* [m]; 0: follows from the deflection */
    double mu_min;         /* 0: mu */
    double slip_stiffness, cornering_stiffness;
    double patch_length;
    double rolling_resistance;
    double low_speed;
    int32_t lags[2];      /* 1: the slip, forward or to the side, lags: it is a state, */
    uint32_t carrier[2];  /* the velocity of this body (model/state.h) */
    double relaxation[2]; /* lengths [m]; 0: follow from the coefficients */
    double envelope
        [2]; /* length and width over which obstacles are rolled, as given; 0: the default */
    double coefficients[SE3D_TYRE_COEFFICIENTS]; /* of the Magic Formula */
    int32_t has_turn_slip;                       /* 1: it knows of turning */
    int32_t kind; /* of those with the same coefficients, set by the model */
} se3di_tyre;

#endif
