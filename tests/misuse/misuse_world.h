/* SPDX-License-Identifier: BSD-3-Clause */
/* What every row of the misuse table is called with: a small system, and handles that are null,
 * stale and of another system. */
#ifndef SE3D_TESTS_MISUSE_WORLD_H
#define SE3D_TESTS_MISUSE_WORLD_H

#include "check.h"
#include "se3d/se3d.h"

#include <stdio.h>

typedef struct handles {
    se3d_body body;
    se3d_marker marker;
    se3d_constraint pin, slide, driver, primitive;
    se3d_function function;
    se3d_force force;
    se3d_wheel wheel;
    se3d_road road;
    se3d_state state;
} handles;

typedef union def_storage {
    size_t struct_size; /* the first member of every def */
    double numbers[160];
} def_storage;

/* The arguments of one call, any of which a case spoils. */
typedef struct arguments {
    se3d_system *system;
    handles use;
    double vector[12], number;
    const double *in;
    const char *text;
    size_t index;
    def_storage storage;
    const void *def;
    double out_storage[4][40];
    void *out[4];
    se3d_solver *solver;
    se3d_snapshot *snapshot;
    se3d_check *check;
    se3d_expression *expression;
} arguments;

static se3d_body_def body_def(const char *name)
{
    se3d_body_def def = se3d_body_def_default();
    def.name = name;
    def.mass = 2.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    return def;
}

/* One element of each kind; they are named after `name` so that a set can be added again. */
static void add_elements(se3d_system *system, handles *h, const char *name)
{
    se3d_body ground;
    se3d_body_def body = body_def(name);
    CHECK(!se3d_system_get_ground(system, &ground));
    CHECK(!se3d_body_create(system, &body, &h->body));
    se3d_marker_def marker = se3d_marker_def_default();
    marker.name = name;
    marker.body = h->body;
    CHECK(!se3d_marker_create(system, &marker, &h->marker));
    se3d_joint_def joint = se3d_joint_def_default();
    joint.body_i = ground;
    joint.body_j = h->body;
    joint.name = name;
    CHECK(!se3d_joint_create_revolute(system, &joint, &h->pin));
    joint.name = NULL;
    CHECK(!se3d_joint_create_prismatic(system, &joint, &h->slide));
    CHECK(!se3d_function_create_expression(system, "0*t", &h->function));
    se3d_driver_def driver = se3d_driver_def_default();
    driver.joint = h->pin;
    CHECK(!se3d_driver_create(system, &driver, &h->driver));
    se3d_primitive_def primitive = se3d_primitive_def_default();
    primitive.type = SE3D_PRIMITIVE_CD;
    primitive.body_i = ground;
    primitive.body_j = h->body;
    primitive.c[0] = 1.0;
    CHECK(!se3d_primitive_create(system, &primitive, &h->primitive));
    se3d_tsda_def spring = se3d_tsda_def_default();
    spring.name = name;
    spring.body_i = ground;
    spring.body_j = h->body;
    spring.point_j[0] = 1.0;
    spring.k = 1.0;
    CHECK(!se3d_force_create_tsda(system, &spring, &h->force));
    se3d_wheel_def wheel = se3d_wheel_def_default();
    wheel.name = name;
    wheel.body = h->body;
    wheel.chassis = ground;
    wheel.radius = 0.3;
    CHECK(!se3d_wheel_create(system, &wheel, &h->wheel));
    se3d_road_def road = se3d_road_def_default();
    road.name = name;
    road.body = h->body;
    CHECK(!se3d_road_create(system, &road, &h->road));
    se3d_state_def state = se3d_state_def_default();
    char text[32];
    snprintf(text, sizeof text, "%s state", name); /* forces and states have names of one kind */
    state.name = text;
    CHECK(!se3d_state_create(system, &state, &h->state));
}

static void remove_elements(se3d_system *system, const handles *h)
{
    CHECK(!se3d_state_destroy(system, h->state));
    CHECK(!se3d_road_destroy(system, h->road));
    CHECK(!se3d_wheel_destroy(system, h->wheel));
    CHECK(!se3d_force_destroy(system, h->force));
    CHECK(!se3d_constraint_destroy(system, h->primitive));
    CHECK(!se3d_constraint_destroy(system, h->driver));
    CHECK(!se3d_constraint_destroy(system, h->slide));
    CHECK(!se3d_constraint_destroy(system, h->pin));
    CHECK(!se3d_function_destroy(system, h->function));
    CHECK(!se3d_marker_destroy(system, h->marker));
    CHECK(!se3d_body_destroy(system, h->body));
}

typedef struct misuse_world {
    se3d_system *system, *other;
    handles live, stale, foreign, none;
} misuse_world;

static void misuse_world_open(misuse_world *w)
{
    *w = (misuse_world){0};
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_create(NULL, &w->other));
    add_elements(w->system, &w->live, "taken");
    add_elements(w->system, &w->stale, "gone");
    remove_elements(w->system, &w->stale);
    add_elements(w->other, &w->foreign, "taken"); /* the same indices */
}

static void misuse_world_close(misuse_world *w)
{
    se3d_system_destroy(w->system);
    se3d_system_destroy(w->other);
}

#endif
