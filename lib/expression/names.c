/* SPDX-License-Identifier: BSD-3-Clause */
#include "expression/names.h"

#include "base/error.h"
#include "expression/functions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    double value;
} constants[] = {
    {"pi", 3.14159265358979323846},
    {"deg", 3.14159265358979323846 / 180.0},
};
#define CONSTANT_COUNT (sizeof constants / sizeof constants[0])

static int equals(const char *candidate, const char *name, size_t length)
{
    return strncmp(candidate, name, length) == 0 && candidate[length] == '\0';
}

static int is_reserved(const char *name)
{
    for (size_t k = 0; k < CONSTANT_COUNT; ++k) {
        if (strcmp(constants[k].name, name) == 0) {
            return 1;
        }
    }
    return se3di_function_find(name, strlen(name)) != SE3DI_FUNCTION_NONE;
}

se3di_name se3di_name_find(const se3d_expression_def *def, const char *name, size_t length)
{
    for (size_t k = 0; k < def->variable_count; ++k) {
        if (equals(def->variables[k], name, length)) {
            return (se3di_name){SE3DI_NAME_VARIABLE, k, 0.0};
        }
    }
    for (size_t k = 0; k < def->symbol_count; ++k) {
        if (equals(def->symbols[k].name, name, length)) {
            return (se3di_name){SE3DI_NAME_NUMBER, 0, def->symbols[k].value};
        }
    }
    for (size_t k = 0; k < CONSTANT_COUNT; ++k) {
        if (equals(constants[k].name, name, length)) {
            return (se3di_name){SE3DI_NAME_NUMBER, 0, constants[k].value};
        }
    }
    return (se3di_name){SE3DI_NAME_UNKNOWN, 0, 0.0};
}

static se3d_status check_name(const se3di_lexer *lexer, const char *what, const char *name)
{
    if (!name) {
        return se3di_lexer_fail(lexer, SE3D_ERR_NULL, NULL, "the name of a %s is NULL", what);
    }
    if (!se3di_lexer_is_identifier(name)) {
        return se3di_lexer_fail(lexer, SE3D_ERR_INVALID_ARGUMENT, NULL,
                                "%s '%.60s': a name has letters, digits and '_' and does not "
                                "begin with a digit",
                                what, name);
    }
    if (is_reserved(name)) {
        return se3di_lexer_fail(lexer, SE3D_ERR_INVALID_ARGUMENT, NULL,
                                "%s '%.60s': the name is reserved for a function or constant of "
                                "expressions",
                                what, name);
    }
    return SE3D_OK;
}

static se3d_status check_variables(const se3d_expression_def *def, const se3di_lexer *lexer)
{
    if (def->variable_count > SE3D_EXPRESSION_VARIABLE_MAX) {
        return se3di_lexer_fail(lexer, SE3D_ERR_INVALID_ARGUMENT, NULL,
                                "%zu variables, at most %d are allowed", def->variable_count,
                                SE3D_EXPRESSION_VARIABLE_MAX);
    }
    if (def->variable_count > 0 && !def->variables) {
        return se3di_lexer_fail(lexer, SE3D_ERR_NULL, NULL, "the list of variables is NULL");
    }
    for (size_t k = 0; k < def->variable_count; ++k) {
        SE3DI_TRY(check_name(lexer, "variable", def->variables[k]));
        for (size_t m = 0; m < k; ++m) {
            if (strcmp(def->variables[k], def->variables[m]) == 0) {
                return se3di_lexer_fail(lexer, SE3D_ERR_INVALID_ARGUMENT, NULL,
                                        "two variables are called '%.60s'", def->variables[k]);
            }
        }
    }
    return SE3D_OK;
}

se3d_status se3di_names_check(const se3d_expression_def *def, const se3di_lexer *lexer)
{
    SE3DI_TRY(check_variables(def, lexer));
    if (def->symbol_count > 0 && !def->symbols) {
        return se3di_lexer_fail(lexer, SE3D_ERR_NULL, NULL, "the list of symbols is NULL");
    }
    for (size_t k = 0; k < def->symbol_count; ++k) {
        const char *name = def->symbols[k].name;
        SE3DI_TRY(check_name(lexer, "symbol", name));
        for (size_t m = 0; m < def->variable_count; ++m) {
            if (strcmp(name, def->variables[m]) == 0) {
                return se3di_lexer_fail(lexer, SE3D_ERR_INVALID_ARGUMENT, NULL,
                                        "symbol '%.60s': a variable has this name", name);
            }
        }
        if (!isfinite(def->symbols[k].value)) {
            return se3di_lexer_fail(lexer, SE3D_ERR_INVALID_ARGUMENT, NULL,
                                    "symbol '%.60s': its value must be finite", name);
        }
    }
    return SE3D_OK;
}

/* ---- suggestions ----------------------------------------------------------------------------*/

#define NEAR       2  /* largest distance of a suggestion */
#define NEAR_WIDTH 64 /* longer names get none */

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Levenshtein's edit distance, letters' case ignored; one row of the table at a time. */
static size_t edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t row[NEAR_WIDTH + 1];
    if (a_length > NEAR_WIDTH || b_length > NEAR_WIDTH) {
        return SIZE_MAX;
    }
    for (size_t j = 0; j <= b_length; ++j) {
        row[j] = j;
    }
    for (size_t i = 1; i <= a_length; ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b_length; ++j) {
            size_t replaced = diagonal + (lower(a[i - 1]) != lower(b[j - 1]));
            diagonal = row[j];
            row[j] = smaller(replaced, smaller(row[j], row[j - 1]) + 1);
        }
    }
    return row[b_length];
}

typedef struct suggestion {
    const char *name;
    size_t distance;
} suggestion;

static void consider(suggestion *best, const se3di_token *token, const char *candidate)
{
    size_t distance = edit_distance(token->start, token->length, candidate, strlen(candidate));
    if (distance < token->length && distance < best->distance) {
        *best = (suggestion){candidate, distance};
    }
}

static const char *suggest(const se3d_expression_def *def, const se3di_token *token,
                           int is_function)
{
    suggestion best = {NULL, NEAR + 1};
    for (size_t k = 0; k < def->variable_count && !is_function; ++k) {
        consider(&best, token, def->variables[k]);
    }
    for (size_t k = 0; k < def->symbol_count && !is_function; ++k) {
        consider(&best, token, def->symbols[k].name);
    }
    for (size_t k = 0; k < CONSTANT_COUNT && !is_function; ++k) {
        consider(&best, token, constants[k].name);
    }
    for (size_t k = 0; k < se3di_function_count; ++k) {
        if (se3di_lexer_is_identifier(se3di_functions[k].name)) {
            consider(&best, token, se3di_functions[k].name);
        }
    }
    return best.name;
}

/* "t, l, " */
static void list_variables(const se3d_expression_def *def, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < def->variable_count; ++k) {
        int written = snprintf(text + used, size - used, "%.14s, ", def->variables[k]);
        used += written > 0 ? (size_t)written : 0;
    }
}

se3d_status se3di_name_fail(const se3d_expression_def *def, const se3di_lexer *lexer,
                            const se3di_token *token, int is_function)
{
    char text[SE3DI_TOKEN_TEXT_SIZE], variables[17 * SE3D_EXPRESSION_VARIABLE_MAX];
    const char *near = suggest(def, token, is_function);
    const char *what = is_function ? "function" : "name";
    se3di_token_describe(token, text);
    if (near) {
        return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, token->start,
                                "unknown %s %s, did you mean '%.64s'?", what, text, near);
    }
    if (is_function) {
        return se3di_lexer_fail(
            lexer, SE3D_ERR_EXPRESSION, token->start,
            "unknown function %s; allowed are if min max abs sqrt exp log log10 "
            "sin cos tan asin acos atan atan2 sinh cosh tanh mod hypot step "
            "floor ceil round sign",
            text);
    }
    list_variables(def, variables, sizeof variables);
    return se3di_lexer_fail(lexer, SE3D_ERR_EXPRESSION, token->start,
                            "unknown name %s; allowed are %s%spi, deg and functions", text,
                            variables, def->symbol_count > 0 ? "the parameters, " : "");
}
