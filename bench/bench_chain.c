/* SPDX-License-Identifier: BSD-3-Clause */
/* Work and precision of the integrators on chains, four-bar loops and a pendulum:
 *
 *     bench_chain [a|b|f|p] [N] [method] [formulation] [repeats]
 *
 * a: N bars with revolutes about z, b: with ball joints, each bar spun about itself, 1 s (N = 1:
 * 5 s); f: N windows of four-bars with plain revolutes, 10 s; p: point mass on a rod, 10 s. Prints
 * CPU time, the error of the tip against the reference, energy drift and counters for each
 * tolerance (for methods of fixed step: step). */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"
#include "mechanisms.h"

typedef struct bench_case {
    char kind;
    int n;
    se3d_system *system;
    se3d_body tip;
    double point[3];
    double duration;
    double exact[3];
    int has_exact;
} bench_case;

static void must(const bench_case *c, se3d_status status, const char *what)
{
    if (status < 0) {
        printf("%s: %d %s\n", what, status, c->system ? se3d_system_get_error(c->system) : "");
        exit(1);
    }
}

/* The tip at the end of the run; four-bars: all bars turn alike,
 * theta'' = g ((n + 1)/2 + n)/((n + 1)/3 + n) sin theta. */
static const struct {
    char kind;
    int n;
    double tip[3];
} exact_tips[] = {
    {'a', 1, {-0.980009892555, -0.198948763489, 0.0}},
    {'a', 8, {5.18365835706, -4.87899149535, 0.0}},
    {'a', 32, {30.5302553705, -4.90500000005, 0.0}},
    {'b', 1, {-0.980008964342, -0.198948832257, -0.00133863856}},
    {'b', 8, {5.18365835455, -4.87899147099, -1.7493042e-5}},
    {'f', 1, {0.47838505776097056, 0.8781501787912093, 0.0}},
    {'f', 5, {0.23578913584525585, 0.97180424130446533, 0.0}},
    {'f', 40, {0.18051222668672839, 0.98357274058231157, 0.0}},
};

static void build(bench_case *c)
{
    bench_mechanism m = bench_build(c->kind, c->n);
    c->system = m.system;
    must(c, m.status, "mechanism");
    c->tip = m.tip;
    memcpy(c->point, m.point, sizeof c->point);
    c->duration = c->kind == 'f' || c->kind == 'p' ? 10.0 : c->n == 1 ? 5.0 : 1.0;
    for (size_t k = 0; k < sizeof exact_tips / sizeof exact_tips[0]; ++k) {
        if (exact_tips[k].kind == c->kind && exact_tips[k].n == c->n) {
            c->has_exact = 1;
            memcpy(c->exact, exact_tips[k].tip, sizeof c->exact);
        }
    }
}

typedef struct bench_result {
    double seconds, drift, violation;
    double tip[3];
    se3d_solver_stats stats;
    const char *method;
} bench_result;

static bench_result run_once(bench_case c, const se3d_solver_def *def)
{
    bench_result r = {0};
    se3d_solver *solver;
    se3d_energy start, end;
    double p[4], gaps[3];
    build(&c);
    must(&c, se3d_solver_create(c.system, def, &solver), "solver");
    must(&c, se3d_solver_run(solver, 0.0), "start");
    must(&c, se3d_system_get_energy(c.system, &start), "energy");
    double begin = bench_clock();
    se3d_status status = se3d_solver_run(solver, c.duration);
    r.seconds = bench_clock() - begin;
    if (status < 0) {
        printf("failed: %s\n", se3d_system_get_error(c.system));
    }
    must(&c, se3d_system_get_energy(c.system, &end), "energy");
    must(&c, se3d_system_get_violation(c.system, gaps), "violation");
    must(&c, se3d_body_get_position(c.system, c.tip, r.tip), "position");
    must(&c, se3d_body_get_orientation(c.system, c.tip, p), "orientation");
    const double axis[3] = {p[0] * p[0] + p[1] * p[1] - p[2] * p[2] - p[3] * p[3],
                            2.0 * (p[1] * p[2] + p[0] * p[3]), 2.0 * (p[1] * p[3] - p[0] * p[2])};
    for (int k = 0; k < 3; ++k) {
        r.tip[k] += axis[k] * c.point[0];
    }
    r.drift = end.total - start.total;
    r.violation = gaps[0];
    must(&c, se3d_solver_get_stats(solver, &r.stats), "stats");
    must(&c, se3d_solver_get_method(solver, &r.method), "method");
    se3d_solver_destroy(solver);
    se3d_system_destroy(c.system);
    return r;
}

static void compare(bench_case *c, se3d_solver_def def, int repeats)
{
    int is_fixed = (getenv("FIXED") && (def.method == SE3D_METHOD_GENERALIZED_ALPHA ||
                                        def.method == SE3D_METHOD_HHT)) ||
                   def.method == SE3D_METHOD_RATTLE;
    bench_case probe = *c;
    build(&probe);
    se3d_system_destroy(probe.system);
    c->duration = probe.duration;
    memcpy(c->exact, probe.exact, sizeof c->exact);
    if (!probe.has_exact) {
        se3d_solver_def fine = def;
        fine.method = SE3D_METHOD_DOP853;
        fine.tolerance = 1e-13;
        fine.step = 0.0;
        bench_result reference = run_once(*c, &fine);
        memcpy(c->exact, reference.tip, sizeof c->exact);
        printf("reference: (%.15g, %.15g, %.15g)\n", c->exact[0], c->exact[1], c->exact[2]);
    }
    printf("%9s %11s %10s %10s %9s %7s %6s %8s %8s\n", "tolerance", "CPU [ms]", "tip error",
           "drift [J]", "gap", "steps", "reject", "evals", "factors");
    for (int k = 0; k < 12; ++k) {
        double x = is_fixed ? 0.01 * pow(0.5, k) : pow(10.0, -k);
        if (!is_fixed && k < 2) {
            continue;
        }
        def.tolerance = is_fixed ? 0.0 : x;
        def.step = is_fixed ? x : 0.0;
        bench_result best = run_once(*c, &def);
        for (int repeat = 1; repeat < repeats; ++repeat) {
            bench_result again = run_once(*c, &def);
            best.seconds = fmin(best.seconds, again.seconds);
        }
        double error = 0.0, size = 0.0;
        for (int i = 0; i < 3; ++i) {
            error += (best.tip[i] - c->exact[i]) * (best.tip[i] - c->exact[i]);
            size += c->exact[i] * c->exact[i];
        }
        printf("%9.1e %11.4f %10.2e %10.2e %9.1e %7lu %6lu %8lu %8lu\n", x, 1e3 * best.seconds,
               sqrt(error / size), best.drift, best.violation, (unsigned long)best.stats.steps,
               (unsigned long)best.stats.rejected, (unsigned long)best.stats.evaluations,
               (unsigned long)best.stats.factorizations);
    }
}

int main(int argc, char **argv)
{
    bench_case c = {.kind = argc > 1 ? argv[1][0] : 'a', .n = argc > 2 ? atoi(argv[2]) : 8};
    se3d_solver_def def = se3d_solver_def_default();
    def.method = argc > 3 ? atoi(argv[3]) : SE3D_METHOD_DOP853;
    def.formulation = argc > 4 ? atoi(argv[4]) : SE3D_FORMULATION_AUTO;
    compare(&c, def, argc > 5 ? atoi(argv[5]) : 3);
    return 0;
}
