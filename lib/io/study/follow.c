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
#include "io/study/inplace.h"
#include "io/study/trial.h"

enum { LEVELS = 5, FOLLOWERS = 2 * LEVELS };
#define SHARE  0.5  /* of the first step of differences of runs */
#define ROUGH  1e-6 /* error of the derivative of what is not smooth, */
#define FINE   1e-3 /* or of this part of what changes it by itself in a step */
#define TWO_PI 6.283185307179586476925286766559
#define APART  2e-2 /* of a slope: what a wide pair of models may tell otherwise */

typedef struct follower {
    se3di_trial trial;
    se3d_system *system; /* its own; that of its model, unless the model is the prototype's */
    se3di_output_entry output;
    se3di_sample sample;
    se3d_solver *solver;
    double *row;
} follower;

/* Those that tell of one parameter. */
typedef struct group {
    const se3di_study_point *point;
    follower of[FOLLOWERS];
    size_t count;
    double h; /* the first step */
    bool has_failed;
} group;

typedef struct followers {
    se3d_study *study;
    group *groups;
    size_t count;
    size_t stage;           /* the analysis whose solver is followed; SIZE_MAX: none */
    se3d_model_error error; /* of any of them: told to nobody */
} followers;

static bool is_of_modes(const se3d_study *study)
{
    return study->model->analyses[study->analysis].modes.file != NULL;
}

/* The analysis whose solver is followed: that which is measured, or the equilibrium before modes.
 * Followers take the way to it, and assemblies, by themselves.
 * @return false: what is measured cannot be followed */
static bool find_stage(const se3d_study *study, size_t *stage)
{
    const se3d_model *model = study->model;
    *stage = study->analysis;
    if (!is_of_modes(study)) {
        return model->analyses[*stage].solver.analysis != SE3D_ANALYSIS_ASSEMBLY;
    }
    while (*stage != SIZE_MAX && model->analyses[*stage].modes.file) {
        --*stage;
    }
    if (*stage == SIZE_MAX || model->analyses[*stage].solver.analysis == SE3D_ANALYSIS_ASSEMBLY) {
        *stage = SIZE_MAX;
        return true;
    }
    return model->analyses[*stage].solver.analysis == SE3D_ANALYSIS_EQUILIBRIUM;
}

/* Whether rows and modes are all that the measures are made of. */
static bool is_followable(const se3d_study *study)
{
    const se3d_model *model = study->model;
    bool good = !model->particles && model->guest_count == 0;
    for (size_t k = 0; k < model->event_count && good; ++k) {
        good = model->events[k].action == SE3D_EVENT_RECORD;
    }
    return good;
}

static void destroy(follower *one)
{
    se3di_sample_destroy(&one->sample);
    se3d_solver_destroy(one->solver);
    if (one->trial.is_set) {
        se3d_system_destroy(one->system);
    } else {
        se3d_model_destroy(one->trial.model);
    }
    se3di_iopool_destroy(&one->trial.pool);
}

static void destroy_all(followers *all)
{
    for (size_t k = 0; all->groups && k < all->count; ++k) {
        for (size_t i = 0; i < all->groups[k].count; ++i) {
            destroy(&all->groups[k].of[i]);
        }
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

/* Through the analyses before that which is followed, or measured. */
static se3d_status begin(follower *one, size_t stage)
{
    const se3di_trial *t = &one->trial;
    const size_t index = stage == SIZE_MAX ? t->study->analysis : stage;
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
    return isnan(start) ? SE3D_OK : se3d_system_set_time(one->system, start);
}

/* The solver of what is followed, as a run of the model has it. */
static se3d_status create_solver(follower *one, size_t stage)
{
    se3di_trial *t = &one->trial;
    const se3di_analysis_entry *entry = &t->model->analyses[stage];
    se3d_solver_def def = entry->solver;
    double start = 0.0;
    se3d_system_get_time(one->system, &start);
    const double end = start + entry->analysis.duration;
    def.horizon = fabs(end) > 0.0 ? end : DBL_MIN;
    def.interrupt = t->study->interrupt;
    def.interrupt_ctx = t->study->interrupt_ctx;
    const se3d_status status = se3d_solver_create(one->system, &def, &one->solver);
    return status >= 0 && se3di_analysis_has_motion(entry)
               ? se3di_events_create(t->model, one->solver, se3di_trial_take_event, t)
               : status;
}

/* Its channels, tallies and solver; the system is that of its model. */
static se3d_status prepare(follower *one, size_t stage)
{
    se3di_trial *t = &one->trial;
    const se3d_study *study = t->study;
    if (!has_same_times(t)) {
        return SE3D_ERR_UNSUPPORTED;
    }
    se3di_trial_sharpen(t);
    se3d_status status = begin(one, stage);
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
    t->tally_pool = &t->pool;
    se3di_trial_begin(t);
    return stage == SIZE_MAX ? SE3D_OK : create_solver(one, stage);
}

/* A model with the parameter at p + shift. That of the prototype lends its texts and numbers to
 * all, which have systems of their own. */
static se3d_status add(followers *all, group *g, double shift)
{
    follower *one = &g->of[g->count++];
    const se3di_study_point *point = g->point;
    double *value = &point->values[point->which].value.v[0];
    const double p = *value;
    memset(one, 0, sizeof *one);
    one->trial.study = all->study;
    one->trial.error = &all->error;
    se3di_iopool_init(&one->trial.pool, &all->study->pool.allocator);
    *value = p + shift;
    se3d_status status = se3di_trial_make_model(&one->trial, point->values, point->count);
    *value = p;
    if (one->trial.model) {
        one->system = one->trial.model->system;
        se3di_sample_init(&one->sample, one->system, &one->trial.model->pool.allocator);
    }
    status = status < 0 ? status : prepare(one, all->stage);
    if (one->trial.is_set) {
        (void)se3di_inplace_take(all->study);
    }
    return status;
}

static bool is_within(const se3di_study_point *point, double shift)
{
    const double p = point->values[point->which].value.v[0];
    return p + shift >= point->bounds[0] && p + shift <= point->bounds[1];
}

/* At p +- h, p +- h/2, ... */
static se3d_status create_ladder(followers *all, group *g)
{
    double h = g->h;
    se3d_status status =
        is_within(g->point, h) && is_within(g->point, -h) ? SE3D_OK : SE3D_ERR_UNSUPPORTED;
    for (size_t k = 0; k < LEVELS && status >= 0; ++k, h *= 0.5) {
        status = add(all, g, -h);
        status = status < 0 ? status : add(all, g, h);
    }
    return status;
}

static bool is_of_motion(const se3d_study *study)
{
    const se3d_solver_def *solver = &study->model->analyses[study->analysis].solver;
    return solver->analysis == SE3D_ANALYSIS_DYNAMICS;
}

/* At p +- h; beside a bound at p, p + h, p + 2 h, where h may be negative. The steps of a motion
 * see no force that jumps unless the parameter moves it from one of their stages to the next: a
 * wide pair tells. */
static se3d_status create_pair(followers *all, group *g)
{
    const double wide = g->point->step;
    if (is_of_motion(all->study) && !(is_within(g->point, wide) && is_within(g->point, -wide))) {
        return SE3D_ERR_UNSUPPORTED;
    }
    if (is_within(g->point, g->h) && is_within(g->point, -g->h)) {
        const double shifts[4] = {-g->h, g->h, -wide, wide};
        se3d_status status = SE3D_OK;
        for (int k = 0; k < (is_of_motion(all->study) ? 4 : 2) && status >= 0; ++k) {
            status = add(all, g, shifts[k]);
        }
        return status;
    }
    if (!is_within(g->point, 2.0 * g->h)) {
        g->h = -g->h;
    }
    se3d_status status = is_within(g->point, 2.0 * g->h) ? SE3D_OK : SE3D_ERR_UNSUPPORTED;
    for (int k = 0; k < 3 && status >= 0; ++k) {
        status = add(all, g, k * g->h);
    }
    return status;
}

/* Differences of runs would fare no better. */
static bool is_final(se3d_status status)
{
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_INTERRUPTED;
}

/* @return how many groups there are, or why there are none */
static se3d_status create(followers *all, const se3di_study_point *points, size_t *left)
{
    *left = 0;
    for (size_t k = 0; k < all->count; ++k) {
        group *g = &all->groups[k];
        g->point = &points[k];
        g->h = ldexp(1.0, ilogb(g->point->follow_step > 0.0 ? g->point->follow_step
                                                            : SHARE * g->point->step));
        const se3d_status status =
            g->point->follow_step > 0.0 ? create_pair(all, g) : create_ladder(all, g);
        if (is_final(status)) {
            return status;
        }
        g->has_failed = status < 0;
        *left += !g->has_failed;
    }
    return SE3D_OK;
}

/* As se3di_model_watch makes a row of a run. */
static se3d_status take_row(follower *one, double time)
{
    double *row = one->row;
    se3di_sample_renew(&one->sample, NULL);
    *row++ = time;
    for (size_t k = 0; k < one->output.count; ++k) {
        double value[4];
        const se3d_status status =
            se3di_channel_eval(&one->output.channels[k], &one->sample, value);
        if (status < 0) {
            return status;
        }
        const size_t width = se3di_channel_get_width(&one->output.channels[k]);
        memcpy(row, value, width * sizeof *row);
        row += width;
    }
    return se3di_trial_take_row(&one->trial, one->row);
}

/* What all do where the run has come to. */
typedef struct occasion {
    se3d_solver *solver; /* of the run; NULL: there is nothing to follow */
    const se3d_modes *modes;
    bool has_row;
    double time; /* of the row */
} occasion;

/* The modes that the measures ask for. */
static se3d_status take_modes(follower *one, const se3d_modes *modes)
{
    se3di_trial *t = &one->trial;
    const size_t count = se3d_modes_count(modes);
    double *re = se3di_iopool_array(&t->pool, count + 1, sizeof *re);
    double *im = se3di_iopool_array(&t->pool, count + 1, sizeof *im);
    if (!re || !im) {
        return SE3D_ERR_NO_MEMORY;
    }
    const double start = t->model->analyses[t->study->analysis].analysis.start;
    se3d_status status = isnan(start) ? SE3D_OK : se3d_system_set_time(one->system, start);
    status = status < 0 ? status : se3d_modes_follow(modes, one->system, count, re, im);
    for (size_t k = 0; k < count && status >= 0; ++k) {
        const double modulus = sqrt(re[k] * re[k] + im[k] * im[k]);
        const se3d_eigenvalue e = {re[k], im[k], modulus / TWO_PI, -re[k] / modulus};
        se3di_trial_take_mode(t, k, &e);
    }
    return status;
}

static se3d_status meet(follower *one, const occasion *o)
{
    se3d_status status = SE3D_OK;
    if (o->solver) {
        status = se3d_solver_follow(one->solver, o->solver);
    }
    if (status >= 0 && o->modes) {
        status = take_modes(one, o->modes);
    }
    return status >= 0 && o->has_row ? take_row(one, o->time) : status;
}

static se3d_status meet_all(followers *all, const occasion *o)
{
    for (size_t n = 0; n < all->count; ++n) {
        group *g = &all->groups[n];
        for (size_t k = 0; k < g->count && !g->has_failed; ++k) {
            const se3d_status status = meet(&g->of[k], o);
            if (is_final(status)) {
                return status;
            }
            g->has_failed = status < 0;
        }
    }
    return SE3D_OK;
}

static se3d_status reach(void *ctx, se3d_solver *solver, double time)
{
    followers *all = ctx;
    const bool is_there = is_of_modes(all->study);
    const occasion o = {.solver = is_there ? NULL : solver, .has_row = true, .time = time};
    return meet_all(all, &o);
}

static se3d_status settle(void *ctx, se3d_solver *solver)
{
    followers *all = ctx;
    const bool is_followed = is_of_modes(all->study) && all->stage != SIZE_MAX;
    const occasion o = {.solver = is_followed ? solver : NULL};
    return meet_all(all, &o);
}

static se3d_status linearise(void *ctx, const se3d_modes *modes)
{
    const occasion o = {.modes = modes};
    return meet_all(ctx, &o);
}

/* Whether there is a derivative of each measure, which is no corner: forces that jump within a step
 * are told better by runs with steps of their own. */
static bool is_good(const se3d_study *study, const group *g, const double *measures,
                    const double *errors)
{
    bool good = true;
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        const double slope = fabs(g->point->derivatives[k]);
        const double most = ROUGH * (slope + FINE * fabs(measures[k]) / g->h);
        good = good && (!isfinite(measures[k]) || errors[k] <= most + DBL_MIN);
    }
    return good;
}

/* By the tables of all steps. */
static se3d_status conclude_ladder(const followers *all, group *g, double *const *beside,
                                   const double *centre)
{
    se3di_study_point known = *g->point;
    known.beside = beside;
    known.step = g->h;
    known.levels = LEVELS;
    if (!known.errors) {
        known.errors = se3di_iopool_array(&g->of[0].trial.pool, all->study->entry->measure_count,
                                          sizeof *known.errors);
    }
    const se3d_status status =
        known.errors ? se3di_study_differentiate(all->study, &known, centre) : SE3D_ERR_NO_MEMORY;
    g->has_failed = status >= 0 && !is_good(all->study, g, centre, known.errors);
    return status;
}

/* By a pair, or beside a bound by three; *spread: how far a wide pair is off. */
static double get_slope(const group *g, double *const *f, size_t k, double *spread)
{
    *spread = 0.0;
    if (g->count == 3) {
        return (4.0 * f[1][k] - 3.0 * f[0][k] - f[2][k]) / (2.0 * g->h);
    }
    const double slope = (f[1][k] - f[0][k]) / (2.0 * g->h);
    if (g->count == 4) {
        *spread = fabs((f[3][k] - f[2][k]) / (2.0 * g->point->step) - slope);
    }
    return slope;
}

static void conclude_pair(const followers *all, group *g, double *const *f, const double *centre)
{
    for (size_t k = 0; k < all->study->entry->measure_count; ++k) {
        double spread;
        const double slope = get_slope(g, f, k, &spread);
        const double most = APART * fabs(slope) + FINE * fabs(centre[k]) / g->point->step;
        const bool has_value = isfinite(centre[k]);
        g->point->derivatives[k] = has_value ? slope : (double)NAN;
        g->has_failed = g->has_failed || (has_value && !(spread <= most && isfinite(slope)));
    }
}

/* The measures of all, and what they tell. */
static se3d_status conclude(const followers *all, group *g, const double *centre)
{
    double *beside[FOLLOWERS];
    for (size_t k = 0; k < g->count; ++k) {
        se3di_trial *t = &g->of[k].trial;
        beside[k] = se3di_iopool_array(&t->pool, all->study->entry->measure_count, sizeof **beside);
        const se3d_status status =
            beside[k] ? se3di_trial_conclude(t, beside[k]) : SE3D_ERR_NO_MEMORY;
        if (status == SE3D_ERR_NO_MEMORY) {
            return status;
        }
    }
    if (!(g->point->follow_step > 0.0)) {
        return conclude_ladder(all, g, beside, centre);
    }
    conclude_pair(all, g, beside, centre);
    return SE3D_OK;
}

/* The run at the point, which the others follow. */
static se3d_status run(followers *all, double *measures, bool *has_run, se3d_model_error *error)
{
    const se3di_row_listener listener = {
        .reach = reach, .settle = settle, .linearise = linearise, .ctx = all};
    const se3di_study_point *point = all->groups[0].point;
    const se3d_status status =
        se3di_study_run_with(all->study, point->values, point->count, &listener, measures, error);
    se3d_status told = SE3D_OK;
    *has_run = !is_final(status);
    for (size_t k = 0; k < all->count && *has_run && told >= 0; ++k) {
        group *g = &all->groups[k];
        g->has_failed = g->has_failed || (status < 0 && status != SE3D_ERR_NOT_FINITE);
        told = g->has_failed ? SE3D_OK : conclude(all, g, measures);
    }
    *has_run = *has_run && told >= 0;
    return told < 0 ? told : status;
}

se3d_status se3di_study_follow(se3d_study *study, const se3di_study_point *points, size_t count,
                               double *measures, bool *done, bool *has_run, se3d_model_error *error)
{
    followers all = {.study = study, .count = count};
    se3di_iopool pool;
    size_t left = 0;
    *has_run = false;
    memset(done, 0, count * sizeof *done);
    memset(error, 0, sizeof *error);
    if (count == 0 || !is_followable(study) || !find_stage(study, &all.stage)) {
        return SE3D_OK;
    }
    se3di_iopool_init(&pool, &study->pool.allocator);
    all.groups = se3di_iopool_array(&pool, count, sizeof *all.groups);
    const se3di_study_work work = se3di_study_begin(study);
    se3d_status status = all.groups ? create(&all, points, &left) : SE3D_ERR_NO_MEMORY;
    if (status >= 0 && left > 0) {
        status = run(&all, measures, has_run, error);
    }
    for (size_t k = 0; k < count && *has_run; ++k) {
        done[k] = !all.groups[k].has_failed;
    }
    destroy_all(&all);
    se3di_study_end(study, work);
    se3di_iopool_destroy(&pool);
    return status;
}
