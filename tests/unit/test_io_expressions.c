/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions of channels in outputs and events, components, and summaries of a run: against what a
 * point in free fall does, z = 3 + 4 t - 5 t^2 with g = 10. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"
#include "support/read_text.h"

#define BALL                                                                                       \
    "se3d: 1\nparameters: {twice: 2, ball: 7, ball_position_z: 100}\ngravity: [0, 0, -10]\n"       \
    "bodies:\n  - {name: ball, mass: 2, inertia: [1, 1, 1], position: [1, 2, 3], "                 \
    "velocity: [3, 0, 4]}\n  - {name: left-arm, mass: 1, inertia: [1, 1, 1], position: [0, 0, "    \
    "7]}\nanalysis: {type: dynamics, duration: 1, step: 0.01, tolerance: 1e-10}\n"

static double value_of(const se3d_model *model, size_t k, const char *name)
{
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    size_t width = 0;
    const char *is = "";
    CHECK(!se3d_model_get_channel(model, 0, k, &is));
    CHECK(strcmp(is, name) == 0);
    CHECK(!se3d_model_get_channel_value(model, 0, k, NULL, value, &width) && width == 1);
    return value[0];
}

static void expressions_have_these_values(void)
{
    static const struct {
        const char *text;
        const char *name;
        double value;
    } table[] = {
        {"ball.position.z", "ball.position.z", 3.0},
        {"speed: hypot(ball.velocity.x, ball.velocity.z)", "speed", 5.0},
        {"\"hypot(ball.velocity.x, ball.velocity.z)\"", "hypot(ball.velocity.x ball.velocity.z)",
         5.0},
        {"ball.position.x - 2*ball.position.y", "ball.position.x - 2*ball.position.y", -3.0},
        {"a: twice*ball.position.z + t", "a", 6.0},
        {"b: ball.position.z - ball_position_z", "b", -97.0},
        {"c: \"'left-arm.position.z' + 1e1*ball.position.x\"", "c", 17.0},
        {"d: ball.position.z - 500 mm", "d", 2.5},
        {"e: energy.kinetic/2", "e", 12.5},
        {"f: ball.orientation.e0 + ball.position.z^2", "f", 10.0}};
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        char text[1500];
        snprintf(text, sizeof text, BALL "output:\n  - file: r.csv\n    channels:\n      - %s\n",
                 table[k].text);
        se3d_model *model = read_text(text);
        CHECK_NEAR(value_of(model, 0, table[k].name), table[k].value, 1e-14);
        se3d_model_destroy(model);
    }
}

/* With units, of vectors of channels: whatever the units of the file are. */
static void formulas_of_channels_have_these_values(void)
{
    static const char *const units[] = {"", "units: {length: mm, time: min, mass: g}\n"};
    static const struct {
        const char *text;
        double value;
    } table[] = {
        {"norm([ball.position.x, ball.position.y, ball.position.z])", 3.7416573867739413},
        {"norm([ball.velocity.x, 0, 2 m/s])", 3.6055512754639893},
        {"dot([ball.position.x, ball.position.y, 0 m], [1 m, 2 m, 3])", 5.0},
        {"dot(p, [ball.position.x, 1 m, 2 m])", 9.0},
        {"cross([ball.position.x, 0, 0 m], [0, ball.position.y, 0 m]).z", 2.0},
        {"cross(p, [ball.position.x, 0, 0 m]).y", 3.0},
        {"unit([ball.velocity.x, 0, 4 m/s]).z", 0.8},
        {"unit([3 m/s, 0 m/s, ball.velocity.z]).x", 0.6},
        {"mid(p, [ball.position.z, 0 m, 0]).x", 2.0},
        {"distance(p, [ball.position.x, 2 m, 8 m])", 5.0},
        {"angle([ball.velocity.x, 0 m/s, 0], [0, 1, 0])", 1.5707963267948966},
        {"rotate([ball.position.x, 0 m, 0], [0, 0, 1], 90 deg).y", 1.0},
        {"rotate([1, 2, 3], [0, 0, 1 m], ball.position.x/(1 m)*90 deg).x", -2.0},
        {"rotate([1, 2, 3], [0, 0, ball.position.x], 1 m/ball.position.x*90 deg).z", 3.0},
        {"(2*p - [ball.position.x, 0 m, 0 m]).x", 1.0},
        {"-[0, ball.position.y, 1 m].y", -2.0},
        {"[ball.position.x, ball.position.y, 1 m].y/(1 m)", 2.0},
        {"if(ball.position.z > 2 m, ball.position.x, 5 m)", 1.0},
        {"if(ball.position.z <= 2000 mm, ball.position.x, 5 m)", 5.0},
        {"(ball.position.z == 3 m) + (ball.position.z != 3 m) + (ball.position.z >= 3 m)", 2.0},
        {"(1 m < 2 m)*ball.position.z", 3.0},
        {"-ball.position.z^2", -9.0},
        {"+ball.position.z", 3.0},
        {"(ball.position.z*(1 m))^0 + 1", 2.0},
        {"ball.position.y^-1*(6 m^2)", 3.0},
        {"2^(ball.position.z/(1 m))", 8.0},
        {"(2 m)^3/ball.position.y", 4.0},
        {"sqrt(ball.position.x^2 + (2 m)^2)", 2.23606797749979},
        {"max(ball.position.x, 20 mm, 1.5 m)", 1.5},
        {"mod(ball.position.z, 2 m)", 1.0},
        {"abs(1 m - ball.position.z)", 2.0},
        {"hypot(ball.position.z, 4 m)", 5.0},
        {"sign(1 m - ball.position.z)", -1.0},
        {"step(ball.position.x, 0 m, 1 N, 2 m, 3 N)", 2.0},
        {"step(1 m, 0 m, ball.position.x, 2 m, ball.position.z)", 2.0},
        {"atan2(ball.position.x, 1 m)/(1 deg)", 45.0},
        {"cos(ball.position.x/(1 m)*60 deg)", 0.5},
        {"exp(log(ball.position.z/(1 m)))", 3.0},
        {"tan(pi*ball.position.x/(4 m))", 1.0},
        {"deg*ball.position.x/(1 m)", 0.017453292519943295},
        {"3.00000000000000000*(1 m)*ball.position.y/(1 m)", 6.0},
        {"2.5e0*ball.position.y/(1E+0 m)*(1 m)", 5.0}};
    for (size_t k = 0; k < 2 * (sizeof table / sizeof *table); ++k) {
        char text[1500];
        snprintf(
            text, sizeof text,
            "se3d: 1\n%spoints: {p: [1 m, 2 m, 3 m]}\nbodies: [{name: ball, mass: 1, inertia: "
            "[1, 1, 1], position: p, velocity: [3 m/s, 0 m/s, 4 m/s]}]\noutput: [{file: r.csv, "
            "channels: [{v: \"%s\"}]}]\n",
            units[k % 2], table[k / 2].text);
        se3d_model *model = read_text(text);
        const double value = model ? value_of(model, 0, "v") : (double)NAN;
        if (!(fabs(value - table[k / 2].value) < 1e-13)) {
            fprintf(stderr, "%s%s: %.17g\n", units[k % 2], table[k / 2].text, value);
        }
        CHECK_NEAR(value, table[k / 2].value, 1e-13);
        se3d_model_destroy(model);
    }
}

/* In a file in mm numbers without a unit are mm, too, and what comes out is in SI units. */
static void units_of_the_file_hold(void)
{
    se3d_model *model = read_text(
        "se3d: 1\nunits: {length: mm}\npoints: {p: [100, 200, 300]}\nbodies: [{name: ball, mass: "
        "2, inertia: [1, 1, 1], position: p}]\noutput:\n  - file: r.csv\n    channels:\n"
        "      - above: ball.position.z - 250\n      - x: ball.position.x + p.y\n"
        "      - y: ball.position.y - 1 m\n      - ratio: ball.position.z/ball.position.x\n");
    CHECK_NEAR(value_of(model, 0, "above"), 0.05, 1e-15);
    CHECK_NEAR(value_of(model, 1, "x"), 0.3, 1e-15);
    CHECK_NEAR(value_of(model, 2, "y"), -0.8, 1e-15);
    CHECK_NEAR(value_of(model, 3, "ratio"), 3.0, 1e-15);
    se3d_model_destroy(model);
}

static void summaries_are_those_of_the_motion(void)
{
    char folder[800];
    se3d_model_error error = {0};
    se3d_run *run = NULL;
    se3d_run_options how = se3d_run_options_default();
    se3d_run_summary s[4];
    snprintf(folder, sizeof folder, "%s/expressions", check_scratch());
    how.directory = folder;
    se3d_model *model = read_text(
        BALL "events:\n  - {name: level, channel: \"ball.position.z + ball.position.x\", value: "
             "5.8, direction: rising}\n"
             "output:\n  - summary: s.csv\n    channels: [ball.position.z, {shift: ball.position.x "
             "- 1}, {one: 1 + 0*ball.position.x}]\n"
             "  - {summary: w.csv, every: 0.1, start: 0.2, stop: 0.6, channels: [{shift: "
             "ball.position.x - 1}]}\n");
    CHECK(se3d_model_run(model, &how, &run, &error) >= 0);
    CHECK(se3d_run_count_summaries(run) == 4);
    for (size_t k = 0; k < 4; ++k) {
        CHECK(!se3d_run_get_summary(run, k, &s[k]));
        CHECK(strcmp(s[k].file, k < 3 ? "s.csv" : "w.csv") == 0);
    }
    const double h2 = 1e-4;
    CHECK(strcmp(s[0].channel, "ball.position.z") == 0);
    CHECK_NEAR(s[0].max, 3.8, 1e-12);
    CHECK_NEAR(s[0].max_time, 0.4, 1e-15);
    CHECK_NEAR(s[0].min, 2.0, 1e-12);
    CHECK_NEAR(s[0].min_time, 1.0, 1e-15);
    CHECK_NEAR(s[0].last, 2.0, 1e-12);
    CHECK_NEAR(s[0].integral, 3.0 + 2.0 - 5.0 / 3.0 - h2 * 10.0 / 12.0, 1e-12);
    CHECK_NEAR(s[0].mean, s[0].integral, 1e-15);
    CHECK(strcmp(s[1].channel, "shift") == 0);
    CHECK_NEAR(s[1].rms, sqrt(3.0), 1e-12); /* of 3 t */
    CHECK_NEAR(s[1].integral, 1.5, 1e-12);
    CHECK_NEAR(s[2].rms, 1.0, 1e-15);
    CHECK_NEAR(s[3].mean, 3.0 * 0.4, 1e-12); /* of 3 t from 0.2 to 0.6 */
    CHECK_NEAR(s[3].integral, 3.0 * 0.4 * 0.4, 1e-12);
    CHECK_NEAR(s[3].min_time, 0.2, 1e-15);
    CHECK_NEAR(s[3].last, 3.0 * 0.6, 1e-12);
    se3d_run_event event;
    CHECK(se3d_run_count_events(run) == 1 && !se3d_run_get_event(run, 0, &event));
    CHECK_NEAR(event.time, 0.7 - sqrt(0.49 - 0.36), 1e-9); /* 4 + 7 t - 5 t^2 = 5.8 */
    se3d_run_destroy(run);
    se3d_model_destroy(model);
}

/* From C: an expression in SI units. */
static void events_of_expressions_are_found(void)
{
    se3d_model_error error = {0};
    se3d_event event;
    se3d_solver *solver = NULL;
    se3d_solver_def solver_def = se3d_solver_def_default();
    se3d_event_def def = se3d_event_def_default();
    se3d_model *model = read_text(BALL);
    CHECK(!se3d_solver_create(se3d_model_get_system(model), &solver_def, &solver));
    def.level = 2.0;
    CHECK(!se3d_model_create_event(model, solver, "ball.position.x^2 - ball.position.y", &def,
                                   &event, &error));
    CHECK(se3d_model_create_event(model, solver, "hypot(ball.position.x", &def, &event, &error) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(error.message, "column");
    CHECK(se3d_model_create_event(model, solver, "2*steps + ball.positon.x", &def, &event,
                                  &error) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(error.message, "did you mean `position`");
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

int main(void)
{
    RUN(expressions_have_these_values);
    RUN(formulas_of_channels_have_these_values);
    RUN(units_of_the_file_hold);
    RUN(summaries_are_those_of_the_motion);
    RUN(events_of_expressions_are_found);
    return check_finish();
}
