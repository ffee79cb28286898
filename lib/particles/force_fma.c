/* SPDX-License-Identifier: BSD-3-Clause */
/* The force kernels in plain C for x86-64 with FMA, where fma() is one instruction and not a call:
 * what is chosen if no vectors are wanted.                          docs/theory/particles.md */
#include "particles/wall.h"

#if defined(__x86_64__) && defined(__GNUC__)

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx,fma")
#endif

#include "particles/force_plain.inc"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

const se3di_kernels *se3di_particle_kernels_fma(void)
{
    static const se3di_kernels table = {"fma", pairs, walls};
    return __builtin_cpu_supports("avx") && __builtin_cpu_supports("fma") ? &table : NULL;
}

#else

const se3di_kernels *se3di_particle_kernels_fma(void)
{
    return NULL;
}

#endif
