/* SPDX-License-Identifier: BSD-3-Clause */
/* Samples and other tasks of a study, done by one process or by several. */
#ifndef SE3D_TOOL_STUDY_JOBS_H
#define SE3D_TOOL_STUDY_JOBS_H

#include <stdio.h>

#include "se3d/study.h"

/* Tasks that do not depend on each other. */
typedef struct study_tasks {
    size_t count;
    /* Do a task in a process of its own and write what came out. @return false: nothing did */
    int (*work)(void *ctx, size_t index, FILE *to);
    /* Read what came out, in the order of the tasks. @return false: it is not there, or no more is
     * wanted */
    int (*take)(void *ctx, size_t index, FILE *from);
    void *ctx; /* of both; what `work` changes is seen by its process alone */
} study_tasks;

/* Do them with at most `jobs` processes beside this one. @return false: not all were done; *why
 * says why not, "" if the user or `take` has ended it. */
int study_run_tasks(const study_tasks *tasks, size_t jobs, const char **why);

/* Samples that are to be run, in this order. */
typedef struct sample_list {
    uint64_t *samples;
    size_t count;
} sample_list;

/* Called with the row of each sample, in their order. @return false: no more. */
typedef int (*take_row)(void *ctx, const char *row);

/* Run them all with `jobs` processes. @return false: not all were run; *why says why not, "" if the
 * user or `take` has ended it. */
int study_run_list(se3d_study *study, const sample_list *list, size_t jobs, take_row take,
                   void *ctx, const char **why);

#endif
