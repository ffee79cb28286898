/* SPDX-License-Identifier: BSD-3-Clause */
/* CD: a coordinate difference, the component of the distance between two points along a direction
 * of the ground frame, is prescribed.
 *
 *     Phi     = c.(r_j + A_j s_j - r_i - A_i s_i)
 *     r-omega   phi_i = [-c, -s_i x A_i^T c]        phi_j = [c, s_j x A_j^T c]
 *               gamma = c.A_i (w_i x (w_i x s_i)) - c.A_j (w_j x (w_j x s_j))
 *     r-p       phi_i = [-c, -B(p_i,s_i)^T c]       phi_j = [c, B(p_j,s_j)^T c]
 *               gamma = c.B(pdot_i,s_i) pdot_i - c.B(pdot_j,s_j) pdot_j
 *
 * Removes one degree of freedom; never degenerate for c /= 0.  docs/theory/cd.md */
#include "primitive/kernel.h"
#include "primitive/table.h"

double se3di_primitive_cd_value(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    double d[3];
    se3di_term_distance(t, i, j, d);
    return se3di_dot(t->c, d);
}

void se3di_primitive_cd_jacobian_romega(const se3di_term *t, const se3di_frame *i,
                                        const se3di_frame *j, double phi_i[6], double phi_j[6])
{
    se3di_copy(t->c, phi_j);
    se3di_scale(-1.0, t->c, phi_i);
    se3di_romega_gradient(i, t->s_i, phi_i, phi_i + 3);
    se3di_romega_gradient(j, t->s_j, phi_j, phi_j + 3);
}

void se3di_primitive_cd_jacobian_rp(const se3di_term *t, const se3di_frame *i, const se3di_frame *j,
                                    double phi_i[7], double phi_j[7])
{
    se3di_copy(t->c, phi_j);
    se3di_scale(-1.0, t->c, phi_i);
    se3di_rp_gradient(i, t->s_i, phi_i, phi_i + 3);
    se3di_rp_gradient(j, t->s_j, phi_j, phi_j + 3);
}

double se3di_primitive_cd_gamma_romega(const se3di_term *t, const se3di_frame *i,
                                       const se3di_frame *j)
{
    double d_term[3];
    se3di_romega_distance_velocity_term(t, i, j, d_term);
    return -se3di_dot(t->c, d_term);
}

double se3di_primitive_cd_gamma_rp(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    double d_term[3];
    se3di_rp_distance_velocity_term(t, i, j, d_term);
    return -se3di_dot(t->c, d_term);
}

void se3di_primitive_cd_curvature_romega(const se3di_term *t, const se3di_frame *i,
                                         const se3di_frame *j, double lambda, double H[144])
{
    enum { N = SE3DI_ROMEGA_TOTAL, I = SE3DI_ROTATION_I, J = SE3DI_ROTATION_J_ROMEGA };
    se3di_romega_add_curvature(se3di_block(H, N, I, I), i, -lambda, t->s_i, t->c);
    se3di_romega_add_curvature(se3di_block(H, N, J, J), j, lambda, t->s_j, t->c);
}

/* Independent of the pose: CD is quadratic in p. */
void se3di_primitive_cd_curvature_rp(const se3di_term *t, const se3di_frame *i,
                                     const se3di_frame *j, double lambda, double H[196])
{
    enum { N = SE3DI_RP_TOTAL, I = SE3DI_ROTATION_I, J = SE3DI_ROTATION_J_RP };
    (void)i;
    (void)j;
    se3di_rp_add_curvature(se3di_block(H, N, I, I), -lambda, t->s_i, t->c);
    se3di_rp_add_curvature(se3di_block(H, N, J, J), lambda, t->s_j, t->c);
}
