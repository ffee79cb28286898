/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/crossing.h"

#include "base/error.h"

#include <float.h>
#include <math.h>

#define DIP_TRIES   4
#define DIP_NEAR    0.6 /* of the smaller end: a parabola that stays above it is no dip to zero */
#define BISECT_EACH 4   /* iterations in which the bracket must have halved */
#define BACK_PARTS  64.0

typedef struct bracket {
    double a, b;   /* not reached, reached */
    double ga, gb; /* values there */
    double side;   /* sign before the crossing */
} bracket;

static double sign_of(double g)
{
    return g > 0.0 ? 1.0 : g < 0.0 ? -1.0 : 0.0;
}

/* The same, 0 in the band. */
static double side_of(const se3di_crossing_function *f, double g)
{
    return fabs(g) > f->band ? sign_of(g) : 0.0;
}

/* side * g is > 0 as long as zero has not been reached. */
static int reached(double side, double g)
{
    return !(side * g > 0.0);
}

/* Move an end outwards until it is on its side: what is cheap to know and what counts may differ
 * near a zero. @return 0: there is no crossing here */
static int widen(const se3di_crossing_function *f, bracket *k, se3d_status *status)
{
    const double begin = f->t[0], end = f->t[f->count - 1];
    double width = k->b - k->a;
    *status = f->exact(f->ctx, k->a, &k->ga);
    for (; *status >= 0 && reached(k->side, k->ga) && k->a > begin; width *= 2.0) {
        k->b = k->a;
        k->a = fmax(begin, k->a - width);
        *status = f->exact(f->ctx, k->a, &k->ga);
    }
    if (*status < 0 || reached(k->side, k->ga)) {
        return 0;
    }
    *status = f->exact(f->ctx, k->b, &k->gb);
    for (; *status >= 0 && !reached(k->side, k->gb) && k->b < end; width *= 2.0) {
        k->a = k->b;
        k->ga = k->gb;
        k->b = fmin(end, k->b + width);
        *status = f->exact(f->ctx, k->b, &k->gb);
    }
    return *status >= 0 && reached(k->side, k->gb);
}

/* Regula falsi with the weights of Anderson and Bjoerck (1973), bisection if that is slow; steps
 * of at least half the tolerance, so that the bracket closes from both sides. */
static se3d_status close_bracket(const se3di_crossing_function *f, bracket *k)
{
    double wa = k->ga, wb = k->gb; /* weighted values */
    double width = k->b - k->a;
    const double step = f->t[f->count - 1] - f->t[0];
    for (int n = 1;; ++n) {
        const double tolerance =
            2.0 * DBL_EPSILON * fmax(fabs(k->a), fabs(k->b)) + 0.25 * DBL_EPSILON * step;
        const double middle = k->a + 0.5 * (k->b - k->a);
        if (k->b - k->a <= tolerance || !(middle > k->a && middle < k->b) || !(fabs(k->gb) > 0.0)) {
            return SE3D_OK;
        }
        double x = k->b - wb * (k->b - k->a) / (wb - wa);
        if (n % BISECT_EACH == 0) {
            x = k->b - k->a > 0.5 * width ? middle : x;
            width = k->b - k->a;
        }
        x = fmin(fmax(x, k->a + 0.5 * tolerance), k->b - 0.5 * tolerance);
        x = x > k->a && x < k->b ? x : middle;
        double g;
        SE3DI_TRY(f->exact(f->ctx, x, &g));
        const int right = reached(k->side, g);
        const double ratio = 1.0 - g / (right ? k->gb : k->ga);
        const double weight = ratio > 0.0 ? ratio : 0.5;
        if (right) {
            k->b = x;
            k->gb = wb = g;
            wa *= weight;
        } else {
            k->a = x;
            k->ga = wa = g;
            wb *= weight;
        }
    }
}

/* Whether the states that count have been beyond the band on `side` at t or before it: what is
 * rough may leave the band if they do not. *yes is set. */
static se3d_status was_beyond(const se3di_crossing_function *f, double t, double g, double side,
                              int *yes)
{
    const double begin = f->t[0];
    double width = (f->t[f->count - 1] - begin) / BACK_PARTS;
    *yes = side * g > f->band;
    for (; !*yes && t > begin; width *= 2.0) {
        t = fmax(begin, t - width);
        SE3DI_TRY(f->exact(f->ctx, t, &g));
        *yes = side * g > f->band;
    }
    *yes = *yes || side * f->side > 0.0;
    return SE3D_OK;
}

typedef struct search {
    const se3di_crossing_function *f;
    se3di_crossings *found;
} search;

/* The crossing between a and b (rough ones), from `side`. */
static se3d_status locate(const search *s, double a, double b, double side)
{
    bracket k = {.a = a, .b = b, .side = side};
    se3di_crossings *found = s->found;
    se3d_status status;
    int counts = 0;
    if (found->count == SE3DI_CROSSINGS_MAX || (double)s->f->direction * side > 0.0) {
        return SE3D_OK;
    }
    if (!widen(s->f, &k, &status)) {
        return status;
    }
    SE3DI_TRY(was_beyond(s->f, k.a, k.ga, side, &counts));
    if (!counts) {
        return SE3D_OK;
    }
    SE3DI_TRY(close_bracket(s->f, &k));
    const int again = found->count > 0 && !(k.b > found->list[found->count - 1].t);
    if (!again) {
        found->list[found->count].t = k.b;
        found->list[found->count++].direction = side < 0.0 ? 1 : -1;
    }
    return SE3D_OK;
}

/* The lowest point of side * g on a parabola through three points; 0: it has none. */
static int find_vertex(const double t[3], const double g[3], double side, double *x, double *low)
{
    const double d01 = (g[1] - g[0]) / (t[1] - t[0]);
    const double d12 = (g[2] - g[1]) / (t[2] - t[1]);
    const double curvature = (d12 - d01) / (t[2] - t[0]);
    if (!(side * curvature > 0.0)) {
        return 0;
    }
    *x = 0.5 * (t[0] + t[1] - d01 / curvature);
    *low = side * (g[0] + (*x - t[0]) * (d01 + (*x - t[1]) * curvature));
    return 1;
}

/* A point between two nodes of one sign at which zero has been reached: successive parabolas. */
static se3d_status find_dip(const se3di_crossing_function *f, int node, int first, double side,
                            double *dip)
{
    double lo = f->t[node], hi = f->t[node + 1];
    double glo = f->g[node], ghi = f->g[node + 1];
    double t[3] = {f->t[first], f->t[first + 1], f->t[first + 2]};
    double g[3] = {f->g[first], f->g[first + 1], f->g[first + 2]};
    *dip = (double)NAN;
    for (int n = 0; n < DIP_TRIES; ++n) {
        double x, low, value;
        const double least = fmin(side * glo, side * ghi);
        if (!find_vertex(t, g, side, &x, &low) || !(x > lo && x < hi) || low > DIP_NEAR * least) {
            return SE3D_OK;
        }
        SE3DI_TRY(f->rough(f->ctx, x, &value));
        if (reached(side, value)) {
            *dip = x;
            return SE3D_OK;
        }
        if (!(side * value < least)) {
            return SE3D_OK;
        }
        if (n > 0) { /* keep the point that was the lowest as an end */
            const int before = t[1] < x;
            lo = before ? t[1] : lo;
            glo = before ? g[1] : glo;
            hi = before ? hi : t[1];
            ghi = before ? ghi : g[1];
        }
        t[0] = lo, t[1] = x, t[2] = hi;
        g[0] = glo, g[1] = value, g[2] = ghi;
    }
    return SE3D_OK;
}

/* Two crossings between two nodes of one sign, if there are any. */
static se3d_status look_between(const search *s, int node, double side)
{
    const se3di_crossing_function *f = s->f;
    double dip = (double)NAN;
    for (int first = node - 1; first <= node && isnan(dip); ++first) {
        if (first >= 0 && first + 2 < f->count) {
            SE3DI_TRY(find_dip(f, node, first, side, &dip));
        }
    }
    if (!isnan(dip)) {
        SE3DI_TRY(locate(s, f->t[node], dip, side));
        SE3DI_TRY(locate(s, dip, f->t[node + 1], -side));
    }
    return SE3D_OK;
}

/* The side after node k, before which it was `side`: kept in the band until zero is reached. */
static double next_side(const search *s, int node, double side, int crossed)
{
    const double g = s->f->g[node];
    const int stays = !crossed && !reached(side, g) && fabs(side) > 0.0;
    return stays ? side : side_of(s->f, g);
}

se3d_status se3di_crossings_find(const se3di_crossing_function *function, se3di_crossings *found)
{
    const search s = {.f = function, .found = found};
    const int last = function->count - 1;
    double side = side_of(function, function->g[0]);
    double beyond = function->t[0]; /* when it was last there */
    int known = 0;
    side = fabs(side) > 0.0 ? side : function->side;
    found->count = 0;
    found->side = 0;
    for (int k = 1; k <= last; ++k) {
        const int before = found->count;
        if (fabs(side) > 0.0) {
            SE3DI_TRY(reached(side, function->g[k])
                          ? locate(&s, function->t[k - 1], function->t[k], side)
                          : look_between(&s, k - 1, side));
        }
        side = next_side(&s, k, side, found->count > before);
        beyond = fabs(side_of(function, function->g[k])) > 0.0 ? function->t[k] : beyond;
    }
    if (fabs(side) > 0.0 && !(fabs(function->g[last]) > function->band)) {
        double g;
        SE3DI_TRY(function->exact(function->ctx, beyond, &g));
        SE3DI_TRY(was_beyond(function, beyond, g, side, &known));
    }
    found->side = known ? (int32_t)side : 0;
    return SE3D_OK;
}
