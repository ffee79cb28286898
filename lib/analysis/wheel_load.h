/* SPDX-License-Identifier: BSD-3-Clause */
/* What springs and gravity do along a motion of wheels. With u the velocities and b the
 * accelerations along it, Q the wrenches at rest and K their derivative:
 *
 *     load  F = -Q . u                  rate  dF/dz = -(u . K u + Q . b)
 *
 * docs/theory/wheel.md */
#ifndef SE3DI_WHEEL_LOAD_H
#define SE3DI_WHEEL_LOAD_H

#include "analysis/wheel_motion.h"

/* The motion in which the wheel and the opposite one have these rates of travel, to be found. */
void se3di_wheel_ride_init(se3di_wheel_motion *motion, const se3di_model *model,
                           const se3di_wheel *wheel, const double rates[2]);
/* The rate of the length of the wheel's spring; without one not a number. */
double se3di_wheel_spring_rate(const se3di_wheel_motion *motion, const se3di_wheel *wheel);
/* What lifts the wheels of a motion that has been found along these rates against gravity and the
 * suspension: force elements that are not friction, loads, nor from the ground; and how it changes;
 * not a number if there is no such motion. */
se3d_status se3di_wheel_load(se3di_wheel_motion *motion, const double rates[2], double *load,
                             double *rate);

#endif
