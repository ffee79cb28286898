/* SPDX-License-Identifier: BSD-3-Clause */
/* The first phase of the elementary functions for every machine. */
#include "math/elementary_fast.h"

#if defined(__FP_FAST_FMA)
#define FUSED
#endif
#include "math/elementary_fast.inc"

const se3di_fast se3di_fast_plain = FAST_TABLE;
