/* SPDX-License-Identifier: BSD-3-Clause */
/* Running a model: its analyses one after the other, the rows of its results files on the way.
 *
 * Output k of an analysis has a row at start + i * every, i = 0, 1, ..., and one at the end. The
 * solver is run from one time at which any file wants a row to the next; times are computed from
 * their number, never summed up, and the last one is start + duration exactly. If an analysis
 * begins at the time at which the one before ended, its first row takes the place of the last one.
 * If an event stops an analysis the last row is that of the event; others are in their own
 * file. */
#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/floats.h"
#include "io/base/file.h"
#include "io/base/pool.h"
#include "io/base/sized.h"
#include "io/channel/channel.h"
#include "io/channel/event.h"
#include "io/channel/output.h"
#include "io/channel/sample.h"
#include "io/document/document.h"
#include "io/model/model.h"
#include "io/run/checkpoint.h"
#include "io/run/guest.h"
#include "io/run/run_modes.h"
#include "io/run/run_particles.h"
#include "io/run/run_record.h"
#include "io/run/runner.h"
#include "io/write/contact_list.h"
#include "io/write/particle_list.h"

#define FLUSH_EVERY 1.0 /* s */

static se3d_status fail(se3di_runner *r, se3d_status status, const char *text)
{
    se3di_document_report(r->error, "", 0, 0, "", text);
    return status;
}

/* `why`: errno, 0 if memory is missing. */
static se3d_status fail_path(se3di_runner *r, const char *path, int why)
{
    char text[800];
    const bool memory = why == 0 || why == ENOMEM;
    if (why == ESTALE) {
        snprintf(text, sizeof text,
                 "%.500s: cannot be resumed: it is not as the checkpoint has left it", path);
        return fail(r, SE3D_ERR_STATE, text);
    }
    snprintf(text, sizeof text, "%.500s: cannot be written: %s", path,
             memory ? "out of memory" : se3di_file_get_text(why));
    return fail(r, memory ? SE3D_ERR_NO_MEMORY : SE3D_ERR_IO, text);
}

/* The rows that are on the disk stay there. */
static se3d_status fail_csv(se3di_runner *r, const se3di_csv *csv)
{
    char text[800];
    if (csv->failure == 0 || csv->failure == ENOMEM || csv->failure == ESTALE || csv->lines < 2) {
        return fail_path(r, csv->path, csv->failure);
    }
    snprintf(text, sizeof text, "%.500s: cannot be written: %s; the first %" PRIu64 " row%s kept",
             csv->path, se3di_file_get_text(csv->failure), csv->lines - 1,
             csv->lines == 2 ? " is" : "s are");
    return fail(r, SE3D_ERR_IO, text);
}

static se3d_status fail_file(se3di_runner *r, const se3di_output_file *file)
{
    return fail_csv(r, &file->csv);
}

static se3d_status open_vtk(se3di_runner *r, const se3di_output_entry *entry, const char *path)
{
    se3di_output_file *file = &r->files[r->file_count];
    file->entry = entry;
    file->vtk = se3di_vtk_open(r->model, &r->run->pool, path, file->entry->grid);
    if (!file->vtk) {
        return fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    ++r->file_count;
    return SE3D_OK;
}

/* The path of a file of the results, which lies in their folder. */
static se3d_status join(se3di_runner *r, const char *file, char *path, size_t size)
{
    char text[800];
    if (se3di_file_join(r->options->directory, file, path, size)) {
        return SE3D_OK;
    }
    snprintf(text, sizeof text, "%.500s: cannot be written: %s", file,
             errno == ELOOP ? "a symbolic link leads out of the results folder" : strerror(errno));
    return fail(r, SE3D_ERR_IO, text);
}

static void put_summary_head(se3di_output_file *file)
{
    for (size_t k = 0; k < SE3DI_SUMMARY_COLUMNS; ++k) {
        se3di_csv_put_name(&file->csv, se3di_summary_get_column(k), k + 1 == SE3DI_SUMMARY_COLUMNS);
    }
}

/* The file of the next output. */
static se3d_status open_csv(const se3di_runner *r, se3di_csv *csv, const char *path, size_t columns)
{
    se3di_iopool *pool = &r->run->pool;
    return r->resume ? se3di_csv_continue(csv, pool, path, columns,
                                          se3di_checkpoint_get_mark(r, r->file_count))
                     : se3di_csv_open(csv, pool, path, columns);
}

/* What a run cannot begin with; what was there of one that is gone on with stays. */
static void give_up(const se3di_runner *r, se3di_csv *csv)
{
    if (r->resume) {
        se3di_csv_leave(csv);
    } else {
        se3di_csv_abandon(csv);
    }
}

static se3d_status open_file(se3di_runner *r, const se3di_output_entry *entry)
{
    se3di_output_file *file = &r->files[r->file_count];
    char path[4096];
    char name[400];
    size_t columns = 1;
    const se3d_status joined = join(r, entry->file, path, sizeof path);
    if (joined < 0) {
        return joined;
    }
    if (entry->vtk) {
        return open_vtk(r, entry, path);
    }
    columns = entry->particles  ? se3di_tagged_count_columns(r->model)
              : entry->contacts ? (size_t)SE3DI_CONTACT_COLUMNS
                                : columns;
    for (size_t k = 0; k < entry->count; ++k) {
        columns += se3di_channel_get_width(&entry->channels[k]);
    }
    if (entry->summary) {
        file->summary = se3di_summary_create(&r->run->pool, entry);
        if (!file->summary) {
            return fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
        }
    }
    file->entry = entry;
    file->row = se3di_iopool_array(&r->run->pool, columns, sizeof *file->row);
    const se3d_status status = open_csv(r, &file->csv, path, columns);
    if (status < 0 || !file->row) {
        const se3d_status result = fail_file(r, file);
        give_up(r, &file->csv);
        return result;
    }
    ++r->file_count;
    if (r->resume) {
        return SE3D_OK; /* its first line is there */
    }
    if (entry->summary) {
        put_summary_head(file);
        return SE3D_OK;
    }
    for (size_t k = 0; k < columns && (entry->particles || entry->contacts); ++k) {
        se3di_csv_put_name(&file->csv,
                           entry->particles ? se3di_tagged_get_column(k)
                                            : se3di_contacts_get_column(k),
                           k + 1 == columns);
    }
    if (entry->particles || entry->contacts) {
        return SE3D_OK;
    }
    se3di_csv_put_name(&file->csv, "time", columns == 1);
    size_t column = 1;
    for (size_t k = 0; k < entry->count; ++k) {
        const size_t width = se3di_channel_get_width(&entry->channels[k]);
        for (size_t i = 0; i < width; ++i) {
            se3di_channel_format_column(&entry->channels[k], i, name, sizeof name);
            se3di_csv_put_name(&file->csv, name, ++column == columns);
        }
    }
    return SE3D_OK;
}

static se3d_status open_events(se3di_runner *r)
{
    char path[4096];
    se3di_event_list *events = &r->run->events;
    const se3d_status joined = join(r, se3di_events_file, path, sizeof path);
    if (joined < 0) {
        return joined;
    }
    const se3d_status status = se3di_event_list_open(
        events, &r->run->pool, path, r->resume ? se3di_checkpoint_get_events(r) : NULL);
    return status < 0 ? fail_path(r, path, events->csv.failure) : SE3D_OK;
}

static se3d_status open_files(se3di_runner *r)
{
    se3d_model *model = r->model;
    r->files = se3di_iopool_array(&r->run->pool, model->output_count, sizeof *r->files);
    if (!r->files) {
        return fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    for (size_t k = 0; k < model->output_count; ++k) {
        const se3d_status status = open_file(r, &model->outputs[k]);
        if (status < 0) {
            return status;
        }
    }
    for (size_t k = 0; k < model->picture_count; ++k) { /* they are made later, by others */
        char path[4096];
        const se3d_status status = join(r, model->pictures[k].file, path, sizeof path);
        if (status < 0) {
            return status;
        }
    }
    return se3di_event_list_is_wanted(model) ? open_events(r) : SE3D_OK;
}

/* Whether the rows of this analysis are what the watch wants. */
static bool is_watched(const se3di_runner *r)
{
    return r->watch && r->watch->analysis == r->analysis;
}

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
    bool more = entry->vtk || entry->particles || entry->contacts;
    for (size_t k = 0; k < entry->count && !more; ++k) {
        more = !se3di_channel_is_shown(&entry->channels[k]);
    }
    return more;
}

/* Number of rows of each file in this analysis. */
static void plan(se3di_runner *r, const se3di_analysis_entry *entry)
{
    if (r->watch && !is_watched(r)) {
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

/* The time of row `number` of a file. */
static double row_time(const se3di_output_file *file, double number, double start, double duration)
{
    return number < file->count ? start + number * file->every : start + duration;
}

/* One row for each particle, or for each contact. */
static se3d_status sample_list(se3di_runner *r, se3di_output_file *file)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, &r->model->pool.allocator);
    const se3d_status status =
        file->entry->contacts ? se3di_contacts_write(r->model, &r->sample, &pool, &file->csv)
                              : se3di_tagged_write(r->model, &pool, file->entry->set, &file->csv);
    se3di_iopool_destroy(&pool);
    if (status < 0) {
        return fail(r, status, se3d_status_get_text(status));
    }
    return file->csv.failure ? fail_file(r, file) : SE3D_OK;
}

/* The rows that follow are of the present state. */
static void begin_rows(se3di_runner *r)
{
    memset(&r->stats, 0, sizeof r->stats);
    se3d_solver_get_stats(r->solver, &r->stats);
    se3di_sample_renew(&r->sample, &r->stats);
}

static se3d_status sample(se3di_runner *r, se3di_output_file *file, double time)
{
    double *row = file->row;
    if (r->watch && !is_watched(r)) {
        return SE3D_OK;
    }
    if (file->vtk) {
        se3di_vtk_record(file->vtk, &r->sample,
                         time); /* a failure is reported at the end: others go on */
        return SE3D_OK;
    }
    if (file->entry->particles || file->entry->contacts) {
        return sample_list(r, file);
    }
    *row++ = time;
    for (size_t k = 0; k < file->entry->count; ++k) {
        const se3di_channel *channel = &file->entry->channels[k];
        double value[4];
        const se3d_status status = se3di_channel_eval(channel, &r->sample, value);
        if (status < 0) {
            char text[600];
            snprintf(text, sizeof text, "the channel `%.300s` cannot be computed at t = %.9g: %s",
                     channel->name, time, se3d_status_get_text(status));
            return fail(r, status, text);
        }
        const size_t width = se3di_channel_get_width(channel);
        memcpy(row, value, width * sizeof *row);
        row += width;
    }
    if (file->summary) {
        se3di_summary_add(file->summary, time, file->row + 1);
        return SE3D_OK;
    }
    if (r->watch) {
        se3d_status status =
            r->watch->reach ? r->watch->reach(r->watch->ctx, r->solver, time) : SE3D_OK;
        status = status < 0 ? status : r->watch->take(r->watch->ctx, file->row);
        return status < 0 ? fail(r, status, se3d_status_get_text(status)) : status;
    }
    se3di_csv_put_row(&file->csv, file->row);
    return file->csv.failure ? fail_file(r, file) : SE3D_OK;
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
        return fail(r, status, text);
    }
    snprintf(text, sizeof text, "the %s analysis failed at t = %.9g s%s: %.500s. What to try: %s",
             entry->analysis.type, now, way, why[0] ? why : se3d_status_get_text(status),
             advise(status, entry->solver.analysis));
    return fail(r, status, text);
}

/* The earliest time at which a file wants its next row; false: all have theirs. */
static bool next_time(const se3di_runner *r, double start, double duration, double *time)
{
    bool found = false;
    for (size_t k = 0; k < r->file_count; ++k) {
        const se3di_output_file *file = &r->files[k];
        if (file->next <= file->count) {
            const double wanted = row_time(file, file->next, start, duration);
            *time = found ? fmin(*time, wanted) : wanted;
            found = true;
        }
    }
    return found;
}

static bool has_row_at(const se3di_output_file *file, double start, double duration, double time)
{
    return file->next <= file->count &&
           row_time(file, file->next, start, duration) - time <= 1e-9 * file->every;
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
    begin_rows(r);
    for (size_t k = 0; k < r->file_count; ++k) {
        se3di_output_file *file = &r->files[k];
        if (has_row_at(file, start, duration, time)) {
            const se3d_status status = sample(r, file, time);
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
            const double wanted = row_time(file, file->next, start, duration);
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
    begin_rows(r);
    for (size_t k = 0; k < r->file_count && status >= 0; ++k) {
        status = sample(r, &r->files[k], time);
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
    return collected < 0 && status >= 0 ? fail(r, collected, "out of memory") : status;
}

/* The time of the day [s]. */
static double clock_now(void)
{
    struct timespec now = {0, 0};
    return timespec_get(&now, TIME_UTC) == TIME_UTC
               ? (double)now.tv_sec + 1e-9 * (double)now.tv_nsec
               : 0.0;
}

/* Whoever watches the files sees what there is, about once a second. */
static void flush_files(se3di_runner *r)
{
    const double now = clock_now();
    if (now - r->flushed < FLUSH_EVERY && now >= r->flushed) {
        return;
    }
    r->flushed = now;
    for (size_t k = 0; k < r->file_count; ++k) {
        if (r->files[k].csv.file) {
            se3di_csv_flush(&r->files[k].csv);
        }
    }
    if (r->run->events.is_open) {
        se3di_csv_flush(&r->run->events.csv);
    }
}

/* CPU time of the analysis so far [s]. */
static double cpu_time(const se3di_runner *r)
{
    return r->cpu_before + (double)(clock() - r->begin) / (double)CLOCKS_PER_SEC;
}

/* A checkpoint, if it is time for one. */
static void save(se3di_runner *r, double start, double reached, se3d_status last)
{
    const double now = clock_now();
    if (!(r->options->checkpoint > 0.0) || r->stopped ||
        (now - r->saved < r->options->checkpoint && now >= r->saved)) {
        return;
    }
    se3di_checkpoint_write(
        r, &(se3di_place){
               .start = start, .reached = reached, .cpu = cpu_time(r), .last = (int32_t)last});
    r->saved = clock_now();
}

/* At a communication point: units go on, and what they say acts from here. */
static se3d_status meet_guests(se3di_runner *r, double time, se3d_status last)
{
    char problem[SE3DI_GUEST_PROBLEM];
    if (last < 0 || last == SE3D_INFO_EVENT || !se3di_guests_are_due(r->guests, time)) {
        return last;
    }
    begin_rows(r);
    const se3d_status status = se3di_guests_meet(r->guests, &r->sample, time, problem);
    if (status < 0) {
        return fail(r, status, problem);
    }
    return se3d_solver_run(r->solver, time);
}

static se3d_status run_rows(se3di_runner *r, size_t index, const se3di_analysis_entry *entry,
                            const se3di_place *place)
{
    const double duration = entry->analysis.duration;
    const double start = place->start;
    se3d_status last = (se3d_status)place->last;
    double time = start;
    double reached = place->reached;
    while (next_time(r, start, duration, &time) && !r->stopped) {
        time = se3di_guests_limit(r->guests, merge_times(r, start, duration, time));
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
        const bool has_row = last < 0 && !(time > reached);
        const se3d_status status = has_row ? SE3D_OK
                                   : ends  ? sample_stop(r, time)
                                           : sample_files(r, start, duration, time);
        if (status < 0) {
            return status;
        }
        reached = time;
        if (collect_events(r, index, SE3D_OK) < 0) {
            return SE3D_ERR_NO_MEMORY;
        }
        flush_files(r);
        show_progress(r, index, time, start, duration);
        if (ends) {
            break;
        }
        save(r, start, reached, last);
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
            return fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
        }
        r->run->files = grown;
        r->run->files[r->run->file_count++] = modes.files[k];
    }
    if (status < 0 && modes.problem[0]) {
        return fail(r, status, modes.problem);
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
    const bool watched = is_watched(r);
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
        const bool keeps = r->options->checkpoint > 0.0 || r->options->resume;
        status =
            se3di_guests_open(r->model, span, r->options->temporary, keeps, &r->guests, problem);
        if (status < 0) {
            return fail(r, status, problem);
        }
    }
    if (r->resume) {
        status = se3di_checkpoint_restore(r, place);
        r->cpu_before = place->cpu;
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
        done->type[0] != '\0' ? SE3D_OK : fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    plan(r, entry);
    status = status < 0 ? status : begin_analysis(r, entry, &place);
    if (status >= 0) {
        status = entry->modes.file ? run_modes(r, entry, place.start)
                                   : run_rows(r, index, entry, &place);
    }
    status = collect_events(r, index, status);
    se3di_run_record(r, entry, cpu_time(r), done);
    done->status = (int32_t)status;
    se3di_guests_close(r->guests);
    r->guests = NULL;
    se3d_solver_destroy(r->solver);
    r->solver = NULL;
    return status;
}

static se3d_status close_csv(se3di_runner *r, se3di_csv *csv, se3d_run_file *about)
{
    about->path = csv->path;
    about->columns = csv->columns;
    const se3d_status status = se3di_csv_close(csv);
    about->rows = csv->rows;
    return status < 0 ? fail_csv(r, csv) : SE3D_OK;
}

/* Its rows, and the columns for those who ask the run. */
static se3d_status close_summary(se3di_runner *r, se3di_output_file *file)
{
    se3d_run *run = r->run;
    se3di_summary_finish(file->summary);
    se3di_summary_write(file->summary, &file->csv);
    for (size_t k = 0; k < file->summary->count && file->summary->begun; ++k) {
        se3d_run_summary *grown = se3di_iopool_grow(&run->pool, run->summaries, run->summary_count,
                                                    &run->summary_capacity, sizeof *grown);
        if (!grown) {
            return fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
        }
        run->summaries = grown;
        run->summaries[run->summary_count++] = file->summary->columns[k];
    }
    return SE3D_OK;
}

/* Complete one file. */
static se3d_status close_file(se3di_runner *r, se3di_output_file *file, se3d_run_file *about)
{
    int why = 0;
    if (file->vtk) {
        const se3d_status status = se3di_vtk_close(file->vtk, &why);
        about->path = se3di_vtk_get_path(file->vtk);
        about->rows = se3di_vtk_count(file->vtk);
        return status < 0 ? fail_path(r, about->path, why) : SE3D_OK;
    }
    if (file->summary) {
        const se3d_status status = close_summary(r, file);
        if (status < 0) {
            se3di_csv_abandon(&file->csv);
            return status;
        }
        file->csv.columns = SE3DI_SUMMARY_COLUMNS;
    }
    return close_csv(r, &file->csv, about);
}

/* One more file of the results, which `closed` says is complete, or which has rows that were kept;
 * the first failure is reported. */
static se3d_status list_file(se3di_runner *r, const se3d_run_file *file, se3d_status closed,
                             se3d_status status)
{
    se3d_run *run = r->run;
    se3d_run_file *grown = se3di_iopool_grow(&run->pool, run->files, run->file_count,
                                             &run->file_capacity, sizeof *grown);
    if (grown) {
        run->files = grown;
        run->files[run->file_count] = *file;
        run->file_count += closed >= 0 || file->rows > 0;
    } else if (status >= 0 && closed >= 0) {
        return fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    return status < 0 ? status : closed < 0 ? closed : status;
}

/* Complete every file, also after a failure: the rows so far are kept. The first failure is
 * reported. */
static se3d_status close_files(se3di_runner *r, se3d_status status)
{
    se3d_model_error *reported = r->error;
    const size_t count = r->file_count + (r->run->events.is_open ? 1 : 0);
    for (size_t k = 0; k < count; ++k) {
        se3d_run_file file = {NULL, 0, 0};
        r->error = status < 0 ? NULL : reported;
        const se3d_status closed = k < r->file_count ? close_file(r, &r->files[k], &file)
                                                     : close_csv(r, &r->run->events.csv, &file);
        status = list_file(r, &file, closed, status);
        r->error = reported;
    }
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

/* What is there of a run that is gone on with, and the files. */
static se3d_status begin_files(se3di_runner *r)
{
    if (r->options->checkpoint > 0.0 || r->options->resume) {
        if (!se3di_checkpoint_listen(r)) {
            return fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
        }
    }
    se3d_status status = r->options->resume ? se3di_checkpoint_open(r) : SE3D_OK;
    status = status < 0 ? status : open_files(r);
    return status >= 0 && r->resume ? se3di_checkpoint_take(r) : status;
}

static se3d_status run_all(se3di_runner *r)
{
    se3d_status status = begin_files(r);
    if (status < 0) {
        for (size_t k = 0; k < r->file_count; ++k) {
            give_up(r, &r->files[k].csv);
        }
        give_up(r, &r->run->events.csv);
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
        status = fail(r, summed, "out of memory");
    }
    status = close_files(r, status);
    if (status >= 0 && !r->stopped) {
        se3di_checkpoint_remove(r);
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
        return fail(&r, SE3D_ERR_NULL, "model or out is NULL");
    }
    if (options) {
        if (!se3di_io_take(options, &used, sizeof used)) {
            return fail(&r, SE3D_ERR_INVALID_ARGUMENT, "options: " SE3DI_IO_SIZE_TEXT);
        }
    }
    if (model->analysis_count == 0) {
        return fail(&r, SE3D_ERR_STATE, "the model has no `analysis`");
    }
    if (model->running || se3d_system_is_busy(model->system)) {
        return fail(&r, SE3D_ERR_STATE, "the model is being run");
    }
    r.run = create_run(model);
    if (!r.run) {
        return fail(&r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    ++model->running;
    model->kept = used.scene;
    r.saved = clock_now();
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
        return fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
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
        return fail(&r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    ++model->running;
    se3di_sample_init(&r.sample, model->system, &model->pool.allocator);
    se3d_status status = open_watch(&r);
    se3d_system_get_time(model->system, &r.time);
    for (size_t k = 0; k <= watch->analysis && status >= 0; ++k) {
        const bool passes = model->analyses[k].modes.file && k < watch->analysis;
        status = passes ? status : run_analysis(&r, k);
    }
    se3di_sample_destroy(&r.sample);
    --model->running;
    se3d_run_destroy(r.run);
    return status;
}
