/* SPDX-License-Identifier: BSD-3-Clause */
/* `fields` of an output: a grid on which particles are shown as a continuum. */
#ifndef SE3D_IO_FIELD_GRID_H
#define SE3D_IO_FIELD_GRID_H

#include "io/document/reader.h"
#include "se3d/field.h"

/* Read the grid of an output; *grid stays NULL if it has none. */
bool se3di_read_field_grid(se3di_reader *reader, const se3di_node *output,
                           const se3d_field_grid **grid);

#endif
