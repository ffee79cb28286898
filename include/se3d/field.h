/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields of particles on a grid: density, velocity, temperature and stress by coarse-graining.
 * Equations: docs/theory/averages.md.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_FIELD_H
#define SE3D_FIELD_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The numbers of a cell, by the place of the first one. Tensors are {xx, yy, zz, xy, yz, xz},
 * ground frame; stresses are positive where particles press. @since 0.1 */
typedef enum se3d_field_value {
    SE3D_FIELD_DENSITY = 0,         /* of mass [kg/m^3] */
    SE3D_FIELD_SOLID_FRACTION = 1,  /* volume of particles over that of the cell */
    SE3D_FIELD_VELOCITY = 2,        /* 3: momentum over mass, ground frame [m/s]; 0 without mass */
    SE3D_FIELD_TEMPERATURE = 5,     /* granular [m^2/s^2] */
    SE3D_FIELD_KINETIC_STRESS = 6,  /* 6: of velocities about that of the cell [Pa] */
    SE3D_FIELD_CONTACT_STRESS = 12, /* 6: of the forces of the last step [Pa] */
    SE3D_FIELD_VALUES = 18          /* of a cell */
} se3d_field_value;

/* A grid of cells, and how widely a particle is spread over them. @since 0.1 */
typedef struct se3d_field_grid {
    size_t struct_size;
    double lower[3], upper[3]; /* corners of the grid, ground frame [m] */
    int32_t cells[3];          /* their numbers along x, y, z; each >= 1, at most 1e8 together */
    int32_t tag;               /* of the particles that count; default -1: all */
    double width; /* radius about a particle in which it counts (Lucy's kernel) [m] > 0;
                                  one or two diameters of a particle show a continuum */
} se3d_field_grid;

/* Fill a grid with the defaults: see se3d_field_grid_default.
 * @param[in] size  of *grid in bytes
 * @since 0.1 */
SE3D_API void se3d_field_grid_init(se3d_field_grid *grid, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_field_grid se3d_field_grid_default(void)
{
    se3d_field_grid grid;
    se3d_field_grid_init(&grid, sizeof grid);
    return grid;
}

/* Compute the fields of a set at an instant. What is inside is conserved: the sum over the cells of
 * density times volume is the mass of the particles whose centre is in the grid, that of momenta
 * and branches likewise. Along an axis with a period that the grid spans, what leaves it on one
 * side enters on the other. Contacts are those of se3d_particles_get_contacts.
 * @param[in] grid     where
 * @param[in] count    of `values`: the number of cells times SE3D_FIELD_VALUES
 * @param[out] values  [count] numbers by cell, x fastest, then y; of a cell as in se3d_field_value
 * @return OK, NULL, INVALID_ARGUMENT (grid, count), STATE (the system is gone; from within a
 *         callback).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_fields(const se3d_particles *particles,
                                               const se3d_field_grid *grid, size_t count,
                                               double *values);

#ifdef __cplusplus
}
#endif
#endif
