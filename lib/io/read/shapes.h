/* SPDX-License-Identifier: BSD-3-Clause */
/* What bodies look like, and what they weigh if no mass is given. */
#ifndef SE3D_IO_SHAPES_H
#define SE3D_IO_SHAPES_H

#include "io/document/reader.h"
#include "io/model/model.h"

/* Add a shape whose place is in the frame of the body of this entry; `node` says the rest of it. */
bool se3di_add_shape(se3di_reader *reader, const se3di_node *node, size_t entry,
                     const se3di_shape_entry *shape);
/* The density of the material that `node` names, left alone if it has none. */
bool se3di_read_material_density(se3di_reader *reader, const se3di_node *node, double *density);
bool se3di_read_shapes(se3di_reader *reader, const se3di_node *body, size_t entry);
/* Mass and inertia of a body from its shapes' densities. */
bool se3di_read_shape_mass(se3di_reader *reader, const se3di_node *body, se3d_body_def *def);

#endif
