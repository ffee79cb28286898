/* SPDX-License-Identifier: BSD-3-Clause */
/* The linearised equations on the freedoms that the constraints leave, dense, in r-omega.
 *
 * With Z an orthonormal basis of the null space of Phi_q in body axes (E = diag(A, I) turns body
 * axes to the unknowns), small motions about the present one are dq = E Z y with
 *
 *     Mr y'' + Dr y' + Kr y = Z^T E^T (applied forces)
 *
 * At rest Mr = Z^T E^T M E Z and so on. About a steady motion (v, w constant in body axes) the
 * rates of the body axes add, with W = tilde(w):
 *
 *     dv = E (s' + W s)
 *     dvdot_r = A (s'' + 2 W s' + (W W + Wdot) s)
 *     dwdot = s'' + W s' + Wdot s
 *
 * Other axes may turn at constant rates of their own (a rotor's with its carrier): W is then their
 * rate, T theirs less the body's, E = diag(A B, B) with B from these axes to the body's, and
 *
 *     dwdot = s'' + (W + T) s' + T W s
 *
 * docs/theory/modes.md */
#ifndef SE3DI_LINEARISE_H
#define SE3DI_LINEARISE_H

#include "assembly/tangent.h"
#include "nonlinear/equations.h"

typedef struct se3di_linear {
    se3di_equations *equations;
    se3di_tangent tangent;
    int32_t n;               /* 6 per free body */
    int32_t rows;            /* constraint equations */
    int32_t freedoms;        /* f */
    double *M, *D, *K;       /* [n n] row-major, body axes */
    double *Z;               /* [n n]: the first f rows are the basis */
    double *Mr, *Dr, *Kr;    /* [n n], used f x f, row-major */
    double *unit;            /* [n 6] a unit block per body */
    double *work;            /* [2 n n] */
    double *load;            /* [n] applied forces and velocity terms, body axes */
    double *lambda, *buffer; /* [rows], [n] */
    double *rate;            /* [n / 2] of the axes, in these axes [rad/s], unless own_axes */
    double *turn;            /* [3 n / 2] axes -> body, if is_turned, row-major */
    int32_t own_axes;        /* the axes turn with the bodies */
    int32_t is_turned;       /* the axes are not those of the bodies at present */
} se3di_linear;

/* For equations in r-omega. On failure nothing is held. */
se3d_status se3di_linear_init(se3di_linear *linear, se3di_equations *equations);
void se3di_linear_destroy(se3di_linear *linear);

/* Z, the load and the multipliers that balance it (minimum norm, least squares: statics), at the
 * present state. */
se3d_status se3di_linear_eval_statics(se3di_linear *linear, double t);
/* M, D, K and their reduction, with Z and the given accelerations [n, ground and body axes as the
 * unknowns] and multipliers [rows]. */
se3d_status se3di_linear_eval_matrices(se3di_linear *linear, double t, const double *vdot,
                                       const double *lambda);

#endif
