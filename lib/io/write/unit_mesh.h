/* SPDX-License-Identifier: BSD-3-Clause */
/* The surfaces and lines that pictures are made of, in unit size. */
#ifndef SE3D_IO_UNIT_MESH_H
#define SE3D_IO_UNIT_MESH_H

#include <stddef.h>
#include <stdint.h>

typedef enum se3di_unit_shape {
    SE3DI_UNIT_BOX = 0,      /* 1 x 1 x 1 */
    SE3DI_UNIT_SPHERE = 1,   /* of radius 1 */
    SE3DI_UNIT_CYLINDER = 2, /* of radius 1 and length 1 along z */
    SE3DI_UNIT_SPRING = 3,   /* a coil of radius 1 and length 1 along z */
    SE3DI_UNIT_GRID = 4,     /* 20 x 20 squares of 1: lines of two points each */
    SE3DI_UNIT_CONE = 5,     /* of radius 1 at z = -1/2, its tip at z = 1/2 */
    SE3DI_UNIT_BALL = 6,     /* of radius 1, of fewer triangles: a sphere that is drawn small */
    SE3DI_UNIT_COUNT = 7
} se3di_unit_shape;

enum { SE3DI_UNIT_VERTICES_MAX = 1024 };

typedef struct se3di_unit_mesh {
    double points[3 * SE3DI_UNIT_VERTICES_MAX];
    double normals[3 * SE3DI_UNIT_VERTICES_MAX];
    uint32_t indices[6 * SE3DI_UNIT_VERTICES_MAX]; /* of triangles */
    size_t points_count;
    size_t indices_count; /* 0: lines, without normals (grid) */
} se3di_unit_mesh;

/* `mesh` is zeroed memory. */
void se3di_unit_mesh_make(se3di_unit_mesh *mesh, se3di_unit_shape unit);

#endif
