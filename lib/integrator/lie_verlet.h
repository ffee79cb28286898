/* SPDX-License-Identifier: BSD-3-Clause */
/* The step of rattle (Andersen 1983) on the group of rigid motions, in parts: translation is
 * Stoermer-Verlet; rotation is the variational Lie-Verlet step with the exponential map (Bou-Rabee,
 * Marsden 2009), for the body-frame momentum L = J w and the turn x of the step, with
 * T(x) m = m + 1/2 x x m + c(x.x) x x (x x m), the transpose of the inverse derivative of exp:
 *
 *     drift   m v_h      = m v_0 + h/2 (F_0 - G_0^T lambda_0)
 *             T(x) J x/h = L_0 + h/2 (n_0 - C_0^T lambda_0)
 *             r_1 = r_0 + h v_h,   p_1 = p_0 exp(x),           lambda_0 from Phi(q_1, t_1) = 0
 *     kick    L_1   = T(-x) J x/h + h/2 (n_1 - C_1^T lambda_1)
 *             m v_1 = m v_h + h/2 (F_1 - G_1^T lambda_1),      lambda_1 from Phi_q qdot_1 = nu(t_1)
 *     finish  accelerations and multipliers of the end state, which is accepted
 *
 * The drift keeps linear and angular momentum of a free body to rounding, and turns it about a
 * principal axis exactly. docs/theory/rattle.md */
#ifndef SE3DI_LIE_VERLET_H
#define SE3DI_LIE_VERLET_H

#include "integrator/integrator.h"
#include "integrator/lie_friction.h"

typedef struct se3di_lie_verlet {
    se3di_integration *integration;
    se3di_equations *equations;
    se3di_assembly *assembly;
    double h, t1;
    double size;          /* of the mechanism [m] */
    int is_singular;      /* some constraints have had no leverage */
    int force_iterations; /* of forces that depend on velocities: 1 is explicit, of order 2 */
    double *wrench;       /* applied at the start [dense bodies * 6] */
    double *lambda;       /* [rows] */
    double *best;         /* [rows]: with the smallest gap yet */
    double *half;         /* half-step velocity and momentum at its end [free bodies * 6] */
    double *begin;        /* accelerations at its start [free bodies * 6] */
    double *last;         /* [unknowns] */
    se3di_lie_friction friction;
} se3di_lie_verlet;

/* For the table of a method. */
size_t se3di_lie_verlet_history_count(const se3di_assembly *assembly);
size_t se3di_lie_verlet_work_count(const se3di_assembly *assembly);
se3d_status se3di_lie_verlet_start(se3di_integration *integration, double h);
se3d_status se3di_lie_verlet_renew(se3di_integration *integration);

/* On the work arrays of the integration; h and t1 are set by the caller for each step. */
se3di_lie_verlet se3di_lie_verlet_begin(se3di_integration *integration, int force_iterations);
/* From the model's state to the positions at t1; the frames hold the mean velocities of the step.
 */
se3d_status se3di_lie_verlet_drift(se3di_lie_verlet *m);
/* The velocities at t1, accelerations and multipliers. */
se3d_status se3di_lie_verlet_kick(se3di_lie_verlet *m);
se3d_status se3di_lie_verlet_finish(se3di_lie_verlet *m);
/* All three. */
se3d_status se3di_lie_verlet_advance(se3di_lie_verlet *m);
/* From the model's time over h to t1. If the length of steps is chosen and friction changes on
 * the way, in parts, of which the one with the change is so short that it meets the tolerance. On
 * failure the state is that of the last part. */
se3d_status se3di_lie_verlet_follow(se3di_lie_verlet *m, double h, double t1);

#endif
