/* SPDX-License-Identifier: BSD-3-Clause */
/* Time of one evaluation of an expression: CPU time, the least of several rounds. */
#include "se3d/expression.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#define ROUNDS      15
#define EVALUATIONS 100000

typedef enum bench_mode { MODE_TIME, MODE_VALUE, MODE_GRADIENT } bench_mode;

static const struct {
    const char *text;
    bench_mode mode;
} rows[] = {
    {"pi/4*cos(2*t)", MODE_TIME},
    {"pi/4*cos(2*t)", MODE_VALUE},
    {"0.5*t^2 + 3*t - 1", MODE_TIME},
    {"step(t, 0.2, 0, 0.8, pi/2)", MODE_TIME},
    {"if(t < 0.5, 4*t^3, 1 - 4*(1-t)^3)", MODE_TIME},
    {"exp(-0.3*t)*sin(7*t)/(1 + t^2)", MODE_TIME},
    {"max(0, 1e5*(l - 0.2)^1.5)*(1 + 0.3*ld)", MODE_GRADIENT},
    {"10*tanh(ld/0.01) + 300*ld*abs(ld)", MODE_GRADIENT},
};

static double evaluate(const se3d_expression *expression, bench_mode mode, double t)
{
    double x[3] = {t, 0.3 + 0.1 * t, 1.0 - t};
    double result[4] = {0.0};
    if (mode == MODE_TIME) {
        (void)se3d_expression_eval_time(expression, x, result);
    } else if (mode == MODE_GRADIENT) {
        (void)se3d_expression_eval_gradient(expression, x, &result[0], &result[1]);
    } else {
        (void)se3d_expression_eval(expression, x, result);
    }
    return result[0] + result[1] + result[2];
}

static double measure_ns(const se3d_expression *expression, bench_mode mode, double *sum)
{
    double best = 1e300;
    for (int round = 0; round < ROUNDS; ++round) {
        clock_t start = clock();
        for (int k = 0; k < EVALUATIONS; ++k) {
            *sum += evaluate(expression, mode, k * (1.0 / EVALUATIONS));
        }
        double ns = (double)(clock() - start) * (1e9 / CLOCKS_PER_SEC) / EVALUATIONS;
        best = ns < best ? ns : best;
    }
    return best;
}

int main(void)
{
    static const char *const variables[] = {"t", "l", "ld"};
    static const char *const results[] = {"f f' f''", "f", "f grad f"};
    double sum = 0.0; /* printed, so that nothing is optimised away */
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        se3d_expression_def def = se3d_expression_def_default();
        def.text = rows[k].text;
        def.variables = variables;
        def.variable_count = 3;
        se3d_expression *expression = NULL;
        se3d_expression_error error;
        if (SE3D_FAILED(se3d_expression_create(&def, &expression, &error))) {
            fprintf(stderr, "%s:%zu: %s\n", def.text, error.column, error.message);
            return 1;
        }
        double ns = measure_ns(expression, rows[k].mode, &sum);
        printf("%-40s %-9s %7.1f ns\n", rows[k].text, results[rows[k].mode], ns);
        se3d_expression_destroy(expression);
    }
    printf("(checksum %.6g)\n", sum);
    return 0;
}
