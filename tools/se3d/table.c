/* SPDX-License-Identifier: BSD-3-Clause */
/* Results files as `se3d plot` and `se3d view` see them. */
#include "table.h"
#include "outcome.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "process.h"
#include "text.h"

enum { BLOCK = 1 << 16 };

/* A line of any length without its end; NULL at the end of the file or without memory. */
static char *read_line(FILE *file)
{
    size_t size = 4096;
    size_t length = 0;
    char *line = malloc(size);
    while (line && fgets(line + length, (int)(size - length), file)) {
        length += strlen(line + length);
        if (length > 0 && line[length - 1] == '\n') {
            break;
        }
        if (length + 1 < size) {
            continue;
        }
        char *grown = size < SIZE_MAX / 4 ? realloc(line, 2 * size) : NULL;
        if (!grown) {
            free(line);
            return NULL;
        }
        line = grown;
        size *= 2;
    }
    if (line && length == 0) {
        free(line);
        return NULL;
    }
    while (line && length > 0 && (line[length - 1] == '\n' || line[length - 1] == '\r')) {
        line[--length] = '\0';
    }
    return line;
}

/* The line with the names of columns; NULL: there is none. A remark before it goes to *remark, or
 * nowhere. */
static char *read_header(FILE *file, char **remark)
{
    char *line = read_line(file);
    if (!line || line[0] != '#') {
        return line;
    }
    if (remark) {
        *remark = line;
    } else {
        free(line);
    }
    return read_line(file);
}

/* Names come from anywhere, and go into scripts, pages and messages. */
static int split_header(table *t)
{
    size_t count = 1;
    text_clean(t->header);
    for (const char *c = t->header; *c; ++c) {
        count += *c == ',';
    }
    t->names = malloc(count * sizeof *t->names);
    char *at = t->header;
    while (t->names && at) {
        char *comma = strchr(at, ',');
        t->names[t->count++] = at;
        if (comma) {
            *comma++ = '\0';
        }
        at = comma;
    }
    return t->names != NULL;
}

/* Lines that are not empty after the present position. */
static size_t count_rows(FILE *file)
{
    char block[BLOCK];
    size_t rows = 0;
    size_t used = 0;
    int inside = 0;
    while ((used = fread(block, 1, sizeof block, file)) > 0) {
        for (size_t k = 0; k < used; ++k) {
            if (block[k] != '\n') {
                inside = inside || block[k] != '\r';
            } else {
                rows += (size_t)inside;
                inside = 0;
            }
        }
    }
    return rows + (size_t)inside;
}

/* The JSON part of scene.glb in the folder of the file. */
static char *read_scene(const char *path)
{
    char folder[4096];
    char name[4200];
    unsigned char head[20];
    char *text = NULL;
    if (!path_get_folder(path, folder, sizeof folder)) {
        return NULL;
    }
    snprintf(name, sizeof name, "%s/scene.glb", folder);
    FILE *file = se3di_file_open(name);
    if (file && fread(head, 1, sizeof head, file) == sizeof head && memcmp(head, "glTF", 4) == 0 &&
        memcmp(head + 16, "JSON", 4) == 0) {
        const size_t length = (size_t)head[12] | (size_t)head[13] << 8 | (size_t)head[14] << 16;
        text = malloc(length + 1);
        if (text) {
            text[fread(text, 1, length, file)] = '\0';
        }
    }
    if (file) {
        fclose(file);
    }
    return text;
}

int table_read(table *t, const char *command, const char *path)
{
    memset(t, 0, sizeof *t);
    t->path = path;
    errno = 0;
    FILE *file = se3di_file_open(path);
    t->header = file ? read_header(file, &t->remark) : NULL;
    const int is_hdf5 = t->header && strncmp(t->header, "\211HDF", 4) == 0;
    if (!file || !t->header || is_hdf5 || !split_header(t)) {
        const char *why = !file && errno ? strerror(errno)
                          : is_hdf5      ? "is HDF5, must be CSV, such as an output `results.csv`"
                                         : "is empty";
        complain("se3d %s: %s: %s\n", command, path, why);
        if (file) {
            fclose(file);
        }
        table_destroy(t);
        return 0;
    }
    t->rows = count_rows(file);
    const int bad = ferror(file);
    fclose(file);
    char *end = NULL;
    strtod(t->names[0], &end);
    if (bad || t->rows == 0 || t->names[0][0] == '\0' || end != t->names[0]) {
        complain("se3d %s: %s: %s\n", command, path,
                 bad            ? "cannot be read"
                 : t->rows == 0 ? "has no rows, only a header: there is nothing to show"
                                : "does not begin with the names of its columns");
        table_destroy(t);
        return 0;
    }
    t->scene = read_scene(path);
    return 1;
}

void table_destroy(table *t)
{
    free(t->names);
    free(t->header);
    free(t->remark);
    free(t->scene);
    memset(t, 0, sizeof *t);
}

size_t table_find(const table *t, const char *name)
{
    size_t k = 0;
    while (k < t->count && strcmp(t->names[k], name) != 0) {
        ++k;
    }
    return k;
}

/* Go through the rows, every `stride`-th and the last; `values` gets column `only`, or all of them
 * where that is `count`. */
static size_t read_numbers(const table *t, size_t only, size_t stride, double *values, size_t size)
{
    FILE *file = se3di_file_open(t->path);
    char *line = file ? read_header(file, NULL) : NULL;
    size_t rows = 0;
    for (size_t row = 0; line && rows < size; ++row) {
        free(line);
        line = read_line(file);
        const int taken = row % stride == 0 || row + 1 == t->rows;
        if (!line || !taken || line[0] == '\0') {
            continue;
        }
        const char *at = line;
        for (size_t k = 0; k < t->count; ++k) {
            const int wanted = only == t->count || only == k;
            char *end = NULL;
            const double value = wanted && at ? strtod(at, &end) : 0.0;
            if (wanted) {
                values[only == t->count ? rows * t->count + k : rows] =
                    at && end != at ? value : (double)NAN;
            }
            at = at ? strchr(at, ',') : NULL;
            at = at ? at + 1 : NULL;
        }
        ++rows;
    }
    free(line);
    if (file) {
        fclose(file);
    }
    return rows;
}

size_t table_read_column(const table *t, size_t column, size_t stride, double *values, size_t size)
{
    return read_numbers(t, column, stride, values, size);
}

size_t table_read_rows(const table *t, size_t stride, double *values, size_t rows)
{
    return read_numbers(t, t->count, stride, values, rows);
}

static int is_component(const char *word)
{
    static const char *const all[] = {"x", "y", "z", "e0", "e1", "e2", "e3"};
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k) {
        if (strcmp(all[k], word) == 0) {
            return 1;
        }
    }
    return 0;
}

void table_get_quantity(const char *column, char *quantity, size_t size)
{
    char text[400];
    snprintf(text, sizeof text, "%s", column);
    char *dot = strrchr(text, '.');
    if (dot && is_component(dot + 1)) {
        *dot = '\0';
        dot = strrchr(text, '.');
    }
    const int whole = strncmp(text, "energy.", 7) == 0 || strncmp(text, "violation.", 10) == 0;
    if (whole) {
        *strchr(text, '.') = '\0';
    }
    snprintf(quantity, size, "%s", dot && !whole ? dot + 1 : text);
}

static const char *const units[][2] = {{"time", "s"},
                                       {"position", "m"},
                                       {"velocity", "m/s"},
                                       {"acceleration", "m/s^2"},
                                       {"angular_velocity", "rad/s"},
                                       {"angular_acceleration", "rad/s^2"},
                                       {"force", "N"},
                                       {"torque", "N m"},
                                       {"angle", "rad"},
                                       {"displacement", "m"},
                                       {"displacement_rate", "m/s"},
                                       {"length", "m"},
                                       {"energy", "J"},
                                       {"effort", "N or N m"}, /* these two if no scene tells */
                                       {"rate", "per s"},
                                       {"frequency", "Hz"},
                                       {"fx", "N"},
                                       {"fy", "N"},
                                       {"fz", "N"},
                                       {"camber", "rad"},
                                       {"inclination", "rad"},
                                       {"steer", "rad"},
                                       {"toe", "rad"},
                                       {"ackermann_error", "rad"},
                                       {"caster", "rad"},
                                       {"kingpin_inclination", "rad"},
                                       {"travel", "m"},
                                       {"wheelbase_change", "m"},
                                       {"track_change", "m"},
                                       {"scrub_radius", "m"},
                                       {"mechanical_trail", "m"},
                                       {"camber_gradient", "rad/m"},
                                       {"toe_gradient", "rad/m"},
                                       {"roll_center_height", "m"},
                                       {"wheel_load", "N"},
                                       {"gain", "dB"},
                                       {"phase", "degree"}};

const char *table_get_unit(const table *t, const char *column, char *buffer, size_t size)
{
    char quantity[400];
    char key[500];
    snprintf(key, sizeof key, "\"%s\":\"", column);
    const char *at = t && t->scene ? strstr(t->scene, "\"units\":{") : NULL;
    at = at ? strstr(at, key) : NULL;
    if (at) {
        at += strlen(key);
        snprintf(buffer, size, "%.*s", (int)strcspn(at, "\""), at);
        return buffer;
    }
    table_get_quantity(column, quantity, sizeof quantity);
    for (size_t k = 0; k < sizeof units / sizeof *units; ++k) {
        if (strcmp(units[k][0], quantity) == 0) {
            return units[k][1];
        }
    }
    return "";
}
