/* SPDX-License-Identifier: BSD-3-Clause */
/* `cell`: how a periodic domain strains. */
#ifndef SE3D_IO_CELL_H
#define SE3D_IO_CELL_H

#include "io/document/reader.h"

/* Add the stages of the model file to the domain of its set of particles. */
bool se3di_read_cell(se3di_reader *reader, const se3di_node *list);

#endif
