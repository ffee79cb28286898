/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints between two bodies, by a global frame or locally. */
#include "io/read/pairs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/bodies.h"
#include "io/read/objects.h"

typedef se3d_status (*create_joint)(se3d_system *, const se3d_joint_def *, se3d_constraint *);

typedef struct joint_type {
    const char *name;
    create_joint create;
    unsigned needs;
} joint_type;

#define TYPE(name, needs, look) {#name, se3d_joint_create_##name, needs},
static const joint_type joint_types[] = {SE3DI_TURNING_LIST(TYPE) SE3DI_DISTANCE_LIST(TYPE)
                                             SE3DI_PERPENDICULAR_LIST(TYPE)};
#undef TYPE

static bool has(const se3di_node *node, const char *key)
{
    return se3di_node_get(node, key) != NULL;
}

static bool is_local(const se3di_node *node)
{
    static const char *const keys[] = {"point_i", "point_j", "axis_i", "axis_j", "ref_i", "ref_j"};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k) {
        if (has(node, keys[k])) {
            return true;
        }
    }
    return false;
}

static bool to_body_axis(se3di_reader *reader, se3d_body body, const double ground[3],
                         double local[3])
{
    double p[4];
    if (SE3D_FAILED(se3d_body_get_orientation(reader->system, body, p))) {
        return se3di_reader_fail_memory(reader);
    }
    se3di_rotation_apply_inverse(p, ground, local);
    return true;
}

/* Mirrored, its axis turns with the displacement; of other joints with the angle. */
static bool has_travel(const joint_type *type)
{
    return se3di_keys_contain(" prismatic cylindrical screw ", type->name);
}

static bool read_local(se3di_reader *reader, const se3di_node *node, const joint_type *type,
                       const se3di_body_entry *bodies[2], se3d_joint_def *def)
{
    static const char *const global[] = {"at", "axis", "ref", "at_2", "axis_2"};
    for (size_t k = 0; k < sizeof global / sizeof *global; ++k) {
        if (has(node, global[k])) {
            return se3di_reader_fail_key(
                reader, node, global[k],
                "cannot be combined with point_i, axis_i ...: give either the "
                "global frame (at, axis, ref) or the local ones");
        }
    }
    if ((type->needs & POINT) && !has(node, "point_i") && !has(node, "point_j")) {
        return se3di_reader_fail_key(reader, node, "point_i",
                                     "is missing, a %s joint needs point_i and point_j",
                                     type->name);
    }
    if ((type->needs & AXIS_I) && !has(node, "axis_i")) {
        return se3di_reader_fail_key(reader, node, "axis_i", "is missing, `%s` needs it",
                                     type->name);
    }
    if ((type->needs & AXIS_J) && !has(node, "axis_j")) {
        return se3di_reader_fail_key(reader, node, "axis_j", "is missing, `%s` needs it",
                                     type->name);
    }
    const bool axial = !has_travel(type);
    return se3di_read_key_point(reader, node, "point_i", bodies[0], def->point_i) &&
           se3di_read_key_point(reader, node, "point_j", bodies[1], def->point_j) &&
           se3di_read_key_body_direction(reader, node, "axis_i", bodies[0], axial, def->axis_i) &&
           se3di_read_key_body_direction(reader, node, "axis_j", bodies[1], axial, def->axis_j) &&
           se3di_read_key_body_direction(reader, node, "ref_i", bodies[0], false, def->ref_i) &&
           se3di_read_key_body_direction(reader, node, "ref_j", bodies[1], false, def->ref_j);
}

/* Two points at the given pose say how far they are apart. */
static bool takes_distance(const se3di_node *node, const joint_type *type)
{
    return strcmp(type->name, "distance") == 0 && !has(node, "distance") && has(node, "at") &&
           has(node, "at_2");
}

static bool check_global(se3di_reader *reader, const se3di_node *node, const joint_type *type)
{
    if ((type->needs & POINT) && !has(node, "at")) {
        return se3di_reader_fail_key(reader, node, "at",
                                     "is missing, `%s` needs a point `at` [x, y, z] in the ground "
                                     "frame, or point_i and point_j on the bodies",
                                     type->name);
    }
    if ((type->needs & AXIS_I) && !has(node, "axis")) {
        return se3di_reader_fail_key(reader, node, "axis",
                                     "is missing, `%s` needs an `axis` [x, y, z] in the ground "
                                     "frame, or axis_i and axis_j on the bodies",
                                     type->name);
    }
    if ((type->needs & AXIS_2) && !has(node, "axis_2")) {
        return se3di_reader_fail_key(reader, node, "axis_2",
                                     "is missing, `%s` needs the axis of body j in the ground "
                                     "frame beside `axis`, that of body i",
                                     type->name);
    }
    if ((type->needs & DISTANCE) && strcmp(type->name, "revolute_cylindrical") != 0 &&
        !has(node, "at_2")) {
        return se3di_reader_fail_key(reader, node, "at_2",
                                     "is missing, `%s` needs the point of body j in the ground "
                                     "frame beside `at`, that of body i",
                                     type->name);
    }
    return true;
}

static bool read_global(se3di_reader *reader, const se3di_node *node, const joint_type *type,
                        se3d_joint_def *def)
{
    double at[3] = {0.0};
    double at_2[3];
    double axis[3] = {0.0, 0.0, 1.0};
    double axis_2[3];
    double ref[3];
    if (!check_global(reader, node, type)) {
        return false;
    }
    if (!has(node, "at") && SE3D_FAILED(se3d_body_get_position(reader->system, def->body_j, at))) {
        return se3di_reader_fail_memory(reader);
    }
    const bool axial = !has_travel(type);
    if (!se3di_read_key_ground_point(reader, node, "at", at) ||
        !se3di_read_key_ground_point(reader, node, "at_2", at_2) ||
        !se3di_read_key_ground_direction(reader, node, "axis", axial, axis) ||
        !se3di_read_key_ground_direction(reader, node, "axis_2", axial, axis_2) ||
        !se3di_read_key_ground_direction(reader, node, "ref", false, ref)) {
        return false;
    }
    const se3d_status status =
        se3d_joint_def_set_frame(reader->system, def, at, axis, has(node, "ref") ? ref : NULL);
    if (status < 0) {
        return se3di_reader_fail_system(reader, node, status);
    }
    if (takes_distance(node, type)) {
        def->distance =
            sqrt((at_2[0] - at[0]) * (at_2[0] - at[0]) + (at_2[1] - at[1]) * (at_2[1] - at[1]) +
                 (at_2[2] - at[2]) * (at_2[2] - at[2]));
    }
    return (!has(node, "at_2") || se3di_ground_to_body(reader, def->body_j, at_2, def->point_j)) &&
           (!has(node, "axis_2") || to_body_axis(reader, def->body_j, axis_2, def->axis_j));
}

static bool read_sizes(se3di_reader *reader, const se3di_node *node, const joint_type *type,
                       se3d_joint_def *def)
{
    if ((type->needs & DISTANCE) && !has(node, "distance") && !takes_distance(node, type)) {
        return se3di_reader_fail_key(reader, node, "distance", "is missing, `%s` needs it [m]",
                                     type->name);
    }
    if ((type->needs & PITCH) && !has(node, "pitch")) {
        return se3di_reader_fail_key(reader, node, "pitch",
                                     "is missing, `screw` needs its advance per turn [m]");
    }
    return se3di_read_fields(reader, node, &se3di_object_joint, type->name, "se3d_joint_def", def);
}

static const joint_type *find_type(const char *name)
{
    for (size_t k = 0; k < sizeof joint_types / sizeof *joint_types; ++k) {
        if (strcmp(joint_types[k].name, name) == 0) {
            return &joint_types[k];
        }
    }
    return NULL;
}

/* Its limits, and the channel that tells whether they were passed. */
static bool read_break(se3di_reader *reader, const se3di_node *node, se3d_joint_def *def,
                       se3di_element_entry *entry)
{
    const se3di_node *limits = se3di_node_get(node, "break");
    char channel[400];
    if (!limits) {
        return true;
    }
    if (!se3di_read_keys(reader, limits, &se3di_object_breakage) ||
        !se3di_read_fields(reader, limits, &se3di_object_breakage, NULL, "se3d_joint_def", def)) {
        return false;
    }
    if (!(def->break_force > 0.0) && !(def->break_moment > 0.0)) {
        return se3di_reader_fail(reader, limits,
                                 "has no limit, must have `force`, `moment` or "
                                 "both");
    }
    snprintf(channel, sizeof channel, "%s.broken", entry->name);
    entry->break_channel = se3di_iopool_copy(reader->pool, channel, strlen(channel));
    return entry->break_channel ? true : se3di_reader_fail_memory(reader);
}

bool se3di_read_pair(se3di_reader *reader, const se3di_node *node, const char *name,
                     se3di_element_entry *entry)
{
    const joint_type *type = find_type(name);
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    se3d_joint_def def = se3d_joint_def_default();
    if (!type) {
        return se3di_reader_fail(reader, node, "a joint of type `%.60s` cannot be made", name);
    }
    if (!se3di_read_bodies_ij(reader, node, "a joint", bodies)) {
        return false;
    }
    def.name = entry->name;
    def.body_i = bodies[0]->body;
    def.body_j = bodies[1]->body;
    if (!read_sizes(reader, node, type, &def) || !read_break(reader, node, &def, entry)) {
        return false;
    }
    if (is_local(node) ? !read_local(reader, node, type, bodies, &def)
                       : !read_global(reader, node, type, &def)) {
        return false;
    }
    if (reader->part->place.mirror >= 0 && has_travel(type)) {
        entry->is_turned = true;
        def.angle0 = 0.0 - def.angle0;
        def.pitch = 0.0 - def.pitch;
    }
    entry->body_i = def.body_i;
    entry->body_j = def.body_j;
    entry->drawn = (type->needs & AXIS_J) ? 2 : 1;
    memcpy(entry->point_i, def.point_i, sizeof def.point_i);
    memcpy(entry->point_j, def.point_j, sizeof def.point_j);
    memcpy(entry->axis_i, def.axis_i, sizeof def.axis_i);
    memcpy(entry->axis_j, def.axis_j, sizeof def.axis_j);
    return se3di_reader_check(reader, node, type->create(reader->system, &def, &entry->constraint));
}
