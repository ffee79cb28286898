/* SPDX-License-Identifier: BSD-3-Clause */
/* The boxes around triangles that searches go through: shape->tree begins with them; behind them
 * those of a mesh, but not of a heightfield, have their facets and what is beyond their sides. */
#ifndef SE3DI_CONTACT_MESH_TREE_H
#define SE3DI_CONTACT_MESH_TREE_H

#include "model/model.h"

#define SE3DI_MESH_LEAF 4 /* triangles of a leaf */

typedef struct se3di_mesh_node {
    double low[3], high[3];
    uint32_t begin, count; /* triangles of a leaf; count 0: its children are the next node and */
    uint32_t right, reserved;
} se3di_mesh_node;

/* A triangle a, b, c as the foot of a perpendicular needs it: 16 numbers, but for the last. */
typedef struct se3di_mesh_facet {
    double a[3], normal[3];  /* of unit length */
    double to_b[3], to_c[3]; /* dot products with x - a: parts of b - a and c - a in its foot */
    double heights[3];       /* of b, c and a over the sides opposite; 0: not told, of slivers */
    uint8_t edges[8];        /* bits: at this edge the next triangle leads 1 below, 2 above it, 4
                                leads on in about its plane, or is the one that tells of the edge;
                                the fourth: it is outermost */
} se3di_mesh_facet;

#define SE3DI_MESH_BYTES (sizeof(se3di_mesh_facet) + 3 * sizeof(uint32_t)) /* of a triangle */

/* Of a closed mesh: the triangles beyond the sides of each. */
static inline uint32_t *se3di_mesh_beyond(const se3di_shape *shape)
{
    char *end = (char *)shape->tree + shape->tree_bytes;
    return (uint32_t *)(void *)end - 3 * shape->triangle_count;
}

static inline se3di_mesh_facet *se3di_mesh_facets(const se3di_shape *shape)
{
    void *end = se3di_mesh_beyond(shape);
    return (se3di_mesh_facet *)end - shape->triangle_count;
}

#endif
