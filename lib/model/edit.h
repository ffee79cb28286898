/* SPDX-License-Identifier: BSD-3-Clause */
/* Edits of a model, one file for each kind of element. Adding reserves first: nothing below the
 * reservation can fail. Removing closes gaps and lowers the indices behind them. */
#ifndef SE3D_MODEL_EDIT_H
#define SE3D_MODEL_EDIT_H

#include "model/model.h"

/* Grow one typed array of the model. */
#define SE3DI_RESERVE(model, array, capacity, needed, size)                                        \
    do {                                                                                           \
        void *reserve_data = (model)->array;                                                       \
        se3d_status reserve_status = se3di_array_reserve(&(model)->allocator, &reserve_data,       \
                                                         &(model)->capacity, (needed), (size));    \
        (model)->array = reserve_data;                                                             \
        if (reserve_status < 0) {                                                                  \
            return reserve_status;                                                                 \
        }                                                                                          \
    } while (0)

/* Close the gap of `removed` elements at `first` in an array of `count`. */
void se3di_array_close_gap(void *array, size_t count, size_t first, size_t removed, size_t size);

/* A copy of a name, and room for it among those of its kind. */
se3d_status se3di_model_copy_name(se3di_model *model, se3di_slots *slots, const char *name,
                                  char **copy);
/* The object behind the last one, whose name (or NULL) is such a copy. */
se3di_handle se3di_model_add_named(se3di_slots *slots, uint32_t owner, const char *name);
/* Take the object `dense` out, and its name. */
void se3di_model_remove_named(se3di_model *model, se3di_slots *slots, uint32_t dense,
                              uint32_t owner, char *name);

/* Take a turn counter out. */
void se3di_model_remove_angle(se3di_model *model, uint32_t angle);

/* Leave the rows of a constraint out, or not. */
void se3di_constraint_leave_out(se3di_model *model, const se3di_constraint *constraint, int broken);

/* Whether a function has a signal of the element whose index is at `offset` in signals. */
int se3di_model_is_signalled(const se3di_model *model, size_t offset, uint32_t element);
/* One of these elements was removed. */
void se3di_model_lower_signals(se3di_model *model, size_t offset, uint32_t removed);

/* An index, -1: none, once the element `removed` is gone. */
static inline void se3di_index_lower(uint32_t *index, uint32_t removed)
{
    *index -= *index > removed;
}

static inline void se3di_index_lower_signed(int32_t *index, uint32_t removed)
{
    *index -= *index >= 0 && (uint32_t)*index > removed;
}

#endif
