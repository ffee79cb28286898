/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics at a position where the constraints lose rank (two branches of the motion meet): there
 * velocities do not follow from the equations, but from the motion on both sides.
 * docs/theory/kinematics.md */
#ifndef SE3DI_SINGULAR_H
#define SE3DI_SINGULAR_H

#include "nonlinear/equations.h"

/* From the present, regular state before t bring the model to t: the motion is continued past t and
 * interpolated. On failure the state is left somewhere before or after t.
 * @return OK, SINGULAR (the motion through t is not determined), or why it could not be continued
 */
se3d_status se3di_singular_pass(se3di_equations *equations, double t);

/* Continue to t: parabola, positions, velocities, accelerations. (kinematics.c) */
se3d_status se3di_kinematics_advance(se3di_equations *equations, double t);

#endif
