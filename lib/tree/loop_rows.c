/* SPDX-License-Identifier: BSD-3-Clause */
/* What poses that no symmetry singles out tell of the rows of loops: which of them the tree
 * implies, being empty in every pose of it, as what holds a planar loop in its plane; and how
 * large pivots usually are.
 *                                                             docs/theory/joint_coordinates.md */
#include "tree/loops.h"

#include "primitive/user.h"

#include <string.h>

#define POSES 3

/* Between -1 and 1, the same in every run. */
static double next_number(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-52 - 1.0;
}

static void place_somewhere(se3di_tree *tree, uint64_t *state)
{
    for (uint32_t k = 0; k < tree->q_count; ++k) {
        tree->q[k] = 2.0 * next_number(state);
    }
    memset(tree->qdot, 0, tree->v_count * sizeof *tree->qdot);
    se3di_tree_place(tree, tree->q, tree->qdot, tree->model->frames);
}

/* Callbacks of users are asked where bodies are, and nowhere else. */
static int is_asked(const se3di_tree_loops *loops, uint32_t loop)
{
    return se3di_is_user(&loops->tree->model->constraints[loops->constraints[loop]]);
}

/* Mark the rows that are not empty here. */
static void mark_rows(se3di_tree_loops *loops, uint32_t loop)
{
    double *G = loops->y;
    se3di_assembly_eval_some_rows(loops->assembly, &loops->constraints[loop], 1, loops->gamma);
    for (int32_t r = 0; r < loops->rows[loop]; ++r) {
        int32_t *mark = &loops->kept[loops->row_begin[loop] + (uint32_t)r];
        memset(G, 0, loops->tree->v_count * sizeof *G);
        se3di_tree_loops_row(loops, loop, (size_t)r, G);
        for (uint32_t v = 0; v < loops->tree->v_count; ++v) {
            *mark |= G[v] != 0.0;
        }
    }
}

/* Points coincide, and no row of it is empty: what is along another direction may still be. */
static int is_full(const se3di_tree_loops *loops, uint32_t loop)
{
    const int32_t *mark = loops->kept + loops->row_begin[loop];
    return loops->rows[loop] >= 3 && !is_asked(loops, loop) && mark[0] && mark[1] && mark[2];
}

/* Turn the rows of loops in which that is so; before: all marks are known. */
static void turn_rows(se3di_tree_loops *loops)
{
    for (int looks = 0; looks < 2; ++looks) {
        uint64_t state = 1;
        for (int pose = 0; pose < POSES; ++pose) {
            place_somewhere(loops->tree, &state);
            for (uint32_t k = 0; k < loops->count; ++k) {
                if (is_full(loops, k) && (!looks || loops->turns[k].is_turned)) {
                    se3di_assembly_eval_some_rows(loops->assembly, &loops->constraints[k], 1,
                                                  loops->gamma);
                    se3di_tree_loops_watch_turn(loops, k, looks);
                }
            }
        }
        for (uint32_t k = 0; k < loops->count; ++k) {
            if (looks && loops->turns[k].is_turned) {
                se3di_tree_loops_decide_turn(loops, k);
                loops->kept[loops->row_begin[k] + 2] = !loops->turns[k].is_turned;
            } else if (!looks && is_full(loops, k)) {
                loops->turns[k].is_turned = se3di_tree_loops_foresee_turn(loops, k);
            }
        }
    }
}

/* Marks -> the list of rows. */
static void list_rows(se3di_tree_loops *loops, uint32_t loop)
{
    int32_t *kept = loops->kept + loops->row_begin[loop], count = 0;
    for (int32_t r = 0; r < loops->rows[loop]; ++r) {
        if (kept[r] || is_asked(loops, loop)) {
            kept[count++] = r;
        }
    }
    loops->kept_count[loop] = count;
}

/* The model's frames, and the tree there, are as they were. */
static void come_back(se3di_tree_loops *loops)
{
    se3di_tree *tree = loops->tree;
    memcpy(tree->model->frames, tree->frames, tree->body_count * sizeof *tree->frames);
    se3di_tree_get(tree, tree->q, tree->qdot);
    se3di_tree_match_signs(tree);
}

void se3di_tree_loops_keep_rows(se3di_tree_loops *loops)
{
    se3di_tree *tree = loops->tree;
    uint64_t state = 1;
    memcpy(tree->frames, tree->model->frames, tree->body_count * sizeof *tree->frames);
    for (int pose = 0; pose < POSES && loops->count > 0; ++pose) {
        place_somewhere(tree, &state);
        for (uint32_t k = 0; k < loops->count; ++k) {
            if (!is_asked(loops, k)) {
                mark_rows(loops, k);
            }
        }
    }
    turn_rows(loops);
    come_back(loops);
    int32_t kept = 0;
    for (uint32_t k = 0; k < loops->count; ++k) {
        list_rows(loops, k);
        loops->kept_begin[k] = kept;
        kept += loops->kept_count[k];
    }
    loops->is_whole = kept == (int32_t)loops->row_count;
}

/* ---- freedoms ---- */

static int32_t root_of(int32_t *above, int32_t v)
{
    while (above[v] != v) {
        above[v] = above[above[v]];
        v = above[v];
    }
    return v;
}

/* Freedoms that a loop shares move together: a set; `left` of its root [velocities] is how many it
 * has less the rows. */
static void join_freedoms(const se3di_tree_loops *loops, int32_t *above, int32_t *left)
{
    for (uint32_t v = 0; v < loops->tree->v_count; ++v) {
        above[v] = (int32_t)v;
        left[v] = 1;
    }
    for (uint32_t k = 0; k < loops->count; ++k) {
        const int32_t begin = loops->member_begin[k], end = loops->member_begin[k + 1];
        for (int32_t m = begin; m < end; ++m) {
            const int32_t one = root_of(above, loops->member[begin]);
            const int32_t other = root_of(above, loops->member[m]);
            left[one] += other != one ? left[other] : 0;
            above[other] = one;
        }
        if (begin < end) {
            left[root_of(above, loops->member[begin])] -= loops->kept_count[k];
        }
    }
}

/* What moves only because rows depend on each other is filtered at every position. */
static int leaves_freedom(const se3di_tree_loops *loops, int32_t *above, const int32_t *left)
{
    int leaves = 1;
    for (uint32_t k = 0; k < loops->count; ++k) {
        const int32_t begin = loops->member_begin[k];
        const int32_t members = loops->member_begin[k + 1] - begin;
        leaves &= loops->kept_count[k] <= members;
        leaves &= members == 0 || left[root_of(above, loops->member[begin])] > 0;
    }
    return leaves;
}

se3d_status se3di_tree_loops_count_freedoms(se3di_tree_loops *loops)
{
    const size_t n = loops->tree->v_count;
    const se3d_allocator *allocator = &loops->tree->model->allocator;
    int32_t *above = NULL, *left = NULL;
    const se3di_array arrays[] = {{(void **)&above, n, sizeof *above},
                                  {(void **)&left, n, sizeof *left}};
    const se3d_status status = se3di_arrays_alloc(allocator, arrays, 2);
    if (status >= 0) {
        join_freedoms(loops, above, left);
        loops->leaves_freedom = leaves_freedom(loops, above, left);
    }
    se3di_arrays_free(allocator, arrays, 2);
    return status;
}

void se3di_tree_loops_refresh(se3di_tree_loops *loops)
{
    se3di_tree *tree = loops->tree;
    uint64_t state = 1;
    se3di_tree_loops_take_points(loops);
    if (!loops->system.is_there) {
        return;
    }
    memcpy(tree->frames, tree->model->frames, tree->body_count * sizeof *tree->frames);
    se3di_loop_system_forget(&loops->system);
    for (int pose = 0; pose < POSES && loops->assembly->user_count == 0; ++pose) {
        place_somewhere(tree, &state);
        if (se3di_tree_factor(tree, NULL) >= 0) {
            se3di_tree_loops_eval_rows(loops);
            se3di_tree_loops_carry(loops);
            se3di_loop_system_learn(&loops->system, tree);
        }
    }
    come_back(loops);
}
