/* SPDX-License-Identifier: BSD-3-Clause */
/* How stiff a model is: what `auto` looks at. */
#ifndef SE3DI_STIFFNESS_H
#define SE3DI_STIFFNESS_H

#include "model/model.h"

/* The rate of the fastest decay [1/s] that a spring-damper or bushing forces on its free bodies at
 * the present state: the largest trace of M^-1 D of an element, D = -d wrench / d velocity. */
double se3di_stiffness_rate(const se3di_model *model);
/* The longest step of an explicit method that follows every spring-damper and bushing at the
 * present state; infinite if there is none. */
double se3di_stiffness_step(const se3di_model *model);
/* The rate of the motion that one wants to see [1/s]: of a pendulum as long as the model is large,
 * and of the spins; 1 if there is neither. */
double se3di_stiffness_motion(const se3di_model *model);
/* An explicit method would be held to steps by decays that are long over. */
int se3di_stiffness_is_stiff(const se3di_model *model);

#endif
