/* SPDX-License-Identifier: BSD-3-Clause */
/* What every driver of the bench has in common (C and C++): it reads requests from its standard
 * input, one a line, and answers each with one line.
 *
 *     request   KIND N METHOD SETTING DURATION SAMPLES REPEATS
 *     answer    ok SECONDS X Y Z DRIFT GAP STEPS EVALUATIONS ITERATIONS FACTORIZATIONS
 *               or: no REASON
 *
 * KIND: a chain with revolutes, b chain with balls, f four-bar windows, p pendulum, and of this
 * library alone c chain closed at its end, g grid of four-bars; METHOD is the driver's own; SETTING
 * the step [s] or the tolerance; SAMPLES parts of the run between which energy and constraints are
 * looked at (1 if time is measured); SECONDS of CPU, the least of REPEATS runs, model building not
 * counted. X Y Z is the tip at the end, DRIFT the largest change of the energy [J], GAP the largest
 * violation.
 */
#ifndef BENCH_DRIVER_H
#define BENCH_DRIVER_H

#include "clock.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct bench_request {
    char kind;
    char method[47];
    int n;
    int samples;
    int repeats;
    int reserved;
    double setting;
    double duration;
} bench_request;

typedef struct bench_answer {
    double seconds;
    double tip[3];
    double drift, gap;
    double steps, evaluations, iterations, factorizations;
    char failure[160]; /* "" if all went well */
} bench_answer;

/* Number of equal steps of at most `setting` over `duration`. */
static inline long bench_steps(double duration, double setting)
{
    double count = ceil(duration / setting - 1e-6);
    return count < 1.0 ? 1 : (long)count;
}

static inline void bench_fail(bench_answer *answer, const char *reason)
{
    size_t k = 0;
    for (; reason[k] && k + 1 < sizeof answer->failure; ++k) {
        answer->failure[k] = reason[k] == '\n' ? ' ' : reason[k];
    }
    answer->failure[k] = '\0';
}

static inline void bench_see(bench_answer *answer, double drift, double gap)
{
    answer->drift = fabs(drift) > answer->drift ? fabs(drift) : answer->drift;
    answer->gap = gap > answer->gap ? gap : answer->gap;
}

typedef void (*bench_run)(const bench_request *request, bench_answer *answer);

/* kernel: the loop of every driver; returns main's result */
static inline int bench_serve(bench_run run)
{
    bench_request request;
    memset(&request, 0, sizeof request);
    while (scanf(" %c %d %46s %lf %lf %d %d", &request.kind, &request.n, request.method,
                 &request.setting, &request.duration, &request.samples, &request.repeats) == 7) {
        bench_answer best;
        memset(&best, 0, sizeof best);
        for (int repeat = 0; repeat < request.repeats; ++repeat) {
            bench_answer answer;
            memset(&answer, 0, sizeof answer);
            run(&request, &answer);
            if (repeat == 0 || answer.seconds < best.seconds || answer.failure[0]) {
                best = answer;
            }
            if (answer.failure[0]) {
                break;
            }
        }
        if (best.failure[0]) {
            printf("no %s\n", best.failure);
        } else {
            printf("ok %.9g %.17g %.17g %.17g %.9g %.9g %.0f %.0f %.0f %.0f\n", best.seconds,
                   best.tip[0], best.tip[1], best.tip[2], best.drift, best.gap, best.steps,
                   best.evaluations, best.iterations, best.factorizations);
        }
        fflush(stdout);
    }
    return 0;
}

#endif
