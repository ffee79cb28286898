/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction and stops in inverse dynamics: drivers pay for them. */
#include "support/text_model.h"

/* A jack: the nut turns, the ram climbs against 1490.5 N. */
static void a_jack_pays_for_the_friction_of_its_thread(void)
{
    static const char *const text =
        "se3d: 1\nbodies:\n  - {name: nut, mass: 1, inertia: [0.01, 0.01, 0.02]}\n"
        "  - {name: ram, mass: 50, inertia: [1, 1, 1], position: [0, 0, 0.3]}\njoints:\n"
        "  - {name: n, type: revolute, body_i: ground, body_j: nut, at: [0, 0, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: sc, type: screw, body_i: nut, body_j: ram, at: [0, 0, 0], axis: [0, 0, 1], "
        "pitch: 0.01}\n"
        "  - {name: g, type: prismatic, body_i: ground, body_j: ram, at: [0, 0, 0.3], axis: [0, 0, "
        "1]}\n"
        "drivers: [{name: m, joint: n, value: \"-20*t\"}]\nforces:\n"
        "  - {name: f, type: friction, joint: sc, coordinate: angle, limit: 0.3, viscous: 0.01}\n"
        "  - {type: force, body: ram, value: [0, 0, -1000]}\n"
        "analysis: {type: inverse_dynamics, duration: 1, step: 0.01}\n"
        "output: [{file: r.csv, channels: [m.effort, f.force, energy.dissipated, "
        "energy.balance]}]\n";
    for (int32_t formulation = 0; formulation < 2; ++formulation) {
        text_model m = text_model_open(text, -1, formulation, 0.01);
        CHECK(text_model_run(&m, 0.0));
        const double balance = text_model_get(&m, 3, 0);
        for (int k = 0; k <= 10; ++k) {
            CHECK(text_model_run(&m, 0.1 * k));
            CHECK_NEAR(text_model_get(&m, 0, 0), -1490.5 * 0.01 / (2.0 * 3.14159265358979) - 0.5,
                       1e-9);
            CHECK_NEAR(text_model_get(&m, 1, 0), 0.5, 1e-12);
            CHECK_NEAR(text_model_get(&m, 2, 0), 0.5 * 20.0 * 0.1 * k, 1e-9);
            CHECK_NEAR(text_model_get(&m, 3, 0), balance, 1e-9);
        }
        text_model_close(&m);
    }
}

#define SLIDER(driver, friction)                                                                   \
    "se3d: 1\nbodies: [{name: a, mass: 2, inertia: [1, 1, 1]}]\n"                                  \
    "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "  \
    "0]}]\ndrivers: [{name: m, joint: j, value: \"" driver "\"}]\n"                                \
    "forces: [{name: f, type: friction, joint: j, " friction "},\n"                                \
    "  {type: force, body: a, frame: body, value: [0, 0, \"-5*t\"]}]\n"                            \
    "analysis: {type: inverse_dynamics, duration: 3, step: 0.01}\n"                                \
    "output: [{file: r.csv, channels: [m.effort, f.force, j.rate]}]\n"

/* The load rises with time, the direction turns with the motion. What does not move takes none. */
static void friction_follows_direction_and_load(void)
{
    for (int32_t formulation = 0; formulation < 2; ++formulation) {
        text_model m = text_model_open(SLIDER("0.3*sin(4*t)", "mu: 0.2, mu_static: 0.6, limit: 1"),
                                       -1, formulation, 0.01);
        for (int k = 0; k <= 30; ++k) {
            const double t = 0.1 * k, way = cos(4.0 * t) > 0.0 ? 1.0 : -1.0;
            CHECK(text_model_run(&m, t));
            const double n = way * (0.2 * (2.0 * 9.81 + 5.0 * t) + 1.0);
            CHECK_NEAR(text_model_get(&m, 1, 0), n, 1e-10);
            CHECK_NEAR(text_model_get(&m, 0, 0), n - 2.0 * 0.3 * 16.0 * sin(4.0 * t), 1e-10);
        }
        text_model_close(&m);
        m = text_model_open(SLIDER("0.3", "mu: 0.2"), -1, formulation, 0.01);
        CHECK(text_model_run(&m, 1.0));
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 0.0);
        text_model_close(&m);
    }
}

#define FEEDBACK(mu)                                                                               \
    "se3d: 1\ngravity: [0, 0, 0]\nbodies:\n"                                                       \
    "  - {name: block, mass: 1, inertia: [1, 1, 1]}\n"                                             \
    "  - {name: rod, mass: 1, inertia: [0.1, 0.1, 0.1], position: [-0.5, 0, 0.5]}\n"               \
    "  - {name: push, mass: 1, inertia: [1, 1, 1], position: [-1, 0, 1]}\n"                        \
    "joints:\n"                                                                                    \
    "  - {name: x, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, "   \
    "0]}\n"                                                                                        \
    "  - {name: a, type: revolute, body_i: block, body_j: rod, at: [0, 0, 0], axis: [0, 1, 0]}\n"  \
    "  - {name: b, type: spherical, body_i: rod, body_j: push, at: [-1, 0, 1]}\n"                  \
    "  - {name: z, type: prismatic, body_i: ground, body_j: push, at: [-1, 0, 1], axis: [0, 0, "   \
    "1]}\n"                                                                                        \
    "drivers: [{name: m, joint: z, value: \"-0.1*t\"}]\n"                                          \
    "forces: [{name: f, type: friction, joint: x, mu: " mu "},\n"                                  \
    "  {type: force, body: block, value: [-7, 0, 0]}]\n"                                           \
    "analysis: {type: inverse_dynamics, duration: 0.2, step: 0.01}\n"                              \
    "output: [{file: r.csv, channels: [f.force, x.force, x.rate]}]\n"

/* A linkage whose friction feeds its own load, and one that jams. */
static void friction_that_raises_its_own_load_is_iterated_or_refused(void)
{
    static const char *const texts[2] = {FEEDBACK("0.5"), FEEDBACK("1.5")};
    text_model m = text_model_open(texts[0], -1, 0, 0.01);
    CHECK(text_model_run(&m, 0.1));
    CHECK(fabs(text_model_get(&m, 0, 0)) > 3.0);
    CHECK_NEAR(fabs(text_model_get(&m, 0, 0)),
               0.5 * hypot(text_model_get(&m, 1, 1), text_model_get(&m, 1, 2)), 1e-9);
    text_model_close(&m);
    m = text_model_open(texts[1], -1, 0, 0.01);
    CHECK(se3d_solver_run(m.solver, 0.1) == SE3D_ERR_NO_CONVERGENCE);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "friction jams");
    text_model_close(&m);
}

/* Driven into a stop with restitution: the damping is that of the speed before. */
static void a_stop_is_damped_as_the_speed_before_it_says(void)
{
    static const char *const text =
        "se3d: 1\ngravity: [0, 0, 0]\nbodies: [{name: a, mass: 2, inertia: [1, 1, 1]}]\n"
        "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, "
        "0, 0]}]\ndrivers: [{name: m, joint: j, value: \"0.5*t\"}]\n"
        "forces: [{name: f, type: stop, joint: j, upper: 0.1, k: 1000, restitution: 0.5}]\n"
        "analysis: {type: inverse_dynamics, duration: 1, step: 0.01}\n"
        "output: [{file: r.csv, channels: [m.effort]}]\n";
    double d = 1.0;
    for (int k = 0; k < 200; ++k) { /* d (1 + e) = ln((1 + d)/(1 - d e)) by its fixed point */
        d = (1.0 - (1.0 + d) * exp(-1.5 * d)) / 0.5;
    }
    text_model m = text_model_open(text, -1, 0, 0.01);
    CHECK(text_model_run(&m, 0.4));
    CHECK_NEAR(text_model_get(&m, 0, 0), 1000.0 * 0.1 * (1.0 + d), 1e-6);
    text_model_close(&m);
}

int main(void)
{
    RUN(a_jack_pays_for_the_friction_of_its_thread);
    RUN(friction_follows_direction_and_load);
    RUN(friction_that_raises_its_own_load_is_iterated_or_refused);
    RUN(a_stop_is_damped_as_the_speed_before_it_says);
    return check_finish();
}
