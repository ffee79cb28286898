/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef SE3DI_FRICTION_START_H
#define SE3DI_FRICTION_START_H

#include "nonlinear/equations.h"

/* Elements with a memory at the start of a run, at a consistent state: friction at rest holds with
 * the force that keeps its coordinate at rest (at most what it can), so that nothing moves when the
 * run starts. Ends with the accelerations and multipliers of that. docs/theory/friction.md */
se3d_status se3di_friction_start(se3di_equations *equations);

/* The same if something else acts from here on: what rests holds with another force. Without
 * friction nothing happens. */
se3d_status se3di_friction_renew(se3di_equations *equations);
/* The same where velocities have jumped: what moves otherwise than it did is taken up anew. */
se3d_status se3di_friction_pass(se3di_equations *equations);

/* If drivers determine the motion: friction slips as its coordinate moves, under the load of the
 * reactions that come out; what is at rest takes none. At a consistent state at t, whose
 * accelerations and multipliers are computed again. @return NO_CONVERGENCE if friction jams. */
se3d_status se3di_friction_follow(se3di_equations *equations, double t);

#endif
