/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints of Adams. I moves relative to J, so that J is our body i and I our body j: angles,
 * displacements and reactions are those of the I marker. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/import/adams.h"
#include "io/import/scan.h"

static const se3di_adams_meaning of_time = {.i = -1, .j = -1};

bool se3di_adams_lose(se3di_adams *a, const se3di_adams_statement *s, const char *why)
{
    char number[24] = "";
    if (s->id >= 0) {
        snprintf(number, sizeof number, "/%ld", s->id);
    }
    se3di_machine_note_of(a->m, SE3D_IMPORT_LOST, s->line, "%s%s%s%s", s->word, number,
                          why ? ": " : "", why ? why : "");
    return true;
}

const char *se3di_adams_name(se3di_adams *a, se3di_adams_statement *s)
{
    char word[20];
    size_t length = strlen(s->word);
    for (size_t k = 0; k <= length && k < sizeof word; ++k) {
        word[k] =
            (char)(s->word[k] >= 'A' && s->word[k] <= 'Z' ? s->word[k] - 'A' + 'a' : s->word[k]);
    }
    const char *wanted = s->name ? s->name : se3di_machine_text(a->m, "%s_%ld", word, s->id);
    return wanted ? se3di_machine_name(a->m, wanted, "element", s->line) : NULL;
}

/* Turn a marker's axes so that what was its k-th axis is z. */
static se3di_frame with_z(const se3di_frame *frame, int axis)
{
    se3di_frame out = *frame;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            out.A[3 * i + k] = frame->A[3 * i + (k + axis + 1) % 3];
        }
    }
    return out;
}

static bool join(se3di_adams *a, se3di_adams_statement *s, const char *type, int axis_i, int axis_j,
                 se3di_entry **entry)
{
    const se3di_adams_marker *i = se3di_adams_marker_of(a, s, "I");
    const se3di_adams_marker *j = i ? se3di_adams_marker_of(a, s, "J") : NULL;
    if (!j) {
        return false;
    }
    if (i->body == j->body) {
        return se3di_machine_fail(a->m, s->line, 1, "%s/%ld: I and J are on one part", s->word,
                                  s->id);
    }
    const se3di_machine_joint joint = {.name = se3di_adams_name(a, s),
                                       .type = type,
                                       .body_i = j->body,
                                       .body_j = i->body,
                                       .frame_i = with_z(&j->frame, axis_j),
                                       .frame_j = with_z(&i->frame, axis_i)};
    s->made = joint.name;
    *entry = joint.name ? se3di_machine_add_joint(a->m, &joint) : NULL;
    return *entry != NULL;
}

enum { X = 0, Y = 1, Z = 2 };

bool se3di_adams_joint(se3di_adams *a, se3di_adams_statement *s)
{
    static const struct {
        const char *adams, *type;
        int axis_i, axis_j;
        bool turns, slides;
    } types[] = {{"REVOLUTE", "revolute", Z, Z, true, false},
                 {"TRANSLATIONAL", "prismatic", Z, Z, false, true},
                 {"CYLINDRICAL", "cylindrical", Z, Z, true, true},
                 {"SPHERICAL", "spherical", Z, Z, false, false},
                 {"PLANAR", "planar", Z, Z, false, false},
                 {"FIXED", "fixed", Z, Z, false, false},
                 {"SCREW", "screw", Z, Z, true, true},
                 {"UNIVERSAL", "universal", Z, Z, false, false},
                 {"HOOKE", "universal", X, Y, false, false}};
    se3di_entry *entry = NULL;
    double pitch = 0.0;
    if (se3di_adams_has(s, "RACKPIN")) {
        return true; /* later, when the joints that it relates are there */
    }
    for (size_t k = 0; k < sizeof types / sizeof *types; ++k) {
        if (!se3di_adams_has(s, types[k].adams)) {
            continue;
        }
        s->turns = types[k].turns;
        s->slides = types[k].slides;
        if (!se3di_adams_number(a, s, "PITCH", a->length, &pitch)) {
            return false;
        }
        if (strcmp(types[k].type, "screw") == 0 && !(fabs(pitch) > 0.0)) {
            return se3di_adams_lose(a, s, "a screw without PITCH");
        }
        if (!join(a, s, types[k].type, types[k].axis_i, types[k].axis_j, &entry)) {
            return false;
        }
        if (strcmp(types[k].type, "screw") == 0) {
            se3di_entry_put_number(a->m, entry, "pitch", pitch);
        }
        if (se3di_adams_has(s, "IC") || se3di_adams_has(s, "ICTRAN") ||
            se3di_adams_has(s, "ICROT")) {
            return se3di_adams_lose(a, s, "its initial conditions");
        }
        return true;
    }
    return se3di_adams_lose(a, s, "a joint of this type");
}

bool se3di_adams_jprim(se3di_adams *a, se3di_adams_statement *s)
{
    static const struct {
        const char *adams, *type;
    } types[] = {{"ATPOINT", "spherical"},      {"INLINE", "point_on_line"},
                 {"INPLANE", "point_on_plane"}, {"ORIENTATION", "orientation"},
                 {"PARALLEL_AXES", "parallel"}, {"PERPENDICULAR", "perpendicular"}};
    se3di_entry *entry = NULL;
    for (size_t k = 0; k < sizeof types / sizeof *types; ++k) {
        if (se3di_adams_has(s, types[k].adams)) {
            return join(a, s, types[k].type, Z, Z, &entry);
        }
    }
    return se3di_adams_lose(a, s, "a primitive of this type");
}

/* "DM(i, j) - length", which is the only constraint by a function that a joint is. */
bool se3di_adams_gcon(se3di_adams *a, se3di_adams_statement *s)
{
    const char *text = se3di_adams_get(s, "FUNCTION");
    long i = -1;
    long j = -1;
    double length = 0.0;
    int used = 0;
    se3di_entry *entry = NULL;
    char dm[3] = "";
    if (!text || sscanf(text, " %2[dDmM] ( %9ld , %9ld ) - %n", dm, &i, &j, &used) != 3 ||
        used == 0 || !se3di_scan_equal(dm, "DM")) {
        return se3di_adams_lose(a, s, "a constraint that is no distance DM(i, j) - length");
    }
    const size_t digits = se3di_scan_number(text + used, true, &length);
    const se3di_adams_marker *mi = se3di_adams_marker_at(a, i);
    const se3di_adams_marker *mj = se3di_adams_marker_at(a, j);
    if (digits == 0 || text[used + (int)digits] || !mi || !mj || mi->body == mj->body ||
        !(length > 0.0)) {
        return se3di_adams_lose(a, s, "a constraint that is no distance DM(i, j) - length");
    }
    const se3di_adams_marker *own = se3di_adams_marker_of(a, s, "I");
    if (!own) {
        return false;
    }
    if (own->body == mj->body) { /* what the reaction acts on is our body j */
        const se3di_adams_marker *swap = mi;
        mi = mj;
        mj = swap;
    }
    const se3di_machine_joint joint = {.name = se3di_adams_name(a, s),
                                       .type = "distance",
                                       .body_i = mj->body,
                                       .body_j = mi->body,
                                       .frame_i = mj->frame,
                                       .frame_j = mi->frame};
    s->made = joint.name;
    entry = joint.name ? se3di_machine_add_joint(a->m, &joint) : NULL;
    se3di_entry_put_number(a->m, entry, "distance", length * a->length);
    return a->m->status >= 0;
}

static se3di_adams_statement *joint_by_id(se3di_adams *a, const se3di_adams_statement *s, double id)
{
    se3di_adams_statement *joint =
        id >= 0.0 && id < 1e9 ? se3di_adams_find(a, "JOINT", (long)id) : NULL;
    if (!joint) {
        se3di_machine_fail(a->m, s->line, 1, "%s/%ld: there is no JOINT/%.0f", s->word, s->id, id);
    }
    return joint;
}

/* A function of time times the unit of what it gives. */
static const char *motion_value(se3di_adams *a, const se3di_adams_statement *s, double unit,
                                const char **why)
{
    const char *text = se3di_adams_get(s, "FUNCTION");
    const char *value = text ? se3di_adams_translate(a, text, &of_time, why) : NULL;
    if (!text) {
        *why = "it has no FUNCTION";
    }
    if (!value) {
        return NULL;
    }
    if (se3di_adams_has(s, "ACCELERATION")) {
        *why = "an acceleration: write the integral of it as the rate";
        return NULL;
    }
    return unit == 1.0 ? value : se3di_machine_text(a->m, "%.15g*(%s)", unit, value);
}

/* `value`, or `rate` and what it starts from. */
static bool put_motion(se3di_adams *a, const se3di_adams_statement *s, se3di_entry *entry,
                       double unit, const char *value)
{
    double start = 0.0;
    const char *quoted = se3di_machine_text(a->m, "'%s'", value);
    if (!se3di_adams_has(s, "VELOCITY")) {
        se3di_entry_put(a->m, entry, "value", quoted);
        return a->m->status >= 0;
    }
    if (se3di_adams_has(s, "ICDISP") && !se3di_adams_number(a, s, "ICDISP", 1.0, &start)) {
        return false;
    }
    se3di_entry_put(a->m, entry, "rate", quoted);
    se3di_entry_put_number(a->m, entry, "start", start * unit);
    return a->m->status >= 0;
}

bool se3di_adams_motion(se3di_adams *a, se3di_adams_statement *s)
{
    const bool slides = se3di_adams_has(s, "TRANSLATION") || se3di_adams_has(s, "TRANSLATIONAL");
    double id = -1.0;
    const char *why = NULL;
    if (!se3di_adams_has(s, "JOINT")) {
        return se3di_adams_lose(a, s, "a motion of markers, not of a joint");
    }
    if (!se3di_adams_number(a, s, "JOINT", 1.0, &id)) {
        return false;
    }
    const se3di_adams_statement *joint = joint_by_id(a, s, id);
    if (!joint) {
        return false;
    }
    if (!joint->made || !(slides ? joint->slides : joint->turns)) {
        return se3di_adams_lose(a, s, "its joint has no such coordinate");
    }
    const double unit = slides ? a->length : 1.0;
    const char *value =
        motion_value(a, s, se3di_adams_has(s, "VELOCITY") ? unit / a->time : unit, &why);
    if (!value) {
        return a->m->status >= 0 && se3di_adams_lose(a, s, why);
    }
    s->made = se3di_adams_name(a, s);
    se3di_entry *entry = s->made ? se3di_machine_add(a->m, SE3DI_SECTION_DRIVERS) : NULL;
    se3di_entry_put_text(a->m, entry, "name", s->made);
    se3di_entry_put_text(a->m, entry, "joint", joint->made);
    if (joint->turns && joint->slides) {
        se3di_entry_put(a->m, entry, "coordinate", slides ? "displacement" : "angle");
    }
    return put_motion(a, s, entry, unit, value);
}

typedef struct term {
    const se3di_adams_statement *joint;
    bool slides;
    double ratio;
} term;

/* Whether each joint is there once and takes part. */
static bool are_different(const term *terms, int count)
{
    for (int k = 0; k < count; ++k) {
        for (int i = 0; i < k; ++i) {
            if (terms[i].joint == terms[k].joint && terms[i].slides == terms[k].slides) {
                return false;
            }
        }
        if (!(fabs(terms[k].ratio) > 0.0)) {
            return false;
        }
    }
    return true;
}

static bool put_coupler(se3di_adams *a, se3di_adams_statement *s, const term *terms, int count)
{
    const char *text = "[";
    if (!are_different(terms, count)) {
        return se3di_adams_lose(a, s, "a joint takes part twice, or with the ratio 0");
    }
    s->made = se3di_adams_name(a, s);
    for (int k = 0; text && k < count; ++k) {
        const char *name = se3di_machine_quote(a->m, terms[k].joint->made);
        const char *ratio = se3di_machine_number(a->m, terms[k].ratio);
        const bool both = terms[k].joint->turns && terms[k].joint->slides;
        text = name && ratio ? se3di_machine_text(a->m, "%s%s{joint: %s%s, ratio: %s}", text,
                                                  k > 0 ? ", " : "", name,
                                                  !both             ? ""
                                                  : terms[k].slides ? ", coordinate: displacement"
                                                                    : ", coordinate: angle",
                                                  ratio)
                             : NULL;
    }
    se3di_entry *entry = s->made ? se3di_machine_add(a->m, SE3DI_SECTION_JOINTS) : NULL;
    se3di_entry_put_text(a->m, entry, "name", s->made);
    se3di_entry_put(a->m, entry, "type", "coupler");
    se3di_entry_put(a->m, entry, "terms", text ? se3di_machine_text(a->m, "%s]", text) : NULL);
    return a->m->status >= 0;
}

bool se3di_adams_coupler(se3di_adams *a, se3di_adams_statement *s)
{
    double ids[3];
    double scales[3] = {1.0, 1.0, 1.0};
    term terms[3];
    int count;
    int given;
    const char *types = se3di_adams_get(s, "TYPE");
    if (!se3di_adams_numbers(a, s, "JOINTS", ids, 3, &count) ||
        !se3di_adams_numbers(a, s, "SCALES", scales, 3, &given)) {
        return false;
    }
    if (count < 2 || given < count - 1) {
        return se3di_adams_lose(a, s, "it has no SCALES for its joints");
    }
    for (int k = count - 1; given < count && k > 0; --k) {
        scales[k] = scales[k - 1]; /* the first is 1 */
    }
    scales[0] = given < count ? 1.0 : scales[0];
    for (int k = 0; k < count; ++k) {
        const se3di_adams_statement *joint = joint_by_id(a, s, ids[k]);
        if (!joint) {
            return false;
        }
        const bool slides =
            types && *types ? *types == 'T' || *types == 't' : joint->slides && !joint->turns;
        if (!joint->made || !(slides ? joint->slides : joint->turns)) {
            return se3di_adams_lose(a, s, "one of its joints has no such coordinate");
        }
        types = types ? strpbrk(types, ":,") : NULL;
        types = types ? types + 1 + strspn(types + 1, " ") : NULL;
        terms[k] = (term){joint, slides, slides ? scales[k] / a->length : scales[k]};
    }
    return put_coupler(a, s, terms, count);
}

static void column(const double A[9], int k, double axis[3])
{
    for (int i = 0; i < 3; ++i) {
        axis[i] = A[3 * i + k];
    }
}

/* The speed of the teeth along z of the marker per unit of the joint's coordinate. */
static bool tooth_speed(se3di_adams *a, const se3di_adams_statement *joint,
                        const se3di_frame *contact, double *speed)
{
    const se3di_adams_marker *j = se3di_adams_marker_of(a, joint, "J");
    double axis[3];
    double along[3];
    double arm[3];
    double v[3];
    if (!j) {
        return false;
    }
    column(j->frame.A, Z, axis);
    column(contact->A, Z, along);
    for (int k = 0; k < 3; ++k) {
        arm[k] = contact->r[k] - j->frame.r[k];
    }
    se3di_cross(axis, arm, v);
    *speed = se3di_dot(joint->turns ? v : axis, along);
    return true;
}

bool se3di_adams_gear(se3di_adams *a, se3di_adams_statement *s)
{
    double ids[2];
    int count;
    term terms[2];
    const se3di_adams_marker *cv = se3di_adams_marker_of(a, s, "CV");
    if (!cv || !se3di_adams_numbers(a, s, "JOINTS", ids, 2, &count)) {
        return false;
    }
    if (count != 2) {
        return se3di_adams_lose(a, s, "it needs two joints");
    }
    for (int k = 0; k < 2; ++k) {
        const se3di_adams_statement *joint = joint_by_id(a, s, ids[k]);
        double speed = 0.0;
        if (!joint) {
            return false;
        }
        if (!joint->made || (!joint->turns && !joint->slides)) {
            return se3di_adams_lose(a, s, "one of its joints has no coordinate");
        }
        const se3di_adams_marker *i = se3di_adams_marker_of(a, joint, "I");
        if (!i || !tooth_speed(a, joint, &cv->frame, &speed)) {
            return false;
        }
        /* the gear is what is not the carrier, which the marker is on */
        const double sign = i->body == cv->body ? -1.0 : 1.0;
        terms[k] = (term){joint, !joint->turns, (k == 0 ? 1.0 : -1.0) * sign * speed};
    }
    return put_coupler(a, s, terms, 2);
}

/* The joint that turns, or slides, the part of a marker. `sign`: -1 if the part is its J. */
static const se3di_adams_statement *joint_of(se3di_adams *a, const se3di_adams_marker *marker,
                                             bool slides, double *sign)
{
    double z[3];
    column(marker->frame.A, Z, z);
    for (const se3di_adams_statement *s = a->first; s; s = s->next) {
        if (strcmp(s->word, "JOINT") != 0 || !s->made || (slides ? !s->slides : !s->turns)) {
            continue;
        }
        const se3di_adams_marker *i = se3di_adams_marker_of(a, s, "I");
        const se3di_adams_marker *j = i ? se3di_adams_marker_of(a, s, "J") : NULL;
        if (!j || (i->body != marker->body && j->body != marker->body)) {
            continue;
        }
        double axis[3];
        column(j->frame.A, Z, axis);
        const double along = se3di_dot(axis, z);
        if (along > 1.0 - 1e-6 || along < -1.0 + 1e-6) {
            *sign = (along > 0.0 ? 1.0 : -1.0) * (i->body == marker->body ? 1.0 : -1.0);
            return s;
        }
    }
    return NULL;
}

/* The pinion turns about z of I, the rack slides along z of J by PD/2 of the angle. */
bool se3di_adams_rackpin(se3di_adams *a, se3di_adams_statement *s)
{
    double diameter = 0.0;
    double sign[2] = {1.0, 1.0};
    const se3di_adams_marker *i = se3di_adams_marker_of(a, s, "I");
    const se3di_adams_marker *j = i ? se3di_adams_marker_of(a, s, "J") : NULL;
    if (!j || !se3di_adams_number(a, s, "PD", a->length, &diameter)) {
        return false;
    }
    const se3di_adams_statement *pinion = joint_of(a, i, false, &sign[0]);
    const se3di_adams_statement *rack = joint_of(a, j, true, &sign[1]);
    if (!pinion || !rack) {
        return a->m->status >= 0 &&
               se3di_adams_lose(a, s, "no joints turn its pinion and slide its rack");
    }
    if (!(fabs(diameter) > 0.0)) {
        return se3di_adams_lose(a, s, "its PD is 0");
    }
    s->made = se3di_adams_name(a, s);
    se3di_entry *entry = s->made ? se3di_machine_add(a->m, SE3DI_SECTION_JOINTS) : NULL;
    se3di_entry_put_text(a->m, entry, "name", s->made);
    se3di_entry_put(a->m, entry, "type", "rack_pinion");
    se3di_entry_put_text(a->m, entry, "pinion", pinion->made);
    se3di_entry_put_text(a->m, entry, "rack", rack->made);
    se3di_entry_put_number(a->m, entry, "radius", 0.5 * diameter * sign[0] * sign[1]);
    return a->m->status >= 0;
}
