/* SPDX-License-Identifier: BSD-3-Clause */
/* Chrono: functions of one variable, and their integrals for motors that prescribe a speed:
 *
 *     polynomial  sum c_k u^k              sum c_k u^(k+1) / (k + 1)
 *     sine        a sin(w u + p) + s       a (cos(p) - cos(w u + p)) / w + s u
 *     data        y_0 + sum s_k (clamp(u, x_k, x_k+1) - x_k)
 *     its integral y_0 u + sum s_k ((clamp(u, x_k, x_k+1) - x_k)^2 / 2
 *                                   + (x_k+1 - x_k) max(u - x_k+1, 0))
 *
 * A function that repeats is f(start + mod(t + offset, width)); its integral grows by that of one
 * slice each time. */
#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/import/chrono.h"
#include "io/import/scan.h"

enum { EXPRESSION_MAX = 4000 };

#define TURN 6.28318530717958647692

static bool read_points(se3di_chrono *c, const se3di_node *list, se3di_chrono_function *function)
{
    se3di_chrono_function *f = function;
    f->kind = SE3DI_CHRONO_DATA;
    f->values = se3di_iopool_array(c->m->pool, list->count + 1, 2 * sizeof(double));
    if (!f->values) {
        return se3di_machine_fail_memory(c->m);
    }
    for (const se3di_node *at = list->first; at; at = at->next) {
        double *point = &f->values[2 * f->count];
        const bool is_pair = at->kind == SE3DI_NODE_LIST && at->count == 2;
        for (int k = 0; is_pair && k < 2; ++k) {
            const se3di_node *x = k == 0 ? at->first : at->last;
            const char *text = x->kind == SE3DI_NODE_SCALAR ? x->text : "";
            const size_t length = se3di_scan_number(text, false, &point[k]);
            if (length == 0 || text[length]) {
                return se3di_machine_fail(c->m, x->line, x->column, "a point must be two numbers");
            }
        }
        if (!is_pair || (f->count > 0 && !(point[0] > point[-2]))) {
            return se3di_machine_fail(c->m, at->line, at->column,
                                      is_pair ? "the points must have ascending first numbers"
                                              : "a point must be two numbers");
        }
        ++f->count;
    }
    return f->count > 0 || se3di_machine_fail(c->m, list->line, list->column, "there is no point");
}

bool se3di_chrono_points(se3di_chrono *c, const se3di_node *map, const char *key,
                         se3di_chrono_function *function)
{
    const se3di_node *list = se3di_node_get(map, key);
    if (!se3di_chrono_has(c, map, key)) {
        return false;
    }
    if (list->kind != SE3DI_NODE_LIST) {
        return se3di_machine_fail(c->m, list->line, list->column, "`%s` must be a list of points",
                                  key);
    }
    memset(function, 0, sizeof *function);
    return read_points(c, list, function);
}

static bool read_coefficients(se3di_chrono *c, const se3di_node *map, se3di_chrono_function *f)
{
    const se3di_node *list = se3di_node_get(map, "coefficients");
    if (!se3di_chrono_has(c, map, "coefficients")) {
        return false;
    }
    if (list->kind != SE3DI_NODE_LIST || list->count > 9 || list->count == 0) {
        return se3di_machine_fail(c->m, list->line, list->column,
                                  "`coefficients` must be 1 to 9 numbers");
    }
    f->count = list->count;
    return se3di_chrono_numbers(c, map, "coefficients", f->values, list->count);
}

static bool read_sine(se3di_chrono *c, const se3di_node *map, se3di_chrono_function *f)
{
    double frequency = 0.0;
    f->kind = SE3DI_CHRONO_SINE;
    if (!se3di_chrono_has(c, map, "amplitude") || !se3di_chrono_has(c, map, "frequency") ||
        !se3di_chrono_number(c, map, "amplitude", &f->amplitude) ||
        !se3di_chrono_number(c, map, "frequency", &frequency) ||
        !se3di_chrono_number(c, map, "phase", &f->phase) ||
        !se3di_chrono_number(c, map, "shift", &f->shift)) {
        return false;
    }
    f->rate = TURN * frequency;
    f->phase *= c->degrees ? TURN / 360.0 : 1.0;
    return true;
}

static bool read_repeat(se3di_chrono *c, const se3di_node *map, se3di_chrono_function *f)
{
    const se3di_node *repeat = se3di_node_get(map, "repeat");
    if (!repeat || f->kind == SE3DI_CHRONO_CONTROLLER) {
        return true;
    }
    f->repeats = true;
    if (!se3di_chrono_has(c, repeat, "width") ||
        !se3di_chrono_number(c, repeat, "start", &f->start) ||
        !se3di_chrono_number(c, repeat, "width", &f->width) ||
        !se3di_chrono_number(c, repeat, "shift", &f->offset)) {
        return false;
    }
    if (!(f->width > 0.0) || f->offset < 0.0) {
        return se3di_machine_fail(c->m, repeat->line, repeat->column,
                                  "`width` must be > 0 and `shift` >= 0");
    }
    f->offset = fmod(f->offset, f->width);
    return true;
}

bool se3di_chrono_function_read(se3di_chrono *c, const se3di_node *map,
                                se3di_chrono_function *function)
{
    se3di_chrono_function *f = function;
    memset(f, 0, sizeof *f);
    const char *type = se3di_chrono_need(c, map, "type");
    f->values = se3di_iopool_array(c->m->pool, 9, sizeof(double));
    if (!type || !f->values) {
        return f->values ? false : se3di_machine_fail_memory(c->m);
    }
    bool good = true;
    if (se3di_scan_equal(type, "CONSTANT")) {
        f->count = 1;
        good = se3di_chrono_has(c, map, "value") &&
               se3di_chrono_number(c, map, "value", &f->values[0]);
    } else if (se3di_scan_equal(type, "RAMP")) {
        f->count = 2;
        good = se3di_chrono_has(c, map, "slope") &&
               se3di_chrono_number(c, map, "slope", &f->values[1]) &&
               se3di_chrono_number(c, map, "intercept", &f->values[0]);
    } else if (se3di_scan_equal(type, "POLYNOMIAL")) {
        good = read_coefficients(c, map, f);
    } else if (se3di_scan_equal(type, "SINE")) {
        good = read_sine(c, map, f);
    } else if (se3di_scan_equal(type, "DATA")) {
        good = se3di_chrono_points(c, map, "data", f);
    } else if (se3di_scan_equal(type, "CONTROLLER")) {
        f->kind = SE3DI_CHRONO_CONTROLLER;
    } else {
        const se3di_node *at = se3di_node_get(map, "type");
        return se3di_machine_fail(
            c->m, at->line, at->column,
            "the function `%.60s` is not known, must be CONSTANT, POLYNOMIAL, "
            "SINE, RAMP, DATA or CONTROLLER",
            type);
    }
    return good && read_repeat(c, map, f);
}

/* A text that grows by terms; NULL once there is no memory. */
typedef struct sum {
    se3di_machine *m;
    const char *text;
} sum;

/* Add "factor*(term)", or the factor if the term is NULL. */
static void add(sum *s, double factor, const char *term)
{
    if (!s->text || factor == 0.0) {
        return;
    }
    const bool first = !s->text[0];
    const char *number = se3di_machine_number(s->m, first ? factor : fabs(factor));
    const char *sign = first ? "" : factor < 0.0 ? " - " : " + ";
    if (!number || strlen(s->text) > EXPRESSION_MAX) {
        s->text = number ? s->text : NULL;
        return;
    }
    const bool one = term && strcmp(number, "1") == 0;
    s->text = one    ? se3di_machine_text(s->m, "%s%s%s", s->text, sign, term)
              : term ? se3di_machine_text(s->m, "%s%s%s*%s", s->text, sign, number, term)
                     : se3di_machine_text(s->m, "%s%s%s", s->text, sign, number);
}

/* " - a" */
static const char *less(se3di_machine *m, double a)
{
    const char *number = se3di_machine_number(m, fabs(a));
    return a == 0.0 ? ""
           : number ? se3di_machine_text(m, " %c %s", a > 0.0 ? '-' : '+', number)
                    : NULL;
}

/* "clamp(u, a, b) - a" in parentheses. */
static const char *ramp(se3di_machine *m, const char *u, double a, double b)
{
    const char *from = se3di_machine_number(m, a);
    const char *to = se3di_machine_number(m, b);
    const char *minus = less(m, a);
    return from && to && minus
               ? se3di_machine_text(m, "(min(max(%s, %s), %s)%s)", u, from, to, minus)
               : NULL;
}

static const char *power(se3di_machine *m, const char *u, size_t k)
{
    return k == 1 ? u : se3di_machine_text(m, "%s^%zu", u, k);
}

/* The terms of the function of `u`, or of its integral. */
static void add_polynomial(sum *s, const se3di_chrono_function *f, const char *u, bool integral)
{
    for (size_t k = 0; k < f->count; ++k) {
        const size_t up = k + (integral ? 1 : 0);
        add(s, f->values[k] / (integral ? (double)up : 1.0), up > 0 ? power(s->m, u, up) : NULL);
    }
}

static void add_sine(sum *s, const se3di_chrono_function *f, const char *u, bool integral)
{
    const char *rate = se3di_machine_number(s->m, f->rate);
    const char *phase = se3di_machine_number(s->m, f->phase);
    const char *name = integral ? "cos" : "sin";
    const char *wave = NULL;
    if (rate && phase) {
        wave = f->phase == 0.0 ? se3di_machine_text(s->m, "%s(%s*%s)", name, rate, u)
                               : se3di_machine_text(s->m, "%s(%s*%s + (%s))", name, rate, u, phase);
    }
    s->text = wave ? s->text : NULL;
    if (f->rate == 0.0) {
        add(s, f->amplitude * io_sin(f->phase) + f->shift, integral ? u : NULL);
    } else if (integral) {
        add(s, f->amplitude / f->rate * io_cos(f->phase), NULL);
        add(s, -f->amplitude / f->rate, wave);
        add(s, f->shift, u);
    } else {
        add(s, f->amplitude, wave);
        add(s, f->shift, NULL);
    }
}

static void add_data(sum *s, const se3di_chrono_function *f, const char *u, bool integral)
{
    add(s, f->values[1], integral ? u : NULL);
    for (size_t k = 0; k + 1 < f->count; ++k) {
        const double *p = &f->values[2 * k];
        const double slope = (p[3] - p[1]) / (p[2] - p[0]);
        const char *part = ramp(s->m, u, p[0], p[2]);
        const char *end = less(s->m, p[2]);
        if (!part || !end) {
            s->text = NULL;
            return;
        }
        if (!integral) {
            add(s, slope, part);
            continue;
        }
        add(s, 0.5 * slope, se3di_machine_text(s->m, "%s^2", part));
        add(s, slope * (p[2] - p[0]), se3di_machine_text(s->m, "max(%s%s, 0)", u, end));
    }
}

static void add_terms(sum *s, const se3di_chrono_function *f, const char *u, bool integral)
{
    if (f->kind == SE3DI_CHRONO_POLYNOMIAL) {
        add_polynomial(s, f, u, integral);
    } else if (f->kind == SE3DI_CHRONO_SINE) {
        add_sine(s, f, u, integral);
    } else if (f->kind == SE3DI_CHRONO_DATA) {
        add_data(s, f, u, integral);
    }
}

/* The integral as add_terms writes it, at u. */
static double integral_at(const se3di_chrono_function *f, double u)
{
    double value = 0.0;
    if (f->kind == SE3DI_CHRONO_POLYNOMIAL) {
        for (size_t k = 0; k < f->count; ++k) {
            value += f->values[k] * io_pow(u, (double)(k + 1)) / (double)(k + 1);
        }
    } else if (f->kind == SE3DI_CHRONO_SINE) {
        value = f->shift * u;
        value += f->rate == 0.0
                     ? f->amplitude * io_sin(f->phase) * u
                     : f->amplitude / f->rate * (io_cos(f->phase) - io_cos(f->rate * u + f->phase));
    } else if (f->kind == SE3DI_CHRONO_DATA) {
        value = f->values[1] * u;
        for (size_t k = 0; k + 1 < f->count; ++k) {
            const double *p = &f->values[2 * k];
            const double slope = (p[3] - p[1]) / (p[2] - p[0]);
            const double part = fmin(fmax(u, p[0]), p[2]) - p[0];
            value += slope * (0.5 * part * part + (p[2] - p[0]) * fmax(u - p[2], 0.0));
        }
    }
    return value;
}

/* The integral over one slice that repeats; what is only rounding is 0. */
static double slice(const se3di_chrono_function *f)
{
    const double first = integral_at(f, f->start);
    double largest = 0.0;
    double value = 0.0;
    for (int k = 1; k <= 16; ++k) {
        value = integral_at(f, f->start + f->width * k / 16.0) - first;
        largest = fmax(largest, fabs(value));
    }
    return fabs(value) > 1e-14 * largest ? value : 0.0;
}

static const char *repeated(se3di_machine *m, const se3di_chrono_function *f, const char *variable)
{
    const char *start = se3di_machine_number(m, f->start);
    const char *width = se3di_machine_number(m, f->width);
    const char *offset = se3di_machine_number(m, f->offset);
    if (!start || !width || !offset) {
        return NULL;
    }
    const char *u = f->offset > 0.0
                        ? se3di_machine_text(m, "mod(%s + %s, %s)", variable, offset, width)
                        : se3di_machine_text(m, "mod(%s, %s)", variable, width);
    return u && f->start != 0.0 ? se3di_machine_text(m, "(%s + %s)", u, start) : u;
}

static const char *finish(const sum *s)
{
    if (!s->text || strlen(s->text) > EXPRESSION_MAX) {
        return NULL;
    }
    return s->text[0] ? s->text : "0";
}

const char *se3di_chrono_expression(se3di_chrono *c, const se3di_chrono_function *function,
                                    const char *variable)
{
    sum s = {.m = c->m, .text = ""};
    const char *u = function->repeats ? repeated(c->m, function, variable) : variable;
    if (u) {
        add_terms(&s, function, u, false);
    }
    return u ? finish(&s) : NULL;
}

const char *se3di_chrono_integral(se3di_chrono *c, const se3di_chrono_function *function)
{
    const se3di_chrono_function *f = function;
    sum s = {.m = c->m, .text = ""};
    const char *u = f->repeats ? repeated(c->m, f, "t") : "t";
    if (!u) {
        return NULL;
    }
    add_terms(&s, f, u, true);
    add(&s, -integral_at(f, f->repeats ? f->start + f->offset : 0.0), NULL);
    if (f->repeats) {
        const char *offset = se3di_machine_number(c->m, f->offset);
        const char *width = se3di_machine_number(c->m, f->width);
        const char *count =
            offset && width ? se3di_machine_text(c->m, "floor((t + %s)/%s)", offset, width) : NULL;
        s.text = count ? s.text : NULL;
        add(&s, slice(f), count);
    }
    return finish(&s);
}
