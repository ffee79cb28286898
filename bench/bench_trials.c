/* SPDX-License-Identifier: BSD-3-Clause */
/* Monte Carlo of a four-bar in batches: masses and gravity of their own, 1 s from rest. Prints the
 * time of all runs and the largest error of some of them against a solver at 1e-12.
 * Arguments: runs, threads and steps of dop853 (100000 1 40). */
#define _POSIX_C_SOURCE 200809L
#include "clock.h"
#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BARS = 3, GROUP = 4096, CHECKED = 16 };

static const double ends[BARS + 1][2] = {{0.0, 0.0}, {0.1, 0.4}, {1.2, 0.8}, {1.0, 0.0}};

typedef struct trial {
    double mass[BARS], gravity[3];
} trial;

static void need(se3d_status status, const char *why)
{
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", se3d_status_get_text(status), why);
        exit(1);
    }
}

static double between(unsigned long *seed, double low, double high)
{
    *seed = *seed * 6364136223846793005ul + 1442695040888963407ul;
    return low + (high - low) * ((double)(*seed >> 11) * 0x1p-53);
}

/* The same whoever asks for it. */
static trial make_trial(size_t k)
{
    unsigned long seed = 2862933555777941757ul * (unsigned long)k + 1;
    trial t = {.gravity = {0.0, -9.81, 0.0}};
    (void)between(&seed, 0.0, 1.0);
    for (int b = 0; b < BARS; ++b) {
        t.mass[b] = between(&seed, 0.8, 1.2);
    }
    t.gravity[0] = between(&seed, -0.5, 0.5);
    return t;
}

static void take_inertia(int bar, double mass, double inertia[6])
{
    const double square =
        pow(ends[bar + 1][0] - ends[bar][0], 2.0) + pow(ends[bar + 1][1] - ends[bar][1], 2.0);
    for (int k = 0; k < 6; ++k) {
        inertia[k] = k < 3 ? mass * square / 12.0 : 0.0;
    }
}

static void join(se3d_system *system, se3d_body i, const double at_i[2], se3d_body j,
                 const double at_j[2])
{
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint;
    def.body_i = i;
    def.body_j = j;
    for (int c = 0; c < 2; ++c) {
        def.point_i[c] = at_i[c];
        def.point_j[c] = at_j[c];
    }
    need(se3d_joint_create_revolute(system, &def, &joint), se3d_system_get_error(system));
}

static se3d_system *make_fourbar(const trial *t, se3d_body bar[BARS])
{
    se3d_system *system = NULL;
    se3d_body ground, last;
    need(se3d_system_create(NULL, &system), "system");
    need(se3d_system_set_gravity(system, t->gravity), "gravity");
    need(se3d_system_get_ground(system, &ground), "ground");
    last = ground;
    double at[2] = {0.0, 0.0};
    for (int b = 0; b < BARS; ++b) {
        se3d_body_def def = se3d_body_def_default();
        double half[2], start[2];
        def.mass = t->mass[b];
        take_inertia(b, def.mass, def.inertia);
        for (int c = 0; c < 2; ++c) {
            half[c] = 0.5 * (ends[b + 1][c] - ends[b][c]);
            start[c] = -half[c];
            def.position[c] = ends[b][c] + half[c];
        }
        need(se3d_body_create(system, &def, &bar[b]), se3d_system_get_error(system));
        join(system, last, at, bar[b], start);
        at[0] = half[0];
        at[1] = half[1];
        last = bar[b];
    }
    join(system, last, at, ground, ends[BARS]);
    return system;
}

/* How far the coupler of a run is from where a solver brings it. */
static double find_error(se3d_batch *batch, size_t state, size_t run)
{
    const trial t = make_trial(run);
    se3d_body bar[BARS], own[BARS];
    se3d_system *exact = make_fourbar(&t, bar), *ours = make_fourbar(&t, own);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver;
    se3d_coordinates *c;
    double q[16], qdot[16], r[2][3], sum = 0.0;
    def.method = SE3D_METHOD_DOP853;
    def.tolerance = 1e-12;
    need(se3d_solver_create(exact, &def, &solver), se3d_system_get_error(exact));
    need(se3d_solver_run(solver, 1.0), se3d_system_get_error(exact));
    need(se3d_batch_get_state(batch, state, 1, q, qdot), "state");
    need(se3d_coordinates_create(ours, &c), "coordinates");
    need(se3d_coordinates_set(c, q, qdot), "coordinates");
    need(se3d_body_get_position(exact, bar[1], r[0]), "position");
    need(se3d_body_get_position(ours, own[1], r[1]), "position");
    for (int k = 0; k < 3; ++k) {
        sum += (r[0][k] - r[1][k]) * (r[0][k] - r[1][k]);
    }
    se3d_coordinates_destroy(c);
    se3d_solver_destroy(solver);
    se3d_system_destroy(exact);
    se3d_system_destroy(ours);
    return sqrt(sum);
}

static void set_group(se3d_batch *batch, const se3d_body bar[BARS], const double *q,
                      const double *qdot, size_t first, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        const trial t = make_trial(first + k);
        for (int b = 0; b < BARS; ++b) {
            double inertia[6];
            take_inertia(b, t.mass[b], inertia);
            need(se3d_batch_set_mass(batch, bar[b], k, 1, &t.mass[b], inertia), "mass");
        }
        need(se3d_batch_set_gravity(batch, k, 1, t.gravity), "gravity");
    }
    const double zero = 0.0;
    for (size_t k = 0; k < count; ++k) {
        need(se3d_batch_set_time(batch, k, 1, &zero), "time");
    }
    need(se3d_batch_set_state(batch, 0, count, q, qdot), se3d_batch_get_error(batch));
}

int main(int argc, char **argv)
{
    const size_t runs = argc > 1 ? (size_t)strtoul(argv[1], NULL, 10) : 100000;
    const int threads = argc > 2 ? atoi(argv[2]) : 1, steps = argc > 3 ? atoi(argv[3]) : 40;
    const trial plain = {{1.0, 1.0, 1.0}, {0.0, -9.81, 0.0}};
    se3d_body bar[BARS];
    se3d_system *system = make_fourbar(&plain, bar);
    se3d_batch *batch;
    double error = 0.0;
    need(se3d_batch_create(system, GROUP, threads, &batch), se3d_system_get_error(system));
    const size_t positions = se3d_batch_count_positions(batch);
    const size_t velocities = se3d_batch_count_velocities(batch);
    double *q = calloc(GROUP * positions, sizeof *q), *qdot = calloc(GROUP * velocities, sizeof *q);
    if (!q || !qdot || steps < 1) {
        return 1;
    }
    need(se3d_batch_get_state(batch, 0, GROUP, q, qdot), "state");
    const double c = bench_clock(), t = bench_clock_of(CLOCK_MONOTONIC);
    for (size_t first = 0; first < runs; first += GROUP) {
        const size_t count = runs - first < GROUP ? runs - first : GROUP;
        set_group(batch, bar, q, qdot, first, count);
        need(se3d_batch_step(batch, SE3D_METHOD_DOP853, 1.0 / steps, (uint64_t)steps),
             se3d_batch_get_error(batch));
        for (size_t k = 0; first == 0 && k < CHECKED && k < count; ++k) {
            error = fmax(error, find_error(batch, k, k));
        }
    }
    printf("se3d, %zu four-bars for 1 s, %d steps of dop853, %d threads, %zu lanes:\n"
           "  %.2f s CPU, %.2f s wall, %.2f us CPU a run; off by %.2g m at most (%d runs)\n",
           runs, steps, threads, se3d_batch_count_lanes(batch), bench_clock() - c,
           bench_clock_of(CLOCK_MONOTONIC) - t, 1e6 * (bench_clock() - c) / (double)runs, error,
           CHECKED);
    free(q);
    free(qdot);
    se3d_batch_destroy(batch);
    se3d_system_destroy(system);
    return 0;
}
