/* SPDX-License-Identifier: BSD-3-Clause */
/* Every row of model_table.h: the model is run to files by the library and the files are compared
 * with the reference, so that reader, solver, channels and writer are all in the line. */
#include <stdlib.h>

#include "check.h"
#include "model_table.h"
#include "se3d/io.h"

typedef struct table {
    char *text;      /* the whole file; names point into it */
    char *names[96]; /* columns */
    size_t columns;
    double *values; /* [rows * columns] */
    size_t rows;
} table;

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    if (file && fseek(file, 0, SEEK_END) == 0) {
        const long size = ftell(file);
        text = size > 0 ? calloc((size_t)size + 1, 1) : NULL;
        rewind(file);
        if (text && fread(text, 1, (size_t)size, file) != (size_t)size) {
            text[0] = '\0';
        }
    }
    if (file) {
        fclose(file);
    }
    return text;
}

static int table_read(table *t, const char *path)
{
    memset(t, 0, sizeof *t);
    t->text = read_file(path);
    if (!t->text) {
        fprintf(stderr, "%s: cannot be read\n", path);
        return 0;
    }
    size_t lines = 0;
    for (const char *c = t->text; *c; ++c) {
        lines += *c == '\n';
    }
    char *line = t->text;
    char *end = strchr(line, '\n');
    *end = '\0';
    for (char *name = strtok(line, ",\r"); name && t->columns < 96; name = strtok(NULL, ",\r")) {
        t->names[t->columns++] = name;
    }
    t->values = calloc((lines + 1) * t->columns, sizeof *t->values);
    char *at = end + 1;
    while (t->values && *at && t->rows < lines) {
        for (size_t k = 0; k < t->columns; ++k) {
            t->values[t->rows * t->columns + k] = strtod(at, &at);
            at += *at == ',';
        }
        ++t->rows;
        at += strspn(at, "\r\n");
    }
    return t->rows > 0;
}

static void table_free(table *t)
{
    free(t->text);
    free(t->values);
}

static size_t table_column(const table *t, const char *name)
{
    for (size_t k = 0; k < t->columns; ++k) {
        if (strcmp(t->names[k], name) == 0) {
            return k;
        }
    }
    fprintf(stderr, "%s: no column `%s`\n", check_case, name);
    const int column_exists = 0;
    CHECK(column_exists);
    return 0;
}

/* The row of `t` at a time, or the number of rows. */
static size_t table_row_at(const table *t, double time, size_t from)
{
    for (size_t k = from; k < t->rows; ++k) {
        if (fabs(t->values[k * t->columns] - time) < 1e-9) {
            return k;
        }
    }
    return t->rows;
}

static void compare_column(const table *result, const table *reference, const char *map,
                           double tolerance)
{
    char channel[120];
    const char *equals = strchr(map, '=');
    snprintf(channel, sizeof channel, "%.*s", (int)(equals - map), map);
    const double sign = equals[1] == '-' ? -1.0 : 1.0;
    const size_t expected = table_column(reference, equals + (equals[1] == '-' ? 2 : 1));
    char *plus = strchr(channel, '+');
    if (plus) {
        *plus = '\0';
    }
    const size_t first = table_column(result, channel);
    const size_t second = plus ? table_column(result, plus + 1) : 0;
    double largest = 0.0;
    double error = 0.0;
    double error_time = 0.0;
    size_t row = 0;
    for (size_t k = 0; k < reference->rows; ++k) {
        const double *want = &reference->values[k * reference->columns];
        if (k > 9 && want[0] > result->values[(result->rows - 1) * result->columns] + 1e-9) {
            break; /* the model stops before the reference */
        }
        row = table_row_at(result, want[0], row);
        if (row == result->rows) {
            fprintf(stderr, "%s: no row at t = %g\n", check_case, want[0]);
            const int time_has_row = 0;
            CHECK(time_has_row);
            return;
        }
        const double *have = &result->values[row * result->columns];
        const double off = have[first] + (plus ? have[second] : 0.0) - sign * want[expected];
        largest = fmax(largest, fabs(want[expected]));
        if (!(fabs(off) <= error)) {
            error = fabs(off);
            error_time = want[0];
        }
    }
    const double allowed = tolerance * (largest > 1e-9 ? largest : 1.0);
    if (!(error <= allowed)) {
        fprintf(stderr, "%s: %s off by %.3g at t = %g\n", check_case, map, error, error_time);
    }
    CHECK_NEAR(error, 0.0, allowed);
}

static int run_model(const model_row *row, const char *formulation, char *path, size_t size)
{
    se3d_model_options options = se3d_model_options_default();
    se3d_run_options how = se3d_run_options_default();
    se3d_model *model = NULL;
    se3d_run *run = NULL;
    se3d_model_error error;
    se3d_run_file file;
    char folder[800];
    char name[800];
    const char *source = getenv("SE3D_SOURCE_DIR");
    snprintf(name, sizeof name, "%s/examples/models/%s.yaml", source ? source : ".", row->model);
    snprintf(folder, sizeof folder, "%s/golden/%s/%s", check_scratch(), row->model, formulation);
    options.analysis = row->analysis;
    options.formulation = formulation;
    options.method = row->method;
    options.step = row->step;
    how.directory = folder;
    int good = !SE3D_FAILED(se3d_model_read_file(name, &options, &model, &error)) &&
               !SE3D_FAILED(se3d_model_run(model, &how, &run, &error)) &&
               !SE3D_FAILED(se3d_run_get_file(run, 0, &file));
    if (good) {
        snprintf(path, size, "%s", file.path);
    } else {
        fprintf(stderr, "%s\n", error.message);
    }
    se3d_run_destroy(run);
    se3d_model_destroy(model);
    return good;
}

static void compare_row(const model_row *row, const char *formulation)
{
    table result;
    table reference;
    char path[1200];
    char name[800];
    char map[160];
    const char *source = getenv("SE3D_SOURCE_DIR");
    snprintf(name, sizeof name, "%s/tests/data/%s.csv", source ? source : ".", row->reference);
    const int ran = run_model(row, formulation, path, sizeof path);
    CHECK(ran);
    if (!ran) {
        return;
    }
    const int read = table_read(&result, path) & table_read(&reference, name);
    CHECK(read);
    for (const char *at = row->columns; read && *at;) {
        const size_t length = strcspn(at, " ");
        snprintf(map, sizeof map, "%.*s", (int)length, at);
        compare_column(&result, &reference, map, row->tolerance);
        at += length;
        at += strspn(at, " ");
    }
    table_free(&result);
    table_free(&reference);
}

static void every_model_gives_its_known_answer(void)
{
    static char title[200];
    for (size_t k = 0; k < sizeof model_table / sizeof *model_table; ++k) {
        static const char *const both[] = {"romega", "rp"};
        for (size_t f = 0; f < 2; ++f) {
            if (!model_table[k].formulation || strcmp(model_table[k].formulation, both[f]) == 0) {
                snprintf(title, sizeof title, "%s, %s", model_table[k].model, both[f]);
                check_case = title;
                compare_row(&model_table[k], both[f]);
            }
        }
    }
}

int main(void)
{
    RUN(every_model_gives_its_known_answer);
    return check_finish();
}
