/* SPDX-License-Identifier: BSD-3-Clause */
#include "particles/chain.h"

#include "particles/sync.h"

#include <string.h>

void se3di_sets_link(se3di_model *model, se3di_particles *set)
{
    se3di_particles **last = &model->sets;
    while (*last) {
        last = &(*last)->next;
    }
    *last = set;
    ++model->topology_version;
}

void se3di_sets_unlink(se3di_model *model, const se3di_particles *set)
{
    se3di_particles **link = &model->sets;
    while (*link != set) {
        link = &(*link)->next;
    }
    *link = set->next;
    ++model->topology_version;
}

se3di_particles *se3di_sets_find(const se3di_model *model, const char *name)
{
    se3di_particles *set = model->sets;
    while (set && !(set->name && strcmp(set->name, name) == 0)) {
        set = set->next;
    }
    return set;
}

se3di_particles *se3di_sets_get(const se3di_model *model, size_t index)
{
    se3di_particles *set = model->sets;
    for (; set && index > 0; --index) {
        set = set->next;
    }
    return set;
}

static void count_function(se3di_model *model, se3di_handle handle, int add)
{
    const uint32_t function =
        se3di_slots_find(&model->function_slots, handle.index1, handle.generation);
    if (function != SE3DI_NO_INDEX) {
        model->functions[function].users += add ? 1u : UINT32_MAX;
    }
}

void se3di_particles_count_users(const se3di_particles *set, se3di_model *model, int add)
{
    for (size_t k = 0; k < set->stuff_count; ++k) {
        const se3di_stuff *stuff = &set->stuffs[k];
        if (stuff->held) {
            uint32_t material = se3di_slots_find(&model->material_slots, stuff->handle.index1,
                                                 stuff->handle.generation);
            model->materials[material].users += add ? 1u : UINT32_MAX;
        }
    }
    for (size_t k = 0; k < set->source_count; ++k) {
        count_function(model, set->sources[k].function, add);
    }
    for (size_t k = 0; k < set->servo_count; ++k) {
        count_function(model, set->servos[k].function, add);
    }
}

void se3di_sets_forget(se3di_particles *saved, const se3d_allocator *allocator)
{
    while (saved) {
        se3di_particles *set = saved;
        saved = set->next;
        se3di_particles_destroy(set);
        se3di_free(allocator, set, 1, sizeof *set);
    }
}

se3d_status se3di_sets_sync(se3di_particles *saved, const se3di_model *model)
{
    for (se3di_particles *set = saved; set; set = set->next) {
        SE3DI_TRY(se3di_particles_sync(set, model));
    }
    return SE3D_OK;
}

int se3di_sets_can_take(const se3di_model *model, const se3di_particles *saved)
{
    for (const se3di_particles *set = saved; set; set = set->next) {
        for (size_t k = 0; k < set->stuff_count; ++k) {
            const se3di_handle handle = set->stuffs[k].handle;
            if (set->stuffs[k].held && se3di_slots_find(&model->material_slots, handle.index1,
                                                        handle.generation) == SE3DI_NO_INDEX) {
                return 0;
            }
        }
    }
    return 1;
}

se3d_status se3di_sets_save(const se3di_particles *sets, const se3d_allocator *allocator,
                            se3di_particles **saved)
{
    se3di_particles **last = saved;
    *saved = NULL;
    for (const se3di_particles *set = sets; set; set = set->next) {
        se3di_particles *copy = se3di_alloc(allocator, 1, sizeof *copy);
        if (!copy || se3di_particles_clone(set, copy) < 0) {
            se3di_free(allocator, copy, 1, sizeof *copy);
            se3di_sets_forget(*saved, allocator);
            *saved = NULL;
            return SE3D_ERR_NO_MEMORY;
        }
        *last = copy;
        last = &copy->next;
    }
    return SE3D_OK;
}

void se3di_sets_take(se3di_model *model, se3di_particles *saved)
{
    for (se3di_particles *set = model->sets; set; set = set->next) {
        se3di_particles *from = saved;
        saved = from->next;
        se3di_particles_count_users(set, model, 0);
        se3di_particles_replace(set, from);
        se3di_particles_count_users(set, model, 1);
        se3di_free(&model->allocator, from, 1, sizeof *from);
    }
}
