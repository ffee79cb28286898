/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces and motion of all slabs. */
#ifndef SE3DI_PARTICLES_SWEEP_H
#define SE3DI_PARTICLES_SWEEP_H

#include "particles/set.h"

/* Half kick of duration h/2 from the present forces and gravity. */
void se3di_particles_kick(se3di_particles *set, double h);
/* One or two half kicks of duration h/2 each and a drift by h, in one pass. */
void se3di_particles_move(se3di_particles *set, int kicks, double h);
/* The forces of all slabs, and for every slab, as soon as its forces are complete and nobody looks
 * at where it was, its motion. */
void se3di_particles_sweep(se3di_particles *set, const se3di_force_task *task,
                           const se3di_particle_motion *motion);

#endif
