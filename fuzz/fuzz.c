/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 200809L

#include "fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 1000, FILES_MAX = 8, CALLS = 60 };

static char folder[PATH_SIZE / 2];
static char paths[FILES_MAX][PATH_SIZE];
static size_t path_count;

void fuzz_fail(const char *file, int line, const char *what, const char *why)
{
    fprintf(stderr, "%s:%d: does not hold: %s%s%s\n", file, line, what, *why ? ": " : "", why);
    abort();
}

static void remove_folder(void)
{
    for (size_t k = 0; k < path_count; ++k) {
        remove(paths[k]);
    }
    rmdir(folder);
}

static const char *get_folder(void)
{
    if (!folder[0]) {
        const char *base = getenv("TMPDIR");
        snprintf(folder, sizeof folder, "%.300s/se3d-fuzz-XXXXXX", base && *base ? base : "/tmp");
        FUZZ_MUST(mkdtemp(folder) != NULL);
        FUZZ_MUST(atexit(remove_folder) == 0);
    }
    return folder;
}

static const char *get_path(const char *name)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", get_folder(), name);
    for (size_t k = 0; k < path_count; ++k) {
        if (strcmp(paths[k], path) == 0) {
            return paths[k];
        }
    }
    FUZZ_MUST(path_count < FILES_MAX);
    memcpy(paths[path_count], path, sizeof path);
    return paths[path_count++];
}

const char *fuzz_write_file(const char *name, const uint8_t *data, size_t size)
{
    const char *path = get_path(name);
    FILE *file = fopen(path, "wb");
    FUZZ_MUST(file && fwrite(data, 1, size, file) == size && fclose(file) == 0);
    return path;
}

int fuzz_interrupt(void *patience)
{
    fuzz_patience *p = patience;
    return p->left-- <= 0;
}

se3d_model *fuzz_read_model(const char *text, size_t size)
{
    char path[PATH_SIZE];
    const size_t start = strlen(get_folder()); /* a file that a model names may be to blame */
    se3d_model_error error;
    se3d_model *model = NULL;
    se3d_model_options options = se3d_model_options_default();
    options.mass_optional = size % 2 == 0;
    snprintf(path, sizeof path, "%s/m.yaml", get_folder());
    const se3d_status status = se3d_model_read_text(text, size, path, &options, &model, &error);
    FUZZ_MUST(status == SE3D_OK || status == SE3D_ERR_MODEL);
    FUZZ_MUST((status == SE3D_OK) == (model != NULL));
    FUZZ_MUST((status == SE3D_OK) == (error.message[0] == '\0'));
    FUZZ_MUST_SAY(model || strncmp(error.message, path, start) == 0, error.message);
    return model;
}

static int all_finite(const double *x, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (!isfinite(x[k])) {
            return 0;
        }
    }
    return 1;
}

void fuzz_check_finite(const se3d_system *system, const char *when)
{
    const size_t count = se3d_system_count_bodies(system);
    for (size_t k = 0; k < count; ++k) {
        se3d_body body;
        double r[3], p[4], v[3], w[3];
        FUZZ_MUST(!se3d_system_get_body(system, k, &body));
        FUZZ_MUST(!se3d_body_get_position(system, body, r));
        FUZZ_MUST(!se3d_body_get_orientation(system, body, p));
        FUZZ_MUST(!se3d_body_get_velocity(system, body, v));
        FUZZ_MUST(!se3d_body_get_angular_velocity(system, body, w));
        FUZZ_MUST_SAY(all_finite(r, 3) && all_finite(v, 3) && all_finite(w, 3), when);
        const double norm = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
        FUZZ_MUST_SAY(fabs(norm - 1.0) < 1e-9, when);
    }
}

static void read_channels(const se3d_model *model)
{
    for (size_t k = 0; k < se3d_model_count_outputs(model); ++k) {
        se3d_model_output output;
        FUZZ_MUST(!se3d_model_get_output(model, k, &output));
        for (size_t c = 0; c < output.channel_count && c < CALLS; ++c) {
            double value[4];
            size_t width = 0;
            const char *name = NULL;
            FUZZ_MUST(!se3d_model_get_channel(model, k, c, &name) && name[0]);
            if (!se3d_model_get_channel_value(model, k, c, NULL, value, &width)) {
                FUZZ_MUST(width <= 4);
            }
        }
    }
}

static int run_analysis(se3d_model *model, size_t index)
{
    se3d_system *system = se3d_model_get_system(model);
    se3d_model_analysis analysis;
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    fuzz_patience patience = {CALLS};
    double time;
    FUZZ_MUST(!se3d_model_get_analysis(model, index, &analysis));
    if (se3d_model_get_solver(model, index, &def) < 0) {
        return 0; /* modes */
    }
    def.interrupt = fuzz_interrupt;
    def.interrupt_ctx = &patience;
    se3d_status status = se3d_solver_create(system, &def, &solver);
    if (status >= 0) {
        FUZZ_MUST(!se3d_system_get_time(system, &time));
        status = se3d_solver_run(solver, time + analysis.duration);
        FUZZ_MUST_SAY(status >= 0 || se3d_system_get_error(system)[0], "a failure has a message");
        fuzz_check_finite(system, "after a run");
        read_channels(model);
    }
    se3d_solver_destroy(solver);
    return status >= 0;
}

void fuzz_run_model(se3d_model *model)
{
    const size_t count = se3d_model_count_analyses(model);
    fuzz_check_finite(se3d_model_get_system(model), "as read");
    read_channels(model);
    for (size_t k = 0; k < count && k < 3; ++k) {
        if (!run_analysis(model, k)) {
            return;
        }
    }
}
