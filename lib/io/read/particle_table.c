/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles from a CSV file: columns by their names, in any order. Of a file with several times (as
 * an output with `particles` writes it) the rows of the last one are taken. Errors say the line and
 * the column. */
#include "io/read/particle_table.h"

#include <math.h>
#include <string.h>

#include "io/base/number.h"
#include "io/base/pool.h"
#include "io/document/attachment.h"
#include "io/document/document.h"
#include "io/document/reader.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/materials.h"

enum {
    FIELD_X = 0, /* x y z vx vy vz wx wy wz: three vectors */
    FIELD_RADIUS = 9,
    FIELD_TIME = 10,
    FIELD_MATERIAL = 11,
    FIELD_ID = 12,
    FIELD_SET = 13, /* what an output has besides is passed over */
    FIELD_FORCE = 14,
    FIELD_COUNT = 15,
    COLUMNS_MAX = 32,
    QUOTE_MAX = 24 /* of a file that may not have been meant to be shown */
};

static const char *const fields[FIELD_COUNT + 1] = {
    "x",  "y",      "z",    "vx",       "vy", "vz",  "wx",    "wy",
    "wz", "radius", "time", "material", "id", "set", "force", NULL};

typedef struct table {
    se3di_reader *reader;
    const se3di_node *node;
    const char *file;
    se3di_iopool *pool;
    char *at;
    size_t line, column; /* of the cell that is read, from 1 */
    int field[COLUMNS_MAX];
    size_t columns;
    double *r, *v, *w, *radius;
    se3d_material *materials;
    se3d_material material; /* of rows that name none */
    size_t count, room;
} table;

static bool fail(const table *t, const char *cell, const char *what)
{
    return se3di_reader_fail_key(t->reader, t->node, "file",
                                 "`%.200s`, line %zu, column %zu: `%.*s` %s", t->file, t->line,
                                 t->column, (int)QUOTE_MAX, cell, what);
}

/* Cut the next cell of the line; *last: it ends the line. */
static char *next_cell(table *t, bool *last)
{
    char *cell = t->at + strspn(t->at, " \t");
    char *end = cell + strcspn(cell, ",\n");
    *last = *end != ',';
    t->at = *end ? end + 1 : end;
    ++t->column;
    *end = '\0';
    while (end > cell && strchr(" \t\r", end[-1])) {
        *--end = '\0';
    }
    return cell;
}

static bool read_header(table *t)
{
    bool last = false;
    unsigned seen = 0;
    while (!last) {
        const char *cell = next_cell(t, &last);
        int k = 0;
        while (fields[k] && strcmp(fields[k], cell) != 0) {
            ++k;
        }
        if (!fields[k]) {
            return fail(t, cell,
                        "is not a column: x, y, z, radius are required; vx, vy, vz, wx, wy, wz, "
                        "material, time, id, set, force are optional");
        }
        if (seen >> k & 1u) {
            return fail(t, cell, "appears twice");
        }
        seen |= 1u << k;
        t->field[t->columns++] = k; /* at most FIELD_COUNT, as none is there twice */
    }
    for (int k = 0; k < FIELD_COUNT; ++k) {
        if ((k < 3 || k == FIELD_RADIUS) && !(seen >> k & 1u)) {
            return fail(t, fields[k], "is missing among the names of the columns");
        }
    }
    return true;
}

static bool read_number(const table *t, const char *cell, double *value)
{
    return se3di_number_parse(cell, value) || fail(t, cell, "is not a number");
}

static bool read_material(table *t, const char *cell)
{
    if (!se3di_reader_find_material(t->reader, cell, &t->materials[t->count])) {
        return t->reader->status < 0 ? false
                                     : fail(t, cell, "is not a material listed under `materials`");
    }
    return true;
}

static bool read_cell(table *t, int field, const char *cell, double *time)
{
    double value = 0.0;
    if (field == FIELD_MATERIAL) {
        return cell[0] == '\0' || read_material(t, cell);
    }
    if (field == FIELD_SET) {
        return true;
    }
    if (!read_number(t, cell, &value)) {
        return false;
    }
    if (field == FIELD_TIME) {
        *time = value;
    } else if (field == FIELD_RADIUS) {
        t->radius[t->count] = value;
        return value > 0.0 || fail(t, cell, "is a radius, must be > 0");
    } else if (field < FIELD_RADIUS) {
        double *const to[3] = {t->r, t->v, t->w};
        to[field / 3][3 * t->count + (size_t)(field % 3)] = value;
    }
    return true;
}

static bool read_row(table *t, double *time)
{
    bool last = false;
    t->column = 0;
    memset(t->v + 3 * t->count, 0, 3 * sizeof *t->v);
    memset(t->w + 3 * t->count, 0, 3 * sizeof *t->w);
    t->materials[t->count] = t->material;
    for (size_t k = 0; k < t->columns; ++k) {
        if (last) {
            ++t->column;
            return fail(t, fields[t->field[k]], "is missing: the row is too short");
        }
        const char *cell = next_cell(t, &last);
        if (!read_cell(t, t->field[k], cell, time)) {
            return false;
        }
    }
    if (!last) {
        const char *cell = next_cell(t, &last);
        return fail(t, cell, "is beyond the last column");
    }
    return true;
}

/* Move the row that was read to the beginning: the ones before are of another time. */
static void start_again(table *t)
{
    const size_t k = t->count;
    memmove(t->r, t->r + 3 * k, 3 * sizeof *t->r);
    memmove(t->v, t->v + 3 * k, 3 * sizeof *t->v);
    memmove(t->w, t->w + 3 * k, 3 * sizeof *t->w);
    t->radius[0] = t->radius[k];
    t->materials[0] = t->materials[k];
    t->count = 0;
}

static bool read_rows(table *t)
{
    double before = (double)NAN;
    for (t->line = 2; *t->at; ++t->line) {
        double time = 0.0;
        if (t->at[strspn(t->at, " \t\r")] == '\n') { /* an empty line */
            t->at = strchr(t->at, '\n') + 1;
            continue;
        }
        if (!read_row(t, &time)) {
            return false;
        }
        if (time < before || time > before) {
            start_again(t);
        }
        before = time;
        ++t->count;
    }
    return true;
}

static bool allocate(table *t)
{
    size_t lines = 2;
    for (const char *c = t->at; (c = strchr(c, '\n')) != NULL; ++c) {
        ++lines;
    }
    t->r = se3di_iopool_array(t->pool, lines, 3 * sizeof *t->r);
    t->v = se3di_iopool_array(t->pool, lines, 3 * sizeof *t->v);
    t->w = se3di_iopool_array(t->pool, lines, 3 * sizeof *t->w);
    t->radius = se3di_iopool_array(t->pool, lines, sizeof *t->radius);
    t->materials = se3di_iopool_array(t->pool, lines, sizeof *t->materials);
    return (t->r && t->v && t->w && t->radius && t->materials) ||
           se3di_reader_fail_memory(t->reader);
}

/* Rows of one material after the other, in the order of the file. */
static bool add_rows(const table *t, uint32_t tag)
{
    se3d_particles *set = t->reader->model->particles->set;
    for (size_t begin = 0, end; begin < t->count; begin = end) {
        uint32_t first = 0;
        for (end = begin + 1;
             end < t->count && t->materials[end].index1 == t->materials[begin].index1; ++end) {
        }
        se3d_status status =
            se3d_particles_add(set, t->materials[begin], end - begin, t->r + 3 * begin,
                               t->radius + begin, t->v + 3 * begin, t->w + 3 * begin, &first);
        for (uint32_t id = first; status >= 0 && tag > 0 && id < first + (end - begin); ++id) {
            status = se3d_particles_set_tags(set, 1, &id, tag);
        }
        if (status < 0) {
            return se3di_reader_fail_system(t->reader, t->node, status);
        }
    }
    return true;
}

bool se3di_read_particle_table(se3di_reader *reader, const se3di_node *node, se3d_material material,
                               uint32_t tag)
{
    se3di_iopool pool;
    table t = {.reader = reader, .node = node, .pool = &pool, .line = 1, .material = material};
    size_t size = 0;
    se3di_iopool_init(&pool, &reader->pool->allocator);
    bool good = se3di_read_text(reader, se3di_node_get(node, "file"), &t.file) &&
                se3di_read_attachment(reader, node, "file", t.file, &pool, &t.at, &size);
    if (good && memchr(t.at, '\0', size)) {
        good = se3di_reader_fail_key(reader, node, "file", "`%.200s` is not a text", t.file);
    }
    if (good) {
        t.at += se3di_byte_order_mark_length(t.at, size);
    }
    good = good && read_header(&t) && allocate(&t) && read_rows(&t) && add_rows(&t, tag);
    se3di_iopool_destroy(&pool);
    return good;
}
