/* SPDX-License-Identifier: BSD-3-Clause */
/* Chrono: springs, dampers and loads. Its force pushes where ours pulls. */
#include <string.h>

#include "io/import/chrono.h"
#include "io/import/scan.h"

#define DEGREE (3.14159265358979323846 / 180.0)

/* The bodies i and j of an element are its bodies 1 and 2. */
static se3di_entry *begin(se3di_chrono *c, const se3di_node *map, const char *type,
                          const se3di_chrono_body *const bodies[2])
{
    se3di_machine *m = c->m;
    const char *wanted = se3di_chrono_need(c, map, "name");
    const char *name = wanted ? se3di_machine_name(m, wanted, "force", map->line) : NULL;
    se3di_entry *entry = se3di_machine_add_force(m, name, type);
    if (!entry) {
        return NULL;
    }
    se3di_entry_put_text(m, entry, "body_i", se3di_machine_body_name(m, bodies[0]->body));
    se3di_entry_put_text(m, entry, "body_j", se3di_machine_body_name(m, bodies[1]->body));
    return entry;
}

/* A curve of points under `key` as an expression under `ours`. */
static bool put_curve(se3di_chrono *c, const se3di_node *map, se3di_entry *entry, const char *key,
                      const char *ours)
{
    se3di_chrono_function curve;
    if (!se3di_node_get(map, key)) {
        return true;
    }
    if (!se3di_chrono_points(c, map, key, &curve)) {
        return false;
    }
    const char *value = se3di_chrono_expression(c, &curve, strcmp(ours, "spring") == 0 ? "x" : "v");
    if (!value) {
        return c->m->status >= 0 &&
               se3di_chrono_lose(c, map, "element", "a curve is too long for an expression");
    }
    se3di_entry_put_text(c->m, entry, ours, value);
    return c->m->status >= 0;
}

/* c v / (1 + d |v|), with d of extension and of compression. */
static bool put_degressive(se3di_chrono *c, const se3di_node *map, se3di_entry *entry,
                           double damping)
{
    double compression = 0.0;
    double extension = 0.0;
    if (!se3di_chrono_number(c, map, "degressivity_compression", &compression) ||
        !se3di_chrono_number(c, map, "degressivity_expansion", &extension)) {
        return false;
    }
    const char *number = se3di_machine_number(c->m, damping);
    const char *in = se3di_machine_number(c->m, compression);
    const char *out = se3di_machine_number(c->m, extension);
    se3di_entry_put_text(
        c->m, entry, "damper",
        number && in && out
            ? se3di_machine_text(c->m, "%s*v/(1 + if(v < 0, -(%s)*v, (%s)*v))", number, in, out)
            : NULL);
    return c->m->status >= 0;
}

typedef struct laws {
    bool spring, spring_curve, damping_curve, degressive;
    double k, c, preload, rest;
} laws;

static bool read_laws(se3di_chrono *c, const se3di_node *map, const char *rest, laws *l)
{
    l->spring = se3di_node_get(map, "spring_coefficient") != NULL;
    l->spring_curve = se3di_node_get(map, "spring_curve_data") != NULL;
    l->damping_curve = se3di_node_get(map, "damping_curve_data") != NULL;
    l->degressive = !l->spring && !l->spring_curve && !l->damping_curve &&
                    se3di_node_get(map, "degressivity_compression") &&
                    se3di_node_get(map, "degressivity_expansion");
    if (!se3di_chrono_number(c, map, "spring_coefficient", &l->k) ||
        !se3di_chrono_number(c, map, "damping_coefficient", &l->c) ||
        !se3di_chrono_number(c, map, "preload", &l->preload) ||
        !se3di_chrono_number(c, map, rest, &l->rest)) {
        return false;
    }
    l->rest *= strcmp(rest, "free_angle") == 0 && c->degrees ? DEGREE : 1.0;
    return true;
}

/* Stiffness, damping and preload, as numbers or curves; `rest` is where the spring is free. A curve
 * stands in the place of both coefficients. */
static bool put_laws(se3di_chrono *c, const se3di_node *map, se3di_entry *entry, const char *rest,
                     const char *ours)
{
    se3di_machine *m = c->m;
    laws l = {.k = 0.0};
    if (!read_laws(c, map, rest, &l)) {
        return false;
    }
    const bool elastic = l.spring || l.spring_curve;
    if (l.rest < 0.0 && strcmp(ours, "l0") == 0) { /* a length is not negative: the same force */
        if (l.spring_curve) {
            return se3di_chrono_lose(c, map, "element", "a curve from a negative free length");
        }
        l.preload += l.k * l.rest;
        l.rest = 0.0;
    }
    if (elastic && l.rest != 0.0) {
        se3di_entry_put_number(m, entry, ours, l.rest);
    }
    if (l.spring && !l.spring_curve) {
        se3di_entry_put_number(m, entry, "k", l.k);
    }
    if (l.c != 0.0 && !l.damping_curve && !l.degressive && !l.spring_curve) {
        se3di_entry_put_number(m, entry, "c", l.c);
    }
    if (elastic && l.preload != 0.0) {
        se3di_entry_put_number(m, entry, "preload", -l.preload);
    }
    return (!l.degressive || put_degressive(c, map, entry, l.c)) &&
           put_curve(c, map, entry, "spring_curve_data", "spring") &&
           put_curve(c, map, entry, "damping_curve_data", "damper");
}

/* The ends of a spring's range, at which Chrono has a curve of its own. */
static bool put_stops(se3di_chrono *c, const se3di_node *map, se3di_entry *entry)
{
    double curve[] = {0.0,  0.0,    2e-3, 200.0,   4e-3, 400.0,   6e-3, 600.0,
                      8e-3, 800.0,  1e-2, 1000.0,  2e-2, 2500.0,  3e-2, 4500.0,
                      4e-2, 7500.0, 5e-2, 12500.0, 6e-2, 125000.0};
    const se3di_chrono_function f = {
        .kind = SE3DI_CHRONO_DATA, .values = curve, .count = sizeof curve / sizeof *curve / 2};
    se3di_machine *m = c->m;
    double range[2];
    if (!se3di_node_get(map, "minimum_length") || !se3di_node_get(map, "maximum_length") ||
        (!se3di_node_get(map, "spring_coefficient") && !se3di_node_get(map, "spring_curve_data"))) {
        return true;
    }
    if (!se3di_chrono_number(c, map, "minimum_length", &range[0]) ||
        !se3di_chrono_number(c, map, "maximum_length", &range[1])) {
        return false;
    }
    const char *least = se3di_machine_number(m, range[0]);
    const char *most = se3di_machine_number(m, range[1]);
    const char *in = least ? se3di_machine_text(m, "(%s - l)", least) : NULL;
    const char *out = most ? se3di_machine_text(m, "(l - %s)", most) : NULL;
    const char *push = in ? se3di_chrono_expression(c, &f, in) : NULL;
    const char *pull = out ? se3di_chrono_expression(c, &f, out) : NULL;
    se3di_entry_put_text(m, entry, "h",
                         push && pull ? se3di_machine_text(m, "%s - (%s)", pull, push) : NULL);
    return m->status >= 0;
}

bool se3di_chrono_tsda(se3di_chrono *c, const se3di_node *map)
{
    static const char *const known[] = {"spring_coefficient", "damping_coefficient",
                                        "spring_curve_data", "damping_curve_data", NULL};
    const se3di_chrono_body *bodies[2] = {NULL, NULL};
    double points[2][3];
    bool differ = false;
    bool has_law = false;
    if (!se3di_chrono_has(c, map, "point1") || !se3di_chrono_has(c, map, "point2") ||
        !se3di_chrono_numbers(c, map, "point1", points[0], 3) ||
        !se3di_chrono_numbers(c, map, "point2", points[1], 3) ||
        !se3di_chrono_bodies_of(c, map, bodies, &differ)) {
        return false;
    }
    se3di_chrono_keys(c, map,
                      "name type body1 body2 point1 point2 free_length spring_coefficient "
                      "damping_coefficient spring_curve_data damping_curve_data deformation "
                      "map_data preload minimum_length maximum_length degressivity_compression "
                      "degressivity_expansion visualization");
    for (int k = 0; known[k]; ++k) {
        has_law = has_law || se3di_node_get(map, known[k]);
    }
    if (se3di_node_get(map, "map_data")) {
        return se3di_chrono_lose(c, map, "tsda", "a force that is a map of length and rate");
    }
    if (!has_law) {
        return se3di_chrono_lose(c, map, "tsda", "it has neither a spring nor a damper");
    }
    se3di_entry *entry = differ ? begin(c, map, "tsda", bodies) : NULL;
    if (!entry) {
        return !differ;
    }
    se3di_entry_put_vector(c->m, entry, "at", points[0]);
    se3di_entry_put_vector(c->m, entry, "at_2", points[1]);
    return put_laws(c, map, entry, "free_length", "l0") && put_stops(c, map, entry);
}

bool se3di_chrono_rsda(se3di_chrono *c, const se3di_node *map)
{
    const se3di_chrono_body *bodies[2] = {NULL, NULL};
    double axis[3] = {0.0, 0.0, 0.0};
    bool differ = false;
    if (!se3di_chrono_has(c, map, "axis") || !se3di_chrono_numbers(c, map, "axis", axis, 3) ||
        !se3di_chrono_bodies_of(c, map, bodies, &differ)) {
        return false;
    }
    se3di_chrono_keys(c, map,
                      "name type body1 body2 location axis free_angle spring_coefficient "
                      "damping_coefficient spring_curve_data damping_curve_data preload "
                      "visualization");
    if (!(se3di_length(axis) > 0.0)) {
        return se3di_machine_fail(c->m, map->line, map->column, "the axis has no length");
    }
    se3di_entry *entry = differ ? begin(c, map, "rsda", bodies) : NULL;
    if (!entry) {
        return !differ;
    }
    se3di_entry_put_vector(c->m, entry, "axis", axis);
    return put_laws(c, map, entry, "free_angle", "theta0");
}

/* "[a*(f), b*(f), c*(f)]" */
static const char *load_text(se3di_chrono *c, const double load[3], const char *factor)
{
    const char *part[3];
    if (!factor) {
        return se3di_machine_numbers(c->m, load, 3);
    }
    for (int k = 0; k < 3; ++k) {
        const char *number = se3di_machine_number(c->m, load[k]);
        const char *text =
            number && load[k] != 0.0 ? se3di_machine_text(c->m, "%s*(%s)", number, factor) : number;
        part[k] = text ? se3di_machine_quote(c->m, text) : NULL;
        if (!part[k]) {
            return NULL;
        }
    }
    return se3di_machine_text(c->m, "[%s, %s, %s]", part[0], part[1], part[2]);
}

typedef struct load {
    const char *name;
    bool is_force, local, local_point;
    double value[3], point[3];
    const char *factor; /* NULL: 1 */
} load;

static bool read_load(se3di_chrono *c, const se3di_node *map, load *l)
{
    const se3di_node *function = se3di_node_get(map, "modulation_function");
    se3di_chrono_function f;
    l->name = se3di_chrono_need(c, map, "name");
    const char *type = l->name ? se3di_chrono_need(c, map, "type") : NULL;
    if (!type) {
        return false;
    }
    l->is_force = se3di_scan_equal(type, "FORCE");
    if (!l->is_force && !se3di_scan_equal(type, "TORQUE")) {
        return se3di_machine_fail(c->m, map->line, map->column,
                                  "the load `%.60s` is not known, must be FORCE or TORQUE", type);
    }
    if (!se3di_chrono_numbers(c, map, "load", l->value, 3) ||
        !se3di_chrono_bool(c, map, "local_load", &l->local) ||
        !se3di_chrono_numbers(c, map, "point", l->point, 3) ||
        !se3di_chrono_bool(c, map, "local_point", &l->local_point)) {
        return false;
    }
    if (function) {
        if (!se3di_chrono_function_read(c, function, &f)) {
            return false;
        }
        l->factor = se3di_chrono_expression(c, &f, "t");
        return l->factor ||
               (c->m->status >= 0 && se3di_chrono_lose(c, map, "load", "its function is too long"));
    }
    return true;
}

/* A point that stays in the ground makes the moment about the centre change as the body moves. */
bool se3di_chrono_load(se3di_chrono *c, const se3di_node *map)
{
    se3di_machine *m = c->m;
    load l = {.local = true, .local_point = true};
    const se3di_chrono_body *body = se3di_chrono_body_of(c, map, "body");
    if (!body || !read_load(c, map, &l)) {
        return false;
    }
    if (!se3di_node_get(map, "load")) {
        se3di_machine_note_of(m, SE3D_IMPORT_NOTE, map->line,
                              "the load `%.80s` waits for a controller: it is 0, which a program "
                              "sets between steps",
                              l.name);
    }
    if (body->fixed) {
        return se3di_chrono_lose(c, map, "load", "its body does not move");
    }
    if (l.is_force && !l.local_point) {
        return se3di_chrono_lose(c, map, "load", "its point stays in the ground");
    }
    const char *name = se3di_machine_name(m, l.name, "force", map->line);
    se3di_entry *entry = name ? se3di_machine_add(m, SE3DI_SECTION_FORCES) : NULL;
    if (!entry) {
        return false;
    }
    const se3di_frame centre =
        se3di_frame_in(&se3di_machine_body_at(m, body->body)->frame, &body->mass);
    double value[3];
    double point[3];
    se3di_turn(centre.A, l.value, value);
    se3di_frame_point(&centre, l.point, point);
    se3di_entry_put_text(m, entry, "name", name);
    se3di_entry_put(m, entry, "type", l.is_force ? "force" : "torque");
    se3di_entry_put_text(m, entry, "body", se3di_machine_body_name(m, body->body));
    if (l.is_force && se3di_length(point) > 0.0) {
        se3di_entry_put_vector(m, entry, "point", point);
    }
    if (l.local) {
        se3di_entry_put(m, entry, "frame", "body");
    }
    se3di_entry_put(m, entry, "value", load_text(c, l.local ? value : l.value, l.factor));
    return m->status >= 0;
}
