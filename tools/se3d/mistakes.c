/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading a model: its mistakes with the lines they are on. A model called "-" comes from standard
 * input. */
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "options.h"
#include "outcome.h"
#include "text.h"

enum { LINE_MAX = 4096, WIDTH = 100 /* characters of a line that are shown */ };
enum { BYTES_MAX = 64 * 1024 * 1024 /* of standard input; the reader allows no more */ };
static const char input_name[] = "stdin";

typedef struct mistakes {
    se3d_model_error list[SE3D_MODEL_MISTAKES_MAX];
    size_t count;
} mistakes;

static void keep(void *ctx, const se3d_model_error *error)
{
    mistakes *m = ctx;
    if (m->count < SE3D_MODEL_MISTAKES_MAX) {
        m->list[m->count++] = *error;
    }
}

/* The rest of a line, which ends as lines of YAML do, with blanks for tabs. @return whether there
 * was one. */
static int read_line(FILE *file, char *text)
{
    size_t length = 0;
    uint32_t last = 0; /* three bytes */
    int c = 0;
    while ((c = fgetc(file)) != EOF && c != '\n' && c != '\r') {
        last = (last << 8 | (uint32_t)c) & 0xFFFFFF;
        if (length + 1 < LINE_MAX) {
            text[length++] = (char)(c == '\t' ? ' ' : c);
        }
        if ((last & 0xFFFF) == 0xC285 || last == 0xE280A8 || last == 0xE280A9) {
            break; /* U+0085, U+2028, U+2029 */
        }
    }
    text[length] = '\0';
    const int next = c == '\r' ? fgetc(file) : '\n';
    if (next != '\n') {
        ungetc(next, file);
    }
    return c != EOF || length > 0;
}

/* Read on to a line of the file, counted in *at. @return whether it is there. */
static int find_line(FILE *file, size_t line, size_t *at, char *text)
{
    static const char mark[] = "\xEF\xBB\xBF"; /* of the byte order: no character of the line */
    const size_t size = sizeof mark - 1;
    while (*at < line) {
        if (!read_line(file, text)) {
            return 0;
        }
        if ((*at)++ == 0 && strncmp(text, mark, size) == 0) {
            memmove(text, text + size, strlen(text + size) + 1);
        }
    }
    return 1;
}

/* The byte at which the character of this column begins, from 1. */
static size_t find_column(const char *text, size_t column)
{
    size_t byte = 0;
    for (size_t k = 1; k < column && text[byte]; ++k) {
        const size_t length = se3d_text_get_character(text + byte);
        byte += length > 0 ? length : 1;
    }
    return byte;
}

/* The line with a mark below the column; of a long one, what is around it. */
static void show_line(const se3d_model_error *error, const char *line)
{
    char part[4 * WIDTH + 1];
    const size_t first = error->column > WIDTH * 3 / 4 ? error->column - WIDTH / 2 : 1;
    const size_t from = find_column(line, first);
    const size_t length = find_column(line + from, WIDTH + 1);
    memcpy(part, line + from, length);
    part[length] = '\0';
    fprintf(stderr, "%6zu | ", error->line);
    text_put_plain(stderr, part);
    fprintf(stderr, "\n       | %*s%s^%s\n", (int)(error->column - first), "",
            colour_get(COLOUR_MARK), colour_get(COLOUR_NONE));
}

static int is_input(const options *o)
{
    return strcmp(o->model, "-") == 0;
}

/* The file that a message begins with: that of the model, or one that it includes. */
static void get_file(const options *o, const se3d_model_error *error, char *file, size_t size)
{
    char place[64];
    snprintf(place, sizeof place, ":%zu:%zu: ", error->line, error->column);
    const char *end = strstr(error->message, place);
    if (end && (size_t)(end - error->message) < size) {
        snprintf(file, size, "%.*s", (int)(end - error->message), error->message);
    } else {
        snprintf(file, size, "%s", is_input(o) ? input_name : o->model);
    }
}

static void show_mistake(const options *o, const se3d_model_error *error)
{
    char path[1024];
    char line[LINE_MAX];
    size_t at = 0;
    complain("%s\n", error->message);
    if (error->line == 0 || error->column == 0 || error->column >= LINE_MAX) {
        return;
    }
    get_file(o, error, path, sizeof path);
    if (is_input(o) && strcmp(path, input_name) == 0) {
        return; /* it has been read */
    }
    FILE *file = se3di_file_open(path); /* what is no regular file cannot be read twice */
    if (file && find_line(file, error->line, &at, line)) {
        show_line(error, line);
    }
    if (file) {
        fclose(file);
    }
}

static void show(const options *o, const mistakes *m)
{
    for (size_t k = 0; k < m->count; ++k) {
        show_mistake(o, &m->list[k]);
    }
    if (m->count > 1) {
        fprintf(stderr, "%zu mistakes%s\n", m->count,
                m->count == SE3D_MODEL_MISTAKES_MAX ? ", there may be more" : "");
    }
}

/* A member with a part of a text. */
static void put_part(const char *name, const char *text, size_t length)
{
    char part[sizeof((se3d_model_error *)0)->message];
    snprintf(part, sizeof part, "%.*s", (int)length, text);
    printf(", \"%s\": ", name);
    json_put_text(part);
}

/* What a message "file:line:column: path: what, did you mean `this`?" says, in parts. */
static void put_parts(const se3d_model_error *e)
{
    static const char meant[] = "did you mean `";
    char place[60];
    snprintf(place, sizeof place, ":%zu:%zu: ", e->line, e->column);
    const char *path = strstr(e->message, place);
    path = path ? path + strlen(place) : e->message;
    const char *end = strstr(path, ": ");
    if (path > e->message && end && strcspn(path, " ") > (size_t)(end - path)) {
        put_part("path", path, (size_t)(end - path));
    }
    const char *suggestion = strstr(path, meant);
    if (suggestion) {
        suggestion += sizeof meant - 1;
        put_part("suggestion", suggestion, strcspn(suggestion, "`"));
    }
}

static void print_json(const options *o, const mistakes *m, const char *message)
{
    char file[1024];
    outcome_tell();
    fputs("{\"status\": \"error\", \"message\": ", stdout);
    json_put_text(message);
    fputs(", \"mistakes\": [", stdout);
    for (size_t k = 0; k < m->count; ++k) {
        get_file(o, &m->list[k], file, sizeof file);
        fputs(k > 0 ? ", {\"file\": " : "{\"file\": ", stdout);
        json_put_text(file);
        printf(", \"line\": %zu, \"column\": %zu, \"message\": ", m->list[k].line,
               m->list[k].column);
        json_put_text(m->list[k].message);
        put_parts(&m->list[k]);
        fputs("}", stdout);
    }
    fputs("]}\n", stdout);
}

char *options_read_input(size_t *length)
{
    size_t capacity = 65536;
    char *text = malloc(capacity);
    *length = 0;
    while (text) {
        *length += fread(text + *length, 1, capacity - *length, stdin);
        if (*length < capacity || capacity > BYTES_MAX) {
            break;
        }
        char *larger = realloc(text, 2 * capacity);
        if (!larger) {
            free(text);
        }
        text = larger;
        capacity *= 2;
    }
    if (text && ferror(stdin)) {
        free(text);
        text = NULL;
    }
    return text;
}

static se3d_status read_model(const options *o, const se3d_model_options *how, se3d_model **model,
                              se3d_model_error *error)
{
    size_t length = 0;
    if (!is_input(o)) {
        return se3d_model_read_file(o->model, how, model, error);
    }
    char *text = options_read_input(&length);
    if (!text) {
        memset(error, 0, sizeof *error);
        snprintf(error->message, sizeof error->message, "%s: %s", input_name, strerror(errno));
        return SE3D_ERR_IO;
    }
    const se3d_status status = se3d_model_read_text(text, length, input_name, how, model, error);
    free(text);
    return status;
}

int options_read_model(const options *o, const se3d_model_options *how, se3d_model **model)
{
    mistakes m = {.count = 0};
    se3d_model_error error;
    se3d_model_options with = *how;
    with.report = keep;
    with.report_ctx = &m;
    if (!SE3D_FAILED(read_model(o, &with, model, &error))) {
        return EXIT_DONE;
    }
    if (m.count == 0) {
        report_failure(o, "", error.message);
        return EXIT_USAGE;
    }
    show(o, &m);
    if (o->json) {
        print_json(o, &m, error.message);
    }
    return EXIT_USAGE;
}
