/* SPDX-License-Identifier: BSD-3-Clause */
/* Dense eigenvalue problems, by LAPACK with the caller's allocator. */
#ifndef SE3DI_LINSOL_EIGEN_H
#define SE3DI_LINSOL_EIGEN_H

#include "base/alloc.h"

/* Eigenvalues w [n], ascending, of the symmetric A [n n]; A is overwritten by the eigenvectors, one
 * a row. @return OK, NO_MEMORY, NOT_FINITE, NO_CONVERGENCE */
se3d_status se3di_symmetric_eigen(const se3d_allocator *allocator, int32_t n, double *A, double *w);

/* Eigenvalues (re, im, [n]) of A x = s B x, A and B [n n] row-major (destroyed); the right
 * eigenvectors are the rows of V [n n], those of a conjugate pair as real and imaginary part. An
 * infinite eigenvalue is infinite in `re`. @return as above */
se3d_status se3di_general_eigen(const se3d_allocator *allocator, int32_t n, double *A, double *B,
                                double *re, double *im, double *V);

#endif
