/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the public layer of particles share. */
#ifndef SE3DI_SYSTEM_PARTICLES_H
#define SE3DI_SYSTEM_PARTICLES_H

#include "contact/particle_set.h"
#include "system/system_internal.h"

struct se3d_particles {
    se3di_particles set;
    se3d_system *system;
    se3d_particles *next; /* of the same system */
};

/* The index of a material in the set's table, which it gets and is counted in where it has none. */
se3d_status se3di_particles_use(se3d_particles *particles, se3d_material material, uint32_t *index);
/* Room for `count` more particles. */
se3d_status se3di_particles_make_room(se3d_particles *particles, size_t count);

#endif
