/* SPDX-License-Identifier: BSD-3-Clause */
/* A closed mesh as the union of convex pieces, which may overlap.      docs/theory/shapes.md */
#ifndef SE3DI_CONTACT_PIECES_H
#define SE3DI_CONTACT_PIECES_H

#include "model/model.h"

#define SE3DI_PIECES_MOST 32 /* of one mesh */

/* Fill pieces and piece_count of a mesh that is closed and not convex: hulls, whose origins x are
 * in its frame. None if it has too many triangles or would need too many pieces, or if their volume
 * is not the mesh's. @return OK, NO_MEMORY (there are none then) */
se3d_status se3di_pieces_build(const se3d_allocator *allocator, se3di_shape *mesh);

#endif
