/* SPDX-License-Identifier: BSD-3-Clause */
/* The first phase of the elementary functions for x86-64 with FMA, chosen at run time. */
#include "math/elementary_fast.h"

#include "base/target.h"

#if defined(SE3DI_FAST_CHOICE)

SE3DI_TARGET_BEGIN(SE3DI_TARGET_FMA)

#define FUSED
#include "math/elementary_fast.inc"

SE3DI_TARGET_END

const se3di_fast se3di_fast_fused = FAST_TABLE;

#endif
