/* SPDX-License-Identifier: BSD-3-Clause */
/* One step of the Newmark family on index 3, shared by generalized_alpha and hht; in r-omega
 * orientations move on the group (Bruels, Cardona, Arnold 2012), in r-p Euler parameters are
 * coordinates (Negrut et al. 2007):
 *
 *     x       = h v_n + h^2 (1/2 - beta) a_n + h^2 beta a          q = q_n moved by x
 *     v       = v_n + h (1 - gamma) a_n + h gamma a
 *     (1 - alpha_m) a + alpha_m a_n = (1 - alpha_f) vdot + alpha_f vdot_n
 *     M vdot + Phi_q^T lambda = Q + velocity terms,  Phi(q, t) = 0       at t = t_n + h
 *
 * a is the algorithmic acceleration, an approximation of vdot at t + (alpha_m - alpha_f) h; it
 * starts there (Arnold, Bruels, Cardona 2015), which gives order 2 from the first step on.
 * docs/theory/newmark.md */
#ifndef SE3DI_NEWMARK_H
#define SE3DI_NEWMARK_H

#include "integrator/integrator.h"

#define SE3DI_NEWMARK_TURN_MAX_RP 0.6 /* rad, of a body in a step: Euler parameters add up */

typedef struct se3di_newmark {
    double alpha_m, alpha_f, beta, gamma;
    double tolerance; /* of the local error of positions; 0: any */
} se3di_newmark;

size_t se3di_newmark_history_count(const se3di_assembly *assembly);
size_t se3di_newmark_work_count(const se3di_assembly *assembly);
se3d_status se3di_newmark_start(se3di_integration *integration, const se3di_newmark *method,
                                double h);
/* One step. A step whose local error of positions,
 *     h^2 (|beta - 1/6| + 1/24) (vdot - vdot_n),
 * exceeds method->tolerance is undone: STEP_SIZE, and integration->error > 1. */
se3d_status se3di_newmark_renew(se3di_integration *integration);
se3d_status se3di_newmark_step(se3di_integration *integration, const se3di_newmark *method,
                               double h);
/* Steps of controlled error that end at t_end. */
se3d_status se3di_newmark_run(se3di_integration *integration, const se3di_newmark *method,
                              double t_end);

#endif
