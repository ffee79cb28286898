/* SPDX-License-Identifier: BSD-3-Clause */
/* Laws of force elements: functions of time, of what the element gives, and of channels. */
#ifndef SE3D_IO_LAW_H
#define SE3D_IO_LAW_H

#include "io/document/reader.h"

/* As se3di_read_function; the text may also name channels that follow from positions and
 * velocities: pin.angle, spring.length, car.velocity.x. */
bool se3di_read_law(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                    double *value, se3d_function *function);

#endif
