/* SPDX-License-Identifier: BSD-3-Clause */
/* Sources, sinks, what has left. */
#ifndef SE3DI_PARTICLES_FLOW_H
#define SE3DI_PARTICLES_FLOW_H

#include "particles/set.h"

/* What the sources give in the step to come, of duration h. */
se3d_status se3di_sources_aim(se3di_particles *set, const se3di_model *model, double h);
/* Insert what is due at the end of a step of duration h, between drift and forces. */
se3d_status se3di_sources_feed(se3di_particles *set, double h);
/* The sink that holds x, SE3DI_NO_INDEX: none. */
uint32_t se3di_sinks_find(const se3di_particles *set, const double x[3]);
/* Whether a particle is beyond the domain or falls without end. */
int se3di_particles_is_out(const se3di_particles *set, size_t k);

#endif
