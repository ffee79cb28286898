/* SPDX-License-Identifier: BSD-3-Clause */
/* The bench's driver of this library. METHOD: auto, dop853, rk45, rk4, generalized_alpha, hht, bdf,
 * radau, rattle, gauss, with /romega, /rp or /joint behind it for a formulation, else that of
 * `auto`; step_dop853, step_rk45 and step_rk4 make equal steps without error control, as the other
 * engines' RK4 does. */
#define _POSIX_C_SOURCE 200809L
#include "driver.h"
#include "mechanisms.h"

static int find_method(const char *text, se3d_solver_def *def)
{
    static const struct {
        const char *name;
        int32_t method;
        int32_t fixed; /* SETTING is the step */
    } methods[] = {
        {"dop853", SE3D_METHOD_DOP853, 0},  {"rk45", SE3D_METHOD_RK45, 0},
        {"gauss", SE3D_METHOD_GAUSS, 0},    {"auto", SE3D_METHOD_AUTO, 0},
        {"bdf", SE3D_METHOD_BDF, 0},        {"radau", SE3D_METHOD_RADAU, 0},
        {"rattle", SE3D_METHOD_RATTLE, 1},  {"generalized_alpha", SE3D_METHOD_GENERALIZED_ALPHA, 1},
        {"hht", SE3D_METHOD_HHT, 1},        {"step_dop853", SE3D_METHOD_DOP853, 1},
        {"rk4", SE3D_METHOD_RK4, 0},        {"step_rk4", SE3D_METHOD_RK4, 1},
        {"step_rk45", SE3D_METHOD_RK45, 1},
    };
    size_t length = strcspn(text, "/");
    def->formulation = bench_formulation(text);
    for (size_t k = 0; k < sizeof methods / sizeof methods[0]; ++k) {
        if (strlen(methods[k].name) == length && strncmp(text, methods[k].name, length) == 0) {
            def->method = methods[k].method;
            return methods[k].fixed;
        }
    }
    return -1;
}

static void look(const bench_mechanism *m, double start, bench_answer *answer)
{
    se3d_energy energy = {0};
    double gaps[3] = {0};
    (void)se3d_system_get_energy(m->system, &energy);
    (void)se3d_system_get_violation(m->system, gaps);
    (void)se3d_body_get_point(m->system, m->tip, m->point, answer->tip);
    bench_see(answer, energy.total - start, gaps[0]);
}

static void count(const se3d_solver *solver, const se3d_solver_stats *before, bench_answer *answer)
{
    se3d_solver_stats stats;
    (void)se3d_solver_get_stats(solver, &stats);
    answer->steps = (double)(stats.steps - before->steps);
    answer->evaluations = (double)(stats.evaluations - before->evaluations);
    answer->iterations = (double)(stats.iterations - before->iterations);
    answer->factorizations = (double)(stats.factorizations - before->factorizations);
}

static se3d_status advance(const bench_request *request, se3d_solver *solver, int part)
{
    if (strncmp(request->method, "step_", 5) != 0) {
        return se3d_solver_run(solver, request->duration * part / request->samples);
    }
    long steps = bench_steps(request->duration, request->setting);
    long end = steps * part / request->samples;
    se3d_status status = SE3D_OK;
    for (long k = steps * (part - 1) / request->samples; k < end && status >= 0; ++k) {
        status = se3d_solver_step(solver, request->duration / (double)steps);
    }
    return status;
}

static void run_solver(const bench_request *request, const bench_mechanism *m, se3d_solver *solver,
                       bench_answer *answer)
{
    se3d_energy start = {0};
    se3d_solver_stats before = {0};
    se3d_status status = se3d_solver_run(solver, 0.0); /* consistent; the structure is built */
    (void)se3d_system_get_energy(m->system, &start);
    (void)se3d_solver_get_stats(solver, &before);
    for (int k = 1; k <= request->samples && status >= 0; ++k) {
        double begin = bench_clock();
        status = advance(request, solver, k);
        answer->seconds += bench_clock() - begin;
        look(m, start.total, answer);
    }
    count(solver, &before, answer);
    if (status < 0) {
        bench_fail(answer, se3d_system_get_error(m->system));
    }
}

static void run(const bench_request *request, bench_answer *answer)
{
    bench_mechanism m = bench_build(request->kind, request->n);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    if (m.status < 0) {
        bench_fail(answer, se3d_system_get_error(m.system));
    } else {
        int fixed = find_method(request->method, &def);
        def.step = fixed == 1 ? request->setting : 0.0;
        def.tolerance = fixed == 1 ? 0.0 : request->setting;
        if (fixed < 0 || SE3D_FAILED(se3d_solver_create(m.system, &def, &solver))) {
            bench_fail(answer, fixed < 0 ? "unknown method" : se3d_system_get_error(m.system));
        } else {
            run_solver(request, &m, solver, answer);
        }
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(m.system);
}

int main(void)
{
    return bench_serve(run);
}
