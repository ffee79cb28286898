/* SPDX-License-Identifier: BSD-3-Clause */
#include "tree/lanes.h"

#include <stdint.h>
#include <string.h>

const se3di_lane_core *se3di_lane_core_find(int32_t width)
{
    switch (width) {
    case 1:
        return se3di_lane_core_portable();
    case 4:
        return se3di_lane_core_avx2();
    case 8:
        return se3di_lane_core_avx512();
    default:
        return NULL;
    }
}

const se3di_lane_core *se3di_lane_core_widest(void)
{
    const se3di_lane_core *avx512 = se3di_lane_core_avx512(), *avx2 = se3di_lane_core_avx2();
    return avx512 ? avx512 : avx2 ? avx2 : se3di_lane_core_portable();
}

double *se3di_lanes_align(double *memory)
{
    const uintptr_t beyond = (uintptr_t)memory % SE3DI_LANES_ALIGN;
    return beyond ? memory + (SE3DI_LANES_ALIGN - beyond) / sizeof *memory : memory;
}

/* An array of the work: where it is kept, its numbers. */
typedef struct part {
    double **to;
    size_t count;
} part;

#define PARTS      14
#define LINK_SIZE  (sizeof(se3di_tree_link) / sizeof(double))
#define INERTIA    (sizeof(se3di_tree_inertia) / sizeof(double))
#define FRAME_SIZE (sizeof(se3di_frame) / sizeof(double))

static size_t list_parts(se3di_lanes *l, int wants_frames, part parts[PARTS])
{
    const se3di_tree *tree = l->tree;
    const size_t n = tree->count, v = tree->v_count, b = wants_frames ? tree->body_count : 0;
    const part list[] = {
        {&l->links, LINK_SIZE * n},
        {&l->S, 6 * v},
        {&l->U, 6 * v},
        {&l->D, v},
        {&l->R, v},
        {&l->e, v},
        {&l->V, 6 * v},
        {&l->k, v},
        {&l->given, v},
        {&l->wrench, 6 * n},
        {&l->branches, INERTIA * tree->branch_count},
        {&l->joint, 6 * n},
        {&l->frames, FRAME_SIZE * b},
        {&l->loads, 6 * b},
    };
    size_t total = 0;
    _Static_assert(sizeof list == PARTS * sizeof *list, "all of them");
    memcpy(parts, list, sizeof list);
    for (int k = 0; k < PARTS; ++k) {
        total += parts[k].count;
    }
    return total;
}

se3d_status se3di_lanes_init(se3di_lanes *lanes, const se3di_tree *tree,
                             const se3di_lane_core *core, int wants_frames)
{
    part parts[PARTS];
    *lanes = (se3di_lanes){.tree = tree, .core = core};
    const size_t width = (size_t)core->width;
    const size_t count =
        list_parts(lanes, wants_frames, parts) * width + SE3DI_LANES_ALIGN / sizeof(double);
    lanes->memory = se3di_alloc(&tree->model->allocator, count, sizeof *lanes->memory);
    if (!lanes->memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    lanes->memory_count = count;
    double *at = se3di_lanes_align(lanes->memory);
    for (int k = 0; k < PARTS; ++k) {
        *parts[k].to = parts[k].count > 0 ? at : NULL;
        at += parts[k].count * width;
    }
    return SE3D_OK;
}

void se3di_lanes_destroy(se3di_lanes *lanes)
{
    if (lanes->tree) {
        se3di_free(&lanes->tree->model->allocator, lanes->memory, lanes->memory_count,
                   sizeof *lanes->memory);
    }
    memset(lanes, 0, sizeof *lanes);
}

void se3di_lanes_accelerate(const se3di_lanes *lanes, const double *effort, double *qddot)
{
    lanes->core->factor(lanes, effort);
    lanes->core->accelerate(lanes, qddot);
}
