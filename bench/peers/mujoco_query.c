/* SPDX-License-Identifier: BSD-3-Clause */
/* What bench_query measures, by MuJoCo: the state and the applied forces are set, mj_forward; the
 * state and the accelerations, mj_inverse; without contact and constraints. */
#define _POSIX_C_SOURCE 200809L
#include "../clock.h"
#include "../robots.h"

#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 15, QUERIES = 2000 };

/* A link with all that hang on it. */
static size_t write_link(const bench_robot *r, int k, char *text, size_t room)
{
    const bench_link *l = &r->link[k];
    size_t n = (size_t)snprintf(text, room, "<body pos='%g %g %g'>", l->at[0], l->at[1], l->at[2]);
    if (r->is_free && k == 0) {
        n += (size_t)snprintf(text + n, room - n, "<freejoint/>");
    } else {
        n += (size_t)snprintf(text + n, room - n, "<joint type='hinge' axis='%g %g %g'/>",
                              l->axis[0], l->axis[1], l->axis[2]);
    }
    n += (size_t)snprintf(text + n, room - n,
                          "<inertial pos='%g %g %g' mass='%.17g' diaginertia='%.17g %.17g %.17g'/>",
                          l->centre[0], l->centre[1], l->centre[2], l->mass, l->inertia[0],
                          l->inertia[1], l->inertia[2]);
    for (int j = k + 1; j < r->count; ++j) {
        n += r->parent[j] == k ? write_link(r, j, text + n, room - n) : 0;
    }
    return n + (size_t)snprintf(text + n, room - n, "</body>");
}

static mjModel *load(const bench_robot *r)
{
    static char text[1 << 15], error[256];
    static mjVFS files;
    size_t n = (size_t)snprintf(text, sizeof text,
                                "<mujoco><option gravity='0 0 -9.81' timestep='%g' "
                                "integrator='RK4'><flag contact='disable' constraint='disable'/>"
                                "</option><worldbody>",
                                BENCH_ARM_STEP);
    n += write_link(r, 0, text + n, sizeof text - n);
    (void)snprintf(text + n, sizeof text - n, "</worldbody></mujoco>");
    mj_defaultVFS(&files);
    mj_makeEmptyFileVFS(&files, "robot.xml", (int)strlen(text));
    memcpy(files.filedata[mj_findFileVFS(&files, "robot.xml")], text, strlen(text));
    mjModel *model = mj_loadXML("robot.xml", &files, error, sizeof error);
    if (!model) {
        fprintf(stderr, "%s\n", error);
        exit(1);
    }
    mj_deleteVFS(&files);
    return model;
}

typedef struct robot {
    bench_robot of;
    mjModel *model;
    mjData *data;
    double q[BENCH_ROBOT_STATE + 1], qdot[BENCH_ROBOT_STATE], effort[BENCH_ROBOT_STATE];
    double qddot[BENCH_ROBOT_STATE];
    unsigned long seed;
} robot;

static void begin(robot *r, int which)
{
    *r = (robot){.of = bench_make_robot(which), .seed = 1};
    r->model = load(&r->of);
    r->data = mj_makeData(r->model);
    memcpy(r->q, r->data->qpos, (size_t)r->model->nq * sizeof(double));
    for (int k = r->of.is_free ? 7 : 0; k < r->model->nq; ++k) {
        r->q[k] = 0.1 * (double)(k % 7) - 0.3;
    }
    for (int k = 0; k < r->model->nv; ++k) {
        r->qdot[k] = 0.1 * (double)(k % 5) - 0.2;
        r->effort[k] = 0.2 * (double)(k % 3);
    }
}

static void set(robot *r)
{
    memcpy(r->data->qpos, r->q, (size_t)r->model->nq * sizeof(double));
    memcpy(r->data->qvel, r->qdot, (size_t)r->model->nv * sizeof(double));
}

static void forward(robot *r)
{
    set(r);
    memcpy(r->data->qfrc_applied, r->effort, (size_t)r->model->nv * sizeof(double));
    mj_forward(r->model, r->data);
    memcpy(r->qddot, r->data->qacc, (size_t)r->model->nv * sizeof(double));
}

static void inverse(robot *r)
{
    set(r);
    memcpy(r->data->qacc, r->qddot, (size_t)r->model->nv * sizeof(double));
    mj_inverse(r->model, r->data);
}

static void step(robot *r)
{
    const int base = r->of.is_free ? 6 : 0;
    for (int k = base; k < r->model->nv; ++k) {
        r->data->qfrc_applied[k] = 0.01 * bench_effort(&r->seed);
    }
    mj_step(r->model, r->data);
}

static double measure(robot *r, void (*ask)(robot *))
{
    double least = HUGE_VAL;
    for (int round = 0; round < ROUNDS; ++round) {
        const double start = bench_clock();
        for (int k = 0; k < QUERIES / ROUNDS; ++k) {
            ask(r);
        }
        least = fmin(least, bench_clock() - start);
    }
    return 1e9 * least / (QUERIES / ROUNDS);
}

int main(void)
{
    for (int which = 0; which < 3; ++which) {
        robot r;
        begin(&r, which);
        forward(&r);
        const int n = r.model->nv;
        printf("MuJoCo %-10s qddot %.7g %.7g %.7g;", r.of.name, r.qddot[0], r.qddot[n / 2],
               r.qddot[n - 1]);
        const double f = measure(&r, forward), i = measure(&r, inverse);
        printf(" forward %7.0f ns, inverse %7.0f ns,", f, i);
        memset(r.data->qfrc_applied, 0, (size_t)n * sizeof(double));
        printf(" rk4 step with new efforts %7.0f ns\n", measure(&r, step));
        mj_deleteData(r.data);
        mj_deleteModel(r.model);
    }
    return 0;
}
