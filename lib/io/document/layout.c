/* SPDX-License-Identifier: BSD-3-Clause */
/* Layout. The tokens of libyaml say where values are; what stands between two of them is spaces,
 * line breaks and comments. Lines are kept as they are broken; what is made anew is
 *
 *     the indent of a line      two more than that of the map or list around it; within brackets
 *                               behind one that is open, or two more than its line: as it stood
 *     spaces between values     [1, 2], {a: 1}, - a
 *     comments                  as far in as the next or last line; those behind the values of
 *                               lines that follow each other in one column
 *     empty lines               one at most
 *
 * The values of both texts are compared in the end. */
#include "io/document/layout.h"

#include <stdint.h>
#include <string.h>
#include <yaml.h>

enum { STEP = 2, GAP = 2, DEPTH_MAX = 2 * SE3DI_DOCUMENT_DEPTH_MAX + 8 };

/* A map or list around the present place, or a bracket. */
typedef struct around {
    bool is_list, is_implied, is_flow;
    size_t indent;              /* of its keys or dashes; of a bracket: of the line it stands in */
    size_t source, out;         /* bracket: columns of what follows it, in the text and laid out */
    size_t hanging;             /* bracket: column in the text of what is two more than its line */
    bool has_source, ends_line; /* bracket: `source` is known; nothing follows it in its line */
} around;

/* A line laid out. */
typedef struct line {
    size_t indent;
    size_t begin, end;     /* of its text in `bytes` */
    size_t width;          /* in characters, without the indent */
    size_t note, note_end; /* of the comment behind it; equal: none */
} line;

typedef struct layout {
    se3di_iopool *pool;
    const char *text;
    size_t length;
    size_t at, index;         /* how far characters are counted: byte and index */
    size_t last_end;          /* end of the last token */
    size_t seen, seen_column; /* a byte of the present line of the text, and its column */
    size_t last_source;       /* column that the last line begins in, and its indent */
    size_t last_indent;
    yaml_token_type_t last;
    around stack[DEPTH_MAX];
    size_t depth;
    bool is_key; /* the next scalar is a key of a map without braces */
    bool opened; /* the last token was an opening bracket */
    char *bytes;
    size_t count, capacity;
    line *lines;
    size_t line_count, line_capacity;
    bool failed; /* no memory */
    bool gives_up;
} layout;

/* ---- what is laid out ---- */

static bool is_continued(char c)
{
    return ((unsigned char)c & 0xC0U) == 0x80U;
}

static void put(layout *l, const char *text, size_t length)
{
    for (size_t k = 0; k < length && !l->failed; ++k) {
        char *grown = se3di_iopool_grow(l->pool, l->bytes, l->count, &l->capacity, 1);
        l->failed = !grown;
        if (grown) {
            l->bytes = grown;
            l->bytes[l->count++] = text[k];
            if (l->line_count > 0 && !is_continued(text[k])) {
                ++l->lines[l->line_count - 1].width;
            }
        }
    }
    if (l->line_count > 0) {
        l->lines[l->line_count - 1].end = l->count;
    }
}

static line *add_line(layout *l, size_t indent)
{
    line *grown =
        se3di_iopool_grow(l->pool, l->lines, l->line_count, &l->line_capacity, sizeof *l->lines);
    l->failed = l->failed || !grown;
    if (!grown) {
        return NULL;
    }
    l->lines = grown;
    l->lines[l->line_count] = (line){.indent = indent, .begin = l->count, .end = l->count};
    return &l->lines[l->line_count++];
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* The end of [begin, end) without spaces. */
static size_t trim(const char *text, size_t begin, size_t end)
{
    while (end > begin && is_space(text[end - 1])) {
        --end;
    }
    return end;
}

static size_t skip_spaces(const char *text, size_t begin, size_t end)
{
    while (begin < end && is_space(text[begin])) {
        ++begin;
    }
    return begin;
}

static size_t find_break(const layout *l, size_t begin, size_t end)
{
    const char *found = memchr(l->text + begin, '\n', end - begin);
    return found ? (size_t)(found - l->text) : end;
}

/* Column of a byte, in characters from 0. */
static size_t column_of(const layout *l, size_t at)
{
    size_t column = 0;
    while (at > 0 && l->text[at - 1] != '\n') {
        column += !is_continued(l->text[--at]);
    }
    return column;
}

/* ---- what stands between two tokens ---- */

/* An empty line unless one is there, or nothing else. */
static void put_empty(layout *l)
{
    const line *before = l->line_count > 0 ? &l->lines[l->line_count - 1] : NULL;
    if (before && before->end > before->begin) {
        (void)add_line(l, 0);
    }
}

/* Comments and empty lines of [begin, end), which begins behind the break of a line; the next line
 * begins at `source`, laid out at `indent`. */
static void put_between(layout *l, size_t begin, size_t end, size_t source, size_t indent)
{
    while (begin < end) {
        const size_t stop = find_break(l, begin, end);
        const size_t first = skip_spaces(l->text, begin, stop);
        if (first < stop) {
            const size_t column = column_of(l, first);
            const bool is_inner =
                column == l->last_source || (column > source && l->last_indent > indent);
            (void)add_line(l, column != source && is_inner ? l->last_indent : indent);
            put(l, l->text + first, trim(l->text, first, stop) - first);
        } else if (stop < end) {
            put_empty(l);
        }
        begin = stop + 1;
    }
}

/* The comment behind the last line. */
static void put_note(layout *l, size_t begin, size_t end)
{
    begin = skip_spaces(l->text, begin, end);
    end = trim(l->text, begin, end);
    if (begin < end && l->line_count > 0) {
        l->lines[l->line_count - 1].note = begin;
        l->lines[l->line_count - 1].note_end = end;
    }
}

/* ---- indents ---- */

static around *top(layout *l)
{
    return l->depth > 0 ? &l->stack[l->depth - 1] : NULL;
}

static around *push(layout *l, bool is_list)
{
    const around *outer = top(l);
    const size_t indent = outer ? outer->indent + STEP : 0;
    if (l->depth == DEPTH_MAX) {
        l->gives_up = true;
        --l->depth;
    }
    around *new = &l->stack[l->depth++];
    *new = (around){.is_list = is_list, .indent = indent};
    return new;
}

static void pop(layout *l)
{
    l->depth -= l->depth > 0;
}

/* The indent of a line within brackets that stood in the column `source`: behind one of them, or
 * two more than the line of one; else `other`. */
static size_t bracket_indent(layout *l, around *inner, size_t source, size_t other)
{
    if (inner->ends_line && !inner->has_source) {
        inner->source = source;
        inner->has_source = true;
    }
    for (size_t k = l->depth; k > 0 && l->stack[k - 1].is_flow; --k) {
        if (l->stack[k - 1].has_source && l->stack[k - 1].source == source) {
            return l->stack[k - 1].out;
        }
    }
    for (size_t k = l->depth; k > 0 && l->stack[k - 1].is_flow; --k) {
        if (l->stack[k - 1].hanging == source) {
            return l->stack[k - 1].indent + STEP;
        }
    }
    return other;
}

/* The indent of a line that begins with a token. */
static size_t line_indent(layout *l, yaml_token_type_t type, size_t source)
{
    around *inner = top(l);
    if (!inner) {
        return 0;
    }
    if (inner->is_flow) {
        const bool closes =
            type == YAML_FLOW_SEQUENCE_END_TOKEN || type == YAML_FLOW_MAPPING_END_TOKEN;
        return !closes            ? bracket_indent(l, inner, source, inner->out)
               : inner->ends_line ? inner->indent
                                  : inner->out - 1;
    }
    return type == YAML_BLOCK_ENTRY_TOKEN || l->is_key ? inner->indent : inner->indent + STEP;
}

/* ---- tokens ---- */

static bool needs_space(const layout *l, yaml_token_type_t type)
{
    const bool closes = type == YAML_FLOW_SEQUENCE_END_TOKEN || type == YAML_FLOW_MAPPING_END_TOKEN;
    const bool joins = type == YAML_FLOW_ENTRY_TOKEN || type == YAML_VALUE_TOKEN;
    return !l->opened && !closes && (!joins || l->last == YAML_VALUE_TOKEN);
}

/* Begin a line with a token, after what stands before it from `from` on, which begins a line. */
static void begin_line(layout *l, yaml_token_type_t type, size_t from, size_t begin)
{
    around *inner = top(l);
    const size_t source = column_of(l, begin);
    if (l->opened && inner) {
        inner->ends_line = true;
        inner->has_source = false;
        inner->out = inner->indent + STEP;
    }
    const size_t indent = line_indent(l, type, source);
    size_t line_begin = begin;
    while (line_begin > from && l->text[line_begin - 1] != '\n') {
        --line_begin;
    }
    put_between(l, from, line_begin, source, indent);
    (void)add_line(l, indent);
    l->last_source = source;
    l->last_indent = indent;
    l->seen = begin;
    l->seen_column = source;
}

/* Put what stands before a token: a space, or the end of a line and the beginning of the next. */
static void go_to(layout *l, yaml_token_type_t type, size_t begin)
{
    const size_t stop = find_break(l, l->last_end, begin);
    if (l->line_count == 0) {
        begin_line(l, type, 0, begin);
    } else if (stop < begin) {
        put_note(l, l->last_end, stop);
        begin_line(l, type, stop + 1, begin);
    } else if (needs_space(l, type)) {
        put(l, " ", 1);
    }
}

/* Lines of a value without a bar that has several: as far in as it begins, or as lines in the
 * brackets around it. */
static void put_lines(layout *l, size_t begin, size_t end)
{
    const line *first = &l->lines[l->line_count - 1];
    const bool is_quoted = l->text[begin] == '"' || l->text[begin] == '\'';
    const size_t own = first->indent + first->width + (is_quoted ? 1 : 0);
    size_t stop = find_break(l, begin, end);
    put(l, l->text + begin, trim(l->text, begin, stop) - begin);
    while (stop < end && !l->failed) {
        const size_t source = stop + 1;
        stop = find_break(l, source, end);
        begin = skip_spaces(l->text, source, stop);
        around *inner = top(l);
        (void)add_line(l, inner && inner->is_flow ? bracket_indent(l, inner, begin - source, own)
                                                  : own);
        put(l, l->text + begin, (stop < end ? trim(l->text, begin, stop) : stop) - begin);
        l->seen = source;
        l->seen_column = 0;
    }
}

/* A value behind a bar: its lines keep their indents among them. */
static void put_block(layout *l, size_t begin, size_t end)
{
    const around *inner = top(l);
    const size_t indent = inner ? inner->indent + STEP : STEP;
    size_t stop = find_break(l, begin, end), least = SIZE_MAX;
    put(l, l->text + begin, trim(l->text, begin, stop) - begin);
    while (stop < end) {
        begin = stop + 1;
        stop = find_break(l, begin, end);
        const size_t first = skip_spaces(l->text, begin, stop);
        least = least == SIZE_MAX && first < stop ? first - begin : least;
        const size_t skip = first < stop && least < first - begin ? least : first - begin;
        if (first < stop || stop < end) {
            (void)add_line(l, first < stop ? indent : 0);
            put(l, l->text + begin + skip, first < stop ? stop - begin - skip : 0);
        }
    }
    while (l->line_count > 0 &&
           l->lines[l->line_count - 1].end == l->lines[l->line_count - 1].begin) {
        --l->line_count;
    }
}

static void put_token(layout *l, const yaml_token_t *token, size_t begin, size_t end)
{
    const bool is_block = token->type == YAML_SCALAR_TOKEN &&
                          (token->data.scalar.style == YAML_LITERAL_SCALAR_STYLE ||
                           token->data.scalar.style == YAML_FOLDED_SCALAR_STYLE);
    go_to(l, token->type, begin);
    if (l->failed || l->line_count == 0) {
        return;
    }
    if (is_block) {
        while (end > begin && (is_space(l->text[end - 1]) || l->text[end - 1] == '\n')) {
            --end;
        }
        put_block(l, begin, end);
    } else {
        put_lines(l, begin, end);
    }
    l->last = token->type;
    l->last_end = end;
    l->opened = false;
    l->is_key = false;
}

/* An opening bracket, just put. */
static void open_bracket(layout *l)
{
    const line *last = &l->lines[l->line_count - 1];
    for (; l->seen < l->last_end; ++l->seen) {
        l->seen_column += !is_continued(l->text[l->seen]);
    }
    around *new = push(l, false);
    *new = (around){.is_flow = true,
                    .indent = last->indent,
                    .out = last->indent + last->width,
                    .source = l->seen_column,
                    .hanging = l->last_source + STEP,
                    .has_source = true};
    l->opened = true;
}

/* ---- structure ---- */

/* What begins or ends without a character of its own. */
static void follow(layout *l, const yaml_token_t *token, size_t begin)
{
    around *inner = top(l);
    if (token->type == YAML_BLOCK_MAPPING_START_TOKEN) {
        (void)push(l, false);
    } else if (token->type == YAML_BLOCK_SEQUENCE_START_TOKEN) {
        (void)push(l, true);
    } else if (token->type == YAML_BLOCK_ENTRY_TOKEN && (!inner || !inner->is_list)) {
        push(l, true)->is_implied = true;
    } else if (token->type == YAML_KEY_TOKEN && inner && !inner->is_flow) {
        if (inner->is_implied) {
            pop(l);
        }
        l->is_key = true;
    } else if (token->type == YAML_BLOCK_END_TOKEN) {
        if (inner && inner->is_implied) {
            pop(l);
        }
        pop(l);
    } else if (token->type == YAML_FLOW_SEQUENCE_END_TOKEN ||
               token->type == YAML_FLOW_MAPPING_END_TOKEN) {
        return;
    }
    if (token->type == YAML_KEY_TOKEN && begin + 1 < l->length && l->text[begin] == '?' &&
        strchr(" \t\r\n", l->text[begin + 1])) {
        l->gives_up = true;
    }
}

/* The byte of an index of libyaml, which counts characters; they come in order. */
static size_t find_byte(layout *l, size_t index)
{
    while (l->index < index && l->at < l->length) {
        ++l->at;
        while (l->at < l->length && is_continued(l->text[l->at])) {
            ++l->at;
        }
        ++l->index;
    }
    return l->at;
}

static void take_token(layout *l, const yaml_token_t *token)
{
    const size_t begin = find_byte(l, token->start_mark.index);
    follow(l, token, begin);
    switch (token->type) {
    case YAML_NO_TOKEN:
    case YAML_STREAM_START_TOKEN:
    case YAML_STREAM_END_TOKEN:
    case YAML_BLOCK_SEQUENCE_START_TOKEN:
    case YAML_BLOCK_MAPPING_START_TOKEN:
    case YAML_BLOCK_END_TOKEN:
    case YAML_KEY_TOKEN:
        return;
    default:
        put_token(l, token, begin, find_byte(l, token->end_mark.index));
    }
    if (l->failed) {
        return;
    }
    if (token->type == YAML_FLOW_SEQUENCE_START_TOKEN ||
        token->type == YAML_FLOW_MAPPING_START_TOKEN) {
        open_bracket(l);
    } else if (token->type == YAML_FLOW_SEQUENCE_END_TOKEN ||
               token->type == YAML_FLOW_MAPPING_END_TOKEN) {
        pop(l);
    }
}

static void take_tokens(layout *l, yaml_parser_t *parser)
{
    bool more = true;
    while (more && !l->failed && !l->gives_up) {
        yaml_token_t token;
        if (!yaml_parser_scan(parser, &token)) {
            l->gives_up = true;
            return;
        }
        more = token.type != YAML_STREAM_END_TOKEN && token.type != YAML_NO_TOKEN;
        take_token(l, &token);
        yaml_token_delete(&token);
    }
}

/* ---- the text ---- */

static bool has_note(const layout *l, size_t k)
{
    return l->lines[k].note < l->lines[k].note_end;
}

/* The column of the comments of lines that follow each other from k on. */
static size_t note_column(const layout *l, size_t k)
{
    size_t column = 0;
    for (; k < l->line_count && has_note(l, k); ++k) {
        const size_t width = l->lines[k].indent + l->lines[k].width + GAP;
        column = width > column ? width : column;
    }
    return column;
}

static void put_text(char *text, size_t *at, const char *part, size_t count)
{
    if (text && count > 0) {
        memcpy(text + *at, part, count);
    }
    *at += count;
}

static void put_spaces(char *text, size_t *at, size_t count)
{
    if (text) {
        memset(text + *at, ' ', count);
    }
    *at += count;
}

/* Write all lines, or, without a text, @return how many bytes they have. */
static size_t write_lines(const layout *l, char *text)
{
    size_t at = 0, column = 0;
    for (size_t k = 0; k < l->line_count; ++k) {
        const line *one = &l->lines[k];
        if (one->end > one->begin) {
            put_spaces(text, &at, one->indent);
            put_text(text, &at, l->bytes + one->begin, one->end - one->begin);
        }
        if (has_note(l, k)) {
            column = k > 0 && has_note(l, k - 1) ? column : note_column(l, k);
            put_spaces(text, &at, column - one->indent - one->width);
            put_text(text, &at, l->text + one->note, one->note_end - one->note);
        }
        put_text(text, &at, "\n", 1);
    }
    return at;
}

static char *write_text(layout *l, size_t *length)
{
    *length = write_lines(l, NULL);
    char *text = se3di_iopool_alloc(l->pool, *length + 1);
    if (text) {
        (void)write_lines(l, text);
    }
    return text;
}

static bool is_equal(const se3di_node *a, const se3di_node *b)
{
    if (a->kind != b->kind || a->plain != b->plain || a->count != b->count ||
        (a->key != NULL) != (b->key != NULL) || (a->key && strcmp(a->key, b->key) != 0) ||
        (a->kind == SE3DI_NODE_SCALAR && strcmp(a->text, b->text) != 0)) {
        return false;
    }
    const se3di_node *other = b->first;
    for (const se3di_node *one = a->first; one; one = one->next, other = other->next) {
        if (!is_equal(one, other)) {
            return false;
        }
    }
    return true;
}

static char *lay_out(layout *l, size_t *length)
{
    yaml_parser_t parser;
    l->failed = !yaml_parser_initialize(&parser);
    if (l->failed) {
        return NULL;
    }
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser, (const unsigned char *)l->text, l->length);
    take_tokens(l, &parser);
    yaml_parser_delete(&parser);
    if (!l->failed && !l->gives_up) {
        const size_t stop = find_break(l, l->last_end, l->length);
        put_note(l, l->last_end, stop);
        put_between(l, stop + 1 < l->length ? stop + 1 : l->length, l->length, 0, 0);
        while (l->line_count > 0 &&
               l->lines[l->line_count - 1].end == l->lines[l->line_count - 1].begin) {
            --l->line_count;
        }
    }
    return l->failed || l->gives_up ? NULL : write_text(l, length);
}

static se3d_status fail_memory(const char *file, char **out, se3d_model_error *error)
{
    *out = NULL;
    se3di_document_report(error, file, 0, 0, "", "out of memory");
    return SE3D_ERR_NO_MEMORY;
}

se3d_status se3di_layout_make(se3di_iopool *pool, const char *file, const char *text, size_t length,
                              char **out, size_t *out_length, se3d_model_error *error)
{
    const size_t mark = se3di_byte_order_mark_length(text, length);
    layout *l = se3di_iopool_alloc(pool, sizeof *l);
    se3di_node *before = NULL, *after = NULL;
    const se3d_status status = se3di_document_parse(pool, file, text, length, &before, error);
    *out = NULL;
    if (status < 0) {
        return status;
    }
    if (l) {
        *l = (layout){.pool = pool, .text = text + mark, .length = length - mark};
        *out = lay_out(l, out_length);
    }
    if (!l || l->failed || (!*out && !l->gives_up)) {
        return fail_memory(file, out, error);
    }
    const se3d_status again =
        *out ? se3di_document_parse(pool, file, *out, *out_length, &after, error) : SE3D_ERR_MODEL;
    if (again == SE3D_ERR_NO_MEMORY) {
        return fail_memory(file, out, error);
    }
    if (again < 0 || !is_equal(before, after)) {
        *out = se3di_iopool_copy(pool, text, length);
        *out_length = length;
        error->message[0] = '\0';
    }
    return *out ? SE3D_OK : fail_memory(file, out, error);
}
