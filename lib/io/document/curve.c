/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables: curves through points that the model lists, or that a CSV file holds. Lines of a file are
 * points; those that are empty or begin with '#' are passed over, the first one may name the
 * columns. Cells are numbers, in the units of the model file as those of a list. */
#include "io/document/curve.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/number.h"
#include "io/base/pool.h"
#include "io/document/amount.h"
#include "io/document/attachment.h"
#include "io/document/fields.h"
#include "io/document/guess.h"
#include "io/document/value.h"

enum {
    COLUMNS_MAX = 1000,
    POINTS_MAX = 1000000,
    QUOTE_MAX = 24 /* of a file that may not have been meant to be shown */
};

/* clang-format off */
static const se3di_key spline_keys[] = {
    {"spline", SE3DI_KIND_CURVE,
     .text = "points of a cubic spline, natural or periodic: second derivatives are continuous"},
    {"akima", SE3DI_KIND_CURVE,
     .text = "in its place: points of a curve after Akima, without overshoot of flat parts; second "
         "derivatives jump at the points"},
    {"linear", SE3DI_KIND_CURVE,
     .text = "in its place: points joined by straight lines; not for what is prescribed, whose "
         "rate would jump"},
    {"columns", SE3DI_KIND_TEXTS, .standard = "the first two",
     .text = "of a file with names in its first line: two of them, x and y"},
    {"periodic", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_function_def, table_periodic),
     .standard = "false, straight outside",
     .text = "it repeats; the last point is the first one, a period later"},
    {.key = NULL}};
const se3di_object se3di_object_spline = {
    "spline",
    "A table: a curve through points.",
    spline_keys, NULL,
    "\"oneOf\": [{\"required\": [\"spline\"]}, {\"required\": [\"akima\"]}, {\"required\": "
    "[\"linear\"]}]"};
/* clang-format on */

static const char *const kind_keys[] = {
    [SE3D_TABLE_CUBIC] = "spline", [SE3D_TABLE_LINEAR] = "linear", [SE3D_TABLE_AKIMA] = "akima"};

typedef struct curve {
    se3di_reader *reader;
    const se3di_node *map, *points; /* the child of the map that says them */
    const char *variable;
    double *x, *y;
    size_t count, capacity;
    const char *file;    /* NULL: a list */
    size_t line, column; /* in the file */
    size_t of_x, of_y;   /* columns, from 0 */
} curve;

/* With the place in the file. */
SE3DI_IO_FORMAT(2, 3)
static bool fail(const curve *c, const char *format, ...)
{
    char text[300];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return se3di_reader_fail(c->reader, c->points, "%.200s:%zu:%zu: %s", c->file, c->line,
                             c->column, text);
}

static bool add_point(curve *c, double x, double y)
{
    if (c->count == c->capacity) {
        const size_t capacity = c->capacity > 0 ? 2 * c->capacity : 64;
        double *grown = se3di_iopool_array(c->reader->pool, 2 * capacity, sizeof *grown);
        if (!grown) {
            return se3di_reader_fail_memory(c->reader);
        }
        if (c->count > 0) {
            memcpy(grown, c->x, c->count * sizeof *grown);
            memcpy(grown + capacity, c->y, c->count * sizeof *grown);
        }
        c->x = grown;
        c->y = grown + capacity;
        c->capacity = capacity;
    }
    c->x[c->count] = x;
    c->y[c->count++] = y;
    return true;
}

static bool read_list(curve *c)
{
    for (const se3di_node *point = c->points->first; point; point = point->next) {
        double pair[2];
        if (!se3di_read_pair_of(c->reader, point, c->variable, c->map, pair)) {
            return false;
        }
        if (c->count > 0 && !(pair[0] > c->x[c->count - 1])) {
            return se3di_reader_fail(c->reader, point, "begins with %g after %g, must increase",
                                     pair[0], c->x[c->count - 1]);
        }
        if (!add_point(c, pair[0], pair[1])) {
            return false;
        }
    }
    return true;
}

/* ---- files ----------------------------------------------------------------------------------*/

typedef struct cell {
    char *text;
    size_t column; /* of its first character, from 1 */
} cell;

/* Cut a line into cells, without the blanks and quotes around them. */
static bool cut(curve *c, char *line, cell *cells, size_t *count)
{
    char *at = line;
    *count = 0;
    while (at) {
        char *end = strpbrk(at, ",;\t");
        char *next = end ? end + 1 : NULL;
        if (*count == COLUMNS_MAX) {
            return fail(c, "the line has more than %d columns", COLUMNS_MAX);
        }
        if (end) {
            *end = '\0';
        }
        at += strspn(at, " \"");
        size_t length = strlen(at);
        while (length > 0 && strchr(" \r\"", at[length - 1])) {
            at[--length] = '\0';
        }
        cells[(*count)++] = (cell){at, (size_t)(at - line) + 1};
        at = next;
    }
    return true;
}

/* The place of a column among the names of a line. */
static bool find_column(curve *c, const se3di_node *name, const cell *cells, size_t count,
                        size_t *index)
{
    se3di_guess guess = se3di_guess_begin(name->text);
    for (size_t k = 0; k < count; ++k) {
        if (strcmp(cells[k].text, name->text) == 0) {
            *index = k;
            return true;
        }
        if (strlen(cells[k].text) <= QUOTE_MAX) {
            se3di_guess_offer(&guess, cells[k].text);
        }
    }
    const char *meant = se3di_guess_get(&guess);
    return se3di_reader_fail(c->reader, name, "no column of `%.200s` is called `%.60s`%s%.60s%s",
                             c->file, name->text, meant ? ", did you mean `" : "",
                             meant ? meant : "", meant ? "`?" : "");
}

/* The columns by their names, in the first line; or the first two. */
static bool find_columns(curve *c, const cell *cells, size_t count)
{
    const se3di_node *names = se3di_node_get(c->map, "columns");
    c->of_x = 0;
    c->of_y = 1;
    return !names || (find_column(c, names->first, cells, count, &c->of_x) &&
                      find_column(c, names->last, cells, count, &c->of_y));
}

static bool read_cell(curve *c, const cell *cells, size_t count, size_t index, double *value)
{
    if (index >= count) {
        return fail(c, "the line has %zu columns, must have %zu", count, index + 1);
    }
    c->column = cells[index].column;
    return se3di_number_parse(cells[index].text, value) ||
           fail(c, "`%.*s` is not a number", (int)QUOTE_MAX, cells[index].text);
}

static bool read_point(curve *c, const cell *cells, size_t count)
{
    se3di_amount x = {.rank = 1};
    se3di_amount y = {.rank = 1};
    if (!read_cell(c, cells, count, c->of_y, &y.v[0]) ||
        !read_cell(c, cells, count, c->of_x, &x.v[0]) ||
        !se3di_amount_take_variable(c->reader, c->points, c->variable, &x) ||
        !se3di_amount_take(c->reader, c->points, c->map, &y) ||
        !se3di_check_number(c->reader, c->points, SE3DI_ANY, x.v[0]) ||
        !se3di_check_number(c->reader, c->points, SE3DI_ANY, y.v[0])) {
        return false;
    }
    if (c->count > 0 && !(x.v[0] > c->x[c->count - 1])) {
        return fail(c, "begins with %g after %g, must increase", x.v[0], c->x[c->count - 1]);
    }
    if (c->count == POINTS_MAX) {
        return fail(c, "the file has more than %d points", POINTS_MAX);
    }
    return add_point(c, x.v[0], y.v[0]);
}

static bool has_number(const cell *cells, size_t count)
{
    double value;
    for (size_t k = 0; k < count; ++k) {
        if (se3di_number_parse(cells[k].text, &value)) {
            return true;
        }
    }
    return false;
}

static bool read_line(curve *c, char *line, cell *cells, bool *is_first)
{
    size_t count = 0;
    c->column = 1;
    if (!line[strspn(line, " \t\r")] || line[strspn(line, " \t")] == '#') {
        return true;
    }
    if (!cut(c, line, cells, &count)) {
        return false;
    }
    const bool names = *is_first && !has_number(cells, count);
    if (*is_first && !names && se3di_node_get(c->map, "columns")) {
        return fail(c, "begins with numbers: `columns` needs names of columns in the first line");
    }
    *is_first = false;
    return names ? find_columns(c, cells, count) : read_point(c, cells, count);
}

static bool read_lines(curve *c, char *text)
{
    cell *cells = se3di_iopool_array(c->reader->pool, COLUMNS_MAX, sizeof *cells);
    bool is_first = true;
    if (!cells) {
        return se3di_reader_fail_memory(c->reader);
    }
    c->of_y = 1;
    for (char *line = text; line;) {
        char *end = strchr(line, '\n');
        ++c->line;
        if (end) {
            *end = '\0';
        }
        if (!read_line(c, line, cells, &is_first)) {
            return false;
        }
        line = end ? end + 1 : NULL;
    }
    return true;
}

static bool read_file(curve *c)
{
    char *text = NULL;
    size_t size = 0;
    if (!se3di_read_text(c->reader, c->points, &c->file) ||
        !se3di_read_attachment(c->reader, c->map, c->points->key, c->file, c->reader->pool, &text,
                               &size)) {
        return false;
    }
    if (memchr(text, '\0', size)) {
        return se3di_reader_fail(c->reader, c->points, "`%.200s` is not a text", c->file);
    }
    if (!read_lines(c, text + se3di_byte_order_mark_length(text, size))) {
        return false;
    }
    return c->count >= 2 ||
           se3di_reader_fail(c->reader, c->points,
                             "`%.200s` has %zu points, must have at least two, one a line: x, y",
                             c->file, c->count);
}

/* ---- tables ---------------------------------------------------------------------------------*/

/* Which kind of curve a map says. */
static bool find_kind(curve *c, int32_t *kind)
{
    for (int32_t k = 0; k <= SE3D_TABLE_AKIMA; ++k) {
        const se3di_node *found = se3di_node_get(c->map, kind_keys[k]);
        if (found && c->points) {
            return se3di_reader_fail(c->reader, found, "stands beside `%s`, must be one of them",
                                     c->points->key);
        }
        if (found) {
            c->points = found;
            *kind = k;
        }
    }
    return c->points || se3di_reader_fail(c->reader, c->map,
                                          "must be {spline: [[%s, value], ...]}, {akima: ...} or "
                                          "{linear: ...}",
                                          c->variable);
}

static bool check_columns(const curve *c)
{
    const se3di_node *columns = se3di_node_get(c->map, "columns");
    if (!columns) {
        return true;
    }
    if (c->points->kind == SE3DI_NODE_LIST) {
        return se3di_reader_fail(c->reader, columns, "is of a table in a file, not of a list");
    }
    if (columns->kind != SE3DI_NODE_LIST || columns->count != 2 || !columns->first->text ||
        !columns->last->text) {
        return se3di_reader_fail(c->reader, columns,
                                 "must be a list of two names of columns, x and y");
    }
    return true;
}

bool se3di_read_curve(se3di_reader *reader, const se3di_node *node, const char *variable,
                      se3d_function_def *def)
{
    curve c = {.reader = reader, .map = node, .variable = variable};
    if (!se3di_read_keys(reader, node, &se3di_object_spline) || !find_kind(&c, &def->table_kind) ||
        !check_columns(&c) ||
        !se3di_read_fields(reader, node, &se3di_object_spline, NULL, "se3d_function_def", def)) {
        return false;
    }
    const bool is_file = c.points->kind == SE3DI_NODE_SCALAR && !se3di_node_is_null(c.points);
    if (!is_file && (c.points->kind != SE3DI_NODE_LIST || c.points->count < 2)) {
        return se3di_reader_fail(reader, c.points,
                                 "must be a list of at least two points [x, y], or the name of a "
                                 "CSV file");
    }
    if (is_file ? !read_file(&c) : !read_list(&c)) {
        return false;
    }
    def->table_x = c.x;
    def->table_y = c.y;
    def->table_count = c.count;
    return true;
}
