/* SPDX-License-Identifier: BSD-3-Clause */
/* A CSV file is read twice: how many rows there are and how long the texts, then the values, which
 * are written column by column for as many rows as fit into memory. */
#include "io/write/table_hdf5.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "io/base/file.h"
#include "io/base/number.h"
#include "io/write/hdf5.h"

enum { BUFFER = 1 << 16, CELL_MOST = 1 << 12, BLOCK_BYTES = 1 << 22 };

typedef struct scanner {
    FILE *file;
    char *buffer; /* [BUFFER] */
    size_t at, used;
    char cell[CELL_MOST];
    size_t length;
    bool ends_line;
} scanner;

typedef struct column {
    const char *name;
    se3di_hdf5_shape shape;
    size_t array;
    unsigned char *block; /* of `rows` rows */
} column;

typedef struct table {
    scanner in;
    se3di_iopool pool;
    column *columns;
    size_t count, capacity;
    uint64_t rows;
    size_t block_rows;
} table;

/* Read a cell. @return false: the file ends, or errno says why it cannot be read. */
static bool next_cell(scanner *in)
{
    in->length = 0;
    for (;;) {
        if (in->at == in->used) {
            in->used = fread(in->buffer, 1, BUFFER, in->file);
            in->at = 0;
            if (in->used == 0) {
                return false;
            }
        }
        const char c = in->buffer[in->at++];
        if (c == ',' || c == '\n') {
            in->cell[in->length] = '\0';
            in->ends_line = c == '\n';
            return true;
        }
        if (in->length + 1 == CELL_MOST) {
            errno = EOVERFLOW;
            return false;
        }
        in->cell[in->length++] = c;
    }
}

static bool is_taken(const table *t, const char *name)
{
    for (size_t k = 0; k < t->count; ++k) {
        if (strcmp(t->columns[k].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* The cell as the name of an array: it has no slashes, which part groups, so a division becomes one
 * by ':'; more of them part it from one that has this name. @return NULL: errno says why */
static const char *make_name(table *t)
{
    scanner *in = &t->in;
    for (char *c = in->cell; *c; ++c) {
        *c = *c == '/' ? ':' : *c;
    }
    while (strchr(in->cell, ':') && is_taken(t, in->cell)) {
        if (in->length + 1 == CELL_MOST) {
            errno = EOVERFLOW;
            return NULL;
        }
        in->cell[in->length++] = ':';
        in->cell[in->length] = '\0';
    }
    const char *name = se3di_iopool_copy(&t->pool, in->cell, in->length);
    errno = name ? errno : ENOMEM;
    return name;
}

static bool read_head(table *t, const se3di_table_columns *kinds)
{
    do {
        column *grown =
            se3di_iopool_grow(&t->pool, t->columns, t->count, &t->capacity, sizeof *grown);
        if (!grown) {
            errno = ENOMEM;
            return false;
        }
        t->columns = grown;
        if (!next_cell(&t->in)) {
            return false;
        }
        const char *name = make_name(t);
        if (!name) {
            return false;
        }
        const uint64_t bit = t->count < 64 ? UINT64_C(1) << t->count : 0;
        t->columns[t->count] = (column){.name = name, .shape = {SE3DI_HDF5_DOUBLE, 1, 1, {0}, 0}};
        if (kinds->texts & bit) {
            t->columns[t->count].shape.type = SE3DI_HDF5_TEXT;
        } else if (kinds->integers & bit) {
            t->columns[t->count].shape.type = SE3DI_HDF5_INT64;
        }
        ++t->count;
    } while (!t->in.ends_line);
    return true;
}

/* How many rows, how long texts. */
static bool measure(table *t)
{
    errno = 0;
    for (size_t k = 0; next_cell(&t->in); k = t->in.ends_line ? 0 : k + 1) {
        se3di_hdf5_shape *shape = &t->columns[k < t->count ? k : 0].shape;
        if (shape->type == SE3DI_HDF5_TEXT && t->in.length > shape->text_size) {
            shape->text_size = t->in.length;
        }
        t->rows += t->in.ends_line;
    }
    return errno == 0 && !ferror(t->in.file);
}

static bool rewind_to_rows(table *t)
{
    t->in.at = t->in.used = 0;
    if (!se3di_file_seek(t->in.file, 0)) {
        return false;
    }
    do {
        if (!next_cell(&t->in)) {
            return false;
        }
    } while (!t->in.ends_line);
    return true;
}

static double number_of(const char *text)
{
    double value = (double)NAN;
    if (!se3di_number_parse(text, &value)) {
        value = strstr(text, "inf") ? (double)HUGE_VAL : (double)NAN;
        value = *text == '-' ? -value : value;
    }
    return value;
}

/* @return false: the file has changed since it was measured */
static bool take_cell(const table *t, column *c, size_t row)
{
    const size_t size = se3di_hdf5_size_of(&c->shape);
    unsigned char *at = c->block + row * size;
    if (c->shape.type == SE3DI_HDF5_TEXT) {
        if (t->in.length > size) {
            errno = EIO;
            return false;
        }
        memset(at, 0, size);
        memcpy(at, t->in.cell, t->in.length);
    } else {
        se3di_hdf5_put_value(at, c->shape.type, number_of(t->in.cell));
    }
    return true;
}

static bool prepare(table *t, se3di_hdf5 *h)
{
    size_t bytes = 0;
    for (size_t k = 0; k < t->count; ++k) {
        bytes += se3di_hdf5_size_of(&t->columns[k].shape);
    }
    t->block_rows = BLOCK_BYTES / bytes > 0 ? BLOCK_BYTES / bytes : 1;
    t->block_rows = t->rows < t->block_rows ? (size_t)t->rows : t->block_rows;
    for (size_t k = 0; k < t->count; ++k) {
        column *c = &t->columns[k];
        c->shape.dims[0] = t->rows;
        c->array = se3di_hdf5_add_array(h, 0, c->name, &c->shape);
        c->block = se3di_iopool_array(&t->pool, t->block_rows + 1, se3di_hdf5_size_of(&c->shape));
        if (!c->block) {
            errno = ENOMEM;
            return false;
        }
    }
    return true;
}

/* The rows from `first` on, as many as a block has. */
static bool write_block(table *t, se3di_hdf5 *h, uint64_t first)
{
    const uint64_t left = t->rows - first;
    const size_t rows = left < t->block_rows ? (size_t)left : t->block_rows;
    for (size_t r = 0; r < rows; ++r) {
        for (size_t k = 0; k < t->count; ++k) {
            if (!next_cell(&t->in)) {
                errno = errno ? errno : EIO;
                return false;
            }
            if (!take_cell(t, &t->columns[k], r)) {
                return false;
            }
        }
    }
    for (size_t k = 0; k < t->count; ++k) {
        column *c = &t->columns[k];
        const size_t size = se3di_hdf5_size_of(&c->shape);
        se3di_hdf5_write(h, c->array, first * size, c->block, rows * size);
    }
    return true;
}

static bool write_all(table *t, const char *path, int compression, const se3d_allocator *allocator)
{
    se3di_hdf5 h;
    if (!se3di_hdf5_open(&h, allocator, path, compression)) {
        return false;
    }
    bool good = prepare(t, &h);
    for (uint64_t first = 0; good && first < t->rows && h.failure == 0; first += t->block_rows) {
        good = write_block(t, &h, first);
    }
    h.failure = h.failure ? h.failure : good ? 0 : errno ? errno : EIO;
    return se3di_hdf5_close(&h);
}

bool se3di_table_convert(const char *csv, const char *path, const se3di_table_columns *columns,
                         int compression, const se3d_allocator *allocator)
{
    table t = {.in = {.file = se3di_file_open(csv)}};
    if (!t.in.file) {
        return false;
    }
    se3di_iopool_init(&t.pool, allocator);
    t.in.buffer = se3di_iopool_alloc(&t.pool, BUFFER);
    errno = t.in.buffer ? 0 : ENOMEM;
    const bool good = t.in.buffer && read_head(&t, columns) && measure(&t) && rewind_to_rows(&t) &&
                      write_all(&t, path, compression, allocator);
    const int why = errno ? errno : EIO;
    fclose(t.in.file);
    se3di_iopool_destroy(&t.pool);
    errno = good ? 0 : why;
    return good;
}
