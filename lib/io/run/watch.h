/* SPDX-License-Identifier: BSD-3-Clause */
/* A run whose rows go to a function, not to files. */
#ifndef SE3D_IO_WATCH_H
#define SE3D_IO_WATCH_H

#include "io/channel/output.h"
#include "io/model/model.h"
#include "se3d/modes.h"

typedef struct se3di_watch {
    const se3di_output_entry *output; /* channels of the rows, and how often */
    size_t analysis;                  /* index of that whose rows are wanted */
    /* Take a row: the time, then the numbers of the channels. @return OK, NO_MEMORY */
    se3d_status (*take)(void *ctx, const double *row);
    /* Told of the solver that has come to the state of a row, before it is taken; NULL: nobody. */
    se3d_status (*reach)(void *ctx, se3d_solver *solver, double time);
    /* Told of the solver of the last analysis before that one, modes left out, when it has ended;
     * NULL: nobody. */
    se3d_status (*settle)(void *ctx, se3d_solver *solver);
    se3d_event_callback event; /* of the events of that analysis; NULL: none */
    /* Take a mode of that analysis, the slowest first, from 0; NULL: none. */
    void (*mode)(void *ctx, size_t index, const se3d_eigenvalue *eigenvalue);
    /* Told of all modes of that analysis before they are taken; NULL: nobody. */
    se3d_status (*linearise)(void *ctx, const se3d_modes *modes);
    void *ctx; /* of all */
} se3di_watch;

/* Run the analyses of a model up to the one that is wanted, but for modes before it; nothing is
 * written.
 * @return as se3d_model_run; `error` (may be NULL) says why not. */
se3d_status se3di_model_watch(se3d_model *model, const se3di_watch *watch,
                              const se3d_run_options *options, se3d_model_error *error);

#endif
