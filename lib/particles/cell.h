/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic cells that strain. */
#ifndef SE3DI_PARTICLES_CELL_H
#define SE3DI_PARTICLES_CELL_H

#include "math/vec3.h"
#include "particles/set.h"

static inline int se3di_domain_strains(const se3di_particles *set)
{
    return set->cell.count > 0;
}

/* A map of a vector. */
static inline void se3di_domain_map_eval(const se3di_domain *cell, const se3di_domain_map *map,
                                         const double x[3], double out[3])
{
    const double shear = map->shear * x[cell->gradient];
    for (int a = 0; a < 3; ++a) {
        out[a] = map->along[a] * x[a];
    }
    out[cell->flow] += shear;
}

/* From the centre. */
static inline void se3di_domain_place(const se3di_domain *cell, const double x[3], double out[3])
{
    se3di_sub(x, cell->centre, out);
}

/* The images of the set's cell, for the kernels. */
se3di_strain se3di_domain_images(const se3di_particles *set);
/* Into the cell, with the velocity that it has there. */
void se3di_domain_come_home(const se3di_particles *set, double x[3], double v[3]);
/* Its velocity about the mean, and what strain adds to how fast pairs come nearer, over 2. */
double se3di_domain_speed(const se3di_particles *set, const se3di_particle *particle);
/* How far it is from where strain alone would have brought it since the list was built, and what
 * that leaves less of its reach. */
double se3di_domain_shift(const se3di_particles *set, size_t k);

/* The second half of a step is over: velocities and mean ones are those of its end. */
void se3di_domain_close(se3di_particles *set, double h);
/* Choose the rates of the next step; before its drift. The change of the mean velocities. */
se3di_domain_map se3di_domain_open(se3di_particles *set, double h);
/* What is to be added to the velocities at the end of a step. */
se3di_domain_map se3di_domain_rest(const se3di_particles *set);
/* The drift is over. */
void se3di_domain_drift(se3di_particles *set, double h);
/* The list was built where all are now. */
void se3di_domain_begin_list(se3di_particles *set);

typedef struct se3di_domain_sums {
    double fastest, hasty; /* as of a slab, */
    double kinetic[6];
} se3di_domain_sums;

/* Half a kick of particles [begin, end) with a change of the mean velocities, then the drift. */
void se3di_domain_move(se3di_particles *set, size_t begin, size_t end,
                       const se3di_particle_motion *motion, const se3di_domain_map *change,
                       se3di_domain_sums *sums);
/* Stress at the last step: xx, yy, zz, xy, yz, xz. */
void se3di_domain_stress(const se3di_particles *set, double stress[6]);
double se3di_domain_volume(const se3di_particles *set);

#endif
