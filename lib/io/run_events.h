/* SPDX-License-Identifier: BSD-3-Clause */
/* The events of a run of a model: put on its solvers, collected, written to a file. */
#ifndef SE3D_IO_RUN_EVENTS_H
#define SE3D_IO_RUN_EVENTS_H

#include "io/csv.h"
#include "io/model.h"

extern const char se3di_events_file[]; /* "events.csv" */

typedef struct se3di_event_list {
    se3d_run_event *list;
    size_t count, capacity;
    se3di_csv csv;
    bool is_open;
} se3di_event_list;

/* The model's events on a solver, whose analysis has a motion. */
se3d_status se3di_events_create(const se3d_model *model, se3d_solver *solver);
/* Open the file: as se3di_csv_open. */
se3d_status se3di_event_list_open(se3di_event_list *events, se3di_iopool *pool, const char *path);
/* What is on the solver's record, to the list and the file. @return OK, NO_MEMORY */
se3d_status se3di_event_list_collect(se3di_event_list *events, se3di_iopool *pool,
                                     const se3d_model *model, se3d_solver *solver, size_t analysis);

#endif
