/* SPDX-License-Identifier: BSD-3-Clause */
/* All particle sets of a model, as a method that moves bodies and particles in one loop sees them.
 *
 * A step of length h: se3di_sets_begin; se3di_sets_move with 1 (or, between two steps of one loop,
 * 2) half kicks; with the bodies at their new positions se3di_sets_forces; se3di_sets_kick at the
 * end of the loop. docs/theory/verlet.md */
#ifndef SE3DI_PARTICLES_SETS_H
#define SE3DI_PARTICLES_SETS_H

#include "particles/set.h"

/* Of one run: more would never end, and time would not advance by them. */
#define SE3DI_STEPS_MOST 1e12

/* The step that a set wants; 0: any. */
double se3di_particles_want_step(const se3di_particles *set, const se3di_model *model);
/* Steps of length `length` of one set beside resting bodies; h is the one that it wanted, which is
 * looked at. */
se3d_status se3di_particles_run(se3di_particles *set, const se3di_model *model, double h,
                                double length, size_t steps, se3di_error *error);

/* The sets at the model's time, with forces that belong to the state. */
se3d_status se3di_sets_begin(se3di_model *model, double h, se3di_error *error);
/* Keep the sets as they are before a step; bring them back. */
se3d_status se3di_sets_keep(se3di_model *model, se3di_error *error);
void se3di_sets_come_back(se3di_model *model);
void se3di_sets_move(se3di_model *model, int kicks, double h);
/* Before a step of length h begins: what the sources give. */
se3d_status se3di_sets_aim(se3di_model *model, double h, se3di_error *error);
/* Forces at t. *late: the first failure in spite of which they are complete (too large an overlap,
 * memory for longer lists). */
se3d_status se3di_sets_forces(se3di_model *model, double t, double h, se3di_error *error,
                              se3d_status *late);
void se3di_sets_kick(se3di_model *model, double h);
/* What fails in one process fails in all that share sets, with its message: all are asked before
 * they do something together and at the end of a call. A call that has failed asks no more. */
se3d_status se3di_sets_settle(const se3di_model *model, se3d_status status, se3di_error *error);
/* The same as the last thing of a public call. */
se3d_status se3di_sets_conclude(const se3di_model *model, se3d_status status, se3di_error *error);
/* The run ends: sets that are spread over processes are whole again. */
void se3di_sets_end(se3di_model *model);
/* What the particles do to the bodies [bodies * 6]: force (ground frame), torque (body frame). */
void se3di_sets_push(const se3di_model *model, double *push);
/* The power of that [W]. */
double se3di_sets_power(const se3di_model *model, const double *push);
/* The step that the particles want; 0: any. */
double se3di_sets_step(const se3di_model *model);

#endif
