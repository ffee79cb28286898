/* SPDX-License-Identifier: BSD-3-Clause */
/* What rolls, in closed form: a ball on a turntable, in a gutter and in a loop, a disk that keeps
 * its tilt, a cart. In an explicit method with a given step, one with control of the error and an
 * implicit one, in both formulations. */
#include "support/scene_choices.h"
#include "support/world.h"

/* A disk that a driver turns about the vertical with `speed`, with a plane on it. */
static void turntable(scene *s, double speed)
{
    const double J[3] = {1.0, 1.0, 1.0};
    se3d_body table = scene_body(s, 10.0, J, scene_zero, scene_zero);
    const double spin[3] = {0.0, 0.0, speed};
    CHECK(se3d_body_set_angular_velocity(s->system, table, spin) == SE3D_OK);
    se3d_shape_def top = scene_shape(s, table);
    se3d_shape shape;
    CHECK(se3d_shape_create_plane(s->system, &top, &shape) == SE3D_OK);
    se3d_joint_def pin = se3d_joint_def_default();
    se3d_constraint joint, motor;
    pin.body_i = scene_ground(s);
    pin.body_j = table;
    CHECK(se3d_joint_create_revolute(s->system, &pin, &joint) == SE3D_OK);
    char text[60];
    se3d_driver_def drive = se3d_driver_def_default();
    snprintf(text, sizeof text, "%.17g * t", speed);
    CHECK(se3d_function_create_expression(s->system, text, &drive.function) == SE3D_OK);
    drive.joint = joint;
    CHECK(se3d_driver_create(s->system, &drive, &motor) == SE3D_OK);
}

/* Without slip, v = Omega z x r + R w x z, and the friction m v' turns the ball: with arm R and
 * inertia 2/5 m R^2, v' = 2/7 Omega z x v. The centre goes round a circle wherever it is. */
static void a_ball_on_a_turntable_goes_round_a_circle(void)
{
    const double R = 0.1, m = 0.5, k = 1e6, speed = 7.0 * PI, a = 0.3, v0 = 0.5;
    const double arm = R - m * G / k;
    const double rate = speed / (1.0 + arm * arm / (0.4 * R * R)); /* 2/7 Omega */
    for (size_t n = 0; n < CHOICES; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.3, k);
        const double r[3] = {a, 0.0, arm}, v[3] = {0.0, v0, 0.0};
        const double w[3] = {(speed * a - v0) / arm, 0.0, 0.0};
        double at[3], now[3];
        turntable(&s, speed);
        se3d_body ball = scene_ball(&s, R, m, r, v);
        CHECK(se3d_body_set_angular_velocity(s.system, ball, w) == SE3D_OK);
        scene_solve(&s, choices[n].method, choices[n].formulation, 0.0, 1e-7);
        for (int quarter = 1; quarter <= 4; ++quarter) {
            const double t = 0.25 * quarter, phase = rate * t;
            scene_run(&s, t);
            CHECK(se3d_body_get_position(s.system, ball, at) == SE3D_OK);
            CHECK(se3d_body_get_velocity(s.system, ball, now) == SE3D_OK);
            CHECK_NEAR(at[0], a - v0 / rate * (1.0 - cos(phase)), 2e-4);
            CHECK_NEAR(at[1], v0 / rate * sin(phase), 2e-4);
            CHECK_NEAR(now[0], -v0 * sin(phase), 2e-3);
            CHECK_NEAR(now[1], v0 * cos(phase), 2e-3);
        }
        scene_end(&s);
    }
}

#define STRIPS       360
#define MESH_CHOICES 3 /* one for each method */

/* A gutter along y about the axis z = 0 of radius `radius`, from -turn to turn about the lowest
 * line: so many plane strips, at whose edges a ball that rolls loses a little. */
static void gutter(scene *s, double radius, double turn, uint32_t strips)
{
    static double points[6 * (STRIPS + 1)];
    static uint32_t faces[6 * STRIPS];
    for (uint32_t k = 0; k <= strips; ++k) {
        double angle = turn * (2.0 * k / strips - 1.0);
        for (uint32_t side = 0; side < 2; ++side) {
            double *p = points + 6 * k + 3 * side;
            p[0] = radius * sin(angle);
            p[1] = side ? 0.3 : -0.3;
            p[2] = -radius * cos(angle);
        }
    }
    for (uint32_t k = 0; k < strips; ++k) {
        const uint32_t two[6] = {2 * k, 2 * k + 2, 2 * k + 1, 2 * k + 1, 2 * k + 2, 2 * k + 3};
        memcpy(faces + 6 * k, two, sizeof two);
    }
    scene_mesh_on(s, scene_ground(s), points, 2 * (strips + 1), faces, 2 * strips);
}

/* Rolling, a pendulum of length R - r with 7/5 of its inertia. */
static void a_ball_swings_in_a_gutter(void)
{
    const double R = 1.0, r = 0.1, m = 2.0, k = 5e4, start = 0.1;
    const double length = R - r + m * G / k;
    const double period = 2.0 * PI * sqrt(7.0 * length / (5.0 * G)) * (1.0 + start * start / 16.0);
    for (size_t n = 0; n < MESH_CHOICES; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.2, k);
        const double at0[3] = {length * sin(start), 0.0, -length * cos(start)};
        double at[3];
        gutter(&s, R, 0.4, 180);
        se3d_body ball = scene_ball(&s, r, m, at0, scene_zero);
        scene_solve(&s, choices[n].method, choices[n].formulation, 0.0, 1e-6);
        scene_run(&s, 0.25 * period);
        CHECK(se3d_body_get_position(s.system, ball, at) == SE3D_OK);
        CHECK_NEAR(at[0], 0.0, 0.005 * start);
        scene_run(&s, 0.5 * period);
        CHECK(se3d_body_get_position(s.system, ball, at) == SE3D_OK);
        CHECK_NEAR(at[0], -at0[0], 0.01 * start);
        CHECK_NEAR(at[1], 0.0, 1e-6);
        scene_end(&s);
    }
}

/* Rolling up a loop, v^2 7/10 + g z is kept: at the top, z = 2 rho, v^2 = v0^2 - 20/7 g rho. The
 * ball stays on where v^2 >= g rho there, v0^2 >= 27/7 g rho. */
static void a_ball_passes_a_loop_if_it_is_fast_enough(void)
{
    const double R = 0.5, r = 0.05, m = 0.2, k = 3e4;
    const double rho = R - r;
    for (size_t n = 0; n < 2 * MESH_CHOICES; ++n) {
        const int passes = n % 2 == 0;
        const double v0 = sqrt((passes ? 1.06 : 0.92) * 27.0 / 7.0 * G * rho);
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 1.5, 0.2, k);
        const double at0[3] = {0.0, 0.0, -rho}, v[3] = {v0, 0.0, 0.0};
        const double w[3] = {0.0, v0 / r, 0.0};
        double at[3], now[3], top = 0.0, least = HUGE_VAL;
        gutter(&s, R, PI, passes ? STRIPS : STRIPS / 2);
        se3d_body ball = scene_ball(&s, r, m, at0, v);
        CHECK(se3d_body_set_angular_velocity(s.system, ball, w) == SE3D_OK);
        scene_solve(&s, choices[n / 2].method, choices[n / 2].formulation, 0.0, 1e-6);
        for (int step = 1; step <= 120 && top >= 0.0; ++step) {
            scene_run(&s, 0.005 * step);
            CHECK(se3d_body_get_position(s.system, ball, at) == SE3D_OK);
            CHECK(se3d_body_get_velocity(s.system, ball, now) == SE3D_OK);
            least = fmin(least, hypot(at[0], at[2]));
            if (at[2] > 0.0 && at[0] < 0.0) { /* beyond the top, or fallen from it */
                top = hypot(now[0], now[2]);
                break;
            }
        }
        CHECK((least > 0.999 * rho) == passes);
        if (passes) {
            CHECK_NEAR(0.7 * top * top + G * (at[2] + rho), 0.7 * v0 * v0, 0.01 * v0 * v0);
        }
        scene_end(&s);
    }
}

/* A disk of radius R and height h that rolls on its lower rim, tilted by `tilt`, with its centre at
 * rest: the rim point d = R e1 - h/2 e3 from the centre is at rest too, so w is along d, and turns
 * about the vertical with Omega. The torque d x m g z turns the angular momentum:
 *
 *     Omega^2 sin(tilt) (Jt cos(tilt) - Ja h/(2 R) sin(tilt)) = m g (R cos(tilt) - h/2 sin(tilt))
 */
static void a_disk_rolls_on_its_rim_about_a_centre_at_rest(void)
{
    const double R = 0.1, h = 0.02, m = 0.4, k = 1e6, tilt = 0.4, sink = m * G / k;
    const double Ja = 0.5 * m * R * R, Jt = m * (3.0 * R * R + h * h) / 12.0;
    const double c = cos(tilt), q = sin(tilt);
    const double rate =
        sqrt(m * G * (R * c - 0.5 * h * q) / (q * (Jt * c - Ja * h / (2.0 * R) * q)));
    for (size_t n = 0; n < CHOICES; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.3, k);
        /* turned about y: e1 = x of the body looks down, e3 leans to +x */
        const double r[3] = {0.0, 0.0, R * q + 0.5 * h * c - sink};
        const double w[3] = {-rate * q, 0.0, 0.5 * h * rate * q / R};
        double at[3], p[4];
        const se3d_body disk = scene_disk(&s, m, R, h, r, tilt, w);
        scene_floor(&s, 0.0);
        scene_solve(&s, choices[n].method, choices[n].formulation, 0.0, 1e-7);
        for (int step = 1; step <= 4; ++step) {
            const double t = 0.05 * step;
            scene_run(&s, t);
            CHECK(se3d_body_get_position(s.system, disk, at) == SE3D_OK);
            CHECK(se3d_body_get_orientation(s.system, disk, p) == SE3D_OK);
            const double axis[3] = {2.0 * (p[1] * p[3] + p[0] * p[2]),
                                    2.0 * (p[2] * p[3] - p[0] * p[1]),
                                    1.0 - 2.0 * (p[1] * p[1] + p[2] * p[2])};
            CHECK_NEAR(at[0], 0.0, 1e-4);
            CHECK_NEAR(at[1], 0.0, 1e-4);
            CHECK_NEAR(at[2], r[2], 1e-4);
            CHECK_NEAR(axis[0], q * cos(rate * t), 0.01);
            CHECK_NEAR(axis[1], q * sin(rate * t), 0.01);
            CHECK_NEAR(axis[2], c, 0.002);
        }
        scene_end(&s);
    }
}

/* A frame on four wheels in bearings rolls down with g sin (m + 4 mw) / (m + 4 mw + 4 J/R^2). */
static void a_cart_rolls_down_a_slope(void)
{
    const double R = 0.1, mw = 1.0, m = 10.0, k = 1e6, slope = 0.15;
    const double sink = (m + 4.0 * mw) * G * cos(slope) / 4.0 / k;
    const double all = m + 4.0 * mw, turning = 4.0 * 0.4 * mw * R * R / ((R - sink) * (R - sink));
    const double along[3] = {cos(slope), 0.0, -sin(slope)}, up[3] = {sin(slope), 0.0, cos(slope)};
    const double about_y[3] = {0.0, 1.0, 0.0};
    for (size_t n = 0; n < CHOICES; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.2, k);
        const double size[3] = {0.8, 0.2, 0.1};
        double r[3], v0[3], v1[3], gained = 0.0;
        for (int a = 0; a < 3; ++a) {
            r[a] = (R - sink) * up[a];
        }
        se3d_body frame = scene_box(&s, size, m, r, scene_zero);
        scene_turn(&s, frame, about_y, slope);
        scene_floor(&s, slope);
        for (int wheel = 0; wheel < 4; ++wheel) {
            const double x = wheel & 1 ? 0.4 : -0.4, y = wheel & 2 ? 0.25 : -0.25;
            const double at[3] = {r[0] + x * along[0], y, r[2] + x * along[2]};
            se3d_body ball = scene_ball(&s, R, mw, at, scene_zero);
            (void)world_join(s.system, se3d_joint_create_revolute, NULL, frame, ball, at, about_y);
        }
        scene_solve(&s, choices[n].method, choices[n].formulation, 0.0, 1e-6);
        scene_run(&s, 0.3);
        CHECK(se3d_body_get_velocity(s.system, frame, v0) == SE3D_OK);
        scene_run(&s, 0.8);
        CHECK(se3d_body_get_velocity(s.system, frame, v1) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            gained += along[a] * (v1[a] - v0[a]);
        }
        CHECK_NEAR(gained / 0.5, G * sin(slope) * all / (all + turning), 1e-3);
        scene_end(&s);
    }
}

/* By default a ball of billiards, 1 m/s for 3 s: a few hundred of its vibrations to each step. */
static void a_ball_rolls_on_in_long_steps(void)
{
    const double R = 0.0286, m = 0.17, k = 1e7, v0 = 1.0, arm = R - m * G / k;
    const double r[3] = {0.0, 0.0, arm}, v[3] = {v0, 0.0, 0.0};
    for (int spins = 0; spins < 2; ++spins) {
        const double w[3] = {0.0, v0 / arm, spins ? 5.0 : 0.0};
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.9, k);
        se3d_solver_stats stats = {0};
        double at[3];
        scene_floor(&s, 0.0);
        se3d_body ball = scene_ball(&s, R, m, r, v);
        CHECK(se3d_body_set_angular_velocity(s.system, ball, w) == SE3D_OK);
        scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, 0.0, 0.0);
        scene_run(&s, 3.0);
        CHECK(se3d_solver_get_stats(s.solver, &stats) == SE3D_OK);
        CHECK(stats.steps < 10000);
        CHECK(se3d_body_get_position(s.system, ball, at) == SE3D_OK);
        CHECK_NEAR(at[0], 3.0 * v0, 1e-6);
        CHECK_NEAR(at[1], 0.0, 1e-6);
        CHECK_NEAR(at[2], arm, 1e-9);
        scene_end(&s);
    }
}

/* The rounding of forces that balance is no error: the force with which a ball lands, over its
 * first overlap, is no stiffness. Landing at 1e-10 put it off by 5e-5 m once. */
static void a_ball_lands_alike_at_tight_tolerances(void)
{
    const double R = 0.1, r[3] = {0.0, 0.0, 0.4}, v[3] = {1.0, 0.3, 0.0}, w[3] = {0.0, -5.0, 8.0};
    const int32_t methods[3] = {SE3D_METHOD_RADAU, SE3D_METHOD_DOP853, SE3D_METHOD_GAUSS};
    double at[3][3];
    for (int k = 0; k < 3; ++k) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.4, 0.6, 1e6);
        scene_floor(&s, 0.0);
        se3d_body ball = scene_ball(&s, R, 4.19, r, v);
        CHECK(se3d_body_set_angular_velocity(s.system, ball, w) == SE3D_OK);
        scene_solve(&s, methods[k], SE3D_FORMULATION_AUTO, 0.0, 1e-10);
        scene_run(&s, 0.4);
        CHECK(se3d_body_get_position(s.system, ball, at[k]) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(at[k][a], at[0][a], 1e-6);
        }
        scene_end(&s);
    }
}

/* What it hits is one line, from end to end of it, whatever way the edge looks. */
static void a_wheel_that_climbs_a_kerb_keeps_its_direction(void)
{
    const double R = 0.1, v[3] = {0.0, 2.5, 0.0}, w[3] = {0.0, 0.0, -v[1] / R};
    const double start[3] = {0.0, 0.0, R}, size[3] = {1.0, 1.0, 0.08}, at[3] = {0.0, 1.0, 0.0};
    double first[3] = {0.0, 0.0, 0.0};
    for (size_t n = 0; n < CHOICES; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.9, 0.1, 1e5);
        double now[3];
        scene_floor(&s, 0.0);
        scene_box_on(&s, scene_ground(&s), size, at);
        const se3d_body wheel = scene_disk(&s, 1.5, R, 0.05, start, 0.5 * PI, w);
        CHECK(se3d_body_set_velocity(s.system, wheel, v) == SE3D_OK);
        scene_solve(&s, choices[n].method, choices[n].formulation, 0.0, 1e-6);
        scene_run(&s, 0.5);
        CHECK(se3d_body_get_position(s.system, wheel, now) == SE3D_OK);
        CHECK(now[1] > 0.7 && now[2] > R + 0.039); /* on it */
        CHECK_NEAR(now[0], 0.0, 1e-5);
        if (n == 0) {
            memcpy(first, now, sizeof first);
        }
        CHECK_NEAR(now[1], first[1], 2e-3);
        CHECK_NEAR(now[2], first[2], 2e-3);
        scene_end(&s);
    }
}

int main(void)
{
    RUN(a_ball_on_a_turntable_goes_round_a_circle);
    RUN(a_ball_swings_in_a_gutter);
    RUN(a_ball_passes_a_loop_if_it_is_fast_enough);
    RUN(a_disk_rolls_on_its_rim_about_a_centre_at_rest);
    RUN(a_cart_rolls_down_a_slope);
    RUN(a_ball_rolls_on_in_long_steps);
    RUN(a_ball_lands_alike_at_tight_tolerances);
    RUN(a_wheel_that_climbs_a_kerb_keeps_its_direction);
    return check_finish();
}
