/* SPDX-License-Identifier: BSD-3-Clause */
/* Energies of particles and what there is of them. Sums go by id, so that they do not depend on the
 * order in memory. */
#ifndef SE3DI_PARTICLES_ENERGY_H
#define SE3DI_PARTICLES_ENERGY_H

#include "particles/set.h"

/* The index of the next live particle at or after *id, which then names the one behind it. */
static inline size_t se3di_particles_next(const se3di_particles *set, size_t *id)
{
    while (set->index_of[*id] == SE3DI_NO_INDEX) {
        ++*id;
    }
    return set->index_of[(*id)++];
}

/* Of all particles [J]: kinetic ones of translation and rotation, potential one of gravity g. */
se3d_particles_energy se3di_particles_energy(const se3di_particles *set, const double g[3]);
/* What there is of a tag; its energy is the sum of the three, its kinetic one of the first two. */
se3d_particles_tally se3di_particles_tally(const se3di_particles *set, uint32_t tag,
                                           const double g[3]);
/* Counts since the set was made. */
se3d_particles_stats se3di_particles_stats(const se3di_particles *set);
/* What the walls of a body, or the shape, get: added to force and torque (ground frame). */
void se3di_particles_push_body(const se3di_particles *set, se3di_handle body, double force[3],
                               double torque[3]);
void se3di_particles_push_shape(const se3di_particles *set, se3di_handle shape, double force[3],
                                double torque[3]);

#endif
