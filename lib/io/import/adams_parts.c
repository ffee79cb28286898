/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts and markers of Adams: a body has the axes of its part's centre-of-mass marker. */
#include <stdio.h>
#include <string.h>

#include "io/import/adams.h"
#include "io/import/inertia.h"

#define LIGHT 1e-9 /* kg, of a part without mass */

/* Turns about z, the new x and the new z. */
static void turn_by_313(const double angles[3], double A[9])
{
    static const double axes[3][3] = {{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    double R[9];
    se3di_turn_about(axes[0], angles[0], A);
    for (int k = 1; k < 3; ++k) {
        se3di_turn_about(axes[k], angles[k], R);
        se3di_turn_multiply(A, R, A);
    }
}

/* Origin and axes by an origin, and Euler angles or points on z and in the plane of x and z. */
static bool read_frame(se3di_adams *a, const se3di_adams_statement *s, const char *const keys[3],
                       se3di_frame *frame)
{
    double angles[3] = {0.0, 0.0, 0.0};
    double zp[3];
    double xp[3];
    int count[4];
    *frame = se3di_frame_identity();
    if (!se3di_adams_numbers(a, s, keys[0], frame->r, 3, &count[0]) ||
        !se3di_adams_numbers(a, s, "REULER", angles, 3, &count[1]) ||
        !se3di_adams_numbers(a, s, keys[1], zp, 3, &count[2]) ||
        !se3di_adams_numbers(a, s, keys[2], xp, 3, &count[3])) {
        return false;
    }
    turn_by_313(angles, frame->A);
    for (int k = 0; k < 3; ++k) {
        zp[k] = count[2] == 3 ? zp[k] - frame->r[k] : k == 2;
        xp[k] = count[3] == 3 ? xp[k] - frame->r[k] : k == 0;
    }
    if (count[2] == 3 || count[3] == 3) {
        const bool along = count[3] == 3 ? se3di_turn_along_both(zp, xp, frame->A)
                                         : se3di_turn_along_both(zp, xp, frame->A) ||
                                               se3di_turn_along(zp, frame->A);
        if (!along) {
            return se3di_machine_fail(a->m, s->line, 1, "%s/%ld: %s and %s give no axes", s->word,
                                      s->id, keys[1], keys[2]);
        }
    }
    for (int k = 0; k < 3; ++k) {
        frame->r[k] *= a->length;
    }
    return true;
}

static bool part_frame(se3di_adams *a, const se3di_adams_statement *s, se3di_frame *frame)
{
    static const char *const keys[3] = {"QG", "ZG", "XG"};
    return read_frame(a, s, keys, frame);
}

static bool marker_frame(se3di_adams *a, const se3di_adams_statement *s, se3di_frame *frame)
{
    static const char *const keys[3] = {"QP", "ZP", "XP"};
    return read_frame(a, s, keys, frame);
}

/* The frame of a marker of the part in the ground, by the key of its number; that of the part if
 * the key is not there. */
static bool frame_by_key(se3di_adams *a, const se3di_adams_statement *part, const char *key,
                         const se3di_frame *of_part, se3di_frame *frame)
{
    double id = -1.0;
    *frame = *of_part;
    if (!se3di_adams_number(a, part, key, 1.0, &id)) {
        return false;
    }
    if (id < 0.0) {
        return true;
    }
    const se3di_adams_statement *s = id < 1e9 ? se3di_adams_find(a, "MARKER", (long)id) : NULL;
    se3di_frame in;
    if (!s) {
        return se3di_machine_fail(a->m, part->line, 1,
                                  "PART/%ld: %s must be the number of a MARKER", part->id, key);
    }
    if (!marker_frame(a, s, &in)) {
        return false;
    }
    *frame = se3di_frame_of(of_part, &in);
    return true;
}

/* The inertia about the centre of mass, in axes there; IP holds positive integrals of products. */
static bool read_inertia(se3di_adams *a, const se3di_adams_statement *s, const se3di_frame *cm,
                         const se3di_frame *im, se3di_machine_body *body)
{
    double ip[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    int count;
    if (!se3di_adams_numbers(a, s, "IP", ip, 6, &count)) {
        return false;
    }
    const double unit = a->mass * a->length * a->length;
    se3di_mass mass = {.mass = body->mass,
                       .J = {ip[0], -ip[3], -ip[4], -ip[3], ip[1], -ip[5], -ip[4], -ip[5], ip[2]}};
    for (int k = 0; k < 9; ++k) {
        mass.J[k] *= unit;
    }
    const se3di_frame in = se3di_frame_in(cm, im);
    mass = se3di_mass_of(&in, &mass);
    /* what is about the inertia marker is more than what is about the centre of mass */
    const double *d = in.r;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            mass.J[3 * i + j] -= body->mass * ((i == j ? se3di_dot(d, d) : 0.0) - d[i] * d[j]);
        }
    }
    memcpy(body->J, mass.J, sizeof body->J);
    return true;
}

static bool read_velocity(se3di_adams *a, const se3di_adams_statement *s,
                          const se3di_frame *of_part, const se3di_frame *cm,
                          se3di_machine_body *body)
{
    static const char *const keys[6] = {"VX", "VY", "VZ", "WX", "WY", "WZ"};
    double v[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    se3di_frame vm;
    se3di_frame wm;
    for (int k = 0; k < 6; ++k) {
        if (!se3di_adams_number(a, s, keys[k], (k < 3 ? a->length : 1.0) / a->time, &v[k])) {
            return false;
        }
    }
    if (!frame_by_key(a, s, "VM", of_part, &vm) || !frame_by_key(a, s, "WM", of_part, &wm)) {
        return false;
    }
    memcpy(body->v, v, sizeof body->v);
    if (se3di_adams_has(s, "VM")) {
        se3di_turn(vm.A, v, body->v);
    }
    se3di_turn(se3di_adams_has(s, "WM") ? wm.A : cm->A, v + 3, body->w);
    se3di_turn_back(cm->A, body->w, body->w);
    return true;
}

static bool make_part(se3di_adams *a, se3di_adams_statement *s)
{
    se3di_machine *m = a->m;
    se3di_frame of_part;
    se3di_frame cm;
    se3di_frame im;
    if (se3di_adams_has(s, "GROUND")) {
        s->made = "ground";
        return true;
    }
    if (!part_frame(a, s, &of_part) || !frame_by_key(a, s, "CM", &of_part, &cm)) {
        return false;
    }
    im = cm;
    if (se3di_adams_has(s, "IM") && !frame_by_key(a, s, "IM", &of_part, &im)) {
        return false;
    }
    const char *wanted = s->name ? s->name : se3di_machine_text(m, "part_%ld", s->id);
    s->made = wanted ? se3di_machine_name_body(m, wanted, "part", s->line) : NULL;
    s->index = m->body_count;
    se3di_machine_body *body = s->made ? se3di_machine_add_body(m, s->made) : NULL;
    if (!body || !se3di_adams_number(a, s, "MASS", a->mass, &body->mass)) {
        return false;
    }
    body->frame = cm;
    if (body->mass > 0.0) {
        return read_inertia(a, s, &cm, &im, body) && read_velocity(a, s, &of_part, &cm, body) &&
               se3di_inertia_mend(m, s->made, s->line, body->mass, body->J);
    }
    body->mass = LIGHT;
    body->J[0] = body->J[4] = body->J[8] = LIGHT;
    se3di_machine_note_of(m, SE3D_IMPORT_CHANGED, s->line,
                          "`%s` has no mass; it gets 1e-9 kg and 1e-9 kg m^2", s->made);
    return read_velocity(a, s, &of_part, &cm, body);
}

static bool make_marker(se3di_adams *a, se3di_adams_statement *s, const se3di_adams_statement *part)
{
    double id = -1.0;
    se3di_frame of_part;
    se3di_frame in;
    if (!se3di_adams_number(a, s, "PART", 1.0, &id)) {
        return false;
    }
    part = id >= 0.0 && id < 1e9 ? se3di_adams_find(a, "PART", (long)id) : part;
    if (!part) {
        if (se3di_adams_has(s, "PART") || !se3di_adams_has(s, "POINT_MASS")) {
            return se3di_machine_fail(a->m, s->line, 1, "MARKER/%ld is on no PART", s->id);
        }
        return true;
    }
    if (!part_frame(a, part, &of_part) || !marker_frame(a, s, &in)) {
        return false;
    }
    se3di_adams_marker *grown =
        se3di_iopool_grow(a->m->pool, a->markers, a->marker_count, &a->marker_room, sizeof *grown);
    if (!grown) {
        return se3di_machine_fail_memory(a->m);
    }
    a->markers = grown;
    s->index = a->marker_count;
    se3di_adams_marker *marker = &grown[a->marker_count++];
    marker->statement = s;
    marker->body = part->index;
    marker->frame = se3di_frame_of(&of_part, &in);
    return true;
}

/* Markers that only drawings use would hide the others. */
static bool is_of_drawing(const se3di_adams *a, long id)
{
    static const char *const keys[] = {"CM", "CORNER", "I", "J", "EMARKER"};
    bool drawn = false;
    for (const se3di_adams_statement *s = a->first; s; s = s->next) {
        for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k) {
            const char *text = se3di_adams_get(s, keys[k]);
            long number = -1;
            if (text && sscanf(text, "%9ld", &number) == 1 && number == id) {
                if (strcmp(s->word, "GRAPHICS") != 0) {
                    return false;
                }
                drawn = true;
            }
        }
    }
    return drawn;
}

static bool put_markers(se3di_adams *a)
{
    se3di_machine *m = a->m;
    const bool few = a->marker_count * a->count < 4000000; /* else all are there */
    for (size_t k = 0; k < a->marker_count; ++k) {
        se3di_adams_marker *marker = &a->markers[k];
        const se3di_adams_statement *s = marker->statement;
        if (few && is_of_drawing(a, s->id)) {
            continue;
        }
        const char *name = s->name ? s->name : se3di_machine_text(m, "marker_%ld", s->id);
        const se3di_frame in =
            se3di_frame_in(&se3di_machine_body_at(m, marker->body)->frame, &marker->frame);
        const se3di_machine_marker *made =
            name ? se3di_machine_add_marker(m, marker->body, name, &in) : NULL;
        if (!made) {
            return false;
        }
        marker->name = made->name;
    }
    return true;
}

typedef struct drawing {
    const char *flag;    /* of GRAPHICS */
    const char *type;    /* of a shape */
    const char *marker;  /* the key of its marker */
    const char *keys[3]; /* of its size */
} drawing;

static const drawing drawings[] = {
    {"BOX", "box", "CORNER", {"X", "Y", "Z"}},
    {"CYLINDER", "cylinder", "CM", {"LENGTH", "RADIUS", "LENGTH"}},
    {"ELLIPSOID", "ellipsoid", "CM", {"XSCALE", "YSCALE", "ZSCALE"}}};

/* The shape of these sizes, and where its centre is seen from the marker. @return whether there is
 * one. */
static bool make_shape(const drawing *d, const double size[3], se3di_machine_shape *shape,
                       double centre[3])
{
    if (!(size[0] > 0.0 && size[1] > 0.0 && size[2] > 0.0)) {
        return false;
    }
    shape->type = d->type;
    if (d == &drawings[0]) {
        for (int k = 0; k < 3; ++k) {
            shape->size[k] = size[k];
            centre[k] = 0.5 * size[k];
        }
        return true;
    }
    if (d == &drawings[1]) {
        shape->radius = size[1];
        shape->length = size[0];
        centre[2] = 0.5 * size[0];
        return true;
    }
    if (size[0] < size[1] || size[0] > size[1] || size[0] < size[2] || size[0] > size[2]) {
        for (int k = 0; k < 3; ++k) {
            shape->size[k] = 0.5 * size[k];
        }
    } else {
        shape->type = "sphere";
        shape->radius = 0.5 * size[0];
    }
    return true;
}

static bool draw_as(se3di_adams *a, const se3di_adams_statement *s, const drawing *d)
{
    se3di_machine *m = a->m;
    double size[3] = {0.0, 0.0, 0.0};
    se3di_machine_shape shape = {.scale = 1.0, .color = {-1.0, 0.0, 0.0}};
    se3di_frame in = se3di_frame_identity();
    for (int k = 0; k < 3; ++k) {
        if (!se3di_adams_number(a, s, d->keys[k], a->length, &size[k])) {
            return false;
        }
    }
    const se3di_adams_marker *marker = se3di_adams_marker_of(a, s, d->marker);
    if (!marker) {
        return false;
    }
    if (!make_shape(d, size, &shape, in.r)) {
        return true;
    }
    in = se3di_frame_of(&marker->frame, &in);
    shape.frame = se3di_frame_in(&se3di_machine_body_at(m, marker->body)->frame, &in);
    se3di_machine_shape *to = se3di_machine_add_shape(m, marker->body);
    if (to) {
        *to = shape; /* the last of its list: it has no next */
    }
    return to != NULL;
}

/* What is no such shape is drawn nowhere: it is no part of the mechanism. */
static bool draw(se3di_adams *a, const se3di_adams_statement *s)
{
    for (size_t k = 0; k < sizeof drawings / sizeof *drawings; ++k) {
        if (se3di_adams_has(s, drawings[k].flag) && se3di_adams_has(s, drawings[k].marker)) {
            return draw_as(a, s, &drawings[k]);
        }
    }
    return true;
}

bool se3di_adams_parts(se3di_adams *a)
{
    const se3di_adams_statement *part = NULL;
    for (se3di_adams_statement *s = a->first; s; s = s->next) {
        if (strcmp(s->word, "PART") == 0 && !make_part(a, s)) {
            return false;
        }
    }
    for (se3di_adams_statement *s = a->first; s; s = s->next) {
        part = strcmp(s->word, "PART") == 0 ? s : part;
        if (strcmp(s->word, "MARKER") == 0 && !make_marker(a, s, part)) {
            return false;
        }
    }
    for (se3di_adams_statement *s = a->first; s; s = s->next) {
        if (strcmp(s->word, "GRAPHICS") == 0 && !draw(a, s)) {
            return false;
        }
    }
    return put_markers(a);
}
