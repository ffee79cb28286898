/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes in files: STL, binary and ASCII, and OBJ. */
#ifndef SE3D_IO_MESH_FILE_H
#define SE3D_IO_MESH_FILE_H

#include "io/document/reader.h"
#include "io/model/mesh.h"

/* Read the file that `file` of a shape names, relative to the model file, once for all shapes of
 * the same scale; its memory is the model's. @return NULL: failed, with the place in the model file
 * and in the mesh. */
const se3di_mesh *se3di_read_mesh(se3di_reader *reader, const se3di_node *shape, const char *file,
                                  double scale);
/* The surface of a funnel, for pictures; NULL: out of memory. */
const se3di_mesh *se3di_make_funnel(se3di_reader *reader, const se3d_model_shape *shape);
/* The mesh with one axis turned round; NULL: out of memory. */
const se3di_mesh *se3di_mirror_mesh(se3di_reader *reader, const se3di_mesh *mesh, int axis);

#endif
