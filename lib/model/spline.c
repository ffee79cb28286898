/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/spline.h"

#include "math/sum.h"

#include <math.h>
#include <stdbool.h>

/* ---- building -------------------------------------------------------------------------------*/

/* Second derivatives m of the natural spline: the tridiagonal system
 *     h_{k-1} m_{k-1} + 2 (h_{k-1} + h_k) m_k + h_k m_{k+1} = 6 (s_k - s_{k-1}),  m_0 = m_{n-1} = 0
 */
static void build_natural(const double *x, const double *y, size_t n, double *m, double *scratch)
{
    m[0] = 0.0;
    m[n - 1] = 0.0;
    scratch[0] = 0.0;
    for (size_t k = 1; k + 1 < n; ++k) {
        double before = x[k] - x[k - 1];
        double after = x[k + 1] - x[k];
        double pivot = 2.0 * (before + after) - before * scratch[k - 1];
        double right = 6.0 * ((y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before);
        scratch[k] = after / pivot;
        m[k] = (right - before * m[k - 1]) / pivot;
    }
    for (size_t k = n - 1; k-- > 1;) {
        m[k] -= scratch[k] * m[k + 1];
    }
}

/* Of the periodic one: the same equations round the circle, m_0 = m_{n-1}. Point 0 is left for the
 * end: m_k = p_k - q_k m_0, with p and q from the tridiagonal system of the others. */
static void build_periodic(const double *x, const double *y, size_t n, double *m, double *scratch)
{
    double *upper = scratch; /* after / pivot */
    double *q = scratch + n;
    const double first = x[1] - x[0];
    const double last = x[n - 1] - x[n - 2];
    upper[0] = m[0] = q[0] = 0.0;
    for (size_t k = 1; k + 1 < n; ++k) {
        const double before = x[k] - x[k - 1];
        const double after = x[k + 1] - x[k];
        const double pivot = 2.0 * (before + after) - before * upper[k - 1];
        const double right = 6.0 * ((y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before);
        const double corner = (k == 1 ? before : 0.0) + (k + 2 == n ? after : 0.0);
        upper[k] = k + 2 < n ? after / pivot : 0.0;
        m[k] = (right - before * m[k - 1]) / pivot;
        q[k] = (corner - before * q[k - 1]) / pivot;
    }
    for (size_t k = n - 2; k-- > 1;) {
        m[k] -= upper[k] * m[k + 1];
        q[k] -= upper[k] * q[k + 1];
    }
    const double right = 6.0 * ((y[1] - y[0]) / first - (y[n - 1] - y[n - 2]) / last);
    m[0] = (right - last * m[n - 2] - first * m[1]) /
           (2.0 * (last + first) - last * q[n - 2] - first * q[1]);
    for (size_t k = 1; k + 1 < n; ++k) {
        m[k] -= q[k] * m[0];
    }
    m[n - 1] = m[0];
}

/* Slopes at the points by Akima (1970), eqs. (1) and (8): the mean of those before and behind,
 * s_{k-1} and s_k, each weighed by how much the slopes of the other side differ. Two slopes are
 * added at each end, those of a parabola through the last three points. */
static void build_akima(const se3di_spline *t, double *m, double *scratch)
{
    const size_t n = t->n;
    double *s = scratch + 2; /* s[k] of the interval k; [-2], [-1], [n - 1], [n] are added */
    for (size_t k = 0; k + 1 < n; ++k) {
        s[k] = (t->y[k + 1] - t->y[k]) / (t->x[k + 1] - t->x[k]);
    }
    if (t->periodic) {
        scratch[0] = s[n - 3];
        scratch[1] = s[n - 2];
        s[n - 1] = s[0];
        s[n] = s[1];
    } else {
        scratch[1] = n > 2 ? 2.0 * s[0] - s[1] : s[0];
        scratch[0] = 2.0 * scratch[1] - s[0];
        s[n - 1] = n > 2 ? 2.0 * s[n - 2] - s[n - 3] : s[0];
        s[n] = 2.0 * s[n - 1] - s[n - 2];
    }
    for (size_t k = 0; k < n; ++k) {
        const double *a = scratch + k; /* s[k - 2] ... s[k + 1] */
        const double of_next = fabs(a[1] - a[0]);
        const double of_last = fabs(a[3] - a[2]);
        const double sum = of_next + of_last;
        m[k] = sum > 0.0 ? (of_last * a[1] + of_next * a[2]) / sum : 0.5 * (a[1] + a[2]);
    }
}

size_t se3di_spline_scratch_size(size_t n)
{
    return 2 * n + 4;
}

void se3di_spline_build(const se3di_spline *s, double *m, double *scratch)
{
    if (s->kind == SE3D_TABLE_AKIMA) {
        build_akima(s, m, scratch);
    } else if (s->kind == SE3D_TABLE_LINEAR) {
        for (size_t k = 0; k < s->n; ++k) {
            m[k] = 0.0;
        }
    } else if (s->periodic) {
        build_periodic(s->x, s->y, s->n, m, scratch);
    } else {
        build_natural(s->x, s->y, s->n, m, scratch);
    }
}

/* ---- values ---------------------------------------------------------------------------------*/

/* Index of the interval that holds u; outside the first or last one. */
static size_t find(const double *x, size_t n, double u)
{
    size_t low = 0;
    size_t high = n - 1;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (x[middle] <= u) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static void eval_cubic(const se3di_spline *s, size_t k, double u, double jet[3])
{
    const double *x = s->x, *y = s->y, *m = s->m;
    double h = x[k + 1] - x[k];
    double a = (x[k + 1] - u) / h;
    double b = (u - x[k]) / h;
    jet[0] = a * y[k] + b * y[k + 1] +
             ((a * a * a - a) * m[k] + (b * b * b - b) * m[k + 1]) * h * h / 6.0;
    jet[1] = (y[k + 1] - y[k]) / h +
             ((1.0 - 3.0 * a * a) * m[k] + (3.0 * b * b - 1.0) * m[k + 1]) * h / 6.0;
    jet[2] = a * m[k] + b * m[k + 1];
}

/* In interval k, u behind its point: y + c[1] u + c[2] u^2 + c[3] u^3, of those that are no cubic
 * splines. */
static void find_piece(const se3di_spline *s, size_t k, double c[4])
{
    const double h = s->x[k + 1] - s->x[k];
    const double slope = (s->y[k + 1] - s->y[k]) / h;
    const bool bent = s->kind == SE3D_TABLE_AKIMA;
    c[0] = s->y[k];
    c[1] = bent ? s->m[k] : slope;
    c[2] = bent ? (3.0 * slope - 2.0 * s->m[k] - s->m[k + 1]) / h : 0.0;
    c[3] = bent ? (s->m[k] + s->m[k + 1] - 2.0 * slope) / (h * h) : 0.0;
}

static void eval_piece(const se3di_spline *s, size_t k, double u, double jet[3])
{
    double c[4];
    find_piece(s, k, c);
    u -= s->x[k];
    jet[0] = c[0] + u * (c[1] + u * (c[2] + u * c[3]));
    jet[1] = c[1] + u * (2.0 * c[2] + 3.0 * u * c[3]);
    jet[2] = 2.0 * c[2] + 6.0 * u * c[3];
}

/* The place in the first period, and how many there are before. */
static double wrap(const se3di_spline *s, double u, double *periods)
{
    const double first = s->x[0], last = s->x[s->n - 1];
    *periods = floor((u - first) / (last - first));
    u -= *periods * (last - first);
    return fmin(fmax(u, first), last);
}

void se3di_spline_eval(const se3di_spline *s, double u, double jet[3])
{
    const double *x = s->x;
    double periods = 0.0;
    if (s->periodic) {
        u = wrap(s, u, &periods);
    }
    const size_t k = find(x, s->n, u);
    const double inside = fmin(fmax(u, x[0]), x[s->n - 1]);
    if (s->kind == SE3D_TABLE_CUBIC) {
        eval_cubic(s, k, inside, jet);
    } else {
        eval_piece(s, k, inside, jet);
    }
    if (u < x[0] || u > x[s->n - 1]) {
        jet[0] += jet[1] * (u - inside);
        jet[2] = 0.0;
    }
}

/* ---- integrals ------------------------------------------------------------------------------*/

/* From point k, u further: of a cubic spline y + s u + m u^2/2 + ..., with second derivatives
 * m, m_next that change linearly. */
static double integrate_piece(const se3di_spline *s, size_t k, double u)
{
    const double *x = s->x, *y = s->y, *m = s->m;
    double c[4];
    if (s->kind == SE3D_TABLE_CUBIC) {
        const double h = x[k + 1] - x[k];
        const double slope = (y[k + 1] - y[k]) / h - h * (2.0 * m[k] + m[k + 1]) / 6.0;
        return u *
               (y[k] + u * (slope / 2.0 + u * (m[k] / 6.0 + u * (m[k + 1] - m[k]) / (24.0 * h))));
    }
    find_piece(s, k, c);
    return u * (c[0] + u * (c[1] / 2.0 + u * (c[2] / 3.0 + u * c[3] / 4.0)));
}

void se3di_spline_integrate(const se3di_spline *s, double *knots)
{
    se3di_sum total = {0.0, 0.0};
    knots[0] = 0.0;
    for (size_t k = 1; k < s->n; ++k) {
        se3di_sum_add(&total, integrate_piece(s, k - 1, s->x[k] - s->x[k - 1]));
        knots[k] = total.high + total.low;
    }
}

/* Slopes beyond the ends. */
static double first_slope(const se3di_spline *s)
{
    const double h = s->x[1] - s->x[0];
    if (s->kind == SE3D_TABLE_AKIMA) {
        return s->m[0];
    }
    return (s->y[1] - s->y[0]) / h - h * s->m[1] / 6.0;
}

static double last_slope(const se3di_spline *s)
{
    const size_t n = s->n;
    const double h = s->x[n - 1] - s->x[n - 2];
    if (s->kind == SE3D_TABLE_AKIMA) {
        return s->m[n - 1];
    }
    return (s->y[n - 1] - s->y[n - 2]) / h + h * s->m[n - 2] / 6.0;
}

double se3di_spline_integral(const se3di_spline *s, const double *knots, double t)
{
    const size_t n = s->n;
    const double *x = s->x, *y = s->y;
    double periods = 0.0;
    if (s->periodic) {
        t = wrap(s, t, &periods);
    }
    if (t < x[0]) {
        const double u = t - x[0];
        return u * (y[0] + 0.5 * u * first_slope(s));
    }
    if (t > x[n - 1]) {
        const double u = t - x[n - 1];
        return knots[n - 1] + u * (y[n - 1] + 0.5 * u * last_slope(s));
    }
    const size_t k = find(x, n, t);
    const double part = knots[k] + integrate_piece(s, k, t - x[k]);
    return s->periodic ? periods * knots[n - 1] + part : part;
}
