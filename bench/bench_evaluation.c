/* SPDX-License-Identifier: BSD-3-Clause */
/* What one acceleration costs inside an explicit method, by internal functions: a driver of the
 * bench as bench_serve.c is. METHOD: evaluation, evaluation/rp, evaluation/joint (a stage, from
 * coordinates); SECONDS is for EVALUATIONS of them. */
#define _POSIX_C_SOURCE 200809L
#include "driver.h"
#include "mechanisms.h"

#include "integrator/motion.h"
#include "system/system_internal.h"

#define ROUNDS 10

static void measure(const bench_request *request, se3di_equations *equations, bench_answer *answer)
{
    int evaluations = 20 + 20000 / request->n;
    se3di_kkt_settings settings = se3di_state_begin(equations, 1e-10, 1e-12);
    const se3di_motion *motion = se3di_motion_find(equations);
    static double y[20000], derivative[20000]; /* of bodies by the thousand at most */
    answer->seconds = 1e300;
    motion->get(equations, y);
    for (int round = 0; round < ROUNDS; ++round) {
        double begin = bench_clock();
        for (int k = 0; k < evaluations; ++k) {
            if (k % 12 == 0) { /* as in a step of dop853 */
                se3di_state_begin_step(equations, 0.0, 0);
            }
            if (equations->tree) {
                (void)motion->evaluate_at(equations, 0.0, y, derivative);
            } else {
                (void)se3di_state_evaluate(equations, 0.0);
            }
        }
        answer->seconds = fmin(answer->seconds, bench_clock() - begin);
    }
    answer->evaluations = evaluations;
    se3di_state_end(equations, &settings);
}

static void run(const bench_request *request, bench_answer *answer)
{
    bench_mechanism m = bench_build(request->kind, request->n);
    se3di_equations equations;
    const se3di_formulation *formulation =
        se3di_formulation_reduce(se3di_formulation_find(bench_formulation(request->method)));
    if (m.status < 0 ||
        se3di_equations_init(&equations, &m.system->model, formulation, 1, &m.system->error) < 0) {
        bench_fail(answer, se3d_system_get_error(m.system));
    } else {
        if (se3di_state_solve(&equations, 0.0) < 0) {
            bench_fail(answer, se3d_system_get_error(m.system));
        } else {
            measure(request, &equations, answer);
        }
        se3di_equations_destroy(&equations);
    }
    se3d_system_destroy(m.system);
}

int main(void)
{
    return bench_serve(run);
}
