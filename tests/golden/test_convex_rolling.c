/* SPDX-License-Identifier: BSD-3-Clause */
/* Rolling and torsional friction by `convex`, beside closed forms (docs/theory/contact-laws.md) and
 * dop853. */
#include "support/text_model.h"

#include <stdio.h>
#include <string.h>

#define STEP 1e-3
#define MU   0.05
#define G    9.81
#define R    0.1

#define BALL(material, law, position, motion, gravity)                                             \
    "se3d: 1\ngravity: " gravity "\nmaterials: [{name: m, density: 1000, friction: 0.6, "          \
    "restitution: 0.3, rolling_friction: 0.05, torsional_friction: 0.05, " material                \
    "}]\ncontact: {law: " law "}\nbodies: [{name: ground, shapes: [{type: plane, material: m}]}, " \
    "{name: a, position: " position ", shapes: [{type: sphere, radius: 0.1, material: m}]" motion  \
    "}]\nanalysis: {type: dynamics, duration: 9}\n"                                                \
    "output: [{file: r.csv, channels: [a.position, a.velocity, a.angular_velocity, "               \
    "energy.balance, energy.total]}]\n"

static text_model open_at(const char *text, int32_t method, double step)
{
    return text_model_open(text, method, SE3D_FORMULATION_AUTO, step);
}

/* 5/7 mu_r g brake it, and where it stops it stays. */
static void a_ball_rolls_to_where_it_should_and_stays(void)
{
#define ROLLS ", velocity: [1, 0, 0], angular_velocity: [0, 10, 0]"
    static const char *const texts[] = {
        BALL("stiffness: 1.0e+6", "hooke", "[0, 0, 0.1]", ROLLS, "[0, 0, -9.81]"),
        BALL("young: 1.0e+9, poisson: 0.3", "hertz_mindlin", "[0, 0, 0.1]", ROLLS,
             "[0, 0, -9.81]")};
    const double brake = 5.0 / 7.0 * MU * G;
    for (size_t k = 0; k < 2; ++k) {
        text_model m = open_at(texts[k], SE3D_METHOD_CONVEX, STEP);
        const double first = text_model_get(&m, 3, 0);
        CHECK(text_model_run(&m, 2.0));
        CHECK_NEAR(text_model_get(&m, 1, 0), 1.0 - 2.0 * brake, 2e-3);
        CHECK_NEAR(text_model_get(&m, 2, 1), 10.0 * (1.0 - 2.0 * brake), 2e-2);
        CHECK(text_model_run(&m, 5.0));
        const double stop = text_model_get(&m, 0, 0);
        CHECK_NEAR(stop, 0.5 / brake, 3e-3);
        CHECK_NEAR(text_model_get(&m, 3, 0), first, 1e-9);
        CHECK(text_model_run(&m, 9.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), stop, 1e-10);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 1e-10);
        text_model_close(&m);
    }
}

/* Springs that steps follow, with the ball 1.4 mm deep: as by dop853. */
static void what_is_soft_rolls_by_its_law(void)
{
    static const char *const text =
        BALL("stiffness: 3.0e+4", "hooke", "[0, 0, 0.1]",
             ", velocity: [1, 0, 0], angular_velocity: [0, 10, 5]", "[0, 0, -9.81]");
    text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
    text_model n = open_at(text, SE3D_METHOD_DOP853, 0.0);
    for (int k = 1; k <= 3; ++k) {
        CHECK(text_model_run(&m, k) && text_model_run(&n, k));
        CHECK_NEAR(text_model_get(&m, 0, 0), text_model_get(&n, 0, 0), 2e-3);
        CHECK_NEAR(text_model_get(&m, 1, 0), text_model_get(&n, 1, 0), 1e-3);
        for (size_t part = 1; part < 3; ++part) {
            CHECK_NEAR(text_model_get(&m, 2, part), text_model_get(&n, 2, part), 0.1);
        }
    }
    text_model_close(&m);
    text_model_close(&n);
}

/* mu_t R m g over 2/5 m R^2. */
static void a_ball_that_spins_is_braked(void)
{
    text_model m = open_at(BALL("stiffness: 1.0e+6", "hooke", "[0, 0, 0.1]",
                                ", angular_velocity: [0, 0, 20]", "[0, 0, -9.81]"),
                           SE3D_METHOD_CONVEX, STEP);
    const double brake = 2.5 * MU * G / R;
    CHECK(text_model_run(&m, 1.0));
    CHECK_NEAR(text_model_get(&m, 2, 2), 20.0 - brake, 1e-2);
    CHECK(text_model_run(&m, 3.0));
    CHECK_NEAR(text_model_get(&m, 2, 2), 0.0, 1e-6);
    text_model_close(&m);
}

/* On a slope of 0.04 it stays, on one of 0.08 it rolls as 5/7 g (sin - mu_r cos) says. */
static void a_slope_holds_a_ball_up_to_its_friction(void)
{
    text_model m = open_at(BALL("stiffness: 1.0e+6", "hooke", "[0, 0, 0.1]", "",
                                "[9.81*sin(0.04), 0, -9.81*cos(0.04)]"),
                           SE3D_METHOD_CONVEX, STEP);
    CHECK(text_model_run(&m, 1.0));
    const double held = text_model_get(&m, 0, 0);
    CHECK_NEAR(held, 0.0, 5e-5);
    CHECK(text_model_run(&m, 9.0));
    CHECK_NEAR(text_model_get(&m, 0, 0), held, 1e-10);
    text_model_close(&m);
    m = open_at(BALL("stiffness: 1.0e+6", "hooke", "[0, 0, 0.1]", "",
                     "[9.81*sin(0.08), 0, -9.81*cos(0.08)]"),
                SE3D_METHOD_CONVEX, STEP);
    CHECK(text_model_run(&m, 2.0));
    CHECK_NEAR(text_model_get(&m, 1, 0), 2.0 * 5.0 / 7.0 * G * (sin(0.08) - MU * cos(0.08)), 2e-3);
    text_model_close(&m);
}

/* It falls with a slip and a spin: rolling and torsion have their part in what an impact does. */
static void impacts_take_from_rolling_what_their_law_says(void)
{
    static const char *const text =
        BALL("stiffness: 1.0e+6", "hooke", "[0, 0, 0.5]",
             ", velocity: [1, 0.5, 0], angular_velocity: [3, -8, 20]", "[0, 0, -9.81]");
    text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
    text_model n = open_at(text, SE3D_METHOD_DOP853, 0.0);
    static const double times[] = {0.35, 0.6, 3.0};
    for (size_t k = 0; k < 3; ++k) {
        CHECK(text_model_run(&m, times[k]) && text_model_run(&n, times[k]));
        for (size_t part = 0; part < 2; ++part) {
            CHECK_NEAR(text_model_get(&m, 0, part), text_model_get(&n, 0, part), 0.01);
            CHECK_NEAR(text_model_get(&m, 1, part), text_model_get(&n, 1, part), 0.01);
        }
        double w[2] = {0.0, 0.0};
        for (size_t part = 0; part < 3; ++part) {
            w[0] += text_model_get(&m, 2, part) * text_model_get(&m, 2, part);
            w[1] += text_model_get(&n, 2, part) * text_model_get(&n, 2, part);
        }
        CHECK_NEAR(sqrt(w[0]), sqrt(w[1]), 0.1);
    }
    text_model_close(&m);
    text_model_close(&n);
}

/* A wheel that is driven at the same rate beside its cart: the drive feels mu_r R N. */
static void a_drive_feels_what_its_wheel_rolls_on(void)
{
    static const char *const text =
        "se3d: 1\nmaterials: [{name: m, density: 1000, friction: 0.6, rolling_friction: 0.05, "
        "stiffness: 1.0e+6}]\ncontact: {}\nbodies: [{name: ground, shapes: [{type: plane, "
        "material: m}]},\n  {name: c, mass: 6, inertia: [1, 1, 1], position: [0, 0, 0.1], "
        "velocity: [0.5, 0, 0]},\n  {name: w, mass: 4, inertia: [0.02, 0.02, 0.02], position: [0, "
        "0, 0.1], velocity: [0.5, 0, 0], angular_velocity: [0, 5, 0], shapes: [{type: sphere, "
        "radius: 0.1, material: m}]}]\n"
        "joints: [{name: p, type: planar, body_i: ground, body_j: c, at: [0, 0, 0.1], axis: [0, "
        "1, 0]},\n  {name: o, type: perpendicular, body_i: ground, body_j: c, axis_i: [1, 0, 0], "
        "axis_j: [0, 0, 1]},\n  {name: j, type: revolute, body_i: c, body_j: w, at: [0, 0, 0.1], "
        "axis: [0, 1, 0]}]\ndrivers: [{name: d, joint: j, value: 5*t}]\n"
        "analysis: {type: dynamics, duration: 3}\n"
        "output: [{file: r.csv, channels: [d.effort, c.velocity, energy.balance, "
        "energy.dissipated]}]\n";
    text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
    const double first = text_model_get(&m, 2, 0);
    CHECK(text_model_run(&m, 3.0));
    CHECK_NEAR(text_model_get(&m, 0, 0), MU * R * 10.0 * G, 2e-3);
    CHECK_NEAR(text_model_get(&m, 1, 0), 0.5, 2e-3);
    CHECK_NEAR(text_model_get(&m, 2, 0), first, 2e-3);
    CHECK_NEAR(text_model_get(&m, 3, 0), MU * R * 10.0 * G * 15.0, 0.02);
    text_model_close(&m);
}

/* Twelve balls fall on each other: by default convex takes them, energy only falls, and they lie
 * still in the end, which those that roll without friction do not. */
static void a_heap_of_balls_comes_to_rest_by_default(void)
{
    char text[4096];
    int used = snprintf(text, sizeof text,
                        "se3d: 1\nmaterials: [{name: m, density: 1000, friction: 0.5, restitution: "
                        "0.2, rolling_friction: 0.05, torsional_friction: 0.03, stiffness: "
                        "1.0e+6}]\ncontact: {}\nbodies:\n  - {name: ground, shapes: [{type: plane, "
                        "material: m}]}\n");
    for (int k = 0; k < 12; ++k) {
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "  - {name: b%d, position: [%g, %g, %g], shapes: [{type: sphere, radius: "
                         "0.1, material: m}]}\n",
                         k, 0.21 * (k % 2) + 0.006 * k, 0.21 * (k / 2 % 2) - 0.004 * k,
                         0.15 + 0.21 * (k / 4));
    }
    (void)snprintf(text + used, sizeof text - (size_t)used,
                   "analysis: {type: dynamics, duration: 6}\n"
                   "output: [{file: r.csv, channels: [energy.total, energy.kinetic, "
                   "energy.balance]}]\n");
    text_model m = open_at(text, SE3D_METHOD_AUTO, 0.0);
    const char *method = "";
    double last = text_model_get(&m, 0, 0);
    const double first = text_model_get(&m, 2, 0);
    for (int step = 1; step <= 60; ++step) {
        CHECK(text_model_run(&m, 0.1 * step));
        CHECK(text_model_get(&m, 0, 0) < last + 1e-9);
        last = text_model_get(&m, 0, 0);
    }
    CHECK_NEAR(text_model_get(&m, 2, 0), first, 1e-6);
    CHECK(text_model_get(&m, 1, 0) < 1e-9);
    CHECK(!se3d_solver_get_method(m.solver, &method) && strcmp(method, "convex") == 0);
    text_model_close(&m);
}

int main(void)
{
    RUN(a_ball_rolls_to_where_it_should_and_stays);
    RUN(what_is_soft_rolls_by_its_law);
    RUN(a_ball_that_spins_is_braked);
    RUN(a_slope_holds_a_ball_up_to_its_friction);
    RUN(impacts_take_from_rolling_what_their_law_says);
    RUN(a_drive_feels_what_its_wheel_rolls_on);
    RUN(a_heap_of_balls_comes_to_rest_by_default);
    return check_finish();
}
