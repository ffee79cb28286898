/* SPDX-License-Identifier: BSD-3-Clause */
/* The kernels of conjugate gradients on blocks for x86-64 with AVX2.     docs/theory/convex.md */
#include "linsol/block_cg_core.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

typedef struct v6 {
    __m256d first;
    __m128d last;
} v6;

static inline v6 v6_load(const double *p)
{
    return (v6){_mm256_loadu_pd(p), _mm_loadu_pd(p + 4)};
}

static inline void v6_store(double *p, v6 v)
{
    _mm256_storeu_pd(p, v.first);
    _mm_storeu_pd(p + 4, v.last);
}

static inline v6 v6_zero(void)
{
    return (v6){_mm256_setzero_pd(), _mm_setzero_pd()};
}

static inline v6 v6_more(v6 acc, v6 v, double s)
{
    const __m256d f = _mm256_set1_pd(s);
    return (v6){_mm256_add_pd(acc.first, _mm256_mul_pd(v.first, f)),
                _mm_add_pd(acc.last, _mm_mul_pd(v.last, _mm256_castpd256_pd128(f)))};
}

static inline v6 v6_less(v6 acc, v6 v, double s)
{
    const __m256d f = _mm256_set1_pd(s);
    return (v6){_mm256_sub_pd(acc.first, _mm256_mul_pd(v.first, f)),
                _mm_sub_pd(acc.last, _mm_mul_pd(v.last, _mm256_castpd256_pd128(f)))};
}

#include "linsol/block_cg_core.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_block_cg_core, se3di_block_cg_core_avx2, se3di_has_avx2, cg_table)
