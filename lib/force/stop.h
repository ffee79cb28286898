/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef SE3DI_FORCE_STOP_H
#define SE3DI_FORCE_STOP_H

#include "model/model.h"

/* Whether an element is a stop, of a joint that has not broken. */
static inline int se3di_stop_acts(const se3di_force *force)
{
    return force->type == SE3DI_FORCE_STOP && !force->released;
}

/* The damping d(e) of a stop with the coefficient of restitution e, 0 < e <= 1; see stop.c. */
double se3di_stop_damping(double e);

/* The damping of the force at a penetration [N s/m, N m s/rad]. */
double se3di_stop_get_damper(const se3di_force *force, double delta);

/* The step of h to the model's state meets the stop: by how much the speed of the impact differs
 * from the one that is remembered, of the beginning of the step, and at which part of the step it
 * begins, along the cubic of the coordinate. @return 0 and *part 0 if it does not */
double se3di_stop_review(const se3di_model *model, const se3di_force *force, double h,
                         double *part);

/* It touches at one of both: the last accepted state and the state of the model. */
int se3di_stop_changes(const se3di_model *model, const se3di_force *force);

#endif
