/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of expressions with their exact derivatives.
 *
 * A unary function writes f, f', f'' at u; a binary one f and its five partial derivatives. The
 * evaluators combine them by the chain rule. What happens at kinks and at the ends of a domain is
 * promised in docs/model-file/expressions.md: kinks take a finite convention, singular derivatives
 * come out as infinite or NaN and are reported by the caller. */
#include "expression/functions.h"
#include "math/elementary.h"
#include "math/over.h"

#include <math.h>
#include <string.h>

static void set(double d[3], double f, double f1, double f2)
{
    d[0] = f;
    d[1] = f1;
    d[2] = f2;
}

static double sign_of(double u)
{
    return u > 0.0 ? 1.0 : u < 0.0 ? -1.0 : u; /* keeps 0 and NaN */
}

void se3di_function_abs(double u, double d[3])
{
    set(d, fabs(u), sign_of(u), 0.0);
}

static void eval_sign(double u, double d[3])
{
    set(d, sign_of(u), 0.0, 0.0);
}

static void eval_floor(double u, double d[3])
{
    set(d, floor(u), 0.0, 0.0);
}

static void eval_ceil(double u, double d[3])
{
    set(d, ceil(u), 0.0, 0.0);
}

static void eval_round(double u, double d[3])
{
    set(d, round(u), 0.0, 0.0);
}

static void eval_sqrt(double u, double d[3])
{
    double s = sqrt(u);
    set(d, s, se3di_over(0.5, s), se3di_over(-0.25, s * u));
}

static void eval_exp(double u, double d[3])
{
    double f = se3di_exp(u);
    set(d, f, f, f);
}

static void eval_log(double u, double d[3])
{
    set(d, se3di_log(u), se3di_over(1.0, u), se3di_over(-1.0, u * u));
}

static void eval_log10(double u, double d[3])
{
    const double log_e = 0.43429448190325182765; /* log10(e) */
    set(d, se3di_log10(u), se3di_over(log_e, u), se3di_over(-log_e, u * u));
}

static void eval_sin(double u, double d[3])
{
    double s, c;
    se3di_sincos(u, &s, &c);
    set(d, s, c, -s);
}

static void eval_cos(double u, double d[3])
{
    double s, c;
    se3di_sincos(u, &s, &c);
    set(d, c, -s, -c);
}

static void eval_tan(double u, double d[3])
{
    double f = se3di_tan(u);
    double f1 = 1.0 + f * f;
    set(d, f, f1, 2.0 * f * f1);
}

static void eval_asin(double u, double d[3])
{
    double w = se3di_over(1.0, sqrt((1.0 - u) * (1.0 + u)));
    set(d, se3di_asin(u), w, u * w * w * w);
}

static void eval_acos(double u, double d[3])
{
    double w = se3di_over(1.0, sqrt((1.0 - u) * (1.0 + u)));
    set(d, se3di_acos(u), -w, -u * w * w * w);
}

static void eval_atan(double u, double d[3])
{
    double w = 1.0 / (1.0 + u * u);
    set(d, se3di_atan(u), w, -2.0 * u * w * w);
}

static void eval_sinh(double u, double d[3])
{
    double s = se3di_sinh(u);
    set(d, s, se3di_cosh(u), s);
}

static void eval_cosh(double u, double d[3])
{
    double c = se3di_cosh(u);
    set(d, c, se3di_sinh(u), c);
}

static void eval_tanh(double u, double d[3])
{
    double f = se3di_tanh(u);
    double s = 1.0 / se3di_cosh(u); /* 1 - f^2 would cancel for large u */
    set(d, f, s * s, -2.0 * f * s * s);
}

static void eval_min(double a, double b, se3di_partials *d)
{
    int first = a <= b;
    *d = (se3di_partials){.f = first ? a : b < a ? b : (double)NAN, .a = first, .b = b < a};
}

static void eval_max(double a, double b, se3di_partials *d)
{
    int first = a >= b;
    *d = (se3di_partials){.f = first ? a : b > a ? b : (double)NAN, .a = first, .b = b > a};
}

static void eval_atan2(double y, double x, se3di_partials *d)
{
    double r = se3di_hypot(x, y);
    double c = se3di_over(x, r), s = se3di_over(y, r); /* scaled first, so that nothing overflows */
    d->f = se3di_atan2(y, x);
    d->a = se3di_over(c, r);
    d->b = se3di_over(-s, r);
    d->aa = se3di_over(se3di_over(-2.0 * c * s, r), r);
    d->bb = se3di_over(se3di_over(2.0 * c * s, r), r);
    d->ab = se3di_over(se3di_over((s - c) * (s + c), r), r);
}

static void eval_hypot(double a, double b, se3di_partials *d)
{
    double r = se3di_hypot(a, b);
    if (r == 0.0) { /* a kink like that of abs */
        *d = (se3di_partials){.f = 0.0};
        return;
    }
    double p = a / r, q = b / r;
    *d = (se3di_partials){r, p, q, q * q / r, -p * q / r, p * p / r};
}

/* The remainder with the sign of b, so that mod(t, T) is periodic also for t < 0. */
static void eval_mod(double a, double b, se3di_partials *d)
{
    double r = fmod(a, b);
    if (r != 0.0 && (r < 0.0) != (b < 0.0)) {
        r += b;
    }
    *d = (se3di_partials){.f = r, .a = 1.0, .b = -round(se3di_over(a - r, b))};
}

static void eval_power(double a, double b, se3di_partials *d)
{
    double f = se3di_pow(a, b);
    if (a == 0.0) { /* limits from a > 0: a^b log(a) and a^b log(a)^2 go to 0 for b > 0 */
        d->f = f;
        d->a = b * se3di_pow(0.0, b - 1.0);
        d->aa = b == 1.0 ? 0.0 : b * (b - 1.0) * se3di_pow(0.0, b - 2.0);
        d->b = d->bb = b > 0.0 ? 0.0 : (double)NAN;
        d->ab = b > 1.0 ? 0.0 : -(double)INFINITY;
        return;
    }
    double l = se3di_log(a); /* NaN for a < 0: only derivatives along a exist there */
    d->f = f;
    d->a = f * b / a;
    d->aa = d->a * (b - 1.0) / a;
    d->b = f * l;
    d->bb = f * l * l;
    d->ab = f * (1.0 + b * l) / a;
}

/* Comparisons give 1 or 0, and NaN if an operand is NaN: it must not choose a branch. */
static void set_truth(int holds, double a, double b, se3di_partials *d)
{
    *d = (se3di_partials){.f = isnan(a) || isnan(b) ? (double)NAN : (double)holds};
}

static void eval_less(double a, double b, se3di_partials *d)
{
    set_truth(a < b, a, b, d);
}

static void eval_less_equal(double a, double b, se3di_partials *d)
{
    set_truth(a <= b, a, b, d);
}

static void eval_greater(double a, double b, se3di_partials *d)
{
    set_truth(a > b, a, b, d);
}

static void eval_greater_equal(double a, double b, se3di_partials *d)
{
    set_truth(a >= b, a, b, d);
}

static void eval_equal(double a, double b, se3di_partials *d)
{
    set_truth(a == b, a, b, d);
}

static void eval_not_equal(double a, double b, se3di_partials *d)
{
    set_truth(a != b, a, b, d);
}

#define UNARY(name, flat, eval)                                                                    \
    {                                                                                              \
        name, name "(x)", SE3DI_FUNCTION_UNARY, flat, 1, 1, eval, NULL                             \
    }
#define BINARY(name, arguments, flat, eval)                                                        \
    {                                                                                              \
        name, name arguments, SE3DI_FUNCTION_BINARY, flat, 2, 2, NULL, eval                        \
    }

const se3di_named_function se3di_functions[] = {
    UNARY("abs", 0, se3di_function_abs),
    UNARY("sqrt", 0, eval_sqrt),
    UNARY("exp", 0, eval_exp),
    UNARY("log", 0, eval_log),
    UNARY("log10", 0, eval_log10),
    UNARY("sin", 0, eval_sin),
    UNARY("cos", 0, eval_cos),
    UNARY("tan", 0, eval_tan),
    UNARY("asin", 0, eval_asin),
    UNARY("acos", 0, eval_acos),
    UNARY("atan", 0, eval_atan),
    UNARY("sinh", 0, eval_sinh),
    UNARY("cosh", 0, eval_cosh),
    UNARY("tanh", 0, eval_tanh),
    UNARY("floor", 1, eval_floor),
    UNARY("ceil", 1, eval_ceil),
    UNARY("round", 1, eval_round),
    UNARY("sign", 1, eval_sign),
    BINARY("atan2", "(y, x)", 0, eval_atan2),
    BINARY("mod", "(x, y)", 0, eval_mod),
    BINARY("hypot", "(x, y)", 0, eval_hypot),
    BINARY("^", "", 0, eval_power),
    BINARY("<", "", 1, eval_less),
    BINARY("<=", "", 1, eval_less_equal),
    BINARY(">", "", 1, eval_greater),
    BINARY(">=", "", 1, eval_greater_equal),
    BINARY("==", "", 1, eval_equal),
    BINARY("!=", "", 1, eval_not_equal),
    {"min", "min(a, b, ...)", SE3DI_FUNCTION_SELECT, 0, 2, UINT8_MAX, NULL, eval_min},
    {"max", "max(a, b, ...)", SE3DI_FUNCTION_SELECT, 0, 2, UINT8_MAX, NULL, eval_max},
    {"step", "step(x, x0, h0, x1, h1)", SE3DI_FUNCTION_STEP, 0, 5, 5, NULL, NULL},
    {"if", "if(c, a, b)", SE3DI_FUNCTION_IF, 0, 3, 3, NULL, NULL},
};
const size_t se3di_function_count = sizeof se3di_functions / sizeof se3di_functions[0];

size_t se3di_function_find(const char *name, size_t length)
{
    for (size_t k = 0; k < se3di_function_count; ++k) {
        const char *candidate = se3di_functions[k].name;
        if (strlen(candidate) == length && memcmp(candidate, name, length) == 0) {
            return k;
        }
    }
    return SE3DI_FUNCTION_NONE;
}

static int is_named(size_t function, const char *const *names)
{
    for (; *names; ++names) {
        if (strcmp(se3di_functions[function].name, *names) == 0) {
            return 1;
        }
    }
    return 0;
}

int se3di_function_is_smooth(size_t function)
{
    static const char *const names[] = {"exp",  "log",  "log10", "sin",  "cos", "tan",
                                        "atan", "sinh", "cosh",  "tanh", NULL};
    return is_named(function, names);
}

int se3di_function_is_continuous(size_t function)
{
    return !se3di_functions[function].flat && strcmp(se3di_functions[function].name, "mod") != 0;
}

int se3di_function_is_total(size_t function)
{
    static const char *const names[] = {"abs",   "sin",  "cos",   "atan", "tanh", "sign",
                                        "floor", "ceil", "round", "<",    "<=",   ">",
                                        ">=",    "==",   "!=",    NULL};
    return is_named(function, names);
}

void se3di_function_power(double u, double c, double d[3])
{
    if (c == 2.0) {
        set(d, u * u, 2.0 * u, 2.0);
    } else if (c == 1.0) {
        set(d, u, 1.0, 0.0);
    } else if (c == 0.0) {
        set(d, 1.0, 0.0, 0.0);
    } else if (c == 3.0) {
        set(d, u * u * u, 3.0 * u * u, 6.0 * u);
    } else if (c == 4.0) {
        set(d, u * u * (u * u), 4.0 * u * u * u, 12.0 * u * u);
    } else if (u == 0.0) { /* a quotient by u would lose the limit */
        set(d, se3di_pow(u, c), c * se3di_pow(u, c - 1.0), c * (c - 1.0) * se3di_pow(u, c - 2.0));
    } else {
        double f = se3di_pow(u, c);
        double f1 = c * f / u;
        set(d, f, f1, (c - 1.0) * f1 / u);
    }
}

void se3di_function_smooth_step(double u, double d[3])
{
    set(d, u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u), 6.0 - 12.0 * u);
}
