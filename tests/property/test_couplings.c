/* SPDX-License-Identifier: BSD-3-Clause */
/* What gears, racks and couplers do to bodies: effort and reactions against closed forms. */
#include "support/text_model.h"

/* Two discs, 2:1; the first is driven by 6 N m: (J1 + 4 J2) theta1'' = 6, and so on. */
static void a_gear_reports_its_torque_on_both_discs(void)
{
    static const char *const text =
        "se3d: 1\ngravity: [0, 0, 0]\nbodies:\n"
        "  - {name: a, mass: 1, inertia: [1, 1, 2]}\n"
        "  - {name: b, mass: 1, inertia: [2, 2, 3], position: [1, 0, 0]}\njoints:\n"
        "  - {name: ja, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: jb, type: revolute, body_i: ground, body_j: b, at: [1, 0, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: g, type: gear, joint_1: ja, joint_2: jb, ratio: 2}\n"
        "forces: [{type: torque, body: a, value: [0, 0, 6]}]\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [g.effort, g.torque, g.force, g.value, "
        "a.angular_acceleration, b.angular_acceleration, energy.balance]}]\n";
    for (int rp = 0; rp < 2; ++rp) {
        text_model m = text_model_open(text, SE3D_METHOD_DOP853, rp, 0.0);
        CHECK(text_model_run(&m, 1.0));
        const double a = 6.0 / (2.0 + 4.0 * 3.0);
        CHECK_NEAR(text_model_get(&m, 4, 2), a, 1e-12);
        CHECK_NEAR(text_model_get(&m, 5, 2), -2.0 * a, 1e-12);
        CHECK_NEAR(text_model_get(&m, 0, 0), 3.0 * -2.0 * a, 1e-11); /* on b about its axis */
        CHECK_NEAR(text_model_get(&m, 1, 2), 2.0 * a - 6.0, 1e-11);  /* on a: twice the effort */
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 1e-12);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.0, 1e-12);
        CHECK_NEAR(text_model_get(&m, 3, 0), 0.0, 1e-12);
        text_model_close(&m);
    }
}

/* A rack of 4 kg pushed by 10 N turns a pinion of J = 0.5, radius 0.25: (4 + J/r^2) x'' = 10. */
static void a_rack_reports_the_force_on_the_rack_and_the_torque_on_the_pinion(void)
{
    static const char *const text =
        "se3d: 1\ngravity: [0, 0, 0]\nbodies:\n"
        "  - {name: p, mass: 1, inertia: [1, 1, 0.5]}\n"
        "  - {name: r, mass: 4, inertia: [1, 1, 1], position: [0, -0.25, 0]}\njoints:\n"
        "  - {name: jr, type: prismatic, body_i: ground, body_j: r, at: [0, -0.25, 0], axis: [1, "
        "0, "
        "0]}\n"
        "  - {name: jp, type: revolute, body_i: ground, body_j: p, at: [0, 0, 0], axis: [0, 0, 1], "
        "angle0: 0.5}\n"
        "  - {name: k, type: rack_pinion, rack: jr, pinion: jp, radius: 0.25}\n"
        "forces: [{type: force, body: r, value: [10, 0, 0]}]\n"
        "analysis: {type: dynamics, duration: 0.5}\n"
        "output: [{file: r.csv, channels: [k.effort, k.torque, k.force, k.value, "
        "r.acceleration]}]\n";
    for (int rp = 0; rp < 2; ++rp) {
        text_model m = text_model_open(text, SE3D_METHOD_DOP853, rp, 0.0);
        CHECK(text_model_run(&m, 0.5));
        const double a = 10.0 / (4.0 + 0.5 / 0.0625), effort = 4.0 * a - 10.0;
        CHECK_NEAR(text_model_get(&m, 4, 0), a, 1e-12);
        CHECK_NEAR(text_model_get(&m, 0, 0), effort, 1e-11);
        CHECK_NEAR(text_model_get(&m, 1, 2), -0.25 * effort, 1e-11);
        CHECK_NEAR(text_model_get(&m, 1, 2), 0.5 * a / 0.25, 1e-11);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.0, 1e-11);
        CHECK_NEAR(text_model_get(&m, 3, 0), -0.25 * 0.5, 1e-12);
        text_model_close(&m);
    }
}

/* x1 - 2 x2 = t^2 between two sliders: m1 x1'' = e, m2 x2'' = -2 e. */
static void a_coupler_that_moves_reports_value_force_and_effort(void)
{
    static const char *const text =
        "se3d: 1\ngravity: [0, 0, 0]\nbodies:\n"
        "  - {name: a, mass: 3, inertia: [1, 1, 1]}\n"
        "  - {name: b, mass: 5, inertia: [1, 1, 1], position: [0, 1, 0]}\njoints:\n"
        "  - {name: ja, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "
        "0]}\n"
        "  - {name: jb, type: prismatic, body_i: ground, body_j: b, at: [0, 1, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: c, type: coupler, terms: [{joint: ja}, {joint: jb, ratio: -2}], value: t^2}\n"
        "analysis: {type: dynamics, duration: 0.5}\n"
        "output: [{file: r.csv, channels: [c.effort, c.force, c.value, ja.displacement, "
        "jb.displacement, energy.balance, work.drivers]}]\n";
    const double e = 2.0 / (1.0 / 3.0 + 4.0 / 5.0);
    text_model m = text_model_open(text, SE3D_METHOD_DOP853, 0, 0.0);
    CHECK(text_model_run(&m, 0.5));
    CHECK_NEAR(text_model_get(&m, 0, 0), e, 1e-11);
    CHECK_NEAR(text_model_get(&m, 1, 0), e, 1e-11);
    CHECK_NEAR(text_model_get(&m, 2, 0), 0.25, 1e-15);
    CHECK_NEAR(text_model_get(&m, 3, 0), 0.125 * e / 3.0, 1e-11);
    CHECK_NEAR(text_model_get(&m, 4, 0), 0.125 * -2.0 * e / 5.0, 1e-11);
    CHECK_NEAR(text_model_get(&m, 6, 0), e * 0.25, 1e-9); /* effort times the change of value */
    text_model_close(&m);
}

/* The message of a gear `g` of joint `j` and `other`. */
static void check_refused(const char *other, const char *why)
{
    char text[600];
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    snprintf(text, sizeof text,
             "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1]}]\njoints:\n"
             "  - {name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, "
             "1]}\n  - {name: g, type: gear, joint_1: j, joint_2: %s, ratio: 1}\n",
             other);
    CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error) < 0);
    CHECK_CONTAINS(error.message, why);
    se3d_model_destroy(model);
}

static void a_gear_of_itself_is_refused_with_its_reason(void)
{
    check_refused("g", "m.yaml:5:48: joints[1].joint_2: is `g` itself");
    check_refused("j", "joints[1].joint_2: is the same as joint_1, must be another joint");
}

static const char *const three_gears =
    "se3d: 1\ngravity: [0, 0, 0]\nparameters: {J: %g}\nbodies:\n"
    "  - {name: a, mass: 20*J, inertia: [0.5*J, 0.6*J, J]}\n"
    "  - {name: b, mass: 2, inertia: [0.1, 0.1, 0.15], position: [1, 0, 0]}\njoints:\n"
    "  - {name: ja, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]}\n"
    "  - {name: jb, type: revolute, body_i: ground, body_j: b, at: [1, 0, 0], axis: [0, 0, 1]}\n"
    "  - {name: g1, type: gear, joint_1: ja, joint_2: jb, ratio: 2}\n"
    "  - {name: g2, type: gear, joint_1: ja, joint_2: jb, ratio: 2}\n"
    "  - {name: g3, type: gear, joint_1: ja, joint_2: jb, ratio: 2}\n"
    "forces: [{type: torque, body: a, value: [0, 0, \"3*sin(5*t)+0.2\"]}]\n"
    "analysis: {type: dynamics, duration: 1}\n"
    "output: [{file: r.csv, channels: [g1.effort, g2.effort, g3.effort]}]\n";

/* The multipliers of least norm are equal, and exact at the time of the output whatever the method.
 * J_b theta_b'' is what all three do, theta_b'' = -2 T / (J + 4 J_b). */
static void check_equal_gears(double J, int32_t method, int32_t formulation)
{
    char text[2000];
    snprintf(text, sizeof text, three_gears, J);
    text_model m = text_model_open(text, method, formulation, 0.0);
    for (int row = 1; row < 6; ++row) {
        const double t = 0.13 * row;
        const double torque = 3.0 * sin(5.0 * t) + 0.2;
        const double third = -0.15 * 2.0 * torque / (J + 0.6) / 3.0;
        CHECK(text_model_run(&m, t));
        for (size_t k = 0; k < 3; ++k) {
            CHECK_NEAR(text_model_get(&m, k, 0), third, 1e-5);
            CHECK_NEAR(text_model_get(&m, k, 0), text_model_get(&m, 0, 0), 1e-8);
        }
    }
    text_model_close(&m);
}

static void equal_gears_share_the_effort_in_every_method(void)
{
    for (int32_t method = SE3D_METHOD_AUTO; method <= SE3D_METHOD_RK4; ++method) {
        for (int32_t formulation = 0; formulation < 3; ++formulation) {
            check_equal_gears(0.05, method, formulation);
            check_equal_gears(5e-9, method, formulation); /* a wheel of nearly nothing */
        }
    }
}

/* A sun of J = 0.02, an arm of J = 0.04 and three planets of 0.3 kg and J = 0.002 times `light`,
 * 0.3 m from the middle, in a ring that stands still; 6 N m on the sun. */
static void write_planets(double light, char *text, size_t size)
{
    char joints[6000] = "", planets[1000] = "";
    for (int k = 0; k < 3; ++k) {
        const double x = 0.3 * cos(2.0943951023931953 * k), y = 0.3 * sin(2.0943951023931953 * k);
        const size_t used = strlen(joints), listed = strlen(planets);
        snprintf(
            planets + listed, sizeof planets - listed,
            "  - {name: p%d, mass: %.9g, inertia: [%.9g, %.9g, %.9g], position: [%.17g, %.17g, "
            "0]}\n",
            k, 0.3 * light, 1e-3 * light, 1e-3 * light, 2e-3 * light, x, y);
        snprintf(joints + used, sizeof joints - used,
                 "  - {name: jp%d, type: revolute, body_i: arm, body_j: p%d, at: [%.17g, %.17g, 0],"
                 " axis: [0, 0, 1]}\n"
                 "  - {name: s%d, type: coupler, terms: [{joint: js, ratio: 2}, {joint: jc, ratio: "
                 "-2}, {joint: jp%d}]}\n"
                 "  - {name: r%d, type: coupler, terms: [{joint: jc, ratio: 4}, {joint: jp%d}]}\n",
                 k, k, x, y, k, k, k, k);
    }
    snprintf(text, size,
             "se3d: 1\ngravity: [0, -9.81, 0]\nbodies:\n"
             "  - {name: sun, mass: 1, inertia: [0.01, 0.01, 0.02]}\n"
             "  - {name: arm, mass: 2, inertia: [0.02, 0.02, 0.04]}\n%sjoints:\n"
             "  - {name: js, type: revolute, body_i: ground, body_j: sun, at: [0, 0, 0], axis: [0, "
             "0, 1]}\n"
             "  - {name: jc, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, "
             "0, 1]}\n%s"
             "forces: [{type: torque, body: sun, value: [0, 0, 6]}]\n"
             "analysis: {type: dynamics, duration: 1, step: 1e-3}\n"
             "output: [{file: r.csv, channels: [s0.effort, s1.effort, s2.effort, r0.effort, "
             "r1.effort, r2.effort]}]\n",
             planets, joints);
}

/* The efforts of sun and ring. The sun turns 3 times as fast as the arm, the planets -3 times (4
 * times to the arm): 3 6 = (9 J_s + J_a + 3 (9 J_p + 0.09 m)) alpha, and the teeth of each planet
 * are in balance with what turns it. */
static void find_efforts(double light, double effort[2])
{
    const double J = 2e-3 * light, m = 0.3 * light;
    const double alpha = 18.0 / (9.0 * 0.02 + 0.04 + 3.0 * (9.0 * J + 0.09 * m));
    effort[0] = (0.02 * 3.0 * alpha - 6.0) / 6.0;
    effort[1] = -3.0 * J * alpha - effort[0];
}

static const int32_t planet_methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU,
                                         SE3D_METHOD_BDF,    SE3D_METHOD_RATTLE,
                                         SE3D_METHOD_GAUSS,  SE3D_METHOD_GENERALIZED_ALPHA};

static void run_planets(double light, int32_t method, int32_t formulation, double end)
{
    char text[8000];
    double effort[2];
    write_planets(light, text, sizeof text);
    find_efforts(light, effort);
    text_model m = text_model_open(text, method, formulation, 0.0);
    for (int row = 0; row <= 2; ++row) {
        const se3d_status status = se3d_solver_run(m.solver, 0.5 * end * row);
        CHECK(status == SE3D_INFO_REDUNDANT);
        if (status < 0) {
            fprintf(stderr, "planets of %g by %s, formulation %d: %s\n", light,
                    se3d_method_get_name(method), (int)formulation,
                    se3d_system_get_error(m.system));
            break;
        }
        for (size_t c = 0; c < 6; ++c) {
            CHECK_NEAR(text_model_get(&m, c, 0), text_model_get(&m, c / 3 * 3, 0), 1e-12);
            CHECK_NEAR(text_model_get(&m, c, 0), effort[c / 3], 1e-10);
        }
    }
    text_model_close(&m);
}

/* What three equal planets carry is redundant, and shared by them alike. */
static void equal_planets_carry_equal_loads(void)
{
    for (int32_t k = 0; k < 12; ++k) {
        run_planets(1.0, planet_methods[k / 2], k % 2, 0.4);
    }
}

/* They carry the sun's load to the ring and the arm, however light they are. */
static void light_planets_carry_what_heavy_ones_do(void)
{
    static const double masses[] = {1e-7, 1e-10, 1e-13};
    for (size_t light = 0; light < 3; ++light) {
        for (int32_t k = 0; k < 12; ++k) {
            run_planets(masses[light], planet_methods[k / 2], k % 2, 0.05);
        }
    }
}

int main(void)
{
    RUN(equal_gears_share_the_effort_in_every_method);
    RUN(a_gear_reports_its_torque_on_both_discs);
    RUN(a_rack_reports_the_force_on_the_rack_and_the_torque_on_the_pinion);
    RUN(a_coupler_that_moves_reports_value_force_and_effort);
    RUN(a_gear_of_itself_is_refused_with_its_reason);
    RUN(equal_planets_carry_equal_loads);
    RUN(light_planets_carry_what_heavy_ones_do);
    return check_finish();
}
