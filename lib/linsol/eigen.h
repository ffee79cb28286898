/* SPDX-License-Identifier: BSD-3-Clause */
/* Dense eigenvalue problems, with one order of all sums: the same bits on every machine.
 *                                                                          docs/theory/modes.md */
#ifndef SE3DI_LINSOL_EIGEN_H
#define SE3DI_LINSOL_EIGEN_H

#include "base/alloc.h"

/* Eigenvalues w [n], ascending, of the symmetric A [n n] (its lower triangle is read); A is
 * overwritten by the orthonormal eigenvectors, one a row. Householder reflections to tridiagonal
 * form, then implicit QR steps with Wilkinson's shift (Golub, Van Loan 2013, 8.3).
 * @return OK, NO_MEMORY, NOT_FINITE, NO_CONVERGENCE */
se3d_status se3di_symmetric_eigen(const se3d_allocator *allocator, int32_t n, double *A, double *w);

/* Eigenvalues (re, im, [n]) of A [n n], row-major (destroyed); the right eigenvectors are the rows
 * of V [n n], the largest component |re| + |im| of each is 1. A conjugate pair stands in two
 * consecutive places, the one with im > 0 first; its rows are the real and the imaginary part.
 * Balancing, Hessenberg form, Francis steps with double shifts to the real Schur form, back
 * substitution (Golub, Van Loan 2013, 7.4-7.6). @return as above */
se3d_status se3di_general_eigen(const se3d_allocator *allocator, int32_t n, double *A, double *re,
                                double *im, double *V);

#endif
