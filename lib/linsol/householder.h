/* SPDX-License-Identifier: BSD-3-Clause */
/* QR factorisations by Householder reflections, column-major, with one order of all sums: what is
 * decided on rounding (the rank of redundant rows) is decided alike on every machine, which an
 * optimised BLAS does not promise.
 *
 *     A = H_0 H_1 .. R,   H_k = I - tau_k v v^T,   v = (0 .. 0, 1, A[k + 1 .. m, k])
 *
 *                                                                            docs/theory/kkt.md */
#ifndef SE3DI_LINSOL_HOUSEHOLDER_H
#define SE3DI_LINSOL_HOUSEHOLDER_H

#include <stddef.h>
#include <stdint.h>

/* The reflection I - tau v v^T, v = (1, column[1 .. n)), that turns column[0 .. n) into
 * (beta, 0 ..). @return tau; column becomes (beta, v[1 .. n)) */
double se3di_householder_reflect(size_t n, double *column);

/* x -= tau v v^T x, v = (1, v[1 .. n)) */
void se3di_householder_mirror(size_t n, double tau, const double *v, double *x);

/* A[rows x columns] in place, tau[min(rows, columns)]. */
void se3di_householder(size_t rows, size_t columns, double *A, double *tau);

/* The same of A P, with the longest remaining column first (the first of equals): column k of A P
 * is column pivot[k] of A. work[2 columns] */
void se3di_householder_pivoted(size_t rows, size_t columns, double *A, int32_t *pivot, double *tau,
                               double *work);

/* x = Q x or Q^T x with the first `count` reflections, x[rows]. */
void se3di_householder_apply(size_t rows, size_t count, const double *A, const double *tau,
                             double *x);
void se3di_householder_apply_transposed(size_t rows, size_t count, const double *A,
                                        const double *tau, double *x);

#endif
