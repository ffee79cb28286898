/* SPDX-License-Identifier: BSD-3-Clause */
/* The observed order of every method in positions, velocities and reactions.
 *
 * Three runs with steps h, h/2, h/4 give the order without a reference:
 * log2(|y_h - y_h/2| / |y_h/2 - y_h/4|). A new method is a new row. */
#include "check.h"
#include "support/models.h"

#include <stdlib.h>

#define BODIES_MAX 4
#define JOINTS_MAX 4

typedef struct method_row {
    const char *name;
    int32_t method;
    double spectral_radius, alpha;
    double order[3];  /* positions, velocities, reactions */
    double tolerance; /* of the observed order */
    double scale;     /* of the mechanism's step */
} method_row;

static const method_row methods[] = {
    {"generalized_alpha 0.9", SE3D_METHOD_GENERALIZED_ALPHA, 0.9, -0.1, {2, 2, 2}, 0.1, 1},
    {"generalized_alpha 0.5", SE3D_METHOD_GENERALIZED_ALPHA, 0.5, -0.1, {2, 2, 2}, 0.1, 1},
    {"generalized_alpha 0", SE3D_METHOD_GENERALIZED_ALPHA, 0.0, -0.1, {2, 2, 2}, 0.1, 1},
    {"hht -0.1", SE3D_METHOD_HHT, 0.9, -0.1, {2, 2, 2}, 0.1, 1},
    {"hht -0.3", SE3D_METHOD_HHT, 0.9, -0.3, {2, 2, 2}, 0.1, 1},
};

typedef struct mechanism_row {
    const char *name;
    double h, t_end; /* h: the longest of the three steps, for a method of order 2 [s] */
} mechanism_row;

/* Long enough for the start to die out (spectral radius^steps) in the coarsest run. */
static const mechanism_row mechanisms[] = {
    {"pendulum", 4e-3, 0.8},   {"double_pendulum", 2e-3, 0.6},        {"heavy_top", 1e-3, 0.25},
    {"four_bar", 4e-3, 0.72},  {"driven_double_pendulum", 2e-3, 0.5}, {"slider_crank", 1e-3, 0.2},
    {"chain_ball", 1e-3, 0.2},
};

/* What is compared: [0] r and p, [1] v and w, [2] forces and torques of the joints. */
typedef struct outcome {
    double values[3][8 * BODIES_MAX];
    int count[3];
    double time;
    int status;
} outcome;

static void append(outcome *out, int kind, const double *values, int count)
{
    memcpy(out->values[kind] + out->count[kind], values, (size_t)count * sizeof *values);
    out->count[kind] += count;
}

static void collect(const support_model *model, outcome *out)
{
    for (int k = 0; k < model->body_count; ++k) {
        double r[3], p[4], v[3], w[3];
        CHECK(se3d_body_get_position(model->system, model->bodies[k], r) == SE3D_OK);
        CHECK(se3d_body_get_orientation(model->system, model->bodies[k], p) == SE3D_OK);
        CHECK(se3d_body_get_velocity(model->system, model->bodies[k], v) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(model->system, model->bodies[k], w) == SE3D_OK);
        append(out, 0, r, 3);
        append(out, 0, p, 4);
        append(out, 1, v, 3);
        append(out, 1, w, 3);
    }
    for (int k = 0; k < model->joint_count; ++k) {
        double force[3], torque[3];
        CHECK(se3d_constraint_get_reaction(model->system, model->joints[k], force, torque) ==
              SE3D_OK);
        append(out, 2, force, 3);
        append(out, 2, torque, 3);
    }
    CHECK(se3d_system_get_time(model->system, &out->time) == SE3D_OK);
}

static outcome run(const char *mechanism, const method_row *row, int32_t formulation, double h,
                   int steps)
{
    outcome out = {0};
    support_model model;
    support_model_make(&model, mechanism, strcmp(mechanism, "chain_ball") == 0 ? 3 : 1);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.method = row->method;
    def.formulation = formulation;
    def.spectral_radius = row->spectral_radius;
    def.alpha = row->alpha;
    def.step = h;
    out.status = se3d_solver_create(model.system, &def, &solver);
    for (int k = 0; k < steps && out.status >= 0; ++k) {
        out.status = se3d_solver_step(solver, h);
    }
    if (out.status >= 0) {
        collect(&model, &out);
    }
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    return out;
}

static double distance(const outcome *a, const outcome *b, int kind)
{
    double largest = 0.0;
    for (int k = 0; k < a->count[kind]; ++k) {
        largest = fmax(largest, fabs(a->values[kind][k] - b->values[kind][k]));
    }
    return largest;
}

static void check_order(const mechanism_row *mechanism, const method_row *row, int32_t formulation)
{
    static const char *const kinds[3] = {"positions", "velocities", "reactions"};
    outcome out[3];
    int steps = (int)lround(mechanism->t_end / (mechanism->h * row->scale));
    for (int k = 0; k < 3; ++k) {
        out[k] =
            run(mechanism->name, row, formulation, mechanism->t_end / (steps << k), steps << k);
        CHECK(out[k].status >= 0);
        if (out[k].status < 0) {
            fprintf(stderr, "%s, %s: %s\n", mechanism->name, row->name,
                    se3d_status_get_text((se3d_status)out[k].status));
            return;
        }
        CHECK_NEAR(out[k].time, mechanism->t_end, 1e-12);
    }
    for (int kind = 0; kind < 3; ++kind) {
        double coarse = distance(&out[0], &out[1], kind);
        double fine = distance(&out[1], &out[2], kind);
        double order = log2(coarse / fine);
        if (!(fabs(order - row->order[kind]) <= row->tolerance) || getenv("SE3D_TEST_VERBOSE")) {
            fprintf(stderr, "%s, %s, %s, %s: order %.3f (%.3g, %.3g)\n", mechanism->name, row->name,
                    formulation == SE3D_FORMULATION_RP ? "rp" : "romega", kinds[kind], order,
                    coarse, fine);
        }
        CHECK_NEAR(order, row->order[kind], row->tolerance);
    }
}

static void every_method_has_its_order_in_positions_velocities_and_reactions(void)
{
    for (size_t m = 0; m < sizeof mechanisms / sizeof mechanisms[0]; ++m) {
        for (size_t k = 0; k < sizeof methods / sizeof methods[0]; ++k) {
            check_order(&mechanisms[m], &methods[k], SE3D_FORMULATION_ROMEGA);
            check_order(&mechanisms[m], &methods[k], SE3D_FORMULATION_RP);
        }
    }
}

/* At t = 1 s from rest, bars of 4 m and 2 m: centres of mass from an independent integration of the
 * two angle equations at a tolerance of 1e-13 (tests/data/double_pendulum.csv). */
static void double_pendulum_is_within_a_micrometre_at_small_steps(void)
{
    const double expected[2][3] = {{0.0, 0.16807258586693044, -1.9929253889395866},
                                   {0.0, 1.3129965652368425, -4.1997698163289643}};
    for (int32_t formulation = 0; formulation < 2; ++formulation) {
        for (size_t k = 0; k < sizeof methods / sizeof methods[0]; k += 3) {
            outcome out = run("double_pendulum", &methods[k], formulation, 1e-4, 10000);
            CHECK(out.status >= 0);
            for (int c = 0; c < 3; ++c) {
                CHECK_NEAR(out.values[0][c], expected[0][c], 1e-6);
                CHECK_NEAR(out.values[0][7 + c], expected[1][c], 1e-6);
            }
        }
    }
}

int main(void)
{
    RUN(every_method_has_its_order_in_positions_velocities_and_reactions);
    RUN(double_pendulum_is_within_a_micrometre_at_small_steps);
    return check_finish();
}
