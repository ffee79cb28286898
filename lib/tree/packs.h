/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes of one tree side by side: four that are as deep in it and have joints of one type, as the
 * corners of a vehicle have, are placed together in the lanes of a vector register, and so are
 * their articulated inertias found, whatever their parents are. A lane does what a node alone does,
 * operation by operation: the same bits.
 * docs/theory/joint_coordinates.md */
#ifndef SE3DI_TREE_PACKS_H
#define SE3DI_TREE_PACKS_H

#include "tree/tree.h"

/* How many there may be at most, whatever the flags; with tree->keys. */
uint32_t se3di_tree_count_packs(se3di_tree *tree);
/* Find nodes that stand side by side, by their flags as they are now, and in which order all are
 * placed. None without lanes. */
void se3di_tree_find_packs(se3di_tree *tree);
/* Take the constants of the nodes as they are now. */
void se3di_tree_fill_packs(se3di_tree *tree);

/* As se3di_tree_place, of the nodes of a pack, whose parents have been placed: with AVX2. */
void se3di_tree_place_pack_avx2(se3di_tree *tree, const se3di_tree_pack *pack, const double *q,
                                const double *qdot, se3di_frame *frames);
/* As se3di_tree_show, of these. */
void se3di_tree_show_pack_avx2(se3di_tree *tree, const se3di_tree_pack *pack, const double *q,
                               const double *qdot, se3di_frame *frames);
/* As the part of core->factor for one node: tree->passed of the nodes of a pack that `factors`, and
 * their U, D, e; that of their children is there. Returns 0 if some D is not > 0. */
int se3di_tree_factor_pack_avx2(se3di_tree *tree, const se3di_tree_pack *pack,
                                const double *effort);
/* The articulated inertia of what is beyond a node, from tree->passed of its children, which add up
 * in the same order as in core->factor; in `room`, or where it stands. */
const se3di_tree_inertia *se3di_tree_beyond_avx2(const se3di_tree *tree, uint32_t node,
                                                 se3di_tree_inertia *room);

#endif
