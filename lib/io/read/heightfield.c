/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/read/heightfield.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/model/model.h"
#include "io/read/height_grid.h"
#include "io/read/objects.h"

static bool read_number(se3di_reader *reader, const se3di_node *shape, const char *key,
                        double *value)
{
    return se3di_read_key(reader, shape, &se3di_object_shape, "heightfield", key, value);
}

static bool read_spacing(se3di_reader *reader, const se3di_node *shape, double spacing[2])
{
    if (!se3di_node_get(shape, "spacing")) {
        return se3di_reader_fail_key(reader, shape, "spacing",
                                     "is missing, a heightfield needs it");
    }
    if (!read_number(reader, shape, "spacing", &spacing[0])) {
        return false;
    }
    spacing[1] = spacing[0];
    return read_number(reader, shape, "row_spacing", &spacing[1]);
}

static bool read_count(se3di_reader *reader, const se3di_node *shape, const char *key,
                       size_t *count)
{
    double value = 0.0;
    if (!read_number(reader, shape, key, &value)) {
        return false;
    }
    *count = (size_t)value;
    return *count >= 2 || se3di_reader_fail_key(reader, shape, key,
                                                "is %zu, an expression of heights needs at least "
                                                "two rows and two columns",
                                                *count);
}

/* Counts belong to expressions; others have their own. */
static bool check_no_counts(se3di_reader *reader, const se3di_node *shape)
{
    static const char *const keys[] = {"rows", "columns"};
    for (size_t k = 0; k < 2; ++k) {
        if (se3di_node_get(shape, keys[k])) {
            return se3di_reader_fail_key(reader, shape, keys[k],
                                         "is of an expression: heights that are listed have as "
                                         "many as there are");
        }
    }
    return true;
}

static bool read_heights(se3di_reader *reader, const se3di_node *shape, const double spacing[2],
                         se3di_height_grid *grid)
{
    const se3di_node *heights = se3di_node_get(shape, "heights");
    const se3di_node *file = se3di_node_get(shape, "file");
    *grid = (se3di_height_grid){NULL, 0, 0};
    if (!heights == !file) {
        return se3di_reader_fail_key(reader, shape, "heights",
                                     file ? "and `file` exclude each other"
                                          : "is missing, a heightfield needs it or `file`");
    }
    if (file) {
        return check_no_counts(reader, shape) && se3di_read_grid_file(reader, shape, "file", grid);
    }
    if (heights->kind == SE3DI_NODE_LIST) {
        return check_no_counts(reader, shape) && se3di_read_grid_rows(reader, heights, grid);
    }
    if (heights->kind != SE3DI_NODE_SCALAR || se3di_node_is_null(heights)) {
        return se3di_reader_fail(reader, heights,
                                 "must be a list of rows of numbers or an expression in x and y");
    }
    return read_count(reader, shape, "rows", &grid->row_count) &&
           read_count(reader, shape, "columns", &grid->column_count) &&
           se3di_read_grid_function(reader, heights, spacing, grid);
}

/* As the core has them, see se3d_shape_create_heightfield. */
static void put_points(const se3di_height_grid *grid, const double spacing[2], se3di_mesh *mesh)
{
    const size_t columns = grid->column_count, rows = grid->row_count;
    for (size_t k = 0; k < rows * columns; ++k) {
        double *p = mesh->points + 3 * k;
        const size_t column = k % columns, row = k / columns;
        p[0] = ((double)column - 0.5 * (double)(columns - 1)) * spacing[0];
        p[1] = ((double)row - 0.5 * (double)(rows - 1)) * spacing[1];
        p[2] = grid->heights[k];
        for (int i = 0; i < 3; ++i) {
            mesh->low[i] = k == 0 ? p[i] : fmin(mesh->low[i], p[i]);
            mesh->high[i] = k == 0 ? p[i] : fmax(mesh->high[i], p[i]);
        }
    }
}

static void put_triangles(const se3di_height_grid *grid, se3di_mesh *mesh)
{
    uint32_t *t = mesh->triangles;
    for (size_t i = 0; i + 1 < grid->row_count; ++i) {
        for (size_t j = 0; j + 1 < grid->column_count; ++j, t += 6) {
            const uint32_t a = (uint32_t)(i * grid->column_count + j);
            const uint32_t b = a + (uint32_t)grid->column_count;
            const uint32_t corners[6] = {a, a + 1, b + 1, a, b + 1, b};
            memcpy(t, corners, sizeof corners);
        }
    }
}

static se3di_mesh *make_mesh(se3di_reader *reader, const se3di_height_grid *grid,
                             const double spacing[2])
{
    se3di_iopool *pool = &reader->model->pool;
    se3di_mesh *mesh = se3di_iopool_alloc(pool, sizeof *mesh);
    if (!mesh) {
        return NULL;
    }
    memset(mesh, 0, sizeof *mesh);
    mesh->file = mesh->model = "";
    mesh->mirror = -1;
    mesh->scale = 1.0;
    mesh->heights = grid->heights;
    mesh->row_count = grid->row_count;
    mesh->column_count = grid->column_count;
    memcpy(mesh->spacing, spacing, sizeof mesh->spacing);
    mesh->point_count = grid->row_count * grid->column_count;
    mesh->triangle_count = 2 * (grid->row_count - 1) * (grid->column_count - 1);
    mesh->points = se3di_iopool_array(pool, mesh->point_count, 3 * sizeof *mesh->points);
    mesh->triangles = se3di_iopool_array(pool, mesh->triangle_count, 3 * sizeof *mesh->triangles);
    if (!mesh->points || !mesh->triangles) {
        return NULL;
    }
    put_points(grid, spacing, mesh);
    put_triangles(grid, mesh);
    return mesh;
}

/* Instances of a part have the same node, but not always the same heights: these may depend on
 * parameters. */
static const se3di_mesh *find_same(const se3d_model *model, const se3di_node *shape,
                                   const se3di_height_grid *grid, const double spacing[2])
{
    const size_t bytes = grid->row_count * grid->column_count * sizeof *grid->heights;
    const se3di_mesh *known = model->meshes;
    while (known &&
           !(known->of == shape && known->mirror < 0 && known->row_count == grid->row_count &&
             known->column_count == grid->column_count &&
             memcmp(known->spacing, spacing, sizeof known->spacing) == 0 &&
             memcmp(known->heights, grid->heights, bytes) == 0)) {
        known = known->next;
    }
    return known;
}

const se3di_mesh *se3di_read_heightfield(se3di_reader *reader, const se3di_node *shape)
{
    se3d_model *model = reader->model;
    se3di_height_grid grid;
    double spacing[2];
    if (!read_spacing(reader, shape, spacing) || !read_heights(reader, shape, spacing, &grid)) {
        return NULL;
    }
    const se3di_mesh *known = find_same(model, shape, &grid, spacing);
    if (known) {
        return known;
    }
    se3di_mesh *mesh = make_mesh(reader, &grid, spacing);
    if (!mesh) {
        se3di_reader_fail_memory(reader);
        return NULL;
    }
    mesh->of = shape;
    mesh->next = model->meshes;
    model->meshes = mesh;
    return mesh;
}
