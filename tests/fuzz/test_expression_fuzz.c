/* SPDX-License-Identifier: BSD-3-Clause */
/* Hostile texts: random bytes, random tokens and damaged good expressions end in a status, with a
 * column inside the text; what compiles can be evaluated. Meant to be run with sanitizers too. */
#include "check.h"
#include "se3d/expression.h"

#define TEXTS     20000
#define TEXT_SIZE 400

static uint64_t seed = 88172645463325252u;

static size_t choose(size_t count)
{
    return (size_t)((check_random(&seed) + 1.0) * 0.5 * (double)count);
}

typedef struct outcomes {
    size_t compiled, rejected;
} outcomes;

static void check_results(const se3d_expression *e, const char *text)
{
    double x[2] = {check_random(&seed), choose(4) ? check_random(&seed) : 0.0};
    double jet[3], f, g, gradient[2];
    se3d_status status = se3d_expression_eval_time(e, x, jet);
    int finite = isfinite(jet[0]) && isfinite(jet[1]) && isfinite(jet[2]);
    CHECK(status == (finite ? SE3D_OK : SE3D_ERR_NOT_FINITE));
    status = se3d_expression_eval(e, x, &f);
    CHECK(status == (isfinite(f) ? SE3D_OK : SE3D_ERR_NOT_FINITE));
    status = se3d_expression_eval_gradient(e, x, &g, gradient);
    CHECK(status == SE3D_OK || status == SE3D_ERR_NOT_FINITE);
    CHECK((isnan(f) && isnan(g) && isnan(jet[0])) || (f == g && f == jet[0]));
    CHECK(!se3d_expression_is_constant(e) || isfinite(f));
    CHECK(strcmp(se3d_expression_get_text(e), text) == 0);
}

static void try_text(const char *text, outcomes *tally)
{
    static const char *const variables[] = {"t", "l"};
    static const se3d_expression_symbol symbols[] = {{"k", 3.5}, {"zero", 0.0}};
    se3d_expression_def def = se3d_expression_def_default();
    def.text = text;
    def.variables = variables;
    def.variable_count = 2;
    def.symbols = symbols;
    def.symbol_count = 2;
    se3d_expression *e = NULL;
    se3d_expression_error error;
    se3d_status status = se3d_expression_create(&def, &e, &error);
    CHECK(status == SE3D_OK || status == SE3D_ERR_EXPRESSION);
    CHECK((status == SE3D_OK) == (e != NULL));
    if (e) {
        check_results(e, text);
        ++tally->compiled;
    } else {
        CHECK(error.column >= 1 && error.column <= strlen(text) + 1);
        CHECK(error.message[0] != '\0');
        ++tally->rejected;
    }
    se3d_expression_destroy(e);
}

static void random_bytes_are_rejected_cleanly(void)
{
    outcomes tally = {0};
    for (int k = 0; k < TEXTS; ++k) {
        char text[TEXT_SIZE];
        size_t length = choose(60);
        for (size_t i = 0; i < length; ++i) {
            text[i] = (char)(1 + choose(255));
        }
        text[length] = '\0';
        try_text(text, &tally);
    }
    CHECK(tally.rejected > TEXTS / 2);
}

static void random_tokens_compile_or_are_rejected_cleanly(void)
{
    static const char *const tokens[] = {
        "t",     "l",     "k",    "zero",   "pi",    "deg",  "1",      "2",     ".5",     "1e-3",
        "1e300", "0",     "+",    "-",      "*",     "/",    "^",      "(",     ")",      ",",
        "<",     "<=",    ">",    ">=",     "==",    "!=",   "if(",    "min(",  "max(",   "step(",
        "sin(",  "sqrt(", "log(", "atan2(", "mod(",  "abs(", "hypot(", "tanh(", "floor(", "foo",
        " ",     "1e",    ".",    "exp(",   "asin(", "0,",   ",1)",    ")",     ")",      "+t"};
    const size_t count = sizeof tokens / sizeof tokens[0];
    outcomes tally = {0};
    for (int k = 0; k < TEXTS; ++k) {
        char text[TEXT_SIZE] = "";
        size_t length = 1 + choose(k % 2 ? 6 : 40), used = 0;
        for (size_t i = 0; i < length; ++i) {
            used += (size_t)snprintf(text + used, sizeof text - used, "%s", tokens[choose(count)]);
        }
        try_text(text, &tally);
    }
    printf("token soup: %zu compiled, %zu rejected\n", tally.compiled, tally.rejected);
    CHECK(tally.compiled > TEXTS / 50);
    CHECK(tally.rejected > TEXTS / 2);
}

static void damaged_expressions_compile_or_are_rejected_cleanly(void)
{
    static const char *const good[] = {
        "if(t < 0.5, step(t, 0, 0, 1, k), min(t, l, 2)^2 - mod(t, 1/k))",
        "-2^-t^2 + atan2(l, t)*hypot(t, l)/(1 + abs(l)) - (t >= l)*exp(-k*t)",
        "max(0, 1e5*(l - 0.2)^1.5)*(1 + 0.3*t) + sqrt(t^2 + l^2) + log(2 + sin(t))",
        "if(zero == 0, t^l, 1/zero) + round(t)*ceil(l) + floor(t*10)/10 + sign(t)*t"};
    outcomes tally = {0};
    for (int k = 0; k < TEXTS; ++k) {
        char text[TEXT_SIZE];
        size_t length =
            (size_t)snprintf(text, sizeof text, "%s", good[choose(sizeof good / sizeof good[0])]);
        for (size_t edits = 1 + choose(3); edits > 0; --edits) {
            size_t at = choose(length), from = choose(length);
            if (choose(2)) {
                text[at] = text[from];
            } else {
                memmove(text + at, text + at + 1, length - at);
                --length;
            }
        }
        try_text(text, &tally);
    }
    printf("damaged: %zu compiled, %zu rejected\n", tally.compiled, tally.rejected);
    CHECK(tally.compiled > TEXTS / 50);
    CHECK(tally.rejected > TEXTS / 10);
}

int main(void)
{
    RUN(random_bytes_are_rejected_cleanly);
    RUN(random_tokens_compile_or_are_rejected_cleanly);
    RUN(damaged_expressions_compile_or_are_rejected_cleanly);
    return check_finish();
}
