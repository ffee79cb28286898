/* SPDX-License-Identifier: BSD-3-Clause */
/* The boxes around triangles that searches go through: shape->tree begins with them. */
#ifndef SE3DI_CONTACT_MESH_TREE_H
#define SE3DI_CONTACT_MESH_TREE_H

#include "model/model.h"

#define SE3DI_MESH_LEAF 4 /* triangles of a leaf */

typedef struct se3di_mesh_node {
    double low[3], high[3];
    uint32_t begin, count; /* triangles of a leaf; count 0: its children are the next node and */
    uint32_t right, reserved;
} se3di_mesh_node;

#endif
