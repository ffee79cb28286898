/* SPDX-License-Identifier: BSD-3-Clause */
/* What small changes of the state are for the bodies, for two changes at once: each is a lane of a
 * pair. The same bits as of each alone. */
#include "tree/recursion.h"

#include "model/state.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));
typedef int64_t verdict __attribute__((vector_size(16)));

#define FREEDOMS_MAX 6

/* Turn and way of a node's point, and their rates. */
typedef struct move {
    pair way[6], rate[6];
} move;

_Static_assert(sizeof(move) == SE3DI_TREE_CHANGES_ROOM * sizeof(double), "as callers count it");

static inline void cross(const pair a[3], const double b[3], pair o[3])
{
    o[0] = a[1] * b[2] - a[2] * b[1];
    o[1] = a[2] * b[0] - a[0] * b[2];
    o[2] = a[0] * b[1] - a[1] * b[0];
}

static inline pair square(const pair a[3])
{
    return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

/* The larger one; what is not a number stays so. */
static inline pair larger(pair most, pair x)
{
    const verdict stays = (x <= most) | (most != most);
    return (pair)(((verdict)most & stays) | ((verdict)x & ~stays));
}

/* 2 G(p) x */
static void turn(const double p[4], const pair x[4], pair o[3])
{
    o[0] = (p[0] * x[1] - p[1] * x[0] + p[3] * x[2] - p[2] * x[3]) * 2.0;
    o[1] = (p[0] * x[2] - p[2] * x[0] + p[1] * x[3] - p[3] * x[1]) * 2.0;
    o[2] = (p[0] * x[3] - p[3] * x[0] + p[2] * x[1] - p[1] * x[2]) * 2.0;
}

static void take_pairs(const double *const change[2], size_t at, int32_t count, pair *x)
{
    for (int32_t k = 0; k < count; ++k) {
        x[k] = (pair){change[0][at + (size_t)k], change[1][at + (size_t)k]};
    }
}

/* A change of positions as one along the freedoms: turns of quaternions in the child's frame. */
static void take_displacements(const se3di_tree_node *node, const double *q,
                               const double *const change[2], pair dq[FREEDOMS_MAX])
{
    const uint32_t way = node->type == SE3DI_TREE_FREE ? 3 : 0;
    if (way == 0 && node->type != SE3DI_TREE_SPHERICAL) {
        take_pairs(change, node->q, node->v_count, dq);
        return;
    }
    pair x[4];
    take_pairs(change, node->q, (int32_t)way, dq);
    take_pairs(change, node->q + way, 4, x);
    turn(q + node->q + way, x, dq + way);
}

/* (turn, way of the point) of a node that moves by dq on a parent that moves by `parent`. */
static inline void carry(const double *S, int32_t count, const double d[3], const pair *dq,
                         const pair *parent, pair out[6])
{
    if (parent) {
        pair x[3];
        cross(parent, d, x);
        for (int k = 0; k < 3; ++k) {
            out[k] = parent[k];
            out[3 + k] = parent[3 + k] + x[k];
        }
    } else {
        memset(out, 0, 6 * sizeof *out);
    }
    for (int32_t c = 0; c < count; ++c) {
        for (int k = 0; k < 6; ++k) {
            out[k] += dq[c] * S[6 * c + k];
        }
    }
}

/* Squares of the way of the centre of mass and of `part` of the turn, with those so far. */
static inline void take_squares(const pair motion[6], const double s[3], double part, pair *way,
                                pair *angle)
{
    pair x[3], turned[3];
    cross(motion, s, x);
    for (int k = 0; k < 3; ++k) {
        x[k] = motion[3 + k] + x[k];
        turned[k] = part * motion[k];
    }
    *way = larger(*way, square(x));
    *angle = larger(*angle, square(turned));
}

/* Of the state that a node carries. */
static pair measure_state(const se3di_tree *tree, const se3di_tree_node *node,
                          const double *const change[2])
{
    const double size = se3di_state_size(tree->model, node->body);
    const size_t at = tree->q_count + node->v;
    return (pair){fabs(change[0][at]) / size, fabs(change[1][at]) / size};
}

void se3di_tree_measure(const se3di_tree *tree, const double *const change[2], double *room,
                        double parts[2][4], double states[2])
{
    move *moves = (move *)(void *)room;
    pair most[4] = {{0.0, 0.0}}, state = {0.0, 0.0};
    for (uint32_t i = 0; i < tree->count; ++i) {
        const se3di_tree_node *node = &tree->nodes[i];
        const se3di_tree_link *link = &tree->links[i];
        const double *S = tree->S + 6 * (size_t)node->v;
        const move *from = node->parent < 0 ? NULL : &moves[node->parent];
        pair dq[FREEDOMS_MAX];
        if (node->type == SE3DI_TREE_CARRIER) {
            state = larger(state, measure_state(tree, node, change));
            continue;
        }
        take_displacements(node, tree->q, change, dq);
        carry(S, node->v_count, link->d, dq, from ? from->way : NULL, moves[i].way);
        take_pairs(change, tree->q_count + node->v, node->v_count, dq);
        carry(S, node->v_count, link->d, dq, from ? from->rate : NULL, moves[i].rate);
        take_squares(moves[i].way, link->s, 0.5, &most[0], &most[1]);
        take_squares(moves[i].rate, link->s, 1.0, &most[2], &most[3]);
    }
    for (int k = 0; k < 4; ++k) {
        parts[0][k] = most[k][0];
        parts[1][k] = most[k][1];
    }
    states[0] = state[0];
    states[1] = state[1];
}
