/* SPDX-License-Identifier: BSD-3-Clause */
/* An elimination order of least local cost.
 *
 * A joint that is eliminated while its neighbours are not must not be redundant for a time: while
 * a set of nodes is eliminated, the bodies outside it count as fixed. The eliminated bodies form
 * components, linked by eliminated joints; a component that is attached to two or more fixed
 * bodies (`anchors`, the ground is one) may be held redundantly although the whole is not. With
 * one anchor it never is, because a free component moves with its anchor as a rigid whole. So a
 * joint may go only when the component that it makes has at most one anchor. Bodies may always go,
 * hence an order always exists; on a tree it is leaf to root.                docs/theory/kkt.md */
#include <string.h>

#include "linsol/kkt_internal.h"

enum { ANCHOR_NONE = -1, ANCHOR_GROUND = -2, ANCHOR_MANY = -3 };

typedef struct node_set { /* neighbours in the elimination graph */
    int32_t *item;
    size_t count, capacity;
} node_set;

typedef struct greedy {
    const se3di_kkt *kkt;
    node_set *near;
    int32_t *memory;
    int32_t *component; /* union-find parent, bodies only */
    int32_t *anchor;    /* of the component's root: a body, or ANCHOR_... */
    int32_t *mark, *heap_at, *sizes, *heap;
    double *cost;
    uint8_t *gone;
    int32_t heap_count, stamp;
} greedy;

static int32_t find_root(const greedy *g, int32_t body)
{
    while (g->component[body] != body) {
        g->component[body] = g->component[g->component[body]];
        body = g->component[body];
    }
    return body;
}

static int32_t join_anchors(int32_t a, int32_t b)
{
    if (a == ANCHOR_NONE || a == b) {
        return b;
    }
    return b == ANCHOR_NONE ? a : ANCHOR_MANY;
}

/* Anchor of the component that eliminating joint `node` would make; ANCHOR_MANY if it may not
 * go. So it never goes before all its bodies: it has two, or one and the ground. */
static int32_t joint_anchor(const greedy *g, int32_t node)
{
    const se3di_kkt_pattern *p = &g->kkt->pattern;
    int32_t joint = g->kkt->node_joint[node];
    int32_t begin = p->joint_begin[joint], end = p->joint_begin[joint + 1];
    int32_t anchor = end - begin < 2 ? ANCHOR_GROUND : ANCHOR_NONE;
    for (int32_t e = begin; e < end; ++e) {
        int32_t body = p->joint_body[e];
        if (g->gone[body]) {
            anchor = join_anchors(anchor, g->anchor[find_root(g, body)]);
        } else {
            anchor = join_anchors(anchor, body);
        }
    }
    return anchor;
}

static double node_key(greedy *g, int32_t node)
{
    const node_set *set = &g->near[node];
    bool is_body = g->kkt->node_joint[node] < 0;
    if (!is_body && joint_anchor(g, node) == ANCHOR_MANY) {
        return 1e300;
    }
    for (size_t k = 0; k < set->count; ++k) {
        g->sizes[k] = g->kkt->node_size[set->item[k]];
    }
    return se3di_kkt_node_cost(g->kkt->node_size[node], g->sizes, (int32_t)set->count, false);
}

/* The heap: least cost first, then least node, so that the order is unique. */
static bool heap_before(const greedy *g, int32_t a, int32_t b)
{
    return g->cost[a] < g->cost[b] || (!(g->cost[b] < g->cost[a]) && a < b);
}

static void heap_put(greedy *g, int32_t at, int32_t node)
{
    g->heap[at] = node;
    g->heap_at[node] = at;
}

static void heap_up(greedy *g, int32_t at)
{
    int32_t node = g->heap[at];
    while (at > 0 && heap_before(g, node, g->heap[(at - 1) / 2])) {
        heap_put(g, at, g->heap[(at - 1) / 2]);
        at = (at - 1) / 2;
    }
    heap_put(g, at, node);
}

static void heap_down(greedy *g, int32_t at)
{
    int32_t node = g->heap[at];
    for (int32_t child = 2 * at + 1; child < g->heap_count; child = 2 * at + 1) {
        if (child + 1 < g->heap_count && heap_before(g, g->heap[child + 1], g->heap[child])) {
            ++child;
        }
        if (!heap_before(g, g->heap[child], node)) {
            break;
        }
        heap_put(g, at, g->heap[child]);
        at = child;
    }
    heap_put(g, at, node);
}

static void heap_update(greedy *g, int32_t node)
{
    g->cost[node] = node_key(g, node);
    heap_up(g, g->heap_at[node]);
    heap_down(g, g->heap_at[node]);
}

static int32_t heap_pop(greedy *g)
{
    int32_t node = g->heap[0];
    int32_t last = g->heap[--g->heap_count];
    if (g->heap_count > 0) {
        heap_put(g, 0, last);
        heap_down(g, 0);
    }
    return node;
}

/* Keep the components up to date; `node` is about to go. */
static void eliminate_component(greedy *g, int32_t node)
{
    const se3di_kkt *kkt = g->kkt;
    const se3di_kkt_pattern *p = &kkt->pattern;
    int32_t joint = kkt->node_joint[node];
    if (joint < 0) { /* components anchored at this body become one with it */
        for (int32_t body = 0; body < (int32_t)p->body_count; ++body) {
            if (g->gone[body] && g->component[body] == body && g->anchor[body] == node) {
                g->component[body] = node;
            }
        }
        g->anchor[node] = ANCHOR_NONE;
        return;
    }
    int32_t anchor = joint_anchor(g, node);
    int32_t root = -1;
    for (int32_t e = p->joint_begin[joint]; e < p->joint_begin[joint + 1]; ++e) {
        int32_t body = p->joint_body[e];
        if (g->gone[body]) {
            int32_t other = find_root(g, body);
            root = root < 0 ? other : root;
            g->component[other] = root;
        }
    }
    if (root >= 0) {
        g->anchor[root] = anchor;
    }
}

/* near[i] becomes (near[i] + near[node]) - {i, node}. */
static se3d_status merge_near(greedy *g, int32_t i, int32_t node)
{
    node_set *set = &g->near[i];
    const node_set *add = &g->near[node];
    void *item = set->item;
    SE3DI_TRY(se3di_array_reserve(&g->kkt->allocator, &item, &set->capacity,
                                  set->count + add->count, sizeof(int32_t)));
    set->item = item;
    int32_t stamp = ++g->stamp;
    size_t count = 0;
    for (size_t k = 0; k < set->count; ++k) {
        if (set->item[k] != node) {
            g->mark[set->item[k]] = stamp;
            set->item[count++] = set->item[k];
        }
    }
    for (size_t k = 0; k < add->count; ++k) {
        int32_t other = add->item[k];
        if (other != i && g->mark[other] != stamp) {
            set->item[count++] = other;
        }
    }
    set->count = count;
    return SE3D_OK;
}

static se3d_status greedy_run(greedy *g, int32_t *node_at)
{
    const se3di_kkt *kkt = g->kkt;
    int32_t n = kkt->node_count;
    for (int32_t i = 0; i < n; ++i) {
        size_t count = (size_t)(kkt->graph_begin[i + 1] - kkt->graph_begin[i]);
        void *item = NULL;
        SE3DI_TRY(se3di_array_reserve(&kkt->allocator, &item, &g->near[i].capacity, count,
                                      sizeof(int32_t)));
        g->near[i].item = item;
        g->near[i].count = count;
        if (count > 0) {
            memcpy(item, kkt->graph + kkt->graph_begin[i], count * sizeof(int32_t));
        }
        g->component[i] = i;
        g->anchor[i] = ANCHOR_NONE;
    }
    for (int32_t i = 0; i < n; ++i) {
        g->cost[i] = node_key(g, i);
        heap_put(g, g->heap_count, i);
        heap_up(g, g->heap_count++);
    }
    for (int32_t k = 0; k < n; ++k) {
        int32_t node = heap_pop(g);
        node_at[k] = node;
        eliminate_component(g, node);
        g->gone[node] = 1;
        for (size_t a = 0; a < g->near[node].count; ++a) {
            SE3DI_TRY(merge_near(g, g->near[node].item[a], node));
        }
        for (size_t a = 0; a < g->near[node].count; ++a) {
            heap_update(g, g->near[node].item[a]);
        }
    }
    return SE3D_OK;
}

se3d_status se3di_kkt_greedy_order(const se3di_kkt *kkt, int32_t *node_at)
{
    size_t n = (size_t)kkt->node_count;
    const se3d_allocator *allocator = &kkt->allocator;
    greedy g = {.kkt = kkt};
    g.near = se3di_alloc(allocator, n, sizeof(node_set));
    g.memory = se3di_alloc(allocator, 6 * n, sizeof(int32_t));
    g.cost = se3di_alloc(allocator, n, sizeof(double));
    g.gone = se3di_alloc(allocator, n, 1);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    if (g.near && g.memory && g.cost && g.gone) {
        g.component = g.memory;
        g.anchor = g.memory + n;
        g.mark = g.memory + 2 * n;
        g.heap_at = g.memory + 3 * n;
        g.sizes = g.memory + 4 * n;
        g.heap = g.memory + 5 * n;
        status = greedy_run(&g, node_at);
    }
    for (size_t i = 0; g.near && i < n; ++i) {
        se3di_free(allocator, g.near[i].item, g.near[i].capacity, sizeof(int32_t));
    }
    se3di_free(allocator, g.near, n, sizeof(node_set));
    se3di_free(allocator, g.memory, 6 * n, sizeof(int32_t));
    se3di_free(allocator, g.cost, n, sizeof(double));
    se3di_free(allocator, g.gone, n, 1);
    return status;
}
