/* SPDX-License-Identifier: BSD-3-Clause */
/* What a set takes from the model: materials, shapes, settings. */
#ifndef SE3DI_PARTICLES_SYNC_H
#define SE3DI_PARTICLES_SYNC_H

#include "particles/set.h"

/* A clone goes with a clone of the model, whose shapes its walls are from now on. */
void se3di_particles_adopt(se3di_particles *set, const se3di_model *model);
/* Take materials, shapes and settings from the model if it was edited since. */
se3d_status se3di_particles_sync(se3di_particles *set, const se3di_model *model);
/* The mass of the lightest body that gives way to particles; infinite if none does. */
double se3di_particles_lightest_body(const se3di_particles *set, const se3di_model *model);
/* The index in the set's table of a material of the model, which is held from now on and counted as
 * used. */
se3d_status se3di_particles_hold(se3di_particles *set, se3di_model *model, uint32_t material,
                                 uint32_t *index);

#endif
