/* SPDX-License-Identifier: BSD-3-Clause */
/* CSV files: buffered rows, completed by renaming. */
#include "io/write/csv.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "base/hash.h"
#include "io/base/file.h"
#include "io/base/number.h"
#include "io/base/pool.h"

enum { BUFFER_SIZE = 1 << 16 };

static void remember(se3di_csv *csv)
{
    if (csv->failure == 0) {
        csv->failure = errno ? errno : EIO;
    }
}

void se3di_csv_flush(se3di_csv *csv)
{
    errno = 0;
    if (csv->failure == 0 && csv->used > 0) {
        const size_t written = fwrite(csv->buffer, 1, csv->used, csv->file);
        if (written != csv->used) {
            remember(csv);
        }
        for (const char *end = csv->buffer;
             (end = memchr(end, '\n', written - (size_t)(end - csv->buffer))) != NULL;) {
            ++end;
            ++csv->lines;
            csv->whole = csv->written + (uint64_t)(end - csv->buffer);
        }
        if (csv->keeps_hash) {
            csv->hash = se3di_hash_bytes(csv->hash, csv->buffer, written);
        }
        csv->written += written;
    }
    csv->used = 0;
}

static void put(se3di_csv *csv, const char *text, size_t length)
{
    while (length > 0) {
        if (csv->used == BUFFER_SIZE) {
            se3di_csv_flush(csv);
        }
        const size_t room = BUFFER_SIZE - csv->used;
        const size_t part = length < room ? length : room;
        memcpy(csv->buffer + csv->used, text, part);
        csv->used += part;
        text += part;
        length -= part;
    }
}

static bool begin(se3di_csv *csv, se3di_iopool *pool, const char *path, size_t columns)
{
    memset(csv, 0, sizeof *csv);
    csv->columns = columns;
    csv->hash = SE3DI_HASH_START;
    csv->path = se3di_iopool_copy(pool, path, strlen(path));
    csv->buffer = se3di_iopool_alloc(pool, BUFFER_SIZE);
    csv->pending = se3di_iopool_array(pool, columns, sizeof *csv->pending);
    return csv->path && csv->buffer && csv->pending;
}

static se3d_status take_file(se3di_csv *csv, FILE *file)
{
    csv->file = file;
    if (!csv->file) {
        remember(csv);
        return SE3D_ERR_IO;
    }
    setvbuf(csv->file, NULL, _IONBF, 0);
    return SE3D_OK;
}

se3d_status se3di_csv_open(se3di_csv *csv, se3di_iopool *pool, const char *path, size_t columns)
{
    if (!begin(csv, pool, path, columns)) {
        return SE3D_ERR_NO_MEMORY;
    }
    errno = 0;
    return take_file(csv, se3di_file_make_folders(path) ? se3di_partial_open(path) : NULL);
}

se3d_status se3di_csv_continue(se3di_csv *csv, se3di_iopool *pool, const char *path, size_t columns,
                               const se3di_csv_mark *mark)
{
    if (!begin(csv, pool, path, columns)) {
        return SE3D_ERR_NO_MEMORY;
    }
    errno = 0;
    csv->written = csv->whole = mark->bytes;
    csv->lines = mark->lines;
    csv->rows = mark->rows;
    csv->hash = mark->hash;
    csv->keeps_hash = true;
    return take_file(csv, se3di_partial_continue(path, mark->bytes, mark->hash));
}

bool se3di_csv_mark_here(se3di_csv *csv, bool sync, se3di_csv_mark *mark)
{
    se3di_csv_flush(csv);
    *mark = (se3di_csv_mark){csv->written, csv->lines, csv->rows, csv->hash};
    return csv->failure == 0 && (!sync || se3di_file_sync(csv->file));
}

void se3di_csv_pack_pending(se3di_csv *csv, se3di_coder *coder)
{
    size_t columns = csv->columns;
    se3di_code_size(coder, &columns);
    se3di_pack_flag(coder, &csv->has_pending);
    if (columns != csv->columns) {
        coder->failed = 1;
    } else if (csv->has_pending) {
        se3di_code_numbers(coder, csv->pending, columns);
    }
}

void se3di_csv_leave(se3di_csv *csv)
{
    if (csv->file) {
        se3di_partial_leave(csv->file);
        csv->file = NULL;
    }
}

/* Names with commas or quotes cannot occur: the reader does not allow them. */
void se3di_csv_put_name(se3di_csv *csv, const char *name, bool last)
{
    put(csv, name, strlen(name));
    put(csv, last ? "\n" : ",", 1);
}

static void write_pending(se3di_csv *csv)
{
    char room[SE3DI_NUMBER_SIZE + 1];
    if (!csv->has_pending) {
        return;
    }
    for (size_t k = 0; k < csv->columns; ++k) {
        const bool fits = BUFFER_SIZE - csv->used >= sizeof room;
        char *text = fits ? csv->buffer + csv->used : room;
        size_t length = se3di_number_format(csv->pending[k], text);
        text[length++] = k + 1 < csv->columns ? ',' : '\n';
        if (fits) {
            csv->used += length;
        } else {
            put(csv, text, length);
        }
    }
    csv->has_pending = false;
    ++csv->rows;
}

void se3di_csv_put_row(se3di_csv *csv, const double *row)
{
    const bool again =
        csv->has_pending && !(row[0] < csv->pending[0]) && !(row[0] > csv->pending[0]);
    if (!again) {
        write_pending(csv);
    }
    memcpy(csv->pending, row, csv->columns * sizeof *row);
    csv->has_pending = true;
}

void se3di_csv_put_cells(se3di_csv *csv, const se3di_csv_cell *cells, size_t count)
{
    char text[SE3DI_NUMBER_SIZE + 1];
    write_pending(csv);
    for (size_t k = 0; k < count; ++k) {
        if (cells[k].text) {
            put(csv, cells[k].text, strlen(cells[k].text));
        } else {
            put(csv, text, se3di_number_format(cells[k].number, text));
        }
        put(csv, k + 1 < count ? "," : "\n", 1);
    }
    ++csv->rows;
}

se3d_status se3di_csv_close(se3di_csv *csv)
{
    write_pending(csv);
    se3di_csv_flush(csv);
    FILE *file = csv->file;
    csv->file = NULL;
    if (csv->failure != 0) { /* lines: the names of the columns are one */
        csv->rows = csv->lines > 1 ? csv->lines - 1 : 0;
        if (csv->rows == 0 || !se3di_partial_keep(file, csv->path, csv->whole)) {
            csv->rows = 0;
            se3di_partial_abandon(file, csv->path);
        }
        return SE3D_ERR_IO;
    }
    if (!se3di_partial_close(file, csv->path)) {
        remember(csv);
        return SE3D_ERR_IO;
    }
    return SE3D_OK;
}

void se3di_csv_abandon(se3di_csv *csv)
{
    if (csv->file) {
        se3di_partial_abandon(csv->file, csv->path);
        csv->file = NULL;
    }
}
