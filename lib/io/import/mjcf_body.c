/* SPDX-License-Identifier: BSD-3-Clause */
/* MJCF: bodies and their joints. A body with several joints is a chain of links without mass but
 * the last. */
#include <string.h>

#include "io/import/mjcf.h"

/* What stands around an element: the link, the frame in it, and the class of the body. */
typedef struct place {
    size_t link;
    se3di_frame frame;
    const char *class_name;
} place;

bool se3di_mjcf_name(se3di_mjcf *f, se3di_ionames *names, const char *name, size_t index)
{
    size_t other;
    if (!name || !name[0] || se3di_ionames_find(names, name, &other)) {
        return true;
    }
    return se3di_ionames_add(names, f->links.m->pool, name, index) ||
           se3di_machine_fail_memory(f->links.m);
}

bool se3di_mjcf_find(se3di_mjcf *f, const se3di_xml *node, const char *attribute,
                     const se3di_ionames *names, size_t *index, bool *found)
{
    const char *name = se3di_xml_get(node, attribute);
    *found = name != NULL;
    if (name && !se3di_ionames_find(names, name, index)) {
        return se3di_machine_fail(f->links.m, node->line, node->column,
                                  "<%.40s %s>: there is no `%.80s`", node->name, attribute, name);
    }
    return true;
}

static bool read_inertial(se3di_mjcf *f, const se3di_xml *node, se3di_mass *mass)
{
    const se3di_mjcf_element e = {.node = node};
    se3di_machine *m = f->links.m;
    se3di_mass read = {.mass = 0.0};
    se3di_frame frame;
    double J[6];
    int count = 0;
    if (!se3di_mjcf_frame(f, &e, &frame) || !se3di_xml_need(m, node, "mass") ||
        !se3di_xml_numbers(m, node, "mass", &read.mass, 1) ||
        !se3di_mjcf_numbers(f, &e, "fullinertia", J, 6, &count)) {
        return false;
    }
    if (count == 6) { /* xx yy zz xy xz yz */
        const double full[9] = {J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2]};
        memcpy(read.J, full, sizeof full);
    } else if (!se3di_mjcf_numbers(f, &e, "diaginertia", J, 6, &count)) {
        return false;
    } else if (count == 3) {
        read.J[0] = J[0];
        read.J[4] = J[1];
        read.J[8] = J[2];
    }
    if (count != 3 && count != 6) {
        return se3di_machine_fail(m, node->line, node->column,
                                  "<inertial> needs `diaginertia`, 3 numbers, or `fullinertia`, 6");
    }
    *mass = se3di_mass_of(&frame, &read);
    return true;
}

static bool read_limits(se3di_mjcf *f, const se3di_mjcf_element *e, double unit,
                        se3di_link_joint *joint)
{
    double range[2] = {0.0, 0.0};
    int count;
    if (!se3di_mjcf_numbers(f, e, "range", range, 2, &count)) {
        return false;
    }
    const bool own = se3di_mjcf_is(f, e, "limited", "true");
    const bool no = se3di_mjcf_is(f, e, "limited", "false");
    if (!f->disabled.limits && (own || (!no && f->autolimits && count == 2))) {
        joint->has_lower = joint->has_upper = true;
        joint->lower = unit * range[0];
        joint->upper = unit * range[1];
    }
    return true;
}

/* What acts along a joint. */
static bool read_acting(se3di_mjcf *f, const se3di_mjcf_element *e, double unit, double ref,
                        se3di_link_joint *joint)
{
    double rest = ref / unit;
    if (!read_limits(f, e, unit, joint) || !se3di_mjcf_number(f, e, "damping", &joint->damping) ||
        !se3di_mjcf_number(f, e, "frictionloss", &joint->friction) ||
        !se3di_mjcf_number(f, e, "stiffness", &joint->stiffness) ||
        !se3di_mjcf_number(f, e, "armature", &joint->armature) ||
        !se3di_mjcf_number(f, e, "springref", &rest)) {
        return false;
    }
    joint->rest = unit * rest;
    joint->damping = f->disabled.dampers ? 0.0 : joint->damping;
    joint->stiffness = f->disabled.springs ? 0.0 : joint->stiffness;
    joint->friction = f->disabled.friction ? 0.0 : joint->friction;
    return true;
}

static bool read_type(se3di_mjcf *f, const se3di_mjcf_element *e, se3di_link_joint *joint)
{
    static const struct {
        const char *name;
        se3di_link_joint_type type;
    } types[] = {{"hinge", SE3DI_LINK_REVOLUTE},
                 {"slide", SE3DI_LINK_PRISMATIC},
                 {"ball", SE3DI_LINK_SPHERICAL},
                 {"free", SE3DI_LINK_FREE}};
    const char *type = se3di_mjcf_get(f, e, "type");
    type = se3di_xml_is(e->node, "freejoint") ? "free" : type ? type : "hinge";
    for (size_t k = 0; k < sizeof types / sizeof *types; ++k) {
        if (strcmp(type, types[k].name) == 0) {
            joint->type = types[k].type;
            return true;
        }
    }
    return se3di_machine_fail(f->links.m, e->node->line, e->node->column,
                              "type=\"%.40s\": must be hinge, slide, ball or free", type);
}

/* A joint of the link, whose frame is in the link's; at the start it is at its `ref`. */
static bool read_joint(se3di_mjcf *f, const se3di_mjcf_element *e, const place *at, size_t parent)
{
    se3di_machine *m = f->links.m;
    const se3di_link *link = &f->links.list[at->link];
    const char *name = se3di_xml_get(e->node, "name");
    const size_t index = f->links.joint_count;
    const char *made = name ? name : se3di_machine_text(m, "%s_joint", link->name);
    se3di_link_joint *joint = made ? se3di_links_join(&f->links, made, e->node->line) : NULL;
    double axis[3] = {0.0, 0.0, 1.0};
    double ref = 0.0;
    int count;
    se3di_frame own = se3di_frame_identity();
    if (!joint || !se3di_mjcf_name(f, &f->joint_names, name, index) || !read_type(f, e, joint)) {
        return false;
    }
    joint->parent = parent;
    joint->child = at->link;
    if (joint->type == SE3DI_LINK_FREE) {
        return true;
    }
    if (!se3di_mjcf_numbers(f, e, "pos", own.r, 3, &count) ||
        !se3di_mjcf_numbers(f, e, "axis", axis, 3, &count) ||
        !se3di_mjcf_number(f, e, "ref", &ref)) {
        return false;
    }
    const double unit = joint->type == SE3DI_LINK_REVOLUTE ? f->angle : 1.0;
    if (joint->type != SE3DI_LINK_SPHERICAL && !se3di_turn_along(axis, own.A)) {
        return se3di_machine_fail(m, e->node->line, e->node->column, "the axis is zero");
    }
    own = se3di_frame_of(&at->frame, &own);
    joint->frame_i = joint->frame_j = se3di_frame_of(&link->frame, &own);
    joint->angle0 = joint->type == SE3DI_LINK_REVOLUTE ? unit * ref : 0.0;
    for (int k = 0; joint->type == SE3DI_LINK_PRISMATIC && k < 3; ++k) {
        joint->frame_i.r[k] -= ref * joint->frame_j.A[3 * k + 2];
    }
    return read_acting(f, e, unit, unit * ref, joint);
}

static bool is_joint(const se3di_xml *node)
{
    return se3di_xml_is(node, "joint") || se3di_xml_is(node, "freejoint");
}

static size_t count_joints(const se3di_xml *node)
{
    size_t count = 0;
    for (const se3di_xml *at = node->first; at; at = at->next) {
        count += is_joint(at) ? 1 : 0;
        count += se3di_xml_is(at, "frame") ? count_joints(at) : 0;
    }
    return count;
}

static bool inner(se3di_mjcf *f, const se3di_xml *node, const place *around, place *at)
{
    const se3di_mjcf_element e = {.node = node};
    const char *name = se3di_xml_get(node, "childclass");
    *at = *around;
    se3di_frame frame;
    if (!se3di_mjcf_frame(f, &e, &frame)) {
        return false;
    }
    at->frame = se3di_frame_of(&around->frame, &frame);
    at->class_name = name ? name : around->class_name;
    return true;
}

/* The joints of a body, the first next to the parent: `*made` links of the chain are there. */
static bool read_joints(se3di_mjcf *f, const se3di_xml *node, const place *around, size_t *parent,
                        size_t *left)
{
    for (const se3di_xml *child = node->first; child; child = child->next) {
        place at = *around;
        if (se3di_xml_is(child, "frame")) {
            if (!inner(f, child, around, &at) || !read_joints(f, child, &at, parent, left)) {
                return false;
            }
        }
        if (!is_joint(child)) {
            continue;
        }
        const se3di_mjcf_element e = {.node = child, .class_name = around->class_name};
        if (--*left > 0) { /* a link between this joint and the next */
            const se3di_frame frame = f->links.list[around->link].frame;
            const char *name =
                se3di_machine_text(f->links.m, "%s_%zu", f->links.list[around->link].name, *left);
            at.link = f->links.count;
            se3di_link *link = name ? se3di_links_add(&f->links, name, child->line) : NULL;
            if (!link) {
                return false;
            }
            link->frame = frame;
            link->between = true;
            link->comment = "between two joints of one body";
        }
        if (!read_joint(f, &e, &at, *parent)) {
            return false;
        }
        *parent = at.link;
    }
    return true;
}

static bool hold(se3di_mjcf *f, size_t parent, size_t link, size_t line)
{
    const char *name = se3di_machine_text(f->links.m, "%s_fixed", f->links.list[link].name);
    se3di_link_joint *joint = name ? se3di_links_join(&f->links, name, line) : NULL;
    if (!joint) {
        return false;
    }
    joint->type = SE3DI_LINK_FIXED;
    joint->parent = parent;
    joint->child = link;
    joint->frame_i = joint->frame_j = f->links.list[link].frame;
    return true;
}

static bool add_site(se3di_mjcf *f, const se3di_mjcf_element *e, const place *at)
{
    const char *name = se3di_xml_get(e->node, "name");
    se3di_frame frame;
    if (!name) {
        return true;
    }
    se3di_mjcf_place *grown =
        se3di_iopool_grow(f->links.m->pool, f->sites, f->site_count, &f->site_room, sizeof *grown);
    if (!grown) {
        return se3di_machine_fail_memory(f->links.m);
    }
    f->sites = grown;
    if (!se3di_mjcf_frame(f, e, &frame) ||
        !se3di_mjcf_name(f, &f->site_names, name, f->site_count)) {
        return false;
    }
    frame = se3di_frame_of(&at->frame, &frame);
    f->sites[f->site_count++] = (se3di_mjcf_place){.name = name, .link = at->link, .frame = frame};
    return se3di_parts_add_marker(f->links.m, &f->links.list[at->link].parts, name, &frame) != NULL;
}

static bool read_body(se3di_mjcf *f, const se3di_xml *node, const place *around);

/* All in a body but its joints and its mass. */
static bool read_parts(se3di_mjcf *f, const se3di_xml *node, const place *around, bool weighs)
{
    static const char *const lost[] = {"replicate", "composite", "flexcomp", "attach", "plugin"};
    for (const se3di_xml *child = node->first; child; child = child->next) {
        const se3di_mjcf_element e = {.node = child, .class_name = around->class_name};
        place at;
        bool good = true;
        if (se3di_xml_is(child, "body")) {
            good = read_body(f, child, around);
        } else if (se3di_xml_is(child, "frame")) {
            good = inner(f, child, around, &at) && read_parts(f, child, &at, weighs);
        } else if (se3di_xml_is(child, "geom")) {
            good = se3di_mjcf_geom(f, around->link, &e, &around->frame, weighs);
        } else if (se3di_xml_is(child, "site")) {
            good = add_site(f, &e, around);
        }
        for (size_t k = 0; k < sizeof lost / sizeof *lost; ++k) {
            if (se3di_xml_is(child, lost[k])) {
                se3di_machine_note_of(f->links.m, SE3D_IMPORT_LOST, child->line, "<%s>", lost[k]);
            }
        }
        if (!good) {
            return false;
        }
    }
    return f->links.m->status >= 0;
}

static bool read_body(se3di_mjcf *f, const se3di_xml *node, const place *around)
{
    se3di_machine *m = f->links.m;
    const char *name = se3di_xml_get(node, "name");
    const se3di_xml *inertial = se3di_xml_child(node, "inertial");
    size_t parent = around->link;
    size_t left = count_joints(node);
    place at;
    if (!inner(f, node, around, &at)) {
        return false;
    }
    const se3di_frame frame = se3di_frame_of(&f->links.list[around->link].frame, &at.frame);
    const char *made = name ? name : se3di_machine_text(m, "body%zu", f->links.count);
    at.link = f->links.count;
    at.frame = se3di_frame_identity();
    se3di_link *link = made ? se3di_links_add(&f->links, made, node->line) : NULL;
    if (!link || !se3di_mjcf_name(f, &f->body_names, name, at.link)) {
        return false;
    }
    link->frame = frame;
    const bool own = inertial && !f->inertia_from_geoms;
    if (own && !read_inertial(f, inertial, &link->mass)) {
        return false;
    }
    if (se3di_xml_get(node, "gravcomp")) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line, "gravcomp of `%.80s`", made);
    }
    if (left == 0 ? !hold(f, parent, at.link, node->line)
                  : !read_joints(f, node, &at, &parent, &left)) {
        return false;
    }
    return read_parts(f, node, &at, !own);
}

bool se3di_mjcf_bodies(se3di_mjcf *f, const se3di_xml *world)
{
    const place at = {.link = 0,
                      .frame = se3di_frame_identity(),
                      .class_name = se3di_xml_get(world, "childclass")};
    return read_parts(f, world, &at, false);
}
