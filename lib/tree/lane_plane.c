/* SPDX-License-Identifier: BSD-3-Clause */
/* Trees that move in planes: whether they do, and what their nodes are there, for the kernels of
 * tree/lane_plane.inc.                                                  docs/theory/lanes.md */
#include "tree/lanes.h"

#include "math/elementary.h"

#include <math.h>
#include <string.h>

#define PARALLEL 1e-14 /* sine of an angle between axes that are rounding */

static int is_planar(const se3di_tree *tree, const se3di_tree_node *n)
{
    const double *T = n->T;
    const int is_free = n->type == SE3DI_TREE_REVOLUTE && !(n->flags & SE3DI_TREE_GIVEN) &&
                        tree->armature[n->v] == 0.0;
    return is_free && (n->parent < 0 || (fabs(T[2]) < PARALLEL && fabs(T[5]) < PARALLEL));
}

int se3di_tree_is_planar(const se3di_tree *tree)
{
    uint32_t k = 0;
    while (k < tree->count && is_planar(tree, &tree->nodes[k])) {
        ++k;
    }
    return k == tree->count;
}

/* `sense`: that of the parent's angle in the plane. */
static void take_node(const se3di_tree_node *n, double sense, se3di_lane_plane *own)
{
    const int is_root = n->parent < 0;
    memset(own, 0, sizeof *own);
    own->sense = is_root || n->T[8] > 0.0 ? sense : -sense;
    own->turn = -own->sense * n->zero;
    for (int k = 0; is_root && k < 3; ++k) {
        own->axes[k] = n->T[3 * k];
        own->axes[3 + k] = n->T[3 * k + 1];
    }
    if (!is_root) {
        own->turn += se3di_atan2(sense * n->T[3], n->T[0]);
        own->d[0] = n->r[0];
        own->d[1] = sense * n->r[1];
    }
    own->s[0] = n->s[0];
    own->s[1] = own->sense * n->s[1];
    own->J = n->J[2];
    own->mass = n->mass;
}

void se3di_lanes_take_plane(se3di_lanes *lanes)
{
    const se3di_tree *tree = lanes->tree;
    se3di_lane_plane *plane = (se3di_lane_plane *)(void *)lanes->planes;
    if (!se3di_tree_is_planar(tree)) {
        return;
    }
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        take_node(n, n->parent < 0 ? 1.0 : plane[n->parent].sense, &plane[k]);
    }
    lanes->plane = plane;
}
