/* SPDX-License-Identifier: BSD-3-Clause */
/* Inertia tensors about the centre of mass, J = {xx, yy, zz, xy, yz, xz}: the elements of the
 * symmetric matrix (so xy is -integral of x y dm) [kg m^2].
 *
 * A tensor is that of a distribution of mass if and only if its principal moments a <= b <= c obey
 * c <= a + b (which implies a >= 0). Zero moments are legal: thin rods and point masses. */
#ifndef SE3DI_MATH_INERTIA_H
#define SE3DI_MATH_INERTIA_H

/* What se3di_inertia_is_physical returns. */
typedef enum se3di_inertia_verdict {
    SE3DI_INERTIA_PHYSICAL = 0,
    SE3DI_INERTIA_NOT_POSITIVE = 1, /* a principal moment is negative, or J is not finite */
    SE3DI_INERTIA_NOT_TRIANGLE = 2  /* the largest principal moment exceeds the others' sum */
} se3di_inertia_verdict;

/* The full matrix, row-major. */
void se3di_inertia_matrix(const double J[6], double M[9]);

/* The principal moments, ascending. */
void se3di_inertia_principal(const double J[6], double moments[3]);

/* Principal moments and their axes, the columns of the rotation R, as near to the axes of J as
 * successive turns leave them: J = R diag(moments) R^T. */
void se3di_inertia_axes(const double J[6], double moments[3], double R[9]);

/* An se3di_inertia_verdict: 0 if J is physical up to 1e-9 of its largest moment (NOT a truth
 * value: zero means yes). */
int se3di_inertia_is_physical(const double J[6]);

#endif
