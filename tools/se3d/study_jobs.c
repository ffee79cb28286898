/* SPDX-License-Identifier: BSD-3-Clause */
/* Processes that do tasks, on POSIX systems. Task n is done by process n modulo their number, which
 * writes what came out to a pipe; this one reads the pipes in turn, so that all comes in the order
 * of the tasks however many processes there are. */
#define _XOPEN_SOURCE 700

#include "study_jobs.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interrupt.h"

static const char no_memory[] = "out of memory";
static const char ended[] = "a process that ran the model has ended";
static const char torn[] = "a process that ran samples has ended: --resume goes on";

/* ---- tasks -----------------------------------------------------------------------------------*/

typedef struct worker {
    pid_t id; /* 0: none */
    FILE *from;
} worker;

/* What a process does: never returns. */
static void work(const study_tasks *tasks, size_t first, size_t step, FILE *to)
{
    for (size_t k = first; k < tasks->count; k += step) {
        if (interrupt_came() || !tasks->work(tasks->ctx, k, to) || fflush(to) != 0) {
            _exit(1);
        }
    }
    _exit(0);
}

static int start(worker *all, size_t index, size_t count, const study_tasks *tasks)
{
    int ends[2];
    if (pipe(ends) != 0) {
        return 0;
    }
    worker *w = &all[index];
    w->id = fork();
    if (w->id == 0) {
        FILE *to = fdopen(ends[1], "w");
        close(ends[0]);
        for (size_t k = 0; k < index; ++k) { /* of the others, so that they see their end */
            close(fileno(all[k].from));
        }
        if (!to) {
            _exit(1);
        }
        work(tasks, index, count, to);
    }
    close(ends[1]);
    w->from = w->id > 0 ? fdopen(ends[0], "r") : NULL;
    if (!w->from) {
        close(ends[0]);
    }
    return w->from != NULL;
}

static void stop(worker *all, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (all[k].id > 0) {
            kill(all[k].id, SIGTERM);
        }
        if (all[k].from) {
            fclose(all[k].from);
        }
    }
    for (size_t k = 0; k < count; ++k) {
        if (all[k].id > 0) {
            waitpid(all[k].id, NULL, 0);
        }
    }
}

static int collect(worker *all, size_t count, const study_tasks *tasks, const char **why)
{
    for (size_t k = 0; k < tasks->count; ++k) {
        FILE *from = all[k % count].from;
        if (interrupt_came() || !tasks->take(tasks->ctx, k, from)) {
            *why = interrupt_came() || !(feof(from) || ferror(from)) ? "" : ended;
            return 0;
        }
    }
    return 1;
}

int study_run_tasks(const study_tasks *tasks, size_t jobs, const char **why)
{
    const size_t count = jobs < tasks->count ? jobs : tasks->count;
    worker *all = calloc(count + 1, sizeof *all);
    int good = all != NULL;
    fflush(stdout);
    for (size_t k = 0; k < count && good; ++k) {
        good = start(all, k, count, tasks);
    }
    *why = good ? "" : "processes cannot be started";
    good = good && collect(all, count, tasks, why);
    if (all) {
        stop(all, count);
    }
    free(all);
    return good;
}

/* ---- samples ---------------------------------------------------------------------------------*/

typedef struct sampling {
    se3d_study *study;
    const sample_list *list;
    take_row take;
    void *ctx;
    char *line;
    size_t size;
} sampling;

/* The row of one sample. */
static int run_one(se3d_study *study, uint64_t sample, const char **row, const char **why)
{
    const se3d_status status = se3d_study_run_sample(study, sample, row);
    *why = status == SE3D_ERR_NO_MEMORY ? no_memory : "";
    return status != SE3D_ERR_NO_MEMORY && status != SE3D_ERR_INTERRUPTED;
}

static int run_here(se3d_study *study, const sample_list *list, take_row take, void *ctx,
                    const char **why)
{
    for (size_t k = 0; k < list->count; ++k) {
        const char *row = "";
        if (interrupt_came() || !run_one(study, list->samples[k], &row, why) || !take(ctx, row)) {
            return 0;
        }
    }
    return 1;
}

static int work_sample(void *ctx, size_t index, FILE *to)
{
    const sampling *s = ctx;
    const char *row = "";
    const char *why = "";
    return run_one(s->study, s->list->samples[index], &row, &why) && fputs(row, to) >= 0;
}

static int take_sample(void *ctx, size_t index, FILE *from)
{
    sampling *s = ctx;
    (void)index;
    const ssize_t length = getline(&s->line, &s->size, from);
    return length > 0 && s->line[length - 1] == '\n' && s->take(s->ctx, s->line);
}

int study_run_list(se3d_study *study, const sample_list *list, size_t jobs, take_row take,
                   void *ctx, const char **why)
{
    sampling s = {.study = study, .list = list, .take = take, .ctx = ctx};
    const study_tasks tasks = {list->count, work_sample, take_sample, &s};
    *why = "";
    if (jobs <= 1 || list->count <= 1) {
        return run_here(study, list, take, ctx, why);
    }
    const int good = study_run_tasks(&tasks, jobs, why);
    *why = *why == ended ? torn : *why;
    free(s.line);
    return good;
}
