/* SPDX-License-Identifier: BSD-3-Clause */
/* The events of a run of a model: put on its solvers, collected, written to a file. */
#ifndef SE3D_IO_RUN_EVENTS_H
#define SE3D_IO_RUN_EVENTS_H

#include "io/model/model.h"
#include "io/write/csv.h"

typedef struct se3di_event_list {
    se3d_run_event *list;
    size_t count, capacity;
    size_t collected; /* of the records of the present solver */
    se3di_csv csv;
    bool is_open;
} se3di_event_list;

/* Something moves, and events are looked for or joints may break. */
bool se3di_event_list_is_wanted(const se3d_model *model);
/* Open the file: as se3di_csv_open, or, with a mark, se3di_csv_continue. */
se3d_status se3di_event_list_open(se3di_event_list *events, se3di_iopool *pool, const char *path,
                                  const se3di_csv_mark *mark);
/* What is new on the solver's record, to the list and the file. @return OK, NO_MEMORY */
se3d_status se3di_event_list_collect(se3di_event_list *events, se3di_iopool *pool,
                                     const se3d_model *model, se3d_solver *solver, size_t analysis);

/* What an event of a run is: an event of the model, or behind them an element, a joint that broke.
 * The one of this name, which is there. */
size_t se3di_run_event_count_kinds(const se3d_model *model);
size_t se3di_run_event_find_kind(const se3d_model *model, const char *name, bool broke);
void se3di_run_event_set_kind(const se3d_model *model, size_t kind, se3d_run_event *event);

#endif
