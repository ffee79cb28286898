/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs that end before their time: where the caller interrupts them, at the last accepted step and
 * with nothing lost for the next run; and where they would take too many steps, in every method. */
#include "se3d/event.h"
#include "support/text_model.h"

/* A double pendulum of two thin rods. */
#define PENDULUM                                                                                   \
    "se3d: 1\n"                                                                                    \
    "bodies:\n"                                                                                    \
    "  - {name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}\n"                    \
    "  - {name: b, mass: 1, inertia: [0.1, 0.1, 0.1], position: [1.5, 0, 0]}\n"                    \
    "joints:\n"                                                                                    \
    "  - {name: p, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"   \
    "  - {name: q, type: revolute, body_i: a, body_j: b, at: [1, 0, 0], axis: [0, 1, 0]}\n"        \
    "output: [{file: r.csv, channels: [b.position]}]\n"
#define DYNAMICS PENDULUM "analysis: {type: dynamics, duration: 1}\n"
#define DRIVERS                                                                                    \
    "drivers: [{name: d, joint: p, value: \"sin(3*t)\"}, {name: e, joint: q, value: \"t^2\"}]\n"

static const int32_t methods[] = {SE3D_METHOD_GENERALIZED_ALPHA,
                                  SE3D_METHOD_HHT,
                                  SE3D_METHOD_DOP853,
                                  SE3D_METHOD_RK45,
                                  SE3D_METHOD_RK4,
                                  SE3D_METHOD_BDF,
                                  SE3D_METHOD_RADAU,
                                  SE3D_METHOD_RATTLE,
                                  SE3D_METHOD_VERLET,
                                  SE3D_METHOD_GAUSS};
enum { METHODS = sizeof methods / sizeof methods[0] };

static int has_fixed_steps(int32_t method)
{
    return method != SE3D_METHOD_DOP853 && method != SE3D_METHOD_RK45 &&
           method != SE3D_METHOD_GAUSS && method != SE3D_METHOD_BDF && method != SE3D_METHOD_RADAU;
}

/* Counts how often it is asked, and wants an end after `patience` times. */
typedef struct caller {
    int asked, patience;
} caller;

static int is_enough(void *ctx)
{
    caller *c = ctx;
    return ++c->asked > c->patience;
}

static text_model open_with(const char *text, int32_t method, int32_t formulation, caller *c,
                            uint64_t steps_max)
{
    text_model m = text_model_open(text, method, formulation, 0.0);
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(!se3d_model_get_solver(m.model, 0, &def));
    se3d_solver_destroy(m.solver);
    def.method = method >= 0 ? method : def.method;
    def.formulation = formulation;
    def.step = method >= 0 && has_fixed_steps(method) ? 0.01 : def.step;
    def.interrupt = c ? is_enough : NULL;
    def.interrupt_ctx = c;
    def.steps_max = steps_max;
    CHECK(!se3d_solver_create(m.system, &def, &m.solver));
    return m;
}

static double time_of(const text_model *m)
{
    double t = (double)NAN;
    CHECK(!se3d_system_get_time(m->system, &t));
    return t;
}

static se3d_status value_of_height(void *ctx, const se3d_system *system, double *value)
{
    const text_model *m = ctx;
    (void)system;
    *value = text_model_get(m, 0, 2);
    return SE3D_OK;
}

/* At heights of -0.3 and -0.9 m. */
static void add_events(text_model *m)
{
    for (int k = 0; k < 2; ++k) {
        se3d_event_def def = se3d_event_def_default();
        se3d_event event;
        def.value = value_of_height;
        def.ctx = m;
        def.level = k == 0 ? -0.3 : -0.9;
        CHECK(!se3d_event_create(m->solver, &def, &event));
    }
}

/* To 1 s, however often the caller interrupts; the number of interrupts. */
static int run_on(text_model *m, caller *c)
{
    int count = 0;
    double before = time_of(m);
    se3d_status status = se3d_solver_run(m->solver, 1.0);
    while (status == SE3D_ERR_INTERRUPTED && count < 10000) {
        CHECK_CONTAINS(se3d_system_get_error(m->system), "interrupted at t = ");
        CHECK(time_of(m) >= before && time_of(m) < 1.0);
        before = time_of(m);
        ++count;
        c->asked = 0;
        status = se3d_solver_run(m->solver, 1.0);
    }
    CHECK(!SE3D_FAILED(status));
    CHECK_NEAR(time_of(m), 1.0, 0.0);
    return count;
}

static void interrupted_runs_go_on_as_if_they_had_not_been(void)
{
    for (int k = 0; k < 2 * METHODS; ++k) {
        const int32_t method = methods[k / 2];
        caller c = {0, method == SE3D_METHOD_DOP853 ? 9 : 37};
        text_model plain = open_with(DYNAMICS, method, k % 2, NULL, 0);
        text_model asked = open_with(DYNAMICS, method, k % 2, &c, 0);
        CHECK(text_model_run(&plain, 1.0));
        CHECK(run_on(&asked, &c) >= 1);
        for (size_t part = 0; part < 3; ++part) {
            CHECK_NEAR(text_model_get(&asked, 0, part), text_model_get(&plain, 0, part),
                       has_fixed_steps(method) ? 1e-12 : 0.0);
        }
        text_model_close(&plain);
        text_model_close(&asked);
    }
}

static void events_between_interrupts_are_neither_lost_nor_doubled(void)
{
    for (int k = 0; k < METHODS; ++k) {
        caller c = {0, methods[k] == SE3D_METHOD_DOP853 ? 9 : 29};
        text_model plain = open_with(DYNAMICS, methods[k], 0, NULL, 0);
        text_model asked = open_with(DYNAMICS, methods[k], 0, &c, 0);
        add_events(&plain);
        add_events(&asked);
        CHECK(text_model_run(&plain, 1.0));
        CHECK(run_on(&asked, &c) >= 1);
        const size_t count = se3d_solver_count_event_records(plain.solver);
        CHECK(count >= 2);
        CHECK(se3d_solver_count_event_records(asked.solver) == count);
        for (size_t n = 0; n < count; ++n) {
            se3d_event_record one, other;
            CHECK(!se3d_solver_get_event_record(plain.solver, n, &one));
            CHECK(!se3d_solver_get_event_record(asked.solver, n, &other));
            CHECK_NEAR(other.time, one.time, 1e-9);
        }
        text_model_close(&plain);
        text_model_close(&asked);
    }
}

static void driven_motion_is_interrupted_between_its_steps(void)
{
    static const char *const kinds[2] = {
        PENDULUM DRIVERS "analysis: {type: kinematics, duration: 1, step: 0.01}\n",
        PENDULUM DRIVERS "analysis: {type: inverse_dynamics, duration: 1, step: 0.01}\n"};
    for (int k = 0; k < 4; ++k) {
        caller c = {0, 50};
        text_model m = open_with(kinds[k / 2], -1, k % 2, &c, 0);
        CHECK(run_on(&m, &c) >= 3);
        CHECK_NEAR(text_model_get(&m, 0, 0), cos(sin(3.0)) + 0.5 * cos(sin(3.0) + 1.0), 1e-12);
        text_model_close(&m);
    }
}

/* The poses of before, whenever the end is asked for. */
static void positions_that_were_not_found_leave_those_of_before(void)
{
    static const char *const kinds[3] = {
        PENDULUM "analysis: {type: equilibrium}\n", PENDULUM DRIVERS "analysis: {type: assembly}\n",
        PENDULUM DRIVERS "analysis: {type: kinematics, duration: 1}\n"};
    for (int k = 0; k < 3; ++k) {
        int ends = 0;
        for (int patience = 0; patience < 1000 && !ends; ++patience) {
            caller c = {0, patience};
            text_model m = open_with(kinds[k], -1, 0, &c, 0);
            const se3d_status status = se3d_solver_run(m.solver, 0.0);
            ends = status >= 0;
            CHECK(ends || status == SE3D_ERR_INTERRUPTED);
            CHECK(ends || patience > 0 || c.asked == 1);
            CHECK(ends || fabs(text_model_get(&m, 0, 0) - 1.5) <= 0.0);
            text_model_close(&m);
        }
        CHECK(ends);
    }
}

static void a_step_can_be_interrupted_where_it_iterates(void)
{
    for (int k = 0; k < METHODS; ++k) {
        caller c = {0, 0};
        text_model m = open_with(DYNAMICS, methods[k], 0, &c, 0);
        CHECK(se3d_solver_step(m.solver, 0.01) == SE3D_ERR_INTERRUPTED);
        CHECK_NEAR(time_of(&m), 0.0, 0.0);
        c.patience = 1000;
        CHECK(!SE3D_FAILED(se3d_solver_step(m.solver, 0.01)));
        CHECK_NEAR(time_of(&m), 0.01, 0.0);
        text_model_close(&m);
    }
}

/* With the steps that are allowed, with and without events; and once more with enough of them. */
static void the_number_of_steps_that_a_run_may_try_holds_in_every_method(void)
{
    for (int k = 0; k < 2 * METHODS; ++k) {
        se3d_solver_stats stats;
        text_model m = open_with(DYNAMICS, methods[k / 2], 0, NULL, 7);
        if (k % 2) {
            add_events(&m);
        }
        const int asked = has_fixed_steps(methods[k / 2]); /* they are counted beforehand */
        CHECK(se3d_solver_run(m.solver, 1.0) ==
              (asked ? SE3D_ERR_INVALID_ARGUMENT : SE3D_ERR_STEP_COUNT));
        CHECK_CONTAINS(se3d_system_get_error(m.system),
                       asked ? "takes 100 steps" : "7 steps were tried since t = 0 s");
        CHECK_CONTAINS(se3d_system_get_error(m.system), asked ? "at most 7" : "steps_max = 7");
        CHECK(!se3d_solver_get_stats(m.solver, &stats));
        CHECK(asked || stats.steps + stats.rejected == 7);
        CHECK(asked || time_of(&m) > 0.0);
        for (int run = 0; run < 1000 && time_of(&m) < 1.0; ++run) { /* each has its own seven */
            const double t = fmin(1.0, time_of(&m) + (asked ? 0.05 : 1.0));
            const se3d_status status = se3d_solver_run(m.solver, t);
            CHECK(!SE3D_FAILED(status) || status == SE3D_ERR_STEP_COUNT);
        }
        CHECK_NEAR(time_of(&m), 1.0, 0.0);
        text_model_close(&m);
    }
}

/* A ball held by a spring so stiff that it would take 1e11 steps, which are foreseen; without a
 * step for the methods that have one. Implicit methods damp it away. */
#define STIFF                                                                                      \
    "se3d: 1\n"                                                                                    \
    "bodies: [{name: a, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}]\n"                      \
    "forces: [{type: tsda, body_i: ground, body_j: a, k: 1e20, l0: 0.9}]\n"                        \
    "output: [{file: r.csv, channels: [a.position]}]\n"                                            \
    "analysis: {type: dynamics, duration: 100}\n"

static void a_run_that_would_never_end_is_given_up_with_its_pace(void)
{
    static const int32_t explicit_ones[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_RK4,
                                            SE3D_METHOD_VERLET};
    for (size_t k = 0; k < 8; ++k) {
        text_model m = text_model_open(STIFF, explicit_ones[k / 2], 0, 0.0);
        if (k % 2) {
            add_events(&m);
        }
        CHECK(se3d_solver_run(m.solver, 100.0) == SE3D_ERR_STEP_COUNT);
        if (explicit_ones[k / 2] == SE3D_METHOD_VERLET) { /* its step is known before the first */
            CHECK_CONTAINS(se3d_system_get_error(m.system), "needs 1.09545e+13 steps");
        } else {
            CHECK_CONTAINS(se3d_system_get_error(m.system), "8192 steps were tried since t = 0 s");
            CHECK_CONTAINS(se3d_system_get_error(m.system), "would be needed to t = 100 s");
        }
        text_model_close(&m);
    }
}

/* 0.1 ms of free fall in a thousand short runs are foreseen together: 1e5 steps of 1e-9 s. */
static void runs_on_the_way_to_a_horizon_are_counted_together(void)
{
    for (int together = 0; together < 2; ++together) {
        text_model m = text_model_open(DYNAMICS, SE3D_METHOD_RK4, 0, 1e-9);
        se3d_solver_def def = se3d_solver_def_default();
        se3d_status status = SE3D_OK;
        se3d_solver_destroy(m.solver);
        def.method = SE3D_METHOD_RK4;
        def.step = 1e-9;
        def.steps_max = 50000;
        def.horizon = together ? 1e-4 : 0.0;
        CHECK(!se3d_solver_create(m.system, &def, &m.solver));
        for (int k = 1; k <= 1000 && status >= 0; ++k) {
            status = se3d_solver_run(m.solver, 1e-4 * k / 1000.0);
        }
        CHECK(status == (together ? SE3D_ERR_STEP_COUNT : SE3D_OK));
        CHECK_NEAR(time_of(&m), together ? 8192e-9 : 1e-4, 1e-8);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(interrupted_runs_go_on_as_if_they_had_not_been);
    RUN(events_between_interrupts_are_neither_lost_nor_doubled);
    RUN(driven_motion_is_interrupted_between_its_steps);
    RUN(positions_that_were_not_found_leave_those_of_before);
    RUN(a_step_can_be_interrupted_where_it_iterates);
    RUN(the_number_of_steps_that_a_run_may_try_holds_in_every_method);
    RUN(a_run_that_would_never_end_is_given_up_with_its_pace);
    RUN(runs_on_the_way_to_a_horizon_are_counted_together);
    return check_finish();
}
