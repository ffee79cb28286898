/* SPDX-License-Identifier: BSD-3-Clause */
/* What wheels measure of a suspension.
 *
 * Vehicle axes are fixed to the chassis: x forward, y left, z up. a is the spin axis, out of the
 * vehicle, s = +1 on the left and -1 on the right, n the road's normal, R the radius:
 *
 *     sin camber = -a_z      tan steer = -s a_x / (s a_y)      toe = -s steer
 *     contact point C = c + R d,   d = ((n . a) a - n) / |..|
 *     tan caster = -k_x / k_z      tan inclination = -s k_y / k_z      k: the steer axis, up
 *
 * Derivatives are by the travel z = e_z . c of the wheel centre, along the motion that the
 * constraints allow (wheel_motion.h).  docs/theory/wheel.md */
#ifndef SE3DI_WHEEL_H
#define SE3DI_WHEEL_H

#include "model/model.h"
#include "se3d/wheel.h"

/* The wheel centre and the contact point from the chassis' origin, vehicle axes. */
void se3di_wheel_place(const se3di_model *model, const se3di_wheel *wheel, double center[3],
                       double contact[3]);

/* All measures of the groups that hold one of first .. first + count - 1, into
 * values[SE3D_WHEEL_MEASURES]. @return as se3d_wheel_get_measures */
se3d_status se3di_wheel_measure(const se3di_model *model, uint32_t wheel, size_t first,
                                size_t count, double *values);

#endif
