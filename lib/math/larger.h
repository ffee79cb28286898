/* SPDX-License-Identifier: BSD-3-Clause */
/* Maxima. Of errors and residuals what is not a number must be seen at their end, and fmax() and
 * comparisons let it go. */
#ifndef SE3DI_LARGER_H
#define SE3DI_LARGER_H

#include <math.h>

/* The larger one; NaN if one is NaN. */
static inline double se3di_larger(double a, double b)
{
    return b <= a || isnan(a) ? a : b;
}

/* The same with what is not a number passed over, as fmax() does, inline; `most` is a number. */
static inline double se3di_raised(double most, double a)
{
    return a > most ? a : most;
}

#endif
