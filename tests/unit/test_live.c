/* SPDX-License-Identifier: BSD-3-Clause */
/* A model that runs while someone looks at it: what it keeps when its file is read again with other
 * bodies, what can be set and pulled, and what is said of files that cannot be shown. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "io/live/live.h"
#include "io/write/drawing.h"
#include "support/scratch.h"

#define MODEL "live.yaml"
#define HEAD                                                                                       \
    "se3d: 1\ngravity: [0, 0, 0]\nparameters: {c: 1}\nbodies:\n"                                   \
    "  - {name: table, mass: 1, inertia: [1, 1, 1], position: [0, 3, 0], fixed: true}\n"           \
    "  - {name: a, mass: 2, inertia: [1, 1, 1], velocity: [1, 0, 0]}\n"
#define SECOND                                                                                     \
    "  - {name: b, mass: 1, inertia: [1, 1, 1], position: [0, 1, 0], angular_velocity: [0, 0, "    \
    "2]}\n"
#define JOINTS                                                                                     \
    "joints:\n"                                                                                    \
    "  - {name: rail, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "    \
    "0]}\n"
#define LAG "states: [{name: lag, type: lag, input: 1, time_constant: 0.5}]\n"
#define RUN_5                                                                                      \
    "analysis: {type: dynamics, duration: 5}\n"                                                    \
    "output: [{file: r.csv, every: 0.1, channels: [a.position, lag.value]}]\n"

static char message[SE3DI_LIVE_MESSAGE_SIZE];
static int ends;

static int interrupt(void *ctx)
{
    (void)ctx;
    return ends;
}

static void write_model(const char *text)
{
    scratch_write(MODEL, text, strlen(text));
}

static se3di_live *open_model(const char *text)
{
    static se3d_model_options options;
    options = se3d_model_options_default();
    write_model(text);
    return se3di_live_create(scratch_path(MODEL), &options, interrupt, NULL, message);
}

/* Position of body `body`, as scenes count them. */
static void get_place(se3di_live *live, size_t body, double r[3])
{
    double *places = malloc(se3di_live_count_places(live) * sizeof *places);
    CHECK(places != NULL);
    if (places) {
        se3di_live_get_places(live, places);
        memcpy(r, places + SE3DI_POSE * body, 3 * sizeof *r);
    }
    free(places);
}

static double get_value(se3di_live *live, const char *column)
{
    double values[20];
    size_t k = 0;
    CHECK(se3di_live_count_columns(live) <= 20);
    se3di_live_get_values(live, values);
    while (k < se3di_live_count_columns(live) &&
           strcmp(se3di_live_get_column(live, k), column) != 0) {
        ++k;
    }
    CHECK(k < se3di_live_count_columns(live)); /* there is such a column */
    return k < se3di_live_count_columns(live) ? values[k] : (double)NAN;
}

/* The number whose name begins so. */
static void set_number(se3di_live *live, const char *name, double value)
{
    size_t k = 0;
    while (k < se3di_live_count_sliders(live) &&
           strncmp(se3di_live_get_slider(live, k)->name, name, strlen(name)) != 0) {
        ++k;
    }
    CHECK(se3di_live_set(live, k, value));
}

/* Bodies and states of the same names go on, others begin as in the file. */
static void a_file_with_another_body_goes_on_where_it_is(void)
{
    double r[3];
    se3di_live *live = open_model(HEAD JOINTS LAG RUN_5);
    CHECK(live && se3di_live_run(live, 0.5, message));
    CHECK_NEAR(get_value(live, "a.position.x"), 0.5, 1e-9);
    const double lag = get_value(live, "lag.value");
    CHECK_NEAR(lag, 1.0 - exp(-1.0), 1e-4);
    write_model(HEAD SECOND JOINTS LAG RUN_5);
    CHECK(se3di_live_read(live, SE3DI_LIVE_GOING_ON, message) && !message[0]);
    CHECK(se3di_live_count_readings(live) == 2);
    CHECK_NEAR(se3di_live_get_time(live), 0.5, 1e-12);
    CHECK_NEAR(get_value(live, "a.position.x"), 0.5, 1e-9);
    CHECK_NEAR(get_value(live, "lag.value"), lag, 1e-12);
    get_place(live, 3, r);
    CHECK_NEAR(r[1], 1.0, 1e-12);
    CHECK(se3di_live_run(live, 1.0, message));
    CHECK_NEAR(get_value(live, "a.position.x"), 1.0, 1e-9); /* with the velocity that it had */
    /* without the state, and with the body under another name */
    write_model("se3d: 1\ngravity: [0, 0, 0]\nbodies:\n"
                "  - {name: table, mass: 1, inertia: [1, 1, 1], position: [0, 4, 0], fixed: true}\n"
                "  - {name: c, mass: 2, inertia: [1, 1, 1], position: [7, 0, 0]}\n"
                "analysis: {type: dynamics, duration: 5}\n");
    CHECK(se3di_live_read(live, SE3DI_LIVE_GOING_ON, message) && !message[0]);
    get_place(live, 2, r);
    CHECK_NEAR(r[0], 7.0, 1e-12);
    get_place(live, 1, r);
    CHECK_NEAR(r[1], 4.0, 1e-12);
    se3di_live_destroy(live);
}

/* The same names, but the table stands elsewhere: it does there, the rest goes on. */
static void a_fixed_body_stands_where_the_file_has_it(void)
{
    double r[3];
    se3di_live *live = open_model(HEAD JOINTS LAG RUN_5);
    CHECK(live && se3di_live_run(live, 0.5, message));
    write_model(
        "se3d: 1\ngravity: [0, 0, 0]\nparameters: {c: 1}\nbodies:\n"
        "  - {name: table, mass: 1, inertia: [1, 1, 1], position: [0, 5, 0], fixed: true}\n"
        "  - {name: a, mass: 2, inertia: [1, 1, 1], velocity: [1, 0, 0]}\n" JOINTS LAG RUN_5);
    CHECK(se3di_live_read(live, SE3DI_LIVE_GOING_ON, message) && !message[0]);
    get_place(live, 1, r);
    CHECK_NEAR(r[1], 5.0, 1e-12);
    CHECK_NEAR(get_value(live, "a.position.x"), 0.5, 1e-9);
    se3di_live_destroy(live);
}

/* A driver by its rate does not jump when another body comes in. */
static void a_driver_with_a_rate_goes_on_from_its_place(void)
{
#define DRIVEN JOINTS "drivers: [{name: push, joint: rail, rate: 2}]\n" LAG RUN_5
    se3di_live *live = open_model(HEAD DRIVEN);
    CHECK(live && se3di_live_run(live, 0.5, message));
    CHECK_NEAR(get_value(live, "a.position.x"), 1.0, 1e-6);
    set_number(live, "push", -1.0);
    write_model(HEAD SECOND DRIVEN);
    CHECK(se3di_live_read(live, SE3DI_LIVE_GOING_ON, message) && !message[0]);
    CHECK_NEAR(get_value(live, "a.position.x"), 1.0, 1e-6);
    CHECK(se3di_live_run(live, 1.0, message));
    CHECK_NEAR(get_value(live, "a.position.x"), 0.5, 1e-6);
    write_model(HEAD JOINTS "drivers: [{name: other, joint: rail, rate: 2}]\n" LAG RUN_5);
    CHECK(se3di_live_read(live, SE3DI_LIVE_RESET, message));
    CHECK_NEAR(get_value(live, "a.position.x"), 0.0, 1e-9);
    se3di_live_destroy(live);
}

/* @return false: nothing has changed */
static int stays_as_it_was(se3di_live *live, const char *text, se3di_live_beginning beginning)
{
    const uint64_t readings = se3di_live_count_readings(live);
    const double time = se3di_live_get_time(live);
    write_model(text);
    return !se3di_live_read(live, beginning, message) && message[0] &&
           se3di_live_count_readings(live) == readings &&
           fabs(se3di_live_get_time(live) - time) < 1e-15;
}

static void files_that_cannot_be_shown_change_nothing(void)
{
    se3di_live *live = open_model(HEAD JOINTS LAG RUN_5);
    CHECK(live && se3di_live_run(live, 0.5, message));
    CHECK(se3di_live_read(live, SE3DI_LIVE_CHANGED, message));
    CHECK(se3di_live_count_readings(live) == 1); /* it is the same file */
    CHECK(stays_as_it_was(live, "se3d: 1\nbodies: [{name: b, mas: 1}, {name: d, mass: -1}]\n",
                          SE3DI_LIVE_CHANGED));
    CHECK_CONTAINS(message, "mas");
    CHECK_CONTAINS(message, "-1");
    CHECK(strchr(message, '\n') != NULL); /* both mistakes */
    CHECK(stays_as_it_was(live,
                          HEAD JOINTS LAG
                          "forces: [{name: f, type: force, body: a, value: [1/(t-t), 0, 0]}]\n"
                          "analysis: {type: dynamics, duration: 5}\n",
                          SE3DI_LIVE_GOING_ON));
    CHECK(stays_as_it_was(live,
                          HEAD JOINTS
                          "drivers: [{name: d, joint: rail, value: t}, {joint: rail, value: 2}]\n"
                          "analysis: [{type: assembly}, {type: dynamics, duration: 5}]\n",
                          SE3DI_LIVE_ANEW));
    CHECK_CONTAINS(message, "assembly");
    CHECK(stays_as_it_was(live,
                          HEAD JOINTS
                          "forces: [{name: push, type: effort, joint: rail, value: 0}]\n"
                          "fmus: [{name: u, file: unit, step: 1, outputs: [{variable: v, element: "
                          "push}]}]\nanalysis: {type: dynamics, duration: 5}\n",
                          SE3DI_LIVE_ANEW));
    CHECK_CONTAINS(message, "`fmus`");
    CHECK(se3di_live_run(live, 1.0, message));
    CHECK_NEAR(get_value(live, "a.position.x"), 1.0, 1e-9);
    se3di_live_destroy(live);
    CHECK(!open_model("se3d: 1\nbodies: [{name: b, mas: 1}]\n"));
    CHECK_CONTAINS(message, "mas");
}

static void numbers_that_are_none_are_not_set(void)
{
    se3di_live *live = open_model(HEAD JOINTS LAG RUN_5);
    CHECK(live && se3di_live_count_sliders(live) == 1);
    CHECK(!se3di_live_set(live, 1, 2.0) && !se3di_live_set(live, 0, (double)NAN));
    CHECK_NEAR(se3di_live_get_slider(live, 0)->value, 1.0, 0.0);
    CHECK(se3di_live_set(live, 0, 3.0));
    se3di_live_take_back(live);
    CHECK_NEAR(se3di_live_get_slider(live, 0)->value, 1.0, 0.0);
    se3di_live_destroy(live);
}

static void only_what_moves_is_pulled(void)
{
    static const double at[3] = {0.0, 0.0, 0.0}, to[3] = {2.0, 0.0, 0.0},
                        none[3] = {0.0, (double)NAN, 0.0};
    double r[3];
    se3di_live *live = open_model(HEAD SECOND LAG RUN_5);
    CHECK(live && !se3di_live_release(live));
    CHECK(!se3di_live_pull(live, 0, at, to)); /* ground */
    CHECK(!se3di_live_pull(live, 1, at, to)); /* fixed */
    CHECK(!se3di_live_pull(live, 4, at, to)); /* there is none */
    CHECK(!se3di_live_pull(live, 2, none, to) && !se3di_live_pull(live, 2, at, none));
    CHECK(!se3di_live_release(live));
    CHECK(se3di_live_pull(live, 2, at, to) && se3di_live_pull(live, 2, at, to));
    CHECK(se3di_live_pull(live, 3, at, to)); /* this one instead */
    CHECK(se3di_live_run(live, 0.5, message));
    get_place(live, 2, r);
    CHECK_NEAR(r[0], 0.5, 1e-9);
    get_place(live, 3, r);
    CHECK(r[0] > 0.1);
    CHECK(se3di_live_release(live) && !se3di_live_release(live));
    se3di_live_destroy(live);
}

static void a_model_without_motion_stands_still(void)
{
    static const double at[3] = {0.0, 0.0, 0.0};
    double low[3], high[3];
    float places[4];
    se3di_live *live = open_model(HEAD JOINTS "analysis: {type: assembly}\n");
    CHECK(live && !se3di_live_has_motion(live));
    CHECK(!se3di_live_run(live, 1.0, message));
    CHECK_CONTAINS(message, "no analysis in which time passes");
    CHECK(!se3di_live_pull(live, 2, at, at));
    CHECK(se3di_live_count_particles(live) == 0 && !se3di_live_get_particles(live, places));
    CHECK(!se3di_live_get_particle_box(live, low, high) && low[0] > high[0]);
    write_model(HEAD JOINTS LAG RUN_5); /* nothing to go on from */
    CHECK(se3di_live_read(live, SE3DI_LIVE_GOING_ON, message) && se3di_live_has_motion(live));
    se3di_live_destroy(live);
}

static void an_event_and_a_failure_are_told_with_their_time(void)
{
    se3di_live *live = open_model(
        HEAD JOINTS LAG
        "events: [{name: far, channel: a.position.x, value: 0.25, action: stop}]\n" RUN_5);
    CHECK(live && !se3di_live_run(live, 1.0, message));
    CHECK_CONTAINS(message, "stopped it at t = 0.25");
    se3di_live_destroy(live);
    live = open_model(HEAD JOINTS LAG
                      "forces: [{name: f, type: force, body: a, value: [1/(1-t), 0, 0]}]\n" RUN_5);
    CHECK(live && !se3di_live_run(live, 2.0, message));
    CHECK_CONTAINS(message, "it cannot go on at t = ");
    ends = 1; /* whoever looks has gone: no reason to say anything */
    CHECK(se3di_live_run(live, se3di_live_get_time(live), message) || message[0]);
    ends = 0;
    se3di_live_destroy(live);
}

/* Particles of an analysis of the bodies alone follow in short pieces. */
static void particles_follow_what_is_driven(void)
{
    double low[3], high[3];
    float places[4 * 50];
    se3di_live *live = open_model(
        "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1e3}]\ncontact: {}\nbodies:\n"
        "  - {name: lid, mass: 1, inertia: [1, 1, 1], shapes: [{type: plane, material: m}]}\n"
        "joints: [{name: rail, type: prismatic, body_i: ground, body_j: lid, at: [0, 0, 0],\n"
        "  axis: [0, 0, 1]}]\ndrivers: [{name: d, joint: rail, value: 0.1*t}]\n"
        "particles: [{material: m, radius: 0.1, lower: [0, 0, 0.3], upper: [0.5, 0.5, 0.6]}]\n"
        "analysis: {type: kinematics, duration: 1, step: 0.01}\n"
        "output: [{file: r.csv, every: 0.1, channels: [lid.position]}]\n");
    CHECK(live != NULL);
    if (live) {
        const size_t n = se3di_live_count_particles(live);
        CHECK(n > 0 && n <= 50 && se3di_live_get_particle_box(live, low, high));
        CHECK(low[2] >= 0.3 - 1e-9 && high[2] <= 0.6 + 1e-9);
        CHECK(se3di_live_run(live, 0.05, message));
        CHECK_NEAR(get_value(live, "lid.position.z"), 0.005, 1e-9);
        CHECK(se3di_live_get_particles(live, places));
        CHECK_NEAR((double)places[2], 0.4 - 0.5 * 9.80665 * 0.05 * 0.05, 0.02); /* it falls */
    }
    se3di_live_destroy(live);
}

int main(void)
{
    RUN(a_file_with_another_body_goes_on_where_it_is);
    RUN(a_fixed_body_stands_where_the_file_has_it);
    RUN(a_driver_with_a_rate_goes_on_from_its_place);
    RUN(files_that_cannot_be_shown_change_nothing);
    RUN(numbers_that_are_none_are_not_set);
    RUN(only_what_moves_is_pulled);
    RUN(a_model_without_motion_stands_still);
    RUN(an_event_and_a_failure_are_told_with_their_time);
    RUN(particles_follow_what_is_driven);
    scratch_remove(MODEL);
    return check_finish();
}
