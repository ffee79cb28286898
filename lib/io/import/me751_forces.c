/* SPDX-License-Identifier: BSD-3-Clause */
/* ME751: springs, actuators and loads. */
#include <math.h>
#include <string.h>

#include "io/import/me751.h"
#include "io/import/scan.h"

static const se3di_me751_member stiffness_names = {{"k", "stiffness", "spring"}};
static const se3di_me751_member damping_names = {{"c", "damping", "damper"}};
static const se3di_me751_member length_names = {{"l0", "lzero", "freelength", "restlength"}};
static const se3di_me751_member angle_names = {{"theta0", "thetazero", "freeangle", "restangle"}};
static const se3di_me751_member actuator_names = {{"h", "actuator", "fun", "function"}};
static const se3di_me751_member one_body_names = {{"body", "body1", "bodyi", "body2", "bodyj"}};
static const se3di_me751_member one_point_names = {
    {"sbar", "s", "spibar", "si", "sbari", "point", "location", "sp1"}};
static const se3di_me751_member load_names = {{"force", "f", "value", "fun"}};
static const se3di_me751_member torque_names = {{"torque", "t", "value", "fun"}};
static const se3di_me751_member own_torque_names = {{"nbar", "tbar", "torquebar"}};
static const se3di_me751_member frame_names = {{"frame"}};
static const se3di_me751_member reference_names[2] = {{{"bibar", "bi", "fibar", "refi"}},
                                                      {{"bjbar", "bj", "fjbar", "refj"}}};
static const se3di_me751_member component_names[3] = {
    {{"funx", "fx"}}, {{"funy", "fy"}}, {{"funz", "fz"}}};

/* A function of t as it is written; *value NULL: none that is an expression. */
static bool take_function(se3di_machine *m, const se3di_node *node, const char **value)
{
    double number = 0.0;
    const char *text = se3di_me751_text_of(node);
    const size_t length = text ? se3di_scan_number(text, false, &number) : 0;
    *value = NULL;
    if (length > 0 && !text[length]) {
        *value = se3di_machine_number(m, number);
    } else if (text) {
        const char *expression = se3di_me751_expression_of(m, text);
        *value = expression && se3di_me751_compiles(expression) ? se3di_machine_quote(m, expression)
                                                                : NULL;
    }
    return m->status >= 0;
}

static bool put_number(se3di_machine *m, const se3di_node *map, const se3di_me751_member *wanted,
                       const char *key, double least, se3di_entry *entry)
{
    const se3di_node *node = se3di_me751_find(map, wanted);
    double value = 0.0;
    if (!node) {
        return true;
    }
    if (!se3di_me751_read_number(m, node, &value)) {
        return false;
    }
    if (value < least) {
        return se3di_me751_expect(m, node, "a number >= 0");
    }
    se3di_entry_put_number(m, entry, key, value);
    return m->status >= 0;
}

static se3di_entry *begin_force(se3di_machine *m, const se3di_node *map, const char *type)
{
    const char *name =
        se3di_machine_name(m, se3di_me751_text_of(se3di_node_get(map, "name")), type, map->line);
    return se3di_machine_add_force(m, name, type);
}

/* What a spring has beside its points or axes. */
static bool put_law(se3di_machine *m, const se3di_node *map, bool turns, const char *actuator,
                    se3di_entry *entry)
{
    if (!put_number(m, map, &stiffness_names, "k", -(double)INFINITY, entry) ||
        !put_number(m, map, &damping_names, "c", -(double)INFINITY, entry) ||
        !put_number(m, map, turns ? &angle_names : &length_names, turns ? "theta0" : "l0",
                    turns ? -(double)INFINITY : 0.0, entry)) {
        return false;
    }
    if (actuator) {
        se3di_entry_put(m, entry, "h", actuator);
    }
    return m->status >= 0;
}

static bool put_points(se3di_machine *m, const se3di_node *map, se3di_entry *entry)
{
    return se3di_me751_put_vector(m, map, &se3di_me751_point_names[0], "point_i", false, entry) &&
           se3di_me751_put_vector(m, map, &se3di_me751_point_names[1], "point_j", false, entry);
}

/* Whether two directions give no plane. */
static bool are_parallel(const double a[3], const double b[3])
{
    const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    return !(se3di_length(n) > 2e-6 * se3di_length(a) * se3di_length(b));
}

/* The axis on body i, and the directions that the angle is between, if they are given. */
static bool put_axis(se3di_machine *m, const se3di_node *map, se3di_entry *entry)
{
    static const char *const keys[2] = {"ref_i", "ref_j"};
    double axis[3] = {0.0, 0.0, 0.0};
    double ref[3] = {0.0, 0.0, 0.0};
    const se3di_node *from = se3di_me751_find(map, &reference_names[1])
                                 ? se3di_me751_find(map, &reference_names[0])
                                 : NULL;
    if (!se3di_me751_put_vector(m, map, &se3di_me751_direction_names[0], "axis_i", true, entry) ||
        !se3di_me751_read_member(m, map, &se3di_me751_direction_names[0], axis, 3) ||
        !se3di_me751_read_member(m, map, &reference_names[0], ref, 3)) {
        return false;
    }
    if (from && are_parallel(axis, ref)) {
        return se3di_me751_expect(m, from, "a direction across the axis");
    }
    for (int k = 0; k < 2 && from; ++k) {
        if (!se3di_me751_put_vector(m, map, &reference_names[k], keys[k], true, entry)) {
            return false;
        }
    }
    return true;
}

static bool read_spring(se3di_me751_reader *r, const se3di_node *map, bool turns)
{
    se3di_machine *m = r->m;
    const se3di_node *law = se3di_me751_find(map, &actuator_names);
    const char *actuator = NULL;
    size_t bodies[2] = {0, 0};
    if (!se3di_me751_find(map, &se3di_me751_body_names[0]) ||
        !se3di_me751_find(map, &se3di_me751_body_names[1])) {
        return se3di_me751_lose(m, map, "it does not name two bodies");
    }
    if (turns && !se3di_me751_find(map, &se3di_me751_direction_names[0])) {
        return se3di_me751_lose(m, map, "it has no axis `aiBAR`");
    }
    if (!se3di_me751_find_body(r, map, &se3di_me751_body_names[0], &bodies[0]) ||
        !se3di_me751_find_body(r, map, &se3di_me751_body_names[1], &bodies[1])) {
        return false;
    }
    if (bodies[0] == bodies[1]) {
        return se3di_me751_lose(m, map, "it is between one body and itself");
    }
    if (law && !se3di_node_is_null(law) &&
        !se3di_scan_equal(se3di_me751_text_of(law) ? se3di_me751_text_of(law) : "", "none") &&
        !(take_function(m, law, &actuator) && actuator)) {
        return m->status >= 0 &&
               se3di_me751_lose(m, map, "its actuator is no number and no expression in t");
    }
    se3di_entry *entry = begin_force(m, map, turns ? "rsda" : "tsda");
    se3di_entry_put_text(m, entry, "body_i", se3di_machine_body_name(m, bodies[0]));
    se3di_entry_put_text(m, entry, "body_j", se3di_machine_body_name(m, bodies[1]));
    return entry && (turns ? put_axis(m, map, entry) : put_points(m, map, entry)) &&
           put_law(m, map, turns, actuator, entry);
}

/* Three numbers or functions of t as a list; NULL: they are not. */
static const char *take_components(se3di_machine *m, const se3di_node *node)
{
    const char *parts[3] = {NULL, NULL, NULL};
    if (!node || node->kind != SE3DI_NODE_LIST || node->count != 3) {
        return NULL;
    }
    int k = 0;
    for (const se3di_node *one = node->first; one; one = one->next, ++k) {
        if (!take_function(m, one, &parts[k]) || !parts[k]) {
            return NULL;
        }
    }
    return se3di_machine_text(m, "[%s, %s, %s]", parts[0], parts[1], parts[2]);
}

/* The same of members of their own. */
static const char *take_single(se3di_machine *m, const se3di_node *map)
{
    const char *parts[3] = {"0", "0", "0"};
    bool is_any = false;
    for (int k = 0; k < 3; ++k) {
        const se3di_node *one = se3di_me751_find(map, &component_names[k]);
        is_any |= one != NULL;
        if (one && (!take_function(m, one, &parts[k]) || !parts[k])) {
            return NULL;
        }
    }
    return is_any ? se3di_machine_text(m, "[%s, %s, %s]", parts[0], parts[1], parts[2]) : NULL;
}

/* A force at a point, or a torque; that of the ground's axes, or with the name of a torque in its
 * body's, or a `frame` that says so, of those. */
static bool read_load(se3di_me751_reader *r, const se3di_node *map, bool turns)
{
    se3di_machine *m = r->m;
    const se3di_node *own = turns ? se3di_me751_find(map, &own_torque_names) : NULL;
    const se3di_node *node = own ? own : se3di_me751_find(map, turns ? &torque_names : &load_names);
    const char *frame = se3di_me751_text_of(se3di_me751_find(map, &frame_names));
    const char *value = node ? take_components(m, node) : take_single(m, map);
    size_t body = 0;
    if (!value || !se3di_me751_find(map, &one_body_names)) {
        return m->status >= 0 &&
               se3di_me751_lose(m, map, "it needs a body, and three numbers or functions");
    }
    if (!se3di_me751_find_body(r, map, &one_body_names, &body)) {
        return false;
    }
    if (body == SE3DI_GROUND) {
        return se3di_me751_lose(m, map, "it acts on the ground");
    }
    se3di_entry *entry = begin_force(m, map, turns ? "torque" : "force");
    se3di_entry_put_text(m, entry, "body", se3di_machine_body_name(m, body));
    if (!entry || (!turns && se3di_me751_find(map, &one_point_names) &&
                   !se3di_me751_put_vector(m, map, &one_point_names, "point", false, entry))) {
        return false;
    }
    se3di_entry_put(m, entry, "value", value);
    if (own || (frame && (se3di_scan_equal(frame, "body") || se3di_scan_equal(frame, "local") ||
                          se3di_scan_equal(frame, "LRF")))) {
        se3di_entry_put(m, entry, "frame", "body");
    }
    return m->status >= 0;
}

/* What a list or a type is of, by its name. */
typedef enum force_kind { NO_FORCE, SPRING, TURN_SPRING, LOAD, TORQUE, SOME_FORCE } force_kind;

static force_kind kind_of(const char *text)
{
    static const struct {
        const char *name;
        force_kind kind;
    } table[] = {{"tsda", SPRING},       {"tsdas", SPRING},      {"rsda", TURN_SPRING},
                 {"rsdas", TURN_SPRING}, {"forces", SOME_FORCE}, {"force", LOAD},
                 {"pointforce", LOAD},   {"pointforces", LOAD},  {"torque", TORQUE},
                 {"torques", TORQUE},    {"loads", SOME_FORCE},  {"puretorque", TORQUE}};
    char plain[SE3DI_ME751_KEY_MAX];
    se3di_me751_plain_text(text ? text : "", plain);
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (strcmp(plain, table[k].name) == 0) {
            return table[k].kind;
        }
    }
    return NO_FORCE;
}

bool se3di_me751_has_forces(const se3di_node *list)
{
    return list->kind == SE3DI_NODE_LIST && kind_of(list->key) != NO_FORCE;
}

static bool read_force(se3di_me751_reader *r, const se3di_node *map, force_kind kind)
{
    const char *type =
        map->kind == SE3DI_NODE_MAP ? se3di_me751_text_of(se3di_node_get(map, "type")) : NULL;
    kind = type ? kind_of(type) : kind;
    if (map->kind != SE3DI_NODE_MAP || kind == NO_FORCE || kind == SOME_FORCE) {
        return se3di_me751_lose(r->m, map, "its `type` must be TSDA, RSDA, force or torque");
    }
    return kind == SPRING || kind == TURN_SPRING ? read_spring(r, map, kind == TURN_SPRING)
                                                 : read_load(r, map, kind == TORQUE);
}

bool se3di_me751_read_forces(se3di_me751_reader *r, const se3di_node *root)
{
    for (const se3di_node *list = root->first; list; list = list->next) {
        const force_kind kind = kind_of(list->key);
        for (const se3di_node *map = se3di_me751_has_forces(list) ? list->first : NULL; map;
             map = map->next) {
            if (!read_force(r, map, kind)) {
                return false;
            }
        }
    }
    return true;
}
