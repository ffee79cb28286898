/* SPDX-License-Identifier: BSD-3-Clause */
/* What particles are drawn from: radii, places in a region. */

#include "particles/draw.h"

#include <float.h>
#include <math.h>

static double weight_of(const se3di_radii *radii, size_t k)
{
    return radii->weights ? radii->weights[k] : 1.0;
}

double se3di_radii_draw(const se3di_radii *radii, uint64_t *state)
{
    double u = se3di_random_draw(state);
    if (radii->count == 0) {
        return radii->smallest + (radii->largest - radii->smallest) * u;
    }
    double sum = 0.0;
    for (size_t k = 0; k < radii->count; ++k) {
        sum += weight_of(radii, k);
    }
    u *= sum;
    size_t k = 0;
    for (; k + 1 < radii->count && !(u < weight_of(radii, k)); ++k) {
        u -= weight_of(radii, k);
    }
    while (!(weight_of(radii, k) > 0.0)) {
        --k; /* rounding reached behind the last one that occurs */
    }
    return radii->radii[k];
}

void se3di_region_draw(const se3di_region *region, double radius, uint64_t *state, double x[3])
{
    for (int a = 0; a < 3; ++a) {
        const double size = se3di_region_is_flat(region->lower, region->upper, a) ? 0.0 : radius;
        double room = region->upper[a] - region->lower[a] - 2.0 * size;
        x[a] = region->lower[a] + size + room * se3di_random_draw(state);
    }
}

double se3di_region_slack(double border, double size)
{
    return 1e-9 * size + 8.0 * DBL_EPSILON * fabs(border);
}

int se3di_region_holds(const se3di_region *region, const double x[3], double radius)
{
    double square = 0.0;
    double reach = HUGE_VAL;
    double slack = 0.0;
    if (region->kind == SE3D_FILL_REGION_BOX) {
        return 1;
    }
    for (int a = 0; a < 3; ++a) {
        double d = x[a] - 0.5 * (region->lower[a] + region->upper[a]);
        if (region->kind == SE3D_FILL_REGION_SPHERE || a != region->axis) {
            square += d * d;
            reach = fmin(reach, 0.5 * (region->upper[a] - region->lower[a]));
            slack = fmax(slack, se3di_region_slack(region->lower[a], radius));
        }
    }
    return sqrt(square) + radius <= reach * (1.0 + 1e-12) + slack;
}
