/* SPDX-License-Identifier: BSD-3-Clause */
/* Many states of one tree of joints, stepped and asked in groups of as many as the lanes of a
 * register are (tree/lanes.h), the groups shared by threads. All numbers of a group lie together:
 * q [positions][width], then qdot [velocities][width], and so on. Steps allocate nothing.
 * docs/theory/lanes.md */
#ifndef SE3DI_ANALYSIS_BATCH_H
#define SE3DI_ANALYSIS_BATCH_H

#include "integrator/explicit_rk.h"
#include "tree/lanes.h"
#include "tree/loops.h"

#define SE3DI_BATCH_STAGES 12 /* of a step, the most */

/* What a thread works with. */
typedef struct se3di_batch_worker {
    se3di_model model; /* a copy, if something but gravity acts */
    int32_t has_model, reserved;
    se3di_lanes lanes;
    double *memory; /* what follows, as allocated */
    size_t memory_count;
    double *y;           /* state of a stage [positions + velocities][width] */
    double *end;         /* that at the end of a step */
    double *rates;       /* y' of the stages [SE3DI_BATCH_STAGES] */
    double *effort;      /* [velocities][width] */
    double *acting;      /* [velocities][width] efforts and what follows laws */
    double *verdict;     /* [width] 1, or not a number */
    double *rows;        /* work of the loops */
    double *scalars;     /* [6 bodies]: a wrench */
    se3di_frame *frames; /* [width][bodies] */
    se3di_angle *angles; /* [width][angles of the model] */
} se3di_batch_worker;

typedef struct se3di_batch {
    se3di_model *model;
    se3di_error *error;
    se3di_tree tree;
    int32_t has_loops, has_assembly; /* then these are there: */
    se3di_assembly assembly;
    se3di_tree_loops loops;
    se3di_lane_loops lane_loops;
    const se3di_lane_core *core;
    size_t count, groups; /* states */
    int32_t is_in_lanes;  /* all that acts is gravity that does not change, and what follows: */
    int32_t reserved;
    se3di_lane_spring *springs; /* [forces] as the model's; used: */
    se3di_lane_load *loads;     /* the same */
    se3di_lane_law *laws;       /* the same */
    size_t spring_count, load_count, law_count;
    int32_t worker_count;
    se3di_batch_worker *workers;
    double *memory; /* what follows, as allocated */
    size_t memory_count;
    double *states;                    /* [groups][positions + velocities][width] */
    double *efforts;                   /* [groups][velocities][width] */
    double *gravity;                   /* [groups][3][width] */
    double *time;                      /* [groups][width] */
    double *inertias, *inertia_memory; /* [groups][nodes][7][width]; NULL: the model's */
    int32_t *status;                   /* [groups * width] se3d_status */
} se3di_batch;

/* What a state of a batch may be made of. */
typedef struct se3di_batch_part {
    double *numbers; /* of all groups */
    size_t size;     /* numbers of one state */
    size_t offset;   /* of them, where they begin */
    size_t whole;    /* numbers of one state between groups */
} se3di_batch_part;

/* `count` states equal to the model's, which stays the batch's own; on failure nothing is held.
 * @return OK, NO_MEMORY, UNSUPPORTED with a message: elements that need more than a tree */
se3d_status se3di_batch_init(se3di_batch *batch, se3di_model *model, size_t count, int32_t threads,
                             se3di_error *error);
void se3di_batch_destroy(se3di_batch *batch);

/* Find out what acts on the states, and whether lanes can compute it: springs, loads and laws.
 * @return OK, NO_MEMORY */
se3d_status se3di_batch_take_forces(se3di_batch *batch);
void se3di_batch_drop_forces(se3di_batch *batch);

/* All states have q (and so on) in `values` [count][part.size]; from state `first`. */
void se3di_batch_write(const se3di_batch *batch, const se3di_batch_part *part, size_t first,
                       size_t count, const double *values);
void se3di_batch_read(const se3di_batch *batch, const se3di_batch_part *part, size_t first,
                      size_t count, double *values);
se3di_batch_part se3di_batch_positions(const se3di_batch *batch);
se3di_batch_part se3di_batch_velocities(const se3di_batch *batch);
se3di_batch_part se3di_batch_efforts(const se3di_batch *batch);
se3di_batch_part se3di_batch_gravity(const se3di_batch *batch);
se3di_batch_part se3di_batch_time(const se3di_batch *batch);

/* Unit quaternions in the states that were written. */
void se3di_batch_normalise(const se3di_batch *batch, size_t first, size_t count);
/* With loops: move the states that were written onto them. Those that are too far off fail. */
void se3di_batch_settle(se3di_batch *batch, size_t first, size_t count);
/* The states go on from what was written. */
void se3di_batch_revive(const se3di_batch *batch, size_t first, size_t count);

/* Masses and moments of inertia of a body's own in states from `first`: mass [count], J [count][6].
 * @return OK, NO_MEMORY */
se3d_status se3di_batch_set_inertia(se3di_batch *batch, uint32_t body, size_t first, size_t count,
                                    const double *mass, const double *J);

/* `steps` steps of length h by an explicit method of at most SE3DI_BATCH_STAGES stages. States that
 * fail keep what they were before the step and have a status; the others go on. */
void se3di_batch_step(se3di_batch *batch, const se3di_rk_tableau *tableau, double h,
                      uint64_t steps);

/* Accelerations of all states [count][velocities]; of those that fail: zero, with a status. */
void se3di_batch_accelerate(se3di_batch *batch, double *qddot);
/* Efforts that give accelerations [count][velocities] (NULL: zero). */
void se3di_batch_find_efforts(se3di_batch *batch, const double *qddot, double *effort);

/* The first state that has failed; count: none has. */
size_t se3di_batch_find_failed(const se3di_batch *batch);

#endif
