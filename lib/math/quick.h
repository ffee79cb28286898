/* SPDX-License-Identifier: BSD-3-Clause */
/* Elementary functions in one phase, within one unit of the last place or 2^-53: for laws whose
 * formulas are fits of measurements. Plain arithmetic in a fixed order, the same bits everywhere,
 * at a quarter of the cost of the correctly rounded ones. Inline, as a law takes some thirty of
 * them: what of sine and cosine is not used is left out.           docs/theory/elementary.md */
#ifndef SE3DI_MATH_QUICK_H
#define SE3DI_MATH_QUICK_H

#include <math.h>

#include "math/elementary.h"
#include "math/elementary_tables.h"

static inline double se3di_quick_nearest(double x) /* |x| < 2^51 */
{
    return (x + 0x1.8p52) - 0x1.8p52;
}

/* As in elementary_fast.inc: a table at t = j/64, and the series of what is beyond it. */
static inline double se3di_quick_atan(double x)
{
    const double size = fabs(x);
    if (!(size < 0x1p50)) {
        return se3di_atan(x); /* NaN, too */
    }
    const int is_steep = size > 1.0;
    const double small = is_steep ? 1.0 / size : size;
    const double k = se3di_quick_nearest(64.0 * small), t = k / 64.0;
    const double z = is_steep ? (1.0 - t * size) / (size + t) : (size - t) / (1.0 + t * size);
    const double s = z * z;
    const double rest = z * s * (1.0 / 3.0 - s * (0.2 - s * (1.0 / 7.0 - s / 9.0)));
    const double *entry = atan_table[(int)k];
    double angle = entry[0] + (z + (entry[1] - rest));
    if (is_steep) {
        angle = half_pi_pair[0] + (half_pi_pair[1] - angle);
    }
    return copysign(angle, x);
}

static inline void se3di_quick_sincos(double x, double *sine, double *cosine)
{
    if (!(fabs(x) < 25.0)) {
        se3di_sincos(x, sine, cosine);
        return;
    }
    const double k = se3di_quick_nearest(x * rate_sin);
    const double r = (x - k * pi_128[0]) - k * pi_128[1], s = r * r;
    const double sr = r - r * s * (1.0 / 6.0 - s * (1.0 / 120.0 - s / 5040.0));
    const double cr = -s * (0.5 - s * (1.0 / 24.0 - s * (1.0 / 720.0 - s / 40320.0)));
    const int n = (int)k, i = n & 63, quadrant = n >> 6 & 3;
    const double *sa = sin_table[i], *ca = sin_table[64 - i];
    const double a = sa[0] + (sa[1] + (ca[0] * sr + sa[0] * cr));
    const double b = ca[0] + (ca[1] + (ca[0] * cr - sa[0] * sr));
    const double turned = quadrant & 1 ? b : a, other = quadrant & 1 ? a : b;
    *sine = quadrant >= 2 ? -turned : turned;
    *cosine = quadrant == 1 || quadrant == 2 ? -other : other;
}

#endif
