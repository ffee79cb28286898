/* SPDX-License-Identifier: BSD-3-Clause */
/* From the list of neighbours to the blocks of active pairs, with the history of their springs. */
#ifndef SE3DI_PARTICLES_LIST_H
#define SE3DI_PARTICLES_LIST_H

#include "particles/set.h"

se3d_status se3di_particles_refresh(se3di_particles *set); /* active blocks from the list */
/* Take the history out of the blocks; the lists are invalid then. */
se3d_status se3di_particles_collect(se3di_particles *set);
/* Room for the history of `count` pairs, which waits in the memory of the loads. */
se3d_status se3di_particles_reserve_carry(se3di_particles *set, size_t count, int rolling);
/* What was collected now belongs to particles of other indices (SE3DI_NO_INDEX: gone). */
void se3di_particles_remap(se3di_particles *set, const uint32_t *new_index);
/* Active blocks from the list and what was collected. */
se3d_status se3di_particles_activate(se3di_particles *set);

#endif
