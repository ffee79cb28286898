/* SPDX-License-Identifier: BSD-3-Clause */
/* Quotients whose divisor may be zero: hosts may trap divisions by zero, see base/floats.h. */
#ifndef SE3DI_MATH_OVER_H
#define SE3DI_MATH_OVER_H

#include <math.h>

/* a / b to the bit: infinite, or NaN for 0 / 0, if b is zero. */
static inline double se3di_over(double a, double b)
{
    return b != 0.0 ? a / b : a * copysign(HUGE_VAL, b);
}

#endif
