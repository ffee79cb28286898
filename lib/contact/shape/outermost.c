/* SPDX-License-Identifier: BSD-3-Clause */
/* Which triangles of a closed mesh nothing of it is beyond: parts of its hull. */
#include "contact/shape/mesh.h"
#include "contact/shape/mesh_tree.h"
#include "math/vec3.h"

#include <math.h>

#define PLACE 3    /* of the bit among those of edges */
#define MOST  2000 /* the first triangles, of which it is found out; others may be such */
#define FLUSH 1e-6 /* of the size: a vertex is in the plane of a face */

void se3di_mesh_note_outermost(se3di_shape *s)
{
    double size = 0.0;
    const size_t most = s->vertex_count > SE3DI_MESH_OUTLINE_MOST ? 0 : MOST; /* none asks */
    for (size_t k = 0; k < s->vertex_count; ++k) {
        size = fmax(size, se3di_norm(s->vertices + 3 * k));
    }
    for (size_t t = 0; t < s->triangle_count && s->closed != 0; ++t) {
        se3di_mesh_facet *f = se3di_mesh_facets(s) + t;
        int is_outermost = 1;
        for (size_t k = 0; k < s->vertex_count && is_outermost && t < most; ++k) {
            double d[3];
            se3di_sub(s->vertices + 3 * k, f->a, d);
            is_outermost = !(s->closed * se3di_dot(d, f->normal) > FLUSH * size);
        }
        f->edges[PLACE] = (uint8_t)is_outermost;
    }
}

int se3di_mesh_is_outermost(const se3di_shape *shape, uint32_t triangle)
{
    return se3di_mesh_facets(shape)[triangle].edges[PLACE] != 0;
}
