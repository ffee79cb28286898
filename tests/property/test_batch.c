/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches: the same motion as that of a solver, the same bits for any number of states and threads
 * and in any lane, states that fail alone, gravity and masses of their own, no memory in steps. */
#include "support/counting.h"
#include "support/parallel_world.h"

#include <stdint.h>
#include <stdlib.h>

enum { MECHANISMS = 40, NUMBERS = 7 * TREE_BODIES_MAX, STATES = 21 };

#define STEP 0.01

/* Every second one moves in planes. */
static void make_world(tree_world *w, uint64_t seed)
{
    if (seed % 2) {
        tree_make_parallel(w, seed / 2, 0.0);
    } else {
        tree_world_init(w, seed / 2, 1 + (int)(seed / 2 % TREE_BODIES_MAX), 0);
    }
}

/* The state of a system as coordinates, or from them. */
static void use_coordinates(se3d_system *system, double *q, double *qdot, int sets)
{
    se3d_coordinates *c;
    CHECK(!se3d_coordinates_create(system, &c));
    CHECK(!(sets ? se3d_coordinates_set(c, q, qdot) : se3d_coordinates_get(c, q, qdot)));
    se3d_coordinates_destroy(c);
}

/* The system after `steps` steps of a solver in joint coordinates. */
static void run_alone(se3d_system *system, se3d_method method, int steps)
{
    se3d_solver *solver;
    se3d_solver_def def = se3d_solver_def_default();
    def.formulation = SE3D_FORMULATION_JOINT;
    def.method = (int32_t)method;
    CHECK(!se3d_solver_create(system, &def, &solver));
    for (int k = 0; k < steps; ++k) {
        CHECK(se3d_solver_step(solver, STEP) >= 0);
    }
    se3d_solver_destroy(solver);
}

static double difference(const double *a, const double *b, size_t count)
{
    double most = 0.0;
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(a[k] - b[k]));
    }
    return most;
}

/* Positions and velocities of all bodies, to rounding. */
static void a_batch_moves_as_a_solver_does(void)
{
    static const se3d_method methods[] = {SE3D_METHOD_RK4, SE3D_METHOD_RK45, SE3D_METHOD_DOP853};
    for (uint64_t seed = 0; seed < 2 * MECHANISMS; ++seed) {
        const se3d_method method = methods[seed % 3];
        tree_world w;
        se3d_system *other;
        se3d_batch *batch;
        double q[NUMBERS], qdot[NUMBERS];
        make_world(&w, seed);
        use_coordinates(w.system, q, qdot, 0);
        use_coordinates(w.system, q, qdot, 1); /* velocities that joints allow */
        CHECK(!se3d_system_clone(w.system, &other));
        CHECK(!se3d_batch_create(w.system, 3, 1, &batch));
        CHECK(!se3d_batch_step(batch, method, STEP, 20));
        CHECK(!se3d_batch_get_state(batch, 2, 1, q, qdot));
        use_coordinates(other, q, qdot, 1);
        run_alone(w.system, method, 20);
        for (int k = 1; k < w.count; ++k) {
            const se3di_frame *a = &w.system->model.frames[k], *b = &other->model.frames[k];
            CHECK_NEAR(difference(a->r, b->r, 3), 0.0, 1e-11);
            CHECK_NEAR(difference(a->v, b->v, 3), 0.0, 1e-11);
            CHECK_NEAR(difference(a->w, b->w, 3), 0.0, 1e-11);
        }
        se3d_batch_destroy(batch);
        se3d_system_destroy(other);
        tree_world_destroy(&w);
    }
}

/* STATES random states of a mechanism with efforts, gravity and masses of their own. */
typedef struct states_of {
    size_t positions, velocities;
    double q[STATES * NUMBERS], qdot[STATES * NUMBERS], effort[STATES * NUMBERS];
    double gravity[3 * STATES], mass[STATES], inertia[6 * STATES];
} states_of;

static void make_states(tree_world *w, states_of *s)
{
    se3d_coordinates *c;
    double q[NUMBERS], dq[NUMBERS];
    CHECK(!se3d_coordinates_create(w->system, &c));
    CHECK(!se3d_coordinates_get(c, q, NULL));
    s->positions = se3d_coordinates_count_positions(c);
    s->velocities = se3d_coordinates_count(c);
    for (size_t k = 0; k < STATES; ++k) {
        tree_vector(w, dq, (int)s->velocities, 1.0);
        CHECK(!se3d_coordinates_move(c, q, dq, s->q + k * s->positions));
        for (int i = 0; i < 3; ++i) {
            s->inertia[6 * k + (size_t)i] = tree_uniform(w, 1.0, 1.5);
            s->inertia[6 * k + 3 + (size_t)i] = tree_uniform(w, 0.0, 0.1);
        }
        s->mass[k] = tree_uniform(w, 1.0, 2.0);
    }
    tree_vector(w, s->qdot, (int)(STATES * s->velocities), 1.0);
    tree_vector(w, s->effort, (int)(STATES * s->velocities), 3.0);
    tree_vector(w, s->gravity, 3 * STATES, 10.0);
    se3d_coordinates_destroy(c);
}

/* States [first, first + count) of `s` in a batch of their own, after some steps. */
static void run_some(const tree_world *w, const states_of *s, size_t first, size_t count,
                     int threads, double *q, double *qdot, double *qddot)
{
    se3d_batch *b;
    CHECK(!se3d_batch_create(w->system, count, threads, &b));
    CHECK(!se3d_batch_set_state(b, 0, count, s->q + first * s->positions,
                                s->qdot + first * s->velocities));
    CHECK(!se3d_batch_set_efforts(b, 0, count, s->effort + first * s->velocities));
    CHECK(!se3d_batch_set_gravity(b, 0, count, s->gravity + 3 * first));
    CHECK(!se3d_batch_set_mass(b, w->bodies[w->count - 1], 0, count, s->mass + first,
                               s->inertia + 6 * first));
    CHECK(!se3d_batch_step(b, SE3D_METHOD_RK4, STEP, 5));
    CHECK(
        !se3d_batch_get_state(b, 0, count, q + first * s->positions, qdot + first * s->velocities));
    CHECK(!se3d_batch_compute_accelerations(b, qddot + first * s->velocities));
    se3d_batch_destroy(b);
}

static void bits_do_not_depend_on_count_lane_and_threads(void)
{
    static states_of s;
    static double q[STATES * NUMBERS], qdot[STATES * NUMBERS], qddot[STATES * NUMBERS];
    static double other[STATES * NUMBERS], other_dot[STATES * NUMBERS], acc[STATES * NUMBERS];
    static const struct {
        size_t size;
        int threads;
    } ways[] = {{1, 1}, {2, 3}, {5, 2}, {9, 1}, {20, 2}, {21, 7}};
    for (uint64_t seed = 0; seed < 24; ++seed) {
        tree_world w;
        make_world(&w, seed);
        make_states(&w, &s);
        run_some(&w, &s, 0, STATES, 1, q, qdot, qddot);
        for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
            for (size_t first = 0; first < STATES; first += ways[k].size) {
                const size_t left = STATES - first;
                run_some(&w, &s, first, left < ways[k].size ? left : ways[k].size, ways[k].threads,
                         other, other_dot, acc);
            }
            CHECK(memcmp(q, other, STATES * s.positions * sizeof *q) == 0);
            CHECK(memcmp(qdot, other_dot, STATES * s.velocities * sizeof *q) == 0);
            CHECK(memcmp(qddot, acc, STATES * s.velocities * sizeof *q) == 0);
        }
        tree_world_destroy(&w);
    }
}

/* Springs and efforts on the coordinates of joints. */
static void add_laws(tree_world *w)
{
    se3d_force force;
    for (int k = 0; k < w->joint_count; ++k) {
        se3d_rsda_def spring = se3d_rsda_def_default();
        se3d_effort_def effort = se3d_effort_def_default();
        spring.joint = effort.joint = w->joints[k];
        spring.k = tree_uniform(w, 0.0, 5.0);
        spring.c = tree_uniform(w, 0.0, 1.0);
        spring.theta0 = tree_uniform(w, -1.0, 1.0);
        effort.value = tree_uniform(w, -2.0, 2.0);
        const se3d_status status = se3d_force_create_rsda(w->system, &spring, &force);
        CHECK(status == SE3D_OK || status == SE3D_ERR_INVALID_ARGUMENT); /* it has no angle */
        effort.coordinate = status ? SE3D_JOINT_COORDINATE_DISPLACEMENT : effort.coordinate;
        (void)se3d_force_create_effort(w->system, &effort, &force);
    }
}

/* At points of the last body. */
static void add_loads(tree_world *w)
{
    se3d_force force;
    const se3d_body last = w->bodies[w->count - 1];
    for (int in_body = 0; in_body < 2; ++in_body) {
        se3d_load_def load = se3d_load_def_default();
        load.body = last;
        load.in_body_frame = in_body;
        tree_vector(w, load.point, 3, 1.0);
        tree_vector(w, load.value, 3, 5.0);
        CHECK(!se3d_force_create_load(w->system, &load, &force));
        CHECK(!se3d_force_create_torque(w->system, &load, &force));
    }
}

/* Accelerations of the states are those of a system with their gravity and masses. */
static void gravity_and_masses_are_those_of_the_state(void)
{
    static states_of s;
    static double qddot[STATES * NUMBERS], effort[STATES * NUMBERS], alone[NUMBERS];
    int in_lanes = 0;
    for (uint64_t seed = 0; seed < 2 * MECHANISMS; ++seed) {
        tree_world w;
        se3d_batch *b;
        se3d_coordinates *c;
        make_world(&w, seed);
        if (seed / 2 % 2) {
            add_laws(&w);
        }
        if (seed / 4 % 2) { /* in space, if it moves in planes */
            add_loads(&w);
        }
        make_states(&w, &s);
        CHECK(!se3d_batch_create(w.system, STATES, 2, &b));
        in_lanes += se3d_batch_count_single_forces(b) == 0;
        CHECK(!se3d_batch_set_state(b, 0, STATES, s.q, s.qdot));
        CHECK(!se3d_batch_set_efforts(b, 0, STATES, s.effort));
        CHECK(!se3d_batch_set_gravity(b, 0, STATES, s.gravity));
        CHECK(!se3d_batch_set_mass(b, w.bodies[w.count - 1], 0, STATES, s.mass, s.inertia));
        CHECK(!se3d_batch_compute_accelerations(b, qddot));
        CHECK(!se3d_batch_compute_efforts(b, qddot, effort));
        for (size_t k = 0; k < STATES; ++k) {
            double size = 1.0, most = 1.0;
            CHECK(!se3d_system_set_gravity(w.system, s.gravity + 3 * k));
            CHECK(
                !se3d_body_set_mass(w.system, w.bodies[w.count - 1], s.mass[k], s.inertia + 6 * k));
            CHECK(!se3d_coordinates_create(w.system, &c));
            CHECK(!se3d_coordinates_set(c, s.q + k * s.positions, s.qdot + k * s.velocities));
            CHECK(!se3d_coordinates_compute_accelerations(c, s.effort + k * s.velocities, alone));
            for (size_t v = 0; v < s.velocities; ++v) {
                size = fmax(size, fabs(alone[v]));
                most = fmax(most, fabs(s.effort[k * s.velocities + v]));
            }
            CHECK_NEAR(difference(alone, qddot + k * s.velocities, s.velocities) / size, 0.0,
                       1e-11);
            CHECK_NEAR(
                difference(s.effort + k * s.velocities, effort + k * s.velocities, s.velocities) /
                    (most * size),
                0.0, 1e-10);
            se3d_coordinates_destroy(c);
        }
        se3d_batch_destroy(b);
        tree_world_destroy(&w);
    }
    CHECK(in_lanes > MECHANISMS);
}

/* A bar on a revolute about z that hangs down, and its batch. */
static se3d_system *make_pendulum(se3d_constraint *joint, se3d_body *bar)
{
    se3d_system *system;
    se3d_body_def body = se3d_body_def_default();
    se3d_joint_def def = se3d_joint_def_default();
    const double down[3] = {0.0, -9.81, 0.0};
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_set_gravity(system, down));
    body.mass = 2.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.1;
    body.position[0] = 1.0;
    CHECK(!se3d_body_create(system, &body, bar));
    CHECK(!se3d_system_get_ground(system, &def.body_i));
    def.body_j = *bar;
    def.point_j[0] = -1.0;
    CHECK(!se3d_joint_create_revolute(system, &def, joint));
    return system;
}

static void a_state_that_fails_hurts_no_other(void)
{
    se3d_constraint joint;
    se3d_body bar;
    se3d_system *system = make_pendulum(&joint, &bar);
    se3d_batch *b, *fine;
    double q[10], qdot[10], good[10], good_dot[10], time[10];
    const double fast = 1e300, zero = 0.0;
    int32_t status[10];
    CHECK(!se3d_batch_create(system, 10, 1, &b));
    CHECK(!se3d_batch_create(system, 10, 1, &fine));
    CHECK(!se3d_batch_set_state(b, 3, 1, NULL, &fast));
    CHECK(se3d_batch_step(b, SE3D_METHOD_RK4, 1e10, 1) == SE3D_ERR_NOT_FINITE);
    CHECK_CONTAINS(se3d_batch_get_error(b), "state 3, t = 0 s");
    CHECK(!se3d_batch_step(fine, SE3D_METHOD_RK4, 1e10, 1));
    CHECK(se3d_batch_step(b, SE3D_METHOD_RK4, STEP, 4) == SE3D_ERR_NOT_FINITE);
    CHECK(!se3d_batch_step(fine, SE3D_METHOD_RK4, STEP, 4));
    CHECK(!se3d_batch_get_state(b, 0, 10, q, qdot) && !se3d_batch_get_time(b, 0, 10, time));
    CHECK(!se3d_batch_get_state(fine, 0, 10, good, good_dot));
    CHECK(!se3d_batch_get_status(b, 0, 10, status));
    for (int k = 0; k < 10; ++k) {
        CHECK(status[k] == (k == 3 ? SE3D_ERR_NOT_FINITE : SE3D_OK));
        CHECK(k == 3 ? q[k] == 0.0 && qdot[k] == fast && time[k] == 0.0
                     : q[k] == good[k] && qdot[k] == good_dot[k] && time[k] > 1e9);
    }
    CHECK(!se3d_batch_set_state(b, 3, 1, &zero, &zero));
    CHECK(!se3d_batch_step(b, SE3D_METHOD_RK4, STEP, 4));
    CHECK(!se3d_batch_get_time(b, 3, 1, time));
    CHECK_NEAR(time[0], 4 * STEP, 1e-15);
    se3d_batch_destroy(b);
    se3d_batch_destroy(fine);
    se3d_system_destroy(system);
}

/* Ends that coincide: a damper between them resists in every direction, as for a solver; a law that
 * needs a direction makes the state fail. */
static void springs_may_have_no_length(void)
{
    static const struct {
        double k, c, l0;
    } laws[] = {{10.0, 0.0, 0.0}, {10.0, 1.0, 0.0}, {0.0, 3.0, 0.0}, {10.0, 1.0, 0.5}};
    for (size_t k = 0; k < sizeof laws / sizeof *laws; ++k) {
        se3d_system *system;
        se3d_batch *b;
        se3d_force force;
        se3d_body_def body = se3d_body_def_default();
        se3d_tsda_def spring = se3d_tsda_def_default();
        const double down[3] = {0.0, 0.0, -9.81};
        double q[5 * 7], qdot[5 * 6], r[3];
        CHECK(!se3d_system_create(NULL, &system));
        CHECK(!se3d_system_set_gravity(system, down));
        CHECK(!se3d_system_get_ground(system, &spring.body_i));
        body.mass = 2.0;
        body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
        body.velocity[0] = 0.5;
        body.angular_velocity[1] = 2.0;
        CHECK(!se3d_body_create(system, &body, &spring.body_j));
        spring.k = laws[k].k;
        spring.c = laws[k].c;
        spring.l0 = laws[k].l0;
        CHECK(!se3d_force_create_tsda(system, &spring, &force));
        CHECK(!se3d_batch_create(system, 5, 1, &b) && se3d_batch_count_single_forces(b) == 0);
        if (laws[k].l0 > 0.0) {
            CHECK(se3d_batch_step(b, SE3D_METHOD_RK4, STEP, 1) == SE3D_ERR_NOT_FINITE);
        } else {
            CHECK(!se3d_batch_step(b, SE3D_METHOD_RK4, STEP, 20));
            CHECK(!se3d_batch_get_state(b, 0, 5, q, qdot));
            run_alone(system, SE3D_METHOD_RK4, 20);
            CHECK(!se3d_body_get_position(system, spring.body_j, r));
            CHECK_NEAR(difference(q, r, 3), 0.0, 1e-13);
            CHECK(memcmp(q, q + 4 * 7, 7 * sizeof *q) == 0);
        }
        se3d_batch_destroy(b);
        se3d_system_destroy(system);
    }
}

/* Against a torque in time that is known, from each state's own time. */
static void functions_see_the_time_of_the_state(void)
{
    se3d_constraint joint;
    se3d_body bar;
    se3d_system *system = make_pendulum(&joint, &bar);
    se3d_load_def load = se3d_load_def_default();
    se3d_force force;
    se3d_batch *b;
    const double none[3] = {0.0, 0.0, 0.0}, inertia = 2.1;
    double time[9], qdot[9];
    se3d_function_def def = se3d_function_def_default();
    se3d_function f;
    def.expression = "3*t^2";
    CHECK(!se3d_function_create(system, &def, &f));
    load.body = bar;
    load.function[2] = f;
    CHECK(!se3d_force_create_torque(system, &load, &force));
    CHECK(!se3d_system_set_gravity(system, none));
    CHECK(!se3d_batch_create(system, 9, 2, &b));
    for (int k = 0; k < 9; ++k) {
        time[k] = 0.1 * k;
    }
    CHECK(!se3d_batch_set_time(b, 0, 9, time));
    CHECK(!se3d_batch_step(b, SE3D_METHOD_RK4, 0.1, 10));
    CHECK(!se3d_batch_get_state(b, 0, 9, NULL, qdot));
    for (int k = 0; k < 9; ++k) {
        const double end = time[k] + 1.0;
        CHECK_NEAR(qdot[k], (end * end * end - time[k] * time[k] * time[k]) / inertia, 1e-12);
    }
    se3d_batch_destroy(b);
    se3d_system_destroy(system);
}

static void steps_and_queries_take_no_memory(void)
{
    for (uint64_t seed = 0; seed < 6; ++seed) {
        static states_of s;
        static double qddot[STATES * NUMBERS];
        tree_world w;
        se3d_batch *b;
        support_counting counting = {0};
        const se3d_allocator allocator = support_counting_allocator(&counting);
        make_world(&w, seed + 6);
        make_states(&w, &s);
        w.system->model.allocator = allocator;
        CHECK(!se3d_batch_create(w.system, STATES, 2, &b));
        w.system->model.allocator = se3di_alloc_default();
        const size_t calls = counting.calls;
        CHECK(!se3d_batch_set_state(b, 0, STATES, s.q, s.qdot));
        CHECK(!se3d_batch_set_efforts(b, 0, STATES, s.effort));
        CHECK(!se3d_batch_step(b, SE3D_METHOD_RK4, STEP, 5));
        CHECK(!se3d_batch_compute_accelerations(b, qddot));
        CHECK(!se3d_batch_compute_efforts(b, qddot, qddot));
        CHECK(counting.calls == calls);
        se3d_batch_destroy(b);
        CHECK(counting.live == 0 && counting.wrong == 0);
        tree_world_destroy(&w);
    }
}

/* A force that tries to change the batch that calls it, and fails at t > 0.5 s. */
static se3d_status meddle(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                          double *K, double *D)
{
    se3d_batch *b = *(se3d_batch **)ctx;
    double time = 0.0;
    int32_t status;
    const se3d_body body = {0, 0};
    (void)motion, (void)K, (void)D;
    if (b) {
        CHECK(se3d_batch_step(b, SE3D_METHOD_RK4, STEP, 1) == SE3D_ERR_STATE);
        CHECK(se3d_batch_set_state(b, 0, 0, NULL, NULL) == SE3D_ERR_STATE);
        CHECK(se3d_batch_set_time(b, 0, 1, &time) == SE3D_ERR_STATE);
        CHECK(se3d_batch_set_efforts(b, 0, 1, &time) == SE3D_ERR_STATE);
        CHECK(se3d_batch_set_gravity(b, 0, 0, &time) == SE3D_ERR_STATE);
        CHECK(se3d_batch_set_mass(b, body, 0, 0, &time, &time) == SE3D_ERR_STATE);
        CHECK(se3d_batch_compute_accelerations(b, &time) == SE3D_ERR_STATE);
        CHECK(se3d_batch_compute_efforts(b, NULL, &time) == SE3D_ERR_STATE);
        CHECK(se3d_batch_get_status(b, 0, 1, &status) == SE3D_ERR_STATE);
        CHECK(se3d_batch_get_time(b, 0, 1, &time) == SE3D_ERR_STATE);
        se3d_batch_destroy(b);
    }
    wrench[6] = -1.0;
    return t > 0.5 ? SE3D_ERR_CALLBACK : SE3D_OK;
}

static void callbacks_work_but_do_not_reach_the_batch(void)
{
    se3d_constraint joint;
    se3d_body bar;
    se3d_force force;
    se3d_batch *b = NULL;
    se3d_system *system = make_pendulum(&joint, &bar);
    se3d_force_callback_def def = se3d_force_callback_def_default();
    double time[2] = {0.0, 0.45}, qddot[2], size[2];
    int32_t status[2];
    CHECK(!se3d_system_get_ground(system, &def.body_i));
    def.body_j = bar;
    def.callback = meddle;
    def.ctx = &b;
    CHECK(!se3d_force_create_callback(system, &def, &force));
    CHECK(!se3d_batch_create(system, 2, 1, &b));
    CHECK(!se3d_batch_set_time(b, 0, 2, time));
    CHECK(!se3d_batch_compute_accelerations(b, qddot));
    for (int k = 0; k < 2; ++k) {
        CHECK_NEAR(qddot[k], -2.0 * 9.81 / 2.1, 1e-12);
    }
    CHECK(se3d_batch_step(b, SE3D_METHOD_RK4, 0.01, 20) == SE3D_ERR_CALLBACK);
    CHECK(!se3d_batch_get_status(b, 0, 2, status) && !se3d_batch_get_time(b, 0, 2, size));
    CHECK(status[0] == SE3D_OK && status[1] == SE3D_ERR_CALLBACK);
    CHECK_NEAR(size[0], 0.2, 1e-15);
    CHECK_NEAR(size[1], 0.5, 1e-14);
    se3d_batch_destroy(b);
    se3d_system_destroy(system);
}

/* Counts its calls, and fails from 0.05 s on. */
static se3d_status count_calls(void *ctx, double t, const se3d_body_motion motion[2],
                               double wrench[12], double *K, double *D)
{
    (void)motion, (void)K, (void)D;
    wrench[6] = 1.0;
    ++*(int *)ctx;
    return t > 0.05 ? SE3D_ERR_CALLBACK : SE3D_OK;
}

static void callbacks_are_not_called_for_states_that_failed(void)
{
    int calls = 0;
    se3d_constraint joint;
    se3d_body bar;
    se3d_force force;
    se3d_batch *b;
    se3d_system *system = make_pendulum(&joint, &bar);
    se3d_force_callback_def def = se3d_force_callback_def_default();
    double time[3] = {0.0, 1.0, 0.0}, qddot[3];
    CHECK(!se3d_system_get_ground(system, &def.body_i));
    def.body_j = bar;
    def.callback = count_calls;
    def.ctx = &calls;
    CHECK(!se3d_force_create_callback(system, &def, &force));
    CHECK(!se3d_batch_create(system, 3, 1, &b));
    CHECK(!se3d_batch_set_time(b, 0, 3, time));
    CHECK(se3d_batch_step(b, SE3D_METHOD_RK4, 0.01, 2) == SE3D_ERR_CALLBACK);
    CHECK(calls == 2 * 8 + 1);
    calls = 0;
    CHECK(se3d_batch_compute_accelerations(b, qddot) == SE3D_ERR_CALLBACK);
    CHECK(calls == 2 && qddot[0] != 0.0 && qddot[1] == 0.0 && qddot[2] == qddot[0]);
    se3d_batch_destroy(b);
    se3d_system_destroy(system);
}

static void what_a_batch_cannot_have_is_named(void)
{
    se3d_constraint joint, driver;
    se3d_body bar;
    se3d_batch *b;
    se3d_system *system = make_pendulum(&joint, &bar);
    se3d_driver_def drive = se3d_driver_def_default();
    drive.joint = joint;
    drive.name = "motor";
    CHECK(!se3d_driver_create(system, &drive, &driver));
    CHECK(se3d_batch_create(system, 1, 1, &b) == SE3D_ERR_UNSUPPORTED && !b);
    CHECK_CONTAINS(se3d_system_get_error(system), "'motor' (driver)");
    CHECK(!se3d_constraint_destroy(system, driver));
    se3d_stop_def stop = se3d_stop_def_default();
    se3d_force force;
    stop.joint = joint;
    stop.name = "limit";
    stop.upper = 1.0;
    stop.k = 1e4;
    CHECK(!se3d_force_create_stop(system, &stop, &force));
    CHECK(se3d_batch_create(system, 1, 1, &b) == SE3D_ERR_UNSUPPORTED && !b);
    CHECK_CONTAINS(se3d_system_get_error(system), "'limit' (stop)");
    CHECK(!se3d_force_destroy(system, force));
    CHECK(!se3d_batch_create(system, 1, 1, &b));
    CHECK(se3d_batch_step(b, SE3D_METHOD_RADAU, STEP, 1) == SE3D_ERR_UNSUPPORTED);
    se3d_batch_destroy(b);
    se3d_system_destroy(system);
}

/* No batch of the system; the message has `text`. */
static void check_refused(se3d_system *system, const char *text)
{
    se3d_batch *b;
    CHECK(se3d_batch_create(system, 1, 1, &b) == SE3D_ERR_UNSUPPORTED && !b);
    CHECK_CONTAINS(se3d_system_get_error(system), text);
}

static void joints_that_may_break_are_named(void)
{
    se3d_constraint joint;
    se3d_body bar;
    se3d_batch *b;
    se3d_system *system = make_pendulum(&joint, &bar);
    CHECK(!se3d_joint_set_break(system, joint, 100.0, 0.0));
    check_refused(system, "'' (revolute) may break");
    CHECK(!se3d_joint_set_break(system, joint, 0.0, 50.0));
    check_refused(system, "'' (revolute) may break");
    CHECK(!se3d_joint_set_break(system, joint, 0.0, 0.0));
    CHECK(!se3d_batch_create(system, 1, 1, &b));
    se3d_batch_destroy(b);
    se3d_system_destroy(system);
}

/* A spring about an axis of its own has an angle that no joint counts. */
static void turns_that_no_joint_counts_are_named(void)
{
    se3d_constraint joint;
    se3d_body bar;
    se3d_force force;
    se3d_batch *b;
    se3d_system *system = make_pendulum(&joint, &bar);
    se3d_rsda_def def = se3d_rsda_def_default();
    CHECK(!se3d_system_get_ground(system, &def.body_i));
    def.body_j = bar;
    def.axis_i[0] = 0.0;
    def.axis_i[2] = 1.0;
    def.k = 3.0;
    def.name = "coil";
    CHECK(!se3d_force_create_rsda(system, &def, &force));
    check_refused(system, "'coil' (rsda) counts turns that are not a joint's");
    CHECK(!se3d_force_destroy(system, force));
    def.joint = joint;
    CHECK(!se3d_force_create_rsda(system, &def, &force));
    CHECK(!se3d_batch_create(system, 1, 1, &b));
    se3d_batch_destroy(b);
    se3d_system_destroy(system);
}

/* Shapes are fine as long as they touch nothing. */
static void shapes_that_may_touch_are_named(void)
{
    se3d_constraint joint;
    se3d_body bar;
    se3d_shape shapes[2];
    se3d_material material;
    se3d_batch *b;
    se3d_system *system = make_pendulum(&joint, &bar);
    se3d_material_def steel = se3d_material_def_default();
    se3d_shape_def def = se3d_shape_def_default();
    steel.density = 7800.0;
    steel.stiffness = 1e6;
    CHECK(!se3d_material_create(system, &steel, &material));
    def.radius = 0.1;
    def.body = bar;
    def.name = "knob";
    CHECK(!se3d_shape_create_sphere(system, &def, &shapes[0]));
    def.name = "rail";
    def.body = (se3d_body){0, 0};
    def.material = material;
    CHECK(!se3d_shape_create_sphere(system, &def, &shapes[1]));
    CHECK(!se3d_batch_create(system, 1, 1, &b));
    se3d_batch_destroy(b);
    CHECK(!se3d_shape_destroy(system, shapes[0]));
    def.name = "hard knob";
    def.body = bar;
    CHECK(!se3d_shape_create_sphere(system, &def, &shapes[0]));
    check_refused(system, "may touch: a batch has no contact");
    CHECK_CONTAINS(se3d_system_get_error(system), "'hard knob'");
    CHECK_CONTAINS(se3d_system_get_error(system), "'rail'");
    se3d_system_destroy(system);
}

static void particles_and_states_are_refused(void)
{
    se3d_constraint joint;
    se3d_body bar;
    se3d_state state;
    se3d_particles *particles;
    se3d_system *system = make_pendulum(&joint, &bar);
    const se3d_state_def def = se3d_state_def_default();
    CHECK(!se3d_state_create(system, &def, &state));
    check_refused(system, "no user-defined states");
    CHECK(!se3d_state_destroy(system, state));
    CHECK(!se3d_particles_create(system, NULL, &particles));
    check_refused(system, "no particles");
    se3d_system_destroy(system);
}

static void counts_beyond_memory_are_refused(void)
{
    static const size_t counts[] = {SIZE_MAX, SIZE_MAX - 1, SIZE_MAX - 8, SIZE_MAX / 8 + 1};
    se3d_constraint joint;
    se3d_body bar;
    se3d_system *systems[2] = {make_pendulum(&joint, &bar), NULL};
    CHECK(!se3d_system_create(NULL, &systems[1])); /* without bodies */
    for (int s = 0; s < 2; ++s) {
        for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k) {
            se3d_batch *b;
            CHECK(se3d_batch_create(systems[s], counts[k], 1, &b) == SE3D_ERR_NO_MEMORY && !b);
        }
        se3d_system_destroy(systems[s]);
    }
}

int main(void)
{
    RUN(a_batch_moves_as_a_solver_does);
    RUN(bits_do_not_depend_on_count_lane_and_threads);
    RUN(gravity_and_masses_are_those_of_the_state);
    RUN(a_state_that_fails_hurts_no_other);
    RUN(springs_may_have_no_length);
    RUN(functions_see_the_time_of_the_state);
    RUN(steps_and_queries_take_no_memory);
    RUN(callbacks_work_but_do_not_reach_the_batch);
    RUN(callbacks_are_not_called_for_states_that_failed);
    RUN(what_a_batch_cannot_have_is_named);
    RUN(joints_that_may_break_are_named);
    RUN(turns_that_no_joint_counts_are_named);
    RUN(shapes_that_may_touch_are_named);
    RUN(particles_and_states_are_refused);
    RUN(counts_beyond_memory_are_refused);
    return check_finish();
}
