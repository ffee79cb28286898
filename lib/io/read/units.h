/* SPDX-License-Identifier: BSD-3-Clause */
/* `units`: what the numbers of a file are in. */
#ifndef SE3D_IO_UNITS_H
#define SE3D_IO_UNITS_H

#include "io/document/reader.h"

/* Those under `units` of a file; left alone if it has none. */
bool se3di_read_units(se3di_reader *reader, const se3di_node *root, se3di_units *units);

#endif
