/* SPDX-License-Identifier: BSD-3-Clause */
/* The recursions of the tree for x86-64 with AVX2 and FMA. docs/theory/joint_coordinates.md */
#include "tree/core.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#endif

#define fma_of(a, b, c) __builtin_fma(a, b, c)

#include "tree/core.inc"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

const se3di_tree_core *se3di_tree_core_avx2(void)
{
    const int has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    return has ? &core_table : NULL;
}

#else

const se3di_tree_core *se3di_tree_core_avx2(void)
{
    return NULL;
}

#endif
