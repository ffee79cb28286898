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
#include "io/import/scan.h"
#include "se3d/expression.h"

enum { NAMES_MAX = 8, KEY_MAX = 64 };

/* What a member may be called; letters and digits alone count, not their case. */
typedef struct member {
    const char *names[NAMES_MAX];
} member;

static const member id_names = {{"id"}};
static const member mass_names = {{"mass", "m"}};
static const member inertia_names = {{"jbar", "j", "inertia", "moi"}};
static const member state_names = {{"q0", "q", "qxyze0e1e2e3"}};
static const member rate_names = {{"qd0", "qd", "qdot"}};
static const member position_names = {{"r", "r0", "position"}};
static const member velocity_names = {{"rd", "dr", "rdot", "velocity"}};
static const member turn_names = {{"p", "p0", "eulerparameters"}};
static const member turn_rate_names = {{"pd", "dp", "pdot"}};
static const member fixed_names = {{"ground", "isground", "fixed"}};
static const member body_names[2] = {{{"body1", "bodyi", "i"}}, {{"body2", "bodyj", "j"}}};
static const member direction_names[2] = {{{"aibar", "ai", "abari", "a1", "a1bar", "ap1"}},
                                          {{"ajbar", "aj", "abarj", "a2", "a2bar", "ap2"}}};
static const member point_names[2] = {
    {{"spibar", "si", "sbari", "s1", "sibar", "spi", "s1bar", "sp1"}},
    {{"sqjbar", "sj", "sbarj", "s2", "sjbar", "sqj", "s2bar", "sp2"}}};
static const member c_names = {{"c"}};
static const member value_names = {{"fun", "f", "function"}};
static const member stiffness_names = {{"k", "stiffness", "spring"}};
static const member damping_names = {{"c", "damping", "damper"}};
static const member length_names = {{"l0", "lzero", "freelength", "restlength"}};
static const member angle_names = {{"theta0", "thetazero", "freeangle", "restangle"}};
static const member actuator_names = {{"h", "actuator", "fun", "function"}};
static const member one_body_names = {{"body", "body1", "bodyi", "body2", "bodyj"}};
static const member one_point_names = {
    {"sbar", "s", "spibar", "si", "sbari", "point", "location", "sp1"}};
static const member load_names = {{"force", "f", "value", "fun"}};
static const member torque_names = {{"torque", "t", "value", "fun"}};
static const member own_torque_names = {{"nbar", "tbar", "torquebar"}};
static const member frame_names = {{"frame"}};
static const member reference_names[2] = {{{"bibar", "bi", "fibar", "refi"}},
                                          {{"bjbar", "bj", "fjbar", "refj"}}};
static const member centre_names = {{"cg", "com"}};
static const member marker_names[2] = {{{"marker1", "markeri"}}, {{"marker2", "markerj"}}};
static const member corner_names[3] = {{{"p"}}, {{"q"}}, {{"r"}}};
static const member component_names[3] = {{{"funx", "fx"}}, {{"funy", "fy"}}, {{"funz", "fz"}}};
static const member duration_names = {{"tend", "duration", "endtime"}};
static const member rows_names = {{"outputsteps"}};
static const member value_rate_names[2] = {{{"df", "fdot", "ft"}}, {{"ddf", "fddot", "ftt"}}};

typedef struct reader {
    se3di_machine *m;
    se3di_ionames ids; /* of bodies, as in the file -> index in `bodies` */
    size_t *bodies;    /* of the machine, SE3DI_GROUND: the ground */
    size_t count;
} reader;

/* ---- members --------------------------------------------------------------------------------*/

/* Letters and digits in lower case, cut to KEY_MAX - 1. */
static void plain_text(const char *text, char plain[KEY_MAX])
{
    size_t used = 0;
    for (; *text && used + 1 < KEY_MAX; ++text) {
        const bool is_upper = *text >= 'A' && *text <= 'Z';
        if (is_upper || (*text >= 'a' && *text <= 'z') || (*text >= '0' && *text <= '9')) {
            plain[used++] = (char)(is_upper ? *text - 'A' + 'a' : *text);
        }
    }
    plain[used] = '\0';
}

static const se3di_node *find(const se3di_node *map, const member *wanted)
{
    for (const se3di_node *at = map->first; at && map->kind == SE3DI_NODE_MAP; at = at->next) {
        char plain[KEY_MAX];
        plain_text(at->key, plain);
        for (size_t k = 0; k < NAMES_MAX && wanted->names[k]; ++k) {
            if (strcmp(plain, wanted->names[k]) == 0) {
                return at;
            }
        }
    }
    return NULL;
}

static bool expect(se3di_machine *m, const se3di_node *node, const char *what)
{
    char path[200];
    se3di_node_format_path(node, path, sizeof path);
    return se3di_machine_fail(m, node->line, node->column, "%s must be %s", path, what);
}

static bool read_number(se3di_machine *m, const se3di_node *node, double *value)
{
    const char *text = node->kind == SE3DI_NODE_SCALAR ? node->text : "";
    const size_t length = se3di_scan_number(text, false, value);
    return (length > 0 && !text[length]) || expect(m, node, "a number of at most 1e40");
}

static bool read_numbers(se3di_machine *m, const se3di_node *node, double *values, size_t count)
{
    if (node->kind != SE3DI_NODE_LIST || node->count != count) {
        char what[40] = "0 numbers";
        what[0] = (char)('0' + count % 10);
        return expect(m, node, what);
    }
    for (const se3di_node *at = node->first; at; at = at->next) {
        if (!read_number(m, at, values++)) {
            return false;
        }
    }
    return true;
}

static bool read_member(se3di_machine *m, const se3di_node *map, const member *wanted,
                        double *values, size_t count)
{
    const se3di_node *node = find(map, wanted);
    return !node || read_numbers(m, node, values, count);
}

static const char *text_of(const se3di_node *node)
{
    return node && node->kind == SE3DI_NODE_SCALAR ? node->text : NULL;
}

/* ---- bodies ---------------------------------------------------------------------------------*/

static bool read_inertia(se3di_machine *m, const se3di_node *map, double J[9])
{
    const se3di_node *node = find(map, &inertia_names);
    double moments[3] = {1.0, 1.0, 1.0};
    memset(J, 0, 9 * sizeof *J);
    if (node && node->kind == SE3DI_NODE_LIST && node->count == 3 &&
        node->first->kind == SE3DI_NODE_LIST) {
        for (const se3di_node *row = node->first; row; row = row->next, J += 3) {
            if (!read_numbers(m, row, J, 3)) {
                return false;
            }
        }
        return true;
    }
    if (node && !read_numbers(m, node, moments, 3)) {
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
    if (!read_member(m, map, &state_names, q, 7) || !read_member(m, map, &rate_names, qd, 7) ||
        !read_member(m, map, &position_names, q, 3) ||
        !read_member(m, map, &turn_names, q + 3, 4) ||
        !read_member(m, map, &velocity_names, qd, 3) ||
        !read_member(m, map, &turn_rate_names, qd + 3, 4)) {
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
    const char *fixed = text_of(find(map, &fixed_names));
    const char *name = text_of(se3di_node_get(map, "name"));
    return (name && se3di_scan_equal(name, "ground")) ||
           (fixed && (se3di_scan_equal(fixed, "true") || strcmp(fixed, "1") == 0));
}

static bool read_mass(se3di_machine *m, const se3di_node *map, se3di_machine_body *body)
{
    const se3di_node *mass = find(map, &mass_names);
    body->mass = 1.0;
    if ((mass && !read_number(m, mass, &body->mass)) || !read_inertia(m, map, body->J)) {
        return false;
    }
    if (!(body->mass > 0.0)) {
        return se3di_machine_fail(m, mass->line, mass->column,
                                  "the mass of `%.80s` is %g kg, must be > 0", body->name,
                                  body->mass);
    }
    if (!mass || !find(map, &inertia_names)) {
        se3di_machine_note_of(m, SE3D_IMPORT_NOTE, map->line,
                              "`%.80s` has no %s: it gets 1, which kinematics does not ask for",
                              body->name, mass ? "inertia" : "mass");
    }
    return se3di_inertia_mend(m, body->name, map->line, body->mass, body->J);
}

static bool read_body(reader *r, const se3di_node *map)
{
    se3di_machine *m = r->m;
    const char *id = text_of(find(map, &id_names));
    const char *name = text_of(se3di_node_get(map, "name"));
    if (map->kind != SE3DI_NODE_MAP || (!id && !name)) {
        return expect(m, map, "a body with an `id`");
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
        !read_member(m, map, &centre_names, centre, 3)) {
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

/* 0 is the ground, unless a body is called so. */
static bool find_body(reader *r, const se3di_node *map, const member *wanted, size_t *body)
{
    const se3di_node *node = find(map, wanted);
    const char *id = text_of(node);
    if (!id) {
        return se3di_machine_fail(r->m, map->line, map->column, "this has no member `%s`",
                                  wanted->names[0]);
    }
    size_t index = 0;
    if (se3di_ionames_find(&r->ids, id, &index)) {
        *body = r->bodies[index];
        return true;
    }
    *body = SE3DI_GROUND;
    return se3di_scan_equal(id, "ground") || strcmp(id, "0") == 0 ||
           se3di_machine_fail(r->m, node->line, node->column, "there is no body %.60s", id);
}

/* The text of a function of t as ours: without "@(t)", "lambda t:", the "()" of pi(), and the dots
 * of operators that go element by element. */
static const char *expression_of(se3di_machine *m, const char *text)
{
    static const char *const heads[] = {"@(t)", "lambda t:", "np.", "numpy.", "math.", "()"};
    char *out = se3di_iopool_array(m->pool, strlen(text) + 1, 1);
    size_t used = 0;
    while (out && *text) {
        size_t skip = 0;
        for (size_t k = 0; k < sizeof heads / sizeof *heads; ++k) {
            const size_t length = strlen(heads[k]);
            skip = skip == 0 && strncmp(text, heads[k], length) == 0 ? length : skip;
        }
        if (skip == 0 && (*text == '.' && text[1] && strchr("*/^", text[1]))) {
            skip = 1;
        }
        if (skip == 0 && text[0] == '*' && text[1] == '*') {
            out[used++] = '^';
            skip = 2;
        } else if (skip == 0) {
            out[used++] = *text;
            skip = 1;
        }
        text += skip;
    }
    if (!out) {
        se3di_machine_fail_memory(m);
    }
    return out;
}

static bool compiles(const char *text)
{
    static const char *const time[] = {"t"};
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    def.text = text;
    def.variables = time;
    def.variable_count = 1;
    const bool good = !SE3D_FAILED(se3d_expression_create(&def, &expression, NULL));
    se3d_expression_destroy(expression);
    return good;
}

/* Numbers f, f', f'' are those at t = 0. *value NULL: it is 0. */
static bool read_value(se3di_machine *m, const se3di_node *map, const char *name,
                       const char **value)
{
    const se3di_node *node = find(map, &value_names);
    const char *text = text_of(node);
    double f = 0.0;
    double rates[2] = {0.0, 0.0};
    *value = NULL;
    if (!node || (text && (!text[0] || se3di_scan_equal(text, "none")))) {
        return true;
    }
    if (!text) {
        return expect(m, node, "a number or a function of t");
    }
    const size_t length = se3di_scan_number(text, false, &f);
    if (length == 0 || text[length]) {
        const char *expression = expression_of(m, text);
        if (expression && !compiles(expression)) {
            se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line,
                                  "the function `%.100s` of `%.80s` is no expression in t: it is 0",
                                  text, name);
            return true;
        }
        *value = expression ? se3di_machine_quote(m, expression) : NULL;
        return m->status >= 0;
    }
    for (int k = 0; k < 2; ++k) {
        const se3di_node *rate = find(map, &value_rate_names[k]);
        if (rate && !read_number(m, rate, &rates[k])) {
            return false;
        }
    }
    const bool moves = rates[0] != 0.0 || rates[1] != 0.0;
    const char *number = se3di_machine_number(m, f);
    *value = moves ? se3di_machine_text(m, "'%s + (%s)*t + (%s)/2*t^2'", number,
                                        se3di_machine_number(m, rates[0]),
                                        se3di_machine_number(m, rates[1]))
                   : number;
    return m->status >= 0;
}

typedef struct primitive {
    const char *type;
    int directions, points; /* of body i, or both */
    bool c;
} primitive;

static const primitive primitives[] = {
    {"dp1", 2, 0, false}, {"dp2", 1, 2, false}, {"d", 0, 2, false}, {"cd", 0, 2, true}};

static const primitive *find_primitive(se3di_machine *m, const se3di_node *map)
{
    const char *type = text_of(se3di_node_get(map, "type"));
    char plain[KEY_MAX];
    plain_text(type ? type : "", plain);
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

/* Note that something is not carried. */
static bool lose(se3di_machine *m, const se3di_node *node, const char *why)
{
    char path[200];
    se3di_node_format_path(node, path, sizeof path);
    se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line, "`%.120s` is not carried: %s", path,
                          why);
    return m->status >= 0;
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
    const char *type = text_of(se3di_node_get(map, "type"));
    char plain[KEY_MAX];
    plain_text(type ? type : "", plain);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        if (strcmp(plain, kinds[k].name) == 0) {
            return &kinds[k];
        }
    }
    return NULL;
}

/* A marker: P is its origin, Q a point on its z axis, R one in the half of its x-z plane where x is
 * positive. */
static bool read_marker(se3di_machine *m, const se3di_node *map, const member *wanted,
                        se3di_frame *frame)
{
    const se3di_node *node = find(map, wanted);
    double corners[3][3] = {{0.0}};
    if (node && node->kind == SE3DI_NODE_LIST && node->count == 1) {
        node = node->first;
    }
    if (!node || node->kind != SE3DI_NODE_MAP) {
        return se3di_machine_fail(m, map->line, map->column, "this has no `%s` of P, Q and R",
                                  wanted->names[0]);
    }
    for (int k = 0; k < 3; ++k) {
        if (!find(node, &corner_names[k])) {
            return se3di_machine_fail(m, node->line, node->column, "this has no member `%s`",
                                      corner_names[k].names[0]);
        }
        if (!read_member(m, node, &corner_names[k], corners[k], 3)) {
            return false;
        }
    }
    double z[3], x[3];
    for (int k = 0; k < 3; ++k) {
        z[k] = corners[1][k] - corners[0][k];
        x[k] = corners[2][k] - corners[0][k];
    }
    memcpy(frame->r, corners[0], sizeof frame->r);
    return se3di_turn_along_both(z, x, frame->A) || expect(m, node, "three points not in one line");
}

/* Drive the joint's coordinate by `value`; the angle is that of x of body j before x of body i. */
static bool put_driver(se3di_machine *m, const se3di_node *map, const char *joint,
                       const joint_kind *kind, bool turned, const char *value)
{
    if (!kind->has_angle && !kind->has_displacement) {
        return lose(m, map, "its `fun` would drive one of several coordinates");
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
    const se3di_node *node = find(map, &value_names);
    const char *text = text_of(node);
    *value = NULL;
    if (!node || (text && (!text[0] || se3di_scan_equal(text, "none")))) {
        return true;
    }
    const char *expression = text ? expression_of(m, text) : NULL;
    if (expression && compiles(expression)) {
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

static bool read_joint(reader *r, const se3di_node *map, const joint_kind *kind)
{
    se3di_machine *m = r->m;
    se3di_machine_joint joint = {.type = kind->type};
    se3di_frame in[2];
    const char *value = NULL;
    joint.name = se3di_machine_name(m, text_of(se3di_node_get(map, "name")), "joint", map->line);
    if (!joint.name || !find_body(r, map, &body_names[0], &joint.body_i) ||
        !find_body(r, map, &body_names[1], &joint.body_j) ||
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

static bool put_vector(se3di_machine *m, const se3di_node *map, const member *wanted,
                       const char *key, bool needed, se3di_entry *entry)
{
    double v[3] = {0.0, 0.0, 0.0};
    if (needed && !find(map, wanted)) {
        return se3di_machine_fail(m, map->line, map->column, "this has no member `%s`",
                                  wanted->names[0]);
    }
    if (!read_member(m, map, wanted, v, 3)) {
        return false;
    }
    if (needed && !(se3di_length(v) > 0.0)) {
        return expect(m, find(map, wanted), "a direction that is not 0");
    }
    se3di_entry_put_vector(m, entry, key, v);
    return m->status >= 0;
}

static bool put_sides(se3di_machine *m, const se3di_node *map, const primitive *kind,
                      se3di_entry *entry)
{
    static const char *const directions[2] = {"a_i", "a_j"};
    static const char *const points[2] = {"point_i", "point_j"};
    for (int k = 0; k < kind->directions; ++k) {
        if (!put_vector(m, map, &direction_names[k], directions[k], true, entry)) {
            return false;
        }
    }
    for (int k = 0; k < kind->points; ++k) {
        if (!put_vector(m, map, &point_names[k], points[k], false, entry)) {
            return false;
        }
    }
    return !kind->c || put_vector(m, map, &c_names, "c", true, entry);
}

static bool read_constraint(reader *r, const se3di_node *map)
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
        return m->status >= 0 && expect(m, map, "a constraint");
    }
    const char *name =
        se3di_machine_name(m, text_of(se3di_node_get(map, "name")), "constraint", map->line);
    if (!name || !find_body(r, map, &body_names[0], &bodies[0]) ||
        !find_body(r, map, &body_names[1], &bodies[1]) || !read_value(m, map, name, &value)) {
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

/* ---- forces ---------------------------------------------------------------------------------*/

/* A function of t as it is written; *value NULL: none that is an expression. */
static bool take_function(se3di_machine *m, const se3di_node *node, const char **value)
{
    double number = 0.0;
    const char *text = text_of(node);
    const size_t length = text ? se3di_scan_number(text, false, &number) : 0;
    *value = NULL;
    if (length > 0 && !text[length]) {
        *value = se3di_machine_number(m, number);
    } else if (text) {
        const char *expression = expression_of(m, text);
        *value = expression && compiles(expression) ? se3di_machine_quote(m, expression) : NULL;
    }
    return m->status >= 0;
}

static bool put_number(se3di_machine *m, const se3di_node *map, const member *wanted,
                       const char *key, se3di_entry *entry)
{
    const se3di_node *node = find(map, wanted);
    double value = 0.0;
    if (!node) {
        return true;
    }
    if (!read_number(m, node, &value)) {
        return false;
    }
    se3di_entry_put_number(m, entry, key, value);
    return m->status >= 0;
}

static se3di_entry *begin_force(se3di_machine *m, const se3di_node *map, const char *type)
{
    const char *name = se3di_machine_name(m, text_of(se3di_node_get(map, "name")), type, map->line);
    return se3di_machine_add_force(m, name, type);
}

/* What a spring has beside its points or axes. */
static bool put_law(se3di_machine *m, const se3di_node *map, bool turns, const char *actuator,
                    se3di_entry *entry)
{
    if (!put_number(m, map, &stiffness_names, "k", entry) ||
        !put_number(m, map, &damping_names, "c", entry) ||
        !put_number(m, map, turns ? &angle_names : &length_names, turns ? "theta0" : "l0", entry)) {
        return false;
    }
    if (actuator) {
        se3di_entry_put(m, entry, "h", actuator);
    }
    return m->status >= 0;
}

static bool put_points(se3di_machine *m, const se3di_node *map, se3di_entry *entry)
{
    return put_vector(m, map, &point_names[0], "point_i", false, entry) &&
           put_vector(m, map, &point_names[1], "point_j", false, entry);
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
    const se3di_node *from = find(map, &reference_names[1]) ? find(map, &reference_names[0]) : NULL;
    if (!put_vector(m, map, &direction_names[0], "axis_i", true, entry) ||
        !read_member(m, map, &direction_names[0], axis, 3) ||
        !read_member(m, map, &reference_names[0], ref, 3)) {
        return false;
    }
    if (from && are_parallel(axis, ref)) {
        return expect(m, from, "a direction across the axis");
    }
    for (int k = 0; k < 2 && from; ++k) {
        if (!put_vector(m, map, &reference_names[k], keys[k], true, entry)) {
            return false;
        }
    }
    return true;
}

static bool read_spring(reader *r, const se3di_node *map, bool turns)
{
    se3di_machine *m = r->m;
    const se3di_node *law = find(map, &actuator_names);
    const char *actuator = NULL;
    size_t bodies[2] = {0, 0};
    if (!find(map, &body_names[0]) || !find(map, &body_names[1])) {
        return lose(m, map, "it does not name two bodies");
    }
    if (turns && !find(map, &direction_names[0])) {
        return lose(m, map, "it has no axis `aiBAR`");
    }
    if (!find_body(r, map, &body_names[0], &bodies[0]) ||
        !find_body(r, map, &body_names[1], &bodies[1])) {
        return false;
    }
    if (bodies[0] == bodies[1]) {
        return lose(m, map, "it is between one body and itself");
    }
    if (law && !se3di_node_is_null(law) &&
        !se3di_scan_equal(text_of(law) ? text_of(law) : "", "none") &&
        !(take_function(m, law, &actuator) && actuator)) {
        return m->status >= 0 && lose(m, map, "its actuator is no number and no expression in t");
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
        const se3di_node *one = find(map, &component_names[k]);
        is_any |= one != NULL;
        if (one && (!take_function(m, one, &parts[k]) || !parts[k])) {
            return NULL;
        }
    }
    return is_any ? se3di_machine_text(m, "[%s, %s, %s]", parts[0], parts[1], parts[2]) : NULL;
}

/* A force at a point, or a torque; that of the ground's axes, or with the name of a torque in its
 * body's, or a `frame` that says so, of those. */
static bool read_load(reader *r, const se3di_node *map, bool turns)
{
    se3di_machine *m = r->m;
    const se3di_node *own = turns ? find(map, &own_torque_names) : NULL;
    const se3di_node *node = own ? own : find(map, turns ? &torque_names : &load_names);
    const char *frame = text_of(find(map, &frame_names));
    const char *value = node ? take_components(m, node) : take_single(m, map);
    size_t body = 0;
    if (!value || !find(map, &one_body_names)) {
        return m->status >= 0 && lose(m, map, "it needs a body, and three numbers or functions");
    }
    if (!find_body(r, map, &one_body_names, &body)) {
        return false;
    }
    if (body == SE3DI_GROUND) {
        return lose(m, map, "it acts on the ground");
    }
    se3di_entry *entry = begin_force(m, map, turns ? "torque" : "force");
    se3di_entry_put_text(m, entry, "body", se3di_machine_body_name(m, body));
    if (!entry || (!turns && find(map, &one_point_names) &&
                   !put_vector(m, map, &one_point_names, "point", false, entry))) {
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
    char plain[KEY_MAX];
    plain_text(text ? text : "", plain);
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (strcmp(plain, table[k].name) == 0) {
            return table[k].kind;
        }
    }
    return NO_FORCE;
}

static bool read_force(reader *r, const se3di_node *map, force_kind kind)
{
    const char *type = map->kind == SE3DI_NODE_MAP ? text_of(se3di_node_get(map, "type")) : NULL;
    kind = type ? kind_of(type) : kind;
    if (map->kind != SE3DI_NODE_MAP || kind == NO_FORCE || kind == SOME_FORCE) {
        return lose(r->m, map, "its `type` must be TSDA, RSDA, force or torque");
    }
    return kind == SPRING || kind == TURN_SPRING ? read_spring(r, map, kind == TURN_SPRING)
                                                 : read_load(r, map, kind == TORQUE);
}

static bool read_forces(reader *r, const se3di_node *root)
{
    for (const se3di_node *list = root->first; list; list = list->next) {
        const force_kind kind = kind_of(list->key);
        const bool is_list = kind != NO_FORCE && list->kind == SE3DI_NODE_LIST;
        for (const se3di_node *map = is_list ? list->first : NULL; map; map = map->next) {
            if (!read_force(r, map, kind)) {
                return false;
            }
        }
    }
    return true;
}

/* ---- files ----------------------------------------------------------------------------------*/

static bool read_all(reader *r, const se3di_node *root, const char *key,
                     bool (*read)(reader *r, const se3di_node *map))
{
    const se3di_node *list = se3di_node_get(root, key);
    if (list && list->kind != SE3DI_NODE_LIST) {
        return expect(r->m, list, "a list");
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
        const bool read = kind_of(at->key) != NO_FORCE && at->kind == SE3DI_NODE_LIST;
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
    const se3di_node *duration = find(map, &duration_names);
    const se3di_node *count = find(map, &rows_names);
    double end = 0.0;
    if ((duration && !read_number(m, duration, &end)) || (count && !read_number(m, count, &rows))) {
        return false;
    }
    if (end > 0.0 && end <= 1e9) {
        m->duration = end;
        m->step = rows >= 1.0 ? end / rows : 0.0;
    }
    return true;
}

bool se3di_import_me751(se3di_machine *m, const se3di_node *root)
{
    reader r = {.m = m};
    const se3di_node *bodies = se3di_node_get(root, "bodies");
    const se3di_node *gravity = se3di_node_get(root, "gravity");
    if (!se3di_import_is_me751(root)) {
        return se3di_machine_fail(m, root->line, root->column,
                                  "a model of ME751 has `bodies` and `constraints`");
    }
    m->title = text_of(se3di_node_get(root, "name"));
    r.bodies = se3di_iopool_array(m->pool, bodies->count + 1, sizeof *r.bodies);
    if (!r.bodies) {
        return se3di_machine_fail_memory(m);
    }
    if (gravity && !read_numbers(m, gravity, m->gravity, 3)) {
        return false;
    }
    note_others(m, root);
    return read_simulation(m, root) && read_all(&r, root, "bodies", read_body) &&
           read_all(&r, root, "constraints", read_constraint) && read_forces(&r, root) &&
           m->status >= 0;
}
