/* SPDX-License-Identifier: BSD-3-Clause */
/* States: controllers and filters that are integrated with the motion, against closed forms, in
 * every method and formulation; and that nothing else takes notice of them. */
#include <math.h>

#include "support/text_model.h"

#define ARM                                                                                        \
    "se3d: 1\ngravity: [0, 0, -9.81]\nparameters: {tau: 1/3, kp: 10/3, kd: 32/9}\nbodies:\n"       \
    "  - {name: arm, mass: 1, inertia: [1, 1, 2], position: [0, 0, 0]}\njoints:\n"                 \
    "  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, 0, "    \
    "1], angle0: 1}\n"
#define PD                                                                                         \
    "forces: [{name: motor, type: effort, joint: pin, value: \"-kp*q - lead.value\"}]\nstates:\n"  \
    "  - {name: lead, type: transfer, input: kd*pin.angle, numerator: [1, 0], denominator: [tau, " \
    "1]}\n  - {name: slow, type: lag, input: 2, time_constant: 0.5, gain: 3, initial: -1}\n"       \
    "  - {name: sum, type: integrator, input: pin.rate, initial: 1}\n"                             \
    "  - {name: free, type: ode, rate: \"sin(t) - 0.5*free.value\"}\n"
#define RUN_TO_2 "analysis: {type: dynamics, duration: 2, tolerance: 1e-11}\n"
#define OUT                                                                                        \
    "output: [{file: r.csv, channels: [pin.angle, lead.value, slow.value, sum.value, free.value, " \
    "energy.total, work.actuators]}]\n"

/* The arm with a proportional controller and a filtered derivative, kp 10/3, kd 32/9, the filter
 * 1/3 s and the inertia 2: the poles are -1, -1 + 2 i, -1 - 2 i. */
static double closed_form(size_t channel, double t)
{
    const double e = exp(-t);
    const double theta = e * (1.5 * cos(2.0 * t) + 0.5 * sin(2.0 * t) - 0.5);
    const double second = e * (-6.5 * cos(2.0 * t) + 4.5 * sin(2.0 * t) - 0.5);
    const double values[] = {theta, -2.0 * second - 10.0 / 3.0 * theta, 6.0 - 7.0 * exp(-2.0 * t),
                             theta, 0.8 * exp(-0.5 * t) + 0.4 * sin(t) - 0.8 * cos(t)};
    return values[channel];
}

static double error_at_end(const text_model *m, double t)
{
    double worst = 0.0;
    for (size_t k = 0; k < 5; ++k) {
        worst = fmax(worst, fabs(text_model_get(m, k, 0) - closed_form(k, t)));
    }
    return worst;
}

static void a_controlled_arm_follows_its_closed_form(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45,  SE3D_METHOD_RADAU,
                                      SE3D_METHOD_BDF,    SE3D_METHOD_GAUSS, SE3D_METHOD_RK4,
                                      SE3D_METHOD_AUTO};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        for (int32_t f = 0; f < 3; ++f) {
            text_model m = text_model_open(ARM PD RUN_TO_2 OUT, methods[k], f, 0.0);
            text_model_run(&m, 1.7);
            CHECK(error_at_end(&m, 1.7) < 1e-9);
            text_model_close(&m);
        }
    }
}

/* The order that the errors of two steps show. */
static void every_method_integrates_states_to_its_order(void)
{
    static const struct {
        int32_t method;
        double order, h;
    } rows[] = {{SE3D_METHOD_GENERALIZED_ALPHA, 2.0, 0.01},
                {SE3D_METHOD_HHT, 2.0, 0.01},
                {SE3D_METHOD_RATTLE, 2.0, 0.01},
                {SE3D_METHOD_VERLET, 2.0, 0.01},
                {SE3D_METHOD_CONVEX, 2.0, 0.01}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        for (int32_t f = 0; f < 3; ++f) {
            double error[2];
            for (int half = 0; half < 2; ++half) {
                text_model m =
                    text_model_open(ARM PD "analysis: {type: dynamics, duration: 2}\n" OUT,
                                    rows[k].method, f, rows[k].h / (1 + half));
                text_model_run(&m, 1.5);
                error[half] = error_at_end(&m, 1.5);
                text_model_close(&m);
            }
            CHECK_NEAR(log2(error[0] / error[1]), rows[k].order, 0.15);
            CHECK(error[0] < 2e-3);
        }
    }
}

/* A state that is held by stiffness, 1 / tau = 1e6: radau takes over. */
static void stiff_filters_are_left_to_implicit_methods(void)
{
    text_model m = text_model_open(
        ARM "forces: [{name: motor, type: effort, joint: pin, value: \"-8*fast.value\"}]\nstates:\n"
            "  - {name: fast, type: lag, input: pin.angle, time_constant: 1e-6, initial: 1}\n"
            "analysis: {type: dynamics, duration: 2, tolerance: 1e-8}\n"
            "output: [{file: r.csv, channels: [pin.angle, steps]}]\n",
        SE3D_METHOD_AUTO, -1, 0.0);
    se3d_solver_stats stats;
    text_model_run(&m, 2.0);
    CHECK_NEAR(text_model_get(&m, 0, 0), cos(4.0), 2e-5); /* and a little damping, 4e-6 */
    CHECK(!se3d_solver_get_stats(m.solver, &stats));
    CHECK(stats.steps < 5000);
    text_model_close(&m);
}

/* What the limits of a controller cut off does not wind up its integral. */
static void a_limited_controller_does_not_wind_up(void)
{
    double past[2];
    for (int free = 0; free < 2; ++free) {
        char text[1500];
        snprintf(text, sizeof text,
                 ARM "states:\n  - {name: c, type: pid, input: 1 - x.value, kp: 4, ki: 2, kd: 0.1, "
                     "filter_time: 0.05, lower: -0.2, upper: 0.2%s}\n"
                     "  - {name: x, type: integrator, input: c.value}\n"
                     "analysis: {type: dynamics, duration: 20, tolerance: 1e-8}\n"
                     "output: [{file: r.csv, channels: [x.value, c.value]}]\n",
                 free ? ", tracking_time: 1e6" : "");
        text_model m = text_model_open(text, SE3D_METHOD_DOP853, -1, 0.0);
        past[free] = 0.0;
        for (int k = 1; k <= 100; ++k) {
            text_model_run(&m, 0.2 * k);
            past[free] = fmax(past[free], text_model_get(&m, 0, 0) - 1.0);
            CHECK(fabs(text_model_get(&m, 1, 0)) <= 0.2);
        }
        text_model_close(&m);
    }
    CHECK(past[0] < 0.12);
    CHECK(past[1] > 0.6);
}

/* Clones go on with the same bits, snapshots come back to them. */
static void clones_and_snapshots_hold_states(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU,
                                      SE3D_METHOD_GENERALIZED_ALPHA};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        text_model m = text_model_open(ARM PD "analysis: {type: dynamics, duration: 2}\n" OUT,
                                       methods[k], -1, 0.0);
        se3d_system *copy = NULL;
        se3d_solver *solver = NULL;
        se3d_snapshot *snapshot = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        text_model_run(&m, 0.5);
        CHECK(!se3d_system_clone(m.system, &copy));
        CHECK(!se3d_snapshot_create(m.system, &snapshot));
        CHECK(!se3d_model_get_solver(m.model, 0, &def));
        def.method = methods[k];
        text_model_run(&m, 1.0);
        const uint64_t hash = se3d_system_hash(m.system);
        CHECK(!se3d_snapshot_restore(snapshot, m.system));
        CHECK(se3d_system_hash(m.system) != hash);
        text_model_run(&m, 1.0);
        CHECK(se3d_system_hash(m.system) == hash);
        CHECK(!se3d_solver_create(copy, &def, &solver));
        CHECK(se3d_solver_run(solver, 1.0) >= 0);
        CHECK(se3d_system_hash(copy) == hash);
        se3d_solver_destroy(solver);
        se3d_snapshot_destroy(snapshot);
        se3d_system_destroy(copy);
        text_model_close(&m);
    }
}

/* A pendulum with and without states that it does not depend on: the same bits. */
static void what_no_state_acts_on_keeps_its_bits(void)
{
    static const struct {
        int32_t method;
        double allowed; /* where one iteration serves all */
    } rows[] = {{SE3D_METHOD_RATTLE, 0.0},
                {SE3D_METHOD_GENERALIZED_ALPHA, 1e-9},
                {SE3D_METHOD_CONVEX, 1e-7}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        double end[2][3];
        for (int with = 0; with < 2; ++with) {
            char text[1500];
            snprintf(text, sizeof text,
                     "se3d: 1\nbodies: [{name: bar, mass: 2, inertia: [1, 1, 1], position: [1, 0, "
                     "0]}]\njoints: [{name: pin, type: revolute, body_i: ground, body_j: bar, at: "
                     "[0, 0, 0], axis: [0, 1, 0]}]\nforces: [{type: torque, body: bar, value: [0, "
                     "0, 0]}]\n"
                     "%sanalysis: {type: dynamics, duration: "
                     "1}\noutput: [{file: r.csv, channels: [pin.angle, energy.kinetic, "
                     "energy.potential]}]\n",
                     with ? "states: [{name: big, type: ode, rate: 1e6*cos(t), initial: 1e6}]\n"
                          : "");
            text_model m = text_model_open(text, rows[k].method, -1, 0.01);
            CHECK(se3d_system_count_bodies(m.system) == 2);
            CHECK(se3d_system_count_forces(m.system) == 1);
            CHECK(se3d_system_count_states(m.system) == (size_t)with);
            text_model_run(&m, 0.7);
            for (size_t c = 0; c < 3; ++c) {
                end[with][c] = text_model_get(&m, c, 0);
            }
            text_model_close(&m);
        }
        for (size_t c = 0; c < 3; ++c) {
            CHECK_NEAR(end[0][c], end[1][c], rows[k].allowed);
        }
    }
}

/* They stay as they are where nothing moves in time. */
static void equilibria_leave_states_as_they_are(void)
{
    text_model m = text_model_open(
        "se3d: 1\nbodies: [{name: box, mass: 2, inertia: [1, 1, 1]}]\njoints: [{name: rail, type: "
        "prismatic, body_i: ground, body_j: box, at: [0, 0, 0], axis: [0, 0, 1]}]\nforces:\n"
        "  - {type: force, body: box, value: [0, 0, \"100*(lift.value - rail.displacement)\"]}\n"
        "states: [{name: lift, type: ode, rate: -lift.value, initial: 0.5}]\n"
        "analysis: {type: equilibrium}\noutput: [{file: r.csv, channels: [rail.displacement, "
        "lift.value, lift.rate]}]\n",
        -1, -1, 0.0);
    text_model_run(&m, 0.0);
    CHECK_NEAR(text_model_get(&m, 0, 0), 0.5 - 2.0 * 9.81 / 100.0, 1e-12);
    CHECK(text_model_get(&m, 1, 0) == 0.5);
    CHECK(text_model_get(&m, 2, 0) == -0.5);
    text_model_close(&m);
}

/* An event is located where the state crosses its level: at log 2. */
static void events_find_levels_of_states(void)
{
    text_model m =
        text_model_open(ARM "states: [{name: z, type: ode, rate: -z.value, initial: 1}]\n"
                            "analysis: {type: dynamics, duration: 3, tolerance: 1e-10}\n",
                        SE3D_METHOD_DOP853, -1, 0.0);
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    se3d_event_record record;
    se3d_model_error error = {0};
    def.name = "half";
    def.level = 0.5;
    def.action = SE3D_EVENT_STOP;
    CHECK(!se3d_model_create_event(m.model, m.solver, "z.value", &def, &event, &error));
    text_model_run(&m, 3.0);
    CHECK(se3d_solver_count_event_records(m.solver) == 1);
    CHECK(!se3d_solver_get_event_record(m.solver, 0, &record));
    CHECK_NEAR(record.time, log(2.0), 1e-9);
    text_model_close(&m);
}

/* States of the C interface: loops, users, and order of creation do not matter. */
static void states_are_made_and_removed_by_hand(void)
{
    static const char *const names[] = {"t", "y"};
    se3d_system *system;
    se3d_state z, w;
    se3d_state_def def = se3d_state_def_default();
    se3d_function decay, loop;
    se3d_signal signal;
    se3d_function_def f = se3d_function_def_default();
    se3d_body_def body = se3d_body_def_default();
    se3d_body ball, found;
    se3d_solver *solver;
    se3d_solver_def run = se3d_solver_def_default();
    double value;
    CHECK(!se3d_system_create(NULL, &system));
    def.name = "z";
    def.initial = 2.0;
    CHECK(!se3d_state_create(system, &def, &z));
    CHECK(se3d_state_create(system, &def, &w) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "\"z\" is taken");
    def.name = "w";
    CHECK(!se3d_state_create(system, &def, &w));
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    CHECK(!se3d_body_create(system, &body, &ball)); /* behind the carriers */
    CHECK(se3d_system_count_bodies(system) == 2);
    CHECK(!se3d_system_get_body(system, 1, &found) && found.index1 == ball.index1);
    CHECK(se3d_system_get_body(system, 2, &found) == SE3D_ERR_INVALID_ARGUMENT);
    memset(&signal, 0, sizeof signal);
    signal.kind = SE3D_SIGNAL_STATE;
    signal.state = z;
    f.variables = names;
    f.variable_count = 2;
    f.signals = &signal;
    f.signal_count = 1;
    f.expression = "-3*y";
    CHECK(!se3d_function_create(system, &f, &decay));
    CHECK(!se3d_state_set_rate(system, z, decay));
    signal.component = SE3D_STATE_OUTPUT;
    f.expression = "2*y";
    CHECK(!se3d_function_create(system, &f, &loop));
    CHECK(!se3d_state_set_output(system, w, loop)); /* of z */
    CHECK(se3d_state_set_output(system, z, loop) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "an algebraic loop");
    CHECK(!se3d_solver_create(system, &run, &solver));
    CHECK(se3d_solver_run(solver, 0.5) >= 0);
    CHECK(!se3d_state_get_value(system, z, SE3D_STATE_VALUE, &value));
    CHECK_NEAR(value, 2.0 * exp(-1.5), 1e-5);
    CHECK(!se3d_state_get_value(system, w, SE3D_STATE_OUTPUT, &value));
    CHECK_NEAR(value, 4.0 * exp(-1.5), 2e-5);
    CHECK(!se3d_state_get_rate(system, z, &value));
    CHECK_NEAR(value, -6.0 * exp(-1.5), 5e-5);
    CHECK(se3d_state_destroy(system, z) == SE3D_ERR_IN_USE);
    CHECK(!se3d_state_set_rate(system, z, (se3d_function){0, 0}));
    CHECK(!se3d_state_set_output(system, w, (se3d_function){0, 0}));
    CHECK(!se3d_function_destroy(system, decay));
    CHECK(!se3d_function_destroy(system, loop));
    CHECK(se3d_state_set_rate(system, z, decay) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_state_set_output(system, z, decay) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_state_set_input(system, z, decay) == SE3D_ERR_STALE_HANDLE);
    CHECK(!se3d_state_destroy(system, z));
    CHECK(se3d_state_find(system, "z", &z) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_state_find(system, "w", &z) && z.index1 == w.index1);
    CHECK(!se3d_state_set_value(system, w, 7.0));
    CHECK(!se3d_state_get_value(system, w, SE3D_STATE_VALUE, &value) && value == 7.0);
    CHECK(!se3d_body_destroy(system, ball));
    CHECK(se3d_force_find(system, "w", &(se3d_force){0, 0}) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

/* An output that is the user's code; it fails if `ctx` says so. */
static se3d_status give_output(void *ctx, const double *x, double jet[3], double *gradient)
{
    jet[0] = x[0];
    jet[1] = 1.0;
    jet[2] = 0.0;
    if (gradient) {
        gradient[0] = 1.0;
    }
    return *(const int *)ctx ? SE3D_ERR_CALLBACK : SE3D_OK;
}

/* Efforts and rates that are expressions of outputs have no energy, and what the user's code
 * behind them says is told all the same. */
static void the_energy_tells_of_callbacks_behind_signals(void)
{
    static const char *const users[] = {
        "states: [{name: y, type: ode, rate: 0}]\n"
        "forces: [{name: motor, type: effort, joint: pin, value: \"-2*y.value\"}]\n",
        "states: [{name: y, type: ode, rate: 0}, {name: z, type: ode, rate: \"-2*y.value\"}]\n",
        "states: [{name: y, type: ode, rate: 0},\n"
        "  {name: z, type: transfer, input: y.value, numerator: [1, 0], denominator: [1, 1]}]\n"
        "forces: [{name: motor, type: effort, joint: pin, value: \"z.value - z.value^2\"}]\n"};
    for (size_t k = 0; k < sizeof users / sizeof *users; ++k) {
        char text[1024];
        int fails = 0;
        se3d_state y;
        se3d_energy energy;
        se3d_function output;
        se3d_function_def def = se3d_function_def_default();
        snprintf(text, sizeof text, ARM "%s" RUN_TO_2, users[k]);
        text_model m = text_model_open(text, SE3D_METHOD_DOP853, -1, 0.0);
        def.callback = give_output;
        def.ctx = &fails;
        CHECK(!se3d_function_create(m.system, &def, &output));
        CHECK(!se3d_state_find(m.system, "y", &y));
        CHECK(!se3d_state_set_output(m.system, y, output));
        CHECK(!se3d_system_get_energy(m.system, &energy));
        fails = 1;
        CHECK(se3d_system_get_energy(m.system, &energy) == SE3D_ERR_CALLBACK);
        fails = 0;
        CHECK(!se3d_system_get_energy(m.system, &energy));
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_controlled_arm_follows_its_closed_form);
    RUN(every_method_integrates_states_to_its_order);
    RUN(stiff_filters_are_left_to_implicit_methods);
    RUN(a_limited_controller_does_not_wind_up);
    RUN(clones_and_snapshots_hold_states);
    RUN(what_no_state_acts_on_keeps_its_bits);
    RUN(equilibria_leave_states_as_they_are);
    RUN(events_find_levels_of_states);
    RUN(states_are_made_and_removed_by_hand);
    RUN(the_energy_tells_of_callbacks_behind_signals);
    return check_finish();
}
