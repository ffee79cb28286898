/* SPDX-License-Identifier: BSD-3-Clause */
/* Drivers whose rate is a function of the time and of signals of any kind.
 * docs/theory/signals.md */
#ifndef SE3DI_FORCE_DRIVER_RATE_H
#define SE3DI_FORCE_DRIVER_RATE_H

#include "primitive/user.h"

/* Signals that a rate depends on in the end. */
#define SE3DI_RATE_LEAVES_MAX 24

/* The rate of the coordinate of a joint follows a function, by dense index: one row of velocities.
 * Its bodies are those of the joint, and those of what the function depends on but states.
 * @return 1; 0: they are more than SE3DI_NODE_BODIES_MAX */
int se3di_driver_rate_draft(const se3di_model *model, uint32_t joint, int32_t coordinate,
                            int32_t function, const char *name, se3di_draft *draft);

/* Whether a constraint is such a driver. */
int se3di_is_driver_rate(const se3di_constraint *constraint);

/* Whether the model has one: its dense index, or SE3DI_NO_INDEX. */
uint32_t se3di_find_driver_rate(const se3di_model *model);

/* The coordinate that it drives, which counts turns. */
double se3di_driver_rate_coordinate(const se3di_model *model, const se3di_constraint *constraint);

/* gamma of the row in a motion at the velocities of the model in which velocities follow each other
 * as in the row, x' = f_v v, and time and states stand: f_v v'|a=0 + (f_v)_s s' v - u.x_qq u */
se3d_status se3di_driver_rate_curve(const se3di_model *model, const se3di_constraint *constraint,
                                    double *gamma);

#endif
