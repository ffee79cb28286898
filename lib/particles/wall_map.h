/* SPDX-License-Identifier: BSD-3-Clause */
/* What particles do to the triangles of a mesh. */
#ifndef SE3DI_PARTICLES_WALL_MAP_H
#define SE3DI_PARTICLES_WALL_MAP_H

#include "particles/set.h"
#include "se3d/wall_map.h"

/* The wall of a set that is this shape; NULL: none. */
const se3di_wall *se3di_wall_map_find(const se3di_particles *set, se3di_handle shape);
/* The numbers of the first `capacity` triangles of a mesh; wall NULL: without forces. */
void se3di_wall_map_fill(const se3di_particles *set, const se3di_wall *wall,
                         const se3di_shape *mesh, size_t capacity, double *values);

#endif
