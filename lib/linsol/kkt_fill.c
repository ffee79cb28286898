/* SPDX-License-Identifier: BSD-3-Clause */
/* Fill-in and cost of an elimination order, by merging the structures of the children in the
 * elimination tree (George and Liu 1981, chapter 5).                        docs/theory/kkt.md */
#include "base/sort.h"
#include "linsol/kkt_internal.h"

double se3di_kkt_node_cost(int32_t size, const int32_t *near_size, int32_t degree, bool is_mass)
{
    double sum = 0.0, pairs = 0.0; /* rows of all neighbours, rows of all blocks (a, b), a <= b */
    for (int32_t a = 0; a < degree; ++a) {
        sum += near_size[a];
        pairs += (double)near_size[a] * (degree - a);
    }
    double s = size;
    double own = is_mass ? 3.0 * degree : 0.5 * s * (s - 1.0) * (1.0 + degree) + 10.0 * s;
    return own + s * pairs + 2.0 * s * (1.0 + degree) + 2.0 * sum;
}

void se3di_kkt_fill_destroy(const se3di_kkt *kkt, se3di_kkt_fill *fill)
{
    size_t n = (size_t)kkt->node_count;
    se3di_free(&kkt->allocator, fill->begin, n + 1, sizeof(int32_t));
    se3di_free(&kkt->allocator, fill->parent, n, sizeof(int32_t));
    se3di_free(&kkt->allocator, fill->near, fill->capacity, sizeof(int32_t));
    *fill = (se3di_kkt_fill){0};
}

/* Work arrays, each [node_count]. */
typedef struct fill_work {
    int32_t *position, *child, *sibling, *mark, *near_size;
    int32_t *memory;
} fill_work;

/* Add position p to the structure of k unless it is there or not later. */
static void add_near(se3di_kkt_fill *fill, fill_work *work, int32_t k, int32_t p)
{
    if (p > k && work->mark[p] != k) {
        work->mark[p] = k;
        fill->near[fill->begin[k + 1]++] = p;
    }
}

static void merge_structures(const se3di_kkt *kkt, int32_t node, int32_t k, se3di_kkt_fill *fill,
                             fill_work *work)
{
    fill->begin[k + 1] = fill->begin[k];
    for (int32_t g = kkt->graph_begin[node]; g < kkt->graph_begin[node + 1]; ++g) {
        add_near(fill, work, k, work->position[kkt->graph[g]]);
    }
    for (int32_t c = work->child[k]; c >= 0; c = work->sibling[c]) {
        for (int32_t g = fill->begin[c]; g < fill->begin[c + 1]; ++g) {
            add_near(fill, work, k, fill->near[g]);
        }
    }
    size_t degree = (size_t)(fill->begin[k + 1] - fill->begin[k]);
    if (degree > 1) {
        se3di_sort_tuples(fill->near + fill->begin[k], degree, 1);
    }
}

static se3d_status fill_all(const se3di_kkt *kkt, const int32_t *node_at, se3di_kkt_fill *fill,
                            fill_work *work)
{
    int32_t n = kkt->node_count;
    bool mass = kkt->pattern.body_kind == SE3DI_KKT_BODY_MASS;
    for (int32_t k = 0; k < n; ++k) {
        work->position[node_at[k]] = k;
        work->child[k] = work->sibling[k] = work->mark[k] = -1;
    }
    for (int32_t k = 0; k < n; ++k) {
        void *near = fill->near;
        SE3DI_TRY(se3di_array_reserve(&kkt->allocator, &near, &fill->capacity,
                                      (size_t)fill->begin[k] + (size_t)n, sizeof(int32_t)));
        fill->near = near;
        int32_t node = node_at[k];
        merge_structures(kkt, node, k, fill, work);
        int32_t degree = fill->begin[k + 1] - fill->begin[k];
        for (int32_t a = 0; a < degree; ++a) {
            work->near_size[a] = kkt->node_size[node_at[fill->near[fill->begin[k] + a]]];
        }
        fill->cost += se3di_kkt_node_cost(kkt->node_size[node], work->near_size, degree,
                                          mass && kkt->node_joint[node] < 0 && work->child[k] < 0);
        int32_t parent = degree > 0 ? fill->near[fill->begin[k]] : -1;
        fill->parent[k] = parent;
        if (parent >= 0) {
            work->sibling[k] = work->child[parent];
            work->child[parent] = k;
        }
    }
    return SE3D_OK;
}

se3d_status se3di_kkt_fill_create(const se3di_kkt *kkt, const int32_t *node_at,
                                  se3di_kkt_fill *fill)
{
    size_t n = (size_t)kkt->node_count;
    *fill = (se3di_kkt_fill){0};
    void *near = NULL;
    size_t wish = 2 * (size_t)kkt->graph_begin[n] + n;
    fill_work work = {0};
    work.memory = se3di_alloc(&kkt->allocator, 5 * n, sizeof(int32_t));
    fill->begin = se3di_alloc(&kkt->allocator, n + 1, sizeof(int32_t));
    fill->parent = se3di_alloc(&kkt->allocator, n, sizeof(int32_t));
    se3d_status status =
        se3di_array_reserve(&kkt->allocator, &near, &fill->capacity, wish, sizeof(int32_t));
    fill->near = near;
    if (work.memory && fill->begin && fill->parent && status == SE3D_OK) {
        work.position = work.memory;
        work.child = work.memory + n;
        work.sibling = work.memory + 2 * n;
        work.mark = work.memory + 3 * n;
        work.near_size = work.memory + 4 * n;
        status = fill_all(kkt, node_at, fill, &work);
    } else {
        status = SE3D_ERR_NO_MEMORY;
    }
    se3di_free(&kkt->allocator, work.memory, 5 * n, sizeof(int32_t));
    if (status < 0) {
        se3di_kkt_fill_destroy(kkt, fill);
    }
    return status;
}
