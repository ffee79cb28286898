/* SPDX-License-Identifier: BSD-3-Clause */
/* Clumps: rigid bodies of several spheres, in bulk, for particles that are not round.
 *
 * The spheres are particles of the set (se3d/particles.h), with ids, contacts and forces of their
 * own; those of one clump have consecutive ids and never touch each other. A clump is named by the
 * id of its first sphere. Equations: docs/theory/clumps.md.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_CLUMP_H
#define SE3D_CLUMP_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What clumps are made like. The spheres may overlap. @since 0.1 */
typedef struct se3d_clump_def {
    size_t struct_size;
    size_t count;         /* of spheres, at most 10000 */
    const double *r;      /* [count * 3] centres, in a frame of the template [m] */
    const double *radius; /* [count] [m] > 0 */
    double mass;          /* [kg]; 0: of the union, by the density of the material */
    double centre[3];     /* of the mass, if it is given, frame of the template [m] */
    double inertia[6];    /* about that, {xx, yy, zz, xy, yz, xz}, if the mass is given [kg m^2] */
} se3d_clump_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_clump_def_default. @since 0.1 */
SE3D_API void se3d_clump_def_init(se3d_clump_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_clump_def se3d_clump_def_default(void)
{
    se3d_clump_def def;
    se3d_clump_def_init(&def, sizeof def);
    return def;
}

/* Add a template of clumps. Snapshots from before do not have it.
 * @param[out] index  its number, from 0; NULL: not wanted
 * @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_add_clump_template(se3d_particles *particles,
                                                       const se3d_clump_def *def, uint32_t *index);

/* What the spheres of a template are together. @since 0.1 */
typedef struct se3d_clump_template_info {
    double volume;     /* of the union; spheres that overlap: to 1e-4 [m^3] */
    double mass;       /* for a density of 1 kg/m^3, or as given [kg] */
    double centre[3];  /* of mass, frame of the template [m] */
    double inertia[6]; /* about that, {xx, yy, zz, xy, yz, xz}, for that mass [kg m^2] */
    double radius;     /* of the sphere about the centre of mass that holds all [m] */
} se3d_clump_template_info;

/* As se3d_particles_get_clump_template, told the size of *info in bytes. @return as
 * se3d_particles_get_clump_template, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_clump_template_sized(const se3d_particles *particles,
                                                             uint32_t index,
                                                             se3d_clump_template_info *info,
                                                             size_t size);

/* Get what the spheres of a template are together.
 * @param[in] index  its number
 * @return OK, NULL, INVALID_ARGUMENT (no such template).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_clump_template(const se3d_particles *particles,
                                                            uint32_t index,
                                                            se3d_clump_template_info *info)
{
    return se3d_particles_get_clump_template_sized(particles, index, info, sizeof *info);
}

/* Add clumps: the last of se3d_particles_get_clump_ids then. Orientations are those of the frame of
 * the template in the ground frame.
 * @param[in] index     number of their template
 * @param[in] material  of their spheres; its density counts if the template's mass is not given
 * @param[in] count     their number
 * @param[in] r         [count * 3] centres of mass, ground frame [m]
 * @param[in] e         [count * 4] orientations, unit Euler parameters, scalar first; NULL:
 *                      none is turned
 * @param[in] v         [count * 3] velocities of the centres of mass [m/s]; NULL: at rest
 * @param[in] w         [count * 3] angular velocities, ground frame [rad/s]; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_add_clumps(se3d_particles *particles, uint32_t index,
                                               se3d_material material, size_t count,
                                               const double *r, const double *e, const double *v,
                                               const double *w);

/* Count the clumps of a set. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_particles_count_clumps(const se3d_particles *particles);

/* Get the clumps and their templates, in the order of creation: the order of all arrays of clumps.
 * NULL arrays are skipped.
 * @param[in] count       must be se3d_particles_count_clumps
 * @param[out] ids        [count] of their first spheres
 * @param[out] templates  [count] numbers of their templates
 * @param[out] mass       [count] [kg]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_clump_ids(const se3d_particles *particles, size_t count,
                                                  uint32_t *ids, uint32_t *templates, double *mass);

/* Get which clumps the particles are of.
 * @param[in] count   must be se3d_particles_count
 * @param[out] clumps [count] ids of their first spheres, UINT32_MAX: a sphere by itself
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_clump_of(const se3d_particles *particles, size_t count,
                                                 uint32_t *clumps);

/* Get the states of the clumps. NULL arrays are skipped.
 * @param[in] count  must be se3d_particles_count_clumps
 * @param[out] r     [count * 3] centres of mass, ground frame [m]
 * @param[out] e     [count * 4] orientations, unit Euler parameters, scalar first
 * @param[out] v     [count * 3] ground frame [m/s]
 * @param[out] w     [count * 3] ground frame [rad/s]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_clumps(const se3d_particles *particles, size_t count,
                                               double *r, double *e, double *v, double *w);

/* Set the states of the clumps; their spheres follow. Arrays that are NULL leave their quantity
 * alone: with an orientation alone the angular velocity stays, ground frame.
 * @param[in] count  must be se3d_particles_count_clumps
 * @param[in] r      [count * 3] centres of mass, ground frame [m]
 * @param[in] e      [count * 4] orientations, unit Euler parameters, scalar first
 * @param[in] v      [count * 3] ground frame [m/s]
 * @param[in] w      [count * 3] ground frame [rad/s]
 * @return OK, NULL, INVALID_ARGUMENT (count, not finite, no orientation), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_set_clumps(se3d_particles *particles, size_t count,
                                               const double *r, const double *e, const double *v,
                                               const double *w);

/* Get what contacts did to the clumps in the last step, without gravity. It is zero from an edit of
 * particles, materials or walls to the next step. NULL arrays are skipped.
 * @param[in] count    must be se3d_particles_count_clumps
 * @param[out] force   [count * 3] ground frame [N]
 * @param[out] torque  [count * 3] about the centres of mass, ground frame [N m]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_clump_forces(const se3d_particles *particles, size_t count,
                                                     double *force, double *torque);

#ifdef __cplusplus
}
#endif
#endif
