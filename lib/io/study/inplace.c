/* SPDX-License-Identifier: BSD-3-Clause */
/* A model is read anew for each sample, as a parameter may stand anywhere in it. What takes longer
 * than many a run is not needed if all that the parameters say is poses, masses and points, axes
 * and numbers of joints, constraints, drivers, forces and wheels: then the model that was read for
 * the first sample is kept as it is before a run, and a sample is a clone of its system in which
 * what depends on them (dependence.c) is defined again. It is read by the same functions from the
 * same places of the file in the same order, and a system that has not moved yet has no history and
 * no audit of energy that would know of the change: the bits are those of a model that was read
 * anew (tests/unit/test_study.c). */
#include "io/study/inplace.h"

#include <string.h>

#include "io/document/value.h"
#include "io/read/include.h"
#include "io/read/parameters.h"
#include "io/read/sections.h"
#include "io/study/dependence.h"

struct se3di_prototype {
    se3di_iopool pool; /* the prototype itself lies in it */
    const char **names;
    size_t count;        /* of parameters that are set */
    se3d_model *model;   /* NULL: these parameters need a reading */
    se3d_system *system; /* of the model, which never moves */
    se3di_dependence d;
    bool is_used, is_sharp;
};

typedef struct se3di_prototype prototype;

/* Parameters that options have replaced, and files of points, are not looked into. */
static bool is_plain(const se3d_study *study)
{
    const se3d_model *model = study->model;
    return study->entry->options.setting_count == 0 && !model->particles &&
           !se3di_node_get(model->root, "point_table");
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
    bool same = p->count == count && p->is_sharp == study->is_sharp;
    for (size_t k = 0; k < count && same; ++k) {
        same = strcmp(p->names[k], values[k].name) == 0;
    }
    return same;
}

/* A prototype without a model, with room for all names. */
static prototype *create(se3d_study *study, const se3di_named *values, size_t count)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, &study->pool.allocator);
    prototype *p = se3di_iopool_alloc(&pool, sizeof *p);
    if (!p) {
        se3di_iopool_destroy(&pool);
        return NULL;
    }
    p->pool = pool;
    p->is_sharp = study->is_sharp;
    p->names = se3di_iopool_array(&p->pool, count + 1, sizeof *p->names);
    for (size_t k = 0; k < count && p->names; ++k) {
        p->names[k] = se3di_iopool_copy(&p->pool, values[k].name, strlen(values[k].name));
    }
    if (p->pool.is_short) {
        pool = p->pool;
        se3di_iopool_destroy(&pool);
        return NULL;
    }
    p->count = count;
    return p;
}

/* Read the model of these values, and see whether it can be kept. A model that cannot be read is
 * none of ours: whoever reads it anew says why. */
static se3d_status prepare(se3d_study *study, const se3di_named *values, size_t count)
{
    se3d_model_error error;
    bool is_all = false;
    prototype *p = create(study, values, count);
    if (!p) {
        return SE3D_ERR_NO_MEMORY;
    }
    study->prototype = p;
    if (study->rebuilds || !is_plain(study)) {
        return SE3D_OK;
    }
    se3d_status status = se3di_study_read(study, values, count, &p->model, &error);
    if (status >= 0) {
        status = se3di_dependence_find(p->model, p->names, count, &p->pool, &p->d, &is_all);
        p->system = p->model->system;
    }
    if (!is_all) {
        se3d_model_destroy(p->model);
        p->model = NULL;
    }
    if (status < 0) {
        se3di_inplace_destroy(study); /* the next values may be better ones */
    }
    return status == SE3D_ERR_NO_MEMORY ? status : SE3D_OK;
}

/* ---- one sample ------------------------------------------------------------------------------*/

/* The values of all that depends, part by part. */
static bool renew(const se3di_dependent_part *part, se3di_reader *reader, const se3di_named *values)
{
    se3di_scope *scope = part->part->scope;
    for (size_t k = 0; k < part->renewal_count; ++k) {
        const se3di_renewal *r = &part->renewals[k];
        se3di_amount given;
        if (r->given) {
            se3di_reader_enter(reader, part->parent->part);
            if (!se3di_read_value(reader, r->given, &given)) {
                return false;
            }
        } else if (r->value != SIZE_MAX) {
            given = values[r->value].value;
        }
        se3di_reader_enter(reader, part->part);
        if (!se3di_read_parameter_again(reader, scope, r->node, r->is_point,
                                        r->given || r->value != SIZE_MAX ? &given : NULL)) {
            return false;
        }
    }
    return true;
}

static bool set_all(const prototype *p, se3di_reader *reader, const se3di_named *values)
{
    se3d_model *model = p->model;
    for (size_t k = 0; k < p->d.part_count; ++k) {
        if (!renew(&p->d.parts[k], reader, values)) {
            return false;
        }
    }
    for (size_t k = 0; k < model->element_count && p->d.has_wheels; ++k) {
        model->elements[k].is_paired = false;
    }
    (void)se3d_system_set_replacing(reader->system, 1);
    reader->again = p->d.again;
    const bool good = se3di_read_mechanism_again(reader, model->root);
    return se3d_system_set_replacing(reader->system, 0) >= 0 && good;
}

se3d_system *se3di_inplace_take(se3d_study *study)
{
    prototype *p = study->prototype;
    se3d_system *taken = p && p->is_used ? p->model->system : NULL;
    if (taken) {
        p->model->system = p->system;
        p->is_used = false;
    }
    return taken;
}

void se3di_inplace_end(se3d_study *study)
{
    se3d_system_destroy(se3di_inplace_take(study));
}

se3d_status se3di_inplace_begin(se3d_study *study, const se3di_named *values, size_t count,
                                se3di_iopool *pool, se3d_model **model)
{
    se3d_model_error error;
    se3d_system *clone = NULL;
    *model = NULL;
    memset(&error, 0, sizeof error);
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
    if (set_all(p, &reader, values)) {
        *model = p->model;
        return SE3D_OK;
    }
    se3di_inplace_end(study);
    return reader.status == SE3D_ERR_NO_MEMORY ? reader.status : SE3D_OK;
}
