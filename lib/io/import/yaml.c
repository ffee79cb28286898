/* SPDX-License-Identifier: BSD-3-Clause */
/* A machine as a model file that a person can read: one entry of a section is one map, broken at
 * 110 characters. */
#include "io/import/yaml.h"

#include "io/import/material.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 110 };

typedef struct writer {
    se3di_machine *m;
    se3di_iotext out;
    bool failed;
} writer;

static void put(writer *w, const char *text)
{
    w->failed = w->failed || !text || !se3di_iotext_put(&w->out, w->m->pool, text);
}

/* A comment, each of its lines as far as it goes. */
static void put_comment(writer *w, const char *indent, const char *text)
{
    while (text && *text) {
        const size_t room = WIDTH - strlen(indent) - 2;
        size_t length = strcspn(text, "\n");
        if (length > room) {
            size_t cut = room;
            while (cut > 0 && text[cut] != ' ') {
                --cut;
            }
            length = cut > 0 ? cut : strcspn(text, " \n"); /* a word that is too long stays whole */
        }
        char *line = se3di_iopool_copy(w->m->pool, text, length);
        if (line) {
            se3di_machine_clean(line);
        }
        put(w, indent);
        put(w, "# ");
        put(w, line);
        put(w, "\n");
        text += length + strspn(text + length, " ");
        text += *text == '\n';
    }
}

static void put_pair(writer *w, const char *indent, const char *key, const char *value, bool first)
{
    if (value && !first) {
        if (w->out.column + strlen(key) + strlen(value) + 4 > WIDTH) {
            put(w, ",\n");
            put(w, indent);
        } else {
            put(w, ", ");
        }
    }
    put(w, key);
    put(w, ": ");
    put(w, value);
}

static void put_entry(writer *w, const se3di_entry *entry)
{
    put_comment(w, "  ", entry->comment);
    put(w, "  - {");
    for (const se3di_pair *pair = entry->first; pair; pair = pair->next) {
        put_pair(w, "     ", pair->key, pair->value, pair == entry->first);
    }
    put(w, "}\n");
}

static void put_sections(writer *w)
{
    static const char *const titles[SE3DI_SECTION_COUNT] = {"joints", "drivers", "constraints",
                                                            "forces"};
    for (int k = 0; k < SE3DI_SECTION_COUNT; ++k) {
        const se3di_entry *entry = w->m->entries[k];
        if (entry) {
            put(w, "\n");
            put(w, titles[k]);
            put(w, ":\n");
        }
        for (; entry; entry = entry->next) {
            put_entry(w, entry);
        }
    }
}

static bool is_turned(const double A[9])
{
    double far = 0.0;
    for (int k = 0; k < 9; ++k) {
        far = fmax(far, fabs(A[k] - (k % 4 == 0 ? 1.0 : 0.0)));
    }
    return far > 1e-15;
}

static bool is_zero(const double v[3])
{
    return v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0;
}

static void put_line(writer *w, const char *key, const char *value)
{
    put(w, "    ");
    put(w, key);
    put(w, ": ");
    put(w, value);
    put(w, "\n");
}

static void put_marker(writer *w, const se3di_machine_marker *marker)
{
    se3di_machine *m = w->m;
    put(w, "      - {");
    put_pair(w, "         ", "name", se3di_machine_quote(m, marker->name), true);
    if (!is_zero(marker->frame.r)) {
        put_pair(w, "         ", "position", se3di_machine_numbers(m, marker->frame.r, 3), false);
    }
    if (is_turned(marker->frame.A)) {
        put_pair(w, "         ", "orientation", se3di_machine_turn_text(m, marker->frame.A), false);
    }
    put(w, "}\n");
}

/* Each edge for itself: none may round to 0 beside the others. */
static const char *edges_text(se3di_machine *m, const double size[3])
{
    const char *a = se3di_machine_number(m, size[0]);
    const char *b = se3di_machine_number(m, size[1]);
    const char *c = se3di_machine_number(m, size[2]);
    return a && b && c ? se3di_machine_text(m, "[%s, %s, %s]", a, b, c) : NULL;
}

static void put_shape(writer *w, const se3di_machine_shape *shape)
{
    static const char indent[] = "         ";
    se3di_machine *m = w->m;
    put(w, "      - {");
    put_pair(w, indent, "type", shape->type, true);
    if (strcmp(shape->type, "box") == 0) {
        put_pair(w, indent, "size", edges_text(m, shape->size), false);
    } else if (strcmp(shape->type, "ellipsoid") == 0) {
        put_pair(w, indent, "semi_axes", edges_text(m, shape->size), false);
    }
    if (shape->radius > 0.0) {
        put_pair(w, indent, "radius", se3di_machine_number(m, shape->radius), false);
    }
    if (shape->length > 0.0) {
        put_pair(w, indent, "length", se3di_machine_number(m, shape->length), false);
    }
    if (shape->file) {
        put_pair(w, indent, "file", se3di_machine_quote(m, shape->file), false);
    }
    if (shape->scale < 1.0 || shape->scale > 1.0) {
        put_pair(w, indent, "scale", se3di_machine_number(m, shape->scale), false);
    }
    if (!is_zero(shape->frame.r)) {
        put_pair(w, indent, "position", se3di_machine_numbers(m, shape->frame.r, 3), false);
    }
    if (is_turned(shape->frame.A)) {
        put_pair(w, indent, "orientation", se3di_machine_turn_text(m, shape->frame.A), false);
    }
    if (shape->color[0] >= 0.0) {
        put_pair(w, indent, "color", se3di_machine_numbers(m, shape->color, 3), false);
    }
    if (shape->material) {
        put_pair(w, indent, "material", se3di_machine_quote(m, shape->material), false);
    }
    if (shape->passes || (m->materials && !shape->material)) {
        put_pair(w, indent, "contact", "false", false);
    } else if (shape->group > 0) {
        put_pair(w, indent, "group", se3di_machine_text(m, "%u", shape->group), false);
        put_pair(w, indent, "mask", se3di_machine_text(m, "%u", shape->mask), false);
    }
    put(w, "}\n");
}

static void put_parts(writer *w, const se3di_machine_parts *parts)
{
    if (parts->markers) {
        put(w, "    markers:\n");
    }
    for (const se3di_machine_marker *at = parts->markers; at; at = at->next) {
        put_marker(w, at);
    }
    if (parts->shapes) {
        put(w, "    shapes:\n");
    }
    for (const se3di_machine_shape *at = parts->shapes; at; at = at->next) {
        put_shape(w, at);
    }
}

static void put_inertia(writer *w, const double J[9])
{
    const double six[6] = {
        J[0], J[4], J[8], 0.5 * (J[1] + J[3]), 0.5 * (J[5] + J[7]), 0.5 * (J[2] + J[6])};
    const double largest = fmax(fabs(six[0]), fmax(fabs(six[1]), fabs(six[2])));
    bool diagonal = true;
    for (int k = 3; k < 6; ++k) {
        diagonal = diagonal && fabs(six[k]) <= 1e-15 * largest;
    }
    put_line(w, "inertia", se3di_machine_numbers(w->m, six, diagonal ? 3 : 6));
}

static void put_body(writer *w, const se3di_machine_body *body)
{
    se3di_machine *m = w->m;
    put_comment(w, "  ", body->comment);
    put(w, "  - name: ");
    put(w, se3di_machine_quote(m, body->name));
    put(w, "\n");
    if (body->fixed) {
        put_line(w, "fixed", "true");
    } else {
        put_line(w, "mass", se3di_machine_number(m, body->mass));
        put_inertia(w, body->J);
    }
    if (!is_zero(body->frame.r)) {
        put_line(w, "position", se3di_machine_numbers(m, body->frame.r, 3));
    }
    if (is_turned(body->frame.A)) {
        put_line(w, "orientation", se3di_machine_turn_text(m, body->frame.A));
    }
    if (!is_zero(body->v)) {
        put_line(w, "velocity", se3di_machine_numbers(m, body->v, 3));
    }
    if (!is_zero(body->w)) {
        put_line(w, "angular_velocity", se3di_machine_numbers(m, body->w, 3));
    }
    put_parts(w, &body->parts);
}

static void put_bodies(writer *w)
{
    se3di_machine *m = w->m;
    const bool ground = m->ground.parts.shapes || m->ground.parts.markers;
    if (m->body_count > 0 || ground) {
        put(w, "\nbodies:\n");
    }
    if (ground) {
        put(w, "  - name: ground\n");
        put_parts(w, &m->ground.parts);
    }
    for (size_t k = 0; k < m->body_count; ++k) {
        put_body(w, &m->bodies[k]);
    }
}

/* What a person should know who reads the file. */
static void put_notes(writer *w)
{
    static const char *const words[] = {"", "Not carried", "Changed", "Named", "Note"};
    size_t shown = 0;
    for (const se3di_machine_note *note = w->m->notes; note && shown < 100; note = note->next) {
        const char *kind = words[note->kind];
        put_comment(w, "",
                    note->line > 0 ? se3di_machine_text(w->m, "%s, line %zu: %s.", kind, note->line,
                                                        note->text)
                                   : se3di_machine_text(w->m, "%s: %s.", kind, note->text));
        ++shown;
    }
    if (w->m->note_count > shown) {
        put_comment(w, "", se3di_machine_text(w->m, "%zu more notes.", w->m->note_count - shown));
    }
}

static void put_head(writer *w)
{
    se3di_machine *m = w->m;
    const char *base = strrchr(m->file, '/');
    put(w, "se3d: 1\n");
    if (m->title && m->title[0]) {
        put(w, "title: ");
        put(w, se3di_machine_quote(m, m->title));
        put(w, "\n");
    }
    put_comment(w, "",
                se3di_machine_text(m, "Imported from %s (%s), in SI units and radians.",
                                   base ? base + 1 : m->file, m->format));
    put_notes(w);
    put(w, "gravity: ");
    put(w, se3di_machine_numbers(m, m->gravity, 3));
    put(w, "\n");
    if (m->parameters) {
        put(w, "\nparameters:\n");
    }
    for (const se3di_pair *at = m->parameters; at; at = at->next) {
        put(w, "  ");
        put(w, at->key);
        put(w, ": ");
        put(w, at->value);
        put(w, "\n");
    }
}

/* ---- contact ----------------------------------------------------------------------------------*/

static double mix(const se3di_machine *m, double a, double b)
{
    return m->mixing == SE3DI_MIXING_LARGEST   ? fmax(a, b)
           : m->mixing == SE3DI_MIXING_PRODUCT ? a * b
                                               : fmin(a, b);
}

/* Whether all of them say how they deform: then they do so as Hertz has it. */
static bool is_hertzian(const se3di_machine *m)
{
    for (const se3di_machine_material *at = m->materials; at; at = at->next) {
        if (!(at->young > 0.0)) {
            return false;
        }
    }
    return m->materials != NULL;
}

static void put_material(writer *w, const se3di_machine_material *one, bool hertzian)
{
    static const char indent[] = "     ";
    se3di_machine *m = w->m;
    put(w, "  - {");
    put_pair(w, indent, "name", se3di_machine_quote(m, one->name), true);
    put_pair(w, indent, "density", "1000", false); /* bodies have their own masses */
    put_pair(w, indent, "friction", se3di_machine_number(m, one->friction), false);
    put_pair(w, indent, "restitution", se3di_machine_number(m, one->restitution), false);
    if (hertzian) {
        put_pair(w, indent, "young", se3di_machine_number(m, one->young), false);
        put_pair(w, indent, "poisson", se3di_machine_number(m, one->poisson), false);
    } else {
        put_pair(w, indent, "stiffness",
                 one->stiffness > 0.0 ? se3di_machine_number(m, one->stiffness)
                                      : "contact_stiffness",
                 false);
    }
    put(w, "}\n");
}

/* Two materials whose mean would be another than the program's. */
static void put_mixed(writer *w, const se3di_machine_material *a, const se3di_machine_material *b,
                      bool *any)
{
    se3di_machine *m = w->m;
    const char *indent = m->touches_later ? "#        " : "       ";
    const double friction = mix(m, a->friction, b->friction);
    const double restitution = fmax(mix(m, a->restitution, b->restitution), 0.01);
    const char *sign = m->touches_later ? "# " : "";
    if (!*any) {
        put(w, sign);
        put(w, "  pairs:\n");
    }
    *any = true;
    put(w, sign);
    put(w, "    - {");
    put_pair(w, indent, "material_1", se3di_machine_quote(m, a->name), true);
    put_pair(w, indent, "material_2", se3di_machine_quote(m, b->name), false);
    put_pair(w, indent, "friction", se3di_machine_number(m, friction), false);
    put_pair(w, indent, "restitution", se3di_machine_number(m, restitution), false);
    put(w, "}\n");
}

static void put_contact(writer *w)
{
    const se3di_machine *m = w->m;
    const bool hertzian = is_hertzian(m);
    bool any = false;
    if (!m->materials) {
        return;
    }
    put(w, "\nmaterials:\n");
    for (const se3di_machine_material *at = m->materials; at; at = at->next) {
        put_material(w, at, hertzian);
    }
    put(w, m->touches_later ? "\n# contact:\n#   law: " : "\ncontact:\n  law: ");
    put(w, hertzian ? "hertz_mindlin\n" : "hooke\n");
    for (const se3di_machine_material *a = m->materials; a; a = a->next) {
        for (const se3di_machine_material *b = a->next; b; b = b->next) {
            if (a->friction < b->friction || a->friction > b->friction ||
                a->restitution < b->restitution || a->restitution > b->restitution) {
                put_mixed(w, a, b, &any);
            }
        }
    }
}

/* The stiffness of materials that say none is a number to be changed. */
static void add_stiffness(se3di_machine *m)
{
    bool needed = false;
    for (const se3di_machine_material *at = m->materials; at; at = at->next) {
        needed |= !(at->stiffness > 0.0);
    }
    if (needed && !is_hertzian(m)) {
        se3di_machine_note_of(m, SE3D_IMPORT_NOTE, 0,
                              "contact is of springs: change the parameter contact_stiffness [N/m] "
                              "if bodies sink in too far, or steps become too small");
        se3di_machine_parameter(m, "contact_stiffness",
                                se3di_machine_number(m, se3di_machine_stiffness(m)));
    }
}

se3d_status se3di_machine_write(se3di_machine *m, const char **text, size_t *length)
{
    writer w = {.m = m};
    add_stiffness(m);
    put_head(&w);
    put_bodies(&w);
    put_sections(&w);
    put_contact(&w);
    put(&w, "\nanalysis: {type: dynamics, duration: ");
    put(&w, se3di_machine_number(m, m->duration));
    if (m->step > 0.0) {
        put(&w, "}\noutput:\n  - {file: results.csv, every: ");
        put(&w, se3di_machine_number(m, m->step));
    }
    put(&w, "}\n");
    *text = w.out.text;
    *length = w.out.used;
    if (m->pool->is_short || m->status < 0) {
        se3di_machine_fail_memory(m);
        return m->status;
    }
    return SE3D_OK;
}
