/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion relative to a body or marker: "wheel.position@chassis". */
#ifndef SE3D_IO_RELATIVE_H
#define SE3D_IO_RELATIVE_H

#include "io/channel/channel.h"

/* Whether a channel is a pose, velocity or acceleration, which alone can be relative. */
bool se3di_channel_can_be_relative(const se3di_channel *channel);
/* The reference that is called `name`, a body or body.marker. If there is none, `problem` says so.
 */
bool se3di_reference_find(const se3d_model *model, const char *name, se3di_reference *reference,
                          char *problem, size_t size);
/* The numbers of a relative channel, in the frame of its reference. */
se3d_status se3di_relative_eval(const se3di_channel *channel, const se3d_system *system,
                                double value[4]);

#endif
