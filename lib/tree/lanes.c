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

/* What the work of a tree is for. */
typedef struct extent {
    size_t nodes, velocities, branches, bodies;
} extent;

#define PARTS      15
#define LINK_SIZE  (sizeof(se3di_tree_link) / sizeof(double))
#define INERTIA    (sizeof(se3di_tree_inertia) / sizeof(double))
#define FRAME_SIZE (sizeof(se3di_frame) / sizeof(double))
#define PLANE_SIZE (sizeof(se3di_lane_plane) / sizeof(double))

/* @return numbers of all */
static size_t list_parts(se3di_lanes *l, extent of, part parts[PARTS])
{
    const size_t v = of.velocities;
    const part list[] = {
        {&l->links, LINK_SIZE * of.nodes},
        {&l->S, 6 * v},
        {&l->U, 6 * v},
        {&l->D, v},
        {&l->R, v},
        {&l->e, v},
        {&l->V, 6 * v},
        {&l->k, v},
        {&l->given, v},
        {&l->wrench, 6 * of.nodes},
        {&l->branches, INERTIA * of.branches},
        {&l->joint, 12 * of.nodes},
        {&l->frames, FRAME_SIZE * of.bodies},
        {&l->loads, 6 * of.bodies},
        {&l->planes, PLANE_SIZE * of.nodes},
    };
    size_t total = 0;
    _Static_assert(sizeof list == PARTS * sizeof *list, "all of them");
    memcpy(parts, list, sizeof list);
    for (int k = 0; k < PARTS; ++k) {
        total += parts[k].count;
    }
    return total;
}

static void lay_out(const part parts[PARTS], size_t width, double *at)
{
    for (int k = 0; k < PARTS; ++k) {
        *parts[k].to = parts[k].count > 0 ? at : NULL;
        at += parts[k].count * width;
    }
}

static extent extent_of(const se3di_tree *tree, int wants_frames)
{
    return (extent){tree->count, tree->v_count, tree->branch_count,
                    wants_frames ? tree->body_count : 0};
}

se3d_status se3di_lanes_init(se3di_lanes *lanes, const se3di_tree *tree,
                             const se3di_lane_core *core, int wants_frames)
{
    part parts[PARTS];
    *lanes = (se3di_lanes){.tree = tree, .core = core, .acts = 1};
    const size_t count =
        list_parts(lanes, extent_of(tree, wants_frames), parts) * (size_t)core->width +
        SE3DI_LANES_ALIGN / sizeof(double);
    lanes->memory = se3di_alloc(&tree->model->allocator, count, sizeof *lanes->memory);
    if (!lanes->memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    lanes->memory_count = count;
    lay_out(parts, (size_t)core->width, se3di_lanes_align(lanes->memory));
    return SE3D_OK;
}

void se3di_lanes_lay_out(se3di_lanes *lanes, const se3di_tree *tree, const se3di_lane_core *core,
                         double *memory)
{
    part parts[PARTS];
    *lanes = (se3di_lanes){.tree = tree, .core = core, .acts = 1};
    (void)list_parts(lanes, extent_of(tree, 0), parts);
    lay_out(parts, (size_t)core->width, memory);
}

size_t se3di_lanes_room(size_t nodes, size_t velocities, size_t branches, size_t width)
{
    part parts[PARTS];
    se3di_lanes lanes;
    return list_parts(&lanes, (extent){nodes, velocities, branches, 0}, parts) * width;
}

void se3di_lanes_destroy(se3di_lanes *lanes)
{
    if (lanes->tree) {
        se3di_free(&lanes->tree->model->allocator, lanes->memory, lanes->memory_count,
                   sizeof *lanes->memory);
    }
    memset(lanes, 0, sizeof *lanes);
}

void se3di_lanes_load(se3di_lanes *lanes, const double *gravity, int acts)
{
    const size_t count = 6 * (size_t)lanes->tree->count * (size_t)lanes->core->width;
    lanes->gravity = gravity;
    lanes->acts = acts;
    for (size_t k = 0; acts && k < count; ++k) {
        lanes->wrench[k] = 0.0;
    }
}

void se3di_lanes_accelerate(const se3di_lanes *lanes, const double *effort, double *qddot)
{
    if (lanes->plane) {
        lanes->core->fall_in_plane(lanes, effort, qddot);
        return;
    }
    lanes->core->factor(lanes, effort);
    if (lanes->loops) {
        lanes->core->factor_rows(lanes);
        lanes->core->close(lanes);
    }
    lanes->core->accelerate(lanes, qddot);
}
