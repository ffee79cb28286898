/* SPDX-License-Identifier: BSD-3-Clause */
/* Sorting particles into slabs and cells, and the list of neighbours. */
#ifndef SE3DI_PARTICLES_GRID_H
#define SE3DI_PARTICLES_GRID_H

#include "particles/set.h"

se3d_status se3di_particles_rebuild(se3di_particles *set); /* sort, list, active blocks */

#endif
