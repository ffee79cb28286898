/* SPDX-License-Identifier: BSD-3-Clause */
/* The rows of loops for lanes: which stand where.                       docs/theory/lanes.md */
#include "tree/lanes.h"
#include "tree/loops.h"

#include <string.h>

/* The velocities that rows of a loop have numbers at. */
static void take_range(const se3di_tree_loops *loops, uint32_t loop, se3di_lane_row *row)
{
    row->from = (int32_t)loops->tree->v_count;
    for (int32_t m = loops->member_begin[loop]; m < loops->member_begin[loop + 1]; ++m) {
        const int32_t v = loops->member[m];
        row->from = v < row->from ? v : row->from;
        row->to = v + 1 > row->to ? v + 1 : row->to;
    }
    row->from = row->from < row->to ? row->from : row->to;
}

/* Rows that share velocities, and all between: the skyline. */
static void lay_out_rows(se3di_lane_loops *l)
{
    for (int32_t i = 0; i < l->count; ++i) {
        se3di_lane_row *row = &l->rows[i];
        row->first = i;
        for (int32_t j = i; j-- > 0;) {
            if (l->rows[j].from < row->to && row->from < l->rows[j].to) {
                row->first = j;
            }
        }
        row->entry = (int32_t)l->entry_count;
        row->value = (int32_t)l->value_count;
        l->entry_count += (size_t)(i - row->first) + 1;
        l->value_count += (size_t)(row->to - row->from);
    }
}

se3d_status se3di_lane_loops_init(se3di_lane_loops *lane_loops, const se3di_tree_loops *loops)
{
    se3di_lane_loops *l = lane_loops;
    const int32_t last = (int32_t)loops->count - 1;
    *l = (se3di_lane_loops){.loops = loops};
    l->count = last < 0 ? 0 : loops->kept_begin[last] + loops->kept_count[last];
    l->rows = se3di_alloc(&loops->tree->model->allocator, (size_t)l->count, sizeof *l->rows);
    if (!l->rows) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (uint32_t k = 0; k < loops->count; ++k) {
        const size_t path = (size_t)(loops->path_begin[k + 1] - loops->path_begin[k]);
        l->path_max = path > l->path_max ? path : l->path_max;
        for (int32_t r = 0; r < loops->kept_count[k]; ++r) {
            se3di_lane_row *row = &l->rows[loops->kept_begin[k] + r];
            row->loop = (int32_t)k;
            row->kept = loops->kept[loops->row_begin[k] + (uint32_t)r];
            take_range(loops, k, row);
        }
    }
    se3di_lane_loops_take_least(l, 1.0);
    lay_out_rows(l);
    return SE3D_OK;
}

void se3di_lane_loops_take_least(se3di_lane_loops *l, double part)
{
    const se3di_tree_loops *loops = l->loops;
    for (int32_t k = 0; k < loops->system.row_strips; ++k) {
        const se3di_loop_strip *strip = &loops->system.strips[k];
        for (int32_t r = 0; r < strip->count; ++r) {
            l->rows[loops->kept_begin[strip->loop] + strip->first + r].least =
                part * loops->system.least[SE3DI_STRIP * k + r];
        }
    }
}

void se3di_lane_loops_destroy(se3di_lane_loops *l)
{
    if (l->loops) {
        se3di_free(&l->loops->tree->model->allocator, l->rows, (size_t)l->count, sizeof *l->rows);
    }
    memset(l, 0, sizeof *l);
}

#define PARTS 6

static size_t list_parts(se3di_lanes *lanes, const se3di_lane_loops *l, double **to[PARTS],
                         size_t counts[PARTS])
{
    double **const all[] = {&lanes->K, &lanes->Y, &lanes->L, &lanes->pivot, &lanes->c, &lanes->z};
    const size_t rows = (size_t)l->count;
    const size_t sizes[] = {6 * l->path_max, l->value_count, l->entry_count, rows, rows, rows};
    size_t total = 0;
    memcpy(to, all, sizeof all);
    memcpy(counts, sizes, sizeof sizes);
    for (int k = 0; k < PARTS; ++k) {
        total += counts[k];
    }
    return total;
}

size_t se3di_lane_loops_room(const se3di_lane_loops *l)
{
    se3di_lanes none;
    double **to[PARTS];
    size_t counts[PARTS];
    return list_parts(&none, l, to, counts);
}

void se3di_lanes_take_loops(se3di_lanes *lanes, const se3di_lane_loops *l, double *memory)
{
    double **to[PARTS];
    size_t counts[PARTS];
    (void)list_parts(lanes, l, to, counts);
    for (int k = 0; k < PARTS; ++k) {
        *to[k] = memory;
        memory += counts[k] * (size_t)lanes->core->width;
    }
    lanes->loops = l;
    lanes->wants_points = 1;
}
