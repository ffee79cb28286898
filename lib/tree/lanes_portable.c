/* SPDX-License-Identifier: BSD-3-Clause */
/* States one by one, in plain C, where the processor has no lanes.      docs/theory/lanes.md */
#include "math/fma.h"

#include <stdint.h>

typedef double number;
typedef uint64_t integers;
typedef int verdict;

#define FINE                1
#define LANES               1
#define NUMBER(x)           (x)
#define fma_of(a, b, c)     se3di_fma(a, b, c)
#define root_of(a)          sqrt(a)
#define is_far(a)           (!((a) > -1e5 && (a) < 1e5))
#define KEEP_IF(verdict, a) ((verdict) ? (a) : (double)NAN)
#define PICK(verdict, a, b) ((verdict) ? (a) : (b))
#define LARGER(a, b)        ((b) > (a) ? (b) : (a))

#include "tree/lanes.inc"

const se3di_lane_core *se3di_lane_core_portable(void)
{
    return &lane_table;
}
