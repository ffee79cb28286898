/* SPDX-License-Identifier: BSD-3-Clause */
/* a b + c, rounded once. The function of the C library is right nearly everywhere, and one
 * instruction where there is one; that of mingw-w64 rounds twice. */
#ifndef SE3DI_MATH_FMA_H
#define SE3DI_MATH_FMA_H

#include <math.h>

/* The same with integers. */
double se3di_fma_by_integers(double a, double b, double c);

static inline double se3di_fma(double a, double b, double c)
{
#if defined(_WIN32) && !defined(__FMA__)
    return se3di_fma_by_integers(a, b, c);
#else
    return fma(a, b, c);
#endif
}

#endif
