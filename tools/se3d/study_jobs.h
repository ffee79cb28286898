/* SPDX-License-Identifier: BSD-3-Clause */
/* Samples of a study, run by one process or by several. */
#ifndef SE3D_TOOL_STUDY_JOBS_H
#define SE3D_TOOL_STUDY_JOBS_H

#include "se3d/study.h"

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
