/* SPDX-License-Identifier: BSD-3-Clause */
/* `servos`: walls that press particles as wanted. */
#ifndef SE3D_IO_SERVOS_H
#define SE3D_IO_SERVOS_H

#include "io/document/reader.h"

/* Add the servo walls of the model file to its set of particles, whose names are known. */
bool se3di_read_servos(se3di_reader *reader, const se3di_node *list);

#endif
