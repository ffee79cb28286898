/* SPDX-License-Identifier: BSD-3-Clause */
/* One order of the content for reading and writing: how far every file is, the state of system and
 * solver, the scene, what the run knows. A frame says what it is: a mark, versions, the model's
 * files and options; a checksum ends it. Sizes of files come first, so that nothing is touched
 * before all is known to fit. */
#include "io/run/checkpoint.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/hash.h"
#include "io/base/file.h"
#include "io/base/pack.h"
#include "io/channel/event.h"
#include "io/document/document.h"
#include "io/run/guest.h"
#include "io/write/scene.h"

#define FILE_NAME "run.checkpoint"
#define MARK      UINT64_C(0x544B504344334553) /* "SE3DCPKT" */
#define VERSION   UINT64_C(6)
#define LIBRARY                                                                                    \
    (((uint64_t)SE3D_VERSION_MAJOR << 32) + ((uint64_t)SE3D_VERSION_MINOR << 16) +                 \
     (uint64_t)SE3D_VERSION_PATCH)

#define SYNC_LEAST 1.0 /* s between checkpoints */

enum { FRAME_WORDS = 5, WORD = 8, TOLD_MAX = 100, PATH_SIZE = 4096, TEXT_SIZE = 800 };

/* A warning of the run. */
typedef struct told_text {
    const char *text;
    int32_t level, kind;
} told_text;

struct se3di_told {
    se3di_runner *runner;
    told_text list[TOLD_MAX];
    size_t count;
};

/* Bytes that others wrote or read. */
typedef struct blob {
    const unsigned char *bytes;
    size_t size;
} blob;

struct se3di_resume {
    se3di_coder coder; /* at what the run knows, later at its end */
    se3di_csv_mark *marks;
    se3di_csv_mark events;
    blob state, solver, scene, guests;
    se3di_place place;
    size_t analysis;    /* the one under way */
    double *durations;  /* [analyses] [s] */
    double *next;       /* [outputs] numbers of the rows to come, */
    double *every;      /* [outputs] and how far they are apart [s] */
    int32_t foresees;   /* the steps so far depend on the end of the analysis */
    int32_t has_guests; /* and so do units of other programs */
    char problem[SE3DI_GUEST_PROBLEM];
};

static void listen(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    struct se3di_told *told = ctx;
    const se3d_model *model = told->runner->model;
    if (model->log) {
        model->log(model->log_ctx, level, kind, message);
    }
    for (size_t k = 0; k < told->count; ++k) {
        if (strcmp(told->list[k].text, message) == 0) {
            return;
        }
    }
    if (level == SE3D_LOG_WARNING && told->count < TOLD_MAX) {
        const char *copy = se3di_iopool_copy(&told->runner->run->pool, message, strlen(message));
        told->list[told->count] = (told_text){copy, (int32_t)level, (int32_t)kind};
        told->count += copy != NULL;
    }
}

bool se3di_checkpoint_listen(se3di_runner *r)
{
    r->told = se3di_iopool_alloc(&r->run->pool, sizeof *r->told);
    if (r->told) {
        r->told->runner = r;
    }
    return r->told && se3d_system_set_log(r->model->system, listen, r->told) >= 0;
}

void se3di_checkpoint_ignore(se3di_runner *r)
{
    if (r->told) {
        (void)se3d_system_set_log(r->model->system, r->model->log, r->model->log_ctx);
    }
}

/* ---- the content, both ways ---- */

static void pack_mark(se3di_coder *p, se3di_csv_mark *mark)
{
    se3di_code_word(p, &mark->bytes);
    se3di_code_word(p, &mark->lines);
    se3di_code_word(p, &mark->rows);
    se3di_code_word(p, &mark->hash);
}

/* What of the analyses depends on how long they are. */
static void pack_course(se3di_coder *p, const se3di_runner *r, struct se3di_resume *c)
{
    size_t analyses = r->model->analysis_count;
    se3di_code_size(p, &analyses);
    se3di_code_size(p, &c->analysis);
    p->failed = p->failed || analyses != r->model->analysis_count || c->analysis >= analyses;
    if (p->failed) {
        return;
    }
    se3di_code_numbers(p, c->durations, analyses);
    se3di_code_numbers(p, c->next, r->model->output_count);
    se3di_code_numbers(p, c->every, r->model->output_count);
    se3di_code_numbers(p, &c->place.start, 1);
    se3di_code_numbers(p, &c->place.reached, 1);
    se3di_code_flag(p, &c->foresees);
    se3di_code_flag(p, &c->has_guests);
}

static void pack_marks(se3di_coder *p, const se3di_runner *r, struct se3di_resume *c)
{
    size_t count = r->model->output_count;
    se3di_code_size(p, &count);
    p->failed = p->failed || count != r->model->output_count;
    for (size_t k = 0; k < r->model->output_count; ++k) {
        pack_mark(p, &c->marks[k]);
    }
    pack_mark(p, &c->events);
    pack_course(p, r, c);
    se3di_pack_bytes(p, &c->state.bytes, &c->state.size);
    se3di_pack_bytes(p, &c->solver.bytes, &c->solver.size);
    se3di_pack_bytes(p, &c->scene.bytes, &c->scene.size);
    se3di_pack_bytes(p, &c->guests.bytes, &c->guests.size);
}

static void pack_analysis(se3di_coder *p, se3di_iopool *pool, se3d_run_analysis *a)
{
    const char **const texts[] = {&a->type,  &a->formulation, &a->method,  &a->left,
                                  &a->moved, &a->deflected,   &a->left_out};
    double *const numbers[] = {&a->start,     &a->end,     &a->cpu_time, &a->left_at,
                               &a->tolerance, &a->reached, &a->step};
    uint64_t *const counts[] = {&a->stats.steps,          &a->stats.rejected,
                                &a->stats.iterations,     &a->stats.evaluations,
                                &a->stats.factorizations, &a->stats.solves};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
        se3di_pack_text(p, pool, texts[k]);
        se3di_code_numbers(p, numbers[k], 1);
    }
    for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k) {
        se3di_code_word(p, counts[k]);
    }
    se3di_code_numbers(p, a->start_change, 8);
    se3di_code_int32(p, &a->status);
}

/* The analyses before the one under way. */
static void pack_analyses(se3di_coder *p, se3di_runner *r)
{
    size_t done = r->run->analysis_count > 0 ? r->run->analysis_count - 1 : 0;
    se3di_code_size(p, &done);
    if (done > r->analysis) {
        p->failed = 1;
        return;
    }
    for (size_t k = 0; k < done; ++k) {
        pack_analysis(p, &r->run->pool, &r->run->analyses[k]);
    }
    if (p->in) {
        r->run->analysis_count = done;
    }
}

/* The text, not a joint of that name. */
static bool is_event(const se3d_model *model, const char *name)
{
    for (size_t k = 0; k < model->event_count; ++k) {
        if (model->events[k].name == name) {
            return true;
        }
    }
    return false;
}

static void pack_event(se3di_coder *p, const se3d_model *model, se3d_run_event *event)
{
    size_t entry = 0;
    if (!p->in) {
        const bool broke = model->event_count == 0 || !is_event(model, event->name);
        entry = se3di_run_event_find_kind(model, event->name, broke);
    }
    se3di_code_size(p, &entry);
    se3di_code_numbers(p, &event->time, 1);
    se3di_code_numbers(p, &event->value, 1);
    se3di_code_size(p, &event->analysis);
    se3di_code_int32(p, &event->direction);
    se3di_code_int32(p, &event->stopped);
    if (entry >= se3di_run_event_count_kinds(model)) {
        p->failed = 1;
    } else if (p->in) {
        se3di_run_event_set_kind(model, entry, event);
    }
}

static void pack_events(se3di_coder *p, se3di_runner *r)
{
    se3di_event_list *events = &r->run->events;
    se3di_code_size(p, &events->collected);
    se3di_code_count(p, &events->count, 1.0);
    if (p->in) {
        events->list = se3di_iopool_array(&r->run->pool, events->count + 1, sizeof *events->list);
        events->capacity = events->count + 1;
        if (!events->list) {
            events->count = events->capacity = 0;
            p->failed = 1;
        }
    }
    for (size_t k = 0; k < events->count; ++k) {
        pack_event(p, r->model, &events->list[k]);
    }
}

/* Files that are complete: of modes. */
static void pack_files(se3di_coder *p, se3d_run *run)
{
    se3di_code_count(p, &run->file_count, 1.0);
    if (p->in) {
        run->files = se3di_iopool_array(&run->pool, run->file_count + 1, sizeof *run->files);
        run->file_capacity = run->file_count + 1;
        if (!run->files) {
            run->file_count = run->file_capacity = 0;
            p->failed = 1;
        }
    }
    for (size_t k = 0; k < run->file_count; ++k) {
        se3di_pack_text(p, &run->pool, &run->files[k].path);
        se3di_code_word(p, &run->files[k].rows);
        se3di_code_size(p, &run->files[k].columns);
    }
}

static void pack_outputs(se3di_coder *p, const se3di_runner *r)
{
    for (size_t k = 0; k < r->file_count; ++k) {
        se3di_output_file *file = &r->files[k];
        if (file->vtk) {
            se3di_vtk_pack(file->vtk, p);
        } else {
            se3di_csv_pack_pending(&file->csv, p);
        }
        if (file->summary) {
            se3di_summary_pack(file->summary, p);
        }
        if (file->average) {
            se3di_average_pack(file->average, p);
        }
    }
}

static void pack_told(se3di_coder *p, struct se3di_told *told)
{
    se3di_code_count(p, &told->count, 1.0);
    if (told->count > TOLD_MAX) {
        told->count = 0;
        p->failed = 1;
    }
    for (size_t k = 0; k < told->count; ++k) {
        se3di_pack_text(p, &told->runner->run->pool, &told->list[k].text);
        se3di_code_int32(p, &told->list[k].level);
        se3di_code_int32(p, &told->list[k].kind);
    }
}

static void pack_rest(se3di_coder *p, se3di_runner *r, struct se3di_resume *c)
{
    pack_analyses(p, r);
    se3di_code_numbers(p, &c->place.cpu, 1);
    se3di_code_int32(p, &c->place.last);
    se3di_code_numbers(p, &r->time, 1);
    pack_events(p, r);
    pack_files(p, r->run);
    pack_outputs(p, r);
    pack_told(p, r->told);
}

/* What it is: the words before the content. */
static void list_frame(const se3di_runner *r, uint64_t words[FRAME_WORDS])
{
    const uint64_t frame[FRAME_WORDS] = {MARK, VERSION, LIBRARY, r->model->timeless[0],
                                         r->model->timeless[1]};
    memcpy(words, frame, sizeof frame);
}

static void pack_all(se3di_coder *p, se3di_runner *r, struct se3di_resume *c)
{
    uint64_t frame[FRAME_WORDS];
    list_frame(r, frame);
    for (int k = 0; k < FRAME_WORDS; ++k) {
        se3di_code_word(p, &frame[k]);
    }
    pack_marks(p, r, c);
    pack_rest(p, r, c);
}

static bool reserve(const se3di_runner *r, se3di_iopool *pool, struct se3di_resume *c)
{
    const size_t count = r->model->output_count;
    c->marks = se3di_iopool_array(pool, count, sizeof *c->marks);
    c->next = se3di_iopool_array(pool, count, sizeof *c->next);
    c->every = se3di_iopool_array(pool, count, sizeof *c->every);
    c->durations = se3di_iopool_array(pool, r->model->analysis_count, sizeof *c->durations);
    return c->marks && c->next && c->every && c->durations;
}

/* ---- writing ---- */

static bool join(const se3di_runner *r, char path[PATH_SIZE])
{
    return se3di_file_join(r->options->directory, FILE_NAME, path, PATH_SIZE);
}

static se3d_status write_state(const se3di_runner *r, se3di_iopool *pool, blob *state)
{
    se3d_snapshot *snapshot = NULL;
    se3d_status status = se3d_snapshot_create(r->model->system, &snapshot);
    if (status >= 0) {
        status = se3d_snapshot_write(snapshot, NULL, 0, &state->size);
    }
    unsigned char *bytes = status >= 0 ? se3di_iopool_alloc(pool, state->size) : NULL;
    if (status >= 0) {
        status = bytes ? se3d_snapshot_write(snapshot, bytes, state->size, &state->size)
                       : SE3D_ERR_NO_MEMORY;
    }
    se3d_snapshot_destroy(snapshot);
    state->bytes = bytes;
    return status;
}

static se3d_status write_solver(const se3di_runner *r, se3di_iopool *pool, blob *solver)
{
    se3d_status status = se3d_solver_write(r->solver, NULL, 0, &solver->size);
    unsigned char *bytes = status >= 0 ? se3di_iopool_alloc(pool, solver->size) : NULL;
    if (status >= 0) {
        status = bytes ? se3d_solver_write(r->solver, bytes, solver->size, &solver->size)
                       : SE3D_ERR_NO_MEMORY;
    }
    solver->bytes = bytes;
    return status;
}

static se3d_status write_scene(const se3di_runner *r, se3di_iopool *pool, blob *scene)
{
    se3di_coder measure = {.size = SIZE_MAX};
    if (!r->options->scene) {
        return SE3D_OK;
    }
    se3di_scene_pack(r->options->scene, &measure);
    unsigned char *bytes = se3di_iopool_alloc(pool, measure.at);
    se3di_coder p = {.out = bytes, .size = measure.at};
    if (bytes) {
        se3di_scene_pack(r->options->scene, &p);
    }
    *scene = (blob){bytes, bytes ? measure.at : 0};
    return bytes ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

/* Disks are slow: who wants checkpoints often cares for programs that end, not for machines. */
static bool syncs(const se3di_runner *r)
{
    return r->options->checkpoint >= SYNC_LEAST;
}

/* How far the files are, and where they go on. */
static bool mark_files(se3di_runner *r, struct se3di_resume *c)
{
    const bool sync = syncs(r);
    bool good = true;
    for (size_t k = 0; k < r->file_count; ++k) {
        c->next[k] = r->files[k].next;
        c->every[k] = r->files[k].every;
        good =
            good && (r->files[k].vtk || se3di_csv_mark_here(&r->files[k].csv, sync, &c->marks[k]));
    }
    return good &&
           (!r->run->events.is_open || se3di_csv_mark_here(&r->run->events.csv, sync, &c->events));
}

static bool write_file(const char *path, const unsigned char *bytes, size_t size, bool sync)
{
    FILE *file = se3di_partial_open(path);
    if (!file) {
        return false;
    }
    errno = 0;
    const bool written = fwrite(bytes, 1, size, file) == size && (!sync || se3di_file_sync(file));
    if (!written) {
        const int why = errno ? errno : EIO;
        se3di_partial_abandon(file, path);
        errno = why;
        return false;
    }
    return se3di_partial_close(file, path);
}

static se3d_status write_bytes(se3di_runner *r, se3di_iopool *pool, struct se3di_resume *c,
                               const char *path)
{
    se3di_coder measure = {.size = SIZE_MAX};
    pack_all(&measure, r, c);
    const size_t size = measure.at + WORD;
    unsigned char *bytes = se3di_iopool_alloc(pool, size);
    if (!bytes) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3di_coder p = {.out = bytes, .size = size};
    pack_all(&p, r, c);
    uint64_t sum = se3di_hash_bytes(SE3DI_HASH_START, bytes, p.at);
    se3di_code_word(&p, &sum);
    return write_file(path, bytes, size, syncs(r)) ? SE3D_OK : SE3D_ERR_IO;
}

static se3d_status write_all(se3di_runner *r, se3di_iopool *pool, struct se3di_resume *c,
                             const char *path)
{
    if (!reserve(r, pool, c)) {
        return SE3D_ERR_NO_MEMORY;
    }
    c->analysis = r->analysis;
    for (size_t k = 0; k < r->model->analysis_count; ++k) {
        c->durations[k] = r->model->analyses[k].analysis.duration;
    }
    c->has_guests = r->guests != NULL;
    (void)se3d_solver_get_foresight(r->solver, &c->foresees);
    if (!mark_files(r, c)) {
        return SE3D_ERR_IO;
    }
    se3d_status status = write_state(r, pool, &c->state);
    status = status < 0 ? status : write_solver(r, pool, &c->solver);
    status = status < 0 ? status : write_scene(r, pool, &c->scene);
    if (status >= 0) {
        status = se3di_guests_write(r->guests, pool, &c->guests.bytes, &c->guests.size, c->problem);
    }
    return status < 0 ? status : write_bytes(r, pool, c, path);
}

void se3di_checkpoint_write(se3di_runner *r, const se3di_place *place)
{
    struct se3di_resume c = {.place = *place};
    char path[PATH_SIZE];
    char text[TEXT_SIZE];
    se3di_iopool pool;
    se3di_iopool_init(&pool, &r->model->pool.allocator);
    errno = 0;
    const se3d_status status = join(r, path) ? write_all(r, &pool, &c, path) : SE3D_ERR_IO;
    const int why = errno;
    se3di_iopool_destroy(&pool);
    if (status < 0 && r->model->log) {
        snprintf(text, sizeof text, "%.500s cannot be written: %.250s", path,
                 c.problem[0]                   ? c.problem
                 : status == SE3D_ERR_IO && why ? strerror(why)
                                                : se3d_status_get_text(status));
        r->model->log(r->model->log_ctx, SE3D_LOG_WARNING, SE3D_LOG_CHECKPOINT, text);
    }
}

/* ---- reading ---- */

static se3d_status refuse(se3di_runner *r, se3d_status status, const char *why)
{
    char path[PATH_SIZE] = FILE_NAME;
    char text[TEXT_SIZE];
    (void)join(r, path);
    snprintf(text, sizeof text, "%.400s: cannot be resumed: %.300s", path, why);
    se3di_document_report(r->error, "", 0, 0, "", text);
    return status;
}

static se3d_status read_file(se3di_runner *r, const char *path, char **bytes, size_t *size)
{
    FILE *file = se3di_file_open(path);
    if (!file) {
        return errno == ENOENT ? SE3D_OK : refuse(r, SE3D_ERR_IO, strerror(errno));
    }
    long length = -1;
    if (fseek(file, 0, SEEK_END) == 0) {
        length = ftell(file);
    }
    rewind(file);
    *size = length > 0 ? (size_t)length : 0;
    *bytes = se3di_iopool_alloc(&r->run->pool, *size + 1);
    const bool whole = *bytes && length >= 0 && fread(*bytes, 1, *size, file) == *size;
    fclose(file);
    return whole    ? SE3D_OK
           : *bytes ? refuse(r, SE3D_ERR_IO, "it cannot be read")
                    : refuse(r, SE3D_ERR_NO_MEMORY, "out of memory");
}

/* Why not; NULL: it is one of this model. */
static const char *check_frame(const se3di_runner *r, se3di_coder *p)
{
    uint64_t expected[FRAME_WORDS], found[FRAME_WORDS], sum = 0;
    list_frame(r, expected);
    if (p->size < (FRAME_WORDS + 1) * WORD) {
        return "it is damaged or cut: too short";
    }
    se3di_coder end = {.in = p->in + p->size - WORD, .size = WORD};
    se3di_code_word(&end, &sum);
    p->size -= WORD;
    for (int k = 0; k < FRAME_WORDS; ++k) {
        se3di_code_word(p, &found[k]);
    }
    return found[0] != expected[0]   ? "it is no checkpoint"
           : found[1] != expected[1] ? "it has another format, of another version of the program"
           : sum != se3di_hash_bytes(SE3DI_HASH_START, p->in, p->size)
               ? "it is damaged or cut: its checksum is another one"
           : found[2] != expected[2]
               ? "it is of another version of the program, whose methods may keep other things"
           : found[3] != expected[3] ? "it is of another model, or of one that was changed since"
           : found[4] != expected[4]
               ? "it is of a run with other options (--set, --method, --step, ...)"
               : NULL;
}

/* What is behind the frame could not be read. */
static se3d_status refuse_content(se3di_runner *r)
{
    return r->run->pool.is_short ? refuse(r, SE3D_ERR_NO_MEMORY, "out of memory")
                                 : refuse(r, SE3D_ERR_STATE, "it is malformed");
}

static bool is_same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* Rows of an output that another duration would give other times, or that would be over. */
static bool check_rows(const se3di_runner *r, const struct se3di_resume *c, size_t k,
                       char text[TEXT_SIZE])
{
    const se3di_output_entry *output = &r->model->outputs[k];
    double every;
    const double count = se3di_output_count_rows(output, &r->model->analyses[c->analysis], &every);
    if (!is_same(every, c->every[k])) {
        snprintf(
            text, TEXT_SIZE,
            "rows of `%.100s` are a 500th of the duration apart, of which there is another one "
            "now: say `every`",
            output->file);
        return false;
    }
    if (c->next[k] > count) {
        snprintf(text, TEXT_SIZE, "rows of `%.100s` go to t = %.9g s, beyond the end of the run",
                 output->file, c->place.reached);
        return false;
    }
    return true;
}

/* Durations may be others where they change nothing of what was done. */
static se3d_status check_course(se3di_runner *r, const struct se3di_resume *c)
{
    char text[TEXT_SIZE];
    for (size_t k = 0; k < c->analysis; ++k) {
        const double now = r->model->analyses[k].analysis.duration;
        if (!is_same(now, c->durations[k])) {
            snprintf(text, sizeof text,
                     "analysis %zu is over and took %.9g s, its duration is %.9g s now", k + 1,
                     c->durations[k], now);
            return refuse(r, SE3D_ERR_STATE, text);
        }
    }
    const double before = c->durations[c->analysis];
    const double now = r->model->analyses[c->analysis].analysis.duration;
    if (is_same(now, before)) {
        return SE3D_OK;
    }
    if (!(c->place.reached < c->place.start + now)) {
        snprintf(text, sizeof text, "it is of t = %.9g s, the run is to end at t = %.9g s",
                 c->place.reached, c->place.start + now);
        return refuse(r, SE3D_ERR_STATE, text);
    }
    if (c->foresees || c->has_guests) {
        snprintf(text, sizeof text, "%s for an end at t = %.9g s, not at %.9g s%s",
                 c->foresees ? "steps were chosen" : "units of `fmus` were started",
                 c->place.start + before, c->place.start + now,
                 c->foresees ? ": only with a `step` can it be another one" : "");
        return refuse(r, SE3D_ERR_STATE, text);
    }
    for (size_t k = 0; k < r->model->output_count; ++k) {
        if (!check_rows(r, c, k, text)) {
            return refuse(r, SE3D_ERR_STATE, text);
        }
    }
    return SE3D_OK;
}

/* Its state can be restored here. */
static se3d_status check_state(se3di_runner *r, const struct se3di_resume *c)
{
    se3d_snapshot *snapshot = NULL;
    const se3d_status status =
        se3d_snapshot_read(r->model->system, c->state.bytes, c->state.size, &snapshot);
    se3d_snapshot_destroy(snapshot);
    return status >= 0 ? SE3D_OK
                       : refuse(r, status == SE3D_ERR_NO_MEMORY ? status : SE3D_ERR_STATE,
                                se3d_system_get_error(r->model->system));
}

se3d_status se3di_checkpoint_open(se3di_runner *r)
{
    char path[PATH_SIZE];
    char *bytes = NULL;
    size_t size = 0;
    if (!join(r, path)) {
        return refuse(r, SE3D_ERR_IO, strerror(errno));
    }
    se3d_status status = read_file(r, path, &bytes, &size);
    if (status < 0 || !bytes) {
        return status;
    }
    struct se3di_resume *c = se3di_iopool_alloc(&r->run->pool, sizeof *c);
    if (!c || !reserve(r, &r->run->pool, c)) {
        return refuse(r, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    c->coder = (se3di_coder){.in = (const unsigned char *)bytes, .size = size};
    const char *why = check_frame(r, &c->coder);
    if (why) {
        return refuse(r, SE3D_ERR_STATE, why);
    }
    pack_marks(&c->coder, r, c);
    status = c->coder.failed ? refuse_content(r) : check_course(r, c);
    status = status < 0 ? status : check_state(r, c);
    r->resume = status < 0 ? NULL : c;
    return status;
}

const se3di_csv_mark *se3di_checkpoint_get_mark(const se3di_runner *r, size_t k)
{
    return &r->resume->marks[k];
}

const se3di_csv_mark *se3di_checkpoint_get_events(const se3di_runner *r)
{
    return &r->resume->events;
}

double se3di_checkpoint_get_start(const se3di_runner *r)
{
    return r->resume->place.start;
}

/* The user hears again what was said before. */
static void tell_again(const se3di_runner *r)
{
    for (size_t k = 0; k < r->told->count && r->model->log; ++k) {
        const told_text *t = &r->told->list[k];
        r->model->log(r->model->log_ctx, (se3d_log_level)t->level, (se3d_log_kind)t->kind, t->text);
    }
}

se3d_status se3di_checkpoint_take(se3di_runner *r)
{
    struct se3di_resume *c = r->resume;
    r->analysis = c->analysis;
    pack_rest(&c->coder, r, c);
    if (!c->coder.failed && r->options->scene && c->scene.size > 0) {
        se3di_coder scene = {.in = c->scene.bytes, .size = c->scene.size};
        se3di_scene_pack(r->options->scene, &scene);
        c->coder.failed = scene.failed;
    }
    if (c->coder.failed || c->coder.at != c->coder.size) {
        return refuse_content(r);
    }
    tell_again(r);
    return SE3D_OK;
}

se3d_status se3di_checkpoint_restore(se3di_runner *r, se3di_place *place)
{
    struct se3di_resume *c = r->resume;
    se3d_system *system = r->model->system;
    se3d_snapshot *snapshot = NULL;
    se3d_status status =
        se3di_guests_read(r->guests, c->guests.bytes, c->guests.size, c->problem); /* sets values */
    if (status < 0) {
        return refuse(r, status, c->problem);
    }
    status = se3d_snapshot_read(system, c->state.bytes, c->state.size, &snapshot);
    if (status >= 0) {
        status = se3d_snapshot_restore(snapshot, system);
    }
    if (status >= 0) {
        status = se3d_solver_read(r->solver, c->solver.bytes, c->solver.size);
    }
    se3d_snapshot_destroy(snapshot);
    for (size_t k = 0; k < r->file_count; ++k) {
        r->files[k].next = c->next[k];
    }
    *place = c->place;
    r->resume = NULL;
    return status < 0 ? refuse(r, status, se3d_system_get_error(system)) : SE3D_OK;
}

void se3di_checkpoint_remove(const se3di_runner *r)
{
    char path[PATH_SIZE];
    if (join(r, path)) {
        se3di_file_remove(path);
    }
}
