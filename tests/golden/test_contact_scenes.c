/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of balls, free, touching and hung up, against closed forms and a chain of springs. */
#include "support/scene.h"
#include "support/world.h"

/* Three equal balls with gaps, the first at 1 m/s: each blow passes on (1 + e)/2 of the speed. */
static void a_row_of_balls_passes_the_blow_on(void)
{
    const double e = 0.9;
    const double expected[3] = {0.5 * (1 - e), 0.25 * (1 - e * e), 0.25 * (1 + e) * (1 + e)};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, e, 1e5);
    se3d_body balls[3];
    CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
    for (int k = 0; k < 3; ++k) {
        const double r[3] = {0.11 * k, 0.0, 0.0}, v[3] = {k == 0 ? 1.0 : 0.0, 0.0, 0.0};
        balls[k] = scene_ball(&s, 0.05, 0.5, r, v);
    }
    scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    scene_run(&s, 0.1);
    for (int k = 0; k < 3; ++k) {
        double v[3] = {0.0};
        CHECK(se3d_body_get_velocity(s.system, balls[k], v) == SE3D_OK);
        CHECK_NEAR(v[0], expected[k], 1e-3);
    }
    scene_end(&s);
}

static const int32_t methods[3] = {SE3D_METHOD_VERLET, SE3D_METHOD_DOP853,
                                   SE3D_METHOD_GENERALIZED_ALPHA};

#define CHAIN 5

static void chain_rate(double stiffness, const double x[CHAIN], double a[CHAIN])
{
    for (int k = 0; k < CHAIN; ++k) {
        const double left = k > 0 ? fmax(0.0, x[k - 1] - x[k]) : 0.0;
        const double right = k < CHAIN - 1 ? fmax(0.0, x[k] - x[k + 1]) : 0.0;
        a[k] = stiffness * (pow(left, 1.5) - pow(right, 1.5));
    }
}

/* Displacements under (K/m) overlap^1.5 between neighbours, by small leapfrog steps. */
static void run_chain(double stiffness, double t, double v[CHAIN])
{
    double x[CHAIN] = {0.0}, a[CHAIN];
    const int steps = 200000;
    const double h = t / steps;
    for (int n = 0; n < steps; ++n) {
        for (int k = 0; k < CHAIN; ++k) {
            x[k] += 0.5 * h * v[k];
        }
        chain_rate(stiffness, x, a);
        for (int k = 0; k < CHAIN; ++k) {
            v[k] += h * a[k];
            x[k] += 0.5 * h * v[k];
        }
    }
}

/* Newton's cradle with Hertz's law: the last ball leaves fastest, the others spread behind it. */
static void touching_balls_pass_a_blow_on_as_a_chain_does(void)
{
    const double R = 0.05, m = 0.5, K = 4.0 / 3.0 * 1e7 / (2.0 * 0.91) * sqrt(0.5 * R);
    double expected[CHAIN] = {1.0};
    run_chain(K / m, 0.1, expected);
    CHECK(expected[CHAIN - 1] > 0.95);
    for (int n = 0; n < 6; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HERTZ_MINDLIN, 0.0, 1.0, 1e5);
        se3d_body balls[CHAIN];
        double sum = 0.0, square = 0.0, before = -1.0;
        CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
        for (int k = 0; k < CHAIN; ++k) {
            const double r[3] = {2.0 * R * k, 0.0, 0.0}, v[3] = {k == 0 ? 1.0 : 0.0, 0.0, 0.0};
            balls[k] = scene_ball(&s, R, m, r, v);
        }
        scene_solve(&s, methods[n % 3], n / 3, 0.0, 1e-7);
        scene_run(&s, 0.1);
        for (int k = 0; k < CHAIN; ++k) {
            double v[3] = {0.0};
            CHECK(se3d_body_get_velocity(s.system, balls[k], v) == SE3D_OK);
            CHECK_NEAR(v[0], expected[k], 2e-3);
            CHECK(v[0] > before);
            before = v[0];
            sum += v[0];
            square += v[0] * v[0];
        }
        CHECK_NEAR(sum, 1.0, 1e-9);
        CHECK_NEAR(square, 1.0, 1e-3);
        scene_end(&s);
    }
}

/* A ball of radius R fixed to a light rod of 1 m that turns about y at (x, 0, 0). */
static se3d_body pendulum(scene *s, double x, double angle, double R)
{
    const double r[3] = {x - sin(angle), 0.0, -cos(angle)}, axis[3] = {0.0, 1.0, 0.0};
    const double at[3] = {x, 0.0, 0.0};
    se3d_body ball = scene_ball(s, R, 1.0, r, scene_zero);
    scene_turn(s, ball, axis, angle);
    (void)world_join(s->system, se3d_joint_create_revolute, NULL, scene_ground(s), ball, at, axis);
    return ball;
}

/* Two pendulums: the second one rises with ((1 + e)/2)^2 of the height of the first. */
static void a_hung_ball_passes_its_height_on(void)
{
    const double R = 0.05, e = 0.8, angle = 0.5;
    const double rise = 0.25 * (1.0 + e) * (1.0 + e) * (1.0 - cos(angle));
    for (int n = 0; n < 6; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.0, e, 1e5);
        double r[3], highest = -1.0;
        (void)pendulum(&s, 0.0, angle, R);
        se3d_body second = pendulum(&s, 2.0 * R + 1e-6, 0.0, R);
        scene_solve(&s, methods[n % 3], n / 3, 0.0, 1e-7);
        for (int step = 0; step <= 50; ++step) { /* to the half swing of the second */
            scene_run(&s, 0.8 + 0.01 * step);
            CHECK(se3d_body_get_position(s.system, second, r) == SE3D_OK);
            highest = fmax(highest, r[2]);
        }
        CHECK_NEAR((highest + 1.0) / rise, 1.0, 4e-3);
        scene_end(&s);
    }
}

int main(void)
{
    RUN(touching_balls_pass_a_blow_on_as_a_chain_does);
    RUN(a_hung_ball_passes_its_height_on);
    RUN(a_row_of_balls_passes_the_blow_on);
    return check_finish();
}
