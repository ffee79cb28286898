/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes in files: STL, binary and ASCII, and OBJ. */
#ifndef SE3D_IO_MESH_H
#define SE3D_IO_MESH_H

#include "io/reader.h"

struct se3di_mesh {
    const char *file;
    double scale;
    struct se3di_mesh *next; /* of the model */
    double *points;          /* [3 * point_count], scaled */
    size_t point_count, point_capacity;
    uint32_t *triangles; /* [3 * triangle_count] */
    size_t triangle_count, triangle_capacity;
    double low[3], high[3]; /* the box around all points */
};

/* Read the file that `file` of a shape names, relative to the model file, once for all shapes of
 * the same scale; its memory is the model's. @return NULL: failed, with the place in the model file
 * and in the mesh. */
const se3di_mesh *se3di_read_mesh(se3di_reader *reader, const se3di_node *shape, const char *file,
                                  double scale);

#endif
