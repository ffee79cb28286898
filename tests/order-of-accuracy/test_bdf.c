/* SPDX-License-Identifier: BSD-3-Clause */
/* bdf with steps by the caller: the order that was asked for in positions, velocities and
 * multipliers, at equal steps and at steps that change; and with error control through singular
 * positions, in as many steps as elsewhere. */
#include "support/mechanisms.h"

/* A pendulum of two bars, on a ball joint and a hinge, thrown sideways. */
typedef struct outcome {
    double r[3], v[3], force[3];
} outcome;

static world create_pendulum(se3d_constraint *pin)
{
    world w = world_create();
    const double axis[3] = {0.0, 0.0, 1.0}, feet[2][2] = {{0.0, 0.0}, {1.0, 0.0}};
    const double first[3] = {0.0, 0.0, 0.0}, second[3] = {1.0, 0.0, 0.0};
    const double spin[3] = {0.3, 0.5, -0.2};
    const se3d_body upper = add_bar(&w, "upper", feet[0], 0.0, 1.0, 1.0);
    const se3d_body lower = add_bar(&w, "lower", feet[1], 0.0, 1.0, 1.0);
    *pin = add_joint(&w, se3d_joint_create_spherical, "pin", w.ground, upper, first, axis);
    add_joint(&w, se3d_joint_create_revolute, "elbow", upper, lower, second, axis);
    MUST(&w, se3d_body_set_angular_velocity(w.system, upper, spin));
    return w;
}

/* Lengths of steps in units of h, over and over. */
typedef struct pattern {
    const char *name;
    int count;
    double length[8];
} pattern;

static outcome run_pendulum(int32_t order, int32_t formulation, const pattern *p, double h)
{
    outcome out;
    se3d_constraint pin;
    se3d_body lower;
    world w = create_pendulum(&pin);
    se3d_solver_def def = se3d_solver_def_default();
    double sum = 0.0, torque[3];
    def.method = order > 0 ? SE3D_METHOD_BDF : SE3D_METHOD_DOP853;
    def.order = order;
    def.formulation = formulation;
    def.tolerance = 1e-12;
    MUST(&w, se3d_solver_create(w.system, &def, &w.solver));
    for (int k = 0; k < p->count; ++k) {
        sum += p->length[k];
    }
    const int rounds = order > 0 ? (int)lround(0.8 / (sum * h)) : 0;
    for (int k = 0; k < rounds * p->count; ++k) {
        MUST(&w, se3d_solver_step(w.solver, h * p->length[k % p->count]));
    }
    if (order == 0) {
        MUST(&w, se3d_solver_run(w.solver, 0.8));
    }
    MUST(&w, se3d_body_find(w.system, "lower", &lower));
    MUST(&w, se3d_body_get_position(w.system, lower, out.r));
    MUST(&w, se3d_body_get_velocity(w.system, lower, out.v));
    MUST(&w, se3d_constraint_get_reaction(w.system, pin, out.force, torque));
    world_destroy(&w);
    return out;
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

#define ROUNDING 1e-10 /* of errors, where slopes say nothing */

/* The slope between h and h/2 of each error. */
static void check_order(int32_t order, const pattern *p, double h, double least)
{
    const int32_t formulation = order % 2;
    const outcome truth = run_pendulum(0, formulation, p, 0.0);
    const outcome coarse = run_pendulum(order, formulation, p, h);
    const outcome fine = run_pendulum(order, formulation, p, 0.5 * h);
    const double before[3] = {distance(coarse.r, truth.r), distance(coarse.v, truth.v),
                              distance(coarse.force, truth.force)};
    const double after[3] = {distance(fine.r, truth.r), distance(fine.v, truth.v),
                             distance(fine.force, truth.force)};
    for (int k = 0; k < 3; ++k) {
        const double slope = log2(before[k] / after[k]);
        if (!(slope >= least || after[k] < ROUNDING)) {
            fprintf(stderr, "%s, order %d, part %d: slope %.2f, error %.1e\n", p->name, (int)order,
                    k, slope, after[k]);
        }
        CHECK(slope >= least || after[k] < ROUNDING);
    }
}

static void equal_steps_have_the_order_asked_for(void)
{
    static const pattern equal = {"equal", 1, {1.0}};
    static const double h[] = {0.0, 2e-4, 1e-3, 2e-3, 4e-3, 4e-3};
    for (int32_t order = 1; order <= 5; ++order) {
        check_order(order, &equal, h[order], order - 0.2);
    }
}

static void changing_steps_keep_the_order(void)
{
    static const pattern patterns[] = {
        {"1 : 1.5", 2, {0.8, 1.2}},
        {"1 : 2", 2, {1.0, 2.0}},
        {"1 : 5", 2, {1.0, 5.0}},
        {"random", 8, {1.0, 0.3, 2.1, 1.9, 0.7, 0.7, 3.0, 0.3}},
        {"slowly", 8, {1.0, 1.05, 1.1, 1.15, 1.1, 1.05, 1.0, 0.95}},
    };
    for (size_t k = 0; k < sizeof patterns / sizeof *patterns; ++k) {
        double sum = 0.0;
        for (int j = 0; j < patterns[k].count; ++j) {
            sum += patterns[k].length[j];
        }
        const double round = 0.8 / (sum * 20.0); /* 20 rounds */
        for (int32_t order = 1; order <= 5; ++order) {
            check_order(order, &patterns[k], order < 2 ? 0.2 * round : round, order - 0.5);
        }
    }
}

/* A bar that falls on a spring without damping, which begins where the bar hangs at -1 rad: the
 * acceleration bends there, again and again. */
static double bounce(int32_t method, double tolerance, uint64_t *steps)
{
    static const char *const variables[] = {"t", "angle", "rate"};
    const double foot[2] = {0.0, 0.0}, at[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 1.0};
    world w = world_create();
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver_stats stats;
    se3d_rsda_def spring = se3d_rsda_def_default();
    se3d_function_def law = se3d_function_def_default();
    se3d_force force;
    double angle;
    const se3d_body bar = add_bar(&w, "bar", foot, 0.0, 1.0, 1.0);
    spring.joint = add_joint(&w, se3d_joint_create_revolute, "pin", w.ground, bar, at, axis);
    law.expression = "1e4*min(0, angle + 1)";
    law.variables = variables;
    law.variable_count = 3;
    MUST(&w, se3d_function_create(w.system, &law, &spring.h));
    MUST(&w, se3d_force_create_rsda(w.system, &spring, &force));
    def.method = method;
    def.tolerance = tolerance;
    MUST(&w, se3d_solver_create(w.system, &def, &w.solver));
    MUST(&w, se3d_solver_run(w.solver, 3.0));
    MUST(&w, se3d_joint_get_coordinate(w.system, spring.joint, SE3D_JOINT_COORDINATE_ANGLE, &angle,
                                       NULL, NULL));
    MUST(&w, se3d_solver_get_stats(w.solver, &stats));
    *steps = stats.steps + stats.rejected;
    world_destroy(&w);
    return angle;
}

static void kinks_of_the_acceleration_are_passed(void)
{
    uint64_t steps;
    const double truth = bounce(SE3D_METHOD_DOP853, 1e-11, &steps);
    static const double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10};
    for (size_t k = 0; k < sizeof tolerances / sizeof *tolerances; ++k) {
        CHECK_NEAR(bounce(SE3D_METHOD_BDF, tolerances[k], &steps), truth, 300.0 * tolerances[k]);
        CHECK(steps < 6000);
    }
}

int main(void)
{
    RUN(equal_steps_have_the_order_asked_for);
    RUN(changing_steps_keep_the_order);
    RUN(kinks_of_the_acceleration_are_passed);
    return check_finish();
}
