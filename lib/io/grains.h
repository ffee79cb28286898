/* SPDX-License-Identifier: BSD-3-Clause */
/* `particles` of a model: the set, and how it goes along with the analyses. */
#ifndef SE3D_IO_GRAINS_H
#define SE3D_IO_GRAINS_H

#include "io/model.h"

struct se3di_grains {
    se3d_particles *set;
    bool moving_walls; /* some shape is on a body that is not fixed */
};

enum { SE3DI_GRAIN_COLUMNS = 12 };

/* Bring the particles of a model to `time` with `solver`, which is made from `def` and
 * moves the bodies, in dynamics the particles too; otherwise walls
 * that move are followed at every step of the particles. Ends before where an event
 * stops the bodies. @return as
 * se3d_solver_run and se3d_particles_run. */
se3d_status se3di_grains_advance(const se3d_model *model, const se3d_solver_def *def,
                                 se3d_solver *solver, double time);
/* Names of the columns of a snapshot. */
const char *se3di_grains_get_column(size_t k);
/* Copy all particles to `rows`, [count * SE3DI_GRAIN_COLUMNS]. */
se3d_status se3di_grains_get_rows(const se3di_grains *grains, se3di_iopool *pool, double **rows,
                                  size_t *count);

#endif
