/* SPDX-License-Identifier: BSD-3-Clause */
/* Definitions that are asked back: misuse, and that what is made of them has the same ones. */
#ifndef SE3D_TESTS_MISUSE_DEFINITIONS_H
#define SE3D_TESTS_MISUSE_DEFINITIONS_H

#include "misuse/misuse_fields.h"
#include "misuse/misuse_world.h"

/* The reader of one kind of definitions: of `good` handles, which `other` ones have not. */
#define DEFINITION(what, handle_type, definition, good, other)                                     \
    do {                                                                                           \
        struct {                                                                                   \
            definition def;                                                                        \
            double beyond[4];                                                                      \
        } larger;                                                                                  \
        definition def = definition##_default();                                                   \
        const handle_type null_handle = {0, 0};                                                    \
        CHECK(se3d_##what(NULL, good, &def) == SE3D_ERR_NULL);                                     \
        CHECK(se3d_##what(a->system, good, NULL) == SE3D_ERR_NULL);                                \
        CHECK(se3d_##what(a->system, null_handle, &def) == SE3D_ERR_STALE_HANDLE);                 \
        CHECK(se3d_##what(a->system, good, &def) == SE3D_OK);                                      \
        CHECK(se3d_##what(a->system, other, &def) < 0);                                            \
        def.struct_size = 0;                                                                       \
        CHECK(se3d_##what(a->system, good, &def) == SE3D_ERR_INVALID_ARGUMENT);                    \
        memset(&larger, 0x5a, sizeof larger);                                                      \
        larger.def.struct_size = sizeof larger;                                                    \
        CHECK(se3d_##what(a->system, good, &larger.def) == SE3D_OK);                               \
        CHECK(larger.beyond[0] == 0.0 && larger.def.struct_size == sizeof larger);                 \
    } while (0)

/* Definitions of one kind, made again under another name: all but the name is the same. */
#define MADE_AGAIN(what, create, handle_type, definition, good)                                    \
    do {                                                                                           \
        definition def = definition##_default(), twin = definition##_default();                    \
        handle_type remade;                                                                        \
        CHECK(!se3d_##what(a->system, good, &def));                                                \
        def.name = NULL;                                                                           \
        CHECK(!se3d_##create(a->system, &def, &remade));                                           \
        CHECK(!se3d_##what(a->system, remade, &twin));                                             \
        CHECK(memcmp(&def, &twin, sizeof def) == 0);                                               \
    } while (0)

/* An element takes another value of a member of its definition, and nothing else; it is refused
 * what its creation refuses, and keeps its name. */
#define DEFINED_AGAIN(what, setter, handle_type, definition, good, member, value)                  \
    do {                                                                                           \
        definition again = definition##_default(), twin = definition##_default();                  \
        const handle_type null_handle = {0, 0};                                                    \
        CHECK(!se3d_##what(a->system, good, &again));                                              \
        CHECK(se3d_##setter(NULL, good, &again) == SE3D_ERR_NULL);                                 \
        CHECK(se3d_##setter(a->system, good, NULL) == SE3D_ERR_NULL);                              \
        CHECK(se3d_##setter(a->system, null_handle, &again) == SE3D_ERR_STALE_HANDLE);             \
        again.struct_size = 0;                                                                     \
        CHECK(se3d_##setter(a->system, good, &again) == SE3D_ERR_INVALID_ARGUMENT);                \
        again.struct_size = sizeof again;                                                          \
        CHECK(!se3d_##what(a->system, good, &twin) && memcmp(&again, &twin, sizeof again) == 0);   \
        const char *const own = again.name;                                                        \
        again.member = value;                                                                      \
        again.name = "a name that is not looked at";                                               \
        CHECK(!se3d_##setter(a->system, good, &again));                                            \
        CHECK(!se3d_##what(a->system, good, &twin));                                               \
        again.name = own;                                                                          \
        CHECK(memcmp(&again, &twin, sizeof again) == 0);                                           \
    } while (0)

/* An element is refused the definition of another kind, type or structure, and stays. */
#define IS_NO(setter, definition, good, part)                                                      \
    do {                                                                                           \
        definition fresh = definition##_default();                                                 \
        const uint64_t before = se3d_system_hash(a->system);                                       \
        CHECK(se3d_##setter(a->system, good, &fresh) < 0);                                         \
        CHECK_CONTAINS(se3d_system_get_error(a->system), part);                                    \
        CHECK(se3d_system_hash(a->system) == before);                                              \
    } while (0)

static se3d_status meet_nothing(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                                double *jacobian, double *nu, double *gamma)
{
    (void)ctx, (void)t, (void)bodies, (void)phi, (void)nu, (void)gamma;
    if (jacobian) {
        jacobian[2] = 1.0;
    }
    return SE3D_OK;
}

static void check_definitions_of_bodies(arguments *a)
{
    const handles *u = &a->use;
    se3d_marker_def marker = se3d_marker_def_default();
    se3d_user_constraint_def user = se3d_user_constraint_def_default();
    se3d_constraint made;
    se3d_marker found;
    DEFINITION(body_get_def, se3d_body, se3d_body_def, u->body, ((se3d_body){9, 9}));
    int32_t held = 0;
    CHECK(!se3d_body_set_held(a->system, u->body, 1));
    DEFINED_AGAIN(body_get_def, body_set_def, se3d_body, se3d_body_def, u->body, position[1], 0.25);
    CHECK(!se3d_body_get_held(a->system, u->body, &held) && held == 1);
    DEFINED_AGAIN(marker_get_def, marker_set_def, se3d_marker, se3d_marker_def, u->marker,
                  position[2], 0.5);
    IS_NO(body_set_def, se3d_body_def, ground_of(a), "ground");
    IS_NO(body_set_def, se3d_body_def, u->body, "mass = 0");
    marker.body = ground_of(a);
    CHECK(se3d_marker_set_def(a->system, u->marker, &marker) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "another kind, body or structure");
    marker.body = u->body;
    marker.name = "findable";
    CHECK(!se3d_marker_create(a->system, &marker, &found));
    CHECK(!se3d_marker_find(a->system, u->body, "findable", &found) && found.index1 > 0);
    CHECK(se3d_marker_find(a->system, ground_of(a), "findable", &found) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(found.index1 == 0);
    CHECK(se3d_marker_find(NULL, u->body, "findable", &found) == SE3D_ERR_NULL);
    CHECK(se3d_marker_find(a->system, u->body, NULL, &found) == SE3D_ERR_NULL);
    CHECK(se3d_marker_find(a->system, u->body, "findable", NULL) == SE3D_ERR_NULL);
    CHECK(se3d_marker_find(a->system, (se3d_body){9, 9}, "findable", &found) ==
          SE3D_ERR_STALE_HANDLE);
    user.callback = meet_nothing;
    user.bodies[0] = u->body;
    CHECK(!se3d_user_constraint_create(a->system, &user, &made));
    DEFINITION(user_constraint_get_def, se3d_constraint, se3d_user_constraint_def, made, u->pin);
    DEFINED_AGAIN(user_constraint_get_def, user_constraint_set_def, se3d_constraint,
                  se3d_user_constraint_def, made, ctx, &a->number);
    IS_NO(user_constraint_set_def, se3d_user_constraint_def, made, "callback");
    user.equation_count = 2;
    CHECK(se3d_user_constraint_set_def(a->system, made, &user) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_constraint_destroy(a->system, made));
}

/* The joint cannot get other bodies, and nothing changes. */
static void check_stays(arguments *a, se3d_constraint joint)
{
    se3d_joint_def def = se3d_joint_def_default(), still = se3d_joint_def_default();
    CHECK(!se3d_joint_get_def(a->system, joint, &def));
    CHECK(!se3d_joint_set_def(a->system, joint, &def));
    const se3d_body own = def.body_j;
    const uint64_t before = se3d_system_hash(a->system);
    CHECK(!se3d_body_find(a->system, "another", &def.body_j));
    CHECK(se3d_joint_set_def(a->system, joint, &def) == SE3D_ERR_IN_USE);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "on other bodies");
    CHECK(se3d_system_hash(a->system) == before);
    CHECK(!se3d_joint_get_def(a->system, joint, &still));
    CHECK(memcmp(&still.body_j, &own, sizeof own) == 0);
}

static se3d_function make_law_of(arguments *a, const se3d_signal *signal)
{
    static const char *const names[2] = {"t", "x"};
    se3d_function_def law = se3d_function_def_default();
    se3d_function made;
    law.expression = "2*x";
    law.variables = names;
    law.variable_count = 2;
    law.signals = signal;
    law.signal_count = 1;
    CHECK(!se3d_function_create(a->system, &law, &made));
    return made;
}

/* Of a joint, and of another force: what has copies of their bodies holds them. */
static void check_tied_joint(arguments *a, se3d_constraint joint)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_rsda_def rsda = se3d_rsda_def_default();
    se3d_joint_def def = se3d_joint_def_default();
    se3d_signal signal = {.kind = SE3D_SIGNAL_JOINT_COORDINATE, .joint = joint};
    se3d_body another;
    se3d_force made;
    se3d_function function;
    body.name = "another";
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    CHECK(!se3d_body_create(a->system, &body, &another));
    rsda.joint = joint;
    CHECK(!se3d_force_create_rsda(a->system, &rsda, &made));
    check_stays(a, joint);
    CHECK(!se3d_force_destroy(a->system, made));
    function = make_law_of(a, &signal);
    check_stays(a, joint);
    CHECK(!se3d_function_destroy(a->system, function));

    se3d_tsda_def tsda = se3d_tsda_def_default(), moved;
    CHECK(!se3d_force_get_tsda(a->system, a->use.force, &tsda));
    moved = tsda;
    moved.body_j = another;
    CHECK(!se3d_force_set_tsda(a->system, a->use.force, &moved));
    signal = (se3d_signal){.kind = SE3D_SIGNAL_FORCE_COORDINATE, .force = a->use.force};
    function = make_law_of(a, &signal);
    CHECK(se3d_force_set_tsda(a->system, a->use.force, &tsda) == SE3D_ERR_IN_USE);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "on other bodies");
    CHECK(!se3d_function_destroy(a->system, function));
    CHECK(!se3d_force_set_tsda(a->system, a->use.force, &tsda));

    CHECK(!se3d_joint_get_def(a->system, joint, &def));
    def.body_j = another;
    CHECK(!se3d_joint_set_def(a->system, joint, &def));
    def.body_j = a->use.body;
    CHECK(!se3d_joint_set_def(a->system, joint, &def));
    CHECK(!se3d_body_destroy(a->system, another)); /* nobody counts it any more */
}

/* The joint has drivers and couplers, or none. */
static void check_joint_again(arguments *a)
{
    const double at[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 1.0};
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint lone;
    CHECK(!se3d_joint_get_def(a->system, a->use.pin, &def));
    CHECK(se3d_joint_set_def(a->system, a->use.pin, &def) == SE3D_ERR_IN_USE);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "drivers or couplers");
    CHECK(!se3d_joint_def_set_frame(a->system, &def, at, axis, NULL));
    def.name = NULL;
    CHECK(!se3d_joint_create_revolute(a->system, &def, &lone));
    DEFINED_AGAIN(joint_get_def, joint_set_def, se3d_constraint, se3d_joint_def, lone, break_force,
                  7.0);
    check_tied_joint(a, lone);
    CHECK(!se3d_constraint_destroy(a->system, lone));
    CHECK(se3d_joint_set_def(a->system, a->use.driver, &def) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "is a driver");
}

static void check_definitions_of_constraints(arguments *a)
{
    const handles *u = &a->use;
    se3d_coupler_def coupler = se3d_coupler_def_default();
    se3d_constraint gear, coupled;
    DEFINITION(marker_get_def, se3d_marker, se3d_marker_def, u->marker, ((se3d_marker){9, 9}));
    DEFINITION(joint_get_def, se3d_constraint, se3d_joint_def, u->pin, u->driver);
    DEFINITION(driver_get_def, se3d_constraint, se3d_driver_def, u->driver, u->pin);
    DEFINITION(primitive_get_def, se3d_constraint, se3d_primitive_def, u->primitive, u->pin);
    MADE_AGAIN(joint_get_def, joint_create_revolute, se3d_constraint, se3d_joint_def, u->pin);
    MADE_AGAIN(joint_get_def, joint_create_prismatic, se3d_constraint, se3d_joint_def, u->slide);
    MADE_AGAIN(driver_get_def, driver_create, se3d_constraint, se3d_driver_def, u->driver);
    MADE_AGAIN(primitive_get_def, primitive_create, se3d_constraint, se3d_primitive_def,
               u->primitive);
    CHECK(!se3d_joint_create_rack_pinion(a->system, NULL, u->pin, u->slide, 0.25, &gear));
    CHECK(!se3d_coupler_get_def(a->system, gear, &coupler));
    CHECK(coupler.count == 2 && coupler.ratio[0] == -0.25 && coupler.ratio[1] == 1.0);
    CHECK(coupler.coordinate[1] == SE3D_JOINT_COORDINATE_DISPLACEMENT);
    CHECK(!se3d_joint_create_coupler(a->system, &coupler, &coupled));
    MADE_AGAIN(coupler_get_def, joint_create_coupler, se3d_constraint, se3d_coupler_def, coupled);
    DEFINITION(coupler_get_def, se3d_constraint, se3d_coupler_def, gear, u->pin);
    DEFINED_AGAIN(coupler_get_def, coupler_set_def, se3d_constraint, se3d_coupler_def, gear,
                  ratio[0], -0.5);
    DEFINED_AGAIN(coupler_get_def, coupler_set_def, se3d_constraint, se3d_coupler_def, coupled,
                  value, 0.125);
    DEFINED_AGAIN(driver_get_def, driver_set_def, se3d_constraint, se3d_driver_def, u->driver,
                  coordinate, SE3D_JOINT_COORDINATE_ANGLE);
    DEFINED_AGAIN(primitive_get_def, primitive_set_def, se3d_constraint, se3d_primitive_def,
                  u->primitive, point_j[1], 0.75);
    IS_NO(coupler_set_def, se3d_coupler_def, u->pin, "count");
    IS_NO(driver_set_def, se3d_driver_def, u->driver, "joint");
    IS_NO(primitive_set_def, se3d_primitive_def, u->primitive, "body_i");
    check_joint_again(a);
}

/* One of a type; the others are refused by all readers but its own. */
static void check_definitions_of_springs(arguments *a, se3d_body ground)
{
    const handles *u = &a->use;
    se3d_rsda_def rsda = se3d_rsda_def_default();
    se3d_bushing_def bushing = se3d_bushing_def_default();
    se3d_force made;
    DEFINITION(force_get_tsda, se3d_force, se3d_tsda_def, u->force, ((se3d_force){9, 9}));
    MADE_AGAIN(force_get_tsda, force_create_tsda, se3d_force, se3d_tsda_def, u->force);
    DEFINED_AGAIN(force_get_tsda, force_set_tsda, se3d_force, se3d_tsda_def, u->force, point_i[2],
                  0.5);
    IS_NO(force_set_tsda, se3d_tsda_def, u->force, "body_i");
    rsda.body_i = ground;
    rsda.body_j = u->body;
    rsda.axis_i[0] = 0.3;
    rsda.axis_i[1] = -0.7;
    rsda.angle0 = 20.0; /* three turns */
    rsda.k = 2.0;
    CHECK(!se3d_force_create_rsda(a->system, &rsda, &made));
    DEFINITION(force_get_rsda, se3d_force, se3d_rsda_def, made, u->force);
    MADE_AGAIN(force_get_rsda, force_create_rsda, se3d_force, se3d_rsda_def, made);
    DEFINED_AGAIN(force_get_rsda, force_set_rsda, se3d_force, se3d_rsda_def, made, k, 3.0);
    rsda.joint = u->pin;
    CHECK(se3d_force_set_rsda(a->system, made, &rsda) == SE3D_ERR_INVALID_ARGUMENT);
    rsda.joint = (se3d_constraint){0, 0};
    CHECK(se3d_force_set_rsda(a->system, u->force, &rsda) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "another kind, body or structure");
    bushing.body_i = ground;
    bushing.body_j = u->body;
    bushing.K[0] = 5.0;
    bushing.orientation_i[0] = bushing.orientation_i[2] = 0.70710678118654752440;
    CHECK(!se3d_force_create_bushing(a->system, &bushing, &made));
    DEFINITION(force_get_bushing_def, se3d_force, se3d_bushing_def, made, u->force);
    MADE_AGAIN(force_get_bushing_def, force_create_bushing, se3d_force, se3d_bushing_def, made);
    DEFINED_AGAIN(force_get_bushing_def, force_set_bushing_def, se3d_force, se3d_bushing_def, made,
                  point_j[0], 0.1);
}

static void check_definitions_on_bodies(arguments *a, se3d_body ground)
{
    const handles *u = &a->use;
    se3d_load_def load = se3d_load_def_default();
    se3d_tyre_def tyre = se3d_tyre_def_default();
    se3d_force made;
    load.body = u->body;
    load.value[1] = 3.0;
    load.in_body_frame = 1;
    CHECK(!se3d_force_create_torque(a->system, &load, &made));
    DEFINITION(force_get_load, se3d_force, se3d_load_def, made, u->force);
    MADE_AGAIN(force_get_load, force_create_load, se3d_force, se3d_load_def, made);
    DEFINED_AGAIN(force_get_load, force_set_load, se3d_force, se3d_load_def, made, function[1],
                  u->function);
    tyre.road = ground;
    tyre.wheel = u->body;
    tyre.side = SE3D_TYRE_RIGHT;
    tyre.axis[0] = 0.1;
    tyre.radius = 0.3;
    tyre.k = tyre.slip_stiffness = tyre.cornering_stiffness = 1e5;
    tyre.mu = 1.0;
    tyre.relaxation_x = 0.2;
    CHECK(!se3d_force_create_tyre(a->system, &tyre, &made));
    DEFINITION(force_get_tyre, se3d_force, se3d_tyre_def, made, u->force);
    MADE_AGAIN(force_get_tyre, force_create_tyre, se3d_force, se3d_tyre_def, made);
    DEFINED_AGAIN(force_get_tyre, force_set_tyre, se3d_force, se3d_tyre_def, made, k, 2e5);
}

static void check_definitions_on_joints(arguments *a)
{
    const handles *u = &a->use;
    se3d_force made;
    se3d_friction_def friction = se3d_friction_def_default();
    friction.joint = u->pin;
    friction.limit = 0.5;
    CHECK(!se3d_force_create_friction(a->system, &friction, &made));
    DEFINITION(force_get_friction, se3d_force, se3d_friction_def, made, u->force);
    MADE_AGAIN(force_get_friction, force_create_friction, se3d_force, se3d_friction_def, made);
    DEFINED_AGAIN(force_get_friction, force_set_friction, se3d_force, se3d_friction_def, made,
                  thrust_radius, 0.1);
    se3d_stop_def stop = se3d_stop_def_default();
    stop.joint = u->pin;
    stop.upper = 1.0;
    stop.k = 0.5;
    CHECK(!se3d_force_create_stop(a->system, &stop, &made));
    DEFINITION(force_get_stop, se3d_force, se3d_stop_def, made, u->force);
    MADE_AGAIN(force_get_stop, force_create_stop, se3d_force, se3d_stop_def, made);
    DEFINED_AGAIN(force_get_stop, force_set_stop, se3d_force, se3d_stop_def, made, upper, 2.0);
    se3d_effort_def effort = se3d_effort_def_default();
    effort.joint = u->pin;
    effort.value = 0.5;
    CHECK(!se3d_force_create_effort(a->system, &effort, &made));
    DEFINITION(force_get_effort, se3d_force, se3d_effort_def, made, u->force);
    MADE_AGAIN(force_get_effort, force_create_effort, se3d_force, se3d_effort_def, made);
    DEFINED_AGAIN(force_get_effort, force_set_effort, se3d_force, se3d_effort_def, made, function,
                  u->function);
    se3d_armature_def armature = se3d_armature_def_default();
    armature.joint = u->pin;
    armature.inertia = 0.5;
    CHECK(!se3d_force_create_armature(a->system, &armature, &made));
    DEFINITION(force_get_armature, se3d_force, se3d_armature_def, made, u->force);
    MADE_AGAIN(force_get_armature, force_create_armature, se3d_force, se3d_armature_def, made);
    DEFINED_AGAIN(force_get_armature, force_set_armature, se3d_force, se3d_armature_def, made,
                  inertia, 0.25);
}

static void check_definitions_of_forces(arguments *a)
{
    se3d_body ground;
    CHECK(!se3d_system_get_ground(a->system, &ground));
    check_definitions_of_springs(a, ground);
    check_definitions_on_bodies(a, ground);
    check_definitions_on_joints(a);
}

static se3d_status push_nothing(void *ctx, double t, const se3d_body_motion motion[2],
                                double wrench[12], double *K, double *D)
{
    (void)ctx, (void)t, (void)motion, (void)wrench, (void)K, (void)D;
    return SE3D_OK;
}

static void check_definitions_of_functions(arguments *a)
{
    static const double x[] = {0.0, 1.0, 3.0}, y[] = {1.0, 2.0, -1.0};
    se3d_function_def table = se3d_function_def_default(), found = se3d_function_def_default();
    se3d_function_def law = se3d_function_def_default();
    se3d_signal signal = {.kind = SE3D_SIGNAL_JOINT_RATE}, got;
    static const char *const names[] = {"t", "q"};
    se3d_function made;
    DEFINITION(function_get_def, se3d_function, se3d_function_def, a->use.function,
               ((se3d_function){9, 9}));
    table.table_x = x;
    table.table_y = y;
    table.table_count = 3;
    table.table_kind = SE3D_TABLE_AKIMA;
    table.integrate = 1;
    table.start = 0.5;
    CHECK(!se3d_function_create(a->system, &table, &made));
    CHECK(!se3d_function_get_def(a->system, made, &found));
    CHECK(found.table_count == 3 && found.table_y[2] == -1.0 && found.table_x[1] == 1.0);
    CHECK(found.table_kind == SE3D_TABLE_AKIMA && found.integrate && found.start == 0.5);
    law.expression = "2*q + t";
    law.variables = names;
    law.variable_count = 2;
    law.signals = &signal;
    law.signal_count = 1;
    signal.joint = a->use.pin;
    CHECK(!se3d_function_create(a->system, &law, &made));
    CHECK(!se3d_function_get_def(a->system, made, &found));
    CHECK(found.compiled && found.signal_count == 1 && !found.signals);
    CHECK(!se3d_function_get_signal(a->system, made, 0, &got));
    CHECK(got.kind == signal.kind && got.joint.index1 == a->use.pin.index1);
    CHECK(se3d_function_get_signal(a->system, made, 1, &got) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_function_get_signal(a->system, (se3d_function){0, 0}, 0, &got) ==
          SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_function_get_signal(NULL, made, 0, &got) == SE3D_ERR_NULL);
    CHECK(se3d_function_get_signal(a->system, made, 0, NULL) == SE3D_ERR_NULL);
}

static void check_definitions_of_the_rest(arguments *a)
{
    const handles *u = &a->use;
    se3d_force_callback_def callback = se3d_force_callback_def_default();
    se3d_force made;
    se3d_state state;
    const char *name = NULL;
    se3d_function gravity[3] = {{1, 1}, {1, 1}, {1, 1}};
    DEFINITION(state_get_def, se3d_state, se3d_state_def, u->state, ((se3d_state){9, 9}));
    MADE_AGAIN(state_get_def, state_create, se3d_state, se3d_state_def, u->state);
    DEFINITION(wheel_get_def, se3d_wheel, se3d_wheel_def, u->wheel, ((se3d_wheel){9, 9}));
    DEFINED_AGAIN(wheel_get_def, wheel_set_def, se3d_wheel, se3d_wheel_def, u->wheel, radius, 0.5);
    se3d_wheel_def wheel = se3d_wheel_def_default();
    CHECK(!se3d_wheel_get_def(a->system, u->wheel, &wheel));
    wheel.opposite = u->wheel;
    CHECK(se3d_wheel_set_def(a->system, u->wheel, &wheel) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "is the wheel itself");
    DEFINITION(road_get_def, se3d_road, se3d_road_def, u->road, ((se3d_road){9, 9}));
    DEFINED_AGAIN(road_get_def, road_set_def, se3d_road, se3d_road_def, u->road, point[2], 0.5);
    CHECK(se3d_system_count_functions(NULL) == 0 && se3d_system_count_functions(a->system) > 0);
    CHECK(!se3d_system_get_function(a->system, 0, &gravity[0]) && gravity[0].index1 > 0);
    CHECK(se3d_system_get_function(a->system, 99, &gravity[0]) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_system_get_function(NULL, 0, &gravity[0]) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_function(a->system, 0, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_system_get_ground(a->system, &callback.body_i));
    callback.body_j = u->body;
    callback.callback = push_nothing;
    CHECK(!se3d_force_create_callback(a->system, &callback, &made));
    DEFINITION(force_get_callback, se3d_force, se3d_force_callback_def, made, u->force);
    MADE_AGAIN(force_get_callback, force_create_callback, se3d_force, se3d_force_callback_def,
               made);
    DEFINED_AGAIN(force_get_callback, force_set_callback, se3d_force, se3d_force_callback_def, made,
                  ctx, &a->number);
    CHECK(!se3d_system_get_state(a->system, 0, &state) && state.index1 == u->state.index1);
    CHECK(se3d_system_get_state(a->system, 99, &state) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_system_get_state(NULL, 0, &state) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_state(a->system, 0, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_state_get_name(a->system, u->state, &name) && name && name[0]);
    CHECK(se3d_state_get_name(a->system, (se3d_state){0, 0}, &name) == SE3D_ERR_STALE_HANDLE);
    CHECK(!name && se3d_state_get_name(NULL, u->state, &name) == SE3D_ERR_NULL);
    CHECK(se3d_state_get_name(a->system, u->state, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_system_get_gravity_function(a->system, gravity) && gravity[2].index1 == 0);
    CHECK(se3d_system_get_gravity_function(NULL, gravity) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_gravity_function(a->system, NULL) == SE3D_ERR_NULL);
}

static void check_definitions_of_contacts(arguments *a)
{
    se3d_material_def stuff = se3d_material_def_default();
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    se3d_shape_def box = se3d_shape_def_default();
    se3d_material material, got;
    se3d_shape shape, found;
    int32_t type = -1;
    stuff.density = 1000.0;
    stuff.stiffness = 1e5;
    CHECK(!se3d_material_create(a->system, &stuff, &material));
    pair.friction = 0.25;
    CHECK(!se3d_material_set_pair(a->system, material, material, &pair));
    pair.friction = 9.0;
    CHECK(!se3d_material_get_pair(a->system, material, material, &pair) && pair.friction == 0.25);
    CHECK(pair.restitution < 0.0);
    CHECK(se3d_material_get_pair(NULL, material, material, &pair) == SE3D_ERR_NULL);
    CHECK(se3d_material_get_pair(a->system, material, material, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_material_get_pair(a->system, material, (se3d_material){0, 0}, &pair) ==
          SE3D_ERR_STALE_HANDLE);
    pair.struct_size = 0;
    CHECK(se3d_material_get_pair(a->system, material, material, &pair) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_system_count_materials(NULL) == 0 && se3d_system_count_materials(a->system) == 1);
    CHECK(!se3d_system_get_material(a->system, 0, &got) && got.index1 == material.index1);
    CHECK(se3d_system_get_material(a->system, 9, &got) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_system_get_material(NULL, 0, &got) == SE3D_ERR_NULL);
    box.body = a->use.body;
    box.material = material;
    box.size[0] = box.size[1] = box.size[2] = 0.1;
    box.orientation[0] = 0.6;
    box.orientation[3] = 0.8;
    CHECK(!se3d_shape_create_box(a->system, &box, &shape));
    DEFINITION(shape_get_def, se3d_shape, se3d_shape_def, shape, ((se3d_shape){9, 9}));
    MADE_AGAIN(shape_get_def, shape_create_box, se3d_shape, se3d_shape_def, shape);
    CHECK(!se3d_shape_get_type(a->system, shape, &type) && type == SE3D_SHAPE_BOX);
    CHECK(se3d_shape_get_type(NULL, shape, &type) == SE3D_ERR_NULL);
    CHECK(se3d_shape_get_type(a->system, shape, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_shape_get_type(a->system, (se3d_shape){0, 0}, &type) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_system_count_shapes(NULL) == 0 && se3d_system_count_shapes(a->system) == 2);
    CHECK(!se3d_system_get_shape(a->system, 0, &found) && found.index1 == shape.index1);
    CHECK(se3d_system_get_shape(a->system, 2, &found) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_system_get_shape(NULL, 0, &found) == SE3D_ERR_NULL);
    CHECK(!se3d_shape_set_filter(a->system, shape, 2, 4) &&
          !se3d_shape_get_def(a->system, shape, &box));
    CHECK(box.group == 2 && box.mask == 4);
    CHECK(se3d_shape_set_filter(NULL, shape, 2, 4) == SE3D_ERR_NULL);
    CHECK(se3d_shape_set_filter(a->system, (se3d_shape){0, 0}, 2, 4) == SE3D_ERR_STALE_HANDLE);
    CHECK(!se3d_shape_set_material(a->system, shape, (se3d_material){0, 0}));
    CHECK(!se3d_shape_get_def(a->system, shape, &box) && box.material.index1 == 0);
    CHECK(!se3d_shape_set_material(a->system, shape, material));
    CHECK(!se3d_shape_get_def(a->system, shape, &box) && box.material.index1 == material.index1);
    CHECK(se3d_shape_set_material(NULL, shape, material) == SE3D_ERR_NULL);
    CHECK(se3d_shape_set_material(a->system, (se3d_shape){0, 0}, material) ==
          SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_shape_set_material(a->system, shape, (se3d_material){9, 9}) ==
          SE3D_ERR_STALE_HANDLE);
}

/* On a clone: the elements that it makes would be in the way of other cases. */
static se3d_status definitions_reject_misuse(arguments *a)
{
    se3d_system *original = a->system;
    CHECK(!se3d_system_clone(original, &a->system));
    check_definitions_of_bodies(a);
    check_definitions_of_constraints(a);
    check_definitions_of_forces(a);
    check_definitions_of_functions(a);
    check_definitions_of_the_rest(a);
    check_definitions_of_contacts(a);
    se3d_system_destroy(a->system);
    a->system = original;
    return SE3D_OK;
}

static se3d_status expressions_are_written_again(arguments *a)
{
    static const char *const names[] = {"t"};
    const char *const other[] = {"'pin 1.angle'"};
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    char text[64];
    size_t length = 0;
    (void)a;
    def.text = "2*(t + 1)";
    def.variables = names;
    def.variable_count = 1;
    CHECK(!se3d_expression_create(&def, &expression, NULL));
    CHECK(!se3d_expression_write(expression, other, text, sizeof text, &length));
    CHECK(strcmp(text, "2*('pin 1.angle' + 1)") == 0 && length == strlen(text));
    CHECK(!se3d_expression_write(expression, other, NULL, 0, &length) && length == strlen(text));
    CHECK(se3d_expression_write(expression, other, text, 5, &length) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(strlen(text) == 4 && length > 4);
    CHECK(se3d_expression_write(NULL, other, text, 5, &length) == SE3D_ERR_NULL && length == 0);
    CHECK(se3d_expression_write(expression, NULL, text, 5, &length) == SE3D_ERR_NULL);
    CHECK(se3d_expression_write(expression, other, text, 5, NULL) == SE3D_ERR_NULL);
    se3d_expression_destroy(expression);
    return SE3D_OK;
}

#endif
