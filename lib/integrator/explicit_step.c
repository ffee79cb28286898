/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/explicit_step.h"
#include "integrator/memory.h"

#include "assembly/energy.h"
#include "assembly/loads.h"
#include "base/pending.h"
#include "contact/bodies/pace.h"
#include "integrator/motion.h"
#include "math/elementary.h"
#include "math/larger.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define PAST (sizeof(se3di_explicit_past) / sizeof(double))

#define FORCED_MAX  3
#define LEAST_STEP  3e-14 /* of the time */
#define BALANCE     8e-15 /* rounding of accelerations, relative to those of forces that balance */
#define ROUNDING    2e-15 /* of a velocity of one kind, relative to those of the other */
#define LARGEST     1e50  /* coordinate or velocity whose squares are far from infinite */
#define GAP_PART    0.25  /* of what rows may violate, at the quarters of a step */
#define WORK_WEIGHT 0.1   /* of the error of works: it disturbs nothing but the audit of energy */

#define VECTORS (3 + SE3DI_EXPLICIT_FORMS)

/* As motion->count has it. */
size_t se3di_explicit_history_count(const se3di_assembly *assembly)
{
    const int has_tree = assembly->tree_count > 0 &&
                         assembly->model->left_out_count == assembly->model->broken_count;
    const size_t count =
        has_tree ? assembly->tree_count + SE3DI_STATE_WORK : se3di_state_count(assembly);
    return PAST + VECTORS * count;
}

/* Work: that of the method, the state of a stage, what the force elements remember, and two changes
 * of the state as the bodies see them. */
size_t se3di_explicit_work_count(const se3di_assembly *assembly)
{
    const size_t memories = SE3DI_FORCE_STATES * assembly->model->force_slots.count;
    return (SE3DI_EXPLICIT_ROWS + 5) * se3di_state_count(assembly) + memories;
}

/* Local errors add up; what the user asks for is about the error of a run of some ten motions. Not
 * below what rounding allows. On open trees with nothing but plain forces the estimates of long
 * steps, which are of low orders, are far above the error: at 0.1 by three orders of magnitude. */
static double inner_tolerance(const se3di_integration *integration, const se3di_motion *motion)
{
    const double tolerance = integration->settings.tolerance;
    const int is_loose = tolerance > SE3DI_EXPLICIT_LOOSE &&
                         integration->method->tag == SE3D_METHOD_DOP853 &&
                         motion->can_wait(integration->equations);
    const double more = is_loose ? sqrt(tolerance / SE3DI_EXPLICIT_LOOSE) : 1.0;
    return fmax(SE3DI_EXPLICIT_PART * more * tolerance, SE3DI_EXPLICIT_LEAST);
}

/* See se3di_state_begin. The tightest tolerances need accelerations with less noise near singular
 * positions; elsewhere a wider filter costs steps and accuracy. */
static double regularisation(double tolerance)
{
    return fmin(1e-9, fmax(1e-10, 1e-10 * (1e-11 / tolerance)));
}

/* The violation of constraints that does not matter: near a singular position velocities magnify it
 * by the inverse of the distance, accelerations by its cube. */
static double projection_accuracy(double tolerance)
{
    return fmin(1e-13, fmax(1e-15, 1e-6 * tolerance));
}

static se3di_explicit_past *past_of(const se3di_model *model)
{
    return (se3di_explicit_past *)(void *)model->history;
}

/* The parts of history and work. */
static se3di_explicit point(const se3di_integration *integration)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_motion *motion = se3di_motion_find(integration->equations);
    const size_t count = motion->count(integration->equations);
    const size_t memories = SE3DI_FORCE_STATES * assembly->model->force_slots.count;
    double *history = assembly->model->history;
    double *memory = integration->work + (SE3DI_EXPLICIT_ROWS + 3) * count;
    return (se3di_explicit){
        .methods = integration->method->explicit_class,
        .tableau = integration->method->tableau,
        .motion = motion,
        .equations = integration->equations,
        .assembly = assembly,
        .count = count,
        .past = past_of(assembly->model),
        .y1 = history + PAST,
        .f1 = history + PAST + count,
        .y0 = history + PAST + 2 * count,
        .forms = history + PAST + 3 * count,
        .K = integration->work,
        .y = integration->work + SE3DI_EXPLICIT_ROWS * count,
        .sum = integration->work + (SE3DI_EXPLICIT_ROWS + 1) * count,
        .sum3 = integration->work + (SE3DI_EXPLICIT_ROWS + 2) * count,
        .memory = memory,
        .bodies = {memory + memories, memory + memories + se3di_state_count(assembly)},
        .tolerance = inner_tolerance(integration, motion),
    };
}

static se3di_explicit begin(se3di_integration *integration)
{
    se3di_explicit m = point(integration);
    m.step.integration = integration;
    se3di_contacts_begin(m.assembly->model, 0.0, 1.0, 0);
    m.kkt =
        se3di_state_begin(m.equations, regularisation(m.tolerance), fmin(1e-6, 1e-3 * m.tolerance));
    return m;
}

/* y'_1 as the bodies see it; y_1 was set last. */
static const double *get_rates(const se3di_explicit *m)
{
    return m->motion->get_rates(m->equations, m->f1, m->bodies[0]);
}

/* Squares of the accelerations that a force and a torque (their squares) on a body would make. */
static void grow_sums(const se3di_body *body, double force, double torque, double sums[2])
{
    const double J = fmax(body->J[0], fmax(body->J[1], body->J[2]));
    if (!body->fixed && body->state == 0) {
        sums[0] = fmax(sums[0], force / (body->mass * body->mass));
        sums[1] = fmax(sums[1], torque / (J * J));
    }
}

/* A contact's force is its stiffness times a difference of positions. */
static void grow_by_contact(const se3di_model *model, const se3di_body_contact *contact,
                            double sums[2])
{
    const uint32_t shapes[2] = {contact->shape_i, contact->shape_j};
    const double overlap = contact->overlap;
    const double stiffness =
        overlap > 0.0 ? se3di_dot(contact->force, contact->force) / (overlap * overlap) : 0.0;
    for (int k = 0; k < 2; ++k) {
        const uint32_t body = model->shapes[shapes[k]].body;
        double arm[3];
        se3di_sub(contact->point, model->frames[body].r, arm);
        const double size = se3di_dot(arm, arm);
        const double force = 2.0 * stiffness * (se3di_dot(contact->point, contact->point) + size);
        grow_sums(&model->bodies[body], force, force * size, sums);
    }
}

/* What is at rest as its forces balance is moved by the rounding of their sums: the accelerations
 * that these are parts of. */
static void grow_balance(se3di_explicit *m)
{
    const se3di_model *model = m->assembly->model;
    const double length = m->past->scale.length;
    double sums[2] = {se3di_dot(model->gravity, model->gravity), 0.0};
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        const size_t body = m->assembly->free_body[k];
        const double *wrench = m->assembly->wrench + 6 * body;
        const double force = se3di_dot(wrench, wrench);
        grow_sums(&model->bodies[body], force,
                  se3di_dot(wrench + 3, wrench + 3) + force * length * length, sums);
    }
    for (size_t k = 0; k < model->contacts.count; ++k) {
        grow_by_contact(model, &model->contacts.list[k], sums);
    }
    for (int c = 0; c < 2; ++c) {
        m->past->balance[c] = fmax(0.95 * m->past->balance[c], sqrt(sums[c]));
    }
}

static void grow_scale(se3di_explicit *m)
{
    se3di_state_scale *scale = &m->past->scale;
    se3di_state_scale_grow(m->assembly, get_rates(m), scale);
    scale->energy = fmax(scale->energy, m->past->energy_least);
    grow_balance(m);
}

typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));

#define PAIRS 4 /* stay in registers */

void se3di_explicit_combine(const se3di_explicit *m, const double *rows, const double *base,
                            double h, const double *coefficients, int limit, double *out)
{
    const double *stage[SE3DI_EXPLICIT_ROWS];
    double factor[SE3DI_EXPLICIT_ROWS];
    int used = 0;
    for (int k = 0; k < limit; ++k) {
        if (coefficients[k] != 0.0) {
            stage[used] = rows + (size_t)k * m->count;
            factor[used++] = h * coefficients[k];
        }
    }
    size_t c = 0;
    for (; c + 2 * PAIRS <= m->count; c += 2 * PAIRS) {
        pair sum[PAIRS] = {{0.0, 0.0}};
        if (base) {
            memcpy(sum, base + c, sizeof sum);
        }
        for (int k = 0; k < used; ++k) {
            const pair *part = (const pair *)(const void *)(stage[k] + c);
            const pair f = {factor[k], factor[k]};
            sum[0] += f * part[0];
            sum[1] += f * part[1];
            sum[2] += f * part[2];
            sum[3] += f * part[3];
        }
        memcpy(out + c, sum, sizeof sum);
    }
    for (; c < m->count; ++c) {
        double sum = base ? base[c] : 0.0;
        for (int k = 0; k < used; ++k) {
            sum += factor[k] * stage[k][c];
        }
        out[c] = sum;
    }
}

/* Derivative at the state that was set last. */
static se3d_status evaluate(se3di_explicit *m, double t, double *derivative)
{
    return m->motion->evaluate(m->equations, t, derivative);
}

se3d_status se3di_explicit_evaluate(se3di_explicit *m, double t, const double *y,
                                    double *derivative)
{
    return m->motion->evaluate_at(m->equations, t, y, derivative);
}

/* What the velocities of the step that is tried are measured by: not below what rounding makes of
 * forces that balance. */
static se3di_state_scale measure_by(const se3di_explicit *m)
{
    const double part = BALANCE / m->tolerance * m->h;
    se3di_state_scale scale = m->past->scale;
    scale.speed = fmax(scale.speed, part * m->past->balance[0]);
    scale.spin = fmax(scale.spin, part * m->past->balance[1]);
    return scale;
}

double se3di_explicit_size_of(const se3di_explicit *m, const double parts[4],
                              const double work[SE3DI_STATE_WORK])
{
    const se3di_state_scale scale = measure_by(m);
    const double least = ROUNDING / m->tolerance;
    const double speed = fmax(scale.speed, least * scale.spin * scale.length);
    const double spin = fmax(scale.spin, least * scale.speed / scale.length);
    const double r = sqrt(parts[0]) / scale.length + 2.0 * sqrt(parts[1]);
    const double v = sqrt(parts[2]) / speed + sqrt(parts[3]) / spin;
    const double e = se3di_norm(work) / scale.energy;
    return r + v + WORK_WEIGHT * e;
}

double se3di_explicit_size(const se3di_explicit *m, const double *error)
{
    double most[4] = {0.0, 0.0, 0.0, 0.0}, z = 0.0;
    const double *end = m->motion->spread(m->equations, error, m->bodies[0]);
    for (size_t k = 0; k < m->assembly->body_count; ++k, end += SE3DI_STATE_SIZE) {
        const double *e = end;
        if (se3di_state_is_carrier(m->assembly, k)) {
            const double part = se3di_state_part(m->assembly, k, &m->past->scale, e + 7);
            z = se3di_larger(z, part);
            continue;
        }
        double turn = e[3] * e[3] + e[4] * e[4] + e[5] * e[5] + e[6] * e[6];
        double parts[4] = {se3di_dot(e, e), turn, se3di_dot(e + 7, e + 7),
                           se3di_dot(e + 10, e + 10)};
        for (int c = 0; c < 4; ++c) {
            most[c] = se3di_larger(most[c], parts[c]);
        }
    }
    return se3di_explicit_size_of(m, most, end) + z;
}

double se3di_explicit_measure(const se3di_explicit *m, const double *error)
{
    return se3di_explicit_size(m, error) / m->tolerance;
}

double *se3di_explicit_end(const se3di_explicit *m)
{
    return m->K + (size_t)m->methods->get_end(m) * m->count;
}

/* The factorisation of the last evaluation, which was here or near, serves. */
static se3d_status project(se3di_explicit *m, double t)
{
    return m->motion->project(m->equations, t, &m->past->scale, projection_accuracy(m->tolerance),
                              1);
}

static int is_too_large(const se3di_explicit *m, double error)
{
    return !(error <= 1.0) && isfinite(m->tolerance);
}

/* The frames at the end, before the projection. */
static void arrive(se3di_explicit *m, double h)
{
    m->methods->arrive(m, h);
    m->motion->set(m->equations, m->y);
}

/* Stages, error, projection. The derivative at the end is that before the projection, which moves
 * the state by its error: the order is the same. *error is infinite if the step cannot be made
 * at all. */
static se3d_status attempt(se3di_explicit *m, double h, double *error)
{
    const double t = m->past->at.time + h;
    double of_stages = 0.0;
    *error = HUGE_VAL;
    m->h = h;
    m->step.fraction = 0.0;
    SE3DI_TRY(m->methods->make_stages(m, h, &of_stages));
    *error = of_stages;
    if (is_too_large(m, *error)) {
        return SE3D_OK;
    }
    arrive(m, h);
    SE3DI_TRY(evaluate(m, t, se3di_explicit_end(m)));
    *error = m->methods->estimate_end(m, h, of_stages);
    if (is_too_large(m, *error)) {
        return SE3D_OK;
    }
    SE3DI_TRY(project(m, t));
    /* near a singular position (more rows are dependent than have been all along) accelerations at
     * a state that violates the constraints are others */
    const double dependent = m->motion->count_dependent(m->equations);
    return dependent > m->past->redundant ? evaluate(m, t, se3di_explicit_end(m)) : SE3D_OK;
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
    m->has_stages = 1;
    const size_t work = m->count - SE3DI_STATE_WORK;
    m->motion->keep(m->equations, m->y1);
    memcpy(m->y1 + work, m->y + work, SE3DI_STATE_WORK * sizeof *m->y);
    if (!m->waits) {
        memcpy(m->f1, m->next, m->count * sizeof *m->f1);
    }
    m->past->unscaled = m->leaves_scale;
    if (!m->leaves_scale) {
        grow_scale(m);
    }
    double dependent = m->motion->count_dependent(m->equations);
    m->past->redundant = fmin(m->past->redundant, dependent);
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
    const se3di_state_scale scale = measure_by(m);
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
    m->next = end.has_changed ? m->sum : m->next;
    return end.has_changed ? m->motion->derive(m->equations, t, m->equations->l, m->next) : SE3D_OK;
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
    m->motion->keep(m->equations, end);
    se3di_equations_save(m->equations);
    for (size_t k = 0; k < m->count; ++k) {
        m->sum3[k] = 0.5 * (m->y1[k] + m->y[k]) + 0.125 * h * (f0[k] - f[k]);
    }
    m->motion->set(m->equations, m->sum3);
    const se3di_state_scale scale = measure_by(m);
    const se3d_status status =
        se3di_memory_review_contacts(m->equations, m->past->at.time + 0.5 * h, m->past->at.time + h,
                                     h, m->tolerance, &scale, &of_contacts);
    m->motion->stand(m->equations, end);
    *error = se3di_larger(*error, of_contacts);
    m->step.fraction = of_contacts > 1.0 ? se3di_memory_get_fraction(of_contacts) : 0.0;
    return status;
}

/* All that may fail before the state is accepted; *error as from settle_memory. */
static se3d_status prepare(se3di_explicit *m, double h, double *error)
{
    se3di_model *model = m->assembly->model;
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

/* If the accelerations jump, as under a driver or a load that is switched, no step is short
 * enough for a tight tolerance. One of the least length crosses the jump; what it makes of error is
 * the jump times h. If no ordinary step follows, it was no jump. */
static se3d_status cross_jump(se3di_explicit *m, double h, double error)
{
    const double t = m->past->at.time + h, tolerance = m->tolerance;
    if (!(error * tolerance < 1e-3) || m->past->forced >= FORCED_MAX) {
        return fail_small(m, h);
    }
    m->tolerance = HUGE_VAL; /* no error control */
    se3d_status status = attempt(m, h, &error);
    status = status < 0 ? status : prepare(m, h, &error);
    m->tolerance = tolerance;
    SE3DI_TRY(status);
    if (!(error <= 1.0)) { /* nor is what it leads to a number */
        return fail_small(m, h);
    }
    accept(m, t);
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
        const size_t body = assembly->free_body[k];
        largest = fmax(largest, se3di_norm(assembly->model->acceleration + 6 * body + 3));
    }
    return 2.0 * largest;
}

int se3di_explicit_is_held(const se3di_integration *integration)
{
    return past_of(integration->equations->assembly.model)->held >= SE3DI_HELD_MIN;
}

void se3di_explicit_count_sign(se3di_explicit *m, int is_held)
{
    double *held = &m->past->held, *free = &m->past->free;
    if (is_held) {
        *held += 1.0;
        *free = 0.0;
    } else if (*held > 0.0) {
        *free += 1.0;
        *held = *free < SE3DI_FREE_MIN ? *held : 0.0;
        *free = *free < SE3DI_FREE_MIN ? *free : 0.0;
    }
}

/* The run is to end at the forward state. */
static int must_leave(const se3di_explicit *m)
{
    return m->step.integration->settings.leaves_stiff && m->past->held >= SE3DI_HELD_MIN;
}

/* ---- in the loop of all methods ---- */

static se3di_explicit *get_explicit(se3di_adaptive *step)
{
    return (se3di_explicit *)(void *)step;
}

static double pace(se3di_adaptive *step, double h)
{
    const se3di_explicit *m = get_explicit(step);
    h = se3di_state_limit_turn(m->assembly->model, largest_growth(m), h);
    return se3di_contacts_pace(m->assembly->model, SE3DI_PACE_ADAPTIVE, h);
}

static se3d_status try_step(se3di_adaptive *step, double h, double *error)
{
    SE3DI_TRY(attempt(get_explicit(step), h, error));
    return *error <= 1.0 ? prepare(get_explicit(step), h, error) : SE3D_OK;
}

/* The step h has met the tolerance: what follows for the next ones. */
static se3d_status take(se3di_adaptive *step, double h, double error)
{
    se3di_explicit *m = get_explicit(step);
    const double least = LEAST_STEP * fmax(1e-3, fabs(step->t));
    accept(m, step->t);
    if (step->integration->settings.leaves_stiff || m->methods->is_watched) {
        m->methods->watch_stability(m, h);
    }
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
    SE3DI_TRY(evaluate(m, m->past->at.time, m->sum));
    grow_scale(m);
    m->past->unscaled = 0.0;
    return SE3D_OK;
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
    m->motion->set(m->equations, m->y1);
    SE3DI_TRY(m->past->unscaled > 0.0 ? catch_up(m) : SE3D_OK);
    se3di_state_set_rates(m->assembly, get_rates(m));
    se3di_angles_accept(model); /* turns count from step to step, not from an output */
    return se3di_adaptive_advance(&m->step, t_end);
}

/* The forward state is the model's own; its derivative remains to be found. `stands`: y_1 is it. */
static void take_state(se3di_explicit *m, int stands)
{
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
    grow_scale(m);
    return SE3D_OK;
}

/* Accelerations and multipliers of the state that was set last are the model's: by the evaluation
 * that finds all of them, where there is one. */
static se3d_status find_all(se3di_explicit *m, double t)
{
    if (m->motion->may_report(m->equations)) {
        SE3DI_TRY(evaluate(m, t, m->sum));
        if (m->motion->report(m->equations)) {
            return SE3D_OK;
        }
    }
    return se3di_acceleration_solve(m->equations, t);
}

/* The model's state is y, at t. */
static se3d_status show(se3di_explicit *m, const double *y, double t, int project)
{
    const se3di_integration *integration = m->step.integration;
    const double *work = y + m->count - SE3DI_STATE_WORK;
    const double rough = se3di_state_rough(m->assembly->model, integration->shows_motion,
                                           integration->settings.tolerance);
    m->motion->set(m->equations, y);
    if (project) {
        SE3DI_TRY(m->motion->project(m->equations, t, &m->past->scale, fmax(1e-15, rough), 0));
    }
    if (rough > 0.0) {
        return se3di_state_conclude_motion(m->equations, work, t);
    }
    SE3DI_TRY(find_all(m, t));
    se3di_contacts_renew_forces(m->assembly->model);
    return se3di_state_conclude(m->equations, work, t);
}

/* The model's state is that at an end of the last step. */
static se3d_status publish(se3di_explicit *m, int at_end)
{
    const double t = at_end ? m->past->at.time : m->past->at.begin;
    se3di_forces_show(m->assembly->model, !at_end);
    return show(m, at_end ? m->y1 : m->y0, t, 0);
}

/* Hairer, Norsett, Wanner 1993, sec. II.4: from the derivative and its change over a small step. */
static se3d_status choose_first(se3di_explicit *m, double *first)
{
    double d1 = se3di_explicit_measure(m, m->f1);
    double limit = m->step.integration->settings.step;
    double h0 = 0.01 / (fmax(d1 * m->tolerance, 1e-5));
    h0 = limit > 0.0 ? fmin(h0, limit) : h0;
    se3di_error ignored = {0};
    se3di_error *error = m->equations->error;
    m->equations->error = &ignored;
    for (size_t k = 0; k < m->count; ++k) {
        m->y[k] = m->y1[k] + h0 * m->f1[k];
    }
    m->motion->set(m->equations, m->y);
    double d2 = 0.0;
    const se3d_status status = evaluate(m, m->past->at.time + h0, m->K);
    if (status >= 0) {
        for (size_t k = 0; k < m->count; ++k) {
            m->K[k] -= m->f1[k];
        }
        d2 = se3di_explicit_measure(m, m->K) / h0;
    }
    m->motion->set(m->equations, m->y1);
    m->equations->error = error;
    if (status == SE3D_ERR_CALLBACK) {
        return se3di_error_set(error, status, "%s", ignored.message);
    }
    double d = fmax(d1 * m->tolerance, 1e-3 / h0);
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
    se3di_explicit m = begin(integration);
    memset(m.past, 0, sizeof *m.past);
    memset(m.y0, 0, (SE3DI_EXPLICIT_FORMS + 1) * m.count * sizeof *m.y0);
    m.past->scale.length = se3di_state_length(m.assembly->model);
    m.past->at.error = 1e-2;
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
    SE3DI_TRY(evaluate(m, model->time, m->f1));
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
    se3di_explicit m = begin(integration);
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

/* The state at the end, projected, with the accelerations and multipliers that the model shows, and
 * the derivative that they are. */
static se3d_status solve_end(se3di_explicit *m, double t)
{
    SE3DI_TRY(project(m, t));
    if (m->motion->may_report(m->equations)) {
        SE3DI_TRY(evaluate(m, t, se3di_explicit_end(m)));
        if (m->motion->report(m->equations)) {
            return SE3D_OK;
        }
    }
    se3di_state_end(m->equations, &m->kkt);
    SE3DI_TRY(se3di_acceleration_solve(m->equations, t));
    return m->motion->derive(m->equations, t, m->assembly->model->lambda, se3di_explicit_end(m));
}

/* The same by an evaluation that finds all. */
static se3d_status evaluate_end(se3di_explicit *m, double t)
{
    SE3DI_TRY(evaluate(m, t, se3di_explicit_end(m)));
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
    se3di_explicit m = point(integration);
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
    const se3di_explicit m = point(integration);
    m.motion->keep_efforts(m.equations);
    se3di_pending_drop(m.assembly->model->pending);
}

void se3di_explicit_come_back(se3di_integration *integration)
{
    const se3di_explicit m = point(integration);
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
    *reported = reports_end(m);
    arrive(m, h);
    m->leaves_scale = *reported && m->motion->finds_all(m->equations);
    m->waits = m->leaves_scale && waits_for_readers(m) && is_moderate(m->y, m->count);
    if (m->waits) {
        m->next = se3di_explicit_end(m);
    } else if (*reported) {
        SE3DI_TRY(m->motion->finds_all(m->equations) ? evaluate_end(m, t) : solve_end(m, t));
    } else {
        SE3DI_TRY(evaluate(m, t, se3di_explicit_end(m)));
        SE3DI_TRY(project(m, t));
    }
    SE3DI_TRY(prepare(m, h, &error));
    accept(m, t);
    return SE3D_OK;
}

se3d_status se3di_explicit_step(se3di_integration *integration, double h)
{
    se3di_explicit m = begin(integration);
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
    se3di_explicit m = begin(integration);
    se3d_status status = advance(&m, t_end);
    status = status < 0 || integration->at_kink ? status : m.methods->build_dense(&m);
    se3di_state_end(m.equations, &m.kkt);
    return status;
}

void se3di_explicit_interpolate(const se3di_integration *integration, double t, double *y)
{
    const se3di_explicit m = point(integration);
    const int is_within = t < m.past->at.time;
    if (is_within) {
        m.methods->interpolate(&m, t, m.y);
    }
    m.motion->show(m.equations, is_within ? m.y : m.y1, y);
}

/* What the interpolation of the last step violates constraints by, at the quarters of the step: a
 * part of the history, so that what is shown does not depend on what was shown before. */
static se3d_status measure_gap(se3di_explicit *m)
{
    const double begin = m->past->at.begin, h = m->past->at.time - begin;
    double worst = 0.0;
    for (int k = 1; k < 4; ++k) {
        const double t = begin + 0.25 * k * h;
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
static se3d_status needs_projection(se3di_explicit *m, int *needed)
{
    const se3di_integration *integration = m->step.integration;
    const double rough = se3di_state_rough(m->assembly->model, integration->shows_motion,
                                           integration->settings.tolerance);
    *needed = 1;
    if (!(rough > 0.0)) {
        return SE3D_OK;
    }
    SE3DI_TRY(m->past->gap < 0.0 ? measure_gap(m) : SE3D_OK);
    *needed = !(m->past->gap <= GAP_PART * rough);
    return SE3D_OK;
}

se3d_status se3di_explicit_run(se3di_integration *integration, double t_end)
{
    se3di_explicit m = begin(integration);
    const int at_begin = !(t_end > m.past->at.begin);
    se3d_status status = at_begin ? SE3D_OK : advance_to(&m, t_end);
    se3di_state_end(m.equations, &m.kkt);
    SE3DI_TRY(status);
    if (at_begin || m.past->at.time <= t_end) { /* earlier if it leaves a stiff motion */
        return publish(&m, m.past->at.time <= t_end);
    }
    int needs;
    se3di_forces_show(m.assembly->model, 1);
    SE3DI_TRY(needs_projection(&m, &needs));
    m.methods->interpolate(&m, t_end, m.y);
    return show(&m, m.y, t_end, needs);
}

static int is_count(double value)
{
    return value >= 0.0 && value <= INT32_MAX && value == floor(value);
}

int se3di_explicit_is_sound(const double *history, size_t count)
{
    const se3di_explicit_past *past = (const se3di_explicit_past *)history;
    return count >= PAST && is_count(past->redundant) && is_count(past->stages);
}
