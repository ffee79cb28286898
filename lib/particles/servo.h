/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls that move so that particles press them as wanted. */
#ifndef SE3DI_PARTICLES_SERVO_H
#define SE3DI_PARTICLES_SERVO_H

#include "particles/set.h"

/* To the place at which its body has the wall's shape, moved as far as its servo is. */
void se3di_wall_place(const se3di_particles *set, se3di_wall *wall, const se3di_frame *frame);
/* 1 + the servo of a shape, 0: none. */
int32_t se3di_servos_find(const se3di_particles *set, se3di_handle shape);
/* The loads that are wanted in the step to come, of duration h. */
se3d_status se3di_servos_aim(se3di_particles *set, const se3di_model *model, double h);
/* Particles have drifted for a time h, and the walls have the forces of its beginning: choose the
 * speeds by these, and drift. */
void se3di_servos_drift(se3di_particles *set, double h);
/* The last particle has gone: nothing presses, and the walls stay where they are. */
void se3di_servos_rest(se3di_particles *set);
/* The force on the particles along the axis, in the last step. */
double se3di_servo_force(const se3di_particles *set, const se3di_servo *servo);
/* What is wanted of it. */
double se3di_servo_wanted(const se3di_servo *servo);

#endif
