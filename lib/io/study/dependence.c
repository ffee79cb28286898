/* SPDX-License-Identifier: BSD-3-Clause */
/* What depends on a parameter is found in the texts: parameters and points that are made of it, in
 * the part that says them and in those that are given them; entries of bodies, joints and the like
 * that have one of these names; and those that name a body whose pose depends, or an element that
 * is read again. Another thing that has one of the names only costs its reading. */
#include "io/study/dependence.h"

#include <string.h>

#include "io/document/amount.h"
#include "io/document/keys.h"

/* Full names of bodies that are somewhere else, and of elements that are read again. */
typedef struct name_list {
    const char **list;
    size_t count, capacity;
} name_list;

typedef struct search {
    const se3d_model *model;
    se3di_iopool *pool;
    se3di_dependence *d;
    name_list moved;
    name_list loads; /* elements whose points channels have, too */
    bool is_all, has_memory;
} search;

static bool refuse(search *s)
{
    s->is_all = false;
    return false;
}

static bool fail_memory(search *s)
{
    s->has_memory = false;
    return false;
}

static bool add_name(search *s, name_list *to, const char *name)
{
    const char **grown =
        se3di_iopool_grow(s->pool, to->list, to->count, &to->capacity, sizeof *grown);
    if (!grown) {
        return fail_memory(s);
    }
    to->list = grown;
    to->list[to->count++] = name;
    return true;
}

/* ---- texts -----------------------------------------------------------------------------------*/

typedef bool (*names_something)(const void *ctx, const char *name, size_t length);

static bool has_name(const char *text, names_something is_one, const void *ctx)
{
    size_t length = 0;
    const char *at = text ? se3di_amount_next_name(text, &length) : NULL;
    while (at && !is_one(ctx, at, length)) {
        at = se3di_amount_next_name(at + length, &length);
    }
    return at != NULL;
}

/* Whether a text at or below a node has such a name. */
static bool mentions(const se3di_node *node, names_something is_one, const void *ctx)
{
    if (node->kind == SE3DI_NODE_SCALAR) {
        return has_name(node->text, is_one, ctx);
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (mentions(child, is_one, ctx)) {
            return true;
        }
    }
    return false;
}

static bool is_parameter(const void *ctx, const char *name, size_t length)
{
    const se3di_dependent_part *part = ctx;
    for (size_t k = 0; k < part->renewal_count; ++k) {
        if (strncmp(part->names[k], name, length) == 0 && part->names[k][length] == '\0') {
            return true;
        }
    }
    return false;
}

static bool depends(const se3di_dependent_part *part, const se3di_node *node)
{
    return mentions(node, is_parameter, part);
}

/* Names as a part says them: its own, or those of parts that it is in. */
typedef struct names_of_part {
    const name_list *names;
    const se3di_component *part;
} names_of_part;

static bool is_called(const se3di_component *part, const char *full, const char *name,
                      size_t length)
{
    for (; part; part = part->parent) {
        const size_t head = strlen(part->prefix);
        if (strlen(full) == head + length && strncmp(full, part->prefix, head) == 0 &&
            strncmp(full + head, name, length) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_listed(const void *ctx, const char *name, size_t length)
{
    const names_of_part *of = ctx;
    for (size_t k = 0; k < of->names->count; ++k) {
        if (is_called(of->part, of->names->list[k], name, length)) {
            return true;
        }
    }
    return false;
}

static bool refers_to(const names_of_part *of, const se3di_node *node)
{
    if (node->kind == SE3DI_NODE_SCALAR && node->text) {
        return strchr(node->text, '{') || is_listed(of, node->text, strlen(node->text)) ||
               has_name(node->text, is_listed, of);
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (refers_to(of, child)) {
            return true;
        }
    }
    return false;
}

/* Whether a node may name one of these: as a text, or in an expression. */
static bool refers(const name_list *names, const se3di_dependent_part *part, const se3di_node *node)
{
    const names_of_part of = {names, part->part};
    return names->count > 0 && refers_to(&of, node);
}

/* ---- parameters and points of parts ----------------------------------------------------------*/

static const se3di_dependent_part *find_part(const se3di_dependence *d, const se3di_component *part)
{
    for (size_t k = 0; k < d->part_count; ++k) {
        if (d->parts[k].part == part) {
            return &d->parts[k];
        }
    }
    return NULL;
}

/* The entry of a name of the part; NULL: it has none, as a point of a table. */
static const se3di_node *find_entry(const se3di_component *part, const char *name, bool *is_point)
{
    const se3di_node *map = se3di_node_get(part->root, "parameters");
    const se3di_node *node = map ? se3di_node_get(map, name) : NULL;
    *is_point = !node;
    if (!node) {
        map = se3di_node_get(part->root, "points");
        node = map ? se3di_node_get(map, name) : NULL;
    }
    return node;
}

/* What else than its parameters makes a part another one, or more of them. */
static bool check_caller(search *s, const se3di_dependent_part *part)
{
    const se3di_node *caller = part->part->caller;
    const se3di_node *given = se3di_node_get(caller, "parameters");
    for (const se3di_node *key = caller->first; key; key = key->next) {
        if (key != given && depends(part->parent, key)) {
            return refuse(s);
        }
    }
    return !(given && se3di_node_get(caller, "repeat") && depends(part->parent, given)) ||
           refuse(s);
}

static size_t find_value(const char *const *names, size_t count, const char *name)
{
    for (size_t k = 0; k < count; ++k) {
        if (strcmp(names[k], name) == 0) {
            return k;
        }
    }
    return SIZE_MAX;
}

/* The names of a part that depend. Its scope has each after those that it is made of. */
static bool find_renewals(search *s, se3di_dependent_part *to, const char *const *names,
                          size_t count)
{
    const se3di_scope *scope = to->part->scope;
    const se3di_node *map = to->parent ? se3di_node_get(to->part->caller, "parameters") : NULL;
    to->renewals = se3di_iopool_array(s->pool, scope->count + 1, sizeof *to->renewals);
    to->names = se3di_iopool_array(s->pool, scope->count + 1, sizeof *to->names);
    if (!to->renewals || !to->names) {
        return fail_memory(s);
    }
    for (size_t k = 0; k < scope->count; ++k) {
        const char *name = scope->list[k].name;
        se3di_renewal r = {.given = map ? se3di_node_get(map, name) : NULL,
                           .value = to->parent ? SIZE_MAX : find_value(names, count, name)};
        r.node = find_entry(to->part, name, &r.is_point);
        const bool is_own = r.value != SIZE_MAX;
        if (!is_own && !(r.given ? depends(to->parent, r.given) : r.node && depends(to, r.node))) {
            continue;
        }
        if (!r.node) {
            return refuse(s);
        }
        to->names[to->renewal_count] = name;
        to->renewals[to->renewal_count++] = r;
    }
    return true;
}

/* ---- entries of lists ------------------------------------------------------------------------*/

static bool is_wanted(const se3di_dependent_part *part, const se3di_node *node)
{
    for (size_t k = 0; k < part->again.count; ++k) {
        if (part->again.nodes[k] == node) {
            return true;
        }
    }
    return false;
}

/* The full name of a body or element that was made of an entry; NULL: it was left out. */
static const char *find_name(const search *s, const se3di_component *part, const se3di_node *node)
{
    const se3d_model *model = s->model;
    for (size_t k = 0; k < model->body_count; ++k) {
        if (model->bodies[k].node == node && model->bodies[k].part == part) {
            return model->bodies[k].name;
        }
    }
    for (size_t k = 0; k < model->element_count; ++k) {
        if (model->elements[k].node == node && model->elements[k].part == part) {
            return model->elements[k].name;
        }
    }
    return NULL;
}

static bool want(search *s, se3di_dependent_part *part, const se3di_node *node)
{
    se3di_again *again = &part->again;
    const se3di_node **grown =
        se3di_iopool_grow(s->pool, again->nodes, again->count, &again->capacity, sizeof *grown);
    if (!grown) {
        return fail_memory(s);
    }
    again->nodes = grown;
    again->nodes[again->count++] = node;
    return true;
}

/* Whether an entry has other keys that depend than those that can be read again. */
static bool check_keys(search *s, const se3di_dependent_part *part, const se3di_node *node)
{
    for (const se3di_node *key = node->first; key; key = key->next) {
        if (se3di_keys_contain(" name when type fixed held shapes ", key->key) &&
            depends(part, key)) {
            return refuse(s);
        }
    }
    return true;
}

/* Without contact, shapes of a sample are nothing but masses. */
static bool has_contact(const se3d_model *model)
{
    return se3di_node_get(model->root, "contact") || model->shape_count > 0;
}

/* Bars and plates have shapes and joints of their own. */
static bool is_solid(const se3di_node *node)
{
    return se3di_node_get(node, "from") || se3di_node_get(node, "plate");
}

/* What the keys of a body say of it. */
typedef struct body_keys {
    bool is_dependent, is_moved, is_fixed; /* fixed: the model is to be read */
} body_keys;

static body_keys look_at_body(const search *s, const se3di_dependent_part *part,
                              const se3di_node *node)
{
    static const char placed[] = " position orientation velocity angular_velocity markers ";
    const bool weighed = se3di_node_get(node, "mass") && se3di_node_get(node, "inertia");
    const bool touches = has_contact(s->model);
    body_keys keys = {false, false, false};
    for (const se3di_node *key = node->first; key; key = key->next) {
        const bool is_shape = strcmp(key->key, "shapes") == 0;
        if (depends(part, key) && !(is_shape && weighed && !touches)) {
            keys.is_dependent = true;
            keys.is_moved = keys.is_moved || se3di_keys_contain(placed, key->key);
            keys.is_fixed = keys.is_fixed || (is_shape && touches) ||
                            se3di_keys_contain(" name when fixed held ", key->key);
        }
    }
    return keys;
}

static bool take_body(search *s, se3di_dependent_part *part, const se3di_node *node)
{
    if (node->kind != SE3DI_NODE_MAP) {
        return !depends(part, node) || refuse(s);
    }
    const body_keys keys = look_at_body(s, part, node);
    const char *name = keys.is_dependent ? find_name(s, part->part, node) : NULL;
    if (keys.is_fixed) {
        return refuse(s);
    }
    if (!name) {
        return true;
    }
    if (is_solid(node) || strcmp(name, "ground") == 0 || (keys.is_moved && has_contact(s->model))) {
        return refuse(s);
    }
    return want(s, part, node) && (!keys.is_moved || add_name(s, &s->moved, name));
}

static bool take_element(search *s, se3di_dependent_part *part, const se3di_node *node)
{
    if (is_wanted(part, node) || !(depends(part, node) || refers(&s->moved, part, node))) {
        return true;
    }
    if (node->kind != SE3DI_NODE_MAP || !check_keys(s, part, node) ||
        se3di_node_get(node, "rate")) {
        return refuse(s);
    }
    const char *name = find_name(s, part->part, node);
    if (!name) {
        return true;
    }
    const se3di_node *type = se3di_node_get(node, "type");
    const bool is_load =
        type && type->text && se3di_keys_contain(" bushing force torque ", type->text);
    return want(s, part, node) && add_name(s, &s->moved, name) &&
           (!is_load || add_name(s, &s->loads, name));
}

/* Each entry of the lists of these keys, in all parts. */
static bool take_lists(search *s, const char *keys,
                       bool (*take)(search *s, se3di_dependent_part *part, const se3di_node *node))
{
    for (size_t k = 0; k < s->d->part_count; ++k) {
        se3di_dependent_part *part = &s->d->parts[k];
        for (const se3di_node *key = part->part->root->first; key; key = key->next) {
            if (!se3di_keys_contain(keys, key->key)) {
                continue;
            }
            for (const se3di_node *node = key->first; node; node = node->next) {
                if (!take(s, part, node)) {
                    return false;
                }
            }
        }
    }
    return true;
}

static size_t count_wanted(const search *s)
{
    size_t count = 0;
    for (size_t k = 0; k < s->d->part_count; ++k) {
        count += s->d->parts[k].again.count;
    }
    return count;
}

static bool want_wheel(search *s, se3di_dependent_part *part, const se3di_node *node)
{
    return is_wanted(part, node) || !find_name(s, part->part, node) || want(s, part, node);
}

static bool find_wheel(search *s, se3di_dependent_part *part, const se3di_node *node)
{
    s->d->has_wheels = s->d->has_wheels || is_wanted(part, node);
    return true;
}

/* Whether a section that is read but once depends. The parameters of expressions of measures are
 * those of the sample anyway. */
static bool check_section(search *s, const se3di_dependent_part *part, const se3di_node *key)
{
    static const char passed[] = " se3d title units parameters points output include instances "
                                 "parts bodies joints constraints drivers forces wheels ";
    if (strcmp(key->key, "study") == 0) {
        const se3di_node *measures = se3di_node_get(key, "measures");
        for (const se3di_node *m = measures ? measures->first : NULL; m; m = m->next) {
            if (refers(&s->loads, part, m) || (m->kind == SE3DI_NODE_MAP && depends(part, m))) {
                return refuse(s);
            }
        }
        return true;
    }
    return se3di_keys_contain(passed, key->key) ||
           !(depends(part, key) || refers(&s->moved, part, key)) || refuse(s);
}

static bool check_sections(search *s)
{
    for (size_t k = 0; k < s->d->part_count; ++k) {
        const se3di_dependent_part *part = &s->d->parts[k];
        for (const se3di_node *key = part->part->root->first; key; key = key->next) {
            if (!check_section(s, part, key)) {
                return false;
            }
        }
    }
    return true;
}

static bool find_all(search *s)
{
    static const char elements[] = " joints constraints drivers forces wheels ";
    size_t before;
    if (!take_lists(s, " bodies ", take_body)) {
        return false;
    }
    do { /* what refers to what */
        before = count_wanted(s);
        if (!take_lists(s, elements, take_element)) {
            return false;
        }
    } while (count_wanted(s) > before);
    if (!take_lists(s, " wheels ", find_wheel)) {
        return false;
    }
    /* which wheel is across which one is found among all of them */
    return (!s->d->has_wheels || take_lists(s, " wheels ", want_wheel)) && check_sections(s);
}

static bool find_parts(search *s, const char *const *names, size_t count)
{
    se3di_dependence *d = s->d;
    size_t all = 0;
    for (const se3di_component *part = s->model->parts; part; part = part->next) {
        ++all;
    }
    d->parts = se3di_iopool_array(s->pool, all, sizeof *d->parts);
    d->again = se3di_iopool_array(s->pool, all, sizeof *d->again);
    if (!d->parts || !d->again) {
        return fail_memory(s);
    }
    for (se3di_component *part = s->model->parts; part; part = part->next) {
        se3di_dependent_part *to = &d->parts[d->part_count];
        *to = (se3di_dependent_part){.part = part};
        to->parent = part->parent ? find_part(d, part->parent) : NULL;
        if ((to->parent && !check_caller(s, to)) || !find_renewals(s, to, names, count)) {
            return false;
        }
        ++d->part_count;
    }
    return true;
}

se3d_status se3di_dependence_find(const se3d_model *model, const char *const *names, size_t count,
                                  se3di_iopool *pool, se3di_dependence *dependence, bool *is_all)
{
    search s = {.model = model, .pool = pool, .d = dependence, .is_all = true, .has_memory = true};
    *dependence = (se3di_dependence){.parts = NULL};
    if (find_parts(&s, names, count) && find_all(&s)) {
        for (size_t k = 0; k < dependence->part_count; ++k) {
            dependence->again[k] = dependence->parts[k].again;
        }
    }
    *is_all = s.is_all;
    return s.has_memory ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}
