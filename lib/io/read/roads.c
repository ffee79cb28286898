/* SPDX-License-Identifier: BSD-3-Clause */
/* `roads`: surfaces under tyres. */
#include <string.h>

#include "io/base/pool.h"
#include "io/document/amount.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/function.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/model/model.h"
#include "io/read/bodies.h"
#include "io/read/elements.h"
#include "io/read/entries.h"
#include "io/read/height_grid.h"
#include "io/read/mesh_file.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

static const char *const frames[] = {"ground", "body", NULL};
static const char *const road_types[] = {"plane", "height", "heightfield", "mesh", NULL};

typedef struct road_values {
    double spacing, row_spacing, scale;
    const char *file;
} road_values;

/* clang-format off */
static const se3di_key road_keys[] = {
    {"name", SE3DI_KIND_NAME, .standard = "road1, road2, ...",
     .text = "unique among joints, drivers, constraints, forces, wheels and roads"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"type", SE3DI_KIND_TYPE, .required = true, .text = ""},
    {"body", SE3DI_KIND_BODY, .standard = "ground", .text = "that the road is fixed to"},
    {"at", SE3DI_KIND_VECTOR, .standard = "[0, 0, 0]",
     .text = "origin of the road's x, y, z at the given pose, ground frame [m]"},
    {"point", SE3DI_KIND_POINT, .text = "in place of at: in the frame of the body [m]"},
    {"frame", SE3DI_KIND_WORD, .words = frames, .standard = "ground",
     .text = "of normal and forward"},
    {"normal", SE3DI_KIND_DIRECTION, .standard = "[0, 0, 1]",
     .text = "its z, at the given pose"},
    {"forward", SE3DI_KIND_DIRECTION, .standard = "[1, 0, 0]",
     .text = "its x, at the given pose, as far as it is not along the normal"},
    {"height", SE3DI_KIND_FUNCTION, .types = " height ", .required = true,
     .text = "z over t, x and y: an expression, or a table over the time t [m]"},
    {"heights", SE3DI_KIND_ROWS, .types = " heightfield ",
     .text = "rows of heights along x, the rows along y, the middle at the origin [m]; or file"},
    {"file", SE3DI_KIND_TEXT, SE3DI_INTO(road_values, file), .types = " heightfield mesh ",
     .text = "relative to the model file; heightfield: CSV, a row on each line; mesh: STL or OBJ"},
    {"spacing", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(road_values, spacing),
     .types = " heightfield ", .required = true, .text = "between columns, along x [m]"},
    {"row_spacing", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(road_values, row_spacing),
     .types = " heightfield ", .standard = "spacing", .text = "between rows, along y [m]"},
    {"scale", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(road_values, scale),
     .types = " mesh ", .standard = "1", .text = "factor, to metres"},
    {.key = NULL}};
const se3di_object se3di_object_road = {
    "road",
    "A road under tyres.",
    road_keys, road_types,
    NULL};
/* clang-format on */

/* The frame of a road in a part that is mirrored has its z and x where these are mirrored; so y is
 * the other way round, and heights over y are turned round with it. */
static bool is_reflected(const se3di_reader *reader)
{
    return se3di_placement_is_reflected(&reader->part->place);
}

static const double *reflect_rows(se3di_reader *reader, const se3di_height_grid *grid)
{
    const size_t columns = grid->column_count;
    double *heights = se3di_iopool_array(reader->pool, grid->row_count * columns, sizeof *heights);
    for (size_t k = 0; heights && k < grid->row_count; ++k) {
        memcpy(heights + k * columns, grid->heights + (grid->row_count - 1 - k) * columns,
               columns * sizeof *heights);
    }
    return heights;
}

static const double *reflect_points(se3di_reader *reader, const se3di_mesh *mesh)
{
    double *points = se3di_iopool_array(reader->pool, 3 * mesh->point_count, sizeof *points);
    for (size_t k = 0; points && k < 3 * mesh->point_count; ++k) {
        points[k] = k % 3 == 1 ? 0.0 - mesh->points[k] : mesh->points[k];
    }
    return points;
}

static bool has_name(const char *text, const char *name)
{
    size_t length = 0;
    const char *at = se3di_amount_next_name(text, &length);
    while (at && (length != strlen(name) || strncmp(at, name, length) != 0)) {
        at = se3di_amount_next_name(at + length, &length);
    }
    return at != NULL;
}

static bool read_heightfield(se3di_reader *reader, const se3di_node *node, const road_values *v,
                             se3d_road_def *def)
{
    const se3di_node *heights = se3di_node_get(node, "heights");
    se3di_height_grid grid = {NULL, 0, 0};
    if ((heights != NULL) == (v->file != NULL)) {
        return se3di_reader_fail_key(reader, node, "heights", "must be given, or file, not both");
    }
    if (!(v->spacing > 0.0)) {
        return se3di_reader_fail_key(reader, node, "spacing",
                                     "is missing, must be the distance of points [m] > 0");
    }
    if (heights && heights->kind != SE3DI_NODE_LIST) {
        return se3di_reader_fail(reader, heights, "is %s, must be a list of rows",
                                 se3di_node_describe(heights));
    }
    if (!(heights ? se3di_read_grid_rows(reader, heights, &grid)
                  : se3di_read_grid_file(reader, node, "file", &grid))) {
        return false;
    }
    def->heights = is_reflected(reader) ? reflect_rows(reader, &grid) : grid.heights;
    if (!def->heights) {
        return se3di_reader_fail_memory(reader);
    }
    def->column_count = grid.column_count;
    def->row_count = grid.row_count;
    def->spacing[0] = v->spacing;
    def->spacing[1] = v->row_spacing > 0.0 ? v->row_spacing : v->spacing;
    return true;
}

static bool read_height(se3di_reader *reader, const se3di_node *node, se3d_road_def *def)
{
    static const char *const variables[] = {"t", "x", "y", NULL};
    const se3di_node *height = se3di_node_get(node, "height");
    se3d_function_def constant = se3d_function_def_default();
    if (!height) {
        return se3di_reader_fail_key(reader, node, "height",
                                     "is missing, must be z over t, x and y [m]");
    }
    if (is_reflected(reader) && height->kind == SE3DI_NODE_SCALAR && has_name(height->text, "y")) {
        return se3di_reader_fail(reader, height,
                                 "has y in a part that is mirrored: put the road into the model, "
                                 "or give a heightfield");
    }
    if (!se3di_read_function(reader, height, variables, &constant.constant, &def->height)) {
        return false;
    }
    if (def->height.index1 == 0 &&
        SE3D_FAILED(se3d_function_create(reader->system, &constant, &def->height))) {
        return se3di_reader_fail_memory(reader);
    }
    return true;
}

static bool read_mesh(se3di_reader *reader, const se3di_node *node, const road_values *v,
                      se3d_road_def *def, const se3di_mesh **surface)
{
    if (!v->file) {
        return se3di_reader_fail_key(reader, node, "file", "is missing, must be an STL or OBJ");
    }
    const se3di_mesh *mesh = se3di_read_mesh(reader, node, v->file, v->scale);
    if (!mesh) {
        return false;
    }
    *surface = mesh;
    mesh = mesh->source ? mesh->source : mesh; /* mirrored for shapes of bodies */
    def->vertices = is_reflected(reader) ? reflect_points(reader, mesh) : mesh->points;
    if (!def->vertices) {
        return se3di_reader_fail_memory(reader);
    }
    def->vertex_count = mesh->point_count;
    def->triangles = mesh->triangles;
    def->triangle_count = mesh->triangle_count;
    return true;
}

static bool read_origin(se3di_reader *reader, const se3di_node *node, const se3di_body_entry *body,
                        se3d_road_def *def)
{
    double at[3] = {0.0, 0.0, 0.0};
    if (se3di_node_get(node, "point")) {
        return se3di_read_key_place(reader, node, "point", "at", body, def->point);
    }
    se3di_place_point(&reader->part->place, at);
    return se3di_read_key_ground_point(reader, node, "at", at) &&
           se3di_ground_to_body(reader, def->body, at, def->point);
}

/* A direction, in the frame that is said or the ground's; the definition has its default. */
static bool read_axis(se3di_reader *reader, const se3di_node *node, const char *key,
                      const se3di_body_entry *body, double axis[3])
{
    int32_t frame = 0;
    if (!se3di_read_key(reader, node, &se3di_object_road, NULL, "frame", &frame)) {
        return false;
    }
    if (frame != 0) {
        return se3di_read_key_body_direction(reader, node, key, body, false, axis);
    }
    double v[3] = {axis[0], axis[1], axis[2]};
    se3di_place_vector(&reader->part->place, v);
    return se3di_read_key_ground_direction(reader, node, key, false, v) &&
           se3di_ground_to_body_direction(reader, body->body, v, axis);
}

static bool read_frame(se3di_reader *reader, const se3di_node *node, se3d_road_def *def)
{
    const se3di_body_entry *body = &reader->model->bodies[0]; /* the ground */
    if (se3di_node_get(node, "body") && !se3di_read_key_body(reader, node, "body", &body)) {
        return false;
    }
    def->body = body->body;
    return read_origin(reader, node, body, def) &&
           read_axis(reader, node, "normal", body, def->normal) &&
           read_axis(reader, node, "forward", body, def->forward);
}

static bool read_road(se3di_reader *reader, const se3di_node *node)
{
    const char *type = NULL;
    se3di_element_entry *entry = NULL;
    se3d_road_def def = se3d_road_def_default();
    road_values v = {.scale = 1.0};
    if (!se3di_read_type(reader, node, &se3di_object_road, &type) ||
        !se3di_read_element(reader, node, SE3DI_ELEMENT_ROAD, &entry) ||
        !read_frame(reader, node, &def) ||
        !se3di_read_fields(reader, node, &se3di_object_road, type, "road_values", &v)) {
        return false;
    }
    def.name = entry->name;
    if ((strcmp(type, "height") == 0 && !read_height(reader, node, &def)) ||
        (strcmp(type, "heightfield") == 0 && !read_heightfield(reader, node, &v, &def)) ||
        (strcmp(type, "mesh") == 0 && !read_mesh(reader, node, &v, &def, &entry->surface))) {
        return false;
    }
    entry->body_i = def.body;
    entry->height = def.height;
    entry->heights = def.heights;
    entry->row_count = def.row_count;
    entry->column_count = def.column_count;
    memcpy(entry->point_i, def.point, sizeof entry->point_i);
    memcpy(entry->axis_i, def.normal, sizeof entry->axis_i);
    memcpy(entry->axis_j, def.forward, sizeof entry->axis_j);
    return se3di_reader_check(reader, node, se3d_road_create(reader->system, &def, &entry->road));
}

bool se3di_read_roads(se3di_reader *reader, const se3di_node *root)
{
    return se3di_read_each(reader, root, "roads", read_road);
}
