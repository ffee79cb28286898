/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables: cubic, linear, Akima's, periodic ones; their derivatives, integrals and energies. The
 * reference values are of the same points in rational arithmetic: the coefficients of all cubics
 * from one dense system of the conditions at the points. */
#include <math.h>

#include "check.h"
#include "se3d/se3d.h"

enum { POINTS = 6 };
static const double table_x[POINTS] = {-1.0, 0.25, 0.5, 2.0, 3.5, 4.0};
static const double table_y[POINTS] = {2.0, -1.0, 4.0, 0.5, 1.5, 2.0};

static se3d_system *make_system(void)
{
    se3d_system *system = NULL;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    return system;
}

static se3d_function_def table_def(int32_t kind, int32_t periodic)
{
    se3d_function_def def = se3d_function_def_default();
    def.table_x = table_x;
    def.table_y = table_y;
    def.table_count = POINTS;
    def.table_kind = kind;
    def.table_periodic = periodic;
    return def;
}

static se3d_function make(se3d_system *system, const se3d_function_def *def)
{
    se3d_function function = {0, 0};
    CHECK(se3d_function_create(system, def, &function) == SE3D_OK);
    return function;
}

static void eval(se3d_system *system, se3d_function function, double u, double jet[3])
{
    CHECK(se3d_function_eval(system, function, &u, jet) == SE3D_OK);
}

static double value(se3d_system *system, se3d_function function, double u)
{
    double jet[3] = {0.0, 0.0, 0.0};
    eval(system, function, u, jet);
    return jet[0];
}

static void curves_are_those_of_rational_arithmetic(void)
{
    static const struct {
        int32_t kind, periodic;
        struct {
            double u, jet[3];
        } at[5];
    } cases[] = {{SE3D_TABLE_CUBIC,
                  1,
                  {{-0.7, {-0.005120695988400193, -8.6445402932173359, -6.0961082648622522}},
                   {0.3, {-0.081760463992266802, 19.503977444820364, 38.263624939584339}},
                   {1.1, {7.7123027549540843, -3.4079142903173838, -23.284175930401162}},
                   {2.9, {-0.60058849685838567, 2.6874825197357821, 5.1028709521507976}},
                   {3.6, {1.8410401159980667, 3.1405091026260674, -7.0613823102948281}}}},
                 {SE3D_TABLE_AKIMA,
                  0,
                  {{-0.7, {-1.2745133591654243, -8.2291276304023828, 17.912522205663194}},
                   {0.3, {-0.20030156737114257, 21.93609193783713, 188.27877692635664}},
                   {1.1, {2.7441167207040298, -3.5957511193453748, -2.0254129998456065}},
                   {2.9, {1.0288470588235294, 0.64478431372549005, 0.33176470588235285}},
                   {3.6, {1.5952, 0.94266666666666665, -0.080000000000000127}}}},
                 {SE3D_TABLE_AKIMA,
                  1,
                  {{-0.7, {1.6985648894899184, -2.596273460866394, -8.1869945937732673}},
                   {0.3, {-0.46452895978676223, 19.293818013680934, 280.75836427182355}},
                   {1.1, {2.7441167207040298, -3.5957511193453748, -2.0254129998456065}},
                   {2.9, {1.0598970588235295, 0.66203431372549026, 0.17843137254901958}},
                   {3.6, {1.5894643206256109, 0.95729227761485824, 1.0714320625610949}}}},
                 {SE3D_TABLE_LINEAR,
                  0,
                  {{-0.7, {1.28, -2.4, 0.0}},
                   {0.3, {0.0, 20.0, 0.0}},
                   {1.1, {2.6, -7.0 / 3.0, 0.0}},
                   {2.9, {1.1, 2.0 / 3.0, 0.0}},
                   {3.6, {1.6, 1.0, 0.0}}}}};
    se3d_system *system = make_system();
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        const se3d_function_def def = table_def(cases[c].kind, cases[c].periodic);
        const se3d_function f = make(system, &def);
        for (size_t k = 0; k < 5; ++k) {
            const double u = cases[c].at[k].u;
            double jet[3];
            eval(system, f, u, jet);
            CHECK_NEAR(jet[0], cases[c].at[k].jet[0], 2e-14);
            CHECK_NEAR(jet[1], cases[c].at[k].jet[1], 2e-13);
            CHECK_NEAR(jet[2], cases[c].at[k].jet[2], 2e-12);
            if (cases[c].periodic) {
                double later[3];
                eval(system, f, u + 35.0, later);
                CHECK_NEAR(later[0], jet[0], 1e-12);
                eval(system, f, u - 15.0, later);
                CHECK_NEAR(later[1], jet[1], 1e-11);
            }
        }
        for (size_t k = 0; k < POINTS; ++k) {
            CHECK_NEAR(value(system, f, table_x[k]), table_y[k], 1e-14);
        }
    }
    se3d_system_destroy(system);
}

/* Central differences: their errors fall with the square of the distance. */
static void derivatives_are_those_of_the_values(void)
{
    se3d_system *system = make_system();
    for (int32_t kind = SE3D_TABLE_CUBIC; kind <= SE3D_TABLE_AKIMA; ++kind) {
        for (int32_t periodic = 0; periodic < 2; ++periodic) {
            const se3d_function_def def = table_def(kind, periodic);
            const se3d_function f = make(system, &def);
            for (double u = -3.4; u < 8.0; u += 0.517) { /* also outside */
                double jet[3], error[2];
                eval(system, f, u, jet);
                for (int n = 0; n < 2; ++n) {
                    double before[3], behind[3];
                    const double h = n ? 1e-4 : 2e-4;
                    eval(system, f, u - h, before);
                    eval(system, f, u + h, behind);
                    error[n] = (behind[0] - before[0]) / (2.0 * h) - jet[1];
                    CHECK_NEAR((behind[1] - before[1]) / (2.0 * h), jet[2], 1e-7);
                }
                CHECK_NEAR(error[0], 0.0, 1e-4);
                if (fabs(error[0]) > 1e-7) {
                    CHECK_NEAR(error[0] / error[1], 4.0, 0.1);
                }
            }
        }
    }
    se3d_system_destroy(system);
}

/* By Simpson's rule, which is exact for cubics, from place to place with the points among them. */
static void integrals_are_those_of_the_rate(void)
{
    se3d_system *system = make_system();
    for (int32_t kind = SE3D_TABLE_CUBIC; kind <= SE3D_TABLE_AKIMA; ++kind) {
        for (int32_t periodic = 0; periodic < 2; ++periodic) {
            se3d_function_def def = table_def(kind, periodic);
            const se3d_function rate = make(system, &def);
            def.integrate = 1;
            def.start = 0.75;
            def.start_time = 0.25;
            const se3d_function integral = make(system, &def);
            for (int side = -1; side <= 1; side += 2) {
                double sum = 0.75, before = 0.25;
                for (int k = 1; k < 100; ++k) {
                    const double u = 0.25 + 0.125 * side * k;
                    sum += (u - before) / 6.0 *
                           (value(system, rate, before) +
                            4.0 * value(system, rate, 0.5 * (before + u)) + value(system, rate, u));
                    CHECK_NEAR(value(system, integral, u), sum, 1e-12);
                    before = u;
                }
            }
        }
    }
    se3d_system_destroy(system);
}

/* Akima's curve has no waves beside a step, the cubic has. */
static void akima_does_not_overshoot_flat_parts(void)
{
    static const double x[] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
    static const double y[] = {1.0, 1.0, 1.0, 2.0, 2.0, 2.0};
    se3d_system *system = make_system();
    se3d_function_def def = table_def(SE3D_TABLE_AKIMA, 0);
    def.table_x = x;
    def.table_y = y;
    const se3d_function akima = make(system, &def);
    def.table_kind = SE3D_TABLE_CUBIC;
    const se3d_function cubic = make(system, &def);
    double most = 0.0;
    for (double u = -1.0; u < 6.0; u += 0.05) {
        CHECK(value(system, akima, u) >= 1.0 - 1e-15 && value(system, akima, u) <= 2.0 + 1e-15);
        most = fmax(most, value(system, cubic, u));
    }
    CHECK(most > 2.02);
    se3d_system_destroy(system);
}

static void two_points_are_a_line_in_every_kind(void)
{
    se3d_system *system = make_system();
    for (int32_t kind = SE3D_TABLE_CUBIC; kind <= SE3D_TABLE_AKIMA; ++kind) {
        se3d_function_def def = table_def(kind, 0);
        def.table_count = 2;
        const se3d_function f = make(system, &def);
        CHECK_NEAR(value(system, f, 0.0), -0.4, 1e-15);
        CHECK_NEAR(value(system, f, 5.0), 2.0 - 2.4 * 6.0, 1e-14);
        def.table_count = 3;
        make(system, &def);
    }
    se3d_system_destroy(system);
}

/* A rotor in the field of a torque that repeats: its energy stays. */
static void energy_of_a_repeating_spring_is_its_integral(void)
{
    static const double x[] = {0.2, 0.9, 1.7, 2.3};
    static const double y[] = {0.4, 1.5, -0.7, 0.4};
    se3d_system *system = make_system();
    se3d_body ground, body;
    se3d_body_def mass = se3d_body_def_default();
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_function_def def = table_def(SE3D_TABLE_AKIMA, 1);
    const double no_gravity[3] = {0.0, 0.0, 0.0};
    se3d_force force;
    def.table_x = x;
    def.table_y = y;
    def.table_count = 4;
    CHECK(!se3d_system_set_gravity(system, no_gravity));
    CHECK(!se3d_system_get_ground(system, &ground));
    mass.mass = 0.1;
    mass.inertia[0] = mass.inertia[1] = mass.inertia[2] = 1.0;
    mass.position[0] = 1.0;
    mass.velocity[0] = 20.0;
    CHECK(!se3d_body_create(system, &mass, &body));
    spring.body_i = ground;
    spring.body_j = body;
    spring.spring = make(system, &def);
    CHECK(!se3d_force_create_tsda(system, &spring, &force));
    se3d_solver_def settings = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    settings.tolerance = 1e-9;
    CHECK(!se3d_solver_create(system, &settings, &solver));
    se3d_energy first, last;
    CHECK(se3d_solver_run(solver, 1e-3) >= 0);
    CHECK(!se3d_system_get_energy(system, &first));
    CHECK(se3d_solver_run(solver, 0.5) >= 0);
    CHECK(!se3d_system_get_energy(system, &last));
    CHECK(fabs(first.kinetic - last.kinetic) > 1e-3);
    CHECK_NEAR(first.kinetic + first.potential, last.kinetic + last.potential, 1e-6);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

static void wrong_tables_are_refused(void)
{
    se3d_system *system = make_system();
    se3d_function f;
    se3d_function_def def = table_def(3, 0);
    CHECK(se3d_function_create(system, &def, &f) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "table_kind = 3");
    def = table_def(0, 2);
    CHECK(se3d_function_create(system, &def, &f) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "table_periodic = 2");
    def = table_def(0, 1);
    def.table_count = 5;
    CHECK(se3d_function_create(system, &def, &f) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "must end with 2");
    def.table_count = 2;
    CHECK(se3d_function_create(system, &def, &f) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "at least 3");
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(curves_are_those_of_rational_arithmetic);
    RUN(derivatives_are_those_of_the_values);
    RUN(integrals_are_those_of_the_rate);
    RUN(akima_does_not_overshoot_flat_parts);
    RUN(two_points_are_a_line_in_every_kind);
    RUN(energy_of_a_repeating_spring_is_its_integral);
    RUN(wrong_tables_are_refused);
    return check_finish();
}
