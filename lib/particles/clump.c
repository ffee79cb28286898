/* SPDX-License-Identifier: BSD-3-Clause */
/* Templates and clumps of a set: made, dropped, found by their spheres. */
#include "particles/clump.h"

#include "particles/memory.h"

#include <string.h>

/* clump_of for ids up to `ids`; those that are new are of no clump. */
static se3d_status reserve_owners(se3di_particles *set, size_t ids)
{
    const size_t had = set->clump_of_capacity;
    ids = ids < set->index_capacity ? set->index_capacity : ids;
    SE3DI_TRY(se3di_particles_grow(set, &set->clump_of, &set->clump_of_capacity, ids + 1));
    for (size_t id = had; id < set->clump_of_capacity; ++id) {
        set->clump_of[id] = SE3DI_NO_INDEX;
    }
    return SE3D_OK;
}

static se3d_status reserve(const se3di_particles *set, void **data, size_t *capacity, size_t needed,
                           size_t size)
{
    return se3di_array_reserve(&set->allocator, data, capacity, needed, size);
}

se3d_status se3di_clumps_add_template(se3di_particles *set, const se3di_clump_template *out,
                                      const se3di_clump_ball *balls)
{
    void *templates = set->templates, *all = set->balls;
    se3d_status status = reserve(set, &templates, &set->template_capacity, set->template_count + 1,
                                 sizeof *set->templates);
    set->templates = templates;
    SE3DI_TRY(status);
    status =
        reserve(set, &all, &set->ball_capacity, set->ball_count + out->count, sizeof *set->balls);
    set->balls = all;
    SE3DI_TRY(status);
    SE3DI_TRY(reserve_owners(set, set->id_count));
    set->templates[set->template_count] = *out;
    set->templates[set->template_count].begin = (uint32_t)set->ball_count;
    memcpy(set->balls + set->ball_count, balls, out->count * sizeof *balls);
    set->ball_count += out->count;
    ++set->template_count;
    return SE3D_OK;
}

se3d_status se3di_clumps_reserve(se3di_particles *set, size_t ids, size_t count)
{
    if (set->template_count == 0) {
        return SE3D_OK;
    }
    void *clumps = set->clumps;
    const se3d_status status =
        reserve(set, &clumps, &set->clump_capacity, set->clump_count + count, sizeof *set->clumps);
    set->clumps = clumps;
    SE3DI_TRY(status);
    return reserve_owners(set, ids);
}

static void own(se3di_particles *set, const se3di_clump *clump, uint32_t index)
{
    for (uint32_t k = 0; k < set->templates[clump->template_index].count; ++k) {
        set->clump_of[clump->first + k] = index;
    }
}

void se3di_clumps_filter(se3di_particles *set)
{
    size_t to = 0;
    for (size_t k = 0; k < set->clump_count; ++k) {
        const se3di_clump clump = set->clumps[k];
        const int stays = set->index_of[clump.first] != SE3DI_NO_INDEX;
        own(set, &clump, stays ? (uint32_t)to : SE3DI_NO_INDEX);
        if (stays) {
            set->clumps[to++] = clump;
        }
    }
    set->clump_count = to;
}

int se3di_clumps_index(se3di_particles *set)
{
    for (size_t id = 0; id < set->clump_of_capacity; ++id) {
        set->clump_of[id] = SE3DI_NO_INDEX;
    }
    for (size_t k = 0; k < set->clump_count; ++k) {
        const se3di_clump *clump = &set->clumps[k];
        const uint32_t count = set->templates[clump->template_index].count;
        if (clump->first >= set->id_count || count > set->id_count - clump->first) {
            return 0;
        }
        for (uint32_t id = clump->first; id < clump->first + count; ++id) {
            if (set->index_of[id] == SE3DI_NO_INDEX || set->clump_of[id] != SE3DI_NO_INDEX) {
                return 0;
            }
        }
        own(set, clump, (uint32_t)k);
    }
    return 1;
}
