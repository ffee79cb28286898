/* SPDX-License-Identifier: BSD-3-Clause */
#include "tree/packs.h"

#include "base/sort.h"
#include "tree/core.h"

#include <string.h>

#define KEYS   4  /* depth, type, flags, node */
#define FEWEST 3  /* nodes that fill a pack; two alone cost no more */
#define ALL    -1 /* flags */

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

/* How many from place `k` on are a pack, 0: none. A carrier is placed at once. */
static uint32_t count_pack(const se3di_tree *tree, uint32_t k)
{
    const int32_t *first = tree->keys + KEYS * (size_t)k;
    uint32_t count = 1;
    while (count < SE3DI_TREE_PACK && k + count < tree->count &&
           memcmp(first, first + KEYS * (size_t)count, (KEYS - 1) * sizeof *first) == 0) {
        ++count;
    }
    return count < FEWEST || first[1] == SE3DI_TREE_CARRIER ? 0 : count;
}

/* Each has FEWEST nodes or more that are alike but for flags. */
uint32_t se3di_tree_count_packs(se3di_tree *tree)
{
    uint32_t packs = 0, count = 0;
    sort_nodes(tree, 0);
    for (uint32_t k = 0; k < tree->count; ++k) {
        const int32_t *key = tree->keys + KEYS * (size_t)k;
        const int goes_on = count > 0 && memcmp(key - KEYS, key, (KEYS - 1) * sizeof *key) == 0;
        count = goes_on ? count + 1 : 1;
        packs += count % FEWEST == 0;
    }
    return packs;
}

/* Nothing is prescribed, and armatures of balls are there in all or in none. */
static void compare_armatures(const se3di_tree *tree, se3di_tree_pack *pack)
{
    int plain = 0;
    for (uint32_t lane = 0; lane < SE3DI_TREE_PACK; ++lane) {
        const se3di_tree_node *n = &tree->nodes[pack->node[lane]];
        const double *own = tree->armature + n->v;
        plain += n->type == SE3DI_TREE_SPHERICAL && own[0] == 0.0 && own[1] == 0.0 && own[2] == 0.0;
    }
    pack->is_plain = plain == SE3DI_TREE_PACK;
    pack->factors = !(pack->flags & SE3DI_TREE_GIVEN) && (plain == 0 || pack->is_plain);
}

static void add_pack(se3di_tree *tree, uint32_t k, uint32_t count)
{
    se3di_tree_pack *pack = &tree->packs[tree->pack_count];
    for (uint32_t lane = 0; lane < SE3DI_TREE_PACK; ++lane) {
        const uint32_t place = k + (lane < count ? lane : count - 1);
        pack->node[lane] = (uint32_t)tree->keys[KEYS * (size_t)place + KEYS - 1];
    }
    const se3di_tree_node *n = &tree->nodes[pack->node[0]];
    pack->type = n->type;
    pack->flags = n->flags;
    pack->is_rooted = n->parent < 0;
    compare_armatures(tree, pack);
    tree->steps[tree->step_count++] = tree->count + tree->pack_count++;
}

void se3di_tree_find_packs(se3di_tree *tree)
{
    tree->pack_count = tree->step_count = 0;
    if (tree->pack_max == 0) {
        return;
    }
    sort_nodes(tree, ALL);
    for (uint32_t k = 0; k < tree->count;) {
        const uint32_t count = count_pack(tree, k);
        if (count > 0) {
            add_pack(tree, k, count);
        } else {
            tree->steps[tree->step_count++] = (uint32_t)tree->keys[KEYS * (size_t)k + KEYS - 1];
        }
        k += count > 0 ? count : 1;
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
            fill(1, &n->mass, lane, pack->mass);
            fill(6, n->J, lane, pack->J);
            fill((size_t)n->v_count, tree->armature + n->v, lane, pack->armature);
        }
    }
}
