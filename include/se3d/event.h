/* SPDX-License-Identifier: BSD-3-Clause */
/* Events: where a quantity crosses a level during a run of a solver. docs/theory/events.md
 *
 * Threads: the rule of se3d/se3d.h; what needs a solver for itself needs its system, too. */
#ifndef SE3D_EVENT_H
#define SE3D_EVENT_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Which crossings count: from below the level to it (or beyond), from above, or both.
 * @since 0.1 */
typedef enum se3d_event_direction {
    SE3D_EVENT_FALLING = -1,
    SE3D_EVENT_ANY = 0,
    SE3D_EVENT_RISING = 1
} se3d_event_direction;

/* The effect of an event on the run. @since 0.1 */
typedef enum se3d_event_action {
    SE3D_EVENT_RECORD = 0, /* note it and go on: the motion is the same as without */
    SE3D_EVENT_STOP = 1    /* the run ends there with SE3D_INFO_EVENT */
} se3d_event_action;

/* Compute the quantity at the system's present state, of which it may read everything and set
 * nothing; it must be continuous in time.
 * @return OK, or < 0: the run fails with CALLBACK. @since 0.1 */
typedef se3d_status (*se3d_event_value)(void *ctx, const se3d_system *system, double *value);

/* An event that happened. The state of the system was then consistent: constraints, accelerations
 * and multipliers are those of `time`. @since 0.1 */
typedef struct se3d_event_record {
    double time;           /* [s] */
    double value;          /* of the quantity [its unit]: the level, to rounding, or just beyond */
    const char *name;      /* of the event, "" for none; owned by the event */
    se3d_event event;      /* which one */
    int32_t direction;     /* RISING or FALLING */
    int32_t action;        /* STOP if the run ended with it */
    se3d_constraint joint; /* a joint that broke (se3d_joint_set_break), `name` is its name and
                              `value` the part of its limit, `event` is null; null: an event */
} se3d_event_record;

/* Called at every event with the system in its state there. It may read everything, copy the system
 * (se3d_system_clone, se3d_snapshot_create), and set values and the state: every se3d_..._set_...;
 * the run then goes on from what it left. What creates, destroys, restores, steps or runs anything
 * of the system is refused with STATE: let the event stop the run, edit, and run on.
 * @return OK: go on as the event's action says; SE3D_INFO_EVENT: stop the run; < 0: the run fails
 * with CALLBACK. @since 0.1 */
typedef se3d_status (*se3d_event_callback)(void *ctx, se3d_system *system,
                                           const se3d_event_record *record);

/* The definition of an event. @since 0.1 */
typedef struct se3d_event_def {
    size_t struct_size;
    const char *name;             /* copied; NULL: none */
    se3d_event_value value;       /* required */
    void *ctx;                    /* of `value` */
    se3d_event_callback callback; /* NULL: none */
    void *callback_ctx;           /* of `callback` */
    double level;        /* the crossing that is looked for, in the unit of the value; default 0 */
    int32_t direction;   /* se3d_event_direction, default ANY */
    int32_t action;      /* se3d_event_action, default RECORD */
    int32_t motion_only; /* not 0: the value follows from time, positions and velocities alone
                            (not from accelerations, reactions or forces): cheaper to look for */
    int32_t reserved;    /* 0 */
    double hysteresis;   /* >= 0, in the unit of the value: it has to have been further than this
                            from the level, on the side it comes from, since it last crossed it;
                            default 0: further than the level's own rounding */
} se3d_event_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_event_def_default. @since 0.1 */
SE3D_API void se3d_event_def_init(se3d_event_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_event_def se3d_event_def_default(void)
{
    se3d_event_def def;
    se3d_event_def_init(&def, sizeof def);
    return def;
}

/* Add an event to a solver of dynamics, kinematics or inverse dynamics. From then on crossings
 * are looked for in every step, also several in one step, and located to the rounding of time. A
 * value that is at the level (within `hysteresis`) when a run begins has not crossed it. A
 * system with particle sets cannot be moved back: its run stops at the end of the step that
 * holds the event. @return OK, NULL, STATE (the system is gone), INVALID_ARGUMENT, UNSUPPORTED
 * (the analysis has no motion), NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_event_create(se3d_solver *solver, const se3d_event_def *def,
                                       se3d_event *out);

/* Remove an event and its records. @return OK, NULL, STATE (the system is gone), STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_event_destroy(se3d_solver *solver, se3d_event event);

/* Get the name of an event.
 * @param[out] name  "" if it has none; owned by the event
 * @return OK, NULL, STATE (the system is gone), STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_event_get_name(se3d_solver *solver, se3d_event event, const char **name);

/* Get the definition of an event. Set def->struct_size before the call.
 * @param[out] def  its name (NULL: none) is owned by the event
 * @return OK, NULL, STATE (the system is gone), STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_event_get_def(se3d_solver *solver, se3d_event event, se3d_event_def *def);

/* Count the events that a solver looks for. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_solver_count_events(const se3d_solver *solver);

/* Get an event of a solver, in the order of creation.
 * @param[in] index  from 0, below se3d_solver_count_events
 * @return OK, NULL, STATE (the system is gone), INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_solver_get_event(const se3d_solver *solver, size_t index,
                                           se3d_event *event);

/* Count the events that happened, in the order in which they did. @return the number; 0 for
 * NULL. @since 0.1 */
SE3D_API size_t se3d_solver_count_event_records(const se3d_solver *solver);

/* As se3d_solver_get_event_record, told the size of *record in bytes. @return as
 * se3d_solver_get_event_record, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_solver_get_event_record_sized(se3d_solver *solver, size_t index,
                                                        se3d_event_record *record, size_t size);

/* Get an event that happened.
 * @param[in] index  from 0, below se3d_solver_count_event_records
 * @return OK, NULL, STATE (the system is gone), INVALID_ARGUMENT (index).
 * @since 0.1 */
static inline se3d_status se3d_solver_get_event_record(se3d_solver *solver, size_t index,
                                                       se3d_event_record *record)
{
    return se3d_solver_get_event_record_sized(solver, index, record, sizeof *record);
}

/* Forget the events that happened. @return OK, NULL, STATE (the system is gone). @since 0.1 */
SE3D_API se3d_status se3d_solver_clear_event_records(se3d_solver *solver);

#ifdef __cplusplus
}
#endif
#endif
