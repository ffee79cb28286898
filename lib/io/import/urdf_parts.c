/* SPDX-License-Identifier: BSD-3-Clause */
/* URDF: shapes, limits, damping, mimics. */
#include <math.h>
#include <string.h>

#include "io/import/mesh.h"
#include "io/import/urdf.h"

bool se3di_urdf_origin(se3di_machine *m, const se3di_xml *node, se3di_frame *frame)
{
    double rpy[3] = {0.0, 0.0, 0.0};
    double p[4] = {1.0, 0.0, 0.0, 0.0};
    const se3di_xml *origin = se3di_xml_child(node, "origin");
    *frame = se3di_frame_identity();
    if (!origin) {
        return true;
    }
    if (!se3di_xml_numbers(m, origin, "xyz", frame->r, 3) ||
        !se3di_xml_numbers(m, origin, "rpy", rpy, 3) ||
        !se3di_xml_numbers(m, origin, "quat_xyzw", p, 4)) {
        return false;
    }
    se3di_turn_from_rpy(rpy, frame->A);
    if (se3di_xml_get(origin, "quat_xyzw")) {
        const double scalar_first[4] = {p[3], p[0], p[1], p[2]};
        if (!se3di_turn_from_parameters(scalar_first, frame->A)) {
            return se3di_machine_fail(m, origin->line, origin->column, "quat_xyzw has no length");
        }
    }
    return true;
}

static bool read_color(se3di_machine *m, const se3di_xml *root, const se3di_xml *material,
                       double color[3])
{
    double rgba[4] = {-1.0, 0.0, 0.0, 1.0};
    const se3di_xml *own = se3di_xml_child(material, "color");
    const char *name = material ? se3di_xml_get(material, "name") : NULL;
    const se3di_xml *at = se3di_xml_child(root, "material");
    while (!own && name && at) {
        const char *other = se3di_xml_get(at, "name");
        own = other && strcmp(other, name) == 0 ? se3di_xml_child(at, "color") : NULL;
        at = se3di_xml_again(at);
    }
    if (own && !se3di_xml_numbers(m, own, "rgba", rgba, 4)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        color[k] = rgba[0] < 0.0 ? -1.0 : fmin(fmax(rgba[k], 0.0), 1.0);
    }
    return true;
}

/* A size must be > 0: what is not is noted and left out. */
static bool check_size(se3di_machine *m, const se3di_xml *node, const double *size, int count,
                       bool *good)
{
    *good = true;
    for (int k = 0; k < count; ++k) {
        *good = *good && size[k] > 0.0;
    }
    if (!*good) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line,
                              "the <%.40s> has a size that is not > 0", node->name);
    }
    return true;
}

static bool read_shape(se3di_machine *m, const se3di_xml *node, se3di_machine_shape *shape,
                       bool *good)
{
    double scale[3] = {1.0, 1.0, 1.0};
    double round[2] = {0.0, 1.0}; /* radius, length */
    *good = false;
    if (se3di_xml_is(node, "box")) {
        shape->type = "box";
        return se3di_xml_numbers(m, node, "size", shape->size, 3) &&
               check_size(m, node, shape->size, 3, good);
    }
    if (se3di_xml_is(node, "sphere") || se3di_xml_is(node, "cylinder") ||
        se3di_xml_is(node, "capsule")) {
        const bool is_sphere = se3di_xml_is(node, "sphere");
        shape->type = is_sphere ? "sphere" : node->name;
        if (!se3di_xml_numbers(m, node, "radius", &round[0], 1) ||
            (!is_sphere && !se3di_xml_numbers(m, node, "length", &round[1], 1))) {
            return false;
        }
        shape->radius = round[0];
        shape->length = is_sphere ? 0.0 : round[1];
        return check_size(m, node, round, 2, good);
    }
    if (se3di_xml_is(node, "mesh")) {
        const char *file = se3di_xml_need(m, node, "filename");
        if (!file || !se3di_xml_numbers(m, node, "scale", scale, 3)) {
            return false;
        }
        const char *folder = se3di_path_folder(m, m->file);
        *good = folder && se3di_mesh_take(m, node->line, folder, file, scale, shape);
        return m->status >= 0;
    }
    se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line, "the geometry <%.60s>", node->name);
    return true;
}

bool se3di_urdf_shapes(se3di_links *links, size_t link, const se3di_xml *root,
                       const se3di_xml *node)
{
    se3di_machine *m = links->m;
    const char *which = se3di_xml_child(node, "visual") ? "visual" : "collision";
    for (const se3di_xml *at = se3di_xml_child(node, which); at; at = se3di_xml_again(at)) {
        const se3di_xml *geometry = se3di_xml_child(at, "geometry");
        se3di_machine_shape read = {.scale = 1.0, .color = {-1.0, 0.0, 0.0}};
        if (!se3di_urdf_origin(m, at, &read.frame) ||
            !read_color(m, root, se3di_xml_child(at, "material"), read.color) ||
            !se3di_links_read_shape(links, link, geometry, read_shape, &read)) {
            return false;
        }
    }
    return true;
}

/* The bounds of a drive that are given; NULL: none, or no memory. */
static const char *describe_drive(se3di_machine *m, double effort, double rate, bool slides)
{
    const char *force = slides ? "N" : "N m";
    const char *speed = slides ? "m/s" : "rad/s";
    return effort > 0.0 && rate > 0.0
               ? se3di_machine_text(m, "drive: at most %g %s, %g %s", effort, force, rate, speed)
           : effort > 0.0 ? se3di_machine_text(m, "drive: at most %g %s", effort, force)
           : rate > 0.0   ? se3di_machine_text(m, "drive: at most %g %s", rate, speed)
                          : NULL;
}

static bool read_limits(se3di_machine *m, const se3di_xml *node, se3di_link_joint *joint)
{
    double effort = 0.0;
    double rate = 0.0;
    const char *type = se3di_xml_get(node, "type");
    const se3di_xml *limit = se3di_xml_child(node, "limit");
    if (!limit) {
        return true;
    }
    if (!se3di_xml_numbers(m, limit, "lower", &joint->lower, 1) ||
        !se3di_xml_numbers(m, limit, "upper", &joint->upper, 1) ||
        !se3di_xml_numbers(m, limit, "effort", &effort, 1) ||
        !se3di_xml_numbers(m, limit, "velocity", &rate, 1)) {
        return false;
    }
    const bool ends = se3di_xml_get(limit, "lower") || se3di_xml_get(limit, "upper");
    const bool slides = joint->type == SE3DI_LINK_PRISMATIC;
    joint->has_lower = joint->has_upper =
        ends && (slides || (joint->type == SE3DI_LINK_REVOLUTE && strcmp(type, "revolute") == 0));
    joint->comment = describe_drive(m, effort, rate, slides);
    if (joint->has_lower && (joint->lower > 0.0 || joint->upper < 0.0)) {
        se3di_machine_note_of(m, SE3D_IMPORT_NOTE, joint->line,
                              "zero is outside the range of `%.80s`: its stop pushes from the "
                              "start",
                              joint->name);
    }
    return true;
}

bool se3di_urdf_dynamics(se3di_machine *m, const se3di_xml *node, se3di_link_joint *joint)
{
    const se3di_xml *dynamics = se3di_xml_child(node, "dynamics");
    if (dynamics && (!se3di_xml_numbers(m, dynamics, "damping", &joint->damping, 1) ||
                     !se3di_xml_numbers(m, dynamics, "friction", &joint->friction, 1))) {
        return false;
    }
    if (joint->type == SE3DI_LINK_FIXED || joint->type == SE3DI_LINK_FREE) {
        joint->damping = joint->friction = 0.0;
        return true;
    }
    if (joint->friction < 0.0) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, joint->line,
                              "the friction %g of `%.80s` is negative", joint->friction,
                              joint->name);
    }
    return read_limits(m, node, joint);
}

/* A joint that follows another by the factor 0 stays where it is. */
static bool hold(se3di_machine *m, const char *name, const se3di_link_joint *joint, double value)
{
    se3di_entry *entry = se3di_machine_add(m, SE3DI_SECTION_DRIVERS);
    se3di_entry_put_text(m, entry, "name", name);
    se3di_entry_put_text(m, entry, "joint", joint->made);
    se3di_entry_put_number(m, entry, "value", value);
    return m->status >= 0;
}

bool se3di_urdf_couple(se3di_machine *m, const se3di_link_joint *joint,
                       const se3di_link_joint *other, const se3di_urdf_mimic *mimic)
{
    const bool has = joint->made && other->made &&
                     (joint->type == SE3DI_LINK_REVOLUTE || joint->type == SE3DI_LINK_PRISMATIC) &&
                     (other->type == SE3DI_LINK_REVOLUTE || other->type == SE3DI_LINK_PRISMATIC);
    if (!has) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, joint->line,
                              "the mimic of `%.80s`: both joints must turn or slide", joint->name);
        return true;
    }
    const char *name =
        se3di_machine_name(m, se3di_machine_extend(m, joint->made, "_mimic"), "joint", joint->line);
    if (name && !(fabs(mimic->ratio) > 0.0)) {
        return hold(m, name, joint, mimic->offset);
    }
    se3di_entry *entry = name ? se3di_machine_add(m, SE3DI_SECTION_JOINTS) : NULL;
    const char *a = se3di_machine_quote(m, joint->made);
    const char *b = se3di_machine_quote(m, other->made);
    const char *ratio = se3di_machine_number(m, -mimic->ratio);
    if (!entry || !a || !b || !ratio) {
        return false;
    }
    se3di_entry_put_text(m, entry, "name", name);
    se3di_entry_put(m, entry, "type", "coupler");
    se3di_entry_put(m, entry, "terms",
                    se3di_machine_text(m, "[{joint: %s}, {joint: %s, ratio: %s}]", a, b, ratio));
    if (mimic->offset != 0.0) {
        se3di_entry_put_number(m, entry, "value", mimic->offset);
    }
    return m->status >= 0;
}

/* What Gazebo's own elements say of contact, each with its line. */
static void note_gazebo(se3di_machine *m, const se3di_xml *gazebo)
{
    static const char *const words[] = {"mu1", "mu2",         "mu",          "kp",
                                        "kd",  "selfCollide", "self_collide"};
    const char *link = se3di_xml_get(gazebo, "reference");
    for (const se3di_xml *at = gazebo->first; at; at = at->next) {
        for (size_t k = 0; k < sizeof words / sizeof *words; ++k) {
            if (strcmp(at->name, words[k]) == 0) {
                se3di_machine_note_of(m, SE3D_IMPORT_NOTE, at->line,
                                      "<gazebo> gives `%.80s` %s = %.40s: shapes touch only if "
                                      "they get a `material` and the model `contact`",
                                      link ? link : "all", words[k], at->text);
            }
        }
    }
}

bool se3di_urdf_others(se3di_machine *m, const se3di_xml *root)
{
    static const char *const known[] = {"link", "joint", "material"};
    for (const se3di_xml *node = root->first; node; node = node->next) {
        bool is_known = false;
        bool is_first = true;
        if (strncmp(node->name, "xacro:", 6) == 0) {
            return se3di_machine_fail(m, node->line, node->column,
                                      "<%.60s> is a macro: expand the file with `xacro FILE`",
                                      node->name);
        }
        for (size_t k = 0; k < 3; ++k) {
            is_known = is_known || strcmp(known[k], node->name) == 0;
        }
        for (const se3di_xml *at = root->first; at != node; at = at->next) {
            is_first = is_first && strcmp(at->name, node->name) != 0;
            if (!is_first) {
                break;
            }
        }
        if (strcmp(node->name, "gazebo") == 0) {
            note_gazebo(m, node);
        }
        if (!is_known && is_first) {
            se3di_machine_note_of(m, SE3D_IMPORT_NOTE, node->line,
                                  "<%.60s> is no part of the mechanism and left out", node->name);
        }
    }
    return true;
}
