/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding and removing wheels. */
#include "model/edit.h"

static void count_wheel_users(se3di_model *model, const se3di_wheel *wheel, uint32_t by)
{
    model->bodies[wheel->body].users += by;
    model->bodies[wheel->chassis].users += by;
    if (wheel->travel >= 0) {
        model->constraints[wheel->travel].users += by;
    }
    if (wheel->steering >= 0) {
        model->constraints[wheel->steering].users += by;
    }
    if (wheel->spring >= 0) {
        model->forces[wheel->spring].users += by;
    }
}

/* Let the wheel across know, and any other that was across no longer. */
static void pair_wheel(se3di_model *model, uint32_t index)
{
    const int32_t opposite = model->wheels[index].opposite;
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        if (model->wheels[k].opposite == (int32_t)index && (int32_t)k != opposite) {
            model->wheels[k].opposite = -1;
        }
    }
    if (opposite >= 0) {
        model->wheels[opposite].opposite = (int32_t)index;
    }
}

static void replace_wheel(se3di_model *model, uint32_t index, const se3di_wheel *wheel)
{
    se3di_wheel *old = &model->wheels[index];
    char *name = old->name;
    count_wheel_users(model, old, UINT32_MAX);
    *old = *wheel;
    old->name = name;
    count_wheel_users(model, old, 1);
    pair_wheel(model, index);
}

se3d_status se3di_model_add_wheel(se3di_model *model, const se3di_wheel *wheel,
                                  se3di_handle *handle)
{
    size_t count = model->wheel_slots.count;
    char *name;
    const uint32_t old = se3di_model_find_replaced(model, &model->wheel_slots, 0, wheel->name);
    if (old != SE3DI_NO_INDEX) {
        replace_wheel(model, old, wheel);
        *handle = se3di_slots_handle(&model->wheel_slots, old);
        return SE3D_OK;
    }
    SE3DI_RESERVE(model, wheels, wheel_capacity, count + 1, sizeof *model->wheels);
    SE3DI_TRY(se3di_slots_reserve(&model->wheel_slots, &model->allocator));
    SE3DI_TRY(se3di_model_copy_name(model, &model->wheel_slots, wheel->name, &name));
    model->wheels[count] = *wheel;
    model->wheels[count].name = name;
    pair_wheel(model, (uint32_t)count);
    count_wheel_users(model, wheel, 1);
    *handle = se3di_model_add_named(&model->wheel_slots, 0, name);
    return SE3D_OK;
}

void se3di_model_remove_wheel(se3di_model *model, uint32_t wheel)
{
    count_wheel_users(model, &model->wheels[wheel], UINT32_MAX);
    char *name = model->wheels[wheel].name;
    se3di_array_close_gap(model->wheels, model->wheel_slots.count, wheel, 1, sizeof *model->wheels);
    se3di_model_remove_named(model, &model->wheel_slots, wheel, 0, name);
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        int32_t *opposite = &model->wheels[k].opposite;
        *opposite = *opposite == (int32_t)wheel ? -1 : *opposite;
        se3di_index_lower_signed(opposite, wheel);
    }
}
