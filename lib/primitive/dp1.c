/* SPDX-License-Identifier: BSD-3-Clause */
/* DP1: the dot product of a direction on body i and a direction on body j is prescribed.
 *
 *     Phi     = (A_i a_i).(A_j a_j)
 *     r-omega   phi_i = [0, a_i x A_i^T A_j a_j]     phi_j = [0, a_j x A_j^T A_i a_i]
 *               gamma = - A_j a_j . A_i (w_i x (w_i x a_i)) - A_i a_i . A_j (w_j x (w_j x a_j))
 *                       - 2 A_i (w_i x a_i) . A_j (w_j x a_j)
 *     r-p       phi_i = [0, B(p_i,a_i)^T A_j a_j]    phi_j = [0, B(p_j,a_j)^T A_i a_i]
 *               gamma = - A_j a_j . B(pdot_i,a_i) pdot_i - A_i a_i . B(pdot_j,a_j) pdot_j
 *                       - 2 B(p_i,a_i) pdot_i . B(p_j,a_j) pdot_j
 *
 * Removes one rotational degree of freedom; degenerate if the directions are parallel (all
 * derivatives of first order vanish).  docs/theory/dp1.md */
#include "primitive/dot.h"
#include "primitive/table.h"

double se3di_primitive_dp1_value(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    return se3di_dot_value(i, t->a_i, j, t->a_j);
}

static SE3DI_EITHER void jacobian(se3di_way way, SE3DI_ON_TERM, double *phi_i, double *phi_j)
{
    for (int k = 0; k < 3; ++k) {
        phi_i[k] = phi_j[k] = 0.0;
    }
    se3di_dot_gradient(way, i, t->a_i, j, t->a_j, phi_i + 3, phi_j + 3);
}

static SE3DI_EITHER double gamma_of(se3di_way way, SE3DI_ON_TERM)
{
    return se3di_dot_gamma(way, i, t->a_i, j, t->a_j);
}

static SE3DI_EITHER void curvature(se3di_way way, SE3DI_ON_TERM, double lambda, double *H)
{
    se3di_dot_curvature(way, i, t->a_i, j, t->a_j, lambda, H);
}

SE3DI_PRIMITIVE_JACOBIANS(dp1, jacobian)
SE3DI_PRIMITIVE_GAMMAS(dp1, gamma_of)
SE3DI_PRIMITIVE_CURVATURES(dp1, curvature)
