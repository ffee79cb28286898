/* SPDX-License-Identifier: BSD-3-Clause */
/* Euler normalisation: the constraint p.p - 1 = 0 that each body carries in the r-p formulation. It
 * concerns one body and no data, so it is not a row of se3di_primitives.
 *
 *     Phi = p.p - 1     Phi_p = 2 p^T     nu = 0
 *     gamma = -2 pdot.pdot                curvature = 2 lambda I
 *
 * Never degenerate near |p| = 1.  docs/theory/euler-normalisation.md */
#ifndef SE3DI_PRIMITIVE_EULER_NORM_H
#define SE3DI_PRIMITIVE_EULER_NORM_H

double se3di_euler_norm_value(const double p[4]);
double se3di_euler_norm_gamma(const double pdot[4]);

#endif
