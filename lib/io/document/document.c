/* SPDX-License-Identifier: BSD-3-Clause */
/* A YAML text as a tree. Only what JSON can say too is taken: one document of scalars, lists and
 * maps with plain keys; anchors, aliases, tags and duplicate keys are errors. The tree is built
 * without recursion, so that no text can exhaust the stack. */
#include "io/document/document.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <yaml.h>

#include "io/base/pool.h"

enum { SHOWN = 120 }; /* characters of a value that was cut */

typedef struct builder {
    se3di_iopool *pool;
    const char *file;
    se3d_model_error *error;
    se3di_node *root;
    se3di_node *open; /* the innermost list or map */
    size_t depth;
    size_t nodes;
    const char *key; /* of the value that comes next, in a map */
    yaml_mark_t key_mark;
    bool at_rest; /* of an expression that was cut: the value that comes next is none */
    se3d_status status;
} builder;

/* Messages quote what is in a file: control characters and cut ones become '?'. */
static void make_printable(char *text)
{
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        *text = length > 0 ? *text : '?';
        text += length > 0 ? length : 1;
    }
}

void se3di_document_report(se3d_model_error *error, const char *file, size_t line, size_t column,
                           const char *path, const char *text)
{
    if (!error) {
        return;
    }
    char place[64] = "";
    if (line > 0) {
        snprintf(place, sizeof place, ":%zu:%zu", line, column);
    }
    error->line = line;
    error->column = column;
    snprintf(error->message, sizeof error->message, "%s%s%s%.300s%s%s", line > 0 ? file : "", place,
             line > 0 ? ": " : "", path, path[0] ? ": " : "", text);
    make_printable(error->message);
}

SE3DI_IO_FORMAT(4, 5)
static bool fail_at(builder *b, yaml_mark_t mark, const se3di_node *where, const char *format, ...)
{
    char text[640];
    char path[256] = "";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (where) {
        se3di_node_format_path(where, path, sizeof path);
        if (where == b->open && b->key) {
            const size_t used = strlen(path);
            snprintf(path + used, sizeof path - used, "%s%.80s", used > 0 ? "." : "", b->key);
        }
    }
    se3di_document_report(b->error, b->file, mark.line + 1, mark.column + 1, path, text);
    b->status = SE3D_ERR_MODEL;
    return false;
}

static bool fail_memory(builder *b)
{
    se3di_document_report(b->error, b->file, 0, 0, "", "out of memory");
    b->status = SE3D_ERR_NO_MEMORY;
    return false;
}

/* A new node as the next child of the open one. */
static se3di_node *add_node(builder *b, se3di_node_kind kind, const yaml_event_t *event)
{
    if (++b->nodes > SE3DI_DOCUMENT_NODES_MAX) {
        fail_at(b, event->start_mark, NULL, "too large: more than %d values",
                (int)SE3DI_DOCUMENT_NODES_MAX);
        return NULL;
    }
    se3di_node *node = se3di_iopool_alloc(b->pool, sizeof *node);
    if (!node) {
        fail_memory(b);
        return NULL;
    }
    node->kind = kind;
    node->line = event->start_mark.line + 1;
    node->column = event->start_mark.column + 1;
    node->parent = b->open;
    if (!b->open) {
        b->root = node;
        return node;
    }
    node->key = b->key;
    node->key_line = b->key_mark.line + 1;
    node->key_column = b->key_mark.column + 1;
    b->key = NULL;
    node->index = b->open->count++;
    if (b->open->last) {
        b->open->last->next = node;
    } else {
        b->open->first = node;
    }
    b->open->last = node;
    return node;
}

static bool check_key(builder *b, const char *key, yaml_mark_t mark)
{
    if (se3di_node_get(b->open, key)) {
        return fail_at(b, mark, b->open, "the key `%.80s` is given twice", key);
    }
    if (b->open->count >= SE3DI_DOCUMENT_KEYS_MAX) {
        return fail_at(b, mark, b->open, "too large: more than %d keys",
                       (int)SE3DI_DOCUMENT_KEYS_MAX);
    }
    b->key = key;
    b->key_mark = mark;
    return true;
}

/* The value of an open map that a comma in braces has cut, as in {value: hypot(3, 4)}; NULL: the
 * last one is whole. */
static se3di_node *find_cut(const builder *b)
{
    se3di_node *last = b->open->flow ? b->open->last : NULL;
    int open = 0;
    if (!last || last->kind != SE3DI_NODE_SCALAR || !last->plain) {
        return NULL;
    }
    for (const char *at = last->text; *at; ++at) {
        open += (*at == '(') - (*at == ')');
    }
    return open > 0 ? last : NULL;
}

/* The rest of the expression, which YAML takes for a key without a value; as much as is shown. */
static bool join(builder *b, se3di_node *cut, const char *text)
{
    const size_t length = strlen(cut->text), rest = strlen(text);
    cut->is_cut = true;
    b->at_rest = true;
    if (length + rest > SHOWN) {
        return true;
    }
    char *whole = se3di_iopool_alloc(b->pool, length + rest + 3);
    if (!whole) {
        return fail_memory(b);
    }
    memcpy(whole, cut->text, length);
    memcpy(whole + length, ", ", 2);
    memcpy(whole + length + 2, text, rest);
    cut->text = whole;
    cut->one_line = false;
    return true;
}

/* What was taken for the rest of an expression is a key with a value. */
static bool fail_cut(builder *b, const yaml_event_t *event)
{
    return fail_at(b, event->start_mark, b->open,
                   "`%.80s` has no closing parenthesis, or was cut at a comma: inside { } an "
                   "expression with a comma needs quotes",
                   b->open->last->text);
}

static bool on_key(builder *b, const char *text, const yaml_event_t *event)
{
    se3di_node *cut = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE ? find_cut(b) : NULL;
    return cut ? join(b, cut, text) : check_key(b, text, event->start_mark);
}

static bool on_scalar(builder *b, const yaml_event_t *event)
{
    const char *value = (const char *)event->data.scalar.value;
    const size_t length = event->data.scalar.length;
    const bool plain = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    if (length > SE3DI_DOCUMENT_SCALAR_MAX) {
        return fail_at(b, event->start_mark, b->open, "a text of %zu bytes, at most %d are allowed",
                       length, (int)SE3DI_DOCUMENT_SCALAR_MAX);
    }
    if (memchr(value, 0, length)) {
        return fail_at(b, event->start_mark, b->open, "a text with a NUL character in it");
    }
    if (b->at_rest && length == 0) {
        b->at_rest = false;
        return true;
    }
    if (b->at_rest) {
        return fail_cut(b, event);
    }
    const char *text = se3di_iopool_copy(b->pool, value, length);
    if (!text) {
        return fail_memory(b);
    }
    if (b->open && b->open->kind == SE3DI_NODE_MAP && !b->key) {
        return on_key(b, text, event);
    }
    se3di_node *node = add_node(b, SE3DI_NODE_SCALAR, event);
    if (!node) {
        return false;
    }
    const size_t span = event->end_mark.column - event->start_mark.column;
    node->text = text;
    node->plain = plain;
    node->one_line = event->start_mark.line == event->end_mark.line &&
                     event->end_mark.column > event->start_mark.column &&
                     span == length + (plain ? 0 : 2);
    return true;
}

static bool on_open(builder *b, const yaml_event_t *event, se3di_node_kind kind)
{
    if (b->at_rest) {
        return fail_cut(b, event);
    }
    if (b->open && b->open->kind == SE3DI_NODE_MAP && !b->key) {
        return fail_at(b, event->start_mark, b->open, "a key must be a plain text");
    }
    if (b->depth >= SE3DI_DOCUMENT_DEPTH_MAX) {
        return fail_at(b, event->start_mark, NULL, "nested more than %d levels deep",
                       (int)SE3DI_DOCUMENT_DEPTH_MAX);
    }
    se3di_node *node = add_node(b, kind, event);
    if (!node) {
        return false;
    }
    node->flow =
        kind == SE3DI_NODE_MAP && event->data.mapping_start.style == YAML_FLOW_MAPPING_STYLE;
    b->open = node;
    ++b->depth;
    return true;
}

/* Anchors and tags on any kind of value. */
static bool check_plainness(builder *b, const yaml_event_t *event)
{
    const yaml_char_t *anchor = NULL;
    const yaml_char_t *tag = NULL;
    if (event->type == YAML_SCALAR_EVENT) {
        anchor = event->data.scalar.anchor;
        tag = event->data.scalar.tag;
    } else if (event->type == YAML_SEQUENCE_START_EVENT) {
        anchor = event->data.sequence_start.anchor;
        tag = event->data.sequence_start.tag;
    } else if (event->type == YAML_MAPPING_START_EVENT) {
        anchor = event->data.mapping_start.anchor;
        tag = event->data.mapping_start.tag;
    }
    if (anchor) {
        return fail_at(b, event->start_mark, b->open, "anchors (&%.40s) are not allowed",
                       (const char *)anchor);
    }
    if (tag) {
        return fail_at(b, event->start_mark, b->open, "tags (%.60s) are not allowed",
                       (const char *)tag);
    }
    return true;
}

static bool on_event(builder *b, const yaml_event_t *event)
{
    if (!check_plainness(b, event)) {
        return false;
    }
    switch (event->type) {
    case YAML_ALIAS_EVENT:
        return fail_at(b, event->start_mark, b->open, "aliases (*%.40s) are not allowed",
                       (const char *)event->data.alias.anchor);
    case YAML_SCALAR_EVENT:
        return on_scalar(b, event);
    case YAML_SEQUENCE_START_EVENT:
        return on_open(b, event, SE3DI_NODE_LIST);
    case YAML_MAPPING_START_EVENT:
        return on_open(b, event, SE3DI_NODE_MAP);
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        b->open = b->open->parent;
        --b->depth;
        return true;
    case YAML_DOCUMENT_START_EVENT:
        return b->root ? fail_at(b, event->start_mark, NULL,
                                 "a second document, one file must hold one model")
                       : true;
    default:
        return true;
    }
}

/* Line and column of a byte offset: the reader of libyaml gives only that. */
static yaml_mark_t mark_of_offset(const char *text, size_t length, size_t offset)
{
    yaml_mark_t mark = {0, 0, 0};
    for (size_t k = 0; k < offset && k < length; ++k) {
        if (text[k] == '\n') {
            ++mark.line;
            mark.column = 0;
        } else if (((unsigned char)text[k] & 0xC0U) != 0x80U) {
            ++mark.column;
        }
    }
    return mark;
}

static void fail_syntax(builder *b, const yaml_parser_t *parser, const char *text, size_t length)
{
    const char *problem = parser->problem ? parser->problem : "malformed";
    if (parser->error == YAML_MEMORY_ERROR) {
        fail_memory(b);
    } else if (parser->error == YAML_READER_ERROR) {
        fail_at(b, mark_of_offset(text, length, parser->problem_offset), NULL,
                "not a text in UTF-8: %s", problem);
    } else if (strstr(problem, "found character that cannot start any token")) {
        fail_at(b, parser->problem_mark, NULL,
                "syntax error: a value cannot begin with this character (a tab, @, `, %%); "
                "indent with spaces and put texts in quotes");
    } else {
        fail_at(b, parser->problem_mark, NULL, "syntax error: %s%s%s", problem,
                parser->context ? " " : "", parser->context ? parser->context : "");
    }
}

static void parse_events(builder *b, yaml_parser_t *parser, const char *text, size_t length)
{
    bool more = true;
    while (more) {
        yaml_event_t event;
        if (!yaml_parser_parse(parser, &event)) {
            fail_syntax(b, parser, text, length);
            return;
        }
        more = event.type != YAML_STREAM_END_EVENT && on_event(b, &event);
        yaml_event_delete(&event);
    }
}

size_t se3di_byte_order_mark_length(const char *text, size_t length)
{
    return length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
}

se3d_status se3di_document_read(se3di_iopool *pool, FILE *file, char **text, size_t *length)
{
    size_t capacity = 65536;
    char *bytes = se3di_iopool_alloc(pool, capacity);
    size_t used = 0;
    while (bytes) {
        used += fread(bytes + used, 1, capacity - used, file);
        if (used < capacity || capacity > SE3DI_DOCUMENT_BYTES_MAX) {
            *text = bytes;
            *length = used;
            return ferror(file) ? SE3D_ERR_IO : SE3D_OK;
        }
        char *larger = se3di_iopool_alloc(pool, 2 * capacity);
        if (larger) {
            memcpy(larger, bytes, used);
        }
        bytes = larger;
        capacity *= 2;
    }
    return SE3D_ERR_NO_MEMORY;
}

/* The value that a text holds; *root NULL, OK: none. */
static se3d_status parse(se3di_iopool *pool, const char *file, const char *text, size_t length,
                         se3di_node **root, se3d_model_error *error)
{
    const yaml_mark_t start = {0, 0, 0};
    builder b = {.pool = pool, .file = file, .error = error, .status = SE3D_OK};
    *root = NULL;
    if (length > SE3DI_DOCUMENT_BYTES_MAX) {
        fail_at(&b, start, NULL, "too large: %zu bytes, at most %d are allowed", length,
                (int)SE3DI_DOCUMENT_BYTES_MAX);
        return b.status;
    }
    const size_t mark = se3di_byte_order_mark_length(text, length);
    text += mark;
    length -= mark;
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser)) {
        fail_memory(&b);
        return b.status;
    }
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
    parse_events(&b, &parser, text, length);
    yaml_parser_delete(&parser);
    *root = b.status == SE3D_OK ? b.root : NULL;
    if (*root) {
        (*root)->file = file;
    }
    return b.status;
}

/* What must be there is not. */
static se3d_status fail_empty(const char *file, se3d_model_error *error, const char *text)
{
    se3di_document_report(error, file, 1, 1, "", text);
    return SE3D_ERR_MODEL;
}

se3d_status se3di_document_parse(se3di_iopool *pool, const char *file, const char *text,
                                 size_t length, se3di_node **root, se3d_model_error *error)
{
    const se3d_status status = parse(pool, file, text, length, root, error);
    if (status == SE3D_OK && (!*root || se3di_node_is_null(*root))) {
        *root = NULL;
        return fail_empty(file, error, "is empty, must be a map that begins with `se3d: 1`");
    }
    return status;
}

se3d_status se3di_document_parse_value(se3di_iopool *pool, const char *name, const char *text,
                                       size_t length, se3di_node **root, se3d_model_error *error)
{
    const se3d_status status = parse(pool, name, text, length, root, error);
    return status == SE3D_OK && !*root ? fail_empty(name, error, "is empty, must be a value")
                                       : status;
}

se3di_node *se3di_node_of_text(se3di_iopool *pool, const char *key, const char *text)
{
    se3di_node *node = se3di_iopool_alloc(pool, sizeof *node);
    if (node) {
        node->kind = SE3DI_NODE_SCALAR;
        node->key = se3di_iopool_copy(pool, key, strlen(key));
        node->text = se3di_iopool_copy(pool, text, strlen(text));
    }
    return node && node->key && node->text ? node : NULL;
}

se3di_node *se3di_node_get(const se3di_node *map, const char *key)
{
    if (!map || map->kind != SE3DI_NODE_MAP) {
        return NULL;
    }
    for (se3di_node *child = map->first; child; child = child->next) {
        if (strcmp(child->key, key) == 0) {
            return child;
        }
    }
    return NULL;
}

bool se3di_node_is_null(const se3di_node *node)
{
    return node->kind == SE3DI_NODE_SCALAR && node->plain &&
           (!node->text[0] || strcmp(node->text, "~") == 0 || strcmp(node->text, "null") == 0);
}

const char *se3di_node_describe(const se3di_node *node)
{
    if (node->kind == SE3DI_NODE_LIST) {
        return "a list";
    }
    if (node->kind == SE3DI_NODE_MAP) {
        return "a map";
    }
    return se3di_node_is_null(node) ? "empty" : "a single value";
}

void se3di_node_format_path(const se3di_node *node, char *path, size_t size)
{
    const se3di_node *chain[SE3DI_DOCUMENT_DEPTH_MAX + 2];
    size_t count = 0;
    size_t used = 0;
    path[0] = '\0';
    for (; node && count < sizeof chain / sizeof *chain; node = node->parent) {
        chain[count++] = node;
    }
    while (count-- > 0 && used < size) {
        const se3di_node *part = chain[count];
        int written = 0;
        if (part->key) {
            written = snprintf(path + used, size - used, "%s%.80s", used > 0 ? "." : "", part->key);
        } else if (part->parent) {
            written = snprintf(path + used, size - used, "[%zu]", part->index);
        }
        used += written > 0 ? (size_t)written : 0;
    }
}
