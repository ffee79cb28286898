/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls as particles see them, and which particles may touch them. */
#ifndef SE3DI_PARTICLES_WALL_H
#define SE3DI_PARTICLES_WALL_H

#include "particles/set.h"

/* Candidates of walls. */
se3d_status se3di_particles_list_walls(se3di_particles *set);
/* A point in the frame of a wall's shape. */
void se3di_wall_local(const se3di_wall *wall, const double x[3], double local[3]);
/* The point of a wall's surface nearest to x, the normal there; the distance. */
double se3di_wall_nearest(const se3di_wall *wall, const double x[3], double point[3],
                          double normal[3]);
double se3di_wall_distance(const se3di_wall *wall, const double x[3]);
/* Shapes are repeated with the period: if x is not within `reach` of the wall, but one of its
 * images is, make it that one. `length`: 0 without a period. */
void se3di_wall_image(const se3di_wall *wall, const double length[3], double reach, double x[3]);
/* The same with the periods of a set, to `out`. */
void se3di_particles_image(const se3di_particles *set, const se3di_wall *wall, const double x[3],
                           double reach, double out[3]);
/* The vector between centres, to the nearest image. */
void se3di_particles_wrap(const se3di_particles *set, double d[3]);

#endif
