/* SPDX-License-Identifier: BSD-3-Clause */
/* `constraints`: the primitives DP1, DP2, D, CD and the intermediate constraints of ME751. */
#include <string.h>

#include "io/channel/law.h"
#include "io/document/document.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/bodies.h"
#include "io/read/elements.h"
#include "io/read/entries.h"
#include "io/read/objects.h"
#include "io/read/pairs.h"
#include "io/read/sections.h"

#define PRIMITIVES                                                                                 \
    [SE3D_PRIMITIVE_DP1] = "dp1", [SE3D_PRIMITIVE_DP2] = "dp2", [SE3D_PRIMITIVE_D] = "d",          \
    [SE3D_PRIMITIVE_CD] = "cd"
static const char *const primitive_types[] = {PRIMITIVES, NULL};
static const char *const constraint_types[] = {PRIMITIVES, "perpendicular1", "perpendicular2",
                                               NULL};

/* clang-format off */
static const se3di_key constraint_keys[] = {
    {"name", SE3DI_KIND_NAME, .standard = "constraint1, constraint2, ...",
     .text = "unique among joints, drivers, constraints and forces"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"type", SE3DI_KIND_TYPE, .required = true, .text = ""},
    {"body_i", SE3DI_KIND_BODY, .required = true, .text = ""},
    {"body_j", SE3DI_KIND_BODY, .required = true, .text = ""},
    {"a_i", SE3DI_KIND_DIRECTION, .types = " dp1 dp2 ", .text = "frame of body i"},
    {"a_j", SE3DI_KIND_DIRECTION, .types = " dp1 ", .text = "frame of body j"},
    {"point_i", SE3DI_KIND_POINT, .types = " dp2 d cd perpendicular1 perpendicular2 ",
     .text = "frame of body i [m]"},
    {"point_j", SE3DI_KIND_POINT, .types = " dp2 d cd perpendicular1 perpendicular2 ",
     .text = "frame of body j [m]"},
    {"c", SE3DI_KIND_DIRECTION, .types = " cd ", .text = "ground frame"},
    {"value", SE3DI_KIND_FUNCTION, .types = " dp1 dp2 d cd ", .standard = "0",
     .text = "what the expression of the primitive is equal to [1, m, m^2, m]; a function of t "
         "makes it a driver"},
    {"at", SE3DI_KIND_VECTOR, .types = " dp2 d cd ",
     .text = "in place of point_i: at the given pose, ground frame [m]"},
    {"at_2", SE3DI_KIND_VECTOR, .types = " dp2 d cd ",
     .text = "in place of point_j: at the given pose, ground frame [m]"},
    {"at", SE3DI_KIND_VECTOR, .types = " perpendicular1 perpendicular2 ",
     .text = "as of a joint [m]"},
    {"axis", SE3DI_KIND_DIRECTION, .types = " perpendicular1 perpendicular2 ",
     .text = "as of a joint"},
    {"axis_i", SE3DI_KIND_DIRECTION, .types = " perpendicular1 perpendicular2 ",
     .text = "as of a joint"},
    {"axis_j", SE3DI_KIND_DIRECTION, .types = " perpendicular1 ", .text = "as of a joint"},
    {"axis_2", SE3DI_KIND_DIRECTION, .types = " perpendicular1 ", .text = "as of a joint"},
    {"at_2", SE3DI_KIND_VECTOR, .types = " perpendicular2 ", .text = "as of a joint [m]"},
    {.key = NULL}};
const se3di_object se3di_object_constraint = {
    "constraint",
    "A constraint primitive; d runs from the point of body i to that of body j.",
    constraint_keys, constraint_types,
    NULL};
/* clang-format on */

static bool require(se3di_reader *reader, const se3di_node *node, const char *key, const char *type)
{
    return se3di_node_get(node, key)
               ? true
               : se3di_reader_fail_key(reader, node, key, "is missing, `%s` needs it", type);
}

static bool read_geometry(se3di_reader *reader, const se3di_node *node,
                          const se3di_body_entry *bodies[2], se3d_primitive_def *def)
{
    static const char *const required[] = {" a_i a_j ", " a_i ", "  ", " c "};
    static const char *const directions[] = {"a_i", "a_j", "c"};
    double *const targets[] = {def->a_i, def->a_j, def->c};
    for (size_t k = 0; k < 3; ++k) {
        if (se3di_keys_contain(required[def->type], directions[k]) &&
            !require(reader, node, directions[k], primitive_types[def->type])) {
            return false;
        }
        if (k < 2 ? !se3di_read_key_body_direction(reader, node, directions[k], bodies[k], false,
                                                   targets[k])
                  : !se3di_read_key_ground_direction(reader, node, directions[k], false,
                                                     targets[k])) {
            return false;
        }
    }
    return se3di_read_key_place(reader, node, "point_i", "at", bodies[0], def->point_i) &&
           se3di_read_key_place(reader, node, "point_j", "at_2", bodies[1], def->point_j);
}

static bool read_value(se3di_reader *reader, const se3di_node *node, se3d_primitive_def *def)
{
    const se3di_node *value = se3di_node_get(node, "value");
    if (!value) {
        return def->type != SE3D_PRIMITIVE_D || require(reader, node, "value", "d");
    }
    reader->alternative = def->type;
    if (!se3di_read_prescribed(reader, value, &def->value, &def->function)) {
        return false;
    }
    if (def->type == SE3D_PRIMITIVE_D && def->function.index1 == 0 && !(def->value > 0.0)) {
        return se3di_reader_fail(reader, value,
                                 "is %s, must be > 0: the square of the distance [m^2]; for a "
                                 "distance of zero use a spherical joint",
                                 value->text);
    }
    return true;
}

static bool read_primitive(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    size_t index = 0;
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    se3d_primitive_def def = se3d_primitive_def_default();
    if (!se3di_read_word(reader, se3di_node_get(node, "type"), primitive_types, &index)) {
        return false;
    }
    def.type = (int32_t)index;
    if (!se3di_read_bodies_ij(reader, node, "a constraint", bodies)) {
        return false;
    }
    def.name = entry->name;
    def.body_i = bodies[0]->body;
    def.body_j = bodies[1]->body;
    if (!read_geometry(reader, node, bodies, &def) || !read_value(reader, node, &def)) {
        return false;
    }
    return se3di_reader_check(reader, node,
                              se3d_primitive_create(reader->system, &def, &entry->constraint));
}

static bool read_constraint(se3di_reader *reader, const se3di_node *node)
{
    const char *type = NULL;
    se3di_element_entry *entry = NULL;
    if (!se3di_read_type(reader, node, &se3di_object_constraint, &type) ||
        !se3di_read_element(reader, node, SE3DI_ELEMENT_CONSTRAINT, &entry)) {
        return false;
    }
    return strncmp(type, "perpendicular", 13) == 0 ? se3di_read_pair(reader, node, type, entry)
                                                   : read_primitive(reader, node, entry);
}

bool se3di_read_constraints(se3di_reader *reader, const se3di_node *root)
{
    return se3di_read_each(reader, root, "constraints", read_constraint);
}
