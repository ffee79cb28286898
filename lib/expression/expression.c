/* SPDX-License-Identifier: BSD-3-Clause */
/* The public functions: one block of memory per expression, code and text behind the header. */
#include "expression/expression.h"

#include "expression/format.h"
#include "expression/functions.h"
#include "expression/names.h"
#include "expression/parser.h"

#include <math.h>
#include <string.h>

#define TINY 1e-100 /* a quotient by more than that is finite for all that has a meaning */

struct se3d_expression {
    se3d_allocator allocator;
    size_t size; /* of the block */
    size_t variable_count;
    size_t code_count;
    se3di_instruction code[]; /* then the text */
};

void se3d_expression_def_init(se3d_expression_def *def, size_t size)
{
    if (def && size >= sizeof def->struct_size) {
        memset(def, 0, size);
        def->struct_size = size;
    }
}

/* Read a definition of any version: members it lacks are 0, members that this library does not know
 * must be 0. */
static se3d_status read_def(const se3d_expression_def *def, const se3di_lexer *lexer,
                            se3d_expression_def *copy)
{
    size_t size = def->struct_size, known = sizeof *copy;
    int unknown = 0;
    for (size_t k = known; k < size && size <= 4096; ++k) {
        unknown |= ((const unsigned char *)def)[k];
    }
    /* 0.1 is the first version: nothing smaller exists. */
    if (size < known || size > 4096 || unknown) {
        return se3di_lexer_fail(lexer, SE3D_ERR_INVALID_ARGUMENT, NULL,
                                "struct_size = %zu: use se3d_expression_def_default()", size);
    }
    memcpy(copy, def, known);
    return SE3D_OK;
}

static se3d_status check_def(const se3d_expression_def *def, const se3di_lexer *lexer)
{
    const se3d_allocator *allocator = def->allocator;
    if (!def->text) {
        return se3di_lexer_fail(lexer, SE3D_ERR_NULL, NULL, "the text is NULL");
    }
    if (allocator && (!allocator->alloc || !allocator->realloc || !allocator->free)) {
        return se3di_lexer_fail(lexer, SE3D_ERR_NULL, NULL, "a function of the allocator is NULL");
    }
    if (!memchr(def->text, '\0', SE3D_EXPRESSION_TEXT_MAX + 1)) {
        return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, def->text + SE3D_EXPRESSION_TEXT_MAX,
                                "the text is longer than %d characters", SE3D_EXPRESSION_TEXT_MAX);
    }
    return se3di_names_check(def, lexer);
}

static char *text_of(se3d_expression *expression)
{
    return (char *)(expression->code + expression->code_count);
}

/* Move a finished program into one block. */
static se3d_expression *pack(const se3d_expression_def *def, const se3di_program *program)
{
    size_t length = strlen(def->text) + 1;
    size_t code_size = program->count * sizeof *program->code;
    size_t size = sizeof(se3d_expression) + code_size + length;
    se3d_expression *expression = se3di_alloc(&program->allocator, size, 1);
    if (expression) {
        expression->allocator = program->allocator;
        expression->size = size;
        expression->variable_count = def->variable_count;
        expression->code_count = program->count;
        memcpy(expression->code, program->code, code_size);
        memcpy(text_of(expression), def->text, length);
    }
    return expression;
}

static se3d_status compile(const se3d_expression_def *def, se3d_expression **out,
                           se3d_expression_error *error)
{
    se3di_program program = {.allocator = def->allocator ? *def->allocator : se3di_alloc_default()};
    se3d_status status = se3di_expression_parse(def, &program, error);
    if (status == SE3D_OK) {
        *out = pack(def, &program);
        status = *out ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    }
    se3di_program_destroy(&program);
    return status;
}

se3d_status se3d_expression_create(const se3d_expression_def *def, se3d_expression **out,
                                   se3d_expression_error *error)
{
    se3d_expression_def copy;
    se3di_lexer reporter = {.text = def ? def->text : NULL, .error = error};
    if (error) {
        *error = (se3d_expression_error){0};
    }
    if (out) {
        *out = NULL;
    }
    if (!def || !out) {
        return se3di_lexer_fail(&reporter, SE3D_ERR_NULL, NULL, "%s is NULL", def ? "out" : "def");
    }
    se3d_status status = read_def(def, &reporter, &copy);
    if (status == SE3D_OK) {
        status = check_def(&copy, &reporter);
    }
    if (status == SE3D_OK) {
        status = compile(&copy, out, error);
    }
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_lexer_fail(&reporter, status, NULL, "out of memory");
    }
    return status;
}

void se3d_expression_destroy(se3d_expression *expression)
{
    if (expression) {
        se3d_allocator allocator = expression->allocator;
        se3di_free(&allocator, expression, expression->size, 1);
    }
}

se3d_status se3di_expression_clone(const se3d_expression *expression,
                                   const se3d_allocator *allocator, se3d_expression **out)
{
    *out = se3di_alloc(allocator, expression->size, 1);
    if (!*out) {
        return SE3D_ERR_NO_MEMORY;
    }
    memcpy(*out, expression, expression->size);
    (*out)->allocator = *allocator;
    return SE3D_OK;
}

size_t se3di_expression_variable_count(const se3d_expression *expression)
{
    return expression->variable_count;
}

int se3di_expression_reads(const se3d_expression *expression, unsigned mask)
{
    int reads = 0;
    for (size_t k = 0; k < expression->code_count; ++k) {
        const se3di_instruction *in = &expression->code[k];
        reads |= in->op == SE3DI_OP_VARIABLE && (mask >> in->function & 1u);
    }
    return reads;
}

static void fill_nan(double *values, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        values[k] = (double)NAN;
    }
}

static int all_finite(const double *values, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (!isfinite(values[k])) {
            return 0;
        }
    }
    return 1;
}

static se3d_status check_point(const se3d_expression *expression, const double *x)
{
    if (!x && expression->variable_count > 0) {
        return SE3D_ERR_NULL;
    }
    return all_finite(x, expression->variable_count) ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

se3d_status se3d_expression_eval(const se3d_expression *expression, const double *x, double *value)
{
    if (!value) {
        return SE3D_ERR_NULL;
    }
    se3d_status status = expression ? check_point(expression, x) : SE3D_ERR_NULL;
    if (status != SE3D_OK) {
        *value = (double)NAN;
        return status;
    }
    se3di_program_eval(expression->code, expression->code_count, x, 0, value);
    return isfinite(*value) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3di_expression_eval_points(const se3d_expression *expression, const double *x,
                                         double values[SE3DI_EXPRESSION_POINTS])
{
    const size_t n = expression->variable_count;
    if (!all_finite(x, n * SE3DI_EXPRESSION_POINTS)) {
        fill_nan(values, SE3DI_EXPRESSION_POINTS);
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_program_eval_points(expression->code, expression->code_count, x, n, values);
    return all_finite(values, SE3DI_EXPRESSION_POINTS) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3d_expression_eval_time(const se3d_expression *expression, const double *x,
                                      double jet[3])
{
    if (!jet) {
        return SE3D_ERR_NULL;
    }
    se3d_status status = expression ? check_point(expression, x) : SE3D_ERR_NULL;
    if (status != SE3D_OK) {
        fill_nan(jet, 3);
        return status;
    }
    se3di_program_eval_time(expression->code, expression->code_count, x, jet);
    return all_finite(jet, 3) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3d_expression_eval_gradient(const se3d_expression *expression, const double *x,
                                          double *value, double *gradient)
{
    size_t n = expression ? expression->variable_count : 0;
    if (!value || (!gradient && n > 0)) {
        return SE3D_ERR_NULL;
    }
    se3d_status status = expression ? check_point(expression, x) : SE3D_ERR_NULL;
    if (status != SE3D_OK) {
        *value = (double)NAN;
        fill_nan(gradient, n);
        return status;
    }
    double result[1 + SE3D_EXPRESSION_VARIABLE_MAX];
    se3di_program_eval(expression->code, expression->code_count, x, n, result);
    *value = result[0];
    for (size_t k = 0; k < n; ++k) {
        gradient[k] = result[1 + k];
    }
    return all_finite(result, 1 + n) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

void se3di_expression_eval_along(const se3d_expression *expression, const double *x,
                                 const double *direction, unsigned mask, double jet[3])
{
    se3di_program_eval_along(expression->code, expression->code_count, x, direction, mask, jet);
}

int se3d_expression_is_constant(const se3d_expression *expression)
{
    return expression && expression->code_count == 1 && expression->code[0].op == SE3DI_OP_CONSTANT;
}

static int is_whole_power(const se3di_instruction *in)
{
    return in->value >= 0.0 && in->value == floor(in->value);
}

static int is_smooth(const se3di_instruction *in)
{
    switch (in->op) {
    case SE3DI_OP_UNARY:
        return se3di_function_is_smooth(in->function);
    case SE3DI_OP_POWER:
        return is_whole_power(in);
    case SE3DI_OP_BINARY:
    case SE3DI_OP_SELECT:
    case SE3DI_OP_STEP:
    case SE3DI_OP_JUMP:
    case SE3DI_OP_JUMP_IF_ZERO:
        return 0;
    default:
        return 1;
    }
}

static int is_continuous(const se3di_instruction *in)
{
    return in->op == SE3DI_OP_UNARY || in->op == SE3DI_OP_BINARY
               ? se3di_function_is_continuous(in->function)
               : in->op != SE3DI_OP_JUMP_IF_ZERO;
}

static int holds_for_all(const se3d_expression *expression,
                         int (*holds)(const se3di_instruction *in))
{
    size_t k = 0;
    while (k < expression->code_count && holds(&expression->code[k])) {
        ++k;
    }
    return k == expression->code_count;
}

int se3di_expression_is_smooth(const se3d_expression *expression)
{
    return holds_for_all(expression, is_smooth);
}

int se3di_expression_is_continuous(const se3d_expression *expression)
{
    return holds_for_all(expression, is_continuous);
}

static int has_jumps(const se3d_expression *expression)
{
    size_t k = 0;
    while (k < expression->code_count && expression->code[k].op != SE3DI_OP_JUMP &&
           expression->code[k].op != SE3DI_OP_JUMP_IF_ZERO) {
        ++k;
    }
    return k < expression->code_count;
}

/* Whether the `count` operands before an instruction that takes them last are constants: if there
 * are no jumps, they are what has been pushed just before. */
static int are_constants(const se3d_expression *expression, size_t at, size_t count)
{
    size_t k = 1;
    while (k <= count && k <= at && expression->code[at - k].op == SE3DI_OP_CONSTANT) {
        ++k;
    }
    return k > count && !has_jumps(expression);
}

/* Whether an instruction has a value for all operands that it can get. */
static int is_total(const se3d_expression *expression, size_t at)
{
    const se3di_instruction *in = &expression->code[at];
    switch (in->op) {
    case SE3DI_OP_UNARY:
    case SE3DI_OP_BINARY:
        return se3di_function_is_total(in->function);
    case SE3DI_OP_POWER:
        return is_whole_power(in);
    case SE3DI_OP_DIVIDE:
        return are_constants(expression, at, 1) && fabs(in[-1].value) > TINY;
    case SE3DI_OP_STEP: /* of x, x0, h0, x1, h1 */
        return are_constants(expression, at, 4) && fabs(in[-2].value - in[-4].value) > TINY;
    default:
        return 1;
    }
}

int se3di_expression_is_total(const se3d_expression *expression)
{
    size_t k = 0;
    while (k < expression->code_count && is_total(expression, k)) {
        ++k;
    }
    return k == expression->code_count;
}

const char *se3d_expression_get_text(const se3d_expression *expression)
{
    return expression ? (const char *)(expression->code + expression->code_count) : "";
}

se3d_status se3d_expression_write(const se3d_expression *expression, const char *const *variables,
                                  char *text, size_t capacity, size_t *length)
{
    size_t needed = 0;
    if (length) {
        *length = 0;
    }
    if (!expression || !length || (!variables && expression->variable_count > 0)) {
        return SE3D_ERR_NULL;
    }
    const se3d_allocator allocator = expression->allocator;
    const se3d_status status = se3di_program_format(
        &allocator, expression->code, expression->code_count, variables, text, capacity, &needed);
    *length = status < 0 ? 0 : needed;
    return status >= 0 && text && needed >= capacity ? SE3D_ERR_INVALID_ARGUMENT : status;
}
