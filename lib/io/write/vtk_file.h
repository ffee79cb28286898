/* SPDX-License-Identifier: BSD-3-Clause */
/* One .vtp file: points with numbers, and cells made of them; or one .vti file: numbers of the
 * cells of a grid. The numbers follow the XML as raw bytes, little-endian, or compressed. Or either
 * as one file of VTKHDF. */
#ifndef SE3D_IO_VTK_FILE_H
#define SE3D_IO_VTK_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "se3d/base.h"

/* X(NAME, number, element): in the order of the file; a grid has the first two. */
#define SE3DI_VTK_SECTION_LIST(X)                                                                  \
    X(POINT_DATA, 0, "PointData")                                                                  \
    X(CELL_DATA, 1, "CellData")                                                                    \
    X(POINTS, 2, "Points")                                                                         \
    X(VERTS, 3, "Verts")                                                                           \
    X(LINES, 4, "Lines")                                                                           \
    X(POLYS, 5, "Polys")

typedef enum se3di_vtk_section {
#define SE3DI_VTK_SECTION(NAME, number, element) SE3DI_VTK_##NAME = number,
    SE3DI_VTK_SECTION_LIST(SE3DI_VTK_SECTION)
#undef SE3DI_VTK_SECTION
        SE3DI_VTK_SECTION_COUNT = 6
} se3di_vtk_section;

/* values[k * stride + i], i < width; without values: first + k * step. */
typedef struct se3di_vtk_array {
    se3di_vtk_section section;
    const char *name;
    const double *values;
    size_t count, width, stride;
    double first, step;
    bool whole; /* 32-bit integers, else 32-bit floats */
} se3di_vtk_array;

/* Component i of entry k. */
static inline double se3di_vtk_value(const se3di_vtk_array *a, size_t k, size_t i)
{
    return a->values ? a->values[k * a->stride + i] : a->first + (double)k * a->step;
}

typedef struct se3di_vtk_grid {
    double origin[3], spacing[3];
    int32_t cells[3];
} se3di_vtk_grid;

typedef struct se3di_vtk_file {
    size_t points, verts, polys;   /* how many, */
    const se3di_vtk_array *arrays; /* in the order of their sections */
    size_t array_count;
    size_t lines;               /* and of these */
    const se3di_vtk_grid *grid; /* of a .vti file, all of whose arrays are cell data; NULL: .vtp */
} se3di_vtk_file;

/* The place that a file goes to. */
typedef struct se3di_vtk_target {
    const char *path;
    int compression; /* 1 ... 9; 0: none */
    const se3d_allocator *allocator;
} se3di_vtk_target;

/* Write it under a temporary name, then rename: as XML, or, if the path ends with .vtkhdf, as HDF5;
 * this and compression need memory. @return false: errno says why. */
bool se3di_vtk_file_write(const se3di_vtk_file *file, const se3di_vtk_target *to);
/* As HDF5, in vtk_hdf5.c. */
bool se3di_vtk_file_write_hdf5(const se3di_vtk_file *file, const se3di_vtk_target *to);

#endif
