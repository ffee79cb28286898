/* SPDX-License-Identifier: BSD-3-Clause */
/* What a study seeks, for a method of optimisation: its parameters, its limits, and the measures
 * with their derivatives where it asks for them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/number.h"
#include "io/base/sized.h"
#include "io/document/document.h"
#include "io/read/study_goal.h"
#include "io/study/derive.h"
#include "io/study/follow.h"
#include "io/study/study.h"

/* Of differences of runs, two steps, extrapolated once: what a search needs. Models that follow
 * have no noise, and so little that rounding and the third derivative take 1e-10. */
enum { LEVELS = 2 };
#define SHARE  0.01   /* of from ... to: the first step */
#define FOLLOW 1.6e-5 /* of a parameter: the step of models that follow */
#define LEAST  1e-3   /* of from ... to: less counts as this much */

static const se3di_study_goal *get_goal(const se3d_study *study)
{
    return study ? study->entry->goal : NULL;
}

se3d_status se3d_study_get_goal_sized(const se3d_study *study, se3d_study_goal *goal, size_t size)
{
    const se3di_study_goal *from = get_goal(study);
    if (!study || !goal) {
        return SE3D_ERR_NULL;
    }
    if (!from) {
        return SE3D_ERR_STATE;
    }
    const se3d_study_goal filled = {.method = se3di_study_goal_get_method(from->method),
                                    .maximizes = from->greatest,
                                    .measure = from->measure,
                                    .evaluations = (uint64_t)from->evaluations,
                                    .tolerance = from->tolerance,
                                    .seed = (uint64_t)study->entry->seed};
    return se3di_io_give(goal, size, &filled, sizeof filled);
}

size_t se3d_study_count_unknowns(const se3d_study *study)
{
    const se3di_study_goal *goal = get_goal(study);
    return goal ? goal->unknown_count : 0;
}

const char *se3d_study_get_unknown_name(const se3d_study *study, size_t index)
{
    return index < se3d_study_count_unknowns(study) ? study->entry->goal->unknowns[index].name : "";
}

se3d_status se3d_study_get_unknown(const se3d_study *study, size_t index, double bounds[2],
                                   double *start)
{
    if (!study || !bounds || !start) {
        return SE3D_ERR_NULL;
    }
    if (index >= se3d_study_count_unknowns(study)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_study_unknown *u = &study->entry->goal->unknowns[index];
    bounds[0] = u->from;
    bounds[1] = u->to;
    *start = u->start;
    return SE3D_OK;
}

size_t se3d_study_count_limits(const se3d_study *study)
{
    const se3di_study_goal *goal = get_goal(study);
    return goal ? goal->limit_count : 0;
}

se3d_status se3d_study_get_limit(const se3d_study *study, size_t index, size_t *measure,
                                 double bounds[2])
{
    if (!study || !measure || !bounds) {
        return SE3D_ERR_NULL;
    }
    if (index >= se3d_study_count_limits(study)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_study_limit *limit = &study->entry->goal->limits[index];
    *measure = limit->measure;
    bounds[0] = limit->from;
    bounds[1] = limit->to;
    return SE3D_OK;
}

/* "kg*m^2/s": the SI unit as a model file takes it. */
static void put_unit(se3di_dimension d, char *text, size_t size)
{
    static const char *const words[] = {"m", "kg", "rad", "s"};
    const int exponents[] = {d.length, d.mass, d.angle, d.time};
    size_t used = 0;
    text[0] = '\0';
    for (int sign = 1; sign >= -1; sign -= 2) {
        for (size_t k = 0; k < 4; ++k) {
            const int exponent = sign * exponents[k];
            if (exponent <= 0) {
                continue;
            }
            const char *before = used == 0 ? (sign > 0 ? "" : "rad/") : sign > 0 ? "*" : "/";
            used += (size_t)snprintf(text + used, size - used, exponent > 1 ? "%s%s^%d" : "%s%s",
                                     before, words[k], exponent);
        }
    }
}

se3d_status se3d_study_write_unknown(const se3d_study *study, size_t index, double value,
                                     char *text, size_t size)
{
    char number[SE3DI_NUMBER_SIZE];
    char unit[60] = "";
    if (!study || !text) {
        return SE3D_ERR_NULL;
    }
    if (index >= se3d_study_count_unknowns(study) || size < SE3DI_NUMBER_SIZE + sizeof unit) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_amount *shape = &study->entry->goal->unknowns[index].shape;
    if (shape->hard) {
        put_unit(shape->dimension, unit, sizeof unit);
    }
    number[se3di_number_format(value, number)] = '\0';
    snprintf(text, size, "%s%s%s", number, unit[0] ? " " : "", unit);
    return SE3D_OK;
}

/* ---- measures --------------------------------------------------------------------------------*/

static se3d_status fail(const se3d_study *study, se3d_model_error *error, se3d_status status,
                        const char *text)
{
    se3di_document_report(error, study ? study->model->file : "", 0, 0, "", text);
    return status;
}

static se3d_status check(const se3d_study *study, const double *values, const double *measures,
                         se3d_model_error *error)
{
    if (!study || !values || !measures) {
        return fail(study, error, SE3D_ERR_NULL, "study, values or measures is NULL");
    }
    if (!get_goal(study)) {
        return fail(study, error, SE3D_ERR_STATE,
                    "the study has no `optimize`: which parameters are sought, and what for?");
    }
    if (study->is_running) {
        return fail(study, error, SE3D_ERR_STATE, "a sample of the study is being run");
    }
    for (size_t k = 0; k < study->entry->goal->unknown_count; ++k) {
        if (!isfinite(values[k])) {
            char text[120];
            snprintf(text, sizeof text, "%.60s = %g, must be finite",
                     study->entry->goal->unknowns[k].name, values[k]);
            return fail(study, error, SE3D_ERR_INVALID_ARGUMENT, text);
        }
    }
    return SE3D_OK;
}

/* The unknowns as parameters of a run; NULL: out of memory. */
static se3di_named *name_values(const se3d_study *study, const double *values, se3di_iopool *pool)
{
    const se3di_study_goal *goal = study->entry->goal;
    se3di_named *named = se3di_iopool_array(pool, goal->unknown_count, sizeof *named);
    for (size_t k = 0; named && k < goal->unknown_count; ++k) {
        named[k] = (se3di_named){goal->unknowns[k].name, goal->unknowns[k].shape};
        named[k].value.v[0] = values[k];
    }
    return named;
}

static se3di_study_point make_point(const se3d_study *study, size_t index, se3di_named *named,
                                    double *derivatives)
{
    const se3di_study_goal *goal = study->entry->goal;
    const se3di_study_unknown *u = &goal->unknowns[index];
    const double range = u->to - u->from;
    const double size = fmin(fmax(fabs(named[index].value.v[0]), LEAST * range), range);
    return (se3di_study_point){.values = named,
                               .count = goal->unknown_count,
                               .which = index,
                               .step = SHARE * range,
                               .follow_step = FOLLOW * size,
                               .bounds = {u->from, u->to},
                               .levels = LEVELS,
                               .derivatives = derivatives};
}

/* What a search asks at one point. */
typedef struct enquiry {
    size_t first, count; /* of the unknowns */
    double *measures;
    double *derivatives; /* [count][measure_count] */
} enquiry;

/* The measures and all derivatives, by one run if models can follow it. The bits of the measures
 * are those of a run that nobody follows. */
static se3d_status derive(se3d_study *study, const enquiry *q, se3di_named *named,
                          se3d_model_error *error)
{
    const size_t width = study->entry->measure_count;
    bool has_run;
    se3di_iopool pool;
    se3di_iopool_init(&pool, &study->pool.allocator);
    se3di_study_point *points = se3di_iopool_array(&pool, q->count, sizeof *points);
    bool *done = se3di_iopool_array(&pool, q->count, sizeof *done);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    for (size_t k = 0; points && done && k < q->count; ++k) {
        points[k] = make_point(study, q->first + k, named, q->derivatives + k * width);
    }
    if (points && done) {
        status = se3di_study_follow(study, points, q->count, q->measures, done, &has_run, error);
        if (!has_run && status >= 0) {
            status = se3di_study_run(study, named, study->entry->goal->unknown_count, q->measures,
                                     error);
        }
    }
    for (size_t k = 0; k < q->count && (status >= 0 || status == SE3D_ERR_NOT_FINITE); ++k) {
        const se3d_status told =
            done[k] ? SE3D_OK : se3di_study_differentiate(study, &points[k], q->measures);
        status = told < 0 ? told : status;
    }
    se3di_iopool_destroy(&pool);
    return status;
}

/* What is not told is NaN. */
static se3d_status eval(se3d_study *study, const enquiry *q, const double *values,
                        se3d_model_error *error)
{
    se3di_iopool pool;
    for (size_t k = 0; k < q->count * study->entry->measure_count; ++k) {
        q->derivatives[k] = (double)NAN;
    }
    memset(error, 0, sizeof *error);
    se3di_iopool_init(&pool, &study->pool.allocator);
    se3di_named *named = name_values(study, values, &pool);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    if (named && q->count > 0) {
        status = derive(study, q, named, error);
    } else if (named) {
        status =
            se3di_study_run(study, named, study->entry->goal->unknown_count, q->measures, error);
    }
    if (status < 0 && error->message[0] == '\0') {
        status = fail(study, error, status, se3d_status_get_text(status));
    }
    se3di_iopool_destroy(&pool);
    return status;
}

se3d_status se3di_study_eval_part(se3d_study *study, se3di_study_part part, const double *values,
                                  double *measures, double *derivatives, se3d_model_error *error)
{
    const enquiry q = {part.first, part.count, measures, derivatives};
    const se3d_status status = check(study, values, measures, error);
    return status < 0 ? status : eval(study, &q, values, error);
}

se3d_status se3d_study_eval_unknowns(se3d_study *study, const double *values, double *measures,
                                     double *derivatives, se3d_model_error *error)
{
    se3d_model_error own;
    const se3di_study_part all = {0, derivatives ? se3d_study_count_unknowns(study) : 0};
    return se3di_study_eval_part(study, all, values, measures, derivatives, error ? error : &own);
}
