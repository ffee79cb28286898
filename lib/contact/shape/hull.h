/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex hulls of points. */
#ifndef SE3DI_CONTACT_HULL_H
#define SE3DI_CONTACT_HULL_H

#include "model/model.h"

/* Fill the shape's vertices (the corners of the hull) and triangles (its faces, counter-clockwise
 * seen from outside) with their planes; they are the caller's, see se3di_shape_release.
 * @return OK, NO_MEMORY, INVALID_ARGUMENT (the points lie in a plane); the arrays are NULL then. */
se3d_status se3di_hull_build(const se3d_allocator *allocator, const double *points, size_t count,
                             se3di_shape *shape);
/* Its planes again, of vertices that have moved. */
void se3di_hull_set_planes(se3di_shape *shape);

#endif
