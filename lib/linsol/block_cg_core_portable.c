/* SPDX-License-Identifier: BSD-3-Clause */
/* The kernels of conjugate gradients on blocks in plain C.               docs/theory/convex.md */
#include "linsol/block_cg_core.h"

typedef double v2 __attribute__((vector_size(16), aligned(8), may_alias));
typedef struct v6 {
    v2 part[3];
} v6;

static inline v6 v6_load(const double *p)
{
    const v2 *q = (const v2 *)(const void *)p;
    return (v6){{q[0], q[1], q[2]}};
}

static inline void v6_store(double *p, v6 v)
{
    v2 *q = (v2 *)(void *)p;
    q[0] = v.part[0];
    q[1] = v.part[1];
    q[2] = v.part[2];
}

static inline v6 v6_zero(void)
{
    return (v6){{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}};
}

static inline v6 v6_more(v6 acc, v6 v, double s)
{
    const v2 f = {s, s};
    return (v6){
        {acc.part[0] + v.part[0] * f, acc.part[1] + v.part[1] * f, acc.part[2] + v.part[2] * f}};
}

static inline v6 v6_less(v6 acc, v6 v, double s)
{
    const v2 f = {s, s};
    return (v6){
        {acc.part[0] - v.part[0] * f, acc.part[1] - v.part[1] * f, acc.part[2] - v.part[2] * f}};
}

#include "linsol/block_cg_core.inc"

const se3di_block_cg_core *se3di_block_cg_core_portable(void)
{
    return &cg_table;
}
