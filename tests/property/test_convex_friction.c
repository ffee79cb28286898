/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction in joints by `convex`, beside closed forms and dop853 at a tight tolerance. */
#include "support/text_model.h"

#include <stdio.h>

#define STEP 1e-3

static text_model open_at(const char *text, int32_t method, double step)
{
    return text_model_open(text, method, SE3D_FORMULATION_AUTO, step);
}

#define SLIDE(velocity, friction, more)                                                            \
    "se3d: 1\nbodies: [{name: a, mass: 2, inertia: [1, 1, 1], velocity: [" velocity ", 0, 0]}]\n"  \
    "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "  \
    "0]}]\nforces:\n  - {name: f, type: friction, joint: j, " friction "}\n" more                  \
    "analysis: {type: dynamics, duration: 20, tolerance: 1.0e-10}\n"                               \
    "output: [{file: r.csv, channels: [j.displacement, j.rate, f.force, energy.balance, "          \
    "energy.dissipated]}]\n"

/* It stops after v^2 / (2 mu g), gives all its energy to friction, and then does not creep. */
static void a_block_stops_where_it_should_and_stays(void)
{
    static const char *const texts[] = {
        SLIDE("1", "mu: 0.5", ""), SLIDE("1", "limit: 0.5*2*9.81", ""),
        SLIDE("1", "mu: 0.2, limit: 0.3*2*9.81, mu_static: 0.7, presliding: 1.0e-12", "")};
    for (size_t k = 0; k < 3; ++k) {
        text_model m = open_at(texts[k], SE3D_METHOD_CONVEX, STEP);
        CHECK(text_model_run(&m, 0.1));
        CHECK_NEAR(text_model_get(&m, 2, 0), 9.81, 1e-9);
        CHECK(text_model_run(&m, 0.5));
        const double stop = text_model_get(&m, 0, 0);
        CHECK_NEAR(stop, 0.5 / (0.5 * 9.81), 1e-6);
        CHECK_NEAR(text_model_get(&m, 3, 0), 1.0, 1e-12);
        CHECK_NEAR(text_model_get(&m, 4, 0), 1.0, 1e-7);
        CHECK(text_model_run(&m, 20.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), stop, 1e-13);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.0, 1e-3);
        text_model_close(&m);
    }
}

/* A load that swings below the limit moves it by the presliding; one that rises passes mu_static,
 * and from then on only mu brakes. */
static void a_block_sticks_until_the_static_limit(void)
{
    static const char *const swings =
        SLIDE("0", "mu: 0.5", "  - {type: force, body: a, value: [\"9.5*sin(50*t)\", 0, 0]}\n");
    static const char *const rises = SLIDE("0", "mu: 0.25, mu_static: 0.5",
                                           "  - {type: force, body: a, value: [9.81*t, 0, 0]}\n");
    text_model m = open_at(swings, SE3D_METHOD_CONVEX, STEP);
    CHECK(text_model_run(&m, 2.0));
    CHECK_NEAR(text_model_get(&m, 0, 0), 0.0, 1e-9);
    CHECK_NEAR(text_model_get(&m, 2, 0), 9.5 * sin(50.0 * (2.0 - STEP)), 0.1); /* a step ago */
    text_model_close(&m);
    m = open_at(rises, SE3D_METHOD_CONVEX, STEP);
    CHECK(text_model_run(&m, 0.99));
    CHECK_NEAR(text_model_get(&m, 0, 0), 0.0, 1e-9);
    CHECK(text_model_run(&m, 2.0)); /* a = 9.81 (t - 0.5)/2 from t = 1 */
    CHECK_NEAR(text_model_get(&m, 0, 0), 9.81 * (0.125 + 1.0 / 12.0), 1e-2);
    CHECK_NEAR(text_model_get(&m, 1, 0), 9.81 * 0.5, 1e-2);
    CHECK_NEAR(text_model_get(&m, 2, 0), 0.25 * 2.0 * 9.81, 1e-9);
    text_model_close(&m);
}

/* On a slope it holds m g sin with the stretch of its spring, and goes no further; a presliding
 * that is long beside the step swings as the law's spring does. */
static void what_sticks_has_the_spring_of_the_law(void)
{
    static const char *const held =
        SLIDE("0", "limit: 20", "  - {type: force, body: a, value: [8, 0, 0]}\n");
    static const char *const elastic =
        SLIDE("0", "limit: 20, presliding: 0.01", "  - {type: force, body: a, value: [8, 0, 0]}\n");
    text_model m = open_at(held, SE3D_METHOD_CONVEX, STEP);
    CHECK(text_model_run(&m, 0.01));
    const double place = text_model_get(&m, 0, 0);
    CHECK(fabs(place) < 1e-9);
    CHECK_NEAR(text_model_get(&m, 2, 0), 8.0, 1e-6);
    CHECK(text_model_run(&m, 20.0));
    CHECK_NEAR(text_model_get(&m, 0, 0), place, 1e-13);
    text_model_close(&m);
    m = open_at(elastic, SE3D_METHOD_CONVEX, STEP);
    text_model n = open_at(elastic, SE3D_METHOD_DOP853, 0.0);
    CHECK(text_model_run(&m, 1.0) && text_model_run(&n, 1.0));
    CHECK_NEAR(text_model_get(&m, 0, 0), text_model_get(&n, 0, 0), 1e-4);
    text_model_close(&m);
    text_model_close(&n);
}

#define PENDULUM(friction)                                                                         \
    "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}]\n"     \
    "joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, -1, "  \
    "0]}]\nforces: [{name: f, type: friction, joint: j, " friction "}]\n"                          \
    "analysis: {type: dynamics, duration: 15, tolerance: 1.0e-10}\n"                               \
    "output: [{file: r.csv, channels: [j.angle, f.force, energy.dissipated, energy.balance]}]\n"

/* Bodies m and n, at the end of both runs: channels 0 to `count` - 1 within `off`. */
static void compare(const text_model *m, const text_model *n, size_t count, double off)
{
    for (size_t k = 0; k < count; ++k) {
        CHECK_NEAR(text_model_get(m, k, 0), text_model_get(n, k, 0), off);
    }
}

static void a_pendulum_comes_to_rest_where_it_does_by_dop853(void)
{
    static const char *const texts[] = {
        PENDULUM("mu: 0.3, radius: 0.1"), PENDULUM("limit: 0.2"),
        PENDULUM("mu: 0.1, mu_static: 0.2, radius: 0.1, limit: 0.1, viscous: 0.05")};
    for (size_t k = 0; k < 3; ++k) {
        text_model m = open_at(texts[k], SE3D_METHOD_CONVEX, STEP);
        text_model n = open_at(texts[k], SE3D_METHOD_DOP853, 0.0);
        CHECK(text_model_run(&m, 15.0) && text_model_run(&n, 15.0));
        compare(&m, &n, 4, 1.2e-4);
        text_model_close(&m);
        text_model_close(&n);
    }
}

/* What is much more viscous than a step follows stops at once, and does not swing. */
static void a_viscous_joint_is_stable(void)
{
    text_model m = open_at(SLIDE("1", "limit: 0.1, viscous: 1.0e+5", ""), SE3D_METHOD_CONVEX, STEP);
    for (int step = 1; step <= 10; ++step) {
        CHECK(text_model_run(&m, STEP * step));
        CHECK(text_model_get(&m, 0, 0) > 0.0 && text_model_get(&m, 0, 0) < STEP);
        CHECK(fabs(text_model_get(&m, 1, 0)) < 0.05);
    }
    CHECK_NEAR(text_model_get(&m, 4, 0), 1.0, 1e-6);
    text_model_close(&m);
}

/* A slide meets its stop at 1.68 m/s, comes back with half of that and stops before it. */
static void a_stop_and_friction_act_together(void)
{
    static const char *const text =
        SLIDE("2", "mu: 0.3",
              "  - {name: s, type: stop, joint: j, upper: 0.2, k: 1.0e+6, restitution: "
              "0.5}\n");
    const double g = 0.3 * 9.81;
    for (int k = 0; k < 3; ++k) {
        text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP * (1 << k));
        CHECK(text_model_run(&m, 2.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), 0.2 - 0.25 * (4.0 - 0.4 * g) / (2.0 * g), 2e-4);
        CHECK_NEAR(text_model_get(&m, 3, 0), 4.0, 1e-9);
        CHECK_NEAR(text_model_get(&m, 4, 0), 4.0, 1e-6);
        text_model_close(&m);
    }
}

/* A slider that a crank drives, whose rod presses it on its rail. */
static void a_driven_slider_is_braked_by_what_presses_it(void)
{
    static const char *const text =
        "se3d: 1\nbodies: [{name: c, mass: 1, inertia: [0.01, 0.01, 0.01], position: [0.05, 0, "
        "0]},\n {name: r, mass: 1, inertia: [0.01, 0.02, 0.02], position: [0.25, 0, 0]},\n"
        " {name: s, mass: 2, inertia: [0.1, 0.1, 0.1], position: [0.4, 0, 0]}]\n"
        "joints: [{name: j, type: revolute, body_i: ground, body_j: c, at: [0, 0, 0], axis: [0, "
        "-1, 0]},\n {name: k, type: revolute, body_i: c, body_j: r, at: [0.1, 0, 0], axis: [0, -1, "
        "0]},\n {name: l, type: revolute, body_i: r, body_j: s, at: [0.4, 0, 0], axis: [0, -1, "
        "0]},\n {name: p, type: prismatic, body_i: ground, body_j: s, at: [0.4, 0, 0], axis: [1, "
        "0, 0]}]\ndrivers: [{name: d, joint: j, value: 5*t}]\n"
        "forces: [{name: f, type: friction, joint: p, mu: 0.3}, {name: g, type: friction, joint: "
        "l, mu: 0.2, radius: 0.02}]\nanalysis: {type: dynamics, duration: 3, tolerance: 1.0e-8}\n"
        "output: [{file: r.csv, channels: [d.effort, f.force, g.force, energy.dissipated, "
        "work.drivers]}]\n";
    text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
    text_model n = open_at(text, SE3D_METHOD_DOP853, 0.0);
    CHECK(text_model_run(&m, 3.0) && text_model_run(&n, 3.0));
    compare(&m, &n, 3, 1e-4);
    CHECK_NEAR(text_model_get(&m, 3, 0) / text_model_get(&n, 3, 0), 1.0, 2e-4);
    CHECK_NEAR(text_model_get(&m, 4, 0) / text_model_get(&n, 4, 0), 1.0, 2e-3);
    text_model_close(&m);
    text_model_close(&n);
}

#define FEEDBACK(mu, way, value)                                                                   \
    "se3d: 1\nbodies:\n  - {name: block, mass: 1, inertia: [1, 1, 1]}\n"                           \
    "  - {name: rod, mass: 1, inertia: [0.1, 0.1, 0.1], position: [-0.5, 0, 0.5]}\n"               \
    "  - {name: push, mass: 1, inertia: [1, 1, 1], position: [-1, 0, 1]}\njoints:\n"               \
    "  - {name: x, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, "   \
    "0]}\n"                                                                                        \
    "  - {name: a, type: revolute, body_i: block, body_j: rod, at: [0, 0, 0], axis: [0, 1, 0]}\n"  \
    "  - {name: b, type: spherical, body_i: rod, body_j: push, at: [-1, 0, 1]}\n"                  \
    "  - {name: z, type: prismatic, body_i: ground, body_j: push, at: [-1, 0, 1], axis: [0, 0, "   \
    "1]}\n"                                                                                        \
    "drivers: [{name: m, joint: z, value: \"" way "\"}]\n"                                         \
    "forces: [{name: f, type: friction, joint: x, mu: " mu "},\n"                                  \
    "  {type: force, body: block, value: [" value ", 0, 0]}]\n"                                    \
    "analysis: {type: dynamics, duration: 3, tolerance: 1.0e-8}\n"                                 \
    "output: [{file: r.csv, channels: [f.force, m.effort]}]\n"

/* Friction that a rod at 45 degrees makes more by itself, or less, by nearly as much; and what is
 * driven where it would be more without end. */
static void friction_that_changes_its_own_load_is_found(void)
{
    static const char *const texts[] = {FEEDBACK("0.95", "-0.1*t", "-7"),
                                        FEEDBACK("0.95", "0.1*t", "-7"),
                                        FEEDBACK("0.7", "-0.2*sin(3*t)", "-7")};
    for (size_t k = 0; k < 2; ++k) {
        text_model m = open_at(texts[k], SE3D_METHOD_CONVEX, STEP);
        text_model n = open_at(texts[k], SE3D_METHOD_DOP853, 0.0);
        CHECK(text_model_run(&m, 3.0) && text_model_run(&n, 3.0));
        CHECK(fabs(text_model_get(&n, 0, 0)) > 9.0);
        CHECK_NEAR(text_model_get(&m, 0, 0) / text_model_get(&n, 0, 0), 1.0, 5e-4);
        CHECK_NEAR(text_model_get(&m, 1, 0) / text_model_get(&n, 1, 0), 1.0, 5e-4);
        text_model_close(&m);
        text_model_close(&n);
    }
    text_model m = open_at(texts[2], SE3D_METHOD_CONVEX, STEP);
    double t;
    CHECK(se3d_solver_run(m.solver, 3.0) == SE3D_ERR_NO_CONVERGENCE);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "friction jams");
    CHECK(!se3d_system_get_time(m.system, &t));
    CHECK_NEAR(t, 0.5235987755982989 * 3.0, 1e-3); /* where it turns */
    text_model_close(&m);
}

#define MATERIAL                                                                                   \
    "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, restitution: 0.2, "          \
    "friction: "                                                                                   \
    "0.4}]\ncontact: {}\n"

/* A door on two hinges, one of which is redundant, with three elements on one freedom; a ball lies
 * on the floor meanwhile, so that all steps are those of contacts. */
static void elements_on_one_freedom_share_it(void)
{
    static const char *const text = MATERIAL
        "bodies: [{name: ground, shapes: [{type: plane, material: m}]}, {name: a, mass: 5, "
        "inertia: "
        "[0.4, 0.4, 0.4], position: [0, 0.4, 1]},\n {name: b, position: [0, 0, 0.1], shapes: "
        "[{type: sphere, radius: 0.1, material: m}], velocity: [0.5, 0, 0]}]\n"
        "joints: [{name: h1, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0.5], axis: [0, "
        "0, 1]}, {name: h2, type: revolute, body_i: ground, body_j: a, at: [0, 0, 1.5], axis: [0, "
        "0, 1]}]\nforces: [{name: f1, type: friction, joint: h1, mu: 0.2, radius: 0.02, "
        "thrust_radius: 0.02}, {name: f2, type: friction, joint: h2, mu: 0.1, radius: 0.02}, "
        "{name: f3, type: friction, joint: h2, limit: 0.3},\n {name: e, type: effort, joint: h1, "
        "value: \"2*sin(3*t)\"}]\nanalysis: {type: dynamics, duration: 3, tolerance: 1.0e-7}\n"
        "output: [{file: r.csv, channels: [h1.angle, h1.rate, f1.force, f2.force, f3.force, "
        "energy.balance]}]\n";
    text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
    text_model n = open_at(text, SE3D_METHOD_DOP853, 0.0);
    CHECK(text_model_run(&m, 3.0) && text_model_run(&n, 3.0));
    compare(&m, &n, 6, 3e-3);
    text_model_close(&m);
    text_model_close(&n);
}

/* What turns fast presses its bearing by that, also in steps of contacts, whose velocities begin on
 * the constraints and end half a step behind them. */
static void what_spins_presses_its_bearing(void)
{
    static const char *const text = MATERIAL
        "gravity: [0, 0, -9.81]\nbodies: [{name: ground, shapes: [{type: plane, position: [0, 0, "
        "-2], material: m}]}, {name: b, position: [3, 0, -1.9], shapes: [{type: sphere, radius: "
        "0.1, material: m}]}, {name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0.5, 0], "
        "velocity: [-5, 0, 0], angular_velocity: [0, 0, 10]}]\n"
        "joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, "
        "1]}]\nforces: [{name: f, type: friction, joint: j, mu: 0.2, radius: 0.05}]\n"
        "analysis: {type: dynamics, duration: 2, tolerance: 1.0e-9}\n"
        "output: [{file: r.csv, channels: [j.angle, j.rate, energy.dissipated]}]\n";
    for (int k = 0; k < 2; ++k) {
        text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP / (1 << k));
        text_model n = open_at(text, SE3D_METHOD_DOP853, 0.0);
        CHECK(text_model_run(&m, 2.0) && text_model_run(&n, 2.0));
        for (size_t c = 0; c < 3; ++c) {
            CHECK_NEAR(text_model_get(&m, c, 0) / text_model_get(&n, c, 0), 1.0, 1e-3 / (1 << k));
        }
        text_model_close(&m);
        text_model_close(&n);
    }
}

/* A ball lands on a cart, in a contact that both follow: what presses on the rail brakes it. */
static void what_lands_on_a_cart_loads_its_rail(void)
{
    static const char *const text =
        "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+4, restitution: 0.2, "
        "friction: 0.4}]\ncontact: {}\n"
        "bodies: [{name: c, mass: 2, inertia: [0.1, 0.1, 0.1], velocity: [1, 0, 0], shapes: "
        "[{type: box, size: [2, 1, 0.2], material: m}]},\n {name: b, position: [0, 0, 0.22], "
        "velocity: [1, 0, 0], shapes: [{type: sphere, radius: 0.1, material: m}]}]\n"
        "joints: [{name: p, type: prismatic, body_i: ground, body_j: c, at: [0, 0, 0], axis: [1, "
        "0, 0]}]\nforces: [{name: f, type: friction, joint: p, mu: 0.1}]\n"
        "analysis: {type: dynamics, duration: 2, tolerance: 1.0e-7}\n"
        "output: [{file: r.csv, channels: [p.displacement, energy.dissipated, energy.balance, "
        "energy.total]}]\n";
    text_model m = open_at(text, SE3D_METHOD_CONVEX, STEP);
    text_model n = open_at(text, SE3D_METHOD_DOP853, 0.0);
    CHECK(text_model_run(&m, 1.0) && text_model_run(&n, 1.0));
    CHECK_NEAR(text_model_get(&m, 0, 0) / text_model_get(&n, 0, 0), 1.0, 0.01);
    CHECK_NEAR(text_model_get(&m, 1, 0) / text_model_get(&n, 1, 0), 1.0, 0.01);
    CHECK_NEAR(text_model_get(&m, 2, 0), text_model_get(&n, 2, 0), 1e-3);
    text_model_close(&m);
    text_model_close(&n);
}

/* Three parts with ranges and friction fall on a plane: by default convex takes over, energy does
 * not grow, and they come to rest in a pose that friction holds. */
static void a_figure_with_stiff_joints_falls_down_by_default(void)
{
    static const char *const text = MATERIAL
        "bodies: [{name: ground, shapes: [{type: plane, material: m}]},\n"
        "  {name: a, position: [0, 0, 1.2], angular_velocity: [0.4, 0.9, 0], shapes: [{type: "
        "capsule, radius: 0.1, length: 0.3, material: m}]},\n  {name: b, position: [0, 0, 0.75], "
        "shapes: [{type: capsule, radius: 0.07, length: 0.3, material: m}]},\n"
        "  {name: c, position: [0, 0, 0.35], shapes: [{type: capsule, radius: 0.05, length: 0.3, "
        "material: m}]},\n  {name: d, position: [0, 0, 1.55], shapes: [{type: sphere, radius: "
        "0.09, material: m}]}]\njoints: [{name: hip, type: revolute, body_i: a, body_j: b, at: [0, "
        "0, 0.95], axis: [0, 1, 0]},\n  {name: knee, type: revolute, body_i: b, body_j: c, at: [0, "
        "0, 0.55], axis: [0, 1, 0]},\n  {name: neck, type: revolute, body_i: a, body_j: d, at: [0, "
        "0, 1.45], axis: [1, 0, 0]}]\nforces: [{name: hs, type: stop, joint: hip, lower: -0.9, "
        "upper: 0.2, k: 1.0e+5, restitution: 0.1},\n  {name: hf, type: friction, joint: hip, "
        "limit: "
        "2, mu: 0.3, radius: 0.03},\n  {name: kf, type: friction, joint: knee, limit: 1, viscous: "
        "0.1},\n  {name: nf, type: friction, joint: neck, mu: 0.3, radius: 0.03}]\n"
        "analysis: {type: dynamics, duration: 6}\n"
        "output: [{file: r.csv, channels: [energy.total, energy.balance, hip.rate, knee.rate, "
        "contacts.count]}]\n";
    const int32_t methods[] = {SE3D_METHOD_CONVEX, SE3D_METHOD_AUTO};
    for (size_t k = 0; k < 2; ++k) {
        text_model m = open_at(text, methods[k], k ? 0.0 : STEP);
        const char *method = "";
        double last = HUGE_VAL, most = 0.0;
        for (int step = 1; step <= 600; ++step) {
            CHECK(text_model_run(&m, 0.01 * step));
            most = fmax(most, text_model_get(&m, 0, 0) - last);
            last = text_model_get(&m, 0, 0);
        }
        CHECK(most < 0.02); /* of 261 J */
        CHECK_NEAR(text_model_get(&m, 1, 0), 261.165, 1.5);
        CHECK(last < 60.0);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.0, 1e-3);
        CHECK_NEAR(text_model_get(&m, 3, 0), 0.0, 1e-3);
        CHECK(text_model_get(&m, 4, 0) >= 2.0);
        CHECK(!se3d_solver_get_method(m.solver, &method) && strcmp(method, "convex") == 0);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_block_stops_where_it_should_and_stays);
    RUN(a_block_sticks_until_the_static_limit);
    RUN(what_sticks_has_the_spring_of_the_law);
    RUN(a_pendulum_comes_to_rest_where_it_does_by_dop853);
    RUN(a_viscous_joint_is_stable);
    RUN(a_stop_and_friction_act_together);
    RUN(a_driven_slider_is_braked_by_what_presses_it);
    RUN(friction_that_changes_its_own_load_is_found);
    RUN(elements_on_one_freedom_share_it);
    RUN(what_spins_presses_its_bearing);
    RUN(what_lands_on_a_cart_loads_its_rail);
    RUN(a_figure_with_stiff_joints_falls_down_by_default);
    return check_finish();
}
