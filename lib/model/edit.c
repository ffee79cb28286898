/* SPDX-License-Identifier: BSD-3-Clause */
/* What all edits of a model share: names, gaps in arrays, turn counters. */
#include "model/edit.h"

#include <string.h>

void se3di_array_close_gap(void *array, size_t count, size_t first, size_t removed, size_t size)
{
    char *bytes = array;
    if (removed > 0 && first + removed < count) {
        memmove(bytes + first * size, bytes + (first + removed) * size,
                (count - first - removed) * size);
    }
}

se3d_status se3di_model_copy_name(se3di_model *model, se3di_slots *slots, const char *name,
                                  char **copy)
{
    *copy = NULL;
    if (name) {
        SE3DI_TRY(se3di_names_reserve(&slots->names, &model->allocator, slots->names.count + 1));
        *copy = se3di_text_copy(&model->allocator, name);
        return *copy ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    }
    return SE3D_OK;
}

se3di_handle se3di_model_add_named(se3di_slots *slots, uint32_t owner, const char *name)
{
    const se3di_handle handle = se3di_slots_add(slots);
    if (name) {
        se3di_slots_name(slots, (uint32_t)slots->count - 1, owner, name);
    }
    return handle;
}

uint32_t se3di_model_find_replaced(const se3di_model *model, const se3di_slots *slots,
                                   uint32_t owner, const char *name)
{
    if (model->target > 0) {
        return model->target - 1;
    }
    return model->replaces && name ? se3di_slots_find_name(slots, owner, name) : SE3DI_NO_INDEX;
}

void se3di_model_remove_named(se3di_model *model, se3di_slots *slots, uint32_t dense,
                              uint32_t owner, char *name)
{
    if (name) {
        se3di_names_remove(&slots->names, owner, name);
        se3di_text_free(&model->allocator, name);
    }
    se3di_slots_remove(slots, dense);
}

void se3di_model_remove_angle(se3di_model *model, uint32_t angle)
{
    se3di_array_close_gap(model->angles, model->angle_count--, angle, 1, sizeof *model->angles);
    for (size_t k = 0; k < model->term_count; ++k) {
        se3di_index_lower_signed(&model->terms[k].angle, angle);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        se3di_index_lower_signed(&model->constraints[k].angle, angle);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        se3di_index_lower_signed(&model->forces[k].angle, angle);
    }
}
