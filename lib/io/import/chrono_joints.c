/* SPDX-License-Identifier: BSD-3-Clause */
/* Chrono: joints, and bushings in their place. Its body 1 moves relative to body 2, so that body 2
 * is our body i. */
#include <string.h>

#include "io/import/chrono.h"
#include "io/import/scan.h"

typedef struct joint_type {
    const char *chrono, *type;
    char axis;     /* of its frame, which is our z; ' ': it has no axis */
    bool bushing;  /* it can be one */
    bool turns[3]; /* about its axes freely */
} joint_type;

static const joint_type types[] = {
    {"LOCK", "fixed", 'z', true, {false, false, false}},
    {"REVOLUTE", "revolute", 'z', true, {false, false, true}},
    {"SPHERICAL", "spherical", 'z', true, {true, true, true}},
    {"PRISMATIC", "prismatic", 'z', false, {false, false, false}},
    {"UNIVERSAL", "universal", 'u', true, {true, true, false}},
    {"POINT_LINE", "point_on_line", 'x', false, {true, true, true}},
    {"POINT_PLANE", "point_on_plane", 'z', false, {true, true, true}}};

static void turn_axes(const double A[9], int z, double out[9])
{
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            out[3 * i + k] = A[3 * i + (k + z + 1) % 3];
        }
    }
}

/* The axes of a universal joint: x along the first, y towards the second. */
static bool read_cross(se3di_chrono *c, const se3di_node *map, double A[9])
{
    double x[3];
    double y[3];
    double z[3];
    if (!se3di_chrono_has(c, map, "axis1") || !se3di_chrono_has(c, map, "axis2") ||
        !se3di_chrono_numbers(c, map, "axis1", x, 3) ||
        !se3di_chrono_numbers(c, map, "axis2", y, 3)) {
        return false;
    }
    se3di_cross(x, y, z);
    if (!se3di_turn_along_both(z, x, A)) {
        return se3di_machine_fail(c->m, map->line, map->column, "axis1 and axis2 are parallel");
    }
    return true;
}

static bool read_frame(se3di_chrono *c, const se3di_node *map, const joint_type *type,
                       se3di_frame *frame)
{
    if (!se3di_chrono_has(c, map, "location") ||
        !se3di_chrono_numbers(c, map, "location", frame->r, 3)) {
        return false;
    }
    if (strcmp(type->type, "revolute") == 0 || strcmp(type->type, "prismatic") == 0) {
        return se3di_chrono_has(c, map, "axis") && se3di_chrono_axis(c, map, "axis", frame->A);
    }
    return type->axis != 'u' || read_cross(c, map, frame->A);
}

typedef struct coefficients {
    double k_linear, c_linear, k_turn, c_turn;
} coefficients;

static bool read_coefficients(se3di_chrono *c, const se3di_node *map, coefficients *out)
{
    return se3di_chrono_number(c, map, "stiffness_linear", &out->k_linear) &&
           se3di_chrono_number(c, map, "damping_linear", &out->c_linear) &&
           se3di_chrono_number(c, map, "stiffness_rotational", &out->k_turn) &&
           se3di_chrono_number(c, map, "damping_rotational", &out->c_turn);
}

static void put_side(se3di_chrono *c, se3di_entry *entry, const se3di_chrono_body *body,
                     const se3di_frame *frame, bool first)
{
    se3di_machine *m = c->m;
    const se3di_frame in = se3di_frame_in(&se3di_machine_body_at(m, body->body)->frame, frame);
    se3di_entry_put_vector(m, entry, first ? "point_i" : "point_j", in.r);
    se3di_entry_put(m, entry, first ? "orientation_i" : "orientation_j",
                    se3di_machine_turn_text(m, in.A));
}

static bool add_bushing(se3di_chrono *c, const se3di_node *map, const joint_type *type,
                        const se3di_chrono_body *const bodies[2], const se3di_frame *frame)
{
    se3di_machine *m = c->m;
    const se3di_node *data = se3di_node_get(map, "bushing_data");
    const se3di_node *dof = se3di_node_get(data, "DOF");
    coefficients held = {0.0, 0.0, 0.0, 0.0};
    coefficients free = {0.0, 0.0, 0.0, 0.0};
    const char *wanted = se3di_chrono_need(c, map, "name");
    if (!wanted || !read_coefficients(c, data, &held) ||
        (dof && !read_coefficients(c, dof, &free))) {
        return false;
    }
    if (!type->bushing) {
        return se3di_chrono_lose(c, map, "bushing", "Chrono makes none of this type");
    }
    const char *name = se3di_machine_name(m, wanted, "force", map->line);
    se3di_entry *entry = name ? se3di_machine_add(m, SE3DI_SECTION_FORCES) : NULL;
    double K[6];
    double C[6];
    for (int k = 0; k < 3; ++k) {
        K[k] = held.k_linear;
        C[k] = held.c_linear;
        K[k + 3] = type->turns[k] ? free.k_turn : held.k_turn;
        C[k + 3] = type->turns[k] ? free.c_turn : held.c_turn;
    }
    if (!entry) {
        return false;
    }
    se3di_entry_put_text(m, entry, "name", name);
    se3di_entry_put(m, entry, "type", "bushing");
    se3di_entry_put_text(m, entry, "body_i", se3di_machine_body_name(m, bodies[1]->body));
    se3di_entry_put_text(m, entry, "body_j", se3di_machine_body_name(m, bodies[0]->body));
    put_side(c, entry, bodies[1], frame, true);
    put_side(c, entry, bodies[0], frame, false);
    se3di_entry_put(m, entry, "K", se3di_machine_numbers(m, K, 6));
    se3di_entry_put(m, entry, "C", se3di_machine_numbers(m, C, 6));
    se3di_machine_note_of(m, SE3D_IMPORT_NOTE, map->line,
                          "the torque of `%.80s` is that of Chrono for small angles; for large "
                          "ones ours has a potential",
                          name);
    return m->status >= 0;
}

static const joint_type *type_of(se3di_chrono *c, const se3di_node *map)
{
    const char *text = se3di_chrono_need(c, map, "type");
    for (size_t k = 0; text && k < sizeof types / sizeof *types; ++k) {
        if (se3di_scan_equal(text, types[k].chrono)) {
            return &types[k];
        }
    }
    if (text) {
        const se3di_node *at = se3di_node_get(map, "type");
        se3di_machine_fail(c->m, at->line, at->column,
                           "the joint `%.60s` is not known, must be LOCK, REVOLUTE, SPHERICAL, "
                           "PRISMATIC, UNIVERSAL, POINT_LINE or POINT_PLANE",
                           text);
    }
    return NULL;
}

bool se3di_chrono_joint(se3di_chrono *c, const se3di_node *map)
{
    se3di_frame frame = se3di_frame_identity();
    const se3di_chrono_body *bodies[2] = {NULL, NULL};
    bool differ = false;
    const char *wanted = se3di_chrono_need(c, map, "name");
    const joint_type *type = wanted ? type_of(c, map) : NULL;
    if (!type || !read_frame(c, map, type, &frame) ||
        !se3di_chrono_bodies_of(c, map, bodies, &differ)) {
        return false;
    }
    se3di_chrono_keys(c, map, "name type body1 body2 location axis axis1 axis2 bushing_data");
    if (!differ) {
        return true;
    }
    if (se3di_node_get(map, "bushing_data")) {
        return add_bushing(c, map, type, bodies, &frame);
    }
    se3di_machine_joint joint = {.name = se3di_machine_name(c->m, wanted, "joint", map->line),
                                 .type = type->type,
                                 .body_i = bodies[1]->body,
                                 .body_j = bodies[0]->body,
                                 .frame_i = frame,
                                 .frame_j = frame};
    if (type->axis == 'u') { /* x of body 1 is perpendicular to y of body 2 */
        turn_axes(frame.A, 1, joint.frame_i.A);
        turn_axes(frame.A, 0, joint.frame_j.A);
    } else if (type->axis == 'x') {
        turn_axes(frame.A, 0, joint.frame_i.A);
        turn_axes(frame.A, 0, joint.frame_j.A);
    }
    return joint.name && se3di_machine_add_joint(c->m, &joint) != NULL;
}

bool se3di_chrono_constraint(se3di_chrono *c, const se3di_node *map)
{
    const se3di_chrono_body *bodies[2] = {NULL, NULL};
    se3di_frame points[2] = {se3di_frame_identity(), se3di_frame_identity()};
    bool differ = false;
    const char *wanted = se3di_chrono_need(c, map, "name");
    const char *type = wanted ? se3di_chrono_need(c, map, "type") : NULL;
    if (!type) {
        return false;
    }
    if (!se3di_scan_equal(type, "DISTANCE")) {
        return se3di_chrono_lose(c, map, "constraint", "Chrono makes none of this type");
    }
    if (!se3di_chrono_has(c, map, "point1") || !se3di_chrono_has(c, map, "point2") ||
        !se3di_chrono_numbers(c, map, "point1", points[0].r, 3) ||
        !se3di_chrono_numbers(c, map, "point2", points[1].r, 3) ||
        !se3di_chrono_bodies_of(c, map, bodies, &differ)) {
        return false;
    }
    const double length = se3di_distance(points[0].r, points[1].r);
    if (!differ || !(length > 0.0)) {
        return !differ || se3di_chrono_lose(c, map, "constraint", "its points are one");
    }
    const se3di_machine_joint joint = {.name = se3di_machine_name(c->m, wanted, "joint", map->line),
                                       .type = "distance",
                                       .body_i = bodies[1]->body,
                                       .body_j = bodies[0]->body,
                                       .frame_i = points[1],
                                       .frame_j = points[0]};
    se3di_entry *entry = joint.name ? se3di_machine_add_joint(c->m, &joint) : NULL;
    if (!entry) {
        return false;
    }
    se3di_entry_put_number(c->m, entry, "distance", length);
    return c->m->status >= 0;
}
