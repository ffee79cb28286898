/* SPDX-License-Identifier: BSD-3-Clause */
/* bdf: backward differentiation of order 1 to 5 with quasi-constant steps, for stiff and smooth
 * motions. With the backward differences D_0 .. D_k of y = (r, p, v, w) at the step h,
 *
 *     y_1 = y_P - psi + c y'_1,    y_P = sum_j D_j,   psi = sum_(j >= 1) gamma_j D_j / gamma_k,
 *     c = h / gamma_k,             gamma_j = sum_(i <= j) 1/i
 *     M vdot_1 + Phi_q^T lambda = Q + velocity terms,   Phi(q_1, t_1) = 0
 *
 * solved for (vdot_1, lambda) by Newton with the exact matrix; p_1 = (I - c/2 Omega(w_1))^-1 (..)
 * is explicit. Velocities, and positions to rounding, are then projected onto their constraints
 * (stabilisation of index 2). The local error is d/(k + 1), d = y_1 - y_P; the order follows the
 * estimates of its neighbours (Shampine, Reichelt 1997).  docs/theory/bdf.md */
#include "contact/loads.h"
#include "contact/pace.h"
#include "integrator/memory.h"
#include "math/elementary.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define ORDER_MAX   5
#define DIFFERENCES (ORDER_MAX + 3)

/* The history: this header, the differences, the state at the begin of the last step, the
 * multipliers. */
enum {
    BDF_TIME = SE3DI_HISTORY_TIME,
    BDF_BEGIN = SE3DI_HISTORY_BEGIN, /* of the last step */
    BDF_STEP,                        /* the next one */
    BDF_ORDER,
    BDF_EQUAL,
    BDF_LENGTH,
    BDF_SPEED,
    BDF_SPIN,
    BDF_RENEWED, /* 1: something else acts since the last step */
    BDF_HEADER
};

typedef struct bdf {
    se3di_integration *integration;
    se3di_equations *equations;
    se3di_assembly *assembly;
    size_t count; /* numbers of y */
    double *header, *D, *y0, *lambda;
    double *base;      /* y_P - psi */
    double *predicted; /* y_P */
    double *y;
    double *acceleration; /* a, wdot of each free body [6] */
    double *work;         /* [unknowns] */
    double tolerance, c;
    double t_end; /* of the run */
} bdf;

static size_t history_count(const se3di_assembly *assembly)
{
    return BDF_HEADER + (DIFFERENCES + 1) * se3di_state_count(assembly) + assembly->row_count;
}

static size_t work_count(const se3di_assembly *assembly)
{
    return 3 * se3di_state_count(assembly) + 2 * (size_t)assembly->unknown_count;
}

/* The parts of history and work. */
static bdf point(const se3di_integration *integration)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    size_t count = se3di_state_count(assembly);
    bdf m = {.equations = integration->equations,
             .assembly = assembly,
             .count = count,
             .header = assembly->model->history,
             .base = integration->work,
             .tolerance = fmax(0.1 * integration->settings.tolerance, 1e-10)};
    m.D = m.header + BDF_HEADER;
    m.y0 = m.D + DIFFERENCES * count;
    m.lambda = m.y0 + count;
    m.predicted = m.base + count;
    m.y = m.predicted + count;
    m.acceleration = m.y + count;
    m.work = m.acceleration + assembly->unknown_count;
    return m;
}

static bdf begin(se3di_integration *integration)
{
    bdf m = point(integration);
    m.integration = integration;
    return m;
}

static se3di_state_scale get_scale(const bdf *m)
{
    return (se3di_state_scale){.length = m->header[BDF_LENGTH],
                               .speed = m->header[BDF_SPEED],
                               .spin = m->header[BDF_SPIN]};
}

/* The largest part of an error vector, relative to tolerance and scales. */
static double measure(const bdf *m, const double *error)
{
    double r = 0.0, v = 0.0;
    for (size_t k = 0; k + SE3DI_STATE_WORK < m->count; k += SE3DI_STATE_SIZE) {
        const double *e = error + k;
        double turn = sqrt(e[3] * e[3] + e[4] * e[4] + e[5] * e[5] + e[6] * e[6]);
        double q = se3di_norm(e) / m->header[BDF_LENGTH] + 2.0 * turn;
        double s =
            se3di_norm(e + 7) / m->header[BDF_SPEED] + se3di_norm(e + 10) / m->header[BDF_SPIN];
        r = q <= r ? r : q; /* NaN stays */
        v = s <= v ? v : s;
    }
    return (r + v) / m->tolerance;
}

/* Backward differences for the step `ratio` times as long from a time `shift` steps after the
 * present one: interpolation of degree `order`. */
static void move_base(bdf *m, double ratio, double shift)
{
    int order = (int)m->header[BDF_ORDER];
    double basis[ORDER_MAX + 1][ORDER_MAX + 1] = {{0.0}}; /* value at -i ratio of the j-th form */
    double R[ORDER_MAX + 1][ORDER_MAX + 1];
    for (int i = 0; i <= order; ++i) {
        basis[i][0] = 1.0;
        for (int j = 1; j <= order; ++j) {
            basis[i][j] = basis[i][j - 1] * (j - 1 + shift - i * ratio) / j;
        }
    }
    memcpy(R, basis, sizeof R);
    for (int level = 1; level <= order; ++level) { /* differences of the values at the new nodes */
        for (int i = order; i >= level; --i) {
            for (int j = 0; j <= order; ++j) {
                R[i][j] = R[i - 1][j] - R[i][j];
            }
        }
    }
    for (size_t k = 0; k < m->count; ++k) {
        double fresh[ORDER_MAX + 1] = {0.0};
        for (int i = 0; i <= order; ++i) {
            for (int j = 0; j <= order; ++j) {
                fresh[i] += R[i][j] * m->D[(size_t)j * m->count + k];
            }
        }
        for (int i = 0; i <= order; ++i) {
            m->D[(size_t)i * m->count + k] = fresh[i];
        }
    }
    m->header[BDF_STEP] *= ratio;
    m->header[BDF_EQUAL] = 0.0;
}

static void change_step(bdf *m, double ratio)
{
    move_base(m, ratio, 0.0);
}

static double harmonic(int order)
{
    double sum = 0.0;
    for (int k = 1; k <= order; ++k) {
        sum += 1.0 / k;
    }
    return sum;
}

static void predict(bdf *m)
{
    int order = (int)m->header[BDF_ORDER];
    m->c = m->header[BDF_STEP] / harmonic(order);
    memcpy(m->predicted, m->D, m->count * sizeof *m->D);
    memcpy(m->base, m->D, m->count * sizeof *m->D);
    for (int j = 1; j <= order; ++j) {
        const double *D = m->D + (size_t)j * m->count;
        const double weight = 1.0 - harmonic(j) / harmonic(order);
        for (size_t k = 0; k < m->count; ++k) {
            m->predicted[k] += D[k];
            m->base[k] += weight * D[k];
        }
    }
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        for (size_t i = 0; i < 6; ++i) {
            size_t at = k * SE3DI_STATE_SIZE + 7 + i;
            m->acceleration[6 * k + i] = (m->predicted[at] - m->base[at]) / m->c;
        }
    }
}

/* y_1 from the accelerations, and the frames. */
static void update_state(bdf *m)
{
    const double c = m->c;
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        const double *base = m->base + k * SE3DI_STATE_SIZE;
        double *y = m->y + k * SE3DI_STATE_SIZE;
        double rate[4];
        for (int i = 0; i < 6; ++i) {
            y[7 + i] = base[7 + i] + c * m->acceleration[6 * k + (size_t)i];
        }
        for (int i = 0; i < 3; ++i) {
            y[i] = base[i] + c * y[7 + i];
        }
        se3di_quat_rate(base + 3, y + 10, rate);
        const double scale = 1.0 / (1.0 + 0.25 * c * c * se3di_dot(y + 10, y + 10));
        for (int i = 0; i < 4; ++i) {
            y[3 + i] = scale * (base[3 + i] + c * rate[i]);
        }
    }
    se3di_state_set(m->assembly, m->y);
}

/* Right-hand sides of a Newton correction of accelerations and multipliers. */
static se3d_status eval_residual(bdf *m, double t)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    se3di_assembly_eval_mass(assembly);
    se3di_assembly_eval_jacobian(assembly);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, t, equations->b, equations->error));
    se3di_assembly_add_transposed(assembly, -1.0, m->lambda, equations->b);
    se3di_assembly_subtract_mass(assembly, m->acceleration, equations->b);
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_mul(assembly, equations->x, equations->c);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = (assembly->f[3 * (size_t)k + 1] - equations->c[k]) / m->c;
    }
    return SE3D_OK;
}

/* One correction; its size relative to the tolerance. */
static se3d_status iterate(bdf *m, double t, int refactor, double *size)
{
    se3di_equations *equations = m->equations;
    const se3di_assembly *assembly = m->assembly;
    SE3DI_TRY(eval_residual(m, t));
    if (refactor) {
        se3di_kkt_expect(m->integration->newton.kkt, equations->b, equations->c);
        SE3DI_TRY(se3di_newton_factor_rates(&m->integration->newton, t, m->acceleration, m->lambda,
                                            m->c));
    }
    SE3DI_TRY(se3di_newton_solve(&m->integration->newton));
    ++equations->counters.iterations;
    *size = 0.0;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const double *change = equations->x + 6 * k;
        for (size_t i = 0; i < 6; ++i) {
            double scale = i < 3 ? 1.0 / m->header[BDF_SPEED] + m->c / m->header[BDF_LENGTH]
                                 : 1.0 / m->header[BDF_SPIN] + m->c;
            double part = m->c * fabs(change[i]) * scale / m->tolerance;
            *size = part <= *size ? *size : part;
            m->acceleration[6 * k + i] += change[i];
        }
    }
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        m->lambda[k] += equations->l[k];
    }
    update_state(m);
    return isfinite(*size) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

/* A fall from a correction that had blown up (a stop, a contact that comes and goes) says nothing
 * of what remains: what is left must be small by itself, too. */
static se3d_status iterate_to_convergence(bdf *m, double t)
{
    double before = HUGE_VAL, size = HUGE_VAL;
    int refactor = 1;
    if (m->equations->redundant && m->assembly->row_count > 0) {
        memset(m->lambda, 0, m->assembly->row_count * sizeof *m->lambda);
    }
    se3di_contacts_begin(m->assembly->model, m->header[BDF_STEP], 1.0, 0);
    SE3DI_TRY(se3di_assembly_eval_functions(m->assembly, t, m->equations->error));
    update_state(m);
    for (int k = 0; k < 10; ++k) {
        SE3DI_TRY(se3di_equations_ask(m->equations));
        SE3DI_TRY(iterate(m, t, refactor, &size));
        const int is_traced = se3di_newton_note(&m->integration->newton, size * m->tolerance);
        if (size <= 1e-3 || (k > 0 && size <= 1.0 && size * size / before <= 1e-4) ||
            (k > 1 && size > 0.8 * before && size * m->tolerance <= SE3DI_STATE_NOISE)) {
            return SE3D_OK;
        }
        if (k > 1 && size > 2.0 * before) {
            break;
        }
        refactor = is_traced || (k > 0 && size > 0.1 * before);
        before = size;
    }
    return size <= 0.03
               ? SE3D_OK
               : se3di_error_set(m->equations->error, SE3D_ERR_NO_CONVERGENCE,
                                 "t = %g s: Newton did not converge in a step of %g s; try a "
                                 "smaller step or tolerance",
                                 t, m->header[BDF_STEP]);
}

static se3d_status solve_step(bdf *m, double t)
{
    se3di_kkt *kkt = m->integration->newton.kkt;
    const se3di_kkt_settings before = se3di_state_regularise(m->assembly, kkt);
    se3d_status status = iterate_to_convergence(m, t);
    se3di_kkt_set_settings(kkt, &before);
    return status;
}

/* What friction remembers of the end of the step; *error is raised to what that changes. If it is
 * too much for a controlled step, nothing is remembered. */
static se3d_status settle(bdf *m, double t, int is_controlled, double *error)
{
    const se3di_state_scale scale = get_scale(m);
    double change;
    SE3DI_TRY(
        se3di_memory_settle(m->integration, t, m->header[BDF_STEP], &scale, m->work, &change));
    if (is_controlled) {
        *error = fmax(*error, change / m->integration->settings.tolerance);
        if (!(*error <= 1.0)) {
            se3di_memory_undo(m->integration);
        }
    }
    return SE3D_OK;
}

static se3d_status project_end(bdf *m, double t, double power[SE3DI_STATE_WORK])
{
    se3di_model *model = m->assembly->model;
    se3di_state_scale scale = get_scale(m);
    SE3DI_TRY(se3di_state_project(m->equations, t, &scale, 1e-13, 0));
    SE3DI_TRY(se3di_loads_prepare(model, t, m->equations->error));
    return se3di_loads_power(model, t, power);
}

/* Project, and take y_1 into the differences. */
static se3d_status accept(bdf *m, double t)
{
    se3di_model *model = m->assembly->model;
    size_t bodies = m->count - SE3DI_STATE_WORK;
    int order = (int)m->header[BDF_ORDER];
    double power[SE3DI_STATE_WORK];
    if (m->assembly->row_count > 0) {
        memcpy(model->lambda, m->lambda, m->assembly->row_count * sizeof *m->lambda);
    }
    const se3d_status status = project_end(m, t, power);
    if (status < 0) {
        se3di_memory_undo(m->integration);
        return status;
    }
    for (int k = 0; k < SE3DI_STATE_WORK; ++k) {
        m->y[bodies + (size_t)k] = m->base[bodies + (size_t)k] + m->c * power[k];
    }
    memcpy(m->y0, m->D, m->count * sizeof *m->y0);
    for (size_t k = 0; k < m->count; ++k) {
        double *D = m->D + k;
        double d = m->y[k] - m->predicted[k];
        D[(size_t)(order + 2) * m->count] = d - D[(size_t)(order + 1) * m->count];
        D[(size_t)(order + 1) * m->count] = d;
        for (int j = order; j >= 0; --j) {
            D[(size_t)j * m->count] += D[(size_t)(j + 1) * m->count];
        }
    }
    double work[SE3DI_STATE_WORK];
    memcpy(work, m->D + bodies, sizeof work);
    se3di_state_get(m->assembly, m->D); /* projected */
    memcpy(m->D + bodies, work, sizeof work);
    m->header[BDF_BEGIN] = m->header[BDF_TIME];
    m->header[BDF_TIME] = t;
    m->header[BDF_EQUAL] += 1.0;
    m->header[BDF_RENEWED] = 0.0;
    se3di_angles_accept(model);
    se3di_contacts_accept(model); /* force elements: settle */
    ++m->equations->counters.steps;
    return SE3D_OK;
}

static double error_of(const bdf *m, int difference)
{
    return measure(m, m->D + (size_t)difference * m->count) / difference;
}

/* Order and step after an accepted step of error `error`. */
static void adapt(bdf *m, double error)
{
    int order = (int)m->header[BDF_ORDER];
    int top = m->integration->settings.order;
    top = top >= 1 && top <= ORDER_MAX ? top : ORDER_MAX;
    double limit = m->integration->settings.step;
    if (m->header[BDF_EQUAL] < order + 1) {
        return;
    }
    double best = se3di_pow(fmax(error, 1e-10), -1.0 / (order + 1));
    int chosen = order;
    if (order > 1) {
        double factor = se3di_pow(fmax(error_of(m, order), 1e-10), -1.0 / order);
        chosen = factor > best ? order - 1 : chosen;
        best = fmax(best, factor);
    }
    if (order < top) {
        double factor = se3di_pow(fmax(error_of(m, order + 2), 1e-10), -1.0 / (order + 2));
        chosen = factor > best ? order + 1 : chosen;
        best = fmax(best, factor);
    }
    m->header[BDF_ORDER] = chosen;
    double ratio = fmin(5.0, 0.9 * best);
    ratio = limit > 0.0 ? fmin(ratio, limit / m->header[BDF_STEP]) : ratio;
    if (ratio > 1.1 || ratio < 0.9 || chosen != order) {
        change_step(m, ratio);
    }
}

/* No step over a contact that begins; and after a change of what acts, which may soon change again,
 * none over the end of the run. */
static void keep_pace(bdf *m)
{
    se3di_state_set(m->assembly, m->D);
    double h = m->header[BDF_STEP];
    double paced = se3di_contacts_pace(m->assembly->model, SE3DI_PACE_ADAPTIVE, h);
    const double rest = m->t_end - m->header[BDF_TIME];
    paced = m->header[BDF_RENEWED] > 0.0 && rest > 0.0 ? fmin(paced, rest) : paced;
    if (paced < h) {
        change_step(m, paced / h);
    }
}

/* One accepted step. */
static se3d_status advance(bdf *m, int is_controlled)
{
    if (is_controlled) {
        keep_pace(m);
    }
    for (;;) {
        double t = m->header[BDF_TIME] + m->header[BDF_STEP];
        double error = HUGE_VAL;
        int order = (int)m->header[BDF_ORDER];
        if (is_controlled) {
            SE3DI_TRY(se3di_equations_try_step(m->equations, m->header[BDF_TIME]));
        }
        predict(m);
        se3d_status status = solve_step(m, t);
        if (status >= 0) {
            for (size_t k = 0; k + SE3DI_STATE_WORK < m->count; ++k) {
                m->predicted[k] = m->y[k] - m->predicted[k];
            }
            error = measure(m, m->predicted) / (order + 1);
            for (size_t k = 0; k + SE3DI_STATE_WORK < m->count; ++k) {
                m->predicted[k] = m->y[k] - m->predicted[k];
            }
            if (error <= 1.0 || !is_controlled) {
                status = settle(m, t, is_controlled, &error);
            }
            if (status >= 0) {
                status = error <= 1.0 || !is_controlled ? accept(m, t) : SE3D_INFO_REDUNDANT;
            }
        }
        if (status == SE3D_OK) {
            se3di_state_scale scale = get_scale(m);
            se3di_state_derivative(m->assembly, t, m->acceleration, m->lambda, m->y);
            se3di_state_scale_grow(m->assembly, m->y, &scale);
            m->header[BDF_SPEED] = scale.speed;
            m->header[BDF_SPIN] = scale.spin;
            if (is_controlled) {
                adapt(m, error);
            }
            return SE3D_OK;
        }
        if (status == SE3D_ERR_INTERRUPTED) {
            return status;
        }
        ++m->equations->counters.rejected;
        double factor = isfinite(error) ? 0.9 * se3di_pow(error, -1.0 / (order + 1)) : 0.25;
        if (!is_controlled || m->header[BDF_STEP] < 1e-12 * fmax(1e-3, fabs(t))) {
            return status < 0 ? status
                              : se3di_error_set(m->equations->error, SE3D_ERR_STEP_SIZE,
                                                "t = %g s: the step fell to %.3g s: the tolerance "
                                                "%g cannot be met here; the motion is not smooth",
                                                t, m->header[BDF_STEP],
                                                m->integration->settings.tolerance);
        }
        change_step(m, fmax(0.1, fmin(0.9, factor)));
    }
}

/* D_0 and D_1 from the model's state. */
static se3d_status adopt(bdf *m, double h)
{
    se3di_model *model = m->assembly->model;
    se3di_state_scale scale = {.length = se3di_state_length(model)};
    memset(m->header, 0, history_count(m->assembly) * sizeof *m->header);
    se3di_state_get(m->assembly, m->D);
    se3di_assembly_get_acceleration(m->assembly, m->acceleration);
    SE3DI_TRY(se3di_state_derivative(m->assembly, model->time, m->acceleration, model->lambda,
                                     m->D + m->count));
    se3di_state_scale_grow(m->assembly, m->D + m->count, &scale);
    for (size_t k = 0; k < m->count; ++k) {
        m->D[m->count + k] *= h;
    }
    m->header[BDF_TIME] = m->header[BDF_BEGIN] = model->time;
    m->header[BDF_STEP] = h;
    m->header[BDF_ORDER] = 1.0;
    m->header[BDF_LENGTH] = scale.length;
    m->header[BDF_SPEED] = scale.speed;
    m->header[BDF_SPIN] = scale.spin;
    if (m->assembly->row_count > 0) {
        memcpy(m->lambda, model->lambda, m->assembly->row_count * sizeof *m->lambda);
    }
    return SE3D_OK;
}

static se3d_status start(se3di_integration *integration, double h)
{
    bdf m = begin(integration);
    double limit = integration->settings.step;
    double first = fmin(1e-3, 0.1 * sqrt(m.tolerance));
    (void)h;
    return adopt(&m, limit > 0.0 ? fmin(limit, first) : first);
}

/* The past is moved to where the present rates y' and accelerations would have led from it: a line
 * on all, a parabola on positions. With the latter order 2 is there from the start. */
static void bend(bdf *m, const double *rate)
{
    const double h = m->header[BDF_STEP];
    const int order = (int)m->header[BDF_ORDER];
    double *D1 = m->D + m->count, *D2 = D1 + m->count;
    for (size_t k = 0; k < m->count; ++k) {
        double slope = D1[k];
        for (int j = 2; j <= order; ++j) {
            slope += m->D[(size_t)j * m->count + k] / j;
        }
        m->y[k] = h * rate[k] - slope;
        D1[k] += m->y[k];
    }
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        const size_t at = k * SE3DI_STATE_SIZE;
        double curve[7];
        for (size_t i = 7; order == 1 && i < SE3DI_STATE_SIZE; ++i) {
            m->y[at + i] = h * rate[at + i]; /* there was no parabola yet */
        }
        se3di_copy(m->y + at + 7, curve);
        se3di_quat_rate(m->D + at + 3, m->y + at + 10, curve + 3);
        for (size_t i = 3; order == 1 && i < 7; ++i) {
            const double *w = m->D + at + 10;
            curve[i] -= 0.25 * h * se3di_dot(w, w) * m->D[at + i];
        }
        for (size_t i = 0; i < 7; ++i) {
            D1[at + i] -= 0.5 * h * curve[i];
            D2[at + i] = (order > 1 ? D2[at + i] : 0.0) + h * curve[i];
        }
        for (size_t i = 7; order == 1 && i < SE3DI_STATE_SIZE; ++i) {
            D2[at + i] = 0.0;
        }
    }
}

static se3d_status renew(se3di_integration *integration)
{
    bdf m = begin(integration);
    se3di_model *model = m.assembly->model;
    const double shift = (model->time - m.header[BDF_TIME]) / m.header[BDF_STEP];
    if (shift < 0.0) {
        move_base(&m, 1.0, shift);
        m.header[BDF_TIME] = model->time;
    }
    se3di_state_get(m.assembly, m.D);
    se3di_assembly_get_acceleration(m.assembly, m.acceleration);
    SE3DI_TRY(se3di_state_derivative(m.assembly, model->time, m.acceleration, model->lambda,
                                     m.predicted));
    bend(&m, m.predicted);
    const int top = integration->settings.order;
    m.header[BDF_ORDER] = top == 1 ? 1.0 : fmax(2.0, m.header[BDF_ORDER]);
    m.header[BDF_RENEWED] = 1.0;
    if (m.assembly->row_count > 0) {
        memcpy(m.lambda, model->lambda, m.assembly->row_count * sizeof *m.lambda);
    }
    return SE3D_OK;
}

/* The polynomial of the differences at t. */
static void eval_polynomial(const bdf *m, double t, double *y)
{
    int order = (int)m->header[BDF_ORDER];
    double s = (t - m->header[BDF_TIME]) / m->header[BDF_STEP];
    for (size_t k = 0; k < m->count; ++k) {
        double weight = 1.0, sum = m->D[k];
        for (int j = 1; j <= order; ++j) {
            weight *= (s + j - 1.0) / j;
            sum += weight * m->D[(size_t)j * m->count + k];
        }
        y[k] = sum;
    }
}

static se3d_status publish(bdf *m, double t, int project)
{
    se3di_state_scale scale = get_scale(m);
    eval_polynomial(m, t, m->y);
    return se3di_state_publish(m->equations, m->y, t, &scale, project);
}

/* One step of length h; the order grows with the number of equal steps. */
static se3d_status step(se3di_integration *integration, double h)
{
    bdf m = begin(integration);
    double t0 = m.assembly->model->time;
    if (m.header[BDF_TIME] != t0 || m.header[BDF_EQUAL] == 0.0) {
        SE3DI_TRY(adopt(&m, h));
    } else if (fabs(m.header[BDF_STEP] / h - 1.0) > 1e-9) {
        change_step(&m, h / m.header[BDF_STEP]);
    }
    int top = integration->settings.order;
    top = top >= 1 && top <= ORDER_MAX ? top : ORDER_MAX;
    se3d_status status = advance(&m, 0);
    if (status >= 0) {
        m.header[BDF_TIME] = t0 + h;
        m.header[BDF_ORDER] = fmin(top, m.header[BDF_ORDER] + 1.0);
    }
    se3d_status published = publish(&m, m.header[BDF_TIME], 0);
    return status < 0 ? status : published;
}

static se3d_status advance_one(se3di_integration *integration, double t_end)
{
    bdf m = begin(integration);
    m.t_end = t_end;
    return advance(&m, 1);
}

static void interpolate(const se3di_integration *integration, double t, double *y)
{
    const bdf m = point(integration);
    if (t > m.header[BDF_BEGIN]) {
        eval_polynomial(&m, t, y);
    } else { /* which the polynomial meets to the error only */
        memcpy(y, m.y0, m.count * sizeof *y);
    }
}

static se3d_status run(se3di_integration *integration, double t_end)
{
    bdf m = begin(integration);
    se3d_status status = SE3D_OK;
    m.t_end = t_end;
    while (m.header[BDF_TIME] < t_end && status >= 0) {
        status = advance(&m, 1);
    }
    if (status < 0) {
        se3di_error cause = *m.equations->error;
        (void)publish(&m, m.header[BDF_TIME], 0);
        *m.equations->error = cause;
        return status;
    }
    return publish(&m, t_end, m.header[BDF_TIME] > t_end);
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
    .advance = advance_one,
    .interpolate = interpolate,
    .is_implicit = 1,
    .is_reduced = 1,
    .orders = 0x3E, /* 1 to 5 */
};
