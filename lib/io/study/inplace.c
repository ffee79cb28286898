/* SPDX-License-Identifier: BSD-3-Clause */
/* A model is read anew for each sample, as a parameter may stand anywhere in it. What takes longer
 * than many a run is not needed if all that the parameters say is masses, inertias, and numbers of
 * springs: then the model that was read for the first sample is kept as it is before a run, and a
 * sample is a clone of its system in which these numbers are set. They are read by the same
 * functions from the same places of the file, and a system that has not moved yet has no history
 * and no audit of energy that would know of the change: the bits are those of a model that was read
 * anew (tests/unit/test_study.c).
 *
 * What depends on the parameters is found in the texts: another thing that has one of their
 * names only costs the reading. */
#include "io/study/inplace.h"

#include <string.h>

#include "io/document/amount.h"
#include "io/document/fields.h"
#include "io/document/value.h"
#include "io/read/include.h"
#include "io/read/inertia.h"
#include "io/read/objects.h"
#include "io/read/parameters.h"

/* A number of a spring, or the mass and inertia of a body. */
typedef struct place {
    const se3di_node *node; /* of the body or the force */
    const char *key;        /* of the force; NULL: it is a body */
    int32_t parameter;      /* se3d_force_parameter */
    int32_t reserved;
    se3d_force force;
    se3d_body body;
} place;

struct se3di_prototype {
    se3di_iopool pool; /* the prototype itself lies in it */
    const char **names;
    size_t name_count, own; /* own: the first ones are parameters that are set */
    se3d_model *model;      /* NULL: these parameters need a reading */
    const se3di_scope *scope;
    se3d_system *system; /* of the model, which never moves */
    place *places;
    size_t place_count, place_capacity;
    bool is_used, is_sharp;
};

typedef struct se3di_prototype prototype;

/* ---- what depends on the parameters ----------------------------------------------------------*/

static bool is_name(const prototype *p, const char *text, size_t length)
{
    for (size_t k = 0; k < p->name_count; ++k) {
        if (strncmp(p->names[k], text, length) == 0 && p->names[k][length] == '\0') {
            return true;
        }
    }
    return false;
}

static bool is_mentioned(const prototype *p, const char *text)
{
    size_t length = 0;
    const char *at = text ? se3di_amount_next_name(text, &length) : NULL;
    while (at && !is_name(p, at, length)) {
        at = se3di_amount_next_name(at + length, &length);
    }
    return at != NULL;
}

/* Whether a text at or below a node has one of the names. */
static bool depends(const prototype *p, const se3di_node *node)
{
    if (node->kind == SE3DI_NODE_SCALAR) {
        return is_mentioned(p, node->text);
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (depends(p, child)) {
            return true;
        }
    }
    return false;
}

/* Parameters that are made of others depend on them. */
static void add_dependent(prototype *p, const se3di_node *root)
{
    const se3di_node *map = se3di_node_get(root, "parameters");
    size_t before;
    do {
        before = p->name_count;
        for (const se3di_node *node = map ? map->first : NULL; node; node = node->next) {
            if (!is_name(p, node->key, strlen(node->key)) && depends(p, node)) {
                p->names[p->name_count++] = node->key;
            }
        }
    } while (p->name_count > before);
}

static bool is_passed_over(const char *key)
{
    static const char *const keys[] = {"se3d", "title", "units", "parameters", "output", "study"};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k) {
        if (strcmp(key, keys[k]) == 0) {
            return true;
        }
    }
    return false;
}

static bool add_place(prototype *p, const place *made)
{
    place *places = p->places;
    if (p->place_count == p->place_capacity) {
        p->place_capacity = 2 * p->place_capacity + 16;
        places = se3di_iopool_array(&p->pool, p->place_capacity, sizeof *places);
        if (!places) {
            return false;
        }
        if (p->place_count > 0) {
            memcpy(places, p->places, p->place_count * sizeof *places);
        }
        p->places = places;
    }
    places[p->place_count++] = *made;
    return true;
}

/* Whether the parameters say nothing of a body but its mass and inertia. */
static bool take_body(prototype *p, const se3di_node *map, bool *good)
{
    bool is_wanted = false;
    for (const se3di_node *key = map->first; key; key = key->next) {
        if (depends(p, key)) {
            if (strcmp(key->key, "mass") != 0 && strcmp(key->key, "inertia") != 0) {
                return false;
            }
            is_wanted = true;
        }
    }
    if (!is_wanted) {
        return true;
    }
    if (!se3di_node_get(map, "mass") || !se3di_node_get(map, "inertia") ||
        se3di_node_get(map, "from") || se3di_node_get(map, "fixed")) {
        return false; /* one follows from the other, or from a shape */
    }
    for (size_t k = 1; k < p->model->body_count; ++k) {
        if (p->model->bodies[k].node == map) {
            const place made = {.node = map, .body = p->model->bodies[k].body};
            *good = *good && add_place(p, &made);
        }
    }
    return true;
}

/* The parameter of a spring that a key is, -1: it is none. */
static int32_t find_parameter(const se3di_node *map, const char *key)
{
    const se3di_node *type = se3di_node_get(map, "type");
    const bool is_tsda = type && type->text && strcmp(type->text, "tsda") == 0;
    const bool is_rsda = type && type->text && strcmp(type->text, "rsda") == 0;
    if (!is_tsda && !is_rsda) {
        return -1;
    }
    if (strcmp(key, "preload") == 0 && !se3di_node_get(map, "h")) {
        return SE3D_FORCE_PARAMETER_PRELOAD;
    }
    return strcmp(key, "k") == 0                         ? SE3D_FORCE_PARAMETER_K
           : strcmp(key, "c") == 0                       ? SE3D_FORCE_PARAMETER_C
           : strcmp(key, is_tsda ? "l0" : "theta0") == 0 ? SE3D_FORCE_PARAMETER_REST
                                                         : -1;
}

static bool take_force(prototype *p, const se3di_node *map, bool *good)
{
    for (const se3di_node *key = map->first; key; key = key->next) {
        const int32_t parameter = find_parameter(map, key->key);
        if (!depends(p, key)) {
            continue;
        }
        if (parameter < 0 || key->kind != SE3DI_NODE_SCALAR) {
            return false;
        }
        for (size_t k = 0; k < p->model->element_count; ++k) {
            const se3di_element_entry *e = &p->model->elements[k];
            if (e->node == map && e->kind == SE3DI_ELEMENT_FORCE) {
                const place made = {
                    .node = map, .key = key->key, .parameter = parameter, .force = e->force};
                *good = *good && add_place(p, &made);
            }
        }
    }
    return true;
}

/* Each entry of a list. */
static bool take_list(prototype *p, const se3di_node *list,
                      bool (*take)(prototype *p, const se3di_node *map, bool *good), bool *good)
{
    for (const se3di_node *map = list->first; map; map = map->next) {
        if (map->kind != SE3DI_NODE_MAP ? depends(p, map) : !take(p, map, good)) {
            return false;
        }
    }
    return true;
}

/* Whether a channel, band or curve of a measure depends on the parameters; an expression of other
 * measures is evaluated with those of the sample anyway. */
static bool has_dependent_measure(const prototype *p, const se3di_node *study)
{
    const se3di_node *measures = se3di_node_get(study, "measures");
    for (const se3di_node *node = measures ? measures->first : NULL; node; node = node->next) {
        if (node->kind == SE3DI_NODE_MAP && depends(p, node)) {
            return true;
        }
    }
    return false;
}

/* Whether all that the parameters say can be set. */
static bool take_root(prototype *p, const se3di_node *root, bool *good)
{
    for (const se3di_node *key = root->first; key; key = key->next) {
        const bool is_list = key->kind == SE3DI_NODE_LIST;
        if (strcmp(key->key, "study") == 0 && has_dependent_measure(p, key)) {
            return false;
        }
        if (is_passed_over(key->key)) {
            continue;
        }
        if (strcmp(key->key, "bodies") == 0 && is_list) {
            if (!take_list(p, key, take_body, good)) {
                return false;
            }
        } else if (strcmp(key->key, "forces") == 0 && is_list) {
            if (!take_list(p, key, take_force, good)) {
                return false;
            }
        } else if (depends(p, key)) {
            return false;
        }
    }
    return true;
}

/* Parameters that options have replaced, and files of points, are not looked into. */
static bool is_plain(const se3d_study *study)
{
    const se3d_model *model = study->model;
    return study->entry->options.setting_count == 0 && !model->particles &&
           !se3di_node_get(model->root, "point_table");
}

/* Find the places of the parameters. @return false: the model is to be read anew */
static bool take_model(prototype *p, const se3di_node *root, bool *good)
{
    add_dependent(p, root);
    if (!take_root(p, root, good)) {
        return false;
    }
    for (const se3di_component *part = p->model->parts->next; part; part = part->next) {
        if (depends(p, part->root)) {
            return false;
        }
    }
    return true;
}

/* ---- the model that is kept ------------------------------------------------------------------*/

void se3di_inplace_destroy(se3d_study *study)
{
    prototype *p = study->prototype;
    if (p) {
        se3di_iopool pool = p->pool;
        se3d_model_destroy(p->model);
        se3di_iopool_destroy(&pool);
        study->prototype = NULL;
    }
}

bool se3di_inplace_is_kept(const se3d_study *study)
{
    return study->prototype && study->prototype->model;
}

/* Whether the last samples had values for the same parameters. */
static bool is_of(const prototype *p, const se3d_study *study, const se3di_named *values,
                  size_t count)
{
    bool same = p->own == count && p->is_sharp == study->is_sharp;
    for (size_t k = 0; k < count && same; ++k) {
        same = strcmp(p->names[k], values[k].name) == 0;
    }
    return same;
}

/* A prototype without a model, with room for all names. */
static prototype *create(se3d_study *study, const se3di_named *values, size_t count)
{
    const se3di_node *map = se3di_node_get(study->model->root, "parameters");
    se3di_iopool pool;
    se3di_iopool_init(&pool, &study->pool.allocator);
    prototype *p = se3di_iopool_alloc(&pool, sizeof *p);
    if (!p) {
        se3di_iopool_destroy(&pool);
        return NULL;
    }
    p->pool = pool;
    p->is_sharp = study->is_sharp;
    p->names = se3di_iopool_array(&p->pool, count + (map ? map->count : 0) + 1, sizeof *p->names);
    for (size_t k = 0; k < count && p->names; ++k) {
        p->names[k] = se3di_iopool_copy(&p->pool, values[k].name, strlen(values[k].name));
    }
    if (!p->names || (count > 0 && !p->names[count - 1])) {
        pool = p->pool;
        se3di_iopool_destroy(&pool);
        return NULL;
    }
    p->own = p->name_count = count;
    return p;
}

/* Read the model of these values, and see whether it can be kept. A model that cannot be read is
 * none of ours: whoever reads it anew says why. */
static se3d_status prepare(se3d_study *study, const se3di_named *values, size_t count)
{
    se3d_model_error error;
    bool good = true;
    prototype *p = create(study, values, count);
    if (!p) {
        return SE3D_ERR_NO_MEMORY;
    }
    study->prototype = p;
    if (study->rebuilds || !is_plain(study)) {
        return SE3D_OK;
    }
    const se3d_status status = se3di_study_read(study, values, count, &p->model, &error);
    if (status >= 0 && take_model(p, study->model->root, &good)) {
        p->scope = p->model->scope;
        p->system = p->model->system;
    } else {
        se3d_model_destroy(p->model);
        p->model = NULL;
    }
    if (status == SE3D_ERR_NO_MEMORY || !good) {
        se3di_inplace_destroy(study);
        return SE3D_ERR_NO_MEMORY;
    }
    if (status < 0) {
        se3di_inplace_destroy(study); /* the next values may be better ones */
    }
    return SE3D_OK;
}

/* ---- one sample ------------------------------------------------------------------------------*/

static bool set_body(se3di_reader *reader, const place *at)
{
    double mass = 0.0;
    double inertia[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    return se3di_read_key(reader, at->node, &se3di_object_body, NULL, "mass", &mass) &&
           se3di_read_inertia(reader, se3di_node_get(at->node, "inertia"), inertia) &&
           se3d_body_set_mass(reader->system, at->body, mass, inertia) >= 0;
}

static bool set_force(se3di_reader *reader, const place *at)
{
    const char *type = se3di_node_get(at->node, "type")->text;
    const bool is_coefficient =
        at->parameter == SE3D_FORCE_PARAMETER_K || at->parameter == SE3D_FORCE_PARAMETER_C;
    double value = 0.0;
    reader->alternative = strcmp(type, "rsda") == 0 ? 1 : 0;
    const bool good =
        is_coefficient
            ? se3di_read_key_number(reader, at->node, at->key, SE3DI_ANY, &value)
            : se3di_read_key(reader, at->node, &se3di_object_force, type, at->key, &value);
    reader->alternative = 0;
    return good && se3d_force_set_parameter(reader->system, at->force, at->parameter, value) >= 0;
}

static bool set_all(const prototype *p, se3di_reader *reader)
{
    if (!se3di_read_parameters(reader, p->model->parts, NULL)) {
        return false;
    }
    se3di_reader_enter(reader, p->model->parts);
    p->model->scope = reader->scope;
    for (size_t k = 0; k < p->place_count; ++k) {
        const place *at = &p->places[k];
        if (!(at->key ? set_force(reader, at) : set_body(reader, at))) {
            return false;
        }
    }
    return true;
}

void se3di_inplace_end(se3d_study *study)
{
    prototype *p = study->prototype;
    if (p && p->is_used) {
        se3d_system_destroy(p->model->system);
        p->model->system = p->system;
        p->model->scope = p->model->parts->scope = p->scope;
        p->is_used = false;
    }
}

se3d_status se3di_inplace_begin(se3d_study *study, const se3di_named *values, size_t count,
                                se3di_iopool *pool, se3d_model **model)
{
    se3d_model_error error;
    se3d_system *clone = NULL;
    *model = NULL;
    if (study->prototype && !is_of(study->prototype, study, values, count)) {
        se3di_inplace_destroy(study);
    }
    if (!study->prototype) {
        const se3d_status status = prepare(study, values, count);
        if (status < 0) {
            return status;
        }
    }
    prototype *p = study->prototype;
    if (!p || !p->model) {
        return SE3D_OK;
    }
    const se3d_status status = se3d_system_clone(p->system, &clone);
    if (status < 0) {
        return status == SE3D_ERR_NO_MEMORY ? status : SE3D_OK;
    }
    p->is_used = true;
    p->model->system = clone;
    se3di_reader reader = {.model = p->model,
                           .pool = pool,
                           .file = p->model->file,
                           .system = clone,
                           .part = p->model->parts,
                           .options = &study->entry->options,
                           .error = &error,
                           .values = values,
                           .value_count = count,
                           .study = study->entry};
    if (set_all(p, &reader)) {
        *model = p->model;
        return SE3D_OK;
    }
    se3di_inplace_end(study);
    return reader.status == SE3D_ERR_NO_MEMORY ? reader.status : SE3D_OK;
}
