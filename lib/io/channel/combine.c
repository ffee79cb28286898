/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions of channels. What names a channel, pin.force.x, becomes a variable; the rest is as
 * everywhere in a model file. */
#include "io/channel/combine.h"

#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/amount.h"
#include "io/document/document.h"
#include "io/document/formula.h"
#include "io/document/value.h"
#include "io/model/model.h"

enum { NAME_MAX_LENGTH = 310 };

static bool is_word(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

static bool is_figure(char c)
{
    return c >= '0' && c <= '9';
}

/* Length of what begins with a figure: a number, whose exponent is no name. */
static size_t skip_number(const char *at)
{
    size_t length = 0;
    while (is_figure(at[length]) || at[length] == '.') {
        ++length;
    }
    if ((at[length] == 'e' || at[length] == 'E') && strchr("+-0123456789", at[length + 1]) &&
        at[length + 1]) {
        length += 2;
        while (is_figure(at[length])) {
            ++length;
        }
    }
    return length;
}

/* Whether a word with dots, pin.x, is a component of a point or vector that is called pin; a joint
 * may have the same name, but pin.force.x is none. */
static bool is_component(const se3di_scope *scope, const char *word, size_t length)
{
    char head[64];
    const size_t dot = strcspn(word, ".");
    snprintf(head, sizeof head, "%.*s", (int)dot, word);
    return dot + 2 == length && strchr("xyz", word[dot + 1]) && scope &&
           se3di_scope_find(scope, head);
}

/* The next name at or behind `at` that is a channel's: in ' ', or with a dot. @return NULL: none */
static const char *find_mention(const char *at, const se3di_scope *scope, size_t *length)
{
    while (*at) {
        size_t n = 0;
        if (*at == '\'') {
            const char *end = strchr(at + 1, '\'');
            *length = end ? (size_t)(end - at) + 1 : strlen(at);
            return at;
        }
        if (is_figure(*at) || (*at == '.' && is_figure(at[1]))) {
            at += skip_number(at);
            continue;
        }
        while (is_word(at[n]) || (n > 0 && at[n] == '.' && is_word(at[n + 1])) ||
               (at[n] == '@' && memchr(at, '.', n) && is_word(at[n + 1]))) {
            ++n;
        }
        if (memchr(at, '.', n) && !is_component(scope, at, n)) {
            *length = n;
            return at;
        }
        at += n > 0 ? n : *at == '.' ? 2 : 1; /* .x of a point in parentheses */
        if (at[-1] == '\0') {
            break;
        }
    }
    return NULL;
}

static bool find_in_parts(se3d_model *model, const se3di_component *part, const char *name,
                          se3di_channel *channel, size_t *component, char *problem, size_t size)
{
    char whole[4 * NAME_MAX_LENGTH];
    for (; part && part->prefix[0]; part = part->parent) {
        const size_t head = strcspn(name, "@");
        const char *behind = name[head] ? name + head + 1 : "";
        for (int both = name[head] ? 1 : 0; both >= 0; --both) { /* the reference may be outside */
            snprintf(whole, sizeof whole, "%.200s%.*s%s%.100s%.310s", part->prefix, (int)head, name,
                     name[head] ? "@" : "", both ? part->prefix : "", behind);
            const char *copy = se3di_iopool_copy(&model->pool, whole, strlen(whole));
            if (copy && se3di_channel_find_number(model, copy, channel, component, problem, size)) {
                return true;
            }
        }
    }
    return se3di_channel_find_number(model, name, channel, component, problem, size);
}

static bool is_taken(const se3di_mentions *m, const se3di_scope *scope, const char *name)
{
    for (size_t k = 0; k < m->count; ++k) {
        if (strcmp(m->variables[k], name) == 0) {
            return true;
        }
    }
    return scope && se3di_scope_find(scope, name);
}

/* A variable of the same length as what stands in the text: other characters become '_'. */
static bool make_variable(const se3di_mentions *m, const se3di_scope *scope, char *word)
{
    size_t last = strlen(word);
    for (char *c = word; *c; ++c) {
        *c = is_word(*c) ? *c : '_';
    }
    while (is_taken(m, scope, word) && last > 1) {
        word[--last] = '_';
    }
    return !is_taken(m, scope, word);
}

static bool is_same(const se3di_channel *a, const se3di_channel *b)
{
    return strcmp(a->name, b->name) == 0;
}

/* The variable that stands for a channel: a new one unless it has one already. */
static bool take_mention(se3d_model *model, const se3di_component *part, const char *start,
                         size_t length, char *into, se3di_mentions *m, char *problem, size_t size)
{
    const size_t quote = *start == '\'' ? 1 : 0;
    char *name = se3di_iopool_copy(&model->pool, start + quote, length - 2 * quote);
    char *word = se3di_iopool_copy(&model->pool, start, length);
    se3di_channel channel;
    size_t component = 0;
    if (!name || !word) {
        snprintf(problem, size, "out of memory");
        return false;
    }
    if (length > NAME_MAX_LENGTH || (quote && (length < 2 || start[length - 1] != '\''))) {
        snprintf(problem, size,
                 length > NAME_MAX_LENGTH ? "is longer than any channel's name"
                                          : "a name in ' has no second '");
        return false;
    }
    if (!find_in_parts(model, part, name, &channel, &component, problem, size)) {
        return false;
    }
    for (size_t k = 1; k < m->count; ++k) {
        if (m->channels[k].name && is_same(&m->channels[k], &channel) &&
            m->components[k] == component && strlen(m->variables[k]) == length) {
            memcpy(into, m->variables[k], length);
            return true;
        }
    }
    if (m->count == SE3D_EXPRESSION_VARIABLE_MAX) {
        snprintf(problem, size, "has too many different channels, at most %d variables are allowed",
                 SE3D_EXPRESSION_VARIABLE_MAX);
        return false;
    }
    if (!make_variable(m, part ? part->scope : NULL, word)) {
        snprintf(problem, size, "`%.100s` reads as the parameter of that name", name);
        return false;
    }
    memcpy(into, word, length);
    m->variables[m->count] = word;
    m->channels[m->count] = channel;
    m->dimensions[m->count] = se3di_channel_get_dimension(&channel);
    m->components[m->count++] = component;
    return true;
}

bool se3di_text_has_mention(const se3di_component *part, const char *text)
{
    size_t length = 0;
    return find_mention(text, part ? part->scope : NULL, &length) != NULL;
}

bool se3di_mentions_find(se3d_model *model, const se3di_component *part, const char *text,
                         const char *const *taken, se3di_mentions *mentions, size_t *where,
                         char *problem, size_t size)
{
    const se3di_scope *scope = part ? part->scope : NULL;
    char *copy = se3di_iopool_copy(&model->pool, text, strlen(text));
    size_t length = 0;
    memset(mentions, 0, sizeof *mentions);
    *where = 0;
    for (size_t k = 0; taken[k]; ++k) {
        mentions->variables[mentions->count++] = taken[k];
    }
    mentions->text = copy;
    if (!copy) {
        snprintf(problem, size, "out of memory");
        return false;
    }
    const char *at = find_mention(text, scope, &length);
    for (; at; at = find_mention(at + length, scope, &length)) {
        *where = (size_t)(at - text);
        if (!take_mention(model, part, at, length, copy + *where, mentions, problem, size)) {
            return false;
        }
    }
    return true;
}

static const char *const time_only[] = {"t", NULL};
static const char operators[] = "()+-*/^<>=!,' ";

static bool is_known(se3d_model *model, const char *text)
{
    char problem[480];
    se3di_channel channel;
    size_t component = 0;
    return strlen(text) <= NAME_MAX_LENGTH &&
           (se3di_channel_find(model, text, &channel, problem, sizeof problem) ||
            se3di_channel_find_number(model, text, &channel, &component, problem, sizeof problem));
}

/* Names may have such characters themselves. */
static bool begins_with_name(const se3d_model *model, const char *text)
{
    char head[128];
    snprintf(head, sizeof head, "%.*s", (int)strcspn(text, "."), text);
    return head[strcspn(head, operators)] &&
           (se3di_ionames_find(&model->body_names, head, NULL) ||
            se3di_ionames_find(&model->element_names, head, NULL));
}

bool se3di_text_is_combination(se3d_model *model, const char *text)
{
    return text[strcspn(text, operators)] && !begins_with_name(model, text) &&
           !is_known(model, text);
}

/* The expression goes with the model: its memory is the pool's. */
static void *pool_alloc(void *ctx, size_t size)
{
    return se3di_iopool_alloc(ctx, size);
}

static void *pool_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    void *grown = se3di_iopool_alloc(ctx, new_size);
    if (grown && memory) {
        memcpy(grown, memory, old_size < new_size ? old_size : new_size);
    }
    return grown;
}

static void pool_free(void *ctx, void *memory, size_t size)
{
    (void)ctx;
    (void)memory;
    (void)size;
}

/* Parts and expression of a channel that is of the time and of `m`. */
static bool fill(se3d_model *model, const se3di_mentions *m, const char *name,
                 const se3d_expression *expression, se3di_channel *channel)
{
    const size_t count = m->count - 1;
    se3di_combination *c = se3di_iopool_alloc(&model->pool, sizeof *c);
    se3di_channel *parts = se3di_iopool_array(&model->pool, count + 1, sizeof *parts);
    size_t *components = se3di_iopool_array(&model->pool, count + 1, sizeof *components);
    if (!c || !parts || !components) {
        return false;
    }
    memcpy(parts, m->channels + 1, count * sizeof *parts);
    memcpy(components, m->components + 1, count * sizeof *components);
    *c = (se3di_combination){expression, parts, components, count};
    *channel = (se3di_channel){.name = name, .combination = c};
    return true;
}

bool se3di_mentions_eval(se3di_reader *reader, const se3di_node *node, const se3di_mentions *m,
                         const se3di_node *plain, se3di_amount *q)
{
    reader->measured = (se3di_measured){m->variables, m->dimensions, node->text};
    const bool good = se3di_amount_eval(reader, plain, m->variables, q);
    reader->measured = (se3di_measured){NULL, NULL, NULL};
    if (good && q->rank != 1) {
        return se3di_reader_fail(reader, node, "`%.120s` is a vector, must be a number",
                                 node->text);
    }
    return good;
}

/* In SI units, from those of the file. */
static bool make_plain(se3di_reader *reader, const se3di_node *node, const se3di_mentions *m,
                       se3di_node *plain)
{
    se3di_amount q;
    if (!se3di_mentions_eval(reader, node, m, plain, &q) ||
        !se3di_amount_take_plain(reader, plain, &q)) {
        return false;
    }
    if (!q.text[0]) {
        return se3di_reader_fail(reader, node, "`%.120s` is a constant, must name a channel",
                                 node->text);
    }
    plain->text = q.text[0];
    plain->one_line = false;
    return true;
}

bool se3di_combination_read(se3di_reader *reader, const se3di_node *node, const char *name,
                            se3di_channel *channel)
{
    se3d_model *model = reader->model;
    se3d_expression_def def = se3d_expression_def_default();
    const se3d_allocator memory = {pool_alloc, pool_realloc, pool_free, &model->pool};
    se3d_expression *expression = NULL;
    se3di_mentions *m = se3di_iopool_alloc(&model->pool, sizeof *m);
    se3di_node plain = *node;
    if (!m) {
        return se3di_reader_fail_memory(reader);
    }
    if (!se3di_check_expression(reader, node) || !se3di_mentions_read(reader, node, time_only, m)) {
        return false;
    }
    plain.text = m->text;
    if (se3di_amount_is_needed(reader, m->text) && !make_plain(reader, node, m, &plain)) {
        return false;
    }
    def.variables = m->variables;
    def.variable_count = m->count;
    def.allocator = &memory;
    def.text = plain.text;
    plain.text = node->text;
    if (!se3di_read_compile(reader, &plain, &def, &expression)) {
        return false;
    }
    if (m->count == 1) {
        return se3di_reader_fail(reader, node,
                                 "`%.120s` names no channel, must be a channel such as pin.angle, "
                                 "or an expression of some",
                                 node->text);
    }
    return fill(model, m, name, expression, channel) || se3di_reader_fail_memory(reader);
}

bool se3di_mentions_read(se3di_reader *reader, const se3di_node *node, const char *const *taken,
                         se3di_mentions *m)
{
    char problem[480] = "";
    size_t where = 0;
    se3di_node place = *node;
    if (se3di_mentions_find(reader->model, reader->part, node->text, taken, m, &where, problem,
                            sizeof problem)) {
        return true;
    }
    if (node->one_line) {
        place.column += where + (node->plain ? 0 : 1);
    }
    return se3di_reader_fail(reader, &place, "%s", problem);
}

bool se3di_combination_find(se3d_model *model, const char *text, se3di_channel *channel,
                            char *problem, size_t size)
{
    const se3d_allocator memory = {pool_alloc, pool_realloc, pool_free, &model->pool};
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression_error error = {0};
    se3d_expression *expression = NULL;
    se3di_mentions *m = se3di_iopool_alloc(&model->pool, sizeof *m);
    size_t where = 0;
    if (!m) {
        snprintf(problem, size, "out of memory");
        return false;
    }
    if (!se3di_mentions_find(model, NULL, text, time_only, m, &where, problem, size)) {
        return false;
    }
    def.text = m->text;
    def.variables = m->variables;
    def.variable_count = m->count;
    def.allocator = &memory;
    if (se3d_expression_create(&def, &expression, &error) < 0) {
        snprintf(problem, size, "`%.200s`, column %zu: %s", text, error.column, error.message);
        return false;
    }
    if (m->count == 1 || !fill(model, m, text, expression, channel)) {
        snprintf(problem, size, m->count == 1 ? "`%.200s` names no channel" : "%.1sout of memory",
                 m->count == 1 ? text : "");
        return false;
    }
    return true;
}

bool se3di_component_find(se3d_model *model, const char *name, se3di_channel *channel,
                          char *problem, size_t size)
{
    se3di_mentions *m = se3di_iopool_alloc(&model->pool, sizeof *m);
    if (!m) {
        snprintf(problem, size, "out of memory");
        return false;
    }
    m->count = 2;
    if (!se3di_channel_find_number(model, name, &m->channels[1], &m->components[1], problem,
                                   size)) {
        return false;
    }
    if (!fill(model, m, name, NULL, channel)) {
        snprintf(problem, size, "out of memory");
        return false;
    }
    return true;
}
