/* SPDX-License-Identifier: BSD-3-Clause */
/* MJCF: what closes loops, couples joints and acts. */
#include <math.h>
#include <string.h>

#include "io/import/mjcf.h"

static bool lose(se3di_mjcf *f, const se3di_xml *node, const char *why)
{
    const char *name = se3di_xml_get(node, "name");
    se3di_machine_note_of(f->links.m, SE3D_IMPORT_LOST, node->line, "<%.40s> `%.80s`: %s",
                          node->name, name ? name : "", why);
    return f->links.m->status >= 0;
}

/* A joint of the links between frames of the ground; the ground is its child, so that it does not
 * hold what moves otherwise. */
static bool join(se3di_mjcf *f, const se3di_xml *node, se3di_link_joint_type type,
                 const size_t links[2], const se3di_frame frames[2])
{
    const char *name = se3di_xml_get(node, "name");
    const int first = links[0] == 0 ? 1 : 0;
    if (links[0] == links[1]) {
        return lose(f, node, "both ends are on one body");
    }
    se3di_link_joint *joint = se3di_links_join(&f->links, name ? name : node->name, node->line);
    if (!joint) {
        return false;
    }
    joint->type = type;
    joint->parent = links[first];
    joint->child = links[1 - first];
    joint->frame_i = frames[first];
    joint->frame_j = frames[1 - first];
    return true;
}

/* Frames at two sites. */
static bool of_sites(se3di_mjcf *f, const se3di_xml *node, size_t links[2], se3di_frame frames[2],
                     bool *found)
{
    static const char *const keys[] = {"site1", "site2"};
    *found = true;
    for (int k = 0; k < 2 && *found; ++k) {
        size_t index = 0;
        if (!se3di_mjcf_find(f, node, keys[k], &f->site_names, &index, found)) {
            return false;
        }
        if (*found) {
            links[k] = f->sites[index].link;
            frames[k] = se3di_frame_of(&f->links.list[links[k]].frame, &f->sites[index].frame);
        }
    }
    return true;
}

static bool of_bodies(se3di_mjcf *f, const se3di_xml *node, size_t links[2], se3di_frame frames[2])
{
    const se3di_mjcf_element e = {.node = node};
    double pose[7] = {0.0};
    se3di_frame local = se3di_frame_identity();
    bool found = false;
    int count;
    links[1] = 0;
    if (!se3di_xml_need(f->links.m, node, "body1") ||
        !se3di_mjcf_find(f, node, "body1", &f->body_names, &links[0], &found) ||
        !se3di_mjcf_find(f, node, "body2", &f->body_names, &links[1], &found) ||
        !se3di_mjcf_numbers(f, &e, "anchor", local.r, 3, &count)) {
        return false;
    }
    const bool weld = se3di_xml_is(node, "weld");
    const size_t of = weld && found ? links[1] : links[0]; /* whose frame the anchor is in */
    frames[0] = frames[1] = se3di_frame_of(&f->links.list[of].frame, &local);
    if (!se3di_mjcf_numbers(f, &e, "relpose", pose, 7, &count)) {
        return false;
    }
    if (weld && count == 7 && se3di_turn_from_parameters(pose + 3, local.A)) {
        memcpy(local.r, pose, sizeof local.r);
        frames[0] = se3di_frame_of(&f->links.list[links[0]].frame, &local);
        frames[1] = f->links.list[links[1]].frame;
    }
    return true;
}

bool se3di_mjcf_close(se3di_mjcf *f)
{
    if (f->disabled.equality) {
        return true;
    }
    for (const se3di_xml *list = se3di_xml_child(f->root, "equality"); list;
         list = se3di_xml_again(list)) {
        for (const se3di_xml *at = list->first; at; at = at->next) {
            const bool weld = se3di_xml_is(at, "weld");
            size_t links[2] = {0, 0};
            se3di_frame frames[2];
            bool found = false;
            const char *active = se3di_xml_get(at, "active");
            if ((!weld && !se3di_xml_is(at, "connect")) || (active && !strcmp(active, "false"))) {
                continue;
            }
            if (!of_sites(f, at, links, frames, &found) ||
                (!found && !of_bodies(f, at, links, frames)) ||
                !join(f, at, weld ? SE3DI_LINK_FIXED : SE3DI_LINK_SPHERICAL, links, frames)) {
                return false;
            }
        }
    }
    return true;
}

static double start_of(const se3di_link_joint *joint)
{
    if (joint->type == SE3DI_LINK_REVOLUTE) {
        return joint->angle0;
    }
    double d[3];
    for (int k = 0; k < 3; ++k) {
        d[k] = joint->frame_j.r[k] - joint->frame_i.r[k];
    }
    const double z[3] = {joint->frame_i.A[2], joint->frame_i.A[5], joint->frame_i.A[8]};
    return se3di_dot(d, z);
}

static bool has_coordinate(const se3di_link_joint *joint)
{
    return joint->made &&
           (joint->type == SE3DI_LINK_REVOLUTE || joint->type == SE3DI_LINK_PRISMATIC);
}

static void put_terms(se3di_machine *m, se3di_entry *entry, const se3di_link_joint *a,
                      const se3di_link_joint *b, double factor)
{
    const char *one = se3di_machine_quote(m, a->made);
    const char *two = se3di_machine_quote(m, b->made);
    const char *ratio = se3di_machine_number(m, factor);
    se3di_entry_put(m, entry, "type", "coupler");
    if (one && two && ratio) {
        se3di_entry_put(
            m, entry, "terms",
            se3di_machine_text(m, "[{joint: %s}, {joint: %s, ratio: %s}]", one, two, ratio));
    }
}

/* q1 - ref1 = a0 + a1 (q2 - ref2), in the units of ours: radians as in MuJoCo. */
static bool couple(se3di_mjcf *f, const se3di_xml *node)
{
    se3di_machine *m = f->links.m;
    const se3di_mjcf_element e = {.node = node};
    double c[5] = {0.0, 1.0, 0.0, 0.0, 0.0};
    size_t index[2] = {0, 0};
    bool found = false;
    int count;
    if (!se3di_xml_need(m, node, "joint1") ||
        !se3di_mjcf_find(f, node, "joint1", &f->joint_names, &index[0], &found) ||
        !se3di_mjcf_find(f, node, "joint2", &f->joint_names, &index[1], &found) ||
        !se3di_mjcf_numbers(f, &e, "polycoef", c, 5, &count)) {
        return false;
    }
    const se3di_link_joint *a = &f->links.joints[index[0]];
    const se3di_link_joint *b = &f->links.joints[index[1]];
    if (c[2] != 0.0 || c[3] != 0.0 || c[4] != 0.0) {
        return lose(f, node, "its polynomial is not linear");
    }
    if (!has_coordinate(a) || (found && !has_coordinate(b))) {
        return lose(f, node, "its joints must be hinges or slides");
    }
    const bool follows = found && c[1] != 0.0;
    const char *name = se3di_machine_name(m, se3di_xml_get(node, "name"),
                                          follows ? "coupler" : "driver", node->line);
    se3di_entry *entry =
        name ? se3di_machine_add(m, follows ? SE3DI_SECTION_JOINTS : SE3DI_SECTION_DRIVERS) : NULL;
    const double value = c[0] + start_of(a) - (follows ? c[1] * start_of(b) : 0.0);
    if (!entry) {
        return false;
    }
    se3di_entry_put_text(m, entry, "name", name);
    if (follows) {
        put_terms(m, entry, a, b, -c[1]);
    } else {
        se3di_entry_put_text(m, entry, "joint", a->made);
    }
    se3di_entry_put_number(m, entry, "value", value);
    return m->status >= 0;
}

static bool read_equality(se3di_mjcf *f, const se3di_xml *node)
{
    const char *active = se3di_xml_get(node, "active");
    if (f->disabled.equality || (active && strcmp(active, "false") == 0)) {
        se3di_machine_note_of(f->links.m, SE3D_IMPORT_NOTE, node->line,
                              "<%.40s> is not active and left out", node->name);
        return f->links.m->status >= 0;
    }
    if (se3di_xml_is(node, "joint")) {
        return couple(f, node);
    }
    return se3di_xml_is(node, "connect") || se3di_xml_is(node, "weld") ||
           lose(f, node, "an equality of this type");
}

typedef struct spring {
    double k, c, length[2];
    int lengths; /* that are given */
    size_t sites[2];
} spring;

static bool add_spring(se3di_mjcf *f, const se3di_xml *node, const spring *s)
{
    se3di_machine *m = f->links.m;
    double points[2][3];
    static const char *const bodies[] = {"body_i", "body_j"};
    static const char *const at[] = {"at", "at_2"};
    const char *name = se3di_machine_name(m, se3di_xml_get(node, "name"), "tendon", node->line);
    se3di_entry *entry = se3di_machine_add_force(m, name, "tsda");
    if (!entry) {
        return false;
    }
    for (int k = 0; k < 2; ++k) {
        const se3di_mjcf_place *site = &f->sites[s->sites[k]];
        const se3di_link *link = &f->links.list[site->link];
        se3di_entry_put_text(m, entry, bodies[k], se3di_machine_body_name(m, link->body));
        se3di_frame_point(&link->frame, site->frame.r, points[k]);
    }
    for (int k = 0; k < 2; ++k) {
        se3di_entry_put_vector(m, entry, at[k], points[k]);
    }
    const double start = se3di_distance(points[0], points[1]);
    se3di_entry_put_number(m, entry, "l0",
                           s->lengths > 0 && s->length[0] >= 0.0 ? s->length[0] : start);
    se3di_entry_put_number(m, entry, "k", s->k);
    if (s->c != 0.0) {
        se3di_entry_put_number(m, entry, "c", s->c);
    }
    return m->status >= 0;
}

/* Stiffness, damping and lengths; friction and a range are lost. */
static bool read_spring(se3di_mjcf *f, const se3di_xml *node, spring *s)
{
    const se3di_mjcf_element e = {.node = node};
    double friction = 0.0;
    if (!se3di_mjcf_number(f, &e, "stiffness", &s->k) ||
        !se3di_mjcf_number(f, &e, "damping", &s->c) ||
        !se3di_mjcf_number(f, &e, "frictionloss", &friction) ||
        !se3di_mjcf_numbers(f, &e, "springlength", s->length, 2, &s->lengths)) {
        return false;
    }
    if ((friction != 0.0 && !f->disabled.friction) ||
        (se3di_mjcf_get(f, &e, "range") && !f->disabled.limits)) {
        lose(f, node, "its friction or range");
    }
    s->k = f->disabled.springs ? 0.0 : s->k;
    s->c = f->disabled.dampers ? 0.0 : s->c;
    return true;
}

static bool read_tendon(se3di_mjcf *f, const se3di_xml *node)
{
    spring s = {.length = {-1.0, -1.0}};
    size_t count = 0;
    bool found = true;
    if (!read_spring(f, node, &s)) {
        return false;
    }
    for (const se3di_xml *at = node->first; at; at = at->next) {
        found = found && se3di_xml_is(at, "site");
        if (found && count < 2 &&
            !se3di_mjcf_find(f, at, "site", &f->site_names, &s.sites[count], &found)) {
            return false;
        }
        ++count;
    }
    if (s.k == 0.0 && s.c == 0.0) {
        return f->links.m->status >= 0;
    }
    if (!se3di_xml_is(node, "spatial") || !found || count != 2 ||
        (s.lengths == 2 && s.length[1] > s.length[0])) {
        return lose(f, node, "it is no spring between two sites");
    }
    if (f->links.list[f->sites[s.sites[0]].link].body ==
        f->links.list[f->sites[s.sites[1]].link].body) {
        return lose(f, node, "both of its sites are on one body");
    }
    return add_spring(f, node, &s);
}

/* The gear of a motor is a factor of its control, which is not there: a program sets the effort. */
static bool read_actuator(se3di_mjcf *f, const se3di_xml *node)
{
    se3di_machine *m = f->links.m;
    size_t index = 0;
    bool found = false;
    const char *own = se3di_xml_get(node, "name");
    if (!se3di_mjcf_find(f, node, "joint", &f->joint_names, &index, &found)) {
        return false;
    }
    if (!found || !has_coordinate(&f->links.joints[index])) {
        return lose(f, node, "it acts on no hinge or slide");
    }
    const char *joint = f->links.joints[index].made;
    const char *wanted = own ? own : se3di_machine_extend(m, joint, "_effort");
    const char *name = wanted ? se3di_machine_name(m, wanted, "effort", node->line) : NULL;
    se3di_entry *entry = se3di_machine_add_force(m, name, "effort");
    if (!entry) {
        return false;
    }
    se3di_entry_put_text(m, entry, "joint", joint);
    if (!se3di_xml_is(node, "motor")) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line,
                              "the law of <%.40s> `%.80s`: it is an effort of 0, which a program "
                              "sets",
                              node->name, name);
    }
    return m->status >= 0;
}

bool se3di_mjcf_acts(se3di_mjcf *f)
{
    static const struct {
        const char *list;
        bool (*read)(se3di_mjcf *f, const se3di_xml *node);
    } lists[] = {{"equality", read_equality}, {"tendon", read_tendon}, {"actuator", read_actuator}};
    for (size_t k = 0; k < sizeof lists / sizeof *lists; ++k) {
        for (const se3di_xml *list = se3di_xml_child(f->root, lists[k].list); list;
             list = se3di_xml_again(list)) {
            for (const se3di_xml *at = list->first; at; at = at->next) {
                if (!lists[k].read(f, at)) {
                    return false;
                }
            }
        }
    }
    const se3di_xml *motors = se3di_xml_child(f->root, "actuator");
    if (motors && motors->first) {
        se3di_machine_note_of(f->links.m, SE3D_IMPORT_NOTE, motors->line,
                              "actuators are efforts of 0, which a program sets between steps");
    }
    return f->links.m->status >= 0;
}
