/* SPDX-License-Identifier: BSD-3-Clause */
/* Events of a model: numbers of channels that cross levels. */
#ifndef SE3D_IO_EVENT_H
#define SE3D_IO_EVENT_H

#include "io/channel/channel.h"
#include "io/model/model.h"

extern const char se3di_events_file[]; /* "events.csv" */

/* What an event looks at: a number of a channel. */
typedef struct se3di_event_source {
    se3di_channel channel;
    size_t component;
    const se3d_model *model;
} se3di_event_source;

typedef struct se3di_event_entry {
    const char *name;
    const char *channel; /* with its component */
    se3di_event_source source;
    double level;
    double hysteresis; /* 0: chosen for the channel */
    int32_t direction; /* se3d_event_direction */
    int32_t action;    /* se3d_event_action */
} se3di_event_entry;

/* Find what an event looks at, unless source->channel is an expression that has been read. If it
 * cannot, `problem` gets what is allowed. */
bool se3di_event_source_find(se3d_model *model, const char *channel, se3di_event_source *source,
                             char *problem, size_t size);
/* The model's events on a solver, whose analysis has a motion. `callback` (NULL: none) is called at
 * each that happens. */
se3d_status se3di_events_create(const se3d_model *model, se3d_solver *solver,
                                se3d_event_callback callback, void *ctx);

#endif
