/* SPDX-License-Identifier: BSD-3-Clause */
/* Kernels of the equations of loops (tree/loop_system.h), compiled for several instruction levels
 * from one source: the four rows of a strip are the lanes of a register. */
#ifndef SE3DI_TREE_LOOP_CORE_H
#define SE3DI_TREE_LOOP_CORE_H

#include "tree/loop_system.h"

struct se3di_loop_side;

typedef struct se3di_loop_core {
    /* What one side of a loop (tree/loop_points.c) has of rows along d [3][4], added to K [6][4],
     * c and weight [4]. */
    void (*load_side)(const se3di_tree *tree, const struct se3di_loop_side *side, double sign,
                      const double *d, double *K, double *c, double *weight);
    /* Rows on the nodes of a path, K [nodes][6][4], down to the ground: their numbers at the
     * freedoms on the way into Y [freedoms][4], and c [4] less what accelerates without these. */
    void (*carry)(const se3di_tree *tree, const se3di_loop_path *path, double *K, double *c,
                  double *Y);
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

#endif
