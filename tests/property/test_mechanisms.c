/* SPDX-License-Identifier: BSD-3-Clause */
/* What holds for every mechanism: both formulations agree, energy is conserved, the frame does not
 * matter, and the forces on every body balance its acceleration. */
#include "check.h"
#include "support/models.h"

static const char *const mechanisms[] = {
    "pendulum",        "double_pendulum", "heavy_top",           "four_bar",
    "slider_crank",    "chain_revolute",  "chain_ball",          "driven_double_pendulum",
    "driven_pendulum", "driven_four_bar", "driven_slider_crank",
};
#define MECHANISMS (sizeof mechanisms / sizeof mechanisms[0])

static int is_determined(const char *name)
{
    return strncmp(name, "driven", 6) == 0 && !strstr(name, "double");
}

static int count_of(const char *name)
{
    return strncmp(name, "chain", 5) == 0 ? 5 : 1;
}

static void run_to(const support_model *model, const char *name, int32_t formulation, double step,
                   double t_end)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.analysis = is_determined(name) ? SE3D_ANALYSIS_INVERSE_DYNAMICS : SE3D_ANALYSIS_DYNAMICS;
    def.method = SE3D_METHOD_GENERALIZED_ALPHA;
    def.formulation = formulation;
    def.step = step;
    CHECK(!se3d_solver_create(model->system, &def, &solver));
    se3d_status status = se3d_solver_run(solver, t_end);
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", name, se3d_system_get_error(model->system));
    }
    CHECK(status >= 0);
    se3d_solver_destroy(solver);
}

typedef struct motion {
    double r[3], v[3], w[3], a[3], alpha[3];
} motion;

static motion motion_of(const support_model *model, int body)
{
    motion m;
    CHECK(!se3d_body_get_position(model->system, model->bodies[body], m.r));
    CHECK(!se3d_body_get_velocity(model->system, model->bodies[body], m.v));
    CHECK(!se3d_body_get_angular_velocity(model->system, model->bodies[body], m.w));
    CHECK(!se3d_body_get_acceleration(model->system, model->bodies[body], m.a));
    CHECK(!se3d_body_get_angular_acceleration(model->system, model->bodies[body], m.alpha));
    return m;
}

static double scale_of(const double v[3])
{
    return 1.0 + fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

static void check_same(const double a[3], const double b[3], double tolerance)
{
    for (int c = 0; c < 3; ++c) {
        CHECK_NEAR(a[c], b[c], tolerance * scale_of(b));
    }
}

static void check_same_motion(const motion *a, const motion *b, double tolerance)
{
    check_same(a->r, b->r, tolerance);
    check_same(a->v, b->v, tolerance);
    check_same(a->w, b->w, tolerance);
    check_same(a->a, b->a, 10.0 * tolerance);
    check_same(a->alpha, b->alpha, 10.0 * tolerance);
}

static void check_same_reactions(const support_model *a, const support_model *b, double tolerance)
{
    for (int k = 0; k < a->joint_count; ++k) {
        double force[2][3], torque[2][3];
        CHECK(!se3d_constraint_get_reaction(a->system, a->joints[k], force[0], torque[0]));
        CHECK(!se3d_constraint_get_reaction(b->system, b->joints[k], force[1], torque[1]));
        check_same(force[0], force[1], tolerance);
        /* a torque is the moment of forces on arms of about 1 m, and as accurate as they are */
        for (int c = 0; c < 3; ++c) {
            double scale = fmax(scale_of(force[1]), scale_of(torque[1]));
            CHECK_NEAR(torque[0][c], torque[1][c], tolerance * scale);
        }
    }
}

/* If the drivers determine the motion to rounding, in dynamics to the error of the integrators,
 * which differs. Rows of the two formulations are the same: so are least-norm multipliers. */
static void both_formulations_give_the_same_motion_and_reactions(void)
{
    for (size_t m = 0; m < MECHANISMS; ++m) {
        support_model model[2];
        int exact = is_determined(mechanisms[m]);
        for (int32_t formulation = 0; formulation < 2; ++formulation) {
            support_model_make(&model[formulation], mechanisms[m], count_of(mechanisms[m]));
            run_to(&model[formulation], mechanisms[m], formulation, exact ? 0.01 : 5e-4, 0.2);
        }
        for (int k = 0; k < model[0].body_count; ++k) {
            motion a = motion_of(&model[0], k), b = motion_of(&model[1], k);
            check_same_motion(&a, &b, exact ? 1e-10 : 2e-5);
        }
        check_same_reactions(&model[0], &model[1], exact ? 1e-9 : 2e-3);
        support_model_destroy(&model[0]);
        support_model_destroy(&model[1]);
    }
}

static double energy_of(const support_model *model)
{
    se3d_energy energy;
    CHECK(!se3d_system_get_energy(model->system, &energy));
    CHECK_NEAR(energy.total, energy.kinetic + energy.potential, 1e-9 * (1 + energy.kinetic));
    return energy.total;
}

/* The drift falls with the step at second order. */
static void energy_is_conserved_without_drivers(void)
{
    for (size_t m = 0; m < 7; ++m) {
        for (int32_t formulation = 0; formulation < 2; ++formulation) {
            double drift[2];
            for (int k = 0; k < 2; ++k) {
                support_model model;
                se3d_energy now;
                support_model_make(&model, mechanisms[m], count_of(mechanisms[m]));
                double start = energy_of(&model);
                run_to(&model, mechanisms[m], formulation, k ? 5e-4 : 1e-3, 0.3);
                drift[k] = fabs(energy_of(&model) - start);
                CHECK(!se3d_system_get_energy(model.system, &now));
                CHECK(drift[k] < 1e-4 * (1.0 + now.kinetic));
                support_model_destroy(&model);
            }
            CHECK(drift[1] < 0.4 * drift[0] + 1e-7);
        }
    }
}

static void turn(const double p[4], const double v[3], double out[3])
{
    const double *e = p + 1;
    for (int k = 0; k < 3; ++k) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        out[k] = (2.0 * p[0] * p[0] - 1.0) * v[k] +
                 2.0 * e[k] * (e[0] * v[0] + e[1] * v[1] + e[2] * v[2]) +
                 2.0 * p[0] * (e[a] * v[b] - e[b] * v[a]);
    }
}

/* The whole mechanism turned and moved, gravity included: everything turns with it. */
static void the_frame_does_not_matter(void)
{
    const double p[4] = {0.5, -0.7, 0.1, 0.5}, shift[3] = {3.0, -2.0, 1.5};
    for (size_t m = 0; m < 2 * MECHANISMS; ++m) {
        const char *name = mechanisms[m / 2];
        support_plan plan;
        support_model model[2];
        support_plan_make(&plan, name, count_of(name));
        CHECK(!support_model_create(&model[0], &plan, NULL, 0));
        support_plan_transform(&plan, p, shift);
        CHECK(!support_model_create(&model[1], &plan, NULL, 0));
        support_plan_destroy(&plan);
        for (int k = 0; k < 2; ++k) {
            run_to(&model[k], name, (int32_t)(m % 2), 2e-3, 0.1);
        }
        for (int k = 0; k < model[0].body_count; ++k) {
            motion a = motion_of(&model[0], k), b = motion_of(&model[1], k);
            double r[3], v[3], acceleration[3];
            turn(p, a.r, r);
            turn(p, a.v, v);
            turn(p, a.a, acceleration);
            for (int c = 0; c < 3; ++c) {
                CHECK_NEAR(b.r[c], r[c] + shift[c], 1e-9);
            }
            check_same(b.v, v, 1e-8);
            check_same(b.w, a.w, 1e-8);
            check_same(b.a, acceleration, 1e-5);
        }
        for (int k = 0; k < model[0].joint_count; ++k) {
            double force[2][3], torque[2][3], expected[3];
            for (int s = 0; s < 2; ++s) {
                CHECK(!se3d_constraint_get_reaction(model[s].system, model[s].joints[k], force[s],
                                                    torque[s]));
            }
            turn(p, force[0], expected);
            check_same(force[1], expected, 1e-5);
            turn(p, torque[0], expected);
            check_same(torque[1], expected, 1e-4);
        }
        support_model_destroy(&model[0]);
        support_model_destroy(&model[1]);
    }
}

/* Add what `constraint` does to `body`: force, and torque about its centre of mass. */
static void add_reaction(const support_model *model, se3d_constraint constraint, se3d_body body,
                         const double centre[3], double sum[6])
{
    for (size_t slot = 0; slot < 2; ++slot) {
        se3d_body taking_part;
        double wrench[6];
        CHECK(!se3d_constraint_get_body(model->system, constraint, slot, &taking_part));
        if (taking_part.index1 != body.index1) {
            continue;
        }
        CHECK(!se3d_constraint_get_reaction_at(model->system, constraint, slot, centre,
                                               (se3d_marker){0, 0}, wrench));
        for (int c = 0; c < 6; ++c) {
            sum[c] += wrench[c];
        }
    }
}

static void check_balance(const support_model *model, int body, double tolerance)
{
    double sum[6] = {0.0}, g[3], mass, J[6], p[4], back[3];
    motion m = motion_of(model, body);
    CHECK(!se3d_body_get_mass(model->system, model->bodies[body], &mass, J));
    CHECK(!se3d_body_get_orientation(model->system, model->bodies[body], p));
    CHECK(!se3d_system_get_gravity(model->system, g));
    size_t count = se3d_system_count_constraints(model->system);
    for (size_t k = 0; k < count; ++k) {
        se3d_constraint constraint;
        CHECK(!se3d_system_get_constraint(model->system, k, &constraint));
        add_reaction(model, constraint, model->bodies[body], m.r, sum);
    }
    const double conjugate[4] = {p[0], -p[1], -p[2], -p[3]};
    turn(conjugate, sum + 3, back); /* Euler's equations in the body frame */
    for (int c = 0; c < 3; ++c) {
        int a = (c + 1) % 3, b = (c + 2) % 3;
        double rate = J[c] * m.alpha[c] + m.w[a] * J[b] * m.w[b] - m.w[b] * J[a] * m.w[a];
        CHECK_NEAR(sum[c] + mass * g[c], mass * m.a[c], tolerance * mass * 10.0);
        CHECK_NEAR(back[c], rate, tolerance * mass * 10.0);
    }
}

/* Implicit steps satisfy the velocity level to the error of the step only, p.pdot = 0 too: in r-p,
 * the rate of w then differs from the one of Euler's equations by as much. */
static void forces_on_every_body_balance_its_acceleration(void)
{
    for (size_t m = 0; m < 2 * MECHANISMS; ++m) {
        const char *name = mechanisms[m / 2];
        support_model model;
        support_model_make(&model, name, count_of(name));
        run_to(&model, name, (int32_t)(m % 2), 2e-3, 0.1);
        for (int k = 0; k < model.body_count; ++k) {
            check_balance(&model, k, m % 2 && !is_determined(name) ? 2e-6 : 1e-7);
        }
        support_model_destroy(&model);
    }
}

/* A free body without gravity: momentum and angular momentum, in the ground frame. */
static void free_bodies_keep_their_momentum(void)
{
    for (int32_t formulation = 0; formulation < 2; ++formulation) {
        support_model model = {.body_count = 1};
        se3d_body body;
        se3d_body_def def = se3d_body_def_default();
        const double none[3] = {0.0, 0.0, 0.0}, J[3] = {1.0, 2.0, 2.5}, w[3] = {0.3, 4.0, 0.2};
        memcpy(def.inertia, J, sizeof J);
        memcpy(def.angular_velocity, w, sizeof w);
        def.mass = 3.0;
        def.velocity[0] = 1.0;
        CHECK(!se3d_system_create(NULL, &model.system));
        CHECK(!se3d_system_set_gravity(model.system, none));
        CHECK(!se3d_body_create(model.system, &def, &body));
        model.bodies = &body;
        run_to(&model, "pendulum", formulation, 1e-3, 2.0);
        motion m = motion_of(&model, 0);
        double p[4], before[3], after[3], local[3];
        CHECK(!se3d_body_get_orientation(model.system, body, p));
        for (int c = 0; c < 3; ++c) {
            before[c] = J[c] * w[c];
            local[c] = J[c] * m.w[c];
        }
        turn(p, local, after);
        for (int c = 0; c < 3; ++c) {
            CHECK_NEAR(after[c], before[c], 1e-4);
            CHECK_NEAR(m.v[c], def.velocity[c], 1e-12);
            CHECK_NEAR(m.r[c], 2.0 * def.velocity[c], 1e-11);
        }
        CHECK(fabs(m.w[0] - w[0]) > 0.05); /* it tumbles */
        se3d_system_destroy(model.system);
    }
}

int main(void)
{
    RUN(both_formulations_give_the_same_motion_and_reactions);
    RUN(energy_is_conserved_without_drivers);
    RUN(the_frame_does_not_matter);
    RUN(forces_on_every_body_balance_its_acceleration);
    RUN(free_bodies_keep_their_momentum);
    return check_finish();
}
