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
#include "integrator/memory.h"
#include "integrator/radau.h"

#include "assembly/energy.h"
#include "contact/bodies/pace.h"
#include "force/force.h"
#include "math/elementary.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define GROWTH 2.0 /* of a step at most */

/* Newton iterations: a shorter step is worth more than many, where it can be had. */
#define ITERATIONS_CONTROLLED 10
#define ITERATIONS_STEP       25

size_t se3di_bdf_history_count(const se3di_assembly *assembly)
{
    return BDF_HEADER + SE3DI_BDF_POINTS_MAX * se3di_state_count(assembly);
}

size_t se3di_bdf_work_count(const se3di_assembly *assembly)
{
    return 4 * se3di_state_count(assembly) + 2 * (size_t)assembly->unknown_count +
           assembly->row_count;
}

/* Behind what the steps of radau need. */
static size_t work_count(const se3di_assembly *assembly)
{
    return se3di_radau_work_count(assembly) + se3di_bdf_work_count(assembly);
}

void se3di_bdf_point(se3di_bdf *m, const se3di_integration *integration, size_t before)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const size_t count = se3di_state_count(assembly);
    const size_t n = assembly->unknown_count;
    *m = (se3di_bdf){.equations = integration->equations,
                     .assembly = assembly,
                     .count = count,
                     .header = assembly->model->history,
                     .base = integration->work + before,
                     .iterations_max = ITERATIONS_CONTROLLED,
                     .tolerance = 0.1 * fmax(integration->settings.tolerance, SE3DI_BDF_REACH)};
    m->accuracy = fmin(1e-13, fmax(1e-15, 1e-6 * m->tolerance));
    m->times = m->header + BDF_TIMES;
    m->points = m->header + BDF_HEADER;
    m->predicted = m->base + count;
    m->y = m->predicted + count;
    m->difference = m->y + count;
    m->acceleration = m->difference + count;
    m->work = m->acceleration + n;
    m->lambda = m->work + n;
}

static se3di_bdf begin(se3di_integration *integration)
{
    se3di_bdf m;
    se3di_bdf_point(&m, integration, se3di_radau_work_count(&integration->equations->assembly));
    m.integration = integration;
    return m;
}

se3di_state_scale se3di_bdf_get_scale(const se3di_bdf *m)
{
    return (se3di_state_scale){.length = m->header[BDF_LENGTH],
                               .speed = m->header[BDF_SPEED],
                               .spin = m->header[BDF_SPIN]};
}

int se3di_bdf_get_top(const se3di_bdf *m)
{
    const int top = m->integration->settings.order;
    return top >= 1 && top <= SE3DI_BDF_ORDER_MAX ? top : SE3DI_BDF_ORDER_MAX;
}

/* The largest part of m->difference, relative to tolerance and scales. */
static double measure(const se3di_bdf *m)
{
    double r = 0.0, v = 0.0;
    for (size_t k = 0; k + SE3DI_STATE_WORK < m->count; k += SE3DI_STATE_SIZE) {
        const double *e = m->difference + k;
        const double turn = sqrt(e[3] * e[3] + e[4] * e[4] + e[5] * e[5] + e[6] * e[6]);
        const double q = se3di_norm(e) / m->header[BDF_LENGTH] + 2.0 * turn;
        const double s =
            se3di_norm(e + 7) / m->header[BDF_SPEED] + se3di_norm(e + 10) / m->header[BDF_SPIN];
        r = q <= r ? r : q; /* NaN stays */
        v = s <= v ? v : s;
    }
    return (r + v) / m->tolerance;
}

/* Six numbers a body of m->difference, positions (`at` 0) or velocities (7), without the part that
 * the constraints decide: from m->work. */
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

/* The same of its part in the directions that the constraints leave, where the equations are
 * factored. The others are as good as rounding is in the projection, which near a singular position
 * amplifies it by the square of the inverse distance: no shorter step would help. */
static se3d_status measure_tangent(se3di_bdf *m, double *error)
{
    double largest[2] = {0.0, 0.0};
    for (int level = 0; level < 2; ++level) {
        for (size_t k = 0; k < m->assembly->body_count; ++k) {
            const double *d = m->difference + k * SE3DI_STATE_SIZE;
            double *six = m->work + 6 * k;
            se3di_copy(level ? d + 7 : d, six);
            if (level) {
                se3di_copy(d + 10, six + 3);
            } else {
                se3di_quat_angular_velocity(m->y + k * SE3DI_STATE_SIZE + 3, d + 3, six + 3);
            }
        }
        SE3DI_TRY(leave_tangent(m, m->work));
        for (size_t k = 0; k < m->assembly->unknown_count; k += 6) {
            const double part =
                se3di_norm(m->work + k) / m->header[level ? BDF_SPEED : BDF_LENGTH] +
                se3di_norm(m->work + k + 3) / (level ? m->header[BDF_SPIN] : 1.0);
            largest[level] = part <= largest[level] ? largest[level] : part;
        }
    }
    *error = (largest[0] + largest[1]) / m->tolerance;
    return SE3D_OK;
}

/* The step is not taken: what force elements remembered before. */
static void forget(const se3di_bdf *m)
{
    se3di_model_restore_memory(m->assembly->model, m->integration->newton.memory);
}

/* What friction remembers of the end of the step; *error is raised to what that changes. If it is
 * too much for a controlled step, nothing is remembered. */
static se3d_status settle(se3di_bdf *m, int is_controlled, double *error)
{
    const se3di_state_scale scale = se3di_bdf_get_scale(m);
    const double tolerance = is_controlled ? m->integration->settings.tolerance : HUGE_VAL;
    se3di_memory_end end;
    const se3di_memory_step step = {
        m->t, m->h, tolerance, m->lambda, &scale, m->integration->newton.memory, m->work};
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
        *error = fmax(*error, end.error);
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
    const se3di_state_scale scale = se3di_bdf_get_scale(m);
    double work[SE3DI_STATE_WORK];
    SE3DI_TRY(se3di_state_project(m->equations, m->t, &scale, m->accuracy, 0));
    memcpy(work, m->y + bodies, sizeof work);
    se3di_state_get(m->assembly, m->y);
    memcpy(m->y + bodies, work, sizeof work);
    return SE3D_OK;
}

/* The frames and y_1 are the projected end of the step; `is_bdf`: without the works yet. */
static void take(se3di_bdf *m, const double *power, int order, int is_bdf)
{
    const size_t bodies = m->count - SE3DI_STATE_WORK;
    for (size_t k = bodies; k < m->count && is_bdf; ++k) {
        m->y[k] = m->base[k] + m->c * power[k - bodies];
    }
    se3di_bdf_push(m, m->y, m->t);
    m->header[BDF_BEGIN] = m->header[BDF_TIME];
    m->header[BDF_TIME] = m->t;
    m->header[BDF_USED] = order;
    m->header[BDF_SINCE] += 1.0;
    m->header[BDF_RENEWED] = 0.0;
    se3di_angles_accept(m->assembly->model);
    se3di_contacts_accept(m->assembly->model); /* force elements: settle */
    ++m->equations->counters.steps;
}

/* Take y_1, and let the scales follow. */
static se3d_status accept(se3di_bdf *m, int order, int is_bdf)
{
    se3di_model *model = m->assembly->model;
    se3di_state_scale scale = se3di_bdf_get_scale(m);
    double power[SE3DI_STATE_WORK];
    if (m->assembly->row_count > 0) {
        memcpy(model->lambda, m->lambda, m->assembly->row_count * sizeof *m->lambda);
    }
    se3d_status status = se3di_state_prepare(m->equations, m->t);
    status = status < 0 ? status : se3di_loads_power(model, m->t, power);
    status = status < 0 ? status
                        : se3di_state_derivative(m->assembly, m->t, m->acceleration, m->lambda,
                                                 m->difference);
    if (status < 0) {
        forget(m);
        return status;
    }
    take(m, power, order, is_bdf);
    se3di_state_scale_grow(m->assembly, m->difference, &scale);
    m->header[BDF_SPEED] = scale.speed;
    m->header[BDF_SPIN] = scale.spin;
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
    return is_tangent ? measure_tangent(m, error) : SE3D_OK;
}

/* The errors of the orders that can be chosen. */
static se3d_status measure_errors(se3di_bdf *m, int order, errors *e)
{
    SE3DI_TRY(measure_error(m, order, 0, &e->here));
    const int is_tangent = e->here > 1.0 && m->assembly->row_count > 0;
    if (is_tangent) {
        SE3DI_TRY(se3di_equations_factor(m->equations));
        SE3DI_TRY(measure_error(m, order, 1, &e->here));
    }
    if (!(e->here <= 1.0)) {
        return isfinite(e->here) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
    }
    if (order > 1) {
        SE3DI_TRY(measure_error(m, order - 1, is_tangent, &e->lower));
    }
    if (order < se3di_bdf_get_top(m) && (int)m->header[BDF_POINTS] > order + 1) {
        SE3DI_TRY(measure_error(m, order + 1, is_tangent, &e->higher));
    }
    return SE3D_OK;
}

/* A step of the order; its errors. */
static se3d_status attempt(se3di_bdf *m, int order, errors *e)
{
    *e = (errors){HUGE_VAL, HUGE_VAL, HUGE_VAL};
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
    if (order != (int)m->header[BDF_ORDER]) {
        m->header[BDF_SINCE] = 0.0;
    }
    m->header[BDF_ORDER] = order;
}

static double limit_step(const se3di_bdf *m, double h)
{
    const double limit = m->integration->settings.step;
    return limit > 0.0 && h > limit ? limit : h;
}

/* At the beginning the order rises and the step doubles as long as the errors allow both. */
static int grow_at_start(se3di_bdf *m, int order, const errors *e)
{
    if (m->header[BDF_STARTS] == 0.0) {
        return 0;
    }
    const int can_rise = order < se3di_bdf_get_top(m);
    if (!can_rise || e->lower < e->here || !(factor_of(e->here, order) >= GROWTH)) {
        m->header[BDF_STARTS] = 0.0;
        return 0;
    }
    set_order(m, order + 1);
    m->header[BDF_STEP] = limit_step(m, GROWTH * m->h);
    return 1;
}

/* Order and step after an accepted step. A step that would grow a little only stays. */
static void adapt(se3di_bdf *m, int order, const errors *e)
{
    if (grow_at_start(m, order, e)) {
        return;
    }
    double best = factor_of(e->here, order);
    int chosen = order;
    if (order > 1 && factor_of(e->lower, order - 1) > best) {
        best = factor_of(e->lower, order - 1);
        chosen = order - 1;
    }
    if (m->header[BDF_SINCE] > order && isfinite(e->higher) &&
        factor_of(e->higher, order + 1) > best) {
        best = factor_of(e->higher, order + 1);
        chosen = order + 1;
    }
    set_order(m, chosen);
    double factor = 1.0;
    if (best >= 1.2) {
        factor = fmin(best, GROWTH);
    } else if (best < 1.0) {
        factor = fmax(0.5, fmin(0.9, best));
    }
    m->header[BDF_STEP] = limit_step(m, factor * m->h);
}

/* A step that was rejected `times` times: at a kink of the motion the states behind it say nothing
 * of what is ahead, and the order falls. The history stays as it is: a run that is interrupted here
 * begins the step anew. */
static void shorten(se3di_bdf *m, int *order, double error, int times)
{
    if (times == 1 && isfinite(error)) {
        m->h *= fmax(0.25, fmin(0.9, 0.9 * factor_of(error, *order)));
    } else {
        m->h *= 0.25;
    }
    *order = times > 2 ? 1 : *order;
}

static se3d_status fail_small(const se3di_bdf *m, se3d_status cause)
{
    if (cause >= 0) {
        cause = se3di_error_set(m->equations->error, SE3D_ERR_STEP_SIZE,
                                "t = %g s: the step fell to %.3g s: the tolerance %g cannot "
                                "be met here; the motion is not smooth",
                                m->t, m->h, m->integration->settings.tolerance);
    }
    se3di_contacts_blame(m->assembly->model, m->equations->error);
    return cause;
}

/* No step over a contact that begins, nor of more than an angle's counter can follow; and after a
 * change of what acts, which may soon change again, none over the end of the run: *longer is then
 * what it would have been, else 0. */
static double pace(se3di_bdf *m, double t_end, double *longer)
{
    const double rest = t_end - m->header[BDF_TIME];
    se3di_state_set(m->assembly, m->points);
    se3di_bdf_eval_rate(m, m->header[BDF_TIME], m->difference);
    se3di_state_set_rates(m->assembly, m->difference);
    double h = se3di_state_limit_turn(m->assembly->model, 0.0, m->header[BDF_STEP]);
    h = se3di_contacts_pace(m->assembly->model, SE3DI_PACE_ADAPTIVE, h);
    *longer = m->header[BDF_RENEWED] > 0.0 && rest > 0.0 && h > rest ? h : 0.0;
    return *longer > 0.0 ? rest : h;
}

/* One accepted step with error control. */
static se3d_status advance(se3di_bdf *m, double t_end)
{
    double longer;
    int order = (int)m->header[BDF_ORDER];
    se3di_forces_show(m->assembly->model, 0);
    m->h = pace(m, t_end, &longer);
    for (int times = 1;; ++times, longer = 0.0) {
        errors e;
        m->fraction = 0.0;
        SE3DI_TRY(se3di_equations_try_step(m->equations, m->header[BDF_TIME]));
        se3d_status status = attempt(m, order, &e);
        if (status >= 0 && e.here <= 1.0) {
            status = settle(m, 1, &e.here);
        }
        if (status >= 0 && e.here <= 1.0) {
            status = accept(m, order, 1);
            if (status >= 0) {
                m->header[BDF_STARTS] = times > 1 ? 0.0 : m->header[BDF_STARTS];
                set_order(m, order);
                adapt(m, order, &e);
                if (longer > 0.0) {
                    m->header[BDF_TIME] = m->times[0] = t_end;
                    m->header[BDF_STEP] = fmax(longer, m->header[BDF_STEP]);
                }
                return SE3D_OK;
            }
        }
        if (status == SE3D_ERR_INTERRUPTED || status == SE3D_ERR_NO_MEMORY) {
            return status;
        }
        ++m->equations->counters.rejected;
        if (status >= 0 && m->fraction > 0.0) {
            m->h *= m->fraction;
        } else {
            shorten(m, &order, status < 0 ? HUGE_VAL : e.here, times);
        }
        if (!(m->h > 1e-12 * fmax(1e-3, fabs(m->t)))) {
            return fail_small(m, status);
        }
    }
}

/* ---- begin, steps and runs ---- */

/* The model's state is the newest one. */
static se3d_status adopt(se3di_bdf *m)
{
    se3di_model *model = m->assembly->model;
    se3di_state_scale scale = {.length = se3di_state_length(model),
                               .speed = m->header[BDF_SPEED],
                               .spin = m->header[BDF_SPIN]};
    se3di_forces_stay(model);
    se3di_bdf_drop_from(m, model->time);
    se3di_state_get(m->assembly, m->y);
    se3di_bdf_push(m, m->y, model->time);
    se3di_assembly_get_acceleration(m->assembly, m->acceleration);
    SE3DI_TRY(se3di_state_derivative(m->assembly, model->time, m->acceleration, model->lambda,
                                     m->difference));
    se3di_state_scale_grow(m->assembly, m->difference, &scale);
    m->header[BDF_TIME] = m->header[BDF_BEGIN] = model->time;
    m->header[BDF_LENGTH] = scale.length;
    m->header[BDF_SPEED] = scale.speed;
    m->header[BDF_SPIN] = scale.spin;
    return SE3D_OK;
}

/* A run begins on states before its start, on the parabola (velocities: the line) that the
 * accelerations make of the state: order 2 is there at once. */
static void add_past(se3di_bdf *m, double h)
{
    const double t = m->header[BDF_TIME];
    memcpy(m->y, m->points, m->count * sizeof *m->y);
    m->header[BDF_POINTS] = 0.0;
    for (int j = 2; j > 0; --j) {
        se3di_bdf_extend(m, -j * h, m->predicted);
        se3di_bdf_push(m, m->predicted, t - j * h);
    }
    se3di_bdf_push(m, m->y, t);
    m->header[BDF_USED] = se3di_bdf_get_top(m) > 1 ? 2.0 : 1.0;
    set_order(m, (int)m->header[BDF_USED]);
}

static se3d_status start(se3di_integration *integration, double h)
{
    se3di_bdf m = begin(integration);
    const double limit = integration->settings.step;
    const double first = fmin(1e-3, 0.1 * sqrt(m.tolerance));
    (void)h;
    memset(m.header, 0, se3di_bdf_history_count(m.assembly) * sizeof *m.header);
    SE3DI_TRY(adopt(&m));
    m.header[BDF_STEP] = limit > 0.0 ? fmin(limit, first) : first;
    m.header[BDF_STARTS] = 1.0;
    add_past(&m, m.header[BDF_STEP]);
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
    if (m.header[BDF_POINTS] < 3.0) {
        add_past(&m, m.header[BDF_STEP]);
    } else {
        for (size_t k = 0; k < m.count; ++k) {
            m.difference[k] -= m.base[k];
        }
        se3di_bdf_bend(&m, m.difference, work);
    }
    const double least = fmin(2.0, se3di_bdf_get_top(&m));
    set_order(&m, (int)fmin(fmax(least, m.header[BDF_ORDER]), m.header[BDF_POINTS] - 1.0));
    m.header[BDF_RENEWED] = 1.0;
    return SE3D_OK;
}

static se3d_status publish(se3di_bdf *m, double t, int project)
{
    const se3di_state_scale scale = se3di_bdf_get_scale(m);
    const int at_begin = !(t > m->header[BDF_BEGIN]) && m->header[BDF_POINTS] > 1.0;
    se3di_forces_show(m->assembly->model, t < m->header[BDF_TIME]);
    if (t < m->header[BDF_TIME] && at_begin) { /* the end of the step before, to the bit */
        memcpy(m->y, m->points + m->count, m->count * sizeof *m->y);
    } else if (t < m->header[BDF_TIME]) {
        se3di_bdf_eval(m, t, m->y);
    } else {
        memcpy(m->y, m->points, m->count * sizeof *m->y);
    }
    return se3di_state_publish(m->equations, m->y, t, &scale, project);
}

/* y_1, accelerations and multipliers by a step of radau. */
static se3d_status solve_by_radau(se3di_bdf *m)
{
    const se3di_state_scale scale = se3di_bdf_get_scale(m);
    const se3di_radau_begin_state from = {m->points, m->header[BDF_TIME], &scale};
    m->t = m->header[BDF_TIME] + m->h;
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
    if (m.header[BDF_TIME] != t0) {
        SE3DI_TRY(adopt(&m));
    } else if (m.header[BDF_STARTS] > 0.0 && m.header[BDF_BEGIN] == t0) {
        m.header[BDF_POINTS] = 1.0; /* no step was made yet: without the state before the start */
    }
    se3di_forces_show(m.assembly->model, 0);
    const int order = se3di_bdf_get_top(&m);
    const int is_bdf = se3di_bdf_is_even(&m, order, h);
    m.h = h;
    m.iterations_max = ITERATIONS_STEP;
    if (is_bdf) {
        se3di_bdf_predict(&m, order);
    }
    se3d_status status = is_bdf ? se3di_bdf_solve(&m) : solve_by_radau(&m);
    status = status < 0 ? status : project_end(&m);
    status = status < 0 ? status : settle(&m, 0, &error);
    status = status < 0 ? status : accept(&m, order, is_bdf);
    SE3DI_TRY(status);
    m.header[BDF_TIME] = m.times[0] = t0 + h;
    set_order(&m, 1 < order && m.header[BDF_POINTS] > 2.0 ? 2 : 1);
    m.header[BDF_STEP] = limit_step(&m, h);
    return publish(&m, m.header[BDF_TIME], 0);
}

static se3d_status advance_one(se3di_integration *integration, double t_end)
{
    se3di_bdf m = begin(integration);
    return advance(&m, t_end);
}

static void interpolate(const se3di_integration *integration, double t, double *y)
{
    se3di_bdf m;
    se3di_bdf_point(&m, integration, se3di_radau_work_count(&integration->equations->assembly));
    se3di_bdf_eval(&m, t, y);
}

static se3d_status run(se3di_integration *integration, double t_end)
{
    se3di_bdf m = begin(integration);
    se3d_status status = SE3D_OK;
    while (m.header[BDF_TIME] < t_end && status >= 0) {
        status = advance(&m, t_end);
    }
    SE3DI_TRY(status);
    return publish(&m, t_end, m.header[BDF_TIME] > t_end && t_end > m.header[BDF_BEGIN]);
}

const se3di_integrator se3di_integrator_bdf = {
    .name = "bdf",
    .tag = SE3D_METHOD_BDF,
    .history_count = se3di_bdf_history_count,
    .work_count = work_count,
    .start = start,
    .renew = renew,
    .step = step,
    .run = run,
    .advance = advance_one,
    .interpolate = interpolate,
    .is_implicit = 1,
    .is_reduced = 1,
    .orders = 0x3E, /* 1 to 5 */
    .reach = SE3DI_BDF_REACH,
};
