/* SPDX-License-Identifier: BSD-3-Clause */
/* What sticks at both ends of a step may have to slip within it. docs/theory/friction.md */
#ifndef SE3DI_HOLD_REVIEW_H
#define SE3DI_HOLD_REVIEW_H

#include "integrator/memory.h"

/* To be called with the frames of the end of the step. They are restored, and so is what elements
 * remember (step->memory has it already). If the step has missed a slip, end->error is raised to
 * the change of velocities that the slip would cause, relative to the scales and the tolerance, and
 * end->fraction to its beginning. *since: the last part of the step in which friction had to hold
 * more than it can; 1: not known. */
se3d_status se3di_hold_review(se3di_equations *equations, const se3di_memory_step *step,
                              se3di_memory_end *end, double *since);

/* Whether element k was held at the end of the step that was reviewed last with more than it can
 * be, by the balance of forces: its spring follows that by what velocities are off. */
int se3di_hold_is_exceeded(const se3di_equations *equations, uint32_t k, int *is_known);

/* The difference of the accelerations in equations->x from those `before`, times h, relative to the
 * scales. */
double se3di_hold_change(const se3di_equations *equations, const double *before, double h,
                         const se3di_state_scale *scale);

#endif
