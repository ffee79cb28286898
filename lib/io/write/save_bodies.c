/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies with their markers and shapes, and what they touch with, as a model file. */
#include <stdio.h>
#include <string.h>

#include "io/document/fields.h"
#include "io/read/shape_kinds.h"
#include "io/write/save.h"

static void save_key(se3di_save *s, const char *key)
{
    s->is_first = true; /* a line of its own */
    se3di_save_put(s, "    ");
    s->indent = "      ";
    (void)key;
}

/* `    key: value` */
static void line_of_vector(se3di_save *s, const char *key, const double *values, size_t count)
{
    save_key(s, key);
    se3di_save_vector(s, key, values, count);
    se3di_save_put(s, "\n");
}

static void save_mass(se3di_save *s, se3d_body body)
{
    double mass = 0.0, inertia[6] = {0.0};
    int32_t fixed = 0;
    (void)se3d_body_get_fixed(s->system, body, &fixed);
    (void)se3d_body_get_mass(s->system, body, &mass, inertia);
    save_key(s, "mass");
    if (fixed) {
        se3di_save_word(s, "fixed", "true");
        se3di_save_put(s, "\n");
        return;
    }
    se3di_save_number(s, "mass", mass);
    se3di_save_put(s, "\n");
    line_of_vector(s, "inertia", inertia, se3di_save_is_zero(inertia + 3, 3) ? 3 : 6);
}

static void save_state(se3di_save *s, se3d_body body)
{
    double r[3] = {0.0}, p[4] = {1.0, 0.0, 0.0, 0.0}, v[3] = {0.0}, w[3] = {0.0};
    static const double none[4] = {1.0, 0.0, 0.0, 0.0};
    int32_t held = 0;
    (void)se3d_body_get_position(s->system, body, r);
    (void)se3d_body_get_orientation(s->system, body, p);
    (void)se3d_body_get_velocity(s->system, body, v);
    (void)se3d_body_get_angular_velocity(s->system, body, w);
    (void)se3d_body_get_held(s->system, body, &held);
    if (!se3di_save_is_zero(r, 3)) {
        line_of_vector(s, "position", r, 3);
    }
    if (memcmp(p, none, sizeof none) != 0) {
        save_key(s, "orientation");
        se3di_save_orientation(s, "orientation", p);
        se3di_save_put(s, "\n");
    }
    if (!se3di_save_is_zero(v, 3)) {
        line_of_vector(s, "velocity", v, 3);
    }
    if (!se3di_save_is_zero(w, 3)) {
        line_of_vector(s, "angular_velocity", w, 3);
    }
    if (held) {
        se3di_save_line(s, "    held: true");
    }
}

/* Entries within a body stand deeper. */
static void open_part(se3di_save *s, const char *title, bool *is_first)
{
    if (*is_first) {
        se3di_save_put(s, "    ");
        se3di_save_put(s, title);
        se3di_save_put(s, ":\n");
        *is_first = false;
    }
    se3di_save_put(s, "      - {");
    s->indent = "         ";
    s->is_first = true;
}

static void save_markers(se3di_save *s, se3d_body body)
{
    bool is_first = true;
    for (size_t k = 0; k < se3d_system_count_markers(s->system); ++k) {
        se3d_marker marker;
        se3d_marker_def def = se3d_marker_def_default();
        char made[32];
        (void)se3d_system_get_marker(s->system, k, &marker);
        (void)se3d_marker_get_def(s->system, marker, &def);
        if (def.body.index1 != body.index1) {
            continue;
        }
        snprintf(made, sizeof made, "marker%zu", k + 1);
        open_part(s, "markers", &is_first);
        se3di_save_text(s, "name", def.name ? def.name : made);
        se3di_save_vector_but_zero(s, "position", def.position, 3);
        se3di_save_orientation(s, "orientation", def.orientation);
        se3di_save_line(s, "}");
    }
}

/* ---- shapes ---------------------------------------------------------------------------------*/

static void save_file(se3di_save *s, const se3di_shape_entry *entry)
{
    if (entry->part && entry->part->place.mirror >= 0) {
        se3di_save_refuse(s, "a mesh that is mirrored has no file");
    } else if (!entry->shape.file || !entry->shape.file[0]) {
        se3di_save_refuse(s, "a plate that touches has no file");
    }
    se3di_save_text(s, "file", se3di_save_get_file(s, entry->part, entry->shape.file));
    se3di_save_number_but(s, "scale", entry->shape.scale, 1.0);
    if (entry->convex) {
        se3di_save_word(s, "convex", "true");
    }
}

void se3di_save_heights(se3di_save *s, const double *heights, size_t stride, size_t rows,
                        size_t columns)
{
    se3di_save_word(s, "heights", "[");
    for (size_t i = 0; i < rows; ++i) {
        se3di_save_put(s, i > 0 ? ",\n" : "\n");
        se3di_save_put(s, s->indent);
        for (size_t j = 0; j < columns; ++j) {
            se3di_save_put(s, j > 0 ? ", " : "[");
            se3di_save_put_numbers(s, heights + stride * (i * columns + j), 1);
        }
        se3di_save_put(s, "]");
    }
    se3di_save_put(s, "]");
}

void se3di_save_spacing(se3di_save *s, const double spacing[2])
{
    se3di_save_number(s, "spacing", spacing[0]);
    se3di_save_number_but(s, "row_spacing", spacing[1], spacing[0]);
}

/* Heights in rows, or the file that has them. */
static void save_heights(se3di_save *s, const se3di_shape_entry *entry)
{
    const se3di_mesh *mesh = entry->mesh;
    const se3di_node *file = se3di_node_get(entry->node, "file");
    se3di_save_spacing(s, mesh->spacing);
    if (!mesh->heights) {
        se3di_save_refuse(s, "a heightfield that is mirrored has no heights");
    } else if (file && file->text && se3di_save_is_in_metres(entry->part)) {
        se3di_save_text(s, "file", se3di_save_get_file(s, entry->part, file->text));
    } else {
        se3di_save_heights(s, mesh->heights, 1, mesh->row_count, mesh->column_count);
    }
}

static void save_look(se3di_save *s, const se3di_shape_entry *entry)
{
    const double color[4] = {entry->shape.color[0], entry->shape.color[1], entry->shape.color[2],
                             entry->opacity};
    if (color[0] >= 0.0) {
        se3di_save_vector(s, "color", color, color[3] < 1.0 ? 4 : 3);
    }
    if (entry->style != SE3DI_STYLE_PAINT) {
        se3di_save_text(s, "style", se3di_shape_styles[entry->style]);
    }
}

/* Materials that nothing touches with, of which only the density counted, are not in the system. */
static bool is_material(const se3di_save *s, const char *name)
{
    bool found = false;
    for (uint32_t k = 0; k < s->materials.count && !found; ++k) {
        found = s->materials.names[k] && strcmp(s->materials.names[k], name) == 0;
    }
    return found;
}

static void save_surface(se3di_save *s, se3d_shape shape)
{
    double velocity[3];
    double spin[3];
    if (se3d_shape_get_surface_motion(s->system, shape, velocity, spin) == SE3D_OK) {
        se3di_save_vector_but_zero(s, "surface_velocity", velocity, 3);
        se3di_save_vector_but_zero(s, "surface_spin", spin, 3);
    }
}

/* What a shape of the system touches with. */
static void save_touch_of(se3di_save *s, const se3d_shape_def *def)
{
    if (def->name && def->name[0]) {
        se3di_save_text(s, "name", def->name);
    }
    if (def->material.index1 != 0) {
        se3di_save_text(s, "material", s->materials.names[def->material.index1]);
    }
    se3di_save_number_but(s, "group", (double)def->group, 1.0);
    se3di_save_number_but(s, "mask", (double)def->mask, 4294967295.0);
}

/* The same of a shape of the file, which need not be in the system. */
static void save_touch(se3di_save *s, const se3di_shape_entry *entry)
{
    static const char *const keys[] = {"name", "material", "contact"};
    se3d_shape_def def = se3d_shape_def_default();
    if (entry->made.index1 != 0 && se3d_shape_get_def(s->system, entry->made, &def) >= 0) {
        save_touch_of(s, &def);
        return;
    }
    for (size_t k = 0; entry->node && k < sizeof keys / sizeof *keys; ++k) {
        const se3di_node *child = se3di_node_get(entry->node, keys[k]);
        if (child && child->text && !strchr(child->text, '{') &&
            (k != 1 || is_material(s, child->text))) {
            se3di_save_text(s, keys[k], child->text);
        }
    }
}

static void save_ends(se3di_save *s, int32_t type, double bottom, double top)
{
    if (type == SE3D_SHAPE_FUNNEL) {
        se3di_save_number(s, "bottom_radius", bottom);
        se3di_save_number(s, "top_radius", top);
    }
}

static void save_shape(se3di_save *s, const se3di_shape_entry *entry)
{
    const se3d_model_shape *shape = &entry->shape;
    size_t kind = 0;
    while (se3di_shape_types[kind] != shape->type) {
        ++kind;
    }
    se3di_save_text(s, "type", se3di_shape_names[kind]);
    se3di_save_vector_but_zero(s, "size", shape->size, 3);
    se3di_save_vector_but_zero(s, "semi_axes", shape->semi_axes, 3);
    se3di_save_number_but(s, "radius", shape->radius, 0.0);
    se3di_save_number_but(s, "length", shape->length, 0.0);
    if (shape->type == SE3D_SHAPE_MESH) {
        save_file(s, entry);
    } else if (shape->type == SE3D_SHAPE_HEIGHTFIELD) {
        save_heights(s, entry);
    }
    save_ends(s, shape->type, shape->bottom_radius, shape->top_radius);
    se3di_save_vector_but_zero(s, "position", shape->position, 3);
    se3di_save_orientation(s, "orientation", shape->orientation);
    save_touch(s, entry);
    save_surface(s, entry->made);
    save_look(s, entry);
}

/* A shape that is not of a file. */
static void save_made_shape(se3di_save *s, se3d_shape made)
{
    se3d_shape_def def = se3d_shape_def_default();
    int32_t type = 0;
    size_t kind = 0;
    (void)se3d_shape_get_def(s->system, made, &def);
    (void)se3d_shape_get_type(s->system, made, &type);
    if (type == SE3D_SHAPE_MESH || type == SE3D_SHAPE_HULL) {
        se3di_save_refuse(s, "shape %.100s is a mesh without a file", def.name ? def.name : "");
        return;
    }
    while (se3di_shape_types[kind] != type) {
        ++kind;
    }
    se3di_save_text(s, "type", se3di_shape_names[kind]);
    se3di_save_vector_but_zero(s, "size", def.size, 3);
    se3di_save_vector_but_zero(s, "semi_axes", def.semi_axes, 3);
    se3di_save_number_but(s, "radius", def.radius, 0.0);
    se3di_save_number_but(s, "length", def.length, 0.0);
    save_ends(s, type, def.bottom_radius, def.top_radius);
    if (type == SE3D_SHAPE_HEIGHTFIELD) {
        se3di_save_spacing(s, def.spacing);
        se3di_save_heights(s, def.vertices + 2, 3, def.row_count, def.column_count);
    }
    se3di_save_vector_but_zero(s, "normal", def.normal, 3);
    se3di_save_vector_but_zero(s, "position", def.position, 3);
    se3di_save_orientation(s, "orientation", def.orientation);
    save_touch_of(s, &def);
    save_surface(s, made);
}

static void name_problem(se3di_save *s, se3d_body body, const char *file)
{
    char text[sizeof s->problem];
    if (s->problem[0]) {
        snprintf(text, sizeof text, "%s", s->problem);
        snprintf(s->problem, sizeof s->problem, "a shape of body %.100s%s%.100s: %.250s",
                 s->bodies.names[body.index1], file ? ", file " : "", file ? file : "", text);
    }
}

/* One of them; what a mesh cannot say ends it, or leaves it out. */
static void close_shape(se3di_save *s, const se3di_save_entry *entry, se3d_body body,
                        const char *file)
{
    name_problem(s, body, file);
    (void)se3di_save_close(s, entry);
    s->section = NULL;
}

void se3di_save_shapes(se3di_save *s, se3d_body body)
{
    bool is_first = true;
    for (size_t k = 0; s->model && k < s->model->shape_count; ++k) {
        const se3di_shape_entry *entry = &s->model->shapes[k];
        if (entry->shape.body.index1 == body.index1) {
            open_part(s, "shapes", &is_first);
            const se3di_save_entry at = {s->out.used - strlen("      - {"), 0, NULL};
            save_shape(s, entry);
            close_shape(s, &at, body, entry->shape.file);
        }
    }
    for (size_t k = 0; !s->model && k < se3d_system_count_shapes(s->system); ++k) {
        se3d_shape shape;
        se3d_body owner = {0, 0};
        (void)se3d_system_get_shape(s->system, k, &shape);
        (void)se3d_shape_get_body(s->system, shape, &owner);
        if (owner.index1 == body.index1) {
            open_part(s, "shapes", &is_first);
            const se3di_save_entry at = {s->out.used - strlen("      - {"), 0, NULL};
            save_made_shape(s, shape);
            close_shape(s, &at, body, NULL);
        }
    }
}

static bool has_parts(const se3di_save *s, se3d_body body)
{
    bool found = false;
    for (size_t k = 0; k < se3d_system_count_markers(s->system); ++k) {
        se3d_marker marker;
        se3d_body owner = {0, 0};
        (void)se3d_system_get_marker(s->system, k, &marker);
        (void)se3d_marker_get_body(s->system, marker, &owner);
        found = found || owner.index1 == body.index1;
    }
    for (size_t k = 0; s->model && k < s->model->shape_count; ++k) {
        found = found || s->model->shapes[k].shape.body.index1 == body.index1;
    }
    for (size_t k = 0; !s->model && k < se3d_system_count_shapes(s->system); ++k) {
        se3d_shape shape;
        se3d_body owner = {0, 0};
        (void)se3d_system_get_shape(s->system, k, &shape);
        (void)se3d_shape_get_body(s->system, shape, &owner);
        found = found || owner.index1 == body.index1;
    }
    return found;
}

void se3di_save_bodies(se3di_save *s)
{
    bool is_first = true;
    for (size_t k = 0; k < se3d_system_count_bodies(s->system) && s->status >= 0; ++k) {
        se3d_body body;
        (void)se3d_system_get_body(s->system, k, &body);
        if (k == 0 && !has_parts(s, body)) {
            continue;
        }
        se3di_save_put(s, is_first ? "\nbodies:\n" : "");
        is_first = false;
        se3di_save_put(s, "  - name: ");
        se3di_save_put_text(s, s->bodies.names[body.index1]);
        se3di_save_put(s, "\n");
        if (k > 0) {
            save_mass(s, body);
            save_state(s, body);
        }
        save_markers(s, body);
        se3di_save_shapes(s, body);
    }
}

/* ---- what they touch with -------------------------------------------------------------------*/

/* What 0 is the law's own of, and less is none. */
static void save_choice(se3di_save *s, const char *key, double value)
{
    if (value > 0.0 || value < 0.0) {
        se3di_save_number(s, key, value > 0.0 ? value : 0.0);
    }
}

static void save_material(se3di_save *s, se3d_material material)
{
    se3d_contact_settings contact = se3d_contact_settings_default();
    const se3d_material_def standard = se3d_material_def_default();
    se3d_material_def def = standard;
    (void)se3d_material_get(s->system, material, &def);
    (void)se3d_system_get_contact(s->system, &contact);
    se3di_save_text(s, "name", s->materials.names[material.index1]);
    se3di_save_number(s, "density", def.density);
    se3di_save_number_but(s, "friction", def.friction, standard.friction);
    if (!(def.damping_ratio > 0.0 || def.damping_ratio < 0.0)) {
        se3di_save_number_but(s, "restitution", def.restitution, standard.restitution);
    }
    se3di_save_number_but(s, "rolling_friction", def.rolling_friction, 0.0);
    se3di_save_number_but(s, "torsional_friction", def.torsional_friction, 0.0);
    se3di_save_number_but(s, "stiffness", def.stiffness, 0.0);
    if (contact.law == SE3D_CONTACT_LAW_HERTZ_MINDLIN) {
        save_choice(s, "tangential_ratio", def.tangential_ratio_hertz);
    } else if (!(def.tangential_stiffness > 0.0 || def.tangential_stiffness < 0.0)) {
        se3di_save_number_but(s, "tangential_ratio", def.tangential_ratio,
                              standard.tangential_ratio);
    }
    se3di_save_number_but(s, "young", def.young, 0.0);
    se3di_save_number_but(s, "poisson", def.poisson, standard.poisson);
    se3di_save_number_but(s, "cohesion", def.cohesion, 0.0);
    se3di_save_number_but(s, "adhesion", def.adhesion, 0.0);
    save_choice(s, "damping_ratio", def.damping_ratio);
    save_choice(s, "damping_rate", def.damping_rate);
    save_choice(s, "tangential_damping", def.tangential_damping);
    save_choice(s, "rolling_ratio", def.rolling_ratio);
    save_choice(s, "rolling_damping", def.rolling_damping);
    save_choice(s, "tangential_stiffness", def.tangential_stiffness);
    save_choice(s, "rolling_stiffness", def.rolling_stiffness);
}

void se3di_save_materials(se3di_save *s)
{
    se3di_save_begin_section(s, "materials");
    for (size_t k = 0; k < se3d_system_count_materials(s->system); ++k) {
        se3d_material material;
        (void)se3d_system_get_material(s->system, k, &material);
        const se3di_save_entry entry = se3di_save_open(s);
        save_material(s, material);
        (void)se3di_save_close(s, &entry);
    }
}

/* By se3d_contact_law. */
static const char *const laws[] = {"hooke", "hertz_mindlin"};

static bool save_pair(se3di_save *s, se3d_material a, se3d_material b)
{
    se3d_material_pair_def def = se3d_material_pair_def_default();
    (void)se3d_material_get_pair(s->system, a, b, &def);
    const struct {
        const char *key;
        double value;
    } values[] = {{"friction", def.friction},
                  {"restitution", def.restitution},
                  {"rolling_friction", def.rolling_friction},
                  {"torsional_friction", def.torsional_friction},
                  {"stiffness", def.stiffness},
                  {"cohesion", def.cohesion},
                  {"adhesion", def.adhesion},
                  {"damping_ratio", def.damping_ratio},
                  {"damping_rate", def.damping_rate},
                  {"tangential_ratio", def.tangential_ratio},
                  {"tangential_damping", def.tangential_damping},
                  {"rolling_ratio", def.rolling_ratio},
                  {"rolling_damping", def.rolling_damping},
                  {"young", def.young},
                  {"poisson", def.poisson},
                  {"tangential_stiffness", def.tangential_stiffness},
                  {"rolling_stiffness", def.rolling_stiffness}};
    bool any = def.law >= 0;
    for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
        any = any || values[k].value >= 0.0;
    }
    if (!any) {
        return false;
    }
    se3di_save_put(s, "    - {");
    s->is_first = true;
    s->indent = "       ";
    se3di_save_text(s, "material_1", s->materials.names[a.index1]);
    se3di_save_text(s, "material_2", s->materials.names[b.index1]);
    if (def.law >= 0) {
        se3di_save_text(s, "law", laws[def.law]);
    }
    for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
        if (values[k].value >= 0.0) {
            se3di_save_number(s, values[k].key, values[k].value);
        }
    }
    se3di_save_line(s, "}");
    return true;
}

static void save_pairs(se3di_save *s)
{
    const size_t count = se3d_system_count_materials(s->system);
    const size_t before = s->out.used;
    bool any = false;
    se3di_save_line(s, "  pairs:");
    for (size_t i = 0; i < count; ++i) {
        for (size_t j = i; j < count; ++j) {
            se3d_material a, b;
            (void)se3d_system_get_material(s->system, i, &a);
            (void)se3d_system_get_material(s->system, j, &b);
            any = save_pair(s, a, b) || any;
        }
    }
    s->out.used = any || s->status < 0 ? s->out.used : before;
}

/* Of particles. */
const char *const se3di_save_domain_keys[] = {"threads", "skin",  "boundary",
                                              "lower",   "upper", NULL};

static void save_domain(se3di_save *s, const se3di_node *given)
{
    const char *const *keys = se3di_save_domain_keys;
    for (size_t k = 0; keys[k] && !se3di_save_has_units(s); ++k) {
        const se3di_node *node = given ? se3di_node_get(given, keys[k]) : NULL;
        if (node) {
            se3di_save_put(s, "  ");
            se3di_save_put(s, keys[k]);
            se3di_save_put(s, ": ");
            se3di_save_put_node(s, node);
            se3di_save_put(s, "\n");
        }
    }
}

static void put_audit(se3di_save *s)
{
    if (s->model && s->model->particles && s->model->particles->audit) {
        se3di_save_put(s, "  audit: true\n");
    }
}

void se3di_save_contact(se3di_save *s)
{
    se3d_contact_settings settings = se3d_contact_settings_default();
    (void)se3d_system_get_contact(s->system, &settings);
    const se3di_node *given = s->model ? se3di_node_get(s->model->root, "contact") : NULL;
    if (!given && (s->model || se3d_system_count_shapes(s->system) == 0)) {
        return;
    }
    se3di_save_begin_section(s, NULL);
    if (settings.law == SE3D_CONTACT_LAW_CALLBACK) {
        se3di_save_refuse(s, "the law of contact is a callback");
        const se3di_save_entry at = {s->out.used, s->out.column, NULL};
        (void)se3di_save_close(s, &at);
        return;
    }
    se3di_save_put(s, "\ncontact:\n  law: ");
    se3di_save_line(s, laws[settings.law]);
    put_audit(s);
    s->is_first = true;
    if (settings.step > 0.0) {
        se3di_save_put(s, "  ");
        se3di_save_number(s, "step", settings.step);
        se3di_save_put(s, "\n");
        s->is_first = true;
    }
    se3di_save_put(s, "  ");
    se3di_save_number(s, "overlap_limit", settings.overlap_limit);
    se3di_save_put(s, "\n");
    save_domain(s, given);
    save_pairs(s);
}
