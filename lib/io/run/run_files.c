/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of results while a model runs: opened, one row after the other, flushed, closed. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "io/base/file.h"
#include "io/base/pool.h"
#include "io/channel/channel.h"
#include "io/channel/event.h"
#include "io/channel/output.h"
#include "io/channel/sample.h"
#include "io/document/document.h"
#include "io/model/model.h"
#include "io/run/checkpoint.h"
#include "io/run/run_files.h"
#include "io/run/runner.h"
#include "io/write/contact_list.h"
#include "io/write/particle_list.h"
#include "io/write/table_hdf5.h"

#define FLUSH_EVERY 1.0 /* s */
#define ROWS_ENDING ".csv"

se3d_status se3di_files_fail(se3di_runner *r, se3d_status status, const char *text)
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
        return se3di_files_fail(r, SE3D_ERR_STATE, text);
    }
    snprintf(text, sizeof text, "%.500s: cannot be written: %s", path,
             memory ? "out of memory" : se3di_file_get_text(why));
    return se3di_files_fail(r, memory ? SE3D_ERR_NO_MEMORY : SE3D_ERR_IO, text);
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
    return se3di_files_fail(r, SE3D_ERR_IO, text);
}

static se3d_status fail_file(se3di_runner *r, const se3di_output_file *file)
{
    return fail_csv(r, &file->csv);
}

static se3d_status open_vtk(se3di_runner *r, const se3di_output_entry *entry, const char *path)
{
    se3di_output_file *file = &r->files[r->file_count];
    file->entry = entry;
    file->vtk =
        se3di_vtk_open(r->model, &r->run->pool, path, file->entry->grid, (int)entry->compression);
    if (!file->vtk) {
        return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
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
    return se3di_files_fail(r, SE3D_ERR_IO, text);
}

/* What is written at the end, in place of rows. */
static bool open_sums(const se3di_runner *r, const se3di_output_entry *entry,
                      se3di_output_file *file)
{
    if (entry->summary) {
        file->summary = se3di_summary_create(&r->run->pool, entry);
    }
    if (entry->average) {
        file->average = se3di_average_create(r->model, &r->run->pool, entry);
    }
    return !entry->summary == !file->summary && !entry->average == !file->average;
}

static size_t count_sums(const se3di_output_file *file)
{
    return file->summary ? SE3DI_SUMMARY_COLUMNS : se3di_average_count_columns(file->average);
}

static void put_sums_head(se3di_output_file *file)
{
    const size_t count = count_sums(file);
    for (size_t k = 0; k < count; ++k) {
        se3di_csv_put_name(&file->csv,
                           file->summary ? se3di_summary_get_column(k)
                                         : se3di_average_get_column(file->average, k),
                           k + 1 == count);
    }
}

/* The file of the next output. */
static se3d_status open_csv(const se3di_runner *r, se3di_csv *csv, const char *path, size_t columns)
{
    se3di_iopool *pool = &r->run->pool;
    const se3d_status status = r->resume
                                   ? se3di_csv_continue(csv, pool, path, columns,
                                                        se3di_checkpoint_get_mark(r, r->file_count))
                                   : se3di_csv_open(csv, pool, path, columns);
    csv->keeps_hash = se3di_runner_has_checkpoints(r);
    return status;
}

void se3di_files_give_up(const se3di_runner *r, se3di_csv *csv)
{
    if (r->resume) {
        se3di_csv_leave(csv);
    } else {
        se3di_csv_abandon(csv);
    }
}

/* The rows of what is not to be CSV stand beside it until they are all there: results.h5.csv. That
 * it cannot have its name is known before the work, not after it. */
static bool name_rows(se3di_runner *r, se3di_output_file *file, char *path, size_t size)
{
    if (se3di_output_get_format(file->entry) == SE3DI_OUTPUT_CSV) {
        return true;
    }
    const size_t length = strlen(path);
    file->made = se3di_iopool_copy(&r->run->pool, path, length);
    if (!file->made || length + sizeof ROWS_ENDING > size) {
        errno = file->made ? ENAMETOOLONG : ENOMEM;
        return false;
    }
    memcpy(path + length, ROWS_ENDING, sizeof ROWS_ENDING);
    errno = se3di_file_forbid(file->made);
    return errno == 0;
}

/* The names of the columns. */
static void put_head(se3di_output_file *file, size_t columns)
{
    const se3di_output_entry *entry = file->entry;
    char name[400];
    size_t column = 1;
    if (entry->summary || entry->average) {
        put_sums_head(file);
        return;
    }
    if (entry->particles || entry->contacts) {
        for (size_t k = 0; k < columns; ++k) {
            se3di_csv_put_name(&file->csv,
                               entry->particles ? se3di_tagged_get_column(k)
                                                : se3di_contacts_get_column(k),
                               k + 1 == columns);
        }
        return;
    }
    se3di_csv_put_name(&file->csv, "time", columns == 1);
    for (size_t k = 0; k < entry->count; ++k) {
        const size_t width = se3di_channel_get_width(&entry->channels[k]);
        for (size_t i = 0; i < width; ++i) {
            se3di_channel_format_column(&entry->channels[k], i, name, sizeof name);
            se3di_csv_put_name(&file->csv, name, ++column == columns);
        }
    }
}

static se3d_status open_file(se3di_runner *r, const se3di_output_entry *entry)
{
    se3di_output_file *file = &r->files[r->file_count];
    char path[4096];
    size_t columns = 1;
    const se3d_status joined = join(r, entry->file, path, sizeof path);
    if (joined < 0) {
        return joined;
    }
    if (entry->vtk) {
        return open_vtk(r, entry, path);
    }
    file->entry = entry;
    if (!name_rows(r, file, path, sizeof path)) {
        return fail_path(r, file->made ? file->made : entry->file, errno);
    }
    columns = entry->particles  ? se3di_tagged_count_columns(r->model)
              : entry->contacts ? (size_t)SE3DI_CONTACT_COLUMNS
                                : columns;
    for (size_t k = 0; k < entry->count; ++k) {
        columns += se3di_channel_get_width(&entry->channels[k]);
    }
    if (!open_sums(r, entry, file)) {
        return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    file->row = se3di_iopool_array(&r->run->pool, columns, sizeof *file->row);
    const se3d_status status = open_csv(r, &file->csv, path, columns);
    if (status < 0 || !file->row) {
        const se3d_status result = fail_file(r, file);
        se3di_files_give_up(r, &file->csv);
        return result;
    }
    ++r->file_count;
    if (!r->resume) { /* else its first line is there */
        put_head(file, columns);
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
    events->csv.keeps_hash = se3di_runner_has_checkpoints(r);
    return status < 0 ? fail_path(r, path, events->csv.failure) : SE3D_OK;
}

static se3d_status open_files(se3di_runner *r)
{
    se3d_model *model = r->model;
    r->files = se3di_iopool_array(&r->run->pool, model->output_count, sizeof *r->files);
    if (!r->files) {
        return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
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

bool se3di_files_is_watched(const se3di_runner *r)
{
    return r->watch && r->watch->analysis == r->analysis;
}

double se3di_files_row_time(const se3di_output_file *file, double number, double start,
                            double duration)
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
        return se3di_files_fail(r, status, se3d_status_get_text(status));
    }
    return file->csv.failure ? fail_file(r, file) : SE3D_OK;
}

void se3di_files_begin_rows(se3di_runner *r)
{
    memset(&r->stats, 0, sizeof r->stats);
    se3d_solver_get_stats(r->solver, &r->stats);
    se3di_sample_renew(&r->sample, &r->stats);
}

/* With the rounding of times. */
static bool is_in_window(const se3di_output_file *file, double time)
{
    const double slack = 1e-12 * fabs(time);
    return time + slack >= file->entry->start && time - slack <= file->entry->stop;
}

se3d_status se3di_files_sample(se3di_runner *r, se3di_output_file *file, double time)
{
    double *row = file->row;
    if (r->watch && !se3di_files_is_watched(r)) {
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
    if (file->average) {
        const se3d_status status =
            is_in_window(file, time) ? se3di_average_add(file->average, time) : SE3D_OK;
        return status < 0 ? se3di_files_fail(r, status, se3d_status_get_text(status)) : SE3D_OK;
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
            return se3di_files_fail(r, status, text);
        }
        const size_t width = se3di_channel_get_width(channel);
        for (size_t i = 0; i < width; ++i) {
            *row++ = value[i];
        }
    }
    if (file->summary) {
        if (is_in_window(file, time)) {
            se3di_summary_add(file->summary, time, file->row + 1);
        }
        return SE3D_OK;
    }
    if (r->watch) {
        se3d_status status =
            r->watch->reach ? r->watch->reach(r->watch->ctx, r->solver, time) : SE3D_OK;
        status = status < 0 ? status : r->watch->take(r->watch->ctx, file->row);
        return status < 0 ? se3di_files_fail(r, status, se3d_status_get_text(status)) : status;
    }
    se3di_csv_put_row(&file->csv, file->row);
    return file->csv.failure ? fail_file(r, file) : SE3D_OK;
}

double se3di_files_time_of_day(void)
{
    struct timespec now = {0, 0};
    return timespec_get(&now, TIME_UTC) == TIME_UTC
               ? (double)now.tv_sec + 1e-9 * (double)now.tv_nsec
               : 0.0;
}

void se3di_files_flush(se3di_runner *r)
{
    const double now = se3di_files_time_of_day();
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

static se3d_status close_csv(se3di_runner *r, se3di_csv *csv, se3d_run_file *about)
{
    about->path = csv->path;
    about->columns = csv->columns;
    const se3d_status status = se3di_csv_close(csv);
    about->rows = csv->rows;
    return status < 0 ? fail_csv(r, csv) : SE3D_OK;
}

/* A window that no row is in. */
static void warn_of_no_rows(const se3di_runner *r, const se3di_output_file *file)
{
    const se3di_output_entry *entry = file->entry;
    char text[500], from[40] = "", to[40] = "";
    if (r->model->log) {
        if (isfinite(entry->start)) {
            snprintf(from, sizeof from, " from `start`, %g s,", entry->start);
        }
        if (isfinite(entry->stop)) {
            snprintf(to, sizeof to, " to `stop`, %g s", entry->stop);
        }
        snprintf(text, sizeof text, "%.200s is empty: no row is%s%s", entry->file, from,
                 *to ? to : " on");
        r->model->log(r->model->log_ctx, SE3D_LOG_WARNING, SE3D_LOG_FILE, text);
    }
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
            return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
        }
        run->summaries = grown;
        run->summaries[run->summary_count++] = file->summary->columns[k];
    }
    return SE3D_OK;
}

/* What was to be written at the end. */
static se3d_status close_sums(se3di_runner *r, se3di_output_file *file)
{
    se3d_status status = SE3D_OK;
    if (!(file->summary ? file->summary->begun : file->average->rows > 0)) {
        warn_of_no_rows(r, file);
    }
    if (file->summary) {
        status = close_summary(r, file);
    } else {
        se3di_average_write(file->average, &file->csv);
    }
    file->csv.columns = count_sums(file);
    return status;
}

/* Columns of a table that are texts, or whole numbers. */
static se3di_table_columns columns_of(const se3di_output_entry *entry)
{
    se3di_table_columns columns = {0, 0};
    if (entry->summary) {
        columns.texts = 1;
    } else if (entry->particles) {
        columns = se3di_tagged_get_kinds();
    } else if (entry->contacts) {
        columns = se3di_contacts_get_kinds();
    }
    return columns;
}

/* What the rows become; they stay as CSV if that fails. */
static se3d_status make_file(se3di_runner *r, const se3di_output_file *file, se3d_run_file *about)
{
    char text[1600];
    const se3di_table_columns columns = columns_of(file->entry);
    const int compression = (int)file->entry->compression;
    const bool made = se3di_output_get_format(file->entry) == SE3DI_OUTPUT_VTK
                          ? se3di_average_write_vtk(file->average, file->made, compression)
                          : se3di_table_convert(file->csv.path, file->made, &columns, compression,
                                                &r->model->pool.allocator);
    if (made) {
        about->path = file->made;
        return SE3D_OK;
    }
    const int why = errno;
    snprintf(text, sizeof text, "%.700s: cannot be written: %s; its rows are in %.700s", file->made,
             why == ENOMEM ? "out of memory" : se3di_file_get_text(why), file->csv.path);
    return se3di_files_fail(r, why == ENOMEM ? SE3D_ERR_NO_MEMORY : SE3D_ERR_IO, text);
}

void se3di_files_tidy(const se3di_runner *r)
{
    for (size_t k = 0; k < r->file_count; ++k) {
        if (r->files[k].is_made) {
            se3di_file_remove(r->files[k].csv.path);
        }
    }
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
    if (file->summary || file->average) {
        const se3d_status status = close_sums(r, file);
        if (status < 0) {
            se3di_csv_abandon(&file->csv);
            return status;
        }
    }
    const se3d_status status = close_csv(r, &file->csv, about);
    if (status < 0 || !file->made) {
        return status;
    }
    const se3d_status made = make_file(r, file, about);
    file->is_made = made >= 0;
    return made;
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
        return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    return status < 0 ? status : closed < 0 ? closed : status;
}

se3d_status se3di_files_close_all(se3di_runner *r, se3d_status status)
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

se3d_status se3di_files_begin(se3di_runner *r)
{
    if (se3di_runner_has_checkpoints(r)) {
        if (!se3di_checkpoint_listen(r)) {
            return se3di_files_fail(r, SE3D_ERR_NO_MEMORY, "out of memory");
        }
    }
    se3d_status status = r->options->resume ? se3di_checkpoint_open(r) : SE3D_OK;
    status = status < 0 ? status : open_files(r);
    return status >= 0 && r->resume ? se3di_checkpoint_take(r) : status;
}
