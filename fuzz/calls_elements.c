/* SPDX-License-Identifier: BSD-3-Clause */
/* Operations that create, change and destroy elements. */
#include "calls.h"

#include <math.h>

/* A body that may be gone, or null. */
static se3d_body pick_body(calls *c)
{
    const se3d_body none = {0, 0};
    const size_t k = calls_pick(c, CALLS_KEPT);
    return k < c->body_count ? c->bodies[k] : k % 3 == 0 ? none : c->bodies[c->body_count - 1];
}

static se3d_constraint pick_joint(calls *c)
{
    return c->joints[calls_pick(c, c->joint_count + (c->joint_count == 0))];
}

/* Mostly the null function. */
static se3d_function pick_function(calls *c)
{
    const se3d_function none = {0, 0};
    const size_t k = calls_pick(c, 2 * CALLS_KEPT);
    return k < c->function_count ? c->functions[k] : none;
}

/* Euler parameters of length 1, or now and then not. */
static void pick_orientation(calls *c, double p[4])
{
    double norm = 0.0;
    p[0] = 1.0;
    calls_vector(c, 1.0, p + 1);
    for (int k = 0; k < 4; ++k) {
        norm += p[k] * p[k];
    }
    for (int k = 0; k < 4; ++k) {
        p[k] /= sqrt(norm);
    }
    if (calls_pick(c, 16) == 15) {
        p[calls_pick(c, 4)] = calls_any_number(c);
    }
}

void calls_create_body(calls *c)
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    const uint64_t before = calls_state(c);
    const unsigned kind = calls_byte(c);
    def.mass = 1.0 + 0.9 * calls_number(c);
    for (int k = 0; k < 3; ++k) {
        def.inertia[k] = 0.1 + 0.02 * k + 0.01 * calls_number(c);
    }
    calls_vector(c, 2.0, def.position);
    if (kind & 1) {
        pick_orientation(c, def.orientation);
    }
    if (kind & 2) {
        calls_vector(c, 2.0, def.velocity);
        calls_vector(c, 2.0, def.angular_velocity);
    }
    if (kind % 16 == 15) {
        double *const fields[] = {&def.mass,        &def.inertia[0],  &def.inertia[3],
                                  &def.position[0], &def.velocity[2], &def.angular_velocity[1]};
        *fields[calls_pick(c, sizeof fields / sizeof *fields)] = calls_any_number(c);
    }
    if (c->body_count < CALLS_KEPT &&
        calls_edited(c, se3d_body_create(c->system, &def, &body), before)) {
        c->bodies[c->body_count++] = body;
    }
}

void calls_create_marker(calls *c)
{
    se3d_marker_def def = se3d_marker_def_default();
    se3d_marker marker;
    const uint64_t before = calls_state(c);
    def.body = pick_body(c);
    calls_vector(c, 1.0, def.position);
    pick_orientation(c, def.orientation);
    if (c->marker_count < CALLS_KEPT &&
        calls_edited(c, se3d_marker_create(c->system, &def, &marker), before)) {
        c->markers[c->marker_count++] = marker;
    }
}

void calls_create_function(calls *c)
{
    static const char *const texts[] = {"0.3*sin(5*t)",
                                        "t",
                                        "step(t, 0, 0, 0.1, 0.2)",
                                        "1/t",
                                        "sqrt(t - 1)",
                                        "(",
                                        "1e300*exp(t)",
                                        "if(t < 0.05, 0, 1)"};
    se3d_function_def def = se3d_function_def_default();
    se3d_function function;
    const uint64_t before = calls_state(c);
    if (calls_byte(c) & 1) {
        def.constant = calls_any_number(c);
    } else {
        def.expression = texts[calls_pick(c, sizeof texts / sizeof *texts)];
    }
    def.integrate = calls_pick(c, 8) == 7;
    if (c->function_count < CALLS_KEPT &&
        calls_edited(c, se3d_function_create(c->system, &def, &function), before)) {
        c->functions[c->function_count++] = function;
    }
}

typedef se3d_status (*joint_create)(se3d_system *, const se3d_joint_def *, se3d_constraint *);

static void keep_joint(calls *c, se3d_status status, se3d_constraint joint, uint64_t before)
{
    if (calls_edited(c, status, before)) {
        c->joints[c->joint_count++] = joint;
    }
}

/* By a frame at the present poses, so that joints fit, or by what the input says. */
void calls_create_joint(calls *c)
{
    static const joint_create all[] = {se3d_joint_create_revolute,
                                       se3d_joint_create_prismatic,
                                       se3d_joint_create_spherical,
                                       se3d_joint_create_fixed,
                                       se3d_joint_create_cylindrical,
                                       se3d_joint_create_universal,
                                       se3d_joint_create_planar,
                                       se3d_joint_create_screw,
                                       se3d_joint_create_point_on_line,
                                       se3d_joint_create_point_on_plane,
                                       se3d_joint_create_distance,
                                       se3d_joint_create_revolute_spherical,
                                       se3d_joint_create_revolute_cylindrical,
                                       se3d_joint_create_parallel,
                                       se3d_joint_create_perpendicular,
                                       se3d_joint_create_orientation,
                                       se3d_joint_create_perpendicular1,
                                       se3d_joint_create_perpendicular2};
    static const double axes[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6, 0, 0.8}};
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint = {0, 0};
    double at[3], axis[3];
    const uint64_t before = calls_state(c);
    const joint_create create = all[calls_pick(c, sizeof all / sizeof *all)];
    def.body_i = pick_body(c);
    def.body_j = pick_body(c);
    calls_vector(c, 2.0, at);
    const unsigned kind = calls_byte(c);
    for (int k = 0; k < 3; ++k) {
        axis[k] = axes[kind % 4][k];
    }
    def.pitch = 0.1;
    def.distance = 1.0 + 0.5 * calls_number(c);
    if (kind < 240) {
        (void)se3d_joint_def_set_frame(c->system, &def, at, axis, NULL);
    } else {
        calls_vector(c, 2.0, def.point_j);
        def.axis_j[calls_pick(c, 3)] = calls_any_number(c);
    }
    if (c->joint_count < CALLS_KEPT) {
        keep_joint(c, create(c->system, &def, &joint), joint, before);
    }
}

void calls_create_driver(calls *c)
{
    se3d_driver_def def = se3d_driver_def_default();
    se3d_constraint joint = {0, 0};
    const uint64_t before = calls_state(c);
    def.joint = pick_joint(c);
    def.coordinate = (int32_t)calls_pick(c, 3);
    def.value = calls_number(c);
    def.function = pick_function(c);
    if (c->joint_count < CALLS_KEPT) {
        keep_joint(c, se3d_driver_create(c->system, &def, &joint), joint, before);
    }
}

void calls_create_primitive(calls *c)
{
    se3d_primitive_def def = se3d_primitive_def_default();
    se3d_constraint joint = {0, 0};
    const uint64_t before = calls_state(c);
    def.type = (int32_t)calls_pick(c, 5);
    def.body_i = pick_body(c);
    def.body_j = pick_body(c);
    calls_vector(c, 1.0, def.a_i);
    calls_vector(c, 1.0, def.a_j);
    calls_vector(c, 1.0, def.point_j);
    calls_vector(c, 1.0, def.c);
    def.value = calls_any_number(c);
    def.function = pick_function(c);
    if (c->joint_count < CALLS_KEPT) {
        keep_joint(c, se3d_primitive_create(c->system, &def, &joint), joint, before);
    }
}

static void keep_force(calls *c, se3d_status status, se3d_force force, uint64_t before)
{
    if (calls_edited(c, status, before)) {
        c->forces[c->force_count++] = force;
    }
}

void calls_create_spring(calls *c)
{
    se3d_force force = {0, 0};
    const uint64_t before = calls_state(c);
    const se3d_body body_i = pick_body(c), body_j = pick_body(c);
    const double k = 100.0 * (1.0 + calls_number(c)), l0 = 1.0 + calls_number(c);
    const double damping = calls_any_number(c);
    if (c->force_count == CALLS_KEPT) {
        return;
    }
    if (calls_byte(c) & 1) {
        se3d_tsda_def def = se3d_tsda_def_default();
        def.body_i = body_i;
        def.body_j = body_j;
        calls_vector(c, 1.0, def.point_i);
        def.k = k;
        def.l0 = l0;
        def.c = damping;
        keep_force(c, se3d_force_create_tsda(c->system, &def, &force), force, before);
    } else {
        se3d_bushing_def def = se3d_bushing_def_default();
        def.body_i = body_i;
        def.body_j = body_j;
        for (int i = 0; i < 6; ++i) {
            def.K[7 * i] = k;
            def.C[7 * i] = damping;
        }
        keep_force(c, se3d_force_create_bushing(c->system, &def, &force), force, before);
    }
}

void calls_create_load(calls *c)
{
    se3d_load_def def = se3d_load_def_default();
    se3d_force force = {0, 0};
    const uint64_t before = calls_state(c);
    def.body = pick_body(c);
    calls_vector(c, 10.0, def.value);
    def.function[1] = pick_function(c);
    def.in_body_frame = (int32_t)calls_pick(c, 2);
    if (c->force_count == CALLS_KEPT) {
        return;
    }
    if (calls_byte(c) & 1) {
        keep_force(c, se3d_force_create_load(c->system, &def, &force), force, before);
    } else {
        keep_force(c, se3d_force_create_torque(c->system, &def, &force), force, before);
    }
}

static se3d_status create_stop(calls *c, se3d_constraint joint, int32_t coordinate,
                               se3d_force *force)
{
    se3d_stop_def def = se3d_stop_def_default();
    def.joint = joint;
    def.coordinate = coordinate;
    def.upper = 0.5 + calls_number(c);
    def.k = 1e3;
    def.restitution = 0.5;
    return se3d_force_create_stop(c->system, &def, force);
}

static se3d_status create_friction(calls *c, se3d_constraint joint, int32_t coordinate,
                                   se3d_force *force)
{
    se3d_friction_def def = se3d_friction_def_default();
    def.joint = joint;
    def.coordinate = coordinate;
    def.mu = 0.3 + 0.3 * calls_number(c);
    def.radius = 0.05;
    def.limit = 0.1 + 0.1 * calls_number(c);
    return se3d_force_create_friction(c->system, &def, force);
}

void calls_create_on_joint(calls *c)
{
    se3d_force force = {0, 0};
    const uint64_t before = calls_state(c);
    const se3d_constraint joint = pick_joint(c);
    const int32_t coordinate = (int32_t)calls_pick(c, 3);
    const size_t kind = calls_pick(c, 4);
    if (c->force_count == CALLS_KEPT) {
        return;
    }
    if (kind == 0) {
        keep_force(c, create_stop(c, joint, coordinate, &force), force, before);
    } else if (kind == 1) {
        keep_force(c, create_friction(c, joint, coordinate, &force), force, before);
    } else if (kind == 2) {
        se3d_effort_def def = se3d_effort_def_default();
        def.joint = joint;
        def.coordinate = coordinate;
        def.value = calls_any_number(c);
        keep_force(c, se3d_force_create_effort(c->system, &def, &force), force, before);
    } else {
        se3d_rsda_def def = se3d_rsda_def_default();
        def.joint = joint;
        def.k = 10.0 * (1.0 + calls_number(c));
        def.c = 1.0 + calls_number(c);
        def.h = pick_function(c);
        keep_force(c, se3d_force_create_rsda(c->system, &def, &force), force, before);
    }
}

void calls_create_shape(calls *c)
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape = {0, 0};
    se3d_status status = SE3D_OK;
    const se3d_material none = {0, 0};
    if (c->material.generation == none.generation) {
        se3d_material_def stuff = se3d_material_def_default();
        const uint64_t before = calls_state(c);
        stuff.density = 1000.0;
        stuff.stiffness = 1e4;
        if (!calls_edited(c, se3d_material_create(c->system, &stuff, &c->material), before)) {
            c->material = none;
        }
    }
    const uint64_t before = calls_state(c);
    def.material = c->material;
    def.body = pick_body(c);
    def.radius = 0.3 + 0.2 * calls_number(c);
    def.length = 0.3 + 0.2 * calls_number(c);
    def.size[0] = def.size[1] = def.size[2] = 0.5;
    def.semi_axes[0] = 0.3 + 0.2 * calls_number(c);
    def.semi_axes[1] = 0.2;
    def.semi_axes[2] = 0.1;
    switch (calls_pick(c, 6)) {
    case 0:
        status = se3d_shape_create_sphere(c->system, &def, &shape);
        break;
    case 1:
        status = se3d_shape_create_box(c->system, &def, &shape);
        break;
    case 2:
        status = se3d_shape_create_capsule(c->system, &def, &shape);
        break;
    case 3:
        status = se3d_shape_create_cylinder(c->system, &def, &shape);
        break;
    case 4:
        status = se3d_shape_create_ellipsoid(c->system, &def, &shape);
        break;
    default:
        status = se3d_shape_create_plane(c->system, &def, &shape);
        break;
    }
    if (calls_edited(c, status, before)) {
        c->shapes[c->shape_count++ % CALLS_KEPT] = shape;
    }
}

void calls_destroy(calls *c)
{
    se3d_system *system = c->system;
    const uint64_t before = calls_state(c);
    const size_t kind = calls_pick(c, 6), k = calls_pick(c, CALLS_KEPT);
    se3d_status status = SE3D_OK;
    switch (kind) {
    case 0:
        status = se3d_body_destroy(system, c->bodies[k]);
        break;
    case 1:
        status = se3d_constraint_destroy(system, c->joints[k]);
        break;
    case 2:
        status = se3d_force_destroy(system, c->forces[k]);
        break;
    case 3:
        status = se3d_marker_destroy(system, c->markers[k]);
        break;
    case 4:
        status = se3d_function_destroy(system, c->functions[k]);
        break;
    default:
        status = se3d_shape_destroy(system, c->shapes[k]);
        break;
    }
    (void)calls_edited(c, status, before);
}

void calls_set_state(calls *c)
{
    const se3d_body body = pick_body(c);
    const size_t kind = calls_pick(c, 5);
    const uint64_t before = calls_state(c);
    double v[4];
    se3d_status status;
    calls_vector(c, 2.0, v);
    if (calls_pick(c, 8) == 7) {
        v[calls_pick(c, 3)] = calls_any_number(c);
    }
    switch (kind) {
    case 0:
        status = se3d_body_set_position(c->system, body, v);
        break;
    case 1:
        status = se3d_body_set_velocity(c->system, body, v);
        break;
    case 2:
        status = se3d_body_set_angular_velocity(c->system, body, v);
        break;
    case 3:
        status = se3d_system_set_time(c->system, v[0]);
        break;
    default:
        pick_orientation(c, v);
        status = se3d_body_set_orientation(c->system, body, v);
        break;
    }
    (void)calls_edited(c, status, before);
}

void calls_set_value(calls *c)
{
    const size_t kind = calls_pick(c, 5), k = calls_pick(c, CALLS_KEPT);
    const double inertia[6] = {0.2, 0.2, 0.2, 0.0, 0.0, 0.0};
    const uint64_t before = calls_state(c);
    double v[3];
    se3d_status status;
    for (int i = 0; i < 3; ++i) {
        v[i] = calls_any_number(c);
    }
    switch (kind) {
    case 0:
        status = se3d_system_set_gravity(c->system, v);
        break;
    case 1:
        status = se3d_body_set_mass(c->system, c->bodies[k], v[0], inertia);
        break;
    case 2:
        status = se3d_force_set_value(c->system, c->forces[k], v);
        break;
    case 3:
        status = se3d_effort_set(c->system, c->forces[k], v[0]);
        break;
    default:
        status = se3d_function_set_constant(c->system, c->functions[k], v[0]);
        break;
    }
    (void)calls_edited(c, status, before);
}
