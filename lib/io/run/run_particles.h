/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles during a run. */
#ifndef SE3D_IO_RUN_PARTICLES_H
#define SE3D_IO_RUN_PARTICLES_H

#include "io/model/model.h"

/* Bring the particles of a model to `time` with `solver`, which is made from `def` and
 * moves the bodies, in dynamics the particles too; otherwise walls
 * that move are followed at every step of the particles. Ends before where an event
 * stops the bodies. @return as
 * se3d_solver_run and se3d_particles_run. */
se3d_status se3di_tagged_advance(const se3d_model *model, const se3d_solver_def *def,
                                 se3d_solver *solver, double time);
/* What became of the particles of every name, for the summary of a run. @return OK, NO_MEMORY. */
se3d_status se3di_tagged_sum_up(const se3di_tagged *particles, se3di_iopool *pool,
                                se3d_run_particles **out, size_t *count);

#endif
