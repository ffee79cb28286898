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

typedef struct node_state {
    int32_t type, flags;
    number zero, lead, base, C[4], T[9], r[3], B[4], s[3];
} node_state;

typedef number constant;
#define CONSTANT(x) (x)

_Static_assert(LANES == SE3DI_TREE_PACK, "as many nodes");
_Static_assert(sizeof(link_state) == LANES * sizeof(se3di_tree_link) &&
                   sizeof(body_frame) == LANES * sizeof(se3di_frame),
               "the same members");

#include "tree/place_joints.inc"

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
    scatter_links(tree, pack, &link, poses);
    scatter_freedoms(tree, pack, S);
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
        place_pack(tree, pack, q, qdot, frames, 1);
    } else {
        place_pack(tree, pack, q, qdot, NULL, 0);
    }
}

SE3DI_TARGET_END

#endif
