/* SPDX-License-Identifier: BSD-3-Clause */
/* What tips, what slides, what is held and what falls: boxes on inclines and pushed, a gripper,
 * dominoes, a coin. */
#include "support/scene_choices.h"
#include "support/world.h"

static const double about_y[3] = {0.0, 1.0, 0.0};

/* A tall box, w by h, on a slope; its centre stays at the distance that carries it. */
#define W 0.2
#define H 0.4

static se3d_body tall_box(scene *s, double k, double slope)
{
    const double size[3] = {W, W, H}, m = 2.0;
    const double height = 0.5 * H - m * G * cos(slope) / (4.0 * k);
    const double r[3] = {height * sin(slope), 0.0, height * cos(slope)};
    se3d_body box = scene_box(s, size, m, r, scene_zero);
    scene_turn(s, box, about_y, slope);
    scene_floor(s, slope);
    return box;
}

static double angle_of(const scene *s, se3d_body body)
{
    double p[4];
    CHECK(se3d_body_get_orientation(s->system, body, p) == SE3D_OK);
    return 2.0 * atan2(p[2], p[0]);
}

/* About the lower edge, J = m (w^2 + h^2)/3: the angle beyond the slope after t, by small steps. */
static double tipped(double slope, double angle, double rate, double t)
{
    const double arm = 0.5 * sqrt(W * W + H * H), lean = atan2(W, H);
    const int steps = 20000;
    for (int k = 0; k < steps; ++k) { /* leapfrog */
        const double h = t / steps;
        angle += 0.5 * h * rate;
        rate += h * G * arm * sin(slope + angle - lean) / ((W * W + H * H) / 3.0);
        angle += 0.5 * h * rate;
    }
    return angle;
}

/* Stands where tan < w/h and mu; tips where tan > w/h and mu is large; slides where mu is less. */
static void a_box_on_a_slope_stands_tips_or_slides(void)
{
    static const double slopes[3] = {0.42, 0.6, 0.6}, friction[3] = {0.9, 0.9, 0.3};
    for (size_t n = 0; n < 3 * CHOICES; ++n) {
        const int kind = (int)(n % 3);
        const choice *c = &choices[n / 3];
        const double slope = slopes[kind], mu = friction[kind], k = 1e6;
        double v0[3], v1[3], w[3];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, mu, 0.3, k);
        se3d_body box = tall_box(&s, k, slope);
        scene_solve(&s, c->method, c->formulation, 0.0, 1e-6);
        scene_run(&s, 0.2);
        CHECK(se3d_body_get_velocity(s.system, box, v0) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(s.system, box, w) == SE3D_OK);
        const double begun = angle_of(&s, box) - slope;
        scene_run(&s, 0.4);
        CHECK(se3d_body_get_velocity(s.system, box, v1) == SE3D_OK);
        const double gained = (v1[0] - v0[0]) * cos(slope) - (v1[2] - v0[2]) * sin(slope);
        if (kind == 1) {
            CHECK_NEAR(begun, tipped(slope, 0.0, 0.0, 0.2), 0.005);
            CHECK_NEAR(angle_of(&s, box) - slope, tipped(slope, begun, w[1], 0.2), 5e-4);
            CHECK(angle_of(&s, box) - slope > 0.5);
        } else {
            CHECK_NEAR(angle_of(&s, box), slope, 1e-3);
            CHECK_NEAR(gained / 0.2, kind ? G * (sin(slope) - mu * cos(slope)) : 0.0, 0.02);
        }
        scene_end(&s);
    }
}

/* Pushed at the height z with P: slides where P > mu m g and z < w/(2 mu), with P/m - mu g; tips
 * where P z > m g w/2 and P < mu m g. */
static void a_pushed_box_slides_or_tips(void)
{
    const double m = 2.0, k = 1e6, mu = 0.4, push[2] = {1.2 * mu * m * G, 0.9 * mu * m * G};
    const double at[2] = {0.9 * W / (2.0 * mu), H};
    for (size_t n = 0; n < 2 * CHOICES; ++n) {
        const int tips = (int)(n % 2);
        const choice *c = &choices[n / 2];
        double v0[3], v1[3];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, mu, 0.3, k);
        se3d_body box = tall_box(&s, k, 0.0);
        se3d_load_def load = se3d_load_def_default();
        se3d_force force;
        load.body = box;
        load.point[2] = at[tips] - 0.5 * H;
        load.value[0] = push[tips];
        CHECK(se3d_force_create_load(s.system, &load, &force) == SE3D_OK);
        scene_solve(&s, c->method, c->formulation, 0.0, 1e-6);
        scene_run(&s, 0.1);
        CHECK(se3d_body_get_velocity(s.system, box, v0) == SE3D_OK);
        scene_run(&s, 0.3);
        CHECK(se3d_body_get_velocity(s.system, box, v1) == SE3D_OK);
        if (tips) {
            CHECK(angle_of(&s, box) > 0.1);
        } else {
            CHECK_NEAR(angle_of(&s, box), 0.0, 1e-3);
            CHECK_NEAR((v1[0] - v0[0]) / 0.2, push[0] / m - mu * G, 0.01);
        }
        scene_end(&s);
    }
}

/* A slide on `along` of `parent`, at r. */
static se3d_constraint slide(scene *s, se3d_body parent, se3d_body child, const double r[3],
                             const double along[3])
{
    se3d_constraint joint;
    joint = world_join(s->system, se3d_joint_create_prismatic, NULL, parent, child, r, along);
    return joint;
}

/* A hand that a driver lifts with the acceleration `lift`, two fingers that slide in it and press a
 * box of 1 kg between them with N each. Returns the box. */
static se3d_body gripper(scene *s, double lift, double N)
{
    const double up[3] = {0.0, 0.0, 1.0}, across[3] = {1.0, 0.0, 0.0}, top[3] = {0.0, 0.0, 0.3};
    const double J[3] = {0.1, 0.1, 0.1}, size[3] = {0.1, 0.1, 0.1}, pad[3] = {0.04, 0.06, 0.06};
    se3d_body hand = scene_body(s, 5.0, J, top, scene_zero), fingers[2];
    se3d_driver_def drive = se3d_driver_def_default();
    se3d_constraint motor;
    char text[60];
    drive.joint = slide(s, scene_ground(s), hand, top, up);
    drive.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    snprintf(text, sizeof text, "%.17g * t^2 / 2", lift);
    CHECK(se3d_function_create_expression(s->system, text, &drive.function) == SE3D_OK);
    CHECK(se3d_driver_create(s->system, &drive, &motor) == SE3D_OK);
    se3d_body box = scene_box(s, size, 1.0, scene_zero, scene_zero);
    for (int side = 0; side < 2; ++side) {
        /* the pads are pressed in by N / k for each of four corners */
        const double r[3] = {(side ? 1.0 : -1.0) * (0.07 - N / 4e6), 0.0, 0.0};
        fingers[side] = scene_box(s, pad, 0.2, r, scene_zero);
        (void)slide(s, hand, fingers[side], r, across);
    }
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force force;
    spring.body_i = fingers[0];
    spring.body_j = fingers[1];
    spring.k = 1.0; /* soft: N whatever the fingers do */
    spring.l0 = 0.14;
    spring.preload = N;
    CHECK(se3d_force_create_tsda(s->system, &spring, &force) == SE3D_OK);
    return box;
}

/* Two pads hold what 2 mu N >= m (g + a) says, and else let it slip with 2 mu N/m - g. */
static void a_gripper_lifts_what_its_friction_holds(void)
{
    const double lift = 2.0, mu = 0.5;
    for (size_t n = 0; n < 2 * CHOICES; ++n) {
        const int holds = n % 2 == 0;
        const choice *c = &choices[n / 2];
        const double N = (holds ? 1.05 : 0.8) * (G + lift) / (2.0 * mu);
        double v0[3], v1[3], w[3];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, mu, 0.3, 1e6);
        se3d_body box = gripper(&s, lift, N);
        scene_solve(&s, c->method, c->formulation, 0.0, 1e-6);
        scene_run(&s, 0.05);
        CHECK(se3d_body_get_velocity(s.system, box, v0) == SE3D_OK);
        scene_run(&s, 0.15);
        CHECK(se3d_body_get_velocity(s.system, box, v1) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(s.system, box, w) == SE3D_OK);
        CHECK_NEAR((v1[2] - v0[2]) / 0.1, holds ? lift : 2.0 * mu * N - G, 0.02);
        CHECK_NEAR(v1[0], 0.0, 1e-6);
        CHECK_NEAR(w[1], 0.0, 1e-6);
        scene_end(&s);
    }
}

/* When the last of four dominoes leans by 0.3, the first being let go beyond its balance; and after
 * how many steps. */
static double time_to_topple(const choice *c, int64_t *steps)
{
    se3d_solver_stats stats;
    const double size[3] = {0.02, 0.1, 0.12}, pitch = 0.06, lean = 0.25, k = 1e5, m = 0.1;
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.6, 0.3, k);
    se3d_body row[4];
    se3d_energy before, after;
    scene_floor(&s, 0.0);
    for (int n = 0; n < 4; ++n) {
        const double a = n ? 0.0 : lean, sink = m * G / (4.0 * k);
        const double r[3] = {pitch * n + (n ? 0.0 : 0.06 * sin(a) - 0.01 * (1.0 - cos(a))), 0.0,
                             0.06 * cos(a) + (n ? 0.0 : 0.01 * sin(a)) - sink};
        row[n] = scene_box(&s, size, m, r, scene_zero);
        scene_turn(&s, row[n], about_y, a);
    }
    scene_solve(&s, c->method, c->formulation, 0.0, 1e-6);
    scene_run(&s, 0.0);
    CHECK(se3d_system_get_energy(s.system, &before) == SE3D_OK);
    double t = 0.0, last = 0.0, now = 0.0;
    for (; t < 1.0 && now < 0.3;) {
        last = now;
        t += 0.005;
        scene_run(&s, t);
        now = angle_of(&s, row[3]);
        CHECK(se3d_system_get_energy(s.system, &after) == SE3D_OK);
        CHECK(after.total < before.total + 1e-4);
    }
    CHECK(now >= 0.3);
    for (int n = 0; n < 3; ++n) { /* each leans on the next */
        CHECK(angle_of(&s, row[n]) > angle_of(&s, row[n + 1]));
    }
    CHECK(se3d_solver_get_stats(s.solver, &stats) == SE3D_OK);
    *steps = (int64_t)stats.steps;
    scene_end(&s);
    return t - 0.005 * (now - 0.3) / (now - last);
}

static void dominoes_topple_alike_in_all_methods(void)
{
    int64_t steps;
    double first = time_to_topple(&choices[0], &steps);
    for (size_t n = 1; n < CHOICES; ++n) {
        CHECK_NEAR(time_to_topple(&choices[n], &steps), first, 0.01 * first);
    }
}

/* What slides at its cap under a load that changes is smooth: not stepped through by microseconds,
 * whatever what is remembered of it does between steps. */
static void sliding_dominoes_do_not_hold_implicit_methods(void)
{
    static const choice implicit[2] = {{SE3D_METHOD_RADAU, SE3D_FORMULATION_ROMEGA},
                                       {SE3D_METHOD_BDF, SE3D_FORMULATION_ROMEGA}};
    for (int n = 0; n < 2; ++n) {
        int64_t steps;
        (void)time_to_topple(&implicit[n], &steps);
        CHECK(steps < (n ? 5000 : 2500));
    }
}

/* Spun up on its rim, with rolling friction: energy never grows, and it lies flat in the end. */
static void a_coin_spins_down_and_lies_flat(void)
{
    const double R = 0.05, h = 0.02, m = 0.2, k = 1e5, tilt = 0.3;
    for (size_t n = 0; n < 3; ++n) {
        se3d_material_def stuff = scene_stuff(0.5, 0.3, k);
        const double r[3] = {0.0, 0.0, R * sin(tilt) + 0.5 * h * cos(tilt)};
        const double w[3] = {-8.0, 0.0, 1.0};
        double at[3], p[4], last;
        stuff.rolling_friction = 0.1;
        stuff.torsional_friction = 0.1;
        scene s = scene_begin_with(NULL, SE3D_CONTACT_LAW_HOOKE, &stuff);
        se3d_energy energy;
        const se3d_body coin = scene_disk(&s, m, R, h, r, tilt, w);
        scene_floor(&s, 0.0);
        scene_solve(&s, choices[n].method, choices[n].formulation, 0.0, 1e-6);
        scene_run(&s, 0.0);
        CHECK(se3d_system_get_energy(s.system, &energy) == SE3D_OK);
        const double begun = energy.total;
        last = begun;
        for (int step = 1; step <= 40; ++step) {
            scene_run(&s, 0.05 * step);
            CHECK(se3d_system_get_energy(s.system, &energy) == SE3D_OK);
            CHECK(energy.total <
                  last + 1e-3 * begun); /* springs give back what dampers stretched */
            last = energy.total;
        }
        CHECK(se3d_body_get_position(s.system, coin, at) == SE3D_OK);
        CHECK(se3d_body_get_orientation(s.system, coin, p) == SE3D_OK);
        CHECK_NEAR(at[2], 0.5 * h - m * G / (8.0 * k), 2e-5);
        CHECK_NEAR(p[1] * p[1] + p[2] * p[2], 0.0, 1e-6);
        scene_end(&s);
    }
}

int main(void)
{
    RUN(a_box_on_a_slope_stands_tips_or_slides);
    RUN(a_pushed_box_slides_or_tips);
    RUN(a_gripper_lifts_what_its_friction_holds);
    RUN(dominoes_topple_alike_in_all_methods);
    RUN(sliding_dominoes_do_not_hold_implicit_methods);
    RUN(a_coin_spins_down_and_lies_flat);
    return check_finish();
}
