/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/document/omitted.h"

#include <string.h>

#include "base/hash.h"

/* A place in a text. */
typedef struct cursor {
    const unsigned char *text;
    size_t length, at;
    size_t line, column; /* 1-based, in characters */
} cursor;

/* Bytes of the line break at the cursor, as libyaml knows them; 0: there is none. */
static size_t break_length(const cursor *c)
{
    const unsigned char *s = c->text + c->at;
    const size_t rest = c->length - c->at;
    if (s[0] == '\r') {
        return rest > 1 && s[1] == '\n' ? 2 : 1;
    }
    if (s[0] == '\n') {
        return 1;
    }
    if (rest > 1 && s[0] == 0xC2 && s[1] == 0x85) {
        return 2;
    }
    return rest > 2 && s[0] == 0xE2 && s[1] == 0x80 && (s[2] == 0xA8 || s[2] == 0xA9) ? 3 : 0;
}

static void step(cursor *c)
{
    const size_t broken = break_length(c);
    if (broken > 0) {
        c->at += broken;
        ++c->line;
        c->column = 1;
        return;
    }
    do {
        ++c->at;
    } while (c->at < c->length && (c->text[c->at] & 0xC0) == 0x80);
    ++c->column;
}

/* The cursor, which is before it, comes to where the characters of a scalar begin. @return false:
 * they do not stand there as they are */
static bool find(cursor *c, const se3di_node *node)
{
    const size_t size = strlen(node->text);
    while (c->at < c->length &&
           (c->line < node->line || (c->line == node->line && c->column < node->column))) {
        step(c);
    }
    if (!node->plain && c->at < c->length) {
        step(c); /* the quote */
    }
    return c->line == node->line && c->length - c->at >= size &&
           memcmp(c->text + c->at, node->text, size) == 0;
}

static size_t list_durations(const se3di_node *root, const se3di_node *list[SE3DI_DURATIONS_MAX])
{
    const se3di_node *all = se3di_node_get(root, "analysis");
    const bool is_list = all && all->kind == SE3DI_NODE_LIST;
    size_t count = 0;
    for (const se3di_node *one = is_list ? all->first : all; one && count < SE3DI_DURATIONS_MAX;
         one = is_list ? one->next : NULL) {
        const se3di_node *duration = se3di_node_get(one, "duration");
        if (duration && duration->kind == SE3DI_NODE_SCALAR && duration->one_line) {
            list[count++] = duration;
        }
    }
    return count;
}

uint64_t se3di_hash_without_durations(const char *text, size_t length, const se3di_node *root)
{
    const se3di_node *durations[SE3DI_DURATIONS_MAX];
    const size_t count = list_durations(root, durations);
    const size_t mark = se3di_byte_order_mark_length(text, length);
    cursor c = {(const unsigned char *)text, length, mark, 1, 1};
    uint64_t hash = SE3DI_HASH_START;
    size_t hashed = 0;
    for (size_t k = 0; k < count; ++k) { /* in the order of the text */
        if (find(&c, durations[k])) {
            hash = se3di_hash_bytes(hash, text + hashed, c.at - hashed);
            hashed = c.at + strlen(durations[k]->text);
            hash = se3di_hash_bytes(hash, "duration", sizeof "duration");
        }
    }
    return se3di_hash_bytes(hash, text + hashed, length - hashed);
}

bool se3di_setting_is_duration(const se3d_model_setting *setting)
{
    static const char list[] = "analysis", key[] = ".duration";
    const char *at = setting->name;
    if (strncmp(at, list, sizeof list - 1) != 0) {
        return false;
    }
    at += sizeof list - 1;
    if (*at == '[') {
        at += 1 + strspn(at + 1, "0123456789");
        at += *at == ']';
    }
    return strcmp(at, key) == 0;
}
