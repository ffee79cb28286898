/* SPDX-License-Identifier: BSD-3-Clause */
/* Radii and places, by chance. */
#ifndef SE3DI_PARTICLES_DRAW_H
#define SE3DI_PARTICLES_DRAW_H

#include "math/random.h"
#include "particles/set.h"

/* A radius; a point such that a sphere of that radius is within the box of a
 * region, or, along an axis along which it is flat, its centre; what rounding may take of a length
 * beside a border; whether the region holds it. */
double se3di_radii_draw(const se3di_radii *radii, uint64_t *state);
void se3di_region_draw(const se3di_region *region, double radius, uint64_t *state, double x[3]);
static inline int se3di_region_is_flat(const double lower[3], const double upper[3], int axis)
{
    return !(upper[axis] > lower[axis]);
}
double se3di_region_slack(double border, double size);
int se3di_region_holds(const se3di_region *region, const double x[3], double radius);

#endif
