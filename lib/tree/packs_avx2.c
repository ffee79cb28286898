/* SPDX-License-Identifier: BSD-3-Clause */
/* Four nodes side by side for x86-64 with AVX2 and FMA.         docs/theory/joint_coordinates.md */
#include "tree/packs.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

typedef double number __attribute__((vector_size(32)));
typedef uint64_t integers __attribute__((vector_size(32)));
typedef int64_t verdict __attribute__((vector_size(32)));

#define FINE             (~(verdict){0})
#define LANES            4
#define NUMBER(x)        ((number)_mm256_set1_pd(x))
#define fma_of(a, b, c)  ((number)_mm256_fmadd_pd(a, b, c))
#define fnma_of(a, b, c) ((number)_mm256_fnmadd_pd(a, b, c))
#define fms_of(a, b, c)  ((number)_mm256_fmsub_pd(a, b, c))
#define root_of(a)       ((number)_mm256_sqrt_pd(a))
#define is_far(a)                                                                                  \
    (_mm256_movemask_pd(_mm256_cmp_pd(_mm256_andnot_pd(_mm256_set1_pd(-0.0), a),                   \
                                      _mm256_set1_pd(1e5), _CMP_LT_OQ)) != 15)

#include "tree/numbers.inc"

/* The members of se3di_tree_link, se3di_frame and, as far as they are used, se3di_tree_node. */
typedef struct link_state {
    number W[9], d[3], s[3], w[3], c[6], a[6], t[4], P[3], v[3];
} link_state;

typedef struct body_frame {
    number r[3], p[4], A[9], v[3], w[3], pdot[4];
} body_frame;

typedef struct inertia {
    number I[6], G[9], M[6], p[6], none;
} inertia;

/* v is the first of its own numbers, parent -1 or not. */
typedef struct node_state {
    int32_t type, flags, parent, v_count;
    uint32_t v;
    number zero, lead, base, C[4], T[9], r[3], B[4], s[3], mass, J[6];
} node_state;

/* The numbers of the freedoms of one node. */
typedef struct tree_state {
    number S[36], U[36], V[18], D[6], R[6], e[6], k[6], armature[6], given[6];
} tree_state;

typedef number constant;
#define CONSTANT(x) (x)

_Static_assert(LANES == SE3DI_TREE_PACK, "as many nodes");
_Static_assert(sizeof(link_state) == LANES * sizeof(se3di_tree_link) &&
                   sizeof(inertia) == LANES * sizeof(se3di_tree_inertia) &&
                   sizeof(body_frame) == LANES * sizeof(se3di_frame),
               "the same members");

#include "tree/place_joints.inc"

#define KEEPS_COLUMNS 1

KERNEL int take_constants(const tree_state *tree, const node_state *n, number *mass, number *J)
{
    (void)tree;
    *mass = n->mass;
    copy_numbers(6, n->J, J);
    return n->flags & SE3DI_TREE_DIAGONAL;
}

#include "tree/factor_joints.inc"

KERNEL void load_numbers(const int count, const double *from, number *to)
{
    UNROLL
    for (int k = 0; k < count; ++k) {
        to[k] = (number)_mm256_loadu_pd(from + LANES * k);
    }
}

KERNEL void load_node(const se3di_tree_pack *pack, node_state *n)
{
    n->type = pack->type;
    n->flags = pack->flags;
    load_numbers(1, pack->zero, &n->zero);
    load_numbers(1, pack->lead, &n->lead);
    load_numbers(1, pack->base, &n->base);
    load_numbers(4, pack->C, n->C);
    load_numbers(9, pack->T, n->T);
    load_numbers(3, pack->r, n->r);
    load_numbers(4, pack->B, n->B);
    load_numbers(3, pack->s, n->s);
}

/* Rows of four numbers <-> lanes. */
KERNEL void turn_four(const __m256d from[4], __m256d to[4])
{
    const __m256d a = _mm256_unpacklo_pd(from[0], from[1]);
    const __m256d b = _mm256_unpackhi_pd(from[0], from[1]);
    const __m256d c = _mm256_unpacklo_pd(from[2], from[3]);
    const __m256d d = _mm256_unpackhi_pd(from[2], from[3]);
    to[0] = _mm256_permute2f128_pd(a, c, 0x20);
    to[1] = _mm256_permute2f128_pd(b, d, 0x20);
    to[2] = _mm256_permute2f128_pd(a, c, 0x31);
    to[3] = _mm256_permute2f128_pd(b, d, 0x31);
}

/* Four numbers from place `at` on of what each lane has. */
KERNEL void gather_four(const double *const from[LANES], size_t at, number *to)
{
    __m256d row[4], lane[4];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        row[k] = _mm256_loadu_pd(from[k] + at);
    }
    turn_four(row, lane);
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        to[at + (size_t)k] = (number)lane[k];
    }
}

KERNEL void scatter_four(const number *from, size_t at, double *const to[LANES])
{
    __m256d row[4], lane[4];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        lane[k] = (__m256d)from[at + (size_t)k];
    }
    turn_four(lane, row);
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        _mm256_storeu_pd(to[k] + at, row[k]);
    }
}

#define AS(type, memory)     ((type *)(void *)(memory))
#define AS_CONST(type, from) ((const type *)(const void *)(from))
#define PLACE(type, member)  (offsetof(type, member) / sizeof(double))

/* W and w, with what is beside them; where frames are wanted t, P and v. */
KERNEL void gather_parents(const se3di_tree *tree, const se3di_tree_pack *pack, const int poses,
                           link_state *parent)
{
    const double *from[LANES];
    number *to = AS(number, parent);
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        from[k] = AS_CONST(double, &tree->links[tree->nodes[pack->node[k]].parent]);
    }
    gather_four(from, 0, to);
    gather_four(from, 4, to);
    gather_four(from, 8, to);
    gather_four(from, PLACE(se3di_tree_link, w), to);
    if (poses) {
        gather_four(from, PLACE(se3di_tree_link, t), to);
        gather_four(from, PLACE(se3di_tree_link, P), to);
        gather_four(from, PLACE(se3di_tree_link, v) - 1, to);
    }
}

KERNEL void gather_coordinates(const se3di_tree *tree, const se3di_tree_pack *pack, const double *q,
                               const double *qdot, number *at, number *rate)
{
    const se3di_tree_node *n[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        n[k] = &tree->nodes[pack->node[k]];
    }
    for (int32_t k = 0; k < n[0]->q_count; ++k) {
        at[k] = (number)_mm256_set_pd(q[n[3]->q + (uint32_t)k], q[n[2]->q + (uint32_t)k],
                                      q[n[1]->q + (uint32_t)k], q[n[0]->q + (uint32_t)k]);
    }
    for (int32_t k = 0; k < n[0]->v_count; ++k) {
        rate[k] = (number)_mm256_set_pd(qdot[n[3]->v + (uint32_t)k], qdot[n[2]->v + (uint32_t)k],
                                        qdot[n[1]->v + (uint32_t)k], qdot[n[0]->v + (uint32_t)k]);
    }
}

/* What those beyond them are placed by, if there are any. */
KERNEL void scatter_bases(const se3di_tree *tree, const se3di_tree_pack *pack,
                          const link_state *link)
{
    const number *from = AS_CONST(number, link);
    double *to[LANES];
    int32_t child = -1;
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        to[k] = AS(double, &tree->links[pack->node[k]]);
        child = tree->nodes[pack->node[k]].child > child ? tree->nodes[pack->node[k]].child : child;
    }
    if (child < 0) {
        return;
    }
    UNROLL
    for (size_t at = 0; at < PLACE(se3di_tree_link, s); at += 4) {
        scatter_four(from, at, to);
    }
    scatter_four(from, PLACE(se3di_tree_link, w) - 1, to);
    scatter_four(from, PLACE(se3di_tree_link, t), to);
    scatter_four(from, PLACE(se3di_tree_link, P), to);
    scatter_four(from, PLACE(se3di_tree_link, v) - 1, to);
}

/* All but accelerations. */
KERNEL void scatter_links(const se3di_tree *tree, const se3di_tree_pack *pack,
                          const link_state *link, const int poses)
{
    const number *from = AS_CONST(number, link);
    double *to[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        to[k] = AS(double, &tree->links[pack->node[k]]);
    }
    UNROLL
    for (size_t at = 0; at < PLACE(se3di_tree_link, a); at += 4) {
        scatter_four(from, at, to);
    }
    if (poses) {
        scatter_four(from, PLACE(se3di_tree_link, t), to);
        scatter_four(from, PLACE(se3di_tree_link, P), to);
        scatter_four(from, PLACE(se3di_tree_link, v) - 1, to);
    }
}

KERNEL void scatter_freedoms(const se3di_tree *tree, const se3di_tree_pack *pack, const number *S)
{
    double *to[LANES];
    const int32_t count = tree->nodes[pack->node[0]].v_count;
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        to[k] = tree->S + 6 * (size_t)tree->nodes[pack->node[k]].v;
    }
    for (size_t v = 0; v < (size_t)count; ++v) {
        scatter_four(S, 6 * v, to);
        scatter_four(S, 6 * v + 2, to);
    }
}

KERNEL void scatter_frames(const se3di_tree *tree, const se3di_tree_pack *pack,
                           const body_frame *frame, se3di_frame *frames)
{
    const number *from = AS_CONST(number, frame);
    double *to[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        to[k] = AS(double, &frames[tree->nodes[pack->node[k]].body]);
    }
    UNROLL
    for (size_t at = 0; at < 24; at += 4) {
        scatter_four(from, at, to);
    }
    scatter_four(from, PLACE(se3di_frame, pdot), to);
}

KERNEL void place_pack(se3di_tree *tree, const se3di_tree_pack *pack, const double *q,
                       const double *qdot, se3di_frame *frames, const int poses)
{
    number at[7], rate[6], S[36];
    node_state n;
    joint_base b;
    link_state link;
    load_node(pack, &n);
    gather_coordinates(tree, pack, q, qdot, at, rate);
    if (pack->is_rooted) {
        base_on_ground(&n, &b);
    } else {
        link_state parent;
        gather_parents(tree, pack, poses, &parent);
        base_on_parent(&n, &parent, poses, poses, &b);
    }
    if (n.type == SE3DI_TREE_REVOLUTE) {
        place_revolute(&n, at, rate, &b, &link, S);
    } else {
        place_joint(&n, at, rate, &b, &link, S);
    }
    complete_link(&n, &b, &link);
    if (poses == FRAMES) {
        scatter_bases(tree, pack, &link);
    } else {
        scatter_links(tree, pack, &link, poses);
        scatter_freedoms(tree, pack, S);
    }
    if (poses) {
        body_frame frame;
        place_body(&n, &link, &frame);
        scatter_frames(tree, pack, &frame, frames);
    }
}

void se3di_tree_place_pack_avx2(se3di_tree *tree, const se3di_tree_pack *pack, const double *q,
                                const double *qdot, se3di_frame *frames)
{
    if (frames) {
        place_pack(tree, pack, q, qdot, frames, POSES);
    } else {
        place_pack(tree, pack, q, qdot, NULL, LINKS);
    }
}

void se3di_tree_show_pack_avx2(se3di_tree *tree, const se3di_tree_pack *pack, const double *q,
                               const double *qdot, se3di_frame *frames)
{
    place_pack(tree, pack, q, qdot, frames, FRAMES);
}

/* ---- articulated inertias ---- */

#define PARTS (sizeof(se3di_tree_inertia) / (LANES * sizeof(double)))

KERNEL void add_parts(const __m256d *a, const se3di_tree_inertia *b, __m256d *sum)
{
    const double *from = AS_CONST(double, b);
    UNROLL
    for (size_t k = 0; k < PARTS; ++k) {
        sum[k] = _mm256_add_pd(a[k], _mm256_loadu_pd(from + LANES * k));
    }
}

const se3di_tree_inertia *se3di_tree_beyond_avx2(const se3di_tree *tree, uint32_t node,
                                                 se3di_tree_inertia *room)
{
    static const se3di_tree_inertia nothing;
    const se3di_tree_node *n = &tree->nodes[node];
    const se3di_tree_inertia *first = n->child >= 0 ? &tree->passed[node + 1] : &nothing;
    __m256d sum[PARTS];
    if (n->branch < 0) {
        return first;
    }
    for (size_t k = 0; k < PARTS; ++k) {
        sum[k] = _mm256_setzero_pd();
    }
    for (int32_t k = n->child; k != (int32_t)node + 1; k = tree->nodes[k].before) {
        add_parts(sum, &tree->passed[k], sum);
    }
    add_parts(sum, first, sum);
    for (size_t k = 0; k < PARTS; ++k) {
        _mm256_storeu_pd(AS(double, room) + LANES * k, sum[k]);
    }
    return room;
}

KERNEL void load_inertia(const se3di_tree *tree, const se3di_tree_pack *pack, inertia *a)
{
    se3di_tree_inertia room[LANES];
    const double *from[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        from[k] = AS_CONST(double, se3di_tree_beyond_avx2(tree, pack->node[k], &room[k]));
    }
    UNROLL
    for (size_t at = 0; at < LANES * PARTS; at += LANES) {
        gather_four(from, at, AS(number, a));
    }
}

/* W, d, s, w and c. */
KERNEL void gather_links(const se3di_tree *tree, const se3di_tree_pack *pack, link_state *link)
{
    const double *from[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        from[k] = AS_CONST(double, &tree->links[pack->node[k]]);
    }
    UNROLL
    for (size_t at = 0; at < PLACE(se3di_tree_link, a); at += 4) {
        gather_four(from, at, AS(number, link));
    }
}

KERNEL void gather_six(const se3di_tree_pack *pack, const double *each, number *to)
{
    const double *from[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        from[k] = each + 6 * (size_t)pack->node[k];
    }
    gather_four(from, 0, to);
    gather_four(from, 2, to);
}

/* S and, NULL: zero, efforts of the freedoms. */
KERNEL void gather_freedoms(const se3di_tree *tree, const se3di_tree_pack *pack,
                            const double *effort, tree_state *own, number *efforts)
{
    const double *from[LANES];
    size_t v[LANES];
    const int count = tree->nodes[pack->node[0]].v_count;
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        v[k] = tree->nodes[pack->node[k]].v;
        from[k] = tree->S + 6 * v[k];
    }
    for (int k = 0; k < count; ++k) {
        const size_t f = (size_t)k;
        gather_four(from, 6 * f, own->S);
        gather_four(from, 6 * f + 2, own->S);
        own->armature[k] = (number)_mm256_loadu_pd(pack->armature + LANES * k);
        efforts[k] = effort ? (number)_mm256_set_pd(effort[v[3] + f], effort[v[2] + f],
                                                    effort[v[1] + f], effort[v[0] + f])
                            : NUMBER(0.0);
    }
}

KERNEL void scatter_one(const se3di_tree *tree, const se3di_tree_pack *pack, size_t freedom,
                        number from, double *to)
{
    double each[LANES];
    _mm256_storeu_pd(each, (__m256d)from);
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        to[tree->nodes[pack->node[k]].v + freedom] = each[k];
    }
}

KERNEL void scatter_columns(const se3di_tree *tree, const se3di_tree_pack *pack, size_t freedom,
                            const number *from, double *to)
{
    double *each[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        each[k] = to + 6 * (size_t)tree->nodes[pack->node[k]].v;
    }
    scatter_four(from, 6 * freedom, each);
    scatter_four(from, 6 * freedom + 2, each);
}

KERNEL void scatter_factors(se3di_tree *tree, const se3di_tree_pack *pack, const tree_state *own)
{
    const size_t count = (size_t)tree->nodes[pack->node[0]].v_count;
    const int is_revolute = pack->type == SE3DI_TREE_REVOLUTE;
    for (size_t k = 0; k < count; ++k) {
        scatter_one(tree, pack, k, own->D[k], tree->D);
        scatter_one(tree, pack, k, own->R[k], tree->R);
        scatter_one(tree, pack, k, own->e[k], tree->e);
        scatter_columns(tree, pack, k, own->U, tree->U);
        if (is_revolute || pack->is_plain) {
            scatter_columns(tree, pack, k, own->V, tree->V);
        }
    }
    if (is_revolute) {
        scatter_one(tree, pack, 0, own->k[0], tree->k);
    }
}

KERNEL void scatter_passed(const se3di_tree *tree, const se3di_tree_pack *pack, const inertia *o)
{
    double *to[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        to[k] = AS(double, &tree->passed[pack->node[k]]);
    }
    UNROLL
    for (size_t at = 0; at < LANES * PARTS; at += LANES) {
        scatter_four(AS_CONST(number, o), at, to);
    }
}

KERNEL void load_inertia_node(const se3di_tree *tree, const se3di_tree_pack *pack, node_state *n)
{
    n->type = pack->type;
    n->flags = pack->flags;
    n->parent = pack->is_rooted ? -1 : 0;
    n->v = 0;
    n->v_count = tree->nodes[pack->node[0]].v_count;
    load_numbers(1, pack->mass, &n->mass);
    load_numbers(6, pack->J, n->J);
}

int se3di_tree_factor_pack_avx2(se3di_tree *tree, const se3di_tree_pack *pack, const double *effort)
{
    number external[6], efforts[6];
    node_state n;
    link_state link;
    inertia a, o;
    tree_state own;
    load_inertia_node(tree, pack, &n);
    gather_links(tree, pack, &link);
    gather_freedoms(tree, pack, effort, &own, efforts);
    load_inertia(tree, pack, &a);
    if (tree->acts) {
        gather_six(pack, tree->wrench, external);
    }
    add_own(&own, &n, &link, tree->acts ? external : NULL, &a);
    clear_numbers(18, own.V);
    clear_numbers(LANES * PARTS, AS(number, &o)); /* not the rooted ones' */
    const verdict fine = pass_node(&own, &n, pack->is_plain, efforts, &link, &a, &o);
    scatter_factors(tree, pack, &own);
    if (!pack->is_rooted) {
        scatter_passed(tree, pack, &o);
    }
    return _mm256_movemask_pd((__m256d)fine) == 15;
}

SE3DI_TARGET_END

#endif
