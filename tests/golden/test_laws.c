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

/* sqrt(t) rises infinitely fast at t = 0, which explicit methods need not know:
 * 2 theta'' = sqrt(t). */
static void a_law_may_rise_infinitely_fast(void)
{
    text_model m = text_model_open(HEAD "forces: [{name: u, type: torque, body: arm, value: [0, 0, "
                                        "\"sqrt(t) + 0*pin.angle\"]}]\n" TAIL OUT,
                                   SE3D_METHOD_DOP853, -1, 0.0);
    text_model_run(&m, 1.0);
    CHECK_NEAR(text_model_get(&m, 0, 0), 1.0 + 2.0 / 15.0, 1e-8);
    text_model_close(&m);
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
    CHECK_CONTAINS(se3d_system_get_error(m.system), "an expression of the time and of them");
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

#define CAM                                                                                        \
    "se3d: 1\ngravity: [0, 0, 0]\nbodies:\n"                                                       \
    "  - {name: arm, mass: 1, inertia: [1, 1, 2], angular_velocity: [0, 0, 1]}\n"                  \
    "  - {name: cart, mass: 2, inertia: [1, 1, 1], position: [1, 0, 0], velocity: [2, 0, 0]}\n"    \
    "joints:\n"                                                                                    \
    "  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, 0, "    \
    "1]}\n"                                                                                        \
    "  - {name: rail, type: prismatic, body_i: ground, body_j: cart, at: [1, 0, 0], axis: [1, 0, " \
    "0]}\n"
#define FOLLOW                                                                                     \
    "drivers:\n  - {name: cam, joint: rail, value: 2*sin(pin.angle)}\n%s" TAIL                     \
    "output: [{file: r.csv, channels: [pin.angle, rail.displacement, cam.effort, cam.value%s]}]\n"

typedef struct way {
    int32_t method, formulation;
    double step, tolerance;
} way;

static const way ways[] = {
    {SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-8},
    {SE3D_METHOD_DOP853, SE3D_FORMULATION_RP, 0.0, 1e-8},
    {SE3D_METHOD_DOP853, SE3D_FORMULATION_JOINT, 0.0, 1e-8},
    {SE3D_METHOD_GAUSS, SE3D_FORMULATION_JOINT, 0.0, 1e-8},
    {SE3D_METHOD_RK45, SE3D_FORMULATION_RP, 0.0, 1e-7},
    {SE3D_METHOD_RADAU, SE3D_FORMULATION_ROMEGA, 0.0, 1e-6},
    {SE3D_METHOD_BDF, SE3D_FORMULATION_RP, 0.0, 1e-5},
    {SE3D_METHOD_RATTLE, SE3D_FORMULATION_ROMEGA, 1e-3, 2e-5},
    {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_ROMEGA, 1e-3, 2e-5},
    {SE3D_METHOD_HHT, SE3D_FORMULATION_RP, 1e-3, 2e-5},
};

/* t(theta) of the free cam: the energy theta'^2 (1 + 4 cos^2 theta) stays 5. */
static double time_of(double theta)
{
    enum { CELLS = 2000 };
    double sum = 0.0;
    for (int k = 0; k <= CELLS; ++k) {
        const double c = cos(theta * k / CELLS);
        const double weight = k == 0 || k == CELLS ? 1.0 : k % 2 ? 4.0 : 2.0;
        sum += weight * sqrt((1.0 + 4.0 * c * c) / 5.0);
    }
    return sum * theta / CELLS / 3.0;
}

/* A cart that follows 2 sin(angle) of an arm that turns freely, as by an ideal cam. */
static void a_driver_follows_an_angle_that_is_free(void)
{
    char text[3000];
    snprintf(text, sizeof text, CAM FOLLOW, "", "");
    for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
        text_model m = text_model_open(text, ways[k].method, ways[k].formulation, ways[k].step);
        text_model_run(&m, 1.7);
        const double theta = text_model_get(&m, 0, 0);
        CHECK_NEAR(text_model_get(&m, 1, 0), 2.0 * sin(theta), 1e-9);
        CHECK_NEAR(text_model_get(&m, 3, 0), 2.0 * sin(theta), 1e-9);
        CHECK_NEAR(time_of(theta), 1.7, ways[k].tolerance);
        text_model_close(&m);
    }
}

/* With a motor on the arm, angle = 3 t: the cart needs -36 sin(3 t) N, which the motor feels as
 * 2 cos(3 t) times that. */
static void a_driver_follows_a_driven_angle(void)
{
    const double t = 1.1, force = -36.0 * sin(3.0 * t);
    char text[3000];
    snprintf(text, sizeof text, CAM FOLLOW, "  - {name: motor, joint: pin, value: 3*t}\n",
             ", motor.effort");
    for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
        text_model m = text_model_open(text, ways[k].method, ways[k].formulation, ways[k].step);
        const double tolerance = ways[k].step > 0.0 ? 1e-2 : 1e-4;
        text_model_run(&m, t);
        CHECK_NEAR(text_model_get(&m, 1, 0), 2.0 * sin(3.0 * t), 1e-9);
        CHECK_NEAR(text_model_get(&m, 2, 0), force, tolerance);
        CHECK_NEAR(text_model_get(&m, 4, 0), 2.0 * cos(3.0 * t) * force, tolerance);
        text_model_close(&m);
    }
}

/* A rate that follows others; the methods that begin with positions do not take it. */
typedef struct rated {
    const char *law, *states, *motor;
    double (*x)(double t), (*force)(double t), (*torque)(double t);
} rated;

static double x_square(double t)
{
    return 4.0 * t * t * t / 3.0;
}

static double force_square(double t)
{
    return 16.0 * t;
}

/* The row is x' - 2 w w + w^2 about w = 2 t: 4 t of what the cart feels, and 2 * 2 to turn it. */
static double torque_square(double t)
{
    return 4.0 + 4.0 * t * 16.0 * t;
}

static double x_pid(double t)
{
    return t - 1.0 / 3.0 + exp(-3.0 * t) / 3.0;
}

static double force_pid(double t)
{
    return 6.0 * exp(-3.0 * t);
}

static double torque_pid(double t)
{
    return 4.0 + 1.5 * 6.0 * exp(-3.0 * t);
}

static double x_lag(double t)
{
    return t - 0.2 * (1.0 - exp(-t / 0.2)) + 0.5 * t * t;
}

static double force_lag(double t)
{
    return 2.0 * (exp(-t / 0.2) / 0.2 + 1.0);
}

static double torque_lag(double t)
{
    (void)t;
    return 4.0;
}

/* In order: not linear in a velocity; a controller with feed-through of a velocity and a position;
 * a state, and the time. */
static const rated rates[] = {
    {"pin.rate^2", "", "t^2", x_square, force_square, torque_square},
    {"control.value",
     "states: [{name: control, type: pid, kp: 3, input: 0.5*pin.rate - rail.displacement}]\n",
     "t^2", x_pid, force_pid, torque_pid},
    {"filter.value + t", "states: [{name: filter, type: lag, time_constant: 0.2, input: 1}]\n",
     "t^2", x_lag, force_lag, torque_lag}};

static void rates_follow_velocities_states_and_positions(void)
{
    for (size_t c = 0; c < sizeof rates / sizeof *rates; ++c) {
        for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
            char text[3000];
            const double t = 0.8;
            const int is_equal = ways[k].step > 0.0;
            snprintf(text, sizeof text,
                     CAM "drivers:\n  - {name: motor, joint: pin, value: \"%s\"}\n"
                         "  - {name: cam, joint: rail, rate: \"%s\"}\n%s" TAIL
                         "output: [{file: r.csv, channels: [rail.displacement, cam.value, "
                         "cam.effort, motor.effort]}]\n",
                     rates[c].motor, rates[c].law, rates[c].states);
            if (ways[k].method == SE3D_METHOD_RATTLE) {
                continue;
            }
            text_model m = text_model_open(text, ways[k].method, ways[k].formulation, ways[k].step);
            text_model_run(&m, t);
            CHECK_NEAR(text_model_get(&m, 0, 0), rates[c].x(t), is_equal ? 2e-5 : 1e-6);
            CHECK_NEAR(text_model_get(&m, 1, 0), text_model_get(&m, 0, 0), 0.0);
            CHECK_NEAR(text_model_get(&m, 2, 0), rates[c].force(t), is_equal ? 1e-2 : 1e-4);
            CHECK_NEAR(text_model_get(&m, 3, 0), rates[c].torque(t), is_equal ? 5e-2 : 1e-3);
            text_model_close(&m);
        }
    }
}

/* A gear whose ratio is 2 cos(angle) makes the motion of the cam 2 sin(angle), by its own
 * integration: no energy is lost on the way, and both sides feel it. */
static void a_rate_of_a_free_angle_is_a_gear(void)
{
    char text[3000];
    snprintf(text, sizeof text,
             CAM "drivers:\n  - {name: cam, joint: rail, rate: 2*cos(pin.angle)*pin.rate}\n" TAIL
                 "output: [{file: r.csv, channels: [pin.angle, rail.displacement, "
                 "energy.kinetic, work.drivers]}]\n");
    for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
        if (ways[k].method == SE3D_METHOD_RATTLE) {
            continue;
        }
        text_model m = text_model_open(text, ways[k].method, ways[k].formulation, ways[k].step);
        text_model_run(&m, 1.7);
        const double theta = text_model_get(&m, 0, 0);
        CHECK_NEAR(text_model_get(&m, 1, 0), 2.0 * sin(theta), 2.0 * ways[k].tolerance);
        CHECK_NEAR(time_of(theta), 1.7, 2.0 * ways[k].tolerance);
        CHECK_NEAR(text_model_get(&m, 2, 0), 5.0, 10.0 * ways[k].tolerance);
        CHECK_NEAR(text_model_get(&m, 3, 0), 0.0, 1e-9);
        text_model_close(&m);
    }
}

/* Analyses of positions and methods that begin with them say that they do not take it; a clone
 * goes on with the same bits; a file is written as it was. */
static void rates_are_refused_where_positions_come_first(void)
{
    static const int32_t methods[] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET, SE3D_METHOD_CONVEX};
    static const int32_t analyses[] = {SE3D_ANALYSIS_KINEMATICS, SE3D_ANALYSIS_INVERSE_DYNAMICS,
                                       SE3D_ANALYSIS_EQUILIBRIUM};
    const char *const text =
        CAM "drivers: [{name: cam, joint: rail, rate: control.value}]\n"
            "states: [{name: control, type: pid, kp: 2, input: pin.rate}]\n" TAIL;
    text_model m = text_model_open(text, SE3D_METHOD_DOP853, -1, 0.0);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_write_options how = se3d_write_options_default();
    se3d_model_error error;
    se3d_modes *modes = NULL;
    se3d_state control;
    se3d_system *copy = NULL;
    char written[4000];
    size_t length = 0;
    for (size_t k = 0; k < 6; ++k) {
        se3d_solver *solver = NULL;
        def.analysis = k < 3 ? SE3D_ANALYSIS_DYNAMICS : analyses[k - 3];
        def.method = k < 3 ? methods[k] : SE3D_METHOD_AUTO;
        def.step = 1e-3;
        CHECK(!se3d_solver_create(m.system, &def, &solver));
        CHECK(se3d_solver_run(solver, 0.01) == SE3D_ERR_UNSUPPORTED);
        CHECK_CONTAINS(se3d_system_get_error(m.system), "the rate of driver 'cam' follows signals");
        se3d_solver_destroy(solver);
    }
    CHECK(se3d_modes_create(m.system, NULL, &modes) == SE3D_ERR_UNSUPPORTED && !modes);
    CHECK(!se3d_state_find(m.system, "control", &control));
    CHECK(se3d_state_set_output(m.system, control, (se3d_function){0, 0}) == SE3D_ERR_IN_USE);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "the rate of driver cam depends on");
    how.partial = 1;
    CHECK(se3d_model_write_text(m.model, &how, written, sizeof written, &length, &error) >= 0);
    CHECK_CONTAINS(written, "{name: cam, joint: rail, rate: control.value}");
    CHECK(!se3d_system_clone(m.system, &copy));
    text_model_run(&m, 0.5);
    const uint64_t hash = se3d_system_hash(m.system);
    CHECK(!se3d_model_get_solver(m.model, 0, &def));
    text_model_close(&m);
    se3d_solver *solver = NULL;
    def.method = SE3D_METHOD_DOP853;
    CHECK(!se3d_solver_create(copy, &def, &solver));
    CHECK(se3d_solver_run(solver, 0.5) >= 0);
    CHECK(se3d_system_hash(copy) == hash);
    se3d_solver_destroy(solver);
    se3d_system_destroy(copy);
}

/* w = w^2 + 1 has no solution, that Newton's method goes from 1 to 0 and back. */
static void rates_that_no_velocities_have_are_refused(void)
{
    for (int32_t formulation = 0; formulation < 2; ++formulation) {
        text_model m = text_model_open(
            CAM
            "drivers: [{name: box, joint: pin, rate: rail.rate}, {name: cam, joint: rail, rate: "
            "pin.rate^2 + 1}]\n" TAIL,
            SE3D_METHOD_DOP853, formulation, 0.0);
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver *solver = NULL;
        CHECK(!se3d_model_get_solver(m.model, 0, &def));
        CHECK(!se3d_solver_create(m.system, &def, &solver));
        CHECK(se3d_solver_run(solver, 0.1) == SE3D_ERR_INCONSISTENT);
        CHECK_CONTAINS(se3d_system_get_error(m.system), "the velocity equation of");
        se3d_solver_destroy(solver);
        text_model_close(&m);
    }
}

/* What jumps within a step would be found by nobody: positions were off by 17 %. */
static void rates_that_may_jump_are_refused(void)
{
    static const char *const laws[] = {"\"if(t < 0.503, 1, 2)*pin.rate\"", "\"sign(pin.angle)\"",
                                       "\"(pin.angle > 1)*pin.rate\"",     "\"mod(pin.angle, 1)\"",
                                       "\"max(-1, min(1, pin.angle))\"",   "\"abs(pin.rate)\""};
    for (size_t k = 0; k < sizeof laws / sizeof *laws; ++k) {
        char text[2000];
        se3d_model *model = NULL;
        se3d_model_error error;
        snprintf(text, sizeof text, "%s%s%s%s",
                 CAM "drivers: [{name: cam, joint: rail, rate: ", laws[k], "}]\n", TAIL);
        const se3d_status status =
            se3d_model_read_text(text, strlen(text), "x.yaml", NULL, &model, &error);
        CHECK(status == (k < 4 ? SE3D_ERR_MODEL : SE3D_OK));
        if (k < 4) {
            CHECK_CONTAINS(error.message, "function may jump");
        }
        se3d_model_destroy(model);
    }
}

#define CHAIN                                                                                      \
    "se3d: 1\nbodies:\n  - {name: arm, mass: 1, inertia: [1, 1, 2]}\n"                             \
    "  - {name: cart, mass: 2, inertia: [1, 1, 1]}\n"                                              \
    "  - {name: block, mass: 2, inertia: [1, 1, 1]}\njoints:\n"                                    \
    "  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, 0, "    \
    "1]}\n"                                                                                        \
    "  - {name: rail, type: prismatic, body_i: ground, body_j: cart, at: [0, 0, 0], axis: [1, 0, " \
    "0]}\n"                                                                                        \
    "  - {name: slider, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [0, " \
    "1, 0]}\n"

/* Followers of the length of a spring, of an orientation and the time, and of a follower. */
static void drivers_follow_lengths_positions_and_followers(void)
{
    const double t = 1.9, a = 0.5 * t, length = sqrt(5.0 - 4.0 * cos(a));
    const double rate = 4.0 * sin(a) * 0.5 / (2.0 * length);
    text_model m = text_model_open(
        CHAIN "drivers:\n"
              "  - {name: cam, joint: rail, value: (gauge.length - 1)^2 + 0.1*t}\n"
              "  - {name: motor, joint: pin, value: 0.5*t}\n"
              "  - {name: last, joint: slider, value: cart.position.x*arm.orientation.e0}\n"
              "forces: [{name: gauge, type: tsda, body_i: ground, body_j: arm, point_i: [2, 0, "
              "0], point_j: [1, 0, 0]}]\nanalysis: {type: kinematics, duration: 2, step: 0.1}\n"
              "output: [{file: r.csv, channels: [rail.displacement, slider.displacement, "
              "rail.rate, slider.rate]}]\n",
        -1, -1, 0.0);
    const double x = (length - 1.0) * (length - 1.0) + 0.1 * t;
    const double x_t = 2.0 * (length - 1.0) * rate + 0.1;
    text_model_run(&m, t);
    CHECK_NEAR(text_model_get(&m, 0, 0), x, 1e-10);
    CHECK_NEAR(text_model_get(&m, 1, 0), x * cos(0.5 * a), 1e-10);
    CHECK_NEAR(text_model_get(&m, 2, 0), x_t, 1e-9);
    CHECK_NEAR(text_model_get(&m, 3, 0), x_t * cos(0.5 * a) - 0.25 * x * sin(0.5 * a), 1e-9);
    text_model_close(&m);
}

/* A spring holds the cam against a pull of 10 N along the rail: where it stands still at 0.5 rad,
 * the follower's curvature adds 20 sin 0.5 to the stiffness 40, and its slope 8 cos^2 0.5 to the
 * inertia 2. */
static void a_follower_takes_its_part_in_frequencies(void)
{
    text_model m = text_model_open(
        "se3d: 1\ngravity: [5, 0, 0]\nbodies:\n"
        "  - {name: arm, mass: 1, inertia: [1, 1, 2], orientation: {axis: [0, 0, 1], angle: 0.5}}\n"
        "  - {name: cart, mass: 2, inertia: [1, 1, 1]}\njoints:\n"
        "  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, 0, "
        "1], ref: [1, 0, 0], angle0: 0.5}\n"
        "  - {name: rail, type: prismatic, body_i: ground, body_j: cart, at: [0, 0, 0], axis: [1, "
        "0, 0]}\n"
        "drivers: [{name: cam, joint: rail, value: 2*sin(pin.angle) - 2*sin(0.5)}]\n"
        "forces: [{name: s, type: rsda, joint: pin, k: 40, theta0: 0.5 - 20*cos(0.5)/40}]\n"
        "analysis: {type: equilibrium}\noutput: [{file: r.csv, channels: [pin.angle]}]\n",
        -1, -1, 0.0);
    const double w = sqrt((40.0 + 20.0 * sin(0.5)) / (2.0 + 8.0 * cos(0.5) * cos(0.5)));
    se3d_modes *modes = NULL;
    se3d_eigenvalue value = {0};
    text_model_run(&m, 0.0);
    CHECK_NEAR(text_model_get(&m, 0, 0), 0.5, 1e-9);
    CHECK(!se3d_modes_create(m.system, NULL, &modes));
    CHECK(se3d_modes_count(modes) == 1);
    CHECK(!se3d_modes_get_eigenvalue(modes, 0, &value));
    CHECK_NEAR(value.imaginary, w, 1e-8);
    se3d_modes_destroy(modes);
    text_model_close(&m);
}

/* Definitions are given as they were made, what cannot be followed is refused, and what is
 * followed cannot be destroyed. */
static void followers_are_checked_and_given_back(void)
{
    char text[3000];
    snprintf(text, sizeof text, CAM FOLLOW, "", "");
    text_model m = text_model_open(text, -1, -1, 0.0);
    se3d_constraint cam, pin, rail, other;
    se3d_driver_def def = se3d_driver_def_default();
    static const char *const names[] = {"t", "a"};
    static const int32_t refused[] = {SE3D_SIGNAL_JOINT_RATE, SE3D_SIGNAL_POINT_VELOCITY,
                                      SE3D_SIGNAL_ANGULAR_VELOCITY};
    char written[4000];
    size_t length = 0;
    se3d_write_options how = se3d_write_options_default();
    se3d_model_error error;
    how.partial = 1;
    CHECK(se3d_model_write_text(m.model, &how, written, sizeof written, &length, &error) >= 0);
    CHECK_CONTAINS(written, "{name: cam, joint: rail, value: \"2*sin(pin.angle)\"}");
    CHECK(!se3d_constraint_find(m.system, "cam", &cam));
    CHECK(!se3d_constraint_find(m.system, "pin", &pin));
    CHECK(!se3d_constraint_find(m.system, "rail", &rail));
    CHECK(!se3d_driver_get_def(m.system, cam, &def));
    CHECK(def.joint.index1 == rail.index1 && def.function.index1 != 0);
    CHECK(def.coordinate == SE3D_JOINT_COORDINATE_DISPLACEMENT);
    CHECK(se3d_constraint_set_value(m.system, cam, 1.0) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_constraint_destroy(m.system, pin) == SE3D_ERR_IN_USE);
    for (size_t k = 0; k < sizeof refused / sizeof *refused; ++k) {
        se3d_signal signal = {.kind = refused[k], .joint = pin};
        se3d_function_def law = se3d_function_def_default();
        se3d_driver_def driver = se3d_driver_def_default();
        CHECK(!se3d_body_find(m.system, "arm", &signal.body));
        law.expression = "a";
        law.variables = names;
        law.variable_count = 2;
        law.signals = &signal;
        law.signal_count = 1;
        CHECK(!se3d_function_create(m.system, &law, &driver.function));
        driver.joint = rail;
        driver.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
        CHECK(se3d_driver_create(m.system, &driver, &other) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(m.system), "function depends on a velocity");
        CHECK(!se3d_function_destroy(m.system, driver.function));
    }
    CHECK(!se3d_constraint_destroy(m.system, cam));
    CHECK(!se3d_function_destroy(m.system, def.function));
    CHECK(!se3d_constraint_destroy(m.system, pin));
    text_model_close(&m);
}

int main(void)
{
    RUN(a_driver_follows_an_angle_that_is_free);
    RUN(a_driver_follows_a_driven_angle);
    RUN(rates_follow_velocities_states_and_positions);
    RUN(a_rate_of_a_free_angle_is_a_gear);
    RUN(rates_are_refused_where_positions_come_first);
    RUN(rates_that_no_velocities_have_are_refused);
    RUN(rates_that_may_jump_are_refused);
    RUN(drivers_follow_lengths_positions_and_followers);
    RUN(a_follower_takes_its_part_in_frequencies);
    RUN(followers_are_checked_and_given_back);
    RUN(a_torque_of_an_angle_is_a_spring);
    RUN(a_law_may_rise_infinitely_fast);
    RUN(bodies_that_no_element_joins_are_coupled);
    RUN(a_length_of_another_spring_is_as_good_as_its_own);
    RUN(a_clone_has_its_own_laws);
    RUN(elements_of_signals_are_in_use);
    return check_finish();
}
