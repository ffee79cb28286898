/* SPDX-License-Identifier: BSD-3-Clause */
/* The statements of an Adams data set: WORD/id, KEY = values, ... A line that begins with a comma,
 * or follows one that ends with &, continues the one before; ! begins a comment. */
#include <stdio.h>
#include <string.h>

#include "io/import/adams.h"
#include "io/import/scan.h"

enum { STATEMENT_MAX = 65536, STATEMENTS_MAX = 200000 };

#define DEGREE (3.14159265358979323846 / 180.0)

static const char *const words[] = {
    "PART",       "MARKER",     "JOINT",       "JPRIM",   "MOTION",      "SPRINGDAMPER", "BUSHING",
    "SFORCE",     "GFORCE",     "VFORCE",      "VTORQUE", "GEAR",        "COUPLER",      "ACCGRAV",
    "UNITS",      "REQUEST",    "GRAPHICS",    "GCON",    "VARIABLE",    "OUTPUT",       "RESULTS",
    "INTEGRATOR", "KINEMATICS", "EQUILIBRIUM", "DEBUG",   "PREFERENCES", "LSE",          "LINEAR",
    "LIST",       "IC",         "DYNAMICS",    "SENSOR",  "FRICTION",    "FIELD",        "BEAM",
    "CONTACT",    "SPLINE",     "ARRAY",       "STRING",  "MATRIX",      "DIFF",         "TFSISO",
    "CVCV",       "PTCV",       "CURVE",       "SURFACE", "POINT_MASS",  "FLEX_BODY",    "UCON",
    "NFORCE",     "GSE",        "PINPUT",      "POUTPUT", "PLANT",       "TIRE",         "DATA",
    "FE_PART",    "EXECUTION",  "END"};

typedef struct lines {
    se3di_adams *a;
    char *text; /* of the statement, [STATEMENT_MAX] */
    size_t used;
    size_t line;     /* where it began */
    int depth;       /* of brackets */
    bool more;       /* it ended with & */
    char name[101];  /* of the statement */
    char ahead[101]; /* in a comment since it began: that of the next one */
} lines;

se3di_adams_statement *se3di_adams_find(const se3di_adams *a, const char *word, long id)
{
    char key[80];
    size_t index;
    snprintf(key, sizeof key, "%s/%ld", word, id);
    return se3di_ionames_find(&a->statements, key, &index) ? a->by_index[index] : NULL;
}

static bool is_key(const char *key, const char *full)
{
    const size_t length = strlen(key);
    return se3di_scan_equal(key, full) ||
           (length >= 3 && strlen(full) > length && se3di_scan_begins(full, key));
}

const char *se3di_adams_get(const se3di_adams_statement *s, const char *key)
{
    for (const se3di_adams_value *v = s->first; v; v = v->next) {
        if (se3di_scan_equal(v->key, key)) {
            return v->text;
        }
    }
    for (const se3di_adams_value *v = s->first; v; v = v->next) {
        if (is_key(v->key, key)) {
            return v->text;
        }
    }
    return NULL;
}

bool se3di_adams_has(const se3di_adams_statement *s, const char *flag)
{
    return se3di_adams_get(s, flag) != NULL;
}

/* Cut blanks at both ends. */
static char *trim(char *text)
{
    text += strspn(text, " \t\r\n");
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\r\n", text[length - 1])) {
        text[--length] = '\0';
    }
    return text;
}

/* `key` and `text` are kept: they are parts of the copy of the statement. */
static bool add_value(se3di_adams *a, se3di_adams_statement *s, const char *key, char *text)
{
    se3di_adams_value *v = se3di_iopool_alloc(a->m->pool, sizeof *v);
    if (!v) {
        return se3di_machine_fail_memory(a->m);
    }
    v->key = key;
    v->text = text;
    v->end = text + strlen(text);
    /* of an expression a comma only continues the line */
    v->is_list = se3di_scan_numeric(text) || !(is_key(key, "FUNCTION") || strchr("fFtT", key[0]));
    if (s->last) {
        s->last->next = v;
    } else {
        s->first = v;
    }
    s->last = v;
    return true;
}

static bool is_word(const char *text)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
    return strspn(text, letters) > 0 && !text[strspn(text, letters)];
}

/* A piece between two commas: "KEY = value", a flag, or another value of the key before. */
static bool add_piece(se3di_adams *a, se3di_adams_statement *s, char *piece)
{
    char *equals = NULL;
    int depth = 0;
    for (char *c = piece; *c && !equals; ++c) {
        depth += *c == '(' ? 1 : *c == ')' ? -1 : 0;
        equals = *c == '=' && depth == 0 ? c : NULL;
    }
    piece = trim(piece);
    if (!*piece) {
        return true;
    }
    if (equals) {
        *equals = '\0';
        return add_value(a, s, trim(piece), trim(equals + 1));
    }
    se3di_adams_value *last = s->last;
    if (!last || !last->text[0] || is_word(piece)) {
        return add_value(a, s, piece, piece + strlen(piece));
    }
    /* what is between the two is blank: they become one text */
    memset(last->end, ' ', (size_t)(piece - last->end));
    *last->end = last->is_list ? ',' : ' ';
    last->end = piece + strlen(piece);
    return true;
}

static bool add_pieces(se3di_adams *a, se3di_adams_statement *s, char *text)
{
    int depth = 0;
    char *start = text;
    for (char *c = text;; ++c) {
        const bool ends = *c == '\0';
        depth += *c == '(' ? 1 : *c == ')' ? -1 : 0;
        if (ends || ((*c == ',' || *c == '\\') && depth <= 0)) {
            *c = '\0';
            if (!add_piece(a, s, start)) {
                return false;
            }
            start = c + 1;
        }
        if (ends) {
            return true;
        }
    }
}

/* The word in full, in capitals; four letters are enough. NULL: unknown. */
static const char *full_word(const char *text, size_t length)
{
    for (size_t k = 0; k < sizeof words / sizeof *words; ++k) {
        if (se3di_scan_equal_part(text, length, words[k])) {
            return words[k];
        }
    }
    for (size_t k = 0; length >= 3 && k < sizeof words / sizeof *words; ++k) {
        char part[20];
        if (length < sizeof part) {
            memcpy(part, text, length);
            part[length] = '\0';
            if (se3di_scan_begins(words[k], part)) {
                return words[k];
            }
        }
    }
    return NULL;
}

static bool register_statement(se3di_adams *a, se3di_adams_statement *s)
{
    se3di_adams_statement **grown = se3di_iopool_grow(a->m->pool, (void *)a->by_index, a->count,
                                                      &a->room, sizeof(se3di_adams_statement *));
    size_t index;
    const char *key = se3di_machine_text(a->m, "%s/%ld", s->word, s->id);
    if (!grown || !key) {
        return se3di_machine_fail_memory(a->m);
    }
    a->by_index = grown;
    if (s->id >= 0 && se3di_ionames_find(&a->statements, key, &index)) {
        return se3di_machine_fail(a->m, s->line, 1, "%s is there twice", key);
    }
    a->by_index[a->count] = s;
    if (s->id >= 0 && !se3di_ionames_add(&a->statements, a->m->pool, key, a->count)) {
        return se3di_machine_fail_memory(a->m);
    }
    if (++a->count > STATEMENTS_MAX) {
        return se3di_machine_fail(a->m, s->line, 1, "there are more than 200000 statements");
    }
    if (a->last) {
        a->last->next = s;
    } else {
        a->first = s;
    }
    a->last = s;
    return true;
}

static bool finish(lines *l)
{
    se3di_adams *a = l->a;
    char *text = trim(l->text);
    char *slash = strchr(text, '/');
    const bool first = a->count == 0 && l->line == 1; /* the title */
    const size_t length = slash ? (size_t)(slash - text) : strcspn(text, " \t,");
    double id = -1.0;
    if (!*text) {
        return true;
    }
    const char *word = full_word(text, length);
    if (first && (!word || !slash)) {
        a->m->title = se3di_iopool_copy(a->m->pool, text, strlen(text));
        l->used = 0;
        return true;
    }
    se3di_adams_statement *s = se3di_iopool_alloc(a->m->pool, sizeof *s);
    if (!s) {
        return se3di_machine_fail_memory(a->m);
    }
    if (!word) {
        return se3di_machine_fail(a->m, l->line, 1, "`%.40s` begins no statement of Adams", text);
    }
    s->word = word;
    s->line = l->line;
    s->index = SE3DI_GROUND;
    char *rest = slash ? slash + 1 : text + length;
    const size_t digits = se3di_scan_number(rest + strspn(rest, " \t"), false, &id);
    rest += strspn(rest, " \t");
    s->id = digits > 0 && id >= 0.0 && id < 1e9 && !strchr("=", rest[digits] ? rest[digits] : ',')
                ? (long)id
                : -1;
    rest += s->id >= 0 ? digits : 0;
    if (l->name[0]) {
        s->name = se3di_iopool_copy(a->m->pool, l->name, strlen(l->name));
    }
    l->used = 0;
    rest = se3di_iopool_copy(a->m->pool, rest, strlen(rest));
    if (!rest) {
        return se3di_machine_fail_memory(a->m);
    }
    return add_pieces(a, s, rest) && register_statement(a, s);
}

static void keep_name(lines *l, const char *comment, size_t length)
{
    static const char key[] = "adams_view_name='";
    for (size_t k = 0; k + sizeof key - 1 < length; ++k) {
        if (memcmp(comment + k, key, sizeof key - 1) == 0) {
            const char *from = comment + k + sizeof key - 1;
            size_t count = 0;
            while (from + count < comment + length && from[count] != '\'' &&
                   count + 1 < sizeof l->ahead) {
                ++count;
            }
            memcpy(l->ahead, from, count);
            l->ahead[count] = '\0';
            return;
        }
    }
}

/* Add the characters of a line to the statement. A comma that continues it within brackets is none
 * of the expression. */
static bool append(lines *l, const char *text, size_t length, size_t line)
{
    if (l->used == 0) {
        l->line = line;
        l->depth = 0;
        memcpy(l->name, l->ahead, sizeof l->name);
        l->ahead[0] = '\0';
    }
    l->more = text[length - 1] == '&';
    length -= l->more;
    if (l->used + length + 2 > STATEMENT_MAX) {
        return se3di_machine_fail(l->a->m, line, 1, "the statement has more than 65536 characters");
    }
    l->text[l->used++] = ' ';
    for (size_t k = 0; k < length; ++k) {
        const bool comma = k == 0 && text[k] == ',' && l->depth > 0;
        l->text[l->used++] = text[k];
        if (comma || text[k] == '\0') {
            l->text[l->used - 1] = ' ';
        }
        l->depth += text[k] == '(' ? 1 : text[k] == ')' ? -1 : 0;
    }
    return true;
}

/* Add a line, without its comment, to the statement that it belongs to. */
static bool add_line(lines *l, const char *text, size_t length, size_t line)
{
    const char *comment = memchr(text, '!', length);
    const char *end = text + length;
    length = comment ? (size_t)(comment - text) : length;
    while (length > 0 && strchr(" \t\r", text[length - 1])) {
        --length;
    }
    while (length > 0 && strchr(" \t", *text)) {
        ++text;
        --length;
    }
    const bool continues = length > 0 && (l->more || (*text == ',' && l->used > 0));
    if (length > 0 && !continues && l->used > 0) {
        l->text[l->used] = '\0';
        if (!finish(l)) {
            return false;
        }
    }
    if (comment) {
        keep_name(l, comment, (size_t)(end - comment));
    }
    return length == 0 || append(l, text, length, line);
}

bool se3di_adams_read(se3di_adams *a, const char *text, size_t length)
{
    lines l = {.a = a};
    size_t line = 1;
    l.text = se3di_iopool_alloc(a->m->pool, STATEMENT_MAX + 1);
    if (!l.text) {
        return se3di_machine_fail_memory(a->m);
    }
    for (size_t at = 0; at < length; ++line) {
        const char *end = memchr(text + at, '\n', length - at);
        const size_t size = end ? (size_t)(end - text) - at : length - at;
        if (!add_line(&l, text + at, size, line)) {
            return false;
        }
        at += size + 1;
        if (a->last && strcmp(a->last->word, "END") == 0) {
            return true; /* whatever comes behind it */
        }
    }
    l.text[l.used] = '\0';
    return finish(&l);
}

/* A number, with D behind it in degrees. */
static size_t read_angle(const char *text, double *value)
{
    size_t length = se3di_scan_number(text, true, value);
    if (length > 0 && (text[length] == 'd' || text[length] == 'D')) {
        *value *= DEGREE;
        ++length;
    }
    return length;
}

bool se3di_adams_numbers(se3di_adams *a, const se3di_adams_statement *s, const char *key,
                         double *values, int room, int *count)
{
    const char *text = se3di_adams_get(s, key);
    const char *at = text;
    *count = 0;
    while (at && *at) {
        at += strspn(at, " \t");
        const size_t length = *count < room ? read_angle(at, &values[*count]) : 0;
        at += length;
        at += strspn(at, " \t");
        if (length == 0 || (*at && *at != ',')) {
            return se3di_machine_fail(a->m, s->line, 1,
                                      "%s/%ld: %s = %.60s: must be at most %d "
                                      "numbers",
                                      s->word, s->id, key, text, room);
        }
        ++*count;
        at += *at == ',';
    }
    return true;
}

bool se3di_adams_number(se3di_adams *a, const se3di_adams_statement *s, const char *key,
                        double scale, double *value)
{
    double read[1];
    int count;
    if (!se3di_adams_numbers(a, s, key, read, 1, &count)) {
        return false;
    }
    *value = count == 1 ? read[0] * scale : *value;
    return true;
}

const se3di_adams_marker *se3di_adams_marker_at(se3di_adams *a, long id)
{
    const se3di_adams_statement *s = se3di_adams_find(a, "MARKER", id);
    return s && s->index < a->marker_count ? &a->markers[s->index] : NULL;
}

const se3di_adams_marker *se3di_adams_marker_of(se3di_adams *a, const se3di_adams_statement *s,
                                                const char *key)
{
    double id = -1.0;
    if (!se3di_adams_number(a, s, key, 1.0, &id)) {
        return NULL;
    }
    const se3di_adams_marker *marker =
        id >= 0.0 && id < 1e9 ? se3di_adams_marker_at(a, (long)id) : NULL;
    if (!marker) {
        se3di_machine_fail(a->m, s->line, 1, "%s/%ld: %s must be the number of a MARKER", s->word,
                           s->id, key);
    }
    return marker;
}
