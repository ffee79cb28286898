/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions: those of numbers are the core's, with what they do to dimensions; those of vectors are
 * made of sums and products. */
#include <stdio.h>
#include <string.h>

#include "io/document/formula.h"
#include "io/document/formula_text.h"
#include "io/document/guess.h"

static const se3di_dimension none = {0, 0, 0, 0};
static const se3di_dimension angle = {0, 0, 0, 1};

/* What a function asks of its arguments' dimensions, and what its result has. */
typedef enum law {
    OF_ANGLE,       /* a number of an angle */
    OF_NUMBER,      /* a number of a number */
    ANGLE_OF,       /* an angle of a number */
    ANGLE_OF_EQUAL, /* an angle of two that are alike */
    ROOT,           /* half the exponents */
    EQUAL,          /* as the arguments, which are alike */
    SIGN,           /* a number of anything */
    STEP,
    IF
} law;

static const struct {
    const char *name;
    law law;
} numbers[] = {
    {"sin", OF_ANGLE},   {"cos", OF_ANGLE},    {"tan", OF_ANGLE},   {"exp", OF_NUMBER},
    {"log", OF_NUMBER},  {"log10", OF_NUMBER}, {"sinh", OF_NUMBER}, {"cosh", OF_NUMBER},
    {"tanh", OF_NUMBER}, {"floor", OF_NUMBER}, {"ceil", OF_NUMBER}, {"round", OF_NUMBER},
    {"asin", ANGLE_OF},  {"acos", ANGLE_OF},   {"atan", ANGLE_OF},  {"atan2", ANGLE_OF_EQUAL},
    {"sqrt", ROOT},      {"abs", EQUAL},       {"min", EQUAL},      {"max", EQUAL},
    {"mod", EQUAL},      {"hypot", EQUAL},     {"sign", SIGN},      {"step", STEP},
    {"if", IF}};

/* All arguments from `first` on, every `stride`-th, alike. */
static bool make_alike(se3di_formula *f, const char *place, se3di_amount *a, size_t first,
                       size_t stride, size_t count)
{
    for (int round = 0; round < 2; ++round) {
        for (size_t k = first + stride; k < count; k += stride) {
            if (!se3di_formula_unify(f, place, &a[first], &a[k])) {
                return false;
            }
        }
    }
    return true;
}

/* An argument must be of this dimension: what has none takes it. */
static bool ask(se3di_formula *f, const char *place, const char *name, se3di_amount *a,
                se3di_dimension d)
{
    char is[80];
    char must[80];
    if (!a->hard) {
        se3di_amount like = {.rank = 1, .hard = true, .dimension = d};
        return se3di_dimension_is_none(d) || se3di_formula_unify(f, place, a, &like);
    }
    if (se3di_dimension_fits(a->dimension, d)) {
        return true;
    }
    se3di_dimension_describe(a->dimension, is, sizeof is);
    se3di_dimension_describe(d, must, sizeof must);
    return se3di_formula_fail(f, place, "%s of %s, must be of %s", name, is, must);
}

static bool halve(se3di_formula *f, const char *place, se3di_amount *a)
{
    se3di_dimension *d = &a->dimension;
    if (a->hard && (d->length % 2 || d->mass % 2 || d->time % 2 || d->angle % 2)) {
        char is[80];
        se3di_dimension_describe(*d, is, sizeof is);
        return se3di_formula_fail(f, place, "sqrt of %s, which is no square", is);
    }
    *d = (se3di_dimension){(int8_t)(d->length / 2), (int8_t)(d->mass / 2), (int8_t)(d->time / 2),
                           (int8_t)(d->angle / 2)};
    return true;
}

/* Check the arguments; the result's dimension goes to *like. */
static bool obey(se3di_formula *f, const char *place, size_t row, se3di_amount *a, size_t count,
                 se3di_amount *like)
{
    const char *name = numbers[row].name;
    *like = (se3di_amount){.rank = 1};
    switch (numbers[row].law) {
    case OF_ANGLE:
        return ask(f, place, name, &a[0], angle);
    case OF_NUMBER:
        return ask(f, place, name, &a[0], none);
    case ANGLE_OF:
        like->hard = true;
        like->dimension = angle;
        return ask(f, place, name, &a[0], none);
    case ANGLE_OF_EQUAL:
        like->hard = true;
        like->dimension = angle;
        return make_alike(f, place, a, 0, 1, count);
    case ROOT: {
        se3di_amount half = a[0];
        const bool good = halve(f, place, &half);
        like->hard = half.hard;
        like->dimension = half.dimension;
        return good;
    }
    case EQUAL:
    case IF:
    case STEP:
        break;
    case SIGN:
        return true;
    }
    const size_t first = numbers[row].law == EQUAL ? 0 : numbers[row].law == IF ? 1 : 2;
    const size_t stride = numbers[row].law == STEP ? 2 : 1;
    bool good = first >= count || make_alike(f, place, a, first, stride, count);
    if (numbers[row].law == STEP && count == 5) {
        good = good && se3di_formula_unify(f, place, &a[0], &a[1]) &&
               se3di_formula_unify(f, place, &a[1], &a[3]) &&
               se3di_formula_unify(f, place, &a[0], &a[1]);
    }
    if (first < count) {
        like->hard = a[first].hard;
        like->dimension = a[first].dimension;
    }
    return good;
}

/* ---- vectors --------------------------------------------------------------------------------*/

static bool multiply(se3di_formula *f, const char *place, se3di_amount a, se3di_amount b,
                     se3di_amount *out)
{
    *out = a;
    (void)place;
    return se3di_formula_multiply(f, "*", out, &b);
}

static bool dot(se3di_formula *f, const char *place, const se3di_amount *a, const se3di_amount *b,
                se3di_amount *out)
{
    for (size_t k = 0; k < 3; ++k) {
        se3di_amount part;
        if (!multiply(f, place, se3di_formula_part(a, k), se3di_formula_part(b, k), &part)) {
            return false;
        }
        if (k == 0) {
            *out = part;
        } else if (!se3di_formula_add(f, "+", out, &part)) {
            return false;
        }
    }
    return true;
}

static bool cross(se3di_formula *f, const char *place, const se3di_amount *a, const se3di_amount *b,
                  se3di_amount *out)
{
    for (size_t k = 0; k < 3; ++k) {
        const size_t i = (k + 1) % 3;
        const size_t j = (k + 2) % 3;
        se3di_amount left;
        se3di_amount right;
        if (!multiply(f, place, se3di_formula_part(a, i), se3di_formula_part(b, j), &left) ||
            !multiply(f, place, se3di_formula_part(a, j), se3di_formula_part(b, i), &right) ||
            !se3di_formula_add(f, "-", &left, &right)) {
            return false;
        }
        if (k == 0) {
            *out = left;
        }
        out->rank = 3;
        out->v[k] = left.v[0];
        out->text[k] = left.text[0];
    }
    return true;
}

/* The length: hypot(hypot(x, y), z), which does not overflow. */
static bool norm(se3di_formula *f, const char *place, const se3di_amount *a, se3di_amount *out)
{
    static const char *const pieces[3] = {"hypot(", ",", ")"};
    const se3di_amount xy[2] = {se3di_formula_part(a, 0), se3di_formula_part(a, 1)};
    se3di_amount both[2];
    both[0] = *a;
    if (!se3di_formula_apply(f, place, pieces, xy, 2, &both[0])) {
        return false;
    }
    both[1] = se3di_formula_part(a, 2);
    *out = both[0];
    return se3di_formula_apply(f, place, pieces, both, 2, out);
}

static bool unit(se3di_formula *f, const char *place, const se3di_amount *a, se3di_amount *out)
{
    se3di_amount length;
    if (!norm(f, place, a, &length)) {
        return false;
    }
    if (!length.text[0] && !(length.v[0] > 1e-100)) {
        return se3di_formula_fail(f, place, "the unit vector of zero, must be a direction");
    }
    *out = *a;
    return se3di_formula_multiply(f, "/", out, &length);
}

static bool middle(se3di_formula *f, const se3di_amount *a, const se3di_amount *b,
                   se3di_amount *out)
{
    se3di_amount sum = *a;
    se3di_amount other = *b;
    se3di_amount half = {.rank = 1, .v = {0.5}};
    if (!se3di_formula_add(f, "+", &sum, &other) || !se3di_formula_multiply(f, "*", &sum, &half)) {
        return false;
    }
    *out = sum;
    return true;
}

/* The angle between: atan2(|a x b|, a . b). */
static bool angle_between(se3di_formula *f, const char *place, const se3di_amount *a,
                          const se3di_amount *b, se3di_amount *out)
{
    se3di_amount both[2];
    se3di_amount across;
    if (!cross(f, place, a, b, &across) || !norm(f, place, &across, &both[0]) ||
        !dot(f, place, a, b, &both[1])) {
        return false;
    }
    out->hard = true;
    out->dimension = angle;
    return se3di_formula_apply(f, place, (const char *[]){"atan2(", ",", ")"}, both, 2, out);
}

/* Turn v about the direction of n by phi: v cos + (e x v) sin + e (e . v) (1 - cos). */
static bool rotate(se3di_formula *f, const char *place, se3di_amount *a, se3di_amount *out)
{
    se3di_amount e;
    se3di_amount c = {.rank = 1};
    se3di_amount s = {.rank = 1};
    se3di_amount across;
    se3di_amount along;
    se3di_amount part;
    se3di_amount rest = {.rank = 1, .v = {1.0}};
    if (!ask(f, place, "rotate by", &a[2], angle) || !unit(f, place, &a[1], &e) ||
        !se3di_formula_apply(f, place, (const char *[]){"cos(", ",", ")"}, &a[2], 1, &c) ||
        !se3di_formula_apply(f, place, (const char *[]){"sin(", ",", ")"}, &a[2], 1, &s) ||
        !cross(f, place, &e, &a[0], &across) || !dot(f, place, &e, &a[0], &part)) {
        return false;
    }
    *out = a[0];
    along = e;
    se3di_amount again = c;
    return se3di_formula_multiply(f, "*", out, &c) && se3di_formula_multiply(f, "*", &across, &s) &&
           se3di_formula_add(f, "-", &rest, &again) &&
           se3di_formula_multiply(f, "*", &along, &part) &&
           se3di_formula_multiply(f, "*", &along, &rest) &&
           se3di_formula_add(f, "+", out, &across) && se3di_formula_add(f, "+", out, &along);
}

static const struct {
    const char *name;
    const char *signature;
    size_t count;
} vectors[] = {{"unit", "unit(a)", 1},      {"norm", "norm(a)", 1},
               {"dot", "dot(a, b)", 2},     {"cross", "cross(a, b)", 2},
               {"mid", "mid(a, b)", 2},     {"distance", "distance(a, b)", 2},
               {"angle", "angle(a, b)", 2}, {"rotate", "rotate(a, axis, angle)", 3}};

enum { UNIT, NORM, DOT, CROSS, MID, DISTANCE, ANGLE, ROTATE, VECTOR_FUNCTIONS };

static size_t find_vector_function(const char *name)
{
    size_t k = 0;
    while (k < VECTOR_FUNCTIONS && strcmp(vectors[k].name, name) != 0) {
        ++k;
    }
    return k;
}

bool se3di_formula_is_vector_function(const char *name)
{
    return find_vector_function(name) < VECTOR_FUNCTIONS;
}

static bool call_vector(se3di_formula *f, const char *place, size_t k, se3di_amount *a,
                        size_t count, se3di_amount *out)
{
    if (count != vectors[k].count) {
        return se3di_formula_fail(f, place, "%s takes %zu argument%s, found %zu",
                                  vectors[k].signature, vectors[k].count,
                                  vectors[k].count == 1 ? "" : "s", count);
    }
    for (size_t i = 0; i < count && i < 2; ++i) {
        if (a[i].rank != 3) {
            return se3di_formula_fail(f, place, "%s: argument %zu is a number, must be a vector",
                                      vectors[k].signature, i + 1);
        }
    }
    if (k == ROTATE && a[2].rank != 1) {
        return se3di_formula_fail(f, place, "%s: the angle is a vector, must be a number",
                                  vectors[k].signature);
    }
    se3di_amount apart = a[0];
    switch (k) {
    case UNIT:
        return unit(f, place, a, out);
    case NORM:
        return norm(f, place, a, out);
    case DOT:
        return dot(f, place, &a[0], &a[1], out);
    case CROSS:
        return cross(f, place, &a[0], &a[1], out);
    case MID:
        return middle(f, &a[0], &a[1], out);
    case DISTANCE:
        return se3di_formula_unify(f, place, &apart, &a[1]) &&
               se3di_formula_add(f, "-", &apart, &a[1]) && norm(f, place, &apart, out);
    case ANGLE:
        *out = (se3di_amount){.rank = 1};
        return angle_between(f, place, &a[0], &a[1], out);
    default:
        return rotate(f, place, a, out);
    }
}

bool se3di_formula_call(se3di_formula *f, const char *place, const char *name,
                        se3di_amount *arguments, size_t count, se3di_amount *out)
{
    char head[80];
    const size_t vector = find_vector_function(name);
    size_t row = 0;
    if (vector < VECTOR_FUNCTIONS) {
        return call_vector(f, place, vector, arguments, count, out);
    }
    for (size_t k = 0; k < count; ++k) {
        if (arguments[k].rank == 3) {
            return se3di_formula_fail(f, place, "%s of a vector, must be of a number", name);
        }
    }
    while (row < sizeof numbers / sizeof *numbers && strcmp(numbers[row].name, name) != 0) {
        ++row;
    }
    *out = (se3di_amount){.rank = 1};
    if (row < sizeof numbers / sizeof *numbers && !obey(f, place, row, arguments, count, out)) {
        return false;
    }
    snprintf(head, sizeof head, "%s(", name);
    return se3di_formula_apply(f, place, (const char *[]){head, ",", ")"}, arguments, count, out);
}
