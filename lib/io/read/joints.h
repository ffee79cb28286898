/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints between two bodies. */
#ifndef SE3D_IO_JOINTS_H
#define SE3D_IO_JOINTS_H

#include "io/document/reader.h"
#include "io/model/model.h"

/* One that a pair of bodies carries: used for joints and two of the constraints. */
bool se3di_read_pair(se3di_reader *reader, const se3di_node *node, const char *type,
                     se3di_element_entry *entry);

#endif
