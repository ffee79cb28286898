/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantities of sets and sinks of particles. */
#ifndef SE3D_IO_CHANNEL_FLOW_H
#define SE3D_IO_CHANNEL_FLOW_H

#include "io/channel/channel.h"

/* Quantities of a set or of a sink. */
se3d_status se3di_grains_eval(const se3di_channel *channel, double *value);

#endif
