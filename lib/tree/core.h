/* SPDX-License-Identifier: BSD-3-Clause */
/* The recursions of the tree, compiled for several instruction levels from one source. */
#ifndef SE3DI_TREE_CORE_H
#define SE3DI_TREE_CORE_H

#include "tree/tree.h"

typedef struct se3di_tree_core {
    int32_t has_packs, reserved; /* nodes side by side are placed together (tree/packs.h) */
    /* links, S and biases, and the frames of the bodies; without frames (NULL) links have neither
     * quaternions nor points */
    void (*place)(se3di_tree *tree, const double *q, const double *qdot, se3di_frame *frames);
    /* the frames of the bodies alone; links, S and biases are not those of this state */
    void (*show)(se3di_tree *tree, const double *q, const double *qdot, se3di_frame *frames);
    /* articulated inertias from the leaves to the root: U, D, e; returns 0 if some D is not > 0 */
    int (*factor)(se3di_tree *tree, const double *effort);
    /* accelerations from the root to the leaves */
    void (*accelerate)(se3di_tree *tree, const double *e, double *qddot);
    /* [nodes * 6] moment about P and force that the joint of each node exerts on it, at the
     * accelerations of the links; `external` [nodes * 6] (NULL: nothing) acts on it. driven: only
     * of the nodes that are */
    void (*transmit)(const se3di_tree *tree, const double *external, int driven, double *joint);
    /* se3di_tree_measure */
    void (*measure)(const se3di_tree *tree, const double *const change[2], double *room,
                    double parts[2][4], double states[2]);
} se3di_tree_core;

const se3di_tree_core *se3di_tree_core_portable(void);
const se3di_tree_core *se3di_tree_core_avx2(void);   /* NULL: not here */
const se3di_tree_core *se3di_tree_core_avx512(void); /* the same */

#endif
