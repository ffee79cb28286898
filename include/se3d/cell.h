/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic cells that strain: the domain of a set is stretched along its axes and sheared (with the
 * border condition of Lees and Edwards), at given rates or so that a stress stays.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_CELL_H
#define SE3D_CELL_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Stages of a cell at most. @since 0.1 */
#define SE3D_CELL_STAGES 16

/* A stage of the motion of a cell, which lasts from its start to that of the next one. The mean
 * velocity is v = L (x - centre): L has the rates on its diagonal and shear_rate beside it.
 * @since 0.1 */
typedef struct se3d_cell_def {
    size_t struct_size;
    double start;      /* [s]; one that is over begins with the next step */
    double rate[3];    /* of the lengths along x, y, z, over them [1/s]; without servo */
    double shear_rate; /* of the velocity along `flow`, by the place along `gradient` [1/s] */
    int32_t flow;      /* axis: 0, 1 or 2; default 0 */
    int32_t gradient;  /* another axis; default 2; all stages that shear have the same two */
    int32_t servo[3];  /* not 0: the length along this axis keeps the stress */
    int32_t reserved;
    double stress[3];    /* servo: normal stress, positive where particles press [Pa] */
    double rate_max[3];  /* servo: largest abs(rate) [1/s] > 0; default 1 */
    double gain[3];      /* servo: rate over excess of stress [1/(Pa s)] >= 0; 0: by the stiffness
                         * of contacts, rate_max over abs(stress) while there are none, which then
                         * must not be 0 */
    int32_t volume[3];   /* not 0: the length along this axis keeps the volume: several share it */
    int32_t shear_servo; /* not 0: the shear keeps the stress; without shear_rate */
    double shear_stress; /* shear_servo: along flow, on the plane across gradient [Pa]: < 0 where
                            * a positive shear_rate is resisted */
    double shear_rate_max; /* shear_servo: largest abs(shear_rate) [1/s] > 0; default 1 */
    double shear_gain;     /* shear_servo: shear_rate over excess of stress [1/(Pa s)] >= 0; 0: as
                            * gain, with shear_rate_max and shear_stress */
} se3d_cell_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_cell_def_default. @since 0.1 */
SE3D_API void se3d_cell_def_init(se3d_cell_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_cell_def se3d_cell_def_default(void)
{
    se3d_cell_def def;
    se3d_cell_def_init(&def, sizeof def);
    return def;
}

/* Add a stage to the motion of the domain, which must be periodic along x, y and z. Particles get
 * the mean velocities when a stage begins, and keep what they have beside them; across a border
 * velocities jump by the difference of its sides. While a set has stages, steps with shapes that it
 * touches, with clumps or with flows are UNSUPPORTED.
 * @param[out] stage  its number, from 0; NULL: not wanted
 * @return OK, NULL, INVALID_ARGUMENT, STATE (a particle is fixed), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_add_cell_stage(se3d_particles *particles,
                                                   const se3d_cell_def *def, uint32_t *stage);

/* A cell as it is now. Stress is that of contacts, bonds and motion about the mean velocities,
 * positive where particles press, in the last step. Energy of translation about the mean velocities
 * and of rotation, and what contacts and bonds store and turn to heat, come from the work.
 * @since 0.1 */
typedef struct se3d_cell_state {
    double lower[3], upper[3]; /* of the domain [m] */
    double offset;             /* of the image beyond the upper side, along `flow` [m] */
    double strain[3];          /* ln(length / first length) [1] */
    double shear_strain;       /* the integral of shear_rate [1] */
    double rate[3];            /* of the lengths, over them [1/s] */
    double shear_rate;         /* [1/s] */
    double stress[6];          /* xx, yy, zz, xy, yz, xz [Pa] */
    double volume;             /* [m^3] */
    double solid_fraction;     /* volume of the spheres over that [1] */
    double kinetic_energy;     /* of translation about the mean velocities [J] */
    double work;               /* of the cell on what is in it: minus the integral of
                                * volume * stress:L over time [J] */
    uint64_t stage;            /* the number of the stage under way; SE3D_CELL_STAGES: none yet */
} se3d_cell_state;

/* As se3d_particles_get_cell, told the size of *state in bytes. @return as se3d_particles_get_cell,
 * and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_cell_sized(const se3d_particles *particles,
                                                   se3d_cell_state *state, size_t size);

/* Get the state of the domain of a set; one without stages is at rest and has no stress.
 * @return OK, NULL.
 * @since 0.1 */
static inline se3d_status se3d_particles_get_cell(const se3d_particles *particles,
                                                  se3d_cell_state *state)
{
    return se3d_particles_get_cell_sized(particles, state, sizeof *state);
}

#ifdef __cplusplus
}
#endif
#endif
