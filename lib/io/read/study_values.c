/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranges, lists and distributions of the parameters of a study, and tables of them. */
#include "io/read/study_values.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/amount.h"
#include "io/document/attachment.h"
#include "io/document/fields.h"
#include "io/document/formula.h"
#include "io/document/guess.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/objects.h"
#include "io/read/parameters.h"
#include "io/read/point_table.h"

enum { VALUES_MAX = 10000000, GRID_COUNT_MAX = 1000000 };

/* clang-format off */
static const se3di_key varied_keys[] = {
    {"from", SE3DI_KIND_NUMBER, .required = true, .text = "in the unit of the parameter"},
    {"to", SE3DI_KIND_NUMBER, .required = true, .text = "in the unit of the parameter"},
    {"count", SE3DI_KIND_COUNT, .most = GRID_COUNT_MAX,
     .text = "values from `from` to `to`, evenly spaced; of a grid, others draw from between"},
    {.key = NULL}};
const se3di_object se3di_object_varied = {
    "varied",
    "A range of a parameter.",
    varied_keys, NULL,
    NULL};
/* clang-format on */

/* A distribution by its name: how many arguments, and which of them are in the unit of the
 * parameter. */
typedef struct distribution_row {
    const char *name;
    const char *usage;
    se3di_distribution distribution;
    size_t count;
    unsigned of_parameter; /* bit k: argument k */
} distribution_row;

static const distribution_row distributions[] = {
    {"normal", "normal(mean, deviation)", SE3DI_DISTRIBUTION_NORMAL, 2, 3},
    {"uniform", "uniform(lower, upper)", SE3DI_DISTRIBUTION_UNIFORM, 2, 3},
    {"lognormal", "lognormal(mean of the logarithm, its deviation)", SE3DI_DISTRIBUTION_LOGNORMAL,
     2, 0},
    {"triangular", "triangular(lower, mode, upper)", SE3DI_DISTRIBUTION_TRIANGULAR, 3, 7},
    {"exponential", "exponential(mean)", SE3DI_DISTRIBUTION_EXPONENTIAL, 1, 1},
    {"weibull", "weibull(scale, shape)", SE3DI_DISTRIBUTION_WEIBULL, 2, 1}};
enum { DISTRIBUTIONS = sizeof distributions / sizeof *distributions };

bool se3di_check_study_parameter(se3di_reader *reader, const se3di_node *place, const char *name)
{
    const se3di_node *map = se3di_node_get(reader->model->root, "parameters");
    const se3di_amount *value = se3di_scope_find(reader->scope, name);
    se3di_guess guess = se3di_guess_begin(name);
    for (const se3di_node *p = map ? map->first : NULL; p; p = p->next) {
        se3di_guess_offer(&guess, p->key);
    }
    const char *meant = se3di_guess_get(&guess);
    if (!se3di_node_get(map, name) || !value) {
        return se3di_reader_fail(reader, place, "the model has no parameter `%.60s`%s%s%s", name,
                                 meant ? ", did you mean `" : "", meant ? meant : "",
                                 meant ? "`?" : "");
    }
    return value->rank == 1 ||
           se3di_reader_fail(reader, place,
                             "`%.60s` is a vector, only numbers can vary: write it with them",
                             name);
}

static bool check_single(se3di_reader *reader, const se3di_node *node, const se3di_amount *value)
{
    return value->rank == 1 ||
           se3di_reader_fail(reader, node, "`%.120s` is a vector, must be a number", node->text);
}

/* Give all numbers one unit: what has none takes that of the others. */
static bool unify(se3di_reader *reader, const se3di_node *node, se3di_amount *list, size_t count)
{
    se3di_formula f = {.reader = reader, .node = node, .text = ""};
    for (int round = 0; round < 2; ++round) {
        for (size_t k = 1; k < count; ++k) {
            if (!se3di_formula_unify(&f, f.text, &list[0], &list[k])) {
                return false;
            }
        }
    }
    return true;
}

static bool read_list(se3di_reader *reader, const se3di_node *node, se3di_study_variable *v)
{
    se3di_amount *list = se3di_iopool_array(reader->pool, node->count, sizeof *list);
    size_t k = 0;
    v->distribution = SE3DI_DISTRIBUTION_LIST;
    v->count = node->count;
    v->values = se3di_iopool_array(reader->pool, node->count, sizeof *v->values);
    if (!list || !v->values) {
        return se3di_reader_fail_memory(reader);
    }
    if (node->count == 0) {
        return se3di_reader_fail(reader, node, "is empty, must have at least one value");
    }
    for (const se3di_node *child = node->first; child; child = child->next, ++k) {
        if (!se3di_read_amount(reader, child, &list[k]) || !check_single(reader, child, &list[k])) {
            return false;
        }
    }
    if (!unify(reader, node, list, v->count)) {
        return false;
    }
    for (k = 0; k < v->count; ++k) {
        v->values[k] = list[k].v[0];
    }
    v->shape = list[0];
    return true;
}

bool se3di_read_study_amounts(se3di_reader *reader, const se3di_node *map, const char *const *keys,
                              size_t count, se3di_amount *values)
{
    for (size_t k = 0; k < count; ++k) {
        const se3di_node *node = se3di_node_get(map, keys[k]);
        if (node && (!se3di_read_amount(reader, node, &values[k]) ||
                     !check_single(reader, node, &values[k]))) {
            return false;
        }
    }
    return unify(reader, map, values, count);
}

static bool read_range(se3di_reader *reader, const se3di_node *node, se3di_study_variable *v)
{
    static const char *const names[2] = {"from", "to"};
    se3di_amount ends[2];
    double count = 0.0;
    v->distribution = SE3DI_DISTRIBUTION_RANGE;
    if (!se3di_read_keys(reader, node, &se3di_object_varied)) {
        return false;
    }
    for (size_t k = 0; k < 2; ++k) {
        if (!se3di_node_get(node, names[k])) {
            return se3di_reader_fail_key(reader, node, names[k], "is missing");
        }
    }
    if (!se3di_read_study_amounts(reader, node, names, 2, ends) ||
        !se3di_read_key(reader, node, &se3di_object_varied, NULL, "count", &count)) {
        return false;
    }
    v->a[0] = ends[0].v[0];
    v->a[1] = ends[1].v[0];
    v->shape = ends[0];
    v->count = (size_t)count;
    const se3di_node *number = se3di_node_get(node, "count");
    return !number || v->count > 0 || se3di_reader_fail(reader, number, "is 0, must be at least 1");
}

static const distribution_row *find_distribution(const char *name, size_t length)
{
    for (size_t k = 0; k < DISTRIBUTIONS; ++k) {
        const distribution_row *row = &distributions[k];
        if (strlen(row->name) == length && strncmp(row->name, name, length) == 0) {
            return row;
        }
    }
    return NULL;
}

static bool fail_distribution(se3di_reader *reader, const se3di_node *node)
{
    char list[500] = "";
    for (size_t k = 0; k < DISTRIBUTIONS; ++k) {
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", k > 0 ? ", " : "",
                 distributions[k].usage);
    }
    return se3di_reader_fail(reader, node,
                             "is `%.80s`, must be {from: 1, to: 2}, a list of values, or one of %s",
                             node->text, list);
}

/* The arguments of "name(a, b, c)": where each begins and how long it is. @return their number, 0
 * if the text is not so. */
static size_t split_arguments(const char *text, const char *begin[4], size_t length[4])
{
    size_t count = 0;
    int depth = 0;
    const char *start = text + 1;
    const char *at = start;
    for (; *at; ++at) {
        depth += (*at == '(' || *at == '[') - (*at == ')' || *at == ']');
        const bool ends = depth < 0;
        if (ends || (*at == ',' && depth == 0)) {
            if (count == 4) {
                return 0;
            }
            begin[count] = start;
            length[count++] = (size_t)(at - start);
            start = at + 1;
        }
        if (ends) {
            return at[1 + strspn(at + 1, " \t")] == '\0' ? count : 0;
        }
    }
    return 0;
}

/* Whether the arguments make a distribution; if not, what must be. */
static const char *judge(se3di_distribution distribution, const double a[3])
{
    switch (distribution) {
    case SE3DI_DISTRIBUTION_UNIFORM:
        return a[0] < a[1] ? NULL : "lower must be less than upper";
    case SE3DI_DISTRIBUTION_TRIANGULAR:
        return a[0] <= a[1] && a[1] <= a[2] && a[0] < a[2]
                   ? NULL
                   : "must be lower <= mode <= upper, and lower < upper";
    case SE3DI_DISTRIBUTION_EXPONENTIAL:
        return a[0] > 0.0 ? NULL : "the mean must be > 0";
    case SE3DI_DISTRIBUTION_WEIBULL:
        return a[0] > 0.0 && a[1] > 0.0 ? NULL : "scale and shape must be > 0";
    default:
        return a[1] > 0.0 ? NULL : "the deviation must be > 0";
    }
}

/* Arguments in the unit of the parameter get one unit, the others have none. */
static bool give_units(se3di_reader *reader, const se3di_node *node, const distribution_row *row,
                       se3di_amount *list, se3di_amount *shape)
{
    size_t count = 0;
    for (size_t k = 0; k < row->count; ++k) {
        const bool of_parameter = row->of_parameter >> k & 1u;
        count += of_parameter;
        if (!of_parameter && list[k].hard && !se3di_dimension_is_none(list[k].dimension)) {
            return se3di_reader_fail(reader, node, "argument %zu of %s must have no unit", k + 1,
                                     row->usage);
        }
    }
    *shape = (se3di_amount){.rank = 1};
    if (count > 0) { /* they come first */
        if (!unify(reader, node, list, count)) {
            return false;
        }
        *shape = list[0];
    }
    return true;
}

static bool read_distribution(se3di_reader *reader, const se3di_node *node, se3di_study_variable *v)
{
    const char *text = node->text + strspn(node->text, "~ \t");
    const size_t name = strcspn(text, " \t(");
    const distribution_row *row = find_distribution(text, name);
    const char *open = text + name + strspn(text + name, " \t");
    const char *begin[4];
    size_t length[4];
    se3di_amount list[3];
    if (!row || *open != '(') {
        return fail_distribution(reader, node);
    }
    if (split_arguments(open, begin, length) != row->count) {
        return se3di_reader_fail(reader, node, "is `%.80s`, must be %s%s", node->text, row->usage,
                                 strchr(open, ')') ? ""
                                                   : "; inside { } a text with a comma needs "
                                                     "quotes");
    }
    for (size_t k = 0; k < row->count; ++k) {
        se3di_node part = *node;
        part.one_line = false;
        part.text = se3di_iopool_copy(reader->pool, begin[k], length[k]);
        if (!part.text) {
            return se3di_reader_fail_memory(reader);
        }
        if (!se3di_read_amount(reader, &part, &list[k]) || !check_single(reader, &part, &list[k])) {
            return false;
        }
    }
    if (!give_units(reader, node, row, list, &v->shape)) {
        return false;
    }
    for (size_t k = 0; k < row->count; ++k) {
        v->a[k] = list[k].v[0];
    }
    v->distribution = row->distribution;
    const char *problem = judge(row->distribution, v->a);
    return !problem || se3di_reader_fail(reader, node, "is `%.80s`, %s", node->text, problem);
}

static bool read_variable(se3di_reader *reader, const se3di_node *node, se3di_study_variable *v)
{
    v->name = node->key;
    if (!se3di_check_study_parameter(reader, node, node->key)) {
        return false;
    }
    switch (node->kind) {
    case SE3DI_NODE_LIST:
        return read_list(reader, node, v);
    case SE3DI_NODE_MAP:
        return read_range(reader, node, v);
    default:
        return read_distribution(reader, node, v);
    }
}

bool se3di_read_study_variables(se3di_reader *reader, const se3di_node *map,
                                se3di_study_entry *entry)
{
    if (map->kind != SE3DI_NODE_MAP || map->count == 0) {
        return se3di_reader_fail(
            reader, map, "is %s, must be a map such as {m: [1, 2, 3]}",
            map->count == 0 && map->kind == SE3DI_NODE_MAP ? "empty" : se3di_node_describe(map));
    }
    if (map->count > SE3DI_STUDY_PARAMETERS_MAX) {
        return se3di_reader_fail(reader, map, "has %zu parameters, at most %d are allowed",
                                 map->count, (int)SE3DI_STUDY_PARAMETERS_MAX);
    }
    entry->variables = se3di_iopool_array(reader->pool, map->count, sizeof *entry->variables);
    if (!entry->variables) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *node = map->first; node; node = node->next) {
        if (!read_variable(reader, node, &entry->variables[entry->variable_count])) {
            return false;
        }
        ++entry->variable_count;
    }
    return true;
}

/* ---- sensitivities ---------------------------------------------------------------------------*/

static bool add_sensitivity(se3di_reader *reader, const se3di_node *node, se3di_study_entry *entry)
{
    const char *name = NULL;
    if (!se3di_read_text(reader, node, &name) || !se3di_check_study_parameter(reader, node, name)) {
        return false;
    }
    for (size_t k = 0; k < entry->sensitivity_count; ++k) {
        if (strcmp(entry->sensitivities[k], name) == 0) {
            return se3di_reader_fail(reader, node, "`%.60s` is there twice", name);
        }
    }
    entry->sensitivities[entry->sensitivity_count++] = name;
    return true;
}

bool se3di_read_study_sensitivities(se3di_reader *reader, const se3di_node *node,
                                    se3di_study_entry *entry)
{
    const size_t sought =
        entry->goal && entry->variable_count == 0 ? entry->goal->unknown_count : 0;
    const size_t count = node ? node->count : entry->variable_count + sought;
    if (node && (node->kind != SE3DI_NODE_LIST || count == 0)) {
        return se3di_reader_fail(reader, node, "is %s, must be a list of parameters such as [m, k]",
                                 node->kind == SE3DI_NODE_LIST ? "empty"
                                                               : se3di_node_describe(node));
    }
    if (count > SE3DI_STUDY_PARAMETERS_MAX) {
        return se3di_reader_fail(reader, node, "has %zu parameters, at most %d are allowed", count,
                                 (int)SE3DI_STUDY_PARAMETERS_MAX);
    }
    entry->sensitivities = se3di_iopool_array(reader->pool, count, sizeof *entry->sensitivities);
    if (!entry->sensitivities) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *child = node ? node->first : NULL; child; child = child->next) {
        if (!add_sensitivity(reader, child, entry)) {
            return false;
        }
    }
    for (size_t k = 0; !node && k < count; ++k) {
        entry->sensitivities[entry->sensitivity_count++] =
            sought > 0 ? entry->goal->unknowns[k].name : entry->variables[k].name;
    }
    return true;
}

/* ---- tables ----------------------------------------------------------------------------------*/

typedef struct table {
    se3di_reader *reader;
    const se3di_node *node;
    se3di_study_entry *entry;
    const char *file;
    size_t line;
    size_t rows, capacity;
    double **columns;
} table;

SE3DI_IO_FORMAT(2, 3)
static bool fail(table *t, const char *format, ...)
{
    char text[300];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return se3di_reader_fail(t->reader, t->node, "%.200s:%zu: %s", t->file, t->line, text);
}

static bool read_head(table *t, char *line)
{
    se3di_study_entry *entry = t->entry;
    size_t count = 1;
    for (const char *c = line; *c; ++c) {
        count += *c == ',' || *c == ';';
    }
    if (count > SE3DI_STUDY_PARAMETERS_MAX) {
        return fail(t, "has %zu columns, at most %d are allowed", count,
                    (int)SE3DI_STUDY_PARAMETERS_MAX);
    }
    entry->variables = se3di_iopool_array(t->reader->pool, count, sizeof *entry->variables);
    t->columns = se3di_iopool_array(t->reader->pool, count, sizeof *t->columns);
    if (!entry->variables || !t->columns) {
        return se3di_reader_fail_memory(t->reader);
    }
    char *at = line;
    for (char *name; (name = se3di_table_next_cell(&at)) != NULL;) {
        if (!se3di_check_study_parameter(t->reader, t->node, name)) {
            return false;
        }
        for (size_t k = 0; k < entry->variable_count; ++k) {
            if (strcmp(entry->variables[k].name, name) == 0) {
                return fail(t, "the column `%.60s` is there twice", name);
            }
        }
        entry->variables[entry->variable_count++] =
            (se3di_study_variable){.name = name, .shape = {.rank = 1}};
    }
    return true;
}

static bool grow(table *t)
{
    const size_t capacity = t->capacity > 0 ? 2 * t->capacity : 64;
    if (t->rows < t->capacity) {
        return true;
    }
    if (capacity * t->entry->variable_count > VALUES_MAX) {
        return fail(t, "the table has more than %d values", (int)VALUES_MAX);
    }
    for (size_t k = 0; k < t->entry->variable_count; ++k) {
        double *column = se3di_iopool_array(t->reader->pool, capacity, sizeof *column);
        if (!column) {
            return se3di_reader_fail_memory(t->reader);
        }
        if (t->rows > 0) {
            memcpy(column, t->columns[k], t->rows * sizeof *column);
        }
        t->columns[k] = column;
    }
    t->capacity = capacity;
    return true;
}

/* A number with a point, as programs write it. */
static bool read_cell(table *t, const char *cell, const char *name, double *value)
{
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    def.text = cell;
    def.allocator = se3di_iopool_lend(t->reader->pool);
    const bool plain = cell[0] && cell[strspn(cell, "0123456789.eE+-")] == '\0';
    se3d_status status =
        plain ? se3d_expression_create(&def, &expression, NULL) : SE3D_ERR_EXPRESSION;
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_reader_fail_memory(t->reader);
    }
    if (status >= 0) {
        status = se3d_expression_eval(expression, NULL, value);
    }
    se3d_expression_destroy(expression);
    return status >= 0 || fail(t, "%s is `%.40s`, must be a finite number", name, cell);
}

static bool read_row(table *t, char *line)
{
    char *at = line;
    if (!grow(t)) {
        return false;
    }
    for (size_t k = 0; k < t->entry->variable_count; ++k) {
        const char *cell = se3di_table_next_cell(&at);
        const char *name = t->entry->variables[k].name;
        if (!cell) {
            return fail(t, "has %zu numbers, must have %zu", k, t->entry->variable_count);
        }
        if (!read_cell(t, cell, name, &t->columns[k][t->rows])) {
            return false;
        }
    }
    ++t->rows;
    return !at || fail(t, "has more than %zu numbers", t->entry->variable_count);
}

static bool read_lines(table *t, char *text)
{
    for (char *line = text; line;) {
        char *end = strchr(line, '\n');
        ++t->line;
        if (end) {
            *end = '\0';
        }
        const bool empty = !line[strspn(line, " \t\r")] || line[strspn(line, " \t")] == '#';
        if (!empty && !(t->entry->variables ? read_row(t, line) : read_head(t, line))) {
            return false;
        }
        line = end ? end + 1 : NULL;
    }
    return true;
}

bool se3di_read_study_table(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry)
{
    table t = {.reader = reader,
               .node = se3di_node_get(map, "table"),
               .entry = entry,
               .file = entry->table};
    char *text = NULL;
    size_t size = 0;
    if (!se3di_read_attachment(reader, map, "table", t.file, reader->pool, &text, &size)) {
        return false;
    }
    if (memchr(text, '\0', size)) {
        return se3di_reader_fail(reader, t.node, "`%.200s` is not a text", t.file);
    }
    if (!read_lines(&t, text + se3di_byte_order_mark_length(text, size))) {
        return false;
    }
    if (t.rows == 0) {
        return se3di_reader_fail(reader, t.node,
                                 "`%.200s` has no samples: a line of names, then lines of numbers",
                                 t.file);
    }
    for (size_t k = 0; k < entry->variable_count; ++k) {
        entry->variables[k].values = t.columns[k];
        entry->variables[k].count = t.rows;
    }
    entry->samples = (double)t.rows;
    return true;
}
