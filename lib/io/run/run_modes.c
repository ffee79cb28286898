/* SPDX-License-Identifier: BSD-3-Clause */
/* The files that an analysis of type modes writes: <file>, and beside it <stem>_A.csv ... _D.csv
 * and <stem>_transfer.csv. Their first column numbers the rows (the frequency in the last one). */
#include "io/run/run_modes.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/file.h"
#include "io/base/pool.h"
#include "io/model/model.h"
#include "io/run/watch.h"
#include "io/write/csv.h"

static const char *const shape_parts[] = {"x", "y", "z", "rx", "ry", "rz"};

static se3d_status fail_file(se3di_modes_run *run, const se3di_csv *csv)
{
    snprintf(run->problem, sizeof run->problem, "%.500s: cannot be written: %s",
             csv->path ? csv->path : run->entry->file,
             csv->failure ? se3di_file_get_text(csv->failure) : "out of memory");
    return csv->failure ? SE3D_ERR_IO : SE3D_ERR_NO_MEMORY;
}

/* Open <stem>suffix.csv, or the file itself if there is no suffix; *row has `columns` numbers. */
static se3d_status open_csv(se3di_modes_run *run, const char *suffix, size_t columns,
                            se3di_csv *csv, double **row)
{
    char name[1100];
    char path[4096];
    const char *file = run->entry->file;
    size_t stem = strlen(file);
    memset(csv, 0, sizeof *csv);
    if (stem > 4 && strcmp(file + stem - 4, ".csv") == 0 && suffix[0]) {
        stem -= 4;
    }
    snprintf(name, sizeof name, "%.*s%s%s", (int)stem, file, suffix, suffix[0] ? ".csv" : "");
    if (!se3di_file_join(run->folder, name, path, sizeof path)) {
        snprintf(run->problem, sizeof run->problem, "%.500s: cannot be written: %s", name,
                 errno == ELOOP ? "a symbolic link leads out of the results folder"
                                : strerror(errno));
        return SE3D_ERR_IO;
    }
    *row = se3di_iopool_array(run->pool, columns, sizeof **row);
    const se3d_status status = se3di_csv_open(csv, run->pool, path, columns);
    if (status < 0 || !*row) {
        const se3d_status result = fail_file(run, csv);
        se3di_csv_abandon(csv);
        return result;
    }
    return SE3D_OK;
}

static se3d_status close_csv(se3di_modes_run *run, se3di_csv *csv)
{
    if (se3di_csv_close(csv) < 0) {
        return fail_file(run, csv);
    }
    const se3d_run_file done = {csv->path, csv->rows, csv->columns};
    run->files[run->file_count++] = done;
    return SE3D_OK;
}

static void put_shape_names(const se3di_modes_run *run, se3di_csv *csv, size_t count)
{
    char name[400];
    for (size_t b = 1; b < count; ++b) {
        for (size_t k = 0; k < 12; ++k) {
            snprintf(name, sizeof name, "%s.%s%s", run->model->bodies[b].name, shape_parts[k % 6],
                     k < 6 ? "" : "_imag");
            se3di_csv_put_name(csv, name, b + 1 == count && k == 11);
        }
    }
}

/* One row for each mode: eigenvalue, frequency, damping ratio, shape. */
static se3d_status write_modes(se3di_modes_run *run, const se3d_modes *modes)
{
    static const char *const names[] = {"mode", "real", "imag", "frequency", "damping"};
    const size_t bodies = run->model->body_count;
    const size_t columns = 5 + 12 * (bodies - 1);
    se3di_csv csv;
    double *row = NULL;
    se3d_status status = open_csv(run, "", columns, &csv, &row);
    if (status < 0) {
        return status;
    }
    for (size_t k = 0; k < 5; ++k) {
        se3di_csv_put_name(&csv, names[k], k + 1 == columns);
    }
    put_shape_names(run, &csv, bodies);
    for (size_t m = 0; m < se3d_modes_count(modes) && status >= 0; ++m) {
        se3d_eigenvalue e;
        status = se3d_modes_get_eigenvalue(modes, m, &e);
        row[0] = (double)(m + 1);
        row[1] = e.real;
        row[2] = e.imaginary;
        row[3] = e.frequency;
        row[4] = e.damping;
        for (size_t b = 1; b < bodies && status >= 0; ++b) {
            double *at = row + 5 + 12 * (b - 1);
            status = se3d_modes_get_shape(modes, m, b, at, at + 6);
        }
        se3di_csv_put_row(&csv, row);
    }
    if (status < 0) {
        se3di_csv_abandon(&csv);
        return status;
    }
    return close_csv(run, &csv);
}

static se3d_status write_matrix(se3di_modes_run *run, const se3d_modes *modes, int32_t matrix)
{
    static const char *const suffixes[] = {"_A", "_B", "_C", "_D"};
    size_t rows = 0;
    size_t columns = 0;
    se3di_csv csv;
    double *row = NULL;
    char name[32];
    se3d_status status = se3d_modes_get_matrix(modes, matrix, &rows, &columns, NULL, 0);
    if (status < 0 || columns == 0) {
        return status;
    }
    double *values = se3di_iopool_array(run->pool, rows * columns + 1, sizeof *values);
    if (!values) {
        return SE3D_ERR_NO_MEMORY;
    }
    status = se3d_modes_get_matrix(modes, matrix, &rows, &columns, values, rows * columns);
    if (status >= 0) {
        status = open_csv(run, suffixes[matrix], columns + 1, &csv, &row);
    }
    if (status < 0) {
        return status;
    }
    se3di_csv_put_name(&csv, "row", false);
    for (size_t k = 0; k < columns; ++k) {
        snprintf(name, sizeof name, "%zu", k + 1);
        se3di_csv_put_name(&csv, name, k + 1 == columns);
    }
    for (size_t i = 0; i < rows; ++i) {
        row[0] = (double)(i + 1);
        memcpy(row + 1, values + i * columns, columns * sizeof *row);
        se3di_csv_put_row(&csv, row);
    }
    return close_csv(run, &csv);
}

static void put_transfer_names(const se3di_modes_run *run, se3di_csv *csv)
{
    const size_t pairs = run->entry->input_count * run->entry->output_count;
    char name[80];
    se3di_csv_put_name(csv, "frequency", false);
    for (size_t k = 0; k < 2 * pairs; ++k) {
        const size_t pair = k / 2;
        snprintf(name, sizeof name, "output%zu/input%zu.%s", pair / run->entry->input_count + 1,
                 pair % run->entry->input_count + 1, k % 2 == 0 ? "real" : "imag");
        se3di_csv_put_name(csv, name, k + 1 == 2 * pairs);
    }
}

/* From each input to each output, at frequencies in a geometric progression. */
static se3d_status write_transfer(se3di_modes_run *run, const se3d_modes *modes)
{
    const se3di_modes_entry *entry = run->entry;
    const size_t pairs = entry->input_count * entry->output_count;
    const double last = (double)(entry->frequency_count - 1);
    se3di_csv csv;
    double *row = NULL;
    se3d_status status = open_csv(run, "_transfer", 1 + 2 * pairs, &csv, &row);
    if (status < 0) {
        return status;
    }
    put_transfer_names(run, &csv);
    for (size_t k = 0; k < entry->frequency_count && status >= 0; ++k) {
        row[0] = k == entry->frequency_count - 1
                     ? entry->to
                     : entry->from * io_pow(entry->to / entry->from, (double)k / last);
        for (size_t pair = 0; pair < pairs && status >= 0; ++pair) {
            status =
                se3d_modes_get_transfer(modes, pair % entry->input_count, pair / entry->input_count,
                                        row[0], &row[1 + 2 * pair], &row[2 + 2 * pair]);
        }
        se3di_csv_put_row(&csv, row);
    }
    if (status < 0) {
        se3di_csv_abandon(&csv);
        return status;
    }
    return close_csv(run, &csv);
}

/* Eigenvalues for who asked for them. */
static se3d_status show_modes(const se3di_watch *watch, const se3d_modes *modes)
{
    se3d_status status = watch->linearise ? watch->linearise(watch->ctx, modes) : SE3D_OK;
    for (size_t k = 0; watch->mode && k < se3d_modes_count(modes) && status >= 0; ++k) {
        se3d_eigenvalue e;
        status = se3d_modes_get_eigenvalue(modes, k, &e);
        watch->mode(watch->ctx, k, &e);
    }
    return status;
}

static se3d_status write_files(se3di_modes_run *run, const se3d_modes *modes)
{
    const se3di_modes_entry *entry = run->entry;
    const bool matrices = entry->input_count + entry->output_count > 0;
    se3d_status status = write_modes(run, modes);
    for (int32_t k = SE3D_MODES_A; k <= SE3D_MODES_D && matrices && status >= 0; ++k) {
        status = write_matrix(run, modes, k);
    }
    return status >= 0 && entry->frequency_count > 0 ? write_transfer(run, modes) : status;
}

se3d_status se3di_modes_run_write(se3di_modes_run *run)
{
    const se3di_modes_entry *entry = run->entry;
    se3d_modes_def def = se3d_modes_def_default();
    se3d_modes *modes = NULL;
    def.inputs = entry->inputs;
    def.input_count = entry->input_count;
    def.outputs = entry->outputs;
    def.output_count = entry->output_count;
    def.lowest = (size_t)entry->count;
    se3d_status status = se3d_modes_create(run->model->system, &def, &modes);
    if (status >= 0) {
        status = run->watch ? show_modes(run->watch, modes) : write_files(run, modes);
    }
    se3d_modes_destroy(modes);
    return status;
}
