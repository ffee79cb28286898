/* SPDX-License-Identifier: BSD-3-Clause */
/* How stiff a model is: what `auto` looks at. */
#ifndef SE3DI_STIFFNESS_H
#define SE3DI_STIFFNESS_H

#include "model/model.h"

/* The fastest spin of a body [rad/s]. */
double se3di_stiffness_spin(const se3di_model *model);
/* What the fastest spring-damper or bushing turns and decays by in a step of h, its bodies free. */
double se3di_stiffness_angle(const se3di_model *model, double h);
/* The longest step of an explicit method that follows every spring-damper and bushing at the
 * present state; infinite if there is none. */
double se3di_stiffness_step(const se3di_model *model);
/* The spring-damper or bushing that vibrates fastest, its bodies free, of those that damp the
 * vibration less than half critically; no tyre, in whose place nothing could be.
 * @return its rate [rad/s]; 0: there is none */
double se3di_stiffness_vibration(const se3di_model *model, const se3di_force **force);
/* The rate of the motion that one wants to see [1/s]: of a pendulum as long as the model is large,
 * and of the spins; 1 at least, as a spin by rounding is none. */
double se3di_stiffness_motion(const se3di_model *model);
/* An explicit method would be held to steps by decays that are long over: the fastest that a
 * spring-damper or bushing forces is much faster than the motion that one wants to see, both on its
 * bodies as if they were free, tr(M^-1 D), D = -d wrench / d velocity, and as they are held by the
 * constraints: a light body on a pin away from its centre may be held by a heavy one.
 * @return OK, NO_MEMORY */
se3d_status se3di_stiffness_is_stiff(se3di_model *model, se3di_error *error, int *is_stiff);

#endif
