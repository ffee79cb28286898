/* SPDX-License-Identifier: BSD-3-Clause */
/* Products of columns that Householder reflections are made of (linsol/householder.h), at the
 * instruction levels of the processor: the same operations in the same order, the same bits. */
#ifndef SE3DI_LINSOL_MIRRORS_H
#define SE3DI_LINSOL_MIRRORS_H

#include <stddef.h>

typedef struct se3di_mirrors {
    /* a . b, [n] each, in eight partial sums */
    double (*dot)(const double *a, const double *b, size_t n);
    /* x -= tau v v^T x, v = (1, v[1 ..)), where v[1 + i] are zeros for i below `from`, a multiple
     * of eight, and from `to` on: a sum without these is the same to the bit. */
    void (*mirror)(size_t from, size_t to, double tau, const double *v, double *x);
} se3di_mirrors;

const se3di_mirrors *se3di_mirrors_portable(void);
const se3di_mirrors *se3di_mirrors_avx2(void); /* NULL: not here */

#endif
