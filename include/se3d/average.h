/* SPDX-License-Identifier: BSD-3-Clause */
/* Averages over the particles in a box: how densely they lie, how they move, how they press.
 * Equations: docs/theory/averages.md.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_AVERAGE_H
#define SE3D_AVERAGE_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Averages. A clump is one particle, at its centre of mass. Tensors are {xx, yy, zz, xy, yz, xz},
 * ground frame; stresses are positive where particles press. @since 0.1 */
typedef struct se3d_average {
    uint64_t count;           /* of particles whose centre is in the box */
    double mass;              /* of these [kg] */
    double solid_fraction;    /* volume of spheres over that of the box >= 0; what of a sphere is
                                 outside does not count */
    double coordination;      /* contacts of a particle, in the mean >= 0; walls count, too */
    double velocity[3];       /* in the mean by mass, ground frame [m/s] */
    double mass_flux[3];      /* mass times velocity over the volume of the box [kg/m^2/s] */
    double temperature;       /* granular: a third of the mean square of velocities about the mean
                                 [m^2/s^2] */
    double kinetic_stress[6]; /* of velocities about the mean [Pa] */
    double contact_stress[6]; /* of the last step's forces of contacts, not of bonds [Pa] */
} se3d_average;

/* As se3d_particles_get_average, told the size of *average in bytes. @return as
 * se3d_particles_get_average, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_average_sized(const se3d_particles *particles,
                                                      const double lower[3], const double upper[3],
                                                      int32_t tag, se3d_average *average,
                                                      size_t size);

/* Compute averages over the particles in a box. Contacts are those of se3d_particles_get_contacts,
 * with their forces; after an edit there are none until the next step. Each call evaluates all.
 * @param[in] lower     corner of the box, ground frame [m]
 * @param[in] upper     the opposite one: greater [m]
 * @param[in] tag       of the particles that count, with their contacts with any; -1: all
 * @param[out] average  what they are in the mean
 * @return OK, NULL, INVALID_ARGUMENT (box, tag), STATE (the system is gone; from within a
 *         callback).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_average(const se3d_particles *particles,
                                                     const double lower[3], const double upper[3],
                                                     int32_t tag, se3d_average *average)
{
    return se3d_particles_get_average_sized(particles, lower, upper, tag, average, sizeof *average);
}

#ifdef __cplusplus
}
#endif
#endif
