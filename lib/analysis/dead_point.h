/* SPDX-License-Identifier: BSD-3-Clause */
/* Dead points: positions that a driver cannot take the mechanism beyond, as a slider that drives a
 * crank when crank and rod are in line. Towards one, at t*, velocities grow as (t* - t)^(-1/2). */
#ifndef SE3DI_ANALYSIS_DEAD_POINT_H
#define SE3DI_ANALYSIS_DEAD_POINT_H

#include "nonlinear/equations.h"

/* Explain why a motion under drivers has failed by `status` on the way to t_end, from the state
 * that was accepted last: if a dead point has ended it, the message names the driver and the time
 * and value of the dead point. @return status */
se3d_status se3di_dead_point_explain(se3di_equations *equations, double t_end, se3d_status status);

#endif
