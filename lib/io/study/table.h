/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of samples: their lines in memory. */
#ifndef SE3D_IO_STUDY_TABLE_H
#define SE3D_IO_STUDY_TABLE_H

#include <stdio.h>

#include "io/study/study.h"

/* One line of a table. */
typedef struct se3di_study_line {
    const char *text;
    size_t length; /* with the line break */
    uint64_t sample;
    bool failed;
} se3di_study_line;

/* Read all of an open file; a zero follows. @return OK, IO, NO_MEMORY. */
se3d_status se3di_study_load(FILE *file, se3di_iopool *pool, char **text, size_t *length);
/* Whether a text begins as tables of the study do; *begin: where its rows are. If not, *problem
 * says what is different. */
bool se3di_study_check_head(const se3d_study *study, const char *text, const char **begin,
                            uint32_t *shard, uint32_t *shards, const char **problem);
/* Cut the line at *at, which must be one of this study. @return false at the end, or at what is no
 * whole line: *at is there then, and *problem says what is wrong but for a line without its end. */
bool se3di_study_next_line(const se3d_study *study, const char **at, const char *end,
                           se3di_study_line *line, const char **problem);

#endif
