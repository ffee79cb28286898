/* SPDX-License-Identifier: BSD-3-Clause */
/* Accelerations that jump, under a driver whose second derivative jumps and under a load that is
 * switched, also exactly at output times: the explicit methods cross the jump at every tolerance;
 * against closed forms and an integration of the pendulum's one equation, restarted at the jumps.
 */
#include "check.h"
#include "se3d/io.h"

static const int32_t methods[3] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_GAUSS};

/* A pendulum on a cart that is driven: at rest, 2 m/s^2, constant speed. */
static const char pushed[] =
    "{se3d: 1, bodies: [{name: cart, mass: 2, inertia: [1, 1, 1]},"
    "  {name: bob, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, -1]}],"
    " joints: [{name: slide, type: prismatic, body_i: ground, body_j: cart, at: [0, 0, 0],"
    "           axis: [1, 0, 0]},"
    "          {name: pin, type: revolute, body_i: cart, body_j: bob, at: [0, 0, 0],"
    "           axis: [0, 1, 0]}],"
    " drivers: [{name: push, joint: slide,"
    "            value: \"if(t < 0.3, 0, if(t < 0.5, (t - 0.3)^2, 0.4*(t - 0.5) + 0.04))\"}],"
    " analysis: {type: dynamics, duration: 1}}";

/* A free body under 10 N, from 0.3 s on -20 N. */
static const char switched[] =
    "{se3d: 1, gravity: [0, 0, 0], bodies: [{name: cart, mass: 2, inertia: [1, 1, 1]}],"
    " forces: [{type: force, body: cart, value: [\"if(t < 0.3, 10, -20)\", 0, 0]}],"
    " analysis: {type: dynamics, duration: 1}}";

/* Pushed away by the cube of its distance: infinitely far after a finite time. */
static const char runaway[] =
    "{se3d: 1, gravity: [0, 0, 0],"
    " bodies: [{name: cart, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}],"
    " forces: [{type: tsda, body_i: ground, body_j: cart, h: \"-100*l^3\"}],"
    " analysis: {type: dynamics, duration: 1}}";

/* A block thrown up a slope of 30 degrees at 2 m/s: friction turns when it does. */
static const char thrown[] =
    "{se3d: 1, parameters: {slope: 30*deg}, gravity: [0, 0, -9.81],"
    " bodies: [{name: block, mass: 2, inertia: [1, 1, 1],"
    "           velocity: [-2*cos(slope), 0, 2*sin(slope)]}],"
    " joints: [{name: guide, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0],"
    "           axis: [cos(slope), 0, -sin(slope)]}],"
    " forces: [{type: friction, joint: guide, mu: 0.3, presliding: 1e-8}],"
    " analysis: {type: dynamics, duration: 1}}";

typedef struct result {
    se3d_status status;
    double r[3], v[3]; /* of the body `name` */
} result;

/* `steps` outputs up to t_end. */
static result run(const char *text, const char *name, int32_t method, double tolerance, int steps,
                  double t_end)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    se3d_solver *solver = NULL;
    se3d_body body;
    result out = {.status = SE3D_OK};
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(!se3d_model_read_text(text, strlen(text), "text", NULL, &model, &error));
    se3d_system *system = se3d_model_get_system(model);
    def.analysis = SE3D_ANALYSIS_DYNAMICS;
    def.method = method;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(system, &def, &solver));
    for (int k = 1; k <= steps && out.status >= 0; ++k) {
        out.status = se3d_solver_run(solver, t_end * k / steps);
    }
    CHECK(!se3d_body_find(system, name, &body));
    CHECK(!se3d_body_get_position(system, body, out.r));
    CHECK(!se3d_body_get_velocity(system, body, out.v));
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
    return out;
}

/* (J + m L^2) phi'' = -m L (g sin phi + a cos phi), J = 0.1, m = L = 1, by the classical method of
 * order 4 over pieces with constant a. */
static void swing(double a, double duration, double state[2])
{
    enum { STEPS = 4000 };
    const double h = duration / STEPS;
    for (int k = 0; k < STEPS; ++k) {
        double K[4][2], at[2] = {state[0], state[1]};
        for (int s = 0; s < 4; ++s) {
            double c = s == 2 ? h : 0.5 * h;
            K[s][0] = at[1];
            K[s][1] = -(9.81 * sin(at[0]) + a * cos(at[0])) / 1.1;
            at[0] = state[0] + c * K[s][0];
            at[1] = state[1] + c * K[s][1];
        }
        for (int i = 0; i < 2; ++i) {
            state[i] += h / 6.0 * (K[0][i] + 2.0 * K[1][i] + 2.0 * K[2][i] + K[3][i]);
        }
    }
}

static void drivers_may_jump_in_their_second_derivative(void)
{
    double state[2] = {0.0, 0.0};
    swing(2.0, 0.2, state);
    swing(0.0, 0.5, state);
    for (int k = 0; k < 3; ++k) {
        for (double tolerance = 1e-6; tolerance > 1e-13; tolerance *= 1e-3) {
            for (int steps = 1; steps <= 100; steps += 9) { /* 10, 100: outputs at the jumps */
                result out = run(pushed, "bob", methods[k], tolerance, steps, 1.0);
                CHECK(out.status >= 0);
                CHECK_NEAR(out.r[0], 0.24 + sin(state[0]), 2.0 * tolerance + 1e-11);
                CHECK_NEAR(out.r[2], -cos(state[0]), 2.0 * tolerance + 1e-11);
            }
        }
    }
}

static void loads_may_be_switched(void)
{
    for (int k = 0; k < 3; ++k) {
        for (double tolerance = 1e-6; tolerance > 1e-13; tolerance *= 1e-3) {
            result out = run(switched, "cart", methods[k], tolerance, 10, 1.0);
            CHECK(out.status >= 0);
            CHECK_NEAR(out.v[0], 5.0 * 0.3 - 10.0 * 0.7, 10.0 * tolerance + 1e-10);
            CHECK_NEAR(out.r[0], 2.5 * 0.09 + 1.5 * 0.7 - 5.0 * 0.49, 10.0 * tolerance + 1e-10);
        }
    }
}

static void friction_turns_with_the_motion(void)
{
    const double slope = 3.14159265358979323846 / 6.0;
    const double up = 9.81 * (sin(slope) + 0.3 * cos(slope));
    const double down = 9.81 * (sin(slope) - 0.3 * cos(slope));
    const double v = down * (1.0 - 2.0 / up);
    for (int k = 0; k < 3; ++k) {
        result coarse = run(thrown, "block", methods[k], 1e-6, 1, 1.0);
        result fine = run(thrown, "block", methods[k], 1e-8, 7, 1.0);
        CHECK(coarse.status >= 0 && fine.status >= 0);
        /* the bristles take a moment to turn: sqrt(presliding / acceleration) */
        CHECK_NEAR(hypot(fine.v[0], fine.v[2]), v, 5e-4);
        CHECK_NEAR(coarse.v[0], fine.v[0], 1e-3);
    }
}

static void what_runs_away_is_no_jump(void)
{
    for (int k = 0; k < 3; ++k) {
        result out = run(runaway, "cart", methods[k], 1e-6, 1, 1.0);
        CHECK(out.status < 0);
    }
}

/* A driven rod: what became of it, and the message. */
static se3d_status drive(const char *value, int32_t analysis, int32_t method, int outputs,
                         char message[512], double *time)
{
    char text[600];
    se3d_model *model = NULL;
    se3d_solver *solver = NULL;
    se3d_status status = SE3D_OK;
    se3d_solver_def def = se3d_solver_def_default();
    snprintf(text, sizeof text,
             "{se3d: 1, bodies: [{name: rod, mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0]}],"
             " joints: [{name: pin, type: revolute, body_i: ground, body_j: rod, at: [0, 0, 0],"
             "           axis: [0, 0, 1]}],"
             " drivers: [{name: steady, joint: pin, value: \"%s\"}]}",
             value);
    CHECK(!se3d_model_read_text(text, strlen(text), "text", NULL, &model, NULL));
    se3d_system *system = se3d_model_get_system(model);
    def.analysis = analysis;
    def.method = method;
    def.step = 0.01;
    CHECK(!se3d_solver_create(system, &def, &solver));
    for (int k = 1; k <= outputs && status >= 0; ++k) {
        status = se3d_solver_run(solver, 2.0 * k / outputs);
    }
    snprintf(message, 512, "%s", se3d_system_get_error(system));
    CHECK(!se3d_system_get_time(system, time));
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
    return status;
}

static const struct {
    int32_t analysis, method;
} ways[] = {{SE3D_ANALYSIS_KINEMATICS, 0},
            {SE3D_ANALYSIS_INVERSE_DYNAMICS, 0},
            {SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853},
            {SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GENERALIZED_ALPHA},
            {SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_RATTLE},
            {SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_BDF}};

static void a_prescribed_value_that_jumps_is_named_with_its_time(void)
{
    static const struct {
        const char *value, *said;
    } rows[] = {{"floor(t)", "from 0 to 1 at t = 1 s"},
                {"0.1*mod(t, 0.7)", "from 0.07 to 0 at t = 0.7 s"},
                {"sign(t - 0.5)", "at t = 0.5 s"},
                {"if(t > 0.95, 2, 0)", "from 0 to 2 at t = 0.95 s"},
                {"t + if(t < 1.37, 0, 1e-3)", "from 1.37 to 1.371 at t = 1.37 s"},
                {"sin(5*t) + round(0.4*t)", "at t = 1.25 s"}};
    char message[512];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        for (size_t way = 0; way < sizeof ways / sizeof *ways; ++way) {
            for (int outputs = 1; outputs <= 200; outputs += 199) {
                double time = 0.0;
                CHECK(drive(rows[k].value, ways[way].analysis, ways[way].method, outputs, message,
                            &time) < 0);
                CHECK_CONTAINS(message, "the value of steady.");
                CHECK_CONTAINS(message, rows[k].said);
                CHECK(time < 1.4 && (outputs == 1 || time > 0.45)); /* the last good state */
            }
        }
    }
}

static void steep_and_fast_values_and_whole_turns_are_no_jumps(void)
{
    static const char *const values[] = {
        "tanh(30*(t - 1))", "sin(40*t)",      "mod(3*t, 2*pi)",       "abs(t - 0.3)",
        "max(0, t - 1)^2",  "1e-12*floor(t)", "0.1*abs(t - 0.31)^0.7"};
    char message[512];
    for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
        for (size_t way = 0; way < 2; ++way) {
            double time = 0.0;
            CHECK(drive(values[k], ways[way].analysis, ways[way].method, 20, message, &time) >= 0);
            CHECK_NEAR(time, 2.0, 0.0);
        }
    }
}

int main(void)
{
    RUN(drivers_may_jump_in_their_second_derivative);
    RUN(loads_may_be_switched);
    RUN(friction_turns_with_the_motion);
    RUN(what_runs_away_is_no_jump);
    RUN(a_prescribed_value_that_jumps_is_named_with_its_time);
    RUN(steep_and_fast_values_and_whole_turns_are_no_jumps);
    return check_finish();
}
