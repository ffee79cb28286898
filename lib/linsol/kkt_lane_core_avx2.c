/* SPDX-License-Identifier: BSD-3-Clause */
/* Four states at once for x86-64 with AVX2 and FMA.                         docs/theory/kkt.md */
#include "linsol/kkt_lanes_internal.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

typedef double number __attribute__((vector_size(32)));
typedef int64_t verdict __attribute__((vector_size(32)));

#define LANES            4
#define NUMBER(x)        ((number)_mm256_set1_pd(x))
#define fma_of(a, b, c)  ((number)_mm256_fmadd_pd(a, b, c))
#define fnma_of(a, b, c) ((number)_mm256_fnmadd_pd(a, b, c))
#define root_of(a)       ((number)_mm256_sqrt_pd(a))
#define PICK(v, a, b)    ((number)_mm256_blendv_pd(b, a, (__m256d)(v)))
#define largest_of(a, b) ((number)_mm256_max_pd(_mm256_andnot_pd(_mm256_set1_pd(-0.0), b), a))

#include "linsol/kkt_lane_core.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_kkt_lane_core, se3di_kkt_lane_core_avx2, se3di_has_avx2, lane_table)
