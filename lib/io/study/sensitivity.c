/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of the measures at the values that the model's file gives its parameters. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/document/document.h"
#include "io/study/follow.h"

#define SHARE 0.05 /* of a parameter, or of what it varies by: the first step */

size_t se3d_study_count_sensitivities(const se3d_study *study)
{
    return study ? study->entry->sensitivity_count : 0;
}

const char *se3d_study_get_sensitivity_name(const se3d_study *study, size_t index)
{
    return index < se3d_study_count_sensitivities(study) ? study->entry->sensitivities[index] : "";
}

static se3d_status fail(const se3d_study *study, se3d_model_error *error, se3d_status status,
                        const char *text)
{
    se3di_document_report(error, study ? study->model->file : "", 0, 0, "", text);
    return status;
}

/* How far apart the values are that a study gives a parameter; 0: not known. */
static double get_spread(const se3di_study_variable *v)
{
    double least = HUGE_VAL;
    double most = -HUGE_VAL;
    switch (v->distribution) {
    case SE3DI_DISTRIBUTION_LIST:
        for (size_t k = 0; k < v->count; ++k) {
            least = fmin(least, v->values[k]);
            most = fmax(most, v->values[k]);
        }
        return fmax(most - least, 0.0);
    case SE3DI_DISTRIBUTION_RANGE:
    case SE3DI_DISTRIBUTION_UNIFORM:
        return fabs(v->a[1] - v->a[0]);
    case SE3DI_DISTRIBUTION_TRIANGULAR:
        return v->a[2] - v->a[0];
    case SE3DI_DISTRIBUTION_NORMAL:
        return 4.0 * v->a[1];
    default:
        return 0.0;
    }
}

double se3di_study_get_step(const se3d_study *study, const char *name, double value)
{
    double spread = 0.0;
    for (size_t k = 0; k < study->entry->variable_count; ++k) {
        const se3di_study_variable *v = &study->entry->variables[k];
        spread = strcmp(v->name, name) == 0 ? get_spread(v) : spread;
    }
    const double own = SHARE * fabs(value);
    const double other = SHARE * spread;
    const double step = own > 0.0 && other > 0.0 ? fmin(own, other) : fmax(own, other);
    return step > 1e-280 ? step : SHARE * 0.1;
}

/* What cannot be asked, as NaN and a message. */
static se3d_status check(const se3d_study *study, const void *parameter, const void *results,
                         se3d_model_error *error)
{
    if (!study || !parameter || !results) {
        return fail(study, error, SE3D_ERR_NULL, "study, value or derivatives is NULL");
    }
    if (study->is_running) {
        return fail(study, error, SE3D_ERR_STATE, "a sample of the study is being run");
    }
    return SE3D_OK;
}

se3d_status se3d_study_eval_nominal(se3d_study *study, double *measures, se3d_model_error *error)
{
    se3d_model_error own;
    error = error ? error : &own;
    const se3d_status status = check(study, measures, measures, error);
    if (status < 0) {
        return status;
    }
    study->is_sharp = true;
    const se3d_status done = se3di_study_run(study, NULL, 0, measures, error);
    study->is_sharp = false;
    return done;
}

/* All derivatives of one parameter; study->measures: the measures where it has its own value. */
static se3d_status differentiate(se3d_study *study, size_t index, double *derivatives,
                                 double *errors, se3d_model_error *error)
{
    const char *name = study->entry->sensitivities[index];
    const se3di_amount *amount = se3di_scope_find(study->model->scope, name);
    se3di_named value = {.name = name, .value = *amount};
    const se3di_study_point point = {.values = &value,
                                     .count = 1,
                                     .which = 0,
                                     .step = se3di_study_get_step(study, name, amount->v[0]),
                                     .bounds = {-HUGE_VAL, HUGE_VAL},
                                     .levels = SE3DI_STUDY_LEVELS,
                                     .derivatives = derivatives,
                                     .errors = errors};
    bool followed, has_run;
    se3d_status status =
        se3di_study_follow(study, &point, 1, study->measures, &followed, &has_run, error);
    if (status < 0 && error->message[0] == '\0') {
        return fail(study, error, status, se3d_status_get_text(status));
    }
    if (!has_run && status >= 0) {
        status = se3di_study_run(study, &value, 1, study->measures, error);
    }
    if (followed || (status < 0 && status != SE3D_ERR_NOT_FINITE)) {
        return status;
    }
    const se3d_status done = se3di_study_differentiate(study, &point, study->measures);
    return done < 0 ? fail(study, error, done, se3d_status_get_text(done)) : status;
}

se3d_status se3d_study_eval_sensitivity(se3d_study *study, size_t index, double *value,
                                        double *derivatives, double *errors,
                                        se3d_model_error *error)
{
    se3d_model_error own;
    error = error ? error : &own;
    const se3d_status status = check(study, value, derivatives, error);
    if (status < 0) {
        return status;
    }
    if (index >= study->entry->sensitivity_count) {
        return fail(study, error, SE3D_ERR_INVALID_ARGUMENT, "there is no such sensitivity");
    }
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        derivatives[k] = (double)NAN;
        if (errors) {
            errors[k] = (double)NAN;
        }
    }
    *value = se3di_scope_find(study->model->scope, study->entry->sensitivities[index])->v[0];
    study->is_sharp = true;
    const se3d_status done = differentiate(study, index, derivatives, errors, error);
    study->is_sharp = false;
    return done;
}
