/* SPDX-License-Identifier: BSD-3-Clause */
/* Processes that run samples, on POSIX systems. Sample n of the list is run by process n modulo
 * their number, which writes its row to a pipe; this one reads the pipes in turn, so that rows come
 * in the order of the list however many processes there are. */
#define _XOPEN_SOURCE 700

#include "study_jobs.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interrupt.h"

static const char no_memory[] = "out of memory";
static const char ended[] = "a process that ran samples has ended: --resume goes on";

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

typedef struct worker {
    pid_t id; /* 0: none */
    FILE *from;
    char *line;
    size_t size;
} worker;

/* What a process does: never returns. */
static void work(se3d_study *study, const sample_list *list, size_t first, size_t step, FILE *to)
{
    for (size_t k = first; k < list->count; k += step) {
        const char *row = "";
        const char *why = "";
        if (interrupt_came() || !run_one(study, list->samples[k], &row, &why) ||
            fputs(row, to) < 0 || fflush(to) != 0) {
            _exit(1);
        }
    }
    _exit(0);
}

static int start(worker *all, size_t index, size_t count, se3d_study *study,
                 const sample_list *list)
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
        work(study, list, index, count, to);
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
        free(all[k].line);
    }
}

static int collect(worker *all, size_t count, const sample_list *list, take_row take, void *ctx,
                   const char **why)
{
    for (size_t k = 0; k < list->count; ++k) {
        worker *w = &all[k % count];
        const ssize_t length = interrupt_came() ? -1 : getline(&w->line, &w->size, w->from);
        if (length <= 0 || w->line[length - 1] != '\n') {
            *why = interrupt_came() ? "" : ended;
            return 0;
        }
        if (!take(ctx, w->line)) {
            return 0;
        }
    }
    return 1;
}

int study_run_list(se3d_study *study, const sample_list *list, size_t jobs, take_row take,
                   void *ctx, const char **why)
{
    const size_t count = jobs < list->count ? jobs : list->count;
    *why = "";
    if (count <= 1) {
        return run_here(study, list, take, ctx, why);
    }
    worker *all = calloc(count, sizeof *all);
    int good = all != NULL;
    fflush(stdout);
    for (size_t k = 0; k < count && good; ++k) {
        good = start(all, k, count, study, list);
    }
    *why = good ? "" : "processes cannot be started";
    good = good && collect(all, count, list, take, ctx, why);
    if (all) {
        stop(all, count);
    }
    free(all);
    return good;
}
