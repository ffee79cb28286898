/* SPDX-License-Identifier: BSD-3-Clause */
/* Parameters and points: numbers, vectors and expressions over one another, in any order.
 *
 * Each is evaluated after those that its text names (depth first over an explicit stack, so that
 * long chains need no recursion); one that is met again while it waits is part of a cycle. */
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/amount.h"
#include "io/document/document.h"
#include "io/document/formula.h"
#include "io/document/guess.h"
#include "io/document/reader.h"
#include "io/document/setting.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/parameters.h"
#include "io/read/point_table.h"
#include "io/read/sections.h"
#include "io/read/units.h"

typedef enum parameter_state { NEW = 0, WAITING = 1, DONE = 2 } parameter_state;

typedef struct parameter {
    const se3di_node *node;
    const char *text;        /* where the search for names goes on */
    const se3di_node *place; /* of the list's entry that it is in; NULL: no list */
    bool is_point;
    const se3di_amount *given; /* by the entry that includes the part; NULL: its own */
    parameter_state state;
} parameter;

typedef struct resolver {
    se3di_reader *reader;
    parameter *list;
    size_t count;
    se3di_ionames names;
    size_t *stack;
    size_t depth;
    se3di_scope *scope;            /* those that are done */
    const se3di_component *caller; /* NULL: the model itself */
} resolver;

static const char *const reserved[] = {"t", "pi", "deg", "ground", NULL};

static bool check_name(se3di_reader *reader, const se3di_node *node)
{
    bool good = true;
    if (!se3di_reader_try_symbol(reader, node->key, &good)) {
        return false;
    }
    for (const char *const *word = reserved; *word; ++word) {
        good = good && strcmp(*word, node->key) != 0;
    }
    if (!good) {
        se3di_node place = *node;
        place.line = node->key_line;
        place.column = node->key_column;
        if (strpbrk(node->key, "()")) {
            return se3di_reader_fail(reader, &place,
                                     "is the rest of an expression that was cut at a comma: inside "
                                     "{ } an expression with a comma needs quotes");
        }
        return se3di_reader_fail(reader, &place,
                                 "the name is not allowed: letters, digits and _, not beginning "
                                 "with a digit, and not t or the name of a constant or function");
    }
    return true;
}

/* The next name of a parameter or point in the text, from *text on. */
static bool next_name(const resolver *r, const char **text, size_t *index)
{
    char word[64];
    size_t length = 0;
    const char *at = se3di_amount_next_name(*text, &length);
    for (; at; at = se3di_amount_next_name(at + length, &length)) {
        *text = at + length;
        if (length < sizeof word) {
            memcpy(word, at, length);
            word[length] = '\0';
            if (se3di_ionames_find(&r->names, word, index)) {
                return true;
            }
        }
    }
    *text = "";
    return false;
}

static bool fail_cycle(resolver *r, size_t again)
{
    char text[400] = "";
    size_t k = 0;
    while (r->stack[k] != again) {
        ++k;
    }
    for (; k < r->depth && strlen(text) < 300; ++k) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%.60s -> ", r->list[r->stack[k]].node->key);
    }
    return se3di_reader_fail(r->reader, r->list[again].node,
                             "depends on itself: %s%.60s; parameters must not form a cycle", text,
                             r->list[again].node->key);
}

/* The next name in the text, or in those of the entries of a list. */
static bool next_name_of(const resolver *r, parameter *p, size_t *index)
{
    while (!next_name(r, &p->text, index)) {
        p->place = p->place ? p->place->next : NULL;
        if (!p->place) {
            return false;
        }
        p->text = p->place->text ? p->place->text : "";
    }
    return true;
}

/* A list of three numbers that are alike. */
static bool read_list(se3di_reader *reader, const se3di_node *node, se3di_amount *value)
{
    se3di_amount part[3];
    size_t k = 0;
    if (node->count != 3) {
        return se3di_reader_fail(
            reader, node, "has %zu entries, must be a number or a list of 3 numbers", node->count);
    }
    for (const se3di_node *child = node->first; child; child = child->next, ++k) {
        if (!se3di_read_amount(reader, child, &part[k])) {
            return false;
        }
        if (part[k].rank != 1) {
            return se3di_reader_fail(reader, child, "`%.120s` is a vector, must be a number",
                                     child->text);
        }
    }
    se3di_formula f = {.reader = reader, .node = node, .text = ""};
    for (int round = 0; round < 2; ++round) {
        if (!se3di_formula_unify(&f, f.text, &part[0], &part[1]) ||
            !se3di_formula_unify(&f, f.text, &part[0], &part[2])) {
            return false;
        }
    }
    *value = part[0];
    value->rank = 3;
    for (k = 0; k < 3; ++k) {
        value->v[k] = part[k].v[0];
    }
    return true;
}

bool se3di_read_value(se3di_reader *reader, const se3di_node *node, se3di_amount *value)
{
    return node->kind == SE3DI_NODE_LIST ? read_list(reader, node, value)
                                         : se3di_read_amount(reader, node, value);
}

/* What the caller gives for a point is in the units of the caller. */
static bool take_given(se3di_reader *reader, const se3di_component *caller, const se3di_node *node,
                       se3di_amount *value)
{
    const se3di_measure metre = {{1, 0, 0, 0}, 1.0, 1.0};
    if (value->rank != 3 ||
        (value->hard && !se3di_dimension_fits(value->dimension, metre.dimension))) {
        return se3di_reader_fail(reader, node, "is a point, but what is given for it is not");
    }
    if (!value->hard) {
        const se3di_measure unit = se3di_units_of(&caller->scope->units, metre.dimension);
        for (size_t k = 0; k < 3; ++k) {
            value->v[k] = value->v[k] * unit.times / unit.over;
        }
    }
    value->hard = true;
    value->dimension = metre.dimension;
    return true;
}

/* A point is a length, whatever is written. */
static bool read_point(se3di_reader *reader, const se3di_node *node, se3di_amount *value)
{
    *value = (se3di_amount){.rank = 3, .hard = true, .dimension = {1, 0, 0, 0}};
    return se3di_read_vector(reader, node, 3, value->v);
}

/* `given` (NULL: nothing) stands for what its own entry says. */
static bool eval_entry(se3di_reader *reader, const se3di_component *caller, const se3di_node *node,
                       bool is_point, const se3di_amount *given, se3di_amount *value)
{
    if (!given) {
        return is_point ? read_point(reader, node, value) : se3di_read_value(reader, node, value);
    }
    *value = *given;
    return !is_point || take_given(reader, caller, node, value);
}

bool se3di_read_parameter_again(se3di_reader *reader, se3di_scope *scope, const se3di_node *node,
                                bool is_point, const se3di_amount *given)
{
    se3di_amount value;
    return eval_entry(reader, reader->part->parent, node, is_point, given, &value) &&
           (se3di_scope_renew(scope, node->key, &value) ||
            se3di_reader_fail(reader, node, "is of another kind than before"));
}

static bool finish(resolver *r, size_t index)
{
    parameter *p = &r->list[index];
    se3di_amount value;
    if (!eval_entry(r->reader, r->caller, p->node, p->is_point, p->given, &value)) {
        return false;
    }
    p->state = DONE;
    return se3di_scope_add(r->scope, r->reader->pool, p->node->key, &value) ||
           se3di_reader_fail_memory(r->reader);
}

static bool resolve(resolver *r, size_t start)
{
    r->stack[0] = start;
    r->depth = 1;
    r->list[start].state = WAITING;
    while (r->depth > 0) {
        parameter *p = &r->list[r->stack[r->depth - 1]];
        size_t index = 0;
        if (!next_name_of(r, p, &index)) {
            if (!finish(r, r->stack[r->depth - 1])) {
                return false;
            }
            --r->depth;
        } else if (r->list[index].state == WAITING) {
            return fail_cycle(r, index);
        } else if (r->list[index].state == NEW) {
            r->list[index].state = WAITING;
            r->stack[r->depth++] = index;
        }
    }
    return true;
}

static bool apply_settings(resolver *r)
{
    se3di_reader *reader = r->reader;
    for (size_t k = 0; k < reader->options->setting_count; ++k) {
        const se3d_model_setting *setting = &reader->options->settings[k];
        se3di_node *node = se3di_node_of_text(reader->pool, setting->name, setting->value);
        size_t index = 0;
        if (se3di_setting_is_path(setting)) {
            continue; /* it was put in its place already */
        }
        if (!node) {
            return se3di_reader_fail_memory(reader);
        }
        if (!se3di_ionames_find(&r->names, setting->name, &index)) {
            char list[400] = "";
            se3di_guess guess = se3di_guess_begin(setting->name);
            for (size_t i = 0; i < r->count; ++i) {
                const size_t used = strlen(list);
                snprintf(list + used, sizeof list - used, "%s%s", used > 0 ? ", " : "",
                         r->list[i].node->key);
                se3di_guess_offer(&guess, r->list[i].node->key);
            }
            const char *meant = se3di_guess_get(&guess);
            return se3di_reader_fail(reader, node, "the model has no such parameter, %s%s%s",
                                     meant          ? "did you mean `"
                                     : r->count > 0 ? "it has: "
                                                    : "it has none",
                                     meant ? meant : list, meant ? "`?" : "");
        }
        node->row = r->list[index].node->row;
        node->parent = r->list[index].node->parent;
        r->list[index].node = node;
        r->list[index].text = node->text;
        r->list[index].place = NULL;
    }
    return true;
}

/* Put the values of a sample in the place of the model's. */
static void apply_values(resolver *r)
{
    const se3di_reader *reader = r->reader;
    for (size_t k = 0; k < reader->value_count; ++k) {
        size_t index = 0;
        if (se3di_ionames_find(&r->names, reader->values[k].name, &index)) {
            r->list[index].given = &reader->values[k].value;
            r->list[index].text = "";
            r->list[index].place = NULL;
        }
    }
}

static bool collect(resolver *r, const se3di_node *map, bool is_point)
{
    if (!map) {
        return true;
    }
    for (const se3di_node *node = map->first; node; node = node->next) {
        parameter *p = &r->list[r->count];
        if (!check_name(r->reader, node)) {
            return false;
        }
        if (se3di_ionames_find(&r->names, node->key, NULL)) {
            return se3di_reader_fail(r->reader, node,
                                     "is the name of two: parameters and points must have "
                                     "different names");
        }
        p->node = node;
        p->is_point = is_point;
        p->place = node->kind == SE3DI_NODE_LIST ? node->first : NULL;
        p->text = node->text ? node->text : p->place && p->place->text ? p->place->text : "";
        if (!se3di_ionames_add(&r->names, r->reader->pool, node->key, r->count++)) {
            return se3di_reader_fail_memory(r->reader);
        }
    }
    return true;
}

/* The map under `key`, or nothing. */
static bool find_map(se3di_reader *reader, const se3di_node *root, const char *key,
                     const char *example, const se3di_node **map)
{
    *map = se3di_node_get(root, key);
    if (*map && se3di_node_is_null(*map)) {
        *map = NULL;
    }
    return !*map || (*map)->kind == SE3DI_NODE_MAP ||
           se3di_reader_fail(reader, *map, "is %s, must be a map such as %s",
                             se3di_node_describe(*map), example);
}

/* Put the values that the entry gives in the place of the part's own. */
static bool apply_given(resolver *r, const se3di_given *given)
{
    const se3di_node *node = given->node ? given->node->first : NULL;
    for (size_t k = 0; k < given->count; ++k, node = node->next) {
        size_t index = 0;
        se3di_guess guess = se3di_guess_begin(node->key);
        if (!se3di_ionames_find(&r->names, node->key, &index)) {
            for (size_t i = 0; i < r->count; ++i) {
                se3di_guess_offer(&guess, r->list[i].node->key);
            }
            const char *meant = se3di_guess_get(&guess);
            r->reader->part = r->caller; /* whose mistake it is */
            return se3di_reader_fail(
                r->reader, node, "the part has no such parameter or point%s%s%s",
                meant ? ", did you mean `" : "", meant ? meant : "", meant ? "`?" : "");
        }
        r->list[index].given = &given->values[k];
        r->list[index].text = "";
        r->list[index].place = NULL;
    }
    size_t counter = 0;
    if (!given->index) {
        return true;
    }
    if (!se3di_ionames_find(&r->names, given->index, &counter)) {
        return se3di_scope_add(r->scope, r->reader->pool, given->index, &given->i) ||
               se3di_reader_fail_memory(r->reader);
    }
    r->list[counter].given = &given->i;
    r->list[counter].text = "";
    return true;
}

/* The maps of a part: its parameters, its points, and those of its table. */
static bool find_maps(se3di_reader *reader, const se3di_component *part, se3di_scope *scope,
                      const se3di_node *maps[3])
{
    const se3di_node *root = part->root;
    if (!find_map(reader, root, "parameters", "{L: 2}", &maps[0]) ||
        !find_map(reader, root, "points", "{hub: [0, 1, 2]}", &maps[1]) ||
        !se3di_read_units(reader, root, &scope->units)) {
        return false;
    }
    reader->scope = scope;
    return se3di_read_point_table(reader, root, &maps[2]);
}

/* Units of a file are those of its parts, too. */
static se3di_units first_units(const se3di_component *part)
{
    const se3di_component *file = part;
    while (file->parent && (file->root->parent || file->file != part->file)) {
        file = file->parent;
    }
    return file != part && file->scope ? file->scope->units : se3di_units_si();
}

bool se3di_read_parameters(se3di_reader *reader, se3di_component *part, const se3di_given *given)
{
    se3di_iopool *pool = reader->pool;
    const se3di_node *maps[3] = {NULL, NULL, NULL};
    resolver r = {.reader = reader,
                  .scope = se3di_iopool_alloc(pool, sizeof *r.scope),
                  .caller = part->parent};
    size_t count = 0;
    if (!r.scope) {
        return se3di_reader_fail_memory(reader);
    }
    r.scope->units = first_units(part);
    part->scope = r.scope;
    if (!find_maps(reader, part, r.scope, maps)) {
        return false;
    }
    for (size_t k = 0; k < 3; ++k) {
        count += maps[k] ? maps[k]->count : 0;
    }
    r.list = se3di_iopool_array(pool, count, sizeof *r.list);
    r.stack = se3di_iopool_array(pool, count, sizeof *r.stack);
    if (!r.list || !r.stack) {
        return se3di_reader_fail_memory(reader);
    }
    if (!collect(&r, maps[0], false) || !collect(&r, maps[1], true) ||
        !collect(&r, maps[2], true) || !(given ? apply_given(&r, given) : apply_settings(&r))) {
        return false;
    }
    if (!given) {
        apply_values(&r);
    }
    for (size_t k = 0; k < r.count; ++k) {
        if (r.list[k].state == NEW && !resolve(&r, k)) {
            return false;
        }
    }
    return true;
}
