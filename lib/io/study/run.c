/* SPDX-License-Identifier: BSD-3-Clause */
/* One run of the model of a study: with other parameters, read again from its tree if need be, run
 * without files, measured on the way. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/channel/event.h"
#include "io/channel/sample.h"
#include "io/document/document.h"
#include "io/document/value.h"
#include "io/run/watch.h"
#include "io/study/inplace.h"
#include "io/study/trial.h"

#define SHARP 1e-11 /* tolerance of runs whose differences count */

typedef se3di_trial trial;

static se3d_status fail(const trial *t, se3d_status status, const char *text)
{
    se3di_document_report(t->error, "", 0, 0, "", text);
    return status;
}

/* The parameters as expressions see them: the next sample may change those of the model. */
static se3d_status keep_symbols(trial *t)
{
    const se3di_scope *scope = t->model->scope;
    t->symbols = se3di_iopool_array(&t->pool, scope->symbol_count + 1, sizeof *t->symbols);
    if (!t->symbols) {
        return fail(t, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    t->symbol_count = scope->symbol_count;
    for (size_t k = 0; k < t->symbol_count; ++k) {
        t->symbols[k] = scope->symbols[k];
    }
    return SE3D_OK;
}

se3d_status se3di_trial_make_model(trial *t, const se3di_named *values, size_t count)
{
    se3d_study *study = t->study;
    se3d_status status = se3di_inplace_begin(study, values, count, &t->pool, &t->model);
    t->is_set = t->model != NULL;
    if (status < 0) {
        return fail(t, status, "out of memory");
    }
    if (!t->is_set) {
        status = se3di_study_read(study, values, count, &t->model, t->error);
    }
    return status < 0 ? status : keep_symbols(t);
}

/* What a row is made of. */
se3d_status se3di_trial_find_channels(trial *t, se3di_output_entry *output)
{
    const size_t count = t->study->entry->source_count;
    const se3di_study_channel *measured = t->model->measured;
    se3di_channel *channels = se3di_iopool_array(&t->pool, count, sizeof *channels);
    size_t place = 1;
    t->places = se3di_iopool_array(&t->pool, count, sizeof *t->places);
    if (!channels || !t->places) {
        return fail(t, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    for (size_t k = 0; k < count; ++k) {
        channels[k] = measured[k].channel;
        t->places[k] = place + measured[k].component;
        place += se3di_channel_get_width(&channels[k]);
    }
    *output = (se3di_output_entry){
        .every = t->study->entry->every, .channels = channels, .count = count, .set = -1};
    return SE3D_OK;
}

void se3di_trial_begin(trial *t)
{
    for (size_t k = 0; k < t->study->entry->measure_count; ++k) {
        se3di_tally_begin(&t->tallies[k], &t->model->measures[k]);
    }
}

se3d_status se3di_trial_take_row(trial *t, const double *row)
{
    const se3d_study *study = t->study;
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        se3di_tally *tally = &t->tallies[k];
        const se3di_study_measure *m = tally->measure;
        if (m->source == SE3DI_STUDY_NO_SOURCE) {
            continue;
        }
        double value = row[t->places[m->source]];
        if (m->reduction == SE3DI_REDUCE_MISFIT) {
            const double since = tally->has_row ? row[0] - tally->start : 0.0;
            value -= se3di_tally_get_wanted(
                m, m->along == SE3DI_STUDY_NO_SOURCE ? since : row[t->places[m->along]]);
        }
        if (!se3di_tally_add(tally, t->tally_pool, row[0], value)) {
            return SE3D_ERR_NO_MEMORY;
        }
    }
    return SE3D_OK;
}

static se3d_status take_row(void *ctx, const double *row)
{
    return se3di_trial_take_row(ctx, row);
}

static se3d_status reach(void *ctx, se3d_solver *solver, double time)
{
    const trial *t = ctx;
    return t->listener->reach(t->listener->ctx, solver, time);
}

static se3d_status settle(void *ctx, se3d_solver *solver)
{
    const trial *t = ctx;
    return t->listener->settle(t->listener->ctx, solver);
}

static se3d_status linearise(void *ctx, const se3d_modes *modes)
{
    const trial *t = ctx;
    return t->listener->linearise(t->listener->ctx, modes);
}

se3d_status se3di_trial_take_event(void *ctx, se3d_system *system, const se3d_event_record *record)
{
    const trial *t = ctx;
    const se3d_study *study = t->study;
    se3d_status status = SE3D_OK;
    se3di_sample sample;
    se3di_sample_init(&sample, system, &t->model->pool.allocator);
    for (size_t k = 0; k < study->entry->measure_count && status >= 0; ++k) {
        const se3di_study_measure *m = &study->entry->measures[k];
        double value[4] = {0.0, 0.0, 0.0, 0.0};
        if (!m->event || strcmp(m->event, record->name) != 0) {
            continue;
        }
        if (m->source == SE3DI_STUDY_NO_SOURCE) {
            se3di_tally_find(&t->tallies[k], record->time);
            continue;
        }
        const se3di_study_channel *from = &t->model->measured[m->source];
        status = se3di_channel_eval(&from->channel, &sample, value);
        if (status >= 0) {
            se3di_tally_find(&t->tallies[k], value[from->component]);
        }
    }
    se3di_sample_destroy(&sample);
    return status;
}

void se3di_trial_take_mode(void *ctx, size_t index, const se3d_eigenvalue *eigenvalue)
{
    const trial *t = ctx;
    for (size_t k = 0; k < t->study->entry->measure_count; ++k) {
        const se3di_study_measure *m = &t->model->measures[k];
        if (m->mode > 0.0 && (size_t)m->mode == index + 1) {
            se3di_tally_find(&t->tallies[k], m->reduction == SE3DI_REDUCE_FREQUENCY
                                                 ? eigenvalue->frequency
                                                 : eigenvalue->damping);
        }
    }
}

/* An expression over the measures above it and the parameters of this model. */
static se3d_status eval_expression(trial *t, size_t index, const double *measures, double *value)
{
    const se3di_study_entry *entry = t->study->entry;
    const size_t count = index + t->symbol_count;
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    se3d_expression_symbol *symbols = se3di_iopool_array(&t->pool, count, sizeof *symbols);
    *value = (double)NAN;
    if (!symbols) {
        return SE3D_ERR_NO_MEMORY;
    }
    size_t used = 0;
    for (size_t k = 0; k < index;
         ++k) { /* without a value it is unknown, and so is what needs it */
        if (isfinite(measures[k])) {
            symbols[used++] = (se3d_expression_symbol){entry->measures[k].name, measures[k]};
        }
    }
    for (size_t k = 0; k < t->symbol_count; ++k) {
        symbols[used++] = t->symbols[k];
    }
    def.text = entry->measures[index].node->text;
    def.symbols = symbols;
    def.symbol_count = used;
    def.allocator = se3di_iopool_lend(&t->model->pool);
    const se3d_status status = se3d_expression_create(&def, &expression, NULL);
    if (status >= 0) {
        (void)se3d_expression_eval(expression, NULL, value); /* not finite is told below */
    }
    se3d_expression_destroy(expression);
    return status == SE3D_ERR_NO_MEMORY ? status : SE3D_OK;
}

se3d_status se3di_trial_conclude(trial *t, double *measures)
{
    const se3d_study *study = t->study;
    se3d_status result = SE3D_OK;
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        const se3di_study_measure *m = &study->entry->measures[k];
        const char *problem = "is not finite";
        se3d_status status = SE3D_OK;
        if (m->reduction == SE3DI_REDUCE_EXPRESSION) {
            status = eval_expression(t, k, measures, &measures[k]);
        } else {
            measures[k] = se3di_tally_get(&t->tallies[k], &problem);
        }
        if (status < 0) {
            return fail(t, status, "out of memory");
        }
        if (!isfinite(measures[k])) {
            char text[200];
            measures[k] = (double)NAN;
            snprintf(text, sizeof text, "`%.60s` %s", m->name, problem);
            result = result < 0 ? result : fail(t, SE3D_ERR_NOT_FINITE, text);
        }
    }
    return result;
}

static bool is_of_high_order(int32_t method)
{
    return method == SE3D_METHOD_AUTO || method == SE3D_METHOD_DOP853 ||
           method == SE3D_METHOD_GAUSS || method == SE3D_METHOD_RADAU || method == SE3D_METHOD_RK45;
}

/* Let methods of high order hold their errors near rounding, if the user has not asked for another
 * tolerance. Those of second order would take for ever. */
void se3di_trial_sharpen(const trial *t)
{
    const bool wanted =
        t->study->is_sharp && !t->study->entry->options.tolerance && !t->model->particles;
    for (size_t k = 0; wanted && k < t->model->analysis_count; ++k) {
        se3d_solver_def *solver = &t->model->analyses[k].solver;
        if (is_of_high_order(solver->method) && solver->analysis == SE3D_ANALYSIS_DYNAMICS &&
            !(solver->tolerance > 0.0 && solver->tolerance < SHARP)) {
            solver->tolerance = SHARP;
        }
    }
}

se3di_study_work se3di_study_begin(se3d_study *study)
{
    const se3di_study_work work = {se3di_floats_set(), study->is_running};
    study->is_running = true;
    ++study->model->running;
    return work;
}

void se3di_study_end(se3d_study *study, se3di_study_work work)
{
    --study->model->running;
    study->is_running = work.was_running;
    se3di_floats_restore(work.host);
}

se3d_run_options se3di_study_get_options(const se3d_study *study)
{
    se3d_run_options how = se3d_run_options_default();
    how.interrupt = study->interrupt;
    how.interrupt_ctx = study->interrupt_ctx;
    return how;
}

static se3d_status run(trial *t, const se3di_named *values, size_t count, double *measures)
{
    se3d_study *study = t->study;
    se3di_output_entry output;
    const se3d_run_options how = se3di_study_get_options(study);
    se3d_status status = se3di_trial_make_model(t, values, count);
    if (status >= 0) {
        status = se3di_trial_find_channels(t, &output);
    }
    if (status < 0) {
        return status;
    }
    se3di_trial_sharpen(t);
    se3di_trial_begin(t);
    const se3di_watch watch = {.output = &output,
                               .analysis = study->analysis,
                               .take = take_row,
                               .reach = t->listener ? reach : NULL,
                               .settle = t->listener ? settle : NULL,
                               .event = se3di_trial_take_event,
                               .mode = se3di_trial_take_mode,
                               .linearise = t->listener ? linearise : NULL,
                               .ctx = t};
    status = se3di_model_watch(t->model, &watch, &how, t->error);
    return status < 0 ? status : se3di_trial_conclude(t, measures);
}

se3d_status se3di_study_run_with(se3d_study *study, const se3di_named *values, size_t count,
                                 const se3di_row_listener *listener, double *measures,
                                 se3d_model_error *error)
{
    trial t = {.study = study,
               .tallies = study->tallies,
               .tally_pool = &study->pool,
               .listener = listener,
               .error = error};
    memset(error, 0, sizeof *error);
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        measures[k] = (double)NAN;
    }
    const se3di_study_work work = se3di_study_begin(study);
    se3di_iopool_init(&t.pool, &study->pool.allocator);
    const se3d_status status = run(&t, values, count, measures);
    if (t.is_set) {
        se3di_inplace_end(study);
    } else {
        se3d_model_destroy(t.model);
    }
    se3di_iopool_destroy(&t.pool);
    se3di_study_end(study, work);
    return status > 0 ? SE3D_OK : status;
}

se3d_status se3di_study_run(se3d_study *study, const se3di_named *values, size_t count,
                            double *measures, se3d_model_error *error)
{
    return se3di_study_run_with(study, values, count, NULL, measures, error);
}
