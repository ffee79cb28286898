/* SPDX-License-Identifier: BSD-3-Clause */
/* `joints`: their list. Those between two bodies: pairs.c, those between joints: couplings.c. */
#include <string.h>

#include "io/read/couplings.h"
#include "io/read/elements.h"
#include "io/read/objects.h"
#include "io/read/pairs.h"
#include "io/read/sections.h"

typedef bool (*read_element)(se3di_reader *reader, const se3di_node *node,
                             se3di_element_entry *entry);

#define NAME(name, needs, look) #name,
static const char *const joint_types[] = {SE3DI_TURNING_LIST(NAME) SE3DI_DISTANCE_LIST(NAME) "gear",
                                          "rack_pinion", "coupler", NULL};
#undef NAME
#define WORD(name, needs, look) #name " "
#define TURNING                 " " SE3DI_TURNING_LIST(WORD)
#define PAIRS                   TURNING SE3DI_DISTANCE_LIST(WORD)

/* clang-format off */
static const se3di_key joint_keys[] = {
    {"name", SE3DI_KIND_NAME, .standard = "joint1, joint2, ...",
     .text = "unique among joints, drivers, constraints and forces"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"type", SE3DI_KIND_TYPE, .required = true, .text = ""},
    {"body_i", SE3DI_KIND_BODY, .types = PAIRS, .text = "the reference"},
    {"body_j", SE3DI_KIND_BODY, .types = PAIRS, .text = "moves relative to body_i"},
    {"at", SE3DI_KIND_VECTOR, .types = PAIRS,
     .text = "joint point, ground frame, at the given pose [m]"},
    {"axis", SE3DI_KIND_DIRECTION, .types = TURNING, .text = "joint axis, ground frame"},
    {"ref", SE3DI_KIND_DIRECTION, .types = TURNING,
     .text = "zero direction of the angle, ground frame"},
    {"at_2", SE3DI_KIND_VECTOR,
     .types = " point_on_line point_on_plane distance revolute_spherical revolute_cylindrical ",
     .text = "point of body j if it is another one, ground frame [m]"},
    {"axis_2", SE3DI_KIND_DIRECTION, .types = " universal revolute_cylindrical perpendicular ",
     .text = "axis of body j if it is another one, ground frame"},
    {"point_i", SE3DI_KIND_POINT, .types = PAIRS,
     .text = "frame of body i [m]; one of the points may be left out and is the origin"},
    {"point_j", SE3DI_KIND_POINT, .types = PAIRS, .text = "frame of body j [m]"},
    {"axis_i", SE3DI_KIND_DIRECTION, .types = TURNING, .text = "frame of body i"},
    {"axis_j", SE3DI_KIND_DIRECTION, .types = TURNING, .text = "frame of body j"},
    {"ref_i", SE3DI_KIND_DIRECTION, .types = TURNING,
     .text = "the angle is from ref_i to ref_j about the axis; frame of body i"},
    {"ref_j", SE3DI_KIND_DIRECTION, .types = TURNING, .text = "see ref_i; frame of body j"},
    {"angle0", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_joint_def, angle0), .types = TURNING,
     .standard = "0",
     .text = "angle at the given pose, or, with ref_j, when ref_i and ref_j coincide [rad]"},
    {"pitch", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_joint_def, pitch), .types = " screw ",
     .text = "advance per turn [m]"},
    {"distance", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_joint_def, distance),
     .types = " distance revolute_spherical ", .standard = "that of `at` and `at_2` (`distance`)",
     .text = "[m]"},
    {"distance", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_joint_def, distance),
     .types = " revolute_cylindrical ", .text = "[m]"},
    {"break", SE3DI_KIND_OBJECT, .types = PAIRS, .object = "breakage",
     .text = "it breaks where its reaction passes one of these limits, in dynamics"},
    {"joint_1", SE3DI_KIND_JOINT, .types = " gear ", .text = "a joint with an angle"},
    {"joint_2", SE3DI_KIND_JOINT, .types = " gear ", .text = "another joint with an angle"},
    {"ratio", SE3DI_KIND_NUMBER, .types = " gear ",
     .text = "ratio * angle 1 + angle 2 = constant"},
    {"pinion", SE3DI_KIND_JOINT, .types = " rack_pinion ", .text = "a joint with an angle"},
    {"rack", SE3DI_KIND_JOINT, .types = " rack_pinion ", .text = "a joint with a displacement"},
    {"radius", SE3DI_KIND_NUMBER, .types = " rack_pinion ",
     .text = "displacement = radius * angle + constant [m]"},
    {"terms", SE3DI_KIND_TERMS, .types = " coupler ", .object = "term",
     .text = "sum of ratio * coordinate = value"},
    {"value", SE3DI_KIND_FUNCTION, .types = " coupler ", .standard = "0",
     .text = "a number or a function of t"},
    {.key = NULL}};
const se3di_object se3di_object_joint = {
    "joint",
    "A joint between two bodies, by a global frame at the given pose or by local ones; or "
         "between joints.",
    joint_keys, joint_types,
    NULL};
static const se3di_key breakage_keys[] = {
    {"force", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_joint_def, break_force),
     .standard = "no limit", .text = "of the force of the reaction [N]"},
    {"moment", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_joint_def, break_moment),
     .standard = "no limit", .text = "of its moment about the joint point on body j [N m]"},
    {.key = NULL}};
const se3di_object se3di_object_breakage = {
    "breakage",
    "Limits at which a joint breaks.",
    breakage_keys, NULL,
    NULL};
/* clang-format on */

#undef WORD

/* How a coupling is read, NULL: it is no coupling. */
static read_element find_coupling(const char *type)
{
    static const struct {
        const char *type;
        read_element read;
    } readers[] = {{"gear", se3di_read_gear},
                   {"rack_pinion", se3di_read_rack},
                   {"coupler", se3di_read_coupler}};
    for (size_t k = 0; k < sizeof readers / sizeof *readers; ++k) {
        if (strcmp(readers[k].type, type) == 0) {
            return readers[k].read;
        }
    }
    return NULL;
}

static bool read_joint(se3di_reader *reader, const se3di_node *node, const char *type)
{
    const read_element read = find_coupling(type);
    se3di_element_entry *entry = NULL;
    if (!se3di_read_element(reader, node, SE3DI_ELEMENT_JOINT, &entry)) {
        return false;
    }
    return read ? read(reader, node, entry) : se3di_read_pair(reader, node, type, entry);
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
            bool wanted = true;
            if (!se3di_reader_wants(reader, node)) {
                continue;
            }
            if (!se3di_read_when(reader, node, &wanted) ||
                !se3di_read_type(reader, node, &se3di_object_joint, &type) ||
                (wanted && (find_coupling(type) != NULL) == (round == 1) &&
                 !read_joint(reader, node, type))) {
                return false;
            }
        }
    }
    return true;
}
