/* SPDX-License-Identifier: BSD-3-Clause */
/* The head of a model file, and what only a model knows that was read from one: analyses, results,
 * events, particles, as their file says them, with the parameters that they name. */
#include <stdio.h>
#include <string.h>

#include "base/shortest.h"
#include "io/document/amount.h"
#include "io/write/save.h"

enum { WIDTH = 100 };

static const char *const sections[] = {"clumps",   "particles", "sinks", "regions",
                                       "flows",    "servos",    "bonds", "cell",
                                       "analysis", "events",    "fmus",  "output"};

static bool is_bare(const char *text)
{
    return !text[strcspn(text, ",[]{}#:\"'\n")] && !strchr("&*!|>%@`?", text[0]) && text[0] &&
           strcmp(text, "-") != 0 && strncmp(text, "- ", 2) != 0;
}

static void put_scalar(se3di_save *s, const se3di_node *node)
{
    if (se3di_node_is_null(node)) {
        se3di_save_put(s, "~");
    } else if (node->plain && is_bare(node->text)) {
        se3di_save_put(s, node->text);
    } else {
        se3di_save_put_quoted(s, node->text);
    }
}

/* In braces and brackets. */
void se3di_save_put_node(se3di_save *s, const se3di_node *node)
{
    const bool is_map = node->kind == SE3DI_NODE_MAP;
    if (node->kind == SE3DI_NODE_SCALAR) {
        put_scalar(s, node);
        return;
    }
    se3di_save_put(s, is_map ? "{" : "[");
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (child != node->first) {
            se3di_save_put(s, s->out.column > WIDTH - 20 ? ",\n     " : ", ");
        }
        if (is_map) {
            se3di_save_put(s, child->key);
            se3di_save_put(s, ": ");
        }
        if (s->in_files && is_map && child->text && strcmp(child->key, "file") == 0) {
            se3di_save_put_quoted(s, se3di_save_get_file(s, NULL, child->text));
        } else {
            se3di_save_put_node(s, child);
        }
    }
    se3di_save_put(s, is_map ? "}" : "]");
}

static void put_section(se3di_save *s, const se3di_node *node)
{
    s->in_files = strcmp(node->key, "particles") == 0 || strcmp(node->key, "fmus") == 0;
    se3di_save_put(s, "\n");
    se3di_save_put(s, node->key);
    if (node->kind != SE3DI_NODE_LIST || !node->first) {
        se3di_save_put(s, ": ");
        se3di_save_put_node(s, node);
        se3di_save_put(s, "\n");
        return;
    }
    se3di_save_put(s, ":\n");
    for (const se3di_node *child = node->first; child; child = child->next) {
        se3di_save_put(s, "  - ");
        se3di_save_put_node(s, child);
        se3di_save_put(s, "\n");
    }
}

static const se3di_node *get_section(const se3di_save *s, const char *key)
{
    const se3di_node *node = s->model ? se3di_node_get(s->model->root, key) : NULL;
    return node && !se3di_node_is_null(node) ? node : NULL;
}

bool se3di_save_has_units(const se3di_save *s)
{
    return get_section(s, "units") != NULL;
}

/* Whether the texts of a section say in SI units what they say in those of the file: names, and
 * numbers that are seconds or have no unit. */
static bool is_same_in_si(const se3di_save *s, const se3di_node *node)
{
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (!is_same_in_si(s, child)) {
            return false;
        }
    }
    if (node->kind != SE3DI_NODE_SCALAR) {
        return true;
    }
    const se3di_measure *time = &s->model->scope->units.time;
    const se3di_key *row = se3di_amount_find_key(node);
    se3di_measure unit;
    switch (row ? row->kind : SE3DI_KIND_END) {
    case SE3DI_KIND_BOOL:
    case SE3DI_KIND_WORD:
    case SE3DI_KIND_TYPE:
    case SE3DI_KIND_NAME:
    case SE3DI_KIND_FILE:
        return true;
    case SE3DI_KIND_TEXT:
    case SE3DI_KIND_CHANNELS:
        return !strpbrk(node->text, " +-*/^()<>="); /* an expression may have numbers */
    case SE3DI_KIND_NUMBER:
    case SE3DI_KIND_COUNT:
        return se3di_amount_find_unit(row, 0, &unit) && unit.dimension.length == 0 &&
               unit.dimension.mass == 0 && unit.dimension.angle == 0 &&
               (unit.dimension.time == 0 || time->times == time->over);
    default:
        return false;
    }
}

/* A section that can be written as it is; NULL: it is not there, or cannot. */
static const se3di_node *get_kept(const se3di_save *s, const char *key)
{
    const se3di_node *node = get_section(s, key);
    const bool is_timed = strcmp(key, "analysis") == 0 || strcmp(key, "output") == 0;
    return node && (!se3di_save_has_units(s) || (is_timed && is_same_in_si(s, node))) ? node : NULL;
}

void se3di_save_document(se3di_save *s)
{
    for (size_t k = 0; k < sizeof sections / sizeof *sections; ++k) {
        const se3di_node *node = get_kept(s, sections[k]);
        if (node) {
            put_section(s, node);
        }
    }
}

/* ---- what is left out ------------------------------------------------------------------------*/

enum { LIST_SIZE = 300 };

static void list(char text[LIST_SIZE], const char *name)
{
    const size_t used = strlen(text);
    snprintf(text + used, LIST_SIZE - used, "%s%s", used > 0 ? ", " : "", name);
}

/* Sections of a file with units, whose numbers would be read as SI units. */
static void list_in_units(const se3di_save *s, char text[LIST_SIZE])
{
    const se3di_node *contact = get_section(s, "contact");
    for (size_t k = 0; k < sizeof sections / sizeof *sections; ++k) {
        if (get_section(s, sections[k]) && !get_kept(s, sections[k])) {
            list(text, sections[k]);
        }
    }
    for (size_t k = 0; contact && se3di_save_domain_keys[k]; ++k) {
        if (se3di_node_get(contact, se3di_save_domain_keys[k])) {
            list(text, "contact.");
            strncat(text, se3di_save_domain_keys[k], LIST_SIZE - strlen(text) - 1);
        }
    }
    if (text[0]) {
        strncat(text, " (of a file with units)", LIST_SIZE - strlen(text) - 1);
    }
}

void se3di_save_losses(se3di_save *s)
{
    char lost[LIST_SIZE] = "";
    char text[LIST_SIZE + 20];
    if (s->wants_document && se3di_save_has_units(s)) {
        list_in_units(s, lost);
    }
    if (s->wants_document && get_section(s, "study")) {
        list(lost, "study");
    }
    if (lost[0] && s->partial) {
        snprintf(text, sizeof text, "Left out: %s", lost);
        se3di_save_comment(s, "", text);
    } else if (lost[0] && s->status >= 0) {
        se3di_save_refuse(s, "cannot be written: %s; `--partial` leaves it out", lost);
        s->status = SE3D_ERR_UNSUPPORTED;
    }
}

/* ---- the head -------------------------------------------------------------------------------*/

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

static bool text_names(const char *text, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = text ? strstr(text, name) : NULL; at; at = strstr(at + 1, name)) {
        if ((at == text || !is_letter(at[-1])) && !is_letter(at[length])) {
            return true;
        }
    }
    return false;
}

static bool node_names(const se3di_node *node, const char *name)
{
    bool found = node->kind == SE3DI_NODE_SCALAR && text_names(node->text, name);
    for (const se3di_node *child = node->first; child && !found; child = child->next) {
        found = node_names(child, name);
    }
    return found;
}

static bool is_named(const se3di_save *s, const char *name)
{
    const bool has_units = se3di_save_has_units(s);
    const se3di_node *contact = has_units ? NULL : get_section(s, "contact");
    bool found = contact && node_names(contact, name);
    for (size_t k = 0; k < sizeof sections / sizeof *sections && !found; ++k) {
        const se3di_node *node = get_kept(s, sections[k]);
        found = node && node_names(node, name);
    }
    return found;
}

static void put_parameter(se3di_save *s, const se3di_named *parameter, bool *is_first)
{
    char text[SE3DI_SHORTEST_SIZE];
    const se3di_amount *value = &parameter->value;
    se3di_save_put(s, *is_first ? "\nparameters:\n" : "");
    *is_first = false;
    se3di_save_put(s, "  ");
    se3di_save_put(s, parameter->name);
    se3di_save_put(s, ": ");
    if (value->rank == 1) {
        (void)se3di_shortest_format(value->v[0], text);
        se3di_save_put(s, text);
    } else {
        s->indent = "    ";
        se3di_save_put_row(s, value->v, value->rank);
    }
    se3di_save_put(s, "\n");
}

static void put_parameters(se3di_save *s)
{
    const se3di_scope *scope = s->model ? s->model->scope : NULL;
    bool is_first = true;
    for (size_t k = 0; scope && k < scope->count; ++k) {
        if (is_named(s, scope->list[k].name)) {
            put_parameter(s, &scope->list[k], &is_first);
        }
    }
}

void se3di_save_head(se3di_save *s)
{
    double gravity[3] = {0.0};
    se3d_function function[3] = {{0, 0}, {0, 0}, {0, 0}};
    (void)se3d_system_get_gravity(s->system, gravity);
    (void)se3d_system_get_gravity_function(s->system, function);
    se3di_save_put(s, "se3d: 1\n");
    if (s->model && s->model->title[0]) {
        se3di_save_put(s, "title: ");
        se3di_save_put_text(s, s->model->title);
        se3di_save_put(s, "\n");
    }
    se3di_save_put(s, "gravity: [");
    for (int k = 0; k < 3; ++k) {
        se3di_save_put(s, k > 0 ? ", " : "");
        se3di_save_put_function(s, function[k], gravity[k], NULL);
    }
    se3di_save_put(s, "]\n");
    put_parameters(s);
}
