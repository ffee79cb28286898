/* SPDX-License-Identifier: BSD-3-Clause */
/* The accepted states of bdf and what is made of them. With the polynomial P of degree k through
 * the newest k + 1 states, at whatever times, and h the step to t_1,
 *
 *     y_P = P(t_1),   y'_1 = P'(t_1) + (alpha / h) (y_1 - y_P),   alpha = sum_(j <= k) 1/j
 *
 * (fixed leading coefficient; at equal steps the classical formula of order k). The local error is
 * C (y_1 - y_P), C = max(a, |a + sum_(j <= k) (a_j - 1/j)|) with a_j = h / (t_1 - t_(1-j)),
 * a = a_(k+1) (Brenan, Campbell, Petzold 1996, sec. 5.2).  docs/theory/bdf.md */
#include "integrator/bdf.h"

#include "math/over.h"
#include "math/quaternion.h"

#include <math.h>
#include <string.h>

typedef struct weights {
    double value[SE3DI_BDF_POINTS_MAX], rate[SE3DI_BDF_POINTS_MAX];
} weights;

/* Of the polynomial through `count` states at t. */
static void eval_weights(const double *times, int count, double t, weights *w)
{
    for (int j = 0; j < count; ++j) {
        double value = 1.0, rate = 0.0;
        for (int i = 0; i < count; ++i) {
            if (i != j) {
                const double over = se3di_over(1.0, times[j] - times[i]);
                rate = (rate * (t - times[i]) + value) * over;
                value *= (t - times[i]) * over;
            }
        }
        w->value[j] = value;
        w->rate[j] = rate;
    }
}

/* The newest state weighs what the others leave of 1: sums of differences from it lose no digits of
 * positions far from the origin. */
static double combine(const se3di_bdf *m, const double *weight, int count, size_t k)
{
    double sum = 0.0;
    for (int j = 1; j < count; ++j) {
        sum += weight[j] * (m->points[(size_t)j * m->count + k] - m->points[k]);
    }
    return sum;
}

static double harmonic(int order)
{
    double sum = 0.0;
    for (int k = 1; k <= order; ++k) {
        sum += 1.0 / k;
    }
    return sum;
}

void se3di_bdf_push(se3di_bdf *m, const double *y, double t)
{
    const size_t keep = SE3DI_BDF_POINTS_MAX - 1;
    memmove(m->points + m->count, m->points, keep * m->count * sizeof *m->points);
    memmove(m->times + 1, m->times, keep * sizeof *m->times);
    memcpy(m->points, y, m->count * sizeof *y);
    m->times[0] = t;
    m->past->count = fmin(SE3DI_BDF_POINTS_MAX, m->past->count + 1.0);
}

void se3di_bdf_drop_from(se3di_bdf *m, double t)
{
    int points = (int)m->past->count;
    int drop = 0;
    while (drop < points && !(m->times[drop] < t)) {
        ++drop;
    }
    points -= drop;
    memmove(m->points, m->points + (size_t)drop * m->count,
            (size_t)points * m->count * sizeof *m->points);
    memmove(m->times, m->times + drop, (size_t)points * sizeof *m->times);
    m->past->count = points;
}

int se3di_bdf_is_even(const se3di_bdf *m, int order, double h)
{
    static const double largest[SE3DI_BDF_ORDER_MAX + 1] = {0.0, HUGE_VAL, 1.6, 1.3, 1.15, 1.1};
    if ((int)m->past->count <= order) {
        return 0;
    }
    for (int k = 0; k < order; ++k) {
        const double ratio = h / (m->times[k] - m->times[k + 1]);
        if (!(fmax(ratio, 1.0 / ratio) <= largest[order])) {
            return 0;
        }
    }
    return 1;
}

void se3di_bdf_predict(se3di_bdf *m, int order)
{
    weights w;
    m->t = m->past->at.time + m->h;
    m->c = m->h / harmonic(order);
    eval_weights(m->times, order + 1, m->t, &w);
    for (size_t k = 0; k < m->count; ++k) {
        m->predicted[k] = m->points[k] + combine(m, w.value, order + 1, k);
        m->difference[k] = combine(m, w.rate, order + 1, k);
        m->base[k] = m->predicted[k] - m->c * m->difference[k];
    }
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        memcpy(m->acceleration + 6 * k, m->difference + k * SE3DI_STATE_SIZE + 7,
               6 * sizeof *m->acceleration);
    }
}

static double error_constant(const se3di_bdf *m, int order)
{
    double sum = 0.0;
    for (int j = 0; j < order; ++j) {
        sum += m->h / (m->t - m->times[j]) - 1.0 / (j + 1);
    }
    const double a = m->h / (m->t - m->times[order]);
    return fmax(a, fabs(a + sum));
}

void se3di_bdf_get_error(se3di_bdf *m, int order)
{
    weights w;
    const double factor = error_constant(m, order);
    eval_weights(m->times, order + 1, m->t, &w);
    for (size_t k = 0; k < m->count; ++k) {
        m->difference[k] = factor * (m->y[k] - m->points[k] - combine(m, w.value, order + 1, k));
    }
}

void se3di_bdf_eval(const se3di_bdf *m, double t, double *y)
{
    weights w;
    const int count = (int)m->past->used + 1;
    eval_weights(m->times, count, t, &w);
    for (size_t k = 0; k < m->count; ++k) {
        y[k] = m->points[k] + combine(m, w.value, count, k);
    }
}

void se3di_bdf_eval_rate(const se3di_bdf *m, double t, double *rate)
{
    weights w;
    const int count = (int)fmin(m->past->used + 1.0, m->past->count);
    eval_weights(m->times, count, t, &w);
    for (size_t k = 0; k < m->count; ++k) {
        rate[k] = combine(m, w.rate, count, k);
    }
}

void se3di_bdf_extend(const se3di_bdf *m, double s, double *y)
{
    for (size_t k = 0; k < m->count; ++k) {
        y[k] = m->y[k] + s * m->difference[k];
    }
    for (size_t k = 0; k + SE3DI_STATE_WORK < m->count; k += SE3DI_STATE_SIZE) {
        const double *rate = m->difference + k + 7;
        double turn[3];
        for (size_t i = 0; i < 3; ++i) {
            y[k + i] += 0.5 * s * s * rate[i];
            turn[i] = s * (m->y[k + 10 + i] + 0.5 * s * rate[3 + i]);
        }
        se3di_quat_rotate(m->y + k + 3, turn, y + k + 3);
    }
}

void se3di_bdf_bend(se3di_bdf *m, const double *jump, const double work[SE3DI_STATE_WORK])
{
    const size_t first = m->count - SE3DI_STATE_WORK;
    for (int j = 1; j < (int)m->past->count; ++j) {
        const double s = m->times[j] - m->times[0];
        for (size_t k = 0; k + SE3DI_STATE_WORK < m->count; k += SE3DI_STATE_SIZE) {
            double *y = m->points + (size_t)j * m->count + k;
            double curve[4];
            se3di_quat_rate(m->points + k + 3, jump + k + 10, curve);
            for (int i = 0; i < 3; ++i) {
                y[i] += 0.5 * s * s * jump[k + 7 + (size_t)i];
            }
            for (int i = 0; i < 4; ++i) {
                y[3 + i] += 0.5 * s * s * curve[i];
            }
            for (int i = 7; i < SE3DI_STATE_SIZE; ++i) {
                y[i] += s * jump[k + (size_t)i];
            }
        }
        for (size_t k = 0; k < SE3DI_STATE_WORK; ++k) {
            m->points[(size_t)j * m->count + first + k] += work[k] + s * jump[first + k];
        }
    }
}
