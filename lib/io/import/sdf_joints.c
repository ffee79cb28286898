/* SPDX-License-Identifier: BSD-3-Clause */
/* SDF: joints. Both frames of a joint are its own, in which all coordinates are zero at the poses
 * of the file; so closed loops meet as they are. */
#include <math.h>
#include <string.h>

#include "io/import/sdf.h"
#include "io/import/urdf.h"

#define PI      3.14159265358979323846
#define ENDLESS 1e15 /* a limit beyond it is none; SDF's own is 1e16 */
#define SQUARE  1e-9 /* what the axes of a cross may be off a right angle */

typedef enum joint_kind { KIND_PLAIN, KIND_TURN, KIND_SLIDE, KIND_SCREW, KIND_TWO } joint_kind;

static const struct {
    const char *name;
    se3di_link_joint_type type;
    joint_kind kind;
} types[] = {
    {"revolute", SE3DI_LINK_REVOLUTE, KIND_TURN},    {"continuous", SE3DI_LINK_REVOLUTE, KIND_TURN},
    {"prismatic", SE3DI_LINK_PRISMATIC, KIND_SLIDE}, {"screw", SE3DI_LINK_SCREW, KIND_SCREW},
    {"ball", SE3DI_LINK_SPHERICAL, KIND_PLAIN},      {"fixed", SE3DI_LINK_FIXED, KIND_PLAIN},
    {"universal", SE3DI_LINK_UNIVERSAL, KIND_TWO},   {"revolute2", SE3DI_LINK_UNIVERSAL, KIND_TWO}};

/* The bounds of a drive that are given; NULL: none, or no memory. */
static const char *describe_drive(se3di_machine *m, double effort, double rate)
{
    const bool pushes = effort > 0.0 && effort < ENDLESS;
    const bool moves = rate > 0.0 && rate < ENDLESS;
    const char *most = pushes ? se3di_machine_number(m, effort) : "";
    const char *fastest = moves ? se3di_machine_number(m, rate) : "";
    return pushes || moves ? se3di_machine_text(m, "%s%s%s%s%s", pushes ? "effort up to " : "",
                                                most, pushes && moves ? ", " : "",
                                                moves ? "rate up to " : "", fastest)
                           : NULL;
}

/* Ends, damping, friction and spring along an axis. */
static bool read_dynamics(se3di_machine *m, const se3di_xml *axis, bool endless,
                          se3di_link_joint *joint)
{
    const se3di_xml *limit = se3di_xml_child(axis, "limit");
    const se3di_xml *dynamics = se3di_xml_child(axis, "dynamics");
    double effort = -1.0;
    double rate = -1.0;
    joint->lower = -1e16;
    joint->upper = 1e16;
    if ((limit && (!se3di_sdf_number(m, limit, "lower", &joint->lower) ||
                   !se3di_sdf_number(m, limit, "upper", &joint->upper) ||
                   !se3di_sdf_number(m, limit, "effort", &effort) ||
                   !se3di_sdf_number(m, limit, "velocity", &rate))) ||
        (dynamics && (!se3di_sdf_number(m, dynamics, "damping", &joint->damping) ||
                      !se3di_sdf_number(m, dynamics, "friction", &joint->friction) ||
                      !se3di_sdf_number(m, dynamics, "spring_stiffness", &joint->stiffness) ||
                      !se3di_sdf_number(m, dynamics, "spring_reference", &joint->rest)))) {
        return false;
    }
    joint->has_lower = !endless && joint->lower > -ENDLESS;
    joint->has_upper = !endless && joint->upper < ENDLESS;
    joint->comment = describe_drive(m, effort, rate);
    if (joint->friction < 0.0) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, joint->line,
                              "the friction %g of `%.80s` is negative", joint->friction,
                              joint->name);
    }
    return m->status >= 0;
}

/* The direction of an axis in the ground. */
static bool read_axis(se3di_sdf_model *s, const se3di_sdf_place *place, const se3di_xml *axis,
                      double out[3])
{
    se3di_machine *m = s->links->m;
    const se3di_xml *xyz = se3di_xml_child(axis, "xyz");
    const char *in = xyz ? se3di_xml_get(xyz, "expressed_in") : NULL;
    se3di_frame frame = place->frame;
    double own[3] = {0.0, 0.0, 1.0};
    double model[3];
    if (xyz && !se3di_xml_text_numbers(m, xyz, own, 3)) {
        return false;
    }
    /* before version 1.5 axes were in the model's frame */
    if (se3di_sdf_flag(axis, "use_parent_model_frame", s->is_old)) {
        frame = se3di_frame_identity();
    }
    if (in && *in && !se3di_sdf_find_frame(s, xyz, in, &frame)) {
        return false;
    }
    if (!(se3di_length(own) > 0.0)) {
        return se3di_machine_fail(m, axis->line, axis->column, "the axis of `%.80s` is zero",
                                  place->name);
    }
    se3di_turn(frame.A, own, model);
    se3di_turn(s->frame.A, model, out);
    return true;
}

static const char *name_of(se3di_sdf_model *s, const char *name)
{
    return *s->prefix ? se3di_machine_text(s->links->m, "%s_%s", s->prefix, name) : name;
}

/* The frame of a joint with z along an axis, NULL: its own axes; in the ground. */
static se3di_frame frame_of(const se3di_sdf_model *s, const se3di_sdf_place *place,
                            const double *axis)
{
    se3di_frame frame = se3di_frame_of(&s->frame, &place->frame);
    if (axis) {
        se3di_turn_along(axis, frame.A);
    }
    return frame;
}

static bool find_ends(se3di_sdf_model *s, const se3di_sdf_place *place, size_t ends[2])
{
    static const char *const keys[2] = {"parent", "child"};
    se3di_machine *m = s->links->m;
    for (int k = 0; k < 2; ++k) {
        const char *name = se3di_sdf_text(m, place->node, keys[k]);
        if (!name || !*name) {
            return m->status >= 0 &&
                   se3di_machine_fail(m, place->node->line, place->node->column,
                                      "the joint `%.80s` has no <%s>", place->name, keys[k]);
        }
        if (!se3di_sdf_find_link(s, place->node, name, &ends[k])) {
            return false;
        }
    }
    return true;
}

static se3di_link_joint *add(se3di_sdf_model *s, const se3di_sdf_place *place, const char *name,
                             size_t parent, size_t child)
{
    se3di_link_joint *joint =
        name ? se3di_links_join(s->links, name_of(s, name), place->node->line) : NULL;
    if (joint) {
        joint->parent = parent;
        joint->child = child;
    }
    return joint;
}

/* Read the two axes of a cross and what acts along them. @return whether it could be read */
static bool read_two(se3di_sdf_model *s, const se3di_sdf_place *place, double z[2][3],
                     se3di_link_joint halves[2])
{
    se3di_machine *m = s->links->m;
    static const char *const names[2] = {"axis", "axis2"};
    memset(halves, 0, 2 * sizeof *halves);
    for (int k = 0; k < 2; ++k) {
        const se3di_xml *axis = se3di_xml_child(place->node, names[k]);
        halves[k].name = place->name;
        halves[k].line = place->node->line;
        if (!axis) {
            return se3di_machine_fail(m, place->node->line, place->node->column,
                                      "the joint `%.80s` has no <%s>", place->name, names[k]);
        }
        if (!read_axis(s, place, axis, z[k]) || !read_dynamics(m, axis, false, &halves[k])) {
            return false;
        }
    }
    return true;
}

/* Whether nothing acts along an axis but the joint itself. */
static bool is_bare(const se3di_link_joint *half)
{
    return !half->has_lower && !half->has_upper && !(fabs(half->damping) > 0.0) &&
           !(half->friction > 0.0) && !(fabs(half->stiffness) > 0.0);
}

static bool add_universal(se3di_sdf_model *s, const se3di_sdf_place *place, const size_t ends[2],
                          double z[2][3])
{
    se3di_link_joint *joint = add(s, place, place->name, ends[0], ends[1]);
    if (joint) {
        joint->type = SE3DI_LINK_UNIVERSAL;
        joint->frame_i = frame_of(s, place, z[0]);
        joint->frame_j = frame_of(s, place, z[1]);
    }
    return joint != NULL;
}

/* One of the two joints of a cross, about its axis z. */
static bool add_half(se3di_sdf_model *s, const se3di_sdf_place *place, const char *name,
                     const size_t ends[2], const se3di_link_joint *half, const double z[3])
{
    se3di_link_joint *joint = add(s, place, name, ends[0], ends[1]);
    if (!joint) {
        return false;
    }
    const char *own = joint->name;
    *joint = *half;
    joint->name = own;
    joint->parent = ends[0];
    joint->child = ends[1];
    joint->type = SE3DI_LINK_REVOLUTE;
    joint->frame_i = joint->frame_j = frame_of(s, place, z);
    return true;
}

/* A cross: a universal joint, or two joints with a link between that says what acts along its axes,
 * or whose axes have another angle. */
static bool add_two(se3di_sdf_model *s, const se3di_sdf_place *place, const size_t ends[2])
{
    se3di_machine *m = s->links->m;
    se3di_link_joint halves[2];
    double z[2][3];
    if (!read_two(s, place, z, halves)) {
        return false;
    }
    if (is_bare(&halves[0]) && is_bare(&halves[1]) &&
        fabs(se3di_dot(z[0], z[1])) <= SQUARE * se3di_length(z[0]) * se3di_length(z[1])) {
        return add_universal(s, place, ends, z);
    }
    const char *own = name_of(s, place->name);
    const char *cross = own ? se3di_machine_text(m, "%s_cross", own) : NULL;
    const size_t middle = s->links->count;
    se3di_link *link = cross ? se3di_links_add(s->links, cross, place->node->line) : NULL;
    if (!link) {
        return false;
    }
    link->between = true;
    link->frame = frame_of(s, place, NULL);
    const char *second = se3di_machine_text(m, "%s_2", place->name);
    return add_half(s, place, place->name, (const size_t[2]){ends[0], middle}, &halves[0], z[0]) &&
           add_half(s, place, second, (const size_t[2]){middle, ends[1]}, &halves[1], z[1]);
}

/* Advance per turn, right-handed; the older element says radians per metre, left-handed. */
static bool read_pitch(se3di_machine *m, const se3di_xml *node, double *pitch)
{
    double thread = 1.0;
    *pitch = 0.0;
    if (!se3di_sdf_number(m, node, "screw_thread_pitch", pitch) ||
        !se3di_sdf_number(m, node, "thread_pitch", &thread)) {
        return false;
    }
    if (!se3di_xml_child(node, "screw_thread_pitch")) {
        *pitch = thread != 0.0 ? 0.0 - 2.0 * PI / thread : 0.0;
    }
    return (isfinite(*pitch) && fabs(*pitch) > 0.0) ||
           se3di_machine_fail(m, node->line, node->column, "the pitch of `%.80s` is %g",
                              se3di_xml_get(node, "name"), *pitch);
}

static bool add_one(se3di_sdf_model *s, const se3di_sdf_place *place, size_t type,
                    const size_t ends[2])
{
    se3di_machine *m = s->links->m;
    const joint_kind kind = types[type].kind;
    const se3di_xml *axis = se3di_xml_child(place->node, "axis");
    const bool endless = strcmp(types[type].name, "continuous") == 0;
    double z[3];
    se3di_link_joint *joint = add(s, place, place->name, ends[0], ends[1]);
    if (!joint) {
        return false;
    }
    joint->type = types[type].type;
    joint->frame_i = joint->frame_j = frame_of(s, place, NULL);
    if (kind == KIND_PLAIN) {
        return true;
    }
    if (!axis) {
        return se3di_machine_fail(m, place->node->line, place->node->column,
                                  "the joint `%.80s` has no <axis>", place->name);
    }
    if (!read_axis(s, place, axis, z) || !read_dynamics(m, axis, endless, joint) ||
        (kind == KIND_SCREW && !read_pitch(m, place->node, &joint->pitch))) {
        return false;
    }
    joint->frame_i = joint->frame_j = frame_of(s, place, z);
    return true;
}

static bool add_joint(se3di_sdf_model *s, const se3di_sdf_place *place)
{
    se3di_machine *m = s->links->m;
    const char *type = se3di_xml_need(m, place->node, "type");
    size_t ends[2] = {0, 0};
    size_t k = 0;
    if (!type || !find_ends(s, place, ends)) {
        return false;
    }
    if (strcmp(type, "gearbox") == 0) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, place->node->line,
                              "the gearbox `%.80s`: give a `gear` between two joints", place->name);
        return true;
    }
    while (k < sizeof types / sizeof *types && strcmp(types[k].name, type) != 0) {
        ++k;
    }
    if (k == sizeof types / sizeof *types) {
        return se3di_machine_fail(m, place->node->line, place->node->column,
                                  "type=\"%.40s\": must be revolute, revolute2, continuous, "
                                  "prismatic, screw, universal, ball, fixed or gearbox",
                                  type);
    }
    return types[k].kind == KIND_TWO ? add_two(s, place, ends) : add_one(s, place, k, ends);
}

bool se3di_sdf_joints(se3di_sdf_model *s)
{
    s->first_joint = s->links->joint_count;
    for (size_t k = 0; k < s->count; ++k) {
        if (s->places[k].kind == SE3DI_SDF_JOINT && !add_joint(s, &s->places[k])) {
            return false;
        }
    }
    return true;
}

static const se3di_link_joint *find_joint(const se3di_sdf_model *s, const char *name)
{
    for (size_t k = s->first_joint; name && k < s->links->joint_count; ++k) {
        if (strcmp(s->links->joints[k].name, name) == 0) {
            return &s->links->joints[k];
        }
    }
    return NULL;
}

bool se3di_sdf_mimics(se3di_sdf_model *s)
{
    se3di_machine *m = s->links->m;
    for (size_t k = 0; k < s->count; ++k) {
        const se3di_sdf_place *place = &s->places[k];
        const se3di_xml *axis = se3di_xml_child(place->node, "axis");
        const se3di_xml *mimic =
            place->kind == SE3DI_SDF_JOINT ? se3di_xml_child(axis, "mimic") : NULL;
        se3di_urdf_mimic follows = {.joint = 0, .ratio = 1.0};
        double reference = 0.0;
        if (!mimic) {
            continue;
        }
        const char *leader = se3di_xml_need(m, mimic, "joint");
        if (!leader || !se3di_sdf_number(m, mimic, "multiplier", &follows.ratio) ||
            !se3di_sdf_number(m, mimic, "offset", &follows.offset) ||
            !se3di_sdf_number(m, mimic, "reference", &reference)) {
            return false;
        }
        const se3di_link_joint *joint = find_joint(s, name_of(s, place->name));
        const se3di_link_joint *other = find_joint(s, name_of(s, leader));
        if (m->status < 0) {
            return false;
        }
        if (!joint || !other) {
            return se3di_machine_fail(m, mimic->line, mimic->column, "there is no joint `%.80s`",
                                      leader);
        }
        follows.offset -= follows.ratio * reference;
        if (!se3di_urdf_couple(m, joint, other, &follows)) {
            return false;
        }
    }
    return true;
}
