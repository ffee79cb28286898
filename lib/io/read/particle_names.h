/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of sets of particles, and of what counts them. */
#ifndef SE3D_IO_PARTICLE_NAMES_H
#define SE3D_IO_PARTICLE_NAMES_H

#include "io/document/reader.h"
#include "se3d/shape.h"

/* Whether nothing else has the name: those of sets, sinks, regions and flows are channels, as those
 * of bodies and elements are. */
bool se3di_check_free_name(se3di_reader *reader, const se3di_node *node, const char *name);
/* The shape that has the name of a node. */
bool se3di_read_shape_name(se3di_reader *reader, const se3di_node *node, se3d_shape *shape);
/* The tag of the set that `key` of a map names; -1 without it. */
bool se3di_read_key_set(se3di_reader *reader, const se3di_node *map, const char *key, int32_t *tag);

#endif
