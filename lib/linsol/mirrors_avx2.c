/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/mirrors.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

#define WIDTH 4
#include "linsol/mirrors.inc"

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_mirrors, se3di_mirrors_avx2, se3di_has_avx2, table)
