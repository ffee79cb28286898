/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of unequal lengths, as programs make them that follow a clock: the methods of the Newmark
 * family keep order 2 in positions, velocities, accelerations and reactions at every step, the
 * first one included, however the lengths follow each other. The reference is dop853 at the same
 * times. */
#include "check.h"
#include "support/models.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GROUPS = 6, NUMBERS = 32 };

static const char *const groups[GROUPS] = {"r", "v", "w", "a", "wdot", "reactions"};

typedef struct sample {
    double values[GROUPS][NUMBERS];
    size_t counts[GROUPS];
} sample;

static void append(sample *s, int group, const double values[3])
{
    CHECK(s->counts[group] + 3 <= NUMBERS);
    memcpy(s->values[group] + s->counts[group], values, 3 * sizeof *values);
    s->counts[group] += 3;
}

static sample take(const support_model *model)
{
    sample s = {.counts = {0}};
    double x[3], torque[3];
    for (int k = 0; k < model->body_count; ++k) {
        CHECK(se3d_body_get_position(model->system, model->bodies[k], x) == SE3D_OK);
        append(&s, 0, x);
        CHECK(se3d_body_get_velocity(model->system, model->bodies[k], x) == SE3D_OK);
        append(&s, 1, x);
        CHECK(se3d_body_get_angular_velocity(model->system, model->bodies[k], x) == SE3D_OK);
        append(&s, 2, x);
        CHECK(se3d_body_get_acceleration(model->system, model->bodies[k], x) == SE3D_OK);
        append(&s, 3, x);
        CHECK(se3d_body_get_angular_acceleration(model->system, model->bodies[k], x) == SE3D_OK);
        append(&s, 4, x);
    }
    for (int k = 0; k < model->joint_count; ++k) {
        CHECK(se3d_constraint_get_reaction(model->system, model->joints[k], x, torque) == SE3D_OK);
        append(&s, 5, x);
    }
    return s;
}

/* Lengths of `count` steps over `duration`. */
typedef void (*sequence)(double *h, int count);

static void equal(double *h, int count)
{
    for (int k = 0; k < count; ++k) {
        h[k] = 1.0;
    }
}

static void one_to_two(double *h, int count)
{
    for (int k = 0; k < count; ++k) {
        h[k] = k % 2 ? 2.0 : 1.0;
    }
}

static void one_to_five(double *h, int count)
{
    for (int k = 0; k < count; ++k) {
        h[k] = k % 2 ? 5.0 : 1.0;
    }
}

static void chance(double *h, int count)
{
    uint32_t seed = 12345u;
    for (int k = 0; k < count; ++k) {
        seed = 1664525u * seed + 1013904223u;
        h[k] = 1.0 + 4.0 * (double)(seed >> 8) / 16777216.0;
    }
}

typedef struct trial {
    const char *mechanism;
    double duration;
    int steps;
} trial;

static se3d_solver *make_solver(const support_model *model, int32_t method, int32_t formulation)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.method = method;
    def.formulation = formulation;
    def.tolerance = method == SE3D_METHOD_DOP853 ? 1e-12 : 0.0;
    CHECK(se3d_solver_create(model->system, &def, &solver) == SE3D_OK);
    return solver;
}

/* The largest errors of all steps, over the largest values. */
static void measure(const trial *t, sequence lengths, int count, int32_t method,
                    int32_t formulation, double error[GROUPS])
{
    support_model model, exact;
    double h[512], sum = 0.0, size[GROUPS] = {0.0};
    CHECK(count <= 512);
    lengths(h, count);
    for (int k = 0; k < count; ++k) {
        sum += h[k];
    }
    support_model_make(&model, t->mechanism, 1);
    support_model_make(&exact, t->mechanism, 1);
    se3d_solver *solver = make_solver(&model, method, formulation);
    se3d_solver *reference = make_solver(&exact, SE3D_METHOD_DOP853, formulation);
    memset(error, 0, GROUPS * sizeof *error);
    for (int k = 0; k < count; ++k) {
        double time;
        CHECK(se3d_solver_step(solver, h[k] * t->duration / sum) >= 0);
        CHECK(se3d_system_get_time(model.system, &time) == SE3D_OK);
        CHECK(se3d_solver_run(reference, time) >= 0);
        const sample a = take(&model), b = take(&exact);
        for (int group = 0; group < GROUPS; ++group) {
            for (size_t i = 0; i < a.counts[group]; ++i) {
                const double value = b.values[group][i];
                size[group] = fmax(size[group], fabs(value));
                error[group] = fmax(error[group], fabs(a.values[group][i] - value));
            }
        }
    }
    for (int group = 0; group < GROUPS; ++group) {
        error[group] = size[group] > 1e-9 ? error[group] / size[group] : 0.0;
    }
    se3d_solver_destroy(solver);
    se3d_solver_destroy(reference);
    support_model_destroy(&model);
    support_model_destroy(&exact);
}

static const trial trials[] = {
    {"driven_double_pendulum", 0.5, 64},
    {"four_bar", 0.3, 32},
    {"heavy_top", 0.05, 160},
};

static void check_sequence(sequence lengths, int32_t method)
{
    for (size_t k = 0; k < sizeof trials / sizeof trials[0]; ++k) {
        for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_RP; ++f) {
            const trial *t = &trials[k];
            double coarse[GROUPS], fine[GROUPS];
            measure(t, lengths, t->steps, method, f, coarse);
            measure(t, lengths, 2 * t->steps, method, f, fine);
            for (int group = 0; group < GROUPS; ++group) {
                const double order = log2(coarse[group] / fine[group]);
                const int holds = fine[group] < 1e-10 || (order > 1.7 && coarse[group] < 0.05);
                CHECK(holds);
                if (!holds || getenv("SE3D_TEST_VERBOSE")) {
                    fprintf(stderr, "%s, %s, method %d, formulation %d, %s: %.3e %.3e, %.2f\n",
                            check_case, t->mechanism, (int)method, (int)f, groups[group],
                            coarse[group], fine[group], order);
                }
            }
        }
    }
}

static void equal_steps_are_of_order_2_from_the_first_one(void)
{
    check_sequence(equal, SE3D_METHOD_GENERALIZED_ALPHA);
    check_sequence(equal, SE3D_METHOD_HHT);
}

static void steps_that_alternate_are_of_order_2(void)
{
    check_sequence(one_to_two, SE3D_METHOD_GENERALIZED_ALPHA);
    check_sequence(one_to_two, SE3D_METHOD_HHT);
    check_sequence(one_to_five, SE3D_METHOD_GENERALIZED_ALPHA);
    check_sequence(one_to_five, SE3D_METHOD_HHT);
}

static void steps_of_chance_are_of_order_2(void)
{
    check_sequence(chance, SE3D_METHOD_GENERALIZED_ALPHA);
    check_sequence(chance, SE3D_METHOD_HHT);
}

int main(void)
{
    RUN(equal_steps_are_of_order_2_from_the_first_one);
    RUN(steps_that_alternate_are_of_order_2);
    RUN(steps_of_chance_are_of_order_2);
    return check_finish();
}
