/* SPDX-License-Identifier: BSD-3-Clause */
/* Random expression trees: values against the same tree computed in C, exact derivatives against
 * central differences, whose error must fall with the second power of the step. */
#include "check.h"
#include "expression/expression.h"

#include <stdlib.h>

#define TREES     2000
#define DEPTH     5
#define VARIABLES 3

static const char *const variables[VARIABLES] = {"t", "u", "v"};

typedef struct random_tree {
    char text[4096];
    size_t size;
    uint64_t seed;
    const double *x;
} random_tree;

static void put(random_tree *tree, const char *text)
{
    tree->size +=
        (size_t)snprintf(tree->text + tree->size, sizeof tree->text - tree->size, "%s", text);
}

static int choose(random_tree *tree, int count)
{
    return (int)((check_random(&tree->seed) + 1.0) * 0.5 * count);
}

static double grow(random_tree *tree, int depth);

static double leaf(random_tree *tree)
{
    int k = choose(tree, VARIABLES + 2);
    if (k < VARIABLES) {
        put(tree, variables[k]);
        return tree->x[k];
    }
    if (k == VARIABLES) {
        put(tree, "t");
        return tree->x[0];
    }
    char number[32];
    snprintf(number, sizeof number, "%.3f", 1.0 + 0.5 * check_random(&tree->seed));
    put(tree, number);
    return strtod(number, NULL);
}

/* open, a subtree, close */
static double wrap(random_tree *tree, int depth, const char *open, const char *close)
{
    put(tree, open);
    double value = grow(tree, depth - 1);
    put(tree, close);
    return value;
}

/* Functions whose arguments stay well inside their domains, so that differences are smooth. */
static double grow_unary(random_tree *tree, int depth)
{
    switch (choose(tree, 15)) {
    case 0:
        return sin(wrap(tree, depth, "sin(", ")"));
    case 1:
        return cos(wrap(tree, depth, "cos(", ")"));
    case 2:
        return tanh(wrap(tree, depth, "tanh(", ")"));
    case 3:
        return atan(wrap(tree, depth, "atan(", ")"));
    case 4:
        return exp(sin(wrap(tree, depth, "exp(sin(", "))")));
    case 5:
        return sqrt(2 + sin(wrap(tree, depth, "sqrt(2+sin(", "))")));
    case 6:
        return log(2 + cos(wrap(tree, depth, "log(2+cos(", "))")));
    case 7:
        return log10(3 + cos(wrap(tree, depth, "log10(3+cos(", "))")));
    case 8:
        return asin(sin(wrap(tree, depth, "asin(sin(", ")*0.7)")) * 0.7);
    case 9:
        return acos(sin(wrap(tree, depth, "acos(sin(", ")*0.7)")) * 0.7);
    case 10:
        return tan(sin(wrap(tree, depth, "tan(sin(", "))")));
    case 11:
        return sinh(sin(wrap(tree, depth, "sinh(sin(", "))")));
    case 12:
        return cosh(sin(wrap(tree, depth, "cosh(sin(", "))")));
    case 13:
        return pow(wrap(tree, depth, "(", ")^3"), 3);
    default:
        return -pow(wrap(tree, depth, "(-(", ")^2)"), 2);
    }
}

static double grow_binary(random_tree *tree, int depth)
{
    int kind = choose(tree, 9);
    double a, b;
    switch (kind) {
    case 0:
        a = wrap(tree, depth, "(", "+");
        return a + wrap(tree, depth, "", ")");
    case 1:
        a = wrap(tree, depth, "((", ")-");
        return a - wrap(tree, depth, "(", "))");
    case 2:
        a = wrap(tree, depth, "(", ")*");
        return a * wrap(tree, depth, "(", ")");
    case 3:
        a = wrap(tree, depth, "((", ")/");
        return a / (2 + sin(wrap(tree, depth, "(2+sin(", ")))")));
    case 4:
        a = wrap(tree, depth, "hypot(", ",");
        return hypot(a, 2 + sin(wrap(tree, depth, "2+sin(", "))")));
    case 5:
        a = wrap(tree, depth, "atan2(", ",");
        return atan2(a, 2 + sin(wrap(tree, depth, "2+sin(", "))")));
    case 6:
        a = 2 + sin(wrap(tree, depth, "(2+sin(", "))"));
        b = wrap(tree, depth, "^sin(", ")");
        return pow(a, sin(b));
    case 7:
        a = wrap(tree, depth, "if(t>-9,", ",");
        (void)wrap(tree, depth, "", ")");
        return a;
    default: {
        double s = 0.5 + 0.4 * sin(wrap(tree, depth, "step(0.5+0.4*sin(", "),0,"));
        a = wrap(tree, depth, "", ",1,");
        b = wrap(tree, depth, "", ")");
        return a + (b - a) * s * s * (3 - 2 * s);
    }
    }
}

static double grow(random_tree *tree, int depth)
{
    if (depth == 0 || tree->size > 1500) {
        return leaf(tree);
    }
    return choose(tree, 2) ? grow_unary(tree, depth) : grow_binary(tree, depth);
}

static se3d_expression *compile(const char *text)
{
    se3d_expression_def def = se3d_expression_def_default();
    def.text = text;
    def.variables = variables;
    def.variable_count = VARIABLES;
    se3d_expression *expression = NULL;
    CHECK(se3d_expression_create(&def, &expression, NULL) == SE3D_OK);
    return expression;
}

static double value_at(const se3d_expression *e, const double *x, int k, double step)
{
    double moved[VARIABLES], f;
    memcpy(moved, x, sizeof moved);
    moved[k] += step;
    CHECK(se3d_expression_eval(e, moved, &f) == SE3D_OK);
    return f;
}

/* Points side by side have the bits that each has alone. */
static void check_points(const se3d_expression *e, const double *x)
{
    double at[VARIABLES][SE3DI_EXPRESSION_POINTS], values[SE3DI_EXPRESSION_POINTS];
    for (int k = 0; k < SE3DI_EXPRESSION_POINTS; ++k) {
        for (int i = 0; i < VARIABLES; ++i) {
            at[i][k] = x[i] + (i == k % VARIABLES ? 0.01 * k : 0.0);
        }
    }
    CHECK(se3di_expression_eval_points(e, at[0], values) == SE3D_OK);
    for (int k = 0; k < SE3DI_EXPRESSION_POINTS; ++k) {
        CHECK(values[k] == value_at(e, x, k % VARIABLES, 0.01 * k));
    }
    at[1][3] = HUGE_VAL;
    CHECK(se3di_expression_eval_points(e, at[0], values) == SE3D_ERR_INVALID_ARGUMENT);
}

static double rate_at(const se3d_expression *e, const double *x, double step)
{
    double moved[VARIABLES], jet[3];
    memcpy(moved, x, sizeof moved);
    moved[0] += step;
    CHECK(se3d_expression_eval_time(e, moved, jet) == SE3D_OK);
    return jet[1];
}

typedef struct order_count {
    int regular, seen; /* differences whose error fell as h^2, and all that could tell */
} order_count;

/* Compare `exact` with the differences over h and h/2. */
static void compare(order_count *orders, double exact, double coarse, double fine, const char *text)
{
    double scale = 1.0 + fabs(exact);
    double better = fine + (fine - coarse) / 3.0; /* Richardson: error O(h^4) */
    int before = check_failures;
    CHECK_NEAR(exact, better, 1e-6 * scale + 0.1 * fabs(fine - coarse));
    if (check_failures > before) {
        fprintf(stderr, "    in %s\n", text);
    }
    if (fabs(fine - exact) > 1e-8 * scale) {
        double order = log2(fabs(coarse - exact) / fabs(fine - exact));
        orders->seen += 1;
        orders->regular += order > 1.9 && order < 2.1;
    }
}

static void check_tree(const se3d_expression *e, const random_tree *tree, order_count orders[3])
{
    const double h = 2e-3, *x = tree->x;
    double jet[3], f, gradient[VARIABLES], d[VARIABLES][2];
    CHECK(se3d_expression_eval_time(e, x, jet) == SE3D_OK);
    CHECK(se3d_expression_eval_gradient(e, x, &f, gradient) == SE3D_OK);
    CHECK(f == jet[0] && f == value_at(e, x, 0, 0.0)); /* the same bits from all three */
    CHECK_NEAR(gradient[0], jet[1], 1e-12 * (1.0 + fabs(jet[1])));
    check_points(e, x);
    for (int k = 0; k < VARIABLES; ++k) {
        d[k][0] = (value_at(e, x, k, h) - value_at(e, x, k, -h)) / (2 * h);
        d[k][1] = (value_at(e, x, k, h / 2) - value_at(e, x, k, -h / 2)) / h;
        compare(&orders[0], gradient[k], d[k][0], d[k][1], tree->text);
    }
    compare(&orders[1], jet[1], d[0][0], d[0][1], tree->text);
    double coarse = (rate_at(e, x, h) - rate_at(e, x, -h)) / (2 * h);
    double fine = (rate_at(e, x, h / 2) - rate_at(e, x, -h / 2)) / h;
    compare(&orders[2], jet[2], coarse, fine, tree->text);
}

static void derivatives_of_random_trees_agree_with_differences_to_second_order(void)
{
    uint64_t seed = 20240229;
    order_count orders[3] = {{0, 0}};
    for (int k = 0; k < TREES; ++k) {
        double x[VARIABLES];
        for (int i = 0; i < VARIABLES; ++i) {
            x[i] = 0.8 * check_random(&seed);
        }
        random_tree tree = {.seed = seed + (uint64_t)k * 7919 + 1, .x = x};
        double expected = grow(&tree, DEPTH);
        se3d_expression *e = compile(tree.text);
        double f;
        CHECK(se3d_expression_eval(e, x, &f) == SE3D_OK);
        CHECK_NEAR(f, expected, 1e-12 * (1.0 + fabs(expected)));
        if (fabs(expected) < 100.0) { /* towers of powers leave h too coarse */
            check_tree(e, &tree, orders);
        }
        se3d_expression_destroy(e);
    }
    for (int k = 0; k < 3; ++k) {
        printf("order 2 in %d of %d differences\n", orders[k].regular, orders[k].seen);
        CHECK(orders[k].seen > TREES / 4);
        CHECK(orders[k].regular >= 0.95 * orders[k].seen);
    }
}

int main(void)
{
    RUN(derivatives_of_random_trees_agree_with_differences_to_second_order);
    return check_finish();
}
