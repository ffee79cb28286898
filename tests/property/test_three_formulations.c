/* SPDX-License-Identifier: BSD-3-Clause */
/* Euler parameters, angular velocities and joint coordinates give one motion: positions,
 * velocities, accelerations and reactions of every mechanism agree to 1e-11 of the largest value of
 * each, by both methods that integrate all three. */
#include "check.h"
#include "support/models.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 8, BODIES = 8, JOINTS = 10, KINDS = 7 };

static const char *const kinds[KINDS] = {"positions",
                                         "velocities",
                                         "angular velocities",
                                         "accelerations",
                                         "angular accelerations",
                                         "forces of joints",
                                         "torques of joints"};

typedef struct record {
    double values[KINDS][SAMPLES][JOINTS][3];
} record;

static void observe(const support_model *model, int sample, record *out)
{
    static se3d_status (*const get[5])(const se3d_system *, se3d_body, double *) = {
        se3d_body_get_position, se3d_body_get_velocity, se3d_body_get_angular_velocity,
        se3d_body_get_acceleration, se3d_body_get_angular_acceleration};
    for (int b = 0; b < model->body_count; ++b) {
        for (int k = 0; k < 5; ++k) {
            CHECK(!get[k](model->system, model->bodies[b], out->values[k][sample][b]));
        }
    }
    for (int j = 0; j < model->joint_count; ++j) {
        CHECK(!se3d_constraint_get_reaction(model->system, model->joints[j],
                                            out->values[5][sample][j], out->values[6][sample][j]));
    }
}

static void run(const char *name, int count, int32_t method, int32_t formulation, double duration,
                record *out)
{
    support_model model;
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    memset(out, 0, sizeof *out);
    support_model_make(&model, name, count);
    CHECK(model.body_count <= BODIES && model.joint_count <= JOINTS);
    def.method = method;
    def.formulation = formulation;
    def.tolerance = 1e-12;
    CHECK(!se3d_solver_create(model.system, &def, &solver));
    for (int k = 0; k < SAMPLES; ++k) {
        CHECK(se3d_solver_run(solver, duration * (k + 1) / SAMPLES) >= 0);
        observe(&model, k, out);
    }
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
}

static void compare(const record *a, const record *b, const char *name, int32_t formulation)
{
    double size = 0.0;
    for (int kind = 0; kind < KINDS; ++kind) {
        const double *x = &a->values[kind][0][0][0], *y = &b->values[kind][0][0][0];
        double worst = 0.0;
        size = kind < KINDS - 1 ? 1e-3 : size; /* torques beside forces, a metre away */
        for (int k = 0; k < SAMPLES * JOINTS * 3; ++k) {
            worst = fmax(worst, fabs(x[k] - y[k]));
            size = fmax(size, fabs(x[k]));
        }
        CHECK(worst <= 1e-11 * size);
        if (!(worst <= 1e-11 * size) || getenv("SE3D_TEST_VERBOSE")) {
            fprintf(stderr, "%s, formulation %d, %s: %.1e of %.1e\n", name, (int)formulation,
                    kinds[kind], worst, size);
        }
    }
}

static void all_three_agree_on_every_mechanism(void)
{
    static const struct {
        const char *name;
        int count;
        double duration;
    } rows[] = {{"pendulum", 1, 2.0},
                {"double_pendulum", 1, 1.0},
                {"heavy_top", 1, 0.2},
                {"four_bar", 1, 0.6},
                {"four_bar", 2, 0.4},
                {"slider_crank", 1, 0.6},
                {"chain_revolute", 6, 0.7},
                {"chain_ball", 4, 0.7},
                {"driven_double_pendulum", 1, 1.0}};
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_GAUSS};
    static record first, other;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        run(rows[k].name, rows[k].count, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA,
            rows[k].duration, &first);
        for (int m = 0; m < 2; ++m) {
            for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_JOINT; ++f) {
                run(rows[k].name, rows[k].count, methods[m], f, rows[k].duration, &other);
                compare(&first, &other, rows[k].name, f);
            }
        }
    }
}

int main(void)
{
    RUN(all_three_agree_on_every_mechanism);
    return check_finish();
}
