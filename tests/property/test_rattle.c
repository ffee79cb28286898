/* SPDX-License-Identifier: BSD-3-Clause */
/* The step that rattle and verlet share: fast rotation, and positions where constraints lose rank.
 */
#include "check.h"
#include "math/quaternion.h"
#include "se3d/se3d.h"
#include "support/world.h"

#define PI 3.14159265358979323846

static const int32_t methods[2] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET};

static se3d_solver *solver_of(se3d_system *system, int32_t method, int rp, double step)
{
    return world_solver(system, SE3D_ANALYSIS_DYNAMICS, method,
                        rp ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA, step);
}

static se3d_body add_top(se3d_system *system, const double w[3])
{
    static const double weightless[3] = {0.0, 0.0, 0.0};
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    def.name = "top";
    def.mass = 1.0;
    for (int k = 0; k < 3; ++k) {
        def.inertia[k] = 1.0 + 0.5 * k;
        def.angular_velocity[k] = w[k];
    }
    CHECK(!se3d_system_set_gravity(system, weightless));
    CHECK(!se3d_body_create(system, &def, &body));
    return body;
}

/* About a principal axis the angle of a step is h w, with and without a pin. */
static void a_body_that_turns_a_radian_a_step_turns_exactly(void)
{
    for (int run = 0; run < 8; ++run) {
        const double w[3] = {0.0, 0.0, 100.0}, angle = 100.0 * 0.37;
        se3d_system *system = NULL;
        double p[4];
        CHECK(!se3d_system_create(NULL, &system));
        se3d_body top = add_top(system, w);
        if (run / 4) {
            se3d_joint_def def = se3d_joint_def_default();
            se3d_constraint pin;
            CHECK(!se3d_system_get_ground(system, &def.body_i));
            def.body_j = top;
            CHECK(!se3d_joint_create_revolute(system, &def, &pin));
        }
        se3d_solver *solver = solver_of(system, methods[run % 2], run / 2 % 2, 0.01);
        CHECK(se3d_solver_run(solver, 0.37) >= 0);
        CHECK(!se3d_body_get_orientation(system, top, p));
        CHECK_NEAR(fabs(p[0] * cos(0.5 * angle) + p[3] * sin(0.5 * angle)), 1.0, 1e-13);
        CHECK_NEAR(p[1] * p[1] + p[2] * p[2], 0.0, 1e-26);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* The momentum in the ground frame is kept to rounding, the energy within a bound that falls with
 * the square of the step and does not grow in time. */
static void a_free_tumbling_top_keeps_momentum_and_energy(void)
{
    const double w[3] = {2.0, 100.0, 3.0}; /* about the middle axis: it tumbles */
    const double steps[3] = {0.001, 0.0005, 0.01}, energy = 0.5 * (4.0 + 1.5e4 + 18.0);
    double worst[3] = {0.0, 0.0, 0.0}, late = 0.0;
    for (int run = 0; run < 3; ++run) {
        const double L0[3] = {2.0, 150.0, 6.0};
        se3d_system *system = NULL;
        CHECK(!se3d_system_create(NULL, &system));
        se3d_body top = add_top(system, w);
        se3d_solver *solver = solver_of(system, SE3D_METHOD_RATTLE, 0, steps[run]);
        for (int k = 1; k <= 400; ++k) {
            double wk[3], p[4], A[9], L[3] = {0.0, 0.0, 0.0}, e = 0.0;
            CHECK(se3d_solver_run(solver, 0.05 * k) >= 0);
            CHECK(!se3d_body_get_angular_velocity(system, top, wk));
            CHECK(!se3d_body_get_orientation(system, top, p));
            se3di_quat_to_matrix(p, A);
            for (int c = 0; c < 3; ++c) {
                e += 0.5 * (1.0 + 0.5 * c) * wk[c] * wk[c] / energy;
                for (int r = 0; r < 3; ++r) {
                    L[r] += A[3 * r + c] * (1.0 + 0.5 * c) * wk[c];
                }
            }
            for (int r = 0; r < 3; ++r) {
                CHECK_NEAR(L[r], L0[r], 150.0 * 1e-11);
            }
            worst[run] = fmax(worst[run], fabs(e - 1.0));
            late = run == 0 && k > 200 ? fmax(late, fabs(e - 1.0)) : late;
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
    CHECK(worst[0] < 2e-3);
    CHECK_NEAR(worst[0] / worst[1], 4.0, 0.2);
    CHECK(late < 1.02 * worst[0]);
}

static void a_step_that_turns_a_body_too_far_names_it(void)
{
    const double w[3] = {0.0, 0.0, 400.0};
    for (int run = 0; run < 4; ++run) {
        se3d_system *system = NULL;
        double now[3];
        CHECK(!se3d_system_create(NULL, &system));
        se3d_body top = add_top(system, w);
        se3d_solver *solver = solver_of(system, methods[run % 2], run / 2, 0.01);
        CHECK(se3d_solver_run(solver, 0.1) == SE3D_ERR_NO_CONVERGENCE);
        CHECK_CONTAINS(se3d_system_get_error(system), "body top turns too far");
        CHECK_CONTAINS(se3d_system_get_error(system), "a step of at most 0.0025 s");
        CHECK(!se3d_body_get_angular_velocity(system, top, now));
        CHECK_NEAR(now[2], 400.0, 1e-12);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

static se3d_body add_link(se3d_system *system, double x, double z, double J)
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    def.mass = J > 1.0 ? 5.0 : 1.0;
    def.inertia[0] = 0.1 * J;
    def.inertia[1] = def.inertia[2] = J;
    def.position[0] = x;
    def.position[2] = z;
    def.angular_velocity[1] = z < 1.0 ? 1.0 : 0.0;
    def.velocity[0] = z;
    CHECK(!se3d_body_create(system, &def, &body));
    return body;
}

static se3d_constraint add_pin(se3d_system *system, se3d_body i, se3d_body j, double x, double z)
{
    const double at[3] = {x, 0.0, z}, axis[3] = {0.0, 1.0, 0.0};
    se3d_constraint pin;
    pin = world_join(system, se3d_joint_create_revolute, NULL, i, j, at, axis);
    return pin;
}

/* Three equal cranks with one coupler, all pins revolute: a pendulum of
 * (3 (J + m/4) + M) theta'' = (3 m/2 + M) g sin theta, flat at 90 and 270 degrees. */
static void three_parallel_cranks_pass_their_flat_positions(void)
{
    for (int run = 0; run < 8; ++run) {
        const double step = run / 4 ? 0.002 : 0.01, inertia = 3.0 * (0.1 + 0.25) + 5.0;
        const double fall = 6.5 * 9.81;
        se3d_system *system = NULL;
        se3d_constraint pins[3];
        se3d_body ground;
        CHECK(!se3d_system_create(NULL, &system));
        CHECK(!se3d_system_get_ground(system, &ground));
        se3d_body coupler = add_link(system, 1.0, 1.0, 2.0);
        for (int k = 0; k < 3; ++k) {
            se3d_body crank = add_link(system, k, 0.5, 0.1);
            pins[k] = add_pin(system, ground, crank, k, 0.0);
            (void)add_pin(system, crank, coupler, k, 1.0);
        }
        se3d_solver *solver = solver_of(system, methods[run % 2], run / 2 % 2, step);
        double angle = 0.0, before = 0.0, rate = 0.0;
        for (int k = 1; k <= 300; ++k) {
            double other, p[4];
            se3d_status status = se3d_solver_run(solver, 0.02 * k);
            CHECK(status >= 0);
            if (status < 0) {
                fprintf(stderr, "t = %g: %s\n", 0.02 * k, se3d_system_get_error(system));
                break;
            }
            CHECK(!se3d_joint_get_coordinate(system, pins[0], SE3D_JOINT_COORDINATE_ANGLE, &angle,
                                             &rate, NULL));
            CHECK(!se3d_joint_get_coordinate(system, pins[2], SE3D_JOINT_COORDINATE_ANGLE, &other,
                                             NULL, NULL));
            CHECK_NEAR(other, angle, 1e-9);
            CHECK(!se3d_body_get_orientation(system, coupler, p));
            CHECK_NEAR(fabs(p[0]), 1.0, 1e-9); /* the coupler only shifts */
            CHECK(angle > before);
            double energy = 0.5 * inertia * rate * rate + fall * (cos(angle) - 1.0);
            CHECK_NEAR(energy, 0.5 * inertia, 1e3 * step * step);
            before = angle;
        }
        CHECK(angle > 4.0 * PI);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* Four-bars of unequal lengths in a row, all flat at once. The steps that order 4 takes there in
 * place of its own are as exact as those. */
static void order_4_passes_flat_windows_to_its_tolerance(void)
{
    static const double foot[4] = {0.0, 0.7, 2.0, 2.4};
    double angle[2] = {0.0, 0.0};
    for (int run = 0; run < 2; ++run) {
        se3d_solver_def def = se3d_solver_def_default();
        se3d_system *system = NULL;
        se3d_solver *solver = NULL;
        se3d_constraint first = {0}, pin;
        se3d_body ground, crank[4];
        CHECK(!se3d_system_create(NULL, &system));
        CHECK(!se3d_system_get_ground(system, &ground));
        for (int k = 0; k < 4; ++k) {
            crank[k] = add_link(system, foot[k], 0.5, 0.1);
            pin = add_pin(system, ground, crank[k], foot[k], 0.0);
            first = k == 0 ? pin : first;
        }
        for (int k = 0; k < 3; ++k) {
            const double middle = 0.5 * (foot[k] + foot[k + 1]);
            const se3d_body bar = add_link(system, middle, 1.0, 0.2 + 0.1 * k);
            (void)add_pin(system, crank[k], bar, foot[k], 1.0);
            (void)add_pin(system, bar, crank[k + 1], foot[k + 1], 1.0);
        }
        def.method = run ? SE3D_METHOD_RATTLE : SE3D_METHOD_DOP853;
        def.order = run ? 4 : 0;
        def.tolerance = run ? 1e-4 : 1e-10;
        def.horizon = 5.0;
        CHECK(!se3d_solver_create(system, &def, &solver));
        CHECK(se3d_solver_run(solver, 5.0) >= 0);
        CHECK(!se3d_joint_get_coordinate(system, first, SE3D_JOINT_COORDINATE_ANGLE, &angle[run],
                                         NULL, NULL));
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
    CHECK_NEAR(angle[1], angle[0], 4e-4);
}

int main(void)
{
    RUN(a_body_that_turns_a_radian_a_step_turns_exactly);
    RUN(a_free_tumbling_top_keeps_momentum_and_energy);
    RUN(a_step_that_turns_a_body_too_far_names_it);
    RUN(three_parallel_cranks_pass_their_flat_positions);
    RUN(order_4_passes_flat_windows_to_its_tolerance);
    return check_finish();
}
