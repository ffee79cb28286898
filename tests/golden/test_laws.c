/* SPDX-License-Identifier: BSD-3-Clause */
/* Laws of channels: elements that depend on what other elements measure, against closed forms and
 * against elements that say the same by themselves. */
#include <math.h>

#include "support/text_model.h"

#define HEAD                                                                                       \
    "se3d: 1\ngravity: [0, 0, 0]\nparameters: {k: 40, c: 3}\nbodies:\n"                            \
    "  - {name: arm, mass: 1, inertia: [1, 1, 2], position: [0, 0, 0], angular_velocity: [0, 0, "  \
    "1]}\n  - {name: cart, mass: 2, inertia: [1, 1, 1], position: [1, 0, 0], velocity: [0.5, 0, "  \
    "0], markers: [{name: tip, position: [0, 0.5, 0]}]}\njoints:\n"                                \
    "  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, 0, "    \
    "1]}\n  - {name: rail, type: prismatic, body_i: ground, body_j: cart, at: [1, 0, 0], axis: "   \
    "[1, 0, 0]}\n"
#define TAIL "analysis: {type: dynamics, duration: 2, tolerance: 1e-11}\n"
#define OUT  "output: [{file: r.csv, channels: [pin.angle, rail.displacement]}]\n"

/* An arm with the inertia 2 and a torque -8 (angle) from elsewhere: cos(2 t). */
static void a_torque_of_an_angle_is_a_spring(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_RADAU,
                                      SE3D_METHOD_BDF};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        for (int32_t f = 0; f < 2; ++f) {
            text_model m =
                text_model_open(HEAD "forces: [{name: u, type: torque, body: arm, value: [0, 0, "
                                     "\"-8*pin.angle - 0*arm.angular_velocity.z\"]}]\n" TAIL OUT,
                                methods[k], f, 0.0);
            text_model_run(&m, 1.3);
            CHECK_NEAR(text_model_get(&m, 0, 0), 0.5 * sin(2.6), 3e-9);
            text_model_close(&m);
        }
    }
}

/* Two bodies that know of each other by channels only: a spring and damper written as two laws,
 * whose Jacobian has blocks between bodies that no element joins. With x = angle - displacement,
 * 2 theta'' = -(k x + c x'), 2 s'' = k x + c x': x'' = -(k x + c x'), theta + s = 1.5 t. */
static void bodies_that_no_element_joins_are_coupled(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU, SE3D_METHOD_BDF};
    const double w = sqrt(40.0 - 2.25);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        text_model m = text_model_open(
            HEAD
            "forces:\n"
            "  - {name: u, type: effort, joint: pin, value: \"-k*(q - rail.displacement) - "
            "c*(qdot - rail.rate)\"}\n"
            "  - {name: f, type: force, body: cart, value: [\"k*(pin.angle - "
            "(cart.tip.position.x - 1)) + c*(pin.rate - cart.tip.velocity.x)\", 0, 0]}\n" TAIL OUT,
            methods[k], -1, 0.0);
        text_model_run(&m, 0.9);
        const double x = 0.5 * exp(-1.5 * 0.9) * sin(w * 0.9) / w; /* x' = 1 - 0.5 */
        CHECK_NEAR(text_model_get(&m, 0, 0) - text_model_get(&m, 1, 0), x, 1e-8);
        CHECK_NEAR(text_model_get(&m, 0, 0) + text_model_get(&m, 1, 0), 1.5 * 0.9, 1e-8);
        text_model_close(&m);
    }
}

/* The length of one spring drives another: as its own l in a spring at the same place. */
static void a_length_of_another_spring_is_as_good_as_its_own(void)
{
    double end[2];
    for (int own = 0; own < 2; ++own) {
        char text[3000];
        snprintf(text, sizeof text,
                 HEAD "forces:\n  - {name: gauge, type: tsda, body_i: arm, body_j: cart, point_i: "
                      "[0.2, 0.1, 0]}\n  - {name: push, type: tsda, body_i: arm, body_j: cart, "
                      "point_i: [0.2, 0.1, 0], h: \"30*(%s - 0.7) + 2*%s\"}\n" TAIL OUT,
                 own ? "l" : "gauge.length", own ? "ldot" : "gauge.rate");
        text_model m = text_model_open(text, SE3D_METHOD_RADAU, -1, 0.0);
        text_model_run(&m, 0.8);
        end[own] = text_model_get(&m, 1, 0);
        text_model_close(&m);
    }
    CHECK_NEAR(end[0], end[1], 1e-11);
}

/* A clone goes on with the same bits when its original is gone. */
static void a_clone_has_its_own_laws(void)
{
    const char *const text = HEAD
        "forces: [{name: u, type: torque, body: arm, value: [0, 0, \"-8*pin.angle\"]}]\n" TAIL OUT;
    text_model m = text_model_open(text, SE3D_METHOD_DOP853, -1, 0.0);
    se3d_system *copy = NULL;
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    text_model_run(&m, 0.5);
    CHECK(!se3d_system_clone(m.system, &copy));
    CHECK(!se3d_model_get_solver(m.model, 0, &def));
    text_model_run(&m, 1.0);
    const uint64_t hash = se3d_system_hash(m.system);
    text_model_close(&m);
    CHECK(!se3d_solver_create(copy, &def, &solver));
    CHECK(se3d_solver_run(solver, 1.0) >= 0);
    CHECK(se3d_system_hash(copy) == hash);
    se3d_solver_destroy(solver);
    se3d_system_destroy(copy);
}

/* Elements that a law measures stay as long as it; what cannot be measured is refused. */
static void elements_of_signals_are_in_use(void)
{
    text_model m = text_model_open(HEAD TAIL, -1, -1, 0.0);
    se3d_body arm;
    se3d_constraint pin, rail;
    se3d_function law;
    se3d_force force;
    se3d_signal signals[2];
    static const char *const names[] = {"a", "x"};
    se3d_function_def def = se3d_function_def_default();
    memset(signals, 0, sizeof signals);
    CHECK(!se3d_body_find(m.system, "arm", &arm));
    CHECK(!se3d_constraint_find(m.system, "pin", &pin));
    CHECK(!se3d_constraint_find(m.system, "rail", &rail));
    signals[0] = (se3d_signal){.kind = SE3D_SIGNAL_JOINT_COORDINATE, .joint = pin};
    signals[1] = (se3d_signal){.kind = SE3D_SIGNAL_POINT_POSITION, .body = arm};
    def.expression = "a + x";
    def.variables = names;
    def.variable_count = 2;
    def.signals = signals;
    def.signal_count = 2;
    CHECK(!se3d_function_create(m.system, &def, &law));
    CHECK(se3d_constraint_destroy(m.system, pin) == SE3D_ERR_IN_USE);
    se3d_driver_def driver = se3d_driver_def_default();
    driver.joint = pin;
    driver.function = law;
    CHECK(se3d_driver_create(m.system, &driver, &rail) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "signals, which only the law");
    CHECK(!se3d_constraint_find(m.system, "rail", &rail));
    CHECK(!se3d_constraint_destroy(m.system, rail)); /* the others move up */
    se3d_load_def load = se3d_load_def_default();
    load.body = arm;
    load.function[0] = law;
    CHECK(!se3d_force_create_load(m.system, &load, &force));
    CHECK(!se3d_force_destroy(m.system, force));
    CHECK(!se3d_function_destroy(m.system, law));
    CHECK(!se3d_constraint_destroy(m.system, pin));
    signals[0].component = 7;
    CHECK(se3d_function_create(m.system, &def, &law) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "component = 7, must be from 0 to 1");
    signals[0].component = 0;
    CHECK(se3d_function_create(m.system, &def, &law) == SE3D_ERR_STALE_HANDLE);
    signals[0].kind = 99;
    CHECK(se3d_function_create(m.system, &def, &law) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "kind = 99");
    def.signal_count = 3;
    CHECK(se3d_function_create(m.system, &def, &law) == SE3D_ERR_INVALID_ARGUMENT);
    text_model_close(&m);
}

int main(void)
{
    RUN(a_torque_of_an_angle_is_a_spring);
    RUN(bodies_that_no_element_joins_are_coupled);
    RUN(a_length_of_another_spring_is_as_good_as_its_own);
    RUN(a_clone_has_its_own_laws);
    RUN(elements_of_signals_are_in_use);
    return check_finish();
}
