/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of joints, constraints, drivers and forces, and looking joints up. */
#include "io/read/elements.h"

#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/guess.h"
#include "io/document/reader.h"
#include "io/model/model.h"

const char *const se3di_coordinates[] = {[SE3D_JOINT_COORDINATE_ANGLE] = "angle",
                                         [SE3D_JOINT_COORDINATE_DISPLACEMENT] = "displacement",
                                         NULL};

static const char *const kind_texts[] = {"joint", "constraint", "driver", "force",
                                         "wheel", "state",      "road"};

static void begin_element(se3di_reader *reader, const se3di_node *node, se3di_element_kind kind,
                          const char *name, se3di_element_entry *entry)
{
    memset(entry, 0, sizeof *entry);
    entry->name = name;
    entry->node = node;
    entry->part = reader->part;
    entry->kind = kind;
    reader->alternative = 0;
}

bool se3di_read_element(se3di_reader *reader, const se3di_node *node, se3di_element_kind kind,
                        se3di_element_entry **entry)
{
    se3d_model *model = reader->model;
    const se3di_node *child = se3di_node_get(node, "name");
    const char *name = NULL;
    if (child && !se3di_read_part_name(reader, child, &name)) {
        return false;
    }
    if (!child) {
        char made[48];
        snprintf(made, sizeof made, "%s%zu", kind_texts[kind], node->index + 1);
        name = se3di_iopool_copy(&model->pool, made, strlen(made));
        name = name ? se3di_reader_prefix(reader, name) : NULL;
        if (!name) {
            return se3di_reader_fail_memory(reader);
        }
    }
    size_t known = 0;
    if (se3di_ionames_find(&model->element_names, name, &known)) {
        if (reader->again && model->elements[known].node == node) {
            *entry = &model->elements[known];
            begin_element(reader, node, kind, (*entry)->name, *entry);
            return true;
        }
        return se3di_reader_fail_key(
            reader, node, "name",
            "`%.60s` is the name of two elements: joints, constraints, "
            "drivers, forces, wheels, states and roads must have different "
            "names",
            name);
    }
    se3di_element_entry *grown =
        se3di_iopool_grow(&model->pool, model->elements, model->element_count,
                          &model->element_capacity, sizeof *grown);
    if (!grown ||
        !se3di_ionames_add(&model->element_names, &model->pool, name, model->element_count)) {
        return se3di_reader_fail_memory(reader);
    }
    model->elements = grown;
    *entry = &model->elements[model->element_count++];
    begin_element(reader, node, kind, name, *entry);
    return true;
}

bool se3di_read_key_joint(se3di_reader *reader, const se3di_node *map, const char *key,
                          se3d_constraint *joint)
{
    const se3d_model *model = reader->model;
    const se3di_node *node = se3di_node_get(map, key);
    const char *name = NULL;
    size_t index = 0;
    if (!node) {
        return se3di_reader_fail_key(reader, map, key, "is missing, must be the name of a joint");
    }
    if (!se3di_read_reference(reader, node, &name)) {
        return false;
    }
    if (se3di_reader_find(reader, &model->element_names, name, &index) &&
        model->elements[index].kind == SE3DI_ELEMENT_JOINT) {
        *joint = model->elements[index].constraint;
        return joint->index1 != 0 ||
               se3di_reader_fail(reader, node,
                                 "is `%.60s` itself, must be the name of another joint", name);
    }
    se3di_guess guess = se3di_guess_begin(name);
    for (size_t k = 0; k < model->element_count; ++k) {
        if (model->elements[k].kind == SE3DI_ELEMENT_JOINT) {
            se3di_guess_offer(&guess, model->elements[k].name);
        }
    }
    const char *meant = se3di_guess_get(&guess);
    se3di_reader_fail(reader, node, "no joint is named `%.60s`, %s%s%s", name,
                      meant ? "did you mean `" : "must be the name of one of `joints`",
                      meant ? meant : "", meant ? "`?" : "");
    return se3di_reader_propose(reader, meant);
}

static bool read_coordinate(se3di_reader *reader, const se3di_node *node, se3d_constraint joint,
                            int32_t *coordinate)
{
    const se3d_system *system = reader->system;
    const se3di_node *child = se3di_node_get(node, "coordinate");
    size_t word = 0;
    const bool angle = se3di_joint_has(system, joint, SE3D_JOINT_COORDINATE_ANGLE);
    const bool displacement = se3di_joint_has(system, joint, SE3D_JOINT_COORDINATE_DISPLACEMENT);
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
    if (!se3di_read_word(reader, child, se3di_coordinates, &word)) {
        return false;
    }
    if (word == 0 ? !angle : !displacement) {
        return se3di_reader_fail(reader, child,
                                 "is `%s`, which this joint does not have, must be `%s`",
                                 se3di_coordinates[word], se3di_coordinates[1 - word]);
    }
    *coordinate = (int32_t)word;
    return true;
}

bool se3di_read_key_coordinate(se3di_reader *reader, const se3di_node *node, se3d_constraint joint,
                               int32_t *coordinate)
{
    const bool good = read_coordinate(reader, node, joint, coordinate);
    const bool angle = good && *coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    reader->alternative = angle ? 1 : 0;
    return good && (!angle || se3di_check_angle(reader, node, joint));
}

bool se3di_check_angle(se3di_reader *reader, const se3di_node *node, se3d_constraint joint)
{
    const se3d_model *model = reader->model;
    const bool mirrored = se3di_component_is_mirrored(reader->part);
    for (size_t k = 0; mirrored && k < model->element_count; ++k) {
        const se3di_element_entry *entry = &model->elements[k];
        if (entry->is_turned && entry->constraint.index1 == joint.index1) {
            return se3di_reader_fail(reader, node,
                                     "uses the angle of `%.60s`: in a part that is mirrored it "
                                     "cannot count both its angle and its displacement as in the "
                                     "given one",
                                     entry->name);
        }
    }
    return true;
}
