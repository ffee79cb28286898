/* SPDX-License-Identifier: BSD-3-Clause */
/* Keys, words and names. */
#include "io/document/reader.h"

#include <stdio.h>
#include <string.h>

#include "io/document/document.h"
#include "io/document/guess.h"
#include "io/document/keys.h"

/* Append "a, b, c" to `text`. */
static void append_word(char *text, size_t size, const char *word)
{
    const size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "", word);
}

static bool fail_unknown_key(se3di_reader *reader, const se3di_node *child,
                             const se3di_object *object)
{
    char path[256];
    char text[640];
    char list[480];
    se3di_guess guess = se3di_guess_begin(child->key);
    for (const se3di_key *row = object->keys; row->key; ++row) {
        if (!se3di_node_get(child->parent, row->key)) {
            se3di_guess_offer(&guess, row->key);
        }
    }
    const bool is_cut = (strchr(child->key, '(') != NULL) != (strchr(child->key, ')') != NULL);
    const char *meant = is_cut ? NULL : se3di_guess_get(&guess);
    reader->fault = se3di_fault_of(child);
    reader->fault.meant = meant;
    reader->fault.is_key = true;
    se3di_node_format_path(child->parent, path, sizeof path);
    if (is_cut) {
        snprintf(text, sizeof text,
                 "`%.60s` is the rest of an expression that was cut at a comma: inside { } an "
                 "expression with a comma needs quotes",
                 child->key);
    } else if (meant) {
        snprintf(text, sizeof text, "the key `%.60s` is unknown, did you mean `%s`?", child->key,
                 meant);
    } else {
        se3di_object_list(object, NULL, ", ", list, sizeof list);
        snprintf(text, sizeof text, "the key `%.60s` is unknown, allowed are: %s", child->key,
                 list);
    }
    return se3di_reader_fail_at(reader, child, child->key_line, child->key_column, path, text);
}

bool se3di_check_whole(se3di_reader *reader, const se3di_node *node)
{
    return !node->is_cut || se3di_reader_fail(reader, node,
                                              "`%.120s` is cut at its commas: inside { } an "
                                              "expression with a comma needs quotes",
                                              node->text);
}

bool se3di_read_keys(se3di_reader *reader, const se3di_node *node, const se3di_object *object)
{
    if (node->kind != SE3DI_NODE_MAP) {
        return se3di_reader_fail(reader, node, "is %s, must be a map such as {%s: ...}",
                                 se3di_node_describe(node), object->keys[0].key);
    }
    for (se3di_node *child = node->first; child; child = child->next) {
        if (!se3di_check_whole(reader, child)) {
            return false;
        }
        const bool known = reader->study && child->row; /* by the reading of the model itself */
        child->row = known ? child->row : se3di_object_find(object, NULL, child->key);
        if (!child->row) {
            return fail_unknown_key(reader, child, object);
        }
    }
    return true;
}

/* The keys that this type does not have. */
static bool check_type_keys(se3di_reader *reader, const se3di_node *node,
                            const se3di_object *object, const char *type)
{
    for (se3di_node *child = node->first; child; child = child->next) {
        child->row = se3di_object_find(object, type, child->key);
        if (!child->row) {
            char path[256];
            char list[480];
            char text[640];
            se3di_node_format_path(child, path, sizeof path);
            se3di_object_list(object, type, ", ", list, sizeof list);
            reader->fault = se3di_fault_of(child);
            snprintf(text, sizeof text, "`%s` has no such key, allowed are: %s", type, list);
            return se3di_reader_fail_at(reader, child, child->key_line, child->key_column, path,
                                        text);
        }
    }
    return true;
}

static bool fail_unknown_type(se3di_reader *reader, const se3di_node *map, const se3di_node *node,
                              const se3di_object *object)
{
    char list[480] = "";
    const char *text = node ? node->text : NULL;
    se3di_guess guess = se3di_guess_begin(text ? text : "");
    for (const char *const *type = object->types; *type; ++type) {
        append_word(list, sizeof list, *type);
        se3di_guess_offer(&guess, *type);
    }
    const char *meant = se3di_guess_get(&guess);
    if (!node) {
        return se3di_reader_fail_key(reader, map, "type", "is missing, must be one of: %s", list);
    }
    if (!text) {
        return se3di_reader_fail(reader, node, "is %s, must be one of: %s",
                                 se3di_node_describe(node), list);
    }
    const char *place = se3di_guess_place(text);
    if (place) {
        return se3di_reader_fail(reader, node, "`%.60s` is not a %s type, but %s; allowed are: %s",
                                 text, object->name, place, list);
    }
    se3di_reader_fail(reader, node, "the %s type `%.60s` is not supported, %s%s%s", object->name,
                      text, meant ? "did you mean `" : "allowed are: ", meant ? meant : list,
                      meant ? "`?" : "");
    return se3di_reader_propose(reader, meant);
}

bool se3di_read_type(se3di_reader *reader, const se3di_node *node, const se3di_object *object,
                     const char **type)
{
    if (!se3di_read_keys(reader, node, object)) {
        return false;
    }
    const se3di_node *child = se3di_node_get(node, "type");
    for (const char *const *known = object->types; child && child->text && *known; ++known) {
        if (strcmp(*known, child->text) == 0) {
            *type = *known;
            return check_type_keys(reader, node, object, *known);
        }
    }
    return fail_unknown_type(reader, node, child, object);
}

bool se3di_reader_wants(const se3di_reader *reader, const se3di_node *node)
{
    bool wanted = !reader->wanted;
    for (size_t k = 0; reader->wanted && k < reader->wanted->count && !wanted; ++k) {
        wanted = reader->wanted->nodes[k] == node;
    }
    return wanted;
}

bool se3di_read_list(se3di_reader *reader, const se3di_node *map, const char *key,
                     const se3di_node **list)
{
    *list = se3di_node_get(map, key);
    if (*list && se3di_node_is_null(*list)) {
        *list = NULL;
    }
    if (*list && (*list)->kind != SE3DI_NODE_LIST) {
        return se3di_reader_fail(reader, *list, "is %s, must be a list",
                                 se3di_node_describe(*list));
    }
    return true;
}

bool se3di_read_word(se3di_reader *reader, const se3di_node *node, const char *const *words,
                     size_t *index)
{
    char list[480] = "";
    se3di_guess guess = se3di_guess_begin(node->text ? node->text : "");
    for (size_t k = 0; words[k]; ++k) {
        if (node->text && strcmp(node->text, words[k]) == 0) {
            *index = k;
            return true;
        }
        append_word(list, sizeof list, words[k]);
        se3di_guess_offer(&guess, words[k]);
    }
    const char *meant = se3di_guess_get(&guess);
    if (!node->text) {
        return se3di_reader_fail(reader, node, "is %s, must be one of: %s",
                                 se3di_node_describe(node), list);
    }
    if (meant) {
        se3di_reader_fail(reader, node, "is `%.60s`, did you mean `%s`? Allowed are: %s",
                          node->text, meant, list);
        return se3di_reader_propose(reader, meant);
    }
    return se3di_reader_fail(reader, node, "is `%.60s`, must be one of: %s", node->text, list);
}

bool se3di_read_text(se3di_reader *reader, const se3di_node *node, const char **text)
{
    if (node->kind != SE3DI_NODE_SCALAR) {
        return se3di_reader_fail(reader, node, "is %s, must be a text", se3di_node_describe(node));
    }
    *text = node->text;
    return true;
}

bool se3di_read_bool(se3di_reader *reader, const se3di_node *node, int32_t *value)
{
    if (node->text && strcmp(node->text, "true") == 0) {
        *value = 1;
    } else if (node->text && strcmp(node->text, "false") == 0) {
        *value = 0;
    } else {
        return se3di_reader_fail(
            reader, node, "is %s%.60s%s, must be true or false", node->text ? "`" : "",
            node->text ? node->text : se3di_node_describe(node), node->text ? "`" : "");
    }
    return true;
}

/* UTF-8 without what cannot be shown. */
static bool is_plain(const char *text)
{
    size_t length = 0;
    while ((length = se3d_text_get_character(text)) > 0) {
        text += length;
    }
    return *text == '\0';
}

bool se3di_read_name(se3di_reader *reader, const se3di_node *node, const char **name)
{
    if (!se3di_read_reference(reader, node, name)) {
        return false;
    }
    const char *text = *name;
    const size_t length = strlen(text);
    bool good = length > 0 && length <= 100 && text[0] != ' ' && text[length - 1] != ' ';
    good = good && !text[strcspn(text, ".,;\"'`[]{}")] && is_plain(text);
    if (!good) {
        return se3di_reader_fail(reader, node,
                                 "the name `%.60s` is not allowed: 1 to 100 characters, none of "
                                 ". , ; \" ' ` [ ] { }, no control characters and no blank at its "
                                 "ends",
                                 text);
    }
    return true;
}

bool se3di_reader_try_symbol(se3di_reader *reader, const char *name, bool *is_good)
{
    *is_good = se3di_text_is_identifier(name) && strlen(name) <= 60;
    if (!*is_good) {
        return true;
    }
    const se3d_expression_symbol symbol = {name, 1.0};
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    def.text = "1";
    def.symbols = &symbol;
    def.symbol_count = 1;
    def.allocator = se3di_iopool_lend(reader->pool);
    const se3d_status status = se3d_expression_create(&def, &expression, NULL);
    se3d_expression_destroy(expression);
    *is_good = status >= 0;
    return status != SE3D_ERR_NO_MEMORY || se3di_reader_fail_memory(reader);
}

const char *se3di_reader_prefix(se3di_reader *reader, const char *name)
{
    const char *prefix = reader->part ? reader->part->prefix : "";
    const size_t length = strlen(prefix);
    char *whole =
        length > 0 ? se3di_iopool_array(reader->pool, length + strlen(name) + 1, 1) : NULL;
    if (length == 0) {
        return name;
    }
    if (!whole) {
        se3di_reader_fail_memory(reader);
        return NULL;
    }
    memcpy(whole, prefix, length);
    memcpy(whole + length, name, strlen(name) + 1);
    return whole;
}

bool se3di_read_part_name(se3di_reader *reader, const se3di_node *node, const char **name)
{
    const char *text = NULL;
    if (!se3di_read_name(reader, node, &text)) {
        return false;
    }
    *name = se3di_reader_prefix(reader, text);
    if (*name && strlen(*name) > 100) {
        return se3di_reader_fail(reader, node,
                                 "the name `%.60s...` has %zu characters with its prefix, at most "
                                 "100 are allowed",
                                 *name, strlen(*name));
    }
    return *name != NULL;
}

bool se3di_reader_find(se3di_reader *reader, const se3di_ionames *names, const char *name,
                       size_t *index)
{
    char whole[256];
    for (const se3di_component *part = reader->part; part; part = part->parent) {
        snprintf(whole, sizeof whole, "%.110s%.110s", part->prefix, name);
        if (se3di_ionames_find(names, whole, index)) {
            return true;
        }
    }
    return false;
}

/* Parts between '/' are not empty, "." or "..". */
static bool stays_inside(const char *name)
{
    for (const char *part = name;; ++part) {
        const size_t length = strcspn(part, "/");
        if (length == 0 || (length == 1 && part[0] == '.') ||
            (length == 2 && part[0] == '.' && part[1] == '.')) {
            return false;
        }
        part += length;
        if (*part == '\0') {
            return true;
        }
    }
}

/* Programs to which the user gives such a file take a part that begins so for an option, a pipe or
 * another folder. */
static bool is_like_command(const char *name)
{
    for (const char *part = name; part; part = strchr(part, '/')) {
        part += *part == '/';
        if (*part && strchr("-|<>~", *part)) {
            return true;
        }
    }
    return false;
}

bool se3di_read_file_name(se3di_reader *reader, const se3di_node *node, const char **name)
{
    static const char tail[] = ".partial";
    if (!se3di_read_text(reader, node, name)) {
        return false;
    }
    const char *text = *name;
    const size_t length = strlen(text);
    if (length == 0 || length > 1000 || strchr(text, '\\') || !is_plain(text)) {
        return se3di_reader_fail(reader, node,
                                 "`%.60s` is not a file name: 1 to 1000 characters, no \\ and no "
                                 "control characters",
                                 text);
    }
    if (!stays_inside(text) || (length > 1 && text[1] == ':')) {
        return se3di_reader_fail(reader, node,
                                 "`%.60s` must be a file inside the results folder: a "
                                 "relative path without `..`, `.` and `//`",
                                 text);
    }
    if (is_like_command(text)) {
        return se3di_reader_fail(reader, node,
                                 "`%.60s`: no part of it may begin with `-`, `|`, `<`, `>` or `~`: "
                                 "other programs would not take it for a file name",
                                 text);
    }
    if (length >= sizeof tail - 1 && strcmp(text + length - (sizeof tail - 1), tail) == 0) {
        return se3di_reader_fail(reader, node, "`%.60s` must not end with %s", text, tail);
    }
    return true;
}

bool se3di_text_is_identifier(const char *text)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
    static const char more[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
    return strspn(text, letters) > 0 && text[strspn(text, more)] == '\0';
}
