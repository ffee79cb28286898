/* SPDX-License-Identifier: BSD-3-Clause */
/* A smooth f obeys f1 - f0 = h/2 (f0' + f1') + O(h^3). If it does not, the interval is halved,
 * always towards the half that misses more; f jumps if it still changes in the last one, as short
 * as the times are resolved. */
#include "nonlinear/jump.h"

#include "base/floats.h"
#include "expression/expression.h"
#include "model/integral.h"

#include <math.h>
#include <stdio.h>

#define LEAST     1e-6      /* relative: smaller ones are no jump */
#define RESOLVED  4e-16     /* relative length of the last interval */
#define PARTS_MAX 64.0      /* of one run */
#define CELL      0.0078125 /* s, between looks for kinks: a power of two, */
#define CELLS_MAX 1024.0    /* twice, four times ... as much if there were more of them */
#define DEPTH_MAX 8         /* of parts of a cell */
#define LEFT_MOST 0.4       /* of what a rule misses, by halving: a smooth function leaves 1/4 */
#define ZERO      1e-15     /* s: no cell is resolved as finely */
#define TWO_PI    6.283185307179586

typedef struct point {
    double t, f, d; /* time, value, derivative */
} point;

typedef struct search {
    const se3di_function *function;
    int derivative;
    int wraps; /* whole turns are no jump */
} search;

/* A value that cannot be computed ends the search. */
static int eval(const search *s, double t, point *p)
{
    const int of_rate = s->function->integral && s->derivative > 0;
    const se3di_function rate =
        of_rate ? se3di_integral_rate(s->function) : (se3di_function){.expression = NULL};
    const int derivative = s->derivative - of_rate;
    double jet[3];
    if (se3di_function_eval(of_rate ? &rate : s->function, &t, jet, NULL) < 0) {
        return 0;
    }
    *p = (point){t, jet[derivative], jet[derivative + 1]};
    return 1;
}

static double change(const search *s, const point *a, const point *b)
{
    const double d = b->f - a->f;
    return s->wraps && s->derivative == 0 ? d - TWO_PI * se3di_nearest(d / TWO_PI) : d;
}

static double miss(const search *s, const point *a, const point *b)
{
    return fabs(change(s, a, b) - 0.5 * (b->t - a->t) * (a->d + b->d));
}

/* `scale`: smaller ones are no jump. */
static int look_between(const search *s, point a, point b, double scale, se3di_jump *jump)
{
    const double shortest = RESOLVED * fmax(fmax(fabs(a.t), fabs(b.t)), b.t - a.t);
    while (miss(s, &a, &b) > scale && b.t - a.t > shortest) {
        point middle;
        const double t = a.t + 0.5 * (b.t - a.t);
        if (!(t > a.t && t < b.t) || !eval(s, t, &middle)) {
            break;
        }
        if (miss(s, &a, &middle) >= miss(s, &middle, &b)) {
            b = middle;
        } else {
            a = middle;
        }
    }
    *jump = (se3di_jump){.t = b.t, .before = a.f, .after = b.f};
    return b.t - a.t <= 4.0 * shortest && fabs(change(s, &a, &b)) > scale;
}

static int look(const search *s, const double range[2], int parts, se3di_jump *jump)
{
    point a;
    point b;
    if (s->function->integral && s->derivative == 0) { /* it has none, its rate may have */
        return 0;
    }
    if (!eval(s, range[0], &a)) {
        return 0;
    }
    for (int k = 1; k <= parts; ++k, a = b) {
        const double t = k < parts ? range[0] + (range[1] - range[0]) * k / parts : range[1];
        if (!eval(s, t, &b)) {
            return 0;
        }
        const double scale = LEAST * fmax(fmax(fabs(a.f), fabs(b.f)), 1e-3);
        if (look_between(s, a, b, scale, jump)) {
            return 1;
        }
    }
    return 0;
}

int se3di_jump_find(const se3di_assembly *assembly, const double range[2], int parts, int highest,
                    se3di_jump *jump)
{
    const se3di_model *model = assembly->model;
    for (int derivative = 0; derivative <= highest; ++derivative) {
        for (uint32_t timed = 0; timed < assembly->timed_count; ++timed) {
            const uint32_t row = assembly->timed_rows[timed];
            const search s = {&model->functions[model->rows[row].function], derivative,
                              model->rows[row].wrap};
            if (look(&s, range, parts, jump)) {
                jump->row = row;
                jump->derivative = derivative;
                return 1;
            }
        }
    }
    return 0;
}

/* Rates on both sides have limits: one that grows without bound is no jump. */
static int has_limits(const search *s, const point *a, const point *b, double apart)
{
    point outer[2];
    const double most = 0.1 * fabs(b->f - a->f);
    return eval(s, a->t - apart, &outer[0]) && eval(s, b->t + apart, &outer[1]) &&
           fabs(outer[0].f - a->f) <= most && fabs(outer[1].f - b->f) <= most;
}

/* The kink that `jump` of `s` is, if it is one. */
static int refine(const search *s, const se3di_jump *jump, double apart, se3di_kink *kink)
{
    point after = {.t = jump->t, .f = jump->after};
    point before = {.t = nextafter(jump->t, -HUGE_VAL), .f = jump->before};
    for (int back = 0; back < 8 && eval(s, before.t, &before) &&
                       fabs(before.f - jump->before) > fabs(before.f - jump->after);
         ++back) {
        after.t = before.t; /* it is within the last few steps of rounding */
        before.t = nextafter(before.t, -HUGE_VAL);
    }
    if (fabs(jump->t) < ZERO && !(fabs(before.f - jump->before) < fabs(before.f - jump->after))) {
        before.t = 0.0; /* near which times are finer than the search */
        (void)eval(s, before.t, &before);
    }
    kink->t = after.t;
    kink->t_before = before.t;
    kink->derivative = s->derivative;
    return has_limits(s, &before, &after, 1e-8 * fmax(apart, 1e-3));
}

/* One kink, of the rate or of the value, between a and b. */
static int look_for_kink(const search *value, double a, double b, se3di_kink *kink)
{
    const double range[2] = {a, b};
    const search rate = {value->function, 1, 0};
    se3di_jump jump;
    return (look(&rate, range, 1, &jump) && refine(&rate, &jump, b - a, kink)) ||
           (look(value, range, 1, &jump) && refine(value, &jump, b - a, kink));
}

/* The rate may jump up and down between a and b, with equal rates at both ends: what the
 * trapezoidal rule misses of the value does not fall as it should where the part is halved. */
static int hides_kinks(const search *value, double a, double b)
{
    point left, middle, right;
    if (!eval(value, a, &left) || !eval(value, a + 0.5 * (b - a), &middle) ||
        !eval(value, b, &right)) {
        return 0;
    }
    const double whole = miss(value, &left, &right);
    const double halves = miss(value, &left, &middle) + miss(value, &middle, &right);
    return whole > LEAST * fmax(fmax(fabs(left.f), fabs(right.f)), 1e-3) &&
           halves > LEFT_MOST * whole;
}

/* The first kink after `from` between a and b. */
static int find_first(const search *value, const double range[2], double from, int depth,
                      se3di_kink *kink)
{
    const double a = range[0], b = range[1];
    se3di_kink one;
    if (!(b > from) || !(b > a) || depth > DEPTH_MAX) {
        return 0;
    }
    const int found = look_for_kink(value, a, b, &one);
    if (!found && !hides_kinks(value, a, b)) {
        return 0;
    }
    const double middle = a + 0.5 * (b - a);
    const double first[2] = {a, found ? one.t_before : middle};
    const double second[2] = {found ? one.t : middle, b};
    if (find_first(value, first, from, depth + 1, kink)) {
        return 1;
    }
    if (found && one.t > from) {
        *kink = one;
        return 1;
    }
    return find_first(value, second, from, depth + 1, kink);
}

/* Of one function, up to `to`. */
static int find_in_cells(const search *value, double from, double to, se3di_kink *kink)
{
    double cell = CELL;
    while (to - from > CELLS_MAX * cell) {
        cell *= 2.0;
    }
    for (double k = floor(from / cell); k * cell < to; k += 1.0) {
        const double range[2] = {k * cell, (k + 1.0) * cell};
        if (find_first(value, range, from, 0, kink)) {
            return kink->t <= to;
        }
    }
    return 0;
}

static int may_have_kinks(const se3di_function *function)
{
    return !function->callback && function->expression &&
           !se3di_expression_is_smooth(function->expression);
}

int se3di_kink_find(const se3di_assembly *assembly, double from, double to, se3di_kink *kink)
{
    const se3di_model *model = assembly->model;
    int found = 0;
    for (uint32_t timed = 0; timed < assembly->timed_count && to > from; ++timed) {
        const uint32_t row = assembly->timed_rows[timed];
        const search value = {&model->functions[model->rows[row].function], 0,
                              model->rows[row].wrap};
        se3di_kink one;
        if (may_have_kinks(value.function) && find_in_cells(&value, from, to, &one)) {
            *kink = one;
            kink->row = row;
            to = nextafter(one.t, -HUGE_VAL); /* an earlier one counts */
            found = 1;
        }
    }
    return found;
}

int se3di_jump_is_between(const se3di_function *function, double t0, double t1)
{
    const search s = {.function = function};
    const double range[2] = {t0, t1};
    se3di_jump jump;
    return look(&s, range, 1, &jump);
}

void se3di_jump_format(const se3di_model *model, const se3di_jump *jump, char *text, size_t size)
{
    char name[128];
    se3di_row_name(model, jump->row, name, sizeof name);
    snprintf(text, size,
             "the %s of %s jumps from %.6g to %.6g at t = %.9g s; no motion does: "
             "smooth it, for example with step(t, t0, f0, t1, f1)",
             jump->derivative > 0 ? "rate" : "value", name, jump->before, jump->after, jump->t);
}

se3d_status se3di_jump_refuse(const se3di_assembly *assembly, double t_end, double step,
                              se3di_error *error)
{
    const double range[2] = {assembly->model->time, t_end};
    const int parts = (int)fmin(PARTS_MAX, fmax(1.0, ceil((t_end - range[0]) / step - 1e-9)));
    se3di_jump jump;
    char text[300];
    if (assembly->timed_count == 0 || !se3di_jump_find(assembly, range, parts, 0, &jump)) {
        return SE3D_OK;
    }
    se3di_jump_format(assembly->model, &jump, text, sizeof text);
    se3di_error_set(error, SE3D_ERR_INCONSISTENT, "%s", text);
    if (error) {
        error->cause = SE3DI_CAUSE_JUMP;
    }
    return SE3D_ERR_INCONSISTENT;
}
