/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/explicit_step.h"
#include "integrator/explicit_point.h"
#include "integrator/memory.h"

#include "assembly/energy.h"
#include "base/pending.h"
#include "contact/bodies/pace.h"
#include "integrator/motion.h"
#include "integrator/step_list.h"
#include "integrator/tyre_steps.h"
#include "math/elementary.h"
#include "math/larger.h"
#include "math/over.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

_Static_assert(2 * SE3DI_TYRE_NOTES <= SE3DI_FORCE_STATES,
               "memory has room for notes of both ends");

#define CLEARLY    0.999 /* less than a limit, whatever rounding does */
#define FORCED_MAX 3
#define TYRE_TRIES 4     /* of a step that look for changes of tyres, */
#define CROSSING   4.0   /* and how many of the least steps lead across one */
#define MISSED     0.5   /* of a length that was cut for a change that was not there */
#define LEAST_STEP 3e-14 /* of the time */
#define LARGEST    1e50  /* coordinate or velocity whose squares are far from infinite */
#define GAP_PART   0.25  /* of what rows may violate, at the quarters of a step; */
#define CLEAR_PART 0.01  /* of that, at the middle: there is seldom ten times as much beside it */
#define WIDE_PART  0.1   /* of the error of a step that rows redundant by geometry make */
#define WIDE_TRIES 16    /* in vain, until no more are made */

/* The frames at the end, before the projection. */
static void arrive(se3di_explicit *m, double h)
{
    m->methods->arrive(m, h);
    if (!m->is_bare) {
        m->motion->set(m->equations, m->y);
    }
}

/* The derivative there; what is not finite without frames is told by the way that has them. */
static se3d_status differentiate_end(se3di_explicit *m, double t)
{
    if (m->is_bare) {
        if (m->methods->find_end(m, t)) {
            return SE3D_OK;
        }
        m->is_bare = 0;
        m->motion->set(m->equations, m->y);
    }
    return se3di_explicit_differentiate(m, t, se3di_explicit_end(m));
}

/* Stages, error, projection. The derivative at the end is that before the projection, which moves
 * the state by its error: the order is the same. *error is infinite if the step cannot be made
 * at all. */
static se3d_status attempt_once(se3di_explicit *m, double h, double *error)
{
    const double t = m->past->at.time + h;
    double of_stages = 0.0;
    *error = HUGE_VAL;
    m->h = h;
    m->step.fraction = 0.0;
    SE3DI_TRY(m->methods->make_stages(m, h, &of_stages));
    *error = of_stages;
    if (se3di_explicit_is_too_large(m, *error)) {
        return SE3D_OK;
    }
    arrive(m, h);
    SE3DI_TRY(m->is_closed ? se3di_explicit_project(m, t, 0) : SE3D_OK);
    SE3DI_TRY(differentiate_end(m, t));
    *error = m->methods->estimate_end(m, h, of_stages);
    if (m->is_closed || m->is_bare || se3di_explicit_is_too_large(m, *error)) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_explicit_project(m, t, 1));
    /* near a singular position (more rows are dependent than have been all along) accelerations at
     * a state that violates the constraints are others */
    const double dependent = m->motion->count_dependent(m->equations);
    return dependent > m->past->redundant
               ? se3di_explicit_differentiate(m, t, se3di_explicit_end(m))
               : SE3D_OK;
}

static int may_be_wide(const se3di_explicit *m, double error)
{
    const se3di_explicit_past *past = m->past;
    return past->redundant > 0.0 && past->redundant < (double)m->assembly->row_count &&
           !(past->wide > 0.0) && past->narrow < WIDE_TRIES && isfinite(error) &&
           se3di_explicit_is_too_large(m, error);
}

/* A step that is too long although it is short beside the motion may be so by what rows ask for
 * that are redundant by geometry alone. If a filter of them shows that, it stays. */
static se3d_status attempt(se3di_explicit *m, double h, double *error)
{
    SE3DI_TRY(attempt_once(m, h, error));
    if (!may_be_wide(m, *error)) {
        return SE3D_OK;
    }
    const double narrow = *error, fraction = m->step.fraction;
    m->past->wide = 1.0;
    const se3d_status status = attempt_once(m, h, error);
    if (status >= 0 && *error < WIDE_PART * narrow) {
        return status;
    }
    m->past->wide = 0.0;
    if (status < 0 && !se3di_adaptive_may_shrink(status)) {
        return status;
    }
    m->past->narrow += 1.0;
    m->step.fraction = fraction;
    *error = narrow;
    return SE3D_OK;
}

/* The scale, and the accelerations that the next step of a run begins with. */
static void grow_scale(se3di_explicit *m)
{
    m->knows_turns = m->is_bare;
    if (m->is_bare) {
        se3di_explicit_grow_bare_scale(m);
        m->turns[0] = sqrt(m->squares[1]);
        m->turns[1] = sqrt(m->squares[3]);
        m->has_rates = 1; /* nobody looks at them */
        return;
    }
    const double *rates = m->leaves_scale ? NULL : se3di_explicit_grow_scale(m);
    if (rates && m->step.methods) {
        se3di_state_set_rates(m->assembly, rates);
        m->has_rates = 1;
    }
}

/* The frames hold the projected y_1, at t. */
static void accept(se3di_explicit *m, double t)
{
    if (m->methods->accept) {
        m->methods->accept(m, t - m->past->at.time);
    }
    m->past->at.begin = m->past->at.time;
    m->past->at.time = t;
    m->past->dense = m->past->at.renewed = 0.0;
    m->past->gap = -1.0;
    m->has_stages = m->stands = 1;
    const size_t work = m->count - SE3DI_STATE_WORK;
    if (m->is_bare) {
        m->motion->take(m->equations, m->y);
    }
    m->motion->keep(m->equations, m->y1);
    memcpy(m->y1 + work, m->y + work, SE3DI_STATE_WORK * sizeof *m->y);
    if (!m->waits) {
        memcpy(m->f1, m->next, m->count * sizeof *m->f1);
    }
    m->past->unscaled = m->leaves_scale;
    grow_scale(m);
    if (!(m->past->wide > 0.0)) { /* else one with little part in its dependence may seem clear */
        const double dependent = m->motion->count_dependent(m->equations);
        m->past->redundant = fmin(m->past->redundant, dependent);
    }
    m->motion->accept_angles(m->equations);
    se3di_contacts_accept(m->assembly->model); /* force elements: settle_memory */
    ++m->equations->counters.steps;
}

/* The state that the step begins with, as the bodies have it; the one that was set last stays. */
static void show_begin(se3di_explicit *m, double *bodies)
{
    double *end = m->sum3;
    m->motion->keep(m->equations, end);
    m->motion->show(m->equations, m->y1, bodies);
    m->motion->stand(m->equations, end);
}

/* Elements with a memory (stick or slip, stops) change it between steps: *error is raised to what
 * that says of the step, and the memory stays as it was if that is too much. The derivative after
 * the change is the next step's; the interpolation of this one ends with that before. */
static se3d_status settle_memory(se3di_explicit *m, double h, double *error)
{
    se3di_model *model = m->assembly->model;
    const double t = m->past->at.time + h;
    m->next = se3di_explicit_end(m);
    if (!se3di_forces_have_memory(model)) {
        return SE3D_OK;
    }
    se3di_memory_end end;
    const se3di_state_scale scale = se3di_explicit_measure_by(m);
    const se3di_memory_step step = {.t = t,
                                    .h = h,
                                    .tolerance = m->tolerance,
                                    .begin = m->bodies[1],
                                    .lambda = model->lambda,
                                    .scale = &scale,
                                    .memory = m->memory,
                                    .work = m->bodies[0]};
    show_begin(m, m->bodies[1]);
    SE3DI_TRY(se3di_memory_settle(m->equations, &step, &end));
    *error = se3di_larger(*error, end.error);
    m->step.fraction = end.fraction;
    if (!(*error <= 1.0)) {
        se3di_model_restore_memory(model, m->memory);
        return SE3D_OK;
    }
    if (end.has_moved) {
        m->motion->follow(m->equations);
    }
    if (!end.has_changed) {
        return SE3D_OK;
    }
    m->next = m->sum;
    const se3d_status status = m->motion->derive(m->equations, t, m->equations->l, m->next);
    if (status < 0) {
        se3di_model_restore_memory(model, m->memory);
    }
    return status;
}

/* The state half way to the projected end, along a cubic, which the contacts look at. */
static se3d_status review_contacts(se3di_explicit *m, double h, double *error)
{
    const se3di_model *model = m->assembly->model;
    const double *f0 = m->f1, *f = se3di_explicit_end(m);
    double *end = m->bodies[1], of_contacts = 0.0;
    if (model->contacts.pair_count == 0 || !isfinite(m->tolerance)) {
        return SE3D_OK;
    }
    show_begin(m, m->bodies[0]);
    m->motion->keep(m->equations, end);
    se3di_equations_save(m->equations);
    for (size_t k = 0; k < m->count; ++k) {
        m->sum3[k] = 0.5 * (m->y1[k] + m->y[k]) + 0.125 * h * (f0[k] - f[k]);
    }
    m->motion->set(m->equations, m->sum3);
    const se3di_state_scale scale = se3di_explicit_measure_by(m);
    const se3di_memory_step step = {.t = m->past->at.time + h,
                                    .h = h,
                                    .tolerance = m->tolerance,
                                    .begin = m->bodies[0],
                                    .scale = &scale};
    const se3d_status status =
        se3di_memory_review_contacts(m->equations, &step, m->past->at.time + 0.5 * h, &of_contacts);
    m->motion->stand(m->equations, end);
    *error = se3di_larger(*error, of_contacts);
    m->step.fraction = of_contacts > 1.0 ? se3di_memory_get_fraction(of_contacts) : 0.0;
    return status;
}

/* All that may fail before the state is accepted; *error as from settle_memory. */
static se3d_status prepare(se3di_explicit *m, double h, double *error)
{
    se3di_model *model = m->assembly->model;
    if (m->is_bare) {
        m->next = se3di_explicit_end(m);
        return SE3D_OK;
    }
    SE3DI_TRY(review_contacts(m, h, error));
    SE3DI_TRY(*error <= 1.0 ? settle_memory(m, h, error) : SE3D_OK);
    if (!(*error <= 1.0)) {
        return SE3D_OK;
    }
    se3d_status status = se3di_state_prepare(m->equations, m->past->at.time + h);
    if (status < 0 && se3di_forces_have_memory(model)) {
        se3di_model_restore_memory(model, m->memory);
    }
    return status;
}

static se3d_status fail_small(se3di_explicit *m, double h)
{
    double t = m->past->at.time;
    const se3d_status status =
        se3di_error_set(m->equations->error, SE3D_ERR_STEP_SIZE,
                        "t = %g s: the step fell to %.3g s: the tolerance %g cannot be met here; "
                        "the motion is not smooth, or stiff (try generalized_alpha or radau)",
                        t, h, m->tolerance);
    m->motion->set(m->equations, m->y1);
    se3di_contacts_blame(m->assembly->model, m->equations->error);
    return status;
}

/* A step of h to t without control of its error; *error above 1: it leads to no number. */
static se3d_status make_step(se3di_explicit *m, double t, double h, double *error)
{
    const double tolerance = m->tolerance;
    m->tolerance = HUGE_VAL;
    se3d_status status = attempt(m, h, error);
    status = status < 0 ? status : prepare(m, h, error);
    m->tolerance = tolerance;
    if (status >= 0 && *error <= 1.0) {
        accept(m, t);
    }
    return status;
}

/* If the accelerations jump, as under a driver or a load that is switched, no step is short
 * enough for a tight tolerance. One of the least length crosses the jump; what it makes of error is
 * the jump times h. If no ordinary step follows, it was no jump. */
static se3d_status cross_jump(se3di_explicit *m, double h, double error)
{
    if (!(error * m->tolerance < 1e-3) || m->past->forced >= FORCED_MAX) {
        return fail_small(m, h);
    }
    SE3DI_TRY(make_step(m, m->past->at.time + h, h, &error));
    if (!(error <= 1.0)) {
        return fail_small(m, h);
    }
    m->past->forced += 1.0;
    m->past->at.next = se3di_adaptive_limit(m->step.integration, 1e6 * h);
    m->past->at.error = 1e-2;
    return SE3D_OK;
}

/* Bound on how fast a relative angular velocity grows at the forward state. */
static double largest_growth(const se3di_explicit *m)
{
    const se3di_assembly *assembly = m->assembly;
    double largest = 0.0;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const double *wdot = assembly->model->acceleration + 6 * assembly->free_body[k] + 3;
        largest = se3di_raised(largest, se3di_dot(wdot, wdot));
    }
    return 2.0 * sqrt(largest);
}

/* The run is to end at the forward state. */
static int must_leave(const se3di_explicit *m)
{
    const se3di_integration *integration = m->step.integration;
    return integration->settings.leaves_stiff && se3di_explicit_is_held(integration);
}

/* ---- in the loop of all methods ---- */

static se3di_explicit *get_explicit(se3di_adaptive *step)
{
    return (se3di_explicit *)(void *)step;
}

static int is_little(double spin, double growth, double h)
{
    return h * (2.0 * spin + growth * h) < CLEARLY * SE3DI_STATE_TURN;
}

/* Whether no turn limits the step, as the fastest body turns too little, or all that turns if it
 * were added up: frames need not be made to know. */
static int turns_little(const se3di_explicit *m, double h)
{
    const se3di_tree *tree = m->equations->tree;
    if (m->knows_turns && is_little(m->turns[0], m->turns[1], h)) {
        return 1;
    }
    const double spin = se3di_tree_sum_turns(tree, m->y1 + tree->q_count);
    const double growth = se3di_tree_sum_turns(tree, m->f1 + tree->q_count) + spin * spin;
    return is_little(spin, growth, h);
}

static double pace(se3di_adaptive *step, double h)
{
    const se3di_explicit *m = get_explicit(step);
    if (m->is_bare) {
        if (turns_little(m, h)) {
            return h;
        }
        m->motion->set(m->equations, m->y1);
        se3di_state_set_rates(m->assembly, se3di_explicit_get_rates(m));
    }
    h = se3di_state_limit_turn(m->assembly->model, largest_growth(m), h);
    return se3di_contacts_pace(m->assembly->model, SE3DI_PACE_ADAPTIVE, h);
}

/* A step that is too long may be so because tyres leave their roads or meet them within it: the
 * part after which the next one ends, 0 if that is unknown. */
static double seek_tyres(se3di_explicit *m, double h)
{
    const se3di_model *model = m->assembly->model;
    double *begin = m->memory, *end = begin + SE3DI_TYRE_NOTES * model->force_slots.count;
    const double t = m->past->at.time;
    if (m->step.tries > TYRE_TRIES || !se3di_tyres_are_there(model)) {
        return 0.0;
    }
    (void)m->motion->set_frames(m->equations, m->y1);
    const se3d_status status = se3di_tyres_note(model, t, begin);
    m->methods->arrive(m, h);
    (void)m->motion->set_frames(m->equations, m->y);
    const int is_known = status >= 0 && se3di_tyres_note(model, t + h, end) >= 0;
    const double part = is_known ? se3di_tyres_find_part(model, h, begin, end) : 0.0;
    const double shortest = CROSSING * se3di_adaptive_least(&m->step, t) / h;
    return part > 0.0 && shortest < 1.0 ? fmax(part, shortest) : 0.0;
}

/* The length that the next step takes up after this one of h, at whose end the frames are, if one
 * of `resumed` was cut short for a tyre; less if it was to lead across its change and has not. */
static double resume(se3di_explicit *m, double h, double resumed)
{
    const se3di_model *model = m->assembly->model;
    double *begin = m->memory, *end = begin + SE3DI_TYRE_NOTES * model->force_slots.count;
    if (!(resumed > 0.0) || se3di_tyres_note(model, m->past->at.time + h, end) < 0) {
        return 0.0;
    }
    return se3di_tyres_miss(model, h / resumed, h, begin, end) ? MISSED * resumed : resumed;
}

static se3d_status try_step(se3di_adaptive *step, double h, double *error)
{
    se3di_explicit *m = get_explicit(step);
    const double resumed = step->resumed;
    step->resumed = 0.0;
    SE3DI_TRY(attempt(m, h, error));
    if (*error <= 1.0) {
        const double length = resume(m, h, resumed);
        SE3DI_TRY(prepare(m, h, error));
        step->resumed = *error <= 1.0 ? length : 0.0; /* elements use the memory of tyres */
        return SE3D_OK;
    }
    const double part = isfinite(*error) ? seek_tyres(m, h) : 0.0;
    if (part > 0.0) {
        step->fraction = part;
        step->resumed = fmax(resumed, h);
    }
    return SE3D_OK;
}

/* The step h has met the tolerance: what follows for the next ones. */
static se3d_status take(se3di_adaptive *step, double h, double error)
{
    se3di_explicit *m = get_explicit(step);
    const double least = se3di_adaptive_least(step, step->t);
    accept(m, step->t);
    if (step->integration->settings.leaves_stiff || m->methods->is_watched) {
        m->methods->watch_stability(m, h);
    }
    se3di_explicit_watch_crowd(m);
    error = fmax(error, m->remembered);
    step->at->next = m->methods->next_step(m, h, error);
    step->at->error = error;
    m->past->forced = h > 1e3 * least ? 0.0 : m->past->forced;
    return SE3D_OK;
}

static double shrink(se3di_adaptive *step, double h, se3d_status status, double error)
{
    (void)h;
    return get_explicit(step)->methods->shrink(get_explicit(step), status, error);
}

static se3d_status surrender(se3di_adaptive *step, double h, se3d_status status, double error)
{
    return status < 0 ? status : cross_jump(get_explicit(step), h, error);
}

/* The scale, after steps without error control. */
static se3d_status catch_up(se3di_explicit *m)
{
    SE3DI_TRY(se3di_explicit_differentiate(m, m->past->at.time, m->sum));
    se3di_explicit_grow_scale(m);
    m->past->unscaled = 0.0;
    return SE3D_OK;
}

/* The next step of a list, without control of its error. */
static se3d_status repeat(se3di_explicit *m)
{
    double h = 0.0, error = 0.0;
    SE3DI_TRY(se3di_step_list_next(m->step.integration, m->past->at.time, &h, &m->step.t));
    SE3DI_TRY(h > 0.0 ? make_step(m, m->step.t, h, &error) : SE3D_OK);
    return error <= 1.0 ? SE3D_OK : se3di_step_list_fail(m->step.integration);
}

/* The frames are at the forward state, unless nobody looks at them; turns count from step to step,
 * not from an output. */
static void stand_at_begin(se3di_explicit *m)
{
    if (m->is_bare && !(m->past->unscaled > 0.0)) {
        return;
    }
    if (m->stands) {
        m->motion->set_again(m->equations, m->y1);
    } else {
        m->motion->set(m->equations, m->y1);
        m->motion->accept_angles(m->equations);
    }
    m->stands = 0;
}

/* One accepted step with error control. What contacts remember belongs to the end of a step, and
 * cannot be interpolated: if shapes are near each other steps end at t_end. So does the first
 * one after a change of what acts, which may soon change again. */
static se3d_status advance(se3di_explicit *m, double t_end)
{
    static const se3di_adaptive_class methods = {pace,   try_step,  take,
                                                 shrink, surrender, LEAST_STEP};
    se3di_model *model = m->assembly->model;
    m->step.methods = &methods;
    m->step.at = &m->past->at;
    m->step.ends = se3di_adaptive_ends(m->step.integration, &m->past->at);
    se3di_forces_show(model, 0);
    stand_at_begin(m);
    SE3DI_TRY(m->past->unscaled > 0.0 ? catch_up(m) : SE3D_OK);
    if (!m->has_rates && !m->is_bare) {
        se3di_state_set_rates(m->assembly, se3di_explicit_get_rates(m));
    }
    m->has_rates = 0;
    if (m->step.integration->repeat) {
        return repeat(m);
    }
    const double wide = m->past->wide, narrow = m->past->narrow;
    const se3d_status status = se3di_adaptive_advance(&m->step, t_end);
    if (status < 0) { /* nothing is learnt from attempts that end the run */
        m->past->wide = wide;
        m->past->narrow = narrow;
        return status;
    }
    return se3di_step_list_note(m->step.integration, m->past->at.time);
}

/* The forward state is the model's own; its derivative remains to be found. `stands`: y_1 is it. */
static void take_state(se3di_explicit *m, int stands)
{
    m->knows_turns = 0;
    se3di_forces_stay(m->assembly->model);
    m->past->at.time = m->past->at.begin = m->assembly->model->time;
    m->past->dense = 0.0;
    m->past->gap = -1.0;
    if (stands) {
        m->motion->stand(m->equations, m->y1);
    } else {
        m->motion->get(m->equations, m->y1);
    }
}

/* The model still is where the last step has ended. */
static int is_at_end(const se3di_explicit *m)
{
    const double t = m->assembly->model->time;
    return !m->step.integration->is_moved && !(m->past->at.time < t) && !(m->past->at.time > t);
}

/* With the accelerations and multipliers that the model has. */
static se3d_status adopt(se3di_explicit *m)
{
    se3di_assembly *assembly = m->assembly;
    take_state(m, 0);
    se3di_assembly_get_acceleration(assembly, m->equations->x);
    SE3DI_TRY(
        m->motion->derive(m->equations, assembly->model->time, assembly->model->lambda, m->f1));
    se3di_explicit_grow_scale(m);
    return SE3D_OK;
}

/* Accelerations and multipliers of the state that was set last are the model's: by the evaluation
 * that finds all of them, where there is one. */
static se3d_status find_all(se3di_explicit *m, double t)
{
    if (m->motion->may_report(m->equations)) {
        SE3DI_TRY(se3di_explicit_differentiate(m, t, m->sum));
        if (m->motion->report(m->equations)) {
            return SE3D_OK;
        }
    }
    return se3di_acceleration_solve(m->equations, t);
}

static double find_rough(const se3di_integration *integration)
{
    return se3di_state_rough(integration->equations->assembly.model, integration->shows_motion,
                             integration->settings.tolerance);
}

/* The model's state is y, at t; `rough` of now. */
static se3d_status show(se3di_explicit *m, const double *y, double t, int project, double rough)
{
    const double *work = y + m->count - SE3DI_STATE_WORK;
    int is_finite = 0;
    if (rough > 0.0 && !project) {
        is_finite = m->motion->set_frames(m->equations, y);
    } else {
        m->motion->set(m->equations, y);
    }
    if (project) {
        SE3DI_TRY(m->motion->project(m->equations, t, &m->past->scale, fmax(1e-15, rough), 0));
    }
    if (rough > 0.0) {
        m->motion->accept_angles(m->equations);
        se3di_state_take_motion(m->assembly->model, work, t);
        return is_finite ? SE3D_OK : se3di_state_check(m->equations, t);
    }
    SE3DI_TRY(find_all(m, t));
    se3di_contacts_renew_forces(m->assembly->model);
    m->motion->accept_angles(m->equations);
    return se3di_state_conclude(m->equations, work, t);
}

/* The model's state is that at an end of the last step. */
static se3d_status publish(se3di_explicit *m, int at_end)
{
    const double t = at_end ? m->past->at.time : m->past->at.begin;
    se3di_forces_show(m->assembly->model, !at_end);
    return show(m, at_end ? m->y1 : m->y0, t, 0, find_rough(m->step.integration));
}

/* Hairer, Norsett, Wanner 1993, sec. II.4: from the derivative and its change over a small step,
 * which does not go beyond the run: what acts there need not be defined. */
static se3d_status choose_first(se3di_explicit *m, double *first)
{
    double d1 = se3di_explicit_measure(m, m->f1);
    double limit = m->step.integration->settings.step;
    const double rest = m->step.integration->end - m->past->at.time;
    double h0 = 0.01 / (fmax(d1 * m->tolerance, 1e-5));
    h0 = limit > 0.0 ? fmin(h0, limit) : h0;
    m->step.integration->foresees |= rest > 0.0 && rest < h0;
    h0 = rest > 0.0 ? fmin(h0, rest) : h0;
    se3di_error ignored = {0};
    se3di_error *error = m->equations->error;
    m->equations->error = &ignored;
    for (size_t k = 0; k < m->count; ++k) {
        m->y[k] = m->y1[k] + h0 * m->f1[k];
    }
    double d2 = 0.0;
    const se3d_status status = se3di_explicit_evaluate(m, m->past->at.time + h0, m->y, m->K);
    if (status >= 0) {
        for (size_t k = 0; k < m->count; ++k) {
            m->K[k] -= m->f1[k];
        }
        d2 = se3di_over(se3di_explicit_measure(m, m->K), h0);
    }
    if (m->motion->take && !m->equations->is_placed) { /* the frames have stayed at y_1 */
        m->motion->take(m->equations, m->y1);
    } else {
        m->motion->set(m->equations, m->y1);
    }
    m->equations->error = error;
    if (status == SE3D_ERR_CALLBACK) {
        return se3di_error_set(error, status, "%s", ignored.message);
    }
    double d = fmax(d1 * m->tolerance, se3di_over(1e-3, h0));
    double h1 = se3di_pow(0.01 / (fmax(d, sqrt(fmax(d2, 0.0) * m->tolerance)) / m->tolerance),
                          1.0 / m->methods->get_order(m));
    double h = isfinite(h1) && h1 > 0.0 ? fmin(100.0 * h0, h1) : h0;
    h = m->methods->shorten_first ? m->methods->shorten_first(m, h) : h;
    *first = limit > 0.0 ? fmin(h, limit) : h;
    return SE3D_OK;
}

se3d_status se3di_explicit_start(se3di_integration *integration, double h)
{
    (void)h; /* the first step is chosen */
    se3di_explicit m = se3di_explicit_begin(integration, 0);
    memset(m.past, 0, sizeof *m.past);
    memset(m.y0, 0, (SE3DI_EXPLICIT_FORMS + 1) * m.count * sizeof *m.y0);
    m.past->scale.length = se3di_state_length(m.assembly->model);
    m.past->at.error = 1e-2;
    if (!m.methods->is_watched) {
        m.past->watch.since = m.assembly->model->time;
    }
    m.past->redundant = (double)m.assembly->row_count;
    double potential, springs;
    const se3di_model *model = m.assembly->model;
    se3d_status status = se3di_loads_potential(model, model->time, &potential, &springs);
    if (status >= 0) {
        m.past->energy_least = 1e-3 * fabs(potential);
        status = adopt(&m);
    }
    if (status >= 0) {
        status = choose_first(&m, &m.past->at.next);
    }
    se3di_state_end(m.equations, &m.kkt);
    return status;
}

/* What the model shows of accelerations is not looked at before somebody reads it. */
static int waits_for_readers(const se3di_explicit *m)
{
    return m->step.integration->may_wait && !m->methods->keeps_end &&
           m->motion->can_wait(m->equations);
}

/* By the one evaluation that finds all: it is the derivative, and what the model shows. */
static se3d_status adopt_evaluated(se3di_explicit *m)
{
    se3di_model *model = m->assembly->model;
    const size_t work = m->count - SE3DI_STATE_WORK;
    take_state(m, is_at_end(m));
    m->step.integration->owes = 0;
    SE3DI_TRY(se3di_explicit_differentiate(m, model->time, m->f1));
    if (!waits_for_readers(m)) { /* else a step follows at once, which ends elsewhere */
        (void)m->motion->report(m->equations);
    }
    se3di_work_take(model, 0.0, m->f1 + work);
    memcpy(m->y1 + work, model->work, sizeof model->work);
    m->past->unscaled = 1.0;
    return SE3D_OK;
}

int se3di_explicit_renews_all(const se3di_integration *integration)
{
    return se3di_motion_find(integration->equations)->finds_all(integration->equations);
}

se3d_status se3di_explicit_renew(se3di_integration *integration)
{
    se3di_explicit m = se3di_explicit_begin(integration, 0);
    const se3d_status status = m.motion->finds_all(m.equations) ? adopt_evaluated(&m) : adopt(&m);
    m.past->at.renewed = 1.0;
    se3di_state_end(m.equations, &m.kkt);
    return status;
}

/* The accelerations that are reported can be those that the next step begins with: nothing changes
 * at the end of a step, and nothing there is nearly singular, where those of the method are
 * smoother.
 */
static int reports_end(const se3di_explicit *m)
{
    const se3di_model *model = m->assembly->model;
    return !se3di_forces_have_memory(model) && model->shape_slots.count <= 1 &&
           m->motion->count_dependent(m->equations) == 0;
}

static se3d_status solve_accelerations(se3di_explicit *m, double t)
{
    se3di_state_end(m->equations, &m->kkt);
    SE3DI_TRY(se3di_acceleration_solve(m->equations, t));
    return m->motion->derive(m->equations, t, m->assembly->model->lambda, se3di_explicit_end(m));
}

/* The state at the end, projected, with the accelerations and multipliers that the model shows, and
 * the derivative that they are. */
static se3d_status solve_end(se3di_explicit *m, double t)
{
    SE3DI_TRY(se3di_explicit_project(m, t, 1));
    if (m->motion->may_report(m->equations)) {
        SE3DI_TRY(se3di_explicit_differentiate(m, t, se3di_explicit_end(m)));
        if (m->motion->report(m->equations)) {
            return SE3D_OK;
        }
    }
    return solve_accelerations(m, t);
}

/* The same after closed stages. They leave no factors that tell which rows are dependent: what is
 * there is of whatever was solved before, so the end is evaluated before anybody asks. */
static se3d_status solve_closed_end(se3di_explicit *m, double t, int *reported)
{
    SE3DI_TRY(se3di_explicit_project(m, t, 0));
    SE3DI_TRY(se3di_explicit_differentiate(m, t, se3di_explicit_end(m)));
    *reported = reports_end(m);
    const int is_told =
        *reported && m->motion->may_report(m->equations) && m->motion->report(m->equations);
    return *reported && !is_told ? solve_accelerations(m, t) : SE3D_OK;
}

/* The same by an evaluation that finds all. */
static se3d_status evaluate_end(se3di_explicit *m, double t)
{
    SE3DI_TRY(se3di_explicit_differentiate(m, t, se3di_explicit_end(m)));
    (void)m->motion->report(m->equations);
    return SE3D_OK;
}

/* So that no number of an evaluation there overflows. */
static int is_moderate(const double *y, size_t count)
{
    int moderate = 1;
    for (size_t k = 0; k < count; ++k) {
        moderate &= fabs(y[k]) < LARGEST;
    }
    return moderate;
}

/* What a step has left to be computed; the state is still that of its end. */
static void complete(void *ctx)
{
    se3di_integration *integration = ctx;
    se3di_explicit m = se3di_explicit_point(integration);
    se3di_model *model = m.assembly->model;
    se3di_error ignored = {0}, *const error = m.equations->error;
    m.equations->error = &ignored; /* it may be a reader who asks */
    m.motion->stand(m.equations, m.y1);
    const se3d_status status = m.motion->evaluate_again(m.equations, m.past->at.time, m.f1);
    m.equations->error = error;
    if (status < 0) { /* the next step begins anew, and says why it cannot */
        model->settled |= SE3DI_LACKING;
        model->history_tag = 0;
        return;
    }
    (void)m.motion->report(m.equations);
    memcpy(model->power, m.f1 + m.count - SE3DI_STATE_WORK, sizeof model->power);
}

void se3di_explicit_put_off(se3di_integration *integration)
{
    const se3di_explicit m = se3di_explicit_point(integration);
    m.motion->keep_efforts(m.equations);
    se3di_pending_drop(m.assembly->model->pending);
}

void se3di_explicit_come_back(se3di_integration *integration)
{
    const se3di_explicit m = se3di_explicit_point(integration);
    m.motion->come_back(m.equations);
    complete(integration);
}

/* One step of h without error control; *reported: the accelerations at its end are the model's. */
static se3d_status step_once(se3di_explicit *m, double h, int *reported)
{
    const double t = m->past->at.time + h;
    double error = 0.0; /* none is asked for: what settle_memory adds decides */
    SE3DI_TRY(m->methods->make_stages(m, h, &error));
    error = 0.0;
    *reported = !m->is_closed && reports_end(m);
    arrive(m, h);
    m->leaves_scale = *reported && m->motion->finds_all(m->equations);
    m->waits = m->leaves_scale && waits_for_readers(m) && is_moderate(m->y, m->count);
    if (m->is_closed) {
        SE3DI_TRY(solve_closed_end(m, t, reported));
    } else if (m->waits) {
        m->next = se3di_explicit_end(m);
    } else if (*reported) {
        SE3DI_TRY(m->motion->finds_all(m->equations) ? evaluate_end(m, t) : solve_end(m, t));
    } else {
        SE3DI_TRY(se3di_explicit_differentiate(m, t, se3di_explicit_end(m)));
        SE3DI_TRY(se3di_explicit_project(m, t, 1));
    }
    SE3DI_TRY(prepare(m, h, &error));
    accept(m, t);
    return SE3D_OK;
}

se3d_status se3di_explicit_step(se3di_integration *integration, double h)
{
    se3di_explicit m = se3di_explicit_begin(integration, 0);
    int reported = 0;
    se3d_status status = SE3D_OK;
    se3di_pending_complete(m.assembly->model->pending);
    m.equations->counters.evaluations += integration->owes != 0;
    integration->owes = 0;
    if (m.past->at.time != m.assembly->model->time) {
        status = adopt(&m);
    } else {
        m.motion->stand(m.equations, m.y1);
    }
    se3di_forces_show(m.assembly->model, 0);
    m.tolerance = HUGE_VAL; /* no error control */
    status = status < 0 ? status : step_once(&m, h, &reported);
    se3di_state_end(m.equations, &m.kkt);
    const double *work = m.y1 + m.count - SE3DI_STATE_WORK;
    const double *power = m.f1 + m.count - SE3DI_STATE_WORK;
    if (status >= 0 && m.leaves_scale) {
        se3di_state_conclude_step(m.equations, work, m.waits ? NULL : power, m.past->at.time);
        integration->owes = m.waits;
        if (m.waits) {
            se3di_pending_open(m.assembly->model->pending, complete, integration);
        }
        return SE3D_OK;
    }
    if (status >= 0 && reported) {
        return se3di_state_conclude(m.equations, work, m.past->at.time);
    }
    return status < 0 ? status : publish(&m, 1);
}

/* Forward steps until t_end is reached, and the interpolation where it is passed. */
static se3d_status advance_to(se3di_explicit *m, double t_end)
{
    while (m->past->at.time < t_end && !must_leave(m) && !m->step.integration->at_kink) {
        SE3DI_TRY(advance(m, t_end));
    }
    return m->past->at.time > t_end && m->past->dense == 0.0 ? m->methods->build_dense(m) : SE3D_OK;
}

se3d_status se3di_explicit_advance(se3di_integration *integration, double t_end)
{
    se3di_explicit m = se3di_explicit_begin(integration, 1);
    se3d_status status = advance(&m, t_end);
    status = status < 0 || integration->at_kink ? status : m.methods->build_dense(&m);
    se3di_state_end(m.equations, &m.kkt);
    return status;
}

void se3di_explicit_interpolate(const se3di_integration *integration, double t, double *y)
{
    const se3di_explicit m = se3di_explicit_point(integration);
    const int is_within = t < m.past->at.time;
    if (is_within) {
        m.methods->interpolate(&m, t, m.y);
    }
    m.motion->show(m.equations, is_within ? m.y : m.y1, y);
}

/* What the interpolation of the last step violates constraints by, at its middle and, unless that
 * is far below `limit`, at the other quarters: a part of the history, so that what is shown does
 * not depend on what was shown before. */
static se3d_status measure_gap(se3di_explicit *m, double limit)
{
    static const double places[] = {0.5, 0.25, 0.75};
    const double begin = m->past->at.begin, h = m->past->at.time - begin;
    double worst = 0.0;
    for (int k = 0; k < 3 && (k == 0 || !(worst <= CLEAR_PART * limit)); ++k) {
        const double t = begin + places[k] * h;
        double gap;
        m->methods->interpolate(m, t, m->y);
        m->motion->set(m->equations, m->y);
        SE3DI_TRY(m->motion->measure_gap(m->equations, t, &m->past->scale, &gap));
        worst = se3di_larger(worst, gap);
    }
    m->past->gap = worst;
    return SE3D_OK;
}

/* *needed: a row of the motion within the last step is to be projected onto the constraints; of
 * a motion that a step keeps well within them all along it is not even compared with them. */
static se3d_status needs_projection(se3di_explicit *m, double rough, int *needed)
{
    *needed = 1;
    if (!(rough > 0.0)) {
        return SE3D_OK;
    }
    SE3DI_TRY(m->past->gap < 0.0 ? measure_gap(m, GAP_PART * rough) : SE3D_OK);
    *needed = !(m->past->gap <= GAP_PART * rough);
    return SE3D_OK;
}

static int lies_within(const se3di_integration *integration, double t, double rough)
{
    const se3di_explicit_past *past =
        se3di_explicit_past_of(integration->equations->assembly.model);
    return past->dense > 0.0 && t > past->at.begin && t < past->at.time && rough > 0.0 &&
           past->gap >= 0.0 && past->gap <= GAP_PART * rough;
}

int se3di_explicit_is_within(const se3di_integration *integration, double t)
{
    return lies_within(integration, t, find_rough(integration));
}

/* Nothing is solved on the way: what the solvers need is not made. */
static se3d_status show_within(se3di_integration *integration, double t, double rough)
{
    se3di_explicit m = se3di_explicit_point(integration);
    m.step.integration = integration;
    se3di_forces_show(m.assembly->model, 1);
    m.methods->interpolate(&m, t, m.y);
    return show(&m, m.y, t, 0, rough);
}

se3d_status se3di_explicit_run(se3di_integration *integration, double t_end)
{
    double rough = find_rough(integration);
    if (lies_within(integration, t_end, rough)) {
        return show_within(integration, t_end, rough);
    }
    se3di_explicit m = se3di_explicit_begin(integration, 1);
    const int at_begin = !(t_end > m.past->at.begin);
    se3d_status status = at_begin ? SE3D_OK : advance_to(&m, t_end);
    se3di_state_end(m.equations, &m.kkt);
    SE3DI_TRY(status);
    if (at_begin || m.past->at.time <= t_end) { /* earlier if it leaves a stiff motion */
        return publish(&m, m.past->at.time <= t_end);
    }
    int needs;
    rough = find_rough(integration); /* contacts may have come */
    se3di_forces_show(m.assembly->model, 1);
    SE3DI_TRY(needs_projection(&m, rough, &needs));
    m.methods->interpolate(&m, t_end, m.y);
    return show(&m, m.y, t_end, needs, rough);
}

static int is_count(double value)
{
    return value >= 0.0 && value <= INT32_MAX && value == floor(value);
}

int se3di_explicit_is_sound(const double *history, size_t count)
{
    const se3di_explicit_past *past = (const se3di_explicit_past *)history;
    return count >= SE3DI_EXPLICIT_PAST && is_count(past->redundant) && is_count(past->stages);
}
