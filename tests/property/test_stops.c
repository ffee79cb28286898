/* SPDX-License-Identifier: BSD-3-Clause */
/* Stops in every method: what falls freely meets one in the middle of a long step. */
#include "support/text_model.h"

static const int32_t methods[] = {
    SE3D_METHOD_AUTO, SE3D_METHOD_DOP853, SE3D_METHOD_RK45,  SE3D_METHOD_GENERALIZED_ALPHA,
    SE3D_METHOD_HHT,  SE3D_METHOD_BDF,    SE3D_METHOD_RADAU, SE3D_METHOD_RATTLE,
    SE3D_METHOD_RK4,  SE3D_METHOD_VERLET, SE3D_METHOD_GAUSS,
};

static int has_error_control(int32_t method)
{
    return method == SE3D_METHOD_AUTO || method == SE3D_METHOD_DOP853 ||
           method == SE3D_METHOD_RK45 || method == SE3D_METHOD_RK4 || method == SE3D_METHOD_BDF ||
           method == SE3D_METHOD_RADAU || method == SE3D_METHOD_GAUSS;
}

static int is_newmark(int32_t method)
{
    return method == SE3D_METHOD_GENERALIZED_ALPHA || method == SE3D_METHOD_HHT;
}

/* The law of the stop alone returns e v0; the weight, which acts along, adds 2 g over the time of
 * the contact, about 1 %. Energies stay what they were to the tolerance of the method. */
static void what_falls_onto_a_stop_bounces_as_high_as_the_restitution_says(void)
{
    static const char *const text =
        "se3d: 1\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], position: [0, 0, 1]}]\n"
        "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 1], axis: [0, "
        "0, 1]}]\n"
        "forces: [{name: f, type: stop, joint: s, lower: -1, k: 1.0e+6, restitution: 0.7}]\n"
        "analysis: {type: dynamics, duration: 2.5}\n"
        "output: [{file: r.csv, channels: [s.displacement, s.rate, energy.total, "
        "energy.balance]}]\n";
    for (size_t run = 0; run < 2 * sizeof methods / sizeof methods[0]; ++run) {
        const int32_t method = methods[run / 2];
        const double step = has_error_control(method) ? 0.0 : 1e-4;
        text_model m = text_model_open(text, method, (int32_t)(run % 2), step);
        CHECK(text_model_run(&m, 0.46)); /* it hits at 0.4515 s */
        const double up = text_model_get(&m, 1, 0), v = sqrt(2.0 * 9.81);
        CHECK_NEAR(up / v, 0.7, 0.02);
        const double top = 0.46 + up / 9.81;
        CHECK(text_model_run(&m, top));
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 1e-6);
        CHECK_NEAR(text_model_get(&m, 0, 0), -1.0 + 0.49, 5e-3);
        CHECK_NEAR(text_model_get(&m, 2, 0), 9.81 * 0.49, 5e-2);
        CHECK(text_model_run(&m, 2.5));
        CHECK_NEAR(text_model_get(&m, 3, 0), 9.81, 5e-2);
        text_model_close(&m);
    }
}

#define BLOCK(stop)                                                                                \
    "se3d: 1\ngravity: [0, 0, 0]\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], position: [0, "  \
    "0, 1], velocity: [0, 0, -4]}]\njoints: [{name: s, type: prismatic, body_i: ground, body_j: "  \
    "b, at: [0, 0, 1], axis: [0, 0, 1]}]\nforces:\n  - {name: buffer, type: stop, " stop           \
    ", restitution: 0.5}\n  - {name: f, type: friction, joint: s, limit: 1.0e-6}\n"                \
    "analysis: {type: dynamics, duration: 0.6}\n"                                                  \
    "output: [{file: r.csv, channels: [b.velocity, energy.balance]}]\n"

static const char *const hard_stops[2] = {
    BLOCK("joint: s, lower: -1, k: 1.0e+8"),
    BLOCK("body_i: ground, body_j: b, point_i: [0, 0, -1], lower: 1, k: 1.0e+8"),
};

/* An impact of 0.3 ms in steps of 1 ms, on a joint's coordinate and on a length. */
static void a_hard_stop_returns_what_it_should_at_the_defaults_of_every_method(void)
{
    for (size_t run = 0; run < 4 * sizeof methods / sizeof methods[0]; ++run) {
        const int32_t method = methods[run / 4];
        if (is_newmark(method)) {
            continue;
        }
        text_model m = text_model_open(hard_stops[run % 2], method, (int32_t)(run / 2 % 2), 0.0);
        CHECK(text_model_run(&m, 0.6));
        CHECK_NEAR(text_model_get(&m, 0, 2) / 2.0, 1.0, 1e-3);
        CHECK_NEAR(text_model_get(&m, 1, 0) / 8.0, 1.0, 1e-3);
        text_model_close(&m);
    }
}

/* With an acceleration that is large for its speed: it leaves as with a tight tolerance, which a
 * speed of before the impact would not do. */
static void the_speed_of_an_impact_is_that_where_it_begins(void)
{
    static const char text[] =
        "se3d: 1\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}]\n"
        "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: [0, "
        "0, 1]}]\n"
        "forces:\n  - {type: stop, joint: s, lower: -0.03, k: 2.0e+3, restitution: 0.4}\n"
        "  - {type: tsda, body_i: ground, body_j: b, point_i: [0, 0, -2], k: 300, l0: 1.9}\n"
        "analysis: {type: dynamics, duration: 0.3, tolerance: %g}\n"
        "output: [{file: r.csv, channels: [s.rate]}]\n";
    for (size_t run = 0; run < sizeof methods / sizeof methods[0]; ++run) {
        double rate[2];
        for (int k = 0; k < 2 && (has_error_control(methods[run]) || is_newmark(methods[run]));
             ++k) {
            char full[1000];
            snprintf(full, sizeof full, text, k ? 1e-9 : 1e-6);
            text_model m = text_model_open(full, k ? SE3D_METHOD_DOP853 : methods[run], -1, 0.0);
            CHECK(text_model_run(&m, 0.1));
            rate[k] = text_model_get(&m, 0, 0);
            CHECK(k == 0 || (fabs(rate[1]) > 0.3 && fabs(rate[0] - rate[1]) < 1e-4));
            text_model_close(&m);
        }
    }
}

/* A leg that falls straight, its knee at the end of its range, moves by rounding only; an arm that
 * its weight presses against the end from the first moment goes in by at most twice what it rests
 * at. Both begin with no speed at all. */
static void what_begins_at_rest_at_its_end_is_no_impact(void)
{
    static const char text[] =
        "se3d: 1\nbodies:\n"
        "  - {name: thigh, mass: 4, inertia: [0.1, 0.1, 0.01], position: [0, 0, 1]}\n"
        "  - {name: leg, mass: 3, inertia: [0.1, 0.1, 0.01], position: [0, 0, 0.5]}\n"
        "  - {name: arm, mass: 1, inertia: [0.1, 0.1, 0.1], position: [2.5, 0, 0]}\n"
        "joints:\n"
        "  - {name: fall, type: prismatic, body_i: ground, body_j: thigh, at: [0, 0, 1], axis: [0, "
        "0, 1]}\n"
        "  - {name: knee, type: revolute, body_i: thigh, body_j: leg, at: [0, 0, 0.75], axis: [0, "
        "1, 0]}\n"
        "  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [2, 0, 0], axis: [0, 1, "
        "0]}\n"
        "forces:\n"
        "  - {type: stop, joint: knee, lower: -2, upper: 0, k: 1.0e+4}\n"
        "  - {type: stop, joint: pin, lower: -1, upper: 0, k: 1.0e+4, restitution: 0.5}\n"
        "analysis: {type: dynamics, duration: 0.1}\n"
        "output: [{file: r.csv, channels: [fall.displacement, knee.angle, pin.angle]}]\n";
    for (size_t run = 0; run < 2 * sizeof methods / sizeof methods[0]; ++run) {
        const int32_t method = methods[run / 2];
        const double step = has_error_control(method) || is_newmark(method) ? 0.0 : 5e-4;
        text_model m = text_model_open(text, method, (int32_t)(run % 2), step);
        CHECK(text_model_run(&m, 0.1));
        CHECK_NEAR(text_model_get(&m, 0, 0), -9.81 * 0.1 * 0.1 / 2.0, 1e-5);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 1e-8);
        const double rest = 9.81 * 0.5 / 1e4;
        CHECK_NEAR(text_model_get(&m, 2, 0), rest, 1.01 * rest);
        text_model_close(&m);
    }
}

/* If a step is asked for that the impact does not fit in, that is an error before the impact. */
static void a_step_that_jumps_over_an_impact_is_refused_by_the_name_of_the_stop(void)
{
    for (size_t run = 0; run < sizeof methods / sizeof methods[0]; ++run) {
        const int32_t method = methods[run];
        if (has_error_control(method)) {
            continue;
        }
        text_model m = text_model_open(hard_stops[run % 2], method, 0, 1e-3);
        CHECK(se3d_solver_run(m.solver, 0.6) == SE3D_ERR_STEP_SIZE);
        CHECK_CONTAINS(se3d_system_get_error(m.system), "impact on the stop buffer; try at most 4");
        CHECK_NEAR(text_model_get(&m, 0, 2), -4.0, 1e-4);
        text_model_close(&m);
        m = text_model_open(hard_stops[run % 2], method, 0, 2e-6);
        CHECK(text_model_run(&m, 0.26));
        CHECK_NEAR(text_model_get(&m, 0, 2) / 2.0, 1.0, 1e-3);
        text_model_close(&m);
    }
}

/* The force of a stop has a kink at its beginning and its end, and the result is no better than its
 * estimate; and a step that is rounding away from the stop is not refused for it. */
static void a_stiff_stop_is_met_as_the_tolerance_asks(void)
{
    static const struct {
        int32_t method;
        double tolerance, accuracy; /* 3e-5 at 1e-6 by radau before, no end at 1e-8 by bdf */
    } cases[] = {{SE3D_METHOD_RADAU, 1e-6, 1.2e-5},
                 {SE3D_METHOD_RADAU, 1e-8, 2e-7},
                 {SE3D_METHOD_BDF, 1e-6, 1.2e-5},
                 {SE3D_METHOD_BDF, 1e-8, 2e-7},
                 {SE3D_METHOD_DOP853, 1e-8, 2e-7}};
    for (size_t k = 0; k < 9 * (sizeof cases / sizeof *cases); ++k) {
        static const double limits[3] = {0.0, 1e-6, 0.5};
        char text[1000];
        double v[2] = {0.0, 0.0};
        for (int which = 0; which < 2; ++which) {
            const size_t c = k / 9;
            snprintf(text, sizeof text,
                     "se3d: 1\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], position: [0, 0, "
                     "1]}]\njoints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, "
                     "0, 1], axis: [0, 0, 1]}]\nforces:\n  - {type: stop, joint: s, lower: -1, k: "
                     "%g, restitution: 0.5}\n  - {type: friction, joint: s, limit: %g}\n"
                     "analysis: {type: dynamics, duration: 1, tolerance: %g}\n"
                     "output: [{file: r.csv, channels: [s.rate]}]\n",
                     k % 3 == 0 ? 1e6 : (k % 3 == 1 ? 1e7 : 1e8), limits[k / 3 % 3],
                     which ? cases[c].tolerance : 1e-11);
            text_model m =
                text_model_open(text, which ? cases[c].method : SE3D_METHOD_DOP853, -1, 0.0);
            CHECK(text_model_run(&m, 0.5));
            v[which] = text_model_get(&m, 0, 0);
            text_model_close(&m);
        }
        CHECK_NEAR(v[1], v[0], cases[k / 9].accuracy * 4.43);
    }
}

/* Steps by the caller: a blow of 3 ms in steps of 10 ms, by every method, is no step, and leaves
 * the state as it was; in steps of .5 ms it costs little. The first way is free, at any length. */
static void a_long_step_by_the_caller_into_a_stop_is_refused(void)
{
    static const char *const text =
        "se3d: 1\ngravity: [0, 0, 0]\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], position: "
        "[0, 0, 1], velocity: [0, 0, -1]}]\njoints: [{name: s, type: prismatic, body_i: ground, "
        "body_j: b, at: [0, 0, 1], axis: [0, 0, 1]}]\n"
        "forces: [{name: buffer, type: stop, joint: s, lower: -0.1001, k: 1.0e+6}]\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [energy.total, b.velocity]}]\n";
    for (size_t run = 0; run < 2 * sizeof methods / sizeof methods[0]; ++run) {
        const int32_t method = methods[run / 2];
        text_model m = text_model_open(text, method, (int32_t)(run % 2), 0.0);
        double time, end;
        CHECK(se3d_solver_step(m.solver, 0.09) >= 0);
        CHECK(se3d_solver_step(m.solver, 0.01) >= 0);
        CHECK(!se3d_system_get_time(m.system, &time));
        CHECK(se3d_solver_step(m.solver, 0.01) == SE3D_ERR_STEP_SIZE);
        CHECK_CONTAINS(se3d_system_get_error(m.system), "the impact on the stop buffer");
        CHECK_CONTAINS(se3d_system_get_error(m.system), "or a run that chooses its steps");
        CHECK(!se3d_system_get_time(m.system, &end));
        CHECK_NEAR(end, time, 0.0);
        CHECK_NEAR(text_model_get(&m, 0, 0), 0.5, 1e-9);
        for (int k = 0; k < 20; ++k) {
            CHECK(se3d_solver_step(m.solver, 5e-4) >= 0);
        }
        CHECK_NEAR(text_model_get(&m, 0, 0), 0.5, 0.06);
        CHECK(text_model_get(&m, 1, 2) > 0.9);
        text_model_close(&m);
    }
}

/* Most of its force is damping: an explicit step of a third of the impact would throw the body back
 * several times as fast. What then rests on it needs no short steps, but stable ones. */
static void a_stop_that_gives_little_back_gives_no_energy(void)
{
    static const double restitutions[] = {0.02, 0.1, 0.4, 0.8};
    static const int32_t explicit_methods[] = {SE3D_METHOD_VERLET, SE3D_METHOD_CONVEX,
                                               SE3D_METHOD_RATTLE};
    for (size_t run = 0; run < 12; ++run) {
        const double e = restitutions[run / 3];
        const int32_t method = explicit_methods[run % 3];
        char text[1000];
        snprintf(text, sizeof text,
                 "se3d: 1\ngravity: [0, 0, 0]\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], "
                 "position: [0, 0, 1], velocity: [0, 0, -4]}]\n"
                 "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 1], "
                 "axis: [0, 0, 1]}]\n"
                 "forces: [{name: buffer, type: stop, joint: s, lower: -1, k: 1.0e+6, "
                 "restitution: %g}]\n"
                 "analysis: {type: dynamics, duration: 1}\n"
                 "output: [{file: r.csv, channels: [b.velocity, energy.balance]}]\n",
                 e);
        text_model m = text_model_open(text, method, -1, 0.0);
        CHECK(text_model_run(&m, 0.3));
        CHECK_NEAR(text_model_get(&m, 0, 2), 4.0 * e, 0.1);
        CHECK_NEAR(text_model_get(&m, 1, 0), 8.0, 0.1);
        text_model_close(&m);
        m = text_model_open(text, method, -1, 1e-3); /* the impact takes 3.14 ms */
        if (e < 0.5 && method != SE3D_METHOD_CONVEX) {
            CHECK(se3d_solver_run(m.solver, 0.6) == SE3D_ERR_STEP_SIZE);
            CHECK_CONTAINS(se3d_system_get_error(m.system), "impact on the stop buffer");
        }
        text_model_close(&m);
    }
    for (size_t run = 0; run < 3; ++run) {
        static const char *const text =
            "se3d: 1\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.01]}]\n"
            "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: "
            "[0, 0, 1]}]\n"
            "forces: [{type: stop, joint: s, lower: 0, k: 1.0e+5, restitution: 0.2}]\n"
            "analysis: {type: dynamics, duration: 2}\n"
            "output: [{file: r.csv, channels: [s.displacement, s.rate, energy.balance]}]\n";
        text_model m = text_model_open(text, explicit_methods[run], -1, 0.0);
        CHECK(text_model_run(&m, 2.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), -9.81 / 1e5, 2e-7);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 1e-6);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.0981, 1e-3);
        text_model_close(&m);
    }
}

/* The joint breaks, and what it held flies on past the range that it had. */
static void the_stop_of_a_broken_joint_holds_no_steps(void)
{
    static const char *const text =
        "se3d: 1\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1]}]\n"
        "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: [1, "
        "0, 0], break: {force: 12}}]\n"
        "forces: [{name: f, type: stop, joint: s, upper: 0.5, k: 1.0e+9, restitution: 0.5},\n"
        "  {name: p, type: force, body: b, value: [1, 0, -10*t]}]\n"
        "analysis: {type: dynamics, duration: 3}\n"
        "output: [{file: r.csv, channels: [b.position]}]\n";
    for (size_t k = 0; k < sizeof methods / sizeof methods[0]; ++k) {
        const double step = has_error_control(methods[k]) ? 0.0 : 1e-3;
        text_model m = text_model_open(text, methods[k], -1, step);
        CHECK(text_model_run(&m, 3.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), 4.5, 1e-2);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_hard_stop_returns_what_it_should_at_the_defaults_of_every_method);
    RUN(a_step_that_jumps_over_an_impact_is_refused_by_the_name_of_the_stop);
    RUN(a_long_step_by_the_caller_into_a_stop_is_refused);
    RUN(what_begins_at_rest_at_its_end_is_no_impact);
    RUN(the_speed_of_an_impact_is_that_where_it_begins);
    RUN(what_falls_onto_a_stop_bounces_as_high_as_the_restitution_says);
    RUN(a_stiff_stop_is_met_as_the_tolerance_asks);
    RUN(a_stop_that_gives_little_back_gives_no_energy);
    RUN(the_stop_of_a_broken_joint_holds_no_steps);
    return check_finish();
}
