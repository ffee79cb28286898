/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction under methods with error control: within a step it keeps its mode and its load, at the
 * end they change. docs/theory/friction.md */
#ifndef SE3DI_MEMORY_H
#define SE3DI_MEMORY_H

#include "integrator/state.h"

/* The largest rate against the direction of slip, relative to the scales: there friction has
 * driven, as the motion turned within the step. */
double se3di_memory_overshoot(const se3di_model *model, const se3di_state_scale *scale);

/* At the end of a step of h, at the state of the model at t: let the force elements remember it.
 * *error: what this changes of the accelerations, times h, and the overshoot, relative to the
 * scales. For implicit methods. `work` [unknowns]. */
se3d_status se3di_memory_settle(se3di_integration *integration, double t, double h,
                                const se3di_state_scale *scale, double *work, double *error);
/* The step is not taken: the memory of before. */
void se3di_memory_undo(se3di_integration *integration);

#endif
