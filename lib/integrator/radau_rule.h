/* SPDX-License-Identifier: BSD-3-Clause */
/* Collocation of Radau IIA with three stages, order 5 (Hairer, Wanner 1996, sec. IV.8), and the
 * matrix with one value three times, P = gamma S (I - N)^-1 S^-1, that stands for A in Newton's
 * method: N and S are triangular. docs/theory/radau.md */
#ifndef SE3DI_RADAU_RULE_H
#define SE3DI_RADAU_RULE_H

/* Nodes, coefficients and their inverse. */
extern const double se3di_radau_c[3];
extern const double se3di_radau_a[3][3];
extern const double se3di_radau_inverse[3][3];
extern const double se3di_radau_gamma; /* the Newton matrix is that of a step gamma h */
/* N and S. */
extern const double se3di_radau_lower[3][3];
extern const double se3di_radau_upper[3][3];

/* A^-1 S (I - N)^-1 u / h: of transformed impulses the forces of the stages. */
void se3di_radau_untransform(const double u[3], double h, double change[3]);

#endif
