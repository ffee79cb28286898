/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/explicit_rk.h"

#include "force/force.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define SLOW_MAX   0.01  /* most of a step times the rate of the motion, */
#define DECAY_MIN  0.5   /* and least of it times a decay, if decays limit the step */
#define HELD_EACH  8.0   /* steps between looks if there is no sign */
#define SAFETY     0.8   /* a rejected step costs more than several that are this much shorter */
#define CAUTION    0.01  /* of a first step that has one estimate of two */
#define LOOP_PACE  0.35  /* where radau is worth its steps, */
#define JOINT_PACE 0.2   /* the same in joint coordinates, whose steps take less, */
#define LOOP_REST  100.0 /* tolerances: a smaller change of velocities is that of a rest */
#define REST_SLOW  1e-5  /* of a step times the rate of the motion, at a rest, */
#define REST_ERROR 0.01  /* and least of its error, if stiffness limits the step */
#define LOOP_AT    (SE3DI_EXPLICIT_PART * 1e-6) /* at this tolerance */
#define TIMES      1e-8 /* of the time: shorter steps are not known to the digits that this takes */
#define SHORTEST   0.05 /* of steps in this one, before which the second estimate is rounding */
#define FREE_PART  0.1  /* of the error of a step: that of an interpolation without more stages */
#define GROWTH     3.0  /* largest, of a step: one small error may be chance */

static se3d_status evaluate_stage(se3di_explicit *m, double t, double h, int stage)
{
    se3di_explicit_combine(m, m->K, m->y0, h, m->tableau->a[stage], stage, m->y);
    return se3di_explicit_evaluate(m, t + m->tableau->c[stage] * h, m->y,
                                   m->K + (size_t)stage * m->count);
}

/* The error of the step, relative to the tolerance. */
static double estimate_error(se3di_explicit *m, double h)
{
    const se3di_rk_tableau *tableau = m->tableau;
    se3di_explicit_combine(m, m->K, NULL, h, tableau->error, tableau->stages + tableau->uses_end,
                           m->sum);
    if (!tableau->error3) {
        return se3di_explicit_measure(m, m->sum);
    }
    se3di_explicit_combine(m, m->K, NULL, h, tableau->error3, tableau->stages, m->sum3);
    const double *const estimates[2] = {m->sum, m->sum3};
    double sizes[2];
    se3di_explicit_sizes(m, estimates, sizes);
    const double error = sizes[0] / m->tolerance, error3 = sizes[1] / m->tolerance;
    return error > 0.0 ? error * error / sqrt(error * error + 0.01 * error3 * error3) : error;
}

/* In the history: the derivative that the last step began with. */
static double *first_derivative(const se3di_explicit *m)
{
    return m->forms + (size_t)(SE3DI_EXPLICIT_FORMS - 1) * m->count;
}

/* From y0 at t and the first derivative. */
static se3d_status evaluate_stages(se3di_explicit *m, double t, double h)
{
    memcpy(m->K, first_derivative(m), m->count * sizeof *m->K);
    se3di_state_begin_step(m->equations, m->past->redundant, m->past->wide > 0.0);
    for (int k = 1; k < m->tableau->stages; ++k) {
        SE3DI_TRY(evaluate_stage(m, t, h, k));
    }
    return SE3D_OK;
}

static se3d_status make_stages(se3di_explicit *m, double h, double *error)
{
    memcpy(m->y0, m->y1, m->count * sizeof *m->y0);
    memcpy(first_derivative(m), m->f1, m->count * sizeof *m->f1);
    m->past->length = h;
    SE3DI_TRY(evaluate_stages(m, m->past->at.time, h));
    *error = m->tableau->uses_end ? 0.0 : estimate_error(m, h);
    return SE3D_OK;
}

/* In the history, of methods with a second estimate: what the last step added to the state, before
 * the projection, and the derivative that it began with. */
static double *last_change(const se3di_explicit *m)
{
    return m->forms + (size_t)(SE3DI_EXPLICIT_FORMS - 3) * m->count;
}

static double *last_derivative(const se3di_explicit *m)
{
    return m->forms + (size_t)(SE3DI_EXPLICIT_FORMS - 2) * m->count;
}

/* h^5/120 of the fifth derivative of the motion, relative to the tolerance: the divided difference
 * of states and derivatives at the ends of this step and of the one before. With the times in
 * steps, x = -r, 0, 1, and p_i the product of x_i - x_j,
 *
 *     sum_i h y'_i / p_i^2 - 2 y_i / p_i^2 sum_(j != i) 1 / (x_i - x_j)
 *
 * 0 if no step came before, or steps are so short that the differences or r are rounding. */
static double measure_fifth(se3di_explicit *m, double h)
{
    const double r = (m->past->at.time - m->past->at.begin) / h;
    if (!(r > SHORTEST) || h < TIMES * fabs(m->past->at.time)) {
        return 0.0;
    }
    const double p[3] = {r * (1.0 + r), r, 1.0 + r};
    const double before = -2.0 * (1.0 / r + 1.0 / (1.0 + r)) / (p[0] * p[0]);
    const double here = -2.0 * (1.0 + 1.0 / (1.0 + r)) / (p[2] * p[2]);
    const double rate[3] = {h / (p[0] * p[0]), h / (p[1] * p[1]), h / (p[2] * p[2])};
    const double *last = last_change(m), *f0 = last_derivative(m), *f1 = m->f1;
    const double *f2 = se3di_explicit_end(m);
    for (size_t k = 0; k < m->count; ++k) {
        m->sum3[k] = here * (m->y[k] - m->y0[k]) + before * last[k] + rate[0] * f0[k] +
                     rate[1] * f1[k] + rate[2] * f2[k];
    }
    return se3di_explicit_measure(m, m->sum3);
}

static double estimate_end(se3di_explicit *m, double h, double error)
{
    const double second = m->tableau->second;
    m->remembered = second > 0.0 ? second * measure_fifth(m, h) : 0.0;
    return m->tableau->uses_end ? estimate_error(m, h) : error;
}

static void accept(se3di_explicit *m, double h)
{
    double *change = last_change(m);
    (void)h;
    if (!(m->tableau->second > 0.0)) {
        return;
    }
    for (size_t k = 0; k < m->count; ++k) {
        change[k] = m->y[k] - m->y1[k];
    }
    memcpy(last_derivative(m), m->f1, m->count * sizeof *m->f1);
}

static int get_end(const se3di_explicit *m)
{
    return m->tableau->stages;
}

static int get_order(const se3di_explicit *m)
{
    return m->tableau->order;
}

static void arrive(se3di_explicit *m, double h)
{
    const int stages = m->tableau->stages;
    se3di_explicit_combine(m, m->K, m->y0, h, m->tableau->a[stages], stages, m->y);
}

/* The next step: PI control of the error (Gustafsson 1991). */
static double next_step(const se3di_explicit *m, double h, double error)
{
    double exponent = 1.0 / m->tableau->order;
    double before = fmax(m->past->at.error, 1e-4);
    double e = fmax(error, 1e-10);
    double factor = SAFETY * se3di_pow(e, -0.8 * exponent) * se3di_pow(e / before, -0.2 * exponent);
    double largest = m->past->at.rejected != 0.0 ? 1.0 : GROWTH;
    h *= fmin(largest, fmax(0.2, factor));
    return se3di_adaptive_limit(m->step.integration, h);
}

/* There is no second estimate of the first step. */
static double shorten_first(const se3di_explicit *m, double h)
{
    return m->tableau->second > 0.0 ? CAUTION * h : h;
}

static double shrink(const se3di_explicit *m, se3d_status status, double error)
{
    const double exponent = 1.0 / m->tableau->order;
    const double factor =
        status < 0 || !isfinite(error) ? 0.25 : SAFETY * se3di_pow(error, -exponent);
    return fmax(0.2, fmin(0.9, factor));
}

/* h lambda of a decay that is in the differences `y` of velocities and `f` of accelerations times
 * h: what oscillates has none on the average. */
static double decay_of(const se3di_explicit *m, const double *y_change, const double *f_change)
{
    const double *y = m->motion->spread(m->equations, y_change, m->bodies[0]);
    const double *f = m->motion->spread(m->equations, f_change, m->bodies[1]);
    const double v = 1.0 / (m->past->scale.speed * m->past->scale.speed);
    const double w = 1.0 / (m->past->scale.spin * m->past->scale.spin);
    double product = 0.0, square = 0.0;
    for (size_t k = 7; k < SE3DI_STATE_SIZE * m->assembly->body_count; k += SE3DI_STATE_SIZE) {
        if (se3di_state_is_carrier(m->assembly, k / SE3DI_STATE_SIZE)) {
            const double one[6] = {1.0};
            const double z =
                se3di_state_part(m->assembly, k / SE3DI_STATE_SIZE, &m->past->scale, one);
            product += z * z * y[k] * f[k];
            square += z * z * y[k] * y[k];
            continue;
        }
        product += v * se3di_dot(y + k, f + k) + w * se3di_dot(y + k + 3, f + k + 3);
        square += v * se3di_dot(y + k, y + k) + w * se3di_dot(y + k + 3, y + k + 3);
    }
    return square > 0.0 ? -product / square : 0.0;
}

/* The sum of squares of velocities in a change, relative to the scales. */
static double square_of(const se3di_explicit *m, const double *change)
{
    const double *y = m->motion->spread(m->equations, change, m->bodies[0]);
    const double v = 1.0 / (m->past->scale.speed * m->past->scale.speed);
    const double w = 1.0 / (m->past->scale.spin * m->past->scale.spin);
    double sum = 0.0;
    for (size_t k = 7; k < SE3DI_STATE_SIZE * m->assembly->body_count; k += SE3DI_STATE_SIZE) {
        if (!se3di_state_is_carrier(m->assembly, k / SE3DI_STATE_SIZE)) {
            sum += v * se3di_dot(y + k, y + k) + w * se3di_dot(y + k + 3, y + k + 3);
        }
    }
    return sum;
}

/* Next to nothing has moved in this step, of `change` (square_of()). */
static int is_rest(const se3di_explicit *m, double change)
{
    const double rest = LOOP_REST * m->tolerance;
    return change < rest * rest;
}

/* The step is far shorter than anything that moves asks for, and has an error all the same: it is
 * made of what stiffness makes of rounding. A vibration that is a part of the motion changes
 * velocities by more. */
static int is_held_at_rest(const se3di_explicit *m, double h)
{
    const double rate = fmax(m->past->scale.speed / m->past->scale.length, m->past->scale.spin);
    const double *end = m->y, *begin = m->y0;
    if (!(h * rate < REST_SLOW) || !(m->past->at.error > REST_ERROR)) {
        return 0;
    }
    for (size_t k = 0; k < m->count; ++k) {
        m->sum[k] = end[k] - begin[k];
    }
    return is_rest(m, square_of(m, m->sum));
}

/* Whether another method would make longer steps than stability allows. The step times the rate at
 * which the motion itself changes is |h (y'(end) - y'(begin))| / |y(end) - y(begin)| of the
 * velocities. If bodies and joints make loops radau takes about twice the time for a step, three
 * times or more beside joint coordinates, which is accurate up to 0.7 of that at the tolerance
 * 1e-6: it gains something only if stability limits steps far below. If next to nothing moves, the
 * change is what stiffness makes of errors and tells no pace: there nothing but stability limits
 * the steps. */
static int gains_by_leaving(se3di_explicit *m, double h)
{
    const double *end = se3di_explicit_end(m);
    if (!se3di_kkt_has_loop(m->equations->kkt)) {
        return 1;
    }
    for (size_t k = 0; k < m->count; ++k) {
        m->sum[k] = m->y[k] - m->y0[k];
        m->sum3[k] = h * (end[k] - m->K[k]);
    }
    const int is_joint = m->assembly->formulation->id == SE3D_FORMULATION_JOINT;
    const double pace = is_joint ? JOINT_PACE : LOOP_PACE;
    const double accurate = pace * se3di_pow(m->tolerance / LOOP_AT, 0.2);
    const double change = square_of(m, m->sum);
    return is_rest(m, change) || square_of(m, m->sum3) < accurate * accurate * change;
}

/* The step is far below what the motion asks for, and of the size of a decay. Disturbances of each
 * step (its projection) keep such a decay alive long before stability is lost. */
static int is_held_by_decay(const se3di_explicit *m, double h)
{
    const double rate = fmax(m->past->scale.speed / m->past->scale.length, m->past->scale.spin);
    return h * rate < SLOW_MAX && decay_of(m, m->sum, m->sum3) > DECAY_MIN;
}

/* |h lambda| of the fastest motion, from the last stage and the end of the step, which are at one
 * time: |y'(end) - y'(stage)|/|y(end) - y(stage)| (Hairer, Wanner 1996, sec. IV.2). What is far
 * below the tolerance tells nothing; nor does what is near a singular position, where accelerations
 * change fast with how far the constraints are violated. */
static void watch_stability(se3di_explicit *m, double h)
{
    const se3di_rk_tableau *tableau = m->tableau;
    const int last = tableau->stages - 1, end = tableau->stages;
    double difference[SE3DI_RK_MAX];
    m->past->since += 1.0;
    if (m->motion->count_dependent(m->equations) > m->past->redundant) {
        return;
    }
    if (!(m->past->held > 0.0) && m->past->since < HELD_EACH) {
        return;
    }
    m->past->since = 0.0;
    for (int k = 0; k < SE3DI_RK_MAX; ++k) {
        difference[k] = tableau->a[end][k] - tableau->a[last][k];
    }
    se3di_explicit_combine(m, m->K, NULL, h, difference, end, m->sum);
    for (size_t k = 0; k < m->count; ++k) {
        m->sum3[k] = h * (m->K[(size_t)end * m->count + k] - m->K[(size_t)last * m->count + k]);
    }
    memset(m->sum + m->count - SE3DI_STATE_WORK, 0, SE3DI_STATE_WORK * sizeof *m->sum);
    memset(m->sum3 + m->count - SE3DI_STATE_WORK, 0, SE3DI_STATE_WORK * sizeof *m->sum3);
    const double apart = se3di_explicit_measure(m, m->sum);
    int is_held = apart > 0.01 && (se3di_explicit_measure(m, m->sum3) > tableau->stable * apart ||
                                   is_held_by_decay(m, h));
    is_held = (is_held && gains_by_leaving(m, h)) || (apart > 0.01 && is_held_at_rest(m, h));
    se3di_explicit_count_sign(m, is_held);
}

/* The stages of the last step once more: what was to be done after them failed, and they are not a
 * part of the history. */
static se3d_status remake_stages(se3di_explicit *m)
{
    const double h = m->past->length;
    SE3DI_TRY(evaluate_stages(m, m->past->at.begin, h));
    arrive(m, h);
    return se3di_explicit_evaluate(m, m->past->at.time, m->y, se3di_explicit_end(m));
}

/* F_0 to F_2, which the ends give. */
static void make_end_forms(se3di_explicit *m, double h)
{
    const double *f0 = m->K, *f1 = se3di_explicit_end(m);
    double *F0 = m->forms, *F1 = F0 + m->count, *F2 = F1 + m->count;
    for (size_t k = 0; k < m->count; ++k) {
        F0[k] = m->y1[k] - m->y0[k];
        F1[k] = h * f0[k] - F0[k];
        F2[k] = 2.0 * F0[k] - h * (f0[k] + f1[k]);
    }
}

/* F_3 and on, by rows of d that take the first stages; returns the last. */
static double *make_forms(se3di_explicit *m, double h, const double (*d)[SE3DI_RK_MAX], int stages)
{
    double *form = m->forms + 2 * m->count;
    for (int row = 0; row < m->tableau->dense_rows; ++row) {
        form += m->count;
        se3di_explicit_combine(m, m->K, NULL, h, d[row], stages, form);
    }
    return form;
}

/* Whether the stages of the step do: what they leave is small beside the error of the step. */
static int makes_free_forms(se3di_explicit *m, double h)
{
    const se3di_rk_tableau *tableau = m->tableau;
    if (!tableau->free) {
        return 0;
    }
    const double *last = make_forms(m, h, tableau->free, tableau->stages + 1);
    return tableau->free_error * se3di_explicit_measure(m, last) <= FREE_PART;
}

static se3d_status make_all_forms(se3di_explicit *m, double h)
{
    const se3di_rk_tableau *tableau = m->tableau;
    for (int k = tableau->stages + 1; k < tableau->total; ++k) {
        SE3DI_TRY(evaluate_stage(m, m->past->at.begin, h, k));
    }
    (void)make_forms(m, h, tableau->d, tableau->total);
    return SE3D_OK;
}

/* The interpolation of the last step. */
static se3d_status build_dense(se3di_explicit *m)
{
    const double h = m->past->at.time - m->past->at.begin;
    se3di_forces_show(m->assembly->model, 1);
    if (!m->has_stages) {
        SE3DI_TRY(remake_stages(m));
    }
    make_end_forms(m, h);
    SE3DI_TRY(makes_free_forms(m, h) ? SE3D_OK : make_all_forms(m, h));
    /* rows of users that failed are told of later: what was made of them is not kept */
    m->past->dense = m->assembly->model->user_failure.status < 0 ? 0.0 : 1.0;
    return SE3D_OK;
}

/* y = y0 + s_0 (form_0 + s_1 (form_1 + ...)) */
static void interpolate(const se3di_explicit *m, double t, double *y)
{
    const double s = (t - m->past->at.begin) / (m->past->at.time - m->past->at.begin);
    const double factor[2] = {s, 1.0 - s};
    m->sums->nest(m->count, 3 + m->tableau->dense_rows, m->forms, factor, m->y0, y);
}

const se3di_explicit_class se3di_rk_class = {
    .make_stages = make_stages,
    .arrive = arrive,
    .estimate_end = estimate_end,
    .accept = accept,
    .next_step = next_step,
    .shorten_first = shorten_first,
    .shrink = shrink,
    .watch_stability = watch_stability,
    .build_dense = build_dense,
    .interpolate = interpolate,
    .get_order = get_order,
    .get_end = get_end,
};
