/* SPDX-License-Identifier: BSD-3-Clause */
/* The search for all mistakes of a model. */
#include "io/read/mistakes.h"

#include <string.h>

#include "io/base/pool.h"

enum {
    READINGS_MAX = 200,
    WORK_MAX = 256 * 1024 * 1024 /* bytes that all readings look at */
};

typedef struct search {
    se3di_recovery recovery;
    se3d_model_error list[SE3D_MODEL_MISTAKES_MAX];
    const se3di_node *parents[SE3D_MODEL_MISTAKES_MAX]; /* of what they are about */
    size_t count;
} search;

void se3di_mistakes_report_one(const se3di_attempt *attempt, se3d_status status)
{
    if (status == SE3D_ERR_MODEL && attempt->options->report) {
        attempt->options->report(attempt->options->report_ctx, attempt->error);
    }
}

/* What a message says, behind "file:line:column: path: ". */
static const char *find_text(const char *message)
{
    const char *path = strstr(message, ": ");
    const char *text = path ? strstr(path + 2, ": ") : NULL;
    return text ? text : message;
}

/* Whether the same was said of another part of the same thing. Things of a list are no parts: they
 * have mistakes of their own. */
static bool is_repeated(const search *s, const se3d_model_error *error, const se3di_fault *fault)
{
    const se3di_node *node = fault->node;
    const char *text = find_text(error->message);
    if (!node || node->kind == SE3DI_NODE_MAP) {
        return false;
    }
    for (size_t k = 0; k < s->count; ++k) {
        if (s->parents[k] == node->parent && strcmp(find_text(s->list[k].message), text) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_before(const se3d_model_error *a, const se3d_model_error *b)
{
    return a->line < b->line || (a->line == b->line && a->column < b->column);
}

/* Keep the mistake, in the order of the lines, behind those of the same place. */
static void insert(search *s, const se3d_model_error *error, const se3di_fault *fault)
{
    size_t k = s->count++;
    for (; k > 0 && is_before(error, &s->list[k - 1]); --k) {
        s->list[k] = s->list[k - 1];
        s->parents[k] = s->parents[k - 1];
    }
    s->list[k] = *error;
    s->parents[k] = fault->node ? fault->node->parent : NULL;
}

/* Read what is left into next->model. @return MODEL: there is another mistake, in *next, some of
 * which is the model's. */
static se3d_status read_again(const se3d_model *like, se3di_attempt *next)
{
    next->model = se3di_model_create(next->options->allocator);
    if (!next->model) {
        return SE3D_ERR_NO_MEMORY;
    }
    next->model->file = like->file;
    next->model->name = like->name;
    next->model->root = like->root;
    return se3di_model_fill(next);
}

/* `next` is the first attempt and ends as the last one. */
static void look_further(search *s, se3di_attempt *next, size_t length)
{
    const se3d_model *first = next->model;
    se3d_status status = SE3D_ERR_MODEL;
    size_t work = 0;
    for (int k = 0; k < READINGS_MAX && work < WORK_MAX && status == SE3D_ERR_MODEL; ++k) {
        const bool new = !se3di_recovery_expects(&s->recovery, &next->fault) &&
                         !is_repeated(s, next->error, &next->fault);
        if (new) {
            insert(s, next->error, &next->fault);
        }
        if (s->count == SE3D_MODEL_MISTAKES_MAX ||
            !se3di_recovery_mend(&s->recovery, &next->fault, new)) {
            return;
        }
        if (next->model != first) {
            se3d_model_destroy(next->model);
        }
        work += length + next->attached;
        status = read_again(first, next);
    }
}

void se3di_mistakes_report_all(se3di_attempt *attempt, size_t length)
{
    se3d_model *model = attempt->model;
    search *s = se3di_iopool_alloc(&model->pool, sizeof *s);
    if (!s) {
        se3di_mistakes_report_one(attempt, SE3D_ERR_MODEL);
        return;
    }
    s->recovery.pool = &model->pool;
    se3d_model_error error = *attempt->error;
    se3di_attempt last = *attempt;
    last.error = &error;
    last.warns = false;
    look_further(s, &last, length);
    if (last.model != model) {
        se3d_model_destroy(last.model);
    }
    for (size_t k = 0; k < s->count; ++k) {
        attempt->options->report(attempt->options->report_ctx, &s->list[k]);
    }
}
