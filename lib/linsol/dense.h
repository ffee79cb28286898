/* SPDX-License-Identifier: BSD-3-Clause */
/* Small dense linear algebra on row-major arrays of the caller, without allocation.
 *
 * Own loops, whose bits do not depend on any library or its threads. */
#ifndef SE3DI_LINSOL_DENSE_H
#define SE3DI_LINSOL_DENSE_H

#include "se3d/base.h"

/* P A = L U in place, row pivoting. pivot[n]. Returns SE3D_ERR_SINGULAR if a pivot is zero,
 * SE3D_ERR_NOT_FINITE if A is not finite. */
se3d_status se3di_dense_lu_factor(int32_t n, double *A, int32_t *pivot);
/* Overwrite b[n] by A^-1 b. */
void se3di_dense_lu_solve(int32_t n, const double *A, const int32_t *pivot, double *b);

/* A = L L^T in place (lower triangle; the upper is not touched). SE3D_ERR_SINGULAR if A is not
 * positive definite. */
se3d_status se3di_dense_cholesky_factor(int32_t n, double *A);

#endif
