/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT kernels in plain C. se3di_fma stands where the other levels fuse, so that all give the
 * same bits; it is one instruction on arm64.                                 docs/theory/kkt.md */
#include "linsol/kkt_internal.h"
#include "math/fma.h"

typedef double v2 __attribute__((vector_size(16)));
typedef double v2_anywhere __attribute__((vector_size(16), aligned(8), may_alias));
typedef int64_t i2 __attribute__((vector_size(16)));
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

V8_INLINE v2 v2_load_part(const int n, const double *p)
{
    if (n >= 2) {
        return *(const v2_anywhere *)(const void *)p;
    }
    return (v2){n > 0 ? p[0] : 0.0, 0.0};
}

/* The first n (a constant) of 8, zeros behind; any alignment. */
V8_INLINE v8 v8_load_part(const int n, const double *p)
{
    return (v8){{v2_load_part(n, p), v2_load_part(n - 2, p + 2), v2_load_part(n - 4, p + 4),
                 v2_load_part(n - 6, p + 6)}};
}

V8_INLINE v2 v2_largest(v2 acc, v2 v)
{
    const i2 magnitude = {INT64_MAX, INT64_MAX};
    v2 size = (v2)((i2)v & magnitude);
    i2 is_larger = size > acc;
    return (v2)((is_larger & (i2)size) | (~is_larger & (i2)acc));
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

V8_INLINE v2 v2_fma(v2 a, v2 b, v2 c)
{
    return (v2){se3di_fma(a[0], b[0], c[0]), se3di_fma(a[1], b[1], c[1])};
}

V8_INLINE v8 v8_madd(v8 acc, v8 u, v8 v)
{
    return (v8){
        {v2_fma(u.part[0], v.part[0], acc.part[0]), v2_fma(u.part[1], v.part[1], acc.part[1]),
         v2_fma(u.part[2], v.part[2], acc.part[2]), v2_fma(u.part[3], v.part[3], acc.part[3])}};
}

V8_INLINE v8 v8_fnma(v8 acc, v8 v, double s)
{
    v2 f = {-s, -s};
    return v8_madd(acc, v, (v8){{f, f, f, f}});
}

V8_INLINE double v8_sum(v8 v)
{
    v2 s = (v.part[0] + v.part[2]) + (v.part[1] + v.part[3]);
    return s[0] + s[1];
}

V8_INLINE double v8_lane(v8 v, const int r)
{
    return v.part[r / 2][r % 2];
}

V8_INLINE void v8_transpose(v8 v[8])
{
    v8 t[8];
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) {
            v2 a = v[2 * r].part[c], b = v[2 * r + 1].part[c];
            t[2 * c].part[r] = (v2){a[0], b[0]};
            t[2 * c + 1].part[r] = (v2){a[1], b[1]};
        }
    }
    for (int c = 0; c < 8; ++c) {
        v[c] = t[c];
    }
}

V8_INLINE double s_fnma(double acc, double a, double b)
{
    return se3di_fma(-a, b, acc);
}

#include "linsol/kkt_core.inc"

const se3di_kkt_core *se3di_kkt_core_portable(void)
{
    return &core_table;
}
