/* SPDX-License-Identifier: BSD-3-Clause */
/* `bonds`: beams between particles, or from them to shapes. */
#ifndef SE3D_IO_BONDS_H
#define SE3D_IO_BONDS_H

#include "io/document/reader.h"

/* Add the bonds of the model file to its set of particles, whose names are known. */
bool se3di_read_bonds(se3di_reader *reader, const se3di_node *list);

#endif
