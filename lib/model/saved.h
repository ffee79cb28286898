/* SPDX-License-Identifier: BSD-3-Clause */
/* A copy of all that a step reads and writes, an integrator's history included, without particle
 * sets: snapshots, and what the search for events comes back to. Filling it again allocates only
 * if the model has grown. */
#ifndef SE3DI_MODEL_SAVED_H
#define SE3DI_MODEL_SAVED_H

#include "model/model.h"

typedef struct se3di_saved_array {
    void *data;
    size_t count, capacity;
} se3di_saved_array;

typedef struct se3di_saved {
    double time, time_rest, rest_time;
    double work[3], power[3];
    double contact_step, contact_time;
    uint64_t history_tag;
    int64_t history_redundant;
    uint64_t history_inputs, history_values;
    uint64_t history_stamp; /* of the model when the history was copied */
    int32_t settled;
    int32_t work_valid;
    int32_t ranks_known;
    uint32_t left_out_count, left_out_row;
    int32_t shows_before;
    double left_out_gap;
    se3di_saved_array frames;       /* se3di_frame */
    se3di_saved_array acceleration; /* [bodies * 6] */
    se3di_saved_array lambda;       /* [rows] */
    se3di_saved_array turns;        /* [angles] */
    se3di_saved_array memory;       /* [forces * SE3DI_FORCE_STATES] */
    se3di_saved_array history;      /* none if nobody wrote it */
    se3di_saved_array contacts;     /* se3di_body_contact */
    se3di_saved_array wrench;       /* [shapes * 6] */
    se3di_saved_array left_out;     /* [rows] uint8_t, none if no row is */
} se3di_saved;

/* Copy the model's state; `saved` is zero or has been filled before with the same allocator.
 * @return OK, NO_MEMORY (what it holds is then undefined) */
se3d_status se3di_saved_fill(se3di_saved *saved, const se3di_model *model,
                             const se3d_allocator *allocator);
/* The same; a history that was copied before and has not gone on since is not copied again, but for
 * what its interpolation is made of. `saved` is the caller's own, of this model alone. */
se3d_status se3di_saved_refill(se3di_saved *saved, const se3di_model *model,
                               const se3d_allocator *allocator);
/* The state is that of a model with as many bodies, rows, angles, forces and shapes. */
int se3di_saved_fits(const se3di_saved *saved, const se3di_model *model);
/* Make room in the model, so that se3di_saved_restore cannot fail. @return OK, NO_MEMORY */
se3d_status se3di_saved_reserve(const se3di_saved *saved, se3di_model *model);
/* Put the state back into a model that it fits, which is the one it came from or has room. */
void se3di_saved_restore(const se3di_saved *saved, se3di_model *model);
void se3di_saved_destroy(se3di_saved *saved, const se3d_allocator *allocator);

#endif
