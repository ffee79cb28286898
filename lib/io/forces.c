/* SPDX-License-Identifier: BSD-3-Clause */
/* `forces`: tsda, rsda, force, torque. */
#include <string.h>

#include "io/reader.h"

static const char *const time_only[] = {"t", NULL};

/* `h`: a function of time and of the element's coordinate and rate; also a mere number. */
static bool read_actuator(se3di_reader *reader, const se3di_node *node,
                          const char *const *variables, se3d_function *function)
{
    const se3di_node *h = se3di_node_get(node, "h");
    se3d_function_def def = se3d_function_def_default();
    if (!h) {
        return true;
    }
    if (!se3di_read_function(reader, h, variables, &def.constant, function)) {
        return false;
    }
    if (function->index1 != 0 || def.constant == 0.0) {
        return true;
    }
    def.variables = variables;
    def.variable_count = 3;
    const se3d_status status = se3d_function_create(reader->model->system, &def, function);
    return status < 0 ? se3di_reader_fail_system(reader, h, status) : true;
}

static bool read_tsda(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    static const char *const variables[] = {"t", "l", "ldot", NULL};
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    se3d_tsda_def def = se3d_tsda_def_default();
    if (!se3di_read_key_body(reader, node, "body_i", &bodies[0]) ||
        !se3di_read_key_body(reader, node, "body_j", &bodies[1]) ||
        !se3di_read_key_point(reader, node, "point_i", bodies[0], def.point_i) ||
        !se3di_read_key_point(reader, node, "point_j", bodies[1], def.point_j) ||
        !se3di_read_key_number(reader, node, "k", SE3DI_ANY, &def.k) ||
        !se3di_read_key_number(reader, node, "c", SE3DI_ANY, &def.c) ||
        !se3di_read_key_number(reader, node, "l0", SE3DI_NOT_NEGATIVE, &def.l0) ||
        !read_actuator(reader, node, variables, &def.h)) {
        return false;
    }
    if (bodies[0] == bodies[1]) {
        return se3di_reader_fail_key(reader, node, "body_j",
                                     "is body_i too, a spring needs two different bodies");
    }
    def.name = entry->name;
    def.body_i = bodies[0]->body;
    def.body_j = bodies[1]->body;
    const se3d_status status = se3d_force_create_tsda(reader->model->system, &def, &entry->force);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

static bool read_rsda(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    static const char *const variables[] = {"t", "theta", "thetadot", NULL};
    se3d_rsda_def def = se3d_rsda_def_default();
    if (!se3di_read_key_joint(reader, node, "joint", &def.joint) ||
        !se3di_read_key_number(reader, node, "k", SE3DI_ANY, &def.k) ||
        !se3di_read_key_number(reader, node, "c", SE3DI_ANY, &def.c) ||
        !se3di_read_key_number(reader, node, "theta0", SE3DI_ANY, &def.theta0) ||
        !read_actuator(reader, node, variables, &def.h)) {
        return false;
    }
    def.name = entry->name;
    const se3d_status status = se3d_force_create_rsda(reader->model->system, &def, &entry->force);
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
    def.name = entry->name;
    def.body = body->body;
    def.in_body_frame = word == 1;
    const se3d_status status =
        strcmp(type, "force") == 0
            ? se3d_force_create_load(reader->model->system, &def, &entry->force)
            : se3d_force_create_torque(reader->model->system, &def, &entry->force);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

static bool read_force(se3di_reader *reader, const se3di_node *node)
{
    const char *type = NULL;
    se3di_element_entry *entry = NULL;
    if (!se3di_read_type(reader, node, SE3DI_OBJECT_FORCE, &type) ||
        !se3di_read_element(reader, node, SE3DI_ELEMENT_FORCE, &entry)) {
        return false;
    }
    if (strcmp(type, "tsda") == 0) {
        return read_tsda(reader, node, entry);
    }
    return strcmp(type, "rsda") == 0 ? read_rsda(reader, node, entry)
                                     : read_load(reader, node, type, entry);
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
