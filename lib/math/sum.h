/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums in two parts (Neumaier 1974): what is lost of each term is kept apart. */
#ifndef SE3DI_MATH_SUM_H
#define SE3DI_MATH_SUM_H

typedef struct se3di_sum {
    double high, low;
} se3di_sum;

static inline void se3di_sum_add(se3di_sum *s, double x)
{
    const double total = s->high + x;
    const double part = total - s->high;
    s->low += (s->high - (total - part)) + (x - part);
    s->high = total;
}

#endif
