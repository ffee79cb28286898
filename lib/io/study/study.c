/* SPDX-License-Identifier: BSD-3-Clause */
/* Studies: what they are made of, and the rows of their samples. */
#include "io/study/study.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/hash.h"
#include "io/base/number.h"
#include "io/document/document.h"
#include "io/study/design.h"
#include "io/study/inplace.h"

static se3d_status fail(se3d_model_error *error, const char *file, se3d_status status,
                        const char *text)
{
    se3di_document_report(error, file, 0, 0, "", text);
    return status;
}

static uint64_t hash_text(uint64_t hash, const char *text)
{
    return text ? se3di_hash_bytes(hash, text, strlen(text) + 1) : se3di_hash_bytes(hash, "", 0);
}

/* Of all files of the model, and of what options change. */
static uint64_t hash_study(const se3d_study *study)
{
    const se3d_model_options *o = &study->entry->options;
    const char *const texts[] = {o->analysis, o->formulation, o->method,
                                 o->step,     o->duration,    o->tolerance};
    uint64_t hash = study->model->content;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
        const unsigned char mark = texts[k] ? (unsigned char)(k + 1) : 0;
        hash = hash_text(se3di_hash_bytes(hash, &mark, 1), texts[k]);
    }
    for (size_t k = 0; k < o->setting_count; ++k) {
        hash = hash_text(hash_text(hash, o->settings[k].name), o->settings[k].value);
    }
    return hash;
}

static bool make_head(se3d_study *study)
{
    const se3di_study_entry *entry = study->entry;
    size_t size = 200;
    for (size_t k = 0; k < entry->variable_count; ++k) {
        size += strlen(entry->variables[k].name) + 1;
    }
    for (size_t k = 0; k < entry->measure_count; ++k) {
        size += strlen(entry->measures[k].name) + 1;
    }
    char *head = se3di_iopool_array(&study->pool, size, 1);
    if (!head) {
        return false;
    }
    size_t used = (size_t)snprintf(head, size,
                                   "# se3d study 1, se3d %s, model %016" PRIx64
                                   ", %zu parameters, %" PRIu64 " samples",
                                   se3d_version_get_text(), hash_study(study),
                                   entry->variable_count, se3di_design_count(entry)) +
                  1;
    used += (size_t)snprintf(head + used, size - used, "sample");
    for (size_t k = 0; k < entry->variable_count; ++k) {
        used += (size_t)snprintf(head + used, size - used, ",%s", entry->variables[k].name);
    }
    for (size_t k = 0; k < entry->measure_count; ++k) {
        used += (size_t)snprintf(head + used, size - used, ",%s", entry->measures[k].name);
    }
    snprintf(head + used, size - used, ",status\n");
    study->head = head;
    return true;
}

const char *se3di_study_get_columns(const se3d_study *study)
{
    return study->head + strlen(study->head) + 1;
}

static bool fill(se3d_study *study)
{
    const se3di_study_entry *entry = study->entry;
    const size_t variables = entry->variable_count;
    const size_t measures = entry->measure_count;
    se3di_iopool *pool = &study->pool;
    study->tallies = se3di_iopool_array(pool, measures, sizeof *study->tallies);
    study->measures = se3di_iopool_array(pool, measures, sizeof *study->measures);
    study->parameters = se3di_iopool_array(pool, variables, sizeof *study->parameters);
    study->values = se3di_iopool_array(pool, variables, sizeof *study->values);
    study->row_size = (variables + measures + 2) * SE3DI_STUDY_CELL + 2 * SE3DI_STUDY_REASON;
    study->row = se3di_iopool_array(pool, study->row_size, 1);
    if (!study->tallies || !study->measures || !study->parameters || !study->values ||
        !study->row) {
        return false;
    }
    for (size_t k = 0; k < variables; ++k) {
        study->values[k].name = entry->variables[k].name;
        study->values[k].value = entry->variables[k].shape;
    }
    return make_head(study);
}

/* The analysis that is measured. */
static bool find_analysis(const se3d_model *model, size_t *index)
{
    const size_t asked = (size_t)model->study->analysis;
    *index = asked > 0 ? asked - 1 : model->analysis_count - 1;
    return *index < model->analysis_count;
}

se3d_status se3d_study_create(se3d_model *model, se3d_study **out, se3d_model_error *error)
{
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (out) {
        *out = NULL;
    }
    if (!model || !out) {
        return fail(error, "", SE3D_ERR_NULL, "model or out is NULL");
    }
    if (!model->study) {
        return fail(error, model->file, SE3D_ERR_STATE,
                    "the model has no `study`: which parameters vary, and what is measured?");
    }
    size_t analysis = 0;
    if (!find_analysis(model, &analysis)) {
        return fail(error, model->file, SE3D_ERR_STATE,
                    "there is nothing to measure: add `analysis: {type: dynamics, duration: 1}` to "
                    "the model");
    }
    se3di_iopool pool;
    se3di_iopool_init(&pool, &model->pool.allocator);
    se3d_study *study = se3di_iopool_alloc(&pool, sizeof *study);
    if (study) {
        study->pool = pool;
        study->model = model;
        study->entry = model->study;
        study->analysis = analysis;
        se3di_iopool_init(&study->reply_pool, &model->pool.allocator);
    }
    if (!study || !fill(study)) {
        pool = study ? study->pool : pool; /* the study itself lies in it */
        se3di_iopool_destroy(&pool);
        return fail(error, model->file, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    *out = study;
    return SE3D_OK;
}

void se3d_study_destroy(se3d_study *study)
{
    if (study && !study->is_running) {
        se3di_iopool_destroy(&study->reply_pool);
        se3di_inplace_destroy(study);
        se3di_iopool pool = study->pool; /* the study itself lies in it */
        se3di_iopool_destroy(&pool);
    }
}

uint64_t se3d_study_count_samples(const se3d_study *study)
{
    return study ? se3di_design_count(study->entry) : 0;
}

size_t se3d_study_count_parameters(const se3d_study *study)
{
    return study ? study->entry->variable_count : 0;
}

const char *se3d_study_get_parameter_name(const se3d_study *study, size_t index)
{
    return index < se3d_study_count_parameters(study) ? study->entry->variables[index].name : "";
}

size_t se3d_study_count_measures(const se3d_study *study)
{
    return study ? study->entry->measure_count : 0;
}

const char *se3d_study_get_measure_name(const se3d_study *study, size_t index)
{
    return index < se3d_study_count_measures(study) ? study->entry->measures[index].name : "";
}

se3d_status se3d_study_set_interrupt(se3d_study *study, se3d_interrupt interrupt, void *ctx)
{
    if (!study) {
        return SE3D_ERR_NULL;
    }
    study->interrupt = interrupt;
    study->interrupt_ctx = ctx;
    return SE3D_OK;
}

se3d_status se3d_study_get_sample(const se3d_study *study, uint64_t sample, double *parameters)
{
    if (!study || !parameters) {
        return SE3D_ERR_NULL;
    }
    if (sample >= se3di_design_count(study->entry)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_design_get(study->entry, sample, parameters);
    return SE3D_OK;
}

se3d_status se3d_study_eval(se3d_study *study, const double *parameters, double *measures,
                            se3d_model_error *error)
{
    se3d_model_error own;
    error = error ? error : &own;
    if (!study || !parameters || !measures) {
        return fail(error, "", SE3D_ERR_NULL, "study, parameters or measures is NULL");
    }
    if (study->is_running) {
        return fail(error, study->model->file, SE3D_ERR_STATE,
                    "a sample of the study is being run");
    }
    const size_t count = study->entry->variable_count;
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        measures[k] = (double)NAN;
    }
    for (size_t k = 0; k < count; ++k) {
        study->values[k].value.v[0] = parameters[k];
        if (!isfinite(parameters[k])) {
            char text[120];
            snprintf(text, sizeof text, "%.60s = %g, must be finite", study->values[k].name,
                     parameters[k]);
            return fail(error, "", SE3D_ERR_INVALID_ARGUMENT, text);
        }
    }
    return se3di_study_run(study, study->values, count, measures, error);
}

/* ---- rows ------------------------------------------------------------------------------------*/

/* Why a sample failed, as a cell: without advice, and without the folder of the model, which is not
 * the same on all machines. */
static size_t put_reason(const se3d_study *study, char *to, const char *reason)
{
    const char *file = study->model->file;
    const char *slash = strrchr(file, '/');
    const size_t folder = slash ? (size_t)(slash - file) + 1 : 0;
    const char *advice = strstr(reason, ". What to try: ");
    reason += strncmp(reason, file, folder) == 0 ? folder : 0;
    size_t length = advice ? (size_t)(advice - reason) : strlen(reason);
    char *at = to;
    *at++ = '"';
    for (size_t k = 0; k < length && k < SE3DI_STUDY_REASON; ++k) {
        const unsigned char c = (unsigned char)reason[k];
        if (c == '"') {
            *at++ = '"';
        }
        *at++ = c < 0x20 || c == 0x7f ? ' ' : (char)c;
    }
    *at++ = '"';
    return (size_t)(at - to);
}

static size_t put_numbers(char *to, const double *numbers, size_t count)
{
    size_t used = 0;
    for (size_t k = 0; k < count; ++k) {
        to[used++] = ',';
        used += isfinite(numbers[k]) ? se3di_number_format(numbers[k], to + used) : 0;
    }
    return used;
}

se3d_status se3d_study_run_sample(se3d_study *study, uint64_t sample, const char **row)
{
    se3d_model_error error = {.message = ""};
    if (row) {
        *row = "";
    }
    if (!study || !row) {
        return SE3D_ERR_NULL;
    }
    if (study->is_running) {
        return SE3D_ERR_STATE;
    }
    se3d_status status = se3d_study_get_sample(study, sample, study->parameters);
    if (status < 0) {
        return status;
    }
    status = se3d_study_eval(study, study->parameters, study->measures, &error);
    if (status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_INTERRUPTED) {
        return status; /* that says nothing of the sample */
    }
    char *text = study->row;
    size_t used = (size_t)snprintf(text, study->row_size, "%" PRIu64, sample);
    used += put_numbers(text + used, study->parameters, study->entry->variable_count);
    used += put_numbers(text + used, study->measures, study->entry->measure_count);
    text[used++] = ',';
    if (status < 0) {
        used += put_reason(study, text + used, error.message);
    } else {
        memcpy(text + used, "ok", 2);
        used += 2;
    }
    text[used++] = '\n';
    text[used] = '\0';
    *row = text;
    return status;
}
