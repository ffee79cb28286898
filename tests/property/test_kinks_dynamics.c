/* SPDX-License-Identifier: BSD-3-Clause */
/* Rates that jump under dynamics: several drivers, kinks at the ends of runs and steps, going on
 * from snapshots, friction. */
#include "support/methods.h"
#include "support/text_model.h"

#define HEAD          "se3d: 1\ngravity: [0, 0, 0]\nbodies:\n"
#define BODY(name, y) "  - {name: " name ", mass: 2, inertia: [1, 1, 1], position: [0, " y ", 0]}\n"
#define SLIDE(name, body, y)                                                                       \
    "  - {name: " name ", type: prismatic, body_i: ground, body_j: " body ", at: [0, " y           \
    ", 0], axis: [1, 0, 0]}\n"
#define DRIVE(name, joint, value)                                                                  \
    "  - {name: " name ", joint: " joint ", coordinate: displacement, value: \"" value "\"}\n"
#define TAIL                                                                                       \
    "analysis: {type: dynamics, duration: 1}\n"                                                    \
    "output: [{file: o.csv, every: 0.1, channels: [a.velocity, b.velocity, energy.balance]}]\n"

/* Two carts. */
#define CARTS                                                                                      \
    HEAD BODY("a", "0") BODY("b", "1") "joints:\n" SLIDE("sa", "a", "0") SLIDE("sb", "b", "1")

/* From rest: velocities of both, and nothing is missing in the account. */
static void check_state(const text_model *m, double a, double b, double most)
{
    CHECK_NEAR(text_model_get(m, 0, 0), a, most);
    CHECK_NEAR(text_model_get(m, 1, 0), b, most);
    CHECK_NEAR(text_model_get(m, 2, 0), 0.0, most);
}

static text_model open_carts(const char *drivers, int32_t method, double step)
{
    char text[2000];
    snprintf(text, sizeof text, "%sdrivers:\n%s" TAIL, CARTS, drivers);
    return text_model_open(text, method, method % 2, step);
}

static void two_drivers_jump_at_once_and_after_each_other(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        text_model m = open_carts(DRIVE("da", "sa", "max(0, t - 0.5)")
                                      DRIVE("db", "sb", "2*max(0, t - 0.5) - 3*max(0, t - 0.502)"),
                                  method, 0.0);
        text_model_run(&m, 0.501);
        check_state(&m, 1.0, 2.0, 1e-9);
        text_model_run(&m, 0.6);
        check_state(&m, 1.0, -1.0, 1e-9);
        text_model_close(&m);
    }
}

/* The second cart follows the first one through a coupler. */
static void coupled_drivers_share_the_impulse(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        text_model m = text_model_open(
            CARTS
            "  - {name: c, type: coupler, terms: [{joint: sa, ratio: 3}, {joint: sb, ratio: -1}]}\n"
            "drivers:\n" DRIVE("da", "sa", "if(t <= 0.25, 0, 0.25 - t)") TAIL,
            method, method % 2, 0.0);
        text_model_run(&m, 1.0);
        check_state(&m, -1.0, -3.0, 1e-9);
        text_model_close(&m);
    }
}

/* A pulse of 2 ms, at both ends of which rates are alike. */
static void short_pulses_are_not_passed_over(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        text_model m = open_carts(DRIVE("da", "sa", "max(0, t - 0.5001) - max(0, t - 0.5021)")
                                      DRIVE("db", "sb", "max(0, t - 0.3)"),
                                  method, 0.0);
        text_model_run(&m, 0.501);
        check_state(&m, 1.0, 1.0, 1e-9);
        text_model_run(&m, 1.0);
        check_state(&m, 0.0, 1.0, 1e-9);
        text_model_close(&m);
    }
}

/* The rate after the kink is that at its time where the function says so. */
static void runs_begin_and_end_at_kinks(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int k = 0; k < 2; ++k) {
            text_model m = open_carts(DRIVE("da", "sa", "if(t < 0.5, 0, t - 0.5)")
                                          DRIVE("db", "sb", "if(t <= 0.5, 0, t - 0.5)"),
                                      method, k * 0.01);
            text_model_run(&m, 0.5);
            check_state(&m, 1.0, 0.0, 1e-9);
            text_model_run(&m, 0.5); /* again: nothing happens twice */
            check_state(&m, 1.0, 0.0, 1e-9);
            text_model_run(&m, 0.51);
            check_state(&m, 1.0, 1.0, 1e-9);
            text_model_close(&m);
        }
    }
}

/* The velocity of the first cart; the account goes on from the kinetic energy at the start. */
static void check_account(const text_model *m, double v, double v_start)
{
    CHECK_NEAR(text_model_get(m, 0, 0), v, 1e-9);
    CHECK_NEAR(text_model_get(m, 2, 0), v_start * v_start, 1e-9);
}

/* At a kink the rate is neither that before nor the mean of both; the one at the start is passed,
 * too. From -.5 to 1.5 m/s the driver does 2 J on 2 kg, which the account has. */
static void kinks_at_round_times_and_at_the_start_are_passed(void)
{
    static const struct {
        const char *value;
        double middle, end, start; /* velocities at .5 and .75 s, and what is there at 0 s */
    } rows[] = {{"abs(t - 0.5) + 0.5*t", 1.5, 1.5, -0.5},
                {"max(0.5 - t, 0)", 0.0, 0.0, -1.0},
                {"abs(t)", 1.0, 1.0, 1.0},
                {"max(0, t)", 1.0, 1.0, 1.0},
                {"-min(2*t, t)", -1.0, -1.0, -1.0},
                {"if(t <= 0, 0, t)", 1.0, 1.0, 0.0}};
    for (int32_t method = 0; method < method_count(); ++method) {
        for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
            char drivers[200];
            snprintf(drivers, sizeof drivers, DRIVE("da", "sa", "%s"), rows[k].value);
            text_model m = open_carts(drivers, method, 0.0);
            text_model_run(&m, 0.0);
            check_account(&m, rows[k].start, rows[k].start);
            text_model_run(&m, 0.5);
            check_account(&m, rows[k].middle, rows[k].start);
            text_model_run(&m, 0.75);
            check_account(&m, rows[k].end, rows[k].start);
            text_model_close(&m);
        }
    }
}

/* A pendulum below a cart that starts and stops; goes on bit by bit from any time. */
static const char swing[] = "se3d: 1\nbodies:\n" BODY(
    "a", "0") "  - {name: b, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, -1]}\n"
              "joints:\n" SLIDE("sa", "a",
                                "0") "  - {name: pin, type: revolute, body_i: a, body_j: b, at: "
                                     "[0, 0, 0], axis: [0, 1, 0]}\n"
                                     "drivers:\n" DRIVE("da", "sa",
                                                        "max(0, t - 0.5) - max(0, t - 0.75)") TAIL;

static void runs_go_on_bit_by_bit_over_kinks(void)
{
    static const double times[] = {0.45, 0.4999, 0.5, 0.6};
    for (int32_t method = 0; method < method_count(); ++method) {
        for (size_t k = 0; k < sizeof times / sizeof *times; ++k) {
            text_model m = text_model_open(swing, method, k % 2, 0.0);
            se3d_snapshot *kept = NULL;
            se3d_system *other = NULL;
            se3d_solver *solver = NULL;
            se3d_solver_def def = se3d_solver_def_default();
            CHECK(!se3d_model_get_solver(m.model, 0, &def));
            def.method = method;
            def.formulation = k % 2;
            text_model_run(&m, times[k]);
            CHECK(!se3d_snapshot_create(m.system, &kept));
            CHECK(!se3d_system_clone(m.system, &other));
            CHECK(!se3d_solver_create(other, &def, &solver));
            text_model_run(&m, 0.8);
            const uint64_t hash = se3d_system_hash(m.system);
            CHECK(!se3d_solver_run(solver, 0.8));
            CHECK(se3d_system_hash(other) == hash);
            CHECK(!se3d_snapshot_restore(kept, m.system));
            text_model_run(&m, 0.8);
            CHECK(se3d_system_hash(m.system) == hash);
            se3d_solver_destroy(solver);
            se3d_system_destroy(other);
            se3d_snapshot_destroy(kept);
            text_model_close(&m);
        }
    }
}

/* A cart is driven on; another one on it with friction stays, then slips as it is left behind. */
static void friction_slips_the_new_way_behind_a_kink(void)
{
    static const char text[] = HEAD BODY("a", "0") BODY("b", "1") "joints:\n" SLIDE(
        "sa", "a", "0") "  - {name: sb, type: prismatic, body_i: a, body_j: b, at: [0, 1, 0], "
                        "axis: [1, 0, 0]}\n"
                        "drivers:\n" DRIVE(
                            "da", "sa", "max(0, t - 0.5)") "forces:\n  - {name: f, type: friction, "
                                                           "joint: sb, limit: 1}\n" TAIL;
    for (int32_t method = 0; method < method_count(); ++method) {
        text_model m = text_model_open(text, method, method % 2, 0.0);
        text_model_run(&m, 0.4);
        check_state(&m, 0.0, 0.0, 1e-6);
        text_model_run(&m, 1.0); /* .5 s of 1 N on 2 kg */
        check_state(&m, 1.0, 0.25, 1e-4);
        text_model_close(&m);
    }
}

/* However short the runs are: steps ahead of them do not pass over it unseen. */
static void values_that_jump_are_refused_in_every_method(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int k = 0; k < 2; ++k) {
            text_model m = open_carts(
                DRIVE("da", "sa", "if(t < 0.505, 0, 1e-3)") DRIVE("db", "sb", "0*t"), method, 0.0);
            se3d_status status = SE3D_OK;
            double t = 0.0;
            for (int run = 1; run <= 100 && status >= 0; ++run) {
                status =
                    k ? se3d_solver_step(m.solver, 0.01) : se3d_solver_run(m.solver, 0.01 * run);
            }
            CHECK(status == SE3D_ERR_INCONSISTENT);
            CHECK_CONTAINS(se3d_system_get_error(m.system), "jumps from 0 to 0.001 at t = 0.505 s");
            CHECK(!se3d_system_get_time(m.system, &t));
            CHECK(t < 0.505);
            CHECK(fabs(text_model_get(&m, 0, 0)) < 1e-9);
            text_model_close(&m);
        }
    }
}

/* If a kink is less than two steps ahead, two shorter ones lead to it. */
static void no_step_before_a_kink_is_longer_than_it_was_given(void)
{
    static const int32_t methods[] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT,
                                      SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET, SE3D_METHOD_CONVEX};
    for (size_t k = 0; k < sizeof methods / sizeof methods[0]; ++k) {
        text_model m = open_carts(DRIVE("da", "sa", "max(0, t - 0.036)"), methods[k], 0.01);
        se3d_solver_stats stats;
        CHECK(text_model_run(&m, 0.05));
        CHECK(!se3d_solver_get_stats(m.solver, &stats));
        CHECK(stats.steps == 7); /* four to the kink, one over it, two from there */
        check_state(&m, 1.0, 0.0, 1e-9);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(two_drivers_jump_at_once_and_after_each_other);
    RUN(coupled_drivers_share_the_impulse);
    RUN(short_pulses_are_not_passed_over);
    RUN(runs_begin_and_end_at_kinks);
    RUN(kinks_at_round_times_and_at_the_start_are_passed);
    RUN(runs_go_on_bit_by_bit_over_kinks);
    RUN(friction_slips_the_new_way_behind_a_kink);
    RUN(values_that_jump_are_refused_in_every_method);
    RUN(no_step_before_a_kink_is_longer_than_it_was_given);
    return check_finish();
}
