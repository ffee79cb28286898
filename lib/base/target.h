/* SPDX-License-Identifier: BSD-3-Clause */
/* Code for x86-64 processors with more than the baseline, in a binary for all: what stands between
 * SE3DI_TARGET_BEGIN(features) and SE3DI_TARGET_END may use them, and is called only where
 * se3di_has_avx2 or se3di_has_avx512 say so. Without SE3DI_TARGETS there is no such code.
 * SE3DI_TARGET_FINDER(type, finder, has, table) defines the function through which a file with such
 * code shows its table: NULL if the processor has() not what it needs, or there is no such code. */
#ifndef SE3DI_BASE_TARGET_H
#define SE3DI_BASE_TARGET_H

#include <stddef.h>

#if defined(__x86_64__) && defined(__GNUC__)

#define SE3DI_TARGETS
#if defined(__has_feature)
#if __has_feature(memory_sanitizer) /* which does not know what some instructions leave unset */
#undef SE3DI_TARGETS
#endif
#endif

#define SE3DI_PRAGMA_TEXT(text) _Pragma(#text)
#define SE3DI_PRAGMA(text)      SE3DI_PRAGMA_TEXT(text)
#if defined(__clang__)
#define SE3DI_TARGET_BEGIN(features)                                                               \
    SE3DI_PRAGMA(clang attribute push(__attribute__((target(features))), apply_to = function))
#define SE3DI_TARGET_END SE3DI_PRAGMA(clang attribute pop)
#else
#define SE3DI_TARGET_BEGIN(features)                                                               \
    SE3DI_PRAGMA(GCC push_options) SE3DI_PRAGMA(GCC target(features))
#define SE3DI_TARGET_END SE3DI_PRAGMA(GCC pop_options)
#endif

#define SE3DI_TARGET_FMA    "avx,fma"
#define SE3DI_TARGET_AVX2   "avx2,fma"
#define SE3DI_TARGET_AVX512 "avx512f,avx512vl,avx512dq,avx2,fma"

static inline int se3di_has_fma(void)
{
    return __builtin_cpu_supports("avx") && __builtin_cpu_supports("fma");
}

static inline int se3di_has_avx2(void)
{
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

static inline int se3di_has_avx512(void)
{
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma");
}

#endif

#if defined(SE3DI_TARGETS)

#define SE3DI_TARGET_FINDER(type, finder, has, table)                                              \
    const type *finder(void)                                                                       \
    {                                                                                              \
        return has() ? &(table) : NULL;                                                            \
    }

#else

#define SE3DI_TARGET_FINDER(type, finder, has, table)                                              \
    const type *finder(void)                                                                       \
    {                                                                                              \
        return NULL;                                                                               \
    }

#endif
#endif
