/* SPDX-License-Identifier: BSD-3-Clause */
/* What sticks at both ends of a step may have to slip within it. docs/theory/friction.md */
#ifndef SE3DI_HOLD_REVIEW_H
#define SE3DI_HOLD_REVIEW_H

#include "integrator/memory.h"

/* The frames are those of the end of the step, and come back, as what elements remember does
 * (step->memory has it already). end->error and end->fraction are raised to what a slip that the
 * step has missed would make of velocities, relative to the scales and the tolerance, and to where
 * it begins; *since: the part of the step for which something has been held with more than it can
 * be, at its end; 1: not known. */
se3d_status se3di_hold_review(se3di_equations *equations, const se3di_memory_step *step,
                              se3di_memory_end *end, double *since);

/* What the accelerations in equations->x differ from those `before` by, times h, relative to the
 * scales. */
double se3di_hold_change(const se3di_equations *equations, const double *before, double h,
                         const se3di_state_scale *scale);

#endif
