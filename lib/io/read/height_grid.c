/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/read/height_grid.h"

#include <string.h>

#include "io/base/number.h"
#include "io/base/pool.h"
#include "io/document/amount.h"
#include "io/document/attachment.h"
#include "io/document/document.h"
#include "io/document/function.h"
#include "io/document/value.h"
#include "io/model/model.h"

enum {
    HEIGHTS_MAX = 1 << 24,
    QUOTE_MAX = 24 /* of a file that may not have been meant to be shown */
};

static bool reserve(se3di_reader *reader, const se3di_node *node, se3di_height_grid *grid)
{
    if (grid->row_count > HEIGHTS_MAX / grid->column_count) {
        return se3di_reader_fail(reader, node, "has %zu rows of %zu heights, must be at most %d",
                                 grid->row_count, grid->column_count, HEIGHTS_MAX);
    }
    grid->heights = se3di_iopool_array(&reader->model->pool, grid->row_count * grid->column_count,
                                       sizeof *grid->heights);
    return grid->heights || se3di_reader_fail_memory(reader);
}

bool se3di_read_grid_rows(se3di_reader *reader, const se3di_node *list, se3di_height_grid *grid)
{
    const se3di_node *first = list->first;
    if (list->count < 2 || first->kind != SE3DI_NODE_LIST || first->count < 2) {
        return se3di_reader_fail(reader, list,
                                 "must be a list of at least two rows of at least two numbers");
    }
    grid->row_count = list->count;
    grid->column_count = first->count;
    if (!reserve(reader, list, grid)) {
        return false;
    }
    double *to = grid->heights;
    for (const se3di_node *row = first; row; row = row->next, to += grid->column_count) {
        if (!se3di_read_vector(reader, row, grid->column_count, to)) {
            return false;
        }
    }
    return true;
}

/* ---- files ----------------------------------------------------------------------------------*/

typedef struct table {
    se3di_reader *reader;
    const se3di_node *node; /* that names the file */
    const char *file;
    size_t line;
    char separator; /* `,` or `;` between numbers, ' ': blanks; 0: not known yet */
    double *heights;
    size_t count, capacity;
    se3di_height_grid *grid;
} table;

static bool add_height(table *t, const char *text)
{
    se3di_amount height = {.rank = 1, .dimension = {1, 0, 0, 0}};
    if (!se3di_number_parse(text, &height.v[0])) {
        return se3di_reader_fail(t->reader, t->node, "%.200s:%zu: `%.*s` is not a number", t->file,
                                 t->line, (int)QUOTE_MAX, text);
    }
    if (!se3di_amount_take_plain(t->reader, t->node, &height) ||
        !se3di_check_number(t->reader, t->node, SE3DI_ANY, height.v[0])) {
        return false;
    }
    if (t->count == HEIGHTS_MAX) {
        return se3di_reader_fail(t->reader, t->node, "%.200s:%zu: more than %d heights", t->file,
                                 t->line, HEIGHTS_MAX);
    }
    double *grown = se3di_iopool_grow(&t->reader->model->pool, t->heights, t->count, &t->capacity,
                                      sizeof *grown);
    if (!grown) {
        return se3di_reader_fail_memory(t->reader);
    }
    t->heights = grown;
    grown[t->count++] = height.v[0];
    return true;
}

/* The first line with numbers says what is between them. A comma may be meant as a decimal one, so
 * that lines are not taken that have more. */
static bool find_separator(table *t, const char *text)
{
    const bool comma = strchr(text, ',') != NULL, semicolon = strchr(text, ';') != NULL;
    const char own = (char)(comma ? ',' : semicolon ? ';' : ' '); /* also of a number alone */
    if (comma && semicolon) {
        return se3di_reader_fail(t->reader, t->node,
                                 "%.200s:%zu: has `,` and `;`, must have one of them between "
                                 "numbers (decimals have a point)",
                                 t->file, t->line);
    }
    if (t->separator != '\0' && own != t->separator && own != ' ') {
        return se3di_reader_fail(t->reader, t->node,
                                 "%.200s:%zu: has `%c` between numbers, must have `%c` as the "
                                 "lines before",
                                 t->file, t->line, own, t->separator);
    }
    t->separator = t->separator != '\0' ? t->separator : own;
    return true;
}

/* From the end of a number to the next: blanks with the separator among them. */
static bool skip_gap(table *t, char **at)
{
    static const char blanks[] = " \t\r";
    char *next = *at + strspn(*at, blanks);
    if (*next == t->separator) {
        next += 1 + strspn(next + 1, blanks);
    } else if (*next && t->separator != ' ') {
        return se3di_reader_fail(t->reader, t->node,
                                 "%.200s:%zu: has a blank alone between numbers, must have `%c` "
                                 "(decimals have a point)",
                                 t->file, t->line, t->separator);
    }
    *at = next;
    return true;
}

/* Numbers with a comma, a semicolon or blanks between them. */
static bool read_line(table *t, char *at)
{
    const size_t before = t->count;
    at += strspn(at, " \t\r");
    if (*at == '\0' || *at == '#') {
        return true;
    }
    if (!find_separator(t, at)) {
        return false;
    }
    while (*at) {
        char *end = at + strcspn(at, " \t\r,;"), *next = end;
        if (!skip_gap(t, &next)) {
            return false;
        }
        *end = '\0';
        if (!add_height(t, at)) {
            return false;
        }
        at = next;
    }
    const size_t count = t->count - before;
    if (t->grid->row_count > 0 && count != t->grid->column_count) {
        return se3di_reader_fail(t->reader, t->node,
                                 "%.200s:%zu: has %zu heights, must have %zu as the rows before",
                                 t->file, t->line, count, t->grid->column_count);
    }
    t->grid->column_count = count;
    ++t->grid->row_count;
    return true;
}

bool se3di_read_grid_file(se3di_reader *reader, const se3di_node *map, const char *key,
                          se3di_height_grid *grid)
{
    table t = {.reader = reader, .node = se3di_node_get(map, key), .grid = grid};
    char *text = NULL;
    size_t size = 0;
    *grid = (se3di_height_grid){NULL, 0, 0};
    if (!se3di_read_text(reader, t.node, &t.file) ||
        !se3di_read_attachment(reader, map, key, t.file, reader->pool, &text, &size)) {
        return false;
    }
    if (memchr(text, '\0', size)) {
        return se3di_reader_fail(reader, t.node, "`%.200s` is not a text", t.file);
    }
    for (char *line = text + se3di_byte_order_mark_length(text, size); line;) {
        char *end = strchr(line, '\n');
        ++t.line;
        if (end) {
            *end = '\0';
        }
        if (!read_line(&t, line)) {
            return false;
        }
        line = end ? end + 1 : NULL;
    }
    grid->heights = t.heights;
    return (grid->row_count >= 2 && grid->column_count >= 2) ||
           se3di_reader_fail(reader, t.node,
                             "`%.200s` has %zu rows of %zu heights, must have at least two of two",
                             t.file, grid->row_count, grid->column_count);
}

/* ---- expressions ----------------------------------------------------------------------------*/

static bool eval_heights(se3di_reader *reader, const se3di_node *node, const double spacing[2],
                         const se3d_expression *expression, se3di_height_grid *grid)
{
    const double middle[2] = {0.5 * (double)(grid->column_count - 1),
                              0.5 * (double)(grid->row_count - 1)};
    for (size_t k = 0; k < grid->row_count * grid->column_count; ++k) {
        const size_t column = k % grid->column_count, row = k / grid->column_count;
        const double x[2] = {((double)column - middle[0]) * spacing[0],
                             ((double)row - middle[1]) * spacing[1]};
        if (se3d_expression_eval(expression, x, &grid->heights[k]) < 0) {
            return se3di_reader_fail(reader, node, "is %g at x = %g m, y = %g m, must be finite",
                                     grid->heights[k], x[0], x[1]);
        }
    }
    return true;
}

bool se3di_read_grid_function(se3di_reader *reader, const se3di_node *node, const double spacing[2],
                              se3di_height_grid *grid)
{
    static const char *const variables[] = {"x", "y", NULL};
    static const se3di_dimension lengths[] = {{1, 0, 0, 0}, {1, 0, 0, 0}};
    const se3di_measured before = reader->measured;
    se3d_expression *expression = NULL;
    double value = 0.0;
    if (!reserve(reader, node, grid)) {
        return false;
    }
    reader->measured = (se3di_measured){variables, lengths, NULL};
    bool good = se3di_read_expression(reader, node, variables, &value, &expression);
    reader->measured = before;
    if (good && expression) {
        good = eval_heights(reader, node, spacing, expression, grid);
    }
    for (size_t k = 0; good && !expression && k < grid->row_count * grid->column_count; ++k) {
        grid->heights[k] = value;
    }
    se3d_expression_destroy(expression);
    return good;
}
