/* SPDX-License-Identifier: BSD-3-Clause */
/* Creation of a KKT solver: checks, copies, graph.                           docs/theory/kkt.md */
#include "linsol/kkt.h"

#include <string.h>

#include "linsol/kkt_internal.h"

static bool joint_is_valid(const se3di_kkt_pattern *p, size_t j)
{
    int32_t begin = p->joint_begin[j], end = p->joint_begin[j + 1];
    if (p->joint_rows[j] < 0 || p->joint_rows[j] > SE3DI_KKT_MAX_JOINT_ROWS || end < begin) {
        return false;
    }
    for (int32_t e = begin; e < end; ++e) {
        if (p->joint_body[e] < 0 || (size_t)p->joint_body[e] >= p->body_count) {
            return false;
        }
        for (int32_t f = begin; f < e; ++f) {
            if (p->joint_body[f] == p->joint_body[e]) {
                return false;
            }
        }
    }
    return true;
}

static bool couplings_are_valid(const se3di_kkt_pattern *p)
{
    for (size_t e = 0; e < p->coupling_count; ++e) {
        int32_t i = p->coupling[2 * e], j = p->coupling[2 * e + 1];
        if (i < 0 || i >= j || (size_t)j >= p->body_count) {
            return false;
        }
    }
    return true;
}

static bool pattern_is_valid(const se3di_kkt_pattern *p)
{
    bool mass = p->body_kind == SE3DI_KKT_BODY_MASS;
    if (p->body_size < 1 || p->body_size > SE3DI_KKT_MAX_BODY_SIZE || (mass && p->body_size != 6) ||
        p->body_count > INT32_MAX / 64 || p->joint_count > INT32_MAX / 64) {
        return false;
    }
    for (size_t j = 0; j < p->joint_count; ++j) {
        if (p->joint_begin[0] != 0 || !joint_is_valid(p, j)) {
            return false;
        }
    }
    return couplings_are_valid(p);
}

static const int32_t *copy_ints(se3di_kkt *kkt, const int32_t *from, size_t count)
{
    int32_t *copy = se3di_kkt_take(kkt, count, sizeof(int32_t));
    if (copy && from && count > 0) {
        memcpy(copy, from, count * sizeof(int32_t));
    }
    return copy;
}

static se3d_status copy_pattern(se3di_kkt *kkt, const se3di_kkt_pattern *p)
{
    kkt->pattern = *p;
    size_t entries = p->joint_count > 0 ? (size_t)p->joint_begin[p->joint_count] : 0;
    kkt->pattern.joint_rows = copy_ints(kkt, p->joint_rows, p->joint_count);
    kkt->pattern.joint_begin =
        copy_ints(kkt, p->joint_count > 0 ? p->joint_begin : NULL, p->joint_count + 1);
    kkt->pattern.joint_body = copy_ints(kkt, p->joint_body, entries);
    kkt->pattern.coupling = copy_ints(kkt, p->coupling, 2 * p->coupling_count);
    kkt->row_offset = se3di_kkt_take(kkt, p->joint_count + 1, sizeof(int32_t));
    kkt->block_offset = se3di_kkt_take(kkt, entries, sizeof(size_t));
    return kkt->out_of_memory ? SE3D_ERR_NO_MEMORY : SE3D_OK;
}

static void build_layout(se3di_kkt *kkt)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    size_t values = 0;
    for (size_t j = 0; j < p->joint_count; ++j) {
        kkt->has_unbound = kkt->has_unbound || p->joint_begin[j + 1] == p->joint_begin[j];
        kkt->row_offset[j + 1] = kkt->row_offset[j] + p->joint_rows[j];
        for (int32_t e = p->joint_begin[j]; e < p->joint_begin[j + 1]; ++e) {
            kkt->block_offset[e] = values;
            values += (size_t)(p->joint_rows[j] * p->body_size);
        }
    }
    kkt->layout = (se3di_kkt_layout){
        .unknown_count = p->body_count * (size_t)p->body_size,
        .row_count = (size_t)kkt->row_offset[p->joint_count],
        .joint_value_count = values,
        .row_offset = kkt->row_offset,
        .block_offset = kkt->block_offset,
    };
}

/* Pieces of a joint: as few as possible, of nearly equal size. None without bodies. */
static int32_t piece_count(const se3di_kkt_pattern *p, size_t j)
{
    bool is_bound = p->joint_begin[j + 1] > p->joint_begin[j];
    return is_bound ? (p->joint_rows[j] + KKT_LANES - 1) / KKT_LANES : 0;
}

static se3d_status build_nodes(se3di_kkt *kkt)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    size_t count = p->body_count;
    for (size_t j = 0; j < p->joint_count; ++j) {
        count += (size_t)piece_count(p, j);
    }
    kkt->node_count = (int32_t)count;
    kkt->node_size = se3di_kkt_take(kkt, count, sizeof(int32_t));
    kkt->node_joint = se3di_kkt_take(kkt, count, sizeof(int32_t));
    kkt->node_row = se3di_kkt_take(kkt, count, sizeof(int32_t));
    kkt->joint_node = se3di_kkt_take(kkt, p->joint_count + 1, sizeof(int32_t));
    kkt->node_at = se3di_kkt_take(kkt, count, sizeof(int32_t));
    if (kkt->out_of_memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    int32_t node = 0;
    for (; node < (int32_t)p->body_count; ++node) {
        kkt->node_size[node] = p->body_size;
        kkt->node_joint[node] = -1;
    }
    for (size_t j = 0; j < p->joint_count; ++j) {
        int32_t pieces = piece_count(p, j), row = 0;
        kkt->joint_node[j] = node;
        for (int32_t k = 0; k < pieces; ++k, ++node) {
            kkt->node_joint[node] = (int32_t)j;
            kkt->node_row[node] = row;
            kkt->node_size[node] = (p->joint_rows[j] - row + pieces - k - 1) / (pieces - k);
            row += kkt->node_size[node];
        }
    }
    kkt->joint_node[p->joint_count] = node;
    return SE3D_OK;
}

/* Count (edges NULL) or write both directions of every edge; at[] are the ends of the lists. */
static void walk_edges(const se3di_kkt *kkt, int32_t *at, int32_t *edges)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    for (size_t j = 0; j < p->joint_count; ++j) {
        for (int32_t node = kkt->joint_node[j]; node < kkt->joint_node[j + 1]; ++node) {
            for (int32_t e = p->joint_begin[j]; e < p->joint_begin[j + 1]; ++e) {
                int32_t body = p->joint_body[e], to_node = at[body]++, to_body = at[node]++;
                if (edges) {
                    edges[to_node] = node;
                    edges[to_body] = body;
                }
            }
        }
    }
    for (size_t e = 0; e < p->coupling_count; ++e) {
        int32_t i = p->coupling[2 * e], j = p->coupling[2 * e + 1], a = at[i]++, b = at[j]++;
        if (edges) {
            edges[a] = j;
            edges[b] = i;
        }
    }
}

static se3d_status build_graph(se3di_kkt *kkt)
{
    size_t n = (size_t)kkt->node_count;
    kkt->graph_begin = se3di_kkt_take(kkt, n + 1, sizeof(int32_t));
    int32_t *at = se3di_kkt_take(kkt, n, sizeof(int32_t));
    if (kkt->out_of_memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    walk_edges(kkt, at, NULL);
    for (size_t k = 0; k < n; ++k) {
        kkt->graph_begin[k + 1] = kkt->graph_begin[k] + at[k];
        at[k] = kkt->graph_begin[k];
    }
    kkt->graph = se3di_kkt_take(kkt, (size_t)kkt->graph_begin[n], sizeof(int32_t));
    if (!kkt->graph) {
        return SE3D_ERR_NO_MEMORY;
    }
    walk_edges(kkt, at, kkt->graph);
    return SE3D_OK;
}

/* Whether bodies, the ground and joints make a loop; joints of one body are to the ground. */
static se3d_status find_loops(se3di_kkt *kkt)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    size_t n = p->body_count + 1;
    int32_t *root = se3di_alloc(&kkt->allocator, n, sizeof(int32_t));
    if (!root) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t i = 0; i < n; ++i) {
        root[i] = (int32_t)i;
    }
    for (size_t j = 0; j < p->joint_count; ++j) {
        int32_t begin = p->joint_begin[j], end = p->joint_begin[j + 1];
        int32_t a = end - begin == 1 ? (int32_t)p->body_count : -1;
        for (int32_t e = begin; e < end; ++e) {
            int32_t b = p->joint_body[e];
            while (root[b] != b) {
                b = root[b] = root[root[b]];
            }
            while (a >= 0 && root[a] != a) {
                a = root[a] = root[root[a]];
            }
            kkt->has_loop = kkt->has_loop || a == b;
            if (a >= 0) {
                root[b] = a;
            } else {
                a = b;
            }
        }
    }
    se3di_free(&kkt->allocator, root, n, sizeof(int32_t));
    return SE3D_OK;
}

static se3d_status take_vectors(se3di_kkt *kkt)
{
    size_t n = kkt->layout.unknown_count, m = kkt->layout.row_count;
    kkt->mobility = se3di_kkt_take_aligned(kkt, kkt->pattern.body_count * KKT_LANES);
    kkt->weight = se3di_kkt_take_aligned(kkt, m);
    kkt->raised = se3di_kkt_take_aligned(kkt, n * (size_t)kkt->pattern.body_size);
    kkt->raise = se3di_kkt_take_aligned(kkt, kkt->pattern.body_count);
    kkt->saved_l = se3di_kkt_take_aligned(kkt, m);
    kkt->saved_x = se3di_kkt_take_aligned(kkt, kkt->pattern.body_count);
    kkt->ratio = se3di_kkt_take_aligned(kkt, m);
    kkt->e = se3di_kkt_take_aligned(kkt, m);
    kkt->residual_b = se3di_kkt_take_aligned(kkt, n);
    kkt->residual_c = se3di_kkt_take_aligned(kkt, m);
    kkt->correction_x = se3di_kkt_take_aligned(kkt, n);
    kkt->correction_l = se3di_kkt_take_aligned(kkt, m);
    return kkt->out_of_memory ? SE3D_ERR_NO_MEMORY : SE3D_OK;
}

static void choose_level(se3di_kkt *kkt)
{
    se3di_kkt_level wish = kkt->pattern.level;
    kkt->core = se3di_kkt_core_portable();
    kkt->level = SE3DI_KKT_LEVEL_PORTABLE;
    if (wish != SE3DI_KKT_LEVEL_PORTABLE && se3di_kkt_core_avx2()) {
        kkt->core = se3di_kkt_core_avx2();
        kkt->level = SE3DI_KKT_LEVEL_AVX2;
    }
    if ((wish == SE3DI_KKT_LEVEL_AUTO || wish == SE3DI_KKT_LEVEL_AVX512) &&
        se3di_kkt_core_avx512()) {
        kkt->core = se3di_kkt_core_avx512();
        kkt->level = SE3DI_KKT_LEVEL_AVX512;
    }
}

static se3d_status build_structure(se3di_kkt *kkt, const se3di_kkt_pattern *pattern)
{
    SE3DI_TRY(copy_pattern(kkt, pattern));
    build_layout(kkt);
    SE3DI_TRY(find_loops(kkt));
    choose_level(kkt);
    SE3DI_TRY(build_nodes(kkt));
    if (kkt->kind == SE3DI_KKT_DENSE) {
        return SE3D_OK;
    }
    SE3DI_TRY(build_graph(kkt));
    SE3DI_TRY(se3di_kkt_order_choose(kkt));
    return se3di_kkt_symbolic_build(kkt);
}

/* ---- what solvers of one pattern share -------------------------------------------------------*/

static void destroy_structure(se3di_shelf_item *item)
{
    se3di_kkt_structure *structure = (se3di_kkt_structure *)(void *)item;
    const se3d_allocator allocator = structure->kkt.allocator;
    se3di_kkt_give_back(&structure->kkt);
    se3di_free(&allocator, structure, 1, sizeof *structure);
}

typedef struct wanted_structure {
    const se3di_kkt_pattern *pattern;
    se3di_kkt_kind kind;
} wanted_structure;

static bool ints_are(const int32_t *a, const int32_t *b, size_t count)
{
    return count == 0 || memcmp(a, b, count * sizeof *a) == 0;
}

static int is_structure(const se3di_shelf_item *item, const void *wanted)
{
    const se3di_kkt_structure *structure = (const se3di_kkt_structure *)(const void *)item;
    const wanted_structure *w = wanted;
    const se3di_kkt_pattern *a = &structure->kkt.pattern, *b = w->pattern;
    const size_t joints = b->joint_count;
    return structure->kkt.kind == w->kind && a->body_count == b->body_count &&
           a->joint_count == joints && a->coupling_count == b->coupling_count &&
           a->body_size == b->body_size && a->symmetric == b->symmetric &&
           a->body_kind == b->body_kind && a->level == b->level &&
           ints_are(a->joint_rows, b->joint_rows, joints) &&
           (joints == 0 ||
            (ints_are(a->joint_begin, b->joint_begin, joints + 1) &&
             ints_are(a->joint_body, b->joint_body, (size_t)b->joint_begin[joints]))) &&
           ints_are(a->coupling, b->coupling, 2 * b->coupling_count);
}

static se3d_status make_structure(const se3d_allocator *allocator, const wanted_structure *w,
                                  se3di_kkt_structure **made)
{
    se3di_kkt_structure *structure = se3di_alloc(allocator, 1, sizeof *structure);
    if (!structure) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3di_shelf_item_init(&structure->item, destroy_structure);
    structure->kkt.allocator = *allocator;
    structure->kkt.kind = w->kind;
    structure->kkt.settings = (se3di_kkt_settings){.eps = 1e-10,
                                                   .eps_min = 1e-14,
                                                   .tolerance = 1e-15,
                                                   .max_refinements = 10,
                                                   .regularise = SE3DI_KKT_REGULARISE_AUTO,
                                                   .always_check = false};
    const se3d_status status = build_structure(&structure->kkt, w->pattern);
    if (status < 0) {
        destroy_structure(&structure->item);
        return status;
    }
    *made = structure;
    return SE3D_OK;
}

static se3d_status get_structure(const se3d_allocator *allocator, const wanted_structure *w,
                                 se3di_shelf *shelf, se3di_kkt_structure **structure)
{
    *structure = (se3di_kkt_structure *)(void *)se3di_shelf_find(shelf, is_structure, w);
    if (!*structure) {
        SE3DI_TRY(make_structure(allocator, w, structure));
        se3di_shelf_put(shelf, &(*structure)->item);
    }
    return SE3D_OK;
}

se3d_status se3di_kkt_create(const se3d_allocator *allocator, const se3di_kkt_pattern *pattern,
                             se3di_kkt_kind kind, se3di_shelf *shelf, se3di_kkt **kkt)
{
    *kkt = NULL;
    if (!pattern_is_valid(pattern)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_kkt *made = se3di_alloc(allocator, 1, sizeof *made);
    if (!made) {
        return SE3D_ERR_NO_MEMORY;
    }
    const wanted_structure wanted = {pattern, kind};
    se3di_kkt_structure *structure;
    se3d_status status = get_structure(allocator, &wanted, shelf, &structure);
    if (status < 0) {
        se3di_free(allocator, made, 1, sizeof *made);
        return status;
    }
    *made = structure->kkt;
    made->allocator = *allocator;
    made->structure = structure;
    made->array_count = 0;
    status = take_vectors(made);
    if (status == SE3D_OK) {
        status =
            kind == SE3DI_KKT_DENSE ? se3di_kkt_dense_create(made) : se3di_kkt_symbolic_take(made);
    }
    if (status < 0) {
        se3di_kkt_destroy(made);
        return status;
    }
    *kkt = made;
    return SE3D_OK;
}

se3di_kkt_settings se3di_kkt_get_settings(const se3di_kkt *kkt)
{
    return kkt->settings;
}

void se3di_kkt_set_settings(se3di_kkt *kkt, const se3di_kkt_settings *settings)
{
    kkt->settings = *settings;
}

int32_t se3di_kkt_get_dependent_rows(const se3di_kkt *kkt)
{
    return kkt->dependent_rows;
}

bool se3di_kkt_has_loop(const se3di_kkt *kkt)
{
    return kkt->has_loop;
}

double se3di_kkt_get_cost(const se3di_kkt *kkt)
{
    return kkt->cost;
}
