/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps in which something turns further than can be told from its end. */
#ifndef SE3DI_TURNS_H
#define SE3DI_TURNS_H

#include "nonlinear/equations.h"

/* A step h from the present state. An angle that turns by more than half a turn could not be
 * counted; a body that turns by more than `most` [rad] (infinite: any) has no meaning for the
 * method. @return OK, STEP_SIZE: with what turns and the largest step in the message */
se3d_status se3di_turns_check(const se3di_equations *equations, double h, double most);

#endif
