/* SPDX-License-Identifier: BSD-3-Clause */
/* Running a model: its analyses one after the other, the rows of its results files on the way.
 *
 * Output k of an analysis has a row at start + i * every, i = 0, 1, ..., and one at the end. The
 * solver is run from one time at which any file wants a row to the next; times are computed from
 * their number, never summed up, and the last one is start + duration exactly. If an analysis
 * begins at the time at which the one before ended, its first row takes the place of the last one.
 * If an event stops an analysis the last row is that of the event; others are in their own
 * file. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/floats.h"
#include "io/base/pool.h"
#include "io/base/sized.h"
#include "io/channel/channel.h"
#include "io/channel/event.h"
#include "io/channel/output.h"
#include "io/channel/sample.h"
#include "io/model/model.h"
#include "io/run/checkpoint.h"
#include "io/run/guest.h"
#include "io/run/run_estimate.h"
#include "io/run/run_files.h"
#include "io/run/run_modes.h"
#include "io/run/run_particles.h"
#include "io/run/run_record.h"
#include "io/run/runner.h"

/* An analysis that is run for the state at its end only. */
static void plan_passing(se3di_runner *r, const se3di_analysis_entry *entry)
{
    se3di_output_file *file = &r->files[0];
    file->next = 0.0;
    file->every = entry->analysis.duration;
    file->count = file->every > 0.0 ? 1.0 : 0.0;
}

static bool needs_more_than_motion(const se3di_output_entry *entry)
{
    bool more = entry->vtk || entry->average || entry->particles || entry->contacts;
    for (size_t k = 0; k < entry->count && !more; ++k) {
        more = !se3di_channel_is_shown(&entry->channels[k]);
    }
    return more;
}

/* Number of rows of each file in this analysis. */
static void plan(se3di_runner *r, const se3di_analysis_entry *entry)
{
    if (r->watch && !se3di_files_is_watched(r)) {
        plan_passing(r, entry);
        return;
    }
    for (size_t k = 0; k < r->file_count; ++k) {
        se3di_output_file *file = &r->files[k];
        file->next = 0.0;
        file->solves = needs_more_than_motion(file->entry);
        file->count = se3di_output_count_rows(file->entry, entry, &file->every);
    }
}

/* What does not converge: steps and methods are those of dynamics. */
static const char *advise_iteration(int32_t analysis)
{
    switch (analysis) {
    case SE3D_ANALYSIS_EQUILIBRIUM:
        return "start from a position nearer to the equilibrium, or run dynamics with dampers "
               "before it";
    case SE3D_ANALYSIS_ASSEMBLY:
        return "start from positions nearer to the assembled ones, or see `se3d check`";
    case SE3D_ANALYSIS_DYNAMICS:
        return "try a smaller --step, another --method, or `se3d check` at this position";
    default:
        return "try a smaller --step, or `se3d check` at this position";
    }
}

/* The advice that fits a failure. */
static const char *advise(se3d_status status, int32_t analysis)
{
    const bool moves = analysis != SE3D_ANALYSIS_EQUILIBRIUM && analysis != SE3D_ANALYSIS_ASSEMBLY;
    switch (status) {
    case SE3D_ERR_INCONSISTENT:
        return "look for constraints and drivers that contradict each other with `se3d check`, and "
               "check the positions at the start";
    case SE3D_ERR_SINGULAR:
        return "the mechanism may be at a dead point or not fully driven: see `se3d check`";
    case SE3D_ERR_NO_CONVERGENCE:
    case SE3D_ERR_STEP_SIZE:
        return advise_iteration(analysis);
    case SE3D_ERR_STEP_COUNT:
        return "try a larger --step, a looser `tolerance`, --method radau if the motion is stiff, "
               "a shorter --duration, or a larger `steps_max`";
    case SE3D_ERR_NOT_FINITE:
        return moves
                   ? "look for a function that is not finite at this time, or try a smaller --step"
                   : "look for a function that is not finite at this time";
    case SE3D_ERR_UNSUPPORTED:
        return "choose another --method, --formulation or --analysis";
    default:
        return "see the message above";
    }
}

/* A message without the time that it begins with, if that is told already. */
static const char *without_time(const char *message, double now)
{
    char head[64];
    for (int digits = 6; digits <= 9; digits += 3) {
        const int length = snprintf(head, sizeof head, "t = %.*g s: ", digits, now);
        if (strncmp(message, head, (size_t)length) == 0) {
            return message + length;
        }
    }
    return message;
}

/* What overlaps is told what to do, which no status knows. */
static bool has_advice(const char *why)
{
    return strstr(why, "; move them apart") || strstr(why, "; try a stiffer material");
}

static se3d_status fail_analysis(se3di_runner *r, const se3di_analysis_entry *entry,
                                 se3d_status status, double target)
{
    char text[1000];
    char way[80] = "";
    double now = r->time;
    se3d_system_get_time(r->model->system, &now);
    const char *why = without_time(se3d_system_get_error(r->model->system), now);
    if (target > now) {
        snprintf(way, sizeof way, " on the way to t = %.9g", target);
    }
    if (status == SE3D_ERR_INTERRUPTED) {
        snprintf(text, sizeof text, "the %s analysis was interrupted at t = %.9g s",
                 entry->analysis.type, now);
        return se3di_files_fail(r, status, text);
    }
    const int length =
        snprintf(text, sizeof text, "the %s analysis failed at t = %.9g s%s: %.500s",
                 entry->analysis.type, now, way, why[0] ? why : se3d_status_get_text(status));
    if (!has_advice(why)) {
        snprintf(text + length, sizeof text - (size_t)length, ". What to try: %s",
                 advise(status, entry->solver.analysis));
    }
    return se3di_files_fail(r, status, text);
}

/* The earliest time at which a file wants its next row; false: all have theirs. */
static bool next_time(const se3di_runner *r, double start, double duration, double *time)
{
    bool found = false;
    for (size_t k = 0; k < r->file_count; ++k) {
        const se3di_output_file *file = &r->files[k];
        if (file->next <= file->count) {
            const double wanted = se3di_files_row_time(file, file->next, start, duration);
            *time = found ? fmin(*time, wanted) : wanted;
            found = true;
        }
    }
    return found;
}

static bool has_row_at(const se3di_output_file *file, double start, double duration, double time)
{
    return file->next <= file->count &&
           se3di_files_row_time(file, file->next, start, duration) - time <= 1e-9 * file->every;
}

/* What the rows at `time` need; the last state of an analysis, where others begin, is whole. */
static int32_t shown_at(const se3di_runner *r, double start, double duration, double time)
{
    bool more = time >= start + duration || se3di_guests_are_due(r->guests, time);
    for (size_t k = 0; k < r->file_count && !more; ++k) {
        more = r->files[k].solves && has_row_at(&r->files[k], start, duration, time);
    }
    return more ? SE3D_SHOWN_ALL : SE3D_SHOWN_MOTION;
}

/* To `time`, as far as the rows there need it. */
static se3d_status run_to(se3di_runner *r, double start, double duration, double time)
{
    const se3d_status status = se3d_solver_set_shown(r->solver, shown_at(r, start, duration, time));
    return status < 0 ? status : se3d_solver_run(r->solver, time);
}

static se3d_status sample_files(se3di_runner *r, double start, double duration, double time)
{
    se3di_files_begin_rows(r);
    for (size_t k = 0; k < r->file_count; ++k) {
        se3di_output_file *file = &r->files[k];
        if (has_row_at(file, start, duration, time)) {
            const se3d_status status = se3di_files_sample(r, file, time);
            if (status < 0) {
                return status;
            }
            file->next += 1.0;
        }
    }
    return SE3D_OK;
}

/* Times of two files that differ by rounding only are one time: the later is asked for first. */
static double merge_times(const se3di_runner *r, double start, double duration, double time)
{
    double merged = time;
    for (size_t k = 0; k < r->file_count; ++k) {
        const se3di_output_file *file = &r->files[k];
        if (file->next <= file->count) {
            const double wanted = se3di_files_row_time(file, file->next, start, duration);
            if (wanted - time <= 1e-9 * file->every && wanted > merged) {
                merged = wanted;
            }
        }
    }
    return merged;
}

/* Rows of all files where an event, or the user, has ended the analysis. */
static se3d_status sample_stop(se3di_runner *r, double time)
{
    se3d_status status = SE3D_OK;
    se3di_files_begin_rows(r);
    for (size_t k = 0; k < r->file_count && status >= 0; ++k) {
        status = se3di_files_sample(r, &r->files[k], time);
    }
    return status;
}

static void show_progress(se3di_runner *r, size_t index, double time, double start, double duration)
{
    if (!r->options->progress) {
        return;
    }
    if (r->options->progress(r->options->ctx, index, time,
                             duration > 0.0 ? (time - start) / duration : 1.0)) {
        r->stopped = true;
    }
    se3di_floats_resume();
}

static se3d_status collect_events(se3di_runner *r, size_t index, se3d_status status)
{
    se3d_run *run = r->run;
    if (!run->events.is_open || !r->solver) {
        return status;
    }
    const se3d_status collected =
        se3di_event_list_collect(&run->events, &run->pool, r->model, r->solver, index);
    return collected < 0 && status >= 0 ? se3di_files_fail(r, collected, "out of memory") : status;
}

/* CPU time of the analysis itself so far [s]. */
static double cpu_time(const se3di_runner *r)
{
    return r->cpu_before + (double)(clock() - r->begin) / (double)CLOCKS_PER_SEC -
           se3di_estimate_get_time(r->estimate);
}

static void save(se3di_runner *r, const se3di_place *reached)
{
    se3di_place place = *reached;
    place.cpu = cpu_time(r);
    se3di_checkpoint_write(r, &place);
    r->saved = se3di_files_time_of_day();
}

/* A checkpoint, if it is time for one. None is of the end of an analysis, which may have rows that
 * are there for the end's sake; so one goes on from it also where the analysis takes longer. */
static void save_in_time(se3di_runner *r, const se3di_place *reached, double end)
{
    const double now = se3di_files_time_of_day();
    if (r->options->checkpoint > 0.0 && !r->stopped && reached->reached < end &&
        !(now - r->saved < r->options->checkpoint && now >= r->saved)) {
        save(r, reached);
    }
}

/* The checkpoint that stays: of the last rows before those at the end. */
static void save_before_end(se3di_runner *r, const se3di_place *reached, double time, double end)
{
    if (r->options->keep && !(time < end) && reached->reached < end &&
        reached->reached > -HUGE_VAL && r->analysis + 1 == r->model->analysis_count) {
        save(r, reached);
        r->kept = true;
    }
}

/* At a communication point: units go on, and what they say acts from here. */
static se3d_status meet_guests(se3di_runner *r, double time, se3d_status last)
{
    char problem[SE3DI_GUEST_PROBLEM];
    if (last < 0 || last == SE3D_INFO_EVENT || !se3di_guests_are_due(r->guests, time)) {
        return last;
    }
    se3di_files_begin_rows(r);
    const se3d_status status = se3di_guests_meet(r->guests, &r->sample, time, problem);
    if (status < 0) {
        return se3di_files_fail(r, status, problem);
    }
    return se3d_solver_run(r->solver, time);
}

static se3d_status run_rows(se3di_runner *r, size_t index, const se3di_analysis_entry *entry,
                            const se3di_place *place)
{
    const double duration = entry->analysis.duration;
    const double start = place->start;
    se3d_status last = (se3d_status)place->last;
    se3di_place at = *place;
    double time = start;
    while (next_time(r, start, duration, &time) && !r->stopped) {
        time = se3di_guests_limit(r->guests, merge_times(r, start, duration, time));
        save_before_end(r, &at, time, start + duration);
        last = r->model->particles ? se3di_tagged_advance(r->model, &entry->solver, r->solver, time)
                                   : run_to(r, start, duration, time);
        last = meet_guests(r, time, last);
        if (last < 0 && r->guests && se3di_guests_have_failed(r->guests)) {
            return last;
        }
        if (last < 0 && last != SE3D_ERR_INTERRUPTED) {
            return fail_analysis(r, entry, last, time);
        }
        const bool ends = last == SE3D_INFO_EVENT || last < 0;
        if (ends) {
            se3d_system_get_time(r->model->system, &time);
        }
        const bool has_row = last < 0 && !(time > at.reached);
        const se3d_status status = has_row ? SE3D_OK
                                   : ends  ? sample_stop(r, time)
                                           : sample_files(r, start, duration, time);
        if (status < 0) {
            return status;
        }
        at.reached = time;
        at.last = (int32_t)last;
        if (collect_events(r, index, SE3D_OK) < 0) {
            return SE3D_ERR_NO_MEMORY;
        }
        if (se3di_estimate_meet(r->estimate, time, ends || !(time < start + duration)) < 0) {
            return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
        }
        se3di_files_flush(r);
        show_progress(r, index, time, start, duration);
        if (ends) {
            break;
        }
        save_in_time(r, &at, start + duration);
    }
    return last < 0 ? fail_analysis(r, entry, last, time) : last;
}

/* The files of the modes, and the state at which they are. */
static se3d_status run_modes(se3di_runner *r, const se3di_analysis_entry *entry, double start)
{
    se3di_modes_run modes = {.model = r->model,
                             .entry = &entry->modes,
                             .folder = r->options->directory,
                             .watch = r->watch,
                             .pool = &r->run->pool};
    se3d_status status = se3di_modes_run_write(&modes);
    for (size_t k = 0; k < modes.file_count; ++k) {
        se3d_run_file *grown = se3di_iopool_grow(&r->run->pool, r->run->files, r->run->file_count,
                                                 &r->run->file_capacity, sizeof *grown);
        if (!grown) {
            return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
        }
        r->run->files = grown;
        r->run->files[r->run->file_count++] = modes.files[k];
    }
    if (status < 0 && modes.problem[0]) {
        return se3di_files_fail(r, status, modes.problem);
    }
    return status < 0 ? fail_analysis(r, entry, status, start) : sample_files(r, start, 0.0, start);
}

/* The solver of an analysis: of its whole duration, and it can be interrupted. */
static se3d_status create_solver(se3di_runner *r, const se3di_analysis_entry *entry, double start)
{
    se3d_solver_def def = entry->solver;
    const double end = start + entry->analysis.duration;
    def.horizon = fabs(end) > 0.0 ? end : DBL_MIN; /* 0 means none */
    def.interrupt = r->options->interrupt;
    def.interrupt_ctx = r->options->interrupt_ctx;
    return se3d_solver_create(r->model->system, &def, &r->solver);
}

/* The solver and its events, at the start or where the run that is gone on with was. */
static se3d_status begin_analysis(se3di_runner *r, const se3di_analysis_entry *entry,
                                  se3di_place *place)
{
    const bool watched = se3di_files_is_watched(r);
    const double start = place->start;
    se3d_status status = r->resume ? SE3D_OK : se3d_system_set_time(r->model->system, start);
    if (status >= 0 && !entry->modes.file) {
        status = create_solver(r, entry, start);
    }
    if (status >= 0 && se3di_analysis_has_motion(entry)) {
        status = se3di_events_create(r->model, r->solver, watched ? r->watch->event : NULL,
                                     watched ? r->watch->ctx : NULL);
    }
    if (status < 0) {
        return fail_analysis(r, entry, status, start);
    }
    if (r->model->guest_count > 0 && se3di_analysis_has_motion(entry)) {
        char problem[SE3DI_GUEST_PROBLEM];
        const double span[2] = {start, start + entry->analysis.duration};
        const bool keeps = se3di_runner_has_checkpoints(r);
        status =
            se3di_guests_open(r->model, span, r->options->temporary, keeps, &r->guests, problem);
        if (status < 0) {
            return se3di_files_fail(r, status, problem);
        }
    }
    if (r->resume) {
        status = se3di_checkpoint_restore(r, place);
        r->cpu_before = place->cpu;
    } else if (status >= 0 && se3di_estimate_begin(r, entry) < 0) {
        return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    return status;
}

/* Its beginning: at a time that is given, or where the one before has ended. */
static double start_of(const se3di_runner *r, const se3di_analysis_entry *entry)
{
    return r->resume                      ? se3di_checkpoint_get_start(r)
           : isnan(entry->analysis.start) ? r->time
                                          : entry->analysis.start;
}

static se3d_status run_analysis(se3di_runner *r, size_t index)
{
    const se3di_analysis_entry *entry = &r->model->analyses[index];
    se3d_run_analysis *done = &r->run->analyses[r->run->analysis_count++];
    se3di_place place = {.start = start_of(r, entry), .reached = -HUGE_VAL, .last = SE3D_OK};
    r->analysis = index;
    r->run->events.collected = r->resume ? r->run->events.collected : 0;
    r->begin = clock();
    r->cpu_before = 0.0;
    done->type = se3di_run_copy_text(r, entry->analysis.type);
    done->formulation = se3d_formulation_get_name(SE3D_FORMULATION_ROMEGA);
    done->method = "";
    done->start = place.start;
    done->end = place.start;
    se3d_status status =
        done->type[0] != '\0' ? SE3D_OK : se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    plan(r, entry);
    status = status < 0 ? status : begin_analysis(r, entry, &place);
    if (status >= 0) {
        status = entry->modes.file ? run_modes(r, entry, place.start)
                                   : run_rows(r, index, entry, &place);
    }
    status = collect_events(r, index, status);
    if (status >= 0 && r->watch && r->watch->settle && index == r->settled) {
        const se3d_status told = r->watch->settle(r->watch->ctx, r->solver);
        status = told < 0 ? told : status;
    }
    se3di_run_record(r, entry, cpu_time(r), done);
    se3di_estimate_end(r, done);
    if (r->run->pool.is_short && status >= 0) { /* a text of the record is missing */
        status = se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    done->status = (int32_t)status;
    se3di_guests_close(r->guests);
    r->guests = NULL;
    se3d_solver_destroy(r->solver);
    r->solver = NULL;
    return status;
}

static se3d_run *create_run(const se3d_model *model)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, &model->pool.allocator);
    se3d_run *run = se3di_iopool_alloc(&pool, sizeof *run);
    if (run) {
        run->analyses = se3di_iopool_array(&pool, model->analysis_count, sizeof *run->analyses);
    }
    if (!run || !run->analyses) {
        se3di_iopool_destroy(&pool);
        return NULL;
    }
    run->pool = pool;
    return run;
}

/* No checkpoint could be kept. */
static void tell_of_none(const se3di_runner *r)
{
    if (r->options->keep && r->model->log) {
        r->model->log(r->model->log_ctx, SE3D_LOG_WARNING, SE3D_LOG_CHECKPOINT,
                      "no checkpoint is kept: an event has ended the last analysis, or it has no "
                      "rows before its end");
    }
}

static se3d_status run_all(se3di_runner *r)
{
    se3d_status status = se3di_files_begin(r);
    if (status < 0) {
        for (size_t k = 0; k < r->file_count; ++k) {
            se3di_files_give_up(r, &r->files[k].csv);
        }
        se3di_files_give_up(r, &r->run->events.csv);
        return status;
    }
    if (!r->resume) {
        se3di_checkpoint_remove(r);
        se3d_system_get_time(r->model->system, &r->time);
    }
    for (size_t k = r->resume ? r->analysis : 0;
         k < r->model->analysis_count && status >= 0 && !r->stopped; ++k) {
        status = run_analysis(r, k);
    }
    const se3d_status summed =
        r->model->particles ? se3di_tagged_sum_up(r->model->particles, &r->run->pool,
                                                  &r->run->particles, &r->run->particles_count)
                            : SE3D_OK;
    if (summed < 0 && status >= 0) {
        status = se3di_files_fail(r, summed, "out of memory");
    }
    status = se3di_files_close_all(r, status);
    const bool ended = status >= 0 && !r->stopped;
    if (ended && !r->kept) {
        tell_of_none(r);
        se3di_checkpoint_remove(r);
    }
    if (ended ? !r->kept : !se3di_runner_has_checkpoints(r)) {
        se3di_files_tidy(r);
    }
    return status;
}

se3d_status se3d_model_run(se3d_model *model, const se3d_run_options *options, se3d_run **out,
                           se3d_model_error *error)
{
    se3d_run_options used = se3d_run_options_default();
    se3di_runner r = {.model = model, .options = &used, .error = error};
    if (out) {
        *out = NULL;
    }
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (!model || !out) {
        return se3di_files_fail(&r, SE3D_ERR_NULL, "model or out is NULL");
    }
    if (options) {
        if (!se3di_io_take(options, &used, sizeof used)) {
            return se3di_files_fail(&r, SE3D_ERR_INVALID_ARGUMENT, "options: " SE3DI_IO_SIZE_TEXT);
        }
    }
    if (model->analysis_count == 0) {
        return se3di_files_fail(&r, SE3D_ERR_STATE, "the model has no `analysis`");
    }
    if (model->running || se3d_system_is_busy(model->system)) {
        return se3di_files_fail(&r, SE3D_ERR_STATE, "the model is being run");
    }
    r.run = create_run(model);
    if (!r.run) {
        return se3di_files_fail(&r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    ++model->running;
    model->kept = used.scene;
    r.saved = se3di_files_time_of_day();
    const se3di_floats host = se3di_floats_set();
    se3di_sample_init(&r.sample, model->system, &model->pool.allocator);
    const se3d_status status = run_all(&r);
    se3di_sample_destroy(&r.sample);
    se3di_checkpoint_ignore(&r);
    se3di_floats_restore(host);
    --model->running;
    model->kept = NULL;
    *out = r.run;
    return status;
}

/* One "file" that hands its rows on. */
static se3d_status open_watch(se3di_runner *r)
{
    const se3di_output_entry *output = r->watch->output;
    size_t columns = 1;
    for (size_t k = 0; k < output->count; ++k) {
        columns += se3di_channel_get_width(&output->channels[k]);
    }
    r->files = se3di_iopool_alloc(&r->run->pool, sizeof *r->files);
    double *row = se3di_iopool_array(&r->run->pool, columns, sizeof *row);
    if (!r->files || !row) {
        return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    r->files->entry = output;
    r->files->row = row;
    r->file_count = 1;
    return SE3D_OK;
}

se3d_status se3di_model_watch(se3d_model *model, const se3di_watch *watch,
                              const se3d_run_options *options, se3d_model_error *error)
{
    se3di_runner r = {.model = model, .watch = watch, .options = options, .error = error};
    r.run = create_run(model);
    if (!r.run) {
        return se3di_files_fail(&r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    ++model->running;
    se3di_sample_init(&r.sample, model->system, &model->pool.allocator);
    se3d_status status = open_watch(&r);
    se3d_system_get_time(model->system, &r.time);
    r.settled = SIZE_MAX;
    for (size_t k = 0; k < watch->analysis; ++k) {
        r.settled = model->analyses[k].modes.file ? r.settled : k;
    }
    for (size_t k = 0; k <= watch->analysis && status >= 0; ++k) {
        const bool passes = model->analyses[k].modes.file && k < watch->analysis;
        status = passes ? status : run_analysis(&r, k);
    }
    se3di_sample_destroy(&r.sample);
    --model->running;
    se3d_run_destroy(r.run);
    return status;
}
