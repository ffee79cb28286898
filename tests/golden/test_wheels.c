/* SPDX-License-Identifier: BSD-3-Clause */
/* What wheels measure: closed forms of planar suspensions, differences along a sweep, mirrored
 * corners, the slope of what lifts a wheel at its equilibria. docs/theory/wheel.md */
#include "support/text_model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct measures {
    double of[SE3D_WHEEL_MEASURES];
} measures;

static measures measure(const se3d_system *system, size_t k)
{
    measures m;
    se3d_wheel wheel;
    CHECK(!se3d_system_get_wheel(system, k, &wheel));
    CHECK(!se3d_wheel_get_measures(system, wheel, 0, SE3D_WHEEL_MEASURES, m.of));
    return m;
}

/* A double wishbone in the plane x = 0: a four-bar whose coupler is the upright. `HOLD` is what
 * carries the wheel: a road that lifts it, or a force. */
#define PLANAR(HOLD, TRAVEL)                                                                       \
    "se3d: 1\n"                                                                                    \
    "parameters: {lift: 0.04, load: 900}\n"                                                        \
    "points:\n"                                                                                    \
    "  hub: [0, 0.6, 0.25]\n"                                                                      \
    "  lower_in: [0, 0.2, 0.14]\n"                                                                 \
    "  lower: [0, 0.55, 0.13]\n"                                                                   \
    "  upper_in: [0, 0.28, 0.33]\n"                                                                \
    "  upper: [0, 0.53, 0.36]\n"                                                                   \
    "  top: [0, 0.3, 0.5]\n"                                                                       \
    "  foot: mid(lower_in, lower)\n"                                                               \
    "bodies:\n"                                                                                    \
    "  - {name: chassis, fixed: true}\n"                                                           \
    "  - {name: upright, mass: 8, inertia: [0.1, 0.1, 0.1], position: hub}\n"                      \
    "  - {name: low, mass: 1, inertia: [0.01, 0.01, 0.01], position: foot}\n"                      \
    "  - {name: up, mass: 1, inertia: [0.01, 0.01, 0.01], position: 'mid(upper_in, upper)'}\n"     \
    "joints:\n"                                                                                    \
    "  - {type: revolute, body_i: chassis, body_j: low, at: lower_in, axis: [1, 0, 0]}\n"          \
    "  - {type: revolute, body_i: chassis, body_j: up, at: upper_in, axis: [1, 0, 0]}\n"           \
    "  - {type: revolute, body_i: low, body_j: upright, at: lower, axis: [1, 0, 0]}\n"             \
    "  - {type: point_on_line, body_i: up, body_j: upright, at: upper, axis: [1, 0, 0]}\n" HOLD    \
    "  - {name: spring, type: tsda, body_i: chassis, body_j: low, at: top, at_2: foot,\n"          \
    "     k: 30000, l0: 0.45, c: 500}\n"                                                           \
    "wheels:\n"                                                                                    \
    "  - {name: wheel, body: upright, chassis: chassis, at: hub, radius: 0.25, " TRAVEL            \
    "     spring: spring, lower: lower, upper: upper}\n"

static const char driven[] =
    PLANAR("constraints:\n"
           "  - {name: road, type: cd, body_i: ground, body_j: upright, c: [0, 0, 1], at_2: hub,\n"
           "     value: 'hub.z + lift*t'}\n"
           "forces:\n",
           "travel: road,\n") "analysis: {type: kinematics, duration: 1, step: 0.01}\n";
static const char carried[] =
    PLANAR("forces:\n  - {type: force, body: upright, at: hub, value: [0, 0, load]}\n",
           "\n") "analysis: {type: equilibrium}\n";

/* The point at which the lines of two arms meet, in y and z. */
static void intersect(double y[2][2], double z[2][2], double center[2])
{
    const double m0 = (z[0][1] - z[0][0]) / (y[0][1] - y[0][0]);
    const double m1 = (z[1][1] - z[1][0]) / (y[1][1] - y[1][0]);
    center[0] = (z[1][0] - z[0][0] + m0 * y[0][0] - m1 * y[1][0]) / (m0 - m1);
    center[1] = z[0][0] + m0 * (center[0] - y[0][0]);
}

static void planar_wishbones_have_their_closed_forms(void)
{
    text_model t = text_model_open(driven, -1, -1, 0.0);
    const measures m = measure(t.system, 0);
    double y[2][2] = {{0.2, 0.55}, {0.28, 0.53}}, z[2][2] = {{0.14, 0.13}, {0.33, 0.36}}, c[2];
    intersect(y, z, c);
    const double omega = 1.0 / (0.6 - c[0]);
    CHECK_NEAR(m.of[SE3D_WHEEL_CAMBER], 0.0, 1e-15);
    CHECK_NEAR(m.of[SE3D_WHEEL_TOE], 0.0, 1e-15);
    CHECK_NEAR(m.of[SE3D_WHEEL_CONTACT_Y], 0.6, 1e-14);
    CHECK_NEAR(m.of[SE3D_WHEEL_CONTACT_Z], 0.0, 1e-14);
    CHECK_NEAR(m.of[SE3D_WHEEL_FRONT_SWING_ARM], 0.6 - c[0], 1e-9);
    CHECK_NEAR(m.of[SE3D_WHEEL_FRONT_CENTER_HEIGHT], c[1], 1e-9);
    CHECK_NEAR(m.of[SE3D_WHEEL_CAMBER_GRADIENT], -omega, 1e-11);
    CHECK_NEAR(m.of[SE3D_WHEEL_TRACK_GRADIENT], omega * c[1], 1e-11);
    CHECK_NEAR(m.of[SE3D_WHEEL_TOE_GRADIENT], 0.0, 1e-11);
    CHECK_NEAR(m.of[SE3D_WHEEL_WHEELBASE_GRADIENT], 0.0, 1e-11);
    CHECK_NEAR(m.of[SE3D_WHEEL_ROLL_CENTER_HEIGHT], c[1] * 0.6 / (0.6 - c[0]), 1e-11);
    /* the arm turns about its pin as the upright does about the centre: at the ball */
    const double arm = omega * (0.55 - c[0]) / 0.35;
    const double foot[2] = {0.375, 0.135};
    const double v[2] = {-arm * (foot[1] - 0.14), arm * (foot[0] - 0.2)};
    const double d[2] = {foot[0] - 0.3, foot[1] - 0.5};
    const double ratio = -(d[0] * v[0] + d[1] * v[1]) / hypot(d[0], d[1]);
    CHECK_NEAR(m.of[SE3D_WHEEL_MOTION_RATIO], ratio, 1e-11);
    CHECK_NEAR(m.of[SE3D_WHEEL_KINGPIN_INCLINATION], atan2(0.02, 0.23), 1e-12);
    CHECK_NEAR(m.of[SE3D_WHEEL_CASTER], 0.0, 1e-12);
    CHECK_NEAR(m.of[SE3D_WHEEL_MECHANICAL_TRAIL], 0.0, 1e-12);
    /* the axis meets the road at y = 0.55 + 0.13 0.02 / 0.23 */
    CHECK_NEAR(m.of[SE3D_WHEEL_SCRUB_RADIUS], 0.05 - 0.13 * 0.02 / 0.23, 1e-12);
    CHECK(isnan(m.of[SE3D_WHEEL_ROLL_RATE]) && isnan(m.of[SE3D_WHEEL_ACKERMANN_ERROR]));
    text_model_close(&t);
}

/* A spatial corner with toe, caster and a long tie rod, for both sides; the second wheel finds its
 * steer axis. */
static const char spatial[] =
    "se3d: 1\n"
    "points:\n"
    "  hub: [0.01, 0.6, 0.25]\n"
    "bodies:\n"
    "  - {name: chassis, fixed: true, position: [0.1, 0, 0.3], orientation: {rpy: [0, 0, 0.7]}}\n"
    "parts:\n"
    "  corner:\n"
    "    points:\n"
    "      hub: [0.01, 0.6, 0.25]\n"
    "      upper: hub + [-0.01, -0.045, 0.11]\n"
    "      lower: hub + [0.008, -0.025, -0.105]\n"
    "      uf: [0.11, 0.26, 0.325]\n"
    "      ur: [-0.13, 0.265, 0.31]\n"
    "      lf: [0.13, 0.22, 0.155]\n"
    "      lr: [-0.15, 0.225, 0.14]\n"
    "      tie_in: [0.075, 0.23, 0.185]\n"
    "      tie_out: hub + [0.075, -0.035, -0.06]\n"
    "      top: [0.02, 0.33, 0.47]\n"
    "      foot: mid(lf, lr) + 0.75*(lower - mid(lf, lr))\n"
    "    bodies:\n"
    "      - {name: upright, mass: 9, inertia: [0.09, 0.07, 0.09], position: hub}\n"
    "      - {name: high, mass: 1, inertia: [0.01, 0.01, 0.01], position: upper}\n"
    "      - {name: low, mass: 1, inertia: [0.01, 0.01, 0.01], position: lower}\n"
    "    joints:\n"
    "      - {type: revolute, body_i: chassis, body_j: high, at: 'mid(uf, ur)', axis: uf - ur}\n"
    "      - {type: revolute, body_i: chassis, body_j: low, at: 'mid(lf, lr)', axis: lf - lr}\n"
    "      - {type: spherical, body_i: high, body_j: upright, at: upper}\n"
    "      - {type: spherical, body_i: low, body_j: upright, at: lower}\n"
    "      - {name: tie, type: distance, body_i: chassis, body_j: upright, at: tie_in,\n"
    "         at_2: tie_out, distance: 'distance(tie_in, tie_out)'}\n"
    "    constraints:\n"
    "      - {name: road, type: cd, body_i: ground, body_j: upright, c: [0, 0, 1], at_2: hub,\n"
    "         value: 'hub.z + 0.05*(t - 0.5)'}\n"
    "    forces:\n"
    "      - {name: spring, type: tsda, body_i: chassis, body_j: low, at: top, at_2: foot,\n"
    "         k: 30000, l0: 0.45}\n"
    "    wheels:\n"
    "      - {name: wheel, body: upright, chassis: chassis, at: hub, axis: [0.02, 1, 0.03],\n"
    "         radius: 0.24, travel: road, spring: spring, lower: lower, upper: upper,\n"
    "         wheelbase: 1.55, cg_height: 0.3, brake_share: 0.6, drive_share: 0.5}\n"
    "      - {name: found, body: upright, chassis: chassis, at: hub, axis: [0.02, 1, 0.03],\n"
    "         radius: 0.24, steering: tie, spring: spring}\n"
    "instances:\n"
    "  - {part: corner, prefix: left_}\n"
    "  - {part: corner, prefix: right_, mirror: y}\n"
    "analysis: {type: kinematics, duration: 1, step: 0.01}\n"
    "output: [{file: a.csv, channels: [left_spring.length]}]\n";

static void derivatives_are_those_of_a_sweep(void)
{
    static const int pairs[][2] = {{SE3D_WHEEL_CAMBER, SE3D_WHEEL_CAMBER_GRADIENT},
                                   {SE3D_WHEEL_TOE, SE3D_WHEEL_TOE_GRADIENT},
                                   {SE3D_WHEEL_TRACK_CHANGE, SE3D_WHEEL_TRACK_GRADIENT},
                                   {SE3D_WHEEL_WHEELBASE_CHANGE, SE3D_WHEEL_WHEELBASE_GRADIENT},
                                   {SE3D_WHEEL_WHEEL_LOAD, SE3D_WHEEL_WHEEL_RATE}};
    const double h = 2e-3; /* of time: 1e-4 m of travel */
    text_model t = text_model_open(spatial, -1, -1, 0.0);
    for (double at = 0.1; at < 1.0; at += 0.2) {
        measures m[3];
        double length[3];
        for (int k = 0; k < 3; ++k) {
            if (!text_model_run(&t, at + (k - 1) * h)) {
                break;
            }
            m[k] = measure(t.system, 0);
            length[k] = text_model_get(&t, 0, 0);
        }
        const double by = m[2].of[SE3D_WHEEL_TRAVEL] - m[0].of[SE3D_WHEEL_TRAVEL];
        CHECK_NEAR(by, 0.1 * h, 1e-12);
        for (size_t p = 0; p < sizeof pairs / sizeof *pairs; ++p) {
            const double slope = (m[2].of[pairs[p][0]] - m[0].of[pairs[p][0]]) / by;
            const double exact = m[1].of[pairs[p][1]];
            CHECK_NEAR(slope, exact, 1e-6 * (1.0 + fabs(exact)));
            CHECK(slope != exact); /* not the same computation */
        }
        CHECK_NEAR(-(length[2] - length[0]) / by, m[1].of[SE3D_WHEEL_MOTION_RATIO], 1e-6);
    }
    text_model_close(&t);
}

static void mirrored_corners_measure_the_same(void)
{
    text_model t = text_model_open(spatial, -1, -1, 0.0);
    CHECK(se3d_system_count_wheels(t.system) == 4);
    if (text_model_run(&t, 0.8)) {
        const measures left = measure(t.system, 0), right = measure(t.system, 2);
        for (int k = 0; k < SE3D_WHEEL_MEASURES; ++k) {
            const double sign = k == SE3D_WHEEL_STEER || k == SE3D_WHEEL_CONTACT_Y ? -1.0 : 1.0;
            const double other =
                k == SE3D_WHEEL_ACKERMANN_ERROR ? -right.of[k] : sign * right.of[k];
            CHECK_NEAR(left.of[k], other, 1e-9 * (1.0 + fabs(other)));
        }
        CHECK(left.of[SE3D_WHEEL_TOE] != 0.0 && left.of[SE3D_WHEEL_CASTER] > 0.0);
    }
    text_model_close(&t);
}

static void the_steer_axis_is_found_from_the_motion(void)
{
    text_model t = text_model_open(spatial, -1, -1, 0.0);
    for (double at = 0.3; at < 1.0; at += 0.3) {
        text_model_run(&t, at);
        const measures given = measure(t.system, 0), found = measure(t.system, 1);
        for (int k = SE3D_WHEEL_CASTER; k <= SE3D_WHEEL_MECHANICAL_TRAIL; ++k) {
            CHECK_NEAR(found.of[k], given.of[k], 1e-10);
        }
        CHECK_NEAR(found.of[SE3D_WHEEL_CAMBER_GRADIENT], given.of[SE3D_WHEEL_CAMBER_GRADIENT],
                   1e-12); /* though nothing names what lifts it */
    }
    text_model_close(&t);
}

/* Loads of 900 N -+ 0.1 N: their difference over that of the travel is the wheel rate. */
static void the_wheel_rate_is_the_slope_of_equilibria(void)
{
    const double loads[3] = {899.9, 900.0, 900.1};
    measures m[3];
    for (int k = 0; k < 3; ++k) {
        char value[32];
        snprintf(value, sizeof value, "%.17g", loads[k]);
        const se3d_model_setting setting = {"load", value};
        se3d_model_options options = se3d_model_options_default();
        se3d_model *model = NULL;
        se3d_model_error error;
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver *solver = NULL;
        options.settings = &setting;
        options.setting_count = 1;
        CHECK(!se3d_model_read_text(carried, strlen(carried), "m", &options, &model, &error));
        se3d_system *system = se3d_model_get_system(model);
        CHECK(!se3d_model_get_solver(model, 0, &def));
        CHECK(!se3d_solver_create(system, &def, &solver));
        CHECK(se3d_solver_run(solver, 0.0) >= 0);
        m[k] = measure(system, 0);
        CHECK_NEAR(m[k].of[SE3D_WHEEL_WHEEL_LOAD], loads[k], 1e-6);
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
    const double by = m[2].of[SE3D_WHEEL_TRAVEL] - m[0].of[SE3D_WHEEL_TRAVEL];
    CHECK(by > 0.0);
    CHECK_NEAR(0.2 / by, m[1].of[SE3D_WHEEL_WHEEL_RATE], 2e-5 * m[1].of[SE3D_WHEEL_WHEEL_RATE]);
}

/* A trailing arm on a vehicle that drives along -y: its pin is the side view's centre. */
static void a_trailing_arm_turns_about_its_pin(void)
{
    static const char text[] =
        "se3d: 1\n"
        "bodies:\n"
        "  - {name: chassis, fixed: true, orientation: {rpy: [0.3, 0.2, 0.1]}}\n"
        "  - {name: arm, mass: 5, inertia: [0.1, 0.1, 0.1], position: [0.5, 0.2, 0.25]}\n"
        "joints:\n"
        "  - {type: revolute, body_i: chassis, body_j: arm, at: [0.5, 0.4, 0.31], axis: [1, 0, "
        "0]}\n"
        "wheels:\n"
        "  - {name: w, body: arm, chassis: chassis, at: [0.5, 0, 0.25], axis: [1, 0, 0],\n"
        "     forward: [0, -1, 0], radius: 0.25, wheelbase: 1.6, cg_height: 0.32,\n"
        "     brake_share: 0.6, drive_share: 0.5}\n"
        "analysis: {type: kinematics, duration: 0}\n";
    text_model t = text_model_open(text, -1, -1, 0.0);
    const measures m = measure(t.system, 0);
    CHECK_NEAR(m.of[SE3D_WHEEL_SIDE_SWING_ARM], -0.4, 1e-12); /* the pin is behind */
    CHECK_NEAR(m.of[SE3D_WHEEL_SIDE_CENTER_HEIGHT], 0.31, 1e-12);
    CHECK_NEAR(m.of[SE3D_WHEEL_ANTI_DIVE], 0.6 * 1.6 / 0.32 * 0.31 / 0.4, 1e-12);
    CHECK_NEAR(m.of[SE3D_WHEEL_ANTI_LIFT], -m.of[SE3D_WHEEL_ANTI_DIVE], 1e-15);
    CHECK_NEAR(m.of[SE3D_WHEEL_ANTI_SQUAT], -0.5 * 1.6 / 0.32 * 0.06 / 0.4, 1e-12);
    CHECK_NEAR(m.of[SE3D_WHEEL_WHEELBASE_GRADIENT], 0.06 / 0.4, 1e-12); /* the tread rolls */
    CHECK_NEAR(m.of[SE3D_WHEEL_CAMBER_GRADIENT], 0.0, 1e-12);
    CHECK(isnan(m.of[SE3D_WHEEL_MOTION_RATIO]) && isnan(m.of[SE3D_WHEEL_CASTER]));
    CHECK_NEAR(m.of[SE3D_WHEEL_WHEEL_LOAD], 5 * 9.81 * 0.5, 1e-9); /* half way to the pin */
    text_model_close(&t);
}

/* Two wheels that steer about one centre, and one that does not. */
static void ackermann_is_about_one_centre(void)
{
    static const char text[] =
        "se3d: 1\n"
        "parameters: {delta: 0.2, off: 0.03, inner: 'atan2(1.5*tan(delta), 1.5 - "
        "1.2*tan(delta))'}\n"
        "bodies:\n"
        "  - {name: chassis, fixed: true}\n"
        "  - {name: r, mass: 1, inertia: [1, 1, 1], position: [0, -0.6, 0.3]}\n"
        "  - {name: l, mass: 1, inertia: [1, 1, 1], position: [0, 0.6, 0.3]}\n"
        "joints:\n"
        "  - {name: jr, type: revolute, body_i: chassis, body_j: r, at: [0, -0.6, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: jl, type: revolute, body_i: chassis, body_j: l, at: [0, 0.6, 0], axis: [0, 0, "
        "1]}\n"
        "drivers:\n"
        "  - {joint: jr, value: delta*t}\n"
        "  - {joint: jl, value: (inner + off)*t}\n"
        "wheels:\n"
        "  - {name: wr, body: r, chassis: chassis, at: [0, -0.6, 0.3], axis: [0, -1, 0], radius: "
        "0.3,\n"
        "     wheelbase: 1.5}\n"
        "  - {name: wl, body: l, chassis: chassis, at: [0, 0.6, 0.3], radius: 0.3, wheelbase: "
        "1.5}\n"
        "analysis: {type: kinematics, duration: 1, step: 0.1}\n";
    text_model t = text_model_open(text, -1, -1, 0.0);
    if (text_model_run(&t, 1.0)) {
        const measures right = measure(t.system, 0), left = measure(t.system, 1);
        CHECK_NEAR(right.of[SE3D_WHEEL_STEER], 0.2, 1e-12);
        CHECK_NEAR(left.of[SE3D_WHEEL_ACKERMANN_ERROR], 0.03, 1e-12);
        CHECK_NEAR(left.of[SE3D_WHEEL_TOE], -left.of[SE3D_WHEEL_STEER], 1e-15);
        CHECK_NEAR(right.of[SE3D_WHEEL_TOE], right.of[SE3D_WHEEL_STEER], 1e-15);
        CHECK(right.of[SE3D_WHEEL_ACKERMANN_ERROR] < 0.0);
    }
    text_model_close(&t);
}

static measures measure_rack(const char *rack)
{
    char text[3000];
    snprintf(text, sizeof text,
             "se3d: 1\n"
             "states: [{name: s, type: ode, rate: '1', initial: 0}]\n"
             "bodies:\n"
             "  - {name: chassis, fixed: true}\n"
             "  - {name: rack, mass: 1, inertia: [1, 1, 1], position: [0.1, 0.2, 0.2]}\n"
             "  - {name: low, mass: 1, inertia: [1, 1, 1], position: [0, 0.4, 0.13]}\n"
             "  - {name: up, mass: 1, inertia: [1, 1, 1], position: [0, 0.4, 0.34]}\n"
             "  - {name: upright, mass: 8, inertia: [1, 1, 1], position: [0, 0.6, 0.25]}\n"
             "joints:\n"
             "  - {name: slide, type: prismatic, body_i: chassis, body_j: rack,\n"
             "     at: [0.1, 0.2, 0.2], axis: [0, 1, 0]}\n"
             "  - {name: pin, type: revolute, body_i: chassis, body_j: low, at: [0, 0.2, 0.14],\n"
             "     axis: [1, 0, 0]}\n"
             "  - {type: revolute, body_i: chassis, body_j: up, at: [0, 0.28, 0.33],\n"
             "     axis: [1, 0, 0]}\n"
             "  - {type: spherical, body_i: low, body_j: upright, at: [0, 0.55, 0.13]}\n"
             "  - {type: spherical, body_i: up, body_j: upright, at: [0, 0.53, 0.36]}\n"
             "  - {type: distance, body_i: rack, body_j: upright, at: [0.1, 0.2, 0.2],\n"
             "     at_2: [0.1, 0.56, 0.2], distance: 0.36}\n"
             "drivers: [{joint: slide, %s}]\n"
             "forces:\n"
             "  - {name: coil, type: tsda, body_i: chassis, body_j: upright, at: [0, 0.3, 0.5],\n"
             "     at_2: [0.05, 0.6, 0.2], k: 30000, l0: 0.5}\n"
             "wheels:\n"
             "  - {name: w, body: upright, chassis: chassis, at: [0, 0.6, 0.25], radius: 0.25,\n"
             "     lower: [0, 0.55, 0.13], upper: [0, 0.53, 0.36], spring: coil}\n"
             "analysis: {type: dynamics, duration: 1, step: 0.1}\n",
             rack);
    text_model t = text_model_open(text, -1, -1, 0.0);
    const measures found = measure(t.system, 0);
    text_model_close(&t);
    return found;
}

/* A rack that stands, and one that sets off from there at a rate: neither is part of the travel;
 * one that follows the arm by its angle, and by its rate, is. */
static void a_rack_on_a_rate_measures_as_one_on_a_value(void)
{
    static const char *const racks[][2] = {
        {"value: 0", "rate: '(3 + s.value)*t + 2*s.value'"},
        {"value: '0.1*sin(1 + pin.angle) - 0.1*sin(1)'",
         "rate: '(0.1*cos(1 + pin.angle) + s.value)*pin.rate + 7*t'"}};
    measures found[2][2];
    for (int k = 0; k < 4; ++k) {
        found[k / 2][k % 2] = measure_rack(racks[k / 2][k % 2]);
    }
    for (int k = 0; k < 2 * SE3D_WHEEL_MEASURES; ++k) {
        const int m = k / 2;
        const double a = found[k % 2][0].of[m], b = found[k % 2][1].of[m];
        CHECK((isnan(a) && isnan(b)) || fabs(a - b) <= 1e-10 * (1.0 + fabs(a)));
    }
    CHECK(fabs(found[1][0].of[SE3D_WHEEL_TOE_GRADIENT] - found[0][0].of[SE3D_WHEEL_TOE_GRADIENT]) >
          1e-3);
}

static void what_a_wheel_uses_stays(void)
{
    text_model t = text_model_open(driven, -1, -1, 0.0);
    se3d_force spring;
    se3d_constraint road;
    se3d_wheel wheel;
    se3d_system *copy = NULL;
    const char *name = NULL;
    CHECK(!se3d_system_clone(t.system, &copy));
    CHECK(!se3d_system_get_wheel(copy, 0, &wheel));
    CHECK(!se3d_wheel_get_name(copy, wheel, &name) && name && strcmp(name, "wheel") == 0);
    CHECK(!se3d_force_find(copy, "spring", &spring));
    CHECK(!se3d_constraint_find(copy, "road", &road));
    CHECK(se3d_force_destroy(copy, spring) == SE3D_ERR_IN_USE);
    CHECK_CONTAINS(se3d_system_get_error(copy), "1 wheels");
    CHECK(se3d_constraint_destroy(copy, road) == SE3D_ERR_IN_USE);
    const measures before = measure(copy, 0), same = measure(t.system, 0);
    CHECK(memcmp(&before, &same, sizeof same) == 0);
    CHECK(!se3d_wheel_destroy(copy, wheel));
    CHECK(!se3d_force_destroy(copy, spring) && !se3d_constraint_destroy(copy, road));
    CHECK(se3d_wheel_destroy(copy, wheel) == SE3D_ERR_STALE_HANDLE);
    se3d_system_destroy(copy);
    text_model_close(&t);
}

static void mistakes_of_wheels_are_named(void)
{
    static const char *const rows[][2] = {
        {"body: arm, chassis: chassis, at: [0, 0, 0]", "radius"},
        {"body: arm, chassis: arm, at: [0, 0, 0], radius: 1", "own body"},
        {"body: arm, chassis: chassis, radius: 1", "where the wheel centre is"},
        {"body: arm, chassis: chassis, at: [0, 0, 0], radius: -1", "> 0"},
        {"body: arm, chassis: chassis, at: [0, 0, 0], radius: 1, travel: pim", "`pin`"},
        {"body: arm, chassis: chassis, at: [0, 0, 0], radius: 1, spring: pin", "nothing that can"},
        {"body: arm, chassis: chassis, at: [0, 0, 0], radius: 1, lower: [0, 0, 0]", "upper"},
        {"body: arm, chassis: chassis, at: [0, 0, 0], radius: 1, axis: [0, 0, 1]", "to the left"},
        {"body: arm, chassis: chassis, at: [0, 0, 0], radius: 1, up: [1, 0, 0]", "parallel"},
        {"body: arm, chassis: chassis, at: [0, 0, 0], radius: 1, brake_share: 2", "brake_share"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        char text[1000];
        se3d_model *model = NULL;
        se3d_model_error error;
        snprintf(text, sizeof text,
                 "se3d: 1\nbodies:\n  - {name: chassis, fixed: true}\n"
                 "  - {name: arm, mass: 1, inertia: [1, 1, 1]}\n"
                 "joints: [{name: pin, type: revolute, body_i: chassis, body_j: arm, at: [0, 1, 0],"
                 " axis: [1, 0, 0]}]\nwheels: [{name: w, %s}]\n",
                 rows[k][0]);
        CHECK(se3d_model_read_text(text, strlen(text), "m", NULL, &model, &error) ==
              SE3D_ERR_MODEL);
        CHECK_CONTAINS(error.message, rows[k][1]);
        se3d_model_destroy(model);
    }
}

int main(void)
{
    RUN(planar_wishbones_have_their_closed_forms);
    RUN(derivatives_are_those_of_a_sweep);
    RUN(mirrored_corners_measure_the_same);
    RUN(the_steer_axis_is_found_from_the_motion);
    RUN(the_wheel_rate_is_the_slope_of_equilibria);
    RUN(a_trailing_arm_turns_about_its_pin);
    RUN(ackermann_is_about_one_centre);
    RUN(a_rack_on_a_rate_measures_as_one_on_a_value);
    RUN(what_a_wheel_uses_stays);
    RUN(mistakes_of_wheels_are_named);
    return check_finish();
}
