/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions that are integrals of rates: closed forms, derivatives, the same bits in any order, and
 * motors that turn at a rate. */
#include "check.h"
#include "se3d/se3d.h"

#include <stdlib.h>

#define PI 3.14159265358979323846

static se3d_system *make_system(void)
{
    se3d_system *system = NULL;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    return system;
}

static se3d_function make(se3d_system *system, const char *rate, double start, double start_time)
{
    se3d_function function = {0, 0};
    se3d_function_def def = se3d_function_def_default();
    def.expression = rate;
    def.integrate = 1;
    def.start = start;
    def.start_time = start_time;
    CHECK(se3d_function_create(system, &def, &function) == SE3D_OK);
    return function;
}

static double at(const se3d_system *system, se3d_function function, double t)
{
    double jet[3] = {0.0, 0.0, 0.0};
    CHECK(se3d_function_eval(system, function, &t, jet) == SE3D_OK);
    return jet[0];
}

static double ramp(double t)
{
    return t <= 1.0 ? 0.0 : t - 1.0;
}

static void integrals_have_their_closed_forms(void)
{
    se3d_system *s = make_system();
    const se3d_function sine = make(s, "2*pi*10*sin(2*pi*10*t)", 1.0, 0.0);
    const se3d_function jump = make(s, "if(t < 1, 0, 1)", 0.0, 0.0);
    const se3d_function kink = make(s, "abs(t - pi/7)", 0.0, 0.0);
    const se3d_function smooth = make(s, "step(t, 0.3, 0, 0.9, 600*2*pi/60)", 0.25, 0.0);
    const se3d_function root = make(s, "sqrt(t)", 0.0, 0.0);
    const se3d_function later = make(s, "3*t^2", 1.0, 2.0);
    const se3d_function pulse = make(s, "if(abs(t - 2.2) < 2e-3, 1, 0)", 0.0, 0.0);
    for (double t = -1.5; t < 300.0; t = t < 4.0 ? t + 0.0937 : t * 1.9) {
        CHECK_NEAR(at(s, sine, t), 2.0 - cos(2.0 * PI * 10.0 * t), 1e-13 * (1.0 + 60.0 * fabs(t)));
        CHECK_NEAR(at(s, jump, t), ramp(t), 2e-15 * (1.0 + fabs(t)));
        const double u = t - PI / 7.0, u0 = PI / 7.0;
        CHECK_NEAR(at(s, kink, t), 0.5 * u * fabs(u) + 0.5 * u0 * u0, 1e-15 * (1.0 + t * t));
        if (t >= 0.9) {
            CHECK_NEAR(at(s, smooth, t), 0.25 + 20.0 * PI * (0.3 + (t - 0.9)), 2e-13 * (1.0 + t));
        }
        if (t >= 0.0) {
            se3d_status status;
            double jet[3];
            status = se3d_function_eval(s, root, &t, jet);
            CHECK(status == SE3D_OK || t <= 0.0);
            CHECK_NEAR(jet[0], 2.0 / 3.0 * t * sqrt(t), 1e-14 * (1.0 + jet[0]));
        }
        CHECK_NEAR(at(s, later, t), 1.0 + t * t * t - 8.0, 4e-15 * (8.0 + fabs(t * t * t)));
        if (t > 2.21) {
            CHECK_NEAR(at(s, pulse, t), 4e-3, 1e-15);
        }
    }
    se3d_system_destroy(s);
}

/* Of a spline, as of Simpson's rule, which is exact for cubics, and of the lines outside. */
static void splines_are_integrated_piece_by_piece(void)
{
    static const double x[] = {-1.0, 0.25, 0.5, 2.0, 3.5};
    static const double y[] = {2.0, -1.0, 4.0, 0.5, 1.5};
    se3d_system *s = make_system();
    se3d_function_def def = se3d_function_def_default();
    se3d_function rate = {0, 0}, integral = {0, 0};
    def.table_x = x;
    def.table_y = y;
    def.table_count = 5;
    CHECK(se3d_function_create(s, &def, &rate) == SE3D_OK);
    def.integrate = 1;
    def.start = 0.75;
    def.start_time = 0.1;
    CHECK(se3d_function_create(s, &def, &integral) == SE3D_OK);
    double sum = 0.75, before = 0.1;
    for (double t = 0.1; t < 5.0; t += 0.05) { /* the knots are among the times */
        const double middle = 0.5 * (before + t);
        sum +=
            (t - before) / 6.0 * (at(s, rate, before) + 4.0 * at(s, rate, middle) + at(s, rate, t));
        CHECK_NEAR(at(s, integral, t), sum, 3e-14);
        before = t;
    }
    sum = 0.75;
    before = 0.1;
    for (double t = 0.1; t > -2.0; t -= 0.05) {
        const double middle = 0.5 * (before + t);
        sum +=
            (t - before) / 6.0 * (at(s, rate, before) + 4.0 * at(s, rate, middle) + at(s, rate, t));
        CHECK_NEAR(at(s, integral, t), sum, 3e-14);
        before = t;
    }
    se3d_system_destroy(s);
}

static void rate_and_acceleration_are_those_of_the_rate(void)
{
    se3d_system *s = make_system();
    const se3d_function rate_of = make(s, "t*cos(3*t) + exp(-t)", 0.5, 0.0);
    se3d_function rate = {0, 0};
    CHECK(se3d_function_create_expression(s, "t*cos(3*t) + exp(-t)", &rate) == SE3D_OK);
    for (double t = -0.7; t < 3.0; t += 0.31) {
        double jet[3], of_rate[3];
        double error[2];
        CHECK(se3d_function_eval(s, rate_of, &t, jet) == SE3D_OK);
        CHECK(se3d_function_eval(s, rate, &t, of_rate) == SE3D_OK);
        CHECK(memcmp(&jet[1], of_rate, 2 * sizeof(double)) == 0);
        for (int k = 0; k < 2; ++k) {
            const double h = k ? 5e-3 : 1e-2;
            error[k] = (at(s, rate_of, t + h) - at(s, rate_of, t - h)) / (2.0 * h) - jet[1];
        }
        CHECK(fabs(error[0]) > 1e-9);
        CHECK_NEAR(error[0] / error[1], 4.0, 0.05);
    }
    se3d_system_destroy(s);
}

/* A run remembers sums over panels: what it remembers changes no bit. */
static void the_value_does_not_depend_on_what_was_asked_before(void)
{
    se3d_system *s = make_system();
    se3d_body body = {0, 0};
    se3d_constraint pin = {0, 0}, motor = {0, 0};
    se3d_body_def bar = se3d_body_def_default();
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_driver_def driver = se3d_driver_def_default();
    const double point[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 1.0};
    bar.mass = 2.0;
    bar.inertia[0] = bar.inertia[1] = bar.inertia[2] = 0.3;
    CHECK(se3d_body_create(s, &bar, &body) == SE3D_OK);
    CHECK(se3d_system_get_ground(s, &joint.body_i) == SE3D_OK);
    joint.body_j = body;
    CHECK(se3d_joint_def_set_frame(s, &joint, point, axis, NULL) >= 0);
    CHECK(se3d_joint_create_revolute(s, &joint, &pin) == SE3D_OK);
    driver.joint = pin;
    driver.function = make(s, "if(t < 0.4, 20*t, 8) + sin(50*t)", 0.3, 0.0);
    CHECK(se3d_driver_create(s, &driver, &motor) == SE3D_OK);
    double fresh[40];
    for (int k = 0; k < 40; ++k) {
        fresh[k] = at(s, driver.function, 0.05 * k + 1e-3);
    }
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.analysis = SE3D_ANALYSIS_DYNAMICS;
    CHECK(se3d_solver_create(s, &def, &solver) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 2.0) >= 0);
    double angle, rate, acceleration;
    CHECK(se3d_joint_get_coordinate(s, pin, SE3D_JOINT_COORDINATE_ANGLE, &angle, &rate,
                                    &acceleration) == SE3D_OK);
    CHECK_NEAR(angle, 0.3 + 1.6 + 8.0 * 1.6 + (1.0 - cos(100.0)) / 50.0, 1e-11);
    CHECK_NEAR(rate, 8.0 + sin(100.0), 1e-11);
    CHECK_NEAR(acceleration, 50.0 * cos(100.0), 1e-9);
    se3d_system *copy = NULL;
    CHECK(se3d_system_clone(s, &copy) == SE3D_OK);
    for (int k = 39; k >= 0; --k) {
        const double kept = at(s, driver.function, 0.05 * k + 1e-3);
        const double again = at(copy, driver.function, 0.05 * k + 1e-3);
        CHECK(memcmp(&kept, &fresh[k], sizeof kept) == 0);
        CHECK(memcmp(&again, &fresh[k], sizeof again) == 0);
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(copy);
    se3d_system_destroy(s);
}

static void a_constant_rate_may_be_set_and_goes_on_from_where_it_is(void)
{
    se3d_system *s = make_system();
    se3d_function_def def = se3d_function_def_default();
    se3d_function function = {0, 0};
    def.integrate = 1;
    def.constant = 62.8;
    def.start = -1.0;
    CHECK(se3d_function_create(s, &def, &function) == SE3D_OK);
    CHECK_NEAR(at(s, function, 0.5), 30.4, 1e-14);
    CHECK(se3d_system_set_time(s, 0.5) == SE3D_OK);
    CHECK(se3d_function_set_constant(s, function, -10.0) == SE3D_OK);
    CHECK_NEAR(at(s, function, 0.5), 30.4, 1e-14);
    CHECK_NEAR(at(s, function, 1.5), 20.4, 1e-13);
    se3d_system_destroy(s);
}

static double not_everywhere(double t)
{
    return t < 1.0 ? 1.0 : (double)NAN;
}

static se3d_status call(void *ctx, const double *x, double jet[3], double *gradient)
{
    (void)gradient;
    ++*(int *)ctx;
    jet[0] = not_everywhere(x[0]);
    jet[1] = jet[2] = 0.0;
    return SE3D_OK;
}

static void what_cannot_be_integrated_is_refused(void)
{
    static const char *const two[] = {"t", "q"};
    se3d_system *s = make_system();
    se3d_function_def def = se3d_function_def_default();
    se3d_function function = {1, 1};
    int calls = 0;
    double jet[3], t = 0.5;
    def.expression = "t*q";
    def.variables = two;
    def.variable_count = 2;
    def.integrate = 1;
    CHECK(se3d_function_create(s, &def, &function) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(s), "must have one, the time");
    def = se3d_function_def_default();
    def.integrate = 2;
    CHECK(se3d_function_create(s, &def, &function) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(strcmp(se3d_system_get_error_field(s), "integrate") == 0);
    def.integrate = 1;
    def.start = (double)INFINITY;
    CHECK(se3d_function_create(s, &def, &function) == SE3D_ERR_INVALID_ARGUMENT);
    def.start = 0.0;
    def.callback = call;
    def.ctx = &calls;
    CHECK(se3d_function_create(s, &def, &function) == SE3D_OK);
    CHECK(se3d_function_eval(s, function, &t, jet) == SE3D_OK);
    CHECK_NEAR(jet[0], 0.5, 1e-15);
    CHECK(calls > 1);
    t = 1.5;
    CHECK(se3d_function_eval(s, function, &t, jet) == SE3D_ERR_NOT_FINITE);
    t = 1e300;
    const se3d_function far = make(s, "cos(t)", 0.0, 0.0);
    CHECK(se3d_function_eval(s, far, &t, jet) == SE3D_ERR_NOT_FINITE);
    const se3d_function steep = make(s, "mod(1e9*t, 1)", 0.0, 0.0); /* noise: some digits, soon */
    t = 0.5;
    CHECK(se3d_function_eval(s, steep, &t, jet) == SE3D_OK);
    CHECK_NEAR(jet[0], 0.25, 1e-2);
    se3d_system_destroy(s);
}

int main(void)
{
    RUN(integrals_have_their_closed_forms);
    RUN(splines_are_integrated_piece_by_piece);
    RUN(rate_and_acceleration_are_those_of_the_rate);
    RUN(the_value_does_not_depend_on_what_was_asked_before);
    RUN(a_constant_rate_may_be_set_and_goes_on_from_where_it_is);
    RUN(what_cannot_be_integrated_is_refused);
    return check_finish();
}
