/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT kernels for x86-64 with AVX2 and FMA, chosen at run time.          docs/theory/kkt.md */
#include "linsol/kkt_internal.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

typedef struct v8 {
    __m256d low, high;
} v8;

#define V8_INLINE static inline __attribute__((always_inline))

V8_INLINE v8 v8_zero(void)
{
    return (v8){_mm256_setzero_pd(), _mm256_setzero_pd()};
}

V8_INLINE v8 v8_load(const double *p)
{
    return (v8){_mm256_load_pd(p), _mm256_load_pd(p + 4)};
}

V8_INLINE void v8_store(double *p, v8 v)
{
    _mm256_store_pd(p, v.low);
    _mm256_store_pd(p + 4, v.high);
}

/* The first n (a constant) of 8, zeros behind; any alignment. */
V8_INLINE v8 v8_load_part(const int n, const double *p)
{
    const __m256i lane = _mm256_set_epi64x(3, 2, 1, 0);
    const __m256i low = _mm256_cmpgt_epi64(_mm256_set1_epi64x(n), lane);
    const __m256i high = _mm256_cmpgt_epi64(_mm256_set1_epi64x(n - 4), lane);
    v8 v = {_mm256_maskload_pd(p, low), _mm256_setzero_pd()};
    if (n > 4) {
        v.high = _mm256_maskload_pd(p + 4, high);
    }
    return v;
}

/* The larger of acc and |v|, lane by lane. */
V8_INLINE v8 v8_largest(v8 acc, v8 v)
{
    const __m256d sign = _mm256_set1_pd(-0.0);
    return (v8){_mm256_max_pd(_mm256_andnot_pd(sign, v.low), acc.low),
                _mm256_max_pd(_mm256_andnot_pd(sign, v.high), acc.high)};
}

V8_INLINE v8 v8_add(v8 u, v8 v)
{
    return (v8){_mm256_add_pd(u.low, v.low), _mm256_add_pd(u.high, v.high)};
}

V8_INLINE v8 v8_mul(v8 v, double s)
{
    __m256d f = _mm256_set1_pd(s);
    return (v8){_mm256_mul_pd(v.low, f), _mm256_mul_pd(v.high, f)};
}

V8_INLINE v8 v8_fnma(v8 acc, v8 v, double s)
{
    __m256d f = _mm256_set1_pd(s);
    return (v8){_mm256_fnmadd_pd(v.low, f, acc.low), _mm256_fnmadd_pd(v.high, f, acc.high)};
}

V8_INLINE v8 v8_madd(v8 acc, v8 u, v8 v)
{
    return (v8){_mm256_fmadd_pd(u.low, v.low, acc.low), _mm256_fmadd_pd(u.high, v.high, acc.high)};
}

V8_INLINE double v8_sum(v8 v)
{
    __m256d s = _mm256_add_pd(v.low, v.high);
    __m128d t = _mm_add_pd(_mm256_castpd256_pd128(s), _mm256_extractf128_pd(s, 1));
    return _mm_cvtsd_f64(_mm_add_sd(t, _mm_unpackhi_pd(t, t)));
}

V8_INLINE double v8_lane(v8 v, const int r)
{
    const __m256d half = r < 4 ? v.low : v.high;
    const __m128d pair = r % 4 < 2 ? _mm256_castpd256_pd128(half) : _mm256_extractf128_pd(half, 1);
    return _mm_cvtsd_f64(r % 2 == 0 ? pair : _mm_unpackhi_pd(pair, pair));
}

/* Columns 0 .. 3 of the 4 x 4 block whose rows are a, b, c, d. */
V8_INLINE void turn_four(__m256d a, __m256d b, __m256d c, __m256d d, __m256d out[4])
{
    const __m256d ab_even = _mm256_unpacklo_pd(a, b), ab_odd = _mm256_unpackhi_pd(a, b);
    const __m256d cd_even = _mm256_unpacklo_pd(c, d), cd_odd = _mm256_unpackhi_pd(c, d);
    out[0] = _mm256_permute2f128_pd(ab_even, cd_even, 0x20);
    out[1] = _mm256_permute2f128_pd(ab_odd, cd_odd, 0x20);
    out[2] = _mm256_permute2f128_pd(ab_even, cd_even, 0x31);
    out[3] = _mm256_permute2f128_pd(ab_odd, cd_odd, 0x31);
}

V8_INLINE void v8_transpose(v8 v[8])
{
    __m256d first[4], second[4], third[4], fourth[4];
    turn_four(v[0].low, v[1].low, v[2].low, v[3].low, first);
    turn_four(v[4].low, v[5].low, v[6].low, v[7].low, second);
    turn_four(v[0].high, v[1].high, v[2].high, v[3].high, third);
    turn_four(v[4].high, v[5].high, v[6].high, v[7].high, fourth);
    for (int c = 0; c < 4; ++c) {
        v[c] = (v8){first[c], second[c]};
        v[4 + c] = (v8){third[c], fourth[c]};
    }
}

V8_INLINE double s_fnma(double acc, double a, double b)
{
    return __builtin_fma(-a, b, acc);
}

#include "linsol/kkt_core.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_kkt_core, se3di_kkt_core_avx2, se3di_has_avx2, core_table)
