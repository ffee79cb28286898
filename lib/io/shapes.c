/* SPDX-License-Identifier: BSD-3-Clause */
/* `shapes` and `materials`: what bodies look like, and what they weigh where no mass is given. */
#include <math.h>
#include <string.h>

#include "io/mesh.h"
#include "io/rotation.h"

static const double pi = 3.14159265358979323846;

static bool require(se3di_reader *reader, const se3di_node *node, const char *key)
{
    return se3di_node_get(node, key)
               ? true
               : se3di_reader_fail_key(reader, node, key, "is missing, a %s needs it",
                                       se3di_node_get(node, "type")->text);
}

static bool read_positive(se3di_reader *reader, const se3di_node *node, const char *key,
                          double *value)
{
    return require(reader, node, key) &&
           se3di_read_key_number(reader, node, key, SE3DI_POSITIVE, value);
}

static bool read_size(se3di_reader *reader, const se3di_node *node, double size[3])
{
    if (!require(reader, node, "size") || !se3di_read_key_vector(reader, node, "size", size)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        if (!(size[k] > 0.0)) {
            return se3di_reader_fail_key(reader, node, "size",
                                         "is [%g, %g, %g], each edge must be > 0", size[0], size[1],
                                         size[2]);
        }
    }
    return true;
}

/* The plane's normal is its z axis. */
static bool read_plane(se3di_reader *reader, const se3di_node *node, se3d_model_shape *shape)
{
    double n[3] = {0.0, 0.0, 1.0};
    if (!se3di_read_key_direction(reader, node, "normal", n)) {
        return false;
    }
    if (!se3di_node_get(node, "normal")) {
        return true;
    }
    if (se3di_node_get(node, "orientation")) {
        return se3di_reader_fail_key(reader, node, "normal",
                                     "and `orientation` exclude each other");
    }
    const double across = hypot(n[0], n[1]);
    const double axis[3] = {across > 0.0 ? -n[1] : 1.0, across > 0.0 ? n[0] : 0.0, 0.0};
    se3di_rotation_from_axis(axis, atan2(across, n[2]), shape->orientation);
    return true;
}

static bool read_triangles(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    se3d_model_shape *shape = &entry->shape;
    if (!require(reader, node, "file") ||
        !se3di_read_text(reader, se3di_node_get(node, "file"), &shape->file) ||
        !se3di_read_key_number(reader, node, "scale", SE3DI_POSITIVE, &shape->scale)) {
        return false;
    }
    entry->mesh = se3di_read_mesh(reader, node, shape->file, shape->scale);
    return entry->mesh != NULL;
}

static bool read_dimensions(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    se3d_model_shape *shape = &entry->shape;
    switch (shape->type) {
    case SE3D_SHAPE_SPHERE:
        return read_positive(reader, node, "radius", &shape->radius);
    case SE3D_SHAPE_BOX:
        return read_size(reader, node, shape->size);
    case SE3D_SHAPE_CAPSULE:
    case SE3D_SHAPE_CYLINDER:
        return read_positive(reader, node, "radius", &shape->radius) &&
               read_positive(reader, node, "length", &shape->length);
    case SE3D_SHAPE_PLANE:
        return read_plane(reader, node, shape);
    default:
        return read_triangles(reader, node, entry);
    }
}

static bool read_color(se3di_reader *reader, const se3di_node *node, double color[3])
{
    if (!se3di_read_key_vector(reader, node, "color", color)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        if (se3di_node_get(node, "color") && !(color[k] >= 0.0 && color[k] <= 1.0)) {
            return se3di_reader_fail_key(reader, node, "color",
                                         "is [%g, %g, %g], must be red, green, blue from 0 to 1",
                                         color[0], color[1], color[2]);
        }
    }
    return true;
}

static bool read_shape(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    se3d_model_shape *shape = &entry->shape;
    static const char *const types[] = {"sphere", "box", "capsule", "cylinder", "plane", "mesh"};
    static const se3d_model_shape standard = {
        .scale = 1.0, .orientation = {1.0, 0.0, 0.0, 0.0}, .color = {-1.0, -1.0, -1.0}, .file = ""};
    const char *type = NULL;
    if (!se3di_read_type(reader, node, SE3DI_OBJECT_SHAPE, &type)) {
        return false;
    }
    entry->mesh = NULL;
    *shape = standard;
    while (strcmp(types[shape->type], type) != 0) {
        ++shape->type;
    }
    return se3di_read_key_vector(reader, node, "position", shape->position) &&
           se3di_read_key_orientation(reader, node, shape->orientation) &&
           read_dimensions(reader, node, entry) && read_color(reader, node, shape->color);
}

bool se3di_read_shapes(se3di_reader *reader, const se3di_node *body, size_t entry)
{
    se3d_model *model = reader->model;
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, body, "shapes", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        se3di_shape_entry made;
        if (!read_shape(reader, node, &made)) {
            return false;
        }
        made.shape.body = model->bodies[entry].body;
        se3di_shape_entry *grown = se3di_iopool_grow(
            &model->pool, model->shapes, model->shape_count, &model->shape_capacity, sizeof *grown);
        if (!grown) {
            return se3di_reader_fail_memory(reader);
        }
        model->shapes = grown;
        model->shapes[model->shape_count++] = made;
    }
    return true;
}

bool se3di_read_materials(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *list = NULL;
    const char *name = NULL;
    double density = 0.0;
    if (!se3di_read_list(reader, root, "materials", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        if (!se3di_read_keys(reader, node, SE3DI_OBJECT_MATERIAL) ||
            !se3di_read_key_number(reader, node, "density", SE3DI_POSITIVE, &density)) {
            return false;
        }
        const se3di_node *child = se3di_node_get(node, "name");
        if (!child) {
            return se3di_reader_fail_key(reader, node, "name", "is missing");
        }
        if (!se3di_read_name(reader, child, &name)) {
            return false;
        }
    }
    return true;
}

/* The density of a material, 0 where it has none. */
static bool read_material(se3di_reader *reader, const se3di_node *node, double *density)
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
            return se3di_read_key_number(reader, material, "density", SE3DI_POSITIVE, density);
        }
        se3di_guess_offer(&guess, known);
    }
    const char *meant = se3di_guess_get(&guess);
    return se3di_reader_fail(reader, node, "no material is named `%.60s`%s%s%s", name,
                             meant ? ", did you mean `" : "; list it under `materials`",
                             meant ? meant : "", meant ? "`?" : "");
}

/* Of the shape, else of the body, else of the shape's material; 0 where nobody says. */
static bool read_density(se3di_reader *reader, const se3di_node *body, const se3di_node *shape,
                         double *density)
{
    const se3di_node *material = se3di_node_get(shape, "material");
    *density = 0.0;
    if (material && !read_material(reader, material, density)) {
        return false;
    }
    return se3di_read_key_number(reader, body, "density", SE3DI_POSITIVE, density) &&
           se3di_read_key_number(reader, shape, "density", SE3DI_POSITIVE, density);
}

/* Mass and principal moments of solid bodies, uniform density; round ones about their z axis. */
static double solid_moments(const se3d_model_shape *shape, double density, double J[3])
{
    const double r2 = shape->radius * shape->radius;
    const double length = shape->length;
    const double ball = density * 4.0 / 3.0 * pi * r2 * shape->radius;
    const double tube = density * pi * r2 * length;
    const double across = tube * (3.0 * r2 + length * length) / 12.0;
    double mass = 0.0;
    switch (shape->type) {
    case SE3D_SHAPE_SPHERE:
        J[0] = J[1] = J[2] = 0.4 * ball * r2;
        return ball;
    case SE3D_SHAPE_BOX:
        mass = density * shape->size[0] * shape->size[1] * shape->size[2];
        for (int k = 0; k < 3; ++k) {
            const double a = shape->size[(k + 1) % 3];
            const double b = shape->size[(k + 2) % 3];
            J[k] = mass * (a * a + b * b) / 12.0;
        }
        return mass;
    case SE3D_SHAPE_CYLINDER:
        J[0] = J[1] = across;
        J[2] = 0.5 * tube * r2;
        return tube;
    case SE3D_SHAPE_CAPSULE: /* a hemisphere's centre of mass is 3/8 r from its flat face */
        J[0] = J[1] =
            across + ball * (0.4 * r2 + 0.25 * length * length + 0.375 * length * shape->radius);
        J[2] = 0.5 * tube * r2 + 0.4 * ball * r2;
        return tube + ball;
    default:
        J[0] = J[1] = J[2] = 0.0;
        return 0.0;
    }
}

/* Add a shape's inertia about the body's origin: A diag(J) A^T + m (s.s I - s s^T). */
static void add_inertia(const se3d_model_shape *shape, double mass, const double J[3],
                        double inertia[9])
{
    double A[9];
    const double *s = shape->position;
    const double square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
    se3di_rotation_to_matrix(shape->orientation, A);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            double sum = mass * ((i == j ? square : 0.0) - s[i] * s[j]);
            for (int k = 0; k < 3; ++k) {
                sum += A[3 * i + k] * J[k] * A[3 * j + k];
            }
            inertia[3 * i + j] += sum;
        }
    }
}

static bool check_centre(se3di_reader *reader, const se3di_node *body, double mass,
                         const double moment[3], double size)
{
    const double c[3] = {moment[0] / mass, moment[1] / mass, moment[2] / mass};
    if (hypot(hypot(c[0], c[1]), c[2]) > 1e-9 * size) {
        return se3di_reader_fail_key(
            reader, body, "shapes",
            "have their centre of mass at [%.9g, %.9g, %.9g], must have it "
            "at the body's origin: shift their positions by the opposite, "
            "or give mass and inertia",
            c[0], c[1], c[2]);
    }
    return true;
}

bool se3di_read_shape_mass(se3di_reader *reader, const se3di_node *body, se3d_body_def *def)
{
    const se3di_node *list = NULL;
    double inertia[9] = {0.0};
    double moment[3] = {0.0};
    double mass = 0.0;
    double extent = 0.0;
    if (!se3di_read_list(reader, body, "shapes", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        se3di_shape_entry entry;
        double density = 0.0;
        double J[3];
        if (!read_shape(reader, node, &entry) || !read_density(reader, body, node, &density)) {
            return false;
        }
        const se3d_model_shape *shape = &entry.shape;
        const double part = solid_moments(shape, density, J);
        add_inertia(shape, part, J, inertia);
        mass += part;
        for (int k = 0; k < 3; ++k) {
            moment[k] += part * shape->position[k];
            extent += fabs(shape->position[k]) + shape->size[k];
        }
        extent += shape->radius + shape->length;
    }
    if (!(mass > 0.0)) {
        return true;
    }
    if (!check_centre(reader, body, mass, moment, extent)) {
        return false;
    }
    const double packed[6] = {inertia[0], inertia[4], inertia[8],
                              inertia[1], inertia[5], inertia[2]};
    memcpy(def->inertia, packed, sizeof packed);
    def->mass = mass;
    return true;
}
