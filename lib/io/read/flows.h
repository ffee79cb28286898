/* SPDX-License-Identifier: BSD-3-Clause */
/* `flows`: planes, disks and rectangles through which particles are counted. */
#ifndef SE3D_IO_FLOWS_H
#define SE3D_IO_FLOWS_H

#include "io/document/reader.h"

/* Add the flows of the model file to its set of particles, whose names are known. */
bool se3di_read_flows(se3di_reader *reader, const se3di_node *list);

#endif
