/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles listed in a file. */
#ifndef SE3D_IO_PARTICLE_TABLE_H
#define SE3D_IO_PARTICLE_TABLE_H

#include "io/document/reader.h"

/* The particles of a file: x, y, z, radius and more, see docs/model-file/reference.md. */
bool se3di_read_particle_table(se3di_reader *reader, const se3di_node *node, se3d_material material,
                               uint32_t tag);

/* The particles of the model's set from `before` on, of ascending ids, are of a named one. */
bool se3di_tag_particles(se3di_reader *reader, const se3di_node *node, size_t before, uint32_t tag);

/* They are fixed. */
bool se3di_fix_particles(se3di_reader *reader, const se3di_node *node, size_t before);

#endif
