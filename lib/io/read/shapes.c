/* SPDX-License-Identifier: BSD-3-Clause */
/* `shapes` and `materials`: what bodies look like, and what they weigh if no mass is given. */
#include "io/read/shapes.h"

#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/guess.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/heightfield.h"
#include "io/read/include.h"
#include "io/read/mesh_file.h"
#include "io/read/objects.h"
#include "io/read/sections.h"
#include "io/read/shape_kinds.h"
#include "io/read/solid.h"

static bool require(se3di_reader *reader, const se3di_node *node, const char *key)
{
    if (se3di_node_get(node, key)) {
        return true;
    }
    const char *type = se3di_node_get(node, "type")->text;
    return se3di_reader_fail_key(reader, node, key, "is missing, %s %s needs it",
                                 type[0] == 'e' ? "an" : "a", type);
}

static bool read_required(se3di_reader *reader, const se3di_node *node, const char *key,
                          double *value)
{
    return require(reader, node, key) &&
           se3di_read_key(reader, node, &se3di_object_shape, NULL, key, value);
}

/* Three lengths; `one` of them. */
static bool read_lengths(se3di_reader *reader, const se3di_node *node, const char *key,
                         const char *one, double size[3])
{
    if (!read_required(reader, node, key, size)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        if (!(size[k] > 0.0)) {
            return se3di_reader_fail_key(reader, node, key, "is [%g, %g, %g], each %s must be > 0",
                                         size[0], size[1], size[2], one);
        }
    }
    return true;
}

/* The plane's normal is its z axis. */
static bool read_plane(se3di_reader *reader, const se3di_node *node, se3d_model_shape *shape)
{
    double n[3] = {0.0, 0.0, 1.0};
    if (!se3di_read_key(reader, node, &se3di_object_shape, NULL, "normal", n)) {
        return false;
    }
    if (!se3di_node_get(node, "normal")) {
        return true;
    }
    if (se3di_node_get(node, "orientation")) {
        return se3di_reader_fail_key(reader, node, "normal",
                                     "and `orientation` exclude each other");
    }
    const double across = io_hypot(n[0], n[1]);
    const double axis[3] = {across > 0.0 ? -n[1] : 1.0, across > 0.0 ? n[0] : 0.0, 0.0};
    se3di_rotation_from_axis(axis, io_atan2(across, n[2]), shape->orientation);
    return true;
}

static bool read_heights(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    entry->mesh = se3di_read_heightfield(reader, node);
    return entry->mesh != NULL;
}

static bool read_triangles(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    se3d_model_shape *shape = &entry->shape;
    if (!require(reader, node, "file") ||
        !se3di_read_key(reader, node, &se3di_object_shape, NULL, "file", (void *)&shape->file)) {
        return false;
    }
    entry->mesh = se3di_read_mesh(reader, node, shape->file, shape->scale);
    return entry->mesh != NULL;
}

/* The radii of a funnel, which has at least one. */
static bool read_ends(se3di_reader *reader, const se3di_node *node, se3d_model_shape *shape)
{
    return read_required(reader, node, "bottom_radius", &shape->bottom_radius) &&
           read_required(reader, node, "top_radius", &shape->top_radius) &&
           (shape->bottom_radius > 0.0 || shape->top_radius > 0.0 ||
            se3di_reader_fail_key(reader, node, "top_radius",
                                  "is 0 as `bottom_radius` is, one of them must be > 0"));
}

/* Whether all went well, as far as the kind of shape has this key. */
static bool read_needed(se3di_reader *reader, const se3di_node *node, uint32_t needed,
                        const char *key, double *value)
{
    return !needed || read_required(reader, node, key, value);
}

static bool read_dimensions(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    se3d_model_shape *shape = &entry->shape;
    const uint32_t keys = se3di_shape_row_of(shape)->keys;
    return read_needed(reader, node, keys & SE3DI_SHAPE_NEEDS_RADIUS, "radius", &shape->radius) &&
           read_needed(reader, node, keys & SE3DI_SHAPE_NEEDS_LENGTH, "length", &shape->length) &&
           (!(keys & SE3DI_SHAPE_NEEDS_SIZE) ||
            read_lengths(reader, node, "size", "edge", shape->size)) &&
           (!(keys & SE3DI_SHAPE_NEEDS_AXES) ||
            read_lengths(reader, node, "semi_axes", "of them", shape->semi_axes)) &&
           (!(keys & SE3DI_SHAPE_NEEDS_ENDS) || read_ends(reader, node, shape)) &&
           (!(keys & SE3DI_SHAPE_HAS_NORMAL) || read_plane(reader, node, shape)) &&
           (!(keys & SE3DI_SHAPE_HAS_HEIGHTS) || read_heights(reader, node, entry)) &&
           (!(keys & SE3DI_SHAPE_NEEDS_FILE) || read_triangles(reader, node, entry));
}

static bool read_color(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    const se3di_node *given = se3di_node_get(node, "color");
    double value[4] = {-1.0, -1.0, -1.0, 1.0};
    const size_t count = given && given->count == 4 ? 4 : 3;
    if (given && !se3di_read_vector(reader, given, count, value)) {
        return false;
    }
    for (size_t k = 0; k < count && given; ++k) {
        if (!(value[k] >= 0.0 && value[k] <= 1.0)) {
            return se3di_reader_fail_key(reader, node, "color",
                                         "has %g, must be red, green, blue and, of what is seen "
                                         "through, opacity, each from 0 to 1",
                                         value[k]);
        }
    }
    memcpy(entry->shape.color, value, sizeof entry->shape.color);
    entry->opacity = value[3];
    return true;
}

static bool read_shape(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    se3d_model_shape *shape = &entry->shape;
    size_t index = 0;
    static const se3d_model_shape standard = {
        .scale = 1.0, .orientation = {1.0, 0.0, 0.0, 0.0}, .color = {-1.0, -1.0, -1.0}, .file = ""};
    const char *type = NULL;
    if (!se3di_read_type(reader, node, &se3di_object_shape, &type)) {
        return false;
    }
    entry->mesh = NULL;
    entry->convex = 0;
    entry->style = SE3DI_STYLE_PAINT;
    *shape = standard;
    if (!se3di_read_word(reader, se3di_node_get(node, "type"), se3di_shape_names, &index)) {
        return false;
    }
    shape->type = se3di_shape_types[index];
    return se3di_read_fields(reader, node, &se3di_object_shape, type, "se3d_model_shape", shape) &&
           se3di_read_fields(reader, node, &se3di_object_shape, type, "se3di_shape_entry", entry) &&
           read_dimensions(reader, node, entry) && read_color(reader, node, entry);
}

/* The place of its part. A plane that is mirrored along its normal keeps the side it is on: its x
 * axis is turned round in place of z. */
static bool place_shape(se3di_reader *reader, bool on_ground, se3di_shape_entry *entry)
{
    const se3di_placement *place = &reader->part->place;
    se3d_model_shape *shape = &entry->shape;
    (on_ground ? se3di_place_point : se3di_flip_vector)(place, shape->position);
    (on_ground ? se3di_place_orientation : se3di_flip_orientation)(place, shape->orientation);
    if (place->mirror == 2 && shape->type == SE3D_SHAPE_PLANE) {
        const double p[4] = {shape->orientation[0], shape->orientation[1], shape->orientation[2],
                             shape->orientation[3]};
        shape->orientation[0] = 0.0 - p[2]; /* times half a turn about y */
        shape->orientation[1] = 0.0 - p[3];
        shape->orientation[2] = p[0];
        shape->orientation[3] = p[1];
    }
    if (se3di_shape_row_of(shape)->keys & SE3DI_SHAPE_NEEDS_ENDS) {
        if (place->mirror == 2) {
            const double bottom = shape->bottom_radius;
            shape->bottom_radius = shape->top_radius;
            shape->top_radius = bottom;
        }
        entry->mesh = se3di_make_funnel(reader, shape);
        return entry->mesh != NULL;
    }
    if (entry->mesh && place->mirror >= 0) {
        entry->mesh = se3di_mirror_mesh(reader, entry->mesh, place->mirror);
        return entry->mesh != NULL;
    }
    return true;
}

bool se3di_add_shape(se3di_reader *reader, const se3di_node *node, size_t entry,
                     const se3di_shape_entry *shape)
{
    se3d_model *model = reader->model;
    se3di_shape_entry *grown = se3di_iopool_grow(&model->pool, model->shapes, model->shape_count,
                                                 &model->shape_capacity, sizeof *grown);
    if (!grown) {
        return se3di_reader_fail_memory(reader);
    }
    model->shapes = grown;
    grown += model->shape_count++;
    *grown = *shape;
    grown->node = node;
    grown->part = reader->part;
    grown->shape.body = model->bodies[entry].body;
    return true;
}

/* Without contact shapes are drawn, and have a mass (se3di_read_shape_mass), but nothing else. */
static bool are_drawn_only(const se3d_model *model)
{
    static const char *const sections[] = {"contact", "particles", "sinks"};
    for (size_t k = 0; k < sizeof sections / sizeof *sections; ++k) {
        if (se3di_node_get(model->root, sections[k])) {
            return false;
        }
    }
    return true;
}

bool se3di_read_shapes(se3di_reader *reader, const se3di_node *body, size_t entry)
{
    const se3di_node *list = NULL;
    if (reader->study && are_drawn_only(reader->model)) {
        return true; /* a sample is not drawn */
    }
    if (!se3di_read_list(reader, body, "shapes", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        se3di_shape_entry made = {.node = NULL};
        if (!read_shape(reader, node, &made) || !place_shape(reader, entry == 0, &made) ||
            !se3di_add_shape(reader, node, entry, &made)) {
            return false;
        }
    }
    return true;
}

bool se3di_read_material_density(se3di_reader *reader, const se3di_node *node, double *density)
{
    const se3di_node *list = se3di_node_get(reader->model->root, "materials");
    const char *name = NULL;
    if (!se3di_read_text(reader, node, &name)) {
        return false;
    }
    se3di_guess guess = se3di_guess_begin(name);
    for (const se3di_node *material = list ? list->first : NULL; material;
         material = material->next) {
        const char *known = se3di_node_get(material, "name")->text;
        if (strcmp(known, name) == 0) {
            const se3di_component *part = reader->part;
            se3di_reader_enter(reader, reader->model->parts); /* materials are the model's */
            const bool good =
                se3di_read_key_number(reader, material, "density", SE3DI_POSITIVE, density);
            if (good) {
                se3di_reader_enter(reader, part);
            }
            return good;
        }
        se3di_guess_offer(&guess, known);
    }
    const char *meant = se3di_guess_get(&guess);
    se3di_reader_fail(reader, node, "no material is named `%.60s`%s%s%s", name,
                      meant ? ", did you mean `" : "; list it under `materials`",
                      meant ? meant : "", meant ? "`?" : "");
    return se3di_reader_propose(reader, meant);
}

/* Of the shape, else of the body, else of the shape's material; 0 if nobody says. */
static bool read_density(se3di_reader *reader, const se3di_node *body, const se3di_node *shape,
                         double *density)
{
    const se3di_node *material = se3di_node_get(shape, "material");
    *density = 0.0;
    if (material && !se3di_read_material_density(reader, material, density)) {
        return false;
    }
    return se3di_read_key(reader, body, &se3di_object_body, NULL, "density", density) &&
           se3di_read_key(reader, shape, &se3di_object_shape, NULL, "density", density);
}

/* Shapes of a body together, about its origin. */
typedef struct whole {
    double mass, moment[3], inertia[9];
    double size;
    bool has_mesh;
} whole;

/* Add a shape's: A J A^T + m (s.s I - s s^T), with the centre of mass at s = position + A centre.
 */
static void add_solid(const se3d_model_shape *shape, const se3di_solid *solid, whole *body)
{
    double A[9];
    double s[3];
    double half[9]; /* A J */
    se3di_rotation_to_matrix(shape->orientation, A);
    for (int i = 0; i < 3; ++i) {
        s[i] = shape->position[i];
        for (int j = 0; j < 3; ++j) {
            s[i] += A[3 * i + j] * solid->centre[j];
            half[3 * i + j] = A[3 * i] * solid->inertia[j] + A[3 * i + 1] * solid->inertia[3 + j] +
                              A[3 * i + 2] * solid->inertia[6 + j];
        }
    }
    const double square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            body->inertia[3 * i + j] += solid->mass * ((i == j ? square : 0.0) - s[i] * s[j]) +
                                        half[3 * i] * A[3 * j] + half[3 * i + 1] * A[3 * j + 1] +
                                        half[3 * i + 2] * A[3 * j + 2];
        }
        body->moment[i] += solid->mass * s[i];
        body->size += fabs(shape->position[i]);
    }
    body->mass += solid->mass;
    body->size += solid->size;
}

static bool check_centre(se3di_reader *reader, const se3di_node *node, const whole *body)
{
    const double exact = body->has_mesh ? 1e-7 : 1e-9; /* STL files have 24 bits */
    double c[3];
    for (int k = 0; k < 3; ++k) {
        c[k] = body->moment[k] / body->mass;
    }
    if (io_hypot(io_hypot(c[0], c[1]), c[2]) > exact * body->size) {
        return se3di_reader_fail_key(reader, node, "shapes",
                                     "have their centre of mass at [%.12g, %.12g, %.12g], must "
                                     "have it at the body's origin: shift their positions by the "
                                     "opposite, or give mass and inertia",
                                     c[0], c[1], c[2]);
    }
    return true;
}

bool se3di_read_shape_mass(se3di_reader *reader, const se3di_node *body, se3d_body_def *def)
{
    const se3di_node *list = NULL;
    whole sum = {0};
    if (!se3di_read_list(reader, body, "shapes", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        se3di_shape_entry entry = {.node = NULL};
        se3di_solid solid;
        double density = 0.0;
        if (!read_shape(reader, node, &entry) || !read_density(reader, body, node, &density) ||
            !se3di_solid_measure(reader, node, &entry.shape, entry.mesh, density, &solid)) {
            return false;
        }
        add_solid(&entry.shape, &solid, &sum);
        sum.has_mesh = sum.has_mesh || (entry.mesh && solid.mass > 0.0);
    }
    if (!(sum.mass > 0.0)) {
        return true;
    }
    if (!check_centre(reader, body, &sum)) {
        return false;
    }
    const double packed[6] = {sum.inertia[0], sum.inertia[4], sum.inertia[8],
                              sum.inertia[1], sum.inertia[5], sum.inertia[2]};
    memcpy(def->inertia, packed, sizeof packed);
    def->mass = sum.mass;
    return true;
}
