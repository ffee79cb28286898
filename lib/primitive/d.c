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

void se3di_primitive_d_jacobian_romega(const se3di_term *t, const se3di_frame *i,
                                       const se3di_frame *j, double phi_i[6], double phi_j[6])
{
    se3di_term_distance(t, i, j, phi_j);
    se3di_scale(2.0, phi_j, phi_j);
    se3di_scale(-1.0, phi_j, phi_i);
    se3di_romega_gradient(i, t->s_i, phi_i, phi_i + 3);
    se3di_romega_gradient(j, t->s_j, phi_j, phi_j + 3);
}

void se3di_primitive_d_jacobian_rp(const se3di_term *t, const se3di_frame *i, const se3di_frame *j,
                                   double phi_i[7], double phi_j[7])
{
    se3di_term_distance(t, i, j, phi_j);
    se3di_scale(2.0, phi_j, phi_j);
    se3di_scale(-1.0, phi_j, phi_i);
    se3di_rp_gradient(i, t->s_i, phi_i, phi_i + 3);
    se3di_rp_gradient(j, t->s_j, phi_j, phi_j + 3);
}

double se3di_primitive_d_gamma_romega(const se3di_term *t, const se3di_frame *i,
                                      const se3di_frame *j)
{
    double d[3];
    double ddot[3];
    double d_term[3];
    se3di_term_distance(t, i, j, d);
    se3di_romega_distance_rate(t, i, j, ddot);
    se3di_romega_distance_velocity_term(t, i, j, d_term);
    return -2.0 * (se3di_dot(ddot, ddot) + se3di_dot(d, d_term));
}

double se3di_primitive_d_gamma_rp(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    double d[3];
    double ddot[3];
    double d_term[3];
    se3di_term_distance(t, i, j, d);
    se3di_rp_distance_rate(t, i, j, ddot);
    se3di_rp_distance_velocity_term(t, i, j, d_term);
    return -2.0 * (se3di_dot(ddot, ddot) + se3di_dot(d, d_term));
}

/* With D the derivative of d: 2 D^T D, and the second derivatives of A_i s_i and A_j s_j. */
void se3di_primitive_d_curvature_romega(const se3di_term *t, const se3di_frame *i,
                                        const se3di_frame *j, double lambda, double H[144])
{
    enum { N = SE3DI_ROMEGA_TOTAL, I = SE3DI_ROTATION_I, J = SE3DI_ROTATION_J_ROMEGA };
    double d[3];
    double D[3 * N];
    se3di_term_distance(t, i, j, d);
    se3di_romega_distance_derivative(t, i, j, D);
    se3di_block_add_product(H, N, 2.0 * lambda, D, N, D, N);
    se3di_romega_add_curvature(se3di_block(H, N, I, I), i, -2.0 * lambda, t->s_i, d);
    se3di_romega_add_curvature(se3di_block(H, N, J, J), j, 2.0 * lambda, t->s_j, d);
}

void se3di_primitive_d_curvature_rp(const se3di_term *t, const se3di_frame *i, const se3di_frame *j,
                                    double lambda, double H[196])
{
    enum { N = SE3DI_RP_TOTAL, I = SE3DI_ROTATION_I, J = SE3DI_ROTATION_J_RP };
    double d[3];
    double D[3 * N];
    se3di_term_distance(t, i, j, d);
    se3di_rp_distance_derivative(t, i, j, D);
    se3di_block_add_product(H, N, 2.0 * lambda, D, N, D, N);
    se3di_rp_add_curvature(se3di_block(H, N, I, I), -2.0 * lambda, t->s_i, d);
    se3di_rp_add_curvature(se3di_block(H, N, J, J), 2.0 * lambda, t->s_j, d);
}
