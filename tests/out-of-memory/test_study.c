/* SPDX-License-Identifier: BSD-3-Clause */
/* The k-th allocation of a study fails, once or for ever: the failure is reported, nothing leaks,
 * and the study goes on when there is memory again. */
#include <stdlib.h>

#include "check.h"
#include "se3d/study.h"
#include "support/counting.h"

static const char text[] =
    "se3d: 1\n"
    "parameters: {h: 1, m: 2}\n"
    "parts: {p: {parameters: {a: 1}, bodies: [{name: b, mass: a, inertia: [1, 1, 1]}]}}\n"
    "instances: [{part: p, parameters: {a: m}}]\n"
    "bodies: [{name: block, mass: m, inertia: [1, 1, 1], position: [0, 0, h]}]\n"
    "events: [{name: low, channel: block.position.z, value: 0.99}]\n"
    "analysis: [{type: assembly}, {type: dynamics, duration: 0.2, step: 0.05}]\n"
    "study: {parameters: {h: \"normal(1, 0.001)\", m: {from: 1, to: 2}}, samples: 3,\n"
    "  measures: {z: {min: block.position.z}, s: {settling: block.position.z, band: 1},\n"
    "    v: {at: b.velocity.z, event: low}, e: z + m}}\n";

typedef struct attempt {
    se3d_status status;
    size_t failed;
    char rows[600];
} attempt;

static se3d_status use_table(se3d_study *study, const char *path, const char *row,
                             se3d_model_error *error)
{
    const char *const paths[] = {path};
    char merged[900];
    se3d_study_merge_options how = se3d_study_merge_options_default();
    se3d_study_table_def def = se3d_study_table_def_default();
    se3d_study_table *table = NULL;
    def.path = path;
    remove(path);
    snprintf(merged, sizeof merged, "%s.merged", path);
    se3d_status status = se3d_study_table_open(study, &def, &table, error);
    if (status >= 0) {
        status = se3d_study_table_append(table, row, error);
    }
    se3d_study_table_close(table);
    def.resume = 1;
    table = NULL;
    if (status >= 0) {
        status = se3d_study_table_open(study, &def, &table, error);
    }
    se3d_study_table_close(table);
    if (status >= 0) {
        how.partial = 1;
        status = se3d_study_merge(study, paths, 1, merged, &how, NULL, error);
        status = status == SE3D_ERR_STATE ? SE3D_OK : status; /* two samples are missing */
    }
    remove(path);
    remove(merged);
    return status;
}

static se3d_status use_study(se3d_study *study, char *rows, se3d_model_error *error)
{
    static const char request[] = "{\"id\": \"a\", \"parameters\": {\"m\": 3}}";
    const char *row = "";
    const char *reply = "";
    char path[800];
    snprintf(error->message, sizeof error->message, "out of memory");
    se3d_status status = se3d_study_run_sample(study, 1, &row);
    snprintf(rows, 600, "%s", row);
    if (status >= 0) {
        status = se3d_study_answer(study, request, strlen(request), &reply);
    }
    if (status >= 0) {
        CHECK_CONTAINS(reply, "{\"id\": \"a\", \"measures\": {\"z\": ");
        snprintf(rows + strlen(rows), 600 - strlen(rows), "%s", reply);
        snprintf(path, sizeof path, "%s/out-of-memory-study.csv", check_scratch());
        char kept[300];
        snprintf(kept, sizeof kept, "%.*s", (int)(strchr(rows, '\n') + 1 - rows), rows);
        status = use_table(study, path, kept, error);
    }
    return status;
}

/* A study of a text, of which allocation k fails. */
typedef struct opened {
    support_counting counting;
    se3d_allocator allocator;
    se3d_model *model;
    se3d_study *study;
    se3d_model_error error;
} opened;

static se3d_status open_study(opened *o, const char *words, size_t k, int for_ever)
{
    se3d_model_options options = se3d_model_options_default();
    *o = (opened){.counting = {.fail_at = k, .for_ever = for_ever}};
    o->allocator = support_counting_allocator(&o->counting);
    options.allocator = &o->allocator;
    const se3d_status status =
        se3d_model_read_text(words, strlen(words), "m.yaml", &options, &o->model, &o->error);
    return status < 0 ? status : se3d_study_create(o->model, &o->study, &o->error);
}

static void close_study(opened *o)
{
    se3d_study_destroy(o->study);
    se3d_model_destroy(o->model);
    CHECK(o->counting.live == 0 && o->counting.bytes == 0 && o->counting.wrong == 0);
}

static attempt try_once(size_t k, int for_ever)
{
    opened o;
    attempt a = {SE3D_OK, 0, ""};
    a.status = open_study(&o, text, k, for_ever);
    if (a.status >= 0) {
        a.status = use_study(o.study, a.rows, &o.error);
        CHECK(a.status < 0 || a.rows[0]);
    }
    a.failed = o.counting.failed;
    CHECK(a.status >= 0 || o.error.message[0] != '\0');
    o.counting.fail_at = 0;
    if (a.status < 0 && o.study) { /* there is memory again */
        CHECK(use_study(o.study, a.rows, &o.error) == SE3D_OK);
    }
    close_study(&o);
    return a;
}

static void a_study_survives_every_failed_allocation(void)
{
    const attempt whole = try_once(0, 0);
    CHECK(whole.status >= 0 && whole.rows[0]);
    for (int for_ever = 0; for_ever < 2; ++for_ever) {
        size_t k = 1;
        for (attempt a = {.failed = 1}; k < 5000 && a.failed > 0; ++k) {
            a = try_once(k, for_ever);
            CHECK(a.status == SE3D_ERR_NO_MEMORY || (a.status >= 0 && a.failed == 0));
            CHECK(!a.rows[0] || strcmp(a.rows, whole.rows) == 0);
        }
        CHECK(k > 200 && k < 5000);
    }
}

static const char still[] =
    "se3d: 1\nparameters: {h: 1}\n"
    "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [0, 0, h]}]\n"
    "analysis: {type: dynamics, duration: 0.01}\n"
    "study: {sensitivities: [h], optimize: {minimize: z, parameters: {h: {from: 0, to: 2}}},\n"
    "  measures: {z: {final: block.position.z}}}\n";

static attempt differentiate_once(size_t k, int for_ever)
{
    opened o;
    attempt a = {SE3D_OK, 0, ""};
    double value = 0.0, slope = 0.0;
    const double h = 1.0;
    a.status = open_study(&o, still, k, for_ever);
    if (a.status >= 0) {
        a.status = se3d_study_eval_sensitivity(o.study, 0, &value, &slope, NULL, &o.error);
    }
    if (a.status >= 0) {
        CHECK(fabs(slope - 1.0) < 1e-12);
        a.status = se3d_study_eval_unknowns(o.study, &h, &value, &slope, &o.error);
    }
    a.failed = o.counting.failed;
    CHECK(a.status >= 0 ? fabs(slope - 1.0) < 1e-9 : o.error.message[0] != '\0');
    close_study(&o);
    return a;
}

static void derivatives_survive_failed_allocations(void)
{
    for (int for_ever = 0; for_ever < 2; ++for_ever) {
        size_t k = 1;
        for (attempt a = {.failed = 1}; k < 5000 && a.failed > 0; k += k < 200 ? 1 : 7) {
            a = differentiate_once(k, for_ever);
            CHECK(a.status == SE3D_ERR_NO_MEMORY || (a.status >= 0 && a.failed == 0));
        }
        CHECK(k > 200 && k < 5000);
    }
}

int main(void)
{
    RUN(derivatives_survive_failed_allocations);
    RUN(a_study_survives_every_failed_allocation);
    return check_finish();
}
