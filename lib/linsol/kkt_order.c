/* SPDX-License-Identifier: BSD-3-Clause */
/* The choice of the elimination order.
 *
 * Candidates: leaf to root, joints as soon as they may go (kkt_greedy.c), and all bodies first with
 * AMD on what is left, S = C H^-1 C^T. The cheaper one by estimated vector operations is taken and
 * put in postorder, so that each node's neighbours are still in the cache.   docs/theory/kkt.md */
#include <amd.h>
#include <stddef.h>

#include "linsol/kkt_internal.h"

/* Work of AMD: the joint graph with room to grow, and its 7 integer arrays. */
typedef struct amd_memory {
    int *begin, *near, *work;
    size_t near_size, n;
} amd_memory;

/* Bodies of each joint node are a clique: neighbours of joint node `i`, counted and (if out is not
 * NULL) written. */
static size_t joint_neighbours(const se3di_kkt *kkt, int32_t i, int32_t *mark, int *out)
{
    size_t count = 0;
    int32_t bodies = (int32_t)kkt->pattern.body_count;
    mark[i] = i;
    for (int32_t g = kkt->graph_begin[i]; g < kkt->graph_begin[i + 1]; ++g) {
        int32_t body = kkt->graph[g];
        for (int32_t h = kkt->graph_begin[body]; h < kkt->graph_begin[body + 1]; ++h) {
            int32_t other = kkt->graph[h];
            if (other >= bodies && mark[other] != i) {
                mark[other] = i;
                if (out) {
                    out[count] = other - bodies;
                }
                ++count;
            }
        }
    }
    return count;
}

static void amd_order_joints(const se3di_kkt *kkt, const amd_memory *m, int32_t *mark,
                             int32_t *node_at)
{
    int32_t bodies = (int32_t)kkt->pattern.body_count;
    size_t n = m->n, used = 0;
    int *length = m->work, *nv = length + n, *next = nv + n, *last = next + n, *head = last + n;
    int *elen = head + n, *degree = elen + n, *w = degree + n;
    for (int32_t i = 0; i < kkt->node_count; ++i) {
        mark[i] = -1;
    }
    for (size_t i = 0; i < n; ++i) {
        m->begin[i] = (int)used;
        length[i] = (int)joint_neighbours(kkt, bodies + (int32_t)i, mark, m->near + used);
        used += (size_t)length[i];
    }
    double control[AMD_CONTROL], info[AMD_INFO];
    amd_defaults(control);
    amd_2((int)n, m->begin, m->near, length, (int)m->near_size, (int)used, nv, next, last, head,
          elen, degree, w, control, info);
    for (size_t k = 0; k < n; ++k) { /* amd_2 leaves the order in `last` */
        node_at[bodies + (int32_t)k] = bodies + last[k];
    }
}

/* All bodies, then the joints as AMD orders them. SE3D_ERR_UNSUPPORTED if this is no good
 * candidate: couplings between bodies, or so many joints on a body that S is nearly full. */
static se3d_status bodies_first_order(const se3di_kkt *kkt, int32_t *node_at)
{
    const se3d_allocator *allocator = &kkt->allocator;
    size_t bodies = kkt->pattern.body_count, n = (size_t)kkt->node_count - bodies;
    double pairs = 0.0;
    for (size_t i = 0; i < bodies; ++i) {
        double degree = kkt->graph_begin[i + 1] - kkt->graph_begin[i];
        pairs += degree * degree;
        node_at[i] = (int32_t)i;
    }
    if (kkt->pattern.coupling_count > 0 || n == 0 || pairs > 64.0 * (double)kkt->node_count + 1e4) {
        return SE3D_ERR_UNSUPPORTED;
    }
    amd_memory m = {.n = n};
    m.near_size = (size_t)(1.3 * pairs) + 2 * n + 16;
    m.begin = se3di_alloc(allocator, n, sizeof(int));
    m.near = se3di_alloc(allocator, m.near_size, sizeof(int));
    m.work = se3di_alloc(allocator, 8 * n, sizeof(int));
    int32_t *mark = se3di_alloc(allocator, (size_t)kkt->node_count, sizeof(int32_t));
    se3d_status status = SE3D_ERR_NO_MEMORY;
    if (m.begin && m.near && m.work && mark) {
        amd_order_joints(kkt, &m, mark, node_at);
        status = SE3D_OK;
    }
    se3di_free(allocator, m.begin, n, sizeof(int));
    se3di_free(allocator, m.near, m.near_size, sizeof(int));
    se3di_free(allocator, m.work, 8 * n, sizeof(int));
    se3di_free(allocator, mark, (size_t)kkt->node_count, sizeof(int32_t));
    return status;
}

/* Lists of the children of each node, the largest subtree first, the others just before their
 * parent needs them. size and heavy are work arrays. */
static void link_children(const se3di_kkt_fill *fill, int32_t n, int32_t *child, int32_t *sibling,
                          int32_t *size, int32_t *heavy)
{
    for (int32_t k = 0; k < n; ++k) {
        size[k] = 1;
        heavy[k] = child[k] = -1;
    }
    for (int32_t k = 0; k < n; ++k) {
        int32_t parent = fill->parent[k];
        if (parent >= 0) {
            size[parent] += size[k];
            heavy[parent] = heavy[parent] < 0 || size[k] > size[heavy[parent]] ? k : heavy[parent];
        }
    }
    for (int32_t pass = 0; pass < 2; ++pass) {
        for (int32_t k = n - 1; k >= 0; --k) {
            int32_t parent = fill->parent[k];
            if (parent >= 0 && (heavy[parent] == k) == (pass == 1)) {
                sibling[k] = child[parent];
                child[parent] = k;
            }
        }
    }
}

/* Reorder node_at into a postorder of its elimination tree; the fill-in stays the same. */
static se3d_status postorder(const se3di_kkt *kkt, const se3di_kkt_fill *fill, int32_t *node_at)
{
    int32_t n = kkt->node_count;
    int32_t *memory = se3di_alloc(&kkt->allocator, 4 * (size_t)n, sizeof(int32_t));
    if (!memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    int32_t *child = memory, *sibling = memory + n, *stack = memory + 2 * n,
            *order = memory + 3 * n;
    int32_t depth = 0, count = 0;
    link_children(fill, n, child, sibling, stack, order);
    for (int32_t root = 0; root < n; ++root) {
        if (fill->parent[root] >= 0) {
            continue;
        }
        stack[depth++] = root;
        while (depth > 0) {
            int32_t k = stack[depth - 1];
            if (child[k] >= 0) {
                stack[depth++] = child[k];
                child[k] = sibling[child[k]];
            } else {
                order[count++] = node_at[k];
                --depth;
            }
        }
    }
    for (int32_t k = 0; k < n; ++k) {
        node_at[k] = order[k];
    }
    se3di_free(&kkt->allocator, memory, 4 * (size_t)n, sizeof(int32_t));
    return SE3D_OK;
}

/* Cost of node_at and its postorder. */
static se3d_status order_finish(const se3di_kkt *kkt, int32_t *node_at, double *cost)
{
    se3di_kkt_fill fill;
    SE3DI_TRY(se3di_kkt_fill_create(kkt, node_at, &fill));
    se3d_status status = postorder(kkt, &fill, node_at);
    *cost = fill.cost;
    se3di_kkt_fill_destroy(kkt, &fill);
    return status;
}

static se3d_status choose_cheaper(se3di_kkt *kkt, int32_t *other)
{
    double other_cost;
    SE3DI_TRY(se3di_kkt_greedy_order(kkt, kkt->node_at));
    SE3DI_TRY(order_finish(kkt, kkt->node_at, &kkt->cost));
    se3d_status status = bodies_first_order(kkt, other);
    if (status == SE3D_ERR_UNSUPPORTED) {
        return SE3D_OK;
    }
    SE3DI_TRY(status);
    SE3DI_TRY(order_finish(kkt, other, &other_cost));
    if (other_cost < kkt->cost) {
        kkt->cost = other_cost;
        for (int32_t k = 0; k < kkt->node_count; ++k) {
            kkt->node_at[k] = other[k];
        }
    }
    return SE3D_OK;
}

se3d_status se3di_kkt_order_choose(se3di_kkt *kkt)
{
    size_t n = (size_t)kkt->node_count;
    int32_t *other = se3di_alloc(&kkt->allocator, n, sizeof(int32_t));
    if (!other) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3d_status status = choose_cheaper(kkt, other);
    se3di_free(&kkt->allocator, other, n, sizeof(int32_t));
    return status;
}
