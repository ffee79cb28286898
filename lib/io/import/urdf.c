/* SPDX-License-Identifier: BSD-3-Clause */
/* URDF, the Unified Robot Description Format (wiki.ros.org/urdf/XML): links with frames of their
 * own, joined to a tree. The pose is that of all joints at zero, mimics at their offsets. */
#include <math.h>
#include <string.h>

#include "io/import/formats.h"
#include "io/import/links.h"
#include "io/import/urdf.h"

/* Links and joints, and what is known of each joint before the links are placed. */
typedef struct tree {
    se3di_links links;
    se3di_ionames link_names, joint_names;
    const se3di_xml **joint_nodes; /* of each joint */
    se3di_frame *origins;          /* of each joint, in its parent link */
    double (*axes)[3];             /* of each joint, in its frame */
    size_t *to_parent;             /* of each link: its joint, SE3DI_GROUND: none */
    size_t room;                   /* of joints */
} tree;

static bool read_inertial(se3di_machine *m, const se3di_xml *link, se3di_mass *mass)
{
    static const char *const keys[6] = {"ixx", "iyy", "izz", "ixy", "iyz", "ixz"};
    static const int place[6] = {0, 4, 8, 1, 5, 2};
    const se3di_xml *inertial = se3di_xml_child(link, "inertial");
    const se3di_xml *inertia = se3di_xml_child(inertial, "inertia");
    const se3di_xml *weight = se3di_xml_child(inertial, "mass");
    se3di_mass own = {.mass = 0.0};
    se3di_frame frame;
    if (!inertial) {
        return true;
    }
    if (!se3di_urdf_origin(m, inertial, &frame) ||
        (weight && !se3di_xml_numbers(m, weight, "value", &own.mass, 1))) {
        return false;
    }
    if (own.mass < 0.0) {
        return se3di_machine_fail(m, weight->line, weight->column,
                                  "the mass of `%.80s` is %g kg, must not be negative",
                                  se3di_xml_get(link, "name"), own.mass);
    }
    for (int k = 0; inertia && k < 6; ++k) {
        double value = 0.0;
        if (!se3di_xml_numbers(m, inertia, keys[k], &value, 1)) {
            return false;
        }
        own.J[place[k]] = value;
        own.J[3 * (place[k] % 3) + place[k] / 3] = value;
    }
    *mass = se3di_mass_of(&frame, &own);
    return true;
}

static bool read_link(tree *t, const se3di_xml *root, const se3di_xml *node)
{
    se3di_machine *m = t->links.m;
    const char *name = se3di_xml_need(m, node, "name");
    size_t index;
    if (!name) {
        return false;
    }
    if (se3di_ionames_find(&t->link_names, name, &index)) {
        return se3di_machine_fail(m, node->line, node->column, "there are two links `%.80s`", name);
    }
    index = t->links.count;
    se3di_link *link = se3di_links_add(&t->links, name, node->line);
    if (!link || !se3di_ionames_add(&t->link_names, m->pool, name, index)) {
        return se3di_machine_fail_memory(m);
    }
    return read_inertial(m, node, &link->mass) && se3di_urdf_shapes(&t->links, index, root, node);
}

static bool find_link(tree *t, const se3di_xml *joint, const char *which, size_t *index)
{
    se3di_machine *m = t->links.m;
    const se3di_xml *node = se3di_xml_child(joint, which);
    if (!node) {
        return se3di_machine_fail(m, joint->line, joint->column, "the joint has no <%s>", which);
    }
    const char *name = se3di_xml_need(m, node, "link");
    if (!name) {
        return false;
    }
    if (!se3di_ionames_find(&t->link_names, name, index)) {
        return se3di_machine_fail(m, node->line, node->column, "there is no link `%.80s`", name);
    }
    return true;
}

static bool read_type(se3di_machine *m, const se3di_xml *node, se3di_link_joint *joint)
{
    static const struct {
        const char *name;
        se3di_link_joint_type type;
    } types[] = {{"revolute", SE3DI_LINK_REVOLUTE},   {"continuous", SE3DI_LINK_REVOLUTE},
                 {"prismatic", SE3DI_LINK_PRISMATIC}, {"fixed", SE3DI_LINK_FIXED},
                 {"floating", SE3DI_LINK_FREE},       {"planar", SE3DI_LINK_PLANAR},
                 {"spherical", SE3DI_LINK_SPHERICAL}};
    const char *type = se3di_xml_need(m, node, "type");
    for (size_t k = 0; type && k < sizeof types / sizeof *types; ++k) {
        if (strcmp(types[k].name, type) == 0) {
            joint->type = types[k].type;
            return true;
        }
    }
    if (!type) {
        return false;
    }
    return se3di_machine_fail(m, node->line, node->column,
                              "type=\"%.40s\": must be revolute, continuous, prismatic, fixed, "
                              "floating or planar",
                              type);
}

static bool read_joint(tree *t, const se3di_xml *node)
{
    se3di_machine *m = t->links.m;
    const char *name = se3di_xml_need(m, node, "name");
    const size_t index = t->links.joint_count;
    const se3di_xml *axis = se3di_xml_child(node, "axis");
    size_t other;
    if (!name) {
        return false;
    }
    if (se3di_ionames_find(&t->joint_names, name, &other)) {
        return se3di_machine_fail(m, node->line, node->column, "there are two joints `%.80s`",
                                  name);
    }
    se3di_link_joint *joint = se3di_links_join(&t->links, name, node->line);
    if (!joint || !se3di_ionames_add(&t->joint_names, m->pool, name, index)) {
        return se3di_machine_fail_memory(m);
    }
    t->joint_nodes[index] = node;
    t->axes[index][0] = 1.0;
    if (!read_type(m, node, joint) || !find_link(t, node, "parent", &joint->parent) ||
        !find_link(t, node, "child", &joint->child) ||
        !se3di_urdf_origin(m, node, &t->origins[index]) ||
        (axis && !se3di_xml_numbers(m, axis, "xyz", t->axes[index], 3))) {
        return false;
    }
    if (joint->type == SE3DI_LINK_FIXED || joint->type == SE3DI_LINK_FREE ||
        joint->type == SE3DI_LINK_SPHERICAL) {
        t->axes[index][0] = 1.0; /* it has none, whatever the file says */
        t->axes[index][1] = t->axes[index][2] = 0.0;
    }
    if (!(se3di_length(t->axes[index]) > 0.0)) {
        return se3di_machine_fail(m, axis->line, axis->column, "the axis of `%.80s` is zero", name);
    }
    if (t->to_parent[joint->child] != SE3DI_GROUND) {
        return se3di_machine_fail(m, node->line, node->column,
                                  "the link `%.80s` is the child of two joints",
                                  t->links.list[joint->child].name);
    }
    t->to_parent[joint->child] = index;
    return se3di_urdf_dynamics(m, node, joint);
}

/* The joint that `index` follows, and how far it is displaced with all others at zero. */
static bool read_mimic(tree *t, size_t index, se3di_urdf_mimic *mimic)
{
    se3di_machine *m = t->links.m;
    const se3di_xml *node = se3di_xml_child(t->joint_nodes[index], "mimic");
    *mimic = (se3di_urdf_mimic){.joint = SE3DI_GROUND, .ratio = 1.0};
    if (!node) {
        return true;
    }
    const char *name = se3di_xml_need(m, node, "joint");
    if (!name || !se3di_xml_numbers(m, node, "multiplier", &mimic->ratio, 1) ||
        !se3di_xml_numbers(m, node, "offset", &mimic->offset, 1)) {
        return false;
    }
    if (!se3di_ionames_find(&t->joint_names, name, &mimic->joint)) {
        return se3di_machine_fail(m, node->line, node->column, "there is no joint `%.80s`", name);
    }
    return true;
}

static bool find_start(tree *t, size_t index, double *start)
{
    se3di_machine *m = t->links.m;
    double factor = 1.0;
    size_t at = index;
    *start = 0.0;
    for (size_t k = 0; k <= t->links.joint_count; ++k) {
        se3di_urdf_mimic mimic;
        if (!read_mimic(t, at, &mimic)) {
            return false;
        }
        if (mimic.joint == SE3DI_GROUND) {
            return true;
        }
        *start += factor * mimic.offset;
        factor *= mimic.ratio;
        at = mimic.joint;
    }
    return se3di_machine_fail(m, t->joint_nodes[index]->line, t->joint_nodes[index]->column,
                              "the joint `%.80s` mimics itself", t->links.joints[index].name);
}

/* The frames of a joint and of its child, from that of its parent. */
static bool place(tree *t, size_t index)
{
    se3di_link_joint *joint = &t->links.joints[index];
    const se3di_frame at = se3di_frame_of(&t->links.list[joint->parent].frame, &t->origins[index]);
    const double *axis = t->axes[index];
    se3di_frame motion = se3di_frame_identity();
    se3di_frame along = se3di_frame_identity();
    double q = 0.0;
    if (!find_start(t, index, &q)) {
        return false;
    }
    if (joint->type == SE3DI_LINK_REVOLUTE && q != 0.0) {
        se3di_turn_about(axis, q, motion.A);
    }
    for (int k = 0; joint->type == SE3DI_LINK_PRISMATIC && k < 3; ++k) {
        motion.r[k] = q * axis[k] / se3di_length(axis);
    }
    se3di_turn_along(axis, along.A);
    t->links.list[joint->child].frame = se3di_frame_of(&at, &motion);
    joint->frame_i = se3di_frame_of(&at, &along);
    joint->frame_j = se3di_frame_of(&t->links.list[joint->child].frame, &along);
    return true;
}

/* From the root outwards: a link is placed when the one before it is. */
static bool place_all(tree *t)
{
    se3di_machine *m = t->links.m;
    const size_t count = t->links.count;
    size_t *stack = se3di_iopool_array(m->pool, count + 1, sizeof *stack);
    bool *placed = se3di_iopool_array(m->pool, count + 1, sizeof *placed);
    if (!stack || !placed) {
        return se3di_machine_fail_memory(m);
    }
    for (size_t k = 0; k < count; ++k) {
        size_t depth = 0;
        size_t at = k;
        while (!placed[at] && t->to_parent[at] != SE3DI_GROUND && depth <= count) {
            stack[depth++ < count ? depth - 1 : count] = at;
            at = t->links.joints[t->to_parent[at]].parent;
        }
        if (depth > count) {
            const se3di_xml *node = t->joint_nodes[t->to_parent[k]];
            return se3di_machine_fail(m, node->line, node->column,
                                      "the link `%.80s` is in a circle of joints: URDF has trees",
                                      t->links.list[k].name);
        }
        placed[at] = true;
        while (depth > 0) {
            at = stack[--depth];
            placed[at] = true;
            if (!place(t, t->to_parent[at])) {
                return false;
            }
        }
    }
    return true;
}

static void anchor_roots(tree *t)
{
    se3di_machine *m = t->links.m;
    size_t roots = 0;
    for (size_t k = 0; k < t->links.count; ++k) {
        se3di_link *link = &t->links.list[k];
        if (t->to_parent[k] != SE3DI_GROUND) {
            continue;
        }
        const bool world = strcmp(link->name, "world") == 0 && !(link->mass.mass > 0.0);
        link->is_ground = world;
        link->anchored = world || !m->options->free_base;
        if (++roots == 2) {
            se3di_machine_note_of(m, SE3D_IMPORT_NOTE, link->line,
                                  "`%.80s` is a second root: URDF has one tree", link->name);
        }
    }
}

/* A floating joint holds nothing. */
static void free_floating(tree *t)
{
    for (size_t k = 0; k < t->links.joint_count; ++k) {
        const se3di_link_joint *joint = &t->links.joints[k];
        if (joint->type == SE3DI_LINK_FREE) {
            se3di_machine_note_of(t->links.m, SE3D_IMPORT_NOTE, joint->line,
                                  "the joint `%.80s` is floating: its link is free", joint->name);
        }
    }
}

static bool add_mimics(tree *t)
{
    for (size_t k = 0; k < t->links.joint_count; ++k) {
        se3di_urdf_mimic mimic;
        if (!read_mimic(t, k, &mimic)) {
            return false;
        }
        if (mimic.joint != SE3DI_GROUND &&
            !se3di_urdf_couple(t->links.m, &t->links.joints[k], &t->links.joints[mimic.joint],
                               &mimic)) {
            return false;
        }
    }
    return true;
}

static bool allocate(tree *t, const se3di_xml *root)
{
    se3di_iopool *pool = t->links.m->pool;
    size_t links = 1;
    size_t joints = 1;
    for (const se3di_xml *node = root->first; node; node = node->next) {
        links += se3di_xml_is(node, "link");
        joints += se3di_xml_is(node, "joint");
    }
    t->joint_nodes = se3di_iopool_array(pool, joints, sizeof *t->joint_nodes);
    t->origins = se3di_iopool_array(pool, joints, sizeof *t->origins);
    t->axes = se3di_iopool_array(pool, joints, sizeof *t->axes);
    t->to_parent = se3di_iopool_array(pool, links, sizeof *t->to_parent);
    if (!t->joint_nodes || !t->origins || !t->axes || !t->to_parent) {
        return se3di_machine_fail_memory(t->links.m);
    }
    for (size_t k = 0; k < links; ++k) {
        t->to_parent[k] = SE3DI_GROUND;
    }
    return true;
}

bool se3di_import_urdf(se3di_machine *m, se3di_xml *root)
{
    tree t = {.links = {.m = m}};
    m->title = se3di_xml_get(root, "name");
    if (!se3di_urdf_others(m, root) || !allocate(&t, root)) {
        return false;
    }
    for (const se3di_xml *node = root->first; node; node = node->next) {
        if (se3di_xml_is(node, "link") && !read_link(&t, root, node)) {
            return false;
        }
    }
    if (t.links.count == 0) {
        return se3di_machine_fail(m, root->line, root->column, "the robot has no <link>");
    }
    for (const se3di_xml *node = root->first; node; node = node->next) {
        if (se3di_xml_is(node, "joint") && !read_joint(&t, node)) {
            return false;
        }
    }
    if (!place_all(&t)) {
        return false;
    }
    anchor_roots(&t);
    free_floating(&t);
    return se3di_links_emit(&t.links) && add_mimics(&t);
}
