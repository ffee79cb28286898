/* SPDX-License-Identifier: BSD-3-Clause */
/* A run: one analysis of one model, prepared again whenever the model's structure changes. */
#ifndef SE3DI_RUN_H
#define SE3DI_RUN_H

#include "analysis/events.h"
#include "analysis/kinds.h"
#include "analysis/start_change.h"
#include "integrator/integrator.h"

typedef struct se3di_run {
    se3di_model *model;
    se3di_error *error;
    int32_t analysis; /* se3d_analysis */
    const se3di_formulation *formulation;
    se3di_integration integration; /* dynamics */
    se3di_equations equations;
    size_t work_count;
    int32_t prepared;             /* the equations fit the model */
    int32_t determined;           /* kinematics: the drivers determine the motion (checked once) */
    int32_t automatic;            /* the method is chosen from what the model holds, */
    int32_t picks_formulation;    /* and so is the formulation */
    int32_t in_lanes;             /* auto: by gauss, single steps by dop853, with one memory */
    int32_t gravity_varies;       /* when the method was chosen */
    int32_t has_tolerance;        /* it was asked for */
    int32_t refused;              /* a prescribed value jumps in the run that is asked for */
    const se3di_integrator *left; /* the method that was left on the way, NULL: none */
    double left_at;               /* when [s] */
    se3di_watch watch;            /* what the events are told of the steps */
    se3di_events events;
    uint64_t values_version; /* of the prescribed values that the equations have */
    se3di_guard guard;       /* what ends a run before its time */
    double horizon;          /* runs go on to here [s] */
    se3di_saved before;      /* the state that the call under way began with, where */
    uint64_t before_version;
    int32_t has_before;       /* it was kept */
    int32_t shows_row;        /* it was not: the call shows what is within the last step */
    int32_t steps_once;       /* the call is one step */
    int32_t driven_twice;     /* some coordinate is */
    int32_t shows_motion;     /* runs may end without accelerations and multipliers */
    int32_t before_waits;     /* what it shows remains to be computed, see base/pending.h */
    se3di_start_change start; /* of the last start that the user gave */
    int32_t told_redundant;   /* the log was told of these equations, */
    int32_t told_left_out;    /* and that rows that are left out are off */
    se3di_step_list steps;    /* that others repeat (analysis/follow.h) */
    uint64_t followed_at;     /* factorisations there were when others followed this run, */
    double followed_time;     /* and where [s] (analysis/follow.h) */
    const se3di_integrator *told_reach;  /* the log was told what this method reaches, */
    const se3di_integrator *told_bodies; /* that it integrates bodies, not joint coordinates, */
    const se3di_integrator *told_step;   /* which step it takes if none is given, */
    const se3di_integrator *told_held;   /* that the motion is stiff, */
    const se3di_integrator *told_crowd;  /* that many bodies touch, */
    const se3di_integrator *told_shaken; /* and that it follows a vibration */
    uint64_t shaken_steps;               /* since vibrations were last looked for, */
    double shaken_time;                  /* and how long these took [s] */
} se3di_run;

/* Set up for an analysis; allocates nothing yet. `system`: for the callbacks of events. */
void se3di_run_init(se3di_run *run, se3di_model *model, se3di_error *error, se3d_system *system);
void se3di_run_destroy(se3di_run *run);

/* Build what a run builds before its first step. */
se3d_status se3di_run_prepare(se3di_run *run);
/* Go on by a method that `auto` came to before; prepared. @return OK, NO_MEMORY, UNSUPPORTED */
se3d_status se3di_run_take_method(se3di_run *run, const se3di_integrator *method);
/* Bring the model to t_end >= its time. @return OK or INFO_REDUNDANT, or an error with the model at
 * the last accepted state. */
se3d_status se3di_run_to(se3di_run *run, double t_end);
/* Whether t is the present time, to rounding. */
int se3di_run_is_now(const se3di_run *run, double t);
/* One step of length h > 0, to rounding: n steps come to n h. */
se3d_status se3di_run_step(se3di_run *run, double h);

/* By the method in use to t_end, nobody watching; what it shows there is as much as was asked
 * for. */
se3d_status se3di_run_show(se3di_run *run, double t_end);

/* The bare step of length h of the analysis' method, which nobody watches; on failure the old
 * state. */
se3d_status se3di_run_make_step(se3di_run *run, double h);

/* One kinematic step of length h: prediction, then the three levels; on failure the old state. */
se3d_status se3di_kinematics_step(se3di_equations *equations, double h);
/* Kinematics to t_end in steps of at most `step` (0: any), shortened if the motion is fast. */
se3d_status se3di_kinematics_run(se3di_equations *equations, double t_end, double step);

#endif
