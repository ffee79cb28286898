/* SPDX-License-Identifier: BSD-3-Clause */
/* Settings by path: the tree is changed before its sections are read, so that what is set is
 * checked as if it stood in the file. It has no line: messages name its path alone. */
#include "io/document/setting.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/guess.h"

enum { WORD_SIZE = 128 };

typedef struct walk {
    const se3d_model_setting *setting;
    se3d_model_error *error;
    const char *at;       /* the rest of the path */
    char word[WORD_SIZE]; /* the step at hand: a key or name; empty: `index` */
    size_t index;
    se3di_node *map;  /* what holds the place that was reached; NULL: the document itself */
    se3di_node *node; /* what stands there; NULL: a key that its map does not have */
} walk;

bool se3di_setting_is_path(const se3d_model_setting *setting)
{
    return setting->name && strpbrk(setting->name, ".[");
}

SE3DI_IO_FORMAT(2, 3)
static bool fail(const walk *w, const char *format, ...)
{
    char text[640];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    se3di_document_report(w->error, "", 0, 0, w->setting->name, text);
    return false;
}

static bool fail_syntax(const walk *w)
{
    return fail(w, "is no path: names or keys with dots between them, entries of a list also as "
                   "[0], such as bodies.bar.mass or output[0].every");
}

/* The next step: "[3]", or a word up to the next '.' or '['. */
static bool take_step(walk *w)
{
    size_t length = 0;
    w->word[0] = '\0';
    if (*w->at == '[') {
        const char *digit = w->at + 1;
        const size_t digits = strspn(digit, "0123456789");
        w->index = 0;
        for (size_t k = 0; k < digits && digits < 9; ++k) {
            w->index = 10 * w->index + (size_t)(digit[k] - '0');
        }
        if (digits == 0 || digits >= 9 || digit[digits] != ']') {
            return fail_syntax(w);
        }
        w->at = digit + digits + 1;
    } else {
        length = strcspn(w->at, ".[");
        if (length == 0 || length >= sizeof w->word) {
            return fail_syntax(w);
        }
        memcpy(w->word, w->at, length);
        w->word[length] = '\0';
        w->at += length;
    }
    if (*w->at == '.') {
        ++w->at;
        return (*w->at && *w->at != '[') || fail_syntax(w);
    }
    return !*w->at || *w->at == '[' || fail_syntax(w);
}

/* The name of an entry of a list; NULL: it has none. */
static const char *name_of(const se3di_node *entry)
{
    const se3di_node *name = se3di_node_get(entry, "name");
    return name && name->kind == SE3DI_NODE_SCALAR ? name->text : NULL;
}

static se3di_node *find_entry(const walk *w, const se3di_node *list)
{
    se3di_node *entry = list->first;
    for (; entry; entry = entry->next) {
        const char *name = name_of(entry);
        if (w->word[0] ? name && strcmp(name, w->word) == 0 : entry->index == w->index) {
            return entry;
        }
    }
    return NULL;
}

/* The step leads nowhere: what does. */
static bool fail_step(const walk *w)
{
    char path[256] = "";
    const se3di_node *from = w->node;
    se3di_guess guess = se3di_guess_begin(w->word);
    se3di_node_format_path(from, path, sizeof path);
    const char *quote = path[0] ? "`" : "";
    const char *place = path[0] ? path : "the model";
    if (from->kind == SE3DI_NODE_SCALAR) {
        return fail(w, "%s%.200s%s is %s and holds nothing else", quote, place, quote,
                    se3di_node_describe(from));
    }
    if (!w->word[0]) {
        return fail(w, "%s%.200s%s has %zu %s, the first is [0]", quote, place, quote, from->count,
                    from->count == 1 ? "entry" : "entries");
    }
    for (const se3di_node *child = from->first; child; child = child->next) {
        const char *name = child->key ? child->key : name_of(child);
        if (name) {
            se3di_guess_offer(&guess, name);
        }
    }
    const char *meant = se3di_guess_get(&guess);
    return fail(w, "%s%.200s%s has no `%s`%s%s%s", quote, place, quote, w->word,
                meant ? ", did you mean `" : "", meant ? meant : "", meant ? "`?" : "");
}

/* One step down; the last one may name a key that is new. */
static bool step_down(walk *w)
{
    se3di_node *next = NULL;
    if (w->node->kind == SE3DI_NODE_LIST) {
        next = find_entry(w, w->node);
    } else if (w->word[0]) {
        next = se3di_node_get(w->node, w->word);
    }
    const bool is_new = !next && !*w->at && w->node->kind == SE3DI_NODE_MAP && w->word[0];
    if (!next && !is_new) {
        return fail_step(w);
    }
    w->map = w->node;
    w->node = next;
    return true;
}

/* The node behind `node` in the order of the text, inside `top`. */
static se3di_node *next_inside(se3di_node *node, const se3di_node *top)
{
    if (node->first) {
        return node->first;
    }
    while (node != top && !node->next) {
        node = node->parent;
    }
    return node == top ? NULL : node->next;
}

/* Nothing of the value stands in the file. */
static void forget_places(se3di_node *value)
{
    for (se3di_node *node = value; node; node = next_inside(node, value)) {
        node->line = node->column = node->key_line = node->key_column = 0;
        node->one_line = false;
    }
    value->file = NULL;
}

static void put_behind(se3di_node *parent, se3di_node *before, se3di_node *value)
{
    if (before) {
        before->next = value;
    } else {
        parent->first = value;
    }
    if (!value->next) {
        parent->last = value;
    }
}

/* The value takes the place of w->node, or the end of w->map. */
static void put(const walk *w, se3di_node *value, const char *key)
{
    se3di_node *before = NULL;
    for (se3di_node *child = w->map->first; child != w->node; child = child->next) {
        before = child;
    }
    value->parent = w->map;
    value->key = w->node ? w->node->key : key;
    value->index = w->node ? w->node->index : w->map->count++;
    value->next = w->node ? w->node->next : NULL;
    put_behind(w->map, before, value);
}

se3d_status se3di_setting_apply(se3di_iopool *pool, se3di_node *root,
                                const se3d_model_setting *setting, se3d_model_error *error)
{
    walk w = {.setting = setting, .error = error, .at = setting->name, .node = root};
    se3di_node *value = NULL;
    do {
        if (!take_step(&w) || !step_down(&w)) {
            return SE3D_ERR_MODEL;
        }
    } while (*w.at);
    const char *text = setting->value;
    const se3d_status status =
        se3di_document_parse_value(pool, setting->name, text, strlen(text), &value, error);
    if (status < 0) {
        return status;
    }
    const char *key = se3di_iopool_copy(pool, w.word, strlen(w.word));
    if (!key) {
        fail(&w, "out of memory");
        return SE3D_ERR_NO_MEMORY;
    }
    forget_places(value);
    put(&w, value, key);
    return SE3D_OK;
}
