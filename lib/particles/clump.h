/* SPDX-License-Identifier: BSD-3-Clause */
/* Clumps: rigid bodies of several spheres. The spheres are particles of the set, for lists,
 * contacts and walls; what acts on them moves their clump, which places them.
 *                                                                       docs/theory/clumps.md */
#ifndef SE3DI_PARTICLES_CLUMP_H
#define SE3DI_PARTICLES_CLUMP_H

#include "particles/set.h"

#define SE3DI_CLUMP_LANES 8 /* clumps that the kernels move side by side */

/* clump_mass.c: what a template's balls (r in the frame of the definition) weigh together: fills
 * volume, centre, mass, inertia and axes for density 1, and turns the balls into the principal
 * axes. With `given`, mass, centre and J {xx, yy, zz, xy, yz, xz} are those that the template has.
 * @return OK, NO_MEMORY, INVALID_ARGUMENT (no moment of inertia about some axis) */
se3d_status se3di_clump_weigh(const se3d_allocator *allocator, se3di_clump_template *out,
                              se3di_clump_ball *balls, const double J[6]);

/* Append a template, whose balls are [out->count]. */
se3d_status se3di_clumps_add_template(se3di_particles *set, const se3di_clump_template *out,
                                      const se3di_clump_ball *balls);
/* Room for `ids` particles in all, and `count` clumps more. */
se3d_status se3di_clumps_reserve(se3di_particles *set, size_t ids, size_t count);

/* Drop clumps whose spheres are gone. */
void se3di_clumps_filter(se3di_particles *set);
/* Make clump_of anew. Returns 0 if the clumps do not name live spheres, each once. */
int se3di_clumps_index(se3di_particles *set);
/* Orientation of the frame of the definition, and angular velocity (ground frame). */
void se3di_clump_get(const se3di_particles *set, const se3di_clump *clump, double q[4],
                     double w[3]);
/* New ones, which A follows; the spheres do not yet. NULL: that stays. */
void se3di_clump_set(const se3di_particles *set, se3di_clump *clump, const double *q,
                     const double *w);
/* Give the spheres of a clump their velocities, and with `poses` their places. */
void se3di_clump_place(se3di_particles *set, const se3di_clump *clump, int poses);
/* Kinetic energies of translation and rotation. */
void se3di_clump_energy(const se3di_particles *set, const se3di_clump *clump, double energy[2]);

/* clump_motion.c: what the contacts of its spheres do to a clump: force, torque about the centre of
 * mass (ground frame), in the order of the spheres. */
void se3di_clump_loads(const se3di_particles *set, const se3di_clump *clump, double force[3],
                       double torque[3]);
/* What a unit force along n moves the particle of this id by, if it is of a clump; else `alone`. */
double se3di_clump_mobility(const se3di_particles *set, uint32_t id, const double n[3],
                            double alone);

/* The clump of particle k, NULL: it is a free sphere. */
static inline const se3di_clump *se3di_clump_find(const se3di_particles *set, size_t k)
{
    uint32_t clump = SE3DI_NO_INDEX;
    if (set->clump_count > 0) {
        clump = set->clump_of[set->spins[k].id];
    }
    return clump == SE3DI_NO_INDEX ? NULL : &set->clumps[clump];
}

/* The ids of all spheres that are one body with that of `id`: [first, end). */
static inline void se3di_clump_range(const se3di_particles *set, uint32_t id, uint32_t *first,
                                     uint32_t *end)
{
    const se3di_clump *clump = se3di_clump_find(set, set->index_of[id]);
    *first = clump ? clump->first : id;
    *end = clump ? clump->first + set->templates[clump->template_index].count : id + 1;
}

/* The mass of a clump. */
static inline double se3di_clump_mass(const se3di_particles *set, const se3di_clump *clump)
{
    return clump->factor * set->templates[clump->template_index].mass;
}

#endif
