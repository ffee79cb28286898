/* SPDX-License-Identifier: BSD-3-Clause */
/* Everything that follows from the elimination order: panels, the destination of every update, and
 * the list of blocks to gather, each just before it is needed.               docs/theory/kkt.md */
#include <string.h>

#include "linsol/kkt_internal.h"

static se3d_status take_structure(se3di_kkt *kkt, const se3di_kkt_fill *fill)
{
    size_t n = (size_t)kkt->node_count;
    size_t near_count = (size_t)fill->begin[n];
    kkt->position_of = se3di_kkt_take(kkt, n, sizeof(int32_t));
    kkt->size_at = se3di_kkt_take(kkt, n, sizeof(int32_t));
    kkt->row_at = se3di_kkt_take(kkt, n, sizeof(int32_t));
    kkt->is_untouched_at = se3di_kkt_take(kkt, n, sizeof(bool));
    kkt->is_full_at = se3di_kkt_take(kkt, n, sizeof(bool));
    kkt->near_begin = se3di_kkt_take(kkt, n + 1, sizeof(int32_t));
    kkt->near = se3di_kkt_take(kkt, near_count, sizeof(int32_t));
    kkt->panel = se3di_kkt_take(kkt, n + 1, sizeof(size_t));
    kkt->update_begin = se3di_kkt_take(kkt, n + 1, sizeof(size_t));
    if (kkt->out_of_memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    memcpy(kkt->near_begin, fill->begin, (n + 1) * sizeof(int32_t));
    if (near_count > 0) {
        memcpy(kkt->near, fill->near, near_count * sizeof(int32_t));
    }
    for (size_t k = 0; k < n; ++k) {
        size_t size = (size_t)kkt->node_size[kkt->node_at[k]];
        size_t degree = (size_t)(fill->begin[k + 1] - fill->begin[k]);
        kkt->position_of[kkt->node_at[k]] = (int32_t)k;
        kkt->size_at[k] = (int32_t)size;
        int32_t node = kkt->node_at[k], joint = kkt->node_joint[node];
        kkt->row_at[k] = joint < 0 ? -1 : kkt->row_offset[joint] + kkt->node_row[node];
        kkt->is_untouched_at[k] = joint < 0 && kkt->pattern.symmetric;
        kkt->panel[k + 1] = kkt->panel[k] + size * KKT_LANES * (1 + degree);
        kkt->update_begin[k + 1] = kkt->update_begin[k] + degree * (degree + 1) / 2;
        if ((int32_t)degree > kkt->max_degree) {
            kkt->max_degree = (int32_t)degree;
        }
    }
    for (size_t i = 0; i < near_count; ++i) { /* it receives fill-in */
        kkt->is_untouched_at[kkt->near[i]] = false;
    }
    kkt->bodies_first = true;
    for (size_t k = 0; k < n; ++k) {
        kkt->bodies_first = kkt->bodies_first && (kkt->is_untouched_at[k] || kkt->row_at[k] >= 0);
    }
    return SE3D_OK;
}

/* Offset of block (k, j), j >= k, which must exist. */
static size_t block_at(const se3di_kkt *kkt, int32_t k, int32_t j)
{
    size_t size = (size_t)kkt->size_at[k] * KKT_LANES;
    if (j == k) {
        return kkt->panel[k];
    }
    int32_t low = kkt->near_begin[k], high = kkt->near_begin[k + 1] - 1;
    while (low < high) {
        int32_t middle = (low + high) / 2;
        if (kkt->near[middle] < j) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return kkt->panel[k] + size * (size_t)(1 + low - kkt->near_begin[k]);
}

static se3d_status build_updates(se3di_kkt *kkt)
{
    kkt->update = se3di_kkt_take(kkt, kkt->update_begin[kkt->node_count], sizeof(size_t));
    if (!kkt->update) {
        return SE3D_ERR_NO_MEMORY;
    }
    size_t u = 0;
    for (int32_t k = 0; k < kkt->node_count; ++k) {
        for (int32_t a = kkt->near_begin[k]; a < kkt->near_begin[k + 1]; ++a) {
            for (int32_t b = a; b < kkt->near_begin[k + 1]; ++b) {
                kkt->update[u++] = block_at(kkt, kkt->near[a], kkt->near[b]);
            }
        }
    }
    return SE3D_OK;
}

/* A panel is gathered just before the first elimination that touches it. */
static se3d_status build_loads(se3di_kkt *kkt)
{
    int32_t n = kkt->node_count;
    kkt->load_begin = se3di_kkt_take(kkt, (size_t)n + 1, sizeof(int32_t));
    kkt->load = se3di_kkt_take(kkt, (size_t)n, sizeof(int32_t));
    uint8_t *loaded = se3di_alloc(&kkt->allocator, (size_t)n, 1);
    if (kkt->out_of_memory || !loaded) {
        se3di_free(&kkt->allocator, loaded, (size_t)n, 1);
        return SE3D_ERR_NO_MEMORY;
    }
    int32_t count = 0;
    for (int32_t k = 0; k < n; ++k) {
        kkt->load_begin[k] = count;
        if (!loaded[k]) {
            loaded[k] = 1;
            kkt->load[count++] = k;
        }
        for (int32_t a = kkt->near_begin[k]; a < kkt->near_begin[k + 1]; ++a) {
            if (!loaded[kkt->near[a]]) {
                loaded[kkt->near[a]] = 1;
                kkt->load[count++] = kkt->near[a];
            }
        }
    }
    kkt->load_begin[n] = count;
    se3di_free(&kkt->allocator, loaded, (size_t)n, 1);
    return SE3D_OK;
}

/* The list of sources is made twice: counted (kkt->source NULL), then written. */
typedef struct source_list {
    se3di_kkt *kkt;
    int32_t *count; /* per position */
} source_list;

static void add_source(const source_list *list, int32_t position, se3di_kkt_source source)
{
    int32_t at = list->count[position]++;
    if (list->kkt->source) {
        list->kkt->source[at] = source;
    }
}

static void add_body_sources(const source_list *list)
{
    const se3di_kkt *kkt = list->kkt;
    int32_t n = kkt->pattern.body_size;
    for (size_t i = 0; i < kkt->pattern.body_count; ++i) {
        int32_t k = kkt->position_of[i];
        add_source(list, k,
                   (se3di_kkt_source){.base = KKT_BASE_BODY,
                                      .rows = n,
                                      .source = i * (size_t)(n * n),
                                      .dest = kkt->panel[k]});
    }
}

/* `upper` receives H_ij if i goes first, else H_ji; `lower` the transpose of the other one. */
static void add_coupling_sources(const source_list *list)
{
    const se3di_kkt *kkt = list->kkt;
    const bool symmetric = kkt->pattern.symmetric;
    int32_t n = kkt->pattern.body_size;
    for (size_t e = 0; e < kkt->pattern.coupling_count; ++e) {
        int32_t i = kkt->position_of[kkt->pattern.coupling[2 * e]];
        int32_t j = kkt->position_of[kkt->pattern.coupling[2 * e + 1]];
        int32_t first = i < j ? i : j;
        se3di_kkt_source own = {.base = KKT_BASE_COUPLING_UPPER,
                                .rows = n,
                                .source = e * (size_t)(n * n),
                                .dest = block_at(kkt, first, i < j ? j : i)};
        se3di_kkt_source turned = own;
        turned.is_turned = true;
        if (symmetric) {
            add_source(list, first, i < j ? own : turned);
        } else {
            own.base = i < j ? KKT_BASE_COUPLING_UPPER : KKT_BASE_COUPLING_LOWER;
            turned.base = i < j ? KKT_BASE_COUPLING_LOWER : KKT_BASE_COUPLING_UPPER;
            turned.lower = true;
            add_source(list, first, own);
            add_source(list, first, turned);
        }
    }
}

/* One node of a joint against one body: whichever goes first owns the block; `upper` receives the
 * joint's C or the body's B, `lower` the other one, transposed alike. */
static void add_block_sources(const source_list *list, int32_t node, int32_t body, size_t at)
{
    const se3di_kkt *kkt = list->kkt;
    int32_t j = kkt->position_of[node], i = kkt->position_of[body];
    int32_t first = i < j ? i : j;
    bool is_b = i < j && !kkt->pattern.symmetric;
    at += (size_t)(kkt->node_row[node] * kkt->pattern.body_size);
    se3di_kkt_source source = {.base = is_b ? KKT_BASE_JOINT_B : KKT_BASE_JOINT,
                               .rows = kkt->node_size[node],
                               .is_turned = i < j,
                               .source = at,
                               .dest = block_at(kkt, first, i < j ? j : i)};
    add_source(list, first, source);
    if (!kkt->pattern.symmetric) {
        source.base = is_b ? KKT_BASE_JOINT : KKT_BASE_JOINT_B;
        source.lower = true;
        add_source(list, first, source);
    }
}

static void add_joint_sources(const source_list *list)
{
    const se3di_kkt *kkt = list->kkt;
    const se3di_kkt_pattern *p = &kkt->pattern;
    for (size_t j = 0; j < p->joint_count; ++j) {
        for (int32_t node = kkt->joint_node[j]; node < kkt->joint_node[j + 1]; ++node) {
            for (int32_t e = p->joint_begin[j]; e < p->joint_begin[j + 1]; ++e) {
                add_block_sources(list, node, p->joint_body[e], kkt->block_offset[e]);
            }
        }
    }
}

static void add_all_sources(const source_list *list)
{
    add_body_sources(list);
    add_coupling_sources(list);
    add_joint_sources(list);
}

/* Blocks are sourced once at most, and by the whole of their rows. */
static void find_full_panels(se3di_kkt *kkt)
{
    for (int32_t k = 0; k < kkt->node_count; ++k) {
        int32_t degree = kkt->near_begin[k + 1] - kkt->near_begin[k];
        int32_t blocks = 1 + (kkt->pattern.symmetric ? degree : 2 * degree);
        kkt->is_full_at[k] = kkt->source_begin[k + 1] - kkt->source_begin[k] == blocks;
    }
}

static se3d_status build_sources(se3di_kkt *kkt)
{
    size_t n = (size_t)kkt->node_count;
    kkt->source_begin = se3di_kkt_take(kkt, n + 1, sizeof(int32_t));
    source_list list = {kkt, se3di_alloc(&kkt->allocator, n, sizeof(int32_t))};
    if (kkt->out_of_memory || !list.count) {
        se3di_free(&kkt->allocator, list.count, n, sizeof(int32_t));
        return SE3D_ERR_NO_MEMORY;
    }
    add_all_sources(&list);
    for (size_t k = 0; k < n; ++k) {
        kkt->source_begin[k + 1] = kkt->source_begin[k] + list.count[k];
        list.count[k] = kkt->source_begin[k];
    }
    kkt->source = se3di_kkt_take(kkt, (size_t)kkt->source_begin[n], sizeof(se3di_kkt_source));
    if (kkt->source) {
        add_all_sources(&list);
        find_full_panels(kkt);
    }
    se3di_free(&kkt->allocator, list.count, n, sizeof(int32_t));
    return kkt->source ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

se3d_status se3di_kkt_symbolic_take(se3di_kkt *kkt)
{
    size_t n = (size_t)kkt->node_count, total = kkt->panel[n];
    kkt->upper = se3di_kkt_take_aligned(kkt, total);
    kkt->lower = se3di_kkt_take_aligned(kkt, kkt->pattern.symmetric ? 0 : total);
    kkt->scaled =
        se3di_kkt_take_aligned(kkt, (size_t)kkt->max_degree * SE3DI_KKT_MAX_BODY_SIZE * KKT_LANES);
    kkt->inverse_d = se3di_kkt_take_aligned(kkt, n * KKT_LANES);
    kkt->z = se3di_kkt_take_aligned(kkt, n * KKT_LANES);
    kkt->shift = se3di_kkt_take_aligned(kkt, kkt->pattern.body_count * KKT_LANES);
    kkt->pivot = se3di_kkt_take(kkt, n * KKT_LANES, 1);
    return kkt->out_of_memory ? SE3D_ERR_NO_MEMORY : SE3D_OK;
}

se3d_status se3di_kkt_symbolic_build(se3di_kkt *kkt)
{
    se3di_kkt_fill fill;
    SE3DI_TRY(se3di_kkt_fill_create(kkt, kkt->node_at, &fill));
    se3d_status status = take_structure(kkt, &fill);
    se3di_kkt_fill_destroy(kkt, &fill);
    SE3DI_TRY(status);
    SE3DI_TRY(build_updates(kkt));
    SE3DI_TRY(build_loads(kkt));
    return build_sources(kkt);
}
