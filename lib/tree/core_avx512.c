/* SPDX-License-Identifier: BSD-3-Clause */
/* The recursions of the tree for x86-64 with AVX-512.           docs/theory/joint_coordinates.md */
#include "tree/core.h"

#include "base/target.h"
#include "tree/packs.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX512)

#define fma_of(a, b, c) __builtin_fma(a, b, c)
#define PLACE_PACK      se3di_tree_place_pack_avx2
#define SHOW_PACK       se3di_tree_show_pack_avx2
#define FACTOR_PACK     se3di_tree_factor_pack_avx2
#define BEYOND          se3di_tree_beyond_avx2

#include "tree/core_one.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_tree_core, se3di_tree_core_avx512, se3di_has_avx512, core_table)
