/* SPDX-License-Identifier: BSD-3-Clause */
#include "tree/packs.h"

#include "base/sort.h"
#include "tree/core.h"

#include <string.h>

#define KEYS    4 /* depth, type, flags, node */
#define ALIGNED (SE3DI_TREE_ALIGNED_PARENT | SE3DI_TREE_ALIGNED_BODY)

/* Nodes sorted by how deep they are, then by what must be the same in a pack. */
static void sort_nodes(se3di_tree *tree, int32_t flags)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        int32_t *key = tree->keys + KEYS * (size_t)k;
        key[0] = n->parent < 0 ? 0 : tree->keys[KEYS * (size_t)n->parent] + 1;
        key[1] = n->type;
        key[2] = n->flags & flags;
        key[3] = (int32_t)k;
    }
    se3di_sort_tuples(tree->keys, tree->count, KEYS);
}

/* Whether the four from place `k` on can be a pack: the first and the last are alike. A carrier is
 * placed at once. */
static int begins_pack(const se3di_tree *tree, uint32_t k)
{
    if (k + SE3DI_TREE_PACK > tree->count) {
        return 0;
    }
    const int32_t *first = tree->keys + KEYS * (size_t)k;
    const int32_t *last = first + KEYS * (SE3DI_TREE_PACK - 1);
    return first[1] != SE3DI_TREE_CARRIER && memcmp(first, last, 3 * sizeof *first) == 0;
}

uint32_t se3di_tree_count_packs(se3di_tree *tree)
{
    uint32_t packs = 0;
    sort_nodes(tree, 0);
    for (uint32_t k = 0; k < tree->count;) {
        const int is_pack = begins_pack(tree, k);
        packs += is_pack != 0;
        k += is_pack ? SE3DI_TREE_PACK : 1;
    }
    return packs;
}

static void add_pack(se3di_tree *tree, uint32_t k)
{
    se3di_tree_pack *pack = &tree->packs[tree->pack_count];
    for (uint32_t lane = 0; lane < SE3DI_TREE_PACK; ++lane) {
        pack->node[lane] = (uint32_t)tree->keys[KEYS * (size_t)(k + lane) + 3];
    }
    const se3di_tree_node *n = &tree->nodes[pack->node[0]];
    pack->type = n->type;
    pack->flags = n->flags & ALIGNED;
    pack->is_rooted = n->parent < 0;
    tree->steps[tree->step_count++] = tree->count + tree->pack_count++;
}

void se3di_tree_find_packs(se3di_tree *tree)
{
    tree->pack_count = tree->step_count = 0;
    if (tree->pack_max == 0) {
        return;
    }
    sort_nodes(tree, ALIGNED);
    for (uint32_t k = 0; k < tree->count;) {
        const int is_pack = begins_pack(tree, k);
        if (is_pack) {
            add_pack(tree, k);
        } else {
            tree->steps[tree->step_count++] = (uint32_t)tree->keys[KEYS * (size_t)k + 3];
        }
        k += is_pack ? SE3DI_TREE_PACK : 1;
    }
    se3di_tree_fill_packs(tree);
}

static void fill(size_t count, const double *from, size_t lane, double *to)
{
    for (size_t k = 0; k < count; ++k) {
        to[SE3DI_TREE_PACK * k + lane] = from[k];
    }
}

void se3di_tree_fill_packs(se3di_tree *tree)
{
    for (uint32_t k = 0; k < tree->pack_count; ++k) {
        se3di_tree_pack *pack = &tree->packs[k];
        for (size_t lane = 0; lane < SE3DI_TREE_PACK; ++lane) {
            const se3di_tree_node *n = &tree->nodes[pack->node[lane]];
            fill(1, &n->zero, lane, pack->zero);
            fill(1, &n->lead, lane, pack->lead);
            fill(1, &n->base, lane, pack->base);
            fill(4, n->C, lane, pack->C);
            fill(9, n->T, lane, pack->T);
            fill(3, n->r, lane, pack->r);
            fill(4, n->B, lane, pack->B);
            fill(3, n->s, lane, pack->s);
        }
    }
}
