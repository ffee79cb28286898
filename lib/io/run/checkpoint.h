/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints: a file beside the results with all that a program needs to go on with a run that was
 * ended, so that it leaves the same files. docs/long-runs.md */
#ifndef SE3D_IO_CHECKPOINT_H
#define SE3D_IO_CHECKPOINT_H

#include "io/run/runner.h"

/* The place that the analysis under way has come to. */
typedef struct se3di_place {
    double start;   /* of the analysis [s] */
    double reached; /* the last rows are of then [s] */
    double cpu;     /* spent on it so far [s] */
    int32_t last;   /* se3d_status of the last piece of the run */
} se3di_place;

/* Keep what the log is told from now on. @return false: out of memory */
bool se3di_checkpoint_listen(se3di_runner *runner);
void se3di_checkpoint_ignore(se3di_runner *runner);
/* Write one. What fails is told to the log; the checkpoint before stays. */
void se3di_checkpoint_write(se3di_runner *runner, const se3di_place *place);

/* Look for one and read it: runner->resume, NULL if there is none.
 * @return OK, IO, NO_MEMORY, STATE (damaged, or of something else), with the error. */
se3d_status se3di_checkpoint_open(se3di_runner *runner);
/* The marks of output k, and of the events' file. */
const se3di_csv_mark *se3di_checkpoint_get_mark(const se3di_runner *runner, size_t k);
const se3di_csv_mark *se3di_checkpoint_get_events(const se3di_runner *runner);
/* What was done before the analysis that is gone on with; the files are open.
 * @return OK, or as se3di_checkpoint_open */
se3d_status se3di_checkpoint_take(se3di_runner *runner);
/* Rows to come, the state of the system and of the new solver; then runner->resume is NULL. */
se3d_status se3di_checkpoint_restore(se3di_runner *runner, se3di_place *place);
/* The time at which the analysis to go on with began. */
double se3di_checkpoint_get_start(const se3di_runner *runner);
/* Take the file away. */
void se3di_checkpoint_remove(const se3di_runner *runner);

#endif
