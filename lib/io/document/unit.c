/* SPDX-License-Identifier: BSD-3-Clause */
/* Units and dimensions. */
#include "io/document/unit.h"

#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { EXPONENT_MAX = 20, FACTORS_MAX = 12 };

typedef struct unit_row {
    const char *word;
    const char *name; /* of what is measured in it; NULL: another row has it */
    se3di_measure unit;
} unit_row;

/* clang-format off */
#define LENGTH   {1, 0, 0, 0}
#define MASS     {0, 1, 0, 0}
#define TIME     {0, 0, 1, 0}
#define ANGLE    {0, 0, 0, 1}
#define RATE     {0, 0, -1, 1}
#define FORCE    {1, 1, -2, 0}
#define ENERGY   {2, 1, -2, 0}
#define POWER    {2, 1, -3, 0}
#define PRESSURE {-1, 1, -2, 0}
static const unit_row rows[] = {
    {"m", "a length", {LENGTH, 1.0, 1.0}},   {"km", NULL, {LENGTH, 1e3, 1.0}},
    {"cm", NULL, {LENGTH, 1.0, 100.0}},      {"mm", NULL, {LENGTH, 1.0, 1e3}},
    {"um", NULL, {LENGTH, 1.0, 1e6}},        {"inch", NULL, {LENGTH, 254.0, 1e4}},
    {"ft", NULL, {LENGTH, 3048.0, 1e4}},
    {"kg", "a mass", {MASS, 1.0, 1.0}},      {"g", NULL, {MASS, 1.0, 1e3}},
    {"mg", NULL, {MASS, 1.0, 1e6}},          {"tonne", NULL, {MASS, 1e3, 1.0}},
    {"lb", NULL, {MASS, 45359237.0, 1e8}},
    {"s", "a time", {TIME, 1.0, 1.0}},       {"ms", NULL, {TIME, 1.0, 1e3}},
    {"us", NULL, {TIME, 1.0, 1e6}},          {"min", NULL, {TIME, 60.0, 1.0}},
    {"h", NULL, {TIME, 3600.0, 1.0}},
    {"rad", "an angle", {ANGLE, 1.0, 1.0}},  {"mrad", NULL, {ANGLE, 1.0, 1e3}},
    {"deg", NULL, {ANGLE, PI, 180.0}},       {"rev", NULL, {ANGLE, 2.0 * PI, 1.0}},
    {"rpm", NULL, {RATE, PI, 30.0}},         {"Hz", NULL, {RATE, 2.0 * PI, 1.0}},
    {"kHz", NULL, {RATE, 2000.0 * PI, 1.0}},
    {"N", "a force", {FORCE, 1.0, 1.0}},     {"mN", NULL, {FORCE, 1.0, 1e3}},
    {"kN", NULL, {FORCE, 1e3, 1.0}},         {"MN", NULL, {FORCE, 1e6, 1.0}},
    {"lbf", NULL, {FORCE, 4.4482216152605, 1.0}},
    {"J", NULL, {ENERGY, 1.0, 1.0}},         {"kJ", NULL, {ENERGY, 1e3, 1.0}},
    {"W", "a power", {POWER, 1.0, 1.0}},     {"kW", NULL, {POWER, 1e3, 1.0}},
    {"Pa", "a pressure", {PRESSURE, 1.0, 1.0}}, {"kPa", NULL, {PRESSURE, 1e3, 1.0}},
    {"MPa", NULL, {PRESSURE, 1e6, 1.0}},     {"GPa", NULL, {PRESSURE, 1e9, 1.0}}};

/* Dimensions without a word of their own. */
static const struct {
    se3di_dimension dimension;
    const char *text;
} composed[] = {{{0, 0, 0, 0}, "a number"},
                {{2, 0, 0, 0}, "an area [m^2]"},
                {{3, 0, 0, 0}, "a volume [m^3]"},
                {{1, 0, -1, 0}, "a velocity [m/s]"},
                {{1, 0, -2, 0}, "an acceleration [m/s^2]"},
                {RATE, "an angular velocity [rad/s]"},
                {{0, 0, -2, 1}, "an angular acceleration [rad/s^2]"},
                {{0, 0, -1, 0}, "a rate [1/s]"},
                {ENERGY, "a torque or energy [N m]"},
                {{2, 1, -2, -1}, "a torsional stiffness [N m/rad]"},
                {{0, 1, -2, 0}, "a stiffness [N/m]"},
                {{0, 1, -1, 0}, "a damping [N s/m]"},
                {{2, 1, -1, -1}, "a torsional damping [N m s/rad]"},
                {{2, 1, 0, 0}, "a moment of inertia [kg m^2]"},
                {{-3, 1, 0, 0}, "a density [kg/m^3]"}};
/* clang-format on */

se3di_units se3di_units_si(void)
{
    const se3di_units units = {{LENGTH, 1.0, 1.0}, {MASS, 1.0, 1.0},  {TIME, 1.0, 1.0},
                               {ANGLE, 1.0, 1.0},  {FORCE, 1.0, 1.0}, true};
    return units;
}

/* Multiply a unit by a power of another one. */
static bool multiply(se3di_measure *unit, const se3di_measure *by, int exponent)
{
    const int count = exponent < 0 ? -exponent : exponent;
    for (int k = 0; k < count; ++k) {
        unit->times *= exponent > 0 ? by->times : by->over;
        unit->over *= exponent > 0 ? by->over : by->times;
    }
    return se3di_dimension_add(unit->dimension, by->dimension, exponent, &unit->dimension);
}

se3di_measure se3di_units_of(const se3di_units *units, se3di_dimension d)
{
    se3di_measure unit = {{0, 0, 0, 0}, 1.0, 1.0};
    if (units->are_si) {
        unit.dimension = d;
        return unit;
    }
    /* M^a T^b with b < 0 is F^a L^-a T^(b + 2a): a stiffness [N/m] and so on. */
    const int force = d.mass != 0 && (d.mass > 0) == (d.time < 0) && d.time != 0 ? d.mass : 0;
    multiply(&unit, &units->force, force);
    multiply(&unit, &units->mass, d.mass - force);
    multiply(&unit, &units->length, d.length - force);
    multiply(&unit, &units->time, d.time + 2 * force);
    multiply(&unit, &units->angle, d.angle);
    unit.dimension = d;
    return unit;
}

static size_t word_length(const char *text)
{
    size_t length = 0;
    while ((text[length] >= 'a' && text[length] <= 'z') ||
           (text[length] >= 'A' && text[length] <= 'Z') ||
           (length > 0 && (text[length] == '_' || (text[length] >= '0' && text[length] <= '9')))) {
        ++length;
    }
    return length;
}

static const se3di_measure *find_word(const char *text, size_t length)
{
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        if (strlen(rows[k].word) == length && strncmp(rows[k].word, text, length) == 0) {
            return &rows[k].unit;
        }
    }
    return NULL;
}

/* A word with its exponent, "m^2", and no function, "min(". @return the length, 0 if it is none. */
static size_t parse_factor(const char *text, int sign, se3di_measure *unit)
{
    size_t length = word_length(text);
    const se3di_measure *word = find_word(text, length);
    int exponent = 1;
    if (!word || text[length] == '(') {
        return 0;
    }
    if (text[length] == '^' && text[length + 1] >= '1' && text[length + 1] <= '9' &&
        !(text[length + 2] >= '0' && text[length + 2] <= '9')) {
        exponent = text[length + 1] - '0';
        length += 2;
    }
    return multiply(unit, word, sign * exponent) ? length : 0;
}

size_t se3di_unit_parse(const char *text, bool blanks, se3di_measure *unit)
{
    const bool over = blanks && strncmp(text, "1/", 2) == 0;
    size_t used = over ? 1 : 0;
    *unit = (se3di_measure){{0, 0, 0, 0}, 1.0, 1.0};
    if (!over) {
        used = parse_factor(text, 1, unit);
    }
    for (int k = 0; used > 0 && k < FACTORS_MAX; ++k) {
        const char mark = text[used];
        if (mark != '*' && mark != '/' && !(blanks && mark == ' ')) {
            break;
        }
        const size_t length = parse_factor(text + used + 1, mark == '/' ? -1 : 1, unit);
        if (length == 0) {
            break; /* it goes on with something else */
        }
        used += 1 + length;
    }
    return used;
}

const char *se3di_unit_word(size_t k)
{
    return k < sizeof rows / sizeof *rows ? rows[k].word : NULL;
}

bool se3di_dimension_is_none(se3di_dimension d)
{
    return d.length == 0 && d.mass == 0 && d.time == 0 && d.angle == 0;
}

bool se3di_dimension_fits(se3di_dimension a, se3di_dimension b)
{
    const bool bare = a.length == 0 && a.mass == 0 && a.time == 0;
    return a.length == b.length && a.mass == b.mass && a.time == b.time &&
           (!bare || a.angle == b.angle);
}

static bool add(int8_t a, int8_t b, int factor, int8_t *sum)
{
    const int value = a + factor * b;
    *sum = (int8_t)value;
    return value >= -EXPONENT_MAX && value <= EXPONENT_MAX;
}

bool se3di_dimension_add(se3di_dimension a, se3di_dimension b, int factor, se3di_dimension *sum)
{
    se3di_dimension d;
    const bool good =
        factor >= -EXPONENT_MAX && factor <= EXPONENT_MAX &&
        add(a.length, b.length, factor, &d.length) && add(a.mass, b.mass, factor, &d.mass) &&
        add(a.time, b.time, factor, &d.time) && add(a.angle, b.angle, factor, &d.angle);
    if (good) {
        *sum = d;
    }
    return good;
}

static bool is_same(se3di_dimension a, se3di_dimension b)
{
    return a.length == b.length && a.mass == b.mass && a.time == b.time && a.angle == b.angle;
}

void se3di_dimension_describe(se3di_dimension d, char *text, size_t size)
{
    static const char *const words[] = {"m", "kg", "s", "rad"};
    const int exponents[] = {d.length, d.mass, d.time, d.angle};
    for (size_t k = 0; k < sizeof composed / sizeof *composed; ++k) {
        if (is_same(d, composed[k].dimension)) {
            snprintf(text, size, "%s", composed[k].text);
            return;
        }
    }
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        if (rows[k].name && is_same(d, rows[k].unit.dimension)) {
            snprintf(text, size, "%s [%s]", rows[k].name, rows[k].word);
            return;
        }
    }
    size_t used = (size_t)snprintf(text, size, "a quantity [");
    for (size_t k = 0; k < 4; ++k) {
        if (exponents[k] != 0 && used < size) {
            used +=
                (size_t)snprintf(text + used, size - used, exponents[k] == 1 ? "%s%s" : "%s%s^%d",
                                 text[used - 1] == '[' ? "" : " ", words[k], exponents[k]);
        }
    }
    if (used < size) {
        snprintf(text + used, size - used, "]");
    }
}
