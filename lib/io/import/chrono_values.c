/* SPDX-License-Identifier: BSD-3-Clause */
/* Chrono: values of a map. */
#include <math.h>
#include <string.h>

#include "io/import/chrono.h"
#include "io/import/scan.h"

#define DEGREE (3.14159265358979323846 / 180.0)

static bool expect(se3di_chrono *c, const se3di_node *node, const char *what)
{
    char path[200];
    se3di_node_format_path(node, path, sizeof path);
    return se3di_machine_fail(c->m, node->line, node->column, "%s must be %s", path, what);
}

static bool read_number(se3di_chrono *c, const se3di_node *node, double *value)
{
    const char *text = node->kind == SE3DI_NODE_SCALAR ? node->text : "";
    const size_t length = se3di_scan_number(text, false, value);
    if (length == 0 || text[length]) {
        return expect(c, node, "a number of at most 1e40");
    }
    return true;
}

bool se3di_chrono_number(se3di_chrono *c, const se3di_node *map, const char *key, double *value)
{
    const se3di_node *node = se3di_node_get(map, key);
    return !node || read_number(c, node, value);
}

static bool read_numbers(se3di_chrono *c, const se3di_node *node, double *values, size_t count)
{
    if (node->kind != SE3DI_NODE_LIST || node->count != count) {
        char what[40] = "0 numbers";
        what[0] = (char)('0' + count % 10);
        return expect(c, node, what);
    }
    for (const se3di_node *at = node->first; at; at = at->next) {
        if (!read_number(c, at, values++)) {
            return false;
        }
    }
    return true;
}

bool se3di_chrono_numbers(se3di_chrono *c, const se3di_node *map, const char *key, double *values,
                          size_t count)
{
    const se3di_node *node = se3di_node_get(map, key);
    return !node || read_numbers(c, node, values, count);
}

bool se3di_chrono_bool(se3di_chrono *c, const se3di_node *map, const char *key, bool *value)
{
    const se3di_node *node = se3di_node_get(map, key);
    if (!node) {
        return true;
    }
    const char *text = node->kind == SE3DI_NODE_SCALAR ? node->text : "";
    *value = se3di_scan_equal(text, "true");
    return *value || se3di_scan_equal(text, "false") || expect(c, node, "true or false");
}

bool se3di_chrono_turn(se3di_chrono *c, const se3di_node *map, const char *key, double A[9])
{
    const se3di_node *node = se3di_node_get(map, key);
    double v[4];
    if (!node) {
        return true;
    }
    if (node->kind == SE3DI_NODE_LIST && node->count == 4) {
        if (!read_numbers(c, node, v, 4)) {
            return false;
        }
        return se3di_turn_from_parameters(v, A) ||
               expect(c, node, "Euler parameters that are not 0");
    }
    if (!read_numbers(c, node, v, 3)) {
        return false;
    }
    const double unit = c->degrees ? DEGREE : 1.0;
    const double rpy[3] = {unit * v[2], unit * v[1], unit * v[0]};
    se3di_turn_from_rpy(rpy, A);
    return true;
}

bool se3di_chrono_frame(se3di_chrono *c, const se3di_node *map, se3di_frame *frame)
{
    return se3di_chrono_numbers(c, map, "location", frame->r, 3) &&
           se3di_chrono_turn(c, map, "orientation", frame->A);
}

bool se3di_chrono_axis(se3di_chrono *c, const se3di_node *map, const char *key, double A[9])
{
    const se3di_node *node = se3di_node_get(map, key);
    double axis[3];
    if (!node) {
        return true;
    }
    return read_numbers(c, node, axis, 3) &&
           (se3di_turn_along(axis, A) || expect(c, node, "a direction that is not 0"));
}

const char *se3di_chrono_text(se3di_chrono *c, const se3di_node *map, const char *key)
{
    const se3di_node *node = se3di_node_get(map, key);
    if (node && (node->kind != SE3DI_NODE_SCALAR || !node->text[0])) {
        expect(c, node, "a text");
        return NULL;
    }
    return node ? node->text : NULL;
}

bool se3di_chrono_has(se3di_chrono *c, const se3di_node *map, const char *key)
{
    if (se3di_node_get(map, key)) {
        return true;
    }
    return se3di_machine_fail(c->m, map->line, map->column, "%s has no key `%s`",
                              map->kind == SE3DI_NODE_MAP ? "this" : se3di_node_describe(map), key);
}

const char *se3di_chrono_need(se3di_chrono *c, const se3di_node *map, const char *key)
{
    return se3di_chrono_has(c, map, key) ? se3di_chrono_text(c, map, key) : NULL;
}

const se3di_node *se3di_chrono_list(se3di_chrono *c, const se3di_node *map, const char *key)
{
    const se3di_node *node = se3di_node_get(map, key);
    if (!node || se3di_node_is_null(node)) {
        return NULL;
    }
    if (node->kind != SE3DI_NODE_LIST) {
        expect(c, node, "a list");
        return NULL;
    }
    return node->first;
}

static bool is_among(const char *word, const char *list)
{
    const size_t length = strlen(word);
    for (const char *at = list; (at = strstr(at, word)) != NULL; ++at) {
        const bool begins = at == list || at[-1] == ' ';
        if (begins && (at[length] == ' ' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

void se3di_chrono_keys(se3di_chrono *c, const se3di_node *map, const char *known)
{
    if (map->kind != SE3DI_NODE_MAP) {
        return;
    }
    for (const se3di_node *at = map->first; at; at = at->next) {
        if (!is_among(at->key, known)) {
            se3di_machine_note_of(c->m, SE3D_IMPORT_NOTE, at->key_line,
                                  "Chrono does not read `%.80s` here: it is left out", at->key);
        }
    }
}

const se3di_chrono_body *se3di_chrono_body_of(se3di_chrono *c, const se3di_node *map,
                                              const char *key)
{
    const char *name = se3di_chrono_need(c, map, key);
    size_t index = 0;
    if (!name) {
        return NULL;
    }
    if (!se3di_ionames_find(&c->names, name, &index)) {
        const se3di_node *node = se3di_node_get(map, key);
        se3di_machine_fail(c->m, node->line, node->column, "there is no body `%.200s`", name);
        return NULL;
    }
    return &c->list[index];
}

bool se3di_chrono_lose(se3di_chrono *c, const se3di_node *map, const char *what, const char *why)
{
    const se3di_node *name = se3di_node_get(map, "name");
    const bool has = name && name->kind == SE3DI_NODE_SCALAR;
    se3di_machine_note_of(c->m, SE3D_IMPORT_LOST, map->line, "the %s `%.80s`: %s", what,
                          has ? name->text : "", why);
    return true;
}

bool se3di_chrono_bodies_of(se3di_chrono *c, const se3di_node *map,
                            const se3di_chrono_body *bodies[2], bool *differ)
{
    bodies[0] = se3di_chrono_body_of(c, map, "body1");
    bodies[1] = bodies[0] ? se3di_chrono_body_of(c, map, "body2") : NULL;
    if (!bodies[1]) {
        return false;
    }
    *differ = bodies[0] != bodies[1] && !(bodies[0]->fixed && bodies[1]->fixed);
    if (!*differ) {
        se3di_chrono_lose(c, map, "element", "nothing can move between its bodies");
    }
    return true;
}
