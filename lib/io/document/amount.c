/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions with vectors and units. The grammar is that of lib/expression with
 *
 *     number = digits [unit]                      30 mm, 2 kN/m: no blanks inside a unit
 *     power  = primary {"." ("x" | "y" | "z")} ["^" unary]
 *     primary = ... | "[" sum "," sum "," sum "]"
 *
 * Constants are computed here, functions of numbers by the compiler of the core. What depends on
 * variables becomes the text of a function for that compiler. */
#include "io/document/amount.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/formula.h"
#include "io/document/guess.h"

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static size_t name_length(const char *text)
{
    size_t length = 0;
    while (is_letter(text[length]) || (length > 0 && is_digit(text[length]))) {
        ++length;
    }
    return length;
}

/* Length of the number at `text`, 0 if there is none. */
static size_t number_length(const char *text)
{
    size_t length = 0;
    size_t digits = 0;
    for (; is_digit(text[length]); ++length, ++digits) {
    }
    if (text[length] == '.') {
        for (++length; is_digit(text[length]); ++length, ++digits) {
        }
    }
    if (digits > 0 && (text[length] == 'e' || text[length] == 'E')) {
        const size_t sign = text[length + 1] == '+' || text[length + 1] == '-' ? 1 : 0;
        size_t end = length + 1 + sign;
        if (is_digit(text[end])) {
            while (is_digit(text[end])) {
                ++end;
            }
            length = end;
        }
    }
    return digits > 0 ? length : 0;
}

static size_t blanks_length(const char *text)
{
    size_t length = 0;
    while (is_blank(text[length])) {
        ++length;
    }
    return length;
}

const char *se3di_amount_next_name(const char *text, size_t *length)
{
    se3di_measure unit;
    for (const char *at = text; *at;) {
        const size_t number = number_length(at);
        const size_t name = name_length(at);
        if (number > 0) {
            at += number;
            at += blanks_length(at);
            at += is_letter(*at) ? se3di_unit_parse(at, true, &unit) : 0;
        } else if (name > 0) {
            *length = name;
            return at;
        } else {
            at += *at == '.' ? 1 + name_length(at + 1) : 1; /* .x of a point */
        }
    }
    return NULL;
}

/* Whether a name in a text makes it one for this file. */
static bool is_new_name(const se3di_reader *reader, const char *text, size_t length)
{
    char word[64];
    if (length >= sizeof word) {
        return false;
    }
    memcpy(word, text, length);
    word[length] = '\0';
    if (text[length + blanks_length(text + length)] == '(') {
        return se3di_formula_is_vector_function(word);
    }
    const se3di_amount *known = se3di_scope_find(reader->scope, word);
    return text[length] == '.' || (known && (known->hard || known->rank != 1));
}

bool se3di_amount_is_needed(const se3di_reader *reader, const char *text)
{
    const char *at = text;
    if (!reader->scope->units.are_si) {
        return true;
    }
    while (*at) {
        size_t length = number_length(at);
        if (length > 0) {
            at += length;
            at += blanks_length(at);
            if (is_letter(*at)) {
                return true; /* a unit, or a mistake that is best told as one */
            }
            continue;
        }
        length = name_length(at);
        if (length > 0 && is_new_name(reader, at, length)) {
            return true;
        }
        if (*at == '[' || (*at == ')' && at[1] == '.')) {
            return true;
        }
        at += length > 0 ? length : 1;
    }
    return false;
}

/* ---- the parser -----------------------------------------------------------------------------*/

static bool parse_comparison(se3di_formula *f, se3di_amount *out);
static bool parse_unary(se3di_formula *f, se3di_amount *out);

static void skip_blanks(se3di_formula *f)
{
    f->at += blanks_length(f->at);
}

static bool fail_unexpected(se3di_formula *f, const char *expected)
{
    if (!*f->at) {
        return se3di_formula_fail(f, f->at, "unexpected end of the text, expected %s", expected);
    }
    return se3di_formula_fail(f, f->at, "unexpected '%.1s', expected %s", f->at, expected);
}

static bool pass(se3di_formula *f, char mark, const char *expected)
{
    skip_blanks(f);
    if (*f->at != mark) {
        return fail_unexpected(f, expected);
    }
    ++f->at;
    return true;
}

static bool fail_unit(se3di_formula *f, size_t length)
{
    char word[64];
    se3di_guess guess;
    snprintf(word, sizeof word, "%.*s", (int)(length < 60 ? length : 60), f->at);
    guess = se3di_guess_begin(word);
    for (size_t k = 0; se3di_unit_word(k); ++k) {
        se3di_guess_offer(&guess, se3di_unit_word(k));
    }
    const char *meant = se3di_guess_get(&guess);
    return se3di_formula_fail(f, f->at,
                              "`%s` is no unit%s%s%s; allowed are m mm cm kg g s rad deg rpm Hz N "
                              "kN Pa MPa J W and others, as in 30 mm or 2 kN/m",
                              word, meant ? ", did you mean `" : "", meant ? meant : "",
                              meant ? "`?" : "");
}

/* A number with its unit, if it has one. */
static bool parse_number(se3di_formula *f, size_t length, se3di_amount *out)
{
    se3di_measure unit;
    double value = 0.0;
    if (!se3di_formula_number(f, f->at, length, &value)) {
        return false;
    }
    f->at += length;
    *out = (se3di_amount){.rank = 1, .v = {value}};
    const size_t blanks = blanks_length(f->at);
    const size_t word = name_length(f->at + blanks);
    if (word == 0) {
        return true;
    }
    f->at += blanks;
    const size_t used = se3di_unit_parse(f->at, true, &unit);
    if (used == 0) {
        return fail_unit(f, word);
    }
    if (is_letter(f->at[used]) || is_digit(f->at[used])) {
        return se3di_formula_fail(f, f->at + used, "is not expected behind a unit");
    }
    f->at += used;
    out->hard = !se3di_dimension_is_none(unit.dimension);
    out->dimension = unit.dimension;
    out->v[0] = value * unit.times / unit.over;
    return true;
}

static bool fail_name(se3di_formula *f, const char *start, const char *word)
{
    const se3di_scope *scope = f->reader->scope;
    se3di_guess guess = se3di_guess_begin(word);
    for (size_t k = 0; k < scope->count; ++k) {
        se3di_guess_offer(&guess, scope->list[k].name);
    }
    for (size_t k = 0; f->variables && f->variables[k]; ++k) {
        se3di_guess_offer(&guess, f->variables[k]);
    }
    const char *meant = se3di_guess_get(&guess);
    return se3di_formula_fail(f, start, "unknown name '%.60s'%s%s%s", word,
                              meant ? ", did you mean `"
                                    : "; allowed are parameters, points, pi, deg and functions",
                              meant ? meant : "", meant ? "`?" : "");
}

static bool parse_name(se3di_formula *f, const char *start, const char *word, se3di_amount *out)
{
    *out = (se3di_amount){.rank = 1};
    for (size_t k = 0; f->variables && f->variables[k]; ++k) {
        if (strcmp(f->variables[k], word) == 0) {
            return se3di_formula_variable(f, f->variables[k], out);
        }
    }
    const se3di_amount *known = se3di_scope_find(f->reader->scope, word);
    if (known) {
        *out = *known;
        return true;
    }
    if (strcmp(word, "deg") == 0) {
        se3di_measure unit;
        se3di_unit_parse("deg", false, &unit);
        out->hard = true;
        out->dimension = unit.dimension;
        return se3di_formula_number(f, "deg", 3, &out->v[0]);
    }
    if (strcmp(word, "pi") == 0) {
        return se3di_formula_number(f, "pi", 2, &out->v[0]);
    }
    return fail_name(f, start, word);
}

static bool parse_call(se3di_formula *f, const char *start, const char *word, se3di_amount *out)
{
    se3di_amount arguments[SE3DI_FORMULA_ARGUMENTS];
    size_t count = 0;
    ++f->at; /* ( */
    do {
        if (count == SE3DI_FORMULA_ARGUMENTS) {
            return se3di_formula_fail(f, start, "has more than %d arguments",
                                      (int)SE3DI_FORMULA_ARGUMENTS);
        }
        if (!parse_comparison(f, &arguments[count++])) {
            return false;
        }
        skip_blanks(f);
    } while (*f->at == ',' && *f->at++);
    return pass(f, ')', "an operator, ',' or ')'") &&
           se3di_formula_call(f, start, word, arguments, count, out);
}

/* [x, y, z] */
static bool parse_vector(se3di_formula *f, se3di_amount *out)
{
    const char *start = f->at++;
    se3di_amount part[3];
    for (size_t k = 0; k < 3; ++k) {
        if (!parse_comparison(f, &part[k]) ||
            !pass(f, k < 2 ? ',' : ']', k < 2 ? "',' and three numbers" : "']'")) {
            return false;
        }
        if (part[k].rank != 1) {
            return se3di_formula_fail(f, start, "a vector in a vector, expected 3 numbers");
        }
    }
    for (size_t round = 0; round < 2; ++round) {
        if (!se3di_formula_unify(f, start, &part[0], &part[1]) ||
            !se3di_formula_unify(f, start, &part[0], &part[2])) {
            return false;
        }
    }
    *out = part[0];
    out->rank = 3;
    for (size_t k = 0; k < 3; ++k) {
        out->v[k] = part[k].v[0];
        out->text[k] = part[k].text[0];
    }
    return true;
}

static bool parse_primary(se3di_formula *f, se3di_amount *out)
{
    const char *start = f->at;
    const size_t number = number_length(f->at);
    const size_t name = name_length(f->at);
    char word[64];
    if (number > 0) {
        return parse_number(f, number, out);
    }
    if (*f->at == '(') {
        ++f->at;
        return parse_comparison(f, out) && pass(f, ')', "an operator or ')'");
    }
    if (*f->at == '[') {
        return parse_vector(f, out);
    }
    if (name == 0) {
        return fail_unexpected(f, "a number, a name, a function, '(' or '['");
    }
    if (name >= sizeof word) {
        return se3di_formula_fail(f, start, "a name of %zu characters, at most 63 are allowed",
                                  name);
    }
    memcpy(word, start, name);
    word[name] = '\0';
    f->at += name;
    const size_t blanks = blanks_length(f->at);
    if (f->at[blanks] == '(') {
        f->at += blanks;
        return parse_call(f, start, word, out);
    }
    return parse_name(f, start, word, out);
}

/* .x .y .z */
static bool parse_component(se3di_formula *f, se3di_amount *q)
{
    while (*f->at == '.') {
        const char letter = f->at[1];
        const size_t k = letter == 'x' ? 0 : letter == 'y' ? 1 : letter == 'z' ? 2 : 3;
        if (k == 3 || name_length(f->at + 1) != 1) {
            return se3di_formula_fail(f, f->at, "unexpected '.', expected .x, .y or .z of a point");
        }
        if (q->rank != 3) {
            return se3di_formula_fail(f, f->at,
                                      "what stands before .%c is a number, must be a "
                                      "point or vector",
                                      letter);
        }
        q->rank = 1;
        q->v[0] = q->v[k];
        q->text[0] = q->text[k];
        q->text[1] = q->text[2] = NULL;
        f->at += 2;
    }
    return true;
}

static bool parse_power(se3di_formula *f, se3di_amount *out)
{
    if (!parse_primary(f, out) || !parse_component(f, out)) {
        return false;
    }
    skip_blanks(f);
    const char *mark = f->at;
    se3di_amount exponent;
    if (*mark != '^') {
        return true;
    }
    ++f->at;
    return parse_unary(f, &exponent) && se3di_formula_power(f, mark, out, &exponent);
}

static bool parse_unary(se3di_formula *f, se3di_amount *out)
{
    skip_blanks(f);
    const char mark = *f->at;
    if (++f->depth > SE3D_EXPRESSION_DEPTH_MAX) {
        return se3di_formula_fail(f, f->at, "nested too deeply, at most %d levels are allowed",
                                  SE3D_EXPRESSION_DEPTH_MAX);
    }
    bool good = true;
    if (mark == '+' || mark == '-') {
        ++f->at;
        good = parse_unary(f, out) && (mark == '+' || se3di_formula_negate(f, out));
    } else {
        good = parse_power(f, out);
    }
    --f->depth;
    skip_blanks(f);
    return good;
}

static bool parse_product(se3di_formula *f, se3di_amount *out)
{
    bool good = parse_unary(f, out);
    while (good && (*f->at == '*' || *f->at == '/')) {
        const char *mark = f->at++;
        se3di_amount b;
        good = parse_unary(f, &b) && se3di_formula_multiply(f, mark, out, &b);
    }
    return good;
}

static bool parse_sum(se3di_formula *f, se3di_amount *out)
{
    bool good = parse_product(f, out);
    while (good && (*f->at == '+' || *f->at == '-')) {
        const char *mark = f->at++;
        se3di_amount b;
        good = parse_product(f, &b) && se3di_formula_add(f, mark, out, &b);
    }
    return good;
}

static bool parse_comparison(se3di_formula *f, se3di_amount *out)
{
    if (!parse_sum(f, out)) {
        return false;
    }
    const char *mark = f->at;
    const bool first = *mark == '<' || *mark == '>';
    if (!first && !((*mark == '=' || *mark == '!') && mark[1] == '=')) {
        return true;
    }
    se3di_amount b;
    f->at += mark[1] == '=' ? 2 : 1;
    return parse_sum(f, &b) && se3di_formula_compare(f, mark, (size_t)(f->at - mark), out, &b);
}

bool se3di_amount_eval(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                       se3di_amount *result)
{
    se3di_formula f = {.reader = reader,
                       .node = node,
                       .text = node->text,
                       .at = node->text,
                       .variables = variables};
    if (strlen(node->text) > SE3D_EXPRESSION_TEXT_MAX) {
        return se3di_formula_fail(&f, node->text, "the text is longer than %d characters",
                                  SE3D_EXPRESSION_TEXT_MAX);
    }
    if (!parse_comparison(&f, result)) {
        return false;
    }
    skip_blanks(&f);
    return !*f.at || fail_unexpected(&f, "an operator or the end");
}

/* ---- what keys ask for ----------------------------------------------------------------------*/

/* The n-th of "a, b, c" up to ']', the last one if there are fewer. */
static bool parse_alternative(const char *list, int n, se3di_measure *unit)
{
    const char *at = list;
    for (int k = 0; k < n; ++k) {
        const size_t length = strcspn(at, ",]");
        if (at[length] != ',') {
            break;
        }
        at += length + 1;
        at += *at == ' ';
    }
    if (at[0] == '1' && (at[1] == ',' || at[1] == ']')) {
        *unit = (se3di_measure){{0, 0, 0, 0}, 1.0, 1.0};
        return true;
    }
    const size_t length = se3di_unit_parse(at, true, unit);
    return length > 0 && (at[length] == ',' || at[length] == ']');
}

const se3di_key *se3di_amount_find_key(const se3di_node *node)
{
    const se3di_key *row = NULL;
    for (; node && !row; node = node->parent) {
        row = node->row;
    }
    return row;
}

bool se3di_amount_find_unit(const se3di_key *row, int alternative, se3di_measure *unit)
{
    const char *list = row->text ? strchr(row->text, '[') : NULL;
    if (list && parse_alternative(list + 1, alternative, unit)) {
        return true;
    }
    *unit = (se3di_measure){{0, 0, 0, 0}, 1.0, 1.0};
    return !list && (row->kind == SE3DI_KIND_NUMBER || row->kind == SE3DI_KIND_COUNT);
}

/* What the key of `node` asks for. @return false: anything. */
static bool find_wanted(const se3di_reader *reader, const se3di_node *node, se3di_measure *unit)
{
    const se3di_key *row = se3di_amount_find_key(node);
    return row && reader->alternative >= 0 &&
           se3di_amount_find_unit(row, reader->alternative, unit);
}

/* In a unit, from what has none in that of the file. */
static bool take_unit(se3di_reader *reader, const se3di_node *node, const se3di_measure *unit,
                      se3di_amount *q)
{
    se3di_formula f = {.reader = reader, .node = node, .text = node->text, .at = node->text};
    if (!q->hard) {
        const se3di_measure file = se3di_units_of(&reader->scope->units, unit->dimension);
        return se3di_formula_scale(&f, q, file.times, file.over);
    }
    if (!se3di_dimension_fits(q->dimension, unit->dimension)) {
        char is[80];
        char must[80];
        se3di_dimension_describe(q->dimension, is, sizeof is);
        se3di_dimension_describe(unit->dimension, must, sizeof must);
        return se3di_reader_fail(reader, node, "`%.120s` is %s, must be %s", node->text, is, must);
    }
    return se3di_formula_scale(&f, q, unit->over, unit->times);
}

bool se3di_amount_take(se3di_reader *reader, const se3di_node *node, const se3di_node *key,
                       se3di_amount *q)
{
    se3di_measure unit;
    return !find_wanted(reader, key, &unit) || take_unit(reader, node, &unit, q);
}

bool se3di_amount_take_plain(se3di_reader *reader, const se3di_node *node, se3di_amount *q)
{
    const se3di_measure unit = {q->dimension, 1.0, 1.0};
    return take_unit(reader, node, &unit, q);
}

bool se3di_amount_take_variable(se3di_reader *reader, const se3di_node *node, const char *variable,
                                se3di_amount *q)
{
    const se3di_dimension d = se3di_formula_variable_dimension(reader, variable);
    const se3di_measure unit = {d, 1.0, 1.0};
    return take_unit(reader, node, &unit, q);
}
