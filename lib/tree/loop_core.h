/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of the equations of loops (tree/loop_system.h), compiled for several instruction levels
 * from one source: the four rows of a strip are the lanes of a register. */
#ifndef SE3DI_TREE_LOOP_CORE_H
#define SE3DI_TREE_LOOP_CORE_H

#include "tree/loop_system.h"

struct se3di_loop_side;

/* Loops whose rows are carried side by side: four with three rows each along the ground's axes, and
 * paths of nodes of the same types. `side` of bodies i and j; Y, c, weight of their strips. */
#define SE3DI_TEAM       4
#define SE3DI_TEAM_ROWS  3
#define SE3DI_TEAM_NODES 12 /* most of a path */

typedef struct se3di_loop_team {
    se3di_loop_path path[SE3DI_TEAM];
    const struct se3di_loop_side *side[2][SE3DI_TEAM];
    double *Y[SE3DI_TEAM], *c[SE3DI_TEAM], *weight[SE3DI_TEAM];
} se3di_loop_team;

typedef struct se3di_loop_core {
    /* What one side of a loop (tree/loop_points.c) has of rows along d [3][4], added to K [6][4],
     * c and weight [4]. */
    void (*load_side)(const se3di_tree *tree, const struct se3di_loop_side *side, double sign,
                      const double *d, double *K, double *c, double *weight);
    /* The same of three rows along the ground's axes; K, c and weight have no -0. */
    void (*load_axes)(const se3di_tree *tree, const struct se3di_loop_side *side, double sign,
                      double *K, double *c, double *weight);
    /* Rows on the nodes of a path, K [nodes][6][4], down to the ground: their numbers at the
     * freedoms on the way into Y [freedoms][4], and c [4] less what accelerates without these. */
    void (*carry)(const se3di_tree *tree, const se3di_loop_path *path, double *K, double *c,
                  double *Y);
    /* What load_axes and `carry` do for each of a team, into Y, c and weight, by the same
     * operations; nothing on the way is prescribed. NULL: not at this level. */
    void (*carry_team)(const se3di_tree *tree, const se3di_loop_team *team);
    /* S = L D L^T from Y and the tree's D; returns 0 where a pivot is not clear. */
    int (*factor)(se3di_loop_system *system, const se3di_tree *tree);
    /* z [strips][4] <- S^-1 z */
    void (*solve)(const se3di_loop_system *system, double *z);
    /* z += Y R e over the freedoms that were eliminated, or over all */
    void (*gather)(const se3di_loop_system *system, const se3di_tree *tree, int all,
                   const double *e, double *z);
    /* e -= Y^T z over those that were eliminated */
    void (*scatter)(const se3di_loop_system *system, const double *z, double *e);
} se3di_loop_core;

const se3di_loop_core *se3di_loop_core_portable(void);
const se3di_loop_core *se3di_loop_core_avx2(void); /* NULL: not here */
void se3di_loop_carry_team_avx2(const se3di_tree *tree, const se3di_loop_team *team);

#endif
