/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding, replacing and removing roads. */
#include "model/edit.h"

static void count_road_users(se3di_model *model, const se3di_road *road, uint32_t by)
{
    model->bodies[road->body].users += by;
    if (road->function >= 0) {
        model->functions[road->function].users += by;
    }
}

/* `own` has copies of all but the name. */
static void replace_road(se3di_model *model, uint32_t index, se3di_road *own)
{
    se3di_road *old = &model->roads[index];
    own->name = old->name;
    own->users = old->users;
    count_road_users(model, old, UINT32_MAX);
    se3di_road_release(&model->allocator, old);
    *old = *own;
    count_road_users(model, old, 1);
    se3di_model_touch(model);
}

se3d_status se3di_model_add_road(se3di_model *model, const se3di_road *road, se3di_handle *handle)
{
    const size_t count = model->road_slots.count;
    const uint32_t old = se3di_model_find_replaced(model, &model->road_slots, 0, road->name);
    const int is_new = old == SE3DI_NO_INDEX;
    se3di_road own = *road;
    if (is_new) {
        SE3DI_RESERVE(model, roads, road_capacity, count + 1, sizeof *model->roads);
        SE3DI_TRY(se3di_slots_reserve(&model->road_slots, &model->allocator));
    }
    SE3DI_TRY(se3di_road_own(&model->allocator, &own));
    const int is_mesh = own.kind == SE3DI_ROAD_MESH;
    if ((is_mesh && se3di_road_sort(&model->allocator, &own) < 0) ||
        se3di_model_copy_name(model, &model->road_slots, is_new ? road->name : NULL, &own.name) <
            0) {
        se3di_road_release(&model->allocator, &own);
        return SE3D_ERR_NO_MEMORY;
    }
    if (!is_new) {
        replace_road(model, old, &own);
        *handle = se3di_slots_handle(&model->road_slots, old);
        return SE3D_OK;
    }
    own.users = 0;
    model->roads[count] = own;
    count_road_users(model, road, 1);
    *handle = se3di_model_add_named(&model->road_slots, 0, own.name);
    return SE3D_OK;
}

void se3di_model_remove_road(se3di_model *model, uint32_t road)
{
    count_road_users(model, &model->roads[road], UINT32_MAX);
    char *name = model->roads[road].name;
    se3di_road_release(&model->allocator, &model->roads[road]);
    se3di_array_close_gap(model->roads, model->road_slots.count, road, 1, sizeof *model->roads);
    se3di_model_remove_named(model, &model->road_slots, road, 0, name);
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].tyre) {
            se3di_index_lower_signed(&model->forces[k].tyre->surface, road);
        }
    }
}
