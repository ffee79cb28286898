/* SPDX-License-Identifier: BSD-3-Clause */
/* Which rows of loops the tree implies: those that are empty in every pose of it, as what holds a
 * planar loop in its plane. They are found at poses that no symmetry singles out.
 *                                                             docs/theory/joint_coordinates.md */
#include "tree/loops.h"

#include "joint/user.h"

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

void se3di_tree_loops_keep_rows(se3di_tree_loops *loops)
{
    se3di_tree *tree = loops->tree;
    const size_t size = tree->body_count * sizeof *tree->frames;
    uint64_t state = 1;
    memcpy(tree->frames, tree->model->frames, size);
    for (int pose = 0; pose < POSES && loops->count > 0; ++pose) {
        place_somewhere(tree, &state);
        for (uint32_t k = 0; k < loops->count; ++k) {
            if (!is_asked(loops, k)) {
                mark_rows(loops, k);
            }
        }
    }
    memcpy(tree->model->frames, tree->frames, size);
    se3di_tree_get(tree, tree->q, tree->qdot);
    se3di_tree_place(tree, tree->q, tree->qdot, tree->frames);
    for (uint32_t k = 0; k < loops->count; ++k) {
        list_rows(loops, k);
    }
}
