/* SPDX-License-Identifier: BSD-3-Clause */
/* The times of steps and runs: steps add up without their roundings, a run to the time where they
 * lead is one to the present time, and times may be negative. */
#include "check.h"
#include "se3d/se3d.h"

#include <float.h>
#include <math.h>

#define METHODS 10

typedef struct fall {
    se3d_system *system;
    se3d_solver *solver;
    se3d_body body;
} fall;

static void make(fall *f, const se3d_solver_def *def, double start)
{
    se3d_system_def system = se3d_system_def_default();
    se3d_body_def body = se3d_body_def_default();
    system.time = start;
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    CHECK(!se3d_system_create(&system, &f->system));
    CHECK(!se3d_body_create(f->system, &body, &f->body));
    CHECK(!se3d_solver_create(f->system, def, &f->solver));
}

static void destroy(fall *f)
{
    se3d_solver_destroy(f->solver);
    se3d_system_destroy(f->system);
}

static void a_run_may_go_to_where_steps_have_led(void)
{
    static const double lengths[] = {1e-3, 0.01, 0.1 / 3.0, 1.0 / 60.0, 1e-7, 0.7};
    for (int32_t method = 0; method < METHODS; ++method) {
        for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; ++k) {
            fall f;
            se3d_solver_def def = se3d_solver_def_default();
            const double h = lengths[k];
            def.method = method;
            make(&f, &def, 0.0);
            for (int n = 1; n <= 300; ++n) {
                const double end = n * h;
                double t, v[3], a[3];
                CHECK(se3d_solver_step(f.solver, h) >= 0);
                CHECK(!se3d_system_get_time(f.system, &t));
                CHECK_NEAR(t, end, DBL_EPSILON * end);
                if (n % 7 == 0 || n == 10) {
                    CHECK(se3d_solver_run(f.solver, end) >= 0);
                    CHECK(!se3d_system_get_time(f.system, &t));
                    CHECK_NEAR(t, end, DBL_EPSILON * end);
                }
                CHECK(!se3d_body_get_velocity(f.system, f.body, v));
                CHECK(!se3d_body_get_acceleration(f.system, f.body, a));
                CHECK_NEAR(v[2], -9.81 * end, 1e-12 * (1.0 + 9.81 * end));
                CHECK_NEAR(a[2], -9.81, 1e-12);
            }
            destroy(&f);
        }
    }
}

/* After hours of steps the rounding of the time is a part of a step: a run by steps of given
 * length, in parts, took 16,736 steps in place of 10,000 at 1e5 s. All times are rounded. */
static void runs_at_late_times_take_as_many_steps_as_early_ones(void)
{
    static const double starts[] = {0.0, -1e5, 1e5, 1e7};
    static const int32_t methods[] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET,
                                      SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};
    for (size_t k = 0; k < 16; ++k) {
        fall f;
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver_stats stats;
        const double start = starts[k / 4];
        double v[3];
        def.method = methods[k % 4];
        def.step = 1e-4;
        make(&f, &def, start);
        for (int part = 1; part <= 100; ++part) {
            CHECK(se3d_solver_run(f.solver, start + 1e-3 * part) >= 0);
        }
        CHECK(!se3d_solver_get_stats(f.solver, &stats));
        CHECK(stats.steps >= 1000 && stats.steps <= 1001);
        CHECK(!se3d_body_get_velocity(f.system, f.body, v));
        CHECK_NEAR(v[2], -0.981, 1e-9 + 9.81 * 1000.0 * DBL_EPSILON * fabs(start));
        destroy(&f);
    }
}

/* Steps are as long as the times of the model say, which are rounded by up to 1e-9 s at 1e7 s:
 * velocities were off by as much as that adds up to, 2.4e-6 of what falls for 1 s. */
static void motion_follows_the_rounded_times(void)
{
    static const double starts[] = {1e7, -3e6, 12345.678};
    for (int32_t method = 0; method < METHODS; ++method) {
        for (int k = 0; k < 12; ++k) {
            fall f;
            se3d_solver_def def = se3d_solver_def_default();
            const double start = starts[k % 3];
            double v[3], t;
            def.method = method;
            def.step = 1.1e-3;
            make(&f, &def, start);
            CHECK(!se3d_system_get_time(f.system, &t));
            const double begin = t;
            for (int n = 1; n <= 20 && k / 3 == 0; ++n) {
                CHECK(se3d_solver_run(f.solver, start + 0.05 * n) >= 0);
            }
            for (int n = 1; n <= 900 && k / 3 == 1; ++n) {
                CHECK(se3d_solver_step(f.solver, 1.1e-3) >= 0);
            }
            for (int n = 1; n <= 9 && k / 3 == 2; ++n) { /* a step between two runs */
                CHECK(se3d_solver_run(f.solver, start + 0.1 * n) >= 0);
                CHECK(se3d_solver_step(f.solver, 1.1e-3) >= 0);
            }
            CHECK(k / 3 < 2 || se3d_solver_run(f.solver, start + 1.0) >= 0);
            CHECK(!se3d_system_get_time(f.system, &t));
            CHECK(!se3d_body_get_velocity(f.system, f.body, v));
            const int before = check_failures;
            CHECK_NEAR(v[2], -9.81 * (t - begin), 1e-10); /* 1e-14 s a step */
            if (check_failures > before) {
                fprintf(stderr, "  %s, way %d\n", se3d_method_get_name(method), k);
            }
            destroy(&f);
        }
    }
}

static void a_time_before_the_present_one_is_refused(void)
{
    fall f;
    const se3d_solver_def def = se3d_solver_def_default();
    make(&f, &def, 1.0);
    CHECK(se3d_solver_run(f.solver, 1.0 - 1e-14) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_solver_run(f.solver, 1.0 - DBL_EPSILON) >= 0);
    CHECK(se3d_solver_run(f.solver, 1.0 + DBL_EPSILON) >= 0);
    CHECK(se3d_solver_run(f.solver, 1.0 + 1e-12) >= 0);
    destroy(&f);
}

/* Half of the steps that are allowed, a tenth of the way to t = 0. */
static void no_horizon_is_none_at_negative_times(void)
{
    fall f;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_VERLET;
    def.step = 1e-4;
    def.steps_max = 20000;
    make(&f, &def, -10.0);
    CHECK(se3d_solver_run(f.solver, -9.0) == SE3D_OK);
    destroy(&f);
    def.horizon = -1.0; /* one is */
    make(&f, &def, -10.0);
    CHECK(se3d_solver_run(f.solver, -9.0) == SE3D_ERR_STEP_COUNT);
    destroy(&f);
}

/* A way that overflows, and a spin so fast that Euler parameters vanish. */
static void states_that_are_not_finite_are_not_accepted(void)
{
    static const double fast[2] = {1.7e308, 1e300};
    for (int32_t method = 0; *se3d_method_get_name(method); ++method) {
        for (int kind = 0; kind < 4; ++kind) {
            const double v[3] = {fast[kind % 2], 0.0, 0.0};
            se3d_solver_def def = se3d_solver_def_default();
            se3d_status status = SE3D_OK;
            fall f;
            double r[3], p[4];
            def.method = method;
            def.steps_max = 1000;
            make(&f, &def, 0.0);
            CHECK(!(kind % 2 ? se3d_body_set_angular_velocity(f.system, f.body, v)
                             : se3d_body_set_velocity(f.system, f.body, v)));
            for (int k = 1; k <= 4 && status >= 0; ++k) {
                status =
                    kind < 2 ? se3d_solver_run(f.solver, 0.5 * k) : se3d_solver_step(f.solver, 0.5);
                CHECK(!se3d_body_get_position(f.system, f.body, r));
                CHECK(!se3d_body_get_orientation(f.system, f.body, p));
                CHECK(isfinite(r[0]));
                CHECK_NEAR(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3], 1.0, 1e-12);
            }
            CHECK(status < 0 || kind % 2 == 1);
            destroy(&f);
        }
    }
}

int main(void)
{
    RUN(states_that_are_not_finite_are_not_accepted);
    RUN(a_run_may_go_to_where_steps_have_led);
    RUN(runs_at_late_times_take_as_many_steps_as_early_ones);
    RUN(motion_follows_the_rounded_times);
    RUN(a_time_before_the_present_one_is_refused);
    RUN(no_horizon_is_none_at_negative_times);
    return check_finish();
}
