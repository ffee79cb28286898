/* SPDX-License-Identifier: BSD-3-Clause */
/* `forces`: keys of all types, and readers of all but bushings. */
#include <stdio.h>
#include <string.h>

#include "io/base/number.h"
#include "io/base/rotation.h"
#include "io/channel/law.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/function.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/bodies.h"
#include "io/read/elements.h"
#include "io/read/entries.h"
#include "io/read/forces_bushing.h"
#include "io/read/forces_tyre.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

static const char *const time_only[] = {"t", NULL};
static const char *const frames[] = {"ground", "body", NULL}; /* of se3d_load_def.in_body_frame */
static const char *const tyre_files[] = {".tir", NULL};
static const char *const force_types[] = {"tsda", "rsda",     "bushing", "friction",
                                          "stop", "effort",   "force",   "torque",
                                          "tyre", "armature", NULL};

/* clang-format off */
static const se3di_key force_keys[] = {
    {"name", SE3DI_KIND_NAME, .standard = "force1, force2, ...",
     .text = "unique among joints, drivers, constraints and forces"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"type", SE3DI_KIND_TYPE, .required = true, .text = ""},
    {"body_i", SE3DI_KIND_BODY, .types = " tsda rsda bushing stop ", .text = ""},
    {"body_j", SE3DI_KIND_BODY, .types = " tsda rsda bushing stop ", .text = ""},
    {"point_i", SE3DI_KIND_POINT, .types = " tsda bushing stop ", .text = "frame of body i [m]"},
    {"point_j", SE3DI_KIND_POINT, .types = " tsda bushing stop ", .text = "frame of body j [m]"},
    {"k", SE3DI_KIND_COEFFICIENT, .types = " tsda rsda ", .standard = "0",
     .text = "stiffness [N/m, N m/rad], or the table of the elastic force over l - l0 or theta "
         "- theta0"},
    {"k", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_stop_def, k), .types = " stop ",
     .text = "stiffness [N/m, N m/rad]"},
    {"c", SE3DI_KIND_COEFFICIENT, .types = " tsda rsda ", .standard = "0",
     .text = "damping [N s/m, N m s/rad], or the table of the damping force over the rate"},
    {"l0", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_tsda_def, l0), .types = " tsda ",
     .standard = "0", .text = "free length [m]"},
    {"h", SE3DI_KIND_FUNCTION, .types = " tsda rsda ",
     .text = "actuator [N, N m]: a function of t, l, ldot (tsda) or t, theta, thetadot (rsda), "
         "and of [channels](#laws-of-channels)"},
    {"spring", SE3DI_KIND_FUNCTION, .types = " tsda rsda ",
     .text = "elastic force [N, N m] of x = l - l0 or theta - theta0, beside k"},
    {"damper", SE3DI_KIND_FUNCTION, .types = " tsda rsda ",
     .text = "damping force [N, N m] of v, the rate, beside c"},
    {"preload", SE3DI_KIND_NUMBER, .types = " tsda rsda ", .standard = "0",
     .text = "force at l = l0 (torque at theta = theta0) and rest [N, N m]"},
    {"joint", SE3DI_KIND_JOINT, .types = " rsda ", .text = "a joint with an angle"},
    {"joint", SE3DI_KIND_JOINT, .types = " friction stop effort armature ",
     .text = "a joint with the coordinate"},
    {"theta0", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_rsda_def, theta0), .types = " rsda ",
     .standard = "0", .text = "free angle [rad]"},
    {"axis", SE3DI_KIND_DIRECTION, .types = " rsda ",
     .text = "without a joint: its axis, ground frame"},
    {"ref", SE3DI_KIND_DIRECTION, .types = " rsda ",
     .text = "without a joint: zero direction, ground frame"},
    {"axis_i", SE3DI_KIND_DIRECTION, .types = " rsda ",
     .text = "without a joint: its axis, frame of body i"},
    {"ref_i", SE3DI_KIND_DIRECTION, .types = " rsda ",
     .text = "the angle is from ref_i (frame of body i)"},
    {"ref_j", SE3DI_KIND_DIRECTION, .types = " rsda ", .text = "to ref_j (frame of body j)"},
    {"angle0", SE3DI_KIND_NUMBER, .types = " rsda ", .standard = "0",
     .text = "without a joint: the angle at the given pose [rad]"},
    {"at", SE3DI_KIND_VECTOR, .types = " bushing ",
     .text = "its point at the given pose, ground frame [m]"},
    {"at", SE3DI_KIND_VECTOR, .types = " force tsda stop ",
     .text = "in place of point or point_i: at the given pose, ground frame [m]"},
    {"at_2", SE3DI_KIND_VECTOR, .types = " tsda stop ",
     .text = "in place of point_j: at the given pose, ground frame [m]"},
    {"orientation", SE3DI_KIND_ORIENTATION, .types = " bushing ",
     .text = "with at: its axes in the ground frame"},
    {"orientation_i", SE3DI_KIND_ORIENTATION, .types = " bushing ", .text = "its axes on body i"},
    {"orientation_j", SE3DI_KIND_ORIENTATION, .types = " bushing ", .text = "its axes on body j"},
    {"K", SE3DI_KIND_MATRIX6, .types = " bushing ", .standard = "0",
     .text = "stiffness, symmetric [N/m, N, N m/rad]: the six numbers of a diagonal, or six "
         "rows of six"},
    {"C", SE3DI_KIND_MATRIX6, .types = " bushing ", .standard = "0",
     .text = "damping [N s/m, N s, N m s/rad]"},
    {"coordinate", SE3DI_KIND_WORD, .types = " friction stop effort armature ",
     .words = se3di_coordinates,
     .text = "may be left out if the joint has one only"},
    {"mu", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_friction_def, mu),
     .types = " friction ", .standard = "0", .text = "coefficient of sliding"},
    {"mu_static", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_friction_def, mu_static),
     .types = " friction ", .standard = "mu", .text = "of sticking, at least mu"},
    {"radius", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_friction_def, radius),
     .types = " friction ", .standard = "0", .text = "on an angle: of the bearing [m]"},
    {"limit", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_friction_def, limit),
     .types = " friction ", .standard = "0", .text = "friction without load [N, N m]"},
    {"viscous", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_friction_def, viscous),
     .types = " friction ", .standard = "0", .text = "times the rate [N s/m, N m s/rad]"},
    {"presliding", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_friction_def, presliding),
     .types = " friction ", .standard = "1e-9",
     .text = "how far it gives while it sticks [m, rad]"},
    {"length", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_friction_def, length),
     .types = " friction ", .standard = "one place, no moments",
     .text = "between the two places along the axis that carry the load [m]"},
    {"width", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_friction_def, width),
     .types = " friction ", .standard = "no moment",
     .text = "on a displacement: between the rails that carry the moment about the axis [m]"},
    {"thrust_radius", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_friction_def, thrust_radius), .types = " friction ", .standard = "0",
     .text = "on an angle: of the shoulder that carries the axial force [m]"},
    {"lower", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_stop_def, lower), .types = " stop ",
     .standard = "none", .text = "end of the range [m, rad]"},
    {"upper", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_stop_def, upper), .types = " stop ",
     .standard = "none", .text = "end of the range [m, rad]"},
    {"restitution", SE3DI_KIND_NUMBER, SE3DI_RESTITUTION, SE3DI_INTO(se3d_stop_def, restitution),
     .types = " stop ", .standard = "1", .text = "coefficient of restitution"},
    {"body", SE3DI_KIND_BODY, .types = " force torque ", .text = "what it acts on"},
    {"point", SE3DI_KIND_POINT, .types = " force ", .standard = "the centre of mass",
     .text = "frame of the body [m]"},
    {"frame", SE3DI_KIND_WORD, SE3DI_INTO(se3d_load_def, in_body_frame), .types = " force torque ",
     .words = frames, .standard = "ground", .text = "of value"},
    {"inertia", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_armature_def, inertia),
     .types = " armature ", .required = true,
     .text = "that turns or moves with the coordinate [kg m^2, kg]: of a rotor behind a gear, "
         "ratio squared times its own"},
    {"value", SE3DI_KIND_FUNCTION, .types = " effort ", .standard = "0",
     .text = "along the coordinate [N, N m]: a number, or a function of t, q, qdot: the "
         "coordinate and its rate, and of [channels](#laws-of-channels)"},
    {"value", SE3DI_KIND_FUNCTIONS, .types = " force torque ",
     .text = "numbers or functions of t and of [channels](#laws-of-channels) [N, N m]"},
    {"body", SE3DI_KIND_BODY, .types = " tyre ", .text = "that turns with the tyre: the rim"},
    {"point", SE3DI_KIND_POINT, .types = " tyre ", .standard = "the centre of mass",
     .text = "wheel centre, frame of the body [m]"},
    {"at", SE3DI_KIND_VECTOR, .types = " tyre ",
     .text = "in place of point: at the given pose, ground frame [m]"},
    {"axis", SE3DI_KIND_DIRECTION, .types = " tyre ", .standard = "[0, 1, 0]",
     .text = "spin axis out of the vehicle, to the left on a left wheel, ground frame"},
    {"frame", SE3DI_KIND_WORD, .types = " tyre ", .words = frames, .standard = "ground",
     .text = "of axis, normal and road_point; body: that of the body, and of the road"},
    {"side", SE3DI_KIND_WORD, SE3DI_INTO(se3d_tyre_def, side), .types = " tyre ",
     .words = se3di_tyre_sides, .standard = "left",
     .text = "of the vehicle, where axis points; a part that is mirrored has the other one"},
    {"road", SE3DI_KIND_BODY, .types = " tyre ", .standard = "ground",
     .text = "name of one of `roads`, or of the body that a plane is fixed to"},
    {"envelope", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_tyre_def, envelope_length),
     .types = " tyre ", .standard = "none: it touches a point; on a mesh 0.4 radius",
     .text = "length over which the tyre rolls over obstacles of a road of `roads` [m]"},
    {"envelope_width", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_tyre_def, envelope_width), .types = " tyre ", .standard = "envelope",
     .text = "the same across [m]"},
    {"road_point", SE3DI_KIND_VECTOR, .types = " tyre ", .standard = "[0, 0, 0]",
     .text = "of the road's plane at the given pose, ground frame [m]"},
    {"normal", SE3DI_KIND_DIRECTION, .types = " tyre ", .standard = "[0, 0, 1]",
     .text = "of the road, up, at the given pose, ground frame"},
    {"model", SE3DI_KIND_WORD, SE3DI_INTO(se3d_tyre_def, law), .types = " tyre ",
     .words = se3di_tyre_laws, .standard = "brush, or that of the file",
     .text = "of the forces in the road: brush, Fiala, Magic Formula 5.2 or 6.1"},
    {"file", SE3DI_KIND_FILE, .types = " tyre ", .words = tyre_files,
     .text = "tyre property file of a Magic Formula, relative to the model"},
    {"radius", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_tyre_def, radius),
     .types = " tyre ", .text = "without load [m]"},
    {"k", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_tyre_def, k), .types = " tyre ",
     .text = "vertical stiffness [N/m]"},
    {"c", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_tyre_def, c), .types = " tyre ",
     .standard = "0", .text = "vertical damping [N s/m]"},
    {"mu", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_tyre_def, mu), .types = " tyre ",
     .text = "coefficient of friction"},
    {"mu_min", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_tyre_def, mu_min),
     .types = " tyre ", .standard = "mu", .text = "fiala: at full sliding, at most mu"},
    {"slip_stiffness", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_tyre_def, slip_stiffness), .types = " tyre ",
     .text = "dFx / d(slip ratio) at 0 [N]"},
    {"cornering_stiffness", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_tyre_def, cornering_stiffness), .types = " tyre ",
     .text = "-dFy / d(tangent of the slip angle) at 0 [N]"},
    {"patch_length", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_tyre_def, patch_length), .types = " tyre ", .standard = "0",
     .text = "of the contact patch, for the aligning moment [m]"},
    {"rolling_resistance", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_tyre_def, rolling_resistance), .types = " tyre ", .standard = "0",
     .text = "resistance over load"},
    {"rolling_radius", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_tyre_def, rolling_radius), .types = " tyre ",
     .standard = "radius - deflection/3", .text = "effective [m]"},
    {"low_speed", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_tyre_def, low_speed),
     .types = " tyre ", .standard = "1", .text = "below it slip is regularised [m/s]"},
    {"transient", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_tyre_def, is_transient), .types = " tyre ",
     .standard = "false, or `USE_MODE` of the file",
     .text = "slip lags, by the lengths below or those of the file"},
    {"turn_slip", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_tyre_def, has_turn_slip), .types = " tyre ",
     .standard = "false, or `USE_MODE` of the file",
     .text = "mf52 and mf61: the wheel's turning about the road's normal counts, as in parking and "
         "narrow curves"},
    {"relaxation_x", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_tyre_def, relaxation_x),
     .types = " tyre ", .standard = "that of the file, or none",
     .text = "relaxation length of the slip ratio, which then lags [m]"},
    {"relaxation_y", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_tyre_def, relaxation_y),
     .types = " tyre ", .standard = "that of the file, or none",
     .text = "and of the slip angle [m]"},
    {.key = NULL}};
const se3di_object se3di_object_force = {
    "force",
    "A force element.",
    force_keys, force_types,
    NULL};
/* clang-format on */

/* A function of `variables` under `key`; also a mere number. */
static bool read_function(se3di_reader *reader, const se3di_node *node, const char *key,
                          const char *const *variables, se3d_function *function)
{
    const se3di_node *child = se3di_node_get(node, key);
    se3d_function_def def = se3d_function_def_default();
    if (!child) {
        return true;
    }
    if (!se3di_read_law(reader, child, variables, &def.constant, function)) {
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
    return se3di_reader_check(reader, child, se3d_function_create(reader->system, &def, function));
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
                                 "cannot be combined with a table `%s`, give one of them", key);
    }
    return se3di_read_function(reader, child, x_only, value, function);
}

/* What tsda and rsda have in common: members of their definitions. */
typedef struct spring_places {
    double *k, *c, *preload;
    se3d_function *h, *spring, *damper;
} spring_places;

static bool read_spring(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                        const spring_places *v)
{
    static const char *const elastic[] = {"x", NULL};
    static const char *const viscous[] = {"v", NULL};
    return read_function(reader, node, "spring", elastic, v->spring) &&
           read_function(reader, node, "damper", viscous, v->damper) &&
           read_coefficient(reader, node, "k", "spring", v->k, v->spring) &&
           read_coefficient(reader, node, "c", "damper", v->c, v->damper) &&
           se3di_read_key(reader, node, &se3di_object_force, "tsda", "preload", v->preload) &&
           read_function(reader, node, "h", variables, v->h);
}

static bool read_tsda(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    static const char *const variables[] = {"t", "l", "ldot", NULL};
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    se3d_tsda_def def = se3d_tsda_def_default();
    const spring_places v = {&def.k, &def.c, &def.preload, &def.h, &def.spring, &def.damper};
    if (!se3di_read_bodies_ij(reader, node, "a spring", bodies) ||
        !se3di_read_key_place(reader, node, "point_i", "at", bodies[0], def.point_i) ||
        !se3di_read_key_place(reader, node, "point_j", "at_2", bodies[1], def.point_j) ||
        !se3di_read_fields(reader, node, &se3di_object_force, "tsda", "se3d_tsda_def", &def) ||
        !read_spring(reader, node, variables, &v)) {
        return false;
    }
    def.name = entry->name;
    def.body_i = bodies[0]->body;
    def.body_j = bodies[1]->body;
    entry->body_i = def.body_i;
    entry->body_j = def.body_j;
    entry->drawn = 3;
    memcpy(entry->point_i, def.point_i, sizeof def.point_i);
    memcpy(entry->point_j, def.point_j, sizeof def.point_j);
    return se3di_reader_check(reader, node,
                              se3d_force_create_tsda(reader->system, &def, &entry->force));
}

/* Directions of an rsda without a joint: in the ground frame, or in those of the bodies. */
static bool read_axes(se3di_reader *reader, const se3di_node *node,
                      const se3di_body_entry *const bodies[2], se3d_rsda_def *def)
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
        return se3di_reader_fail_key(
            reader, node, "axis",
            "cannot be combined with ref_i, ref_j: give axis and ref (ground "
            "frame), or axis_i, ref_i, ref_j");
    }
    if (!global) {
        return se3di_read_key_body_direction(reader, node, "axis_i", bodies[0], true,
                                             def->axis_i) &&
               se3di_read_key_body_direction(reader, node, "ref_i", bodies[0], false, def->ref_i) &&
               se3di_read_key_body_direction(reader, node, "ref_j", bodies[1], false, def->ref_j);
    }
    double p[4];
    if (!se3di_read_key_ground_direction(reader, node, "axis", true, axis) ||
        !se3di_read_key_ground_direction(reader, node, "ref", false, ref)) {
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
        return read_axes(reader, node, bodies, def) &&
               se3di_read_key(reader, node, &se3di_object_force, "rsda", "angle0", &def->angle0);
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (se3di_node_get(node, "joint") &&
            se3di_keys_contain(" body_i body_j axis ref axis_i ref_i ref_j angle0 ", child->key)) {
            return se3di_reader_fail(reader, child,
                                     "cannot be combined with `joint`, which has it");
        }
    }
    return se3di_read_key_joint(reader, node, "joint", &def->joint) &&
           se3di_check_angle(reader, node, def->joint);
}

static bool read_rsda(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    static const char *const variables[] = {"t", "theta", "thetadot", NULL};
    se3d_rsda_def def = se3d_rsda_def_default();
    const spring_places v = {&def.k, &def.c, &def.preload, &def.h, &def.spring, &def.damper};
    reader->alternative = 1;
    if (!read_rsda_place(reader, node, &def) ||
        !se3di_read_fields(reader, node, &se3di_object_force, "rsda", "se3d_rsda_def", &def) ||
        !read_spring(reader, node, variables, &v)) {
        return false;
    }
    def.name = entry->name;
    return se3di_reader_check(reader, node,
                              se3d_force_create_rsda(reader->system, &def, &entry->force));
}

/* The joint that an element acts on, and which of its coordinates. */
static bool read_joint(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry,
                       se3d_constraint *joint, int32_t *coordinate)
{
    if (!se3di_read_key_joint(reader, node, "joint", joint) ||
        !se3di_read_key_coordinate(reader, node, *joint, coordinate)) {
        return false;
    }
    entry->coordinate = *coordinate;
    return true;
}

static bool read_friction(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    se3d_friction_def def = se3d_friction_def_default();
    if (!read_joint(reader, node, entry, &def.joint, &def.coordinate) ||
        !se3di_read_fields(reader, node, &se3di_object_force, "friction", "se3d_friction_def",
                           &def)) {
        return false;
    }
    if (def.coordinate == SE3D_JOINT_COORDINATE_ANGLE && def.mu > 0.0 && !(def.radius > 0.0) &&
        !(def.thrust_radius > 0.0)) {
        return se3di_reader_fail_key(reader, node, "radius",
                                     "is missing, friction with `mu` on an angle needs the radius "
                                     "of the bearing [m] > 0");
    }
    def.name = entry->name;
    return se3di_reader_check(reader, node,
                              se3d_force_create_friction(reader->system, &def, &entry->force));
}

static bool read_armature(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    se3d_armature_def def = se3d_armature_def_default();
    if (!read_joint(reader, node, entry, &def.joint, &def.coordinate) ||
        !se3di_read_fields(reader, node, &se3di_object_force, "armature", "se3d_armature_def",
                           &def)) {
        return false;
    }
    def.name = entry->name;
    return se3di_reader_check(reader, node,
                              se3d_force_create_armature(reader->system, &def, &entry->force));
}

static bool read_effort(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    static const char *const variables[] = {"t", "q", "qdot", NULL};
    const se3di_node *value = se3di_node_get(node, "value");
    se3d_effort_def def = se3d_effort_def_default();
    if (!read_joint(reader, node, entry, &def.joint, &def.coordinate) ||
        (value && !se3di_read_law(reader, value, variables, &def.value, &def.function))) {
        return false;
    }
    def.name = entry->name;
    entry->settable = def.function.index1 == 0;
    entry->value[0] = def.value;
    return se3di_reader_check(reader, node,
                              se3d_force_create_effort(reader->system, &def, &entry->force));
}

/* The coordinate of a joint, or two points whose distance it is. */
static bool read_stop_place(se3di_reader *reader, const se3di_node *node, se3d_stop_def *def)
{
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    reader->alternative = 0;
    if (!se3di_node_get(node, "joint") && se3di_node_get(node, "body_j")) {
        if (!se3di_read_bodies_ij(reader, node, "a stop", bodies) ||
            !se3di_read_key_place(reader, node, "point_i", "at", bodies[0], def->point_i) ||
            !se3di_read_key_place(reader, node, "point_j", "at_2", bodies[1], def->point_j)) {
            return false;
        }
        def->body_i = bodies[0]->body;
        def->body_j = bodies[1]->body;
        return true;
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (se3di_node_get(node, "joint") &&
            se3di_keys_contain(" body_i body_j point_i point_j at at_2 ", child->key)) {
            return se3di_reader_fail(reader, child, "cannot be combined with `joint`");
        }
    }
    return se3di_read_key_joint(reader, node, "joint", &def->joint) &&
           se3di_read_key_coordinate(reader, node, def->joint, &def->coordinate);
}

static bool read_stop(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry)
{
    se3d_stop_def def = se3d_stop_def_default();
    if (!read_stop_place(reader, node, &def) ||
        !se3di_read_fields(reader, node, &se3di_object_force, "stop", "se3d_stop_def", &def)) {
        return false;
    }
    if (!se3di_node_get(node, "lower") && !se3di_node_get(node, "upper")) {
        return se3di_reader_fail_key(reader, node, "upper",
                                     "is missing, a stop needs `lower`, `upper` or both");
    }
    if (!se3di_node_get(node, "k")) {
        return se3di_reader_fail_key(reader, node, "k",
                                     "is missing, a stop needs its stiffness > 0");
    }
    def.name = entry->name;
    entry->coordinate =
        se3di_node_get(node, "joint") ? def.coordinate : SE3D_JOINT_COORDINATE_DISPLACEMENT;
    return se3di_reader_check(reader, node,
                              se3d_force_create_stop(reader->system, &def, &entry->force));
}

/* The components in the frame that the part is put in: sums of the given ones, M f. */
static bool read_placed_load(se3di_reader *reader, const se3di_node *value,
                             const se3di_body_entry *body, bool is_torque, se3d_load_def *def)
{
    const se3di_placement *place = &reader->part->place;
    const bool own = def->in_body_frame && body->part == reader->part;
    if (def->in_body_frame && !se3di_check_frame(reader, value, body)) {
        return false;
    }
    for (size_t i = 0; i < 3; ++i) {
        se3di_node sum = *value->first;
        char text[SE3D_EXPRESSION_TEXT_MAX + 1] = "0";
        char factor[SE3DI_NUMBER_SIZE];
        size_t used = 1;
        const se3di_node *part = value->first;
        for (size_t j = 0; j < 3; ++j, part = part->next) {
            double column[3] = {j == 0, j == 1, j == 2};
            if (own) {
                (is_torque ? se3di_flip_axial : se3di_flip_vector)(place, column);
            } else if (!def->in_body_frame) {
                (is_torque ? se3di_place_axial : se3di_place_vector)(place, column);
            }
            if (!part->text) {
                return se3di_reader_fail(reader, part,
                                         "is %s, must be a number or an expression in t in a part "
                                         "that is turned or mirrored",
                                         se3di_node_describe(part));
            }
            if (column[i] != 0.0 && used < sizeof text) {
                sum = used == 1 ? *part : sum;
                (void)se3di_number_format(column[i], factor);
                used += (size_t)snprintf(text + used, sizeof text - used, "+%s*(%s)", factor,
                                         part->text);
            }
        }
        if (used >= sizeof text) {
            return se3di_reader_fail(reader, value, "is too long, at most %d characters",
                                     SE3D_EXPRESSION_TEXT_MAX);
        }
        sum.text = text[1] == '+' ? text + 2 : text;
        sum.one_line = false;
        if (!se3di_read_law(reader, &sum, time_only, &def->value[i], &def->function[i])) {
            return false;
        }
    }
    return true;
}

/* A force at a point or a torque: three components, each a number or a function of time. */
static bool read_load(se3di_reader *reader, const se3di_node *node, const char *type,
                      se3di_element_entry *entry)
{
    const se3di_body_entry *body = NULL;
    const se3di_node *value = se3di_node_get(node, "value");
    se3d_load_def def = se3d_load_def_default();
    if (!se3di_read_key_body(reader, node, "body", &body) ||
        !se3di_read_key_place(reader, node, "point", "at", body, def.point) ||
        !se3di_read_fields(reader, node, &se3di_object_force, type, "se3d_load_def", &def)) {
        return false;
    }
    if (!value || value->kind != SE3DI_NODE_LIST || value->count != 3) {
        return se3di_reader_fail_key(reader, node, "value",
                                     "must be a list of 3 numbers or expressions in t");
    }
    const se3di_node *part = value->first;
    reader->alternative = strcmp(type, "torque") == 0;
    if (reader->part->place.turns) {
        if (!read_placed_load(reader, value, body, strcmp(type, "torque") == 0, &def)) {
            return false;
        }
    } else {
        for (size_t k = 0; k < 3; ++k, part = part->next) {
            if (!se3di_read_law(reader, part, time_only, &def.value[k], &def.function[k])) {
                return false;
            }
        }
    }
    entry->body = body->body;
    memcpy(entry->point, def.point, sizeof entry->point);
    for (size_t k = 0; k < 3; ++k) {
        entry->settable |= def.function[k].index1 == 0 ? 1U << k : 0;
        entry->value[k] = def.value[k];
    }
    def.name = entry->name;
    def.body = body->body;
    return se3di_reader_check(reader, node,
                              strcmp(type, "force") == 0
                                  ? se3d_force_create_load(reader->system, &def, &entry->force)
                                  : se3d_force_create_torque(reader->system, &def, &entry->force));
}

typedef bool (*read_element)(se3di_reader *reader, const se3di_node *node,
                             se3di_element_entry *entry);

static bool read_force(se3di_reader *reader, const se3di_node *node)
{
    static const struct {
        const char *type;
        read_element read;
    } readers[] = {
        {"tsda", read_tsda},         {"rsda", read_rsda},        {"bushing", se3di_read_bushing},
        {"friction", read_friction}, {"effort", read_effort},    {"stop", read_stop},
        {"tyre", se3di_read_tyre},   {"armature", read_armature}};
    const char *type = NULL;
    se3di_element_entry *entry = NULL;
    if (!se3di_read_type(reader, node, &se3di_object_force, &type) ||
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
    return se3di_read_each(reader, root, "forces", read_force);
}
