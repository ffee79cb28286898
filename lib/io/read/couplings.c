/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints between joints: gear, rack and pinion, coupler. */
#include "io/read/couplings.h"

#include <string.h>

#include "io/channel/law.h"
#include "io/document/document.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/elements.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

/* clang-format off */
static const se3di_key term_keys[] = {
    {"joint", SE3DI_KIND_JOINT, .required = true, .text = ""},
    {"coordinate", SE3DI_KIND_WORD, .words = se3di_coordinates,
     .text = "may be left out if the joint has one only"},
    {"ratio", SE3DI_KIND_NUMBER, .standard = "1", .text = ""},
    {.key = NULL}};
const se3di_object se3di_object_term = {
    "term",
    "A term of a coupler.",
    term_keys, NULL,
    NULL};
/* clang-format on */

/* The joints of a pair, the first of which has an angle. */
static bool read_pair(se3di_reader *reader, const se3di_node *node, const char *first,
                      const char *second, se3d_constraint joint[2])
{
    return se3di_read_key_joint(reader, node, first, &joint[0]) &&
           se3di_read_key_joint(reader, node, second, &joint[1]) &&
           se3di_check_angle(reader, node, joint[0]);
}

/* A number that has no default; `why`: what it is for. */
static bool read_needed(se3di_reader *reader, const se3di_node *node, const char *key,
                        const char *why, double *number)
{
    return (se3di_node_get(node, key) ||
            se3di_reader_fail_key(reader, node, key, "is missing: %s", why)) &&
           se3di_read_key_number(reader, node, key, SE3DI_ANY, number);
}

bool se3di_read_gear(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    se3d_constraint joint[2];
    double ratio = 0.0;
    if (!read_pair(reader, node, "joint_1", "joint_2", joint) ||
        !se3di_check_angle(reader, node, joint[1])) {
        return false;
    }
    if (joint[0].index1 == joint[1].index1) {
        return se3di_reader_fail_key(reader, node, "joint_2",
                                     "is the same as joint_1, must be another joint");
    }
    return read_needed(reader, node, "ratio", "ratio * angle 1 + angle 2 = constant", &ratio) &&
           se3di_reader_check(reader, node,
                              se3d_joint_create_gear(reader->system, entry->name, joint[0],
                                                     joint[1], ratio, &entry->constraint));
}

bool se3di_read_rack(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    se3d_constraint joint[2];
    double radius = 0.0;
    return read_pair(reader, node, "pinion", "rack", joint) &&
           read_needed(reader, node, "radius", "displacement = radius * angle + constant [m]",
                       &radius) &&
           se3di_reader_check(reader, node,
                              se3d_joint_create_rack_pinion(reader->system, entry->name, joint[0],
                                                            joint[1], radius, &entry->constraint));
}

bool se3di_read_coupler(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
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
        if (!se3di_read_keys(reader, term, &se3di_object_term) ||
            !se3di_read_key_joint(reader, term, "joint", &def.joint[def.count]) ||
            !se3di_read_key_coordinate(reader, term, def.joint[def.count],
                                       &def.coordinate[def.count]) ||
            !se3di_read_key_number(reader, term, "ratio", SE3DI_ANY, &def.ratio[def.count])) {
            return false;
        }
    }
    reader->alternative = -1; /* of sums of angles and displacements */
    if (value && !se3di_read_prescribed(reader, value, &def.value, &def.function)) {
        return false;
    }
    def.name = entry->name;
    return se3di_reader_check(reader, node,
                              se3d_joint_create_coupler(reader->system, &def, &entry->constraint));
}
