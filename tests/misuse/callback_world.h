/* SPDX-License-Identifier: BSD-3-Clause */
/* A system whose run calls user code of every kind, and code that meddles from within. */
#ifndef SE3D_TESTS_MISUSE_CALLBACK_WORLD_H
#define SE3D_TESTS_MISUSE_CALLBACK_WORLD_H

#include "check.h"
#include "se3d/se3d.h"
#include "support/parts.h"

typedef enum kind {
    KIND_FORCE = 0,
    KIND_FUNCTION = 1,
    KIND_CONSTRAINT = 2,
    KIND_LAW = 3,
    KIND_INTERRUPT = 4,
    KIND_VALUE = 5, /* of an event */
    KIND_EVENT = 6, /* the callback of one */
    KIND_LOG = 7,   /* which is told that a row is redundant, if there is one */
    KIND_COUNT = 8
} kind;

static const char *const kind_names[KIND_COUNT] = {"force",     "function", "constraint", "law",
                                                   "interrupt", "value",    "event",      "log"};

typedef struct world {
    se3d_system *system;
    se3d_solver *solver;
    se3d_particles *particles; /* NULL: none */
    se3d_snapshot *snapshot;
    se3d_coordinates *coordinates;
    se3d_body ball, bar, kite;
    se3d_marker marker;
    se3d_wheel wheel;
    se3d_road road;
    se3d_state state;
    se3d_constraint pin, motor, guide, rail;
    se3d_force push, load, spring, mount, turn, tyre;
    se3d_function value, constant, no_functions[3];
    se3d_shape pad;
    se3d_material stuff;
    se3d_event event;
    se3d_contact_settings contact, contact_read;
    se3d_material_pair_def pair;
    se3d_material_def other_stuff;
    se3d_joint_def frame;
    double r[3], v[3], p[4], inertia[6], many[64], time;
    uint32_t ids[1];
    double storage[4][512];
    void *out[4];
    /* what meddles: in the call of this number of callbacks of the kind */
    kind kind;
    int at;
    int calls[KIND_COUNT];
    int meddling; /* not 0: a callback of this kind is at it; none may come to be called meanwhile
                   */
    int nested;
    void (*meddle)(struct world *w);
} world;

static void world_note(world *w, kind which)
{
    w->nested += w->meddling;
    if (!w->meddling && ++w->calls[which] == w->at && w->kind == which && w->meddle) {
        w->meddling = 1;
        w->meddle(w);
        w->meddling = 0;
    }
}

static se3d_status world_push(void *ctx, double t, const se3d_body_motion motion[2],
                              double wrench[12], double *K, double *D)
{
    (void)K, (void)D;
    world_note(ctx, KIND_FORCE);
    wrench[7] = 0.3 * sin(20.0 * t);
    wrench[8] = -0.5 * motion[1].v[2];
    return SE3D_OK;
}

static se3d_status world_value(void *ctx, const double *x, double jet[3], double *gradient)
{
    world_note(ctx, KIND_FUNCTION);
    jet[0] = 0.2 * sin(30.0 * x[0]);
    jet[1] = 6.0 * cos(30.0 * x[0]);
    jet[2] = -180.0 * sin(30.0 * x[0]);
    if (gradient) {
        gradient[0] = jet[1];
    }
    return SE3D_OK;
}

/* The kite stays in the plane x = 0.25. */
static se3d_status world_guide(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                               double *jacobian, double *nu, double *gamma)
{
    (void)t, (void)nu, (void)gamma;
    world_note(ctx, KIND_CONSTRAINT);
    if (phi) {
        phi[0] = bodies[0].r[0] - 0.25;
    }
    if (jacobian) {
        jacobian[0] = 1.0;
    }
    return SE3D_OK;
}

static se3d_status world_law(void *ctx, const se3d_contact_input *in, se3d_contact_output *out)
{
    world_note(ctx, KIND_LAW);
    out->force = 2e4 * in->overlap - 20.0 * in->onset * in->velocity;
    return SE3D_OK;
}

static int world_interrupt(void *ctx)
{
    world_note(ctx, KIND_INTERRUPT);
    return 0;
}

static se3d_status world_height(void *ctx, const se3d_system *system, double *value)
{
    world *w = ctx;
    double r[3];
    world_note(w, KIND_VALUE);
    const se3d_status status = se3d_body_get_position(system, w->ball, r);
    *value = r[2];
    return status;
}

static se3d_status world_event(void *ctx, se3d_system *system, const se3d_event_record *record)
{
    (void)system, (void)record;
    world_note(ctx, KIND_EVENT);
    return SE3D_OK;
}

static void world_log(void *ctx, se3d_log_level level, se3d_log_kind what, const char *message)
{
    (void)level, (void)what, (void)message;
    if (!((const world *)ctx)->meddling) { /* else of what was refused */
        world_note(ctx, KIND_LOG);
    }
}

static void world_add_bodies(world *w)
{
    se3d_body ground;
    se3d_body_def body = se3d_body_def_default();
    se3d_marker_def marker = se3d_marker_def_default();
    CHECK(!se3d_system_get_ground(w->system, &ground));
    body.name = "name";
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.004;
    body.position[0] = 1.0;
    body.position[2] = 0.1005;
    body.velocity[2] = -0.2;
    CHECK(!se3d_body_create(w->system, &body, &w->ball));
    body.name = NULL;
    body.position[0] = 0.25;
    body.position[2] = 0.0;
    body.velocity[2] = 0.0;
    CHECK(!se3d_body_create(w->system, &body, &w->bar));
    CHECK(!se3d_body_create(w->system, &body, &w->kite));
    w->pin = part_hinge(w->system, "name", w->bar, -0.25);
    marker.name = "name";
    marker.body = w->bar;
    CHECK(!se3d_marker_create(w->system, &marker, &w->marker));
    se3d_wheel_def wheel = se3d_wheel_def_default();
    wheel.body = w->bar;
    wheel.chassis = ground;
    wheel.radius = 0.3;
    CHECK(!se3d_wheel_create(w->system, &wheel, &w->wheel));
    se3d_road_def road = se3d_road_def_default();
    road.body = ground;
    CHECK(!se3d_road_create(w->system, &road, &w->road));
    se3d_state_def state = se3d_state_def_default();
    CHECK(!se3d_state_create(w->system, &state, &w->state));
}

static void world_add_callbacks(world *w)
{
    se3d_function_def value = se3d_function_def_default();
    se3d_force_callback_def push = se3d_force_callback_def_default();
    se3d_user_constraint_def guide = se3d_user_constraint_def_default();
    se3d_driver_def motor = se3d_driver_def_default();
    value.callback = world_value;
    guide.ctx = push.ctx = value.ctx = w;
    CHECK(!se3d_function_create(w->system, &value, &w->value));
    motor.joint = w->pin;
    motor.function = w->value;
    CHECK(!se3d_driver_create(w->system, &motor, &w->motor));
    CHECK(!se3d_system_get_ground(w->system, &push.body_i));
    push.name = "name";
    push.body_j = w->ball;
    push.callback = world_push;
    CHECK(!se3d_force_create_callback(w->system, &push, &w->push));
    guide.callback = world_guide;
    guide.bodies[0] = w->kite;
    CHECK(!se3d_user_constraint_create(w->system, &guide, &w->guide));
}

/* What has values to set. */
static void world_add_values(world *w)
{
    se3d_body ground;
    se3d_load_def load = se3d_load_def_default();
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_bushing_def mount = se3d_bushing_def_default();
    se3d_primitive_def rail = se3d_primitive_def_default();
    se3d_function_def constant = se3d_function_def_default();
    CHECK(!se3d_system_get_ground(w->system, &ground));
    CHECK(!se3d_function_create(w->system, &constant, &w->constant));
    load.body = w->kite;
    load.function[2] = w->constant;
    CHECK(!se3d_force_create_load(w->system, &load, &w->load));
    spring.body_i = mount.body_i = rail.body_i = ground;
    spring.body_j = mount.body_j = rail.body_j = w->kite;
    spring.point_i[2] = 1.0;
    spring.k = 1.0;
    CHECK(!se3d_force_create_tsda(w->system, &spring, &w->spring));
    CHECK(!se3d_force_create_bushing(w->system, &mount, &w->mount));
    se3d_effort_def turn = se3d_effort_def_default();
    turn.joint = w->pin;
    CHECK(!se3d_force_create_effort(w->system, &turn, &w->turn));
    se3d_tyre_def tyre = se3d_tyre_def_default();
    tyre.road = ground;
    tyre.wheel = w->kite;
    tyre.point[2] = -100.0;
    tyre.radius = tyre.k = tyre.mu = tyre.slip_stiffness = tyre.cornering_stiffness = 1.0;
    CHECK(!se3d_force_create_tyre(w->system, &tyre, &w->tyre));
    rail.type = SE3D_PRIMITIVE_CD;
    rail.c[1] = 1.0;
    CHECK(!se3d_primitive_create(w->system, &rail, &w->rail));
}

static void world_add_contact(world *w)
{
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    w->contact = se3d_contact_settings_default();
    w->contact.law = SE3D_CONTACT_LAW_CALLBACK;
    w->contact.callback = world_law;
    w->contact.ctx = w;
    w->contact.step = 2e-4;
    CHECK(!se3d_system_set_contact(w->system, &w->contact));
    stuff.density = 1000.0;
    w->other_stuff = stuff;
    CHECK(!se3d_material_create(w->system, &stuff, &w->stuff));
    shape.material = w->stuff;
    CHECK(!se3d_shape_create_plane(w->system, &shape, &w->pad));
    shape.name = "name";
    shape.body = w->ball;
    shape.radius = 0.1;
    CHECK(!se3d_shape_create_sphere(w->system, &shape, &w->pad));
}

/* A plane far above everything. */
static void world_add_servo(world *w)
{
    se3d_shape_def plane = se3d_shape_def_default();
    se3d_servo_def servo = se3d_servo_def_default();
    plane.material = w->stuff;
    plane.position[2] = 100.0;
    plane.normal[2] = -1.0;
    CHECK(!se3d_shape_create_plane(w->system, &plane, &servo.shape));
    servo.axis[2] = servo.speed_max = servo.gain = 1.0;
    CHECK(!se3d_particles_add_servo(w->particles, &servo, NULL));
}

static void world_add_particles(world *w)
{
    const double r[9] = {2.0, 0.0, 0.0299, 2.0, 0.0595, 0.0299, 2.0, 0.2, 0.0299};
    const double radius[3] = {0.03, 0.03, 0.03};
    se3d_fill_def fill = se3d_fill_def_default();
    se3d_particles_source_def source = se3d_particles_source_def_default();
    se3d_particles_sink_def sink = se3d_particles_sink_def_default();
    se3d_flow_def flow = se3d_flow_def_default();
    CHECK(!se3d_particles_create(w->system, NULL, &w->particles));
    CHECK(!se3d_particles_add(w->particles, w->stuff, 3, r, radius, NULL, NULL, NULL));
    se3d_clump_def clump = se3d_clump_def_default();
    clump.count = 3;
    clump.r = r;
    clump.radius = radius;
    CHECK(!se3d_particles_add_clump_template(w->particles, &clump, &w->ids[0]));
    fill.material = w->stuff;
    fill.lower[0] = fill.lower[1] = fill.lower[2] = 5.0;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = 6.0;
    fill.radius_min = fill.radius_max = 0.03;
    source.fill = &fill;
    source.function = w->value;
    CHECK(!se3d_particles_add_source(w->particles, &source, &w->ids[0]));
    sink.upper[0] = sink.lower[0] = -9.0;
    sink.upper[0] = sink.upper[1] = sink.upper[2] = -8.0;
    sink.lower[1] = sink.lower[2] = -9.0;
    CHECK(!se3d_particles_add_sink(w->particles, &sink, &w->ids[0]));
    flow.normal[2] = 1.0;
    CHECK(!se3d_particles_add_flow(w->particles, &flow, NULL));
    world_add_servo(w);
    w->ids[0] = 0;
}

static void world_add_solver(world *w, int32_t method)
{
    se3d_solver_def solver = se3d_solver_def_default();
    se3d_event_def event = se3d_event_def_default();
    solver.method = method;
    solver.step =
        method == SE3D_METHOD_DOP853 || method == SE3D_METHOD_RADAU || method == SE3D_METHOD_GAUSS
            ? 0.0
            : 5e-4;
    solver.interrupt = world_interrupt;
    solver.interrupt_ctx = w;
    CHECK(!se3d_solver_create(w->system, &solver, &w->solver));
    event.value = world_height;
    event.callback = world_event;
    event.callback_ctx = event.ctx = w;
    event.level = 0.0999;
    CHECK(!se3d_event_create(w->solver, &event, &w->event));
}

/* What the rail says, once more: runs tell the log. */
static void world_add_redundant(world *w)
{
    se3d_constraint twin;
    se3d_primitive_def rail = se3d_primitive_def_default();
    CHECK(!se3d_system_get_ground(w->system, &rail.body_i));
    rail.body_j = w->kite;
    rail.type = SE3D_PRIMITIVE_CD;
    rail.c[1] = 1.0;
    CHECK(!se3d_primitive_create(w->system, &rail, &twin));
}

static void world_open_with(world *w, int32_t method, int redundant)
{
    se3d_system_def def = se3d_system_def_default();
    *w = (world){.p = {1.0}, .pair = se3d_material_pair_def_default(), .time = 0.25};
    w->frame = se3d_joint_def_default();
    def.log = world_log;
    def.log_ctx = w;
    CHECK(!se3d_system_create(&def, &w->system));
    world_add_bodies(w);
    world_add_callbacks(w);
    world_add_values(w);
    if (redundant) {
        world_add_redundant(w);
    }
    world_add_contact(w);
    if (method == SE3D_METHOD_VERLET) {
        world_add_particles(w);
    }
    world_add_solver(w, method);
    CHECK(!se3d_snapshot_create(w->system, &w->snapshot));
    CHECK(!se3d_coordinates_create(w->system, &w->coordinates));
    w->frame.body_i = w->ball;
    w->frame.body_j = w->bar;
    w->r[0] = 1.0;
    w->r[2] = 0.2;
    w->v[2] = 1.0;
    w->inertia[0] = w->inertia[1] = w->inertia[2] = 0.01;
    w->contact_read = se3d_contact_settings_default();
    for (int k = 0; k < 4; ++k) {
        w->out[k] = w->storage[k];
    }
}

static inline void world_open(world *w, int32_t method)
{
    world_open_with(w, method, 0);
}

static inline void world_close(world *w)
{
    se3d_snapshot_destroy(w->snapshot);
    se3d_coordinates_destroy(w->coordinates);
    se3d_solver_destroy(w->solver);
    se3d_system_destroy(w->system);
}

#endif
