/* SPDX-License-Identifier: BSD-3-Clause */
/* Heights over a grid. Vertex (i, j) is at
 *
 *     x = (j - (columns - 1) / 2) dx,   y = (i - (rows - 1) / 2) dy,   z = heights[columns i + j]
 *
 * and a cell is cut from (i, j) to (i + 1, j + 1), its triangles counter-clockwise seen from above.
 * It is a mesh to all that touches it; a search near a place visits the cells there, one from afar
 * goes through boxes as in any mesh.                                     docs/theory/shapes.md */
#include "contact/shape/grid.h"
#include "contact/shape/mesh.h"
#include "contact/shape/mesh_tree.h"
#include "contact/shape/triangles.h"

#include <math.h>
#include <string.h>

#define CELLS_MOST    (UINT32_MAX / 64)
#define SPACING_LEAST 1e-9 /* m */

static void fill_vertices(const double *heights, se3di_shape *s)
{
    for (uint32_t i = 0; i < s->rows; ++i) {
        for (uint32_t j = 0; j < s->columns; ++j) {
            const size_t k = (size_t)i * s->columns + j;
            s->vertices[3 * k] = ((double)j - 0.5 * (double)(s->columns - 1)) * s->spacing[0];
            s->vertices[3 * k + 1] = ((double)i - 0.5 * (double)(s->rows - 1)) * s->spacing[1];
            s->vertices[3 * k + 2] = heights[k];
        }
    }
}

static void fill_triangles(se3di_shape *s)
{
    uint32_t *t = s->triangles;
    for (uint32_t i = 0; i + 1 < s->rows; ++i) {
        for (uint32_t j = 0; j + 1 < s->columns; ++j, t += 6) {
            const uint32_t a = i * s->columns + j, b = a + s->columns;
            const uint32_t corners[6] = {a, a + 1, b + 1, a, b + 1, b};
            memcpy(t, corners, sizeof corners);
        }
    }
}

typedef struct builder {
    const se3di_shape *shape;
    se3di_mesh_node *nodes;
    uint32_t count;
} builder;

static void bound_cells(const se3di_shape *s, const se3di_grid_cells *c, se3di_mesh_node *node)
{
    const double *first = s->vertices + 3 * ((size_t)c->row[0] * s->columns + c->column[0]);
    const double *last = s->vertices + 3 * ((size_t)c->row[1] * s->columns + c->column[1]);
    memcpy(node->low, first, sizeof node->low);
    memcpy(node->high, last, sizeof node->high);
    for (uint32_t i = c->row[0]; i <= c->row[1]; ++i) {
        for (uint32_t j = c->column[0]; j <= c->column[1]; ++j) {
            const double z = s->vertices[3 * ((size_t)i * s->columns + j) + 2];
            node->low[2] = fmin(node->low[2], z);
            node->high[2] = fmax(node->high[2], z);
        }
    }
}

/* A box holds the boxes of its children. */
static void unite(const se3di_mesh_node *a, const se3di_mesh_node *b, se3di_mesh_node *both)
{
    for (int k = 0; k < 3; ++k) {
        both->low[k] = fmin(a->low[k], b->low[k]);
        both->high[k] = fmax(a->high[k], b->high[k]);
    }
}

/* Halve the longer side down to leaves, cells beside each other in one row. */
static void build(builder *b, const se3di_grid_cells *c)
{
    const uint32_t rows = c->row[1] - c->row[0], columns = c->column[1] - c->column[0];
    const uint32_t at = b->count++;
    if (rows == 1 && 2 * columns <= SE3DI_MESH_LEAF) {
        const uint32_t cell = c->row[0] * (b->shape->columns - 1) + c->column[0];
        se3di_mesh_node leaf = {.begin = 2 * cell, .count = 2 * columns};
        bound_cells(b->shape, c, &leaf);
        b->nodes[at] = leaf;
        return;
    }
    se3di_grid_cells low = *c, high = *c;
    if (rows > 1 && (columns == 1 || rows >= columns)) {
        low.row[1] = high.row[0] = c->row[0] + rows / 2;
    } else {
        low.column[1] = high.column[0] = c->column[0] + columns / 2;
    }
    se3di_mesh_node node = {.count = 0};
    build(b, &low);
    node.right = b->count;
    build(b, &high);
    unite(&b->nodes[at + 1], &b->nodes[node.right], &node);
    b->nodes[at] = node;
}

static se3d_status fill(const se3d_allocator *allocator, const double *heights, se3di_shape *s)
{
    const size_t cells = (size_t)(s->rows - 1) * (s->columns - 1);
    const size_t vertices = (size_t)s->rows * s->columns;
    s->vertices = se3di_alloc(allocator, 3 * vertices, sizeof *s->vertices);
    s->vertex_count = s->vertices ? vertices : 0;
    s->triangles = se3di_alloc(allocator, 6 * cells, sizeof *s->triangles);
    s->triangle_count = s->triangles ? 2 * cells : 0;
    se3di_mesh_node *nodes = se3di_alloc(allocator, 2 * cells, sizeof *nodes);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    if (s->vertices && s->triangles && nodes) {
        builder b = {s, nodes, 0};
        const se3di_grid_cells all = {{0, s->rows - 1}, {0, s->columns - 1}};
        fill_vertices(heights, s);
        fill_triangles(s);
        build(&b, &all);
        s->tree = se3di_alloc(allocator, b.count, sizeof *nodes);
        s->tree_bytes = s->tree ? b.count * sizeof *nodes : 0;
        if (s->tree) {
            memcpy(s->tree, nodes, s->tree_bytes);
            status = SE3D_OK;
        }
    }
    se3di_free(allocator, nodes, 2 * cells, sizeof *nodes);
    return status;
}

/* Cells must have an area. */
static se3d_status check_side(size_t count, double spacing, int axis, se3di_error *error)
{
    if (count < 2 || count > CELLS_MOST) {
        return se3di_error_set_of(error, axis ? "row_count" : "column_count",
                                  SE3D_ERR_INVALID_ARGUMENT, " = %zu, must be from 2 to %u", count,
                                  CELLS_MOST);
    }
    if (!isfinite(spacing) || !(spacing >= SPACING_LEAST)) {
        return se3di_error_set(error, SE3D_ERR_INVALID_ARGUMENT,
                               "spacing[%d] = %g m, must be finite and at least %g", axis, spacing,
                               SPACING_LEAST);
    }
    return SE3D_OK;
}

static se3d_status check_grid(const se3d_shape_def *def, se3di_error *error)
{
    SE3DI_TRY(check_side(def->column_count, def->spacing[0], 0, error));
    SE3DI_TRY(check_side(def->row_count, def->spacing[1], 1, error));
    if (def->row_count > CELLS_MOST / def->column_count) {
        return se3di_error_set(error, SE3D_ERR_INVALID_ARGUMENT,
                               "row_count * column_count = %zu * %zu, must be at most %u",
                               def->row_count, def->column_count, CELLS_MOST);
    }
    SE3DI_TRY(se3di_shape_check_array(def->heights, "heights", error));
    for (size_t k = 0; k < def->row_count * def->column_count; ++k) {
        if (!isfinite(def->heights[k])) {
            return se3di_error_set(error, SE3D_ERR_INVALID_ARGUMENT,
                                   "heights[%zu] = %g m, must be finite", k, def->heights[k]);
        }
    }
    return SE3D_OK;
}

static se3d_status define_heightfield(const se3d_shape_def *def, const se3d_allocator *allocator,
                                      se3di_shape *shape, se3di_error *error)
{
    SE3DI_TRY(check_grid(def, error));
    shape->rows = (uint32_t)def->row_count;
    shape->columns = (uint32_t)def->column_count;
    memcpy(shape->spacing, def->spacing, sizeof shape->spacing);
    shape->oriented = 1;
    const se3d_status status = fill(allocator, def->heights, shape);
    if (status < 0) {
        char *name = shape->name; /* the caller's */
        shape->name = NULL;
        se3di_shape_release(allocator, shape);
        shape->name = name;
        return se3di_error_set(error, status, "no memory for a heightfield");
    }
    return SE3D_OK;
}

const se3di_shape_class se3di_shape_class_heightfield = {
    .name = "heightfield",
    .define = define_heightfield,
    .bound = se3di_vertices_bound,
    .size = se3di_vertices_size,
    .nearest = se3di_mesh_nearest_point,
    .support = se3di_vertices_support,
};
