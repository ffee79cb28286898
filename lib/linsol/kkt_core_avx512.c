/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT kernels for x86-64 with AVX-512, chosen at run time.          docs/theory/kkt.md */
#include "linsol/kkt_internal.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx2,fma"))),        \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,avx2,fma")
#endif

typedef __m512d v8;

#define V8_INLINE static inline __attribute__((always_inline))

V8_INLINE v8 v8_zero(void)
{
    return _mm512_setzero_pd();
}

V8_INLINE v8 v8_load(const double *p)
{
    return _mm512_load_pd(p);
}

V8_INLINE void v8_store(double *p, v8 v)
{
    _mm512_store_pd(p, v);
}

/* The first n (a constant) of 8, zeros behind; any alignment. */
V8_INLINE v8 v8_load_part(const int n, const double *p)
{
    return _mm512_maskz_loadu_pd((__mmask8)((1 << n) - 1), p);
}

/* The larger of acc and |v|, lane by lane. */
V8_INLINE v8 v8_largest(v8 acc, v8 v)
{
    return _mm512_max_pd(_mm512_abs_pd(v), acc);
}

V8_INLINE v8 v8_add(v8 u, v8 v)
{
    return _mm512_add_pd(u, v);
}

V8_INLINE v8 v8_mul(v8 v, double s)
{
    return _mm512_mul_pd(v, _mm512_set1_pd(s));
}

V8_INLINE v8 v8_fnma(v8 acc, v8 v, double s)
{
    return _mm512_fnmadd_pd(v, _mm512_set1_pd(s), acc);
}

V8_INLINE v8 v8_madd(v8 acc, v8 u, v8 v)
{
    return _mm512_fmadd_pd(u, v, acc);
}

V8_INLINE double v8_sum(v8 v)
{
    __m256d s = _mm256_add_pd(_mm512_castpd512_pd256(v), _mm512_extractf64x4_pd(v, 1));
    __m128d t = _mm_add_pd(_mm256_castpd256_pd128(s), _mm256_extractf128_pd(s, 1));
    return _mm_cvtsd_f64(_mm_add_sd(t, _mm_unpackhi_pd(t, t)));
}

V8_INLINE double v8_lane(v8 v, const int r)
{
    return _mm512_cvtsd_f64(_mm512_permutexvar_pd(_mm512_set1_epi64(r), v));
}

V8_INLINE double s_fnma(double acc, double a, double b)
{
    return __builtin_fma(-a, b, acc);
}

#include "linsol/kkt_core.inc"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

const se3di_kkt_core *se3di_kkt_core_avx512(void)
{
    bool has = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma");
    return has ? &core_table : NULL;
}

#else

const se3di_kkt_core *se3di_kkt_core_avx512(void)
{
    return NULL;
}

#endif
