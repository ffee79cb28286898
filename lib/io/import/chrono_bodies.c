/* SPDX-License-Identifier: BSD-3-Clause */
/* Chrono: bodies with their shapes. A body has a frame of reference, and in it the frame of its
 * centre of mass, about whose axes the inertia is given. Ours has its origin at the centre and the
 * axes of reference. */
#include <math.h>
#include <string.h>

#include "io/import/chrono.h"
#include "io/import/inertia.h"
#include "io/import/material.h"
#include "io/import/mesh.h"
#include "io/import/scan.h"

static bool read_inertia(se3di_chrono *c, const se3di_node *map, double J[9])
{
    const se3di_node *inertia = se3di_node_get(map, "inertia");
    double moments[3] = {0.0, 0.0, 0.0};
    double products[3] = {0.0, 0.0, 0.0}; /* xy, xz, yz: elements of the matrix */
    if (!se3di_chrono_has(c, map, "inertia") || !se3di_chrono_has(c, inertia, "moments") ||
        !se3di_chrono_numbers(c, inertia, "moments", moments, 3) ||
        !se3di_chrono_numbers(c, inertia, "products", products, 3)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        J[4 * k] = moments[k];
    }
    J[1] = J[3] = products[0];
    J[2] = J[6] = products[1];
    J[5] = J[7] = products[2];
    return true;
}

static bool read_mass(se3di_chrono *c, const se3di_node *map, se3di_machine_body *body,
                      const se3di_frame *com)
{
    double v[3] = {0.0, 0.0, 0.0}; /* of the centre, ground frame */
    double w[3] = {0.0, 0.0, 0.0}; /* in the axes of the centre */
    se3di_mass mass = {.mass = 0.0};
    if (!se3di_chrono_has(c, map, "mass") || !se3di_chrono_number(c, map, "mass", &mass.mass) ||
        !read_inertia(c, map, mass.J) ||
        !se3di_chrono_numbers(c, map, "initial_linear_velocity", v, 3) ||
        !se3di_chrono_numbers(c, map, "initial_angular_velocity", w, 3)) {
        return false;
    }
    if (!(mass.mass > 0.0)) {
        const se3di_node *node = se3di_node_get(map, "mass");
        return se3di_machine_fail(c->m, node->line, node->column,
                                  "the mass of `%.80s` is %g kg, must be > 0", body->name,
                                  mass.mass);
    }
    mass = se3di_mass_of(com, &mass);
    body->mass = mass.mass;
    memcpy(body->J, mass.J, sizeof body->J);
    memcpy(body->v, v, sizeof body->v);
    se3di_turn(com->A, w, body->w);
    return se3di_inertia_mend(c->m, body->name, map->line, body->mass, body->J);
}

static bool read_sizes(se3di_chrono *c, const se3di_node *map, se3di_machine_shape *shape)
{
    const bool good = se3di_chrono_frame(c, map, &shape->frame) &&
                      se3di_chrono_numbers(c, map, "dimensions", shape->size, 3) &&
                      se3di_chrono_number(c, map, "radius", &shape->radius) &&
                      se3di_chrono_number(c, map, "length", &shape->length) &&
                      se3di_chrono_number(c, map, "scale", &shape->scale) &&
                      se3di_chrono_axis(c, map, "axis", shape->frame.A) &&
                      se3di_chrono_numbers(c, map, "color", shape->color, 3);
    for (int k = 0; k < 3 && se3di_node_get(map, "color"); ++k) {
        shape->color[k] = fmin(fmax(shape->color[k], 0.0), 1.0);
    }
    return good;
}

/* A shape that has a size of its own. */
static bool take_solid(se3di_machine *m, const se3di_node *map, se3di_machine_shape *shape)
{
    const bool is_box = strcmp(shape->type, "box") == 0;
    const bool is_cylinder = strcmp(shape->type, "cylinder") == 0;
    const double *s = shape->size;
    shape->radius = is_box ? 0.0 : shape->radius;
    shape->length = is_cylinder ? shape->length : 0.0;
    shape->scale = 1.0;
    const bool good = is_box ? s[0] > 0.0 && s[1] > 0.0 && s[2] > 0.0
                             : shape->radius > 0.0 && (!is_cylinder || shape->length > 0.0);
    if (!good) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, map->line, "the %s has a size that is not > 0",
                              shape->type);
    }
    return good;
}

/* What a shape is; *good: whether it is one that can be drawn. */
static bool read_shape(se3di_chrono *c, const se3di_node *map, se3di_machine_shape *shape,
                       bool *good)
{
    static const char *const solids[] = {"box", "cylinder", "sphere"};
    se3di_machine *m = c->m;
    const char *type = se3di_chrono_need(c, map, "type");
    if (!type || !read_sizes(c, map, shape)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        if (se3di_scan_equal(type, solids[k])) {
            shape->type = solids[k];
            *good = take_solid(m, map, shape);
            return true;
        }
    }
    const char *file = se3di_chrono_text(c, map, "filename");
    if (file) {
        const double scales[3] = {shape->scale, shape->scale, shape->scale};
        *good = se3di_mesh_take(m, map->line, c->folder, file, scales, shape);
        return m->status >= 0;
    }
    se3di_machine_note_of(m, SE3D_IMPORT_LOST, map->line, "the shape %.60s", type);
    return m->status >= 0;
}

/* The material of a contact by its name; its numbers are Chrono's where it says none. */
static bool take_material(se3di_chrono *c, const se3di_node *contact, const char *name,
                          se3di_machine_material *out)
{
    const se3di_node *at = se3di_chrono_list(c, contact, "materials");
    for (; at; at = at->next) {
        const char *own = se3di_chrono_need(c, at, "name");
        if (!own) {
            return false;
        }
        if (strcmp(own, name) != 0) {
            continue;
        }
        const se3di_node *bulk = se3di_node_get(at, "physical_properties");
        const se3di_node *spring = se3di_node_get(at, "coefficients");
        out->name = name;
        return se3di_chrono_number(c, at, "coefficient_of_friction", &out->friction) &&
               se3di_chrono_number(c, at, "coefficient_of_restitution", &out->restitution) &&
               (!bulk || (se3di_chrono_number(c, bulk, "Youngs_modulus", &out->young) &&
                          se3di_chrono_number(c, bulk, "Young_modulus", &out->young) &&
                          se3di_chrono_number(c, bulk, "Poisson_ratio", &out->poisson))) &&
               (!spring || se3di_chrono_number(c, spring, "normal_stiffness", &out->stiffness));
    }
    se3di_machine_note_of(c->m, SE3D_IMPORT_LOST, contact->line,
                          "the contact material `%.80s` is not there", name);
    return c->m->status >= 0;
}

/* What a shape touches with; of `visualization`: nothing. */
static bool read_material(se3di_chrono *c, const se3di_node *parent, const se3di_node *map,
                          se3di_machine_shape *shape)
{
    se3di_machine_material material = {.friction = 0.8, .restitution = 0.01, .poisson = 0.3};
    const char *name = se3di_chrono_text(c, map, "material");
    if (c->m->status < 0 || !name) {
        return c->m->status >= 0;
    }
    if (!take_material(c, parent, name, &material)) {
        return false;
    }
    if (!(material.young >= 0.0 && material.young < 1e40)) {
        material.young = 0.0;
    }
    material.poisson = material.poisson >= 0.0 && material.poisson <= 0.49 ? material.poisson : 0.3;
    if (!(material.stiffness > 0.0 && material.stiffness <= 1e30)) {
        material.stiffness = 0.0;
    }
    shape->material = se3di_machine_material_name(c->m, &material, map->line);
    return shape->material != NULL;
}

static bool read_shapes(se3di_chrono *c, const se3di_node *map, const char *key,
                        const se3di_chrono_body *body)
{
    const se3di_node *parent = se3di_node_get(map, key);
    const se3di_node *at = parent ? se3di_chrono_list(c, parent, "shapes") : NULL;
    const se3di_frame in =
        se3di_frame_in(&se3di_machine_body_at(c->m, body->body)->frame, &body->frame);
    for (; at; at = at->next) {
        se3di_machine_shape read = {.scale = 1.0, .color = {-1.0, 0.0, 0.0}};
        bool good = false;
        read.frame = se3di_frame_identity();
        if (!read_shape(c, at, &read, &good) || !read_material(c, parent, at, &read)) {
            return false;
        }
        se3di_machine_shape *shape = good ? se3di_machine_add_shape(c->m, body->body) : NULL;
        if (good && !shape) {
            return false;
        }
        if (shape) {
            read.frame = se3di_frame_of(&in, &read.frame);
            *shape = read; /* the last of its list: it has no next */
        }
    }
    return c->m->status >= 0;
}

static bool read_geometry(se3di_chrono *c, const se3di_node *map, const se3di_chrono_body *body)
{
    const se3di_node *contact = se3di_node_get(map, "contact");
    if (!read_shapes(c, map, "visualization", body)) {
        return false;
    }
    const se3di_node *drawn = se3di_node_get(map, "visualization");
    if (drawn && se3di_node_get(drawn, "model_file")) {
        se3di_machine_note_of(c->m, SE3D_IMPORT_NOTE, drawn->line,
                              "`model_file` is only drawn: it is left out");
    }
    if (contact && !read_shapes(c, map, "contact", body)) {
        return false;
    }
    double family = 0.0;
    if (contact && !se3di_chrono_number(c, contact, "collision_family", &family)) {
        return false;
    }
    if (fabs(family) > 0.0) {
        se3di_machine_note_of(c->m, SE3D_IMPORT_NOTE, contact->line,
                              "the collision_family is %g: give the shapes that must not touch a "
                              "`group` and `mask`",
                              family);
    }
    return c->m->status >= 0;
}

/* A body of the machine: the ground itself if it is a fixed one of this name. */
static bool make_body(se3di_chrono *c, const se3di_node *map, const char *name,
                      se3di_chrono_body *body, const se3di_frame *com)
{
    se3di_machine *m = c->m;
    if (body->fixed && se3di_scan_equal(name, "ground") && !m->ground.comment) {
        m->ground.comment = ""; /* is taken */
        body->body = SE3DI_GROUND;
        return true;
    }
    const char *made = se3di_machine_name_body(m, name, "body", map->line);
    body->body = m->body_count;
    se3di_machine_body *out = made ? se3di_machine_add_body(m, made) : NULL;
    if (!out) {
        return false;
    }
    out->fixed = body->fixed;
    out->frame = body->frame;
    if (body->fixed) {
        return true;
    }
    memcpy(out->frame.r, body->mass.r, sizeof out->frame.r);
    if (!read_mass(c, map, out, com)) {
        return false;
    }
    const se3di_frame origin = se3di_frame_in(&out->frame, &body->frame);
    return !(se3di_length(origin.r) > 0.0) ||
           se3di_machine_add_marker(m, body->body, "reference", &origin) != NULL;
}

bool se3di_chrono_body_read(se3di_chrono *c, const se3di_node *map)
{
    se3di_chrono_body body = {.frame = se3di_frame_identity()};
    se3di_frame com = se3di_frame_identity();
    size_t taken;
    const char *name = se3di_chrono_need(c, map, "name");
    const se3di_node *centre = se3di_node_get(map, "com");
    if (!name || !se3di_chrono_has(c, map, "location") ||
        !se3di_chrono_bool(c, map, "fixed", &body.fixed) ||
        !se3di_chrono_frame(c, map, &body.frame) ||
        (centre && !se3di_chrono_frame(c, centre, &com))) {
        return false;
    }
    se3di_chrono_keys(c, map,
                      "name fixed location orientation mass com inertia initial_linear_velocity "
                      "initial_angular_velocity contact visualization");
    if (se3di_ionames_find(&c->names, name, &taken)) {
        return se3di_machine_fail(c->m, map->line, map->column, "there are two bodies `%.200s`",
                                  name);
    }
    se3di_chrono_body *grown =
        se3di_iopool_grow(c->m->pool, c->list, c->count, &c->room, sizeof *grown);
    if (!grown || !se3di_ionames_add(&c->names, c->m->pool, name, c->count)) {
        return se3di_machine_fail_memory(c->m);
    }
    c->list = grown;
    body.mass = se3di_frame_of(&body.frame, &com);
    if (!make_body(c, map, name, &body, &com) || !read_geometry(c, map, &body)) {
        return false;
    }
    c->list[c->count++] = body;
    return true;
}
