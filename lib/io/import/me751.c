/* SPDX-License-Identifier: BSD-3-Clause */
/* Models of the course ME751 (Wisconsin), whose programs, each called simEngine3D, read bodies,
 * primitive constraints and joints of markers from a file in JSON. There is no document of it, and
 * each program has its own names for the same members: all are known here that stand in one of the
 * tables below. d runs from the point of body i to that of body j, and D has the square of the
 * distance, as ours. */
#include <math.h>
#include <string.h>

#include "io/import/formats.h"
#include "io/import/inertia.h"
#include "io/import/me751.h"
#include "io/import/scan.h"

static const se3di_me751_member id_names = {{"id"}};
static const se3di_me751_member mass_names = {{"mass", "m"}};
static const se3di_me751_member inertia_names = {{"jbar", "j", "inertia", "moi"}};
static const se3di_me751_member state_names = {{"q0", "q", "qxyze0e1e2e3"}};
static const se3di_me751_member rate_names = {{"qd0", "qd", "qdot"}};
static const se3di_me751_member position_names = {{"r", "r0", "position"}};
static const se3di_me751_member velocity_names = {{"rd", "dr", "rdot", "velocity"}};
static const se3di_me751_member turn_names = {{"p", "p0", "eulerparameters"}};
static const se3di_me751_member turn_rate_names = {{"pd", "dp", "pdot"}};
static const se3di_me751_member fixed_names = {{"ground", "isground", "fixed"}};
static const se3di_me751_member c_names = {{"c"}};
static const se3di_me751_member centre_names = {{"cg", "com"}};
static const se3di_me751_member marker_names[2] = {{{"marker1", "markeri"}},
                                                   {{"marker2", "markerj"}}};
static const se3di_me751_member corner_names[3] = {{{"p"}}, {{"q"}}, {{"r"}}};
static const se3di_me751_member duration_names = {{"tend", "duration", "endtime"}};
static const se3di_me751_member rows_names = {{"outputsteps"}};

/* ---- bodies ---------------------------------------------------------------------------------*/

static bool read_inertia(se3di_machine *m, const se3di_node *map, double J[9])
{
    const se3di_node *node = se3di_me751_find(map, &inertia_names);
    double moments[3] = {1.0, 1.0, 1.0};
    memset(J, 0, 9 * sizeof *J);
    if (node && node->kind == SE3DI_NODE_LIST && node->count == 3 &&
        node->first->kind == SE3DI_NODE_LIST) {
        for (const se3di_node *row = node->first; row; row = row->next, J += 3) {
            if (!se3di_me751_read_numbers(m, row, J, 3)) {
                return false;
            }
        }
        return true;
    }
    if (node && !se3di_me751_read_numbers(m, node, moments, 3)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        J[4 * k] = moments[k];
    }
    return true;
}

/* 2 G(p) pdot over p.p, body frame. */
static void turn_rate(const double p[4], const double d[4], double w[3])
{
    const double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
    w[0] = 2.0 * (-p[1] * d[0] + p[0] * d[1] + p[3] * d[2] - p[2] * d[3]) / square;
    w[1] = 2.0 * (-p[2] * d[0] - p[3] * d[1] + p[0] * d[2] + p[1] * d[3]) / square;
    w[2] = 2.0 * (-p[3] * d[0] + p[2] * d[1] - p[1] * d[2] + p[0] * d[3]) / square;
}

static bool read_pose(se3di_machine *m, const se3di_node *map, se3di_machine_body *body)
{
    double q[7] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
    double qd[7] = {0.0};
    if (!se3di_me751_read_member(m, map, &state_names, q, 7) ||
        !se3di_me751_read_member(m, map, &rate_names, qd, 7) ||
        !se3di_me751_read_member(m, map, &position_names, q, 3) ||
        !se3di_me751_read_member(m, map, &turn_names, q + 3, 4) ||
        !se3di_me751_read_member(m, map, &velocity_names, qd, 3) ||
        !se3di_me751_read_member(m, map, &turn_rate_names, qd + 3, 4)) {
        return false;
    }
    memcpy(body->frame.r, q, sizeof body->frame.r);
    memcpy(body->v, qd, sizeof body->v);
    if (!se3di_turn_from_parameters(q + 3, body->frame.A)) {
        return se3di_machine_fail(m, map->line, map->column,
                                  "the Euler parameters of `%.80s` are 0", body->name);
    }
    turn_rate(q + 3, qd + 3, body->w);
    return true;
}

static bool is_ground(const se3di_node *map)
{
    const char *fixed = se3di_me751_text_of(se3di_me751_find(map, &fixed_names));
    const char *name = se3di_me751_text_of(se3di_node_get(map, "name"));
    return (name && se3di_scan_equal(name, "ground")) ||
           (fixed && (se3di_scan_equal(fixed, "true") || strcmp(fixed, "1") == 0));
}

static bool read_mass(se3di_machine *m, const se3di_node *map, se3di_machine_body *body)
{
    const se3di_node *mass = se3di_me751_find(map, &mass_names);
    body->mass = 1.0;
    if ((mass && !se3di_me751_read_number(m, mass, &body->mass)) ||
        !read_inertia(m, map, body->J)) {
        return false;
    }
    if (!(body->mass > 0.0)) {
        return se3di_machine_fail(m, mass->line, mass->column,
                                  "the mass of `%.80s` is %g kg, must be > 0", body->name,
                                  body->mass);
    }
    if (!mass || !se3di_me751_find(map, &inertia_names)) {
        se3di_machine_note_of(m, SE3D_IMPORT_NOTE, map->line,
                              "`%.80s` has no %s: it gets 1, which kinematics does not ask for",
                              body->name, mass ? "inertia" : "mass");
    }
    return se3di_inertia_mend(m, body->name, map->line, body->mass, body->J);
}

static bool read_body(se3di_me751_reader *r, const se3di_node *map)
{
    se3di_machine *m = r->m;
    const char *id = se3di_me751_text_of(se3di_me751_find(map, &id_names));
    const char *name = se3di_me751_text_of(se3di_node_get(map, "name"));
    if (map->kind != SE3DI_NODE_MAP || (!id && !name)) {
        return se3di_me751_expect(m, map, "a body with an `id`");
    }
    id = id ? id : name;
    if (se3di_ionames_find(&r->ids, id, NULL)) {
        return se3di_machine_fail(m, map->line, map->column, "there are two bodies %.60s", id);
    }
    if (!se3di_ionames_add(&r->ids, m->pool, id, r->count)) {
        return se3di_machine_fail_memory(m);
    }
    r->bodies[r->count++] = is_ground(map) ? SE3DI_GROUND : m->body_count;
    if (is_ground(map)) {
        return true;
    }
    const char *free_name = se3di_machine_name_body(m, name, "body", map->line);
    se3di_machine_body *body = free_name ? se3di_machine_add_body(m, free_name) : NULL;
    double centre[3] = {0.0, 0.0, 0.0};
    if (!body || !read_pose(m, map, body) || !read_mass(m, map, body) ||
        !se3di_me751_read_member(m, map, &centre_names, centre, 3)) {
        return false;
    }
    if (se3di_length(centre) > 0.0) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, map->line,
                              "the centre of mass of `%.80s` is not at its origin, as it is here",
                              body->name);
    }
    return m->status >= 0;
}

/* ---- constraints ----------------------------------------------------------------------------*/

typedef struct primitive {
    const char *type;
    int directions, points; /* of body i, or both */
    bool c;
} primitive;

static const primitive primitives[] = {
    {"dp1", 2, 0, false}, {"dp2", 1, 2, false}, {"d", 0, 2, false}, {"cd", 0, 2, true}};

static const primitive *find_primitive(se3di_machine *m, const se3di_node *map)
{
    const char *type = se3di_me751_text_of(se3di_node_get(map, "type"));
    char plain[SE3DI_ME751_KEY_MAX];
    se3di_me751_plain_text(type ? type : "", plain);
    const char *word = strncmp(plain, "cons", 4) == 0 ? plain + 4 : plain;
    for (size_t k = 0; k < sizeof primitives / sizeof *primitives; ++k) {
        if (strcmp(word, primitives[k].type) == 0) {
            return &primitives[k];
        }
    }
    se3di_machine_fail(m, map->line, map->column,
                       "the type of a constraint is `%.40s`, must be DP1, DP2, D, CD or a joint: "
                       "Revolute, Spherical, Cylindrical, Translational, Universal or Fixed",
                       type ? type : "");
    return NULL;
}

/* ---- joints ---------------------------------------------------------------------------------*/

typedef struct joint_kind {
    const char *name, *type; /* in letters and digits; as in a model file */
    bool has_angle, has_displacement;
} joint_kind;

static const joint_kind *find_joint(const se3di_node *map)
{
    static const joint_kind kinds[] = {{"revolute", "revolute", true, false},
                                       {"revolutejoint", "revolute", true, false},
                                       {"rj", "revolute", true, false},
                                       {"spherical", "spherical", false, false},
                                       {"sphericaljoint", "spherical", false, false},
                                       {"sj", "spherical", false, false},
                                       {"cylindrical", "cylindrical", false, false},
                                       {"cylindricaljoint", "cylindrical", false, false},
                                       {"cj", "cylindrical", false, false},
                                       {"translational", "prismatic", false, true},
                                       {"translationaljoint", "prismatic", false, true},
                                       {"prismatic", "prismatic", false, true},
                                       {"tj", "prismatic", false, true},
                                       {"universal", "universal", false, false},
                                       {"universaljoint", "universal", false, false},
                                       {"uj", "universal", false, false},
                                       {"fixed", "fixed", false, false},
                                       {"fixedjoint", "fixed", false, false}};
    const char *type = se3di_me751_text_of(se3di_node_get(map, "type"));
    char plain[SE3DI_ME751_KEY_MAX];
    se3di_me751_plain_text(type ? type : "", plain);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        if (strcmp(plain, kinds[k].name) == 0) {
            return &kinds[k];
        }
    }
    return NULL;
}

/* A marker: P is its origin, Q a point on its z axis, R one in the half of its x-z plane where x is
 * positive. */
static bool read_marker(se3di_machine *m, const se3di_node *map, const se3di_me751_member *wanted,
                        se3di_frame *frame)
{
    const se3di_node *node = se3di_me751_find(map, wanted);
    double corners[3][3] = {{0.0}};
    if (node && node->kind == SE3DI_NODE_LIST && node->count == 1) {
        node = node->first;
    }
    if (!node || node->kind != SE3DI_NODE_MAP) {
        return se3di_machine_fail(m, map->line, map->column, "this has no `%s` of P, Q and R",
                                  wanted->names[0]);
    }
    for (int k = 0; k < 3; ++k) {
        if (!se3di_me751_find(node, &corner_names[k])) {
            return se3di_machine_fail(m, node->line, node->column, "this has no member `%s`",
                                      corner_names[k].names[0]);
        }
        if (!se3di_me751_read_member(m, node, &corner_names[k], corners[k], 3)) {
            return false;
        }
    }
    double z[3], x[3];
    for (int k = 0; k < 3; ++k) {
        z[k] = corners[1][k] - corners[0][k];
        x[k] = corners[2][k] - corners[0][k];
    }
    memcpy(frame->r, corners[0], sizeof frame->r);
    return se3di_turn_along_both(z, x, frame->A) ||
           se3di_me751_expect(m, node, "three points not in one line");
}

/* Drive the joint's coordinate by `value`; the angle is that of x of body j before x of body i. */
static bool put_driver(se3di_machine *m, const se3di_node *map, const char *joint,
                       const joint_kind *kind, bool turned, const char *value)
{
    if (!kind->has_angle && !kind->has_displacement) {
        return se3di_me751_lose(m, map, "its `fun` would drive one of several coordinates");
    }
    const char *name =
        se3di_machine_name(m, se3di_machine_extend(m, joint, "_driver"), "driver", map->line);
    se3di_entry *entry = name ? se3di_machine_add(m, SE3DI_SECTION_DRIVERS) : NULL;
    if (!entry) {
        return false;
    }
    se3di_entry_put_text(m, entry, "name", name);
    se3di_entry_put_text(m, entry, "joint", joint);
    se3di_entry_put(m, entry, "value",
                    turned ? se3di_machine_quote(m, se3di_machine_text(m, "-(%s)", value))
                           : se3di_machine_quote(m, value));
    return m->status >= 0;
}

/* The function of a joint, NULL: it has none. */
static bool take_drive(se3di_machine *m, const se3di_node *map, const char *name,
                       const char **value)
{
    const se3di_node *node = se3di_me751_find(map, &se3di_me751_value_names);
    const char *text = se3di_me751_text_of(node);
    *value = NULL;
    if (!node || (text && (!text[0] || se3di_scan_equal(text, "none")))) {
        return true;
    }
    const char *expression = text ? se3di_me751_expression_of(m, text) : NULL;
    if (expression && se3di_me751_compiles(expression)) {
        *value = expression;
        return true;
    }
    if (m->status >= 0) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line,
                              "the function `%.100s` of `%.80s` is no expression in t: nothing "
                              "drives the joint",
                              text ? text : "", name);
    }
    return m->status >= 0;
}

static bool read_joint(se3di_me751_reader *r, const se3di_node *map, const joint_kind *kind)
{
    se3di_machine *m = r->m;
    se3di_machine_joint joint = {.type = kind->type};
    se3di_frame in[2];
    const char *value = NULL;
    joint.name =
        se3di_machine_name(m, se3di_me751_text_of(se3di_node_get(map, "name")), "joint", map->line);
    if (!joint.name || !se3di_me751_find_body(r, map, &se3di_me751_body_names[0], &joint.body_i) ||
        !se3di_me751_find_body(r, map, &se3di_me751_body_names[1], &joint.body_j) ||
        !read_marker(m, map, &marker_names[0], &in[0]) ||
        !read_marker(m, map, &marker_names[1], &in[1]) || !take_drive(m, map, joint.name, &value)) {
        return false;
    }
    if (joint.body_i == joint.body_j) {
        return se3di_machine_fail(m, map->line, map->column,
                                  "`%.80s` is between one body and itself", joint.name);
    }
    joint.frame_i = se3di_frame_of(&se3di_machine_body_at(m, joint.body_i)->frame, &in[0]);
    joint.frame_j = se3di_frame_of(&se3di_machine_body_at(m, joint.body_j)->frame, &in[1]);
    double *A = joint.frame_j.A, along = 0.0;
    for (int k = 0; k < 3; ++k) {
        along += joint.frame_i.A[3 * k + 2] * A[3 * k + 2];
    }
    const bool turned = along < 0.0 && (kind->has_angle || kind->has_displacement);
    for (int k = 0; k < 3 && turned; ++k) { /* the axes may point against each other there */
        A[3 * k + 1] = -A[3 * k + 1];
        A[3 * k + 2] = -A[3 * k + 2];
    }
    return se3di_machine_add_joint(m, &joint) != NULL &&
           (!value || put_driver(m, map, joint.name, kind, turned && kind->has_angle, value));
}

static bool put_sides(se3di_machine *m, const se3di_node *map, const primitive *kind,
                      se3di_entry *entry)
{
    static const char *const directions[2] = {"a_i", "a_j"};
    static const char *const points[2] = {"point_i", "point_j"};
    for (int k = 0; k < kind->directions; ++k) {
        if (!se3di_me751_put_vector(m, map, &se3di_me751_direction_names[k], directions[k], true,
                                    entry)) {
            return false;
        }
    }
    for (int k = 0; k < kind->points; ++k) {
        if (!se3di_me751_put_vector(m, map, &se3di_me751_point_names[k], points[k], false, entry)) {
            return false;
        }
    }
    return !kind->c || se3di_me751_put_vector(m, map, &c_names, "c", true, entry);
}

static bool read_constraint(se3di_me751_reader *r, const se3di_node *map)
{
    se3di_machine *m = r->m;
    const joint_kind *joint = map->kind == SE3DI_NODE_MAP ? find_joint(map) : NULL;
    if (joint) {
        return read_joint(r, map, joint);
    }
    const primitive *kind = map->kind == SE3DI_NODE_MAP ? find_primitive(m, map) : NULL;
    size_t bodies[2] = {0, 0};
    const char *value = NULL;
    if (!kind) {
        return m->status >= 0 && se3di_me751_expect(m, map, "a constraint");
    }
    const char *name = se3di_machine_name(m, se3di_me751_text_of(se3di_node_get(map, "name")),
                                          "constraint", map->line);
    if (!name || !se3di_me751_find_body(r, map, &se3di_me751_body_names[0], &bodies[0]) ||
        !se3di_me751_find_body(r, map, &se3di_me751_body_names[1], &bodies[1]) ||
        !se3di_me751_read_value(m, map, name, &value)) {
        return false;
    }
    if (bodies[0] == bodies[1]) {
        return se3di_machine_fail(m, map->line, map->column,
                                  "`%.80s` is between one body and itself", name);
    }
    se3di_entry *entry = se3di_machine_add(m, SE3DI_SECTION_CONSTRAINTS);
    se3di_entry_put_text(m, entry, "name", name);
    se3di_entry_put(m, entry, "type", kind->type);
    se3di_entry_put_text(m, entry, "body_i", se3di_machine_body_name(m, bodies[0]));
    se3di_entry_put_text(m, entry, "body_j", se3di_machine_body_name(m, bodies[1]));
    if (!entry || !put_sides(m, map, kind, entry)) {
        return false;
    }
    double number = 1.0;
    const size_t length = value ? se3di_scan_number(value, false, &number) : 0;
    if (strcmp(kind->type, "d") == 0 && (!value || (!value[length] && !(number > 0.0)))) {
        return se3di_machine_fail(m, map->line, map->column,
                                  "`%.80s` needs a `fun` > 0, the square of its distance", name);
    }
    if (value) {
        se3di_entry_put(m, entry, "value", value);
    }
    return m->status >= 0;
}

/* ---- files ----------------------------------------------------------------------------------*/

static bool read_all(se3di_me751_reader *r, const se3di_node *root, const char *key,
                     bool (*read)(se3di_me751_reader *r, const se3di_node *map))
{
    const se3di_node *list = se3di_node_get(root, key);
    if (list && list->kind != SE3DI_NODE_LIST) {
        return se3di_me751_expect(r->m, list, "a list");
    }
    for (const se3di_node *map = list ? list->first : NULL; map; map = map->next) {
        if (!read(r, map)) {
            return false;
        }
    }
    return true;
}

static void note_others(se3di_machine *m, const se3di_node *root)
{
    for (const se3di_node *at = root->first; at; at = at->next) {
        const bool read = se3di_me751_has_forces(at);
        const bool known = read || strcmp(at->key, "name") == 0 ||
                           strcmp(at->key, "gravity") == 0 || strcmp(at->key, "bodies") == 0 ||
                           strcmp(at->key, "constraints") == 0 ||
                           strcmp(at->key, "simulation") == 0;
        const bool empty = at->kind == SE3DI_NODE_LIST && at->count == 0;
        const bool acts = strstr(at->key, "orce") || strstr(at->key, "orque") ||
                          strstr(at->key, "SDA") || strstr(at->key, "sda");
        if (!known && !empty) {
            se3di_machine_note_of(m, acts ? SE3D_IMPORT_LOST : SE3D_IMPORT_NOTE, at->key_line,
                                  "`%.80s` is not read", at->key);
        }
    }
}

bool se3di_import_is_me751(const se3di_node *root)
{
    return root->kind == SE3DI_NODE_MAP && se3di_node_get(root, "bodies") &&
           se3di_node_get(root, "constraints") && !se3di_node_get(root, "se3d");
}

#define ROWS_MAX 1e8

/* How long it runs, and in how many rows; the method is the user's choice. */
static bool read_simulation(se3di_machine *m, const se3di_node *root)
{
    const se3di_node *map = se3di_node_get(root, "simulation");
    double rows = 0.0;
    if (map && map->kind == SE3DI_NODE_LIST && map->count == 1) {
        map = map->first;
    }
    if (!map || map->kind != SE3DI_NODE_MAP) {
        return true;
    }
    const se3di_node *duration = se3di_me751_find(map, &duration_names);
    const se3di_node *count = se3di_me751_find(map, &rows_names);
    double end = 0.0;
    if ((duration && !se3di_me751_read_number(m, duration, &end)) ||
        (count && !se3di_me751_read_number(m, count, &rows))) {
        return false;
    }
    if (rows > ROWS_MAX) {
        return se3di_me751_expect(m, count, "at most 1e8 rows");
    }
    if (end > 0.0 && end <= 1e9) {
        m->duration = end;
        m->step = rows >= 1.0 ? end / rows : 0.0;
    }
    return true;
}

bool se3di_import_me751(se3di_machine *m, const se3di_node *root)
{
    se3di_me751_reader r = {.m = m};
    const se3di_node *bodies = se3di_node_get(root, "bodies");
    const se3di_node *gravity = se3di_node_get(root, "gravity");
    if (!se3di_import_is_me751(root)) {
        return se3di_machine_fail(m, root->line, root->column,
                                  "a model of ME751 has `bodies` and `constraints`");
    }
    m->title = se3di_me751_text_of(se3di_node_get(root, "name"));
    r.bodies = se3di_iopool_array(m->pool, bodies->count + 1, sizeof *r.bodies);
    if (!r.bodies) {
        return se3di_machine_fail_memory(m);
    }
    if (gravity && !se3di_me751_read_numbers(m, gravity, m->gravity, 3)) {
        return false;
    }
    note_others(m, root);
    return read_simulation(m, root) && read_all(&r, root, "bodies", read_body) &&
           read_all(&r, root, "constraints", read_constraint) &&
           se3di_me751_read_forces(&r, root) && m->status >= 0;
}
