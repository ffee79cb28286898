/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of Adams. A force along the line of two markers, or about z of J, is positive if it drives
 * the coordinate up, which is the opposite of our springs. */
#include <string.h>

#include "io/import/adams.h"

static const se3di_adams_meaning of_time = {.i = -1, .j = -1};

/* The point of a marker: by its name if it has one there. */
static void put_point(se3di_adams *a, se3di_entry *entry, const char *key,
                      const se3di_adams_marker *marker)
{
    if (marker->name) {
        se3di_entry_put_text(a->m, entry, key, marker->name);
        return;
    }
    const se3di_frame in =
        se3di_frame_in(&se3di_machine_body_at(a->m, marker->body)->frame, &marker->frame);
    se3di_entry_put_vector(a->m, entry, key, in.r);
}

static void put_axis(se3di_adams *a, se3di_entry *entry, const char *key,
                     const se3di_adams_marker *marker, int k)
{
    const se3di_frame in =
        se3di_frame_in(&se3di_machine_body_at(a->m, marker->body)->frame, &marker->frame);
    const double axis[3] = {in.A[k], in.A[3 + k], in.A[6 + k]};
    se3di_entry_put_vector(a->m, entry, key, axis);
}

static bool find_markers(se3di_adams *a, const se3di_adams_statement *s,
                         const se3di_adams_marker **i, const se3di_adams_marker **j)
{
    *i = se3di_adams_marker_of(a, s, "I");
    *j = *i ? se3di_adams_marker_of(a, s, "J") : NULL;
    return *j != NULL;
}

/* A spring of two markers: body i is that of J, body j that of I. */
static se3di_entry *add_spring(se3di_adams *a, se3di_adams_statement *s, bool turns,
                               const se3di_adams_marker *i, const se3di_adams_marker *j)
{
    s->made = se3di_adams_name(a, s);
    se3di_entry *entry = s->made ? se3di_machine_add(a->m, SE3DI_SECTION_FORCES) : NULL;
    se3di_entry_put_text(a->m, entry, "name", s->made);
    se3di_entry_put(a->m, entry, "type", turns ? "rsda" : "tsda");
    se3di_entry_put_text(a->m, entry, "body_i", se3di_machine_body_name(a->m, j->body));
    se3di_entry_put_text(a->m, entry, "body_j", se3di_machine_body_name(a->m, i->body));
    if (turns) {
        put_axis(a, entry, "axis_i", j, 2);
        put_axis(a, entry, "ref_i", j, 0);
        put_axis(a, entry, "ref_j", i, 0);
    } else {
        put_point(a, entry, "point_i", j);
        put_point(a, entry, "point_j", i);
    }
    return entry;
}

bool se3di_adams_sforce(se3di_adams *a, se3di_adams_statement *s)
{
    const se3di_adams_marker *i;
    const se3di_adams_marker *j;
    const bool turns = se3di_adams_has(s, "ROTATIONAL") || se3di_adams_has(s, "ROTATION");
    const char *text = se3di_adams_get(s, "FUNCTION");
    const char *why = "it has no FUNCTION";
    if (!find_markers(a, s, &i, &j)) {
        return false;
    }
    if (se3di_adams_has(s, "ACTIONONLY") || i->body == j->body) {
        return se3di_adams_lose(a, s, "a force that acts on one part only");
    }
    const se3di_adams_meaning meaning = {.i = i->statement->id,
                                         .j = j->statement->id,
                                         .distance = turns ? NULL : "l",
                                         .speed = turns ? NULL : "ldot",
                                         .angle = turns ? "theta" : NULL,
                                         .turning = turns ? "thetadot" : NULL};
    const char *value = text ? se3di_adams_translate(a, text, &meaning, &why) : NULL;
    if (!value) {
        return a->m->status >= 0 && se3di_adams_lose(a, s, why);
    }
    se3di_entry *entry = add_spring(a, s, turns, i, j);
    const double unit = turns ? a->force * a->length : a->force;
    se3di_entry_put(a->m, entry, "h",
                    unit == 1.0 ? se3di_machine_text(a->m, "'-(%s)'", value)
                                : se3di_machine_text(a->m, "'-%.15g*(%s)'", unit, value));
    return a->m->status >= 0;
}

bool se3di_adams_springdamper(se3di_adams *a, se3di_adams_statement *s)
{
    const se3di_adams_marker *i;
    const se3di_adams_marker *j;
    const bool turns = se3di_adams_has(s, "ROTATIONAL") || se3di_adams_has(s, "ROTATION");
    double k = 0.0;
    double c = 0.0;
    double free = 0.0;
    double preload = 0.0;
    const double force = turns ? a->force * a->length : a->force;
    const double way = turns ? 1.0 : a->length;
    if (!find_markers(a, s, &i, &j) ||
        !se3di_adams_number(a, s, turns ? "KT" : "K", force / way, &k) ||
        !se3di_adams_number(a, s, turns ? "CT" : "C", force / way * a->time, &c) ||
        !se3di_adams_number(a, s, turns ? "ANGLE" : "LENGTH", way, &free) ||
        !se3di_adams_number(a, s, turns ? "TORQUE" : "FORCE", force, &preload)) {
        return false;
    }
    if (i->body == j->body) {
        return se3di_adams_lose(a, s, "both markers are on one part");
    }
    if (!turns && free < 0.0) {
        return se3di_adams_lose(a, s, "its LENGTH is negative");
    }
    se3di_entry *entry = add_spring(a, s, turns, i, j);
    se3di_entry_put_number(a->m, entry, "k", k);
    se3di_entry_put_number(a->m, entry, "c", c);
    se3di_entry_put_number(a->m, entry, turns ? "theta0" : "l0", free);
    if (preload != 0.0) {
        se3di_entry_put_number(a->m, entry, "preload", -preload);
    }
    return a->m->status >= 0;
}

static void put_orientation(se3di_adams *a, se3di_entry *entry, const char *key,
                            const se3di_adams_marker *marker)
{
    const se3di_frame in =
        se3di_frame_in(&se3di_machine_body_at(a->m, marker->body)->frame, &marker->frame);
    const char *rows[3];
    for (int k = 0; k < 3; ++k) {
        rows[k] = se3di_machine_numbers(a->m, in.A + 3 * k, 3);
    }
    if (rows[0] && rows[1] && rows[2]) {
        se3di_entry_put(
            a->m, entry, key,
            se3di_machine_text(a->m, "{matrix: [%s, %s, %s]}", rows[0], rows[1], rows[2]));
    }
}

bool se3di_adams_bushing(se3di_adams *a, se3di_adams_statement *s)
{
    static const char *const keys[4] = {"K", "KT", "C", "CT"};
    const se3di_adams_marker *i;
    const se3di_adams_marker *j;
    double values[4][3] = {{0.0}};
    double preload[2][3] = {{0.0}};
    int count;
    const double scale[4] = {a->force / a->length, a->force * a->length,
                             a->force / a->length * a->time, a->force * a->length * a->time};
    if (!find_markers(a, s, &i, &j)) {
        return false;
    }
    for (int k = 0; k < 4; ++k) {
        if (!se3di_adams_numbers(a, s, keys[k], values[k], 3, &count)) {
            return false;
        }
        for (int n = 0; n < 3; ++n) {
            values[k][n] *= scale[k];
        }
    }
    if (!se3di_adams_numbers(a, s, "FORCE", preload[0], 3, &count) ||
        !se3di_adams_numbers(a, s, "TORQUE", preload[1], 3, &count)) {
        return false;
    }
    if (se3di_length(preload[0]) > 0.0 || se3di_length(preload[1]) > 0.0 || i->body == j->body) {
        return se3di_adams_lose(
            a, s, i->body == j->body ? "both markers are on one part" : "a bushing with a preload");
    }
    const double K[6] = {values[0][0], values[0][1], values[0][2],
                         values[1][0], values[1][1], values[1][2]};
    const double C[6] = {values[2][0], values[2][1], values[2][2],
                         values[3][0], values[3][1], values[3][2]};
    s->made = se3di_adams_name(a, s);
    se3di_entry *entry = s->made ? se3di_machine_add(a->m, SE3DI_SECTION_FORCES) : NULL;
    se3di_entry_put_text(a->m, entry, "name", s->made);
    se3di_entry_put(a->m, entry, "type", "bushing");
    se3di_entry_put_text(a->m, entry, "body_i", se3di_machine_body_name(a->m, j->body));
    se3di_entry_put_text(a->m, entry, "body_j", se3di_machine_body_name(a->m, i->body));
    put_point(a, entry, "point_i", j);
    put_point(a, entry, "point_j", i);
    put_orientation(a, entry, "orientation_i", j);
    put_orientation(a, entry, "orientation_j", i);
    se3di_entry_put(a->m, entry, "K", se3di_machine_numbers(a->m, K, 6));
    se3di_entry_put(a->m, entry, "C", se3di_machine_numbers(a->m, C, 6));
    return a->m->status >= 0;
}

/* Components of a load along the axes of RM, as functions of time, in the frame of the entry. */
static const char *load_value(se3di_adams *a, const se3di_adams_statement *s, bool torque,
                              const double A[9], bool *any, const char **why)
{
    static const char *const keys[2][3] = {{"FX", "FY", "FZ"}, {"TX", "TY", "TZ"}};
    const char *in[3];
    const char *out[3];
    const double unit = torque ? a->force * a->length : a->force;
    *any = false;
    for (int k = 0; k < 3; ++k) {
        const char *text = se3di_adams_get(s, keys[torque][k]);
        in[k] = text ? se3di_adams_translate(a, text, &of_time, why) : "0";
        if (!in[k]) {
            return NULL;
        }
        *any = *any || strcmp(in[k], "0") != 0;
    }
    for (int i = 0; i < 3; ++i) {
        out[i] = "";
        for (int k = 0; out[i] && k < 3; ++k) {
            const double factor = A[3 * i + k] * unit;
            const bool none = (factor < 1e-14 && factor > -1e-14) || strcmp(in[k], "0") == 0;
            const char *plus = out[i][0] ? " + " : "";
            out[i] = none ? out[i]
                     : factor == 1.0
                         ? se3di_machine_text(a->m, "%s%s(%s)", out[i], plus, in[k])
                         : se3di_machine_text(a->m, "%s%s%.15g*(%s)", out[i], plus, factor, in[k]);
        }
    }
    return out[0] && out[1] && out[2]
               ? se3di_machine_text(a->m, "['%s', '%s', '%s']", out[0][0] ? out[0] : "0",
                                    out[1][0] ? out[1] : "0", out[2][0] ? out[2] : "0")
               : NULL;
}

static bool add_load(se3di_adams *a, se3di_adams_statement *s, bool torque,
                     const se3di_adams_marker *i, bool of_body, const double A[9])
{
    bool any = false;
    const char *why = "no memory";
    const char *value = load_value(a, s, torque, A, &any, &why);
    if (!value) {
        return a->m->status >= 0 && se3di_adams_lose(a, s, why);
    }
    if (!any) {
        return true;
    }
    s->made = se3di_adams_name(a, s);
    se3di_entry *entry = s->made ? se3di_machine_add(a->m, SE3DI_SECTION_FORCES) : NULL;
    se3di_entry_put_text(a->m, entry, "name", s->made);
    se3di_entry_put(a->m, entry, "type", torque ? "torque" : "force");
    se3di_entry_put_text(a->m, entry, "body", se3di_machine_body_name(a->m, i->body));
    if (!torque) {
        put_point(a, entry, "point", i);
    }
    if (of_body) {
        se3di_entry_put(a->m, entry, "frame", "body");
    }
    se3di_entry_put(a->m, entry, "value", value);
    return a->m->status >= 0;
}

/* GFORCE, VFORCE, VTORQUE on a part, with the ground as what they push from. */
bool se3di_adams_gforce(se3di_adams *a, se3di_adams_statement *s)
{
    const se3di_adams_marker *i = se3di_adams_marker_of(a, s, "I");
    double id = -1.0;
    if (!i || !se3di_adams_number(a, s, "JFLOAT", 1.0, &id)) {
        return false;
    }
    const se3di_adams_marker *j = id >= 0.0 && id < 1e9 ? se3di_adams_marker_at(a, (long)id) : NULL;
    if ((j && j->body != SE3DI_GROUND) || i->body == SE3DI_GROUND) {
        return se3di_adams_lose(a, s, "it acts between two parts that move");
    }
    const se3di_adams_marker *rm =
        se3di_adams_has(s, "RM") ? se3di_adams_marker_of(a, s, "RM") : NULL;
    if (!rm && se3di_adams_has(s, "RM")) {
        return false;
    }
    if (rm && rm->body != SE3DI_GROUND && rm->body != i->body) {
        return se3di_adams_lose(a, s, "its RM is on a third part");
    }
    const bool of_body = rm && rm->body == i->body;
    se3di_frame axes = se3di_frame_identity();
    if (of_body) {
        axes = se3di_frame_in(&se3di_machine_body_at(a->m, i->body)->frame, &rm->frame);
    } else if (rm) {
        axes = rm->frame;
    }
    return add_load(a, s, false, i, of_body, axes.A) && add_load(a, s, true, i, of_body, axes.A);
}
