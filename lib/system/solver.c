/* SPDX-License-Identifier: BSD-3-Clause */
/* Solvers: validation and delegation to a run. */
#include "system/solver.h"

#include "analysis/follow.h"
#include "particles/sets.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define STEP_MIN      1e-15 /* s; its square still divides */
#define TOLERANCE_MIN 1e-14 /* what doubles can hold */
#define TOLERANCE_MAX 0.1
#define STEPS_MAX     1e9 /* of one run */

void se3d_solver_def_init(se3d_solver_def *def, size_t size)
{
    se3d_solver_def defaults = {
        .struct_size = size,
        .analysis = SE3D_ANALYSIS_DYNAMICS,
        .formulation = SE3D_FORMULATION_AUTO,
        .spectral_radius = 0.9,
        .alpha = -0.1,
    };
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_numbers(se3d_system *system, const se3d_solver_def *def)
{
    if (!(def->step == 0.0 || (def->step >= STEP_MIN && isfinite(def->step)))) {
        return SE3DI_FAIL_OF(system, "step", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be finite and at least %g (0: chosen)", def->step,
                             STEP_MIN);
    }
    if (!(def->tolerance == 0.0 ||
          (def->tolerance >= TOLERANCE_MIN && def->tolerance <= TOLERANCE_MAX))) {
        return SE3DI_FAIL_OF(system, "tolerance", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be from %g to %g (0: 1e-6)", def->tolerance,
                             TOLERANCE_MIN, TOLERANCE_MAX);
    }
    if (!(def->spectral_radius >= 0.0 && def->spectral_radius <= 1.0)) {
        return SE3DI_FAIL_OF(system, "spectral_radius", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be from 0 to 1", def->spectral_radius);
    }
    if (!(def->alpha >= -1.0 / 3.0 && def->alpha <= 0.0)) {
        return SE3DI_FAIL_OF(system, "alpha", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be from -1/3 to 0", def->alpha);
    }
    if (!isfinite(def->horizon)) {
        return SE3DI_FAIL_OF(system, "horizon", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be finite", def->horizon);
    }
    if (def->iterations_max > 1000000) {
        return SE3DI_FAIL_OF(system, "iterations_max", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be from 1 to 1000000 (0: 25)", def->iterations_max);
    }
    return SE3D_OK;
}

const char *se3d_method_get_name(int32_t method)
{
    const se3di_integrator *found = se3di_integrator_find(method);
    return method == SE3D_METHOD_AUTO ? "auto" : found ? found->name : "";
}

const char *se3d_analysis_get_name(int32_t analysis)
{
    return se3di_analysis_get_name(analysis);
}

const char *se3d_formulation_get_name(int32_t formulation)
{
    const se3di_formulation *found = se3di_formulation_find(formulation);
    return formulation == SE3D_FORMULATION_AUTO ? "auto" : found ? found->name : "";
}

/* The order must be one that the method has. */
static se3d_status check_order(se3d_system *system, const se3d_solver_def *def)
{
    const se3di_integrator *method = se3di_integrator_find(def->method);
    const uint32_t orders = def->method == SE3D_METHOD_AUTO ? 0 : method->orders;
    char list[64] = "";
    size_t used = 0;
    if (def->order == 0 || (def->order > 0 && def->order < 32 && orders >> def->order & 1u)) {
        return SE3D_OK;
    }
    for (int k = 1; k < 32; ++k) {
        if (orders >> k & 1u) {
            used += (size_t)snprintf(list + used, sizeof list - used, ", %d", k);
        }
    }
    return SE3DI_FAIL_OF(system, "order", SE3D_ERR_INVALID_ARGUMENT,
                         " = %d, must be 0%s with method %s", (int)def->order, list,
                         se3d_method_get_name(def->method));
}

static se3d_status check_choices(se3d_system *system, const se3d_solver_def *def)
{
    if (!*se3di_analysis_get_name(def->analysis)) {
        return SE3DI_FAIL_OF(system, "analysis", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be one of se3d_analysis", (int)def->analysis);
    }
    if (!*se3d_formulation_get_name(def->formulation)) {
        return SE3DI_FAIL_OF(system, "formulation", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be SE3D_FORMULATION_ROMEGA, _RP, _JOINT or _AUTO",
                             (int)def->formulation);
    }
    if (!se3di_integrator_find(def->method)) {
        return SE3DI_FAIL_OF(system, "method", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be one of se3d_method", (int)def->method);
    }
    return check_order(system, def);
}

static void configure(se3di_run *run, const se3d_solver_def *def)
{
    run->analysis = def->analysis;
    run->picks_formulation = def->formulation == SE3D_FORMULATION_AUTO;
    run->formulation =
        run->picks_formulation || def->analysis == SE3D_ANALYSIS_EQUILIBRIUM /* no velocities */
            ? &se3di_formulation_romega
            : se3di_formulation_find(def->formulation);
    run->automatic = def->method == SE3D_METHOD_AUTO;
    run->has_tolerance = def->tolerance > 0.0;
    run->guard = (se3di_guard){.interrupt = def->interrupt,
                               .ctx = def->interrupt_ctx,
                               .most = def->steps_max > 0 ? (double)def->steps_max : STEPS_MAX};
    run->horizon = fabs(def->horizon) > 0.0 ? def->horizon : -HUGE_VAL;
    run->integration.method = se3di_integrator_find(def->method);
    run->integration.settings = (se3di_integrator_settings){
        .step = def->step,
        .tolerance = def->tolerance > 0.0 ? def->tolerance : 1e-6,
        .spectral_radius = def->spectral_radius,
        .alpha = def->alpha,
        .iterations_max = def->iterations_max > 0 ? (int32_t)def->iterations_max : 25,
        .order = def->order,
        .sleeps = def->sleep != 0,
        .controls_error = def->tolerance > 0.0,
    };
}

se3d_status se3d_solver_create(se3d_system *system, const se3d_solver_def *def, se3d_solver **out)
{
    if (out) {
        *out = NULL;
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "out", out));
    se3d_solver_def full = se3d_solver_def_default();
    SE3DI_TRY(se3di_check_def(system, "solver def", def, &full, sizeof full));
    SE3DI_TRY(check_numbers(system, &full));
    SE3DI_TRY(check_choices(system, &full));
    se3d_solver *solver = se3di_alloc(&system->model.allocator, 1, sizeof *solver);
    if (!solver) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a solver");
    }
    solver->system = system;
    solver->allocator = system->model.allocator;
    solver->next = system->solvers;
    system->solvers = solver;
    se3di_run_init(&solver->run, &system->model, &system->found, system);
    configure(&solver->run, &full);
    *out = solver;
    return SE3D_OK;
}

void se3d_solver_destroy(se3d_solver *solver)
{
    if (!solver || (solver->system && se3di_enter(solver->system, SE3DI_BUSY_FREE, __func__) < 0)) {
        return;
    }
    if (solver->system) {
        se3d_solver **link = &solver->system->solvers;
        while (*link != solver) {
            link = &(*link)->next;
        }
        *link = solver->next;
        se3di_run_destroy(&solver->run);
    }
    const se3d_allocator allocator = solver->allocator;
    se3di_free(&allocator, solver, 1, sizeof *solver);
}

void se3di_solvers_orphan(se3d_system *system)
{
    for (se3d_solver *solver = system->solvers; solver; solver = solver->next) {
        se3di_run_destroy(&solver->run);
        solver->system = NULL;
    }
    system->solvers = NULL;
}

se3d_status se3d_solver_set_shown(se3d_solver *solver, int32_t shown)
{
    SE3DI_EDIT_OF(solver);
    if (shown != SE3D_SHOWN_ALL && shown != SE3D_SHOWN_MOTION) {
        return SE3DI_FAIL_OF(solver->system, "shown", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be SE3D_SHOWN_ALL or SE3D_SHOWN_MOTION", (int)shown);
    }
    solver->run.shows_motion = shown == SE3D_SHOWN_MOTION;
    return SE3D_OK;
}

se3d_status se3d_solver_follow(se3d_solver *solver, se3d_solver *from)
{
    SE3DI_EDIT_OF(solver);
    SE3DI_EDIT_OF(from);
    if (solver->system == from->system) {
        return SE3DI_FAIL_OF(solver->system, "from", SE3D_ERR_INVALID_ARGUMENT,
                             " is a solver of the same system, must be of another one");
    }
    se3di_work_begin(solver->system);
    return se3di_work_end(solver->system, se3di_run_follow(&solver->run, &from->run));
}

/* What failed for one process of several that share particles has failed for all. */
static se3d_status share(se3d_system *system, se3d_status status)
{
    return se3di_sets_conclude(&system->model, status, &system->found);
}

se3d_status se3d_solver_run(se3d_solver *solver, double t_end)
{
    SE3DI_EDIT_OF(solver);
    se3d_system *system = solver->system;
    if (!isfinite(t_end) ||
        (t_end < system->model.time && !se3di_run_is_now(&solver->run, t_end))) {
        return SE3DI_FAIL_OF(system, "t_end", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be finite and not before the present time %g s", t_end,
                             system->model.time);
    }
    const double most = solver->run.guard.most;
    const double step = solver->run.integration.settings.step; /* 0: none was asked for */
    const double steps = step > 0.0 ? (t_end - system->model.time) / step : 0.0;
    if (isfinite(steps) && steps > most) {
        return SE3DI_FAIL_OF(system, "t_end", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s takes %g steps of %g s, must take at most %g", t_end, steps,
                             step, most);
    }
    se3di_work_begin(system);
    return se3di_work_end(system, share(system, se3di_run_to(&solver->run, t_end)));
}

se3d_status se3d_solver_step(se3d_solver *solver, double h)
{
    SE3DI_EDIT_PAST_OF(solver);
    const double now = solver->system->model.time;
    const double next = nextafter(now, HUGE_VAL) - now; /* exact, however the host rounds */
    if (!(isfinite(h) && h >= STEP_MIN && h >= next)) {
        return SE3DI_FAIL_OF(solver->system, "h", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be finite, at least %g and large enough to move the "
                             "time %.17g s on",
                             h, STEP_MIN, now);
    }
    se3di_work_begin(solver->system);
    return se3di_work_end(solver->system, share(solver->system, se3di_run_step(&solver->run, h)));
}

se3d_status se3d_solver_get_stats_sized(const se3d_solver *solver, se3d_solver_stats *stats,
                                        size_t size)
{
    if (!solver || !stats) {
        return SE3D_ERR_NULL;
    }
    const se3di_counters *counters = &solver->run.equations.counters;
    const se3d_solver_stats full = {
        .steps = counters->steps,
        .rejected = counters->rejected,
        .iterations = counters->iterations,
        .evaluations = counters->evaluations,
        .factorizations = counters->factorizations,
        .solves = counters->solves,
    };
    return se3di_sized_give(stats, size, &full, sizeof full);
}

se3d_status se3d_solver_get_start_change_sized(const se3d_solver *solver, se3d_start_change *change,
                                               size_t size)
{
    if (!solver || !change) {
        return SE3D_ERR_NULL;
    }
    const se3di_start_change *start = &solver->run.start;
    const se3d_start_change full = {
        .time = start->time,
        .position = start->position,
        .rotation = start->rotation,
        .velocity = start->velocity,
        .angular_velocity = start->angular_velocity,
        .most_position = start->most_position[0],
        .most_rotation = start->most_position[1],
        .most_velocity = start->most_velocity[0],
        .most_angular_velocity = start->most_velocity[1],
        .moved = {start->moved.index1, start->moved.generation},
        .deflected = {start->deflected.index1, start->deflected.generation},
    };
    return se3di_sized_give(change, size, &full, sizeof full);
}

se3d_status se3d_solver_get_tolerance(const se3d_solver *solver, double *tolerance)
{
    if (!solver || !tolerance) {
        return SE3D_ERR_NULL;
    }
    const se3di_integration *integration = &solver->run.integration;
    *tolerance = solver->system && solver->run.analysis == SE3D_ANALYSIS_DYNAMICS
                     ? se3di_integration_get_tolerance(integration, &solver->system->model)
                     : 0.0;
    return SE3D_OK;
}

se3d_status se3d_solver_get_step(const se3d_solver *solver, double *step)
{
    if (!solver || !step) {
        return SE3D_ERR_NULL;
    }
    *step = solver->system && solver->run.analysis == SE3D_ANALYSIS_DYNAMICS
                ? se3di_equal_steps_get(&solver->run.integration, &solver->system->model)
                : 0.0;
    return SE3D_OK;
}

se3d_status se3d_solver_get_method(const se3d_solver *solver, const char **name)
{
    if (!solver || !name) {
        return SE3D_ERR_NULL;
    }
    *name = solver->run.integration.method->name;
    return SE3D_OK;
}

se3d_status se3d_solver_get_formulation(const se3d_solver *solver, const char **name)
{
    if (!solver || !name) {
        return SE3D_ERR_NULL;
    }
    *name = solver->run.formulation->name;
    return SE3D_OK;
}

se3d_status se3d_solver_get_switch(const se3d_solver *solver, double *time, const char **left)
{
    if (!solver || !time || !left) {
        return SE3D_ERR_NULL;
    }
    const se3di_run *run = &solver->run;
    *time = run->left ? run->left_at : (double)NAN;
    *left = run->left ? run->left->name : "";
    return SE3D_OK;
}

se3d_status se3d_solver_get_foresight(const se3d_solver *solver, int32_t *foresees)
{
    if (!solver || !foresees) {
        return SE3D_ERR_NULL;
    }
    *foresees = solver->run.integration.foresees;
    return SE3D_OK;
}
