/* SPDX-License-Identifier: BSD-3-Clause */
/* Points listed in a CSV file: columns name, x, y, z. Each becomes what `points` would have for it,
 * at the place of `point_table`. */
#include "io/read/point_table.h"

#include <string.h>

#include "io/base/pool.h"
#include "io/document/attachment.h"

enum { COLUMNS = 4, POINTS_MAX = 100000 };

typedef struct table {
    se3di_reader *reader;
    se3di_node *node; /* of `point_table`, which becomes a map */
    const char *file;
    size_t line;
} table;

static bool fail(table *t, const char *what)
{
    return se3di_reader_fail(t->reader, t->node, "%.200s:%zu: %s", t->file, t->line, what);
}

char *se3di_table_next_cell(char **at)
{
    if (!*at) {
        return NULL;
    }
    char *cell = *at;
    char *comma = strpbrk(cell, ",;");
    *at = comma ? comma + 1 : NULL;
    if (comma) {
        *comma = '\0';
    }
    cell += strspn(cell, " \t\"");
    size_t length = strlen(cell);
    while (length > 0 && strchr(" \t\r\"", cell[length - 1])) {
        cell[--length] = '\0';
    }
    return cell;
}

static se3di_node *add_node(table *t, se3di_node *parent, se3di_node_kind kind, const char *text)
{
    se3di_node *node = se3di_iopool_alloc(t->reader->pool, sizeof *node);
    if (!node) {
        se3di_reader_fail_memory(t->reader);
        return NULL;
    }
    node->kind = kind;
    node->text = kind == SE3DI_NODE_SCALAR ? text : NULL;
    node->key = kind == SE3DI_NODE_SCALAR ? NULL : text;
    node->line = node->key_line = t->node->line;
    node->column = node->key_column = t->node->column;
    node->parent = parent;
    node->index = parent->count++;
    if (parent->last) {
        parent->last->next = node;
    } else {
        parent->first = node;
    }
    parent->last = node;
    return node;
}

static bool add_point(table *t, char *const cells[COLUMNS])
{
    se3di_node *point = add_node(t, t->node, SE3DI_NODE_LIST, cells[0]);
    for (size_t k = 1; point && k < COLUMNS; ++k) {
        if (!add_node(t, point, SE3DI_NODE_SCALAR, cells[k])) {
            return false;
        }
    }
    return point != NULL;
}

static bool read_line(table *t, char *line)
{
    static const char *const header[COLUMNS] = {"name", "x", "y", "z"};
    char *cells[COLUMNS];
    char *at = line;
    bool is_header = true;
    if (!line[strspn(line, " \t\r")] || line[strspn(line, " \t")] == '#') {
        return true;
    }
    for (size_t k = 0; k < COLUMNS; ++k) {
        cells[k] = se3di_table_next_cell(&at);
        if (!cells[k] || !*cells[k]) {
            return fail(t, "must have a name and three coordinates: name, x, y, z");
        }
        is_header = is_header && strcmp(cells[k], header[k]) == 0;
    }
    if (at) {
        return fail(t, "has more than four columns: name, x, y, z");
    }
    if (t->node->count >= POINTS_MAX) {
        return fail(t, "has too many points, at most 100000 are allowed");
    }
    return is_header || add_point(t, cells);
}

/* The lines of a text, which is cut up. */
static bool read_lines(table *t, char *text)
{
    for (char *line = text; line;) {
        char *end = strchr(line, '\n');
        ++t->line;
        if (end) {
            *end = '\0';
        }
        if (!read_line(t, line)) {
            return false;
        }
        line = end ? end + 1 : NULL;
    }
    return true;
}

bool se3di_read_point_table(se3di_reader *reader, const se3di_node *root, const se3di_node **map)
{
    table t = {.reader = reader, .node = se3di_node_get(root, "point_table")};
    char *text = NULL;
    size_t size = 0;
    *map = t.node;
    if (!t.node || (t.node->kind == SE3DI_NODE_MAP && t.node->text)) {
        return true; /* of a reading before */
    }
    if (!se3di_read_text(reader, t.node, &t.file) ||
        !se3di_read_attachment(reader, root, "point_table", t.file, reader->pool, &text, &size)) {
        return false;
    }
    if (memchr(text, '\0', size)) {
        return se3di_reader_fail(reader, t.node, "`%.200s` is not a text", t.file);
    }
    if (!read_lines(&t, text + se3di_byte_order_mark_length(text, size))) {
        return false;
    }
    t.node->kind = SE3DI_NODE_MAP;
    return true;
}
