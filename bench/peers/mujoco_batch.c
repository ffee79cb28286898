/* SPDX-License-Identifier: BSD-3-Clause */
/* What bench_batch measures, by MuJoCo: mj_step with rk4 and with its default method, mj_forward
 * and mj_inverse, of arms of six hinges without contact, one mjData each, new efforts before every
 * step. Arguments: states (64; more of them no longer fit into the cache), and `plane` for arms
 * whose axes are all parallel. */
#define _POSIX_C_SOURCE 200809L
#include "../arm.h"
#include "../clock.h"

#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 9, STEPS = 225 };

static mjModel *load(int in_plane)
{
    static char text[8192], error[256];
    static mjVFS files;
    size_t n = (size_t)snprintf(
        text, sizeof text,
        "<mujoco><option gravity='0 0 -9.81' timestep='%g'><flag contact='disable' "
        "constraint='disable'/></option><worldbody>",
        BENCH_ARM_STEP);
    for (int k = 0; k < BENCH_ARM_LINKS; ++k) {
        static const double y[3] = {0.0, 1.0, 0.0};
        const bench_link *l = &bench_arm[k];
        const double *axis = in_plane ? y : l->axis;
        n += (size_t)snprintf(text + n, sizeof text - n,
                              "<body pos='%g %g %g'><joint type='hinge' axis='%g %g %g'/>"
                              "<inertial pos='%g %g %g' mass='%g' diaginertia='%g %g %g'/>",
                              l->at[0], l->at[1], l->at[2], axis[0], axis[1], axis[2], l->centre[0],
                              l->centre[1], l->centre[2], l->mass, l->inertia[0], l->inertia[1],
                              l->inertia[2]);
    }
    for (int k = 0; k < BENCH_ARM_LINKS; ++k) {
        n += (size_t)snprintf(text + n, sizeof text - n, "</body>");
    }
    (void)snprintf(text + n, sizeof text - n, "</worldbody></mujoco>");
    mj_defaultVFS(&files);
    mj_makeEmptyFileVFS(&files, "arm.xml", (int)strlen(text));
    memcpy(files.filedata[mj_findFileVFS(&files, "arm.xml")], text, strlen(text));
    mjModel *model = mj_loadXML("arm.xml", &files, error, sizeof error);
    if (!model) {
        fprintf(stderr, "%s\n", error);
        exit(1);
    }
    return model;
}

typedef struct work {
    mjModel *model;
    mjData **data;
    int count, reserved;
    unsigned long seed;
} work;

static void step(work *w)
{
    for (int k = 0; k < w->count; ++k) {
        for (int c = 0; c < w->model->nv; ++c) {
            w->data[k]->qfrc_applied[c] = bench_effort(&w->seed);
        }
        mj_step(w->model, w->data[k]);
    }
}

static void forward(work *w)
{
    for (int k = 0; k < w->count; ++k) {
        mj_forward(w->model, w->data[k]);
    }
}

static void inverse(work *w)
{
    for (int k = 0; k < w->count; ++k) {
        mj_inverse(w->model, w->data[k]);
    }
}

static void measure(work *w, void (*compute)(work *), const char *what)
{
    double least = HUGE_VAL;
    for (int round = 0; round < ROUNDS; ++round) {
        const double begin = bench_clock();
        for (int k = 0; k < STEPS; ++k) {
            compute(w);
        }
        least = fmin(least, bench_clock() - begin);
    }
    const double each = 1e9 * least / STEPS / w->count;
    printf("  %-14s %8.1f ns CPU a state: %.3g a second and core\n", what, each, 1e9 / each);
}

int main(int argc, char **argv)
{
    const int in_plane = argc > 2 && strcmp(argv[2], "plane") == 0;
    work w = {.model = load(in_plane), .count = argc > 1 ? atoi(argv[1]) : 64, .seed = 1};
    w.data = calloc((size_t)w.count, sizeof *w.data);
    for (int k = 0; w.data && k < w.count; ++k) {
        w.data[k] = mj_makeData(w.model);
    }
    if (!w.data || !w.data[w.count - 1]) {
        return 1;
    }
    printf("MuJoCo %d, %d arms, 1 thread\n", mj_version(), w.count);
    w.model->opt.integrator = mjINT_RK4;
    for (int k = 0; k < 225 && w.count == 1; ++k) { /* what bench_batch prints of its only state */
        step(&w);
    }
    const mjtNum *q = w.data[0]->qpos;
    printf("  state 0: q = %.9f %.9f %.9f %.9f %.9f %.9f\n", q[0], q[1], q[2], q[3], q[4], q[5]);
    measure(&w, step, "rk4 step");
    w.model->opt.integrator = mjINT_EULER;
    measure(&w, step, "euler step");
    measure(&w, forward, "mj_forward");
    measure(&w, inverse, "mj_inverse");
    return 0;
}
