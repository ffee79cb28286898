/* SPDX-License-Identifier: BSD-3-Clause */
/* States one by one, in plain C, where the processor has no lanes.          docs/theory/kkt.md */
#include "linsol/kkt_lanes_internal.h"
#include "math/fma.h"

typedef double number;
typedef int verdict;

#define LANES            1
#define NUMBER(x)        (x)
#define fma_of(a, b, c)  se3di_fma(a, b, c)
#define fnma_of(a, b, c) se3di_fma(-(a), b, c)
#define root_of(a)       sqrt(a)
#define PICK(v, a, b)    ((v) ? (a) : (b))

static inline double largest_of(double a, double b)
{
    b = b < 0.0 ? -b : b;
    return b > a ? b : a;
}

#include "linsol/kkt_lane_core.inc"

const se3di_kkt_lane_core *se3di_kkt_lane_core_portable(void)
{
    return &lane_table;
}
