/* SPDX-License-Identifier: BSD-3-Clause */
/* Symmetric positive definite matrices of 6 x 6 blocks, solved by conjugate gradients:
 *
 *     A = diagonal blocks A_ii, and A_ij, A_ji = A_ij^T for pairs i < j
 *
 * The preconditioner is P = (D + L) D^-1 (D + L^T), L the blocks below the diagonal and D such that
 * P has the diagonal blocks of A,  D_j = A_jj - sum over i < j of A_ij^T D_i^-1 A_ij.  It is A
 * itself where elimination in the order of the blocks fills nothing in: a chain, a stack. A D_j
 * that is not clearly positive is replaced by A_jj, so that P is positive definite always.
 *                                                                        docs/theory/convex.md */
#ifndef SE3DI_LINSOL_BLOCK_CG_H
#define SE3DI_LINSOL_BLOCK_CG_H

#include "base/alloc.h"

typedef struct se3di_block_matrix {
    size_t count, pair_count;
    int32_t first, reserved; /* the number of the first block in `pairs` */
    const int32_t *pairs;    /* [2 * pair_count]: i < j, increasing */
    const double *diagonal;  /* [36 * count], row-major */
    const double *coupling;  /* [36 * pair_count]: A_ij */
} se3di_block_matrix;

typedef struct se3di_block_cg_core se3di_block_cg_core;

typedef struct se3di_block_cg {
    double *work;
    size_t capacity;
    const se3di_block_cg_core *core; /* kernels for this processor */
} se3di_block_cg;

void se3di_block_cg_destroy(se3di_block_cg *cg, const se3d_allocator *allocator);
/* @return OK, NO_MEMORY */
se3d_status se3di_block_cg_reserve(se3di_block_cg *cg, const se3d_allocator *allocator,
                                   size_t count, size_t pair_count);
/* The preconditioner of A, for solutions until the next call. */
void se3di_block_cg_factor(se3di_block_cg *cg, const se3di_block_matrix *A);
/* The same with the D of the last call, for an A that has changed a little since. */
void se3di_block_cg_renew(se3di_block_cg *cg, const se3di_block_matrix *A);
/* x for A x = b, from x = 0, until the residual by P^-1 is `share` of that of b, or after `most`
 * iterations: b . x > 0 in any case, unless b = 0. Returns the iterations. */
int se3di_block_cg_solve(se3di_block_cg *cg, const se3di_block_matrix *A, const double *b,
                         double share, int most, double *x);
/* out += A x */
void se3di_block_cg_add_product(const se3di_block_matrix *A, const double *x, double *out);

#endif
