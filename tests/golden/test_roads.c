/* SPDX-License-Identifier: BSD-3-Clause */
/* Roads: heights against formulas, a quarter car on a sine against its transfer function, a wheel
 * on a slope, a disc on a step, and the energy of what drives over obstacles. */
#include "check.h"
#include "se3d/io.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static se3d_model *read(const char *text)
{
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    const se3d_status status =
        se3d_model_read_text(text, strlen(text), "road.yaml", NULL, &model, &error);
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s\n", error.message);
    }
    return model;
}

static void run(se3d_model *model, se3d_solver *solver, double t)
{
    CHECK(se3d_solver_run(solver, t) >= 0);
    if (se3d_system_get_error(se3d_model_get_system(model))[0]) {
        fprintf(stderr, "%s\n", se3d_system_get_error(se3d_model_get_system(model)));
    }
}

/* ---- A quarter car on a sine ---------------------------------------------------------------*/

#define SPRUNG   300.0
#define UNSPRUNG 40.0 /* hub and wheel */
#define SPRING   20000.0
#define DAMPER   3000.0
#define TYRE     180000.0
#define RUBBER   120.0
#define SPEED    5.0
#define WAVES    2.4 /* [rad/m] */
#define HIGH     1e-4

#define QUARTER_CAR                                                                                \
    "bodies:\n"                                                                                    \
    "- {name: carriage, mass: 1, inertia: [1, 1, 1], position: [0, 0, 1], velocity: [5, 0, 0]}\n"  \
    "- {name: hub, mass: 25, inertia: [1, 1, 1], position: [0, 0, z], velocity: [5, 0, 0]}\n"      \
    "- {name: wheel, mass: 15, inertia: [0.5, 0.9, 0.5], position: [0, 0, z], velocity: [5, 0, "   \
    "0], angular_velocity: [0, 5/0.29, 0]}\n"                                                      \
    "- {name: car, mass: 300, inertia: [9, 9, 9], position: [0, 0, 0.8], velocity: [5, 0, 0]}\n"   \
    "joints:\n"                                                                                    \
    "- {name: rail, type: prismatic, body_i: ground, body_j: carriage, at: [0, 0, 1], axis: [1, "  \
    "0, 0]}\n"                                                                                     \
    "- {name: upright, type: prismatic, body_i: carriage, body_j: hub, at: [0, 0, z], axis: [0, "  \
    "0, 1]}\n"                                                                                     \
    "- {name: strut, type: prismatic, body_i: carriage, body_j: car, at: [0, 0, 0.8], axis: [0, "  \
    "0, 1]}\n"                                                                                     \
    "- {name: bearing, type: revolute, body_i: hub, body_j: wheel, at: [0, 0, z], axis: [0, 1, "   \
    "0]}\n"                                                                                        \
    "drivers: [{name: ride, joint: rail, value: 5*t}]\n"                                           \
    "forces:\n"                                                                                    \
    "- {name: spring, type: tsda, body_i: hub, body_j: car, k: 20000, c: 3000, l0: 0.8 - z, "      \
    "preload: -300*9.81}\n"                                                                        \
    "- {name: tyre, type: tyre, body: wheel, road: way, radius: 0.3, k: 180000, c: 120, mu: 1, "   \
    "rolling_radius: 0.29, slip_stiffness: 2e4, cornering_stiffness: 2e4}\n"                       \
    "parameters: {z: 0.3 - 340*9.81/180000}\n"                                                     \
    "analysis: {type: dynamics, duration: 1, tolerance: 1e-12}\n"

/* z / h of the sprung (0) and the unsprung mass (1) at w, as cosine and sine. */
static void transfer(double w, double z[2][2])
{
    /* complex: (ks - ms w^2 + i c w) zs = (ks + i c w) zu, and the sum of both masses */
    const double a[2] = {SPRING - SPRUNG * w * w, DAMPER * w}, b[2] = {SPRING, DAMPER * w};
    const double size = a[0] * a[0] + a[1] * a[1];
    const double g[2] = {(b[0] * a[0] + b[1] * a[1]) / size, (b[1] * a[0] - b[0] * a[1]) / size};
    /* (-ms w^2 g - mu w^2 + kt + i ct w) zu = (kt + i ct w) h */
    const double d[2] = {TYRE - w * w * (SPRUNG * g[0] + UNSPRUNG),
                         RUBBER * w - w * w * SPRUNG * g[1]};
    const double over = d[0] * d[0] + d[1] * d[1];
    z[1][0] = (TYRE * d[0] + RUBBER * w * d[1]) / over;
    z[1][1] = (RUBBER * w * d[0] - TYRE * d[1]) / over;
    z[0][0] = g[0] * z[1][0] - g[1] * z[1][1];
    z[0][1] = g[0] * z[1][1] + g[1] * z[1][0];
}

/* The response to sin(w t) of both masses after transients, over one period. */
static void check_quarter_car(const char *roads, double w, double allowed)
{
    enum { POINTS = 32 };
    char text[4000];
    double exact[2][2], found[2][2] = {{0.0}};
    snprintf(text, sizeof text, "se3d: 1\nroads: [{name: way, type: height, height: \"%s\"}]\n%s",
             roads, QUARTER_CAR);
    se3d_model *model = read(text);
    if (!model) {
        return;
    }
    se3d_system *system = se3d_model_get_system(model);
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    se3d_body bodies[2];
    const char *const names[2] = {"car", "hub"};
    CHECK(!se3d_model_get_solver(model, 0, &def));
    CHECK(!se3d_solver_create(system, &def, &solver));
    const double start = 12.0 * pi / w * ceil(4.0 * w / (12.0 * pi));
    for (int k = 0; k < POINTS; ++k) {
        const double t = start + 2.0 * pi * k / (w * POINTS);
        run(model, solver, t);
        for (int b = 0; b < 2; ++b) {
            double r[3];
            CHECK(!se3d_body_find(system, names[b], &bodies[b]));
            CHECK(!se3d_body_get_position(system, bodies[b], r));
            found[b][0] += 2.0 * r[2] * sin(w * t) / (POINTS * HIGH);
            found[b][1] += 2.0 * r[2] * cos(w * t) / (POINTS * HIGH);
        }
    }
    transfer(w, exact);
    for (int b = 0; b < 2; ++b) {
        CHECK_NEAR(found[b][0], exact[b][0], allowed);
        CHECK_NEAR(found[b][1], exact[b][1], allowed);
    }
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

static void a_quarter_car_follows_its_transfer_function(void)
{
    check_quarter_car("1e-4*sin(2.4*x)", WAVES * SPEED, 1e-6);
    check_quarter_car("1e-4*sin(12*t)", 12.0, 1e-6);
    check_quarter_car("1e-4*sin(7*t + 1.3*x)", 7.0 + 1.3 * SPEED, 1e-6);
}

/* ---- What a tyre finds ---------------------------------------------------------------------*/

static double tell(se3d_system *system, const char *name, size_t which)
{
    double value = 0.0;
    se3d_force force;
    CHECK(!se3d_force_find(system, name, &force));
    CHECK(!se3d_tyre_get_values(system, force, which, 1, &value));
    return value;
}

/* A wheel of the radius 0.3 at (x, 0, 0.32) on a road, with what else its tyre says. */
static se3d_model *stand(const char *road, double x, const char *more)
{
    char text[2000];
    snprintf(text, sizeof text,
             "se3d: 1\nroads:\n- %s\nbodies:\n- {name: wheel, mass: 15, inertia: [1, 1, 1], "
             "position: [%.17g, 0, 0.32]}\nforces:\n- {name: tyre, type: tyre, body: wheel, road: "
             "way, radius: 0.3, k: 1e5, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4%s}\n",
             road, x, more);
    return read(text);
}

/* On the slope of 3 in 4 the plane is exact at a point and over obstacles, however it is said. */
static void a_wheel_on_a_slope_finds_the_slope(void)
{
    static const char *const roads[] = {
        "{name: way, type: plane, at: [0.1, 0, 0.075], normal: [-3, 0, 4]}",
        "{name: way, type: height, height: 0.75*x}",
        "{name: way, type: heightfield, spacing: 2, heights: [[-1.5, 0, 1.5], [-1.5, 0, 1.5]]}",
        "{name: way, type: height, height: 0.75*x + 0.1*t, at: [0, 0, 0], forward: [2, 0, 1]}"};
    static const char *const more[] = {"", ", envelope: 0.1",
                                       ", envelope: 0.2, envelope_width: 0.05"};
    for (size_t k = 0; k < 4; ++k) {
        for (size_t m = 0; m < 3; ++m) {
            se3d_model *model = stand(roads[k], 0.05, more[m]);
            if (!model) {
                continue;
            }
            se3d_system *system = se3d_model_get_system(model);
            const double gap = 0.8 * (0.32 - 0.75 * 0.05); /* across the slope */
            const double deflection = tell(system, "tyre", SE3D_TYRE_DEFLECTION);
            CHECK_NEAR(deflection, 0.3 - gap, 1e-12);
            CHECK_NEAR(tell(system, "tyre", SE3D_TYRE_CONTACT_X), 0.05 + 0.6 * gap, 1e-12);
            CHECK_NEAR(tell(system, "tyre", SE3D_TYRE_CONTACT_Z), 0.32 - 0.8 * gap, 1e-12);
            se3d_model_destroy(model);
        }
    }
}

/* In front of a step of the height 0.1 the discs stand on its edge: circles. */
static void discs_roll_over_a_step(void)
{
    const double R = 0.3, L = 0.1;
    for (int k = 0; k < 24; ++k) {
        const double x = -0.33 + 0.0123 * k; /* the edge is at x = 0 */
        double w[2];
        for (int side = 0; side < 2; ++side) {
            const double s = 0.0 - (x + (side ? -0.5 : 0.5) * L);
            const double edge = s < 0.95 * R ? 0.1 - R + sqrt(R * R - s * s) : -1.0;
            w[side] = s < 0.0 ? 0.1 : fmax(0.0, edge);
        }
        const double slope = (w[0] - w[1]) / L, root = sqrt(1.0 + slope * slope);
        const double height = 0.5 * (w[0] + w[1]) + R * (1.0 - root);
        se3d_model *model =
            stand("{name: way, type: height, height: \"if(x < 0, 0, 0.1)\"}", x, ", envelope: 0.1");
        se3d_system *system = se3d_model_get_system(model);
        CHECK_NEAR(tell(system, "tyre", SE3D_TYRE_DEFLECTION), R - (0.32 - height) / root, 1e-9);
        se3d_model_destroy(model);
    }
}

/* Between points of a grid: through them, exact for quadratics inside, level outside. */
static void a_grid_goes_through_its_points(void)
{
    double heights[7 * 6], at[4];
    se3d_system *system = NULL;
    se3d_road road;
    se3d_road_def def = se3d_road_def_default();
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_get_ground(system, &def.body));
    for (size_t k = 0; k < 42; ++k) {
        const double x = 0.5 * (double)(k % 7), y = 0.25 * (double)(k / 7); /* from a corner */
        heights[k] = 0.3 + x - 0.2 * y + 0.4 * x * x - 0.7 * y * y + 0.5 * x * y;
    }
    def.heights = heights;
    def.column_count = 7;
    def.row_count = 6;
    def.spacing[0] = 0.5;
    def.spacing[1] = 0.25;
    CHECK(!se3d_road_create(system, &def, &road));
    for (int k = 0; k < 40; ++k) {
        const double x = 0.5 + 0.05 * k, y = 0.25 + 0.018 * k;
        CHECK(!se3d_road_get_height(system, road, x - 1.5, y - 0.625, at));
        CHECK_NEAR(at[0], 0.3 + x - 0.2 * y + 0.4 * x * x - 0.7 * y * y + 0.5 * x * y, 1e-13);
        CHECK_NEAR(at[1], 1.0 + 0.8 * x + 0.5 * y, 1e-12);
        CHECK_NEAR(at[2], -0.2 - 1.4 * y + 0.5 * x, 1e-12);
    }
    CHECK(!se3d_road_get_height(system, road, -5.0, 99.0, at));
    CHECK_NEAR(at[0], heights[35], 0.0);
    CHECK_NEAR(at[1], 0.0, 0.0);
    CHECK(!se3d_road_get_height(system, road, 1.5, -0.625, at));
    CHECK_NEAR(at[0], heights[6], 0.0);
    se3d_system_destroy(system);
}

/* ---- Energy --------------------------------------------------------------------------------*/

/* What a wheel loses and gets on a washboard that moves adds up, at a point and over obstacles. */
static void energy_balances_on_a_washboard(void)
{
    static const char *const more[] = {"road: way", "road: way, envelope: 0.08"};
    for (int k = 0; k < 2; ++k) {
        char text[4000];
        char *at;
        snprintf(text, sizeof text,
                 "se3d: 1\nroads: [{name: way, type: height, height: \"0.01*sin(9*x)*(1 + "
                 "sin(5*t))\"}]\n%s",
                 QUARTER_CAR);
        at = strstr(text, "road: way");
        char rest[3000];
        snprintf(rest, sizeof rest, "%s", at + 9);
        snprintf(at, sizeof text - (size_t)(at - text), "%s%s", more[k], rest);
        at = strstr(text, "1e-12");
        memcpy(at, "1e-09", 5);
        se3d_model *model = read(text);
        se3d_system *system = se3d_model_get_system(model);
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        se3d_energy energy;
        se3d_work work;
        CHECK(!se3d_model_get_solver(model, 0, &def));
        CHECK(!se3d_solver_create(system, &def, &solver));
        run(model, solver, 0.0);
        CHECK(!se3d_system_get_energy(system, &energy));
        const double before = energy.total;
        run(model, solver, 0.2);
        CHECK(!se3d_system_get_energy(system, &energy));
        CHECK(!se3d_system_get_work(system, &work));
        CHECK(work.dissipated > 0.1);
        CHECK_NEAR(energy.total + work.dissipated - work.actuators - work.drivers, before,
                   1e-6 * work.dissipated);
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
}

/* ---- a road that is defined again ------------------------------------------------------------*/

/* The height of the wheel, whose road sinks by 0.05 m under way, with a run to the present or
 * without: what the solver keeps of the old road has no say. */
static double lower_road(const char *road, int is_told)
{
    se3d_model *model = stand(road, 0.05, "");
    se3d_system *system = se3d_model_get_system(model);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    se3d_road_def way = se3d_road_def_default();
    se3d_road found;
    se3d_body wheel;
    double r[3];
    CHECK(!se3d_solver_create(system, &def, &solver));
    run(model, solver, 0.05);
    CHECK(!se3d_road_find(system, "way", &found));
    CHECK(!se3d_road_get_def(system, found, &way));
    way.point[2] -= 0.05;
    CHECK(!se3d_road_set_def(system, found, &way));
    if (is_told) {
        CHECK(!se3d_system_touch(system));
    }
    run(model, solver, 0.08);
    CHECK(!se3d_body_find(system, "wheel", &wheel));
    CHECK(!se3d_body_get_position(system, wheel, r));
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
    return r[2];
}

static void a_road_defined_again_acts_at_once(void)
{
    static const char *const roads[] = {
        "{name: way, type: plane}", "{name: way, type: height, height: 0.01*x}",
        "{name: way, type: heightfield, spacing: 2, heights: [[0, 0, 0], [0, 0, 0]]}"};
    for (size_t k = 0; k < sizeof roads / sizeof *roads; ++k) {
        const double z = lower_road(roads[k], 0), expected = lower_road(roads[k], 1);
        CHECK(memcmp(&z, &expected, sizeof z) == 0);
    }
}

int main(void)
{
    RUN(a_road_defined_again_acts_at_once);
    RUN(a_wheel_on_a_slope_finds_the_slope);
    RUN(discs_roll_over_a_step);
    RUN(a_grid_goes_through_its_points);
    RUN(energy_balances_on_a_washboard);
    RUN(a_quarter_car_follows_its_transfer_function);
    return check_finish();
}
