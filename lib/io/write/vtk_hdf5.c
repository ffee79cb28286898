/* SPDX-License-Identifier: BSD-3-Clause */
/* VTKHDF, version 1.0: an UnstructuredGrid of points, lines and polygons, or an ImageData whose
 * points are the middles of the cells: VTK 9.1 cannot read data of the cells themselves. */
#include <errno.h>
#include <stdint.h>
#include <string.h>

#include "io/write/hdf5.h"
#include "io/write/vtk_file.h"

enum { BLOCK = 4096, VERTEX = 1, LINE = 3, TRIANGLE = 5, QUAD = 9 };

/* Values first, first + 1, ... of an array; returns where the next ones go. */
static uint64_t write_values(se3di_hdf5 *h, size_t node, uint64_t at, const se3di_vtk_array *a,
                             const se3di_hdf5_shape *shape, double offset)
{
    unsigned char block[8 * BLOCK];
    const size_t size = se3di_hdf5_size_of(shape);
    size_t used = 0;
    for (size_t k = 0; k < a->count; ++k) {
        for (size_t i = 0; i < a->width; ++i) {
            se3di_hdf5_put_value(block + used, shape->type, se3di_vtk_value(a, k, i) + offset);
            used += size;
            if (used + size > sizeof block) {
                se3di_hdf5_write(h, node, at, block, used);
                at += used;
                used = 0;
            }
        }
    }
    se3di_hdf5_write(h, node, at, block, used);
    return at + used;
}

/* Data of points or cells, or the points. Those of a grid have its dimensions, x last. */
static void put_array(se3di_hdf5 *h, size_t group, const char *name, const se3di_vtk_array *a,
                      const se3di_vtk_grid *grid)
{
    se3di_hdf5_shape shape = {a->whole ? SE3DI_HDF5_INT32 : SE3DI_HDF5_SINGLE, 0, 0, {0}, 0};
    for (int k = 2; grid && k >= 0; --k) {
        shape.dims[shape.rank++] = (uint64_t)grid->cells[k];
    }
    if (!grid) {
        shape.dims[shape.rank++] = a->count;
    }
    if (a->width > 1) {
        shape.dims[shape.rank++] = a->width;
    }
    write_values(h, se3di_hdf5_add_array(h, group, name, &shape), 0, a, &shape, 0.0);
}

static void put_data(se3di_hdf5 *h, size_t group, const se3di_vtk_file *f,
                     se3di_vtk_section section, const char *name)
{
    const size_t data = se3di_hdf5_add_group(h, group, name);
    for (size_t k = 0; k < f->array_count; ++k) {
        if (f->arrays[k].section == section) {
            put_array(h, data, f->arrays[k].name, &f->arrays[k], f->grid);
        }
    }
}

static size_t count_of(const se3di_vtk_file *f, se3di_vtk_section section)
{
    return section == SE3DI_VTK_VERTS ? f->verts : section == SE3DI_VTK_LINES ? f->lines : f->polys;
}

/* Connectivity or offsets of a section. */
static const se3di_vtk_array *find_array(const se3di_vtk_file *f, se3di_vtk_section section,
                                         bool is_connectivity)
{
    static const se3di_vtk_array none = {.count = 0};
    for (size_t k = 0; k < f->array_count; ++k) {
        const se3di_vtk_array *a = &f->arrays[k];
        if (a->section == section && (strcmp(a->name, "connectivity") == 0) == is_connectivity) {
            return a;
        }
    }
    return &none;
}

static size_t polygon_corners(const se3di_vtk_file *f)
{
    return find_array(f, SE3DI_VTK_POLYS, true)->count / f->polys;
}

static void put_count(se3di_hdf5 *h, size_t group, const char *name, size_t count)
{
    const se3di_hdf5_shape shape = {SE3DI_HDF5_INT64, 0, 1, {1}, 0};
    unsigned char bytes[8];
    se3di_hdf5_put_value(bytes, shape.type, (double)count);
    se3di_hdf5_write(h, se3di_hdf5_add_array(h, group, name, &shape), 0, bytes, sizeof bytes);
}

/* Vertices, lines and polygons, one after the other; these have three or four corners. */
static void put_cells(se3di_hdf5 *h, size_t group, const se3di_vtk_file *f)
{
    static const se3di_vtk_section sections[3] = {SE3DI_VTK_VERTS, SE3DI_VTK_LINES,
                                                  SE3DI_VTK_POLYS};
    const size_t each = f->polys > 0 ? polygon_corners(f) : 3;
    const double types[3] = {VERTEX, LINE, each == 4 ? QUAD : TRIANGLE};
    const size_t widths[3] = {1, 2, each};
    const size_t cells = f->verts + f->lines + f->polys;
    const size_t corners = f->verts + 2 * f->lines + each * f->polys;
    const se3di_hdf5_shape connectivity = {SE3DI_HDF5_INT64, 0, 1, {corners}, 0};
    const se3di_hdf5_shape offsets = {SE3DI_HDF5_INT64, 0, 1, {cells + 1}, 0};
    const se3di_hdf5_shape kinds = {SE3DI_HDF5_UINT8, 0, 1, {cells}, 0};
    const size_t to = se3di_hdf5_add_array(h, group, "Connectivity", &connectivity);
    const size_t ends = se3di_hdf5_add_array(h, group, "Offsets", &offsets);
    const size_t type = se3di_hdf5_add_array(h, group, "Types", &kinds);
    const se3di_vtk_array zero = {.count = 1, .width = 1};
    uint64_t at = 0, end = write_values(h, ends, 0, &zero, &offsets, 0.0), kind = 0;
    double before = 0.0;
    for (int s = 0; s < 3; ++s) {
        const size_t count = count_of(f, sections[s]);
        const se3di_vtk_array same = {.count = count, .width = 1, .first = types[s]};
        if (count > 0) {
            at = write_values(h, to, at, find_array(f, sections[s], true), &connectivity, 0.0);
            end = write_values(h, ends, end, find_array(f, sections[s], false), &offsets, before);
            kind = write_values(h, type, kind, &same, &kinds, 0.0);
        }
        before += (double)(count * widths[s]);
    }
    put_count(h, group, "NumberOfPoints", f->points);
    put_count(h, group, "NumberOfCells", cells);
    put_count(h, group, "NumberOfConnectivityIds", corners);
}

static void put_type(se3di_hdf5 *h, size_t group, const char *type)
{
    const se3di_hdf5_shape text = {SE3DI_HDF5_TEXT, strlen(type), 0, {0}, 0};
    const se3di_hdf5_shape two = {SE3DI_HDF5_INT64, 0, 1, {2}, 0};
    static const double version[2] = {1.0, 0.0};
    se3di_hdf5_add_attribute(h, group, "Version", &two, version);
    se3di_hdf5_add_attribute(h, group, "Type", &text, type);
}

static void put_image(se3di_hdf5 *h, size_t group, const se3di_vtk_grid *grid)
{
    const se3di_hdf5_shape extent = {SE3DI_HDF5_INT64, 0, 1, {6}, 0};
    const se3di_hdf5_shape three = {SE3DI_HDF5_DOUBLE, 0, 1, {3}, 0};
    const se3di_hdf5_shape nine = {SE3DI_HDF5_DOUBLE, 0, 1, {9}, 0};
    static const double unit[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    double whole[6], middle[3];
    for (int k = 0; k < 3; ++k) {
        whole[2 * k] = 0.0;
        whole[2 * k + 1] = grid->cells[k] - 1.0;
        middle[k] = grid->origin[k] + 0.5 * grid->spacing[k];
    }
    se3di_hdf5_add_attribute(h, group, "WholeExtent", &extent, whole);
    se3di_hdf5_add_attribute(h, group, "Origin", &three, middle);
    se3di_hdf5_add_attribute(h, group, "Spacing", &three, grid->spacing);
    se3di_hdf5_add_attribute(h, group, "Direction", &nine, unit);
}

bool se3di_vtk_file_write_hdf5(const se3di_vtk_file *f, const se3di_vtk_target *to)
{
    se3di_hdf5 h;
    if (!se3di_hdf5_open(&h, to->allocator, to->path, to->compression)) {
        return false;
    }
    const size_t group = se3di_hdf5_add_group(&h, 0, "VTKHDF");
    put_type(&h, group, f->grid ? "ImageData" : "UnstructuredGrid");
    if (f->grid) {
        put_image(&h, group, f->grid);
    } else {
        for (size_t k = 0; k < f->array_count; ++k) {
            if (f->arrays[k].section == SE3DI_VTK_POINTS) {
                put_array(&h, group, "Points", &f->arrays[k], NULL);
            }
        }
        put_cells(&h, group, f);
        put_data(&h, group, f, SE3DI_VTK_POINT_DATA, "PointData");
    }
    put_data(&h, group, f, SE3DI_VTK_CELL_DATA, f->grid ? "PointData" : "CellData");
    return se3di_hdf5_close(&h);
}
