/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions in t, x and y: the three evaluations agree to the bit, a result that is said to be
 * good is finite, and compiling the text that an expression keeps gives the same once more. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VARIABLES = 3 };

static se3d_expression *compile(const char *text)
{
    static const char *const names[VARIABLES] = {"t", "x", "y"};
    static const se3d_expression_symbol symbols[] = {{"m", 2.5}, {"L", 0.0}};
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression_error error;
    se3d_expression *expression = NULL;
    def.text = text;
    def.variables = names;
    def.variable_count = VARIABLES;
    def.symbols = symbols;
    def.symbol_count = sizeof symbols / sizeof *symbols;
    const se3d_status status = se3d_expression_create(&def, &expression, &error);
    FUZZ_MUST(status == SE3D_OK || status == SE3D_ERR_EXPRESSION);
    FUZZ_MUST((status == SE3D_OK) == (expression != NULL));
    FUZZ_MUST((status == SE3D_OK) == (error.message[0] == '\0'));
    FUZZ_MUST(expression || error.column <= strlen(text) + 1);
    return expression;
}

static void must_be_finite(se3d_status status, const double *values, size_t count)
{
    int finite = 1;
    for (size_t k = 0; k < count; ++k) {
        finite = finite && isfinite(values[k]);
    }
    FUZZ_MUST((status == SE3D_OK) == finite);
    FUZZ_MUST(status == SE3D_OK || status == SE3D_ERR_NOT_FINITE);
}

static void must_be_same(double a, double b)
{
    FUZZ_MUST(memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b)));
}

/* At the kinks of these, derivatives along time are those of the way ahead, the others are not. */
static int has_kinks(const se3d_expression *expression)
{
    const char *text = se3d_expression_get_text(expression);
    return strstr(text, "abs") || strstr(text, "min") || strstr(text, "max");
}

static void evaluate(const se3d_expression *expression, const se3d_expression *again,
                     const double x[VARIABLES])
{
    double value, jet[3], all[1 + VARIABLES], other;
    must_be_finite(se3d_expression_eval(expression, x, &value), &value, 1);
    must_be_finite(se3d_expression_eval_time(expression, x, jet), jet, 3);
    must_be_finite(se3d_expression_eval_gradient(expression, x, all, all + 1), all, 1 + VARIABLES);
    must_be_same(jet[0], value);
    must_be_same(all[0], value);
    if (!has_kinks(expression)) {
        must_be_same(all[1], jet[1]);
    }
    (void)se3d_expression_eval(again, x, &other);
    must_be_same(other, value);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double points[][VARIABLES] = {{0.0, 0.0, 0.0},
                                               {0.5, -1.25, 3.0},
                                               {-2.0, 1e-9, 1e9},
                                               {1e300, -1e300, 1e-300},
                                               {1.0, 1.0, -1.0}};
    char *text = malloc(size + 1);
    if (!text) {
        return 0;
    }
    memcpy(text, data, size);
    text[size] = '\0';
    se3d_expression *expression = compile(text);
    if (expression) {
        se3d_expression *again = compile(se3d_expression_get_text(expression));
        FUZZ_MUST(again != NULL);
        for (size_t k = 0; k < sizeof points / sizeof *points; ++k) {
            evaluate(expression, again, points[k]);
        }
        se3d_expression_destroy(again);
    }
    se3d_expression_destroy(expression);
    free(text);
    return 0;
}
