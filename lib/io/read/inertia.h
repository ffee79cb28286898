/* SPDX-License-Identifier: BSD-3-Clause */
/* `inertia` of bodies and clumps. */
#ifndef SE3D_IO_INERTIA_H
#define SE3D_IO_INERTIA_H

#include "io/document/reader.h"

/* 3 diagonal entries, 6 as in the definitions {xx, yy, zz, xy, yz, xz}, or the rows of the
 * symmetric matrix. */
bool se3di_read_inertia(se3di_reader *reader, const se3di_node *node, double inertia[6]);

#endif
