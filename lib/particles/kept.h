/* SPDX-License-Identifier: BSD-3-Clause */
/* The state of a set before a step that may fail. */
#ifndef SE3DI_PARTICLES_KEPT_H
#define SE3DI_PARTICLES_KEPT_H

#include "particles/set.h"

/* Keep what a step changes, to come back to if it fails. Allocates only if the set has
 * grown. */
se3d_status se3di_particles_keep(se3di_particles *set);
void se3di_particles_come_back(se3di_particles *set); /* to what was kept last */
void se3di_particles_forget(se3di_particles *set);    /* give its memory back */
size_t se3di_particles_kept_memory(const se3di_particles *set);

#endif
