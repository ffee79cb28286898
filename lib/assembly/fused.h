/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints whose equations are evaluated together, in r-omega: a point on two bodies (three CD along
 * the ground axes), alone or followed by two DP1 that share their direction on body j. This covers
 * spherical and revolute joints; all others are evaluated term by term.
 *
 *     CD k:  phi_j = [ e_k,  s_j x (row k of A_j)]    phi_i = [-e_k, -s_i x (row k of A_i)]
 *            gamma = f_tt + (A_i (w_i x (w_i x s_i)) - A_j (w_j x (w_j x s_j)))_k
 *     DP1:   with l, l', l'' = A_i^T A_j applied to a_j, w_j x a_j, w_j x (w_j x a_j):
 *            phi_i = [0, a_i x l]    phi_j = [0, a_j x (A_j^T A_i a_i)]
 *            gamma = f_tt - l . (w_i x (w_i x a_i)) - a_i . l'' - 2 (w_i x a_i) . l'
 *
 * docs/theory/assembly.md */
#ifndef SE3DI_ASSEMBLY_FUSED_H
#define SE3DI_ASSEMBLY_FUSED_H

#include "assembly/assembly.h"

/* Whether a constraint of the model can be evaluated so. */
int se3di_fused_fits(const se3di_assembly *assembly, uint32_t joint);
/* Jacobian of a fitting joint into C; gamma (its rows; NULL: not wanted). */
void se3di_fused_eval(se3di_assembly *assembly, uint32_t joint, double *gamma);

#endif
