/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of samples, which only grow: a line is written at once and ends with a line break, so that
 * what a kill leaves is whole lines and at most one that is torn. */
#include "io/study/table.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

#include "io/base/file.h"
#include "io/base/sized.h"
#include "io/document/document.h"
#include "io/study/design.h"

struct se3d_study_table {
    se3di_iopool pool; /* of the table itself, too */
    se3d_study *study;
    FILE *file;
    const char *path;
    uint32_t shard, shards;
    unsigned char *has; /* a bit for each sample of the shard */
    uint64_t failed;
};

/* ---- lines -----------------------------------------------------------------------------------*/

se3d_status se3di_study_load(FILE *file, se3di_iopool *pool, char **text, size_t *length)
{
    const long size = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (size < 0 || fseek(file, 0, SEEK_SET) != 0) {
        return SE3D_ERR_IO;
    }
    *length = (size_t)size;
    *text = se3di_iopool_array(pool, *length + 1, 1);
    if (!*text) {
        return SE3D_ERR_NO_MEMORY;
    }
    return fread(*text, 1, *length, file) == *length ? SE3D_OK : SE3D_ERR_IO;
}

/* A whole number at *at, of at most nine digits. */
static bool take_number(const char **at, uint64_t *number)
{
    int digits = 0;
    for (*number = 0; **at >= '0' && **at <= '9' && digits < 9; ++*at, ++digits) {
        *number = 10 * *number + (uint64_t)(**at - '0');
    }
    return digits > 0;
}

bool se3di_study_check_head(const se3d_study *study, const char *text, const char **begin,
                            uint32_t *shard, uint32_t *shards, const char **problem)
{
    static const char mark[] = "# se3d study ";
    static const char part[] = ", shard ";
    const char *columns = se3di_study_get_columns(study);
    const size_t length = strlen(study->head);
    uint64_t numbers[2] = {1, 1};
    *problem = "is no table of a study";
    if (strncmp(text, mark, strlen(mark)) != 0) {
        return false;
    }
    *problem = "is of another model, study or version of se3d";
    if (strncmp(text, study->head, length) != 0) {
        return false;
    }
    const char *at = text + length;
    if (strncmp(at, part, strlen(part)) == 0) {
        at += strlen(part);
        if (!take_number(&at, &numbers[0]) || *at++ != '/' || !take_number(&at, &numbers[1])) {
            return false;
        }
    }
    if (*at != '\n' || strncmp(at + 1, columns, strlen(columns)) != 0) {
        return false;
    }
    *begin = at + 1 + strlen(columns);
    *shard = (uint32_t)numbers[0];
    *shards = (uint32_t)numbers[1];
    return true;
}

bool se3di_study_next_line(const se3d_study *study, const char **at, const char *end,
                           se3di_study_line *line, const char **problem)
{
    static const char good[] = ",ok\n";
    const size_t cells = study->entry->variable_count + study->entry->measure_count + 2;
    const char *stop = *at < end ? memchr(*at, '\n', (size_t)(end - *at)) : NULL;
    const char *rest = *at;
    size_t count = 1;
    if (!stop) {
        return false;
    }
    line->text = *at;
    line->length = (size_t)(stop + 1 - *at);
    *problem = "has a line that is no sample of the study";
    if (!take_number(&rest, &line->sample) || *rest != ',' ||
        line->sample >= se3di_design_count(study->entry)) {
        return false;
    }
    for (; rest < stop && *rest != '"'; ++rest) {
        count += *rest == ',';
    }
    if (count != cells || (rest < stop && (rest[-1] != ',' || stop[-1] != '"'))) {
        return false;
    }
    line->failed = line->length < strlen(good) || memcmp(stop - 3, good, strlen(good)) != 0;
    *problem = NULL;
    *at = stop + 1;
    return true;
}

/* ---- the file --------------------------------------------------------------------------------*/

void se3d_study_table_def_init(se3d_study_table_def *def, size_t size)
{
    if (def && size >= sizeof def->struct_size) {
        memset(def, 0, size);
        def->struct_size = size;
        if (size >= sizeof *def) {
            def->shard = 1;
            def->shards = 1;
        }
    }
}

static se3d_status fail(const char *path, se3d_model_error *error, se3d_status status,
                        const char *text)
{
    char message[800];
    snprintf(message, sizeof message, "%.500s: %s", path, text);
    se3di_document_report(error, "", 0, 0, "", status == SE3D_ERR_NO_MEMORY ? text : message);
    return status;
}

static se3d_status fail_write(const char *path, se3d_model_error *error)
{
    char text[200];
    snprintf(text, sizeof text, "cannot be written: %.150s",
             se3di_file_get_text(errno ? errno : ENOSPC));
    return fail(path, error, SE3D_ERR_IO, text);
}

static uint64_t place_of(const se3d_study_table *table, uint64_t sample)
{
    return sample / table->shards;
}

static bool is_of(const se3d_study_table *table, uint64_t sample)
{
    return sample < se3di_design_count(table->study->entry) &&
           sample % table->shards == table->shard - 1;
}

int se3d_study_table_has(const se3d_study_table *table, uint64_t sample)
{
    if (!table || !is_of(table, sample)) {
        return 0;
    }
    const uint64_t place = place_of(table, sample);
    return table->has[place / 8] >> (place % 8) & 1;
}

static void note(se3d_study_table *table, const se3di_study_line *line)
{
    const uint64_t place = place_of(table, line->sample);
    table->has[place / 8] = (unsigned char)(table->has[place / 8] | 1u << (place % 8));
    table->failed += line->failed;
}

static bool write_text(FILE *file, const char *text, size_t length)
{
    errno = 0;
    return fwrite(text, 1, length, file) == length && fflush(file) == 0;
}

static se3d_status write_head(se3d_study_table *table, se3d_model_error *error)
{
    char part[40] = "\n";
    const char *columns = se3di_study_get_columns(table->study);
    if (table->shards > 1) {
        snprintf(part, sizeof part, ", shard %" PRIu32 "/%" PRIu32 "\n", table->shard,
                 table->shards);
    }
    const char *head = table->study->head;
    const bool good = se3di_file_cut(table->file, 0) &&
                      write_text(table->file, head, strlen(head)) &&
                      write_text(table->file, part, strlen(part)) &&
                      write_text(table->file, columns, strlen(columns));
    return good ? SE3D_OK : fail_write(table->path, error);
}

/* The rows of a text, from `at` on. *end: behind the last whole one. */
static const char *take_rows(se3d_study_table *table, const char *at, const char *stop,
                             const char **end)
{
    se3di_study_line line;
    const char *problem = NULL;
    while (se3di_study_next_line(table->study, &at, stop, &line, &problem)) {
        if (!is_of(table, line.sample)) {
            return "has a sample of another shard";
        }
        if (se3d_study_table_has(table, line.sample)) {
            return "has a sample twice";
        }
        note(table, &line);
    }
    *end = at;
    return problem;
}

/* Go on with what is there. The head may be torn, too: then there was nothing else. */
static se3d_status take_over(se3d_study_table *table, bool resume, se3d_model_error *error)
{
    se3di_iopool pool;
    char *text = NULL;
    size_t length = 0;
    uint32_t shard = 1;
    uint32_t shards = 1;
    const char *end = NULL;
    const char *problem = NULL;
    se3di_iopool_init(&pool, &table->pool.allocator);
    errno = 0;
    se3d_status status = se3di_study_load(table->file, &pool, &text, &length);
    if (status < 0) {
        status = fail(table->path, error, status,
                      status == SE3D_ERR_IO ? "cannot be read" : "out of memory");
    } else if (length > 0 && !resume) {
        status =
            fail(table->path, error, SE3D_ERR_STATE, "is there already: --resume goes on with it");
    } else if (length == 0 ||
               (!strchr(text, '\n') && length < strlen(table->study->head) + 40 &&
                memcmp(text, table->study->head,
                       length < strlen(table->study->head) ? length : strlen(table->study->head)) ==
                    0)) {
        status = write_head(table, error);
    } else if (!se3di_study_check_head(table->study, text, &end, &shard, &shards, &problem)) {
        status = fail(table->path, error, SE3D_ERR_STATE, problem);
    } else if (shard != table->shard || shards != table->shards) {
        status = fail(table->path, error, SE3D_ERR_STATE, "is another shard");
    } else {
        problem = take_rows(table, end, text + length, &end);
        status = problem ? fail(table->path, error, SE3D_ERR_STATE, problem)
                 : se3di_file_cut(table->file, (uint64_t)(end - text))
                     ? SE3D_OK
                     : fail_write(table->path, error);
    }
    se3di_iopool_destroy(&pool);
    return status;
}

static se3d_status open_file(se3d_study_table *table, bool resume, se3d_model_error *error)
{
    errno = 0;
    table->file = se3di_file_make_folders(table->path) ? se3di_file_continue(table->path) : NULL;
    if (!table->file && errno == EAGAIN) {
        return fail(table->path, error, SE3D_ERR_STATE, "another program is writing it");
    }
    return table->file ? take_over(table, resume, error) : fail_write(table->path, error);
}

static se3d_study_table *create_table(se3d_study *study, const se3d_study_table_def *def)
{
    se3di_iopool pool;
    const uint64_t count = se3di_design_count(study->entry);
    se3di_iopool_init(&pool, &study->pool.allocator);
    se3d_study_table *table = se3di_iopool_alloc(&pool, sizeof *table);
    if (table) {
        table->study = study;
        table->shard = def->shard;
        table->shards = def->shards;
        table->path = se3di_iopool_copy(&pool, def->path, strlen(def->path));
        table->has = se3di_iopool_array(&pool, (size_t)(count / def->shards / 8 + 1), 1);
    }
    if (!table || !table->path || !table->has) {
        se3di_iopool_destroy(&pool);
        return NULL;
    }
    table->pool = pool;
    return table;
}

se3d_status se3d_study_table_open(se3d_study *study, const se3d_study_table_def *def,
                                  se3d_study_table **out, se3d_model_error *error)
{
    se3d_study_table_def used = se3d_study_table_def_default();
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (out) {
        *out = NULL;
    }
    if (!study || !def || !out) {
        return fail("table", error, SE3D_ERR_NULL, "study, def or out is NULL");
    }
    if (!se3di_io_take(def, &used, sizeof used)) {
        return fail("table", error, SE3D_ERR_INVALID_ARGUMENT, "def: " SE3DI_IO_SIZE_TEXT);
    }
    if (!used.path || used.shard < 1 || used.shard > used.shards || used.shards > 100000000) {
        return fail("table", error, SE3D_ERR_INVALID_ARGUMENT,
                    "def: path must be given, shard from 1 to shards, shards at most 1e8");
    }
    se3d_study_table *table = create_table(study, &used);
    if (!table) {
        return fail(used.path, error, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    const se3d_status status = open_file(table, used.resume != 0, error);
    if (status < 0) {
        se3d_study_table_close(table);
        return status;
    }
    *out = table;
    return SE3D_OK;
}

uint64_t se3d_study_table_count_failed(const se3d_study_table *table)
{
    return table ? table->failed : 0;
}

se3d_status se3d_study_table_append(se3d_study_table *table, const char *row,
                                    se3d_model_error *error)
{
    se3di_study_line line;
    const char *problem = NULL;
    if (!table || !row) {
        return fail("table", error, SE3D_ERR_NULL, "table or row is NULL");
    }
    const char *at = row;
    const char *end = row + strlen(row);
    if (!se3di_study_next_line(table->study, &at, end, &line, &problem) || at != end ||
        !is_of(table, line.sample) || se3d_study_table_has(table, line.sample)) {
        return fail(table->path, error, SE3D_ERR_INVALID_ARGUMENT,
                    "the row is no new sample of this table");
    }
    if (!write_text(table->file, row, line.length)) {
        return fail_write(table->path, error);
    }
    note(table, &line);
    return SE3D_OK;
}

void se3d_study_table_close(se3d_study_table *table)
{
    if (table) {
        se3di_iopool pool = table->pool; /* the table itself lies in it */
        if (table->file) {
            fclose(table->file);
        }
        se3di_iopool_destroy(&pool);
    }
}
