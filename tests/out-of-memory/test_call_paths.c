/* SPDX-License-Identifier: BSD-3-Clause */
/* Whatever path of calls asks for memory while a model is read, listed, run, drawn, saved, studied
 * or imported, is a mock-up unit or runs while someone looks at it: it is refused once on each,
 * which is reported and leaks nothing. So are calls of libse3d that fail in a way that is
 * documented, and calls that read and write files; what fails by a mistake of the caller only, or
 * within libse3d, leaks nothing. A model's own memory is cut from large blocks; here each piece of
 * it is refused by itself, as the functions of the pool are replaced when the test is linked. Paths
 * are told apart by the innermost calls. */
#define _POSIX_C_SOURCE 200809L
#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>
#if defined(__GLIBC__)
#include <stdio_ext.h>
#endif

#include "check.h"
#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/layout.h"
#include "io/fmi/exchange.h"
#include "io/fmi/package.h"
#include "io/live/live.h"
#include "io/write/sketch.h"
#include "se3d/import.h"
#include "se3d/io.h"
#include "se3d/study.h"
#include "support/call_paths.h"
#include "support/counting.h"
#include "support/refusals.h"

/* What fails: memory, calls of libse3d, calls within it, or those that read and write files. */
static enum { OF_MEMORY, OF_LIBRARY, OF_LAYERS, OF_FILES } kind;

static int is_memory_refused(void)
{
    return kind == OF_MEMORY && is_refused();
}

static int replaces;   /* the pools of units and sessions take what the test gives them */
static int is_read;    /* the model: functions are evaluated where things move */
static int is_lenient; /* nobody must tell that this call failed */

/* What lists and describes elements that are there. */
static int never_fails(const char *function)
{
    return strncmp(function, "se3d_system_get_", 16) == 0 || strstr(function, "_get_name") ||
           strstr(function, "_get_def") || strstr(function, "_get_type") ||
           strcmp(function, "se3d_system_set_kept") == 0;
}

/* A value that is not finite says that there is one; a step is tried again, a height left out of a
 * picture; a live model whose state cannot be copied is moved by names. */
static int may_be_mended(const char *function)
{
    static const char *const values[] = {"se3d_joint_get_coordinate", "se3d_state_get_value"};
    static const char *const moves[] = {"se3d_function_set_constant", "se3d_system_set_time"};
    int found = (is_read || replaces) && (strncmp(function, "se3d_expression_eval", 20) == 0 ||
                                          strcmp(function, "se3d_function_eval") == 0 ||
                                          strcmp(function, "se3d_road_get_height") == 0);
    for (int k = 0; k < 2; ++k) {
        found |= strcmp(function, values[k]) == 0 || (replaces && strcmp(function, moves[k]) == 0);
    }
    return found;
}

se3d_status support_refusal(const char *function, se3d_status documented)
{
    const int is_inner = strncmp(function, "se3di_", 6) == 0;
    const int may_fail = is_inner || documented != SE3D_OK || !never_fails(function);
    if (kind != (is_inner ? OF_LAYERS : OF_LIBRARY) || !may_fail || !is_refused()) {
        return SE3D_OK;
    }
    is_lenient = is_inner || documented == SE3D_OK || may_be_mended(function);
    if (calls.tells) {
        fprintf(stderr, "%s fails\n", function);
    }
    return is_inner                ? SE3D_ERR_NO_MEMORY
           : documented == SE3D_OK ? SE3D_ERR_STALE_HANDLE
                                   : documented;
}

/* ---- files: what a disk that is full or torn away does ---- */

static int is_aside; /* the test itself is at work */

static int is_file_refused(int strict)
{
    if (kind != OF_FILES || is_aside || !is_refused()) {
        return 0;
    }
    is_lenient = !strict;
    errno = ENOSPC;
    return 1;
}

/* The stream knows that it failed. */
static size_t spoil(FILE *file)
{
#if defined(__GLIBC__)
    file->_flags |= 0x20;
#else
    (void)file;
#endif
    return 0;
}

static int is_written(FILE *file)
{
#if defined(__GLIBC__)
    return __fwritable(file);
#else
    (void)file;
    return 0;
#endif
}

size_t __real_fread(void *to, size_t size, size_t count, FILE *file);
size_t __real_fwrite(const void *from, size_t size, size_t count, FILE *file);
int __real_fflush(FILE *file);
int __real_fclose(FILE *file);
int __real_fseek(FILE *file, long place, int whence);
long __real_ftell(FILE *file);
FILE *__real_fdopen(int number, const char *mode);
int __real_fstat(int number, struct stat *about);
int __real_rename(const char *from, const char *to);
size_t __wrap_fread(void *to, size_t size, size_t count, FILE *file);
size_t __wrap_fwrite(const void *from, size_t size, size_t count, FILE *file);
int __wrap_fflush(FILE *file);
int __wrap_fclose(FILE *file);
int __wrap_fseek(FILE *file, long place, int whence);
long __wrap_ftell(FILE *file);
FILE *__wrap_fdopen(int number, const char *mode);
int __wrap_fstat(int number, struct stat *about);
int __wrap_rename(const char *from, const char *to);

size_t __wrap_fread(void *to, size_t size, size_t count, FILE *file)
{
    return is_file_refused(1) ? spoil(file) : __real_fread(to, size, count, file);
}

size_t __wrap_fwrite(const void *from, size_t size, size_t count, FILE *file)
{
    return is_file_refused(1) ? spoil(file) : __real_fwrite(from, size, count, file);
}

int __wrap_fflush(FILE *file)
{
    return is_file_refused(is_written(file)) ? EOF : __real_fflush(file);
}

int __wrap_fclose(FILE *file)
{
    const int refused = is_file_refused(is_written(file));
    const int closed = __real_fclose(file);
    errno = refused ? ENOSPC : errno;
    return refused ? EOF : closed;
}

int __wrap_fseek(FILE *file, long place, int whence)
{
    return is_file_refused(1) ? -1 : __real_fseek(file, place, whence);
}

long __wrap_ftell(FILE *file)
{
    return is_file_refused(1) ? -1 : __real_ftell(file);
}

FILE *__wrap_fdopen(int number, const char *mode)
{
    return is_file_refused(1) ? NULL : __real_fdopen(number, mode);
}

int __wrap_fstat(int number, struct stat *about)
{
    return is_file_refused(1) ? -1 : __real_fstat(number, about);
}

int __wrap_rename(const char *from, const char *to)
{
    return is_file_refused(1) ? -1 : __real_rename(from, to);
}

/* ---- memory ---- */

void *__real_se3di_iopool_alloc(se3di_iopool *pool, size_t size);
void *__real_se3di_iopool_array(se3di_iopool *pool, size_t count, size_t size);
char *__real_se3di_iopool_copy(se3di_iopool *pool, const char *text, size_t length);
void *__real_se3di_iopool_grow(se3di_iopool *pool, void *array, size_t count, size_t *capacity,
                               size_t size);
bool __real_se3di_ionames_add(se3di_ionames *names, se3di_iopool *pool, const char *name,
                              size_t index);
void *__wrap_se3di_iopool_alloc(se3di_iopool *pool, size_t size);
void *__wrap_se3di_iopool_array(se3di_iopool *pool, size_t count, size_t size);
char *__wrap_se3di_iopool_copy(se3di_iopool *pool, const char *text, size_t length);
void *__wrap_se3di_iopool_grow(se3di_iopool *pool, void *array, size_t count, size_t *capacity,
                               size_t size);
bool __wrap_se3di_ionames_add(se3di_ionames *names, se3di_iopool *pool, const char *name,
                              size_t index);

/* As the pool does it. */
static int is_short(se3di_iopool *pool)
{
    const int hit = is_memory_refused();
    pool->is_short = pool->is_short || hit;
    return hit;
}

void *__wrap_se3di_iopool_alloc(se3di_iopool *pool, size_t size)
{
    return is_short(pool) ? NULL : __real_se3di_iopool_alloc(pool, size);
}

void *__wrap_se3di_iopool_array(se3di_iopool *pool, size_t count, size_t size)
{
    return is_short(pool) ? NULL : __real_se3di_iopool_array(pool, count, size);
}

char *__wrap_se3di_iopool_copy(se3di_iopool *pool, const char *text, size_t length)
{
    return is_short(pool) ? NULL : __real_se3di_iopool_copy(pool, text, length);
}

void *__wrap_se3di_iopool_grow(se3di_iopool *pool, void *array, size_t count, size_t *capacity,
                               size_t size)
{
    return count >= *capacity && is_short(pool)
               ? NULL
               : __real_se3di_iopool_grow(pool, array, count, capacity, size);
}

bool __wrap_se3di_ionames_add(se3di_ionames *names, se3di_iopool *pool, const char *name,
                              size_t index)
{
    return !is_short(pool) && __real_se3di_ionames_add(names, pool, name, index);
}

/* ---- the allocator of the model and its system ---- */

static support_counting counting;

static void *refusing_alloc(void *ctx, size_t size)
{
    const se3d_allocator inner = support_counting_allocator(&counting);
    (void)ctx;
    return is_memory_refused() ? NULL : inner.alloc(inner.ctx, size);
}

static void *refusing_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    const se3d_allocator inner = support_counting_allocator(&counting);
    (void)ctx;
    return is_memory_refused() ? NULL : inner.realloc(inner.ctx, memory, old_size, new_size);
}

static void counting_free(void *ctx, void *memory, size_t size)
{
    const se3d_allocator inner = support_counting_allocator(&counting);
    (void)ctx;
    inner.free(inner.ctx, memory, size);
}

static const se3d_allocator allocator = {refusing_alloc, refusing_realloc, counting_free, NULL};

/* ---- what is done with a file ---- */

static const char *results(void)
{
    static char folder[800];
    snprintf(folder, sizeof folder, "%s/out-of-memory", check_scratch());
    return folder;
}

static int is_told; /* the failure of an analysis, by a status that is passed over here */

/* Stops the run at its second row. */
static int stop(void *ctx, size_t analysis, double time, double fraction)
{
    (void)analysis, (void)time, (void)fraction;
    return ++*(int *)ctx > 1;
}

static void shut(FILE *file)
{
    is_aside = 1;
    fclose(file);
    is_aside = 0;
}

static se3d_status run(se3d_model *model, se3d_model_error *error)
{
    int rows = 0;
    se3d_run *report = NULL;
    se3d_run_options how = se3d_run_options_default();
    how.directory = results();
    how.progress = stop;
    how.ctx = &rows;
    const se3d_status status = se3d_model_run(model, &how, &report, error);
    se3d_run_destroy(report);
    is_told |= status < 0 && status != SE3D_ERR_NO_MEMORY && status != SE3D_ERR_INTERRUPTED;
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_IO ? status : SE3D_OK;
}

static se3d_status draw(se3d_model *model, se3d_model_error *error)
{
    char path[900];
    se3d_scene *scene = NULL;
    snprintf(path, sizeof path, "%s/paths.glb", results());
    snprintf(error->message, sizeof error->message, "no scene");
    se3d_status status = se3d_scene_create(model, &scene);
    if (status >= 0) {
        status = se3d_scene_record(scene);
    }
    if (status >= 0) {
        status = se3d_scene_write(scene, path, error);
    }
    se3d_scene_destroy(scene);
    return status;
}

static se3d_status save(se3d_model *model, se3d_model_error *error)
{
    size_t length = 0;
    se3d_write_options how = se3d_write_options_default();
    how.partial = 1;
    snprintf(error->message, sizeof error->message, "not written");
    return se3d_model_write_text(model, &how, NULL, 0, &length, error);
}

static se3d_status examine(se3d_model *model, se3d_model_error *error)
{
    const char *row = NULL;
    se3d_study *study = NULL;
    se3d_status status = se3d_study_create(model, &study, error);
    if (status == SE3D_ERR_STATE || status == SE3D_ERR_MODEL) {
        return SE3D_OK; /* the file has none */
    }
    snprintf(error->message, sizeof error->message, "no row");
    if (status >= 0) {
        status = se3d_study_run_sample(study, 0, &row);
    }
    is_told |= row && strchr(row, '"');
    se3d_study_destroy(study);
    return status == SE3D_ERR_NO_MEMORY ? status : SE3D_OK;
}

static se3d_status sketch(se3d_model *model, se3d_model_error *error)
{
    FILE *file = tmpfile();
    snprintf(error->message, sizeof error->message, "no sketch");
    se3d_status status = file ? se3di_sketch_put(model, NULL, file) : SE3D_ERR_IO;
    if (file) {
        status = status >= 0 && ferror(file) ? SE3D_ERR_IO : status;
        shut(file);
    }
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_IO ? status : SE3D_OK;
}

static void write_text(const char *name, const char *text)
{
    char path[900];
    snprintf(path, sizeof path, "%s/%s", results(), name);
    FILE *file = fopen(path, "wb");
    is_aside = 1;
    CHECK(file && fputs(text, file) >= 0);
    if (file) {
        shut(file);
    }
    is_aside = 0;
}

/* What a unit has besides the model: any bytes, and the licences that must stand beside them. */
static const char *unit_object(void)
{
    static char path[900];
    write_text("se3d_fmu_licenses.txt", "none");
    write_text("se3d_fmu.so", "none");
    snprintf(path, sizeof path, "%s/se3d_fmu.so", results());
    return path;
}

/* As a mock-up unit, if it can be one. */
static se3d_status pack(se3d_model *model, const char *path, const se3d_model_options *options,
                        se3d_model_error *error)
{
    const char *object = unit_object();
    FILE *file = tmpfile();
    se3di_fmi_package package = {.model = model,
                                 .path = path,
                                 .options = options,
                                 .object = object,
                                 .target = "unit",
                                 .version = 3};
    const se3d_status status = file ? se3di_fmi_package_write(&package, file, error) : SE3D_ERR_IO;
    if (file) {
        shut(file);
    }
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_IO ? status : SE3D_OK;
}

/* Its text, as `se3d fmt` does it. */
static se3d_status lay_out(const char *path, se3d_model_error *error)
{
    se3di_iopool pool;
    char *text = NULL, *made = NULL;
    size_t length = 0, made_length = 0;
    FILE *file = fopen(path, "rb");
    CHECK(file != NULL);
    se3di_iopool_init(&pool, &allocator);
    snprintf(error->message, sizeof error->message, "no text");
    se3d_status status = file ? se3di_document_read(&pool, file, &text, &length) : SE3D_ERR_IO;
    status = status < 0 ? status
                        : se3di_layout_make(&pool, path, text, length, &made, &made_length, error);
    CHECK(status < 0 || strlen(made) == made_length);
    se3di_iopool_destroy(&pool);
    if (file) {
        shut(file);
    }
    return status;
}

static se3d_status use_model(const char *path, se3d_model_error *error)
{
    se3d_model *model = NULL;
    size_t listed = 0;
    se3d_model_options options = se3d_model_options_default();
    options.allocator = &allocator;
    options.mass_optional = 1;
    se3d_status status = lay_out(path, error);
    status = status < 0 ? status : se3d_model_read_file(path, &options, &model, error);
    if (status >= 0) {
        is_read = 1;
        snprintf(error->message, sizeof error->message, "no list");
        status = se3d_model_list_channels(model, &listed);
    }
    status = status < 0 ? status : save(model, error);
    status = status < 0 ? status : sketch(model, error);
    status = status < 0 ? status : pack(model, path, &options, error);
    status = status < 0 ? status : run(model, error);
    status = status < 0 ? status : draw(model, error);
    status = status < 0 ? status : examine(model, error);
    se3d_model_destroy(model);
    return status;
}

/* ---- runs that go on ---- */

static void take_log(void *ctx, se3d_log_level level, se3d_log_kind about, const char *message)
{
    (void)ctx, (void)about, (void)message;
    is_told |= level >= SE3D_LOG_WARNING;
}

/* The model runs to its second row, with an estimate of its error or a checkpoint at each row. */
static se3d_status run_on(const char *path, int resume, int estimate, se3d_model_error *error)
{
    int rows = 0;
    se3d_model *model = NULL;
    se3d_run *report = NULL;
    se3d_model_options options = se3d_model_options_default();
    se3d_run_options how = se3d_run_options_default();
    options.allocator = &allocator;
    options.log = take_log;
    how.directory = results();
    how.checkpoint = estimate ? 0.0 : 1e-9;
    how.estimate = estimate;
    how.resume = resume;
    how.progress = stop;
    how.ctx = &rows;
    is_read = 0;
    se3d_status status = se3d_model_read_file(path, &options, &model, error);
    is_read = status >= 0;
    status = status < 0 ? status : se3d_model_run(model, &how, &report, error);
    se3d_run_destroy(report);
    se3d_model_destroy(model);
    return status == SE3D_ERR_INTERRUPTED ? SE3D_OK : status;
}

static se3d_status use_going_on(const char *path, se3d_model_error *error)
{
    char name[900];
    snprintf(name, sizeof name, "%s/run.checkpoint", results());
    se3d_status status = run_on(path, 0, 1, error);
    status = status < 0 ? status : run_on(path, 0, 0, error);
    status = status < 0 ? status : run_on(path, 1, 0, error);
    (void)remove(name);
    snprintf(error->message + strlen(error->message), 2, status < 0 ? "" : " ");
    return status;
}

static se3d_status use_import(const char *path, se3d_model_error *error)
{
    se3d_model_import *made = NULL;
    se3d_model_import_options options = se3d_model_import_options_default();
    options.allocator = &allocator;
    const se3d_status status = se3d_model_import_file(path, &options, &made, error);
    se3d_model_import_destroy(made);
    return status;
}

/* ---- lives ---- */

void __real_se3di_iopool_init(se3di_iopool *pool, const se3d_allocator *given);
void __wrap_se3di_iopool_init(se3di_iopool *pool, const se3d_allocator *given);

void __wrap_se3di_iopool_init(se3di_iopool *pool, const se3d_allocator *given)
{
    __real_se3di_iopool_init(pool, given || !replaces ? given : &allocator);
}

static void hear(void *ctx, se3d_log_level level, const char *message)
{
    se3d_model_error *error = ctx;
    if (level >= SE3D_LOG_WARNING && !strstr(error->message, "memory")) {
        snprintf(error->message, sizeof error->message, "%s", message);
    }
}

static uint32_t find(const se3di_fmi_unit *u, const char *name)
{
    uint32_t k = 0;
    while (k < u->variables.count && strcmp(u->variables.list[k].name, name) != 0) {
        ++k;
    }
    CHECK(k < u->variables.count);
    return k;
}

/* Save the state, go elsewhere and come back, to the same output. */
static bool comes_back(se3di_fmi_unit *u, uint32_t output, bool (*go)(se3di_fmi_unit *u))
{
    size_t size = 0;
    double before = 0.0, after = 1.0;
    if (!se3di_fmi_unit_get(u, output, &before) || !se3di_fmi_unit_write(u, NULL, &size)) {
        return false;
    }
    unsigned char *bytes = malloc(size);
    const bool good = bytes && se3di_fmi_unit_write(u, bytes, &size) && go(u) &&
                      se3di_fmi_unit_read(u, bytes, size) && se3di_fmi_unit_get(u, output, &after);
    free(bytes);
    CHECK(!good || memcmp(&before, &after, sizeof before) == 0);
    return good;
}

static bool step_on(se3di_fmi_unit *u)
{
    return se3di_fmi_unit_step(u, se3di_fmi_unit_get_time(u), 0.01);
}

static bool live_stepping(se3di_fmi_unit *u)
{
    const uint32_t output = find(u, "arm.position.x"), length = find(u, "parameters.l");
    const uint32_t inputs[2] = {find(u, "motor.input"), find(u, "load.input")};
    const double values[2] = {0.5, 2.0}, longer = 1.5, seed = 1.0;
    double slope = 0.0;
    return se3di_fmi_unit_begin(u, 0.0, 1.0, 1e-6) && se3di_fmi_unit_set(u, &length, 1, &longer) &&
           se3di_fmi_unit_set(u, inputs, 2, values) && se3di_fmi_unit_enter(u) &&
           se3di_fmi_unit_derive(u, &output, 1, &length, 1, &seed, &slope) &&
           se3di_fmi_unit_start(u) && step_on(u) && se3di_fmi_unit_set(u, inputs, 2, values) &&
           se3di_fmi_unit_derive(u, &output, 1, &inputs[1], 1, &seed, &slope) &&
           comes_back(u, output, step_on) && step_on(u) && se3di_fmi_unit_terminate(u);
}

enum { STATES_MAX = 40 };

static bool drift_on(se3di_fmi_unit *u)
{
    double x[STATES_MAX], dx[STATES_MAX], signs[STATES_MAX];
    const size_t n = se3di_fmi_unit_count_states(u), m = se3di_fmi_unit_count_indicators(u);
    const double h = 0.01;
    bool event = false;
    CHECK(n > 0 && n <= STATES_MAX && m > 0 && m <= STATES_MAX);
    if (!se3di_fmi_unit_get_states(u, x, n) || !se3di_fmi_unit_get_derivatives(u, dx, n)) {
        return false;
    }
    for (size_t k = 0; k < n; ++k) {
        x[k] += h * dx[k];
    }
    return se3di_fmi_unit_set_time(u, se3di_fmi_unit_get_time(u) + h) &&
           se3di_fmi_unit_set_states(u, x, n) && se3di_fmi_unit_get_indicators(u, signs, m) &&
           se3di_fmi_unit_complete_step(u, &event);
}

static bool live_exchanging(se3di_fmi_unit *u)
{
    const uint32_t output = find(u, "arm.position.x"), input = find(u, "load.input");
    const double value = 2.0, seed = 1.0;
    double slope = 0.0;
    bool ends = false, moved = false;
    return se3di_fmi_unit_begin(u, 0.0, (double)NAN, (double)NAN) && se3di_fmi_unit_enter(u) &&
           se3di_fmi_unit_set(u, &input, 1, &value) && se3di_fmi_unit_start(u) &&
           se3di_fmi_unit_update_event(u, &ends, &moved) && se3di_fmi_unit_enter_continuous(u) &&
           drift_on(u) && se3di_fmi_unit_derive(u, &output, 1, &input, 1, &seed, &slope) &&
           comes_back(u, output, drift_on) && se3di_fmi_unit_enter_event(u) &&
           se3di_fmi_unit_update_event(u, &ends, &moved) && se3di_fmi_unit_terminate(u);
}

/* A unit that memory was refused to lives again from the start. */
static se3d_status use_unit(const char *folder, bool exchanges, bool (*live)(se3di_fmi_unit *u),
                            se3d_model_error *error)
{
    replaces = 1;
    se3di_fmi_unit *u = se3di_fmi_unit_create(folder, NULL, exchanges, hear, error);
    const bool good = u && live(u);
    if (!u && !error->message[0]) {
        snprintf(error->message, sizeof error->message, "out of memory"); /* of the unit itself */
    }
    if (u && !good) {
        CHECK(se3di_fmi_unit_reset(u) && live(u));
    }
    se3di_fmi_unit_destroy(u);
    replaces = 0;
    return good                               ? SE3D_OK
           : strstr(error->message, "memory") ? SE3D_ERR_NO_MEMORY
                                              : SE3D_ERR_CALLBACK;
}

static se3d_status use_stepping(const char *folder, se3d_model_error *error)
{
    return use_unit(folder, false, live_stepping, error);
}

static se3d_status use_exchanging(const char *folder, se3d_model_error *error)
{
    return use_unit(folder, true, live_exchanging, error);
}

static int goes_on(void *ctx)
{
    (void)ctx;
    return 0;
}

static bool look(se3di_live *live)
{
    double *places = malloc((se3di_live_count_places(live) + 1) * sizeof *places);
    float *spheres = malloc((4 * se3di_live_count_particles(live) + 1) * sizeof *spheres);
    FILE *file = tmpfile();
    const bool has_spheres = se3di_live_count_particles(live) > 0;
    const bool good = places && spheres && file && se3di_live_put_scene(live, file) &&
                      (!has_spheres || se3di_live_get_particles(live, spheres)) && !ferror(file);
    if (places) {
        se3di_live_get_places(live, places);
    }
    if (file) {
        shut(file);
    }
    free(places);
    free(spheres);
    return good;
}

/* A number is set, the file read again on the way and at the start, a body pulled. */
static bool live_shown(se3di_live *live, char *message)
{
    static const double point[3] = {0.0, 0.0, 0.0}, place[3] = {0.5, 0.0, 0.5};
    for (size_t k = 0; k < se3di_live_count_sliders(live); ++k) {
        const se3di_live_slider *slider = se3di_live_get_slider(live, k);
        if (!se3di_live_set(live, k, slider->value + 0.25)) {
            return false;
        }
    }
    const bool pulled = se3di_live_pull(live, 1, point, place);
    return pulled && se3di_live_run(live, 0.01, message) && se3di_live_release(live) &&
           look(live) && se3di_live_read(live, SE3DI_LIVE_GOING_ON, message) && !message[0] &&
           se3di_live_run(live, 0.02, message) &&
           se3di_live_read(live, SE3DI_LIVE_RESET, message) && look(live) &&
           se3di_live_read(live, SE3DI_LIVE_CHANGED, message);
}

/* After a refusal the session is whole: all of it goes well again. */
static se3d_status use_live(const char *path, se3d_model_error *error)
{
    char message[SE3DI_LIVE_MESSAGE_SIZE] = "";
    const se3d_model_options options = se3d_model_options_default();
    replaces = 1;
    se3di_live *live = se3di_live_create(path, &options, goes_on, NULL, message);
    const bool good = live && live_shown(live, message);
    snprintf(error->message, sizeof error->message, "%.900s", good ? "" : message);
    if (live && !good) {
        (void)se3di_live_release(live);
        if (!error->message[0]) {
            snprintf(error->message, sizeof error->message, "refused"); /* what is only true */
        }
        CHECK(se3di_live_read(live, SE3DI_LIVE_ANEW, message) && live_shown(live, message));
    }
    se3di_live_destroy(live);
    replaces = 0;
    return good ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

typedef se3d_status (*use)(const char *path, se3d_model_error *error);

static se3d_status attempt(use what, const char *path, size_t refused, se3d_model_error *error)
{
    calls.count = calls.reached = 0;
    is_read = 0;
    is_lenient = is_told = 0;
    calls.refused = refused;
    counting = (support_counting){.fail_at = 0};
    *error = (se3d_model_error){0, 0, ""};
    const se3d_status status = what(path, error);
    CHECK(counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
    return status;
}

/* @return how many calls were refused */
static size_t refuse_each(use what, const char *path)
{
    static size_t chosen[CALLS];
    se3d_model_error error;
    const int before = check_failures;
    calls.looks = 1;
    calls.fresh_count = 0;
    const se3d_status whole = attempt(what, path, 0, &error);
    calls.looks = 0;
    const int lacks_unit = strstr(error.message, "none.fmu/") != NULL; /* a seed names one */
    if (whole < 0 && !lacks_unit) {
        fprintf(stderr, "%s: %s\n", path, error.message);
    }
    CHECK(whole >= 0 || lacks_unit);
    const int fails_anyway = is_told;
    const size_t count = calls.fresh_count;
    memcpy(chosen, calls.fresh, count * sizeof *chosen);
    for (size_t k = 0; k < count; ++k) {
        const se3d_status status = attempt(what, path, chosen[k], &error);
        CHECK(calls.reached == 1);
        CHECK(kind != OF_MEMORY ? is_lenient || is_told || status < 0
                                : status == SE3D_ERR_NO_MEMORY || (lacks_unit && status == whole) ||
                                      ((fails_anyway || is_told) && status >= 0));
        CHECK(error.message[0] != '\0' || is_lenient);
        if (check_failures > before) {
            fprintf(stderr, "%s: call %zu that fails: status %d: %s\n", path, chosen[k],
                    (int)status, error.message);
            calls.tells = 1;
            attempt(what, path, chosen[k], &error);
            calls.tells = 0;
            break;
        }
    }
    if (getenv("SE3D_SHOW")) {
        fprintf(stderr, "%s: %zu\n", path, count);
    }
    return count;
}

/* Paths that others had, too, end elsewhere here. */
static size_t refuse_each_anew(use what, const char *path)
{
    forget_paths();
    return refuse_each(what, path);
}

static size_t refuse_in_folder(use what, const char *folder, const char *const *endings)
{
    char path[900];
    size_t sum = 0;
    DIR *directory = opendir(folder);
    CHECK(directory != NULL);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        const size_t length = strlen(entry->d_name);
        int is_one = 0;
        for (const char *const *e = endings; *e; ++e) {
            is_one |= length > strlen(*e) && strcmp(entry->d_name + length - strlen(*e), *e) == 0;
        }
        if (is_one) {
            snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
            sum += refuse_each(what, path);
        }
    }
    if (directory) {
        closedir(directory);
    }
    return sum;
}

/* How many paths there are at least, where there are so many that ask for memory. */
static size_t least(size_t of_memory)
{
    return kind == OF_MEMORY ? of_memory : kind == OF_FILES ? of_memory / 100 : of_memory / 4;
}

static void every_path_of_models_survives_a_refusal(void)
{
    static const char *const endings[] = {".yaml", NULL};
    static const char *const some[] = {"electronic_cam.yaml",  "planar_slider_crank_inverse.yaml",
                                       "quarter_car.yaml",     "gear_train.yaml",
                                       "bar_equilibrium.yaml", NULL};
    size_t sum = refuse_in_folder(use_model, "fuzz/seeds/model", endings);
    sum += refuse_in_folder(use_model, "examples/models", check_is_long() ? endings : some);
    CHECK(sum > least(500));
}

static void every_path_of_imports_survives_a_refusal(void)
{
    static const char *const endings[] = {".urdf", ".sdf", ".adm", ".mdl", ".xml", ".yaml", NULL};
    CHECK(refuse_in_folder(use_import, "fuzz/seeds/import", endings) > least(100));
}

#define LIFE                                                                                       \
    "se3d: 1\n"                                                                                    \
    "parameters: {l: 1, half: l/2}\n"                                                              \
    "bodies:\n"                                                                                    \
    "  - {name: arm, mass: 1, inertia: [0.1, 0.1, 0.1], position: [half, 0, 0]}\n"                 \
    "  - {name: block, mass: 1, inertia: [1, 1, 1], position: [0, 2, 0]}\n"                        \
    "joints:\n"                                                                                    \
    "  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, 1, "    \
    "0]}\n"                                                                                        \
    "  - {name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 2, 0], axis: [1, "   \
    "0, "                                                                                          \
    "0]}\n"
#define LIFE_ACTS                                                                                  \
    "forces:\n"                                                                                    \
    "  - {name: spring, type: tsda, body_i: ground, body_j: arm, point_i: [0, 0, 1], point_j: "    \
    "[0.5, 0, 0], k: 50, l0: 1}\n"                                                                 \
    "  - {name: load, type: effort, joint: pin, value: 1}\n"                                       \
    "  - {name: end, type: stop, joint: pin, coordinate: angle, upper: 0.5, k: 1e3}\n"             \
    "states: [{name: lag, type: lag, input: pin.angle, time_constant: 0.1}]\n"                     \
    "events: [{name: low, channel: pin.angle, value: 0.01}]\n"                                     \
    "output: [{file: a.csv, every: 0.1, channels: [arm.position, pin.angle]}]\n"
#define LIFE_SPHERES                                                                               \
    "materials: [{name: m, density: 1000, stiffness: 1e3}]\n"                                      \
    "contact: {}\n"                                                                                \
    "particles: [{material: m, radius: 0.1, lower: [3, 0, 0], upper: [3.5, 0.5, 0.5]}]\n"

static void every_path_of_units_survives_a_refusal(void)
{
    write_text("se3d.txt", "se3d-fmu 1\nmodel life.yaml\nset l=1.25\n");
    write_text("life.yaml", LIFE "drivers: [{name: motor, joint: rail, rate: 0.25}]\n" LIFE_ACTS
                                 "analysis: [{type: assembly}, {type: dynamics, duration: 1}]\n");
    CHECK(refuse_each_anew(use_stepping, results()) > least(250));
    write_text("life.yaml", LIFE LIFE_ACTS "analysis: {type: dynamics, duration: 1}\n");
    CHECK(refuse_each_anew(use_exchanging, results()) > least(250));
}

static void every_path_of_runs_that_go_on_survives_a_refusal(void)
{
    char path[900];
    static const char *const seeds[] = {"grains", "solids", "states"};
    snprintf(path, sizeof path, "%s/life.yaml", results());
    write_text("life.yaml",
               LIFE LIFE_ACTS "analysis: {type: dynamics, duration: 1, step: 1e-3, method: rk4}\n");
    CHECK(refuse_each_anew(use_going_on, path) > least(250));
    for (size_t k = 0; k < sizeof seeds / sizeof *seeds; ++k) {
        snprintf(path, sizeof path, "fuzz/seeds/model/%s.yaml", seeds[k]);
        (void)refuse_each(use_going_on, path);
    }
}

static void every_path_of_a_live_model_survives_a_refusal(void)
{
    char path[900];
    snprintf(path, sizeof path, "%s/life.yaml", results());
    write_text("life.yaml",
               LIFE "drivers: [{name: motor, joint: rail, rate: 0.25}]\n" LIFE_ACTS LIFE_SPHERES
                    "analysis: [{type: assembly}, {type: dynamics, duration: 1, step: 1e-3}]\n");
    CHECK(refuse_each_anew(use_live, path) > least(250));
}

/* ---- calls of libse3d ---- */

#ifdef SE3D_LETS_FAIL
static void let_calls_fail(int depth)
{
    calls.depth = depth;
    forget_paths();
    every_path_of_models_survives_a_refusal();
    every_path_of_units_survives_a_refusal();
    every_path_of_a_live_model_survives_a_refusal();
    every_path_of_runs_that_go_on_survives_a_refusal();
}

static void every_failure_of_the_library_below_is_told(void)
{
    kind = OF_LIBRARY;
    let_calls_fail(4);
}

/* Steps are tried again, and what was only to be known beforehand is not; property.failing_calls
 * has what becomes of the state. */
static void no_failure_within_the_library_leaks_or_crashes(void)
{
    kind = OF_LAYERS;
    let_calls_fail(2);
}
#endif

static void every_failure_of_files_is_told(void)
{
    kind = OF_FILES;
    calls.depth = 4;
    forget_paths();
    every_path_of_imports_survives_a_refusal();
    every_path_of_models_survives_a_refusal();
    every_path_of_units_survives_a_refusal();
    every_path_of_a_live_model_survives_a_refusal();
    every_path_of_runs_that_go_on_survives_a_refusal();
}

int main(void)
{
    (void)mkdir(results(), 0777); /* if it is not there */
    calls.depth = 6;
    RUN(every_path_of_imports_survives_a_refusal);
    RUN(every_path_of_models_survives_a_refusal);
    RUN(every_path_of_units_survives_a_refusal);
    RUN(every_path_of_a_live_model_survives_a_refusal);
    RUN(every_path_of_runs_that_go_on_survives_a_refusal);
#ifdef SE3D_LETS_FAIL
    RUN(every_failure_of_the_library_below_is_told);
    if (check_is_long()) {
        RUN(no_failure_within_the_library_leaks_or_crashes);
    }
#endif
    RUN(every_failure_of_files_is_told);
    return check_finish();
}
