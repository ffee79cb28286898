/* SPDX-License-Identifier: BSD-3-Clause */
/* The slope of a pile that a column leaves behind as it slumps towards +x, on z = 0. */
#ifndef SE3D_TESTS_SUPPORT_PILE_H
#define SE3D_TESTS_SUPPORT_PILE_H

#include "check.h"

#include <math.h>

/* In degrees, of particles of the diameter `d` at r [3 * count]: least squares over the highest of
 * each slice, from the second one to where the pile ends. */
static inline double pile_slope(const double *r, size_t count, double d)
{
    double top[100] = {0.0}, n = 0.0, sx = 0.0, sz = 0.0, sxx = 0.0, sxz = 0.0;
    for (size_t k = 0; k < count; ++k) {
        const double slice = r[3 * k] / d;
        if (slice >= 0.0 && slice < 100.0) {
            double *height = &top[(size_t)slice];
            *height = fmax(*height, r[3 * k + 2]);
        }
    }
    for (int k = 1; k < 100 && top[k] > 1.2 * d; ++k) {
        const double x = ((double)k + 0.5) * d;
        n += 1.0;
        sx += x;
        sz += top[k];
        sxx += x * x;
        sxz += x * top[k];
    }
    CHECK(n >= 4.0);
    return -atan((n * sxz - sx * sz) / (n * sxx - sx * sx)) * 180.0 / 3.14159265358979323846;
}

#endif
