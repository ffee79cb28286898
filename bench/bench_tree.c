/* SPDX-License-Identifier: BSD-3-Clause */
/* What the recursions of joint coordinates cost, in ns a link, with no solver around them: chains
 * of revolutes (a) and of balls (b). `acceleration`: from coordinates and velocities to
 * accelerations of the coordinates under gravity, as stages of a run need them; `frames`: poses and
 * velocities of all bodies; `with frames`: these, and accelerations from wrenches on the bodies;
 * `reactions`: multipliers of all joints on top of that; `lanes`: accelerations under gravity of 4
 * and of 8 states at once, a link and state. Arguments: counts of links. */
#define _POSIX_C_SOURCE 200809L
#include "clock.h"
#include "mechanisms.h"

#include "assembly/loads.h"
#include "system/system_internal.h"
#include "tree/core.h"
#include "tree/lanes.h"
#include "tree/recursion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define ROUNDS 15

typedef struct work {
    se3di_model *model;
    se3di_tree tree;
    double *q, *qdot, *qddot, *wrench, *joint, *lambda;
} work;

static void find_state(work *w)
{
    se3di_tree_place(&w->tree, w->q, w->qdot, w->model->frames);
}

static void find_acceleration(work *w)
{
    se3di_tree_place(&w->tree, w->q, w->qdot, NULL);
    se3di_tree_pull(&w->tree, w->model->gravity);
    (void)se3di_tree_factor(&w->tree, NULL);
    se3di_tree_accelerate(&w->tree, w->tree.e, w->qddot);
}

static void find_with_frames(work *w)
{
    find_state(w);
    se3di_tree_take_wrenches(&w->tree, w->model->frames, w->wrench);
    (void)se3di_tree_factor(&w->tree, NULL);
    se3di_tree_accelerate(&w->tree, w->tree.e, w->qddot);
}

static void find_reactions(work *w)
{
    find_with_frames(w);
    w->tree.core->transmit(&w->tree, w->tree.wrench, 0, w->joint);
    se3di_tree_multipliers(&w->tree, w->joint, NULL, 0, w->lambda);
}

static double *take(size_t count)
{
    double *memory = calloc(count + 1, sizeof *memory);
    if (!memory) {
        exit(1);
    }
    return memory;
}

/* The same under gravity for `width` states at once [ns a link and state]; 0: not here. */
static double measure_lanes(const work *w, int width)
{
    const se3di_lane_core *core = se3di_lane_core_find(width);
    const int count = 20 + 10000 / (int)w->tree.count;
    const size_t size = 7 * (size_t)w->tree.count * SE3DI_LANES_MAX + SE3DI_LANES_ALIGN;
    double least = 1e300;
    se3di_lanes lanes;
    if (!core || se3di_lanes_init(&lanes, &w->tree, core, 0) < 0) {
        return 0.0;
    }
    double *memory = take(4 * size), *q = se3di_lanes_align(memory), *qdot = q + size;
    double *qddot = qdot + size, *gravity = qddot + size;
    for (size_t k = 0; k < (size_t)width * w->tree.q_count; ++k) {
        q[k] = w->q[k / (size_t)width];
    }
    for (int k = 0; k < width; ++k) {
        gravity[width + k] = -9.81;
    }
    se3di_lanes_load(&lanes, gravity, 0);
    for (int round = 0; round < ROUNDS; ++round) {
        const double begin = bench_clock();
        for (int k = 0; k < count; ++k) {
            core->place(&lanes, q, qdot);
            se3di_lanes_accelerate(&lanes, NULL, qddot);
            qdot[0] += 1e-12 * qddot[0];
        }
        least = fmin(least, bench_clock() - begin);
    }
    free(memory);
    se3di_lanes_destroy(&lanes);
    return 1e9 * least / count / w->tree.count / width;
}

/* Least time of some rounds [ns a link]; what is computed enters what comes next. */
static double measure(work *w, void (*compute)(work *))
{
    const int count = 20 + 40000 / (int)w->tree.count;
    double least = 1e300;
    for (int round = 0; round < ROUNDS; ++round) {
        const double begin = bench_clock();
        for (int k = 0; k < count; ++k) {
            compute(w);
            w->qdot[0] += 1e-12 * w->qddot[0];
        }
        least = fmin(least, bench_clock() - begin);
    }
    return 1e9 * least / count / w->tree.count;
}

static void run(char kind, int n)
{
    bench_mechanism m = bench_build(kind, n);
    work w = {.model = &m.system->model};
    uint32_t failed;
    if (m.status < 0 || se3di_tree_init(&w.tree, w.model, 1, NULL) < 0) {
        exit(1);
    }
    w.q = take(w.tree.q_count);
    w.qdot = take(w.tree.v_count);
    w.qddot = take(w.tree.v_count);
    w.wrench = take(6 * w.model->body_slots.count);
    w.joint = take(6 * (size_t)w.tree.count);
    w.lambda = take(w.model->row_count);
    se3di_tree_get(&w.tree, w.q, w.qdot);
    (void)se3di_loads_eval(w.model, 0.0, w.wrench, &failed);
    const double state = measure(&w, find_state);
    const double acceleration = measure(&w, find_acceleration);
    const double with_frames = measure(&w, find_with_frames);
    const double reactions = measure(&w, find_reactions);
    printf(
        "%c %4d links: acceleration %6.1f, frames %6.1f, with frames %6.1f, reactions %6.1f ns a "
        "link, lanes of 4: %5.1f, of 8: %5.1f\n",
        kind, n, acceleration, state, with_frames, reactions - with_frames, measure_lanes(&w, 4),
        measure_lanes(&w, 8));
    free(w.q);
    free(w.qdot);
    free(w.qddot);
    free(w.wrench);
    free(w.joint);
    free(w.lambda);
    se3di_tree_destroy(&w.tree);
    se3d_system_destroy(m.system);
}

int main(int argc, char **argv)
{
    static const int counts[] = {1, 2, 8, 32, 128, 512};
    for (const char *kind = "ab"; *kind; ++kind) {
        for (int k = 1; k < argc; ++k) {
            run(*kind, atoi(argv[k]));
        }
        for (size_t k = 0; argc < 2 && k < sizeof counts / sizeof counts[0]; ++k) {
            run(*kind, counts[k]);
        }
    }
    return 0;
}
