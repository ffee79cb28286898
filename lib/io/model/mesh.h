/* SPDX-License-Identifier: BSD-3-Clause */
/* Surfaces of triangles. */
#ifndef SE3D_IO_MESH_H
#define SE3D_IO_MESH_H

#include <stddef.h>
#include <stdint.h>

typedef struct se3di_mesh {
    const char *file;
    const char *model;               /* the file that names it */
    int mirror;                      /* the axis that is turned round; -1: none */
    const struct se3di_mesh *source; /* that it mirrors; NULL: it mirrors none */
    double scale;
    struct se3di_mesh *next; /* of the model */
    double *points;          /* [3 * point_count], scaled */
    size_t point_count, point_capacity;
    uint32_t *triangles; /* [3 * triangle_count] */
    size_t triangle_count, triangle_capacity;
    double low[3], high[3]; /* the box around all points */
    const void *of;         /* heightfield: the node that says it; NULL: none */
    const double *heights;  /* [row_count * column_count]; NULL: none, or mirrored */
    size_t row_count, column_count;
    double spacing[2]; /* along x, along y */
} se3di_mesh;

#endif
