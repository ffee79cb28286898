/* SPDX-License-Identifier: BSD-3-Clause */
/* Regions filled with particles: a lattice, or places at random without overlaps. The definitions
 * are checked; the set has room. */
#ifndef SE3DI_PARTICLES_FILL_H
#define SE3DI_PARTICLES_FILL_H

#include "particles/set.h"
#include "se3d/particles.h"

/* What a definition says of radii and region. */
se3di_radii se3di_fill_radii(const se3d_fill_def *def);
se3di_region se3di_fill_region(const se3d_fill_def *def);

/* The points of a lattice over the box from lower to upper: they may be too many to look at. */
double se3di_lattice_count(const se3d_fill_def *def);
/* How many particles the lattice gives, and of how many points that come first. */
size_t se3di_lattice_measure(const se3d_fill_def *def, size_t *points);
/* Add them. */
void se3di_lattice_fill(se3di_particles *set, const se3d_fill_def *def, uint32_t material,
                        size_t points);

/* More particles than this have more volume than the box of the region. */
double se3di_fill_most(const se3di_particles *set, const se3d_fill_def *def);
/* Add def->count particles where there is room for them. If one finds none, nothing changes and
 * *placed is how many did. @return OK, NO_MEMORY, NO_CONVERGENCE */
se3d_status se3di_random_fill(se3di_particles *set, const se3d_fill_def *def, uint32_t material,
                              size_t *placed);

#endif
