/* SPDX-License-Identifier: BSD-3-Clause */
/* `clumps`: templates of particles that are not round, which `particles` name. */
#ifndef SE3D_IO_CLUMPS_H
#define SE3D_IO_CLUMPS_H

#include "io/document/reader.h"

/* Add the templates of the model file to its set of particles. */
bool se3di_read_clumps(se3di_reader *reader, const se3di_node *root);
/* The template that an entry of `particles` names, as in se3d_fill_def: from 1; 0 if it names none.
 */
bool se3di_read_key_clump(se3di_reader *reader, const se3di_node *map, uint32_t *clump);

#endif
