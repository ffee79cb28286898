/* SPDX-License-Identifier: BSD-3-Clause */
/* DP2: the component of the distance between two points along a direction on body i is prescribed.
 *
 *     Phi     = u.d,  u = A_i a_i,  d = r_j + A_j s_j - r_i - A_i s_i
 *     r-omega   phi_i = [-u, a_i x (A_i^T d + s_i)]            phi_j = [u, s_j x A_j^T u]
 *     r-p       phi_i = [-u, B(p_i,a_i)^T d - B(p_i,s_i)^T u]  phi_j = [u, B(p_j,s_j)^T u]
 *     gamma   = - d.u'' - 2 udot.ddot - u.d''
 *     r-omega   u'' = A_i (w_i x (w_i x a_i)),
 *               d'' = A_j (w_j x (w_j x s_j)) - A_i (w_i x (w_i x s_i))
 *     r-p       u'' = B(pdot_i,a_i) pdot_i,     d'' = B(pdot_j,s_j) pdot_j - B(pdot_i,s_i) pdot_i
 *
 * Removes one degree of freedom: with f = 0 point j stays in the plane through point i normal to u.
 * Never degenerate for a_i /= 0.  docs/theory/dp2.md */
#include "primitive/kernel.h"
#include "primitive/table.h"

double se3di_primitive_dp2_value(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    double u[3];
    double d[3];
    se3di_mul(i->A, t->a_i, u);
    se3di_term_distance(t, i, j, d);
    return se3di_dot(u, d);
}

void se3di_primitive_dp2_jacobian_romega(const se3di_term *t, const se3di_frame *i,
                                         const se3di_frame *j, double phi_i[6], double phi_j[6])
{
    double d[3];
    double local[3]; /* A_i^T d + s_i */
    se3di_term_distance(t, i, j, d);
    se3di_mul_transposed(i->A, d, local);
    se3di_add(local, t->s_i, local);
    se3di_mul(i->A, t->a_i, phi_j);
    se3di_scale(-1.0, phi_j, phi_i);
    se3di_cross(t->a_i, local, phi_i + 3);
    se3di_romega_gradient(j, t->s_j, phi_j, phi_j + 3);
}

void se3di_primitive_dp2_jacobian_rp(const se3di_term *t, const se3di_frame *i,
                                     const se3di_frame *j, double phi_i[7], double phi_j[7])
{
    double d[3];
    double arm[4];
    se3di_term_distance(t, i, j, d);
    se3di_mul(i->A, t->a_i, phi_j);
    se3di_scale(-1.0, phi_j, phi_i);
    se3di_rp_gradient(i, t->a_i, d, phi_i + 3);
    se3di_rp_gradient(i, t->s_i, phi_j, arm);
    for (int k = 0; k < 4; ++k) {
        phi_i[3 + k] -= arm[k];
    }
    se3di_rp_gradient(j, t->s_j, phi_j, phi_j + 3);
}

static SE3DI_EITHER double gamma_of(se3di_way way, SE3DI_ON_TERM)
{
    double u[3];
    double d[3];
    double udot[3];
    double ddot[3];
    double u_term[3];
    double d_term[3];
    se3di_mul(i->A, t->a_i, u);
    se3di_term_distance(t, i, j, d);
    se3di_rate(way, i, t->a_i, udot);
    se3di_distance_rate(way, t, i, j, ddot);
    se3di_velocity_term(way, i, t->a_i, u_term);
    se3di_distance_velocity_term(way, t, i, j, d_term);
    return -se3di_dot(d, u_term) - 2.0 * se3di_dot(udot, ddot) - se3di_dot(u, d_term);
}

/* With U and D the derivatives of u and d: U^T D + D^T U, and the second derivatives of A_i a_i,
 * A_i s_i and A_j s_j. */
static SE3DI_EITHER void curvature(se3di_way way, SE3DI_ON_TERM, double lambda, double *H)
{
    const int n = se3di_columns(way), I = SE3DI_ROTATION_I, J = se3di_rotation_j(way);
    const int m = se3di_turns(way);
    double u[3];
    double d[3];
    double U[12];
    double D[3 * SE3DI_TERM_TOTAL];
    se3di_mul(i->A, t->a_i, u);
    se3di_term_distance(t, i, j, d);
    se3di_derivative(way, i, t->a_i, U);
    se3di_distance_derivative(way, t, i, j, D);
    se3di_block_add_product(se3di_block(H, n, I, 0), n, lambda, U, m, D, n);
    se3di_block_add_product(se3di_block(H, n, 0, I), n, lambda, D, n, U, m);
    se3di_add_curvature(way, se3di_block(H, n, I, I), i, lambda, t->a_i, d);
    se3di_add_curvature(way, se3di_block(H, n, I, I), i, -lambda, t->s_i, u);
    se3di_add_curvature(way, se3di_block(H, n, J, J), j, lambda, t->s_j, u);
}

SE3DI_PRIMITIVE_GAMMAS(dp2, gamma_of)
SE3DI_PRIMITIVE_CURVATURES(dp2, curvature)
