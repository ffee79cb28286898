/* SPDX-License-Identifier: BSD-3-Clause */
/* Values that may be functions: expressions and tables. */
#include "io/document/function.h"

#include "io/document/amount.h"
#include "io/document/curve.h"
#include "io/document/document.h"
#include "io/document/reader.h"
#include "io/document/value.h"

static bool create(se3di_reader *reader, const se3di_node *node, const se3d_function_def *def,
                   se3d_function *function)
{
    return se3di_reader_check(reader, node, se3d_function_create(reader->system, def, function));
}

/* Errors of the table as a whole are told at what says it. */
static bool read_table(se3di_reader *reader, const se3di_node *node, const char *variable,
                       se3d_function_def *def, se3d_function *function)
{
    return se3di_read_curve(reader, node, variable, def) && create(reader, node, def, function);
}

/* A number or a function with vectors or units, in the unit of its key. */
static bool read_quantity(se3di_reader *reader, const se3di_node *node,
                          const char *const *variables, se3di_amount *q)
{
    if (!se3di_check_expression(reader, node) || !se3di_amount_eval(reader, node, variables, q)) {
        return false;
    }
    if (q->rank != 1) {
        return se3di_reader_fail(reader, node, "`%.120s` is a vector, must be a number",
                                 node->text);
    }
    return se3di_amount_take(reader, node, node, q);
}

/* A number of the text, or NULL and *value. */
static bool read_number(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                        se3di_node *plain, double *value)
{
    *plain = *node;
    if (!se3di_amount_is_needed(reader, node->text)) {
        return true;
    }
    se3di_amount q;
    if (!read_quantity(reader, node, variables, &q)) {
        return false;
    }
    plain->text = q.text[0];
    plain->one_line = false;
    if (q.text[0]) {
        return true;
    }
    *value = q.v[0];
    return se3di_check_number(reader, node, SE3DI_ANY, *value);
}

bool se3di_read_expression(se3di_reader *reader, const se3di_node *node,
                           const char *const *variables, double *value,
                           se3d_expression **expression)
{
    se3d_expression_def text = se3d_expression_def_default();
    se3di_node plain;
    *expression = NULL;
    text.variables = variables;
    while (variables[text.variable_count]) {
        ++text.variable_count;
    }
    if (!read_number(reader, node, variables, &plain, value)) {
        return false;
    }
    if (!plain.text) {
        return true;
    }
    if (!se3di_read_compile(reader, &plain, &text, expression)) {
        return false;
    }
    if (!se3d_expression_is_constant(*expression)) {
        return true;
    }
    const bool good = se3di_read_constant(reader, &plain, *expression, value) &&
                      se3di_check_number(reader, &plain, SE3DI_ANY, *value);
    se3d_expression_destroy(*expression);
    *expression = NULL;
    return good;
}

/* *value, or the kind of a function in `def`, and the function. */
static bool read_any(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                     se3d_function_def *def, double *value, se3d_function *function)
{
    se3d_expression *expression = NULL;
    if (node->kind == SE3DI_NODE_MAP) {
        return read_table(reader, node, variables[0], def, function);
    }
    if (node->kind != SE3DI_NODE_SCALAR || se3di_node_is_null(node)) {
        return se3di_reader_fail(reader, node,
                                 "is %s, must be a number, an expression in %s or {spline: [[%s, "
                                 "value], ...]}",
                                 se3di_node_describe(node), variables[0], variables[0]);
    }
    if (!se3di_read_expression(reader, node, variables, value, &expression)) {
        return false;
    }
    if (!expression) {
        return true;
    }
    def->compiled = expression;
    while (variables[def->variable_count]) {
        ++def->variable_count;
    }
    const bool good = create(reader, node, def, function);
    se3d_expression_destroy(expression);
    def->compiled = NULL;
    return good;
}

bool se3di_read_function(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                         double *value, se3d_function *function)
{
    se3d_function_def def = se3d_function_def_default();
    return read_any(reader, node, variables, &def, value, function);
}

bool se3di_read_rate(se3di_reader *reader, const se3di_node *node, double start, double *value,
                     bool *is_number, se3d_function *function)
{
    static const char *const time_only[] = {"t", NULL};
    se3d_function_def def = se3d_function_def_default();
    def.integrate = 1;
    def.start = start;
    *function = (se3d_function){0, 0};
    if (!read_any(reader, node, time_only, &def, &def.constant, function)) {
        return false;
    }
    *is_number = function->index1 == 0;
    *value = def.constant;
    return !*is_number || create(reader, node, &def, function);
}
