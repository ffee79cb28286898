/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of every joint, coupler, driver and primitive, as the public API evaluates them,
 * against finite differences in both formulations, with functions of time and at states that do
 * not meet the constraints. */
#include "property/test_joint_world.h"

#include "joint/equation.h"

#define ROWS 8

/* A motion through the present state: r, p with constant acceleration a, wdot at t = 0. */
typedef struct motion {
    se3di_frame start;
    double a[3], wdot[3];
} motion;

static void motion_set(world *w, const motion *motions, double t0, double t)
{
    se3di_model *m = &w->system->model;
    for (size_t k = 1; k < m->body_slots.count; ++k) {
        const motion *q = &motions[k];
        double theta[3];
        se3di_frame *frame = &m->frames[k];
        *frame = q->start;
        se3di_add_scaled(t, q->start.v, frame->r);
        se3di_add_scaled(0.5 * t * t, q->a, frame->r);
        se3di_scale(t, q->start.w, theta);
        se3di_add_scaled(0.5 * t * t, q->wdot, theta);
        se3di_quat_rotate(q->start.p, theta, frame->p);
        se3di_frame_update(frame);
    }
    CHECK(se3d_system_set_time(w->system, t0 + t) == SE3D_OK);
}

static void motion_init(world *w, motion *motions)
{
    se3di_model *m = &w->system->model;
    for (size_t k = 1; k < m->body_slots.count; ++k) {
        motions[k].start = m->frames[k];
        world_random(w, motions[k].a, 3, 1.0);
        world_random(w, motions[k].wdot, 3, 1.0);
        memcpy(&m->acceleration[6 * k], motions[k].a, sizeof motions[k].a);
        memcpy(&m->acceleration[6 * k + 3], motions[k].wdot, sizeof motions[k].wdot);
    }
}

static void phi_at(world *w, const motion *motions, se3d_constraint c, double t, double *phi)
{
    motion_set(w, motions, 0.7, t);
    CHECK(se3d_constraint_eval(w->system, c, SE3D_FORMULATION_ROMEGA, phi, NULL, NULL) == SE3D_OK);
}

/* Errors of central differences of Phi with step h: d/dt Phi - (Phi_q qdot - nu), and second. */
static void time_errors(world *w, const motion *motions, se3d_constraint c, double h, size_t rows,
                        const double *rate, const double *acceleration, double error[2])
{
    double phi[3][ROWS];
    for (int k = 0; k < 3; ++k) {
        phi_at(w, motions, c, (k - 1) * h, phi[k]);
    }
    phi_at(w, motions, c, 0.0, phi[1]);
    error[0] = error[1] = 0.0;
    for (size_t r = 0; r < rows; ++r) {
        double first = (phi[2][r] - phi[0][r]) / (2 * h);
        double second = (phi[2][r] - 2 * phi[1][r] + phi[0][r]) / (h * h);
        error[0] = fmax(error[0], fabs(first - rate[r]));
        error[1] = fmax(error[1], fabs(second - acceleration[r]));
    }
}

/* Phi_q qdot - nu and Phi_q qddot - gamma by the public functions. */
static void analytic(world *w, se3d_constraint c, se3d_formulation formulation, size_t rows,
                     double *rate, double *acceleration)
{
    se3di_model *m = &w->system->model;
    size_t bodies, width = formulation == SE3D_FORMULATION_RP ? 4 : 3;
    double nu[ROWS], gamma[ROWS];
    CHECK(se3d_constraint_eval(w->system, c, formulation, NULL, nu, gamma) == SE3D_OK);
    CHECK(se3d_constraint_count_bodies(w->system, c, &bodies) == SE3D_OK);
    for (size_t r = 0; r < rows; ++r) {
        rate[r] = -nu[r];
        acceleration[r] = -gamma[r];
    }
    for (size_t slot = 0; slot < bodies; ++slot) {
        se3d_body body;
        double phi_r[ROWS * 3], phi_rotation[ROWS * 4], pddot[4];
        CHECK(se3d_constraint_get_body(w->system, c, slot, &body) == SE3D_OK);
        CHECK(se3d_constraint_eval_jacobian(w->system, c, formulation, slot, phi_r, phi_rotation) ==
              SE3D_OK);
        uint32_t index = world_index(w, body);
        const se3di_frame *f = &m->frames[index];
        const double *a = &m->acceleration[6 * index];
        se3di_quat_acceleration(f->p, f->w, a + 3, pddot);
        const double *v_rotation = width == 4 ? f->pdot : f->w;
        const double *a_rotation = width == 4 ? pddot : a + 3;
        for (size_t r = 0; r < rows; ++r) {
            rate[r] += se3di_dot(phi_r + 3 * r, f->v);
            acceleration[r] += se3di_dot(phi_r + 3 * r, a);
            for (size_t k = 0; k < width && index > 0; ++k) {
                rate[r] += phi_rotation[width * r + k] * v_rotation[k];
                acceleration[r] += phi_rotation[width * r + k] * a_rotation[k];
            }
        }
    }
}

/* The errors are of second order: halving the step divides them by 4. */
static void check_order(const double coarse[2], const double fine[2], const char *name)
{
    for (int k = 0; k < 2; ++k) {
        double noise = k == 0 ? 1e-11 : 1e-8;
        double ratio = coarse[k] / fine[k];
        int linear = coarse[k] < 100 * noise; /* equations without a third derivative */
        int second_order = linear || (ratio > 3.6 && ratio < 4.4);
        if (!second_order) {
            fprintf(stderr, "%s: derivative %d: errors %g, %g\n", name, k + 1, coarse[k], fine[k]);
        }
        CHECK(second_order);
        CHECK(fine[k] < 0.05);
    }
}

/* What the system calls its violation is the largest of all constraints. */
static void check_violation(world *w)
{
    double violation[3], most[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < se3d_system_count_constraints(w->system); ++k) {
        se3d_constraint c;
        double rate[ROWS], acceleration[ROWS];
        size_t rows;
        CHECK(!se3d_system_get_constraint(w->system, k, &c));
        CHECK(!se3d_constraint_count_equations(w->system, c, &rows));
        analytic(w, c, SE3D_FORMULATION_ROMEGA, rows, rate, acceleration);
        for (size_t r = 0; r < rows; ++r) {
            most[1] = fmax(most[1], fabs(rate[r]));
            most[2] = fmax(most[2], fabs(acceleration[r]));
        }
    }
    CHECK(!se3di_violation_measure(&w->system->model, violation));
    for (int level = 1; level < 3; ++level) {
        CHECK_NEAR(violation[level], most[level], 1e-12 * fmax(1.0, most[level]));
    }
}

static void check_constraint(world *w, se3d_constraint c)
{
    motion motions[WORLD_BODIES + 1];
    double rate[ROWS], acceleration[ROWS], coarse[2], fine[2];
    const char *type;
    size_t rows;
    motion_init(w, motions);
    motion_set(w, motions, 0.7, 0.0);
    CHECK(se3d_constraint_get_type(w->system, c, &type) == SE3D_OK);
    CHECK(se3d_constraint_count_equations(w->system, c, &rows) == SE3D_OK);
    for (int f = 0; f < 2; ++f) {
        se3d_formulation formulation = f ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA;
        motion_set(w, motions, 0.7, 0.0);
        analytic(w, c, formulation, rows, rate, acceleration);
        time_errors(w, motions, c, 4e-3, rows, rate, acceleration, coarse);
        time_errors(w, motions, c, 2e-3, rows, rate, acceleration, fine);
        check_order(coarse, fine, type);
    }
    motion_set(w, motions, 0.7, 0.0);
    check_violation(w);
}

/* The function of time is the given one (at the time of check_constraint, 0.7 s). */
static void check_prescribed(const world *w, se3d_constraint c, double expected)
{
    double f;
    CHECK(se3d_driver_get_value(w->system, c, &f) == SE3D_OK);
    CHECK_NEAR(f, expected, 1e-15);
}

/* A def with nothing aligned: the equations hold nowhere near. */
static se3d_joint_def random_def(world *w, se3d_body body_i, se3d_body body_j)
{
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = body_i;
    def.body_j = body_j;
    world_random(w, def.point_i, 3, 1.0);
    world_random(w, def.point_j, 3, 1.0);
    world_random_unit(w, def.axis_i, 3);
    world_random_unit(w, def.axis_j, 3);
    def.distance = 0.8;
    def.pitch = 0.3;
    def.angle0 = 0.2;
    return def;
}

static void equations_of_every_joint_match_finite_differences(void)
{
    for (size_t k = 0; k < JOINT_CASES; ++k) {
        for (uint64_t trial = 0; trial < 6; ++trial) {
            world w;
            world_init(&w, 31 * (k + 1) + trial);
            se3d_joint_def def = random_def(&w, trial == 1 ? w.ground : w.body[0],
                                            trial == 2 ? w.ground : w.body[1]);
            se3d_constraint joint;
            CHECK(joint_cases[k].create(w.system, &def, &joint) == SE3D_OK);
            check_constraint(&w, joint);
            world_destroy(&w);
        }
    }
}

static void equations_of_drivers_match_finite_differences(void)
{
    for (uint64_t trial = 0; trial < 12; ++trial) {
        world w;
        world_init(&w, 500 + trial);
        se3d_joint_def def = random_def(&w, trial == 1 ? w.ground : w.body[0], w.body[1]);
        se3d_constraint joint, driver;
        CHECK(se3d_joint_create_cylindrical(w.system, &def, &joint) == SE3D_OK);
        se3d_driver_def drive = se3d_driver_def_default();
        drive.joint = joint;
        drive.coordinate = (int32_t)(trial % 2);
        CHECK(se3d_function_create_expression(w.system, "0.3*sin(2*t) + t^3", &drive.function) ==
              SE3D_OK);
        CHECK(se3d_driver_create(w.system, &drive, &driver) == SE3D_OK);
        check_constraint(&w, driver);
        check_prescribed(&w, driver, 0.3 * sin(1.4) + 0.343);
        world_destroy(&w);
    }
}

static void equations_of_primitives_match_finite_differences(void)
{
    for (int32_t type = 0; type < 4; ++type) {
        for (uint64_t trial = 0; trial < 6; ++trial) {
            world w;
            world_init(&w, 600 + 10 * (uint64_t)type + trial);
            se3d_primitive_def def = se3d_primitive_def_default();
            se3d_constraint primitive;
            def.type = type;
            def.body_i = trial == 1 ? w.ground : w.body[2];
            def.body_j = trial == 2 ? w.ground : w.body[1];
            world_random(&w, def.a_i, 3, 2.0);
            world_random(&w, def.a_j, 3, 2.0);
            world_random(&w, def.point_i, 3, 1.0);
            world_random(&w, def.point_j, 3, 1.0);
            world_random(&w, def.c, 3, 2.0);
            CHECK(se3d_function_create_expression(w.system, "1 + 0.5*cos(3*t)", &def.function) ==
                  SE3D_OK);
            CHECK(se3d_primitive_create(w.system, &def, &primitive) == SE3D_OK);
            check_constraint(&w, primitive);
            check_prescribed(&w, primitive, 1.0 + 0.5 * cos(2.1));
            world_destroy(&w);
        }
    }
}

static void equations_of_couplers_match_finite_differences(void)
{
    for (uint64_t trial = 0; trial < 6; ++trial) {
        world w;
        world_init(&w, 700 + trial);
        se3d_constraint pin, slide, gear, rack, coupler;
        se3d_joint_def def = random_def(&w, w.ground, w.body[0]);
        CHECK(se3d_joint_create_revolute(w.system, &def, &pin) == SE3D_OK);
        def = random_def(&w, w.body[0], w.body[1]);
        CHECK(se3d_joint_create_cylindrical(w.system, &def, &slide) == SE3D_OK);
        CHECK(se3d_joint_create_gear(w.system, NULL, pin, slide, 1.7, &gear) == SE3D_OK);
        CHECK(se3d_joint_create_rack_pinion(w.system, NULL, pin, slide, 0.4, &rack) == SE3D_OK);
        se3d_coupler_def couple = se3d_coupler_def_default();
        couple.count = 3;
        couple.joint[0] = pin;
        couple.joint[1] = couple.joint[2] = slide;
        couple.coordinate[2] = SE3D_JOINT_COORDINATE_DISPLACEMENT;
        couple.ratio[0] = 0.9;
        couple.ratio[1] = -1.3;
        couple.ratio[2] = 2.1;
        CHECK(se3d_function_create_expression(w.system, "sin(t)", &couple.function) == SE3D_OK);
        CHECK(se3d_joint_create_coupler(w.system, &couple, &coupler) == SE3D_OK);
        check_constraint(&w, gear);
        check_constraint(&w, rack);
        check_constraint(&w, coupler);
        check_prescribed(&w, coupler, sin(0.7));
        world_destroy(&w);
    }
}

/* Rates and accelerations of joint coordinates along a motion. */
static void coordinate_rates_match_finite_differences(void)
{
    for (uint64_t trial = 0; trial < 8; ++trial) {
        world w;
        world_init(&w, 800 + trial);
        motion motions[WORLD_BODIES + 1];
        se3d_joint_def def = random_def(&w, trial == 1 ? w.ground : w.body[3], w.body[1]);
        se3d_constraint joint;
        se3d_joint_coordinate coordinate = (se3d_joint_coordinate)(trial % 2);
        CHECK(se3d_joint_create_cylindrical(w.system, &def, &joint) == SE3D_OK);
        motion_init(&w, motions);
        double value, rate, acceleration, q[3], coarse[2], fine[2];
        CHECK(se3d_joint_get_coordinate(w.system, joint, coordinate, &value, &rate,
                                        &acceleration) == SE3D_OK);
        for (int pass = 0; pass < 2; ++pass) {
            double h = pass ? 2e-3 : 4e-3;
            for (int k = 0; k < 3; ++k) {
                motion_set(&w, motions, 0.0, (k - 1) * h);
                CHECK(se3d_joint_get_coordinate(w.system, joint, coordinate, &q[k], NULL, NULL) ==
                      SE3D_OK);
            }
            double *error = pass ? fine : coarse;
            error[0] = fabs((q[2] - q[0]) / (2 * h) - rate);
            error[1] = fabs((q[2] - 2 * q[1] + q[0]) / (h * h) - acceleration);
        }
        CHECK_NEAR(q[1], value, 0.0);
        check_order(coarse, fine, "coordinate");
        world_destroy(&w);
    }
}

int main(void)
{
    RUN(equations_of_every_joint_match_finite_differences);
    RUN(equations_of_drivers_match_finite_differences);
    RUN(equations_of_primitives_match_finite_differences);
    RUN(equations_of_couplers_match_finite_differences);
    RUN(coordinate_rates_match_finite_differences);
    return check_finish();
}
