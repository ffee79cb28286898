/* SPDX-License-Identifier: BSD-3-Clause */
/* A system that follows a solver is where its own solution is but for terms of second order in what
 * its data differ; so derivatives of states are those of solutions, and derivatives of all kinds of
 * measures of a study those of its runs. docs/theory/sensitivities.md */
#include "support/counting.h"
#include "support/study_slopes.h"
#include "support/text_model.h"

#include "io/study/derive.h"
#include "se3d/study.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>

enum { CHANNELS = 12, PARAMETERS = 8 };
static const char *const names[PARAMETERS] = {"m", "J", "k", "c", "l0", "y", "b", "w"};
static const double at[PARAMETERS] = {2.0, 0.05, 300.0, 20.0, 0.4, 0.15, 0.5, 3.0};

/* A slider-crank out of line with a spring and a damper, whose masses, points, values and
 * prescribed motion are parameters. */
static const char machine[] =
    "se3d: 1\n"
    "parameters: {m: %.17g, J: %.17g, k: %.17g, c: %.17g, l0: %.17g, y: %.17g, b: %.17g, "
    "w: %.17g, a: 0.2}\n"
    "gravity: [0, -9.81, 0]\n"
    "points: {pin: [a*cos(0.4), a*sin(0.4), 0], end: [pin.x + sqrt(b^2 - (pin.y - y)^2), y, 0]}\n"
    "bodies:\n"
    "  - {name: crank, mass: 1, inertia: [1e-3, 1e-2, 1e-2], position: 'mid([0, 0, 0], pin)'}\n"
    "  - {name: rod, mass: m, inertia: [1e-3, J, J], position: 'mid(pin, end)'}\n"
    "  - {name: slider, mass: 3, inertia: [1e-3, 1e-3, 1e-3], position: end}\n"
    "joints:\n"
    "  - {name: O, type: revolute, body_i: ground, body_j: crank, at: [0, 0, 0], axis: [0, 0, 1]}\n"
    "  - {name: B, type: %s, body_i: crank, body_j: rod, at: pin%s}\n"
    "  - {name: C, type: %s, body_i: slider, body_j: rod, at: end%s}\n"
    "  - {name: guide, type: prismatic, body_i: ground, body_j: slider, at: end, axis: [1, 0, 0]}\n"
    "forces: [{name: coil, type: tsda, body_i: ground, body_j: rod, at: [0.6, 0.4, 0.1],\n"
    "  at_2: 'mid(pin, end)', k: k, c: c, l0: l0}]\n"
    "%s\n"
    "output: [{file: a.csv, channels: [slider.position.x, rod.velocity.y, rod.acceleration.x,\n"
    "  coil.force, coil.length, O.torque.z, O.force.x, B.force.y, C.force.x, guide.force.y,\n"
    "  slider.acceleration.x, O.angle]}]\n";

static const char *const tails[] = {
    "drivers: [{name: motor, joint: O, value: 0.1 + w*t + 0.3*sin(5*t)}]\n"
    "analysis: {type: inverse_dynamics, duration: 1, step: 0.02}",
    "drivers: [{name: motor, joint: O, value: 0.1 + w*t + 0.3*sin(5*t)}]\n"
    "analysis: {type: kinematics, duration: 1, step: 0.02}",
    "analysis: {type: equilibrium}",
    "analysis: {type: dynamics, duration: 0.4, method: dop853, tolerance: 1e-12}",
    "drivers: [{name: motor, joint: O, value: 0.1 + w*t}]\n"
    "analysis: {type: inverse_dynamics, duration: 1.5/w, step: 0.1/w}",
    "events: [{name: turn, channel: O.angle, value: -0.05}]\n"
    "analysis: [{type: assembly}, {type: dynamics, duration: 0.4, tolerance: 1e-12}]"};

/* Joints that say each thing once, or redundant ones. */
static void write(char *text, size_t size, const double *p, int tail, int redundant,
                  const char *end)
{
    const char *const axis = ", axis: [0, 0, 1]";
    char full[2000];
    snprintf(full, sizeof full, "%s\n%s", tails[tail], end);
    snprintf(text, size, machine, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7],
             redundant ? "revolute" : "spherical", redundant ? axis : "",
             redundant ? "revolute" : "universal",
             redundant ? axis : ", axis: [0, 0, 1], axis_2: [0, 1, 0]", full);
}

static text_model open_machine(const double *p, int tail, int redundant)
{
    char text[5000];
    write(text, sizeof text, p, tail, redundant, "");
    return text_model_open(text, -1, -1, 0.0);
}

/* How far the system with parameter `which` changed by `share` is from its own solution, at most,
 * and how far that is from the solution that it follows. */
static double follow(int tail, int redundant, int which, double share, double *moved)
{
    double p[PARAMETERS], off = 0.0;
    memcpy(p, at, sizeof p);
    text_model of = open_machine(p, tail, redundant);
    p[which] *= 1.0 + share;
    text_model to = open_machine(p, tail, redundant), own = open_machine(p, tail, redundant);
    const double t = tail == 2 ? 0.0 : 0.3;
    CHECK(text_model_run(&of, t) && text_model_run(&own, t));
    const se3d_status status = se3d_solver_follow(to.solver, of.solver);
    CHECK(status == SE3D_OK);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(to.system));
    }
    *moved = 0.0;
    for (size_t k = 0; k < CHANNELS; ++k) {
        const double x = text_model_get(&own, k, 0);
        const double size = fmax(1.0, fabs(x));
        off = fmax(off, fabs(text_model_get(&to, k, 0) - x) / size);
        *moved = fmax(*moved, fabs(text_model_get(&of, k, 0) - x) / size);
    }
    text_model_close(&of);
    text_model_close(&to);
    text_model_close(&own);
    return off;
}

static void what_is_left_is_of_second_order(void)
{
    for (int k = 0; k < 3 * 2 * PARAMETERS; ++k) {
        const int which = k % PARAMETERS, redundant = k / PARAMETERS % 2;
        const int tail = k / PARAMETERS / 2;
        double moved[2];
        const double first = follow(tail, redundant, which, 1e-3, &moved[0]);
        const double second = follow(tail, redundant, which, 5e-4, &moved[1]);
        if (getenv("SE3D_SHOW")) {
            fprintf(stderr, "%d %d %s: %.2g %.2g of %.2g\n", tail, redundant, names[which], first,
                    second, moved[0]);
        }
        CHECK(first <= 0.1 * moved[0] + 1e-10);
        CHECK(second <= first / 3.5 + 1e-10);
    }
}

static const char study_tail[] =
    "study:\n"
    "  parameters: {m: [2], J: [0.05], k: [300], c: [20], l0: [0.4], y: [0.15], b: [0.5], w: [3]}\n"
    "  every: 0.02\n"
    "  measures:\n"
    "    most: {max: C.force.x}\n"
    "    least: {min: coil.force}\n"
    "    span: {range: slider.position.x}\n"
    "    middle: {mean: guide.force.y}\n"
    "    size: {rms: O.torque.z}\n"
    "    area: {integral: rod.velocity.y}\n"
    "    begin: {initial: B.force.y}\n"
    "    last: {final: rod.acceleration.x}\n"
    "    off: {misfit: coil.length, curve: {linear: [[0, 0.3], [1, 0.5]]}}\n"
    "    mixed: '2*most*last + k*span - m*middle^2'\n";

/* An assembly before, an event within. */
static const char event_tail[] =
    "study:\n"
    "  parameters: {m: [2], J: [0.05], k: [300], c: [20], l0: [0.4], y: [0.15], b: [0.5], w: [3]}\n"
    "  measures: {when: {time_of: turn}, speed: {at: rod.velocity.y, event: turn},\n"
    "    last: {final: coil.force}}\n";

/* Times that depend on a parameter, and works, cannot be followed: runs are taken instead. */
static const char time_tail[] =
    "study:\n"
    "  parameters: {m: [2], J: [0.05], k: [300], c: [20], l0: [0.4], y: [0.15], b: [0.5], w: [3]}\n"
    "  measures: {last: {final: rod.velocity.y}, lost: {final: energy.dissipated},\n"
    "    all: {integral: coil.force}}\n";

static void derivatives_are_those_of_runs(void)
{
    static const int tails_of[] = {0, 2, 3, 5, 4};
    for (int run = 0; run < 5; ++run) {
        const double exact = run < 2 ? 1e-10 : 1e-8; /* of runs with errors */
        char text[6000];
        se3d_model *model = NULL;
        se3d_study *study = NULL;
        se3d_model_error error = {.message = ""};
        write(text, sizeof text, at, tails_of[run], run == 1,
              run < 3   ? study_tail
              : run < 4 ? event_tail
                        : time_tail);
        CHECK(!se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, &error));
        if (error.message[0] != '\0') {
            fprintf(stderr, "%s\n", error.message);
        }
        CHECK(!se3d_study_create(model, &study, &error));
        const size_t count = se3d_study_count_measures(study);
        CHECK(count == (run < 3 ? 10 : 3));
        for (int which = 0; which < PARAMETERS && study; ++which) {
            double value, slopes[10], errors[10], wanted[10], y[10];
            CHECK(!se3d_study_eval_nominal(study, y, NULL));
            CHECK(!se3d_study_eval_sensitivity(study, (size_t)which, &value, slopes, errors, NULL));
            study_slopes(study, at, PARAMETERS, (size_t)which, wanted, count);
            for (size_t k = 0; k < count; ++k) {
                const double size = fabs(wanted[k]) + (1.0 + fabs(y[k])) / value;
                if (getenv("SE3D_SHOW")) {
                    fprintf(stderr, "%s by %s: %.15g %.2g +- %.2g\n",
                            se3d_study_get_measure_name(study, k), names[which], slopes[k],
                            fabs(slopes[k] - wanted[k]) / size, errors[k] / size);
                }
                CHECK_NEAR(slopes[k], wanted[k], exact * size);
                CHECK(errors[k] < 1e-9 * size);
            }
        }
        se3d_study_destroy(study);
        se3d_model_destroy(model);
    }
}

static const char goal_tail[] =
    "study:\n"
    "  every: 0.02\n"
    "  sensitivities: [m, J, k, c, l0, y, b, w]\n"
    "  optimize: {minimize: size, parameters: {m: {from: 1, to: 4}, J: {from: 0.05, to: 0.1},\n"
    "    k: {from: 200, to: 300}, c: {from: 0.1, to: 100}, l0: {from: 0, to: 1}, y: {from: 0.1,\n"
    "    to: 0.2}, b: {from: 0.4, to: 0.6}, w: {from: 1, to: 5}}}\n"
    "  measures:\n"
    "    size: {rms: coil.length}\n"
    "    most: {max: guide.force.y}\n"
    "    last: {final: rod.velocity.y}\n"
    "    off: {misfit: coil.length, curve: {linear: [[0, 0.3], [1, 0.5]]}}\n"
    "    mixed: m*most + k\n";

/* A search has the derivatives of one run, also at bounds (J, k) and for a part of its parameters,
 * and the bits of the measures are those of a run that nobody follows. */
static void searches_have_the_derivatives_of_one_run(void)
{
    enum { MEASURES = 5 };
    for (int run = 0; run < 4; ++run) {
        char text[6000];
        double plain[MEASURES], y[MEASURES], own[PARAMETERS][MEASURES];
        double slopes[PARAMETERS * MEASURES];
        se3d_model_error error;
        se3d_model *model = NULL;
        se3d_study *study = NULL;
        write(text, sizeof text, at, run, run == 1, goal_tail);
        CHECK(!se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, NULL));
        CHECK(!se3d_study_create(model, &study, NULL));
        CHECK(!se3d_study_eval_unknowns(study, at, plain, NULL, NULL));
        CHECK(!se3d_study_eval_unknowns(study, at, y, slopes, NULL));
        CHECK(memcmp(plain, y, sizeof y) == 0);
        for (size_t which = 0; which < PARAMETERS; ++which) {
            double value, wanted[MEASURES];
            const int is_run = run == 3 && (which == 1 || which == 2); /* a motion at a bound */
            const se3di_study_part part = {which, 1};
            CHECK(!se3di_study_eval_part(study, part, at, y, own[which], &error));
            CHECK(memcmp(plain, y, sizeof y) == 0);
            CHECK(memcmp(own[which], slopes + which * MEASURES, sizeof own[which]) == 0);
            CHECK(!se3d_study_eval_sensitivity(study, which, &value, wanted, NULL, NULL));
            for (size_t k = 0; k < MEASURES; ++k) {
                const double size = fabs(wanted[k]) + (1.0 + fabs(y[k])) / value;
                const double off = fabs(own[which][k] - wanted[k]) / size;
                if (getenv("SE3D_SHOW")) {
                    fprintf(stderr, "%d %s by %s: %.12g %.12g %.2g\n", run,
                            se3d_study_get_measure_name(study, k), names[which], own[which][k],
                            wanted[k], off);
                }
                CHECK(off < (is_run ? 1e-4 : run == 3 ? 1e-8 : 2e-9));
            }
        }
        se3d_study_destroy(study);
        se3d_model_destroy(model);
    }
}

/* Another structure, friction, and what is no function of the data alone. */
static void what_cannot_be_followed_is_refused(void)
{
    text_model of = open_machine(at, 0, 0), to = open_machine(at, 0, 0);
    text_model other = open_machine(at, 2, 0), redundant = open_machine(at, 0, 1);
    CHECK(se3d_solver_follow(to.solver, of.solver) == SE3D_ERR_STATE);
    CHECK_CONTAINS(se3d_system_get_error(to.system), "has not come to a solution");
    CHECK(text_model_run(&of, 0.1));
    CHECK(se3d_solver_follow(of.solver, of.solver) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_solver_follow(other.solver, of.solver) == SE3D_ERR_UNSUPPORTED);
    CHECK(se3d_solver_follow(redundant.solver, of.solver) == SE3D_ERR_STATE);
    CHECK_CONTAINS(se3d_system_get_error(redundant.system), "not the same structure");
    CHECK(se3d_solver_follow(to.solver, of.solver) == SE3D_OK);
    CHECK(se3d_solver_follow(to.solver, NULL) == SE3D_ERR_NULL);
    text_model_close(&of);
    CHECK(se3d_solver_follow(NULL, to.solver) == SE3D_ERR_NULL);
    text_model_close(&to);
    text_model_close(&other);
    text_model_close(&redundant);
    text_model late = open_machine(at, 3, 0), early = open_machine(at, 3, 0);
    CHECK(text_model_run(&early, 0.0));
    CHECK(se3d_solver_follow(late.solver, early.solver) == SE3D_OK);
    CHECK(text_model_run(&early, 0.01));
    CHECK(se3d_solver_follow(late.solver, early.solver) == SE3D_OK);
    CHECK(se3d_solver_follow(early.solver, late.solver) == SE3D_ERR_STATE);
    CHECK_CONTAINS(se3d_system_get_error(early.system), "from its beginning on");
    text_model_close(&early);
    CHECK(text_model_run(&late, 0.02)); /* by steps of its own */
    text_model_close(&late);
}

/* Dynamics makes the same steps: so coarse ones have the derivative of what they compute. */
static void steps_of_dynamics_are_repeated(void)
{
    double p[PARAMETERS], x[2][CHANNELS], slopes[2][CHANNELS];
    for (int n = 0; n < 2; ++n) {
        for (int side = 0; side < 2; ++side) {
            const double h = (side ? 1.0 : -1.0) * ldexp(1e-3, -n);
            memcpy(p, at, sizeof p);
            p[0] *= 1.0 + h;
            text_model of = open_machine(at, 3, 0), to = open_machine(p, 3, 0);
            se3d_solver_def def = se3d_solver_def_default();
            def.analysis = SE3D_ANALYSIS_DYNAMICS;
            def.method = SE3D_METHOD_DOP853;
            def.tolerance = 1e-3;
            text_model *const both[2] = {&of, &to};
            for (int k = 0; k < 2; ++k) {
                se3d_solver_destroy(both[k]->solver);
                CHECK(!se3d_solver_create(both[k]->system, &def, &both[k]->solver));
            }
            for (int row = 0; row <= 4; ++row) {
                CHECK(text_model_run(&of, 0.1 * row));
                CHECK(se3d_solver_follow(to.solver, of.solver) == SE3D_OK);
            }
            se3d_solver_stats stats[2];
            for (int k = 0; k < 2; ++k) {
                CHECK(!se3d_solver_get_stats(both[k]->solver, &stats[k]));
            }
            CHECK(stats[0].steps == stats[1].steps && stats[0].steps > 4);
            for (size_t k = 0; k < CHANNELS; ++k) {
                x[side][k] = text_model_get(&to, k, 0);
            }
            text_model_close(&of);
            text_model_close(&to);
        }
        for (size_t k = 0; k < CHANNELS; ++k) {
            slopes[n][k] = (x[1][k] - x[0][k]) / ldexp(2e-3, -n);
        }
    }
    for (size_t k = 0; k < CHANNELS; ++k) { /* what is left is of second order, not noise */
        if (getenv("SE3D_SHOW")) {
            fprintf(stderr, "%zu: %.15g %.15g\n", k, slopes[0][k], slopes[1][k]);
        }
        CHECK_NEAR(slopes[0][k], slopes[1][k], 1e-5 * (1.0 + fabs(slopes[1][k])));
    }
}

typedef struct patience {
    int asked, most;
} patience;

static int lose_patience(void *ctx)
{
    patience *p = ctx;
    return ++p->asked >= p->most;
}

static int count_asked(void *ctx)
{
    ++*(int *)ctx;
    return 0;
}

enum { GOALS = 5 };

/* Processes that share out the parameters make a run each, and no more: what solvers ask is that
 * of one process and of one run for each other process. @return what one process asks, in runs */
static double share_out(se3d_study *study, size_t most)
{
    int asked = 0;
    double y[GOALS], all[PARAMETERS * GOALS], some[PARAMETERS * GOALS];
    se3d_model_error error;
    CHECK(!se3d_study_set_interrupt(study, count_asked, &asked));
    CHECK(!se3d_study_eval_unknowns(study, at, y, NULL, NULL));
    const int run = asked;
    asked = 0;
    CHECK(!se3d_study_eval_unknowns(study, at, y, all, NULL));
    const int whole = asked;
    CHECK(run > 10);
    for (size_t parts = 2; parts <= most; ++parts) {
        asked = 0;
        for (size_t k = 0; k < parts; ++k) {
            const size_t first = k * PARAMETERS / parts;
            const se3di_study_part part = {first, (k + 1) * PARAMETERS / parts - first};
            CHECK(!se3di_study_eval_part(study, part, at, y, some + first * GOALS, &error));
        }
        CHECK(asked == whole + ((int)parts - 1) * run);
        CHECK(memcmp(all, some, sizeof all) == 0);
    }
    return (double)whole / run;
}

/* If the run fails all that was asked for is NaN. */
static void fail_with_nothing(se3d_study *study)
{
    const se3di_study_part part = {1, PARAMETERS - 2};
    double y[GOALS], some[PARAMETERS * GOALS], p[PARAMETERS];
    se3d_model_error error = {.message = ""};
    memcpy(p, at, sizeof p);
    p[6] = 0.01; /* no rod is so short */
    for (int k = 0; k < PARAMETERS * GOALS; ++k) {
        some[k] = 7.0;
    }
    CHECK(se3di_study_eval_part(study, part, p, y, some, &error) < 0);
    CHECK(error.message[0] != '\0' && isnan(y[0]));
    for (int k = 0; k < PARAMETERS * GOALS; ++k) {
        const int is_asked = k < (PARAMETERS - 2) * GOALS;
        CHECK(is_asked ? isnan(some[k]) : !(fabs(some[k] - 7.0) > 0.0));
    }
}

static void a_part_of_the_parameters_takes_one_run(void)
{
    for (int motion = 0; motion < 2; ++motion) {
        char text[6000];
        se3d_model *model = NULL;
        se3d_study *study = NULL;
        write(text, sizeof text, at, motion ? 3 : 0, 0, goal_tail);
        CHECK(!se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, NULL));
        CHECK(!se3d_study_create(model, &study, NULL));
        const double runs = share_out(study, motion ? 2 : PARAMETERS);
        CHECK(motion ? runs > 2.0 : !(fabs(runs - 1.0) > 0.0));
        fail_with_nothing(study);
        se3d_study_destroy(study);
        se3d_model_destroy(model);
    }
}

/* Rows that followers keep, as for a time of settling, go with them. */
static void derivatives_leave_no_memory_behind(void)
{
    char text[6000];
    double y[GOALS], slopes[PARAMETERS * GOALS];
    support_counting counting = {0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    se3d_model_options options = se3d_model_options_default();
    se3d_model *model = NULL;
    se3d_study *study = NULL;
    write(text, sizeof text, at, 0, 0, goal_tail);
    char *off = strstr(text, "    off: ");
    CHECK(off != NULL);
    strcpy(off, "    settled: {settling: coil.length, band: 0.01}\n");
    options.allocator = &allocator;
    CHECK(!se3d_model_read_text(text, strlen(text), "a.yaml", &options, &model, NULL));
    CHECK(!se3d_study_create(model, &study, NULL));
    CHECK(se3d_study_count_measures(study) == 4);
    CHECK(!se3d_study_eval_unknowns(study, at, y, slopes, NULL));
    const size_t bytes = counting.bytes;
    CHECK(bytes > 0);
    for (int k = 0; k < 3; ++k) {
        CHECK(!se3d_study_eval_unknowns(study, at, y, slopes, NULL));
        CHECK(counting.bytes == bytes);
    }
    se3d_study_destroy(study);
    se3d_model_destroy(model);
    CHECK(counting.bytes == 0);
}

/* What follows a run, and what leads there, ends where the user wants it to. */
static void followers_are_interrupted(void)
{
    char text[6000];
    se3d_model *model = NULL;
    se3d_study *study = NULL;
    se3d_model_error error = {.message = ""};
    write(text, sizeof text, at, 5, 0, event_tail);
    CHECK(!se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, &error));
    CHECK(!se3d_study_create(model, &study, &error));
    patience whole = {0, INT_MAX}, once = whole;
    double value, slopes[10];
    CHECK(!se3d_study_set_interrupt(study, lose_patience, &once));
    CHECK(!se3d_study_eval_nominal(study, slopes, NULL));
    CHECK(!se3d_study_set_interrupt(study, lose_patience, &whole));
    CHECK(!se3d_study_eval_sensitivity(study, 0, &value, slopes, NULL, NULL));
    CHECK(once.asked > 10 && whole.asked >= 8 * once.asked);
    for (int most = 1; most <= whole.asked; most += 1 + whole.asked / 40) {
        patience p = {0, most};
        CHECK(!se3d_study_set_interrupt(study, lose_patience, &p));
        CHECK(se3d_study_eval_sensitivity(study, 0, &value, slopes, NULL, &error) ==
              SE3D_ERR_INTERRUPTED);
        CHECK(p.asked == most && error.message[0] != '\0');
    }
    se3d_study_destroy(study);
    se3d_model_destroy(model);
}

static text_model open_parts(const char *joint, const char *force)
{
    char text[1000];
    snprintf(text, sizeof text,
             "se3d: 1\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}]\n"
             "joints: [{name: j, type: %s, body_i: ground, body_j: b, at: [0, 0, 0]%s}]\n"
             "forces: [{name: f, type: %s}]\nanalysis: {type: dynamics, duration: 1}\n",
             joint,
             strcmp(joint, "distance") == 0 ? ", at_2: [1, 0, 0], distance: 1"
                                            : ", axis: [0, 0, 1]",
             force);
    return text_model_open(text, -1, -1, 0.0);
}

/* As many elements of other types. */
static void other_types_are_refused(void)
{
    static const char pull[] = "force, body: b, value: [1, 0, 0]";
    static const char turn[] = "torque, body: b, value: [1, 0, 0]";
    static const char *const other[][2] = {{"point_on_plane", pull}, {"distance", turn}};
    text_model of = open_parts("distance", pull);
    CHECK(text_model_run(&of, 0.0));
    for (int k = 0; k < 2; ++k) {
        text_model to = open_parts(other[k][0], other[k][1]);
        CHECK(se3d_solver_follow(to.solver, of.solver) == SE3D_ERR_STATE);
        CHECK_CONTAINS(se3d_system_get_error(to.system), "not the same structure");
        text_model_close(&to);
    }
    text_model_close(&of);
}

/* A run that was taken back begins anew, with other steps, for those that follow it from there. */
static void a_run_that_begins_anew_is_followed_anew(void)
{
    text_model of = open_machine(at, 3, 0), to = open_machine(at, 3, 0);
    text_model late = open_machine(at, 3, 0), behind = open_machine(at, 3, 0);
    se3d_snapshot *start = NULL;
    CHECK(text_model_run(&of, 0.0) && text_model_run(&to, 0.0));
    CHECK(se3d_solver_follow(to.solver, of.solver) == SE3D_OK);
    CHECK(se3d_solver_follow(behind.solver, of.solver) == SE3D_OK);
    CHECK(!se3d_snapshot_create(of.system, &start));
    CHECK(text_model_run(&of, 0.1) && se3d_solver_follow(to.solver, of.solver) == SE3D_OK);
    CHECK(!se3d_snapshot_restore(start, of.system) && !se3d_system_set_time(of.system, 0.05));
    CHECK(!se3d_snapshot_restore(start, to.system) && !se3d_system_set_time(to.system, 0.05));
    CHECK(!se3d_system_set_time(late.system, 0.05));
    CHECK(text_model_run(&of, 0.2));
    CHECK(se3d_solver_follow(to.solver, of.solver) == SE3D_OK);
    CHECK(se3d_solver_follow(late.solver, of.solver) == SE3D_OK);
    CHECK(se3d_solver_follow(behind.solver, of.solver) == SE3D_ERR_STEP_SIZE);
    se3d_solver_stats stats[2];
    CHECK(!se3d_solver_get_stats(to.solver, &stats[0]));
    CHECK(!se3d_solver_get_stats(of.solver, &stats[1]));
    CHECK(stats[0].steps == stats[1].steps);
    for (size_t k = 0; k < CHANNELS; ++k) { /* but for rounding of the steps */
        const double x = text_model_get(&of, k, 0);
        CHECK_NEAR(text_model_get(&to, k, 0), x, 1e-12 * (1.0 + fabs(x)));
        CHECK_NEAR(text_model_get(&late, k, 0), x, 1e-12 * (1.0 + fabs(x)));
    }
    se3d_snapshot_destroy(start);
    text_model_close(&of);
    text_model_close(&to);
    text_model_close(&late);
    text_model_close(&behind);
}

int main(void)
{
    RUN(other_types_are_refused);
    RUN(a_run_that_begins_anew_is_followed_anew);
    RUN(a_part_of_the_parameters_takes_one_run);
    RUN(derivatives_leave_no_memory_behind);
    RUN(followers_are_interrupted);
    RUN(derivatives_are_those_of_runs);
    RUN(searches_have_the_derivatives_of_one_run);
    RUN(steps_of_dynamics_are_repeated);
    RUN(what_cannot_be_followed_is_refused);
    RUN(what_is_left_is_of_second_order);
    return check_finish();
}
