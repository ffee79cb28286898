/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of block_cg.h, compiled for several instruction levels from one source. */
#ifndef SE3DI_LINSOL_BLOCK_CG_CORE_H
#define SE3DI_LINSOL_BLOCK_CG_CORE_H

#include "linsol/block_cg.h"

#define SE3DI_CG_SIZE 6

struct se3di_block_cg_core {
    /* D^-1 of the preconditioner [36 * count], and the couplings' transposes [36 * pair_count] */
    void (*factor)(const se3di_block_matrix *A, double *inverse, double *turned);
    /* out = A x */
    void (*multiply)(const se3di_block_matrix *A, const double *turned, const double *x,
                     double *out);
    /* z = P^-1 r */
    void (*apply)(const se3di_block_matrix *A, const double *inverse, const double *turned,
                  const double *r, double *z);
};

const se3di_block_cg_core *se3di_block_cg_core_portable(void);
const se3di_block_cg_core *se3di_block_cg_core_avx2(void); /* NULL: not here */

static inline size_t se3di_cg_first(const se3di_block_matrix *A, size_t pair)
{
    return (size_t)(A->pairs[2 * pair] - A->first);
}

static inline size_t se3di_cg_second(const se3di_block_matrix *A, size_t pair)
{
    return (size_t)(A->pairs[2 * pair + 1] - A->first);
}

#endif
