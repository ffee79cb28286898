/* SPDX-License-Identifier: BSD-3-Clause */
/* Chrono: motors, which hold a joint and move it. Body 1 moves relative to body 2 along or about z
 * of the motor; a speed is integrated from 0 at the start. */
#include "io/import/chrono.h"
#include "io/import/scan.h"

typedef enum actuation { POSITION, SPEED, FORCE } actuation;

typedef struct motor {
    const se3di_node *map;
    const char *name;
    const char *kind; /* of the joint that it holds; NULL: none */
    bool linear;
    actuation acts;
    se3di_chrono_function function;
    se3di_frame frame;
    const se3di_chrono_body *bodies[2];
    const char *value;
} motor;

/* The joint by the word under `guide` or `spindle`. */
static bool read_joint(se3di_chrono *c, const se3di_node *map, motor *m)
{
    static const struct {
        bool linear;
        const char *word, *type;
    } words[] = {{true, "PRISMATIC", "prismatic"},
                 {true, "SPHERICAL", "point_on_line"},
                 {true, "FREE", NULL},
                 {false, "REVOLUTE", "revolute"},
                 {false, "CYLINDRICAL", "cylindrical"},
                 {false, "FREE", NULL}};
    const char *key = m->linear ? "guide" : "spindle";
    const se3di_node *node = se3di_node_get(map, key);
    const char *word = node ? se3di_chrono_text(c, map, key) : m->linear ? "PRISMATIC" : "REVOLUTE";
    if (!word) {
        return false;
    }
    for (size_t k = 0; k < sizeof words / sizeof *words; ++k) {
        if (words[k].linear == m->linear && se3di_scan_equal(word, words[k].word)) {
            m->kind = words[k].type;
            return true;
        }
    }
    return se3di_machine_fail(c->m, node->line, node->column, "the %s `%.60s` is not known", key,
                              word);
}

static bool read_words(se3di_chrono *c, const se3di_node *map, motor *m)
{
    static const char *const actuations[] = {"POSITION", "SPEED", "FORCE"};
    const char *type = se3di_chrono_need(c, map, "type");
    const char *acts = type ? se3di_chrono_need(c, map, "actuation_type") : NULL;
    if (!acts) {
        return false;
    }
    m->linear = se3di_scan_equal(type, "LINEAR");
    if (!m->linear && !se3di_scan_equal(type, "ROTATION")) {
        return se3di_machine_fail(c->m, map->line, map->column,
                                  "the motor `%.60s` is not known, must be LINEAR or ROTATION",
                                  type);
    }
    for (int k = 0; k < 3; ++k) {
        if (se3di_scan_equal(acts, actuations[k])) {
            m->acts = (actuation)k;
            return read_joint(c, map, m);
        }
    }
    return se3di_machine_fail(
        c->m, map->line, map->column,
        "the actuation `%.60s` is not known, must be POSITION, SPEED or FORCE", acts);
}

static void put_bodies(se3di_machine *machine, se3di_entry *entry, const motor *m)
{
    se3di_entry_put_text(machine, entry, "body_i",
                         se3di_machine_body_name(machine, m->bodies[1]->body));
    se3di_entry_put_text(machine, entry, "body_j",
                         se3di_machine_body_name(machine, m->bodies[0]->body));
}

/* A constraint along z of body 2, where no joint has this coordinate. */
static bool add_distance(se3di_chrono *c, const motor *m, const char *name)
{
    se3di_machine *machine = c->m;
    se3di_entry *entry = se3di_machine_add(machine, SE3DI_SECTION_CONSTRAINTS);
    const se3di_frame i =
        se3di_frame_in(&se3di_machine_body_at(machine, m->bodies[1]->body)->frame, &m->frame);
    const se3di_frame j =
        se3di_frame_in(&se3di_machine_body_at(machine, m->bodies[0]->body)->frame, &m->frame);
    const double z[3] = {i.A[2], i.A[5], i.A[8]};
    se3di_entry_put_text(machine, entry, "name", name);
    se3di_entry_put(machine, entry, "type", "dp2");
    put_bodies(machine, entry, m);
    se3di_entry_put_vector(machine, entry, "a_i", z);
    se3di_entry_put_vector(machine, entry, "point_i", i.r);
    se3di_entry_put_vector(machine, entry, "point_j", j.r);
    se3di_entry_put_text(machine, entry, "value", m->value);
    return machine->status >= 0;
}

/* A torque between two bodies that no joint of the motor holds. */
static bool add_torque(se3di_chrono *c, const motor *m, const char *name)
{
    se3di_machine *machine = c->m;
    const double axis[3] = {m->frame.A[2], m->frame.A[5], m->frame.A[8]};
    se3di_entry *entry = se3di_machine_add(machine, SE3DI_SECTION_FORCES);
    se3di_entry_put_text(machine, entry, "name", name);
    se3di_entry_put(machine, entry, "type", "rsda");
    put_bodies(machine, entry, m);
    se3di_entry_put_vector(machine, entry, "axis", axis);
    const char *h = se3di_machine_text(machine, "-(%s)", m->value);
    se3di_entry_put_text(machine, entry, "h", h);
    return machine->status >= 0;
}

/* What moves the joint. */
static bool add_drive(se3di_chrono *c, const motor *m, const char *joint)
{
    se3di_machine *machine = c->m;
    const char *name = se3di_machine_name(
        machine, joint ? se3di_machine_extend(machine, joint, "_actuation") : m->name, "driver",
        m->map->line);
    if (!name) {
        return false;
    }
    const bool coordinate = m->kind && !(m->linear && m->kind[0] == 'p' && m->kind[1] == 'o');
    if (!coordinate && m->linear == (m->acts != FORCE)) {
        return m->linear ? add_distance(c, m, name) : add_torque(c, m, name);
    }
    if (!coordinate) {
        return se3di_chrono_lose(c, m->map, "motor", "it has no joint with a coordinate");
    }
    const bool force = m->acts == FORCE;
    se3di_entry *entry =
        se3di_machine_add(machine, force ? SE3DI_SECTION_FORCES : SE3DI_SECTION_DRIVERS);
    se3di_entry_put_text(machine, entry, "name", name);
    if (force) {
        se3di_entry_put(machine, entry, "type", "effort");
    }
    se3di_entry_put_text(machine, entry, "joint", joint);
    if (!m->linear && m->kind[0] == 'c') {
        se3di_entry_put(machine, entry, "coordinate", "angle");
    }
    se3di_entry_put_text(machine, entry, "value", m->value);
    return machine->status >= 0;
}

static bool make(se3di_chrono *c, motor *m)
{
    se3di_machine *machine = c->m;
    if (m->function.kind == SE3DI_CHRONO_CONTROLLER) {
        m->value = "0";
        se3di_machine_note_of(machine, SE3D_IMPORT_NOTE, m->map->line,
                              "the motor `%.80s` waits for a controller: its value is 0, which a "
                              "program sets between steps",
                              m->name);
    } else {
        m->value = m->acts == SPEED ? se3di_chrono_integral(c, &m->function)
                                    : se3di_chrono_expression(c, &m->function, "t");
    }
    const char *joint = NULL;
    if (!m->value) {
        return machine->status >= 0 &&
               se3di_chrono_lose(c, m->map, "motor", "its function is too long for an expression");
    }
    if (m->kind) {
        const se3di_machine_joint out = {
            .name = joint = se3di_machine_name(machine, m->name, "joint", m->map->line),
            .type = m->kind,
            .body_i = m->bodies[1]->body,
            .body_j = m->bodies[0]->body,
            .frame_i = m->frame,
            .frame_j = m->frame};
        if (!joint || !se3di_machine_add_joint(machine, &out)) {
            return false;
        }
    }
    return add_drive(c, m, joint);
}

bool se3di_chrono_motor(se3di_chrono *c, const se3di_node *map)
{
    motor m = {.map = map, .frame = se3di_frame_identity()};
    bool differ = false;
    m.name = se3di_chrono_need(c, map, "name");
    if (!m.name || !read_words(c, map, &m) || !se3di_chrono_has(c, map, "location") ||
        !se3di_chrono_has(c, map, "axis") || !se3di_chrono_has(c, map, "actuation_function") ||
        !se3di_chrono_numbers(c, map, "location", m.frame.r, 3) ||
        !se3di_chrono_axis(c, map, "axis", m.frame.A) ||
        !se3di_chrono_bodies_of(c, map, m.bodies, &differ) ||
        !se3di_chrono_function_read(c, se3di_node_get(map, "actuation_function"), &m.function)) {
        return false;
    }
    se3di_chrono_keys(c, map,
                      "name type body1 body2 location axis actuation_type actuation_function guide "
                      "spindle");
    return !differ || make(c, &m);
}
