/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding and removing functions, and the signals that they have of elements. */
#include "model/edit.h"
#include "model/function.h"

#include <string.h>

/* Count (+1) or discount (-1) the elements that the signals of a function are of. */
static void count_signal_users(se3di_model *model, const se3di_function *function, uint32_t by)
{
    for (uint32_t k = 0; k < function->signal_count; ++k) {
        const se3di_signal *s = &function->signals[k];
        model->bodies[s->body].users += by;
        if (s->joint != SE3DI_NO_INDEX) {
            model->constraints[s->joint].users += by;
        }
        if (s->force != SE3DI_NO_INDEX) {
            model->forces[s->force].users += by;
        }
    }
}

int se3di_model_is_signalled(const se3di_model *model, size_t offset, uint32_t element)
{
    for (size_t k = 0; k < model->function_slots.count; ++k) {
        for (uint32_t s = 0; s < model->functions[k].signal_count; ++s) {
            uint32_t index;
            memcpy(&index, (const char *)&model->functions[k].signals[s] + offset, sizeof index);
            if (index == element) {
                return 1;
            }
        }
    }
    return 0;
}

void se3di_model_lower_signals(se3di_model *model, size_t offset, uint32_t removed)
{
    for (size_t k = 0; k < model->function_slots.count; ++k) {
        for (uint32_t s = 0; s < model->functions[k].signal_count; ++s) {
            uint32_t index;
            char *at = (char *)&model->functions[k].signals[s] + offset;
            memcpy(&index, at, sizeof index);
            if (index != SE3DI_NO_INDEX) {
                se3di_index_lower(&index, removed);
                memcpy(at, &index, sizeof index);
            }
        }
    }
}

se3d_status se3di_model_add_function(se3di_model *model, const se3di_function *function,
                                     se3di_handle *handle)
{
    size_t count = model->function_slots.count;
    SE3DI_RESERVE(model, functions, function_capacity, count + 1, sizeof *model->functions);
    SE3DI_TRY(se3di_slots_reserve(&model->function_slots, &model->allocator));
    model->functions[count] = *function;
    model->functions[count].users = 0;
    count_signal_users(model, function, 1);
    *handle = se3di_slots_add(&model->function_slots);
    return SE3D_OK;
}

void se3di_model_remove_function(se3di_model *model, uint32_t function)
{
    count_signal_users(model, &model->functions[function], UINT32_MAX);
    se3di_function_release(&model->allocator, &model->functions[function]);
    se3di_array_close_gap(model->functions, model->function_slots.count, function, 1,
                          sizeof *model->functions);
    se3di_slots_remove(&model->function_slots, function);
    for (size_t k = 0; k < model->row_count; ++k) {
        se3di_index_lower_signed(&model->rows[k].function, function);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        se3di_index_lower_signed(&model->constraints[k].law, function);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        for (int c = 0; c < SE3DI_FORCE_FUNCTIONS; ++c) {
            se3di_index_lower_signed(&model->forces[k].function[c], function);
        }
    }
    for (int c = 0; c < 3; ++c) {
        se3di_index_lower_signed(&model->gravity_function[c], function);
    }
    for (size_t k = 0; k < model->road_slots.count; ++k) {
        se3di_index_lower_signed(&model->roads[k].function, function);
    }
}
