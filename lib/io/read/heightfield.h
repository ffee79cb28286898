/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes of type heightfield: their heights, and the triangles that they are seen as. */
#ifndef SE3D_IO_HEIGHTFIELD_H
#define SE3D_IO_HEIGHTFIELD_H

#include "io/document/reader.h"
#include "io/model/mesh.h"

/* Read a shape's heights, once; their memory is the model's. @return NULL: failed */
const se3di_mesh *se3di_read_heightfield(se3di_reader *reader, const se3di_node *shape);

#endif
