/* SPDX-License-Identifier: BSD-3-Clause */
/* What a model that was read without mistakes says that is probably one: names that nothing uses,
 * coordinates that are driven twice, shapes that touch nothing, bodies that nothing holds, masses
 * far apart. */
#include "io/read/warn.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/model/model.h"

#define MASS_RATIO 1e9

void se3di_reader_warn(const se3di_reader *reader, const se3di_node *node, const char *format, ...)
{
    se3d_model_error error;
    const se3d_model_options *options = reader->options;
    const se3di_node *root = node;
    char path[256];
    char text[400];
    va_list arguments;
    if (!options->log) {
        return;
    }
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    while (root->parent) {
        root = root->parent;
    }
    se3di_node_format_path(node, path, sizeof path);
    se3di_document_report(&error, root->file ? root->file : reader->file, node->line, node->column,
                          path, text);
    options->log(options->log_ctx, SE3D_LOG_WARNING, SE3D_LOG_MODEL, error.message);
}

/* ---- names ----------------------------------------------------------------------------------*/

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool add_word(const se3di_reader *reader, const char *text, size_t length,
                     se3di_ionames *words)
{
    char word[64];
    if (length >= sizeof word) {
        return true;
    }
    memcpy(word, text, length);
    word[length] = '\0';
    if (se3di_ionames_find(words, word, NULL)) {
        return true;
    }
    const char *kept = se3di_iopool_copy(reader->pool, word, length);
    return kept && se3di_ionames_add(words, reader->pool, kept, 0);
}

/* All identifiers of a text. */
static bool add_words(const se3di_reader *reader, const char *text, se3di_ionames *words)
{
    for (const char *at = text; *at;) {
        size_t length = 0;
        if (is_letter(*at) && (at == text || !is_digit(at[-1]))) {
            while (is_letter(at[length]) || is_digit(at[length])) {
                ++length;
            }
            if (!add_word(reader, at, length, words)) {
                return false;
            }
        }
        at += length > 0 ? length : 1;
    }
    return true;
}

/* The identifiers of all texts below `root`; of its keys, too, in a study, which names what it
 * varies. */
static bool add_tree(const se3di_reader *reader, const se3di_node *root, se3di_ionames *words)
{
    const se3di_node *study = NULL;
    const se3di_node *node = root;
    while (node) {
        if (node->parent == root && node->key && strcmp(node->key, "study") == 0) {
            study = node;
        }
        if ((node->text && !add_words(reader, node->text, words)) ||
            (study && node->key && !add_words(reader, node->key, words))) {
            return false;
        }
        if (node->first) {
            node = node->first;
            continue;
        }
        while (node != root && !node->next) {
            study = node == study ? NULL : study;
            node = node->parent;
        }
        study = node == study ? NULL : study;
        node = node == root ? NULL : node->next;
    }
    return true;
}

static void tell_unused(const se3di_reader *reader, const se3di_node *root, const char *section,
                        const char *what, const se3di_ionames *words)
{
    const se3di_node *map = se3di_node_get(root, section);
    for (const se3di_node *node = map ? map->first : NULL; node; node = node->next) {
        if (node->key && !se3di_ionames_find(words, node->key, NULL)) {
            se3di_reader_warn(reader, node, "the %s is used nowhere", what);
        }
    }
}

/* Names stand in files of CSV as they are, heads of columns among them. */
static void tell_formulas(const se3di_reader *reader, const se3di_node *node)
{
    const bool is_name = node->key && node->text && strcmp(node->key, "name") == 0;
    if (is_name && node->text[0] && strchr(SE3DI_FORMULA_SIGNS, node->text[0])) {
        se3di_reader_warn(reader, node,
                          "a spreadsheet takes `%.60s` for a formula in files of results",
                          node->text);
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        tell_formulas(reader, child);
    }
}

/* Each file and part once, however often it is included. */
static bool warn_of_names(const se3di_reader *reader)
{
    for (const se3di_component *part = reader->model->parts; part; part = part->next) {
        const se3di_component *before = reader->model->parts;
        se3di_ionames words = {.entries = NULL};
        while (before->root != part->root) {
            before = before->next;
        }
        if (before != part) {
            continue;
        }
        tell_formulas(reader, part->root);
        if (!se3di_node_get(part->root, "parameters") && !se3di_node_get(part->root, "points")) {
            continue;
        }
        if (!add_tree(reader, part->root, &words)) {
            return false;
        }
        tell_unused(reader, part->root, "parameters", "parameter", &words);
        tell_unused(reader, part->root, "points", "point", &words);
    }
    return true;
}

/* ---- bodies ---------------------------------------------------------------------------------*/

typedef struct groups {
    const se3d_model *model;
    size_t *of;    /* [body_count] a smaller index of the same group, or its own */
    size_t *entry; /* [entry_count] of a body by its index1; 0, the ground, if there is none */
    size_t entry_count;
    bool *touches;  /* [body_count] a shape of it has a material, or says that it needs none */
    size_t *joints; /* [body_count] that it takes part in */
} groups;

static bool make_groups(const se3di_reader *reader, groups *g)
{
    const se3d_model *model = reader->model;
    *g = (groups){.model = model, .entry_count = 1};
    for (size_t k = 0; k < model->body_count; ++k) {
        const size_t index = model->bodies[k].body.index1;
        g->entry_count = index >= g->entry_count ? index + 1 : g->entry_count;
    }
    g->of = se3di_iopool_array(reader->pool, model->body_count, sizeof *g->of);
    g->entry = se3di_iopool_array(reader->pool, g->entry_count, sizeof *g->entry);
    g->touches = se3di_iopool_array(reader->pool, model->body_count, sizeof *g->touches);
    g->joints = se3di_iopool_array(reader->pool, model->body_count, sizeof *g->joints);
    if (!g->of || !g->entry || !g->touches || !g->joints) {
        return false;
    }
    for (size_t k = 0; k < model->body_count; ++k) {
        g->of[k] = k;
        g->entry[model->bodies[k].body.index1] = k;
    }
    return true;
}

static size_t entry_of(const groups *g, se3d_body body)
{
    return body.index1 < g->entry_count ? g->entry[body.index1] : 0;
}

static size_t find(const groups *g, size_t k)
{
    while (g->of[k] != k) {
        g->of[k] = g->of[g->of[k]];
        k = g->of[k];
    }
    return k;
}

static void join(const groups *g, size_t a, size_t b)
{
    const size_t i = find(g, a);
    const size_t j = find(g, b);
    g->of[i > j ? i : j] = i > j ? j : i;
}

static bool has_contact(const se3d_model *model)
{
    return se3di_node_get(model->root, "contact") || se3di_node_get(model->root, "particles");
}

/* With contact, a body whose shapes have no material goes through everything. */
static void warn_of_shapes(const se3di_reader *reader, const groups *g)
{
    const se3d_model *model = reader->model;
    if (!has_contact(model)) {
        return;
    }
    for (size_t k = 0; k < model->shape_count; ++k) {
        const se3di_node *node = model->shapes[k].node;
        const size_t body = entry_of(g, model->shapes[k].shape.body);
        if (!g->touches[body]) {
            se3di_reader_warn(
                reader, node,
                "has no material: nothing touches it; give it one, or `contact: false`");
            g->touches[body] = true; /* is told once */
        }
    }
}

static void join_constraint(const groups *g, const se3d_system *system, se3d_constraint constraint,
                            size_t is_joint)
{
    size_t count = 0;
    se3d_body first;
    se3d_body body;
    if (se3d_constraint_count_bodies(system, constraint, &count) < 0 || count == 0 ||
        se3d_constraint_get_body(system, constraint, 0, &first) < 0) {
        return;
    }
    g->joints[entry_of(g, first)] += is_joint;
    for (size_t k = 1; k < count; ++k) {
        if (se3d_constraint_get_body(system, constraint, k, &body) >= 0) {
            g->joints[entry_of(g, body)] += is_joint;
            join(g, entry_of(g, first), entry_of(g, body));
        }
    }
}

static void join_all(const groups *g, const se3d_system *system)
{
    const se3d_model *model = g->model;
    for (size_t k = 0; k < model->element_count; ++k) {
        const se3di_element_entry *e = &model->elements[k];
        if (e->kind <= SE3DI_ELEMENT_DRIVER) {
            join_constraint(g, system, e->constraint, e->kind == SE3DI_ELEMENT_JOINT);
        } else if (e->kind == SE3DI_ELEMENT_FORCE) {
            join(g, entry_of(g, e->body_i), entry_of(g, e->body_j));
            join(g, entry_of(g, e->body), 0);
        }
    }
    for (size_t k = 0; k < model->shape_count; ++k) {
        const se3di_node *node = model->shapes[k].node;
        const size_t body = entry_of(g, model->shapes[k].shape.body);
        const bool has_material = se3di_node_get(node, "material") != NULL;
        g->touches[body] |= has_material || se3di_node_get(node, "contact");
        if (has_material && has_contact(model)) {
            join(g, body, 0);
        }
    }
    for (size_t k = 1; k < model->body_count; ++k) {
        int32_t fixed = 0;
        if (se3d_body_get_fixed(system, model->bodies[k].body, &fixed) >= 0 && fixed) {
            join(g, k, 0);
        }
    }
}

static bool has_weight(const se3di_reader *reader)
{
    double g[3] = {0.0, 0.0, 0.0};
    const se3di_node *node = se3di_node_get(reader->model->root, "gravity");
    const se3d_status status = se3d_system_get_gravity(reader->system, g);
    return status < 0 || g[0] != 0.0 || g[1] != 0.0 || g[2] != 0.0 || node;
}

/* Bodies that fall for ever, the first of each group. */
static void warn_of_free_bodies(const se3di_reader *reader, const groups *g)
{
    const se3d_model *model = reader->model;
    for (size_t k = 1; k < model->body_count && has_weight(reader); ++k) {
        if (find(g, k) == k && model->bodies[k].node) {
            se3di_reader_warn(
                reader, model->bodies[k].node,
                "nothing holds %.60s: no joint, constraint, force or contact leads to the ground, "
                "it falls%s",
                model->bodies[k].name,
                g->touches[k] && !has_contact(model)
                    ? "; materials touch in a model with `contact: {}`"
                    : "");
        }
    }
}

/* A coordinate that two drivers prescribe. */
static bool warn_of_drivers(const se3di_reader *reader)
{
    const se3d_model *model = reader->model;
    se3di_ionames driven = {.entries = NULL};
    for (size_t k = 0; k < model->element_count; ++k) {
        const se3di_element_entry *e = &model->elements[k];
        char key[64];
        size_t first = 0;
        if (e->kind != SE3DI_ELEMENT_DRIVER) {
            continue;
        }
        snprintf(key, sizeof key, "%u.%d", (unsigned)e->driven.index1, (int)e->coordinate);
        if (se3di_ionames_find(&driven, key, &first)) {
            se3di_reader_warn(reader, e->node, "%.60s drives what %.60s drives already", e->name,
                              model->elements[first].name);
            continue;
        }
        const char *kept = se3di_iopool_copy(reader->pool, key, strlen(key));
        if (!kept || !se3di_ionames_add(&driven, reader->pool, kept, k)) {
            return false;
        }
    }
    return true;
}

/* A body between joints that is to weigh nothing, as importers make them. */
static bool is_dummy(const groups *g, size_t k, const double inertia[6])
{
    return g->joints[k] >= 2 && !(fabs(inertia[0] - inertia[1]) > 0.0) &&
           !(fabs(inertia[1] - inertia[2]) > 0.0);
}

static void warn_of_masses(const se3di_reader *reader, const groups *g)
{
    const se3d_model *model = reader->model;
    const se3di_body_entry *light = NULL, *heavy = NULL;
    const bool may_lack = reader->options->mass_optional || reader->is_geometric;
    double least = HUGE_VAL, most = 0.0;
    for (size_t k = 1; k < model->body_count; ++k) {
        double mass = 0.0;
        double inertia[6];
        int32_t fixed = 0;
        const se3di_body_entry *body = &model->bodies[k];
        if (!body->node || (may_lack && !se3di_node_get(body->node, "mass")) ||
            se3d_body_get_fixed(reader->system, body->body, &fixed) < 0 || fixed ||
            se3d_body_get_mass(reader->system, body->body, &mass, inertia) < 0 ||
            is_dummy(g, k, inertia)) {
            continue;
        }
        light = mass < least ? body : light;
        least = fmin(mass, least);
        heavy = mass > most ? body : heavy;
        most = fmax(mass, most);
    }
    if (light && heavy && most >= MASS_RATIO * least) {
        const se3di_node *mass = se3di_node_get(light->node, "mass");
        se3di_reader_warn(
            reader, mass ? mass : light->node,
            "%.60s has %.3g kg and %.60s has %.3g kg: masses %.1g times as large leave few digits",
            light->name, least, heavy->name, most, most / least);
    }
}

bool se3di_warn_of_model(se3di_reader *reader)
{
    if (!reader->options->log) {
        return true;
    }
    groups g;
    if (!warn_of_names(reader) || !warn_of_drivers(reader) || !make_groups(reader, &g)) {
        return se3di_reader_fail_memory(reader);
    }
    join_all(&g, reader->system);
    warn_of_free_bodies(reader, &g);
    warn_of_shapes(reader, &g);
    warn_of_masses(reader, &g);
    return true;
}
