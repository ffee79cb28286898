/* SPDX-License-Identifier: BSD-3-Clause */
/* A prescribed rate that jumps: velocities do by the impulses L of the constraints,
 *
 *     M dv + Phi_q^T L = 0,  Phi_q v = nu,
 *
 * whose work is that of the drivers. docs/theory/kinematics.md */
#ifndef SE3DI_KINK_H
#define SE3DI_KINK_H

#include "nonlinear/equations.h"
#include "nonlinear/jump.h"

/* Carry the model, which is at the end of what was before, over the kink: its time, velocities and
 * works; the impulse of every rate that jumps is told to the log. Accelerations and multipliers are
 * left to the caller. A value that jumps is refused. */
se3d_status se3di_kink_pass(se3di_equations *equations, const se3di_kink *kink);

#endif
