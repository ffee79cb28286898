/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches: CPU time of a step of a state, rk4 at 1 ms with new efforts before every step, and of
 * accelerations and efforts (inverse dynamics), for arms of six revolutes (bench/arm.h).
 * Arguments: states and threads (4096 1), and `plane` for arms whose axes are all parallel;
 * peers/mujoco_batch.c does the same. */
#define _POSIX_C_SOURCE 200809L
#include "arm.h"
#include "clock.h"

#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 9, STEPS = 25 };

static void need(se3d_status status, const char *what, const char *why)
{
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", what, why);
        exit(1);
    }
}

static se3d_system *make_arm(int in_plane)
{
    se3d_system *system = NULL;
    se3d_body before;
    double joint[3] = {0.0, 0.0, 0.0};
    need(se3d_system_create(NULL, &system), "system", "no memory");
    need(se3d_system_get_ground(system, &before), "ground", "");
    const double *centre_before = joint;
    for (int k = 0; k < BENCH_ARM_LINKS; ++k) {
        const bench_link *link = &bench_arm[k];
        se3d_body_def body = se3d_body_def_default();
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint made;
        body.mass = link->mass;
        def.body_i = before;
        for (int c = 0; c < 3; ++c) {
            def.point_i[c] = link->at[c] - (k > 0 ? centre_before[c] : 0.0);
            def.point_j[c] = -link->centre[c];
            def.axis_i[c] = def.axis_j[c] = in_plane ? c == 1 : link->axis[c];
            joint[c] += link->at[c];
            body.position[c] = joint[c] + link->centre[c];
            body.inertia[c] = link->inertia[c];
        }
        need(se3d_body_create(system, &body, &before), "body", se3d_system_get_error(system));
        def.body_j = before;
        need(se3d_joint_create_revolute(system, &def, &made), "joint",
             se3d_system_get_error(system));
        centre_before = link->centre;
    }
    return system;
}

typedef struct work {
    se3d_batch *batch;
    size_t count;
    unsigned long seed;
    double *effort, *qddot;
} work;

static void step(work *w)
{
    for (size_t k = 0; k < w->count * BENCH_ARM_LINKS; ++k) {
        w->effort[k] = bench_effort(&w->seed);
    }
    need(se3d_batch_set_efforts(w->batch, 0, w->count, w->effort), "efforts",
         se3d_batch_get_error(w->batch));
    need(se3d_batch_step(w->batch, SE3D_METHOD_RK4, BENCH_ARM_STEP, 1), "step",
         se3d_batch_get_error(w->batch));
}

static void accelerate(work *w)
{
    need(se3d_batch_compute_accelerations(w->batch, w->qddot), "accelerations",
         se3d_batch_get_error(w->batch));
}

static void find_efforts(work *w)
{
    need(se3d_batch_compute_efforts(w->batch, w->qddot, w->effort), "efforts",
         se3d_batch_get_error(w->batch));
}

/* Least CPU time, and wall time, of a state [ns]. */
static void measure(work *w, void (*compute)(work *), const char *what)
{
    double cpu = HUGE_VAL, wall = HUGE_VAL;
    for (int round = 0; round < ROUNDS; ++round) {
        const double c = bench_clock(), t = bench_clock_of(CLOCK_MONOTONIC);
        for (int k = 0; k < STEPS; ++k) {
            compute(w);
        }
        cpu = fmin(cpu, bench_clock() - c);
        wall = fmin(wall, bench_clock_of(CLOCK_MONOTONIC) - t);
    }
    const double scale = 1e9 / STEPS / (double)w->count;
    printf("  %-14s %8.1f ns CPU, %8.1f ns wall a state: %.3g a second and core\n", what,
           scale * cpu, scale * wall, 1e9 / (scale * cpu));
}

int main(int argc, char **argv)
{
    const size_t count = argc > 1 ? (size_t)strtoul(argv[1], NULL, 10) : 4096;
    const int threads = argc > 2 ? atoi(argv[2]) : 1;
    const int in_plane = argc > 3 && strcmp(argv[3], "plane") == 0;
    se3d_system *system = make_arm(in_plane);
    work w = {.count = count, .seed = 1};
    need(se3d_batch_create(system, count, threads, &w.batch), "batch",
         se3d_system_get_error(system));
    w.effort = calloc(count * BENCH_ARM_LINKS, sizeof(double));
    w.qddot = calloc(count * BENCH_ARM_LINKS, sizeof(double));
    if (!w.effort || !w.qddot) {
        return 1;
    }
    printf("se3d, %zu arms%s, %d threads, %zu lanes\n", count, in_plane ? " in the plane" : "",
           threads, se3d_batch_count_lanes(w.batch));
    measure(&w, step, "rk4 step");
    measure(&w, accelerate, "accelerations");
    measure(&w, find_efforts, "efforts");
    double q[BENCH_ARM_LINKS];
    need(se3d_batch_get_state(w.batch, 0, 1, q, NULL), "state", "");
    printf("  state 0 after %d steps: q = %.9f %.9f %.9f %.9f %.9f %.9f\n", ROUNDS * STEPS, q[0],
           q[1], q[2], q[3], q[4], q[5]);
    free(w.effort);
    free(w.qddot);
    se3d_batch_destroy(w.batch);
    se3d_system_destroy(system);
    return 0;
}
