/* SPDX-License-Identifier: BSD-3-Clause */
/* Armatures by `convex`: stops, contacts and impacts feel what turns with a coordinate. */
#include "support/text_model.h"

#include <stdio.h>
#include <string.h>

#define STEP 1e-3

static text_model open_at(const char *text, int32_t method, double step)
{
    return text_model_open(text, method, SE3D_FORMULATION_AUTO, step);
}

/* 2 kg on a rail, with a rotor of 6 kg: it falls at a quarter of g, onto a stop that throws it back
 * with half of its speed, and rests m g / k beyond. */
static void what_a_rotor_lets_down_bounces_on_its_stop(void)
{
    static const char *const k[] = {"1.0e+4", "1.0e+6", "1.0e+9"};
    for (size_t e = 0; e < 3; ++e) {
        char text[1024];
        double before = 0.0, after = 0.0, worst = 0.0;
        (void)snprintf(
            text, sizeof text,
            "se3d: 1\nbodies: [{name: b, mass: 2, inertia: [1, 1, 1]}]\n"
            "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: "
            "[0, 0, 1]}]\nforces: [{name: a, type: armature, joint: s, inertia: 6},\n"
            "  {name: f, type: stop, joint: s, lower: -1, restitution: 0.5, k: %s}]\n"
            "analysis: {type: dynamics, duration: 12}\n"
            "output: [{file: r.csv, channels: [s.displacement, s.rate, energy.balance]}]\n",
            k[e]);
        text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
        CHECK(text_model_run(&m, 0.5));
        CHECK_NEAR(text_model_get(&m, 1, 0), -0.5 * 9.81 / 4.0, 1e-9);
        for (int step = 501; step <= 12000; ++step) {
            CHECK(text_model_run(&m, STEP * step));
            const double v = text_model_get(&m, 1, 0);
            before = fmin(before, v);
            after = fmax(after, v);
            worst = fmax(worst, fabs(text_model_get(&m, 2, 0)));
        }
        CHECK_NEAR(-before / sqrt(9.81 / 2.0), 1.0, 0.005);
        CHECK_NEAR(after / -before, e > 0 ? 0.5 : 0.4733, 0.005); /* soft: dop853's */
        CHECK_NEAR((-1.0 - text_model_get(&m, 0, 0)) * atof(k[e]) / (2.0 * 9.81), 1.0, 1e-6);
        CHECK(worst < 1e-3);
        text_model_close(&m);
    }
}

/* A wheel with a rotor drives its cart along a plane: tau r / (J + a + (M + m) r^2). */
static void a_geared_wheel_rolls_its_cart(void)
{
    static const char *const text =
        "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, friction: 0.8}]\n"
        "contact: {}\nbodies: [{name: ground, shapes: [{type: plane, material: m}]},\n"
        "  {name: c, mass: 3, inertia: [0.1, 0.1, 0.1], position: [0, 0, 0.1]},\n"
        "  {name: w, mass: 1, inertia: [0.004, 0.004, 0.004], position: [0, 0, 0.1], shapes: "
        "[{type: sphere, radius: 0.1, material: m}]}]\n"
        "joints: [{name: p, type: planar, body_i: ground, body_j: c, at: [0, 0, 0.1], axis: [0, "
        "1, 0]},\n  {name: o, type: perpendicular, body_i: ground, body_j: c, axis_i: [1, 0, "
        "0], axis_j: [0, 0, 1]},\n  {name: j, type: revolute, body_i: c, body_j: w, at: [0, "
        "0, 0.1], axis: [0, 1, 0]}]\n"
        "forces: [{name: a, type: armature, joint: j, inertia: 0.05}, {name: e, type: effort, "
        "joint: j, value: 1}]\nanalysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [c.velocity, j.rate, energy.balance, a.effort]}]\n";
    const double all = 0.004 + 0.05 + 4.0 * 0.01;
    text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
    const double before = text_model_get(&m, 2, 0);
    CHECK(text_model_run(&m, 1.0));
    CHECK_NEAR(text_model_get(&m, 0, 0), 0.1 / all, 5e-3);
    CHECK_NEAR(text_model_get(&m, 1, 0), 1.0 / all, 5e-2);
    CHECK_NEAR(text_model_get(&m, 2, 0), before, 2e-3); /* of 5.3 J of work */
    CHECK_NEAR(text_model_get(&m, 3, 0), -0.05 / all, 5e-4);
    text_model_close(&m);
}

/* A ball falls onto an arm beside its hinge, at 0.4 m: with the rotor the arm is as heavy there as
 * (J + m l^2 + a) / 0.16. */
static void an_impact_feels_the_rotor(void)
{
    static const char *const text =
        "se3d: 1\ngravity: [0, 0, 0]\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+7, "
        "restitution: 0.6, friction: 0}]\ncontact: {}\n"
        "bodies: [{name: a, mass: 1, inertia: [0.02, 0.02, 0.02], position: [0.25, 0, 0], shapes: "
        "[{type: box, size: [0.5, 0.1, 0.02], material: m}]},\n  {name: b, mass: 0.5, inertia: "
        "[0.001, 0.001, 0.001], position: [0.4, 0, 0.063], velocity: [0, 0, -2], shapes: [{type: "
        "sphere, radius: 0.05, material: m}]}]\njoints: [{name: j, type: revolute, body_i: ground, "
        "body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}]\n"
        "forces: [{name: r, type: armature, joint: j, inertia: 0.3}]\n"
        "analysis: {type: dynamics, duration: 1, tolerance: 1.0e-9}\n"
        "output: [{file: r.csv, channels: [b.velocity, j.rate, energy.total, energy.balance]}]\n";
    const int32_t methods[] = {SE3D_METHOD_CONVEX, SE3D_METHOD_DOP853};
    double seen[2][2];
    for (size_t k = 0; k < 2; ++k) {
        text_model m = open_at(text, methods[k], k ? 0.0 : STEP);
        CHECK(text_model_run(&m, 0.03));
        seen[k][0] = text_model_get(&m, 0, 2);
        seen[k][1] = text_model_get(&m, 1, 0);
        CHECK_NEAR(text_model_get(&m, 3, 0), 1.0, 1e-6);
        /* angular momentum about the hinge */
        const double all = 0.02 + 0.0625 + 0.3;
        CHECK_NEAR(all * seen[k][1] - 0.5 * 0.4 * seen[k][0], 0.5 * 0.4 * 2.0, 1e-3);
        text_model_close(&m);
    }
    CHECK_NEAR(seen[0][0], seen[1][0], 2e-3);
    CHECK_NEAR(seen[0][1], seen[1][1], 2e-3);
}

/* An arm of 1 kg and half a metre, whose rotor of `inertia` makes it heavy, comes down on a plane
 * with its tip: contacts of 40 to 140 steps, of which the two bodies alone would have made impacts
 * of one step. The damper of the law, which is that of the two bodies, is weak there. */
static void what_a_rotor_makes_heavy_stays_as_long_as_by_its_law(void)
{
    static const struct {
        const char *law;
        double inertia, stiffness, off;
    } arms[] = {{"hooke", 2.0, 5e4, 0.015},
                {"hooke", 1000.0, 2e6, 0.01},
                {"hooke", 1000.0, 2e7, 0.02},
                {"hertz_mindlin", 30.0, 3e7, 0.02}};
    for (size_t k = 0; k < sizeof arms / sizeof *arms; ++k) {
        char text[2048];
        (void)snprintf(
            text, sizeof text,
            "se3d: 1\nmaterials: [{name: m, density: 1000, %s: %g, restitution: 0.5, friction: "
            "0.3}]\ncontact: {law: %s, overlap_limit: 0.9}\nbodies: [{name: ground, shapes: "
            "[{type: plane, material: m}]},\n  {name: b, mass: 1, inertia: [0.02, 0.02, 0.001], "
            "position: [0.25, 0, 0.15], velocity: [0, 0, -0.25], angular_velocity: [0, 1, 0], "
            "shapes: [{type: sphere, "
            "radius: 0.05, position: [0.25, 0, 0], material: m}]}]\n"
            "joints: [{name: j, type: revolute, body_i: ground, body_j: b, at: [0, 0, 0.15], axis: "
            "[0, -1, 0]}]\nforces: [{name: a, type: armature, joint: j, inertia: %g}]\n"
            "analysis: {type: dynamics, duration: 1, tolerance: 1.0e-9}\n"
            "output: [{file: r.csv, channels: [j.angle, j.rate, energy.balance]}]\n",
            k == 3 ? "poisson: 0.3, young" : "stiffness", arms[k].stiffness, arms[k].law,
            arms[k].inertia);
        text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
        text_model by_law = open_at(text, SE3D_METHOD_DOP853, 0.0);
        const double all = text_model_get(&m, 2, 0);
        for (int step = 1; step <= 60; ++step) {
            CHECK(text_model_run(&m, 0.01 * step) && text_model_run(&by_law, 0.01 * step));
            CHECK_NEAR(text_model_get(&m, 0, 0), text_model_get(&by_law, 0, 0), 0.2 * arms[k].off);
            CHECK_NEAR(text_model_get(&m, 2, 0), all, 1e-4 * all);
        }
        CHECK(text_model_get(&m, 1, 0) > 0.5); /* it has left */
        CHECK_NEAR(text_model_get(&m, 1, 0), text_model_get(&by_law, 1, 0), arms[k].off);
        text_model_close(&m);
        text_model_close(&by_law);
    }
}

/* A leg of three geared joints with stops, friction and servos stands and squats: by default convex
 * takes over, the same motion as in steps of a quarter. */
static void a_geared_leg_squats_by_default(void)
{
    static const char *const text =
        "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 5.0e+7, friction: 0.9}]\n"
        "contact: {}\nbodies: [{name: ground, shapes: [{type: plane, material: m}]},\n"
        "  {name: t, position: [0, 0, 0.86], shapes: [{type: box, size: [0.2, 0.3, 0.1], material: "
        "m}]},\n  {name: u, position: [0, 0, 0.6], shapes: [{type: capsule, radius: 0.04, length: "
        "0.25, material: m}]},\n  {name: l, position: [0, 0, 0.25], shapes: [{type: capsule, "
        "radius: 0.03, length: 0.25, material: m}]},\n  {name: f, position: [0, 0, 0.03], shapes: "
        "[{type: box, size: [0.25, 0.2, 0.04], material: m}]}]\n"
        "joints: [{name: hip, type: revolute, body_i: t, body_j: u, at: [0, 0, 0.8], axis: [0, 1, "
        "0]},\n  {name: knee, type: revolute, body_i: u, body_j: l, at: [0, 0, 0.43], axis: [0, 1, "
        "0]},\n  {name: ankle, type: revolute, body_i: l, body_j: f, at: [0, 0, 0.06], axis: [0, "
        "1, 0]}]\nforces: [{type: armature, joint: hip, inertia: 0.1}, {type: armature, joint: "
        "knee, inertia: 0.1}, {type: armature, joint: ankle, inertia: 0.02},\n"
        "  {type: friction, joint: knee, limit: 0.2}, {type: stop, joint: knee, lower: 0, k: "
        "1.0e+4},\n  {type: effort, joint: hip, value: \"300*(0.4*cos(3*t)-0.4-q)-10*qdot\"},\n"
        "  {type: effort, joint: knee, value: \"300*(0.8-0.8*cos(3*t)-q)-10*qdot\"},\n"
        "  {type: effort, joint: ankle, value: \"300*(0.4*cos(3*t)-0.4-q)-10*qdot\"}]\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [t.position, knee.angle, contacts.count]}]\n";
    double seen[3][2];
    for (size_t k = 0; k < 3; ++k) {
        const char *method = "";
        text_model m = open_at(text, k < 2 ? SE3D_METHOD_CONVEX : SE3D_METHOD_AUTO,
                               k == 0   ? 0.25 * STEP
                               : k == 1 ? STEP
                                        : 0.0);
        CHECK(text_model_run(&m, 1.0));
        seen[k][0] = text_model_get(&m, 0, 2);
        seen[k][1] = text_model_get(&m, 1, 0);
        CHECK(text_model_get(&m, 2, 0) >= 2.0);
        CHECK(!se3d_solver_get_method(m.solver, &method) && strcmp(method, "convex") == 0);
        CHECK_NEAR(seen[k][0], seen[0][0], 2e-3);
        CHECK_NEAR(seen[k][1], seen[0][1], 5e-3);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(what_a_rotor_lets_down_bounces_on_its_stop);
    RUN(a_geared_wheel_rolls_its_cart);
    RUN(an_impact_feels_the_rotor);
    RUN(what_a_rotor_makes_heavy_stays_as_long_as_by_its_law);
    RUN(a_geared_leg_squats_by_default);
    return check_finish();
}
