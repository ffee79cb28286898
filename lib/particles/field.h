/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields of particles on a grid. */
#ifndef SE3DI_PARTICLES_FIELD_H
#define SE3DI_PARTICLES_FIELD_H

#include "particles/set.h"
#include "se3d/field.h"

/* Fill the numbers of all cells; `contacts` 0: without what they give. */
void se3di_particles_fields(const se3di_particles *set, const se3d_field_grid *grid, int contacts,
                            double *values);

#endif
