/* SPDX-License-Identifier: BSD-3-Clause */
/* Four states at once for x86-64 with AVX2 and FMA.                     docs/theory/lanes.md */
#include "tree/lanes.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>
#include <math.h>
#include <stdint.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

typedef double number __attribute__((vector_size(32)));
typedef uint64_t integers __attribute__((vector_size(32)));
typedef int64_t verdict __attribute__((vector_size(32)));

#define FINE             (~(verdict){0})
#define LANES            4
#define NUMBER(x)        ((number)_mm256_set1_pd(x))
#define fma_of(a, b, c)  ((number)_mm256_fmadd_pd(a, b, c))
#define fnma_of(a, b, c) ((number)_mm256_fnmadd_pd(a, b, c))
#define fms_of(a, b, c)  ((number)_mm256_fmsub_pd(a, b, c))
#define root_of(a)       ((number)_mm256_sqrt_pd(a))
#define is_far(a)                                                                                  \
    (_mm256_movemask_pd(_mm256_cmp_pd(_mm256_andnot_pd(_mm256_set1_pd(-0.0), a),                   \
                                      _mm256_set1_pd(1e5), _CMP_LT_OQ)) != 15)
#define KEEP_IF(verdict, a) ((number)((integers)(a) | ~(integers)(verdict)))
#define PICK(verdict, a, b)                                                                        \
    ((number)(((integers)(a) & (integers)(verdict)) | ((integers)(b) & ~(integers)(verdict))))
#define LARGER(a, b) ((number)_mm256_max_pd(b, a)) /* a where one is not a number */

#include "tree/lanes.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_lane_core, se3di_lane_core_avx2, se3di_has_avx2, lane_table)
