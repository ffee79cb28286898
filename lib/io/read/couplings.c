/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of joints; joints between joints (gear, rack and pinion, coupler); drivers. */
#include <string.h>

#include "io/document/document.h"
#include "io/document/function.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/elements.h"
#include "io/read/joints.h"
#include "io/read/sections.h"

static const char *const coordinates[] = {"angle", "displacement", NULL};
static const char *const time_only[] = {"t", NULL};

bool se3di_read_key_coordinate(se3di_reader *reader, const se3di_node *node, se3d_constraint joint,
                               int32_t *coordinate)
{
    const se3d_system *system = reader->system;
    const se3di_node *child = se3di_node_get(node, "coordinate");
    size_t word = 0;
    double value[3];
    const bool angle = !SE3D_FAILED(se3d_joint_get_coordinate(
        system, joint, SE3D_JOINT_COORDINATE_ANGLE, &value[0], &value[1], &value[2]));
    const bool displacement = !SE3D_FAILED(se3d_joint_get_coordinate(
        system, joint, SE3D_JOINT_COORDINATE_DISPLACEMENT, &value[0], &value[1], &value[2]));
    if (!angle && !displacement) {
        return se3di_reader_fail_key(reader, node, "joint",
                                     "has no coordinate, must be a joint with an angle or a "
                                     "displacement");
    }
    if (!child && angle && displacement) {
        return se3di_reader_fail_key(reader, node, "coordinate",
                                     "is missing, must be angle or displacement: the joint has "
                                     "both");
    }
    if (!child) {
        *coordinate = angle ? SE3D_JOINT_COORDINATE_ANGLE : SE3D_JOINT_COORDINATE_DISPLACEMENT;
        return true;
    }
    if (!se3di_read_word(reader, child, coordinates, &word)) {
        return false;
    }
    if (word == 0 ? !angle : !displacement) {
        return se3di_reader_fail(reader, child,
                                 "is `%s`, which this joint does not have, must be `%s`",
                                 coordinates[word], coordinates[1 - word]);
    }
    *coordinate = (int32_t)word;
    return true;
}

static bool read_gear(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    se3d_constraint first;
    se3d_constraint second;
    double ratio = 0.0;
    if (!se3di_read_key_joint(reader, node, "joint_1", &first) ||
        !se3di_read_key_joint(reader, node, "joint_2", &second)) {
        return false;
    }
    if (first.index1 == second.index1) {
        return se3di_reader_fail_key(reader, node, "joint_2",
                                     "is the same as joint_1, must be another joint");
    }
    if (!se3di_node_get(node, "ratio")) {
        return se3di_reader_fail_key(reader, node, "ratio",
                                     "is missing: ratio * angle 1 + angle 2 = constant");
    }
    if (!se3di_read_key_number(reader, node, "ratio", SE3DI_ANY, &ratio)) {
        return false;
    }
    const se3d_status status = se3d_joint_create_gear(reader->system, entry->name, first, second,
                                                      ratio, &entry->constraint);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

static bool read_rack(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    se3d_constraint pinion;
    se3d_constraint rack;
    double radius = 0.0;
    if (!se3di_read_key_joint(reader, node, "pinion", &pinion) ||
        !se3di_read_key_joint(reader, node, "rack", &rack)) {
        return false;
    }
    if (!se3di_node_get(node, "radius")) {
        return se3di_reader_fail_key(reader, node, "radius",
                                     "is missing: displacement = radius * angle + constant [m]");
    }
    if (!se3di_read_key_number(reader, node, "radius", SE3DI_ANY, &radius)) {
        return false;
    }
    const se3d_status status = se3d_joint_create_rack_pinion(reader->system, entry->name, pinion,
                                                             rack, radius, &entry->constraint);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

static bool read_coupler(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    const se3di_node *list = se3di_node_get(node, "terms");
    const se3di_node *value = se3di_node_get(node, "value");
    se3d_coupler_def def = se3d_coupler_def_default();
    if (!list || list->kind != SE3DI_NODE_LIST || list->count == 0 ||
        list->count > SE3D_COUPLER_TERMS_MAX) {
        return se3di_reader_fail_key(reader, node, "terms",
                                     "must be a list of 1 to %d terms {joint: ..., coordinate: "
                                     "..., ratio: ...}",
                                     SE3D_COUPLER_TERMS_MAX);
    }
    for (const se3di_node *term = list->first; term; term = term->next, ++def.count) {
        def.ratio[def.count] = 1.0;
        if (!se3di_read_keys(reader, term, SE3DI_OBJECT_TERM) ||
            !se3di_read_key_joint(reader, term, "joint", &def.joint[def.count]) ||
            !se3di_read_key_coordinate(reader, term, def.joint[def.count],
                                       &def.coordinate[def.count]) ||
            !se3di_read_key_number(reader, term, "ratio", SE3DI_ANY, &def.ratio[def.count])) {
            return false;
        }
    }
    if (value && !se3di_read_function(reader, value, time_only, &def.value, &def.function)) {
        return false;
    }
    def.name = entry->name;
    const se3d_status status = se3d_joint_create_coupler(reader->system, &def, &entry->constraint);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

static bool is_coupling(const char *type)
{
    return se3di_keys_contain(" gear rack_pinion coupler ", type) != 0;
}

static bool read_joint(se3di_reader *reader, const se3di_node *node, const char *type)
{
    se3di_element_entry *entry = NULL;
    if (!se3di_read_element(reader, node, SE3DI_ELEMENT_JOINT, &entry)) {
        return false;
    }
    if (strcmp(type, "gear") == 0) {
        return read_gear(reader, node, entry);
    }
    if (strcmp(type, "rack_pinion") == 0) {
        return read_rack(reader, node, entry);
    }
    return strcmp(type, "coupler") == 0 ? read_coupler(reader, node, entry)
                                        : se3di_read_pair(reader, node, type, entry);
}

/* Couplings may name joints that stand below them: they come in a second round. */
bool se3di_read_joints(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *list = NULL;
    const char *type = NULL;
    if (!se3di_read_list(reader, root, "joints", &list)) {
        return false;
    }
    for (int round = 0; round < 2; ++round) {
        for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
            if (!se3di_read_type(reader, node, SE3DI_OBJECT_JOINT, &type) ||
                (is_coupling(type) == (round == 1) && !read_joint(reader, node, type))) {
                return false;
            }
        }
    }
    return true;
}

static bool read_driver(se3di_reader *reader, const se3di_node *node)
{
    se3d_driver_def def = se3d_driver_def_default();
    se3di_element_entry *entry = NULL;
    const se3di_node *value = se3di_node_get(node, "value");
    if (!se3di_read_keys(reader, node, SE3DI_OBJECT_DRIVER) ||
        !se3di_read_element(reader, node, SE3DI_ELEMENT_DRIVER, &entry) ||
        !se3di_read_key_joint(reader, node, "joint", &def.joint) ||
        !se3di_read_key_coordinate(reader, node, def.joint, &def.coordinate)) {
        return false;
    }
    if (!value) {
        return se3di_reader_fail_key(reader, node, "value",
                                     "is missing, must be a number, an expression in t or "
                                     "{spline: [[t, value], ...]}");
    }
    if (!se3di_read_function(reader, value, time_only, &def.value, &def.function)) {
        return false;
    }
    def.name = entry->name;
    entry->coordinate = def.coordinate;
    const se3d_status status = se3d_driver_create(reader->system, &def, &entry->constraint);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

bool se3di_read_drivers(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "drivers", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        if (!read_driver(reader, node)) {
            return false;
        }
    }
    return true;
}
