/* SPDX-License-Identifier: BSD-3-Clause */
/* What rests and what rolls, in many methods: a box on an incline, in equilibrium, a billiard ball.
 */
#include "support/scene.h"

#define K 1e5

/* A box of .2 m and 2 kg (or a ball of that width) at r, turned about y, on a plane that leans. */
static scene begin(int ball, double slope, double mu, const double r[3], const double v[3],
                   se3d_body *body)
{
    const double size[3] = {0.2, 0.2, 0.2}, about_y[3] = {0.0, 1.0, 0.0};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, mu, 0.3, K);
    *body = ball ? scene_ball(&s, 0.1, 2.0, r, v) : scene_box(&s, size, 2.0, r, v);
    scene_turn(&s, *body, about_y, slope);
    scene_floor(&s, slope);
    return s;
}

static void run(scene *s, int32_t analysis, int32_t method, double t)
{
    if (!s->solver) {
        se3d_solver_def def = se3d_solver_def_default();
        def.analysis = analysis;
        def.method = method;
        CHECK(se3d_solver_create(s->system, &def, &s->solver) == SE3D_OK);
    }
    scene_run(s, t);
}

static void a_box_stays_on_an_incline_in_every_method(void)
{
    const double slope = 20.0 * PI / 180.0;
    const double height = 0.1 - 2.0 * G * cos(slope) / (4.0 * K);
    const double r[3] = {height * sin(slope), 0.0, height * cos(slope)};
    for (int32_t method = SE3D_METHOD_GENERALIZED_ALPHA; method <= SE3D_METHOD_VERLET; ++method) {
        double before[3], after[3];
        se3d_body body;
        scene s = begin(0, slope, 0.5, r, scene_zero, &body);
        run(&s, SE3D_ANALYSIS_DYNAMICS, method, 3.0);
        CHECK(se3d_body_get_position(s.system, body, before) == SE3D_OK);
        run(&s, SE3D_ANALYSIS_DYNAMICS, method, 5.0);
        CHECK(se3d_body_get_position(s.system, body, after) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(after[a], before[a], 1e-9);
            CHECK_NEAR(after[a], r[a], 2e-4); /* the friction springs */
        }
        scene_end(&s);
    }
}

/* Sliding without rolling at first: 5/7 of the speed in the end. */
static void a_billiard_ball_rolls_with_five_sevenths_in_every_method(void)
{
    const double r[3] = {0.0, 0.0, 0.1 - 2.0 * G / K}, v0[3] = {1.0, 0.0, 0.0};
    const double arm = r[2] / 0.1;
    for (int32_t method = SE3D_METHOD_GENERALIZED_ALPHA; method <= SE3D_METHOD_VERLET; ++method) {
        double v[3], w[3];
        se3d_body body;
        scene s = begin(1, 0.0, 0.3, r, v0, &body);
        run(&s, SE3D_ANALYSIS_DYNAMICS, method, 0.5);
        CHECK(se3d_body_get_velocity(s.system, body, v) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(s.system, body, w) == SE3D_OK);
        CHECK_NEAR(v[0], 1.0 / (1.0 + 0.4 / (arm * arm)), 2e-4);
        CHECK_NEAR(v[0], w[1] * r[2], 5e-4); /* the spring swings still */
        scene_end(&s);
    }
}

/* Equilibrium finds the overlap that carries the weight. */
static void equilibrium_of_a_ball_finds_the_overlap(void)
{
    const double r[3] = {0.0, 0.0, 0.0999};
    double at[3], force[3], torque[3];
    se3d_body body;
    scene s = begin(1, 0.0, 0.5, r, scene_zero, &body);
    run(&s, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_METHOD_AUTO, 0.0);
    CHECK(se3d_body_get_position(s.system, body, at) == SE3D_OK);
    CHECK(se3d_body_get_contact_wrench(s.system, body, force, torque) == SE3D_OK);
    CHECK_NEAR(at[2], 0.1 - 2.0 * G / K, 1e-9);
    CHECK_NEAR(force[2], 2.0 * G, 1e-6);
    scene_end(&s);
}

static void equilibrium_of_a_box_finds_the_overlap(void)
{
    const double r[3] = {0.0, 0.0, 0.0999};
    double at[3];
    se3d_body body;
    scene s = begin(0, 0.0, 0.5, r, scene_zero, &body);
    run(&s, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_METHOD_AUTO, 0.0);
    CHECK(se3d_body_get_position(s.system, body, at) == SE3D_OK);
    CHECK_NEAR(at[2], 0.1 - 2.0 * G / (4.0 * K), 1e-9);
    scene_end(&s);
}

int main(void)
{
    RUN(a_box_stays_on_an_incline_in_every_method);
    RUN(a_billiard_ball_rolls_with_five_sevenths_in_every_method);
    RUN(equilibrium_of_a_ball_finds_the_overlap);
    RUN(equilibrium_of_a_box_finds_the_overlap);
    return check_finish();
}
