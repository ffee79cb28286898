/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of measures f with respect to a parameter p, by runs of the model beside it.
 *
 *     D(h) = (f(p + h) - f(p - h)) / 2h = f' + c1 h^2 + c2 h^4 + ...
 *
 * at h, h/2, h/4, ... and extrapolated to h = 0 (Richardson 1911; Ridders 1982): with n steps the
 * error is of order h^2n. Each measure takes the entry of its table that differs least from its
 * neighbours; this difference, with the rounding of f, is the estimated error. If the slopes of
 * the two sides do not come together f has a corner, and half of their difference is the error.
 * If f has values on one side only, at a bound or where runs fail,
 *
 *     D(h) = (f(p + h) - f(p)) / h = f' + c1 h + c2 h^2 + ...
 *
 * is extrapolated in the same way: n steps, n runs, an error of order h^n.
 * docs/theory/sensitivities.md */
#include <float.h>
#include <math.h>
#include <string.h>

#include "io/study/study.h"

#define GOOD   1e-13 /* relative error at which further steps are not worth their runs */
#define NOISE  50.0  /* times the rounding: what is more is no rounding */
#define SAFETY 2.0   /* of estimates */
#define WILD   0.1   /* of the slope: a change by less is no sign of a root */
#define LEAST  1e-6  /* of f: what changes by less may be the error of a run */
enum { RETRIES = 8 };

/* A table of slopes of one measure. */
typedef struct column {
    double row[SE3DI_STUDY_LEVELS]; /* of the last step: i extrapolations in row[i] */
    size_t count;                   /* steps without a gap so far */
    double best, error;             /* error HUGE_VAL: none yet */
    double bend, corner;            /* how far the slopes of both sides are apart */
    bool is_wild;                   /* slopes of one side do not come to an end */
    bool is_open;                   /* another step may be worth its runs */
} column;

/* Those of both sides together, and of each. */
typedef struct tables {
    column both, sides[2];
} tables;

/* The bend halves with the step where f is smooth. */
static void judge_corner(column *c, double bend, double rounding)
{
    c->corner = c->count > 0 && bend > 0.75 * c->bend && bend > NOISE * rounding ? 0.5 * bend : 0.0;
    c->bend = bend;
}

/* So does the change of the slope of one side; that of a root or of a jump grows. */
static void judge_side(column *c, double slope, double least)
{
    const double change = c->count > 0 ? fabs(slope - c->row[0]) : 0.0;
    c->is_wild =
        c->count > 1 && change > 0.75 * c->bend && change > WILD * fabs(slope) && change > least;
    c->bend = change;
}

/* Take the slope of another step, half of the one before; what extrapolations take away falls by
 * the powers of `ratio`. */
static void add_slope(column *c, double slope, double rounding, double ratio)
{
    double value = slope;
    double weight = 1.0;
    bool is_better = false;
    if (c->count == 0 && !(c->error < HUGE_VAL)) {
        c->best = value;
    }
    for (size_t i = 0; i < c->count; ++i) {
        const double before = c->row[i];
        weight *= ratio;
        const double next = value + (value - before) / (weight - 1.0);
        const double apart = fmax(fabs(next - value), fabs(next - before));
        const double error = SAFETY * (apart + rounding);
        c->row[i] = value;
        value = next;
        if (error < c->error) {
            c->best = next;
            c->error = error;
            is_better = true;
        }
    }
    c->row[c->count++] = value;
    c->is_open = (is_better || c->count < 4) && c->error > GOOD * fabs(c->best);
}

/* @return whether there is room for a step that has this slope. */
static bool begin_step(column *c, double slope)
{
    c->count = isfinite(slope) ? c->count : 0;
    c->is_open = !isfinite(slope);
    return isfinite(slope) && c->count < SE3DI_STUDY_LEVELS;
}

/* Take the values below, at and above p: f[i + 1] - f[i] over the distance h[i]. */
static void add_step(tables *t, const double f[3], const double h[2])
{
    const double apart = 0.5 * (h[0] + h[1]); /* as it is after rounding */
    const double most = fmax(fabs(f[0]), fmax(fabs(f[1]), fabs(f[2])));
    const double slope = (f[2] - f[0]) / (2.0 * apart);
    if (begin_step(&t->both, slope)) {
        const double rounding = DBL_EPSILON * most / apart;
        judge_corner(&t->both, fabs((f[2] - f[1]) - (f[1] - f[0])) / apart, rounding);
        add_slope(&t->both, slope, rounding, 4.0);
    }
    for (size_t i = 0; i < 2; ++i) {
        column *c = &t->sides[i];
        const double size = fmax(fabs(f[i]), fabs(f[i + 1])) / h[i];
        const double own = (f[i + 1] - f[i]) / h[i];
        if (begin_step(c, own)) {
            judge_side(c, own, LEAST * size);
            add_slope(c, own, 2.0 * DBL_EPSILON * size, 2.0);
        }
    }
}

/* Whether another step is worth its runs. */
static bool is_open(const tables *t)
{
    return t->both.count > 0 ? t->both.is_open : t->sides[0].is_open && t->sides[1].is_open;
}

/* That of both sides, else that of the better one; NULL: there is no derivative. */
static const column *choose(const tables *t)
{
    const column *best = NULL;
    if (t->both.error < HUGE_VAL) {
        return &t->both;
    }
    for (size_t i = 0; i < 2; ++i) {
        const column *c = &t->sides[i];
        if (c->error < HUGE_VAL && !c->is_wild && (!best || c->error < best->error)) {
            best = c;
        }
    }
    return best;
}

/* The measures at p + shift. A run that fails has none, which is no failure here; nor has what is
 * outside of the bounds. */
static se3d_status eval_beside(se3d_study *study, const se3di_study_point *point, double p,
                               double shift, double *measures)
{
    se3d_model_error error;
    double *value = &point->values[point->which].value.v[0];
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        measures[k] = (double)NAN;
    }
    if ((shift < 0.0 && p + shift < point->bounds[0]) ||
        (shift > 0.0 && p + shift > point->bounds[1])) {
        return SE3D_OK;
    }
    *value = p + shift;
    const se3d_status status =
        se3di_study_run(study, point->values, point->count, measures, &error);
    *value = p;
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_INTERRUPTED ? status : SE3D_OK;
}

/* One more step in all tables. */
static se3d_status take_step(se3d_study *study, const se3di_study_point *point, double h,
                             const double *centre, tables *all, double *const sides[2])
{
    const double p = point->values[point->which].value.v[0];
    const double apart[2] = {p - (p - h), (p + h) - p};
    se3d_status status = SE3D_OK;
    if (!point->beside) {
        status = eval_beside(study, point, p, -h, sides[0]);
    }
    if (!point->beside && status >= 0) {
        status = eval_beside(study, point, p, h, sides[1]);
    }
    for (size_t k = 0; k < study->entry->measure_count && status >= 0; ++k) {
        const double f[3] = {sides[0][k], centre[k], sides[1][k]};
        add_step(&all[k], f, apart);
    }
    return status;
}

static se3d_status take_steps(se3d_study *study, const se3di_study_point *point,
                              const double *centre, tables *all, double *const sides[2])
{
    double h = se3di_study_first_step(point);
    size_t rounds = point->levels;
    se3d_status status = SE3D_OK;
    bool open = true;
    for (size_t k = 0; k < rounds && open && status >= 0; ++k, h *= 0.5) {
        status =
            take_step(study, point, h, centre, all, point->beside ? point->beside + 2 * k : sides);
        size_t failed = 0; /* on one side at least */
        open = false;
        for (size_t i = 0; i < study->entry->measure_count; ++i) {
            const bool wants = isfinite(centre[i]) && is_open(&all[i]);
            open = open || wants;
            failed += wants && all[i].both.count == 0;
        }
        rounds += failed > 0 && !point->beside && rounds < point->levels + RETRIES;
    }
    return status;
}

double se3di_study_first_step(const se3di_study_point *point)
{
    return ldexp(1.0, ilogb(point->step));
}

static void begin_table(tables *t)
{
    column *const columns[] = {&t->both, &t->sides[0], &t->sides[1]};
    for (size_t k = 0; k < sizeof columns / sizeof *columns; ++k) {
        columns[k]->error = HUGE_VAL;
        columns[k]->best = (double)NAN;
        columns[k]->is_open = true;
    }
}

se3d_status se3di_study_differentiate(se3d_study *study, const se3di_study_point *point,
                                      const double *centre)
{
    const size_t count = study->entry->measure_count;
    se3di_iopool pool;
    se3di_iopool_init(&pool, &study->pool.allocator);
    tables *all = se3di_iopool_array(&pool, count, sizeof *all);
    double *values = se3di_iopool_array(&pool, 2 * count, sizeof *values);
    se3d_status status = all && values ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    for (size_t k = 0; k < count && status >= 0; ++k) {
        begin_table(&all[k]);
    }
    if (status >= 0) {
        double *sides[2] = {values, values + count};
        status = take_steps(study, point, centre, all, sides);
    }
    for (size_t k = 0; k < count; ++k) {
        const column *c = status >= 0 && isfinite(centre[k]) ? choose(&all[k]) : NULL;
        point->derivatives[k] = c ? c->best : (double)NAN;
        if (point->errors) {
            point->errors[k] = c ? fmax(c->error, c->corner) : (double)NAN;
        }
    }
    se3di_iopool_destroy(&pool);
    return status;
}
