/* SPDX-License-Identifier: BSD-3-Clause */
/* Eight states at once for x86-64 with AVX-512.                         docs/theory/lanes.md */
#include "tree/lanes.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>
#include <math.h>
#include <stdint.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX512)

typedef double number __attribute__((vector_size(64)));
typedef uint64_t integers __attribute__((vector_size(64)));
typedef int64_t verdict __attribute__((vector_size(64)));

#define FINE                (~(verdict){0})
#define LANES               8
#define NUMBER(x)           ((number)_mm512_set1_pd(x))
#define fma_of(a, b, c)     ((number)_mm512_fmadd_pd(a, b, c))
#define fnma_of(a, b, c)    ((number)_mm512_fnmadd_pd(a, b, c))
#define fms_of(a, b, c)     ((number)_mm512_fmsub_pd(a, b, c))
#define root_of(a)          ((number)_mm512_sqrt_pd(a))
#define within_far(a)       _mm512_cmp_pd_mask(_mm512_abs_pd(a), _mm512_set1_pd(1e5), _CMP_LT_OQ)
#define is_far(a)           (within_far(a) != 255)
#define KEEP_IF(verdict, a) ((number)((integers)(a) | ~(integers)(verdict)))
#define PICK(verdict, a, b)                                                                        \
    ((number)(((integers)(a) & (integers)(verdict)) | ((integers)(b) & ~(integers)(verdict))))
#define LARGER(a, b) ((number)_mm512_max_pd(b, a)) /* a where one is not a number */

#include "tree/lanes.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_lane_core, se3di_lane_core_avx512, se3di_has_avx512, lane_table)
