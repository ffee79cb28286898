/* SPDX-License-Identifier: BSD-3-Clause */
/* Points, vectors and units of model files: what they are worth. */
#include "check.h"
#include "se3d/io.h"
#include "support/read_text.h"
#include "support/scratch.h"

#define HEAD                                                                                       \
    "se3d: 1\nparameters: {L: 2, up: [0, 0, 1], d: 30 mm, m: 5 m, N: 2*s*1 N, s: 3, n: 600 rpm}\n"

/* The value of an expression as the parameter `v`. */
static double value_of(const char *expression)
{
    char text[600];
    double value = -1.0;
    snprintf(text, sizeof text,
             HEAD "points: {a: [1, 2, 3], b: \"[4, 6, 3]\"}\nunits: {}\nbodies: []\n");
    char *at = strstr(text, "n: 600");
    char rest[600];
    snprintf(rest, sizeof rest, "%s", at);
    snprintf(at, sizeof text - (size_t)(at - text), "v: \"%s\", %s", expression, rest);
    se3d_model *model = read_text(text);
    CHECK(model && !se3d_model_get_parameter(model, "v", &value));
    se3d_model_destroy(model);
    return value;
}

static void expressions_have_these_values(void)
{
    static const struct {
        const char *text;
        double value;
    } table[] = {{"30 mm", 0.03},
                 {"2 kN/m", 2000.0},
                 {"1.2 kg*m^2", 1.2},
                 {"m + 1 m", 6.0}, /* a parameter and a unit */
                 {"N/(2 N)", 3.0},
                 {"4 kN s/m", 4000.0},
                 {"3 N m/rad + 1 mN m/rad", 3.001},
                 {"2 N m s - 1 N m s", 1.0},
                 {"7.85 g*cm^2", 7.85 / 1e7},
                 {"15 deg + 1 rad", 15.0 * 3.14159265358979323846 / 180.0 + 1.0},
                 {"n/2", 62.83185307179586 / 2.0},
                 {"1 rev", 6.283185307179586},
                 {"60 rpm*min(1, 2)", 6.283185307179586}, /* a function, not a minute */
                 {"norm(b - a)", 5.0},
                 {"distance(a, b)/d", 5.0 / 0.03},
                 {"dot(a, b)", 25.0},
                 {"cross(a, b).z", 1.0 * 6.0 - 2.0 * 4.0},
                 {"mid(a, b).y", 4.0},
                 {"unit(b - a).x", 3.0 / 5.0},
                 {"(a + 0.5*(b - a)).x", 2.5},
                 {"angle(up, [1, 0, 0])", 1.5707963267948966},
                 {"rotate([1, 0, 0], up, 90 deg).y", 1.0},
                 {"rotate([1, 2, 3], up, pi/2).x", -2.0},
                 {"-a.z^2", -9.0},
                 {"if(a.x < 2, 1 m, 2 m)", 1.0},
                 {"sin(90 deg)", 1.0},
                 {"sqrt(4 mm^2)", 0.002},
                 {"max(1 m, 2 km, 3 cm)", 2000.0},
                 {"step(5 mm, 0 mm, 1 N, 10 mm, 3 N)", 2.0},
                 {"hypot(3 m, 4)", 5.0},
                 {"atan2(a.y, a.y)/deg", 45.0},
                 {"[1, 2, L].z", 2.0},
                 {"a.x/b.x", 0.25},
                 {"2*L^2", 8.0}};
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        const double value = value_of(table[k].text);
        if (!(fabs(value - table[k].value) <= 4e-16 * fabs(table[k].value) + 1e-16)) {
            fprintf(stderr, "%s: %.17g, not %.17g\n", table[k].text, value, table[k].value);
        }
        CHECK_NEAR(value, table[k].value, 4e-16 * fabs(table[k].value) + 1e-16);
    }
}

static const char si[] =
    "se3d: 1\n"
    "bodies:\n"
    "  - {name: bar, mass: 0.5, inertia: [0.002, 0.001, 0.001], position: [0.25, 0.5, 0.75],\n"
    "     velocity: [0.125, 0, 0], markers: [{name: tip, position: [0.5, 0, 0]}]}\n"
    "joints:\n"
    "  - {name: pin, type: revolute, body_i: ground, body_j: bar, at: [0.25, 0.5, 0.75],\n"
    "     axis: [0, 0.5, 0]}\n"
    "forces:\n"
    "  - {name: s, type: tsda, body_i: ground, body_j: bar, point_j: tip, k: 2000, l0: 0.5,\n"
    "     h: 8*(l - 0.25)}\n"
    "  - {name: r, type: rsda, joint: pin, k: 3, theta0: 0.25, c: 0.5}\n"
    "  - {name: b, type: bushing, body_i: ground, body_j: bar, at: [0.25, 0.5, 0.75],\n"
    "     K: [1000, 1000, 1000, 0.5, 0.5, 0.5]}\n"
    "  - {name: f, type: force, body: bar, point: [0.5, 0, 0], value: [0, 0, \"4*t\"]}\n"
    "  - {name: e, type: effort, joint: pin, value: \"2*q\"}\n"
    "analysis: {type: dynamics, duration: 0.25, method: rk4, step: 0.0625}\n"
    "output: [{file: x.csv, channels: [bar.position, bar.tip.position, pin.angle, s.force]}]\n";

/* The same in millimetres, milliseconds and kilonewtons, with points. All factors are exact. */
static const char points[] =
    "se3d: 1\n"
    "units: {length: mm, time: ms, mass: g, force: kN}\n"
    "parameters: {far: 500}\n"
    "points: {c: \"[far/2, 2*o.x, 3*o.x]\", o: [250, 0, 0], tip: \"c + [far, 0, 0]\"}\n"
    "bodies:\n"
    "  - {name: bar, mass: 500, inertia: [2000 kg*mm^2, 1000 kg*mm^2, 0.001 kg*m^2], position: c,\n"
    "     velocity: [0.125, 0, 0], markers: [{name: tip, at: tip}]}\n"
    "joints:\n"
    "  - {name: pin, type: revolute, body_i: ground, body_j: bar, at: c, axis: \"[0, c.y, 0]\"}\n"
    "forces:\n"
    "  - {name: s, type: tsda, body_i: ground, body_j: bar, at_2: tip, k: 2 N/mm, l0: far,\n"
    "     h: 8 N/m*(l - 250)}\n"
    "  - {name: r, type: rsda, joint: pin, k: 3, theta0: 250 mrad, c: 500 N*mm*s/rad}\n"
    "  - {name: b, type: bushing, body_i: ground, body_j: bar, at: c,\n"
    "     K: [1 N/mm, 1000 N/m, 1e-3, 0.5 N*m/rad, 0.5, 0.5 N*m]}\n"
    "  - {name: f, type: force, body: bar, at: tip, value: [0, 0, 4 N/s*t]}\n"
    "  - {name: e, type: effort, joint: pin, value: 2 N*m/rad*q}\n"
    "analysis: {type: dynamics, duration: 250, method: rk4, step: 62.5}\n"
    "output: [{file: x.csv, channels: [bar.position, bar.tip.position, pin.angle, s.force]}]\n";

static void run_to(const char *text, double values[4][4])
{
    se3d_model *model = read_text(text);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    CHECK(model && !se3d_model_get_solver(model, 0, &def));
    CHECK(!se3d_solver_create(se3d_model_get_system(model), &def, &solver));
    CHECK(se3d_solver_run(solver, 0.25) >= 0);
    for (size_t k = 0; k < 4; ++k) {
        size_t width = 0;
        CHECK(!se3d_model_get_channel_value(model, 0, k, NULL, values[k], &width));
    }
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

static void a_model_in_other_units_moves_alike(void)
{
    double a[4][4] = {{0.0}};
    double b[4][4] = {{0.0}};
    run_to(si, a);
    run_to(points, b);
    for (size_t k = 0; k < 16; ++k) {
        CHECK_NEAR(a[k / 4][k % 4], b[k / 4][k % 4], 1e-12 * (1.0 + fabs(a[k / 4][k % 4])));
    }
    CHECK(fabs(a[2][0]) > 0.01);
}

static void points_come_from_tables(void)
{
    static const char text[] = "se3d: 1\npoint_table: points.csv\nunits: {length: mm}\n"
                               "parameters: {w: \"norm(rear - front)\", side: 500}\n";
    static const char file[] = "name, x, y, z\n# hardpoints\nfront, 0, side, 0\r\n"
                               "rear,3 m,\"500\",4000\n\n";
    static const char *const bad[][2] = {{"front, 0, 1\n", "points.csv:1: must have a name"},
                                         {"a,0,1,2,3\n", "points.csv:1: has more than four"},
                                         {"a,0,0,0\na,0,0,0\n", "is the name of two"},
                                         {"\na,0,0,2 kg\n", "a[2]: `2 kg` is a mass [kg]"}};
    double w = 0.0;
    se3d_model_error error;
    scratch_write("points.csv", file, sizeof file - 1);
    se3d_model *model = scratch_read_model(text, &error);
    CHECK(model && !se3d_model_get_parameter(model, "w", &w));
    CHECK_NEAR(w, 5.0, 1e-15);
    se3d_model_destroy(model);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        scratch_write("points.csv", bad[k][0], strlen(bad[k][0]));
        CHECK(!scratch_read_model("se3d: 1\npoint_table: points.csv\n", &error));
        CHECK_CONTAINS(error.message, bad[k][1]);
        CHECK(error.line == 2 && error.column == 14);
    }
    scratch_remove("points.csv");
}

int main(void)
{
    RUN(expressions_have_these_values);
    RUN(a_model_in_other_units_moves_alike);
    RUN(points_come_from_tables);
    return check_finish();
}
