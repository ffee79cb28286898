/* SPDX-License-Identifier: BSD-3-Clause */
#include "tree/packs.h"

#include "base/sort.h"
#include "tree/core.h"

#include <string.h>

#define KEYS   4                     /* depth, type, flags, node */
#define FEWEST 3                     /* nodes that fill a pack; two alone cost no more */
#define ALL    -1                    /* flags */
#define ALIKE  (2 * sizeof(int32_t)) /* type and flags, if they stand first */

/* How deep each node is, its type, its flags and itself, in the order of the nodes. */
static void list_keys(se3di_tree *tree, int32_t flags)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        int32_t *key = tree->keys + KEYS * (size_t)k;
        key[0] = n->parent < 0 ? 0 : tree->keys[KEYS * (size_t)n->parent] + 1;
        key[1] = n->type;
        key[2] = n->flags & flags;
        key[3] = (int32_t)k;
    }
}

/* Keys (a, b, c, node) -> (b, c, a, node), or back. */
static void turn_keys(se3di_tree *tree, int back)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        int32_t *key = tree->keys + KEYS * (size_t)k;
        const int32_t first = back ? key[2] : key[1], last = back ? key[1] : key[0];
        key[1] = back ? key[0] : key[2];
        key[0] = first;
        key[2] = last;
    }
}

/* Whether a node may be placed later than those that are as deep: nothing waits for it, and it has
 * a parent, as those have. */
static int may_wait(const se3di_tree *tree, const int32_t *key)
{
    const se3di_tree_node *n = &tree->nodes[key[KEYS - 1]];
    return n->child < 0 && n->parent >= 0;
}

static void swap(int32_t *a, int32_t *b)
{
    for (int c = 0; c < KEYS; ++c) {
        const int32_t kept = a[c];
        a[c] = b[c];
        b[c] = kept;
    }
}

/* Of the `count` nodes from `key` on, which are as deep, up to `most` leaves wait for those that
 * are `deeper`, and stand last now. Returns how many do. */
static uint32_t let_wait(const se3di_tree *tree, int32_t *key, uint32_t count, uint32_t most,
                         int32_t deeper)
{
    uint32_t waiting = 0;
    for (uint32_t k = count; k-- > 0 && waiting < most;) {
        int32_t *own = key + KEYS * (size_t)k;
        if (may_wait(tree, own)) {
            own[2] = deeper;
            ++waiting;
            swap(own, key + KEYS * (size_t)(count - waiting));
        }
    }
    return waiting;
}

/* Leaves that fill no pack of their depth go on to deeper nodes that are alike: keys are (type,
 * flags, depth, node), sorted. */
static void move_leaves(se3di_tree *tree)
{
    uint32_t waiting = 0;
    for (uint32_t k = 0; k < tree->count;) {
        int32_t *key = tree->keys + KEYS * (size_t)k;
        const int32_t depth = key[2];
        uint32_t count = 0;
        while (k + count < tree->count && memcmp(key, key + KEYS * (size_t)count, ALIKE) == 0 &&
               key[KEYS * (size_t)count + 2] == depth) {
            ++count;
        }
        const int32_t *next = key + KEYS * (size_t)count;
        const int goes_on = k + count < tree->count && memcmp(key, next, ALIKE) == 0;
        const uint32_t rest = (waiting + count) % SE3DI_TREE_PACK;
        k += count;
        waiting = goes_on && rest < FEWEST
                      ? let_wait(tree, key - KEYS * (size_t)waiting, waiting + count, rest, next[2])
                      : 0;
    }
}

/* Nodes sorted by when they are placed, then by what must be the same in a pack. */
static void sort_nodes(se3di_tree *tree)
{
    list_keys(tree, ALL);
    turn_keys(tree, 0);
    se3di_sort_tuples(tree->keys, tree->count, KEYS);
    move_leaves(tree);
    turn_keys(tree, 1);
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

/* Packs of nodes that are as deep and alike but for flags, and one more for each leaf that may go
 * on to deeper ones; never more than all nodes of a type fill. */
uint32_t se3di_tree_count_packs(se3di_tree *tree)
{
    uint32_t all[SE3DI_TREE_JOINT_COUNT] = {0}, most[SE3DI_TREE_JOINT_COUNT] = {0};
    uint32_t packs = 0, count = 0;
    list_keys(tree, 0);
    se3di_sort_tuples(tree->keys, tree->count, KEYS);
    for (uint32_t k = 0; k < tree->count; ++k) {
        const int32_t *key = tree->keys + KEYS * (size_t)k;
        const int goes_on = count > 0 && memcmp(key - KEYS, key, (KEYS - 1) * sizeof *key) == 0;
        count = goes_on ? count + 1 : 1;
        ++all[key[1]];
        most[key[1]] += (count % FEWEST == 0) + (uint32_t)may_wait(tree, key);
    }
    for (int type = 0; type < SE3DI_TREE_JOINT_COUNT; ++type) {
        packs += most[type] < all[type] / FEWEST ? most[type] : all[type] / FEWEST;
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
    sort_nodes(tree);
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
