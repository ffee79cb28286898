/* SPDX-License-Identifier: BSD-3-Clause */
/* What the steps of explicit methods stand on: the vectors of a method, derivatives, scales of
 * errors, projection. */
#ifndef SE3DI_EXPLICIT_POINT_H
#define SE3DI_EXPLICIT_POINT_H

#include "integrator/explicit_step.h"

/* Numbers that the history begins with. */
#define SE3DI_EXPLICIT_PAST (sizeof(se3di_explicit_past) / sizeof(double))

se3di_explicit_past *se3di_explicit_past_of(const se3di_model *model);
/* The parts of history and work. */
se3di_explicit se3di_explicit_point(const se3di_integration *integration);
/* The same, and the solver as it needs it; `is_controlled`: errors decide of its steps. */
se3di_explicit se3di_explicit_begin(se3di_integration *integration, int is_controlled);
/* y'_1 as the bodies see it; y_1 was set last. */
const double *se3di_explicit_get_rates(const se3di_explicit *m);
/* @return them */
const double *se3di_explicit_grow_scale(se3di_explicit *m);
/* The same by m->squares, where nothing acts but gravity. */
void se3di_explicit_grow_bare_scale(se3di_explicit *m);
/* Derivative at the state that was set last. */
se3d_status se3di_explicit_differentiate(se3di_explicit *m, double t, double *derivative);
/* What the velocities of the step that is tried are measured by: not below what rounding makes of
 * forces that balance. */
se3di_state_scale se3di_explicit_measure_by(const se3di_explicit *m);
/* is_factored: the factorisation of the last evaluation, which was here or near, serves. */
se3d_status se3di_explicit_project(se3di_explicit *m, double t, int is_factored);
int se3di_explicit_is_too_large(const se3di_explicit *m, double error);

#endif
