/* SPDX-License-Identifier: BSD-3-Clause */
/* Bonds: elastic beams between spheres, or from a sphere to a wall, that may break.
 *                                                                        docs/theory/bonds.md */
#ifndef SE3DI_PARTICLES_BOND_H
#define SE3DI_PARTICLES_BOND_H

#include "particles/set.h"

/* Room for `count` bonds more, and a group. */
se3d_status se3di_bonds_reserve(se3di_particles *set, size_t count);
/* Append a bond that holds nothing yet, along `way` from its first end to the second; room must
 * have been reserved, and se3di_bonds_index follows. The ends are spheres (ids) or, `second`
 * SE3DI_NO_INDEX, the point x of a wall. */
typedef struct se3di_bond_place {
    uint32_t first, second;
    uint32_t wall;
    double x[3]; /* of the wall, ground frame */
    double way[3];
} se3di_bond_place;
void se3di_bonds_append(se3di_particles *set, const se3di_bond_place *place,
                        const se3di_bond *like);

/* Who is bonded to whom, anew. Returns 0 if bonds name no live ends. */
int se3di_bonds_index(se3di_particles *set);
/* Drop the bonds of particles that are gone. */
void se3di_bonds_filter(se3di_particles *set);
/* Find the walls of the ends in the set's new ones, and drop the bonds of those that are gone. */
void se3di_bonds_find_walls(se3di_particles *set);
/* Count a bond that is gone with its group. */
void se3di_bonds_count(se3di_particles *set, const se3di_bond *bond);
/* Take out those that do not hold any more; the ends stay. */
void se3di_bonds_keep(se3di_particles *set);
/* End -> ground: how the sphere has turned, its clump or the wall. */
void se3di_bond_end_turn(const se3di_particles *set, const se3di_bond_end *end, double q[4]);
/* Whether particles i and j are bonded so that they do not touch. */
int se3di_bonds_part(const se3di_particles *set, uint32_t i, uint32_t j);
/* The same of particle i and a wall. */
int se3di_bonds_part_wall(const se3di_particles *set, uint32_t i, uint32_t wall);
/* Whether a bond holds the two ids together. */
int se3di_bonds_join(const se3di_particles *set, uint32_t i, uint32_t j);

/* bond_motion.c: what bonds do to their ends, added to the loads; with h > 0 some break. */
void se3di_bonds_forces(se3di_particles *set, double h);
/* The same for walls: after their sums, or, of a set that is spread, added to the exact ones. */
void se3di_bonds_push_walls(se3di_particles *set);
/* The forces are complete: those that broke go. */
void se3di_bonds_finish(se3di_particles *set);
/* The spheres have moved on for h: their turns. */
void se3di_bonds_turn(se3di_particles *set, double h);
/* A step in which no motion on bonds is more than a fifth of what is stable; infinite without. */
double se3di_bonds_step(const se3di_particles *set);
/* Mass and moment of inertia of what an end is on; 0: a wall. */
void se3di_bond_end_mass(const se3di_particles *set, const se3di_bond_end *end, double *mass,
                         double *inertia);
/* Dampers by the masses that the ends have now: of a bond, and of those of an id. */
void se3di_bond_damp(const se3di_particles *set, se3di_bond *bond);
void se3di_bonds_damp(se3di_particles *set, uint32_t id);

#define SE3DI_BONDS_STABLE 5.0 /* of the steps above */

#endif
