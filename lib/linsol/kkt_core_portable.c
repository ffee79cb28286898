/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT kernels in plain C: the same bits on every machine (built with -ffp-contract=off).
 *                                                                            docs/theory/kkt.md */
#include "linsol/kkt_internal.h"

typedef double v2 __attribute__((vector_size(16)));
typedef struct v8 {
    v2 part[4];
} v8;

#define V8_INLINE static inline __attribute__((always_inline))

V8_INLINE v8 v8_zero(void)
{
    return (v8){{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}};
}

V8_INLINE v8 v8_load(const double *p)
{
    const v2 *q = (const v2 *)(const void *)p;
    return (v8){{q[0], q[1], q[2], q[3]}};
}

V8_INLINE void v8_store(double *p, v8 v)
{
    v2 *q = (v2 *)(void *)p;
    q[0] = v.part[0];
    q[1] = v.part[1];
    q[2] = v.part[2];
    q[3] = v.part[3];
}

/* The first n (a constant) of 8, zeros behind; any alignment. */
V8_INLINE v8 v8_load_part(const int n, const double *p)
{
    return (v8){{{p[0], n > 1 ? p[1] : 0.0},
                 {n > 2 ? p[2] : 0.0, n > 3 ? p[3] : 0.0},
                 {n > 4 ? p[4] : 0.0, n > 5 ? p[5] : 0.0},
                 {n > 6 ? p[6] : 0.0, n > 7 ? p[7] : 0.0}}};
}

V8_INLINE v2 v2_largest(v2 acc, v2 v)
{
    double a = v[0] < 0.0 ? -v[0] : v[0], b = v[1] < 0.0 ? -v[1] : v[1];
    return (v2){a > acc[0] ? a : acc[0], b > acc[1] ? b : acc[1]};
}

/* The larger of acc and |v|, lane by lane. */
V8_INLINE v8 v8_largest(v8 acc, v8 v)
{
    return (v8){{v2_largest(acc.part[0], v.part[0]), v2_largest(acc.part[1], v.part[1]),
                 v2_largest(acc.part[2], v.part[2]), v2_largest(acc.part[3], v.part[3])}};
}

V8_INLINE v8 v8_add(v8 u, v8 v)
{
    return (v8){{u.part[0] + v.part[0], u.part[1] + v.part[1], u.part[2] + v.part[2],
                 u.part[3] + v.part[3]}};
}

V8_INLINE v8 v8_mul(v8 v, double s)
{
    v2 f = {s, s};
    return (v8){{v.part[0] * f, v.part[1] * f, v.part[2] * f, v.part[3] * f}};
}

V8_INLINE v8 v8_fnma(v8 acc, v8 v, double s)
{
    v2 f = {s, s};
    return (v8){{acc.part[0] - v.part[0] * f, acc.part[1] - v.part[1] * f,
                 acc.part[2] - v.part[2] * f, acc.part[3] - v.part[3] * f}};
}

V8_INLINE v8 v8_madd(v8 acc, v8 u, v8 v)
{
    return (v8){{acc.part[0] + u.part[0] * v.part[0], acc.part[1] + u.part[1] * v.part[1],
                 acc.part[2] + u.part[2] * v.part[2], acc.part[3] + u.part[3] * v.part[3]}};
}

V8_INLINE double v8_sum(v8 v)
{
    v2 s = (v.part[0] + v.part[2]) + (v.part[1] + v.part[3]);
    return s[0] + s[1];
}

V8_INLINE double s_fnma(double acc, double a, double b)
{
    return acc - a * b;
}

#include "linsol/kkt_core.inc"

const se3di_kkt_core *se3di_kkt_core_portable(void)
{
    return &core_table;
}
