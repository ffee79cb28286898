/* SPDX-License-Identifier: BSD-3-Clause */
/* Events tell crossings from rounding: a value counts as on a side of its level once it has been
 * further from it than the hysteresis. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"

typedef double (*signal)(double t);

static se3d_status get_signal(void *ctx, const se3d_system *system, double *value)
{
    double t = 0.0;
    se3d_system_get_time(system, &t);
    *value = (*(const signal *)ctx)(t);
    return SE3D_OK;
}

static double noise(double t)
{
    return 1e-14 * sin(1e5 * t);
}

static double down_into_noise(double t)
{
    return noise(t) + (t < 0.5 ? 0.5 - t : 0.0);
}

static double down_slowly(double t)
{
    return 0.5 - t;
}

static double down_to_the_band_and_back(double t)
{
    return 0.01 + (t - 0.5) * (t - 0.5);
}

static double up_and_down_within_the_band(double t)
{
    return 0.5 - t + 0.02 * sin(100.0 * t);
}

static const struct {
    int32_t method;
    double step;
} methods[] = {
    {SE3D_METHOD_DOP853, 0.01}, {SE3D_METHOD_RADAU, 0.01},  {SE3D_METHOD_BDF, 0.01},
    {SE3D_METHOD_HHT, 0.01},    {SE3D_METHOD_RATTLE, 0.01}, {SE3D_METHOD_VERLET, 0.01},
    {SE3D_METHOD_GAUSS, 0.01},  {SE3D_METHOD_DOP853, 0.0},
};
#define METHODS (sizeof methods / sizeof methods[0])

/* Events in a second of a falling ball. @return how many; *first: time of the first */
static size_t count_crossings(size_t method, signal f, double hysteresis, double *first)
{
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    se3d_body body;
    se3d_event event;
    se3d_body_def ball = se3d_body_def_default();
    se3d_solver_def how = se3d_solver_def_default();
    se3d_event_def def = se3d_event_def_default();
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    ball.mass = ball.inertia[0] = ball.inertia[1] = ball.inertia[2] = 1.0;
    CHECK(se3d_body_create(system, &ball, &body) == SE3D_OK);
    how.method = methods[method].method;
    how.step = methods[method].step;
    CHECK(se3d_solver_create(system, &how, &solver) == SE3D_OK);
    def.value = get_signal;
    def.ctx = &f;
    def.hysteresis = hysteresis;
    CHECK(se3d_event_create(solver, &def, &event) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 0.3) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 1.0) == SE3D_OK);
    const size_t count = se3d_solver_count_event_records(solver);
    se3d_event_record record;
    *first = (double)NAN;
    if (count > 0 && se3d_solver_get_event_record(solver, 0, &record) == SE3D_OK) {
        *first = record.time;
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    return count;
}

static void rounding_about_the_level_is_no_crossing(void)
{
    double t;
    for (size_t k = 0; k < METHODS; ++k) {
        CHECK(count_crossings(k, noise, 1e-12, &t) == 0);
        CHECK(k + 1 == METHODS || count_crossings(k, noise, 0.0, &t) > 10);
    }
}

static void what_comes_down_to_rest_at_the_level_crosses_once(void)
{
    double t;
    for (size_t k = 0; k + 1 < METHODS; ++k) {
        CHECK(count_crossings(k, down_into_noise, 1e-12, &t) == 1);
        CHECK_NEAR(t, 0.5, 0.0051); /* one of the next two samples, a quarter of a step each */
    }
}

/* The band is passed in many steps, and the crossing is that of the level. */
static void a_slow_crossing_keeps_its_side_through_the_band(void)
{
    double t;
    for (size_t k = 0; k < METHODS; ++k) {
        CHECK(count_crossings(k, down_slowly, 0.2, &t) == 1);
        CHECK_NEAR(t, 0.5, 1e-15);
        CHECK(count_crossings(k, down_slowly, 0.6, &t) == 0);
    }
}

static void reaching_the_band_alone_is_no_crossing(void)
{
    double t;
    for (size_t k = 0; k < METHODS; ++k) {
        CHECK(count_crossings(k, down_to_the_band_and_back, 0.1, &t) == 0);
    }
}

/* 0.5 - t + 0.02 sin(100 t) is zero five times; the others are within 0.05 of the first. */
static void returns_within_the_band_do_not_count(void)
{
    double t, once;
    for (size_t k = 0; k + 1 < METHODS; ++k) {
        CHECK(count_crossings(k, up_and_down_within_the_band, 0.0, &t) > 1);
        CHECK(count_crossings(k, up_and_down_within_the_band, 0.1, &once) == 1);
        CHECK_NEAR(once, t, 1e-12);
    }
}

/* A pendulum in a vertical plane whose axis is not exact in binary: torques and rates perpendicular
 * to the plane are rounding. */
static const char pendulum[] =
    "se3d: 1\n"
    "bodies: [{name: bar, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.6, 0.8, 0]}]\n"
    "joints: [{name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0.8, "
    "-0.6, 0]}]\n"
    "events:\n"
    "  - {name: torque, channel: pin.torque.z}\n"
    "  - {name: rate, channel: bar.angular_velocity.z}\n"
    "  - {name: speed, channel: bar.velocity.z}\n"
    "output: [{file: a.csv, channels: [pin.angle]}]\n";

static void channels_at_rounding_do_not_fire_and_others_do(void)
{
    const char *const names[] = {"dop853", "rk45",  "radau", "bdf", "hht", "generalized_alpha",
                                 "rattle", "verlet"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; ++k) {
        char text[1000], folder[800];
        se3d_model *model = NULL;
        se3d_run *run = NULL;
        se3d_run_options how = se3d_run_options_default();
        snprintf(text, sizeof text,
                 "%sanalysis: {type: dynamics, duration: 3, step: 0.01, method: %s}\n", pendulum,
                 names[k]);
        snprintf(folder, sizeof folder, "%s/event_sides", check_scratch());
        how.directory = folder;
        CHECK(se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, NULL) == SE3D_OK);
        CHECK(se3d_model_run(model, &how, &run, NULL) >= 0);
        CHECK(se3d_run_count_events(run) == 4);
        for (size_t n = 0; n < se3d_run_count_events(run); ++n) {
            se3d_run_event event;
            CHECK(se3d_run_get_event(run, n, &event) == SE3D_OK);
            CHECK(strcmp(event.name, "speed") == 0);
        }
        se3d_run_destroy(run);
        se3d_model_destroy(model);
    }
}

int main(void)
{
    RUN(rounding_about_the_level_is_no_crossing);
    RUN(what_comes_down_to_rest_at_the_level_crosses_once);
    RUN(a_slow_crossing_keeps_its_side_through_the_band);
    RUN(reaching_the_band_alone_is_no_crossing);
    RUN(returns_within_the_band_do_not_count);
    RUN(channels_at_rounding_do_not_fire_and_others_do);
    return check_finish();
}
