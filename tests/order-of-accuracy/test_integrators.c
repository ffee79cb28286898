/* SPDX-License-Identifier: BSD-3-Clause */
/* The observed order of every method, in positions, orientations, velocities, angular velocities
 * and reactions, with both formulations, on a heavy top (ball joint, fast spin), a spatial closed
 * loop and a driven chain. Steps of h and h/2 are compared with a reference of order 8 at a step so
 * small that its error does not show; the slope must be that of the method within the tolerance of
 * a slope measured at finite steps (0.35 per doubling), up to a floor of rounding. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BODIES_MAX 3
#define GROUPS     5 /* r, p, v, w, reactions */

typedef struct world {
    se3d_system *system;
    se3d_body bodies[BODIES_MAX];
    se3d_constraint joints[BODIES_MAX + 1];
    int body_count, joint_count;
} world;

typedef struct sample {
    double values[GROUPS][6 * (BODIES_MAX + 1)];
    int counts[GROUPS];
} sample;

static void must(const world *w, se3d_status status)
{
    world_must(w->system, status, "a call of the test");
}

static void add_body(world *w, const double r[3], const double J[3], double mass)
{
    w->bodies[w->body_count++] = world_add_body(w->system, mass, J, r);
}

/* A joint at a point; i = -1 is the ground. */
static void add_joint(world *w, int i, int j, const double at[3], const double axis[3])
{
    const double upward[3] = {0.0, 0.0, 1.0};
    se3d_body ground;
    must(w, se3d_system_get_ground(w->system, &ground));
    w->joints[w->joint_count++] = world_join(
        w->system, axis ? se3d_joint_create_revolute : se3d_joint_create_spherical, NULL,
        i < 0 ? ground : w->bodies[i], j < 0 ? ground : w->bodies[j], at, axis ? axis : upward);
}

static void set_spin(const world *w, int body, double x, double y, double z)
{
    const double spin[3] = {x, y, z};
    must(w, se3d_body_set_angular_velocity(w->system, w->bodies[body], spin));
}

static void build_top(world *w)
{
    const double r[3] = {0.0, 1.0, 0.0}, J[3] = {0.234375, 0.46875, 0.234375};
    const double origin[3] = {0.0, 0.0, 0.0}, v[3] = {4.61538, 0.0, 0.0};
    add_body(w, r, J, 15.0);
    add_joint(w, -1, 0, origin, NULL);
    set_spin(w, 0, 0.0, 150.0, -4.61538);
    must(w, se3d_body_set_velocity(w->system, w->bodies[0], v));
}

/* Three bars with four ball joints between two points of the ground. */
static void build_loop(world *w)
{
    const double points[4][3] = {{0, 0, 0}, {0.6, 0.2, -0.9}, {1.5, -0.3, -1.1}, {2.0, 0.1, 0.0}};
    const double J[3] = {0.1, 0.16, 0.23};
    for (int k = 0; k < 3; ++k) {
        double r[3];
        for (int c = 0; c < 3; ++c) {
            r[c] = 0.5 * (points[k][c] + points[k + 1][c]);
        }
        add_body(w, r, J, 1.0 + k);
    }
    for (int k = 0; k < 4; ++k) {
        add_joint(w, k - 1, k < 3 ? k : -1, points[k], NULL);
    }
    set_spin(w, 0, 0.5, -0.2, 0.4);
    set_spin(w, 1, -0.3, 0.6, 0.8);
    set_spin(w, 2, 0.2, 0.7, -0.5);
}

/* A crank whose angle is a function of time, with a bar on a ball joint. */
static void build_driven(world *w)
{
    const double r0[3] = {0.5, 0.0, 0.0}, r1[3] = {1.4, 0.0, 0.1}, J[3] = {0.15, 0.2, 0.3};
    const double origin[3] = {0.0, 0.0, 0.0}, end[3] = {1.0, 0.0, 0.0}, axis[3] = {0.0, 0.6, 0.8};
    se3d_driver_def def = se3d_driver_def_default();
    se3d_constraint drive;
    add_body(w, r0, J, 1.0);
    add_body(w, r1, J, 2.0);
    add_joint(w, -1, 0, origin, axis);
    add_joint(w, 0, 1, end, NULL);
    must(w, se3d_function_create_expression(w->system, "0.8*sin(3*t) + t^2", &def.function));
    def.joint = w->joints[0];
    must(w, se3d_driver_create(w->system, &def, &drive));
    set_spin(w, 1, 1.0, -2.0, 0.5);
}

typedef void (*builder)(world *w);

static void append(sample *s, int group, const double *values, int count)
{
    memcpy(s->values[group] + s->counts[group], values, (size_t)count * sizeof *values);
    s->counts[group] += count;
}

static sample take(const world *w)
{
    sample s = {.counts = {0}};
    double x[4], torque[3];
    for (int k = 0; k < w->body_count; ++k) {
        must(w, se3d_body_get_position(w->system, w->bodies[k], x));
        append(&s, 0, x, 3);
        must(w, se3d_body_get_orientation(w->system, w->bodies[k], x));
        append(&s, 1, x, 4);
        must(w, se3d_body_get_velocity(w->system, w->bodies[k], x));
        append(&s, 2, x, 3);
        must(w, se3d_body_get_angular_velocity(w->system, w->bodies[k], x));
        append(&s, 3, x, 3);
    }
    for (int k = 0; k < w->joint_count; ++k) {
        must(w, se3d_constraint_get_reaction(w->system, w->joints[k], x, torque));
        append(&s, 4, x, 3);
    }
    return s;
}

typedef struct method_row {
    int32_t method, order_option;
    double order;     /* of positions and velocities */
    double reactions; /* of multipliers */
    int steps[3];     /* coarse steps for top, loop, driven */
    double floor;     /* relative error that rounding leaves */
} method_row;

static sample run(builder build, const method_row *row, int32_t formulation, double duration,
                  int steps)
{
    world w = {.body_count = 0};
    se3d_solver *solver;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = row->method;
    def.formulation = formulation;
    def.order = row->order_option;
    def.step = duration / steps;
    must(&w, se3d_system_create(NULL, &w.system));
    build(&w);
    must(&w, se3d_solver_create(w.system, &def, &solver));
    must(&w, se3d_solver_run(solver, 0.0));
    for (int k = 0; k < steps; ++k) {
        must(&w, se3d_solver_step(solver, duration / steps));
    }
    sample s = take(&w);
    se3d_solver_destroy(solver);
    se3d_system_destroy(w.system);
    return s;
}

static double difference(const sample *a, const sample *b, int group)
{
    double worst = 0.0, size = 1e-3, sign = 1.0;
    for (int k = 0; k < b->counts[group]; ++k) {
        size = fmax(size, fabs(b->values[group][k]));
    }
    for (int k = 0; k < b->counts[group]; ++k) {
        if (group == 1 && k % 4 == 0) { /* p and -p are the same orientation */
            double dot = 0.0;
            for (int c = 0; c < 4; ++c) {
                dot += a->values[1][k + c] * b->values[1][k + c];
            }
            sign = dot < 0.0 ? -1.0 : 1.0;
        }
        worst = fmax(worst, fabs(sign * a->values[group][k] - b->values[group][k]));
    }
    return worst / size;
}

static const struct {
    const char *name;
    builder build;
    double duration;
    int reference_steps;
} problems[3] = {{"top", build_top, 0.1, 256},
                 {"loop", build_loop, 0.6, 192},
                 {"driven", build_driven, 1.0, 256}};

/* Steps and `finer` times as many; the slope may be less by `slack`. */
static void check_refined(const method_row *row, double finer, double slack)
{
    static const char *const names[GROUPS] = {"r", "p", "v", "w", "reactions"};
    const method_row exact = {.method = SE3D_METHOD_DOP853};
    for (int p = 0; p < 3; ++p) {
        sample reference = run(problems[p].build, &exact, SE3D_FORMULATION_ROMEGA,
                               problems[p].duration, problems[p].reference_steps);
        for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_JOINT; ++f) {
            sample coarse = run(problems[p].build, row, f, problems[p].duration, row->steps[p]);
            sample fine = run(problems[p].build, row, f, problems[p].duration,
                              (int)(finer * row->steps[p] + 0.5));
            for (int group = 0; group < GROUPS; ++group) {
                double e1 = difference(&coarse, &reference, group);
                double e2 = difference(&fine, &reference, group);
                double order = group == 4 ? row->reactions : row->order;
                double slope = log2(e1 / e2) / log2(finer);
                int holds = slope > order - slack || e2 < row->floor;
                CHECK(e1 < 0.2 && e1 > e2);
                CHECK(holds);
                if (!holds || !(e1 < 0.2) || getenv("SE3D_TEST_VERBOSE")) {
                    fprintf(stderr, "%s, %s, formulation %d, %s: errors %.3e %.3e, order %.2f\n",
                            check_case, problems[p].name, (int)f, names[group], e1, e2, slope);
                }
            }
        }
    }
}

static void check_method(const method_row *row)
{
    check_refined(row, 2.0, 0.35);
}

static void dop853_is_of_order_8(void)
{
    const method_row row = {SE3D_METHOD_DOP853, 0, 8.0, 8.0, {12, 6, 10}, 2e-12};
    check_method(&row);
}

static void gauss_is_of_order_8(void)
{
    const method_row row = {SE3D_METHOD_GAUSS, 8, 8.0, 8.0, {12, 6, 10}, 2e-12};
    check_method(&row);
}

static void gauss_is_of_order_16(void)
{
    const method_row row = {SE3D_METHOD_GAUSS, 16, 16.0, 16.0, {4, 4, 4}, 2.5e-12};
    check_refined(&row, 1.5, 1.5); /* twice as many leave rounding */
}

static void rk45_is_of_order_5(void)
{
    const method_row row = {SE3D_METHOD_RK45, 0, 5.0, 5.0, {48, 24, 96}, 1e-12};
    check_method(&row);
}

static void rk4_is_of_order_4(void)
{
    const method_row row = {SE3D_METHOD_RK4, 0, 4.0, 4.0, {96, 96, 96}, 1e-11};
    check_method(&row);
}

static void generalized_alpha_is_of_order_2(void)
{
    const method_row row = {SE3D_METHOD_GENERALIZED_ALPHA, 0, 2.0, 2.0, {400, 100, 100}, 1e-12};
    check_method(&row);
}

static void hht_is_of_order_2(void)
{
    const method_row row = {SE3D_METHOD_HHT, 0, 2.0, 2.0, {400, 100, 100}, 1e-12};
    check_method(&row);
}

static void rattle_is_of_order_2(void)
{
    const method_row row = {SE3D_METHOD_RATTLE, 0, 2.0, 2.0, {400, 100, 100}, 1e-12};
    check_method(&row);
}

static void verlet_is_of_order_2(void)
{
    const method_row row = {SE3D_METHOD_VERLET, 0, 2.0, 2.0, {400, 100, 100}, 1e-12};
    check_method(&row);
}

static void convex_is_of_order_2(void)
{
    const method_row row = {SE3D_METHOD_CONVEX, 0, 2.0, 2.0, {800, 200, 200}, 1e-12};
    check_method(&row);
}

static void rattle_is_of_order_4_by_composition(void)
{
    const method_row row = {SE3D_METHOD_RATTLE, 4, 4.0, 4.0, {100, 24, 40}, 1e-11};
    check_method(&row);
}

static void radau_is_of_order_5(void)
{
    const method_row row = {SE3D_METHOD_RADAU, 0, 5.0, 5.0, {24, 12, 24}, 1e-11};
    check_method(&row);
}

/* Equal steps begin with one of order 1, whose error is of order 2. */
static void bdf_is_of_orders_1_and_2_at_equal_steps(void)
{
    const method_row first = {SE3D_METHOD_BDF, 1, 1.0, 1.0, {3200, 400, 800}, 1e-9};
    const method_row second = {SE3D_METHOD_BDF, 2, 2.0, 2.0, {800, 200, 200}, 1e-9};
    check_method(&first);
    check_method(&second);
}

/* A run with error control to the end of a problem; counts its steps. */
static sample run_controlled(builder build, const method_row *row, int32_t formulation,
                             double duration, double tolerance, uint64_t *steps)
{
    world w = {.body_count = 0};
    se3d_solver *solver;
    se3d_solver_stats stats;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = row->method;
    def.order = row->order_option;
    def.formulation = formulation;
    def.tolerance = tolerance;
    must(&w, se3d_system_create(NULL, &w.system));
    build(&w);
    must(&w, se3d_solver_create(w.system, &def, &solver));
    must(&w, se3d_solver_run(solver, duration));
    sample s = take(&w);
    must(&w, se3d_solver_get_stats(solver, &stats));
    *steps = stats.steps;
    se3d_solver_destroy(solver);
    se3d_system_destroy(w.system);
    return s;
}

/* The slope of errors over steps between two tolerances. */
static double measure_control(int p, const method_row *row, int32_t formulation,
                              const sample *reference, const double tolerance[2], double errors[2])
{
    uint64_t steps[2];
    for (int k = 0; k < 2; ++k) {
        sample s = run_controlled(problems[p].build, row, formulation, problems[p].duration,
                                  tolerance[k], &steps[k]);
        errors[k] = 0.0;
        for (int group = 0; group < 4; ++group) {
            errors[k] = fmax(errors[k], difference(&s, reference, group));
        }
    }
    double slope = log(errors[0] / errors[1]) / log((double)steps[1] / (double)steps[0]);
    if (getenv("SE3D_TEST_VERBOSE")) {
        fprintf(stderr, "%s, %s, formulation %d: errors %.3e %.3e, steps %d %d, order %.2f\n",
                check_case, problems[p].name, (int)formulation, errors[0], errors[1], (int)steps[0],
                (int)steps[1], slope);
    }
    return slope;
}

/* At least `order` (the method's, less what the start at low order and the changes of the step
 * cost). */
static void check_control_of(const method_row *row, double order, const double tolerance[2],
                             double factor)
{
    const method_row exact = {.method = SE3D_METHOD_DOP853};
    for (int p = 0; p < 3; ++p) {
        sample reference = run(problems[p].build, &exact, SE3D_FORMULATION_ROMEGA,
                               problems[p].duration, problems[p].reference_steps);
        for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_JOINT; ++f) {
            double errors[2];
            CHECK(measure_control(p, row, f, &reference, tolerance, errors) > order);
            CHECK(errors[0] < factor * tolerance[0] && errors[1] < factor * tolerance[1]);
        }
    }
}

static void check_control(int32_t method, double order, const double tolerance[2], double factor)
{
    const method_row row = {.method = method};
    check_control_of(&row, order, tolerance, factor);
}

/* The highest order that is allowed shows in errors over steps, on the driven mechanism. */
static void bdf_has_the_orders_1_to_5(void)
{
    static const double tolerances[5][2] = {
        {1e-3, 1e-5}, {1e-4, 1e-6}, {1e-5, 1e-7}, {1e-6, 1e-8}, {1e-6, 1e-9}};
    const method_row exact = {.method = SE3D_METHOD_DOP853};
    const int p = 2;
    sample reference = run(problems[p].build, &exact, SE3D_FORMULATION_ROMEGA, problems[p].duration,
                           problems[p].reference_steps);
    for (int32_t order = 1; order <= 5; ++order) {
        const method_row row = {.method = SE3D_METHOD_BDF, .order_option = order};
        double errors[2];
        double slope = measure_control(p, &row, SE3D_FORMULATION_ROMEGA, &reference,
                                       tolerances[order - 1], errors);
        CHECK_NEAR(slope, (double)order, 0.5);
    }
}

static void bdf_controls_its_error_at_high_order(void)
{
    check_control(SE3D_METHOD_BDF, 3.5, (const double[2]){1e-5, 1e-9}, 30.0);
}

static void dop853_controls_its_error_at_high_order(void)
{
    check_control(SE3D_METHOD_DOP853, 6.0, (const double[2]){1e-3, 1e-8}, 3.0);
}

static void radau_controls_its_error_at_high_order(void)
{
    check_control(SE3D_METHOD_RADAU, 4.0, (const double[2]){1e-5, 1e-9}, 30.0);
}

static void gauss_controls_its_error_at_high_order(void)
{
    const method_row four = {SE3D_METHOD_GAUSS, .order_option = 8};
    const method_row eight = {SE3D_METHOD_GAUSS, .order_option = 16};
    check_control_of(&four, 3.9, (const double[2]){1e-4, 1e-6}, 3.0);
    check_control_of(&eight, 7.5, (const double[2]){1e-7, 1e-10}, 3.0);
}

static void rk45_controls_its_error(void)
{
    check_control(SE3D_METHOD_RK45, 4.0, (const double[2]){1e-4, 1e-8}, 3.0);
}

static void rk4_controls_its_error(void)
{
    check_control(SE3D_METHOD_RK4, 3.2, (const double[2]){1e-3, 1e-6}, 3.0);
}

static void generalized_alpha_controls_its_error(void)
{
    check_control(SE3D_METHOD_GENERALIZED_ALPHA, 1.6, (const double[2]){1e-6, 1e-8}, 1e4);
}

int main(void)
{
    RUN(bdf_controls_its_error_at_high_order);
    RUN(bdf_is_of_orders_1_and_2_at_equal_steps);
    RUN(bdf_has_the_orders_1_to_5);
    RUN(radau_is_of_order_5);
    RUN(radau_controls_its_error_at_high_order);
    RUN(dop853_controls_its_error_at_high_order);
    RUN(rk45_controls_its_error);
    RUN(rk4_controls_its_error);
    RUN(generalized_alpha_controls_its_error);
    RUN(rattle_is_of_order_2);
    RUN(verlet_is_of_order_2);
    RUN(convex_is_of_order_2);
    RUN(rattle_is_of_order_4_by_composition);
    RUN(dop853_is_of_order_8);
    RUN(gauss_is_of_order_8);
    RUN(gauss_is_of_order_16);
    RUN(gauss_controls_its_error_at_high_order);
    RUN(rk45_is_of_order_5);
    RUN(rk4_is_of_order_4);
    RUN(generalized_alpha_is_of_order_2);
    RUN(hht_is_of_order_2);
    return check_finish();
}
