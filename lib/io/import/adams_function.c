/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions of Adams as expressions of a model file. Operators are the same but for **; calls are
 * taken apart, and what they mean is written with ours. The units of the file are taken away where
 * a quantity enters: TIME is t over the unit of time. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/import/adams.h"
#include "io/import/scan.h"
#include "se3d/expression.h"

enum { TEXT_MAX = 3800, DEPTH_MAX = 40, ARGUMENTS_MAX = 40 };

typedef struct translator {
    se3di_adams *a;
    const se3di_adams_meaning *meaning;
    const char *why;
    int depth;
    size_t work; /* characters that were read, of all depths */
} translator;

static const char *translate(translator *t, const char *text);

static const char *give_up(translator *t, const char *why)
{
    t->why = t->why ? t->why : why;
    return NULL;
}

typedef struct call {
    const char *name;               /* in capitals */
    const char *own[ARGUMENTS_MAX]; /* as they stand */
    const char *in[ARGUMENTS_MAX];  /* translated */
    size_t count;
} call;

/* What is written of a call: $1 $2 ... are its arguments. */
typedef struct rule {
    const char *name;
    size_t count;
    const char *text;
} rule;

static const rule rules[] = {
    {"ABS", 1, "abs($1)"},
    {"ACOS", 1, "acos($1)"},
    {"ASIN", 1, "asin($1)"},
    {"ATAN", 1, "atan($1)"},
    {"ATAN2", 2, "atan2($1, $2)"},
    {"AINT", 1, "(sign($1)*floor(abs($1)))"},
    {"ANINT", 1, "round($1)"},
    {"COS", 1, "cos($1)"},
    {"COSH", 1, "cosh($1)"},
    {"DIM", 2, "max(($1) - ($2), 0)"},
    {"EXP", 1, "exp($1)"},
    {"LOG", 1, "log($1)"},
    {"LOG10", 1, "log10($1)"},
    {"MOD", 2, "(sign($1)*mod(abs($1), abs($2)))"},
    {"SIGN", 2, "(abs($1)*if(($2) < 0, -1, 1))"},
    {"SIN", 1, "sin($1)"},
    {"SINH", 1, "sinh($1)"},
    {"SQRT", 1, "sqrt($1)"},
    {"TAN", 1, "tan($1)"},
    {"TANH", 1, "tanh($1)"},
    {"IF", 4, "if(($1) < 0, $2, if(($1) == 0, $3, $4))"},
    {"STEP", 5, "step($1, $2, $3, $4, $5)"},
    {"STEP5", 5,
     "(($3) + (($5) - ($3))*min(max((($1) - ($2))/(($4) - ($2)), 0), 1)^3*(10 - 15*min(max((($1) - "
     "($2))/(($4) - ($2)), 0), 1) + 6*min(max((($1) - ($2))/(($4) - ($2)), 0), 1)^2))"},
    {"HAVSIN", 5,
     "(($3) + (($5) - ($3))*(1 - cos(pi*min(max((($1) - ($2))/(($4) - ($2)), 0), 1)))/2)"},
    {"SHF", 6, "(($3)*sin(($4)*(($1) - ($2)) - ($5)) + ($6))"},
    {"IMPACT", 7,
     "if(($1) < ($3), max(0, ($4)*(($3) - ($1))^($5) - ($6)*($2)*step($1, ($3) - ($7), 1, $3, 0)), "
     "0)"},
    {"BISTOP", 8,
     "(if(($1) < ($3), max(0, ($5)*(($3) - ($1))^($6) - ($7)*($2)*step($1, ($3) - ($8), 1, $3, "
     "0)), "
     "0) + if(($1) > ($4), min(0, -($5)*(($1) - ($4))^($6) - ($7)*($2)*step($1, $4, 0, ($4) + "
     "($8), "
     "1)), 0))"},
};

static const char *apply(translator *t, const char *pattern, const call *c)
{
    char out[TEXT_MAX];
    size_t used = 0;
    for (const char *p = pattern; *p; ++p) {
        const bool is_argument = p[0] == '$';
        const char *put = is_argument ? c->in[p[1] - '1'] : p;
        const size_t length = is_argument ? strlen(put) : 1;
        if (used + length >= sizeof out) {
            return give_up(t, "it is too long");
        }
        memcpy(out + used, put, length);
        used += length;
        p += is_argument;
    }
    out[used] = '\0';
    return se3di_machine_text(t->a->m, "%s", out);
}

/* Sums over the arguments from the third on: POLY, FORSIN, FORCOS. */
static const char *series(translator *t, const call *c)
{
    const bool is_poly = strcmp(c->name, "POLY") == 0;
    const bool is_sine = strcmp(c->name, "FORSIN") == 0;
    const size_t first = is_poly ? 2 : 3;
    const char *sum = c->count > first ? se3di_machine_text(t->a->m, "(%s", c->in[first]) : NULL;
    for (size_t k = first + 1; sum && k < c->count; ++k) {
        const size_t n = k - first;
        sum = is_poly ? se3di_machine_text(t->a->m, "%s + (%s)*((%s) - (%s))^%zu", sum, c->in[k],
                                           c->in[0], c->in[1], n)
                      : se3di_machine_text(t->a->m, "%s + (%s)*%s(%zu*(%s)*((%s) - (%s)))", sum,
                                           c->in[k], is_sine ? "sin" : "cos", n, c->in[2], c->in[0],
                                           c->in[1]);
        if (sum && strlen(sum) > TEXT_MAX) {
            return give_up(t, "it is too long");
        }
    }
    return sum ? se3di_machine_text(t->a->m, "%s)", sum) : give_up(t, "it has too few arguments");
}

/* The same place: markers that coincide at the start on one body may stand for each other. */
static bool is_same(const translator *t, const char *text, long id, bool axes)
{
    double value = 0.0;
    const size_t length = se3di_scan_number(text, false, &value);
    const se3di_adams_marker *a = length > 0 && !text[length] && value >= 0.0 && value < 1e9
                                      ? se3di_adams_marker_at(t->a, (long)value)
                                      : NULL;
    const se3di_adams_marker *b = se3di_adams_marker_at(t->a, id);
    if (!a || !b || a == b) {
        return a != NULL && a == b;
    }
    double far = se3di_distance(a->frame.r, b->frame.r);
    for (int k = 0; axes && k < 9; ++k) {
        const double d = a->frame.A[k] - b->frame.A[k];
        far += d < 0.0 ? -d : d;
    }
    return a->body == b->body && far < 1e-12;
}

/* Quantities between the two markers of a force. */
static const char *measure(translator *t, const call *c)
{
    const se3di_adams_meaning *m = t->meaning;
    const char *name = c->name;
    const bool linear = strcmp(name, "DM") == 0 || strcmp(name, "VR") == 0;
    const bool first = strcmp(name, "DM") == 0 || strcmp(name, "AZ") == 0;
    const char *word = strcmp(name, "DM") == 0   ? m->distance
                       : strcmp(name, "VR") == 0 ? m->speed
                       : strcmp(name, "AZ") == 0 ? m->angle
                       : strcmp(name, "WZ") == 0 ? m->turning
                                                 : NULL;
    if (!word || m->i < 0 || c->count < 2) {
        return give_up(
            t, se3di_machine_text(t->a->m, "%s, which is no quantity between its markers", name));
    }
    const bool forth = is_same(t, c->own[0], m->i, !linear) && is_same(t, c->own[1], m->j, !linear);
    const bool back = is_same(t, c->own[0], m->j, !linear) && is_same(t, c->own[1], m->i, !linear);
    if (!forth && !back) {
        return give_up(t, se3di_machine_text(t->a->m, "%s of other markers", name));
    }
    const char *sign = back && !linear ? "-" : "";
    const double unit = (linear ? t->a->length : 1.0) / (first ? 1.0 : t->a->time);
    return unit == 1.0 ? se3di_machine_text(t->a->m, "(%s%s)", sign, word)
                       : se3di_machine_text(t->a->m, "(%s%s/%.15g)", sign, word, unit);
}

/* The function of a VARIABLE in the place of its value. */
static const char *variable(translator *t, const call *c)
{
    double id = -1.0;
    const size_t length = c->count == 1 ? se3di_scan_number(c->own[0], false, &id) : 0;
    const se3di_adams_statement *s =
        length > 0 && id >= 0.0 && id < 1e9 ? se3di_adams_find(t->a, "VARIABLE", (long)id) : NULL;
    const char *text = s ? se3di_adams_get(s, "FUNCTION") : NULL;
    const char *in = text ? translate(t, text) : NULL;
    return in ? se3di_machine_text(t->a->m, "(%s)", in) : give_up(t, "VARVAL of no function");
}

static const char *put_call(translator *t, const call *c)
{
    for (size_t k = 0; k < sizeof rules / sizeof *rules; ++k) {
        if (strcmp(rules[k].name, c->name) == 0) {
            return c->count == rules[k].count ? apply(t, rules[k].text, c)
                                              : give_up(t, "a call with other arguments");
        }
    }
    if ((strcmp(c->name, "MIN") == 0 || strcmp(c->name, "MAX") == 0) && c->count == 2) {
        return apply(t, c->name[1] == 'I' ? "min($1, $2)" : "max($1, $2)", c);
    }
    if (strcmp(c->name, "POLY") == 0 || strcmp(c->name, "FORSIN") == 0 ||
        strcmp(c->name, "FORCOS") == 0) {
        return series(t, c);
    }
    if (strcmp(c->name, "VARVAL") == 0) {
        return variable(t, c);
    }
    return measure(t, c);
}

/* Whether the arguments are numbers of elements, which are not translated. */
static bool takes_numbers(const char *name)
{
    static const char *const names[] = {"DM", "VR", "AZ", "WZ", "VARVAL"};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        if (strcmp(names[k], name) == 0) {
            return true;
        }
    }
    return false;
}

static bool add_argument(translator *t, call *c, const char *start, size_t length)
{
    while (length > 0 && strchr(" \t", start[length - 1])) {
        --length;
    }
    while (length > 0 && strchr(" \t", *start)) {
        ++start;
        --length;
    }
    char *own = se3di_iopool_copy(t->a->m->pool, start, length);
    if (!own || c->count == ARGUMENTS_MAX) {
        give_up(t, "a call with too many arguments");
        return false;
    }
    c->own[c->count] = own;
    c->in[c->count] = takes_numbers(c->name) || !*own ? own : translate(t, own);
    return c->in[c->count++] != NULL;
}

/* The arguments of a call that begins at `open`, an opening bracket. @return behind it, NULL. */
static const char *read_arguments(translator *t, const char *open, call *c)
{
    const char *start = open + 1;
    int depth = 0;
    for (const char *at = open; *at; ++at) {
        depth += *at == '(' ? 1 : *at == ')' ? -1 : 0;
        const bool ends = *at == ')' && depth == 0;
        if (ends || ((*at == ',' || *at == ':') && depth == 1)) {
            if (!add_argument(t, c, start, (size_t)(at - start))) {
                return NULL;
            }
            start = at + 1;
        }
        if (ends) {
            return at + 1;
        }
    }
    return give_up(t, "a bracket that is not closed");
}

static const char *put_name(translator *t, const char *name)
{
    const double unit = t->a->time;
    if (strcmp(name, "TIME") == 0) {
        return unit == 1.0 ? "t" : se3di_machine_text(t->a->m, "(t/%.15g)", unit);
    }
    return strcmp(name, "PI") == 0     ? "pi"
           : strcmp(name, "DTOR") == 0 ? "(pi/180)"
           : strcmp(name, "RTOD") == 0 ? "(180/pi)"
                                       : give_up(t, se3di_machine_text(t->a->m, "%s", name));
}

/* A name, with its call if it is one. @return behind it, NULL. */
static const char *read_word(translator *t, const char *text, const char **put)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
    char name[24];
    const size_t length = strspn(text, letters);
    if (length >= sizeof name) {
        give_up(t, "a name that is not known");
        return NULL;
    }
    for (size_t k = 0; k < length; ++k) {
        name[k] = (char)(text[k] >= 'a' && text[k] <= 'z' ? text[k] - 'a' + 'A' : text[k]);
    }
    name[length] = '\0';
    const char *after = text + length + strspn(text + length, " \t");
    if (*after != '(') {
        *put = put_name(t, name);
        return *put ? text + length : NULL;
    }
    call *c = se3di_iopool_alloc(t->a->m->pool, sizeof *c);
    if (!c) {
        se3di_machine_fail_memory(t->a->m);
        return NULL;
    }
    c->name = name;
    after = read_arguments(t, after, c);
    *put = after ? put_call(t, c) : NULL;
    return *put ? after : NULL;
}

static size_t read_number(translator *t, const char *text, const char **put)
{
    double value = 0.0;
    size_t length = se3di_scan_number(text, true, &value);
    if (length == 0) {
        return 0;
    }
    const bool degrees = text[length] == 'd' || text[length] == 'D';
    *put = degrees ? se3di_machine_text(t->a->m, "%.15g*pi/180", value)
                   : se3di_machine_number(t->a->m, value);
    return *put ? length + degrees : 0;
}

static const char *translate(translator *t, const char *text)
{
    char out[TEXT_MAX];
    size_t used = 0;
    t->work += strlen(text);
    if (++t->depth > DEPTH_MAX || t->work > 200000) {
        return give_up(t, "it is nested too deep");
    }
    for (const char *at = text; *at;) {
        const char *put = NULL;
        char one[2] = {*at, '\0'};
        if (strchr("0123456789.", *at)) {
            const size_t length = read_number(t, at, &put);
            at += length > 0 ? length : strlen(at);
        } else if ((*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z')) {
            at = read_word(t, at, &put);
        } else if (at[0] == '*' && at[1] == '*') {
            put = "^";
            at += 2;
        } else if (strchr("+-*/()", *at) || *at == ' ' || *at == '\t') {
            put = one[0] == '\t' ? " " : one;
            ++at;
        }
        const size_t length = put ? strlen(put) : 0;
        if (!put || used + length >= sizeof out) {
            return give_up(t, put ? "it is too long" : "a sign that is not known");
        }
        memcpy(out + used, put, length);
        used += length;
    }
    out[used] = '\0';
    --t->depth;
    return se3di_machine_text(t->a->m, "%s", out);
}

/* Whether a model file takes it, also with a unit and brackets around it. */
static bool is_expression(translator *t, const char *text)
{
    se3di_machine *m = t->a->m;
    const se3di_adams_meaning *of = t->meaning;
    const char *const known[] = {of->distance, of->speed, of->angle, of->turning};
    const char *names[5] = {"t"};
    const double x[5] = {0.0};
    size_t count = 1;
    double value = 0.0;
    se3d_expression *made = NULL;
    se3d_expression_error error;
    se3d_expression_def def = se3d_expression_def_default();
    for (size_t k = 0; k < 4; ++k) {
        if (known[k]) {
            names[count++] = known[k];
        }
    }
    def.text = se3di_machine_text(m, "-1.00000000000000e+00*((%s)*t)", text);
    def.variables = names;
    def.variable_count = count;
    def.allocator = m->options->allocator;
    se3d_status status =
        def.text ? se3d_expression_create(&def, &made, &error) : SE3D_ERR_NO_MEMORY;
    se3d_expression_destroy(made);
    if (status >= 0) { /* without the time a constant shows */
        def.text = text;
        status = se3d_expression_create(&def, &made, &error);
    }
    if (status >= 0 && se3d_expression_is_constant(made)) {
        se3d_expression_eval(made, x, &value);
    }
    if (status >= 0) {
        se3d_expression_destroy(made);
    }
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_machine_fail_memory(m);
    }
    if (status < 0 || !(fabs(value) <= 1e30)) {
        give_up(t, status < 0 ? se3di_machine_text(m, "its function: %s", error.message)
                              : "its function is larger than 1e30");
        return false;
    }
    return true;
}

const char *se3di_adams_translate(se3di_adams *a, const char *text,
                                  const se3di_adams_meaning *meaning, const char **why)
{
    translator t = {.a = a, .meaning = meaning};
    const char *out = translate(&t, text);
    out = out && is_expression(&t, out) ? out : NULL;
    *why = out ? NULL : t.why ? t.why : "no memory";
    return out;
}
