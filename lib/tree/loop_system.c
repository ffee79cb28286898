/* SPDX-License-Identifier: BSD-3-Clause */
/* The blocks of S that are not zero, their order of elimination, and the use of the factors.
 *
 * Strips of rows are ordered by AMD, freedoms that are only passed stand last; which blocks fill
 * follows from walks up the elimination tree, as in Davis, Direct Methods for Sparse Linear
 * Systems, 2006, sec. 4.1.                                  docs/theory/joint_coordinates.md */
#include "tree/loop_system.h"

#include <amd.h>
#include <math.h>
#include <string.h>

#include "tree/loop_core.h"
#include "tree/loops.h"

#define CLEAR      1e-4 /* of the usual size of a pivot */
#define NEAR       1e-2 /* the same: a singular position is not far */
#define EXACT      1e-3 /* of a row's size: a smaller pivot leaves rounding in what is added */
#define USUAL_MIN  1e-9 /* of a row's size: rows with less depend on others at every pose, or are */
#define PIVOT_MIN  1e-11 /*     made of what shapes are off, and no pivot below this serves */
#define PASSES_MIN 4     /* strips that only pass a freedom, so that it pays to keep it */
#define PAIRS_MAX  1000  /* of strips on one freedom, a strip: S is nearly full beyond */

#define SYSTEM_STRIPS 13
#define SYSTEM_BLOCKS 7

static void list_strips(se3di_loop_system *s, se3di_array list[SYSTEM_STRIPS])
{
    const size_t n = (size_t)s->strip_count, lanes = SE3DI_STRIP * n, size = sizeof(double);
    const se3di_array arrays[] = {
        {(void **)&s->strips, n, sizeof *s->strips},
        {(void **)&s->is_passed, s->velocity_count, sizeof *s->is_passed},
        {(void **)&s->where, n, sizeof *s->where},
        {(void **)&s->carried, n, sizeof *s->carried},
        {(void **)&s->pivot, lanes, size},
        {(void **)&s->weight, lanes, size},
        {(void **)&s->usual, lanes, size},
        {(void **)&s->least, lanes, size},
        {(void **)&s->bound, lanes, size},
        {(void **)&s->c, lanes, size},
        {(void **)&s->z, lanes, size},
        {(void **)&s->rest, lanes, size},
        {(void **)&s->Y, SE3DI_STRIP * s->quad_count, size},
    };
    _Static_assert(sizeof arrays == SYSTEM_STRIPS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void list_blocks(se3di_loop_system *s, se3di_array list[SYSTEM_BLOCKS])
{
    const size_t n = (size_t)s->strip_count + 1, entries = s->entry_count;
    const se3di_array arrays[] = {
        {(void **)&s->column_begin, n, sizeof *s->column_begin},
        {(void **)&s->row_begin, n, sizeof *s->row_begin},
        {(void **)&s->column_row, entries, sizeof *s->column_row},
        {(void **)&s->row_entry, entries, sizeof *s->row_entry},
        {(void **)&s->row_column, entries, sizeof *s->row_column},
        {(void **)&s->product_begin, entries + 1, sizeof *s->product_begin},
        {(void **)&s->X, SE3DI_STRIP * SE3DI_STRIP * entries, sizeof *s->X},
    };
    _Static_assert(sizeof arrays == SYSTEM_BLOCKS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

/* ---- strips ---- */

/* Which strips have a number at a freedom. */
typedef struct strip_use {
    int32_t strip, Y;
} strip_use;

typedef struct builder {
    se3di_loop_system *system;
    const se3di_tree_loops *loops;
    int32_t *begin; /* [velocities + 1] into */
    strip_use *use; /* [quads] strips ascending */
    int32_t *count, *parent, *mark, *order;
    int32_t *passes; /* [nodes] */
    size_t strips, near_size;
    int *near, *near_begin, *work;
} builder;

#define BUILDER_LISTS 6

static void list_builder(builder *b, se3di_array list[BUILDER_LISTS])
{
    const se3di_array arrays[] = {
        {(void **)&b->begin, b->system->velocity_count + 1, sizeof *b->begin},
        {(void **)&b->use, b->system->quad_count, sizeof *b->use},
        {(void **)&b->count, b->strips, sizeof *b->count},
        {(void **)&b->parent, b->strips, sizeof *b->parent},
        {(void **)&b->mark, b->strips, sizeof *b->mark},
        {(void **)&b->order, b->strips, sizeof *b->order},
    };
    _Static_assert(sizeof arrays == BUILDER_LISTS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static int32_t strips_of(int32_t rows)
{
    return (rows + SE3DI_STRIP - 1) / SE3DI_STRIP;
}

/* Strips of freedoms are no wider than those of rows: columns that are not used cost as much. */
static int32_t strips_of_freedoms(const se3di_loop_system *s, int32_t freedoms)
{
    return (freedoms + s->width - 1) / s->width;
}

/* Bodies of a constraint at each node or beyond it, added to `beyond`. */
static void add_bodies(const se3di_tree_loops *loops, uint32_t constraint, int32_t *beyond)
{
    const se3di_tree *tree = loops->tree;
    const se3di_assembly *a = loops->assembly;
    for (int32_t e = a->joint_begin[constraint]; e < a->joint_begin[constraint + 1]; ++e) {
        int32_t at = tree->node_of[a->free_body[a->joint_body[e]]];
        for (; at >= 0; at = tree->nodes[at].parent) {
            ++beyond[at];
        }
    }
}

/* passes [nodes]: strips of rows that pass the node, below 0 if one of their loops is not closed
 * beyond it: it may need the freedoms. */
static void count_passes(const se3di_tree_loops *loops, int32_t *passes)
{
    int32_t *beyond = loops->place_of;
    memset(beyond, 0, loops->tree->count * sizeof *beyond);
    for (uint32_t k = 0; k < loops->count; ++k) {
        const uint32_t constraint = loops->constraints[k];
        const uint32_t bodies = loops->tree->model->constraints[constraint].body_count;
        add_bodies(loops, constraint, beyond);
        for (int32_t p = loops->path_begin[k]; p < loops->path_begin[k + 1]; ++p) {
            const int32_t node = loops->path_node[p];
            const int is_closed = (uint32_t)beyond[node] >= bodies;
            passes[node] = is_closed && passes[node] >= 0
                               ? passes[node] + strips_of(loops->kept_count[k])
                               : -1;
            beyond[node] = 0;
        }
    }
}

/* Nodes whose freedoms stand last. */
static int keeps_freedoms(const builder *b, uint32_t node)
{
    const se3di_tree_node *n = &b->loops->tree->nodes[node];
    return n->v_count > 0 && !(n->flags & SE3DI_TREE_GIVEN) && b->passes[node] >= PASSES_MIN;
}

static void measure(builder *b)
{
    se3di_loop_system *s = b->system;
    const se3di_tree_loops *loops = b->loops;
    s->velocity_count = loops->tree->v_count;
    s->width = 2;
    for (uint32_t k = 0; k < loops->count; ++k) {
        const int32_t strips = strips_of(loops->kept_count[k]);
        const int32_t widest = strips > 1 ? SE3DI_STRIP : loops->kept_count[k];
        s->row_strips += strips;
        s->width = widest > s->width ? widest : s->width;
        s->quad_count +=
            (size_t)strips * (size_t)(loops->member_begin[k + 1] - loops->member_begin[k]);
    }
    s->strip_count = s->row_strips;
    for (uint32_t i = 0; s->row_strips >= PASSES_MIN && i < loops->tree->count; ++i) {
        if (keeps_freedoms(b, i)) {
            s->strip_count += strips_of_freedoms(s, loops->tree->nodes[i].v_count);
        }
    }
    b->strips = (size_t)s->strip_count;
}

static void make_strips(builder *b)
{
    se3di_loop_system *s = b->system;
    const se3di_tree_loops *loops = b->loops;
    se3di_loop_strip *strip = s->strips;
    int32_t Y = 0;
    for (uint32_t k = 0; k < loops->count; ++k) {
        for (int32_t r = 0; r < loops->kept_count[k]; r += SE3DI_STRIP) {
            const int32_t rest = loops->kept_count[k] - r;
            *strip++ = (se3di_loop_strip){.loop = (int32_t)k,
                                          .first = r,
                                          .count = rest < SE3DI_STRIP ? rest : SE3DI_STRIP,
                                          .Y = Y};
            Y += loops->member_begin[k + 1] - loops->member_begin[k];
        }
    }
    const int keeps = s->strip_count > s->row_strips;
    for (uint32_t i = 0; keeps && i < loops->tree->count; ++i) {
        const se3di_tree_node *n = &loops->tree->nodes[i];
        for (int32_t j = 0; keeps_freedoms(b, i) && j < n->v_count; j += s->width) {
            const int32_t rest = n->v_count - j, count = rest < s->width ? rest : s->width;
            *strip++ = (se3di_loop_strip){.loop = -1, .first = (int32_t)n->v + j, .count = count};
            memset(s->is_passed + n->v + j, 1, (size_t)count);
        }
    }
}

static void list_uses(builder *b)
{
    const se3di_loop_system *s = b->system;
    memset(b->begin, 0, (s->velocity_count + 1) * sizeof *b->begin);
    for (int pass = 0; pass < 2; ++pass) {
        for (int32_t k = 0; k < s->row_strips; ++k) {
            const se3di_loop_strip *strip = &s->strips[k];
            const int32_t first = s->member_begin[strip->loop];
            for (int32_t m = first; m < s->member_begin[strip->loop + 1]; ++m) {
                int32_t *at = &b->begin[s->member[m] + 1];
                if (pass == 1) {
                    b->use[at[-1]++] = (strip_use){k, strip->Y + m - first};
                } else {
                    ++*at;
                }
            }
        }
        for (size_t v = 0; pass == 0 && v < s->velocity_count; ++v) {
            b->begin[v + 1] += b->begin[v];
        }
    }
    for (size_t v = s->velocity_count; v > 0; --v) { /* ends -> beginnings */
        b->begin[v] = b->begin[v - 1];
    }
    b->begin[0] = 0;
}

/* ---- order ---- */

static size_t count_pairs(const builder *b)
{
    size_t pairs = 0;
    for (size_t v = 0; v < b->system->velocity_count; ++v) {
        const size_t n = (size_t)(b->begin[v + 1] - b->begin[v]);
        pairs += b->system->is_passed[v] ? 0 : n * n;
    }
    return pairs;
}

/* Strips that share a freedom with strip k, into `out`; returns how many. */
static size_t list_near(const builder *b, int32_t k, int *out)
{
    const se3di_loop_system *s = b->system;
    const int32_t loop = s->strips[k].loop;
    size_t count = 0;
    b->mark[k] = k;
    for (int32_t m = s->member_begin[loop]; m < s->member_begin[loop + 1]; ++m) {
        const int32_t v = s->member[m];
        for (int32_t u = b->begin[v]; !s->is_passed[v] && u < b->begin[v + 1]; ++u) {
            const int32_t other = b->use[u].strip;
            if (b->mark[other] != k) {
                b->mark[other] = k;
                out[count++] = other;
            }
        }
    }
    return count;
}

static void run_amd(builder *b)
{
    const size_t n = (size_t)b->system->row_strips;
    int *length = b->work, *nv = length + n, *next = nv + n, *last = next + n, *head = last + n;
    int *elen = head + n, *degree = elen + n, *w = degree + n;
    double control[AMD_CONTROL], info[AMD_INFO];
    size_t used = 0;
    for (size_t k = 0; k < b->strips; ++k) {
        b->mark[k] = -1;
    }
    for (size_t k = 0; k < n; ++k) {
        b->near_begin[k] = (int)used;
        length[k] = (int)list_near(b, (int32_t)k, b->near + used);
        used += (size_t)length[k];
    }
    amd_defaults(control);
    amd_2((int)n, b->near_begin, b->near, length, (int)b->near_size, (int)used, nv, next, last,
          head, elen, degree, w, control, info);
    for (size_t k = 0; k < n; ++k) { /* amd_2 leaves the order in `last` */
        b->order[k] = last[k];
    }
}

static se3d_status find_order(builder *b, const se3d_allocator *allocator)
{
    const size_t n = (size_t)b->system->row_strips, pairs = count_pairs(b);
    b->near_size = (size_t)(1.3 * (double)pairs) + 2 * n + 16;
    const se3di_array arrays[3] = {{(void **)&b->near, b->near_size, sizeof *b->near},
                                   {(void **)&b->near_begin, n, sizeof *b->near_begin},
                                   {(void **)&b->work, 8 * n, sizeof *b->work}};
    const se3d_status status = se3di_arrays_alloc(allocator, arrays, 3);
    if (status >= 0) {
        run_amd(b);
    }
    se3di_arrays_free(allocator, arrays, 3);
    return status;
}

/* Strips of rows stand as they are eliminated. */
static void sort_strips(builder *b)
{
    se3di_loop_system *s = b->system;
    for (int32_t k = 0; k < s->row_strips; ++k) { /* cycle by cycle */
        int32_t from = b->order[k];
        while (from < k) {
            from = b->order[from];
        }
        const se3di_loop_strip moved = s->strips[k];
        s->strips[k] = s->strips[from];
        s->strips[from] = moved;
    }
}

/* ---- blocks ---- */

/* From a block in row k and column `at` all those that fill follow: columns up the elimination
 * tree. */
static void walk(builder *b, int32_t k, int32_t at, int fills)
{
    se3di_loop_system *s = b->system;
    for (; b->mark[at] != k; at = b->parent[at]) {
        if (b->parent[at] < 0) {
            b->parent[at] = k;
        }
        b->mark[at] = k;
        if (fills) {
            const int32_t entry = s->column_begin[at] + b->count[at];
            const int32_t place = s->row_begin[k + 1]++;
            s->column_row[entry] = k;
            s->row_entry[place] = entry;
            s->row_column[place] = at;
        }
        ++b->count[at];
    }
}

static void walk_uses(builder *b, int32_t k, int32_t v, int fills)
{
    for (int32_t u = b->begin[v]; u < b->begin[v + 1] && b->use[u].strip < k; ++u) {
        walk(b, k, b->use[u].strip, fills);
    }
}

/* Columns of L, or only how long they are (b->count). */
static void find_columns(builder *b, int fills)
{
    se3di_loop_system *s = b->system;
    for (int32_t k = 0; k < s->strip_count; ++k) {
        const se3di_loop_strip *strip = &s->strips[k];
        b->parent[k] = -1;
        b->mark[k] = k;
        b->count[k] = 1; /* the diagonal */
        if (fills) {
            s->column_row[s->column_begin[k]] = k;
            s->row_begin[k + 1] = s->row_begin[k];
        }
        if (strip->loop < 0) {
            walk_uses(b, k, strip->first, fills);
            continue;
        }
        for (int32_t m = s->member_begin[strip->loop]; m < s->member_begin[strip->loop + 1]; ++m) {
            if (!s->is_passed[s->member[m]]) {
                walk_uses(b, k, s->member[m], fills);
            }
        }
    }
}

/* Products of blocks, counted or written. */
static void add_product(se3di_loop_system *s, int32_t entry, const se3di_loop_product *product,
                        int fills)
{
    if (fills) {
        s->products[s->product_begin[entry]++] = *product;
    } else {
        ++s->product_begin[entry + 1];
    }
}

/* Of column k with strips of rows. */
static void add_shared(builder *b, int32_t k, int fills)
{
    se3di_loop_system *s = b->system;
    const se3di_loop_strip *strip = &s->strips[k];
    const int32_t first = s->member_begin[strip->loop];
    for (int32_t m = first; m < s->member_begin[strip->loop + 1]; ++m) {
        const int32_t v = s->member[m];
        for (int32_t u = b->begin[v]; !s->is_passed[v] && u < b->begin[v + 1]; ++u) {
            const strip_use *use = &b->use[u];
            if (use->strip >= k) {
                const se3di_loop_product product = {use->Y, strip->Y + m - first, v};
                add_product(s, s->where[use->strip], &product, fills);
            }
        }
    }
}

/* The same with freedoms that stand last. */
static void add_passed(builder *b, int32_t k, int fills)
{
    se3di_loop_system *s = b->system;
    for (int32_t h = s->row_strips; h < s->strip_count; ++h) {
        const se3di_loop_strip *strip = &s->strips[h];
        for (int32_t u = b->begin[strip->first]; u < b->begin[strip->first + 1]; ++u) {
            if (b->use[u].strip == k) {
                const se3di_loop_product product = {b->use[u].Y, strip->count, -1};
                add_product(s, s->where[h], &product, fills);
            }
        }
    }
}

static void find_products(builder *b, int fills)
{
    se3di_loop_system *s = b->system;
    for (int32_t k = 0; k < s->row_strips; ++k) {
        for (int32_t e = s->column_begin[k]; e < s->column_begin[k + 1]; ++e) {
            s->where[s->column_row[e]] = e;
        }
        add_shared(b, k, fills);
        add_passed(b, k, fills);
    }
    for (size_t e = 0; !fills && e < s->entry_count; ++e) {
        s->product_begin[e + 1] += s->product_begin[e];
    }
    for (size_t e = s->entry_count; fills && e > 0; --e) { /* ends -> beginnings */
        s->product_begin[e] = s->product_begin[e - 1];
    }
    s->product_begin[0] = 0;
}

static se3d_status make_blocks(builder *b, const se3d_allocator *allocator)
{
    se3di_loop_system *s = b->system;
    se3di_array blocks[SYSTEM_BLOCKS];
    find_columns(b, 0);
    for (size_t k = 0; k < b->strips; ++k) {
        s->entry_count += (size_t)b->count[k];
    }
    list_blocks(s, blocks);
    SE3DI_TRY(se3di_arrays_alloc(allocator, blocks, SYSTEM_BLOCKS));
    for (size_t k = 0; k < b->strips; ++k) {
        s->column_begin[k + 1] = s->column_begin[k] + b->count[k];
    }
    find_columns(b, 1);
    find_products(b, 0);
    s->product_count = (size_t)s->product_begin[s->entry_count];
    s->products = se3di_alloc(allocator, s->product_count, sizeof *s->products);
    if (!s->products) {
        return SE3D_ERR_NO_MEMORY;
    }
    find_products(b, 1);
    return SE3D_OK;
}

static se3d_status build(builder *b, const se3d_allocator *allocator)
{
    se3di_loop_system *s = b->system;
    list_uses(b);
    if (count_pairs(b) > PAIRS_MAX * b->strips) {
        return SE3D_OK;
    }
    SE3DI_TRY(find_order(b, allocator));
    sort_strips(b);
    list_uses(b);
    SE3DI_TRY(make_blocks(b, allocator));
    se3di_loop_system_forget(s);
    s->is_there = 1;
    return SE3D_OK;
}

static se3d_status make(builder *b, const se3d_allocator *allocator)
{
    se3di_array lists[BUILDER_LISTS], strips[SYSTEM_STRIPS];
    count_passes(b->loops, b->passes);
    measure(b);
    if (b->system->row_strips == 0) {
        return SE3D_OK;
    }
    list_builder(b, lists);
    list_strips(b->system, strips);
    se3d_status status = se3di_arrays_alloc(allocator, strips, SYSTEM_STRIPS);
    status = status < 0 ? status : se3di_arrays_alloc(allocator, lists, BUILDER_LISTS);
    if (status >= 0) {
        make_strips(b);
        status = build(b, allocator);
    }
    se3di_arrays_free(allocator, lists, BUILDER_LISTS);
    return status;
}

se3d_status se3di_loop_system_init(se3di_loop_system *system, const se3di_tree_loops *loops)
{
    const se3d_allocator *allocator = &loops->tree->model->allocator;
    const size_t nodes = loops->tree->count;
    const se3di_loop_core *avx2 = se3di_loop_core_avx2();
    builder b = {.system = system, .loops = loops};
    *system = (se3di_loop_system){.core = avx2 ? avx2 : se3di_loop_core_portable(),
                                  .member_begin = loops->member_begin,
                                  .member = loops->member};
    b.passes = se3di_alloc(allocator, nodes, sizeof *b.passes);
    const se3d_status status = b.passes ? make(&b, allocator) : SE3D_ERR_NO_MEMORY;
    se3di_free(allocator, b.passes, nodes, sizeof *b.passes);
    return status;
}

void se3di_loop_system_destroy(se3di_loop_system *s, const se3d_allocator *allocator)
{
    se3di_array strips[SYSTEM_STRIPS], blocks[SYSTEM_BLOCKS];
    list_strips(s, strips);
    list_blocks(s, blocks);
    se3di_arrays_free(allocator, strips, SYSTEM_STRIPS);
    se3di_arrays_free(allocator, blocks, SYSTEM_BLOCKS);
    se3di_free(allocator, s->products, s->product_count, sizeof *s->products);
    *s = (se3di_loop_system){0};
}

/* What follows from the usual sizes. Rows of which they are not known are not dull: with callbacks
 * of users nothing is learnt. */
static void take_usual(se3di_loop_system *s)
{
    s->is_dull = 0;
    for (int32_t k = 0; k < SE3DI_STRIP * s->row_strips; ++k) {
        const double usual = s->usual[k] > 0.0 ? s->usual[k] : 1.0;
        s->is_dull |= s->usual[k] > 0.0 && s->usual[k] < USUAL_MIN;
        s->least[k] = fmax(PIVOT_MIN, CLEAR * usual);
    }
}

void se3di_loop_system_forget(se3di_loop_system *s)
{
    for (int32_t k = 0; k < SE3DI_STRIP * s->row_strips; ++k) {
        s->usual[k] = 0.0;
    }
    take_usual(s);
}

int se3di_loop_system_is_regular(const se3di_loop_system *s)
{
    return s->is_there && s->usual[0] > 0.0 && !s->is_dull;
}

#define MEMBER_COST 18.0

double se3di_loop_system_least_cost(size_t members)
{
    return MEMBER_COST * (double)members;
}

/* A number of a strip takes 12 on the way down and 6 in solutions, a product 5, a block 20, a block
 * that an earlier column changes 20. */
double se3di_loop_system_cost(const se3di_loop_system *s)
{
    double cost = MEMBER_COST * (double)s->quad_count + 20.0 * (double)s->entry_count +
                  5.0 * (double)s->product_count;
    for (int32_t k = 0; s->is_there && k < s->strip_count; ++k) {
        const double below = s->column_begin[k + 1] - s->column_begin[k] - 1;
        cost += 10.0 * below * (below + 1.0);
    }
    return cost;
}

/* ---- factors and solutions ---- */

typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));
typedef int64_t pair_mask __attribute__((vector_size(16)));
#define PAIR 2

static const pair *pair_at(const double *x)
{
    return (const pair *)(const void *)x;
}

static void find_bounds(se3di_loop_system *s)
{
    for (int32_t k = 0; k < SE3DI_STRIP * s->row_strips; k += PAIR) {
        const pair bound = *pair_at(s->least + k) * *pair_at(s->weight + k);
        memcpy(s->bound + k, &bound, sizeof bound);
    }
}

/* Which pivots are small. Lanes without a row have the weight 0. */
static void look_at_pivots(se3di_loop_system *s)
{
    pair_mask is_refined = {0}, is_near = {0};
    for (int32_t k = 0; k < SE3DI_STRIP * s->row_strips; k += PAIR) {
        const pair pivot = *pair_at(s->pivot + k);
        is_refined |= pivot * EXACT * *pair_at(s->weight + k) > 1.0;
        is_near |= pivot * *pair_at(s->bound + k) > CLEAR / NEAR;
    }
    s->is_refined = (is_refined[0] | is_refined[1]) != 0;
    s->is_near = (is_near[0] | is_near[1]) != 0;
}

int se3di_loop_system_factor(se3di_loop_system *s, const se3di_tree *tree)
{
    if (s->is_dull) {
        s->is_fine = 0;
        return 0;
    }
    find_bounds(s);
    s->is_fine = s->core->factor(s, tree);
    s->is_refined = s->is_near = 0;
    if (s->is_fine) {
        look_at_pivots(s);
    }
    return s->is_fine;
}

/* S^-1 z, and what it changes of e = D y. */
static void add_solution(se3di_loop_system *s, const se3di_tree *tree, double *z, double *e)
{
    s->core->solve(s, z);
    s->core->scatter(s, z, e);
    for (int32_t k = s->row_strips; k < s->strip_count; ++k) {
        const se3di_loop_strip *strip = &s->strips[k];
        for (int32_t f = 0; f < strip->count; ++f) {
            e[strip->first + f] += tree->D[strip->first + f] * z[SE3DI_STRIP * k + f];
        }
    }
}

void se3di_loop_system_solve(se3di_loop_system *s, const se3di_tree *tree, double *e)
{
    const int32_t rows = SE3DI_STRIP * s->row_strips;
    for (int32_t k = 0; k < rows; ++k) {
        s->z[k] = -s->c[k];
    }
    s->core->gather(s, tree, 0, e, s->z);
    for (int32_t k = s->row_strips; k < s->strip_count; ++k) {
        const se3di_loop_strip *strip = &s->strips[k];
        for (int32_t f = 0; f < SE3DI_STRIP; ++f) {
            double *last = &e[strip->first + f];
            s->z[SE3DI_STRIP * k + f] = f < strip->count ? -*last : 0.0;
            if (f < strip->count) {
                *last = 0.0;
            }
        }
    }
    add_solution(s, tree, s->z, e);
    if (!s->is_refined) {
        return;
    }
    memset(s->rest, 0, SE3DI_STRIP * (size_t)s->strip_count * sizeof *s->rest);
    for (int32_t k = 0; k < rows; ++k) {
        s->rest[k] = -s->c[k];
    }
    s->core->gather(s, tree, 1, e, s->rest);
    add_solution(s, tree, s->rest, e);
    for (int32_t k = 0; k < rows; ++k) {
        s->z[k] += s->rest[k];
    }
}

void se3di_loop_system_learn(se3di_loop_system *s, const se3di_tree *tree)
{
    memset(s->bound, 0, SE3DI_STRIP * (size_t)s->row_strips * sizeof *s->bound);
    if (!s->core->factor(s, tree)) {
        return;
    }
    for (int32_t k = 0; k < s->row_strips; ++k) {
        for (int32_t r = 0; r < s->strips[k].count; ++r) {
            const int32_t at = SE3DI_STRIP * k + r;
            const double part = 1.0 / (s->pivot[at] * s->weight[at]);
            s->usual[at] = fmin(1.0, part > s->usual[at] ? part : s->usual[at]);
        }
    }
    take_usual(s);
}
