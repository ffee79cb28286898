/* SPDX-License-Identifier: BSD-3-Clause */
#include "math/exact.h"

#include <math.h>

#define FIRST 256.0   /* what the first part is a multiple of, */
#define NEXT  0x1p-24 /* and the next ones this much less */

void se3di_exact_add(se3di_exact *sum, double value)
{
    double step = FIRST * 0x1.8p52, rest = value;
    for (int k = 0; k < SE3DI_EXACT_SIZE; ++k, step *= NEXT) {
        const double part = (rest + step) - step;
        sum->part[k] += part;
        rest -= part;
    }
}

void se3di_exact_add_sum(se3di_exact *sum, const se3di_exact *other)
{
    for (int k = 0; k < SE3DI_EXACT_SIZE; ++k) {
        sum->part[k] += other->part[k];
    }
}

/* To parts from 0 to 2^24, but for the first: there is one way only. */
void se3di_exact_carry(se3di_exact *sum)
{
    double unit = FIRST;
    for (int k = 1; k < SE3DI_EXACT_SIZE; ++k) {
        unit *= NEXT;
    }
    for (int k = SE3DI_EXACT_SIZE - 1; k > 0; --k) {
        const double above = unit / NEXT;
        const double carried = above * floor(sum->part[k] / above);
        sum->part[k] -= carried;
        sum->part[k - 1] += carried;
        unit = above;
    }
}

double se3di_exact_get(const se3di_exact *sum)
{
    se3di_exact size = *sum;
    double value = 0.0;
    se3di_exact_carry(&size);
    const double sign = size.part[0] < 0.0 ? -1.0 : 1.0;
    if (sign < 0.0) { /* the size, so that it is rounded to its own last bit */
        for (int k = 0; k < SE3DI_EXACT_SIZE; ++k) {
            size.part[k] = -size.part[k];
        }
        se3di_exact_carry(&size);
    }
    for (int k = SE3DI_EXACT_SIZE - 1; k >= 0; --k) {
        value += size.part[k];
    }
    return sign * value;
}
