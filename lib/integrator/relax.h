/* SPDX-License-Identifier: BSD-3-Clause */
/* If forces are far faster than the step (stiff springs, strong dampers), what a state is off
 * by, far below the tolerance, would make accelerations that the motion does not have. With those
 * of the method, a', one step of Newton's method from frames that fulfil the constraints,
 *
 *     (M + c D + c^2 K) x + Phi_q^T l = M (a - a'),   Phi_q x = 0
 *     q <- q + c^2 x,   v <- v + c x, the latter if it is dampers that are fast
 *
 * puts the state where its fast forces are in balance, and changes what is slow by the step times
 * the error of a'. For methods with unknowns (v, w).  docs/theory/radau.md */
#ifndef SE3DI_RELAX_H
#define SE3DI_RELAX_H

#include "integrator/state.h"

/* Of the fastest forces on a body, without its neighbours. */
typedef struct se3di_fastness {
    double spring2; /* (frequency times step)^2, */
    double damper2; /* (decay times step)^2 */
} se3di_fastness;

/* From the Newton matrix, factored last, of a step of h with the weights c and c^2. */
se3di_fastness se3di_relax_measure(const se3di_newton *newton, double c, double h);

/* Forces are far faster than the step. */
int se3di_is_fast(const se3di_fastness *fast);

/* Without springs, if bodies and joints make loops: near singular positions the curvature of
 * constraints, whose multipliers have a pole there, would count as such. */
se3di_fastness se3di_relax_trust(const se3di_equations *equations, se3di_fastness fast);

/* What the rounding of positions makes of velocities by springs in a step of h, relative to the
 * scales: no correction and no error below it says anything. */
double se3di_relax_noise(const se3di_fastness *fast, const se3di_state_scale *scale, double h);

typedef struct se3di_relaxation {
    double t, c;
    se3di_fastness fast;
    const double *vdot; /* [unknowns]: a' */
    double *work;       /* [2 * unknowns + rows] */
} se3di_relaxation;

/* The frames at t, where it is needed. */
se3d_status se3di_relax(se3di_integration *integration, const se3di_relaxation *relaxation);

/* The same of a state y that is off the constraints, which is projected first; its works stay. */
se3d_status se3di_relax_state(se3di_integration *integration, const se3di_relaxation *relaxation,
                              const se3di_state_scale *scale, double *y);

#endif
