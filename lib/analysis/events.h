/* SPDX-License-Identifier: BSD-3-Clause */
/* Events of a run: crossings of levels, found in every step, located, recorded.
 *
 * A step is looked at in one of two ways. Methods with dense output (integrator `advance`) make
 * their step ahead of the model's time and are asked for states within it. All others, and time
 * driven analyses, are watched: from the state at the beginning of an accepted step a shorter one
 * leads to any time within it, and the state at its end is put back. Neither changes the motion.
 * docs/theory/events.md */
#ifndef SE3DI_EVENTS_H
#define SE3DI_EVENTS_H

#include "analysis/crossing.h"
#include "integrator/integrator.h"
#include "model/saved.h"
#include "se3d/event.h"

struct se3di_run;

typedef struct se3di_event {
    char *name;
    se3d_event_value value;
    void *ctx;
    se3d_event_callback callback;
    void *callback_ctx;
    double level;
    double hysteresis;
    int32_t direction, action; /* se3d_event_direction, se3d_event_action */
    int32_t motion_only;
    int32_t side;   /* where the last step ended near the level: the side it came from, 0: none */
    uint32_t joint; /* 1 + the constraint that breaks there; 0: the user's event */
    uint32_t reserved;
} se3di_event;

/* A crossing in the step that was looked at last. */
typedef struct se3di_event_hit {
    double time;
    uint32_t event; /* dense */
    int32_t direction;
} se3di_event_hit;

typedef struct se3di_events {
    struct se3di_run *run;
    se3d_system *system; /* for callbacks */
    se3di_slots slots;
    se3di_event *list; /* the user's, and behind them those of joints that may break */
    size_t capacity;
    size_t break_count;         /* of the latter, */
    uint64_t break_versions[3]; /* as they were at these versions of the model */
    char **names;               /* of joints in records, kept as long as these */
    size_t name_count, name_capacity;
    se3d_event_record *records;
    size_t record_count, record_capacity;

    se3di_event_hit *hits; /* in order of time */
    size_t hit_count, hit_capacity;
    double t[SE3DI_CROSSING_NODES]; /* nodes of the step */
    double *g;                      /* values at them [events * NODES] */
    size_t g_capacity;
    double *y; /* an interpolated state */
    size_t y_capacity;
    se3di_saved from, to; /* a watched step */
    int32_t node_count;
    int32_t dense;        /* the step is one of dense output */
    uint32_t looking_for; /* dense index of the event whose crossing is being located */
    int32_t goes_on;      /* a callback changed the state: the run goes on from there */
    int32_t looked;       /* the hits are those of the step that ends at looked_time */
    int32_t reserved;
    double reached;        /* to where, at the end of a step, the run has been looked at [s] */
    double looked_time;    /* the end of the last step that was looked at, */
    uint64_t looked_stamp; /* in this history */
} se3di_events;

void se3di_events_init(se3di_events *events, struct se3di_run *run, se3d_system *system,
                       uint32_t salt);
void se3di_events_destroy(se3di_events *events);

/* Events by dense index. The name is copied. @return OK, NO_MEMORY (then nothing has changed) */
se3d_status se3di_events_add(se3di_events *events, const char *name, const se3di_event *event,
                             se3di_handle *handle);
void se3di_events_remove(se3di_events *events, uint32_t event);

/* The user's, and those of joints that may break. */
static inline uint32_t se3di_events_count(const se3di_events *events)
{
    return (uint32_t)(events->slots.count + events->break_count);
}

/* Forget all records. */
void se3di_events_clear(se3di_events *events);
/* @return OK, NO_MEMORY */
se3d_status se3di_events_add_record(se3di_events *events, const se3d_event_record *record);
/* Before a run: room for what a step needs. @return OK, NO_MEMORY */
se3d_status se3di_events_prepare(se3di_events *events);
/* Steps of a method with dense output to t_end. @return OK, INFO_EVENT (the model is at the event),
 * or an error as from the method's run. */
se3d_status se3di_events_run(se3di_events *events, double t_end);
/* The model goes on from its present state under other loads; the history was of `stamp`. */
void se3di_events_renew(se3di_events *events, uint64_t stamp);
/* The run has come back to t: what happened later has not. */
void se3di_events_forget(se3di_events *events, double t);
/* Around a watched step, see se3di_watch. */
se3d_status se3di_events_begin_step(void *events);
se3d_status se3di_events_end_step(void *events);

#endif
