/* SPDX-License-Identifier: BSD-3-Clause */
/* `forces`: springs (tsda, rsda) and loads (force, torque); the others: forces_elements.c. */
#include <string.h>

#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/document/function.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/bodies.h"
#include "io/read/elements.h"
#include "io/read/forces_elements.h"
#include "io/read/sections.h"

static const char *const time_only[] = {"t", NULL};

/* A function of `variables` under `key`; also a mere number. */
static bool read_function(se3di_reader *reader, const se3di_node *node, const char *key,
                          const char *const *variables, se3d_function *function)
{
    const se3di_node *child = se3di_node_get(node, key);
    se3d_function_def def = se3d_function_def_default();
    if (!child) {
        return true;
    }
    if (!se3di_read_function(reader, child, variables, &def.constant, function)) {
        return false;
    }
    if (function->index1 != 0 || def.constant == 0.0) {
        return true;
    }
    def.variables = variables;
    def.variable_count = 0;
    while (variables[def.variable_count]) {
        ++def.variable_count;
    }
    const se3d_status status = se3d_function_create(reader->system, &def, function);
    return status < 0 ? se3di_reader_fail_system(reader, child, status) : true;
}

/* A coefficient: a number, or the table of what it gives: {spline: [[x, force], ...]}. */
static bool read_coefficient(se3di_reader *reader, const se3di_node *node, const char *key,
                             const char *curve, double *value, se3d_function *function)
{
    static const char *const x_only[] = {"x", NULL};
    const se3di_node *child = se3di_node_get(node, key);
    const se3di_node *other = se3di_node_get(node, curve);
    if (!child || child->kind != SE3DI_NODE_MAP) {
        return se3di_read_key_number(reader, node, key, SE3DI_ANY, value);
    }
    if (other) {
        return se3di_reader_fail(reader, other,
                                 "cannot stand beside a table `%s`, give one of them", key);
    }
    return se3di_read_function(reader, child, x_only, value, function);
}

/* What tsda and rsda have in common. */
typedef struct spring_values {
    double k, c, preload;
    se3d_function h, spring, damper;
} spring_values;

static bool read_spring(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                        spring_values *v)
{
    static const char *const elastic[] = {"x", NULL};
    static const char *const viscous[] = {"v", NULL};
    memset(v, 0, sizeof *v);
    return read_function(reader, node, "spring", elastic, &v->spring) &&
           read_function(reader, node, "damper", viscous, &v->damper) &&
           read_coefficient(reader, node, "k", "spring", &v->k, &v->spring) &&
           read_coefficient(reader, node, "c", "damper", &v->c, &v->damper) &&
           se3di_read_key_number(reader, node, "preload", SE3DI_ANY, &v->preload) &&
           read_function(reader, node, "h", variables, &v->h);
}

static bool read_tsda(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    static const char *const variables[] = {"t", "l", "ldot", NULL};
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    se3d_tsda_def def = se3d_tsda_def_default();
    spring_values v;
    if (!se3di_read_bodies_ij(reader, node, "a spring", bodies) ||
        !se3di_read_key_point(reader, node, "point_i", bodies[0], def.point_i) ||
        !se3di_read_key_point(reader, node, "point_j", bodies[1], def.point_j) ||
        !se3di_read_key_number(reader, node, "l0", SE3DI_NOT_NEGATIVE, &def.l0) ||
        !read_spring(reader, node, variables, &v)) {
        return false;
    }
    def.name = entry->name;
    def.body_i = bodies[0]->body;
    def.body_j = bodies[1]->body;
    def.k = v.k;
    def.c = v.c;
    def.preload = v.preload;
    def.h = v.h;
    def.spring = v.spring;
    def.damper = v.damper;
    entry->body_i = def.body_i;
    entry->body_j = def.body_j;
    entry->drawn = 3;
    memcpy(entry->point_i, def.point_i, sizeof def.point_i);
    memcpy(entry->point_j, def.point_j, sizeof def.point_j);
    const se3d_status status = se3d_force_create_tsda(reader->system, &def, &entry->force);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

/* Directions of an rsda without a joint: in the ground frame, or in those of the bodies. */
static bool read_axes(se3di_reader *reader, const se3di_node *node, se3d_rsda_def *def)
{
    double axis[3];
    double ref[3];
    const bool global = se3di_node_get(node, "axis") != NULL;
    if (global == (se3di_node_get(node, "axis_i") != NULL)) {
        return se3di_reader_fail_key(reader, node, "axis",
                                     "must be given, or axis_i, and not both: an rsda needs a "
                                     "`joint` or an axis between two bodies");
    }
    if (global && (se3di_node_get(node, "ref_i") || se3di_node_get(node, "ref_j"))) {
        return se3di_reader_fail_key(reader, node, "axis",
                                     "cannot stand beside ref_i, ref_j: give axis and ref (ground "
                                     "frame), or axis_i, ref_i, ref_j");
    }
    if (!global) {
        return se3di_read_key_direction(reader, node, "axis_i", def->axis_i) &&
               se3di_read_key_direction(reader, node, "ref_i", def->ref_i) &&
               se3di_read_key_direction(reader, node, "ref_j", def->ref_j);
    }
    double p[4];
    if (!se3di_read_key_direction(reader, node, "axis", axis) ||
        !se3di_read_key_direction(reader, node, "ref", ref)) {
        return false;
    }
    if (SE3D_FAILED(se3d_body_get_orientation(reader->system, def->body_i, p))) {
        return se3di_reader_fail_memory(reader);
    }
    se3di_rotation_apply_inverse(p, axis, def->axis_i);
    if (se3di_node_get(node, "ref")) {
        se3di_rotation_apply_inverse(p, ref, def->ref_i);
    }
    return true;
}

/* The joint of an rsda, or its bodies and axes. */
static bool read_rsda_place(se3di_reader *reader, const se3di_node *node, se3d_rsda_def *def)
{
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    if (!se3di_node_get(node, "joint") && se3di_node_get(node, "body_j")) {
        if (!se3di_read_bodies_ij(reader, node, "a spring", bodies)) {
            return false;
        }
        def->body_i = bodies[0]->body;
        def->body_j = bodies[1]->body;
        return read_axes(reader, node, def) &&
               se3di_read_key_number(reader, node, "angle0", SE3DI_ANY, &def->angle0);
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (se3di_node_get(node, "joint") &&
            se3di_keys_contain(" body_i body_j axis ref axis_i ref_i ref_j angle0 ", child->key)) {
            return se3di_reader_fail(reader, child, "cannot stand beside `joint`, which has it");
        }
    }
    return se3di_read_key_joint(reader, node, "joint", &def->joint);
}

static bool read_rsda(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    static const char *const variables[] = {"t", "theta", "thetadot", NULL};
    se3d_rsda_def def = se3d_rsda_def_default();
    spring_values v;
    if (!read_rsda_place(reader, node, &def) ||
        !se3di_read_key_number(reader, node, "theta0", SE3DI_ANY, &def.theta0) ||
        !read_spring(reader, node, variables, &v)) {
        return false;
    }
    def.name = entry->name;
    def.k = v.k;
    def.c = v.c;
    def.preload = v.preload;
    def.h = v.h;
    def.spring = v.spring;
    def.damper = v.damper;
    const se3d_status status = se3d_force_create_rsda(reader->system, &def, &entry->force);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

/* A force at a point or a torque: three components, each a number or a function of time. */
static bool read_load(se3di_reader *reader, const se3di_node *node, const char *type,
                      se3di_element_entry *entry)
{
    static const char *const frames[] = {"ground", "body", NULL};
    const se3di_body_entry *body = NULL;
    const se3di_node *frame = se3di_node_get(node, "frame");
    const se3di_node *value = se3di_node_get(node, "value");
    se3d_load_def def = se3d_load_def_default();
    size_t word = 0;
    if (!se3di_read_key_body(reader, node, "body", &body) ||
        !se3di_read_key_point(reader, node, "point", body, def.point) ||
        (frame && !se3di_read_word(reader, frame, frames, &word))) {
        return false;
    }
    if (!value || value->kind != SE3DI_NODE_LIST || value->count != 3) {
        return se3di_reader_fail_key(reader, node, "value",
                                     "must be a list of 3 numbers or expressions in t");
    }
    const se3di_node *part = value->first;
    for (size_t k = 0; k < 3; ++k, part = part->next) {
        if (!se3di_read_function(reader, part, time_only, &def.value[k], &def.function[k])) {
            return false;
        }
    }
    entry->body = body->body;
    memcpy(entry->point, def.point, sizeof entry->point);
    def.name = entry->name;
    def.body = body->body;
    def.in_body_frame = word == 1;
    const se3d_status status = strcmp(type, "force") == 0
                                   ? se3d_force_create_load(reader->system, &def, &entry->force)
                                   : se3d_force_create_torque(reader->system, &def, &entry->force);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

typedef bool (*read_element)(se3di_reader *reader, const se3di_node *node,
                             se3di_element_entry *entry);

static bool read_force(se3di_reader *reader, const se3di_node *node)
{
    static const struct {
        const char *type;
        read_element read;
    } readers[] = {{"tsda", read_tsda},
                   {"rsda", read_rsda},
                   {"bushing", se3di_read_bushing},
                   {"friction", se3di_read_friction},
                   {"stop", se3di_read_stop}};
    const char *type = NULL;
    se3di_element_entry *entry = NULL;
    if (!se3di_read_type(reader, node, SE3DI_OBJECT_FORCE, &type) ||
        !se3di_read_element(reader, node, SE3DI_ELEMENT_FORCE, &entry)) {
        return false;
    }
    for (size_t k = 0; k < sizeof readers / sizeof *readers; ++k) {
        if (strcmp(readers[k].type, type) == 0) {
            return readers[k].read(reader, node, entry);
        }
    }
    return read_load(reader, node, type, entry);
}

bool se3di_read_forces(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "forces", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        if (!read_force(reader, node)) {
            return false;
        }
    }
    return true;
}
