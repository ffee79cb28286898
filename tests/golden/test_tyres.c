/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyres: forces by an independent program (tyre_reference.py), and wheels that coast, brake, corner
 * and stand. */
#include "support/text_model.h"

#include "golden/tyre_reference.h"

#include <math.h>
#include <string.h>

#define G 9.81

/* Some of the values are the same bits as among all of them. */
static void check_ranges(const se3d_system *system, se3d_force tyre, const double *all)
{
    for (size_t first = 0; first < SE3D_TYRE_VALUES; ++first) {
        for (size_t count = 1; count <= SE3D_TYRE_VALUES - first; ++count) {
            double some[SE3D_TYRE_VALUES];
            CHECK(!se3d_tyre_get_values(system, tyre, first, count, some));
            CHECK(memcmp(some, all + first, count * sizeof *some) == 0);
        }
    }
}

/* Any two, and zeros beside them. */
static void check_pairs(const se3d_system *system, se3d_force tyre, const double *all)
{
    for (uint32_t i = 0; i < SE3D_TYRE_VALUES; ++i) {
        for (uint32_t j = i; j < SE3D_TYRE_VALUES; ++j) {
            double some[SE3D_TYRE_VALUES], wanted[SE3D_TYRE_VALUES] = {0.0};
            wanted[i] = all[i];
            wanted[j] = all[j];
            CHECK(!se3d_tyre_get_some(system, tyre, 1u << i | 1u << j, some));
            CHECK(memcmp(some, wanted, sizeof some) == 0);
        }
    }
}

/* A wheel in the state {h, g, u, v, W} over the road z = 0, turning about its normal. */
static void get_forces(const se3d_tyre_def *given, const double state[5], double turning,
                       int on_right, double values[SE3D_TYRE_VALUES])
{
    se3d_system *system;
    se3d_force tyre;
    se3d_tyre_def def = *given;
    se3d_body_def body = se3d_body_def_default();
    const double side = on_right ? -1.0 : 1.0;
    const double half = 0.5 * side * state[1];
    CHECK(!se3d_system_create(NULL, &system));
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.position[2] = state[0];
    body.orientation[0] = cos(half);
    body.orientation[1] = sin(half);
    body.velocity[0] = state[2];
    body.velocity[1] = side * state[3];
    body.angular_velocity[1] = state[4];
    body.angular_velocity[2] = side * turning * cos(state[1]);
    CHECK(!se3d_body_create(system, &body, &def.wheel));
    CHECK(!se3d_system_get_ground(system, &def.road));
    def.side = on_right ? SE3D_TYRE_RIGHT : SE3D_TYRE_LEFT;
    def.measured_side = SE3D_TYRE_LEFT;
    def.axis[1] = side;
    CHECK(!se3d_force_create_tyre(system, &def, &tyre));
    CHECK(!se3d_tyre_get_values(system, tyre, 0, SE3D_TYRE_VALUES, values));
    check_ranges(system, tyre, values);
    check_pairs(system, tyre, values);
    se3d_system_destroy(system);
}

static se3d_tyre_def simple_tyre(int32_t law)
{
    se3d_tyre_def def = se3d_tyre_def_default();
    def.law = law;
    def.radius = 0.31;
    def.k = 1.8e5;
    def.c = 400.0;
    def.mu = 1.1;
    def.mu_min = law == SE3D_TYRE_FIALA ? 0.7 : 0.0;
    def.slip_stiffness = 4.5e4;
    def.cornering_stiffness = 3.2e4;
    def.patch_length = 0.14;
    def.rolling_resistance = 0.012;
    return def;
}

static void compare(const se3d_tyre_def *def, const double *rates, const double expected[][6])
{
    double values[SE3D_TYRE_VALUES], right[SE3D_TYRE_VALUES];
    for (int k = 0; k < TYRE_STATES; ++k) {
        const double rate = rates ? rates[k] : 0.0;
        get_forces(def, tyre_states[k], rate, 0, values);
        for (int c = 0; c < 6; ++c) {
            CHECK_NEAR(values[c], expected[k][c], 1e-9 * (1.0 + fabs(expected[k][c])));
        }
        get_forces(def, tyre_states[k], rate, 1, right);
        for (int c = 0; c < 6; ++c) { /* the other side is its mirror image */
            const double mirrored = c == SE3D_TYRE_FY || c == SE3D_TYRE_MX || c == SE3D_TYRE_MZ
                                        ? -values[c]
                                        : values[c];
            CHECK_NEAR(right[c], mirrored, 1e-9 * (1.0 + fabs(mirrored)));
        }
    }
}

/* The set of tyre_reference.py. */
static void take_coefficients(se3d_tyre_def *magic, double c[SE3D_TYRE_COEFFICIENTS])
{
    se3d_tyre_coefficients_init(c, SE3D_TYRE_COEFFICIENTS);
    for (size_t k = 0; k < sizeof tyre_coefficients / sizeof *tyre_coefficients; ++k) {
        c[tyre_coefficients[k].at] = tyre_coefficients[k].value;
    }
    magic->coefficients = c;
    magic->coefficient_count = SE3D_TYRE_COEFFICIENTS;
}

static void forces_agree_with_an_independent_program(void)
{
    const se3d_tyre_def brush = simple_tyre(SE3D_TYRE_BRUSH);
    const se3d_tyre_def fiala = simple_tyre(SE3D_TYRE_FIALA);
    se3d_tyre_def magic = brush;
    double c[SE3D_TYRE_COEFFICIENTS];
    take_coefficients(&magic, c);
    magic.law = SE3D_TYRE_MF52;
    compare(&magic, NULL, tyre_mf52);
    magic.law = SE3D_TYRE_MF61;
    compare(&magic, NULL, tyre_mf61);
    compare(&magic, tyre_rates, tyre_mf61); /* without turn slip it does not count */
    magic.has_turn_slip = 1;
    compare(&magic, tyre_rates, tyre_turning61);
    magic.law = SE3D_TYRE_MF52;
    compare(&magic, tyre_rates, tyre_turning52);
    compare(&brush, tyre_rates, tyre_brush);
    compare(&fiala, NULL, tyre_fiala);
}

/* MFeval 4.0 (M. Furlan) for the same coefficients without LGAX, LGAY, LGAZ and LMX, which it does
 * not have or has elsewhere: Fx, Fy, Mx, My without the moment of Fx, Mz. */
typedef struct published {
    double state[5]; /* h, g, u, v, W */
    double of52[5], of61[5];
} published;

static const published mfeval[] = {
    {{0.300, 0.0, 20.0, 0.35, 65.0},
     {-214.3356, -482.956948, -30.6193687, -2.39122616, 17.4275092},
     {-214.3356, -482.956948, -30.6193687, -2.32808959, 17.4275092}},
    {{0.2975, 0.04, 16.7, -0.5, 53.0},
     {-1898.92432, 658.350323, 12.5964886, 34.6474752, -71.5313759},
     {-1898.92432, 617.442819, 10.0330844, 31.5120475, -75.1989451}},
    {{0.292, -0.06, 30.0, 2.4, 99.0},
     {1005.5891, -1585.63845, -97.0571112, -44.724082, 92.7652657},
     {1005.5891, -1469.7958, -87.0610065, -44.8884634, 106.095807}},
    {{0.304, 0.02, 12.0, -0.9, 38.5},
     {-412.662187, 1260.60163, 35.1191047, 0.954070143, -37.0918127},
     {-412.662187, 1260.12998, 35.1037077, 0.906711129, -37.6242137}},
    {{0.296, 0.08, 25.0, 0.2, 60.0},
     {-2704.01816, -136.713254, -65.2659075, 55.1526429, -80.5412009},
     {-2704.01816, -162.377776, -67.0398348, 46.2345914, -80.3937399}},
    {{0.301, -0.03, 18.0, 4.5, 62.0},
     {667.027965, -2209.42168, -96.3892371, -16.1210962, 11.9804594},
     {667.027965, -2209.41251, -96.3888171, -16.3837062, 12.1058924}},
    {{0.290, 0.05, 35.0, -1.1, 121.0},
     {4239.61286, 483.267779, -8.22754215, -167.090405, 88.2225296},
     {4239.61286, 386.801727, -17.1155111, -151.088655, 83.231213}},
    {{0.305, -0.08, 22.0, -3.0, 45.0},
     {-812.889794, 337.147341, 27.0337444, 3.333823, 6.20240371},
     {-812.889794, 337.057184, 27.0309808, 2.81793664, 6.203717}},
};

static void forces_agree_with_mfeval(void)
{
    se3d_tyre_def magic = simple_tyre(SE3D_TYRE_MF52);
    double c[SE3D_TYRE_COEFFICIENTS], values[SE3D_TYRE_VALUES];
    take_coefficients(&magic, c);
    c[SE3D_TYRE_LGAX] = c[SE3D_TYRE_LGAY] = c[SE3D_TYRE_LGAZ] = c[SE3D_TYRE_LMX] = 1.0;
    for (size_t k = 0; k < sizeof mfeval / sizeof *mfeval; ++k) {
        for (int is61 = 0; is61 < 2; ++is61) {
            const double *of = is61 ? mfeval[k].of61 : mfeval[k].of52;
            magic.law = is61 ? SE3D_TYRE_MF61 : SE3D_TYRE_MF52;
            get_forces(&magic, mfeval[k].state, 0.0, 0, values);
            const double arm = values[SE3D_TYRE_LOADED_RADIUS] - values[SE3D_TYRE_ROLLING_RADIUS];
            values[SE3D_TYRE_MY] -= arm * values[SE3D_TYRE_FX];
            const int at[] = {SE3D_TYRE_FX, SE3D_TYRE_FY, SE3D_TYRE_MX, SE3D_TYRE_MY, SE3D_TYRE_MZ};
            for (int i = 0; i < 5; ++i) {
                CHECK_NEAR(values[at[i]], of[i], 2e-7 * (1.0 + fabs(of[i])));
            }
        }
    }
}

/* Slip forces end at FZMAX; what rolls resists by all of its load. */
static void resistance_to_rolling_has_no_limit_of_load(void)
{
    for (int is61 = 0; is61 < 2; ++is61) {
        se3d_tyre_def magic = simple_tyre(is61 ? SE3D_TYRE_MF61 : SE3D_TYRE_MF52);
        double c[SE3D_TYRE_COEFFICIENTS], whole[SE3D_TYRE_VALUES], limited[SE3D_TYRE_VALUES];
        take_coefficients(&magic, c);
        c[SE3D_TYRE_QSY2] = 0.0;
        get_forces(&magic, mfeval[1].state, 0.0, 0, whole);
        c[SE3D_TYRE_FZMAX] = 0.5 * whole[SE3D_TYRE_FZ];
        get_forces(&magic, mfeval[1].state, 0.0, 0, limited);
        CHECK(fabs(limited[SE3D_TYRE_FX]) < 0.7 * fabs(whole[SE3D_TYRE_FX]));
        const double arm = whole[SE3D_TYRE_LOADED_RADIUS] - whole[SE3D_TYRE_ROLLING_RADIUS];
        const double of_whole = whole[SE3D_TYRE_MY] - arm * whole[SE3D_TYRE_FX];
        CHECK(fabs(of_whole) > 1.0);
        CHECK_NEAR(limited[SE3D_TYRE_MY] - arm * limited[SE3D_TYRE_FX], of_whole, 1e-12);
    }
}

/* What camber does to a wheel that rolls freely is what its spin about the road's normal does: with
 * turn slip the slopes of force and moment stay as they are without (there S_Vygamma is a part). A
 * wheel that turns on the spot is held by a moment against its turning, in proportion to it. */
static void turn_slip_holds_camber_and_parking(void)
{
    se3d_tyre_def magic = simple_tyre(SE3D_TYRE_MF61);
    double c[SE3D_TYRE_COEFFICIENTS], values[SE3D_TYRE_VALUES], slope[2][2];
    const double h = 1e-6;
    take_coefficients(&magic, c);
    c[SE3D_TYRE_LHY] = c[SE3D_TYRE_LVY] = c[SE3D_TYRE_LRES] = c[SE3D_TYRE_PPZ2] = 0.0;
    c[SE3D_TYRE_QHZ1] = c[SE3D_TYRE_QHZ2] = c[SE3D_TYRE_QHZ3] = c[SE3D_TYRE_QHZ4] = 0.0;
    c[SE3D_TYRE_SSZ1] = c[SE3D_TYRE_SSZ2] = c[SE3D_TYRE_SSZ3] = c[SE3D_TYRE_SSZ4] = 0.0;
    c[SE3D_TYRE_QEZ4] = c[SE3D_TYRE_PEY3] = c[SE3D_TYRE_PEX4] = c[SE3D_TYRE_PDYP4] = 0.0;
    c[SE3D_TYRE_QCRP2] = c[SE3D_TYRE_PPX3] = c[SE3D_TYRE_INFLPRES] = 0.0;
    c[SE3D_TYRE_RHX1] = c[SE3D_TYRE_RHY1] = c[SE3D_TYRE_RHY2] = 0.0;
    magic.mu = 1.0 / c[SE3D_TYRE_LMUY];
    for (int turns = 0; turns < 2; ++turns) {
        double side[2][2];
        magic.has_turn_slip = turns;
        for (int k = 0; k < 2; ++k) { /* where R0 W = V the spin is that of the formula */
            const double state[5] = {0.3, k ? h : -h, 20.0, 0.0, 20.0 / magic.radius};
            get_forces(&magic, state, 0.0, 0, values);
            side[k][0] = values[SE3D_TYRE_FY];
            side[k][1] = values[SE3D_TYRE_MZ];
        }
        slope[turns][0] = (side[1][0] - side[0][0]) / (2.0 * h);
        slope[turns][1] = (side[1][1] - side[0][1]) / (2.0 * h);
    }
    CHECK(fabs(slope[0][0]) > 100.0 && fabs(slope[0][1]) > 10.0);
    CHECK_NEAR(slope[1][0], slope[0][0], 1e-4 * fabs(slope[0][0]));
    CHECK_NEAR(slope[1][1], slope[0][1], 1e-2 * fabs(slope[0][1]));
    double before = 0.0;
    for (int k = 1; k <= 8; ++k) { /* on the spot, to the left */
        const double state[5] = {0.3, 0.0, 0.0, 0.0, 0.0};
        get_forces(&magic, state, 0.25 * k, 0, values);
        CHECK(values[SE3D_TYRE_MZ] < before);
        CHECK_NEAR(values[SE3D_TYRE_TURN_SLIP], 0.5 * k, 1e-12);
        CHECK(fabs(values[SE3D_TYRE_FX]) < 1e-9);
        before = values[SE3D_TYRE_MZ];
    }
    CHECK(before > -c[SE3D_TYRE_QCRP1] * 2.0 * 1800.0 * 0.31 * 1.5); /* below M_zphi */
}

/* A box that stays level at the height h, and its wheel on a load of k 7.5 mm = 1500 N; %s: the
 * law, the resistance to rolling, and what comes on top. */
#define CARRIAGE                                                                                   \
    "se3d: 1\n"                                                                                    \
    "parameters: {u: 20, h: 0.2925}\n"                                                             \
    "bodies:\n"                                                                                    \
    "  - {name: box, mass: 200, inertia: [5, 5, 5], position: [0, 0, h], velocity: [u, 0, 0]}\n"   \
    "  - {name: rim, mass: 20, inertia: [0.5, 0.9, 0.5], position: [0, 0, h],\n"                   \
    "     velocity: [u, 0, 0], angular_velocity: [0, u/0.2975, 0]}\n"                              \
    "constraints:\n"                                                                               \
    "  - {type: dp1, body_i: ground, body_j: box, a_i: [1, 0, 0], a_j: [0, 1, 0]}\n"               \
    "  - {type: dp1, body_i: ground, body_j: box, a_i: [1, 0, 0], a_j: [0, 0, 1]}\n"               \
    "  - {type: dp1, body_i: ground, body_j: box, a_i: [0, 1, 0], a_j: [0, 0, 1]}\n"               \
    "  - {name: level, type: cd, body_i: ground, body_j: box, c: [0, 0, 1], value: h}\n"           \
    "joints:\n"                                                                                    \
    "  - {name: hub, type: revolute, body_i: box, body_j: rim, at: [0, 0, h], axis: [0, 1, 0]}\n"  \
    "forces:\n"                                                                                    \
    "  - {name: tyre, type: tyre, body: rim, radius: 0.3, k: 2e5, mu: 0.9, model: %s,\n"           \
    "     slip_stiffness: 5e4, cornering_stiffness: 4e4, rolling_resistance: %s}\n"                \
    "%s"                                                                                           \
    "analysis: {type: dynamics, duration: 10}\n"                                                   \
    "output: [{file: o.csv, every: 0.1, channels: [box.position, box.velocity, "                   \
    "rim.angular_velocity, tyre.fx, tyre.slip_ratio, energy.balance, energy.dissipated]}]\n"
enum { POSITION, VELOCITY, SPIN, FX, SLIP, BALANCE, LOST };

static text_model open_carriage(const char *law, const char *resistance, const char *more)
{
    char text[4000];
    snprintf(text, sizeof text, CARRIAGE, law, resistance, more);
    return text_model_open(text, -1, -1, 0.0);
}

/* u^2 m / (2 |Fx|), but for what is left of the speed where slip is regularised. */
static void a_locked_wheel_stops_in_the_distance_of_mu(void)
{
    static const char *const laws[2] = {"brush", "fiala"};
    for (int k = 0; k < 2; ++k) {
        text_model m =
            open_carriage(laws[k], "0", "drivers: [{name: lock, joint: hub, value: 0}]\n");
        text_model_run(&m, 0.0); /* the lock stops the spin at once */
        const double balance = text_model_get(&m, BALANCE, 0);
        text_model_run(&m, 10.0);
        const double whole = 0.9 * 1500.0; /* fiala: at kappa = -1 it does not slide wholly */
        const double force = k == 0 ? whole : whole - whole * whole / (4.0 * 5e4);
        const double distance = 20.0 * 20.0 * 220.0 / (2.0 * force);
        CHECK_NEAR(text_model_get(&m, POSITION, 0), distance, 2e-3 * distance);
        CHECK_NEAR(text_model_get(&m, VELOCITY, 0), 0.0, 1e-6);
        CHECK_NEAR(text_model_get(&m, BALANCE, 0), balance, 1e-3 * 0.5 * 220.0 * 400.0);
        text_model_close(&m);
    }
}

static void a_wheel_without_resistance_rolls_on(void)
{
    text_model m = open_carriage("brush", "0", "");
    CHECK(text_model_run(&m, 4.0));
    CHECK_NEAR(text_model_get(&m, VELOCITY, 0), 20.0, 2e-5);
    CHECK_NEAR(text_model_get(&m, SPIN, 1), 20.0 / 0.2975, 1e-3);
    CHECK_NEAR(text_model_get(&m, LOST, 0), 0.0, 1e-3);
    text_model_close(&m);
}

/* By the energies, the speed falls by f Fz / (m + J / r_e^2), but for the little slip. */
static void a_wheel_slows_by_its_resistance_to_rolling(void)
{
    text_model m = open_carriage("brush", "0.02", "");
    CHECK(text_model_run(&m, 4.0));
    const double slowing = 0.02 * 1500.0 / (220.0 + 0.9 / (0.2975 * 0.2975));
    CHECK_NEAR(text_model_get(&m, VELOCITY, 0), 20.0 - 4.0 * slowing, 1e-3);
    CHECK(text_model_get(&m, SLIP, 0) < 0.0);
    text_model_close(&m);
}

/* J W' = T - r_e Fx and m u' = Fx, with W r_e = u but for the little slip. */
static void a_driven_wheel_pushes_with_its_torque(void)
{
    text_model m =
        open_carriage("brush", "0", "  - {name: engine, type: effort, joint: hub, value: 300}\n");
    CHECK(text_model_run(&m, 3.0));
    const double force = 300.0 / (0.2975 + 0.9 / (220.0 * 0.2975));
    CHECK_NEAR(text_model_get(&m, FX, 0), force, 2e-3 * force);
    CHECK(text_model_get(&m, SLIP, 0) > 0.0);
    text_model_close(&m);
}

#define DROP                                                                                       \
    "se3d: 1\n"                                                                                    \
    "bodies:\n"                                                                                    \
    "  - {name: rim, mass: 50, inertia: [0.5, 0.9, 0.5], position: [0, 0, 0.5],\n"                 \
    "     velocity: [0, 0, 0]}\n"                                                                  \
    "forces:\n"                                                                                    \
    "  - {name: tyre, type: tyre, body: rim, radius: 0.3, k: 2e5, c: %d, mu: 0.9,\n"               \
    "     slip_stiffness: 5e4, cornering_stiffness: 4e4}\n"                                        \
    "analysis: {type: dynamics, duration: 4, tolerance: %s}\n"                                     \
    "output: [{file: o.csv, every: 0.1, channels: [rim.position, tyre.fz, energy.balance]}]\n"

/* A wheel that falls, bounces, comes to rest and stays there. */
static void the_road_never_pulls_and_what_rests_stays(void)
{
    char text[sizeof DROP + 40];
    snprintf(text, sizeof text, DROP, 1500, "1e-6");
    text_model m = text_model_open(text, -1, -1, 0.0);
    const double balance = text_model_get(&m, 2, 0);
    int flies_again = 0;
    for (int k = 1; k <= 400; ++k) {
        CHECK(text_model_run(&m, 0.01 * k));
        const double force = text_model_get(&m, 1, 0), height = text_model_get(&m, 0, 2);
        CHECK(force >= 0.0);
        CHECK(!(height > 0.3 && force > 0.0));
        flies_again |= k > 25 && height > 0.3;
    }
    CHECK(flies_again);
    CHECK_NEAR(text_model_get(&m, 0, 2), 0.3 - 50.0 * G / 2e5, 1e-6);
    CHECK_NEAR(text_model_get(&m, 0, 0), 0.0, 1e-12);
    CHECK_NEAR(text_model_get(&m, 1, 0), 50.0 * G, 1e-3);
    CHECK_NEAR(text_model_get(&m, 2, 0), balance, 1e-3 * 50.0 * G * 0.2);
    text_model_close(&m);
}

/* Steps end where it meets the road and leaves it: without that it takes 1,191 of 4 s, and 510 more
 * in vain. */
static void steps_end_where_a_wheel_meets_the_road(void)
{
    static const char *const tolerances[3] = {"1e-9", "1e-11", "1e-9"};
    static const double starts[3] = {0.0, 0.0, 1e6};
    double height[3], balance[3];
    se3d_solver_stats stats[3];
    for (int k = 0; k < 3; ++k) {
        char text[sizeof DROP + 40];
        snprintf(text, sizeof text, DROP, 300, tolerances[k]);
        text_model m = text_model_open(text, SE3D_METHOD_DOP853, -1, 0.0);
        CHECK(!se3d_system_set_time(m.system, starts[k]));
        CHECK(text_model_run(&m, starts[k] + 4.0));
        height[k] = text_model_get(&m, 0, 2);
        balance[k] = text_model_get(&m, 2, 0);
        CHECK(!se3d_solver_get_stats(m.solver, &stats[k]));
        text_model_close(&m);
    }
    CHECK(stats[0].steps < 700 && stats[0].rejected < 350);
    CHECK_NEAR(height[0], height[1], 1e-9);
    CHECK_NEAR(balance[0], 50.0 * G * 0.5, 1e-5);
    CHECK_NEAR(balance[1], 50.0 * G * 0.5, 1e-6);
    CHECK_NEAR(height[2], height[1], 1e-8); /* times are known to 1e-10 s */
}

/* A rim that is carried along at u and held at a slip angle and a slip ratio, which begin at once;
 * %s: the tyre's other keys. */
#define TOWED                                                                                      \
    "se3d: 1\n"                                                                                    \
    "parameters: {u: 12, a: 3*deg, r: 0.29, kappa: 0.01}\n"                                        \
    "bodies:\n"                                                                                    \
    "  - {name: cart, mass: 10, inertia: [1, 1, 1], position: [0, 0, r], velocity: [u, 0, 0]}\n"   \
    "  - {name: rim, mass: 5, inertia: [0.5, 0.9, 0.5], position: [0, 0, r],\n"                    \
    "     orientation: {rpy: [0, 0, -a]}, velocity: [u, 0, 0]}\n"                                  \
    "joints:\n"                                                                                    \
    "  - {name: rail, type: prismatic, body_i: ground, body_j: cart, at: [0, 0, r], axis: [1, 0, " \
    "0]}\n"                                                                                        \
    "  - {name: hub, type: revolute, body_i: cart, body_j: rim, at: [0, 0, r],\n"                  \
    "     axis: [sin(a), cos(a), 0]}\n"                                                            \
    "drivers:\n"                                                                                   \
    "  - {name: tow, joint: rail, value: u*t}\n"                                                   \
    "  - {name: spin, joint: hub, value: (1 + kappa)*u*cos(a)/r*t}\n"                              \
    "forces: [{name: tyre, type: tyre, body: rim, radius: 0.3, k: 2e5, rolling_radius: r, %s,\n"   \
    "   axis: [sin(a), cos(a), 0]}]\n"                                                             \
    "analysis: {type: dynamics, duration: 1, tolerance: 1e-8}\n"                                   \
    "output: [{file: o.csv, every: 0.1, channels: [tyre.lagged_angle, tyre.lagged_ratio,\n"        \
    "   tyre.slip_angle, tyre.fy, tyre.fx]}]\n"

/* tan(alpha) (1 - exp(-x / sigma)) after the distance x; the same of the slip ratio. */
static void slip_that_lags_rises_with_the_distance(void)
{
    char text[4000];
    const double u = 12.0, a = 3.0 * 3.14159265358979323846 / 180.0, V = u * cos(a);
    snprintf(text, sizeof text, TOWED,
             "mu: 0.9, model: fiala, slip_stiffness: 5e4, cornering_stiffness: 4e4, "
             "relaxation_x: 0.15, relaxation_y: 0.4");
    text_model m = text_model_open(text, -1, -1, 0.0);
    for (int k = 1; k <= 10; ++k) {
        const double t = 0.02 * k, way = V * t;
        CHECK(text_model_run(&m, t));
        const double tangent = tan(a) * (1.0 - exp(-way / 0.4));
        const double f = 0.9 * 2000.0, theta = 4e4 * tangent / (3.0 * f);
        CHECK_NEAR(fabs(tan(text_model_get(&m, 0, 0))), tangent, 1e-8);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.01 * (1.0 - exp(-way / 0.15)), 1e-8);
        CHECK_NEAR(fabs(text_model_get(&m, 2, 0)), a, 1e-9);
        CHECK_NEAR(fabs(text_model_get(&m, 3, 0)),
                   theta < 1.0 ? 4e4 * tangent * (1.0 - theta + theta * theta / 3.0) : f, 1e-3);
        CHECK_NEAR(text_model_get(&m, 4, 0), 5e4 * 0.01 * (1.0 - exp(-way / 0.15)), 1e-3);
    }
    text_model_close(&m);
}

int main(void)
{
    RUN(forces_agree_with_an_independent_program);
    RUN(forces_agree_with_mfeval);
    RUN(resistance_to_rolling_has_no_limit_of_load);
    RUN(turn_slip_holds_camber_and_parking);
    RUN(a_locked_wheel_stops_in_the_distance_of_mu);
    RUN(a_wheel_without_resistance_rolls_on);
    RUN(a_wheel_slows_by_its_resistance_to_rolling);
    RUN(a_driven_wheel_pushes_with_its_torque);
    RUN(the_road_never_pulls_and_what_rests_stays);
    RUN(steps_end_where_a_wheel_meets_the_road);
    RUN(slip_that_lags_rises_with_the_distance);
    return check_finish();
}
