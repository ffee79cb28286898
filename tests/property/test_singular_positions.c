/* SPDX-License-Identifier: BSD-3-Clause */
/* Kinematics that lands on positions where the constraints lose rank: the parallelogram four-bar
 * when it is flat, the slider-crank with equal lengths when the crank is upright. The motion before
 * decides how it goes on: the parallelogram stays one, and velocities and accelerations there are
 * the limits of those on both sides. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/world.h"

#define PI 3.14159265358979323846

typedef struct linkage {
    se3d_system *system;
    se3d_body ground, crank, coupler, last; /* last: rocker or slider */
    se3d_constraint pin, driver;
} linkage;

static se3d_body add_bar(linkage *l, const double a[2], const double b[2])
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    double angle = atan2(b[1] - a[1], b[0] - a[0]);
    def.mass = 2.0;
    def.inertia[0] = 0.1;
    def.inertia[1] = def.inertia[2] = 0.4;
    def.position[0] = 0.5 * (a[0] + b[0]);
    def.position[1] = 0.5 * (a[1] + b[1]);
    def.orientation[0] = cos(0.5 * angle);
    def.orientation[3] = sin(0.5 * angle);
    CHECK(!se3d_body_create(l->system, &def, &body));
    return body;
}

static se3d_constraint add_joint(linkage *l, se3d_body i, se3d_body j, const double at[2],
                                 int slides)
{
    const double point[3] = {at[0], at[1], 0.0};
    const double axis[3] = {slides ? 1.0 : 0.0, 0.0, slides ? 0.0 : 1.0};
    return world_join(l->system, slides ? se3d_joint_create_prismatic : se3d_joint_create_revolute,
                      NULL, i, j, point, axis);
}

/* The crank turns by `text`(t) from `start`. */
static void open_linkage(linkage *l, int slider, double start, const char *text)
{
    const double O[2] = {0.0, 0.0}, A[2] = {cos(start), sin(start)};
    const double B[2] = {slider ? 2.0 * cos(start) : 2.0 + cos(start), slider ? 0.0 : sin(start)};
    const double Q[2] = {slider ? B[0] + 0.5 : 2.0, 0.0};
    CHECK(!se3d_system_create(NULL, &l->system));
    CHECK(!se3d_system_get_ground(l->system, &l->ground));
    l->crank = add_bar(l, O, A);
    l->coupler = add_bar(l, A, B);
    l->last = slider ? add_bar(l, B, Q) : add_bar(l, Q, B);
    l->pin = add_joint(l, l->ground, l->crank, O, 0);
    add_joint(l, l->crank, l->coupler, A, 0);
    add_joint(l, l->coupler, l->last, B, 0);
    add_joint(l, l->ground, l->last, slider ? B : Q, slider);
    se3d_driver_def driver = se3d_driver_def_default();
    driver.joint = l->pin;
    driver.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    CHECK(!se3d_function_create_expression(l->system, text, &driver.function));
    CHECK(!se3d_driver_create(l->system, &driver, &l->driver));
}

static se3d_solver *solver_of(linkage *l, int rp)
{
    return world_solver(l->system, SE3D_ANALYSIS_INVERSE_DYNAMICS, SE3D_METHOD_AUTO,
                        rp ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA, 0.0);
}

/* A failure counts as one and is shown. */
static int run_to(const linkage *l, se3d_solver *solver, double steps, double t)
{
    const se3d_status status = se3d_solver_run(solver, t);
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%g steps a turn, t = %g: %s\n", steps, t,
                se3d_system_get_error(l->system));
    }
    return status >= 0;
}

static void get_motion(const linkage *l, se3d_body body, double r[3], double v[3], double a[3])
{
    CHECK(!se3d_body_get_position(l->system, body, r));
    CHECK(!se3d_body_get_velocity(l->system, body, v));
    CHECK(!se3d_body_get_acceleration(l->system, body, a));
}

/* The coupler of a parallelogram only shifts: its centre turns as the crank's end does. */
static void the_parallelogram_passes_its_flat_positions(void)
{
    static const double counts[] = {12.0, 40.0, 7.0, 360.0};
    for (int run = 0; run < 8; ++run) {
        linkage l;
        double steps = counts[run / 2], rate = PI, worst = 0.0, effort_before = 0.0;
        open_linkage(&l, 0, 0.5 * PI, "pi*t");
        se3d_solver *solver = solver_of(&l, run % 2);
        for (int k = 1; k <= (int)(3.0 * steps); ++k) { /* three turns, flat at t = 1/2, 3/2, ... */
            double t = 2.0 * k / steps, angle = 0.5 * PI + rate * t, r[3], v[3], a[3], w[3], effort;
            if (!run_to(&l, solver, steps, t)) {
                break;
            }
            get_motion(&l, l.coupler, r, v, a);
            CHECK(!se3d_body_get_angular_velocity(l.system, l.last, w));
            CHECK(!se3d_driver_get_effort(l.system, l.driver, &effort));
            CHECK_NEAR(r[0], 1.0 + cos(angle), 1e-10);
            CHECK_NEAR(r[1], sin(angle), 1e-10);
            CHECK_NEAR(v[0], -rate * sin(angle), 1e-8);
            CHECK_NEAR(v[1], rate * cos(angle), 1e-8);
            CHECK_NEAR(w[2], rate, 1e-8);
            CHECK_NEAR(a[0], -rate * rate * cos(angle), 1e-6);
            CHECK_NEAR(a[1], -rate * rate * sin(angle), 1e-6);
            worst = fmax(worst, fabs(effort - effort_before) * (k > 1));
            effort_before = effort;
        }
        CHECK(worst < 1e-3); /* gravity is along z: the turning bars need no effort */
        se3d_solver_destroy(solver);
        se3d_system_destroy(l.system);
    }
}

/* Crank and rod of equal length: the slider is at 2 cos; upright both pins are in one place. */
static void the_slider_crank_of_equal_lengths_passes_upright(void)
{
    static const double counts[] = {12.0, 40.0, 360.0};
    for (int run = 0; run < 6; ++run) {
        linkage l;
        double steps = counts[run / 2];
        open_linkage(&l, 1, PI / 3.0, "pi*t");
        se3d_solver *solver = solver_of(&l, run % 2);
        for (int k = 1; k <= (int)(2.0 * steps); ++k) {
            double t = 2.0 * k / steps, angle = PI / 3.0 + PI * t, r[3], v[3], a[3];
            if (!run_to(&l, solver, steps, t)) {
                break;
            }
            get_motion(&l, l.last, r, v, a);
            CHECK_NEAR(r[0], 0.25 + 2.0 * cos(angle), 1e-10);
            CHECK_NEAR(v[0], -2.0 * PI * sin(angle), 1e-8);
            CHECK_NEAR(a[0], -2.0 * PI * PI * cos(angle), 1e-6);
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(l.system);
    }
}

/* Nothing before the start says how the motion goes on. */
static void a_start_at_a_bifurcation_is_reported_in_both_formulations(void)
{
    for (int run = 0; run < 8; ++run) {
        linkage l;
        int slider = run / 4;
        double start = slider ? 0.5 * PI : run / 2 % 2 ? PI : 0.0;
        open_linkage(&l, slider, start, "pi*t");
        se3d_solver *solver = solver_of(&l, run % 2);
        CHECK(se3d_solver_run(solver, 0.3) == SE3D_ERR_SINGULAR);
        CHECK_CONTAINS(se3d_system_get_error(l.system), "singular position");
        double time = 1.0;
        CHECK(!se3d_system_get_time(l.system, &time));
        CHECK(time == 0.0);
        se3d_solver_destroy(solver);
        se3d_system_destroy(l.system);
    }
}

/* A crank that stops in the flat position and would go on: its rate there is zero, both ways on
 * are smooth to the first order; what is reported must be right or an error. */
static void turning_back_at_a_flat_position_is_right_or_reported(void)
{
    for (int rp = 0; rp < 2; ++rp) {
        linkage l;
        double r[3];
        open_linkage(&l, 0, 0.5 * PI, "pi/2*sin(pi*t)"); /* flat at t = 1/2, then back */
        se3d_solver *solver = solver_of(&l, rp);
        se3d_status status = SE3D_OK;
        for (int k = 1; k <= 20 && status >= 0; ++k) {
            double t = 0.05 * k, angle = 0.5 * PI * (1.0 + sin(PI * t));
            status = se3d_solver_run(solver, t);
            CHECK(status >= 0 || status == SE3D_ERR_SINGULAR);
            if (status >= 0) {
                CHECK(!se3d_body_get_position(l.system, l.coupler, r));
                CHECK_NEAR(r[0], 1.0 + cos(angle), 1e-8);
                CHECK_NEAR(r[1], sin(angle), 1e-8);
            }
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(l.system);
    }
}

int main(void)
{
    RUN(the_parallelogram_passes_its_flat_positions);
    RUN(the_slider_crank_of_equal_lengths_passes_upright);
    RUN(a_start_at_a_bifurcation_is_reported_in_both_formulations);
    RUN(turning_back_at_a_flat_position_is_right_or_reported);
    return check_finish();
}
