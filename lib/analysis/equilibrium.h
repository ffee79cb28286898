/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef SE3DI_EQUILIBRIUM_H
#define SE3DI_EQUILIBRIUM_H

#include "nonlinear/equations.h"

/* Bring the model to a static position at time t: velocities and accelerations zero, constraints
 * met, forces balanced by the multipliers (minimum norm). For equations in r-omega; the model's
 * state is the best one found on failure, the caller restores. @return OK, INFO_UNSTABLE (the
 * potential has a direction of negative curvature), INCONSISTENT, NO_CONVERGENCE, NOT_FINITE,
 * NO_MEMORY, CALLBACK. docs/theory/equilibrium.md */
se3d_status se3di_equilibrium_solve(se3di_equations *equations, double t);

#endif
