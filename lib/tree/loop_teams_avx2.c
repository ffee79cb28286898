/* SPDX-License-Identifier: BSD-3-Clause */
/* Three rows of four loops each, down trees of their own or one that they share, with lanes for
 * loops: x86-64 with AVX2 and FMA. A lane does what the lane of a row does in tree/loop_core.inc,
 * operation by operation.                                   docs/theory/joint_coordinates.md */
#include "tree/loop_core.h"

#include "base/target.h"
#include "tree/loops.h"

#include <stddef.h>

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

#define LANES   SE3DI_TEAM
#define ROWS    SE3DI_TEAM_ROWS
#define KERNEL  static inline __attribute__((always_inline))
#define FREEDOM 6 /* most of a node */
#if defined(__clang__)
#define UNROLL _Pragma("clang loop unroll(full)")
#else
#define UNROLL _Pragma("GCC unroll 6")
#endif

typedef __m256d quad;
typedef quad row[6];      /* of a loop at a node */
typedef quad three[ROWS]; /* numbers of three rows */

#define SPREAD(x)        _mm256_set1_pd(x)
#define add_of(a, b)     _mm256_add_pd(a, b)
#define sub_of(a, b)     _mm256_sub_pd(a, b)
#define mul_of(a, b)     _mm256_mul_pd(a, b)
#define fma_of(a, b, c)  _mm256_fmadd_pd(a, b, c)
#define fnma_of(a, b, c) _mm256_fnmadd_pd(a, b, c)

/* Rows of all loops on the nodes of their paths. */
typedef struct team_rows {
    row K[SE3DI_TEAM_NODES][ROWS];
    three c, weight;
} team_rows;

/* What is at a node: of all lanes, or of the one that they share. */
typedef struct team_node {
    quad S[FREEDOM][6], U[FREEDOM][6], R[FREEDOM];
    quad c[6], d[3];
} team_node;

KERNEL void turn_four(const quad a[4], quad o[4])
{
    const quad low[2] = {_mm256_unpacklo_pd(a[0], a[1]), _mm256_unpacklo_pd(a[2], a[3])};
    const quad high[2] = {_mm256_unpackhi_pd(a[0], a[1]), _mm256_unpackhi_pd(a[2], a[3])};
    o[0] = _mm256_permute2f128_pd(low[0], low[1], 0x20);
    o[1] = _mm256_permute2f128_pd(high[0], high[1], 0x20);
    o[2] = _mm256_permute2f128_pd(low[0], low[1], 0x31);
    o[3] = _mm256_permute2f128_pd(high[0], high[1], 0x31);
}

/* Four numbers of each lane from place `at` on. */
KERNEL void gather_four(const double *const from[LANES], size_t at, quad *to)
{
    quad each[4];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        each[k] = _mm256_loadu_pd(from[k] + at);
    }
    turn_four(each, to);
}

KERNEL void gather_six(const double *const from[LANES], size_t at, quad *to)
{
    quad first[4];
    gather_four(from, at, first);
    gather_four(from, at + 2, to + 2);
    to[0] = first[0];
    to[1] = first[1];
}

KERNEL void gather_three(const double *const from[LANES], size_t at, quad *to)
{
    quad some[4];
    gather_four(from, at, some);
    UNROLL
    for (int k = 0; k < 3; ++k) {
        to[k] = some[k];
    }
}

/* ---- rows at the bodies ---- */

KERNEL void mul3(const quad A[9], const quad a[3], quad o[3])
{
    UNROLL
    for (int k = 0; k < 3; ++k) {
        o[k] = add_of(add_of(mul_of(A[3 * k], a[0]), mul_of(A[3 * k + 1], a[1])),
                      mul_of(A[3 * k + 2], a[2]));
    }
}

KERNEL void cross3(const quad a[3], const quad b[3], quad o[3])
{
    o[0] = sub_of(mul_of(a[1], b[2]), mul_of(a[2], b[1]));
    o[1] = sub_of(mul_of(a[2], b[0]), mul_of(a[0], b[2]));
    o[2] = sub_of(mul_of(a[0], b[1]), mul_of(a[1], b[0]));
}

/* W and w of the links, arm and square of the sides. */
KERNEL void gather_side(const se3di_tree *tree, const se3di_loop_side *const side[LANES], quad W[9],
                        quad w[3], quad arm[3], quad square[9])
{
    const double *link[LANES], *own[LANES];
    quad some[4];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        link[k] = tree->links[side[k]->node].W;
        own[k] = side[k]->arm;
    }
    gather_four(link, 0, W);
    gather_four(link, 4, W + 4);
    gather_four(link, 8, some);
    W[8] = some[0];
    gather_four(link, 14, some);
    UNROLL
    for (int k = 0; k < 3; ++k) {
        w[k] = some[1 + k];
    }
    gather_four(own, 0, some);
    UNROLL
    for (int k = 0; k < 3; ++k) {
        arm[k] = some[k];
    }
    square[0] = some[3];
    gather_four(own, 4, square + 1);
    gather_four(own, 8, square + 5);
}

_Static_assert(offsetof(se3di_tree_link, w) == 15 * sizeof(double), "as it is gathered");
_Static_assert(offsetof(se3di_loop_side, square) ==
                   offsetof(se3di_loop_side, arm) + 3 * sizeof(double),
               "as it is gathered");

/* weight += of row r, whose direction in the triads is row r of W */
KERNEL quad weigh(const quad square[9], const quad *local)
{
    quad sum = SPREAD(0.0);
    UNROLL
    for (int k = 0; k < 3; ++k) {
        const quad *own = square + 3 * k;
        const quad part = add_of(add_of(mul_of(own[0], local[0]), mul_of(own[1], local[1])),
                                 mul_of(own[2], local[2]));
        sum = k == 0 ? mul_of(part, local[0]) : add_of(sum, mul_of(part, local[k]));
    }
    return sum;
}

/* As load_axes. */
static void load_sides(const se3di_tree *tree, const se3di_loop_side *const side[LANES],
                       double sign, team_rows *rows)
{
    const quad none = SPREAD(0.0), to = SPREAD(sign), back = SPREAD(-sign);
    quad W[9], w[3], arm[3], square[9], at[3], turning[3], bias[3];
    gather_side(tree, side, W, w, arm, square);
    mul3(W, arm, at);
    cross3(w, at, turning);
    cross3(w, turning, bias);
    row *K = rows->K[side[0]->place];
    UNROLL
    for (int r = 0; r < ROWS; ++r) {
        const int y = (r + 1) % 3, z = (r + 2) % 3; /* at x e_r: -at_z along y, at_y along z */
        const quad own = add_of(bias[r], SPREAD(tree->pull[r]));
        K[r][r] = none;
        K[r][y] = add_of(none, mul_of(to, at[z]));
        K[r][z] = add_of(none, mul_of(to, sub_of(none, at[y])));
        K[r][3] = K[r][4] = K[r][5] = none;
        K[r][3 + r] = to;
        rows->c[r] = add_of(rows->c[r], mul_of(back, own));
        rows->weight[r] = add_of(rows->weight[r], weigh(square, W + 3 * r));
    }
}

/* ---- down the tree ---- */

KERNEL void spread_three(const double *from, quad *to)
{
    UNROLL
    for (int k = 0; k < 3; ++k) {
        to[k] = SPREAD(from[k]);
    }
}

KERNEL void spread_six(const double *from, quad *to)
{
    spread_three(from, to);
    spread_three(from + 3, to + 3);
}

/* The node that all paths share; `turns`: its freedoms only turn. */
KERNEL void spread_node(const se3di_tree *tree, int32_t index, const int turns, team_node *o)
{
    const se3di_tree_node *n = &tree->nodes[index];
    const se3di_tree_link *link = &tree->links[index];
    for (int32_t j = 0; j < n->v_count; ++j) {
        const size_t v = n->v + (size_t)j;
        spread_three(tree->S + 6 * v, o->S[j]);
        if (!turns) {
            spread_three(tree->S + 6 * v + 3, o->S[j] + 3);
        }
        spread_six(tree->U + 6 * v, o->U[j]);
        o->R[j] = SPREAD(tree->R[v]);
    }
    spread_six(link->c, o->c);
    spread_three(link->d, o->d);
}

/* Nodes at place p of the paths. */
KERNEL void gather_node(const se3di_tree *tree, const se3di_loop_team *team, int32_t p,
                        const int turns, team_node *o)
{
    const double *S[LANES], *U[LANES], *R[LANES], *c[LANES], *d[LANES];
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        const int32_t index = team->path[k].node[p];
        const size_t v = tree->nodes[index].v;
        S[k] = tree->S + 6 * v;
        U[k] = tree->U + 6 * v;
        R[k] = tree->R + v;
        c[k] = tree->links[index].c;
        d[k] = tree->links[index].d;
    }
    const int32_t count = tree->nodes[team->path[0].node[p]].v_count;
    for (int32_t j = 0; j < count; ++j) {
        if (turns) {
            gather_three(S, 6 * (size_t)j, o->S[j]);
        } else {
            gather_six(S, 6 * (size_t)j, o->S[j]);
        }
        gather_six(U, 6 * (size_t)j, o->U[j]);
        o->R[j] = _mm256_setr_pd(R[0][j], R[1][j], R[2][j], R[3][j]);
    }
    gather_six(c, 0, o->c);
    gather_three(d, 0, o->d);
}

/* Of row r: what the freedoms and the bias of a node take from it, as pass_node; y [freedoms]. */
KERNEL void pass_row(const team_node *n, int32_t count, const int turns, int r, quad *K, quad *c,
                     three *y)
{
    for (int32_t j = count; j-- > 0;) {
        quad sum = mul_of(K[0], n->S[j][0]);
        UNROLL
        for (int k = 1; k < 3; ++k) {
            sum = fma_of(K[k], n->S[j][k], sum);
        }
        UNROLL
        for (int k = 3; k < 6 && !turns; ++k) {
            sum = fma_of(K[k], n->S[j][k], sum);
        }
        y[j][r] = sum;
        const quad rate = mul_of(sum, n->R[j]);
        UNROLL
        for (int k = 0; k < 6; ++k) {
            K[k] = fnma_of(rate, n->U[j][k], K[k]);
        }
    }
    UNROLL
    for (int k = 0; k < 6; ++k) {
        *c = fnma_of(K[k], n->c[k], *c);
    }
}

/* As add_shifted. */
KERNEL void shift_row(const quad *K, const quad *d, quad *to)
{
    quad x[3];
    x[0] = fma_of(d[1], K[5], fnma_of(d[2], K[4], K[0]));
    x[1] = fma_of(d[2], K[3], fnma_of(d[0], K[5], K[1]));
    x[2] = fma_of(d[0], K[4], fnma_of(d[1], K[3], K[2]));
    UNROLL
    for (int k = 0; k < 3; ++k) {
        to[k] = add_of(to[k], x[k]);
        to[3 + k] = add_of(to[3 + k], K[3 + k]);
    }
}

/* The rows of place p by one node to its parent, or to the ground. */
KERNEL void pass_rows(const se3di_tree *tree, const team_node *n, int32_t count, const int turns,
                      int32_t p, int32_t parent, team_rows *rows, three *y)
{
    for (int r = 0; r < ROWS; ++r) {
        quad K[6], c = rows->c[r];
        UNROLL
        for (int k = 0; k < 6; ++k) {
            K[k] = rows->K[p][r][k];
        }
        pass_row(n, count, turns, r, K, &c, y);
        if (parent >= 0) {
            shift_row(K, n->d, rows->K[parent][r]);
        } else { /* the ground accelerates by -g where gravity pulls */
            UNROLL
            for (int k = 0; k < 3; ++k) {
                c = fma_of(K[3 + k], SPREAD(tree->pull[k]), c);
            }
        }
        rows->c[r] = c;
    }
}

/* Numbers of the rows, lanes for loops -> lanes for rows. */
KERNEL void scatter_rows(const quad rows[ROWS], double *const to[LANES], size_t at)
{
    const quad from[4] = {rows[0], rows[1], rows[2], SPREAD(0.0)};
    quad lanes[4];
    turn_four(from, lanes);
    UNROLL
    for (int k = 0; k < LANES; ++k) {
        _mm256_storeu_pd(to[k] + at, lanes[k]);
    }
}

static int is_shared(const se3di_loop_team *team, int32_t p)
{
    const int32_t node = team->path[0].node[p];
    return team->path[1].node[p] == node && team->path[2].node[p] == node &&
           team->path[3].node[p] == node;
}

KERNEL void carry_place(const se3di_tree *tree, const se3di_loop_team *team, int32_t p,
                        const int turns, team_rows *rows, three *y)
{
    const int32_t index = team->path[0].node[p];
    team_node n;
    if (is_shared(team, p)) {
        spread_node(tree, index, turns, &n);
    } else {
        gather_node(tree, team, p, turns, &n);
    }
    pass_rows(tree, &n, tree->nodes[index].v_count, turns, p, team->path[0].parent[p], rows, y);
}

static void clear_rows(int32_t count, team_rows *rows)
{
    const quad none = SPREAD(0.0);
    for (int32_t p = 0; p < count; ++p) {
        for (int r = 0; r < ROWS; ++r) {
            UNROLL
            for (int k = 0; k < 6; ++k) {
                rows->K[p][r][k] = none;
            }
        }
    }
    for (int r = 0; r < ROWS; ++r) {
        rows->c[r] = rows->weight[r] = none;
    }
}

void se3di_loop_carry_team_avx2(const se3di_tree *tree, const se3di_loop_team *team)
{
    team_rows rows;
    size_t at = 0;
    const int32_t count = team->path[0].count;
    clear_rows(count, &rows);
    for (int s = 0; s < 2; ++s) {
        if (team->side[s][0]->node >= 0) {
            load_sides(tree, team->side[s], s == 0 ? -1.0 : 1.0, &rows);
        }
    }
    for (int32_t p = 0; p < count; ++p) {
        const se3di_tree_node *first = &tree->nodes[team->path[0].node[p]];
        three y[FREEDOM];
        if (first->type == SE3DI_TREE_REVOLUTE || first->type == SE3DI_TREE_SPHERICAL ||
            first->type == SE3DI_TREE_UNIVERSAL) {
            carry_place(tree, team, p, 1, &rows, y);
        } else {
            carry_place(tree, team, p, 0, &rows, y);
        }
        for (int32_t j = 0; j < first->v_count; ++j, at += SE3DI_STRIP) {
            scatter_rows(y[j], team->Y, at);
        }
    }
    scatter_rows(rows.c, team->c, 0);
    scatter_rows(rows.weight, team->weight, 0);
}

SE3DI_TARGET_END

#endif
