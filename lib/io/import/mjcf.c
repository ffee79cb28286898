/* SPDX-License-Identifier: BSD-3-Clause */
/* MJCF, MuJoCo's format (mujoco.readthedocs.io, XML reference): its settings, defaults and frames.
 * The pose is qpos0: all joints at their `ref`. */
#include "io/import/mjcf.h"
#include "io/import/material.h"

#include <string.h>

#include "io/import/formats.h"
#include "io/import/mesh.h"
#include "io/import/scan.h"

#define PI 3.14159265358979323846

enum { INCLUDES_MAX = 100 };

static const se3di_mjcf_class *find_class(const se3di_mjcf *f, const char *name)
{
    const se3di_mjcf_class *at = f->classes;
    while (at && name && strcmp(at->name, name) != 0) {
        at = at->next;
    }
    return at; /* the first is the main one */
}

const char *se3di_mjcf_get(const se3di_mjcf *f, const se3di_mjcf_element *e, const char *name)
{
    const char *value = se3di_xml_get(e->node, name);
    const char *own = se3di_xml_get(e->node, "class");
    const se3di_mjcf_class *c = find_class(f, own ? own : e->class_name);
    for (; !value && c; c = c->outer) {
        value = se3di_xml_get(se3di_xml_child(c->node, e->node->name), name);
    }
    /* other files may bring more of the outermost class */
    for (c = f->classes; !value && c; c = c->next) {
        value = c->outer ? NULL : se3di_xml_get(se3di_xml_child(c->node, e->node->name), name);
    }
    return value;
}

bool se3di_mjcf_numbers(se3di_mjcf *f, const se3di_mjcf_element *e, const char *name,
                        double *values, int room, int *count)
{
    const char *text = se3di_mjcf_get(f, e, name);
    *count = text ? se3di_scan_numbers(text, values, room) : 0;
    if (*count < 0) {
        return se3di_machine_fail(f->links.m, e->node->line, e->node->column,
                                  "<%.60s %s=\"%.60s\">: must be at most %d numbers", e->node->name,
                                  name, text, room);
    }
    return true;
}

bool se3di_mjcf_number(se3di_mjcf *f, const se3di_mjcf_element *e, const char *name, double *value)
{
    double read[1];
    int count;
    if (!se3di_mjcf_numbers(f, e, name, read, 1, &count)) {
        return false;
    }
    *value = count == 1 ? read[0] : *value;
    return true;
}

bool se3di_mjcf_is(const se3di_mjcf *f, const se3di_mjcf_element *e, const char *name,
                   const char *value)
{
    const char *text = se3di_mjcf_get(f, e, name);
    return text && strcmp(text, value) == 0;
}

/* Angles about the axes of eulerseq: small letters turn with the frame, large ones stand still. */
static void turn_by_euler(const se3di_mjcf *f, const double angles[3], double A[9])
{
    se3di_frame whole = se3di_frame_identity();
    for (int k = 0; k < 3; ++k) {
        const char letter = f->eulerseq[k];
        const bool fixed = letter >= 'X' && letter <= 'Z';
        double axis[3] = {0.0, 0.0, 0.0};
        double R[9];
        axis[letter - (fixed ? 'X' : 'x')] = 1.0;
        se3di_turn_about(axis, angles[k] * f->angle, R);
        if (fixed) {
            se3di_turn_multiply(R, whole.A, whole.A);
        } else {
            se3di_turn_multiply(whole.A, R, whole.A);
        }
    }
    memcpy(A, whole.A, sizeof whole.A);
}

/* The least turn from z to `axis`. */
static bool turn_z_to(const double axis[3], double A[9])
{
    static const double z[3] = {0.0, 0.0, 1.0};
    static const double x[3] = {1.0, 0.0, 0.0};
    double cross[3];
    const double length = se3di_length(axis);
    if (!(length > 0.0)) {
        return false;
    }
    se3di_cross(z, axis, cross);
    const double s = se3di_length(cross);
    if (s > 1e-14 * length) {
        double along[9];
        double turned[9];
        /* axes with z along both, x the common normal */
        se3di_turn_along_both(z, cross, along);
        se3di_turn_along_both(axis, cross, turned);
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                A[3 * i + j] = turned[3 * i] * along[3 * j] + turned[3 * i + 1] * along[3 * j + 1] +
                               turned[3 * i + 2] * along[3 * j + 2];
            }
        }
        return true;
    }
    return se3di_turn_along_both(axis, x, A);
}

static bool read_turn(se3di_mjcf *f, const se3di_mjcf_element *e, double A[9])
{
    static const struct {
        const char *name;
        int count;
    } ways[] = {{"quat", 4}, {"axisangle", 4}, {"xyaxes", 6}, {"zaxis", 3}, {"euler", 3}};
    for (int k = 0; k < 5; ++k) {
        double v[6];
        int count;
        bool good = true;
        if (!se3di_mjcf_numbers(f, e, ways[k].name, v, 6, &count)) {
            return false;
        }
        if (count == 0) {
            continue;
        }
        good = count == ways[k].count;
        if (good && k == 0) {
            good = se3di_turn_from_parameters(v, A);
        } else if (good && k == 1) {
            good = se3di_length(v) > 0.0;
            if (good) {
                se3di_turn_about(v, v[3] * f->angle, A);
            }
        } else if (good && k == 2) {
            double z[3];
            se3di_cross(v, v + 3, z);
            good = se3di_turn_along_both(z, v, A);
        } else if (good && k == 3) {
            good = turn_z_to(v, A);
        } else if (good) {
            turn_by_euler(f, v, A);
        }
        return good || se3di_machine_fail(f->links.m, e->node->line, e->node->column,
                                          "<%.60s %s>: must be %d numbers that are an orientation",
                                          e->node->name, ways[k].name, ways[k].count);
    }
    return true;
}

bool se3di_mjcf_frame(se3di_mjcf *f, const se3di_mjcf_element *e, se3di_frame *frame)
{
    int count;
    *frame = se3di_frame_identity();
    return se3di_mjcf_numbers(f, e, "pos", frame->r, 3, &count) && read_turn(f, e, frame->A);
}

static bool add_classes(se3di_mjcf *f, const se3di_xml *node, const se3di_mjcf_class *outer)
{
    const char *name = se3di_xml_get(node, "class");
    se3di_mjcf_class *c = se3di_iopool_alloc(f->links.m->pool, sizeof *c);
    if (!c) {
        return se3di_machine_fail_memory(f->links.m);
    }
    c->name = name ? name : "main";
    c->node = node;
    c->outer = outer;
    if (f->last_class) {
        f->last_class->next = c;
    } else {
        f->classes = c;
    }
    f->last_class = c;
    for (const se3di_xml *at = se3di_xml_child(node, "default"); at; at = se3di_xml_again(at)) {
        if (!add_classes(f, at, c)) { /* as deep as XML may be */
            return false;
        }
    }
    return true;
}

static bool read_compiler(se3di_mjcf *f, const se3di_xml *node)
{
    se3di_machine *m = f->links.m;
    const char *seq = se3di_xml_get(node, "eulerseq");
    const char *angle = se3di_xml_get(node, "angle");
    const char *from = se3di_xml_get(node, "inertiafromgeom");
    const char *limits = se3di_xml_get(node, "autolimits");
    const char *coordinate = se3di_xml_get(node, "coordinate");
    const char *folder = se3di_xml_get(node, "meshdir");
    if (seq && (strlen(seq) != 3 || seq[strspn(seq, "xyzXYZ")])) {
        return se3di_machine_fail(m, node->line, node->column,
                                  "eulerseq=\"%.20s\": must be three of x y z X Y Z", seq);
    }
    if (coordinate && strcmp(coordinate, "local") != 0) {
        return se3di_machine_fail(m, node->line, node->column,
                                  "coordinate=\"%.20s\": must be local, as in MuJoCo since 2.3.3",
                                  coordinate);
    }
    if (seq) {
        memcpy(f->eulerseq, seq, 4);
    }
    if (angle) {
        f->angle = strcmp(angle, "radian") == 0 ? 1.0 : PI / 180.0;
    }
    f->inertia_from_geoms = from ? strcmp(from, "true") == 0 : f->inertia_from_geoms;
    f->autolimits = limits ? strcmp(limits, "true") == 0 : f->autolimits;
    folder = folder ? folder : se3di_xml_get(node, "assetdir");
    f->mesh_folder = folder ? folder : f->mesh_folder;
    for (size_t k = 0; k < node->attribute_count; ++k) {
        const char *name = node->attributes[k].name;
        if (strcmp(name, "boundmass") == 0 || strcmp(name, "boundinertia") == 0 ||
            (strcmp(name, "balanceinertia") == 0 &&
             strcmp(node->attributes[k].value, "true") == 0)) {
            se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line, "%s of the compiler", name);
        }
    }
    return se3di_xml_numbers(m, node, "settotalmass", &f->total_mass, 1);
}

/* The last word about a flag counts. */
static void read_flags(se3di_mjcf *f, const se3di_xml *option)
{
    se3di_mjcf_disabled *off = &f->disabled;
    const struct {
        const char *name;
        bool *const parts[4];
    } flags[] = {{"constraint", {&off->contact, &off->limits, &off->friction, &off->equality}},
                 {"contact", {&off->contact}},
                 {"limit", {&off->limits}},
                 {"frictionloss", {&off->friction}},
                 {"equality", {&off->equality}},
                 {"passive", {&off->springs, &off->dampers}},
                 {"spring", {&off->springs}},
                 {"damper", {&off->dampers}},
                 {"gravity", {&off->gravity}}};
    for (const se3di_xml *at = se3di_xml_child(option, "flag"); at; at = se3di_xml_again(at)) {
        for (size_t k = 0; k < sizeof flags / sizeof *flags; ++k) {
            const char *value = se3di_xml_get(at, flags[k].name);
            for (size_t i = 0; value && i < 4 && flags[k].parts[i]; ++i) {
                *flags[k].parts[i] = strcmp(value, "disable") == 0;
            }
        }
    }
}

static bool read_settings(se3di_mjcf *f)
{
    se3di_machine *m = f->links.m;
    for (const se3di_xml *at = f->root->first; at; at = at->next) {
        if (se3di_xml_is(at, "compiler") && !read_compiler(f, at)) {
            return false;
        }
        if (se3di_xml_is(at, "option")) {
            read_flags(f, at);
            if (!se3di_xml_numbers(m, at, "gravity", m->gravity, 3)) {
                return false;
            }
        }
        if (se3di_xml_is(at, "option") &&
            (se3di_xml_get(at, "wind") || se3di_xml_get(at, "density") ||
             se3di_xml_get(at, "viscosity"))) {
            se3di_machine_note_of(m, SE3D_IMPORT_LOST, at->line, "the medium around the bodies");
        }
        if (se3di_xml_is(at, "default") && !add_classes(f, at, NULL)) {
            return false;
        }
    }
    if (f->disabled.gravity) {
        memset(m->gravity, 0, sizeof m->gravity);
    }
    return true;
}

/* What <contact> says of single pairs, by their names. */
static void note_pairs(se3di_mjcf *f, const se3di_xml *contact)
{
    for (const se3di_xml *at = contact->first; at; at = at->next) {
        const bool excludes = se3di_xml_is(at, "exclude");
        const char *one = se3di_xml_get(at, excludes ? "body1" : "geom1");
        const char *other = se3di_xml_get(at, excludes ? "body2" : "geom2");
        one = one ? one : "";
        other = other ? other : "";
        if (excludes) {
            se3di_machine_note_of(
                f->links.m, SE3D_IMPORT_LOST, at->line,
                "contact of the bodies `%.80s` and `%.80s` is excluded in MuJoCo: "
                "give their shapes a `group` and `mask`",
                one, other);
        } else if (se3di_xml_is(at, "pair")) {
            se3di_machine_note_of(
                f->links.m, SE3D_IMPORT_LOST, at->line,
                "contact of the geoms `%.80s` and `%.80s` has settings of its own "
                "in MuJoCo: give their materials an entry in `pairs` of `contact`",
                one, other);
        }
    }
}

static void note_others(se3di_mjcf *f)
{
    static const char *const known[] = {"compiler", "option",   "default", "worldbody", "equality",
                                        "tendon",   "actuator", "asset",   "statistic", "visual",
                                        "size",     "include",  "contact"};
    static const char *const lost[] = {"deformable", "extension"};
    for (const se3di_xml *at = f->root->first; at; at = at->next) {
        bool is_known = false;
        if (se3di_xml_is(at, "contact")) {
            note_pairs(f, at);
        }
        bool is_lost = false;
        for (size_t k = 0; k < sizeof known / sizeof *known; ++k) {
            is_known = is_known || se3di_xml_is(at, known[k]);
        }
        for (size_t k = 0; k < sizeof lost / sizeof *lost; ++k) {
            is_lost = is_lost || se3di_xml_is(at, lost[k]);
        }
        if (!is_known) {
            se3di_machine_note_of(f->links.m, is_lost ? SE3D_IMPORT_LOST : SE3D_IMPORT_NOTE,
                                  at->line, "<%.60s> is left out", at->name);
        }
    }
    if (f->touching > 1) {
        se3di_machine_note_of(
            f->links.m, SE3D_IMPORT_LOST, 0,
            "contact: %zu geoms may touch in MuJoCo; here they have materials, `group` and "
            "`mask`, and `contact` is a comment at the end: take its signs away to let them "
            "touch, of springs whose stiffness is a parameter",
            f->touching);
    }
}

static void scale_masses(se3di_mjcf *f)
{
    double sum = 0.0;
    for (size_t k = 0; k < f->links.count; ++k) {
        sum += f->links.list[k].mass.mass;
    }
    for (size_t k = 0; f->total_mass > 0.0 && sum > 0.0 && k < f->links.count; ++k) {
        se3di_mass *mass = &f->links.list[k].mass;
        mass->mass *= f->total_mass / sum;
        for (int i = 0; i < 9; ++i) {
            mass->J[i] *= f->total_mass / sum;
        }
    }
}

static bool read_file(se3di_machine *m, const char *path, se3di_xml **root)
{
    char *text = NULL;
    size_t length = 0;
    return path && se3di_import_read(m, path, &text, &length) &&
           se3di_xml_parse(m, text, length, root);
}

/* Put the elements of a file in the place of the <include> after `before` (NULL: the first). */
static bool include_one(se3di_mjcf *f, se3di_xml *parent, se3di_xml *before, const char *folder)
{
    se3di_machine *m = f->links.m;
    se3di_xml *at = before ? before->next : parent->first;
    se3di_xml *root = NULL;
    const char *name = se3di_xml_need(m, at, "file");
    if (!name || !read_file(m, se3di_path_join(m, folder, name), &root)) {
        return m->status >= 0 ? se3di_machine_fail_memory(m) : false;
    }
    se3di_xml *first = root->first ? root->first : at->next;
    if (root->first) {
        root->last->next = at->next;
    }
    if (before) {
        before->next = first;
    } else {
        parent->first = first;
    }
    return true;
}

static bool include_all(se3di_mjcf *f, se3di_xml *parent, int *count, const char *folder)
{
    se3di_machine *m = f->links.m;
    se3di_xml *before = NULL;
    se3di_xml *at = parent->first;
    while (at) {
        if (se3di_xml_is(at, "include")) {
            if (++*count > INCLUDES_MAX) {
                return se3di_machine_fail(m, at->line, at->column,
                                          "more than 100 files are included");
            }
            if (!include_one(f, parent, before, folder)) {
                return false;
            }
            at = before ? before->next : parent->first;
            continue;
        }
        if (!include_all(f, at, count, folder)) { /* as deep as XML may be */
            return false;
        }
        before = at;
        at = at->next;
    }
    return true;
}

bool se3di_import_mjcf(se3di_machine *m, se3di_xml *root)
{
    se3di_mjcf f = {.links = {.m = m},
                    .root = root,
                    .angle = PI / 180.0,
                    .eulerseq = "xyz",
                    .autolimits = true};
    int count = 0;
    const char *folder = se3di_path_folder(m, m->file);
    m->title = se3di_xml_get(root, "model");
    m->mixing = SE3DI_MIXING_LARGEST;
    m->touches_later = true;
    if (!folder || !include_all(&f, root, &count, folder) || !read_settings(&f)) {
        return m->status >= 0 ? se3di_machine_fail_memory(m) : false;
    }
    f.mesh_folder = f.mesh_folder ? se3di_path_join(m, folder, f.mesh_folder) : folder;
    se3di_link *world = se3di_links_add(&f.links, "world", root->line);
    if (!world) {
        return false;
    }
    world->is_ground = world->anchored = true;
    if (!se3di_mjcf_name(&f, &f.body_names, "world", 0)) {
        return false;
    }
    for (const se3di_xml *at = root->first; at; at = at->next) {
        if (se3di_xml_is(at, "worldbody") && !se3di_mjcf_bodies(&f, at)) {
            return false;
        }
    }
    if (f.links.count < 2) {
        return se3di_machine_fail(m, root->line, root->column, "there is no <body>");
    }
    scale_masses(&f);
    se3di_mjcf_sort_shapes(&f);
    note_others(&f);
    return se3di_mjcf_close(&f) && se3di_links_emit(&f.links) && se3di_mjcf_acts(&f);
}
