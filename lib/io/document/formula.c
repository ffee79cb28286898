/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums, products and powers of numbers and vectors with dimensions. */
#include "io/document/formula.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/formula_text.h"

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Up to 15 digits, and a point within: two numbers that have no error, whose quotient is rounded
 * once, as what the expression would give. @return false: it has another form */
static bool read_decimal(const char *text, size_t length, double *value)
{
    double digits = 0.0, scale = 1.0;
    bool has_point = false;
    if (length == 0 || length > 15 || !is_digit(text[length - 1]) ||
        (text[0] == '0' && length > 1 && text[1] != '.')) {
        return false;
    }
    for (size_t k = 0; k < length; ++k) {
        const bool is_point = text[k] == '.' && k > 0 && !has_point;
        if (!is_point && !is_digit(text[k])) {
            return false;
        }
        digits = is_point ? digits : 10.0 * digits + (text[k] - '0');
        scale = has_point ? 10.0 * scale : scale;
        has_point = has_point || is_point;
    }
    *value = digits / scale;
    return true;
}

bool se3di_formula_number(se3di_formula *f, const char *text, size_t length, double *value)
{
    if (read_decimal(text, length, value)) {
        return true;
    }
    char *copy = se3di_iopool_copy(f->reader->pool, text, length);
    se3di_amount result;
    if (!copy) {
        return se3di_reader_fail_memory(f->reader);
    }
    if (!se3di_formula_compile(f, f->at, copy, NULL, 0, &result)) {
        return false;
    }
    *value = result.v[0];
    return true;
}

/* ---- variables ------------------------------------------------------------------------------*/

/* Names that functions have beside the time; of x, v, q, qdot the second is that of an angle. */
static const struct {
    const char *name;
    se3di_dimension dimension[2];
} variables[] = {
    {"t", {{0, 0, 1, 0}, {0, 0, 1, 0}}},          {"l", {{1, 0, 0, 0}, {1, 0, 0, 0}}},
    {"ldot", {{1, 0, -1, 0}, {1, 0, -1, 0}}},     {"theta", {{0, 0, 0, 1}, {0, 0, 0, 1}}},
    {"thetadot", {{0, 0, -1, 1}, {0, 0, -1, 1}}}, {"x", {{1, 0, 0, 0}, {0, 0, 0, 1}}},
    {"v", {{1, 0, -1, 0}, {0, 0, -1, 1}}},        {"y", {{1, 0, 0, 0}, {1, 0, 0, 0}}},
    {"q", {{1, 0, 0, 0}, {0, 0, 0, 1}}},          {"qdot", {{1, 0, -1, 0}, {0, 0, -1, 1}}}};

se3di_dimension se3di_formula_variable_dimension(const se3di_reader *reader, const char *name)
{
    for (size_t k = 0; k < sizeof variables / sizeof *variables; ++k) {
        if (strcmp(variables[k].name, name) == 0) {
            return variables[k].dimension[reader->alternative == 1];
        }
    }
    const se3di_measured *m = &reader->measured;
    for (size_t k = 0; m->names && m->names[k]; ++k) {
        if (strcmp(m->names[k], name) == 0) {
            return m->dimensions[k];
        }
    }
    return (se3di_dimension){0, 0, 0, 0};
}

/* In the units of the file, as numbers are. */
bool se3di_formula_variable(se3di_formula *f, const char *name, se3di_amount *out)
{
    const se3di_dimension d = se3di_formula_variable_dimension(f->reader, name);
    const se3di_measure unit = se3di_units_of(&f->reader->scope->units, d);
    *out = (se3di_amount){.rank = 1, .dimension = d, .text = {name}};
    return se3di_formula_scale(f, out, unit.over, unit.times);
}

/* ---- dimensions -----------------------------------------------------------------------------*/

bool se3di_formula_scale(se3di_formula *f, se3di_amount *a, double times, double over)
{
    if (times == over) {
        return true;
    }
    for (size_t k = 0; k < a->rank; ++k) {
        const se3di_amount part = se3di_formula_part(a, k);
        const se3di_amount factor = {.rank = 1, .v = {times}};
        const se3di_amount divisor = {.rank = 1, .v = {over}};
        se3di_amount product;
        if (!a->text[k]) {
            a->v[k] = a->v[k] * times / over;
        } else if (!se3di_formula_join(f, "*", &part, &factor, &product) ||
                   !se3di_formula_join(f, "/", &product, &divisor, &product)) {
            return false;
        } else {
            a->text[k] = product.text[0];
        }
    }
    return true;
}

/* In SI units of a dimension from those of the file. */
static bool harden(se3di_formula *f, se3di_amount *a, se3di_dimension d)
{
    const se3di_measure unit = se3di_units_of(&f->reader->scope->units, d);
    a->hard = true;
    a->dimension = d;
    return se3di_formula_scale(f, a, unit.times, unit.over);
}

static bool is_constant(const se3di_amount *a)
{
    return !a->text[0] && !a->text[1] && !a->text[2];
}

/* A channel by itself, whose unit is known; times a number it is what the number makes of it. */
static bool is_channel(const se3di_formula *f, const se3di_amount *a)
{
    const se3di_measured *m = &f->reader->measured;
    if (a->rank != 1 || !a->text[0] || se3di_dimension_is_none(a->dimension)) {
        return false;
    }
    for (size_t k = 0; m->names && m->names[k]; ++k) {
        if (strcmp(m->names[k], a->text[0]) == 0) {
            return true;
        }
    }
    return false;
}

bool se3di_formula_unify(se3di_formula *f, const char *place, se3di_amount *a, se3di_amount *b)
{
    char is[80];
    char other[80];
    const bool fits = se3di_dimension_fits(a->dimension, b->dimension);
    if (a->hard != b->hard && (fits || !is_channel(f, a->hard ? b : a))) {
        return a->hard ? harden(f, b, a->dimension) : harden(f, a, b->dimension);
    }
    if (!a->hard && !b->hard) {
        se3di_amount *plain = is_constant(a) ? a : b;
        plain->dimension = plain == a ? b->dimension : a->dimension;
        return true;
    }
    if (fits) {
        return true;
    }
    se3di_dimension_describe(a->dimension, is, sizeof is);
    se3di_dimension_describe(b->dimension, other, sizeof other);
    return se3di_formula_fail(f, place, "%s and %s do not go together, both must be the same", is,
                              other);
}

/* ---- operations -----------------------------------------------------------------------------*/

bool se3di_formula_negate(se3di_formula *f, se3di_amount *a)
{
    for (size_t k = 0; k < a->rank; ++k) {
        const se3di_amount part = se3di_formula_part(a, k);
        const se3di_amount zero = {.rank = 1};
        se3di_amount result;
        a->v[k] = -a->v[k];
        if (a->text[k]) {
            if (!se3di_formula_join(f, "-", &zero, &part, &result)) {
                return false;
            }
            a->text[k] = result.text[0];
        }
    }
    return true;
}

/* Each component by itself; those of a number serve all. */
static bool combine(se3di_formula *f, const char *mark, se3di_amount *a, const se3di_amount *b)
{
    const char sign[2] = {*mark, '\0'};
    const size_t rank = a->rank > b->rank ? a->rank : b->rank;
    se3di_amount result = *a;
    for (size_t k = 0; k < rank; ++k) {
        const se3di_amount left = se3di_formula_part(a, a->rank == 1 ? 0 : k);
        const se3di_amount right = se3di_formula_part(b, b->rank == 1 ? 0 : k);
        se3di_amount part;
        if (!se3di_formula_join(f, sign, &left, &right, &part)) {
            return false;
        }
        if (!part.text[0] && !isfinite(part.v[0])) {
            return se3di_formula_fail(f, mark, "the constant result of '%s' is not finite%s", sign,
                                      *mark == '/' ? ": division by zero" : "");
        }
        result.v[k] = part.v[0];
        result.text[k] = part.text[0];
    }
    result.rank = rank;
    *a = result;
    return true;
}

bool se3di_formula_add(se3di_formula *f, const char *mark, se3di_amount *a, se3di_amount *b)
{
    if (a->rank != b->rank) {
        return se3di_formula_fail(f, mark, "%s '%.1s' %s, both must be numbers or both vectors",
                                  a->rank == 3 ? "a vector" : "a number", mark,
                                  b->rank == 3 ? "a vector" : "a number");
    }
    return se3di_formula_unify(f, mark, a, b) && combine(f, mark, a, b);
}

bool se3di_formula_multiply(se3di_formula *f, const char *mark, se3di_amount *a, se3di_amount *b)
{
    se3di_dimension d;
    if (b->rank == 3 && (*mark == '/' || a->rank == 3)) {
        return se3di_formula_fail(f, mark,
                                  *mark == '/' ? "division by a vector, must be a number"
                                               : "a product of two vectors, must be "
                                                 "dot(a, b) or cross(a, b)");
    }
    if (a->hard != b->hard &&
        !(a->hard ? harden(f, b, b->dimension) : harden(f, a, a->dimension))) {
        return false;
    }
    if (!se3di_dimension_add(a->dimension, b->dimension, *mark == '/' ? -1 : 1, &d)) {
        return se3di_formula_fail(f, mark,
                                  "the power of a unit is too large, at most 20 is "
                                  "allowed");
    }
    if (!combine(f, mark, a, b)) {
        return false;
    }
    a->dimension = d;
    a->hard = a->hard && !se3di_dimension_is_none(d);
    return true;
}

bool se3di_formula_power(se3di_formula *f, const char *mark, se3di_amount *a, const se3di_amount *b)
{
    const se3di_dimension none = {0, 0, 0, 0};
    if (a->rank == 3 || b->rank == 3) {
        return se3di_formula_fail(f, mark, "a power of vectors, must be of numbers");
    }
    if (b->hard) {
        return se3di_formula_fail(f, mark, "an exponent with a unit, must be a number");
    }
    if (a->hard && (b->text[0] || b->v[0] != floor(b->v[0]) || fabs(b->v[0]) > 20.0)) {
        return se3di_formula_fail(f, mark,
                                  "a power of what has a unit, the exponent must be a "
                                  "whole number");
    }
    se3di_dimension d = none;
    if (!b->text[0] && fabs(b->v[0]) <= 20.0 && b->v[0] == floor(b->v[0]) &&
        !se3di_dimension_add(none, a->dimension, (int)b->v[0], &d)) {
        return se3di_formula_fail(f, mark,
                                  "the power of a unit is too large, at most 20 is "
                                  "allowed");
    }
    const se3di_amount both[2] = {*a, *b};
    if (!se3di_formula_apply(f, mark, (const char *[]){"", "^", ""}, both, 2, a)) {
        return false;
    }
    a->dimension = d;
    a->hard = both[0].hard && !se3di_dimension_is_none(d);
    return true;
}

bool se3di_formula_compare(se3di_formula *f, const char *mark, size_t length, se3di_amount *a,
                           se3di_amount *b)
{
    char sign[3] = {mark[0], length > 1 ? mark[1] : '\0', '\0'};
    if (a->rank == 3 || b->rank == 3) {
        return se3di_formula_fail(f, mark, "a comparison of vectors, must be of numbers");
    }
    if (!se3di_formula_unify(f, mark, a, b)) {
        return false;
    }
    const se3di_amount both[2] = {*a, *b};
    a->hard = false;
    a->dimension = (se3di_dimension){0, 0, 0, 0};
    return se3di_formula_apply(f, mark, (const char *[]){"", sign, ""}, both, 2, a);
}
