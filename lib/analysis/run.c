/* SPDX-License-Identifier: BSD-3-Clause */
/* Preparation and control of a run. */
#include "analysis/run.h"
#include "analysis/run_end.h"
#include "analysis/run_prepare.h"

#include "analysis/dead_point.h"
#include "analysis/equilibrium.h"
#include "analysis/friction_start.h"
#include "analysis/start_moved.h"
#include "analysis/stiffness.h"
#include "assembly/energy.h"
#include "assembly/user.h"
#include "base/log.h"
#include "base/pending.h"
#include "contact/bodies/crowd.h"
#include "contact/bodies/pace.h"
#include "integrator/explicit_step.h"
#include "integrator/kink_step.h"
#include "integrator/motion.h"
#include "integrator/step_list.h"
#include "integrator/turns.h"
#include "math/steps.h"
#include "model/integral.h"
#include "nonlinear/against.h"
#include "nonlinear/jump.h"
#include "nonlinear/kink.h"
#include "nonlinear/ranks.h"
#include "particles/sets.h"
#include "primitive/turn_counter.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define STEP_DEFAULT 1e-3 /* s, of fixed-step methods */
#define TURN_MAX     3.0  /* rad, of a body in a step of an implicit method */

/* Contacts are taken up as they are. */
static se3d_status start_contacts(const se3di_run *run, double t)
{
    se3di_model *model = run->model;
    se3di_contacts_begin(model, 0.0, 1.0, 0);
    SE3DI_TRY(run->analysis == SE3D_ANALYSIS_ASSEMBLY
                  ? se3di_contacts_prepare_any(model, t, run->error)
                  : se3di_contacts_prepare(model, t, run->error));
    se3di_contacts_accept(model);
    return SE3D_OK;
}

/* Accelerations and multipliers at the present state. */
static se3d_status accelerate(se3di_run *run)
{
    const se3di_integrator *method = run->integration.method;
    return run->analysis == SE3D_ANALYSIS_DYNAMICS && method->accelerate
               ? method->accelerate(&run->integration)
               : se3di_acceleration_solve(&run->equations, run->model->time);
}

/* What the user gave against what it has become. */
static void note_start(se3di_run *run, double t)
{
    const int free = run->analysis == SE3D_ANALYSIS_DYNAMICS;
    se3di_start_change_measure(run->model, run->equations.accepted, se3di_run_is_driven(run),
                               &run->start);
    run->start.time = t;
    char far[400];
    if (run->start.moved.index1 != 0 &&
        se3di_start_moved_describe(run->model, run->equations.accepted, far, sizeof far)) {
        se3di_log_write(run->error, SE3D_LOG_WARNING, SE3D_LOG_MOVED, "t = %g s: %s", t, far);
    } else {
        se3di_start_change_log(run->model, &run->start, free ? SE3D_LOG_WARNING : SE3D_LOG_INFO,
                               run->error);
    }
}

/* The state is consistent already, with its accelerations and multipliers, on an open tree on which
 * nothing but plain forces acts: nobody has moved, or changed or broken anything since one was
 * settled. What belongs to the model alone decides, so that any solver goes on alike. */
static int is_settled(const se3di_run *run, double t)
{
    const se3di_equations *equations = &run->equations;
    const se3di_model *model = run->model;
    return model->settled == SE3DI_SETTLED && model->history_tag == 0 &&
           (model->ranks_known || model->row_count == 0) && !(model->time < t) &&
           !(model->time > t) && run->analysis == SE3D_ANALYSIS_DYNAMICS &&
           se3di_motion_find(equations)->are_all_plain(equations);
}

/* A new state: positions, velocities, accelerations and multipliers made consistent at the model's
 * time. */
static se3d_status settle(se3di_run *run, double t)
{
    se3di_equations *equations = &run->equations;
    const int is_there = is_settled(run, t);
    se3di_state_accept(equations);
    equations->hold = run->analysis == SE3D_ANALYSIS_ASSEMBLY;
    equations->unfolds = 1;
    se3d_status status = se3di_ranks_decide(equations, t);
    if (status >= 0 && se3di_run_is_driven(run) &&
        !run->determined) { /* before levels that may have no solution there */
        status = se3di_position_solve(equations, t);
        status = status < 0 ? status : se3di_equations_check_determined(equations);
        run->determined = status >= 0;
    }
    if (status >= 0) {
        status = is_there ? se3di_assembly_eval_wrenches(&equations->assembly, t, equations->error)
                          : se3di_state_solve(equations, t);
    }
    equations->unfolds = 0;
    if (status >= 0 && !(run->model->settled & SE3DI_SETTLED)) {
        note_start(run, t);
    }
    status = status < 0 ? status : start_contacts(run, t);
    if (status < 0) {
        se3di_state_restore(equations);
        return status;
    }
    run->model->time = t;
    run->model->settled = SE3DI_SETTLED;
    se3di_angles_accept(run->model);
    return SE3D_OK;
}

/* The method under way has written the history. */
static int has_history(const se3di_run *run)
{
    const se3di_model *model = run->model;
    return model->history_tag == se3di_run_get_history_tag(run) &&
           model->history_count == run->integration.method->history_count(&run->equations.assembly);
}

/* The history belongs to what acts on the model now. */
static void mark_history(se3di_model *model)
{
    model->history_inputs = model->inputs_version;
    model->history_values = model->values_version;
}

/* If a step ends after the present time, what elements remember of its end is not of their past. */
static se3d_status recall(se3di_run *run)
{
    se3di_model *model = run->model;
    if (!run->integration.method->advance || !(model->history[SE3DI_HISTORY_TIME] > model->time)) {
        return SE3D_OK;
    }
    se3di_forces_show(model, 1);
    se3di_forces_stay(model);
    se3di_contacts_begin(model, 0.0, 1.0, 0);
    return model->contacts.pair_count > 0 ? se3di_contacts_show(model, model->time, run->error)
                                          : SE3D_OK;
}

/* And what friction holds with, which knows no particles. */
static se3d_status renew_accelerations(se3di_run *run)
{
    SE3DI_TRY(accelerate(run));
    SE3DI_TRY(se3di_friction_renew(&run->equations));
    return run->model->sets ? accelerate(run) : SE3D_OK;
}

/* Something else acts on the present state than did on the way to it (`whole`: it may not be
 * consistent any more). All that follows from what acts is computed anew, so that it does so from
 * the very start of the next step; what is remembered of the motion stays. */
static se3d_status renew(se3di_run *run, int whole)
{
    se3di_model *model = run->model;
    const se3di_integrator *method = run->integration.method;
    const int renews_all = method->renews_all && method->renews_all(&run->integration);
    SE3DI_TRY(recall(run));
    SE3DI_TRY(whole ? settle(run, model->time) : SE3D_OK);
    SE3DI_TRY(renews_all ? SE3D_OK : renew_accelerations(run));
    if (model->history_values != model->values_version) { /* who did the work is not known */
        model->work_valid = 0;
    }
    SE3DI_TRY(renews_all ? SE3D_OK : se3di_work_accept(model, 0.0));
    run->integration.is_moved = whole;
    SE3DI_TRY(method->renew ? method->renew(&run->integration) : SE3D_OK);
    mark_history(model);
    const uint64_t stamp = model->history_stamp++;
    se3di_events_renew(&run->events, stamp);
    return SE3D_OK;
}

/* auto: what the method has left that another one takes over from; none: zero. */
static se3di_adaptive_history get_left(const se3di_run *run)
{
    const se3di_model *model = run->model;
    const se3di_integrator *left = se3di_integrator_of_history(model->history_tag);
    return run->automatic && left && left->advance
               ? *(const se3di_adaptive_history *)(const void *)model->history
               : (se3di_adaptive_history){0};
}

/* The method under way has started where another one was left. Back from radau, its first step is
 * none that radau would not make. */
static void take_over(const se3di_run *run, const se3di_adaptive_history *left, int returns)
{
    se3di_adaptive_history *at = (se3di_adaptive_history *)(void *)run->model->history;
    if (run->integration.method->advance) {
        at->returns = left->returns + returns;
        at->next = returns ? fmin(at->next, left->next) : at->next;
    }
}

/* The method starts from a consistent state, where the audit of energy begins if it is void. */
static se3d_status start_method(se3di_run *run, double h)
{
    se3di_model *model = run->model;
    const se3di_adaptive_history left = get_left(run);
    const se3di_integrator *past = se3di_integrator_of_history(model->history_tag);
    const int returns =
        run->automatic && run->integration.method->is_explicit && past && past->takes_stiff;
    SE3DI_TRY(se3di_work_accept(model, 0.0));
    SE3DI_TRY(run->integration.method->start(&run->integration, h));
    take_over(run, &left, returns);
    model->history_count = run->integration.method->history_count(&run->equations.assembly);
    model->history_tag = se3di_run_get_history_tag(run);
    mark_history(model);
    ++model->history_stamp;
    return SE3D_OK;
}

static se3d_status start_history(se3di_run *run, double h)
{
    SE3DI_TRY(settle(run, run->model->time));
    SE3DI_TRY(se3di_friction_start(&run->equations));
    se3di_step_list_begin(&run->integration, run->model->time);
    return start_method(run, h);
}

/* On the other side of a kink, with the velocities there. */
static se3d_status go_on_behind(se3di_run *run, const se3di_kink *kink, double h)
{
    SE3DI_TRY(se3di_kink_pass(&run->equations, kink));
    SE3DI_TRY(settle(run, kink->t));
    if (run->analysis != SE3D_ANALYSIS_DYNAMICS) {
        return se3di_work_accept(run->model, 0.0);
    }
    SE3DI_TRY(se3di_friction_pass(&run->equations));
    return start_method(run, h);
}

/* Over a kink, at which the model is; on failure it stays there. */
static se3d_status pass_kink(se3di_run *run, const se3di_kink *kink, double h)
{
    SE3DI_TRY(se3di_equations_keep(&run->equations));
    const se3d_status status = go_on_behind(run, kink, h);
    if (status < 0) {
        se3di_equations_come_back(&run->equations);
    }
    return status;
}

/* The state that a call comes back to if it cannot reach another one. Methods that step up to a
 * time keep each step's own. */
static se3d_status keep_state(se3di_run *run)
{
    se3di_model *model = run->model;
    run->has_before = 0;
    if (se3di_saved_refill(&run->before, model, &model->allocator) < 0) {
        return se3di_error_set(run->error, SE3D_ERR_NO_MEMORY, "no memory to keep the state");
    }
    run->has_before = 1;
    run->before_version = model->topology_version;
    return SE3D_OK;
}

static int has_step_control(const se3di_integration *integration)
{
    return integration->method->run != NULL;
}

/* A row of the motion within the last step: an interpolation, of which nothing is kept. */
static int is_row(se3di_run *run, double t)
{
    se3di_integration *integration = &run->integration;
    integration->shows_motion = run->shows_motion;
    const int is = integration->method->run == se3di_explicit_run && !run->equations.watch &&
                   se3di_explicit_is_within(integration, t);
    integration->shows_motion = 0;
    return is;
}

/* Dynamics goes on from its own history, or starts anew; up to t. */
static se3d_status begin_dynamics(se3di_run *run, double h, double t)
{
    se3di_model *model = run->model;
    const int waits = model->history_inputs != model->inputs_version && has_history(run) &&
                      se3di_pending_is_of(model->pending, &run->integration);
    if (!waits) {
        se3di_pending_complete(model->pending);
    }
    const int is_there = has_history(run);
    const int goes_on = is_there && model->history_inputs == model->inputs_version;
    run->equations.redundant |= is_there && model->history_redundant > 0; /* whoever made it */
    run->shows_row = goes_on && is_row(run, t);
    if (!goes_on || (run->integration.method->advance && !run->shows_row)) {
        SE3DI_TRY(keep_state(run));
    }
    if (waits) { /* efforts have changed since, nothing else: all is found anew */
        se3di_explicit_put_off(&run->integration);
        run->before_waits = 1;
    }
    const int lacks = (model->settled & SE3DI_LACKING) != 0 && has_step_control(&run->integration);
    if (is_there && lacks && (!goes_on || run->steps_once)) { /* what begins here needs them */
        SE3DI_TRY(run->integration.method->run(&run->integration, model->time));
    }
    if (goes_on) {
        return SE3D_OK;
    }
    return is_there ? renew(run, model->history_values != model->values_version)
                    : start_history(run, h);
}

/* By h, to t. */
static se3d_status watched_step(se3di_run *run, double h, double t)
{
    SE3DI_TRY(se3di_watch_begin(&run->equations));
    SE3DI_TRY(se3di_run_make_step(run, h));
    run->model->time = t;
    return se3di_watch_end(&run->equations);
}

static se3di_pace_kind pace_of(const se3di_integration *integration)
{
    return integration->method->is_implicit ? SE3DI_PACE_IMPLICIT : SE3DI_PACE_EXPLICIT;
}

/* The length was asked for: impacts can be followed with it, or it is an error. */
static se3d_status check_length(se3di_run *run, double h)
{
    const se3di_integration *integration = &run->integration;
    return integration->method->takes_crowd
               ? SE3D_OK
               : se3di_contacts_check_step(run->model, pace_of(integration), h, run->error);
}

/* The next step on the way to t_end: of the length that was asked for, or as contacts need it. */
static se3d_status choose_step(se3di_run *run, double t_end, double *h)
{
    se3di_integration *integration = &run->integration;
    double rest = t_end - run->model->time;
    double asked = integration->settings.step;
    if (asked > 0.0) {
        *h = rest / se3di_steps_count(rest, asked, t_end);
        return check_length(run, *h);
    }
    *h = se3di_equal_steps_next(integration, integration->settings.step_most, t_end);
    return SE3D_OK;
}

/* How far a body may turn in a step. */
static double largest_turn(const se3di_run *run)
{
    return run->integration.method->is_implicit ? TURN_MAX : HUGE_VAL; /* of rattle: its own */
}

static se3d_status step_dynamics(se3di_run *run, double h)
{
    se3di_integration *integration = &run->integration;
    SE3DI_TRY(se3di_turns_check(&run->equations, h, largest_turn(run)));
    return integration->method->step(integration, h);
}

static se3d_status run_fixed_steps(se3di_run *run, double t_end)
{
    se3di_model *model = run->model;
    while (model->time < t_end) {
        const double rest = t_end - model->time;
        double h;
        SE3DI_TRY(se3di_equations_try_step(&run->equations, model->time));
        SE3DI_TRY(choose_step(run, t_end, &h));
        double end = rest <= (1.0 + 1e-9) * h ? t_end : model->time + h;
        h = se3di_kink_step(&run->integration, model->time, h, fmin(2.0 * h, rest), &end);
        if (run->integration.at_kink) {
            break;
        }
        h = se3di_step_length(model->time, end, h);
        SE3DI_TRY(se3di_watch_begin(&run->equations));
        SE3DI_TRY(step_dynamics(run, h));
        model->time = end;
        se3di_equal_steps_watch(&run->integration, h);
        const se3d_status status = se3di_watch_end(&run->equations);
        if (status != SE3D_OK) {
            return status;
        }
    }
    return SE3D_OK;
}

/* auto: the method is held to short steps by stability, or by what touches. */
static int must_switch(const se3di_run *run)
{
    return has_history(run) && se3di_integration_must_leave(&run->integration);
}

/* What is still asked in the rest of this run, after `crowd` has been seen and does not suit. */
static int32_t ask_later(int32_t crowd)
{
    return crowd == SE3DI_CROWD_ROUGH  ? SE3DI_CROWD_SLOW /* after the first tiny steps */
           : crowd == SE3DI_CROWD_NEAR ? SE3DI_CROWD_DENSE
                                       : SE3DI_CROWD_NONE;
}

/* From the present state by a method for stiff motions, or back from it, or for many bodies at each
 * other; by the same one if rounding alone brought them together. */
static se3d_status switch_method(se3di_run *run)
{
    if (se3di_run_is_crowded(run)) {
        return se3di_run_prepare(run);
    }
    const int32_t later = ask_later(run->integration.settings.leaves_crowd);
    run->integration.settings.leaves_crowd = SE3DI_CROWD_NONE;
    if (!must_switch(run)) {
        if (later != SE3DI_CROWD_NONE) {
            run->integration.settings.leaves_crowd = later;
            run->integration.method->stay(run->model);
        }
        return SE3D_OK;
    }
    run->left = run->integration.method;
    run->left_at = run->model->time;
    const int returns = run->left->takes_stiff;
    se3di_run_use_method(run, returns ? se3di_run_find_explicit(run) : &se3di_integrator_radau);
    SE3DI_TRY(se3di_run_build(run));
    const char *const now = run->integration.method->name, *const left = run->left->name;
    se3di_log_write(run->error, SE3D_LOG_INFO, SE3D_LOG_METHOD,
                    returns ? "t = %g s: steps of %s are stable by %s, which takes over"
                            : "t = %g s: stability limits the steps of %s, %s takes over",
                    run->left_at, left, now);
    return se3di_run_prepare(run);
}

se3d_status se3di_run_show(se3di_run *run, double t_end)
{
    se3di_integration *integration = &run->integration;
    integration->shows_motion = run->shows_motion;
    const se3d_status status = integration->method->run(integration, t_end);
    integration->shows_motion = 0;
    return status;
}

/* To t_end, or to where a prescribed rate jumps. */
static se3d_status run_smoothly(se3di_run *run, double t_end)
{
    se3di_integration *integration = &run->integration;
    integration->at_kink = 0;
    if (!has_step_control(integration)) {
        return run_fixed_steps(run, t_end);
    }
    return run->equations.watch && integration->method->advance
               ? se3di_events_run(&run->events, t_end)
               : se3di_run_show(run, t_end);
}

/* The longest step of methods that control no error, if none was given; stable, and exact. */
static double longest_step(const se3di_integration *integration)
{
    const se3di_model *model = integration->equations->assembly.model;
    const int is_controlled =
        integration->method->is_implicit || integration->method->explicit_class;
    const double stable = is_controlled ? HUGE_VAL : se3di_stiffness_step(model);
    const int is_chosen =
        se3di_equal_steps_are_chosen(integration) ||
        (!(integration->settings.step > 0.0) && se3di_equal_steps_given(integration, model) > 0.0);
    return is_chosen ? stable : fmin(STEP_DEFAULT, stable);
}

/* Equal steps, chosen before the first one. */
static se3d_status choose_steps(se3di_run *run, double t_end)
{
    se3di_integration *integration = &run->integration;
    integration->settings.step_most = longest_step(integration);
    SE3DI_TRY(se3di_equal_steps_choose(integration, fmax(t_end, run->horizon)));
    if (se3di_equal_steps_are_chosen(integration)) { /* none is yet where a kink comes first */
        const double chosen = se3di_equal_steps_get(integration, run->model);
        integration->settings.step_most =
            fmin(integration->settings.step_most, chosen > 0.0 ? chosen : STEP_DEFAULT);
    }
    return SE3D_OK;
}

static se3d_status refuse_against(const se3di_run *run, double t_end)
{
    return run->driven_twice && t_end > run->model->time
               ? se3di_against_refuse(&run->equations.assembly, t_end, run->error)
               : SE3D_OK;
}

/* The method in use, to t_end or to where an event ends it or it has to be left. */
static se3d_status run_method(se3di_run *run, double t_end)
{
    se3di_integration *integration = &run->integration;
    integration->settings.step_most = longest_step(integration);
    integration->end = fmax(t_end, run->horizon);
    double step = integration->settings.step > 0.0
                      ? integration->settings.step
                      : fmin(STEP_DEFAULT, integration->settings.step_most);
    const double remaining = t_end - run->model->time;
    run->refused = 1;
    SE3DI_TRY(se3di_jump_refuse(&run->equations.assembly, t_end, step, run->error));
    SE3DI_TRY(refuse_against(run, t_end));
    run->refused = 0;
    step = remaining / se3di_steps_count(remaining, step, t_end);
    SE3DI_TRY(begin_dynamics(run, step, t_end));
    se3di_run_tell_bodies(run);
    se3di_run_tell_step(run);
    se3di_run_tell_crowd(run);
    se3di_run_tell_reach(run);
    for (;;) {
        SE3DI_TRY(choose_steps(run, t_end));
        const se3d_status status = run_smoothly(run, t_end);
        if (status < 0 || status == SE3D_INFO_EVENT || !integration->at_kink) {
            return status;
        }
        SE3DI_TRY(pass_kink(run, &integration->kink, step));
    }
}

static se3d_status run_dynamics(se3di_run *run, double t_end)
{
    if (!(t_end > run->model->time)) {
        SE3DI_TRY(keep_state(run));
        if (has_history(run)) {
            return renew(run, 1);
        }
        SE3DI_TRY(settle(run, t_end));
        SE3DI_TRY(run->integration.method->accelerate ? accelerate(run) : SE3D_OK);
        return se3di_friction_start(&run->equations);
    }
    const double begin = run->model->time;
    const uint64_t steps = run->equations.counters.steps;
    se3d_status status = run_method(run, t_end);
    while (status >= 0 && status != SE3D_INFO_EVENT && run->model->time < t_end &&
           must_switch(run)) {
        SE3DI_TRY(switch_method(run));
        status = run_method(run, t_end);
    }
    se3di_run_tell_held(run);
    if (status >= 0 ? status != SE3D_INFO_EVENT : status == SE3D_ERR_STEP_COUNT) {
        se3di_run_tell_shaken(run, begin, steps);
    }
    if (status < 0 || status == SE3D_INFO_EVENT) { /* whose callback may have changed the model */
        return status;
    }
    return run->equations.redundant && !(run->model->settled & SE3DI_LACKING)
               ? se3di_multipliers_reduce(&run->equations)
               : SE3D_OK;
}

static se3d_status run_kinematics(se3di_run *run, double t_end)
{
    if (run->model->settled != SE3DI_SETTLED || !run->determined || !(t_end > run->model->time)) {
        SE3DI_TRY(settle(run, run->model->time));
    }
    se3di_contacts_begin(run->model, 0.0, 1.0, 0);
    SE3DI_TRY(refuse_against(run, t_end));
    if (run->equations.audits) {
        SE3DI_TRY(se3di_friction_follow(&run->equations, run->model->time));
        se3di_stops_accept(run->model);
        SE3DI_TRY(se3di_work_accept(run->model, 0.0));
    } else {
        memset(run->model->work, 0, sizeof run->model->work);
        run->model->work_valid = SE3DI_WORK_UNKNOWN;
    }
    se3di_kink kink;
    const double step = run->integration.settings.step;
    while (run->equations.audits &&
           se3di_kink_find(&run->equations.assembly, run->model->time, t_end, &kink)) {
        const se3d_status status = se3di_kinematics_run(&run->equations, kink.t_before, step);
        if (status < 0 || status == SE3D_INFO_EVENT) {
            return status;
        }
        SE3DI_TRY(pass_kink(run, &kink, 0.0));
    }
    return se3di_kinematics_run(&run->equations, t_end, step);
}

/* A static position at t_end. */
static se3d_status run_equilibrium(se3di_run *run, double t_end)
{
    se3di_model *model = run->model;
    const se3d_status status = se3di_equilibrium_solve(&run->equations, t_end);
    SE3DI_TRY(status);
    se3di_angles_accept(model);
    se3di_model_touch_state(model);
    SE3DI_TRY(start_contacts(run, model->time)); /* contacts are as they are there */
    return status;
}

static se3d_status run_to(se3di_run *run, double t_end)
{
    se3d_status status =
        run->analysis == SE3D_ANALYSIS_DYNAMICS ? SE3D_OK /* where it has to */ : keep_state(run);
    SE3DI_TRY(status);
    switch (run->analysis) {
    case SE3D_ANALYSIS_EQUILIBRIUM:
        status = run_equilibrium(run, t_end);
        SE3DI_TRY(status);
        break;
    case SE3D_ANALYSIS_ASSEMBLY:
        SE3DI_TRY(settle(run, t_end));
        break;
    case SE3D_ANALYSIS_DYNAMICS:
        status = run_dynamics(run, t_end);
        SE3DI_TRY(status);
        break;
    default:
        status = run_kinematics(run, t_end);
        if (status < 0) {
            return se3di_dead_point_explain(&run->equations, t_end, status);
        }
        break;
    }
    return status == SE3D_INFO_EVENT || status == SE3D_INFO_UNSTABLE || status == SE3D_INFO_NEUTRAL
               ? status
               : se3di_run_inform(run);
}

/* A step of h, in parts where prescribed rates jump within it. */
static se3d_status run_step(se3di_run *run, double h)
{
    se3di_integration *integration = &run->integration;
    const se3di_model *model = run->model;
    const double t_end = model->time + h;
    integration->end = t_end;
    SE3DI_TRY(begin_dynamics(run, h, -HUGE_VAL));
    while (model->time < t_end) {
        double end = t_end;
        integration->at_kink = 0;
        h = se3di_kink_step(integration, model->time, h, h, &end);
        SE3DI_TRY(check_length(run, h));
        const se3d_status status = integration->at_kink
                                       ? pass_kink(run, &integration->kink, t_end - model->time)
                                       : watched_step(run, h, end);
        if (status < 0 || status == SE3D_INFO_EVENT) {
            return status;
        }
        h = t_end - model->time;
    }
    return se3di_run_inform(run);
}

se3d_status se3di_run_make_step(se3di_run *run, double h)
{
    se3di_equations *equations = &run->equations;
    const se3di_watch *watch = equations->watch;
    equations->watch = NULL;
    const se3d_status status = run->analysis == SE3D_ANALYSIS_DYNAMICS
                                   ? step_dynamics(run, h)
                                   : se3di_kinematics_step(equations, h);
    equations->watch = watch;
    return status;
}

/* Room for what integrals of rates are on the way to t_end; steps fill it. */
static se3d_status prepare_integrals(se3di_run *run, double t_end)
{
    se3di_model *model = run->model;
    if (se3di_integrals_reserve(model, fmax(t_end, run->horizon)) < 0) {
        return se3di_error_set(run->error, SE3D_ERR_NO_MEMORY, "no memory for integrals of rates");
    }
    se3di_integrals_advance(model, run->analysis == SE3D_ANALYSIS_DYNAMICS ? model->time : t_end);
    return SE3D_OK;
}

/* @return the status of the message that is there; it is taken off, to see whether one comes. */
static se3d_status begin(se3di_run *run)
{
    const se3d_status told = run->error->status;
    run->error->status = SE3D_OK;
    run->has_before = run->steps_once = run->before_waits = run->shows_row = 0;
    run->events.reached = run->model->time; /* not where an earlier call has come to */
    run->model->remembers = 1;
    se3di_user_begin(run->model);
    return told;
}

static se3d_status conclude(se3di_run *run, se3d_status status, double t_end, se3d_status told)
{
    status = se3di_sets_settle(run->model, status, run->error);
    if (status >= 0) {
        run->error->status = run->error->status < 0 ? run->error->status : told;
        return status;
    }
    return se3di_run_fail(run, status, t_end);
}

/* Runs on the way to one horizon are counted together. */
static void begin_guard(se3di_run *run, double t_end)
{
    se3di_guard *guard = &run->guard;
    const double now = run->model->time;
    const int goes_on = guard->steps > 0.0 && run->horizon >= t_end && guard->end >= t_end &&
                        now >= guard->half_time;
    guard->came = guard->muted = 0;
    if (!goes_on) {
        se3di_guard_begin(guard, now, fmax(t_end, run->horizon));
    }
}

int se3di_run_is_now(const se3di_run *run, double t)
{
    const double now = run->model->time;
    return fabs(t - now) <= 4.0 * DBL_EPSILON * fmax(fabs(t), fabs(now));
}

/* To t_end, and on from what the callback of an event has left. */
static se3d_status run_again(se3di_run *run, double t_end)
{
    se3d_status status;
    begin_guard(run, t_end);
    do {
        run->refused = 0;
        run->events.goes_on = 0;
        SE3DI_TRY(se3di_run_prepare(run));
        se3di_run_choose_for_call(run, 0);
        SE3DI_TRY(prepare_integrals(run, t_end));
        const se3d_status told = begin(run);
        status = conclude(run, run_to(run, t_end), t_end, told);
    } while (status == SE3D_INFO_EVENT && run->events.goes_on);
    return status;
}

se3d_status se3di_run_to(se3di_run *run, double t_end)
{
    se3d_status status;
    const double now = run->model->time;
    if (!se3di_run_is_now(run, t_end)) {
        return run_again(run, t_end);
    }
    run->model->time = fmax(t_end, now); /* no step is that short */
    status = run_again(run, run->model->time);
    run->model->time = status < 0 ? now : run->model->time;
    return status;
}

/* The length of a step of `h` to where as many steps as there were lead, added up exactly: what
 * rounding takes from one goes into the next. *rest: what this one leaves. */
static double step_length(const se3di_model *model, double h, double *rest)
{
    const double t = model->time;
    const int goes_on = !(t < model->rest_time) && !(t > model->rest_time);
    const double wanted = goes_on ? h + model->time_rest : h;
    const double length = (t + wanted) - t;
    *rest = wanted - length;
    return length > 0.0 ? length : h;
}

se3d_status se3di_run_step(se3di_run *run, double h)
{
    if (run->analysis != SE3D_ANALYSIS_DYNAMICS) {
        se3di_pending_complete(run->model->pending);
        return se3di_run_to(run, run->model->time + h);
    }
    double rest;
    se3di_model *model = run->model;
    if (!se3di_pending_is_of(model->pending, &run->integration)) {
        se3di_pending_complete(model->pending); /* of another solver */
    }
    const double length = step_length(model, h, &rest), t_end = model->time + length;
    begin_guard(run, t_end);
    run->refused = 0;
    run->events.goes_on = 0;
    SE3DI_TRY(se3di_run_prepare(run));
    se3di_run_choose_for_call(run, 1);
    SE3DI_TRY(prepare_integrals(run, t_end));
    const se3d_status told = begin(run);
    run->steps_once = 1;
    run->integration.may_wait = model->pending && !run->equations.watch;
    const se3d_status reached = run_step(run, length);
    run->integration.may_wait = 0;
    const se3d_status status = conclude(run, reached, t_end, told);
    if (status >= 0 && status != SE3D_INFO_EVENT) {
        model->rest_time = model->time;
        model->time_rest = rest;
    }
    return status == SE3D_INFO_EVENT && run->events.goes_on ? se3di_run_to(run, t_end) : status;
}
