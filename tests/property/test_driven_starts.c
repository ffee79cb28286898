/* SPDX-License-Identifier: BSD-3-Clause */
/* Machines at rest, without any acceleration, that drivers set in motion: at first nothing that has
 * moved says how fast they are. Equal steps follow them; and one that fails after some of its parts
 * leaves everything as it was. */
#include "check.h"
#include "se3d/io.h"
#include "support/text_model.h"

static const int32_t newmark[] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};

/* Two bars hang from a driven pin. */
static const char *const pendulum =
    "se3d: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
    "  - {name: a, mass: 1, inertia: [1/12, 1/12, 1e-3], position: [0, 0, -0.5]}\n"
    "  - {name: b, mass: 1, inertia: [1/12, 1/12, 1e-3], position: [0, 0, -1.5]}\n"
    "joints:\n"
    "  - {name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"
    "  - {name: k, type: revolute, body_i: a, body_j: b, at: [0, 0, -1], axis: [0, 1, 0]}\n";

static const char *const slide =
    "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}]\n"
    "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "
    "0]}]\n";

/* A crank with a connecting rod and a slider, which both lie in line at first: the driven crank
 * moves the slider by the square of its angle. */
static const char *const crank =
    "se3d: 1\nbodies:\n"
    "  - {name: a, mass: 1, inertia: [1e-3, 1/12, 1/12], position: [0.5, 0, 0]}\n"
    "  - {name: b, mass: 1, inertia: [1e-3, 1/3, 1/3], position: [2, 0, 0]}\n"
    "  - {name: c, mass: 1, inertia: [1, 1, 1], position: [3, 0, 0]}\n"
    "joints:\n"
    "  - {name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"
    "  - {name: k, type: revolute, body_i: a, body_j: b, at: [1, 0, 0], axis: [0, 1, 0]}\n"
    "  - {name: l, type: revolute, body_i: b, body_j: c, at: [3, 0, 0], axis: [0, 1, 0]}\n"
    "  - {name: m, type: prismatic, body_i: ground, body_j: c, at: [3, 0, 0], axis: [1, 0, 0]}\n";

static const char *const turns = "analysis: {type: dynamics, duration: 2}\n"
                                 "output: [{file: a.csv, channels: [j.angle]}]\n";
static const char *const slides = "analysis: {type: dynamics, duration: 2}\n"
                                  "output: [{file: a.csv, channels: [j.displacement]}]\n";

/* A run of `count` steps of h, at whose end the driven value is `end`: how many it took, over
 * `count`. */
static double steps_over(const char *machine, const char *driver, int32_t method, double h,
                         int count, double end)
{
    char text[1500];
    se3d_solver_stats stats = {0};
    snprintf(text, sizeof text, "%sdrivers: [{name: d, joint: j, value: \"%s\"}]\n%s", machine,
             driver, machine == slide ? slides : turns);
    text_model m = text_model_open(text, method, -1, h);
    if (text_model_run(&m, count * h)) {
        CHECK_NEAR(text_model_get(&m, 0, 0), end, 1e-9 * (1.0 + fabs(end)));
    } else {
        fprintf(stderr, "%s, %s, step %g\n", driver, se3d_method_get_name(method), h);
    }
    CHECK(!se3d_solver_get_stats(m.solver, &stats));
    text_model_close(&m);
    return (double)stats.steps / count;
}

/* Powers of the time, and kinks at the end of a step, half way, and close to both: no step is
 * divided that was not too long for the motion. */
static void equal_steps_follow_drivers_from_rest(void)
{
    static const struct {
        const char *driver;
        double h;
        int count;
        double end;
    } rows[] = {
        {"t^3", 0.1, 10, 1.0},
        {"t^3", 0.01, 20, 8e-3},
        {"10*t^3", 0.1, 5, 1.25},
        {"1e-4*t^3", 0.1, 10, 1e-4},
        {"1000*t^3", 0.02, 5, 1.0},
        {"1e5*t^3", 0.01, 1, 0.1},
        {"t^4", 0.1, 10, 1.0},
        {"10*t^5", 0.05, 10, 0.3125},
        {"10*t^7", 0.05, 8, 0.016384},
        {"-t^3", 0.05, 10, -0.125},
        {"(t>1)*2*(t-1)^2", 0.1, 15, 0.5},
        {"(t>1.05)*2*(t-1.05)^2", 0.1, 15, 0.405},
        {"(t>1.001)*2*(t-1.001)^2", 0.1, 12, 0.0792020},
        {"(t>1.099)*20*(t-1.099)^2", 0.1, 12, 0.204020},
        {"(t>0.5)*(t-0.5)^3", 0.01, 60, 1e-3},
        {"(t>0.5)*(t-0.5)^3 - (t>0.8)*(t-0.8)^3", 0.05, 30, 0.657},
    };
    static const char *const machines[] = {"pendulum", "slide", "crank"};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        for (size_t run = 0; run < 6; ++run) {
            const char *const text = run / 2 == 0 ? pendulum : run / 2 == 1 ? slide : crank;
            const double part = steps_over(text, rows[k].driver, newmark[run % 2], rows[k].h,
                                           rows[k].count, rows[k].end);
            CHECK_NEAR(part, 1.0, 1e-12);
            if (!(part <= 1.0)) {
                fprintf(stderr, "%s, %s, %s, step %g: %g times the steps\n", machines[run / 2],
                        rows[k].driver, se3d_method_get_name(newmark[run % 2]), rows[k].h, part);
            }
        }
    }
}

/* The same where constraints have leverage, though rows may depend on each other. */
static void rattle_and_verlet_follow_drivers_from_rest(void)
{
    static const char *const drivers[] = {"t^3", "10*t^3", "t^4", "(t>0.05)*2*(t-0.05)^2"};
    static const double ends[] = {1e-3, 1e-2, 1e-4, 5e-3};
    static const int32_t methods[] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET};
    for (int k = 0; k < 4; ++k) {
        for (size_t run = 0; run < 6; ++run) {
            const char *const text = run / 2 == 0 ? pendulum : run / 2 == 1 ? slide : crank;
            CHECK_NEAR(steps_over(text, drivers[k], methods[run % 2], 0.01, 10, ends[k]), 1.0,
                       1e-12);
        }
    }
}

/* Bars in line are as far as the slide goes, at t = 1: parts of the last step come closer. */
static void a_step_that_fails_after_parts_leaves_all_as_it_was(void)
{
    static const char *const text =
        "se3d: 1\nbodies:\n"
        "  - {name: a, mass: 1, inertia: [1e-3, 1/12, 1/12], position: [0.3, 0, 0.4], "
        "orientation: {axis: [0, 1, 0], angle: -0.92729521800161219}}\n"
        "  - {name: b, mass: 1, inertia: [1e-3, 1/12, 1/12], position: [0.9, 0, 0.4], "
        "orientation: {axis: [0, 1, 0], angle: 0.92729521800161219}}\n"
        "  - {name: c, mass: 1, inertia: [1, 1, 1], position: [1.2, 0, 0]}\n"
        "joints:\n"
        "  - {name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"
        "  - {name: k, type: revolute, body_i: a, body_j: b, at: [0.6, 0, 0.8], axis: [0, 1, 0]}\n"
        "  - {name: l, type: revolute, body_i: b, body_j: c, at: [1.2, 0, 0], axis: [0, 1, 0]}\n"
        "  - {name: m, type: prismatic, body_i: ground, body_j: c, at: [1.2, 0, 0], "
        "axis: [1, 0, 0]}\n"
        "drivers: [{name: d, joint: m, value: \"0.8*t\"}]\n"
        "analysis: {type: dynamics, duration: 2}\n"
        "output: [{file: a.csv, channels: [j.angle]}]\n";
    for (int run = 0; run < 4; ++run) {
        text_model tried = text_model_open(text, newmark[run / 2], run % 2, 0.0);
        text_model other = text_model_open(text, newmark[run / 2], run % 2, 0.0);
        se3d_solver_stats before = {0}, after = {0};
        for (int k = 0; k < 9; ++k) {
            CHECK(se3d_solver_step(tried.solver, 0.1) >= 0);
            CHECK(se3d_solver_step(other.solver, 0.1) >= 0);
        }
        const uint64_t hash = se3d_system_hash(tried.system);
        CHECK(!se3d_solver_get_stats(tried.solver, &before));
        CHECK(se3d_solver_step(tried.solver, 0.15) < 0);
        CHECK(!se3d_solver_get_stats(tried.solver, &after));
        CHECK(after.steps > before.steps); /* parts were made */
        CHECK(se3d_system_hash(tried.system) == hash);
        for (int k = 0; k < 3; ++k) {
            CHECK(se3d_solver_step(tried.solver, 0.01) >= 0);
            CHECK(se3d_solver_step(other.solver, 0.01) >= 0);
            CHECK(se3d_system_hash(tried.system) == se3d_system_hash(other.system));
        }
        text_model_close(&tried);
        text_model_close(&other);
    }
}

int main(void)
{
    RUN(equal_steps_follow_drivers_from_rest);
    RUN(rattle_and_verlet_follow_drivers_from_rest);
    RUN(a_step_that_fails_after_parts_leaves_all_as_it_was);
    return check_finish();
}
