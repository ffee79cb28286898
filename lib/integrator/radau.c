/* SPDX-License-Identifier: BSD-3-Clause */
/* radau: Radau IIA with three stages, order 5, L-stable, for stiff motions that are wanted
 * accurately. The equations are of index 2, stabilised (Gear, Gupta, Leimkuhler 1985):
 *
 *     qdot = T(q) (v + M^-1 Phi_q^T mu),   M vdot + Phi_q^T lambda = Q + velocity terms,
 *     Phi(q, t) = 0,   Phi_q v = nu(t)
 *
 * so that every stage, and with the last one the end of the step, fulfils both levels of the
 * constraints. The step is controlled by an embedded formula of order 3 whose error is filtered by
 * the Newton matrix (Hairer, Wanner 1996, sec. IV.8). Outputs are interpolated by the quartic that
 * has the derivatives of the stages and of the start of the step.  docs/theory/radau.md */
#include "integrator/radau.h"
#include "integrator/adaptive.h"
#include "integrator/crowd_watch.h"
#include "integrator/memory.h"
#include "integrator/radau_easy.h"

#include "assembly/energy.h"
#include "contact/bodies/pace.h"
#include "force/force.h"
#include "force/friction.h"
#include "math/elementary.h"
#include "math/larger.h"
#include "math/over.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define STAGES SE3DI_RADAU_STAGES
#define REACH  1e-13 /* smallest tolerance of a run */

/* The same where rows are redundant: at singular positions nearer stages are noise. */
#define REACH_REDUNDANT 1e-10

#define WORK_WEIGHT 0.1 /* of the error of works: it disturbs nothing but the audit of energy */

#define WAY_ROUNDING 4e-15 /* of a position, in the ways of all stages */

/* Of the tolerance: the estimate at the kink of a force, where the result is no better than it. */
#define AT_KINK 0.3

#define PATIENCE 1024.0 /* steps, shorter on the average than */
#define BRIEF    2e-5   /* s for each body that touches: some three times as long as they compute */

#define UNTRUSTED 0.7 /* of a step whose iteration did not converge: from there on they are tried */
#define TRUST     1.02 /* again, longer and longer with every step */

/* The history: this header, the accepted state, then of the last step: its start, the increments of
 * the stages, d = h f_0 - h u'(0). */
typedef struct radau_header {
    se3di_adaptive_history at;
    se3di_state_scale scale;
    double last; /* the last step [s], 0: none */
    se3di_fastness fast;
    double
        trusted;  /* the longest step in which the iteration is expected to converge [s], 0: any */
    double since; /* steps since one did not */
    se3di_crowd_watch watch;
    double leaves; /* 1: to be left for what touches */
    se3di_radau_ease ease;
} radau_header;

#define RADAU_HEADER (sizeof(radau_header) / sizeof(double))
_Static_assert(sizeof(radau_header) == 24 * sizeof(double),
               "it is an array of double in the model");

typedef struct history {
    radau_header *header;
    double *y1, *start, *Z, *d;
} history;

static size_t history_count(const se3di_assembly *assembly)
{
    return RADAU_HEADER + (3 + STAGES) * se3di_state_count(assembly);
}

static history get_history(const se3di_assembly *assembly)
{
    size_t count = se3di_state_count(assembly);
    double *numbers = assembly->model->history;
    history past = {.header = (radau_header *)(void *)numbers};
    past.y1 = numbers + RADAU_HEADER;
    past.start = past.y1 + count;
    past.Z = past.start + count;
    past.d = past.Z + STAGES * count;
    return past;
}

static double get_reach(const se3di_integration *integration, const se3di_model *model)
{
    (void)model;
    const int is_redundant = integration->equations && integration->equations->redundant;
    return is_redundant ? REACH_REDUNDANT : REACH;
}

/* The estimate is of order 3, the result of order 5 (Hairer, Wanner 1996, sec. IV.8). */
static double inner_tolerance(const se3di_integration *integration)
{
    const se3di_model *model = integration->equations->assembly.model;
    return 0.34 * se3di_pow(se3di_integration_get_tolerance(integration, model), 0.8);
}

/* The iteration stops if it does not show in the result. If stages are projected it
 * converges faster, and its rate tells better what is missing. */
static double iteration_tolerance(const se3di_radau *m, double inner)
{
    return inner * fmin(0.03, (m->projects ? 10.0 : 0.3) * sqrt(inner));
}

/* l_j(s): the polynomial of degree 3 that is 1 at node j and 0 at the others and at 0. */
static void eval_basis(double s, double l[STAGES])
{
    for (int j = 0; j < STAGES; ++j) {
        l[j] = s / se3di_radau_c[j];
        for (int k = 0; k < STAGES; ++k) {
            l[j] *= k == j ? 1.0 : (s - se3di_radau_c[k]) / (se3di_radau_c[j] - se3di_radau_c[k]);
        }
    }
}

/* The integral of (x - c_1)(x - c_2)(x - 1) from 0 to s over its integrand at 0: degree 4, its
 * derivative is 1 at 0 and 0 at the nodes. */
static double eval_quartic(double s)
{
    const double *c = se3di_radau_c;
    const double e1 = c[0] + c[1] + 1.0;
    const double e2 = c[0] * c[1] + c[0] + c[1];
    const double e3 = c[0] * c[1];
    return -s * (s * (s * (0.25 * s - e1 / 3.0) + 0.5 * e2) - e3) / e3;
}

static void eval_polynomial(const history *past, size_t count, double t, double *y)
{
    double l[STAGES];
    const double s = (t - past->header->at.time) / past->header->last + 1.0;
    const double quartic = eval_quartic(s);
    eval_basis(s, l);
    for (size_t k = 0; k < count; ++k) {
        y[k] = past->start[k] + l[0] * past->Z[k] + l[1] * past->Z[count + k] +
               l[2] * past->Z[2 * count + k] + quartic * past->d[k];
    }
}

/* Velocities of the stages by the polynomial of the last step, or constant accelerations;
 * multipliers those of the start: extrapolated, they would grow in dependent directions. */
static void predict(se3di_radau *m, const history *past)
{
    const double last = past->header->last;
    const size_t count = m->count;
    const double *c = se3di_radau_c;
    for (int i = 0; i < STAGES; ++i) {
        double *y = m->Y + (size_t)i * count;
        double *lambda = m->lambda + (size_t)i * m->assembly->row_count;
        double l[STAGES];
        const double s = 1.0 + c[i] * m->h / (last > 0.0 ? last : m->h);
        eval_basis(s, l);
        for (size_t k = 0; k < count; ++k) {
            y[k] = last > 0.0 ? m->y0[k] + l[0] * past->Z[k] + l[1] * past->Z[count + k] +
                                    (l[2] - 1.0) * past->Z[2 * count + k]
                              : m->y0[k] + c[i] * m->h * m->f0[k];
        }
        if (m->assembly->row_count > 0) {
            memcpy(lambda, m->lambda0, m->assembly->row_count * sizeof *lambda);
        }
    }
}

/* l_j'(0) */
static const double start_rates[STAGES] = {10.048809399827415562, -1.3821427331607488957,
                                           0.33333333333333333333};

/* d = h f_0 - h u'(0) of the solved stages. */
static void set_defect(const se3di_radau *m, double *d)
{
    const size_t count = m->count;
    for (size_t k = 0; k < count; ++k) {
        d[k] = m->h * m->f0[k];
        for (size_t i = 0; i < STAGES; ++i) {
            d[k] -= start_rates[i] * (m->Y[i * count + k] - m->y0[k]);
        }
    }
}

/* The state of a solved stage, with its multipliers. Those of inner stages are of a lower order
 * than the motion: if they load friction, better ones follow from the state. */
static se3d_status set_stage(se3di_radau *m, int i)
{
    se3di_equations *equations = m->equations;
    const size_t rows = m->assembly->row_count;
    const double *lambda = m->lambda + (size_t)i * rows;
    se3di_state_set(m->assembly, m->Y + (size_t)i * m->count);
    if (equations->friction.count > 0) {
        const double t = m->t + se3di_radau_c[i] * m->h;
        if (m->projects) {
            SE3DI_TRY(se3di_state_project(equations, t, &m->scale, m->accuracy, 0));
        }
        SE3DI_TRY(se3di_state_evaluate(equations, t));
        lambda = equations->l;
    }
    if (rows > 0) {
        memcpy(m->assembly->model->lambda, lambda, rows * sizeof *lambda);
    }
    return SE3D_OK;
}

/* With the accelerations m->vdot. */
static se3di_relaxation get_relaxation(const se3di_radau *m, double t)
{
    return (se3di_relaxation){.t = t,
                              .c = se3di_radau_gamma * m->h,
                              .fast = se3di_relax_trust(m->equations, m->fast),
                              .vdot = m->vdot,
                              .work = m->relaxation};
}

/* The work done, as a part of the states of the stages. */
static se3d_status add_work(se3di_radau *m)
{
    se3di_model *model = m->assembly->model;
    const size_t place = m->count - SE3DI_STATE_WORK;
    double power[STAGES][SE3DI_STATE_WORK];
    for (int i = 0; i < STAGES; ++i) {
        SE3DI_TRY(set_stage(m, i));
        SE3DI_TRY(se3di_loads_power(model, m->t + se3di_radau_c[i] * m->h, power[i]));
    }
    for (int i = 0; i < STAGES; ++i) {
        for (size_t k = 0; k < SE3DI_STATE_WORK; ++k) {
            double *work = m->Y + (size_t)i * m->count + place + k;
            *work = m->y0[place + k];
            for (int j = 0; j < STAGES; ++j) {
                *work += m->h * se3di_radau_a[i][j] * power[j][k];
            }
        }
    }
    return SE3D_OK;
}

/* The rounding of positions times the force that the works of the step make with the way of its
 * bodies: where they are at rest under load that is all. */
static double work_noise(const se3di_radau *m)
{
    double way = 0.0, work[SE3DI_STATE_WORK];
    const double *end = m->Y + (STAGES - 1) * m->count;
    const size_t place = m->count - SE3DI_STATE_WORK;
    for (size_t k = 0; k + SE3DI_STATE_SIZE <= place; k += SE3DI_STATE_SIZE) {
        way = fmax(way, se3di_norm(end + k + 7) + se3di_norm(end + k + 10) * m->scale.length);
    }
    for (size_t k = 0; k < SE3DI_STATE_WORK; ++k) {
        work[k] = end[place + k] - m->y0[place + k];
    }
    way *= m->h;
    return way > 0.0 ? se3di_norm(work) * WAY_ROUNDING * m->scale.length / way : 0.0;
}

/* The error of the works in a solved step, by the same formula as that of the motion: where drivers
 * prescribe all of that it is the only one. */
static double measure_work(const se3di_radau *m)
{
    double d[SE3DI_STATE_WORK];
    const size_t place = m->count - SE3DI_STATE_WORK;
    for (size_t k = 0; k < SE3DI_STATE_WORK; ++k) {
        d[k] = m->h * m->f0[place + k];
        for (size_t i = 0; i < STAGES; ++i) {
            d[k] -= start_rates[i] * (m->Y[i * m->count + place + k] - m->y0[place + k]);
        }
    }
    const double error = se3di_norm(d);
    return error <= work_noise(m) ? 0.0 : WORK_WEIGHT * se3di_radau_gamma * error / m->scale.energy;
}

/* The step is not taken: what force elements remembered before. */
static void forget(const se3di_radau *m)
{
    se3di_model_restore_memory(m->assembly->model, m->integration->newton.memory);
}

/* *error is raised to what contacts would forget of the step, whose end the frames are at: the
 * second stage lies within it. */
static se3d_status review_contacts(se3di_radau *m, double tolerance, double *error)
{
    double of_contacts = 0.0;
    if (m->assembly->model->contacts.pair_count == 0 || !(m->inner > 0.0)) {
        return SE3D_OK;
    }
    const se3di_memory_step step = {.t = m->t + m->h,
                                    .h = m->h,
                                    .tolerance = SE3DI_MEMORY_PART * tolerance,
                                    .begin = m->y0,
                                    .scale = &m->scale};
    se3di_equations_save(m->equations);
    se3di_state_set(m->assembly, m->Y + m->count);
    SE3DI_TRY(se3di_memory_review_contacts(m->equations, &step, m->t + se3di_radau_c[1] * m->h,
                                           &of_contacts));
    *error = se3di_larger(*error, of_contacts);
    m->fraction = of_contacts > 1.0 ? se3di_memory_get_fraction(of_contacts) : 0.0;
    return SE3D_OK;
}

/* The step is solved: its work, and what friction remembers of its end. *error is raised to what
 * that changes, relative to `tolerance`; if it is too much, nothing is remembered. */
static se3d_status settle(se3di_radau *m, double tolerance, double *error)
{
    se3di_memory_end end;
    SE3DI_TRY(add_work(m)); /* ends at the last stage */
    if (m->inner > 0.0) {
        *error = se3di_larger(*error, measure_work(m) / m->inner);
        if (!(*error <= 1.0)) {
            return SE3D_OK;
        }
    }
    if (m->inner > 0.0 && se3di_memory_meets_stop(m->assembly->model)) {
        *error *= fmax(1.0, m->inner / (AT_KINK * tolerance));
    }
    SE3DI_TRY(*error <= 1.0 ? review_contacts(m, tolerance, error) : SE3D_OK);
    if (!(*error <= 1.0)) {
        return SE3D_OK;
    }
    const se3di_memory_step step = {.t = m->t + m->h,
                                    .h = m->h,
                                    .tolerance = tolerance,
                                    .begin = m->y0,
                                    .lambda = m->assembly->model->lambda,
                                    .scale = &m->scale,
                                    .memory = m->integration->newton.memory,
                                    .work = m->vdot};
    SE3DI_TRY(se3di_memory_settle(m->equations, &step, &end));
    *error = se3di_larger(*error, end.error);
    m->fraction = end.fraction;
    m->has_changed = end.has_changed;
    if (!(*error <= 1.0)) {
        forget(m);
    }
    return SE3D_OK;
}

/* The end has moved by what it violated the rows by. */
static void follow_end(se3di_model *model)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_FRICTION) {
            se3di_friction_shift(model, &model->forces[k]);
        }
    }
}

static se3d_status project_end(se3di_radau *m)
{
    const double accuracy = m->projects ? 1e-15 : 1e-13; /* accelerations magnify it */
    SE3DI_TRY(se3di_state_project(m->equations, m->t + m->h, &m->scale, accuracy, 0));
    if (!m->has_changed) { /* else accelerations jump: that is no force out of balance */
        se3di_radau_get_acceleration(m, STAGES - 1, m->vdot);
        const se3di_relaxation relaxation = get_relaxation(m, m->t + m->h);
        SE3DI_TRY(se3di_relax(m->integration, &relaxation));
    }
    return se3di_state_prepare(m->equations, m->t + m->h);
}

/* The step is solved and settled: project its end to rounding, and take it as that of t. */
static se3d_status accept(se3di_radau *m, const history *past, double t)
{
    se3di_model *model = m->assembly->model;
    const size_t bodies = m->count - SE3DI_STATE_WORK;
    const double *end = m->Y + (STAGES - 1) * m->count;
    const se3d_status status = project_end(m);
    if (status < 0) {
        forget(m);
        return status;
    }
    follow_end(model);
    memcpy(past->start, m->y0, m->count * sizeof *m->y0);
    set_defect(m, past->d);
    if (m->is_stiff) { /* but for the works */
        memcpy(past->d, m->d, bodies * sizeof *m->d);
    }
    for (size_t k = 0; k < STAGES * m->count; ++k) {
        past->Z[k] = m->Y[k] - m->y0[k % m->count];
    }
    se3di_state_get(m->assembly, past->y1);
    memcpy(past->y1 + bodies, end + bodies, SE3DI_STATE_WORK * sizeof *end);
    past->header->at.begin = m->t;
    past->header->at.time = t;
    past->header->last = m->h;
    past->header->fast = se3di_relax_trust(m->equations, m->fast);
    past->header->since += 1.0;
    past->header->trusted *= se3di_pow(TRUST, past->header->since);
    past->header->at.renewed = 0.0;
    se3di_state_scale_grow(m->assembly, m->f0, &m->scale);
    past->header->scale = m->scale;
    se3di_angles_accept(model);
    se3di_contacts_accept(model); /* force elements: settle */
    ++m->equations->counters.steps;
    return SE3D_OK;
}

/* From (TIME, y1). */
static se3d_status begin_step(se3di_radau *m, se3di_integration *integration, const history *past)
{
    se3di_radau_begin(m, integration);
    se3di_forces_show(m->assembly->model, 0);
    m->t = past->header->at.time;
    m->y0 = past->y1;
    m->scale = past->header->scale;
    se3di_state_set(m->assembly, m->y0);
    return se3di_radau_prepare(m);
}

/* A step of h from the prepared start; *error relative to the inner tolerance (0: as exact as it
 * can be). */
static se3d_status attempt(se3di_radau *m, const history *past, double inner, double h,
                           double *error)
{
    m->h = h;
    m->fraction = 0.0;
    m->has_changed = 0;
    m->inner = inner;
    m->tolerance = inner > 0.0 ? iteration_tolerance(m, inner) : 1e-12;
    m->accuracy = inner > 0.0 ? fmin(1e-13, fmax(1e-15, 1e-6 * inner)) : 1e-13;
    m->iterations_max = inner > 0.0 ? 12 : 50;
    *error = HUGE_VAL;
    se3di_contacts_begin(m->assembly->model, inner > 0.0 ? 0.0 : h, 1.0, 0);
    predict(m, past);
    SE3DI_TRY(se3di_radau_solve(m));
    set_defect(m, m->d);
    SE3DI_TRY(se3di_radau_filter(m, m->d, error));
    const double noise = inner > 0.0 ? se3di_relax_noise(&m->fast, &m->scale, h) : 0.0;
    *error = *error <= noise ? 0.0 : se3di_over(*error, inner);
    if (m->is_stiff && !m->projects) {
        SE3DI_TRY(se3di_radau_close(m));
    }
    return inner == 0.0 || isfinite(*error) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3di_radau_make_step(se3di_integration *integration,
                                  const se3di_radau_begin_state *from, double h, double *y1,
                                  double *acceleration)
{
    radau_header header = {.last = 0.0}; /* no step before this one */
    const history none = {.header = &header};
    se3di_radau m;
    double error;
    se3di_radau_begin(&m, integration);
    m.t = from->t;
    m.y0 = from->y;
    m.scale = *from->scale;
    se3di_state_set(m.assembly, m.y0);
    SE3DI_TRY(se3di_radau_prepare(&m));
    SE3DI_TRY(attempt(&m, &none, 0.0, h, &error));
    SE3DI_TRY(add_work(&m)); /* ends at the last stage */
    memcpy(y1, m.Y + (STAGES - 1) * m.count, m.count * sizeof *y1);
    se3di_radau_get_acceleration(&m, STAGES - 1, acceleration);
    return SE3D_OK;
}

/* Predictive control (Gustafsson 1994). */
static double next_step(const se3di_radau *m, const history *past, double error)
{
    const radau_header *header = past->header;
    const double e = fmax(error, 1e-8);
    const double safety = 0.9 * 11.0 / (10.0 + m->iterations);
    double factor = safety * se3di_pow(e, -0.25);
    if (header->last > 0.0 && header->at.error > 0.0) {
        const double predicted =
            0.9 * m->h / header->last * se3di_pow(header->at.error / (e * e), 0.25);
        factor = fmin(factor, predicted);
    }
    factor = fmin(header->at.rejected > 0.0 ? 1.0 : 8.0, fmax(0.2, factor));
    const double next = se3di_adaptive_limit(m->integration, factor * m->h);
    return header->trusted > 0.0 ? fmin(next, header->trusted) : next;
}

/* ---- in the loop of all methods ---- */

typedef struct controlled_step {
    se3di_adaptive step; /* first, so that it is found from the loop's */
    se3di_radau m;
    history past;
    double inner; /* the tolerance of the estimate */
} controlled_step;

static controlled_step *get_step(se3di_adaptive *step)
{
    return (controlled_step *)(void *)step;
}

static se3d_status try_step(se3di_adaptive *step, double h, double *error)
{
    controlled_step *s = get_step(step);
    SE3DI_TRY(attempt(&s->m, &s->past, s->inner, h, error));
    if (*error <= 1.0) {
        SE3DI_TRY(settle(&s->m, step->integration->settings.tolerance, error));
    }
    step->fraction = s->m.fraction;
    return SE3D_OK;
}

static void watch_crowd(controlled_step *s)
{
    radau_header *header = s->past.header;
    const double step[2] = {header->at.begin, header->at.time};
    static const se3di_crowd_pace pace = {
        .steps = PATIENCE, .brief_each = BRIEF, .brief_most = HUGE_VAL};
    header->leaves =
        se3di_crowd_watch_step(&header->watch, s->m.assembly->model,
                               s->step.integration->settings.leaves_crowd, step, &pace);
}

static se3d_status take(se3di_adaptive *step, double h, double error)
{
    controlled_step *s = get_step(step);
    const double next = next_step(&s->m, &s->past, error);
    (void)h;
    SE3DI_TRY(accept(&s->m, &s->past, step->t));
    step->at->next = next;
    step->at->error = fmax(error, 1e-2);
    watch_crowd(s);
    if (step->integration->settings.leaves_stiff) {
        se3di_radau_watch_ease(&s->m, step->at, &s->past.header->ease);
    }
    return SE3D_OK;
}

/* Stiff forces whose directions turn limit the step by the one matrix of all stages: where the
 * iteration has failed once it would again. */
static double shrink(se3di_adaptive *step, double h, se3d_status status, double error)
{
    if (status == SE3D_ERR_NO_CONVERGENCE) {
        get_step(step)->past.header->trusted = UNTRUSTED * h;
        get_step(step)->past.header->since = 0.0;
    }
    return status < 0 ? 0.5 : fmin(0.9, fmax(0.1, 0.9 * se3di_pow(error, -0.25)));
}

static se3d_status surrender(se3di_adaptive *step, double h, se3d_status status, double error)
{
    const se3di_radau *m = &get_step(step)->m;
    (void)error;
    se3di_state_set(m->assembly, m->y0);
    return se3di_adaptive_blame(step->integration, m->t, h, status);
}

/* One accepted step with error control. */
static se3d_status advance(se3di_integration *integration, double t_end)
{
    static const se3di_adaptive_class methods = {se3di_adaptive_pace, try_step, take, shrink,
                                                 surrender,           1e-12};
    controlled_step s = {.past = get_history(&integration->equations->assembly),
                         .inner = inner_tolerance(integration)};
    s.step = (se3di_adaptive){.methods = &methods,
                              .integration = integration,
                              .at = &s.past.header->at,
                              .ends = se3di_adaptive_ends(integration, &s.past.header->at)};
    SE3DI_TRY(begin_step(&s.m, integration, &s.past));
    se3di_state_set_rates(s.m.assembly, s.m.f0);
    return se3di_adaptive_advance(&s.step, t_end);
}

/* The accepted state is the model's own. What step control has learnt is for `start` to forget: a
 * run goes on after steps by the caller. */
static se3d_status adopt(se3di_integration *integration)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    const history past = get_history(assembly);
    double *f1 = past.d; /* no use yet */
    se3di_state_scale scale = {.length = se3di_state_length(assembly->model)};
    const double next = past.header->at.next;
    se3di_forces_stay(assembly->model);
    memset(assembly->model->history, 0, history_count(assembly) * sizeof(double));
    past.header->at.next = next;
    past.header->watch.since = assembly->model->time;
    se3di_state_get(assembly, past.y1);
    se3di_assembly_get_acceleration(assembly, equations->x);
    SE3DI_TRY(se3di_state_derivative(assembly, assembly->model->time, equations->x,
                                     assembly->model->lambda, f1));
    se3di_state_scale_grow(assembly, f1, &scale);
    past.header->at.time = past.header->at.begin = assembly->model->time;
    past.header->scale = scale;
    return SE3D_OK;
}

static se3d_status start(se3di_integration *integration, double h)
{
    const history past = get_history(&integration->equations->assembly);
    const double limit = integration->settings.step;
    (void)h;
    SE3DI_TRY(adopt(integration));
    const double first = fmin(1e-3, sqrt(inner_tolerance(integration)));
    past.header->at.next = limit > 0.0 ? fmin(limit, first) : first;
    return SE3D_OK;
}

static se3d_status renew(se3di_integration *integration)
{
    const history past = get_history(&integration->equations->assembly);
    const radau_header before = *past.header;
    SE3DI_TRY(adopt(integration));
    past.header->watch = before.watch;
    past.header->ease = before.ease;
    past.header->at.returns = before.at.returns;
    past.header->at.renewed = 1.0;
    return SE3D_OK;
}

/* The accelerations that the interpolation has at t [unknowns]. */
static void eval_accelerations(const history *past, size_t count, double t, double *vdot)
{
    const double h = past->header->last;
    const double *c = se3di_radau_c;
    const double s = (t - past->header->at.time) / h + 1.0;
    const double quartic = (s - c[0]) * (s - c[1]) * (1.0 - s) / (c[0] * c[1]);
    double rate[STAGES];
    for (int j = 0; j < STAGES; ++j) { /* l_j'(s) */
        const double a = c[(j + 1) % STAGES], b = c[(j + 2) % STAGES];
        rate[j] = ((s - a) * (s - b) + s * (2.0 * s - a - b)) / (c[j] * (c[j] - a) * (c[j] - b));
    }
    for (size_t k = 0; k < 6 * (count / SE3DI_STATE_SIZE); ++k) {
        const size_t at = k / 6 * SE3DI_STATE_SIZE + 7 + k % 6;
        const double *Z = past->Z + at;
        vdot[k] =
            (rate[0] * Z[0] + rate[1] * Z[count] + rate[2] * Z[2 * count] + quartic * past->d[at]) /
            h;
    }
}

/* y, interpolated at t, onto the constraints, and relaxed. */
static se3d_status relax_within(se3di_integration *integration, const history *past, double t,
                                double *y)
{
    se3di_radau m;
    se3di_radau_begin(&m, integration);
    m.h = past->header->last;
    m.fast = past->header->fast;
    eval_accelerations(past, m.count, t, m.vdot);
    const se3di_relaxation relaxation = get_relaxation(&m, t);
    return se3di_relax_state(integration, &relaxation, &past->header->scale, y);
}

static se3d_status publish(se3di_integration *integration, double t)
{
    se3di_equations *equations = integration->equations;
    const history past = get_history(&equations->assembly);
    const radau_header *header = past.header;
    const int is_within = t > header->at.begin && t < header->at.time;
    const size_t count = se3di_state_count(&equations->assembly);
    double *y = t < header->at.time ? past.start : past.y1;
    se3di_forces_show(equations->assembly.model, t < header->at.time);
    if (is_within) {
        y = integration->work;
        eval_polynomial(&past, count, t, y);
    } else {
        t = t < header->at.time ? header->at.begin : header->at.time;
    }
    const double rough = se3di_state_rough(equations->assembly.model, integration->shows_motion,
                                           integration->settings.tolerance);
    const int relaxes = is_within && !(rough > 0.0) && se3di_is_fast(&header->fast);
    if (relaxes) {
        SE3DI_TRY(relax_within(integration, &past, t, y));
    }
    return se3di_state_publish(equations, &(se3di_shown){.y = y,
                                                         .t = t,
                                                         .scale = &header->scale,
                                                         .rough = rough,
                                                         .project = is_within && !relaxes});
}

/* One step of length h, solved to rounding. */
static se3d_status step(se3di_integration *integration, double h)
{
    se3di_radau m;
    const history past = get_history(&integration->equations->assembly);
    double error;
    const double t0 = integration->equations->assembly.model->time;
    se3d_status status = past.header->at.time == t0 ? SE3D_OK : adopt(integration);
    status = status < 0 ? status : begin_step(&m, integration, &past);
    if (status >= 0) {
        status = attempt(&m, &past, 0.0, h, &error);
        error = 0.0; /* the step is taken as it is */
        status = status < 0 ? status : settle(&m, HUGE_VAL, &error);
        status = status < 0 ? status : accept(&m, &past, t0 + h);
    }
    return status < 0 ? status : publish(integration, t0 + h);
}

static void interpolate(const se3di_integration *integration, double t, double *y)
{
    const se3di_assembly *assembly = &integration->equations->assembly;
    const history past = get_history(assembly);
    const size_t count = se3di_state_count(assembly);
    if (t > past.header->at.begin && t < past.header->at.time) {
        eval_polynomial(&past, count, t, y);
    } else { /* the ends are the projected ones, to the bit */
        memcpy(y, t < past.header->at.time ? past.start : past.y1, count * sizeof *y);
    }
}

static int leaves_crowd(const se3di_model *model)
{
    return ((const radau_header *)(const void *)model->history)->leaves > 0.0;
}

static void stay(se3di_model *model)
{
    ((radau_header *)(void *)model->history)->leaves = 0.0;
}

/* By contacts of which each is followed; or it is not needed any more. */
static int is_held(const se3di_integration *integration)
{
    const se3di_integrator_settings *settings = &integration->settings;
    const se3di_assembly *assembly = &integration->equations->assembly;
    return (settings->leaves_crowd && leaves_crowd(assembly->model)) ||
           (settings->leaves_stiff && get_history(assembly).header->ease.is_over > 0.0);
}

static se3d_status run(se3di_integration *integration, double t_end)
{
    const history past = get_history(&integration->equations->assembly);
    se3d_status status = SE3D_OK;
    while (past.header->at.time < t_end && status >= 0 && !integration->at_kink &&
           !is_held(integration)) {
        status = advance(integration, t_end);
    }
    return status < 0 ? status : publish(integration, fmin(t_end, past.header->at.time));
}

const se3di_integrator se3di_integrator_radau = {
    .name = "radau",
    .tag = SE3D_METHOD_RADAU,
    .history_count = history_count,
    .work_count = se3di_radau_work_count,
    .start = start,
    .renew = renew,
    .step = step,
    .run = run,
    .advance = advance,
    .interpolate = interpolate,
    .is_held = is_held,
    .leaves_crowd = leaves_crowd,
    .stay = stay,
    .is_implicit = 1,
    .is_reduced = 1,
    .orders = 1u << 5,
    .reach = REACH,
    .get_reach = get_reach,
    .takes_stiff = 1,
};
