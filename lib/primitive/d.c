/* SPDX-License-Identifier: BSD-3-Clause */
/* D: the square of the distance between two points is prescribed.
 *
 *     Phi     = d.d,  d = r_j + A_j s_j - r_i - A_i s_i
 *     r-omega   phi_i = [-2 d, -2 s_i x A_i^T d]      phi_j = [2 d, 2 s_j x A_j^T d]
 *     r-p       phi_i = [-2 d, -2 B(p_i,s_i)^T d]     phi_j = [2 d, 2 B(p_j,s_j)^T d]
 *     gamma   = - 2 ddot.ddot - 2 d.d''
 *     r-omega   d'' = A_j (w_j x (w_j x s_j)) - A_i (w_i x (w_i x s_i))
 *     r-p       d'' = B(pdot_j,s_j) pdot_j - B(pdot_i,s_i) pdot_i
 *
 * Removes one degree of freedom; degenerate if the points coincide (d = 0: the Jacobian
 * vanishes; use three CD instead).  docs/theory/d.md */
#include "primitive/kernel.h"
#include "primitive/table.h"

double se3di_primitive_d_value(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    double d[3];
    se3di_term_distance(t, i, j, d);
    return se3di_dot(d, d);
}

static SE3DI_EITHER void jacobian(se3di_way way, SE3DI_ON_TERM, double *phi_i, double *phi_j)
{
    se3di_term_distance(t, i, j, phi_j);
    se3di_scale(2.0, phi_j, phi_j);
    se3di_scale(-1.0, phi_j, phi_i);
    se3di_gradient(way, i, t->s_i, phi_i, phi_i + 3);
    se3di_gradient(way, j, t->s_j, phi_j, phi_j + 3);
}

static SE3DI_EITHER double gamma_of(se3di_way way, SE3DI_ON_TERM)
{
    double d[3];
    double ddot[3];
    double d_term[3];
    se3di_term_distance(t, i, j, d);
    se3di_distance_rate(way, t, i, j, ddot);
    se3di_distance_velocity_term(way, t, i, j, d_term);
    return -2.0 * (se3di_dot(ddot, ddot) + se3di_dot(d, d_term));
}

/* With D the derivative of d: 2 D^T D, and the second derivatives of A_i s_i and A_j s_j. */
static SE3DI_EITHER void curvature(se3di_way way, SE3DI_ON_TERM, double lambda, double *H)
{
    const int n = se3di_columns(way), I = SE3DI_ROTATION_I, J = se3di_rotation_j(way);
    double d[3];
    double D[3 * SE3DI_TERM_TOTAL];
    se3di_term_distance(t, i, j, d);
    se3di_distance_derivative(way, t, i, j, D);
    se3di_block_add_product(H, n, 2.0 * lambda, D, n, D, n);
    se3di_add_curvature(way, se3di_block(H, n, I, I), i, -2.0 * lambda, t->s_i, d);
    se3di_add_curvature(way, se3di_block(H, n, J, J), j, 2.0 * lambda, t->s_j, d);
}

SE3DI_PRIMITIVE_JACOBIANS(d, jacobian)
SE3DI_PRIMITIVE_GAMMAS(d, gamma_of)
SE3DI_PRIMITIVE_CURVATURES(d, curvature)
