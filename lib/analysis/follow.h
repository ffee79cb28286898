/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef SE3DI_FOLLOW_H
#define SE3DI_FOLLOW_H

#include "analysis/run.h"

/* Bring a run's model to where the solution that the model of `from` is at leads if its data become
 * those of the run's: by one step of Newton's method at each level of the state, with the Jacobians
 * and factors of `from`. See se3d_solver_follow. On failure the model's state is of no use.
 * @return OK, STATE (another structure, `from` is not there), UNSUPPORTED, or why not */
se3d_status se3di_run_follow(se3di_run *run, se3di_run *from);

#endif
