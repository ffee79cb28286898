/* SPDX-License-Identifier: BSD-3-Clause */
/* Requests and replies in JSON, which is YAML: the reader of model files reads them, too. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/number.h"
#include "io/document/document.h"
#include "io/study/design.h"
#include "io/study/study.h"

enum { REQUEST_MAX = 1 << 20 };

typedef struct reply {
    se3di_iopool *pool;
    char *text;
    size_t length, capacity;
    bool failed; /* out of memory */
} reply;

static void put_bytes(reply *r, const char *bytes, size_t count)
{
    while (!r->failed && r->length + count + 1 > r->capacity) {
        const size_t capacity = r->capacity > 0 ? 2 * r->capacity : 1024;
        char *grown = se3di_iopool_array(r->pool, capacity, 1);
        r->failed = !grown;
        if (grown) {
            memcpy(grown, r->text ? r->text : "", r->length);
            r->text = grown;
            r->capacity = capacity;
        }
    }
    if (!r->failed) {
        memcpy(r->text + r->length, bytes, count);
        r->length += count;
        r->text[r->length] = '\0';
    }
}

static void put(reply *r, const char *text)
{
    put_bytes(r, text, strlen(text));
}

/* A string of JSON: the text is UTF-8, as it was read. */
static void put_string(reply *r, const char *text)
{
    put(r, "\"");
    for (const char *c = text; *c; ++c) {
        char code[8];
        if (*c == '"' || *c == '\\') {
            put(r, "\\");
        }
        if ((unsigned char)*c < 0x20) {
            snprintf(code, sizeof code, "\\u%04x", (unsigned)(unsigned char)*c);
            put(r, code);
        } else {
            put_bytes(r, c, 1);
        }
    }
    put(r, "\"");
}

static bool is_number(const char *text)
{
    static const char digits[] = "0123456789";
    const char *c = text + (*text == '-');
    const size_t whole = strspn(c, digits);
    if (whole == 0 || (whole > 1 && *c == '0')) {
        return false;
    }
    c += whole;
    if (*c == '.') {
        const size_t length = strspn(c + 1, digits);
        c += length > 0 ? length + 1 : 0;
    }
    if (*c == 'e' || *c == 'E') {
        const size_t sign = c[1] == '+' || c[1] == '-';
        const size_t length = strspn(c + 1 + sign, digits);
        c += length > 0 ? length + 1 + sign : 0;
    }
    return *c == '\0';
}

/* The identity as it came: a number or a string. */
static void put_identity(reply *r, const se3di_node *id)
{
    put(r, "{\"id\": ");
    if (!id || id->kind != SE3DI_NODE_SCALAR || se3di_node_is_null(id)) {
        put(r, "null");
    } else if (id->plain && is_number(id->text)) {
        put(r, id->text);
    } else {
        put_string(r, id->text);
    }
}

/* Whether the run came to its end: a measure that has no value is null. */
static bool has_measures(const se3d_study *study)
{
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        if (isfinite(study->measures[k])) {
            return true;
        }
    }
    return false;
}

static void put_measures(reply *r, const se3d_study *study)
{
    put(r, ", \"measures\": {");
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        char number[SE3DI_STUDY_CELL] = "null";
        if (isfinite(study->measures[k])) {
            number[se3di_number_format(study->measures[k], number)] = '\0';
        }
        put(r, k > 0 ? ", " : "");
        put_string(r, study->entry->measures[k].name);
        put(r, ": ");
        put(r, number);
    }
    put(r, "}");
}

/* ---- the request -----------------------------------------------------------------------------*/

typedef struct request {
    se3d_study *study;
    se3di_iopool *pool;
    const se3di_node *id;
    se3d_model_error error;
} request;

SE3DI_IO_FORMAT(2, 3)
static se3d_status fail(request *q, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(q->error.message, sizeof q->error.message, format, arguments);
    va_end(arguments);
    return SE3D_ERR_INVALID_ARGUMENT;
}

static se3d_status take_number(request *q, const char *name, const se3di_node *node, double *value)
{
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    const bool plain = node->kind == SE3DI_NODE_SCALAR && node->plain && is_number(node->text);
    def.text = plain ? node->text : "";
    def.allocator = se3di_iopool_lend(q->pool);
    se3d_status status =
        plain ? se3d_expression_create(&def, &expression, NULL) : SE3D_ERR_EXPRESSION;
    if (status >= 0) {
        status = se3d_expression_eval(expression, NULL, value);
    }
    se3d_expression_destroy(expression);
    return status >= 0 || status == SE3D_ERR_NO_MEMORY
               ? status
               : fail(q, "%.60s must be a finite number", name);
}

/* The values of any parameters of the model. */
static se3d_status run_parameters(request *q, const se3di_node *map)
{
    se3d_study *study = q->study;
    const se3d_model *model = study->model;
    const se3di_node *known = se3di_node_get(model->root, "parameters");
    se3di_named *values = se3di_iopool_array(q->pool, map ? map->count : 0, sizeof *values);
    size_t count = 0;
    if (!values) {
        return SE3D_ERR_NO_MEMORY;
    }
    if (map && map->kind != SE3DI_NODE_MAP) {
        return fail(q, "parameters must be an object such as {\"m\": 2}");
    }
    for (const se3di_node *node = map ? map->first : NULL; node; node = node->next) {
        const se3di_amount *own = se3di_scope_find(model->scope, node->key);
        if (!se3di_node_get(known, node->key) || !own || own->rank != 1) {
            return fail(q, "the model has no number `%.60s` among its parameters", node->key);
        }
        values[count] = (se3di_named){.name = node->key, .value = {.rank = 1}};
        const se3d_status status = take_number(q, node->key, node, &values[count++].value.v[0]);
        if (status < 0) {
            return status;
        }
    }
    return se3di_study_run(study, values, count, study->measures, &q->error);
}

static se3d_status run_sample(request *q, const se3di_node *node)
{
    se3d_study *study = q->study;
    const double count = (double)se3di_design_count(study->entry);
    double sample = 0.0;
    const se3d_status status = take_number(q, "sample", node, &sample);
    if (status < 0) {
        return status;
    }
    if (!(sample >= 0.0 && sample < count) || floor(sample) < sample) {
        return fail(q, "sample must be a whole number from 0 to %.0f", count - 1.0);
    }
    se3di_design_get(study->entry, (uint64_t)sample, study->parameters);
    return se3d_study_eval(study, study->parameters, study->measures, &q->error);
}

static se3d_status run(request *q, const char *text, size_t length)
{
    se3di_node *root = NULL;
    if (length > REQUEST_MAX) {
        return fail(q, "a request has at most %d bytes", (int)REQUEST_MAX);
    }
    const se3d_status parsed =
        se3di_document_parse(q->pool, "request", text, length, &root, &q->error);
    if (parsed < 0) {
        return parsed;
    }
    q->id = se3di_node_get(root, "id");
    const se3di_node *sample = se3di_node_get(root, "sample");
    const se3di_node *parameters = se3di_node_get(root, "parameters");
    if (!root || root->kind != SE3DI_NODE_MAP) {
        return fail(q, "a request is an object such as {\"id\": 1, \"parameters\": {\"m\": 2}}");
    }
    if (sample && parameters) {
        return fail(q, "a request has `parameters` or `sample`, not both");
    }
    for (const se3di_node *node = root->first; node; node = node->next) {
        if (node != q->id && node != sample && node != parameters) {
            return fail(q, "`%.60s` is unknown: a request has id and parameters or sample",
                        node->key);
        }
    }
    return sample ? run_sample(q, sample) : run_parameters(q, parameters);
}

se3d_status se3d_study_answer(se3d_study *study, const char *text, size_t length, const char **out)
{
    if (out) {
        *out = "";
    }
    if (!study || !text || !out) {
        return SE3D_ERR_NULL;
    }
    if (study->is_running) {
        return SE3D_ERR_STATE;
    }
    for (size_t k = 0; k < study->entry->measure_count; ++k) {
        study->measures[k] = (double)NAN;
    }
    se3di_iopool_destroy(&study->reply_pool);
    se3di_iopool_init(&study->reply_pool, &study->pool.allocator);
    request q = {.study = study, .pool = &study->reply_pool, .error = {.message = ""}};
    reply r = {.pool = q.pool};
    const se3d_status status = run(&q, text, length);
    if (status == SE3D_ERR_NO_MEMORY) {
        return status;
    }
    put_identity(&r, q.id);
    if (has_measures(study)) {
        put_measures(&r, study);
    }
    if (status < 0) {
        put(&r, ", \"error\": ");
        put_string(&r, q.error.message);
    }
    put(&r, "}");
    if (r.failed) {
        return SE3D_ERR_NO_MEMORY;
    }
    *out = r.text;
    return SE3D_OK;
}
