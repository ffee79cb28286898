/* SPDX-License-Identifier: BSD-3-Clause */
/* Merging tables: every sample once, in order. */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "io/base/file.h"
#include "io/base/sized.h"
#include "io/document/document.h"
#include "io/study/design.h"
#include "io/study/table.h"

typedef struct merger {
    const se3d_study *study;
    const se3d_study_merge_options *options;
    se3d_model_error *error;
    se3di_iopool pool;
    se3di_study_line *lines; /* of each sample; text NULL: missing */
    uint64_t count;
    uint64_t problems;
    uint64_t failed;
} merger;

void se3d_study_merge_options_init(se3d_study_merge_options *options, size_t size)
{
    if (options && size >= sizeof options->struct_size) {
        memset(options, 0, size);
        options->struct_size = size;
    }
}

/* Tell one problem; the first is also that of the call. */
static void report(merger *m, const char *text)
{
    se3d_model_error one = {.message = ""};
    se3di_document_report(&one, "", 0, 0, "", text);
    if (m->problems++ == 0 && m->error) {
        *m->error = one;
    }
    if (m->options->report && m->problems <= SE3D_MODEL_MISTAKES_MAX) {
        m->options->report(m->options->ctx, &one);
    }
}

static void report_file(merger *m, const char *path, const char *text)
{
    char message[800];
    snprintf(message, sizeof message, "%.500s: %s", path, text);
    report(m, message);
}

static void take_line(merger *m, const char *path, const se3di_study_line *line)
{
    se3di_study_line *kept = &m->lines[line->sample];
    if (!kept->text) {
        *kept = *line;
        return;
    }
    if (kept->length != line->length || memcmp(kept->text, line->text, line->length) != 0) {
        char text[80];
        snprintf(text, sizeof text, "sample %" PRIu64 " is there twice, and different",
                 line->sample);
        report_file(m, path, text);
    }
}

static se3d_status take_file(merger *m, const char *path)
{
    char *text = NULL;
    size_t length = 0;
    uint32_t shard = 1;
    uint32_t shards = 1;
    const char *at = NULL;
    const char *problem = NULL;
    se3di_study_line line;
    errno = 0;
    FILE *file = se3di_file_open(path);
    se3d_status status = file ? se3di_study_load(file, &m->pool, &text, &length) : SE3D_ERR_IO;
    if (file) {
        fclose(file);
    }
    if (status < 0) {
        const char *why = errno ? strerror(errno) : "cannot be read";
        report_file(m, path, status == SE3D_ERR_NO_MEMORY ? "out of memory" : why);
        return status;
    }
    if (!se3di_study_check_head(m->study, text, &at, &shard, &shards, &problem)) {
        report_file(m, path, length == 0 ? "is empty" : problem);
        return SE3D_OK;
    }
    while (se3di_study_next_line(m->study, &at, text + length, &line, &problem)) {
        take_line(m, path, &line);
    }
    if (problem) {
        report_file(m, path, problem);
    }
    return SE3D_OK;
}

/* Missing samples, as ranges. */
static void report_holes(merger *m)
{
    for (uint64_t k = 0; k < m->count; ++k) {
        uint64_t end = k;
        char text[120];
        while (end < m->count && !m->lines[end].text) {
            ++end;
        }
        if (end == k) {
            m->failed += m->lines[k].failed;
            continue;
        }
        if (end == k + 1) {
            snprintf(text, sizeof text, "sample %" PRIu64 " is missing", k);
        } else {
            snprintf(text, sizeof text, "samples %" PRIu64 " to %" PRIu64 " are missing", k,
                     end - 1);
        }
        report(m, text);
        k = end - 1;
    }
}

static se3d_status write_table(merger *m, const char *path)
{
    const char *columns = se3di_study_get_columns(m->study);
    char text[800];
    errno = 0;
    FILE *file = se3di_file_make_folders(path) ? se3di_partial_open(path) : NULL;
    if (file) {
        bool good = fprintf(file, "%s\n%s", m->study->head, columns) > 0;
        for (uint64_t k = 0; k < m->count && good; ++k) {
            const se3di_study_line *line = &m->lines[k];
            good = !line->text || fwrite(line->text, 1, line->length, file) == line->length;
        }
        if (good && se3di_partial_close(file, path)) {
            return SE3D_OK;
        }
        if (!good) {
            se3di_partial_abandon(file, path);
        }
    }
    snprintf(text, sizeof text, "%.500s: cannot be written: %.150s", path,
             se3di_file_get_text(errno ? errno : ENOSPC));
    se3di_document_report(m->error, "", 0, 0, "", text);
    return SE3D_ERR_IO;
}

static se3d_status merge(merger *m, const char *const *paths, size_t count, const char *path)
{
    se3d_status status = SE3D_OK;
    m->lines = se3di_iopool_array(&m->pool, (size_t)m->count, sizeof *m->lines);
    if (!m->lines) {
        report(m, "out of memory");
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t k = 0; k < count && status >= 0; ++k) {
        status = take_file(m, paths[k]);
    }
    if (status < 0) {
        return status;
    }
    report_holes(m);
    if (m->problems == 0 || m->options->partial) {
        status = write_table(m, path);
    }
    return status < 0 ? status : m->problems > 0 ? SE3D_ERR_STATE : SE3D_OK;
}

se3d_status se3d_study_merge(se3d_study *study, const char *const *paths, size_t count,
                             const char *path, const se3d_study_merge_options *options,
                             uint64_t *failed, se3d_model_error *error)
{
    se3d_study_merge_options used = se3d_study_merge_options_default();
    merger m = {.study = study, .options = &used, .error = error};
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (failed) {
        *failed = 0;
    }
    if (!study || (count > 0 && !paths) || !path) {
        report(&m, "study, paths or path is NULL");
        return SE3D_ERR_NULL;
    }
    if (options && !se3di_io_take(options, &used, sizeof used)) {
        used = se3d_study_merge_options_default();
        report(&m, "options: " SE3DI_IO_SIZE_TEXT);
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    m.count = se3di_design_count(study->entry);
    se3di_iopool_init(&m.pool, &study->pool.allocator);
    const se3d_status status = merge(&m, paths, count, path);
    se3di_iopool_destroy(&m.pool);
    if (failed) {
        *failed = m.failed;
    }
    return status;
}
