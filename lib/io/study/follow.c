/* SPDX-License-Identifier: BSD-3-Clause */
/* The derivative by a parameter of a motion or an equilibrium that is determined follows from the
 * implicit function theorem. Models with the parameter at p +- h, p +- h/2, ... are made; at each
 * row of the one run their states are what se3d_solver_follow makes of its state. They are smooth
 * functions of h with the derivative of the exact solution, free of the noise of iterations, and so
 * are their rows and measures, whose slopes are extrapolated to h = 0 by the tables of
 * differentiate.c. docs/theory/sensitivities.md */
#include "io/study/follow.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "io/channel/event.h"
#include "io/channel/sample.h"
#include "io/run/watch.h"
#include "io/study/trial.h"

enum { LEVELS = 5, FOLLOWERS = 2 * LEVELS };
#define SHARE 0.5  /* of the first step of differences of runs */
#define ROUGH 1e-6 /* error of the derivative of what is not smooth, */
#define FINE  1e-3 /* or of this part of what changes it by itself in a step */

typedef struct follower {
    se3di_trial trial;
    se3di_output_entry output;
    se3di_sample sample;
    se3d_solver *solver;
    double *row;
} follower;

typedef struct followers {
    follower of[FOLLOWERS];
    size_t count;
    bool has_failed;
    se3d_model_error error; /* of any of them: told to nobody */
} followers;

/* Whether rows are all that the measures are made of, and what leads to them can be followed. */
static bool is_followable(const se3d_study *study)
{
    const se3d_model *model = study->model;
    bool good = !model->particles && model->guest_count == 0;
    for (size_t k = 0; k <= study->analysis && good; ++k) {
        good = !model->analyses[k].modes.file;
    }
    for (size_t k = 0; k < model->event_count && good; ++k) {
        good = model->events[k].action == SE3D_EVENT_RECORD;
    }
    return good;
}

static void destroy(followers *all)
{
    for (size_t k = 0; k < all->count; ++k) {
        follower *one = &all->of[k];
        se3di_sample_destroy(&one->sample);
        se3d_solver_destroy(one->solver);
        se3d_model_destroy(one->trial.model);
        se3di_iopool_destroy(&one->trial.pool);
    }
}

static se3d_status pass_row(void *ctx, const double *row)
{
    (void)ctx;
    (void)row;
    return SE3D_OK;
}

/* Whether rows are at the times of the model of the study. */
static bool has_same_times(const se3di_trial *t)
{
    bool same = true;
    for (size_t k = 0; k <= t->study->analysis; ++k) {
        const se3d_model_analysis *a = &t->model->analyses[k].analysis;
        const se3d_model_analysis *b = &t->study->model->analyses[k].analysis;
        same = same && !(fabs(a->duration - b->duration) > 0.0) &&
               (isnan(a->start) ? isnan(b->start) : !(fabs(a->start - b->start) > 0.0));
    }
    return same;
}

/* Through the analyses before that which is measured, to where it begins. */
static se3d_status begin(se3di_trial *t)
{
    const size_t index = t->study->analysis;
    const double start = t->model->analyses[index].analysis.start;
    const se3d_run_options how = se3di_study_get_options(t->study);
    const se3di_output_entry nothing = {.set = -1};
    if (index > 0) {
        const se3di_watch watch = {.output = &nothing, .analysis = index - 1, .take = pass_row};
        const se3d_status status = se3di_model_watch(t->model, &watch, &how, t->error);
        if (status < 0) {
            return status;
        }
    }
    return isnan(start) ? SE3D_OK : se3d_system_set_time(t->model->system, start);
}

/* The solver of what is measured, as a run of the model has it. */
static se3d_status create_solver(follower *one)
{
    se3di_trial *t = &one->trial;
    const se3di_analysis_entry *entry = &t->model->analyses[t->study->analysis];
    se3d_solver_def def = entry->solver;
    double start = 0.0;
    se3d_system_get_time(t->model->system, &start);
    const double end = start + entry->analysis.duration;
    def.horizon = fabs(end) > 0.0 ? end : DBL_MIN;
    def.interrupt = t->study->interrupt;
    def.interrupt_ctx = t->study->interrupt_ctx;
    const se3d_status status = se3d_solver_create(t->model->system, &def, &one->solver);
    return status >= 0 && se3di_analysis_has_motion(entry)
               ? se3di_events_create(t->model, one->solver, se3di_trial_take_event, t)
               : status;
}

/* Its channels, tallies and solver. */
static se3d_status prepare(follower *one)
{
    se3di_trial *t = &one->trial;
    const se3d_study *study = t->study;
    if (!has_same_times(t)) {
        return SE3D_ERR_UNSUPPORTED;
    }
    se3di_trial_sharpen(t);
    se3d_status status = begin(t);
    status = status < 0 ? status : se3di_trial_find_channels(t, &one->output);
    size_t columns = 1;
    if (status < 0) {
        return status;
    }
    for (size_t k = 0; k < one->output.count; ++k) {
        columns += se3di_channel_get_width(&one->output.channels[k]);
    }
    one->row = se3di_iopool_array(&t->pool, columns, sizeof *one->row);
    t->tallies = se3di_iopool_array(&t->pool, study->entry->measure_count, sizeof *t->tallies);
    if (!one->row || !t->tallies) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3di_trial_begin(t);
    return create_solver(one);
}

/* A model with the parameter at p + shift. */
static se3d_status add(followers *all, se3d_study *study, const se3di_study_point *point,
                       double shift)
{
    follower *one = &all->of[all->count++];
    double *value = &point->values[point->which].value.v[0];
    const double p = *value;
    memset(one, 0, sizeof *one);
    one->trial.study = study;
    one->trial.error = &all->error;
    se3di_iopool_init(&one->trial.pool, &study->pool.allocator);
    *value = p + shift;
    se3d_status status =
        se3di_study_read(study, point->values, point->count, &one->trial.model, &all->error);
    *value = p;
    if (one->trial.model) {
        se3di_sample_init(&one->sample, one->trial.model->system,
                          &one->trial.model->pool.allocator);
    }
    return status < 0 ? status : prepare(one);
}

static bool is_within(const se3di_study_point *point, double h)
{
    const double p = point->values[point->which].value.v[0];
    return p - h >= point->bounds[0] && p + h <= point->bounds[1];
}

static se3d_status create(followers *all, se3d_study *study, const se3di_study_point *point)
{
    double h = se3di_study_first_step(point);
    se3d_status status = is_within(point, h) ? SE3D_OK : SE3D_ERR_UNSUPPORTED;
    for (size_t k = 0; k < LEVELS && status >= 0; ++k, h *= 0.5) {
        status = add(all, study, point, -h);
        status = status < 0 ? status : add(all, study, point, h);
    }
    return status;
}

/* As se3di_model_watch makes a row of a run. */
static se3d_status take_row(follower *one, se3d_solver *solver, double time)
{
    double *row = one->row;
    se3d_status status = se3d_solver_follow(one->solver, solver);
    if (status < 0) {
        return status;
    }
    se3di_sample_renew(&one->sample, NULL);
    *row++ = time;
    for (size_t k = 0; k < one->output.count; ++k) {
        double value[4];
        status = se3di_channel_eval(&one->output.channels[k], &one->sample, value);
        if (status < 0) {
            return status;
        }
        const size_t width = se3di_channel_get_width(&one->output.channels[k]);
        memcpy(row, value, width * sizeof *row);
        row += width;
    }
    return se3di_trial_take_row(&one->trial, one->row);
}

/* Differences of runs would fare no better. */
static bool is_final(se3d_status status)
{
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_INTERRUPTED;
}

static se3d_status take_rows(void *ctx, se3d_solver *solver, double time)
{
    followers *all = ctx;
    for (size_t k = 0; k < all->count && !all->has_failed; ++k) {
        const se3d_status status = take_row(&all->of[k], solver, time);
        if (is_final(status)) {
            return status;
        }
        all->has_failed = status < 0;
    }
    return SE3D_OK;
}

/* The measures of all, and what they tell. */
static se3d_status conclude(followers *all, se3d_study *study, const se3di_study_point *point,
                            const double *centre, double *derivatives, double *errors)
{
    double *beside[FOLLOWERS];
    se3di_study_point known = *point;
    for (size_t k = 0; k < FOLLOWERS; ++k) {
        se3di_trial *t = &all->of[k].trial;
        beside[k] = se3di_iopool_array(&t->pool, study->entry->measure_count, sizeof **beside);
        const se3d_status status =
            beside[k] ? se3di_trial_conclude(t, beside[k]) : SE3D_ERR_NO_MEMORY;
        if (status == SE3D_ERR_NO_MEMORY) {
            return status;
        }
    }
    known.beside = beside;
    return se3di_study_differentiate(study, &known, centre, derivatives, errors);
}

/* Whether there is a derivative of each measure, which is no corner: forces that jump within a step
 * are told better by runs with steps of their own. */
static bool is_good(const se3d_study *study, double step, const double *measures,
                    const double *derivatives, const double *errors)
{
    bool good = true;
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        const double most = ROUGH * (fabs(derivatives[k]) + FINE * fabs(measures[k]) / step);
        good = good && (!isfinite(measures[k]) || errors[k] <= most + DBL_MIN);
    }
    return good;
}

se3d_status se3di_study_follow(se3d_study *study, const se3di_study_point *point, double *measures,
                               double *derivatives, double *errors, bool *done,
                               se3d_model_error *error)
{
    followers all = {.count = 0, .has_failed = false};
    const se3di_row_listener listener = {.reach = take_rows, .ctx = &all};
    se3di_study_point near = *point;
    *done = false;
    memset(error, 0, sizeof *error);
    if (!is_followable(study)) {
        return SE3D_OK;
    }
    near.step *= SHARE;
    near.levels = LEVELS;
    const se3di_study_work work = se3di_study_begin(study);
    se3d_status status = create(&all, study, &near);
    if (status >= 0) {
        status =
            se3di_study_run_with(study, point->values, point->count, &listener, measures, error);
        *done = !all.has_failed && (status >= 0 || status == SE3D_ERR_NOT_FINITE);
    }
    if (*done) {
        double *own =
            se3di_iopool_array(&all.of[0].trial.pool, study->entry->measure_count, sizeof *own);
        double *const estimates = errors ? errors : own;
        const se3d_status told =
            own ? conclude(&all, study, &near, measures, derivatives, estimates)
                : SE3D_ERR_NO_MEMORY;
        status = told < 0 ? told : status;
        *done = told < 0 || is_good(study, near.step, measures, derivatives, estimates);
    }
    destroy(&all);
    se3di_study_end(study, work);
    return *done || is_final(status) ? status : SE3D_OK;
}
