/* SPDX-License-Identifier: BSD-3-Clause */
/* Going on after a mistake. */
#include "io/document/recovery.h"

#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/keys.h"

se3di_fault se3di_fault_of(const se3di_node *node)
{
    se3di_fault fault = {.node = node->parent ? node->parent->first : NULL};
    while (fault.node && fault.node->index != node->index) {
        fault.node = fault.node->next;
    }
    return fault;
}

/* Whether `word` stands in the text, not as a part of a longer name. */
static bool mentions(const char *text, const char *word)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
    const size_t length = strlen(word);
    for (const char *at = text; length > 0 && (at = strstr(at, word)) != NULL; ++at) {
        const bool begins = at == text || !strchr(letters, at[-1]);
        if (begins && (!at[length] || !strchr(letters, at[length]))) {
            return true;
        }
    }
    return false;
}

bool se3di_recovery_expects(const se3di_recovery *recovery, const se3di_fault *fault)
{
    const se3di_node *node = fault->node;
    if (!node) {
        return false;
    }
    for (size_t k = 0; node->text && !fault->is_key && k < recovery->lost_count; ++k) {
        if (mentions(node->text, recovery->lost[k])) {
            return true;
        }
    }
    return node->incomplete;
}

static bool add_lost(se3di_recovery *recovery, const char *name)
{
    const char **grown =
        se3di_iopool_grow(recovery->pool, (void *)recovery->lost, recovery->lost_count,
                          &recovery->lost_capacity, sizeof *grown);
    char *copy = se3di_iopool_copy(recovery->pool, name, strlen(name));
    if (grown && copy) {
        recovery->lost = grown;
        grown[recovery->lost_count++] = copy;
    }
    return grown && copy;
}

/* Note the names by which others may refer to what is taken out. */
static bool note_names(se3di_recovery *recovery, const se3di_node *node)
{
    const se3di_node *name = se3di_node_get(node, "name");
    const se3di_node *parent = node->parent;
    if (name && name->text && !add_lost(recovery, name->text)) {
        return false;
    }
    if (node->key && node->text && strcmp(node->key, "name") == 0) {
        return add_lost(recovery, node->text);
    }
    if (node->key && parent->key &&
        se3di_keys_contain(" parameters points point_table ", parent->key)) {
        return add_lost(recovery, node->key);
    }
    if (!name && parent->kind == SE3DI_NODE_LIST && parent->key) { /* joint1 of `joints` */
        char made[64];
        snprintf(made, sizeof made, "%.*s%zu", (int)(strlen(parent->key) - 1), parent->key,
                 node->index + 1);
        return add_lost(recovery, made);
    }
    return true;
}

/* The root of a document, or an entry of `parts`: what has sections. */
static bool has_sections(const se3di_node *node)
{
    const se3di_node *parent = node->parent;
    return !parent || (parent->key && strcmp(parent->key, "parts") == 0 && parent->parent &&
                       !parent->parent->parent);
}

/* Sections whose things others refer to, or that decide what others must say. */
static bool is_foundation(const se3di_node *node)
{
    return !node->parent->parent &&
           se3di_keys_contain(
               " se3d parameters points bodies joints drivers constraints forces materials "
               "contact particles analysis include instances parts ",
               node->key);
}

/* A list of a section goes on without one of its things; a thing or a value not without a part. */
static void mark_incomplete(const se3di_node *out)
{
    const bool thing = out->kind == SE3DI_NODE_MAP;
    se3di_node *node = out->parent;
    while (!has_sections(node) &&
           !(thing && node->kind == SE3DI_NODE_LIST && has_sections(node->parent))) {
        node->incomplete = true;
        node = node->parent;
    }
}

/* The text of an entry that an expression which was cut at a comma began or went on in. */
static const char *part_of(const se3di_node *node, bool begins)
{
    const char *text = node ? begins || !node->key ? node->text : node->key : NULL;
    const char *open = text ? strchr(text, '(') : NULL;
    const char *close = text ? strchr(text, ')') : NULL;
    return begins ? open && !close ? text : NULL : close && !open ? text : NULL;
}

static se3di_node *find_before(const se3di_node *node)
{
    se3di_node *before = NULL;
    for (se3di_node *child = node->parent->first; child != node; child = child->next) {
        before = child;
    }
    return before;
}

static bool take_out_alone(se3di_recovery *recovery, const se3di_node *node)
{
    se3di_node *parent = node->parent;
    se3di_node *before = find_before(node);
    if (!parent || is_foundation(node) || !note_names(recovery, node)) {
        return false;
    }
    if (before) {
        before->next = node->next;
    } else {
        parent->first = node->next;
    }
    parent->last = parent->last == node ? before : parent->last;
    --parent->count;
    mark_incomplete(node);
    return true;
}

/* With the other half of an expression that was cut at a comma. */
static bool take_out(se3di_recovery *recovery, const se3di_node *node)
{
    const se3di_node *half = NULL;
    if (part_of(node, true) && part_of(node->next, false)) {
        half = node->next;
    } else if (part_of(node, false)) {
        const se3di_node *before = find_before(node);
        half = part_of(before, true) ? before : NULL;
    }
    return take_out_alone(recovery, node) && (!half || take_out_alone(recovery, half));
}

/* Put what was meant in its place. */
static bool replace(se3di_recovery *recovery, se3di_node *node, const se3di_fault *fault)
{
    char *meant = se3di_iopool_copy(recovery->pool, fault->meant, strlen(fault->meant));
    if (meant && fault->is_key) {
        node->key = meant;
    } else if (meant) {
        node->text = meant;
    }
    return meant != NULL;
}

bool se3di_recovery_mend(se3di_recovery *recovery, const se3di_fault *fault, bool guess)
{
    se3di_node *node = fault->node;
    if (!node) {
        return false;
    }
    if (guess && fault->meant && !(fault->is_key && se3di_node_get(node->parent, fault->meant))) {
        return replace(recovery, node, fault);
    }
    return take_out(recovery, node);
}
