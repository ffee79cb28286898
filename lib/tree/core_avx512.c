/* SPDX-License-Identifier: BSD-3-Clause */
/* The recursions of the tree for x86-64 with AVX-512.           docs/theory/joint_coordinates.md */
#include "tree/core.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx2,fma"))),        \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,avx2,fma")
#endif

#define fma_of(a, b, c) __builtin_fma(a, b, c)

#include "tree/core.inc"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

const se3di_tree_core *se3di_tree_core_avx512(void)
{
    const int has = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma");
    return has ? &core_table : NULL;
}

#else

const se3di_tree_core *se3di_tree_core_avx512(void)
{
    return NULL;
}

#endif
