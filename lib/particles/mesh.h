/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of particles and meshes. */
#ifndef SE3DI_PARTICLES_MESH_H
#define SE3DI_PARTICLES_MESH_H

#include "particles/set.h"

/* Take the history out of the pairs, as se3di_particles_collect does. */
void se3di_particles_mesh_collect(se3di_particles *set);
/* NULL: particles (walls) are as they were. */
void se3di_particles_mesh_remap(se3di_particles *set, const uint32_t *new_index,
                                const uint32_t *new_wall);
se3d_status se3di_particles_mesh_activate(se3di_particles *set);
void se3di_particles_mesh_forces(se3di_particles *set, const se3di_slab *slab,
                                 se3di_force_task *task);
/* Empty, of a wall. */
void se3di_mesh_batch_begin(const se3di_particles *set, uint32_t wall, se3di_mesh_batch *batch);
/* Append where the two touch now, with the history; returns 0 if there is no room. */
int se3di_mesh_batch_add(const se3di_particles *set, const se3di_mesh_pair *pair,
                         se3di_mesh_batch *batch);

#endif
