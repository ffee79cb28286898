/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantities of sets and sinks of particles. */
#ifndef SE3D_IO_CHANNEL_FLOW_H
#define SE3D_IO_CHANNEL_FLOW_H

#include "io/channel/channel.h"

/* Answers to the questions of the same names (channel.h). */
se3d_status se3di_tagged_ask_tally(const se3di_channel *channel, double numbers[7]);
se3d_status se3di_tagged_ask_sources(const se3di_channel *channel, double numbers[3]);
se3d_status se3di_tagged_ask_sink(const se3di_channel *channel, double *count);
se3d_status se3di_tagged_ask_average(const se3di_channel *channel, double numbers[17]);
se3d_status se3di_tagged_ask_passed(const se3di_channel *channel, double numbers[12]);
se3d_status se3di_tagged_ask_dissipation(const se3di_channel *channel, double numbers[8]);
se3d_status se3di_tagged_ask_servo(const se3di_channel *channel, double numbers[5]);
se3d_status se3di_tagged_ask_cell(const se3di_channel *channel, double numbers[22]);
se3d_status se3di_tagged_ask_bonds(const se3di_channel *channel, double numbers[10]);

#endif
