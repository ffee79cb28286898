/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of loops for x86-64 with AVX2 and FMA.      docs/theory/joint_coordinates.md */
#include "tree/loop_core.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

typedef __m256d quad;

#define load(p)             _mm256_loadu_pd(p)
#define store(p, a)         _mm256_storeu_pd(p, a)
#define SPREAD(x)           _mm256_set1_pd(x)
#define FOUR(x, y, z, w)    _mm256_setr_pd(x, y, z, w)
#define add_of(a, b)        _mm256_add_pd(a, b)
#define mul_of(a, b)        _mm256_mul_pd(a, b)
#define fma_of(a, b, c)     _mm256_fmadd_pd(a, b, c)
#define fnma_of(a, b, c)    _mm256_fnmadd_pd(a, b, c)
#define scalar_fma(a, b, c) __builtin_fma(a, b, c)
#define CARRY_TEAM          se3di_loop_carry_team_avx2

static inline void transpose(const quad a[4], quad o[4])
{
    const quad low[2] = {_mm256_unpacklo_pd(a[0], a[1]), _mm256_unpacklo_pd(a[2], a[3])};
    const quad high[2] = {_mm256_unpackhi_pd(a[0], a[1]), _mm256_unpackhi_pd(a[2], a[3])};
    o[0] = _mm256_permute2f128_pd(low[0], low[1], 0x20);
    o[1] = _mm256_permute2f128_pd(high[0], high[1], 0x20);
    o[2] = _mm256_permute2f128_pd(low[0], low[1], 0x31);
    o[3] = _mm256_permute2f128_pd(high[0], high[1], 0x31);
}

#include "tree/loop_core.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_loop_core, se3di_loop_core_avx2, se3di_has_avx2, loop_table)
