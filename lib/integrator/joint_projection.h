/* SPDX-License-Identifier: BSD-3-Clause */
/* Joint coordinates onto what prescribes them and onto the loops. */
#ifndef SE3DI_JOINT_PROJECTION_H
#define SE3DI_JOINT_PROJECTION_H

#include "integrator/state.h"

/* tree->q and tree->qdot, placed in the frames of the model, onto their constraints at t by the
 * least changes, weighed by the masses; where something was moved they are placed again. As of
 * se3di_state_project; `is_factored`: loops were factored here, or near.
 * @return the same; INFO_REDUNDANT: rows are not clear of each other here, the state may be off */
se3d_status se3di_joint_project(se3di_equations *equations, double t,
                                const se3di_state_scale *scale, double accuracy, int is_factored);

/* *gap: how far that state is off, as of se3di_state_measure_gap. */
se3d_status se3di_joint_measure_gap(se3di_equations *equations, double t,
                                    const se3di_state_scale *scale, double *gap);

#endif
