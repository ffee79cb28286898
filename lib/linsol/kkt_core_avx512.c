/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT kernels for x86-64 with AVX-512, chosen at run time.          docs/theory/kkt.md */
#include "linsol/kkt_internal.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX512)

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

V8_INLINE void v8_transpose(v8 v[8])
{
    v8 pair[8], four[8];
    for (int r = 0; r < 8; r += 2) { /* columns 0 2 4 6 and 1 3 5 7 of two rows */
        pair[r] = _mm512_unpacklo_pd(v[r], v[r + 1]);
        pair[r + 1] = _mm512_unpackhi_pd(v[r], v[r + 1]);
    }
    for (int c = 0; c < 2; ++c) { /* columns (0 4) and (2 6) of four rows, and so on */
        four[c] = _mm512_shuffle_f64x2(pair[c], pair[2 + c], 0x88);
        four[2 + c] = _mm512_shuffle_f64x2(pair[c], pair[2 + c], 0xDD);
        four[4 + c] = _mm512_shuffle_f64x2(pair[4 + c], pair[6 + c], 0x88);
        four[6 + c] = _mm512_shuffle_f64x2(pair[4 + c], pair[6 + c], 0xDD);
    }
    for (int c = 0; c < 4; ++c) {
        v[c] = _mm512_shuffle_f64x2(four[c], four[4 + c], 0x88);
        v[4 + c] = _mm512_shuffle_f64x2(four[c], four[4 + c], 0xDD);
    }
}

V8_INLINE double s_fnma(double acc, double a, double b)
{
    return __builtin_fma(-a, b, acc);
}

#include "linsol/kkt_core.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_kkt_core, se3di_kkt_core_avx512, se3di_has_avx512, core_table)
