/* SPDX-License-Identifier: BSD-3-Clause */
/* What the recursions of joint coordinates cost, in ns a link, with no solver around them: chains
 * of revolutes (a) and of balls (b). `state`: coordinates to poses and velocities of all bodies;
 * `acceleration`: that, and from wrenches on the bodies to accelerations of the coordinates;
 * `reactions`: multipliers of all joints on top of it. Arguments: counts of links. */
#define _POSIX_C_SOURCE 200809L
#include "mechanisms.h"

#include "assembly/loads.h"
#include "system/system_internal.h"
#include "tree/core.h"
#include "tree/recursion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define ROUNDS 15

typedef struct work {
    se3di_model *model;
    se3di_tree tree;
    double *q, *qdot, *qddot, *wrench, *joint, *lambda;
} work;

static double cpu_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void find_state(work *w)
{
    se3di_tree_place(&w->tree, w->q, w->qdot, w->model->frames);
}

static void find_acceleration(work *w)
{
    find_state(w);
    se3di_tree_take_wrenches(&w->tree, w->model->frames, w->wrench);
    (void)se3di_tree_factor(&w->tree, NULL);
    se3di_tree_accelerate(&w->tree, w->tree.e, w->qddot);
}

static void find_reactions(work *w)
{
    find_acceleration(w);
    w->tree.core->transmit(&w->tree, w->tree.wrench, w->joint);
    se3di_tree_multipliers(&w->tree, w->joint, NULL, w->lambda);
}

/* Least time of some rounds [ns a link]; what is computed enters what comes next. */
static double measure(work *w, void (*compute)(work *))
{
    const int count = 20 + 40000 / (int)w->tree.count;
    double least = 1e300;
    for (int round = 0; round < ROUNDS; ++round) {
        const double begin = cpu_time();
        for (int k = 0; k < count; ++k) {
            compute(w);
            w->qdot[0] += 1e-12 * w->qddot[0];
        }
        least = fmin(least, cpu_time() - begin);
    }
    return 1e9 * least / count / w->tree.count;
}

static double *take(size_t count)
{
    double *memory = calloc(count + 1, sizeof *memory);
    if (!memory) {
        exit(1);
    }
    return memory;
}

static void run(char kind, int n)
{
    bench_mechanism m = bench_build(kind, n);
    work w = {.model = &m.system->model};
    uint32_t failed;
    if (m.status < 0 || se3di_tree_init(&w.tree, w.model, NULL) < 0) {
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
    const double reactions = measure(&w, find_reactions);
    printf("%c %4d links: state %6.1f, acceleration %6.1f, reactions %6.1f ns a link\n", kind, n,
           state, acceleration, reactions - acceleration);
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
