/* SPDX-License-Identifier: BSD-3-Clause */
/* bdf: backward differentiation of order 1 to 5 with variable steps, for stiff and smooth motions.
 * The formula has a fixed leading coefficient on the times that the accepted states have
 * (bdf_history.c); both levels of the constraints hold at the end of a step (bdf_newton.c), which
 * is then projected to rounding. Order and step follow the local errors that this and the
 * neighbouring orders would have made.
 *
 * Steps whose lengths the caller gives have no error control: if the last states do not lie
 * nearly evenly behind the new one, and at the beginning, the step is one of radau, of order 5.
 * docs/theory/bdf.md */
#include "integrator/bdf.h"
#include "integrator/adaptive.h"
#include "integrator/memory.h"
#include "integrator/radau.h"

#include "assembly/energy.h"
#include "assembly/loads.h"
#include "contact/bodies/pace.h"
#include "force/force.h"
#include "math/elementary.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define GROWTH   2.0  /* of a step at most */
#define VIBRATES 0.5  /* (frequency times step)^2 from which orders above 2 are not stable */
#define STIFF    1e3  /* and up to which */
#define FILTERED 1e2  /* or (decay times step)^2, from which forces decide of positions */
#define DECIDED  3    /* the least order then, once it is reached */
#define LOOSE    1e-4 /* a tolerance of so few steps that their errors hardly add up */
#define WORK     0.1  /* weight of the error of works, which disturbs nothing but the audit */

#define NOISE 0.25 /* taken for an error that is only rounding: steps may grow a little */

/* Newton iterations: a shorter step is worth more than many, if it can be had. */
#define ITERATIONS_CONTROLLED 10
#define ITERATIONS_STEP       25

static size_t history_count(const se3di_assembly *assembly)
{
    return SE3DI_BDF_PAST + SE3DI_BDF_POINTS_MAX * se3di_state_count(assembly);
}

/* Behind what the steps of radau need. */
static size_t work_count(const se3di_assembly *assembly)
{
    return se3di_radau_work_count(assembly) + 4 * se3di_state_count(assembly) +
           4 * (size_t)assembly->unknown_count + 2 * assembly->row_count;
}

/* What a step may err by: local errors of order 5 add up over a number of steps that grows with
 * tolerance^(-1/5). */
static double local_tolerance(double tolerance)
{
    tolerance = fmax(tolerance, SE3DI_BDF_REACH);
    return 0.1 * tolerance * se3di_pow(fmin(1.0, tolerance / LOOSE), 0.2);
}

/* Its arrays: behind the first `before` numbers of the work. */
static void point_into(se3di_bdf *m, const se3di_integration *integration, size_t before)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const size_t count = se3di_state_count(assembly);
    const size_t n = assembly->unknown_count;
    *m = (se3di_bdf){.equations = integration->equations,
                     .assembly = assembly,
                     .count = count,
                     .past = (se3di_bdf_past *)(void *)assembly->model->history,
                     .base = integration->work + before,
                     .iterations_max = ITERATIONS_CONTROLLED,
                     .is_controlled = 1,
                     .tolerance = local_tolerance(integration->settings.tolerance)};
    m->accuracy = fmin(1e-13, fmax(1e-15, 1e-6 * m->tolerance));
    m->times = m->past->times;
    m->points = assembly->model->history + SE3DI_BDF_PAST;
    m->predicted = m->base + count;
    m->y = m->predicted + count;
    m->difference = m->y + count;
    m->acceleration = m->difference + count;
    m->work = m->acceleration + n;
    m->lambda = m->work + n;
    m->relaxation = m->lambda + assembly->row_count;
}

static se3di_bdf begin(se3di_integration *integration)
{
    se3di_bdf m;
    point_into(&m, integration, se3di_radau_work_count(&integration->equations->assembly));
    m.integration = integration;
    return m;
}

/* Undamped vibrations of the step's own speed would grow by orders above 2. */
static int is_unstable(const se3di_bdf *m)
{
    const se3di_fastness *fast = &m->past->fast;
    return se3di_loads_are_stiff(m->assembly->model) && fast->spring2 > VIBRATES &&
           fast->spring2 < STIFF && fast->damper2 < fast->spring2;
}

/* The highest order that may be used. */
static int get_top(const se3di_bdf *m)
{
    const int top = m->integration->settings.order;
    const int most = is_unstable(m) ? 2 : SE3DI_BDF_ORDER_MAX;
    return top >= 1 && top <= most ? top : most;
}

/* The largest part of m->difference, relative to tolerance and scales. */
static double measure(const se3di_bdf *m)
{
    double r = 0.0, v = 0.0;
    for (size_t k = 0; k + SE3DI_STATE_WORK < m->count; k += SE3DI_STATE_SIZE) {
        const double *e = m->difference + k;
        if (se3di_state_is_carrier(m->assembly, k / SE3DI_STATE_SIZE)) {
            const double z =
                se3di_state_part(m->assembly, k / SE3DI_STATE_SIZE, &m->past->scale, e + 7);
            v = se3di_larger(v, z);
            continue;
        }
        const double turn = sqrt(e[3] * e[3] + e[4] * e[4] + e[5] * e[5] + e[6] * e[6]);
        const double q = se3di_norm(e) / m->past->scale.length + 2.0 * turn;
        const double s =
            se3di_norm(e + 7) / m->past->scale.speed + se3di_norm(e + 10) / m->past->scale.spin;
        r = se3di_larger(r, q);
        v = se3di_larger(v, s);
    }
    return (r + v) / m->tolerance;
}

/* Six numbers a body, positions or velocities, without the part that the constraints decide. */
static se3d_status leave_tangent(se3di_bdf *m, double *six)
{
    se3di_equations *equations = m->equations;
    const se3di_assembly *assembly = m->assembly;
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        six[k] *= -1.0;
    }
    se3di_assembly_subtract_mass(assembly, six, equations->b);
    SE3DI_TRY(se3di_equations_solve(equations));
    memcpy(six, equations->x, assembly->unknown_count * sizeof *six);
    return SE3D_OK;
}

/* Forces decide of positions within a step. */
static int is_filtered(const se3di_bdf *m)
{
    return fmax(m->fast.spring2, m->fast.damper2) > FILTERED;
}

/* The same for forces far faster than the step, which decide of positions and velocities as
 * constraints do: (I - c J)^-1 of both, with the Jacobian J of (q, v)' (Hosea, Shampine 1996). What
 * creeps slowly under them stays. Once, positions still count over the step as velocities, which a
 * spring does not let them become: so it is taken twice, and these velocities, differences that are
 * wrong for one step and do not add up, may be off by the tolerance of the run. */
static se3d_status leave_slow(se3di_bdf *m, double *q, double *v)
{
    se3di_equations *equations = m->equations;
    const se3di_assembly *assembly = m->assembly;
    const se3di_newton *newton = &m->integration->newton;
    const size_t n = assembly->unknown_count;
    memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    if (assembly->row_count > 0) {
        memset(equations->b, 0, n * sizeof *equations->b);
        se3di_newton_add_matrix(newton, q, equations->b);
        SE3DI_TRY(se3di_newton_solve(&m->integration->newton));
        memcpy(q, equations->x, n * sizeof *q);
    }
    memset(equations->b, 0, n * sizeof *equations->b);
    for (size_t k = 0; k < n; ++k) {
        v[k] *= -1.0;
    }
    se3di_assembly_subtract_mass(assembly, v, equations->b);
    se3di_tangent_add_stiffness(&newton->tangent, -m->c, q, equations->b);
    SE3DI_TRY(se3di_newton_solve(&m->integration->newton));
    for (size_t k = 0; k < n; ++k) {
        v[k] = equations->x[k];
        q[k] += m->c * v[k];
    }
    return SE3D_OK;
}

/* m->difference as six numbers a body of positions and of velocities. */
static void get_difference(const se3di_bdf *m, double *q, double *v)
{
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        const double *d = m->difference + k * SE3DI_STATE_SIZE;
        se3di_copy(d, q + 6 * k);
        se3di_quat_angular_velocity(m->y + k * SE3DI_STATE_SIZE + 3, d + 3, q + 6 * k + 3);
        se3di_copy(d + 7, v + 6 * k);
        se3di_copy(d + 10, v + 6 * k + 3);
    }
}

static double measure_six(const se3di_bdf *m, const double *q, const double *v)
{
    const se3di_state_scale *scale = &m->past->scale;
    double largest[2] = {0.0, 0.0};
    for (size_t k = 0; k < m->assembly->unknown_count; k += 6) {
        if (se3di_state_is_carrier(m->assembly, k / 6)) {
            const double z = se3di_state_part(m->assembly, k / 6, scale, v + k);
            largest[1] = se3di_larger(largest[1], z);
            continue;
        }
        const double at = se3di_norm(q + k) / scale->length + se3di_norm(q + k + 3);
        const double rate = se3di_norm(v + k) / scale->speed + se3di_norm(v + k + 3) / scale->spin;
        largest[0] = se3di_larger(largest[0], at);
        largest[1] = se3di_larger(largest[1], rate);
    }
    return (largest[0] + largest[1]) / m->tolerance;
}

/* The same of its part in the directions that the constraints leave, if the equations are
 * factored. The others are as good as rounding is in the projection, which near a singular position
 * amplifies it by the square of the inverse distance: no shorter step would help. */
static se3d_status measure_tangent(se3di_bdf *m, double *error)
{
    double *q = m->relaxation, *v = q + m->assembly->unknown_count;
    double differences = 0.0;
    get_difference(m, q, v);
    if (is_filtered(m)) {
        SE3DI_TRY(leave_slow(m, q, v));
        differences = measure_six(m, q, v) * m->tolerance / m->integration->settings.tolerance;
        SE3DI_TRY(leave_slow(m, q, v));
    } else {
        SE3DI_TRY(leave_tangent(m, q));
        SE3DI_TRY(leave_tangent(m, v));
    }
    const double left = fmax(measure_six(m, q, v), differences);
    *error = is_filtered(m) && !(left < *error) ? *error : left;
    return SE3D_OK;
}

/* The step is not taken: what force elements remembered before. */
static void forget(const se3di_bdf *m)
{
    se3di_model_restore_memory(m->assembly->model, m->integration->newton.memory);
}

/* The state half way from the last one to y_1, along cubics of the positions. */
static void set_middle(se3di_bdf *m)
{
    double *y = m->predicted; /* not needed any more */
    for (size_t k = 0; k + SE3DI_STATE_WORK < m->count; k += SE3DI_STATE_SIZE) {
        const double *y0 = m->points + k, *y1 = m->y + k;
        double rate0[4], rate1[4];
        se3di_quat_rate(y0 + 3, y0 + 10, rate0);
        se3di_quat_rate(y1 + 3, y1 + 10, rate1);
        for (size_t i = 0; i < SE3DI_STATE_SIZE; ++i) {
            const double bend = i < 3   ? y0[7 + i] - y1[7 + i]
                                : i < 7 ? rate0[i - 3] - rate1[i - 3]
                                        : 0.0;
            y[k + i] = 0.5 * (y0[i] + y1[i]) + 0.125 * m->h * bend;
        }
    }
    se3di_state_set(m->assembly, y);
}

/* *error is raised to what contacts would forget of the step, whose end the frames are at. */
static se3d_status review_contacts(se3di_bdf *m, double *error)
{
    const se3di_memory_step step = {.t = m->t,
                                    .h = m->h,
                                    .tolerance =
                                        SE3DI_MEMORY_PART * m->integration->settings.tolerance,
                                    .begin = m->points,
                                    .scale = &m->past->scale};
    double of_contacts = 0.0;
    if (m->assembly->model->contacts.pair_count == 0) {
        return SE3D_OK;
    }
    se3di_equations_save(m->equations);
    set_middle(m);
    SE3DI_TRY(se3di_memory_review_contacts(m->equations, &step, m->t - 0.5 * m->h, &of_contacts));
    *error = se3di_larger(*error, of_contacts);
    m->fraction = of_contacts > 1.0 ? se3di_memory_get_fraction(of_contacts) : 0.0;
    return SE3D_OK;
}

/* What friction remembers of the end of the step; *error is raised to what that changes. If it is
 * too much for a controlled step, nothing is remembered. */
static se3d_status settle(se3di_bdf *m, int is_controlled, double *error)
{
    const double tolerance = is_controlled ? m->integration->settings.tolerance : HUGE_VAL;
    se3di_memory_end end;
    const se3di_memory_step step = {.t = m->t,
                                    .h = m->h,
                                    .tolerance = tolerance,
                                    .begin = m->points,
                                    .lambda = m->lambda,
                                    .scale = &m->past->scale,
                                    .memory = m->integration->newton.memory,
                                    .work = m->work,
                                    .blur = is_controlled ? m->tolerance : 0.0};
    SE3DI_TRY(se3di_memory_settle(m->equations, &step, &end));
    m->fraction = end.fraction;
    if (end.has_changed) { /* what stands still does so */
        const size_t bodies = m->count - SE3DI_STATE_WORK;
        double work[SE3DI_STATE_WORK];
        memcpy(work, m->y + bodies, sizeof work);
        se3di_state_get(m->assembly, m->y);
        memcpy(m->y + bodies, work, sizeof work);
    }
    if (is_controlled) {
        *error = se3di_larger(*error, end.error);
        if (!(*error <= 1.0)) {
            forget(m);
        }
    }
    return SE3D_OK;
}

/* y_1 put onto its constraints to rounding: before its error is measured, as near a singular
 * position the iteration leaves what the projection takes away. */
static se3d_status project_end(se3di_bdf *m)
{
    const size_t bodies = m->count - SE3DI_STATE_WORK;
    double work[SE3DI_STATE_WORK];
    const se3di_relaxation relaxation = {m->t, m->c, m->fast, m->acceleration, m->relaxation};
    SE3DI_TRY(se3di_bdf_close(m));
    SE3DI_TRY(se3di_state_project(m->equations, m->t, &m->past->scale, m->accuracy, 0));
    SE3DI_TRY(se3di_relax(m->integration, &relaxation));
    memcpy(work, m->y + bodies, sizeof work);
    se3di_state_get(m->assembly, m->y);
    memcpy(m->y + bodies, work, sizeof work);
    return SE3D_OK;
}

/* The frames and y_1 are the projected end of the step; `is_bdf`: without the works yet. */
static void take(se3di_bdf *m, int order, int is_bdf)
{
    const size_t bodies = m->count - SE3DI_STATE_WORK;
    for (size_t k = bodies; k < m->count && is_bdf; ++k) {
        m->y[k] = m->base[k] + m->c * m->power[k - bodies];
    }
    se3di_bdf_push(m, m->y, m->t);
    m->past->at.begin = m->past->at.time;
    m->past->at.time = m->t;
    m->past->used = order;
    m->past->c = m->c;
    m->past->fast = m->fast;
    m->past->since += 1.0;
    m->past->at.renewed = 0.0;
    se3di_angles_accept(m->assembly->model);
    se3di_contacts_accept(m->assembly->model); /* force elements: settle */
    ++m->equations->counters.steps;
}

/* The powers at the end of the step, once. */
static se3d_status find_power(se3di_bdf *m)
{
    if (m->has_power) {
        return SE3D_OK;
    }
    se3di_model *model = m->assembly->model;
    if (m->assembly->row_count > 0) {
        memcpy(model->lambda, m->lambda, m->assembly->row_count * sizeof *m->lambda);
    }
    SE3DI_TRY(se3di_state_prepare(m->equations, m->t));
    SE3DI_TRY(se3di_loads_power(model, m->t, m->power));
    m->has_power = 1;
    return SE3D_OK;
}

/* *error is raised to that of the works where drivers prescribe the motion, and where nothing but
 * stiff forces moves: it is the only one there. */
static se3d_status review_work(se3di_bdf *m, int order, double *error)
{
    const size_t bodies = m->count - SE3DI_STATE_WORK;
    if (m->assembly->timed_count == 0 && m->assembly->user_count == 0 && !is_filtered(m)) {
        return SE3D_OK;
    }
    const se3d_status status = find_power(m);
    if (status < 0) {
        forget(m);
        return status;
    }
    for (size_t k = 0; k < SE3DI_STATE_WORK; ++k) {
        m->y[bodies + k] = m->base[bodies + k] + m->c * m->power[k];
    }
    se3di_bdf_get_error(m, order);
    const double off = se3di_norm(m->difference + bodies) / m->past->scale.energy;
    *error = se3di_larger(*error, WORK * off / m->tolerance);
    if (!(*error <= 1.0)) {
        forget(m);
    }
    return SE3D_OK;
}

/* Take y_1, and let the scales follow. */
static se3d_status accept(se3di_bdf *m, int order, int is_bdf)
{
    se3d_status status = find_power(m);
    status = status < 0 ? status
                        : se3di_state_derivative(m->assembly, m->t, m->acceleration, m->lambda,
                                                 m->difference);
    if (status < 0) {
        forget(m);
        return status;
    }
    m->has_power = 0;
    take(m, order, is_bdf);
    se3di_state_scale_grow(m->assembly, m->difference, &m->past->scale);
    return SE3D_OK;
}

/* ---- with error control ---- */

typedef struct errors {
    double lower, here, higher; /* of order - 1, order, order + 1; HUGE_VAL: not to be had */
} errors;

static se3d_status measure_error(se3di_bdf *m, int order, int is_tangent, double *error)
{
    se3di_bdf_get_error(m, order);
    *error = measure(m);
    if (*error * m->tolerance <= se3di_relax_noise(&m->fast, &m->past->scale, m->h)) {
        *error = fmin(*error, NOISE);
        return SE3D_OK;
    }
    return is_tangent ? measure_tangent(m, error) : SE3D_OK;
}

/* The errors of the orders that can be chosen. */
static se3d_status measure_errors(se3di_bdf *m, int order, errors *e)
{
    SE3DI_TRY(measure_error(m, order, 0, &e->here));
    /* rates that follow signals say nothing of positions: their errors stay */
    const int is_fast = is_filtered(m);
    const int is_tangent = e->here > 1.0 && (is_fast || m->assembly->row_count > 0) &&
                           !se3di_state_has_rates(m->equations);
    if (is_tangent) {
        SE3DI_TRY(is_fast ? SE3D_OK : se3di_equations_factor(m->equations));
        SE3DI_TRY(measure_error(m, order, 1, &e->here));
    }
    if (!(e->here <= 1.0)) {
        return isfinite(e->here) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
    }
    if (order > 1) {
        SE3DI_TRY(measure_error(m, order - 1, is_tangent, &e->lower));
    }
    if (order < get_top(m) && (int)m->past->count > order + 1) {
        SE3DI_TRY(measure_error(m, order + 1, is_tangent, &e->higher));
    }
    return SE3D_OK;
}

/* A step of the order; its errors. */
static se3d_status attempt(se3di_bdf *m, int order, errors *e)
{
    *e = (errors){HUGE_VAL, HUGE_VAL, HUGE_VAL};
    m->has_power = 0;
    se3di_bdf_predict(m, order);
    SE3DI_TRY(se3di_bdf_solve(m));
    SE3DI_TRY(project_end(m));
    return measure_errors(m, order, e);
}

/* The factor that a step of the order may be longer by. */
static double factor_of(double error, int order)
{
    return se3di_pow(2.0 * fmax(error, 1e-10), -1.0 / (order + 1));
}

static void set_order(se3di_bdf *m, int order)
{
    if (order != (int)m->past->order) {
        m->past->since = 0.0;
    }
    m->past->order = order;
}

/* At the beginning the order rises and the step doubles as long as the errors allow both. */
static int grow_at_start(se3di_bdf *m, int order, const errors *e)
{
    if (m->past->starts == 0.0) {
        return 0;
    }
    const int can_rise = order < get_top(m);
    if (!can_rise || e->lower < e->here || !(factor_of(e->here, order) >= GROWTH)) {
        m->past->starts = 0.0;
        return 0;
    }
    set_order(m, order + 1);
    m->past->at.next = se3di_adaptive_limit(m->integration, GROWTH * m->h);
    return 1;
}

/* Velocities that forces decide of are the differences of positions, and jump with the order by
 * what the lower one makes of these: such a jump looks like an error, and orders below 3 would
 * follow it down. */
static int least_order(const se3di_bdf *m, int order)
{
    const int least = order < DECIDED ? order : DECIDED;
    return is_filtered(m) ? least : 1;
}

/* Order and step after an accepted step. A step that would grow a little only stays. */
static void adapt(se3di_bdf *m, int order, const errors *e)
{
    if (grow_at_start(m, order, e)) {
        return;
    }
    double best = factor_of(e->here, order);
    int chosen = order;
    if (order > least_order(m, order) && factor_of(e->lower, order - 1) > best) {
        best = factor_of(e->lower, order - 1);
        chosen = order - 1;
    }
    const int rises = is_filtered(m) && order < DECIDED && e->higher <= 1.0;
    if (m->past->since > order && isfinite(e->higher) &&
        (rises || factor_of(e->higher, order + 1) > best)) {
        best = factor_of(e->higher, order + 1);
        chosen = order + 1;
    }
    if (chosen > get_top(m)) {
        chosen = get_top(m);
        best = fmin(best, 1.0);
    }
    set_order(m, chosen);
    double factor = 1.0;
    if (best >= 1.2) {
        factor = fmin(best, GROWTH);
    } else if (best < 1.0) {
        factor = fmax(0.5, fmin(0.9, best));
    }
    m->past->at.next = se3di_adaptive_limit(m->integration, factor * m->h);
}

/* ---- in the loop of all methods ---- */

typedef struct controlled_step {
    se3di_adaptive step; /* first, so that it is found from the loop's */
    se3di_bdf m;
    errors e;
    int order;
} controlled_step;

static controlled_step *get_step(se3di_adaptive *step)
{
    return (controlled_step *)(void *)step;
}

static se3d_status try_step(se3di_adaptive *step, double h, double *error)
{
    controlled_step *s = get_step(step);
    s->m.h = h;
    s->m.fraction = 0.0;
    SE3DI_TRY(attempt(&s->m, s->order, &s->e));
    if (s->e.here <= 1.0) {
        SE3DI_TRY(review_contacts(&s->m, &s->e.here));
    }
    if (s->e.here <= 1.0) {
        SE3DI_TRY(settle(&s->m, 1, &s->e.here));
    }
    if (s->e.here <= 1.0) {
        SE3DI_TRY(review_work(&s->m, s->order, &s->e.here));
    }
    *error = s->e.here;
    step->fraction = s->m.fraction;
    return SE3D_OK;
}

static se3d_status take_step(se3di_adaptive *step, double h, double error)
{
    controlled_step *s = get_step(step);
    se3di_bdf *m = &s->m;
    (void)h;
    (void)error;
    SE3DI_TRY(accept(m, s->order, 1));
    m->past->starts = step->tries > 1 ? 0.0 : m->past->starts;
    set_order(m, s->order);
    adapt(m, s->order, &s->e);
    step->at->time = m->times[0] = step->t;
    return SE3D_OK;
}

/* At a kink of the motion the states behind it say nothing of what is ahead, and the order falls.
 * The history stays as it is: a run that is interrupted here begins the step anew. */
static double shrink(se3di_adaptive *step, double h, se3d_status status, double error)
{
    controlled_step *s = get_step(step);
    const int says = step->tries == 1 && status >= 0 && isfinite(error);
    const double factor = says ? fmax(0.25, fmin(0.9, 0.9 * factor_of(error, s->order))) : 0.25;
    (void)h;
    s->order = step->tries > 2 ? least_order(&s->m, s->order) : s->order;
    return factor;
}

static se3d_status surrender(se3di_adaptive *step, double h, se3d_status status, double error)
{
    (void)error;
    return se3di_adaptive_blame(step->integration, get_step(step)->m.t, h, status);
}

/* One accepted step with error control. */
static se3d_status advance(se3di_integration *integration, double t_end)
{
    static const se3di_adaptive_class methods = {se3di_adaptive_pace, try_step, take_step, shrink,
                                                 surrender,           1e-12};
    controlled_step s = {.m = begin(integration)};
    s.order = (int)s.m.past->order;
    s.step = (se3di_adaptive){.methods = &methods,
                              .integration = integration,
                              .at = &s.m.past->at,
                              .ends = se3di_adaptive_ends(integration, &s.m.past->at)};
    se3di_forces_show(s.m.assembly->model, 0);
    se3di_state_set(s.m.assembly, s.m.points);
    se3di_bdf_eval_rate(&s.m, s.m.past->at.time, s.m.difference);
    se3di_state_set_rates(s.m.assembly, s.m.difference);
    return se3di_adaptive_advance(&s.step, t_end);
}

/* ---- begin, steps and runs ---- */

/* The model's state is the newest one. */
static se3d_status adopt(se3di_bdf *m)
{
    se3di_model *model = m->assembly->model;
    se3di_state_scale scale = {.length = se3di_state_length(model),
                               .speed = m->past->scale.speed,
                               .spin = m->past->scale.spin};
    se3di_forces_stay(model);
    se3di_bdf_drop_from(m, model->time);
    se3di_state_get(m->assembly, m->y);
    se3di_bdf_push(m, m->y, model->time);
    se3di_assembly_get_acceleration(m->assembly, m->acceleration);
    SE3DI_TRY(se3di_state_derivative(m->assembly, model->time, m->acceleration, model->lambda,
                                     m->difference));
    se3di_state_scale_grow(m->assembly, m->difference, &scale);
    m->past->at.time = m->past->at.begin = model->time;
    m->past->scale = scale;
    return SE3D_OK;
}

/* A run begins on states before its start, on the parabola (velocities: the line) that the
 * accelerations make of the state: order 2 is there at once. */
static void add_past(se3di_bdf *m, double h)
{
    const double t = m->past->at.time;
    memcpy(m->y, m->points, m->count * sizeof *m->y);
    m->past->count = 0.0;
    for (int j = 2; j > 0; --j) {
        const double before = t - j * h;
        se3di_bdf_extend(m, before - t, m->predicted);
        se3di_bdf_push(m, m->predicted, before);
    }
    se3di_bdf_push(m, m->y, t);
    m->past->used = get_top(m) > 1 ? 2.0 : 1.0;
    set_order(m, (int)m->past->used);
}

static se3d_status start(se3di_integration *integration, double h)
{
    se3di_bdf m = begin(integration);
    const double limit = integration->settings.step;
    const double first = fmin(1e-3, 0.1 * sqrt(m.tolerance));
    (void)h;
    memset(m.assembly->model->history, 0, history_count(m.assembly) * sizeof(double));
    SE3DI_TRY(adopt(&m));
    m.past->at.next = limit > 0.0 ? fmin(limit, first) : first;
    m.past->starts = 1.0;
    add_past(&m, m.past->at.next);
    return SE3D_OK;
}

/* Something else acts: the past is bent to where the present accelerations would have led from it.
 */
static se3d_status renew(se3di_integration *integration)
{
    se3di_bdf m = begin(integration);
    const double t = m.assembly->model->time;
    double work[SE3DI_STATE_WORK]; /* a change of values does some */
    se3di_bdf_eval(&m, t, m.y);
    for (size_t k = 0; k < SE3DI_STATE_WORK; ++k) {
        work[k] = m.assembly->model->work[k] - m.y[m.count - SE3DI_STATE_WORK + k];
    }
    se3di_bdf_eval_rate(&m, t, m.base);
    SE3DI_TRY(adopt(&m));
    if (m.past->count < 3.0) {
        add_past(&m, m.past->at.next);
    } else {
        for (size_t k = 0; k < m.count; ++k) {
            m.difference[k] -= m.base[k];
        }
        se3di_bdf_bend(&m, m.difference, work);
    }
    const double least = fmin(2.0, get_top(&m));
    set_order(&m, (int)fmin(fmax(least, m.past->order), m.past->count - 1.0));
    m.past->at.renewed = 1.0;
    return SE3D_OK;
}

/* m->y, interpolated at t, onto the constraints, and relaxed. */
static se3d_status relax_within(se3di_bdf *m, double t)
{
    const se3di_relaxation relaxation = {t, m->past->c, m->past->fast, m->acceleration,
                                         m->relaxation};
    se3di_bdf_eval_rate(m, t, m->difference);
    for (size_t k = 0; k < m->assembly->unknown_count; ++k) {
        m->acceleration[k] = m->difference[k / 6 * SE3DI_STATE_SIZE + 7 + k % 6];
    }
    return se3di_relax_state(m->integration, &relaxation, &m->past->scale, m->y);
}

static se3d_status publish(se3di_bdf *m, double t, int project)
{
    const int at_begin = !(t > m->past->at.begin) && m->past->count > 1.0;
    se3di_forces_show(m->assembly->model, t < m->past->at.time);
    if (t < m->past->at.time && at_begin) { /* the end of the step before, to the bit */
        memcpy(m->y, m->points + m->count, m->count * sizeof *m->y);
    } else if (t < m->past->at.time) {
        se3di_bdf_eval(m, t, m->y);
    } else {
        memcpy(m->y, m->points, m->count * sizeof *m->y);
    }
    const double rough = se3di_state_rough(m->assembly->model, m->integration->shows_motion,
                                           m->integration->settings.tolerance);
    if (project && !(rough > 0.0) && se3di_is_fast(&m->past->fast)) {
        SE3DI_TRY(relax_within(m, t));
        project = 0;
    }
    return se3di_state_publish(
        m->equations,
        &(se3di_shown){
            .y = m->y, .t = t, .scale = &m->past->scale, .rough = rough, .project = project});
}

/* y_1, accelerations and multipliers by a step of radau. */
static se3d_status solve_by_radau(se3di_bdf *m)
{
    const se3di_radau_begin_state from = {m->points, m->past->at.time, &m->past->scale};
    m->t = m->past->at.time + m->h;
    SE3DI_TRY(se3di_radau_make_step(m->integration, &from, m->h, m->y, m->acceleration));
    if (m->assembly->row_count > 0) {
        memcpy(m->lambda, m->assembly->model->lambda, m->assembly->row_count * sizeof *m->lambda);
    }
    return SE3D_OK;
}

/* One step of length h. */
static se3d_status step(se3di_integration *integration, double h)
{
    se3di_bdf m = begin(integration);
    const double t0 = m.assembly->model->time;
    double error = 0.0;
    if (m.past->at.time != t0) {
        SE3DI_TRY(adopt(&m));
    } else if (m.past->starts > 0.0 && m.past->at.begin == t0) {
        m.past->count = 1.0; /* no step was made yet: without the state before the start */
    }
    se3di_forces_show(m.assembly->model, 0);
    const int order = get_top(&m);
    const int is_bdf = se3di_bdf_is_even(&m, order, h);
    m.h = h;
    m.iterations_max = ITERATIONS_STEP;
    m.is_controlled = 0;
    if (is_bdf) {
        se3di_bdf_predict(&m, order);
    }
    se3d_status status = is_bdf ? se3di_bdf_solve(&m) : solve_by_radau(&m);
    status = status < 0 ? status : project_end(&m);
    status = status < 0 ? status : settle(&m, 0, &error);
    status = status < 0 ? status : accept(&m, order, is_bdf);
    SE3DI_TRY(status);
    m.past->at.time = m.times[0] = t0 + h;
    set_order(&m, 1 < order && m.past->count > 2.0 ? 2 : 1);
    m.past->at.next = se3di_adaptive_limit(integration, h);
    return publish(&m, m.past->at.time, 0);
}

static void interpolate(const se3di_integration *integration, double t, double *y)
{
    se3di_bdf m;
    point_into(&m, integration, se3di_radau_work_count(&integration->equations->assembly));
    se3di_bdf_eval(&m, t, y);
}

static se3d_status run(se3di_integration *integration, double t_end)
{
    se3di_bdf m = begin(integration);
    se3d_status status = SE3D_OK;
    while (m.past->at.time < t_end && status >= 0 && !integration->at_kink) {
        status = advance(integration, t_end);
    }
    SE3DI_TRY(status);
    t_end = fmin(t_end, m.past->at.time);
    return publish(&m, t_end, m.past->at.time > t_end && t_end > m.past->at.begin);
}

static int is_within(double value, int most)
{
    return value >= 1.0 && value <= most && value == floor(value);
}

static int is_sound(const double *history, size_t count)
{
    const se3di_bdf_past *past = (const se3di_bdf_past *)history;
    return count >= SE3DI_BDF_PAST && is_within(past->order, SE3DI_BDF_ORDER_MAX) &&
           is_within(past->used, SE3DI_BDF_ORDER_MAX) &&
           is_within(past->count, SE3DI_BDF_POINTS_MAX);
}

const se3di_integrator se3di_integrator_bdf = {
    .name = "bdf",
    .tag = SE3D_METHOD_BDF,
    .history_count = history_count,
    .work_count = work_count,
    .start = start,
    .renew = renew,
    .step = step,
    .run = run,
    .advance = advance,
    .interpolate = interpolate,
    .is_sound = is_sound,
    .is_implicit = 1,
    .is_reduced = 1,
    .orders = 0x3E, /* 1 to 5 */
    .reach = SE3DI_BDF_REACH,
};
