/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums of vectors that explicit methods are made of, at the instruction levels of the processor:
 * the same operations number by number, the same bits. */
#ifndef SE3DI_INTEGRATOR_SUMS_H
#define SE3DI_INTEGRATOR_SUMS_H

#include <stddef.h>

typedef struct se3di_sums {
    /* out = base (NULL: 0) + factor_0 part_0 + factor_1 part_1 + ..., [count] each; out may be
     * base */
    void (*combine)(size_t count, int parts, const double *const *part, const double *factor,
                    const double *base, double *out);
    /* out = base + s_0 (row_0 + s_1 (row_1 + s_2 (...))), s_k = factor[k % 2]; row_k at rows + k
     * count */
    void (*nest)(size_t count, int rows, const double *row, const double factor[2],
                 const double *base, double *out);
} se3di_sums;

const se3di_sums *se3di_sums_portable(void);
const se3di_sums *se3di_sums_avx2(void); /* NULL: not here */

#endif
