/* SPDX-License-Identifier: BSD-3-Clause */
/* Laws of force elements: functions of time, of what the element gives, and of channels. */
#ifndef SE3D_IO_LAW_H
#define SE3D_IO_LAW_H

#include "io/document/reader.h"

/* As se3di_read_function; the text may also name channels that follow from positions and
 * velocities: pin.angle, spring.length, car.velocity.x. */
bool se3di_read_law(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                    double *value, se3d_function *function);
/* The same for what is prescribed or integrated beforehand, a function of time alone: a text that
 * names channels is refused with what may take its place. */
bool se3di_read_prescribed(se3di_reader *reader, const se3di_node *node, double *value,
                           se3d_function *function);
/* Whether a value names channels, which se3di_read_followed reads when all of them are there. */
bool se3di_is_followed(const se3di_reader *reader, const se3di_node *node);
/* The value of a driver that names channels: a function of the time and of positions. */
bool se3di_read_followed(se3di_reader *reader, const se3di_node *node, se3d_function *function);
/* The rate of one that does: of the time and of channels of any kind but accelerations and
 * forces. */
bool se3di_read_followed_rate(se3di_reader *reader, const se3di_node *node,
                              se3d_function *function);
/* Whether a text, of a function of time alone, names no channel; reports one that does. */
bool se3di_check_of_time(se3di_reader *reader, const se3di_node *node);

#endif
