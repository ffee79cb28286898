/* SPDX-License-Identifier: BSD-3-Clause */
/* The first phase of the elementary functions for x86-64 with FMA, chosen at run time. */
#include "math/elementary_fast.h"

#if defined(SE3DI_FAST_CHOICE)

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx,fma")
#endif

#define FUSED
#include "math/elementary_fast.inc"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

const se3di_fast se3di_fast_fused = FAST_TABLE;

#endif
