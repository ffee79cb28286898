/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run needs before its first step: equations, work, a method; made anew if the structure
 * changed. */
#include "analysis/run_prepare.h"
#include "analysis/run.h"

#include "analysis/breaks.h"
#include "analysis/crowd.h"
#include "analysis/kinds.h"
#include "analysis/stiffness.h"
#include "contact/bodies/crowd.h"
#include "force/driver_rate.h"
#include "integrator/convex.h"
#include "integrator/gauss_lanes.h"
#include "nonlinear/against.h"
#include "primitive/user.h"

#include <math.h>
#include <string.h>

void se3di_run_init(se3di_run *run, se3di_model *model, se3di_error *error, se3d_system *system)
{
    run->model = model;
    run->error = error;
    run->prepared = 0;
    run->determined = 0;
    run->watch = (se3di_watch){&run->events, se3di_events_begin_step, se3di_events_end_step};
    se3di_events_init(&run->events, run, system, (uint32_t)model->body_slots.salt);
}

static void release(se3di_run *run)
{
    se3di_free(&run->model->allocator, run->integration.work, run->work_count, sizeof(double));
    run->integration.work = NULL;
    run->work_count = 0;
    se3di_newton_destroy(&run->integration.newton);
    se3di_convex_destroy(run->integration.convex, &run->model->allocator);
    run->integration.convex = NULL;
    if (run->prepared) {
        se3di_counters counters = run->equations.counters;
        se3di_equations_destroy(&run->equations);
        run->equations.counters = counters;
    }
    run->prepared = run->in_lanes = 0;
}

void se3di_run_destroy(se3di_run *run)
{
    release(run);
    se3di_events_destroy(&run->events);
    se3di_saved_destroy(&run->before, &run->model->allocator);
    se3di_saved_destroy(&run->integration.before_trials, &run->model->allocator);
    se3di_free(&run->model->allocator, run->steps.ends, run->steps.capacity, sizeof(double));
}

/* Steps and failures allocate nothing. */
static se3d_status reserve_kept(se3di_run *run, size_t history)
{
    const se3d_allocator *allocator = &run->model->allocator;
    const size_t memories = SE3DI_FORCE_STATES * run->model->force_slots.count;
    se3di_saved_array *const arrays[] = {&run->before.history, &run->equations.kept.history,
                                         &run->equations.kept.memory};
    for (int k = 0; k < 3; ++k) {
        se3di_saved_array *array = arrays[k];
        SE3DI_TRY(se3di_array_reserve(allocator, &array->data, &array->capacity,
                                      k < 2 ? history : memories, sizeof(double)));
    }
    return SE3D_OK;
}

/* Which rows are left out, and with them the state of explicit methods, is decided later. */
static size_t largest_history(const se3di_run *run)
{
    se3di_assembly of_bodies = run->equations.assembly;
    of_bodies.tree_count = 0;
    return run->integration.method->history_count(&of_bodies);
}

void se3di_run_use_method(se3di_run *run, const se3di_integrator *method)
{
    run->integration.method = method;
    run->integration.settings.leaves_stiff = method->leaves_stiff || method->takes_stiff;
}

/* Below, accelerations of loops come from the equations of the bodies (lib/integrator/state.c). */
#define TOLERANCE_OF_LOOPS 2.3e-10

static int are_loops_loose(const se3di_run *run)
{
    return !(run->integration.settings.tolerance < TOLERANCE_OF_LOOPS);
}

/* With these equations; dop853, for single steps, needs no more memory. Loops at the tightest
 * tolerances are left to the equations of the bodies. */
static int are_in_lanes(const se3di_run *run)
{
    return run->formulation == &se3di_formulation_joint &&
           se3di_gauss_lanes_suit_equations(&run->equations) &&
           (!run->equations.has_loops || are_loops_loose(run));
}

/* auto takes gauss for the sake of lanes: without them dop853 goes on with the same equations. */
static se3d_status keep_lanes(se3di_run *run)
{
    if (!run->automatic || !run->integration.method->takes_lanes) {
        return SE3D_OK;
    }
    if (are_loops_loose(run)) {
        SE3DI_TRY(se3di_equations_take_lanes(&run->equations));
    }
    run->in_lanes = are_in_lanes(run);
    if (!run->in_lanes) {
        se3di_run_use_method(run, &se3di_integrator_dop853);
    }
    return SE3D_OK;
}

static se3d_status allocate_work(se3di_run *run)
{
    se3di_model *model = run->model;
    if (run->analysis != SE3D_ANALYSIS_DYNAMICS) {
        return SE3D_OK;
    }
    SE3DI_TRY(keep_lanes(run));
    const se3di_integrator *method = run->integration.method;
    const size_t count = largest_history(run);
    void *history = model->history;
    se3d_status status = se3di_array_reserve(&model->allocator, &history, &model->history_capacity,
                                             count, sizeof(double));
    model->history = history;
    SE3DI_TRY(status);
    SE3DI_TRY(reserve_kept(run, count));
    SE3DI_TRY(method->takes_lanes ? se3di_equations_take_lanes(&run->equations) : SE3D_OK);
    run->work_count = method->work_count(&run->equations.assembly);
    run->integration.work = se3di_alloc(&model->allocator, run->work_count, sizeof(double));
    if (!run->integration.work) {
        return SE3D_ERR_NO_MEMORY;
    }
    return method->is_implicit ? se3di_newton_init(&run->integration.newton, &run->equations)
                               : SE3D_OK;
}

/* A step of given length has no tolerance, to which iterations would end. */
void se3di_run_choose_for_call(se3di_run *run, int is_step)
{
    const se3di_integrator *method = is_step ? &se3di_integrator_dop853 : &se3di_integrator_gauss;
    if (run->in_lanes && run->integration.method != method) {
        se3di_run_use_method(run, method);
    }
}

#define STEP_CROWD 5e-3 /* s: a longest step for other methods would be too long for convex */
#define STEP_SLOW  1e-3 /* s: a shorter one is what makes steps short; the one that convex takes */

/* No tolerance is asked for, and bodies may touch that convex would step: SE3DI_CROWD_ */
static int32_t may_crowd(const se3di_run *run)
{
    const se3di_model *model = run->model;
    if (!run->automatic || run->analysis != SE3D_ANALYSIS_DYNAMICS || run->has_tolerance ||
        !(run->integration.settings.step <= STEP_CROWD) || !se3di_crowd_may_touch(model) ||
        !(se3di_crowd_has(model, SE3DI_CROWD_HELD) || se3di_crowd_has_mesh(model))) {
        return SE3DI_CROWD_NONE;
    }
    const double step = run->integration.settings.step;
    const int is_short = step > 0.0 && step < STEP_SLOW;
    if (se3di_crowd_has(model, SE3DI_CROWD) && se3di_crowd_suits(model)) {
        return is_short ? SE3DI_CROWD_DENSE : SE3DI_CROWD_NEAR;
    }
    if (is_short) {
        return SE3DI_CROWD_NONE;
    }
    return se3di_crowd_has_mesh(model) ? SE3DI_CROWD_ROUGH : SE3DI_CROWD_SLOW;
}

/* Contacts have held steps of the method under way short, and nothing else needs them so short. */
static int is_slow(const se3di_run *run, const se3di_integrator *past)
{
    return past && past->leaves_crowd && past->leaves_crowd(run->model) &&
           se3di_crowd_bears(run->model, fmax(run->integration.settings.step, STEP_SLOW));
}

int se3di_run_is_crowded(const se3di_run *run)
{
    const se3di_model *model = run->model;
    const se3di_integrator *past = se3di_integrator_of_history(model->history_tag);
    const int32_t crowd = may_crowd(run);
    if (crowd == SE3DI_CROWD_NONE || (past && past->takes_crowd)) {
        return crowd != SE3DI_CROWD_NONE;
    }
    const int may_be_dense = crowd == SE3DI_CROWD_NEAR || crowd == SE3DI_CROWD_DENSE;
    return (may_be_dense && se3di_bodies_crowd(model)) ||
           (crowd != SE3DI_CROWD_DENSE && is_slow(run, past));
}

/* A function of time or the user's code is among the rows. */
static int is_given(const se3di_model *model)
{
    int given = 0;
    for (size_t k = 0; !given && k < model->row_count; ++k) {
        given = model->rows[k].function >= 0 && !(model->rows[k].left_out & SE3DI_ROW_BROKEN);
    }
    for (size_t k = 0; !given && k < model->constraint_slots.count; ++k) {
        given = se3di_is_user(&model->constraints[k]);
    }
    return given;
}

/* auto: stages in lanes are faster where nothing acts that does not go into them. */
static int may_take_lanes(const se3di_run *run)
{
    const se3di_model *model = run->model;
    const int is_joint = run->picks_formulation || run->formulation == &se3di_formulation_joint;
    return run->analysis == SE3D_ANALYSIS_DYNAMICS && is_joint &&
           model->constraint_slots.count > 0 && se3di_gauss_lanes_suit_model(model) &&
           !is_given(model);
}

const se3di_integrator *se3di_run_find_explicit(const se3di_run *run)
{
    return may_take_lanes(run) ? &se3di_integrator_gauss : &se3di_integrator_dop853;
}

/* auto: particles move by verlet only, heaps by convex; strong dampers hold explicit methods to
 * small steps, or have done so before. A motion under way stays with radau, or without it: the
 * state would now decide otherwise. */
static se3d_status choose_method(se3di_run *run)
{
    const se3di_model *model = run->model;
    if (!run->automatic) {
        return SE3D_OK;
    }
    const se3di_integrator *past = se3di_integrator_of_history(model->history_tag);
    int stiff = run->analysis == SE3D_ANALYSIS_DYNAMICS && past && past->takes_stiff;
    if (run->analysis == SE3D_ANALYSIS_DYNAMICS && !stiff && !(past && past->leaves_stiff)) {
        SE3DI_TRY(se3di_stiffness_is_stiff(run->model, run->error, &stiff));
    }
    const se3di_integrator *method = stiff ? &se3di_integrator_radau : se3di_run_find_explicit(run);
    if (model->sets) {
        method = &se3di_integrator_verlet;
    } else if (se3di_run_is_crowded(run)) {
        method = &se3di_integrator_convex;
    }
    se3di_run_use_method(run, method);
    return SE3D_OK;
}

int se3di_run_is_driven(const se3di_run *run)
{
    return se3di_analysis_is(run->analysis, SE3DI_ANALYSIS_IS_DRIVEN);
}

static se3d_status build_equations(se3di_run *run)
{
    const se3di_integrator *method = run->integration.method;
    const int reduces =
        run->analysis == SE3D_ANALYSIS_DYNAMICS && (method->is_explicit || method->is_reduced);
    const se3di_formulation *formulation =
        reduces ? se3di_formulation_reduce(run->formulation) : run->formulation;
    return se3di_equations_init(&run->equations, run->model, formulation,
                                run->analysis == SE3D_ANALYSIS_DYNAMICS, run->error);
}

static int takes_loops(const se3di_run *run)
{
    return (run->integration.method->takes_lanes && !run->automatic) || are_loops_loose(run);
}

/* If loops cannot be computed in lanes, gauss passes singular positions in fewer steps, and more
 * exactly, by the bodies. What changes without a rebuild has no say: a run that began before the
 * change and one that is prepared after it go on alike. auto takes dop853 for them. */
static se3d_status leave_slow_loops(se3di_run *run, int *picked)
{
    se3di_equations *equations = &run->equations;
    if (!*picked || !equations->has_loops || !run->integration.method->takes_lanes ||
        run->automatic) {
        return SE3D_OK;
    }
    const se3d_status status = se3di_equations_take_lanes(equations);
    if (status < 0 || !se3di_gauss_lanes_suit_loops(equations)) {
        se3di_equations_destroy(equations);
        *picked = 0;
    }
    return status < 0 ? se3di_error_set(run->error, status, "no memory for loops in lanes")
                      : status;
}

/* The formulation of `auto`. *picked: the equations are built, in joint coordinates. */
static se3d_status try_joints(se3di_run *run, int *picked)
{
    se3di_model *model = run->model;
    *picked = 0;
    run->formulation = &se3di_formulation_romega;
    if (run->analysis != SE3D_ANALYSIS_DYNAMICS || !run->integration.method->is_explicit ||
        model->constraint_slots.count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(
        se3di_equations_try_joints(&run->equations, model, takes_loops(run), run->error, picked));
    SE3DI_TRY(leave_slow_loops(run, picked));
    if (*picked) {
        run->formulation = &se3di_formulation_joint;
    }
    return SE3D_OK;
}

/* Methods that take bodies one by one. */
static se3d_status check_armatures(se3di_run *run)
{
    const se3di_assembly *assembly = &run->equations.assembly;
    const se3di_integrator *method = run->integration.method;
    if (run->analysis != SE3D_ANALYSIS_DYNAMICS || !method->weighs_bodies ||
        assembly->armature_count == 0) {
        return SE3D_OK;
    }
    const char *name = run->model->forces[assembly->armature[0].force].name;
    release(run);
    return se3di_error_set(run->error, SE3D_ERR_UNSUPPORTED,
                           "method %s takes no armatures ('%.64s'): they couple the bodies of a "
                           "joint in the mass matrix",
                           method->name, name ? name : "");
}

/* Drivers whose rates follow signals leave nothing to be solved for where there are only positions,
 * and methods that make steps of positions first do not see them. */
static se3d_status check_rates(se3di_run *run)
{
    const se3di_integrator *method = run->integration.method;
    const uint32_t driver = se3di_find_driver_rate(run->model);
    const int is_of_positions =
        run->analysis != SE3D_ANALYSIS_DYNAMICS && run->analysis != SE3D_ANALYSIS_ASSEMBLY;
    if (driver == SE3DI_NO_INDEX ||
        (!is_of_positions && (run->analysis != SE3D_ANALYSIS_DYNAMICS || !method->moves_first))) {
        return SE3D_OK;
    }
    const char *name = run->model->constraints[driver].name;
    release(run);
    return se3di_error_set(
        run->error, SE3D_ERR_UNSUPPORTED,
        "the rate of driver '%.64s' follows signals, which its coordinate is the integral of: "
        "%s %s does not take it, dynamics by other methods does",
        name ? name : "", is_of_positions ? "the analysis" : "method",
        is_of_positions ? se3di_analysis_get_name(run->analysis) : method->name);
}

se3d_status se3di_run_build(se3di_run *run)
{
    release(run);
    se3di_counters counters = run->equations.counters;
    const se3di_integrator *method = run->integration.method;
    int picked = 0;
    SE3DI_TRY(run->picks_formulation ? try_joints(run, &picked) : SE3D_OK);
    SE3DI_TRY(picked ? SE3D_OK : build_equations(run));
    run->equations.counters = counters;
    run->equations.friction.is_rigid =
        run->analysis == SE3D_ANALYSIS_DYNAMICS && method->is_explicit;
    run->equations.audits = run->analysis == SE3D_ANALYSIS_INVERSE_DYNAMICS;
    run->equations.iterations_max = run->integration.settings.iterations_max;
    run->integration.equations = &run->equations;
    run->prepared = 1;
    SE3DI_TRY(check_armatures(run));
    SE3DI_TRY(check_rates(run));
    run->told_redundant = run->told_left_out = 0;
    run->determined = 0;
    run->driven_twice = se3di_against_can_be(run->model);
    run->values_version = run->model->values_version;
    if (se3di_run_is_driven(run)) {
        se3di_assembly_level(&run->equations.assembly);
        run->equations.is_suited = 0; /* the solver is told of it */
    }
    se3di_assembly_eval_mass(&run->equations.assembly); /* steps may rely on constant blocks */
    se3d_status status = allocate_work(run);
    if (status < 0) {
        release(run);
        return se3di_error_set(run->error, status, "no memory for the integrator");
    }
    return SE3D_OK;
}

/* From the present state. */
static se3d_status enter_crowd(se3di_run *run)
{
    const se3di_integrator *past = se3di_integrator_of_history(run->model->history_tag);
    if (past && past->leaves_crowd) {
        run->left = run->integration.method;
        run->left_at = run->model->time;
    }
    se3di_run_use_method(run, &se3di_integrator_convex);
    return se3di_run_build(run);
}

static se3d_status build_anew(se3di_run *run)
{
    SE3DI_TRY(choose_method(run));
    SE3DI_TRY(se3di_run_build(run));
    run->gravity_varies = se3di_model_gravity_varies(run->model);
    return SE3D_OK;
}

/* auto: gravity, which functions of time come to and go from without a change of the structure, is
 * still what the method was chosen by. */
static int is_chosen(const se3di_run *run)
{
    return !run->automatic || run->gravity_varies == se3di_model_gravity_varies(run->model);
}

se3d_status se3di_run_prepare(se3di_run *run)
{
    SE3DI_TRY(se3di_breaks_check(run));
    if (!run->prepared || !se3di_assembly_fits(&run->equations.assembly) || !is_chosen(run)) {
        SE3DI_TRY(build_anew(run));
    } else if (run->integration.settings.leaves_crowd && se3di_run_is_crowded(run)) {
        SE3DI_TRY(enter_crowd(run));
    }
    run->integration.settings.leaves_crowd =
        run->integration.method->leaves_crowd ? may_crowd(run) : SE3DI_CROWD_NONE;
    se3di_equations_suit_masses(&run->equations); /* which may be others than at the last call */
    if (run->values_version != run->model->values_version) {
        se3di_assembly_take_values(&run->equations.assembly);
        run->values_version = run->model->values_version;
    }
    run->equations.guard = &run->guard;
    if (se3di_events_prepare(&run->events) < 0) {
        return se3di_error_set(run->error, SE3D_ERR_NO_MEMORY, "no memory for events");
    }
    run->equations.watch = se3di_events_count(&run->events) > 0 ? &run->watch : NULL;
    return SE3D_OK;
}

se3d_status se3di_run_take_method(se3di_run *run, const se3di_integrator *method)
{
    if (!run->automatic || method == run->integration.method) {
        return SE3D_OK;
    }
    const int is_of_lanes = method == &se3di_integrator_dop853 || method == &se3di_integrator_gauss;
    if (!is_of_lanes || !run->in_lanes) {
        se3di_run_use_method(run, is_of_lanes ? se3di_run_find_explicit(run) : method);
        SE3DI_TRY(se3di_run_build(run));
    }
    if (run->in_lanes) {
        se3di_run_use_method(run, method);
    }
    return SE3D_OK;
}
