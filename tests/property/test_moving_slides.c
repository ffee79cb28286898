/* SPDX-License-Identifier: BSD-3-Clause */
/* A block on a slide that a driver swings by 0.05 sin(8 t): with mu 0.5 it holds all the time, with
 * 0.3 and 0.2 it sticks and slips in turn, with 0.05 it slips to and fro. dop853 at 1e-10, where
 * what sticks is rigid, says what is right. What holds takes no step of its own: implicit methods
 * hold it by a stiff spring, which must not tremble, and rattle and verlet choose steps as if it
 * were none. */
#include "support/text_model.h"

#include <stdio.h>

static const char *const slide =
    "se3d: 1\nparameters: {mu: %g}\ngravity: [0, 0, -9.81]\nbodies:\n"
    "  - {name: slide, velocity: [0.4, 0, 0], mass: 1, inertia: [0.01, 0.01, 0.01]}\n"
    "  - {name: block, velocity: [0.4, 0, 0], mass: 2, inertia: [0.01, 0.01, 0.01], position: [0, "
    "0, 0.1]}\njoints:\n"
    "  - {name: way, type: prismatic, body_i: ground, body_j: slide, at: [0, 0, 0], axis: [1, 0, "
    "0]}\n"
    "  - {name: guide, type: prismatic, body_i: slide, body_j: block, at: [0, 0, 0.1], axis: [1, "
    "0, 0]}\n"
    "drivers: [{name: drive, joint: way, coordinate: displacement, value: 0.05*sin(8*t)}]\n"
    "forces: [{name: friction, type: friction, joint: guide, mu: mu}]\n"
    "analysis: {type: dynamics, duration: 2, tolerance: %g}\n"
    "output: [{file: r.csv, channels: [guide.displacement, guide.rate, friction.force, "
    "energy.dissipated]}]\n";

#define ROWS     8
#define CHANNELS 4

typedef struct record {
    double value[ROWS][CHANNELS];
    uint64_t steps;
    double step;
} record;

static record run(double mu, double tolerance, int32_t method)
{
    char text[2000];
    record r = {.step = 0.0};
    se3d_solver_stats stats;
    snprintf(text, sizeof text, slide, mu, tolerance);
    text_model m = text_model_open(text, method, SE3D_FORMULATION_ROMEGA, 0.0);
    for (int row = 0; row < ROWS && text_model_run(&m, 0.25 * (row + 1)); ++row) {
        for (size_t k = 0; k < CHANNELS; ++k) {
            r.value[row][k] = text_model_get(&m, k, 0);
        }
    }
    CHECK(!se3d_solver_get_stats(m.solver, &stats));
    r.steps = stats.steps;
    (void)se3d_solver_get_step(m.solver, &r.step);
    text_model_close(&m);
    return r;
}

/* Steps at most, what positions, rates, forces and works may be off by, of the scales .1, .4, 5, 1
 */
typedef struct demand {
    int32_t method;
    uint64_t steps;
    double position, rate, force, work;
} demand;

static void check_method(const demand *d, double mu, const record *right)
{
    const record found = run(mu, 1e-6, d->method);
    const double allowed[CHANNELS] = {d->position, d->rate, d->force, d->work};
    if (found.steps > d->steps) {
        fprintf(stderr, "%s, mu %g: %llu steps\n", se3d_method_get_name(d->method), mu,
                (unsigned long long)found.steps);
    }
    CHECK(found.steps <= d->steps);
    for (int row = 0; row < ROWS; ++row) {
        for (size_t k = 0; k < CHANNELS; ++k) {
            CHECK_NEAR(found.value[row][k], right->value[row][k], allowed[k]);
        }
    }
}

static void what_holds_or_slips_on_a_moving_slide_is_followed_by_all(void)
{
    static const demand demands[] = {
        {SE3D_METHOD_DOP853, 200, 1e-7, 1e-7, 1e-6, 1e-6},
        {SE3D_METHOD_RADAU, 800, 5e-6, 1e-5, 0.1, 3e-5},
        {SE3D_METHOD_BDF, 3000, 1e-6, 4e-6, 0.2, 5e-6},
        {SE3D_METHOD_HHT, 20000, 1e-6, 1e-6, 0.2, 5e-5},
    };
    static const double frictions[] = {0.05, 0.2, 0.3, 0.5};
    for (size_t k = 0; k < 4; ++k) {
        const record right = run(frictions[k], 1e-10, SE3D_METHOD_DOP853);
        for (size_t d = 0; d < sizeof demands / sizeof *demands; ++d) {
            if (demands[d].method != SE3D_METHOD_HHT || k == 3) { /* the others take long */
                check_method(&demands[d], frictions[k], &right);
            }
        }
    }
}

/* A step in which friction changes its mode is made in parts; others need not be shorter. */
static void changes_of_friction_choose_no_steps_of_rattle(void)
{
    const record right = run(0.2, 1e-10, SE3D_METHOD_DOP853);
    const record found = run(0.2, 1e-6, SE3D_METHOD_RATTLE);
    CHECK(found.step >= 5e-5);
    for (int row = 0; row < ROWS; ++row) {
        CHECK_NEAR(found.value[row][0], right.value[row][0], 2e-8);
        CHECK_NEAR(found.value[row][1], right.value[row][1], 2e-8);
        CHECK_NEAR(found.value[row][3], right.value[row][3], 1e-6);
    }
}

int main(void)
{
    RUN(what_holds_or_slips_on_a_moving_slide_is_followed_by_all);
    RUN(changes_of_friction_choose_no_steps_of_rattle);
    return check_finish();
}
