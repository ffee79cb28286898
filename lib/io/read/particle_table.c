/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles from a CSV file: columns by their names, in any order. Of a file with several times (as
 * an output with `particles` writes it) the rows of the last one are taken. Errors say the line and
 * the column. */
#include "io/read/particle_table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/number.h"
#include "io/base/pool.h"
#include "io/document/attachment.h"
#include "io/document/document.h"
#include "io/document/reader.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/materials.h"
#include "io/read/particle_clumps.h"

enum {
    FIELD_X = 0, /* x y z vx vy vz wx wy wz: three vectors */
    FIELD_RADIUS = 9,
    FIELD_TIME = 10,
    FIELD_MATERIAL = 11,
    FIELD_ID = 12,
    FIELD_SET = 13, /* what an output has besides is passed over */
    FIELD_FORCE = 14,
    FIELD_CLUMP = 15,
    FIELD_COUNT = 16,
    COLUMNS_MAX = 32,
    QUOTE_MAX = 24 /* of a file that may not have been meant to be shown */
};

static const char *const fields[FIELD_COUNT + 1] = {
    "x",      "y",    "z",        "vx", "vy",  "vz",    "wx",    "wy", "wz",
    "radius", "time", "material", "id", "set", "force", "clump", NULL};

typedef struct table {
    se3di_reader *reader;
    const se3di_node *node;
    const char *file;
    se3di_iopool *pool;
    char *at;
    size_t line, column; /* of the cell that is read, from 1 */
    int field[COLUMNS_MAX];
    size_t columns;
    double *r, *v, *w, *radius, *clump; /* clump: of the same number are spheres of one; -1: none */
    size_t *lines;                      /* of the rows */
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
                        "material, time, id, set, force, clump are optional");
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
    } else if (field == FIELD_CLUMP) {
        t->clump[t->count] = value;
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
    t->clump[t->count] = -1.0;
    t->lines[t->count] = t->line;
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
    t->clump[0] = t->clump[k];
    t->lines[0] = t->lines[k];
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
    t->clump = se3di_iopool_array(t->pool, lines, sizeof *t->clump);
    t->lines = se3di_iopool_array(t->pool, lines, sizeof *t->lines);
    return (t->r && t->v && t->w && t->radius && t->materials && t->clump && t->lines) ||
           se3di_reader_fail_memory(t->reader);
}

static bool is_same(double a, double b)
{
    return !(a < b || a > b);
}

/* Rows from `begin` on of one material that are spheres by themselves, or one clump. */
static size_t end_of_run(const table *t, size_t begin)
{
    size_t end = begin + 1;
    while (end < t->count && t->materials[end].index1 == t->materials[begin].index1 &&
           is_same(t->clump[end], t->clump[begin])) {
        ++end;
    }
    return end;
}

static bool add_clump(table *t, size_t begin, size_t end, se3di_clump_pose *pose)
{
    const se3di_tagged *particles = t->reader->model->particles;
    char text[160];
    const se3di_clump_rows rows = {end - begin, t->r + 3 * begin, t->radius + begin,
                                   t->v + 3 * begin, t->w + 3 * begin};
    if (!se3di_clump_recognise(particles, &rows, pose)) {
        t->line = t->lines[begin];
        t->column = 1;
        snprintf(text, sizeof text,
                 "begins a clump of %zu sphere%s as no entry of `clumps` has them, in its order",
                 end - begin, end - begin == 1 ? "" : "s");
        return fail(t, "clump", text);
    }
    const se3d_status status = se3di_clump_add(particles, t->materials[begin], pose);
    return status >= 0 || se3di_reader_fail_system(t->reader, t->node, status);
}

/* Those that were scaled are not where they shall be yet. */
static bool place_clumps(const table *t, const se3di_clump_pose *poses, size_t count)
{
    enum { NUMBERS = 13 };
    se3d_particles *set = t->reader->model->particles->set;
    const size_t all = se3d_particles_count_clumps(set);
    double *r = se3di_iopool_array(t->pool, all + 1, NUMBERS * sizeof *r);
    if (!r) {
        return se3di_reader_fail_memory(t->reader);
    }
    double *e = r + 3 * all, *v = e + 4 * all, *w = v + 3 * all;
    se3d_status status = se3d_particles_get_clumps(set, all, r, e, v, w);
    for (size_t k = 0; k < count && status >= 0; ++k) {
        const size_t to = all - count + k;
        memcpy(r + 3 * to, poses[k].r, sizeof poses[k].r);
        memcpy(e + 4 * to, poses[k].e, sizeof poses[k].e);
        memcpy(v + 3 * to, poses[k].v, sizeof poses[k].v);
        memcpy(w + 3 * to, poses[k].w, sizeof poses[k].w);
    }
    status = status < 0 ? status : se3d_particles_set_clumps(set, all, r, e, v, w);
    return status >= 0 || se3di_reader_fail_system(t->reader, t->node, status);
}

typedef se3d_status mark_function(se3d_particles *set, size_t count, const uint32_t *ids,
                                  uint32_t value);

static se3d_status fix(se3d_particles *set, size_t count, const uint32_t *ids, uint32_t value)
{
    return se3d_particles_set_fixed(set, count, ids, (int32_t)value);
}

/* Those that are there since there were `before`. */
static bool mark_particles(se3di_reader *reader, const se3di_node *node, size_t before,
                           mark_function *mark, uint32_t value)
{
    se3d_particles *set = reader->model->particles->set;
    const size_t all = se3d_particles_count(set);
    se3di_iopool pool;
    se3di_iopool_init(&pool, &reader->pool->allocator);
    uint32_t *ids = se3di_iopool_array(&pool, all + 1, sizeof *ids);
    se3d_status status = ids ? se3d_particles_get_ids(set, all, ids) : SE3D_ERR_NO_MEMORY;
    if (status >= 0) {
        status = mark(set, all - before, ids + before, value);
    }
    se3di_iopool_destroy(&pool);
    return ids ? se3di_reader_check(reader, node, status) : se3di_reader_fail_memory(reader);
}

bool se3di_tag_particles(se3di_reader *reader, const se3di_node *node, size_t before, uint32_t tag)
{
    return tag == 0 || mark_particles(reader, node, before, se3d_particles_set_tags, tag);
}

bool se3di_fix_particles(se3di_reader *reader, const se3di_node *node, size_t before)
{
    return mark_particles(reader, node, before, fix, 1);
}

/* In the order of the file. */
static bool add_rows(table *t, uint32_t tag)
{
    se3d_particles *set = t->reader->model->particles->set;
    se3di_clump_pose *poses = se3di_iopool_array(t->pool, t->count + 1, sizeof *poses);
    const size_t before = se3d_particles_count(set);
    size_t clumps = 0;
    bool scaled = false;
    if (!poses) {
        return se3di_reader_fail_memory(t->reader);
    }
    for (size_t begin = 0, end; begin < t->count; begin = end) {
        se3d_status status = SE3D_OK;
        end = end_of_run(t, begin);
        if (t->clump[begin] < 0.0) {
            status =
                se3d_particles_add(set, t->materials[begin], end - begin, t->r + 3 * begin,
                                   t->radius + begin, t->v + 3 * begin, t->w + 3 * begin, NULL);
        } else if (!add_clump(t, begin, end, &poses[clumps])) {
            return false;
        } else {
            scaled = scaled || poses[clumps].scale < 1.0 || poses[clumps].scale > 1.0;
            ++clumps;
        }
        if (status < 0) {
            return se3di_reader_fail_system(t->reader, t->node, status);
        }
    }
    return (!scaled || place_clumps(t, poses, clumps)) &&
           se3di_tag_particles(t->reader, t->node, before, tag);
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
