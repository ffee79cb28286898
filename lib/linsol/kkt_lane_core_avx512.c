/* SPDX-License-Identifier: BSD-3-Clause */
/* Eight states at once for x86-64 with AVX-512.                             docs/theory/kkt.md */
#include "linsol/kkt_lanes_internal.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX512)

typedef double number __attribute__((vector_size(64)));
typedef int64_t verdict __attribute__((vector_size(64)));

#define LANES            8
#define NUMBER(x)        ((number)_mm512_set1_pd(x))
#define fma_of(a, b, c)  ((number)_mm512_fmadd_pd(a, b, c))
#define fnma_of(a, b, c) ((number)_mm512_fnmadd_pd(a, b, c))
#define root_of(a)       ((number)_mm512_sqrt_pd(a))
#define PICK(v, a, b)    ((number)_mm512_mask_blend_pd(_mm512_movepi64_mask((__m512i)(v)), b, a))
#define largest_of(a, b) ((number)_mm512_max_pd(_mm512_abs_pd(b), a))

#include "linsol/kkt_lane_core.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_kkt_lane_core, se3di_kkt_lane_core_avx512, se3di_has_avx512, lane_table)
