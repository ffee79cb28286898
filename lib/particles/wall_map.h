/* SPDX-License-Identifier: BSD-3-Clause */
/* What particles do to the patches of a surface: triangles of a mesh or heightfield, rings and
 * sectors of a funnel. */
#ifndef SE3DI_PARTICLES_WALL_MAP_H
#define SE3DI_PARTICLES_WALL_MAP_H

#include "particles/set.h"
#include "se3d/wall_map.h"

/* The wall of a set that is this shape; NULL: none. */
const se3di_wall *se3di_wall_map_find(const se3di_particles *set, se3di_handle shape);
/* How many patches a shape has; 0: it is no surface. */
size_t se3di_wall_map_count(const se3di_shape *shape);
/* The numbers of the first `capacity` patches; wall NULL: without forces. */
void se3di_wall_map_fill(const se3di_particles *set, const se3di_wall *wall,
                         const se3di_shape *shape, size_t capacity, double *values);
/* [SE3D_WALL_CORNERS] of a patch, frame of the body. */
void se3di_wall_map_get_corners(const se3di_shape *shape, size_t patch, double *corners);

#endif
