/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints whose equations are evaluated together: a point on two bodies (three CD along the ground
 * axes), alone or followed by two DP1 that share their direction on body j. This covers spherical
 * and revolute joints; all others are evaluated term by term. With S = A s, W = A w, u = A_j a_j,
 * v = A_i a_i, n = v x u, D = W_i - W_j:
 *
 *     r-omega
 *               CD k:  phi_j = [ e_k,  s_j x (row k of A_j)]
 *                      phi_i = [-e_k, -s_i x (row k of A_i)]
 *                      gamma = f_tt + (W_i (W_i.S_i) - S_i (W_i.W_i) - the same of j)_k
 *               DP1:   Phi' = n . D, so that
 *                      phi_i = [0, A_i^T n]    phi_j = [0, -A_j^T n]
 *                      gamma = f_tt - n . (W_i x W_j) + (D.D) (u.v) - (D.u) (D.v)
 *
 *     r-p on the tangent of |p| = 1 (formulation/rp_tangent.c), with B = B(p,s) and
 *     Z = 2 A(pdot) - (pdot.pdot) 2 A(p), for which Z s = B(pdot,s) pdot - (pdot.pdot) B(p,s) p:
 *
 *               CD k:  phi_j = [ e_k,  1/2 G_j (row k of B_j)]    phi_i = [-e_k, -1/2 G_i (...)]
 *                      gamma = f_tt - (Z_j s_j - Z_i s_i)_k
 *               DP1:   phi_i = [0, 1/2 G_i B(p_i,a_i)^T u]    phi_j = [0, 1/2 G_j B(p_j,a_j)^T v]
 *                      gamma = f_tt - u . Z_i a_i - v . Z_j a_j
 *                              - 2 B(p_i,a_i) pdot_i . B(p_j,a_j) pdot_j
 *
 * The curvature, in both (turns in the body frame), with L = A^T (lambda_0, lambda_1, lambda_2) of
 * either body, alpha = sum of lambda_k a_i of the DP1, u and A_i alpha turned into the other body:
 *
 *     K_jj = ~s_j ~L_j + ~a_j ~(A_j^T A_i alpha)     K_ij = -~alpha A_i^T A_j ~a_j = K_ji^T
 *     K_ii = -~s_i ~L_i + ~alpha ~(A_i^T u)
 *
 * docs/theory/assembly.md */
#ifndef SE3DI_ASSEMBLY_FUSED_H
#define SE3DI_ASSEMBLY_FUSED_H

#include "assembly/assembly.h"

/* Rotational parts (3 x 3 of the 6 x 6) of the body blocks that the curvature of a joint adds to;
 * NULL: a body is fixed. */
typedef struct se3di_fused_blocks {
    double *ii, *jj, *ij, *ji;
} se3di_fused_blocks;

/* Whether a constraint of the model can be evaluated so. */
int se3di_fused_fits(const se3di_assembly *assembly, uint32_t joint);
/* Jacobian of a fitting joint into C; gamma (its rows; NULL: not wanted). */
void se3di_fused_eval(se3di_assembly *assembly, uint32_t joint, double *gamma);
/* Add c d(Phi_q qdot)/dq to `rows`, laid out as C: the Jacobian with the rates of its points and
 * directions in their places. */
void se3di_fused_add_rate_gradient(const se3di_assembly *assembly, uint32_t joint, double c,
                                   double *rows);
/* Add the derivative of Phi_q^T lambda to turns of the body frames; lambda: of its rows. */
void se3di_fused_add_curvature(const se3di_assembly *assembly, uint32_t joint, const double *lambda,
                               const se3di_fused_blocks *blocks);

#endif
