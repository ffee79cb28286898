/* SPDX-License-Identifier: BSD-3-Clause */
/* No step passes over a pulse of what acts by time (prescribed values, loads, gravity): a method
 * that evaluates before and behind it sees nothing of it, nor does the estimate of its error. */
#ifndef SE3DI_PULSE_STEP_H
#define SE3DI_PULSE_STEP_H

#include "assembly/assembly.h"

/* h, or a part of it: of every function of time, looked at in so many places between t and the end
 * of the step, the polynomial of degree 5 through values and derivatives at both ends tells most.
 * Callbacks are not looked at: nobody asks them for later times. */
double se3di_pulse_step(const se3di_assembly *assembly, double t, double h);

#endif
