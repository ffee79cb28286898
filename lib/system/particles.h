/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the public layer of particles share. */
#ifndef SE3DI_SYSTEM_PARTICLES_H
#define SE3DI_SYSTEM_PARTICLES_H

#include "contact/particle_set.h"
#include "system/system_internal.h"

struct se3d_particles {
    se3di_particles set;
    se3d_system *system;
};

/* Dense index of a material; fails with STALE_HANDLE and a message. */
se3d_status se3di_find_material(se3d_particles *particles, const char *what, se3d_material material,
                                uint32_t *index);
/* `value` is finite and in [low, high]. */
se3d_status se3di_check_range(se3d_particles *particles, const char *what, double value, double low,
                              double high);
/* Room for `count` more particles. */
se3d_status se3di_particles_make_room(se3d_particles *particles, size_t count);

#endif
