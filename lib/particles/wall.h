/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls as particles see them, and which particles may touch them. */
#ifndef SE3DI_PARTICLES_WALL_H
#define SE3DI_PARTICLES_WALL_H

#include "particles/set.h"

/* Whether the wall's triangles are what particles touch. */
static inline int se3di_wall_is_mesh(const se3di_wall *wall)
{
    return se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_SURFACE) &&
           !se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_TURNED);
}

/* Walls that a shape is: two of a funnel, in which a particle may touch on both sides of the axis.
 */
static inline size_t se3di_wall_count_of(const se3di_shape *shape)
{
    return se3di_shape_is(shape, SE3DI_SHAPE_IS_TURNED) ? 2 : 1;
}

/* There is no particle: nothing pushes them. */
void se3di_walls_rest(se3di_particles *set);
/* Candidates of walls. */
se3d_status se3di_particles_list_walls(se3di_particles *set);
/* A point in the frame of a wall's shape. */
void se3di_wall_local(const se3di_wall *wall, const double x[3], double local[3]);
/* The point of a wall's surface nearest to x, the normal there; the distance, SE3DI_WALL_NOWHERE if
 * there is no such point: of the far side of a funnel, for what is not between its sides. */
double se3di_wall_nearest(const se3di_wall *wall, const double x[3], double point[3],
                          double normal[3]);
/* The same, or less where there is no such point: it grows by at most what x moves. */
double se3di_wall_distance(const se3di_wall *wall, const double x[3]);

#define SE3DI_WALL_NOWHERE 1e30
/* Shapes are repeated with the period: if x is not within `reach` of the wall, but one of its
 * images is, make it that one. `length`: 0 without a period. */
void se3di_wall_image(const se3di_wall *wall, const double length[3], double reach, double x[3]);
/* The same with the periods of a set, to `out`. */
void se3di_particles_image(const se3di_particles *set, const se3di_wall *wall, const double x[3],
                           double reach, double out[3]);
/* The vector between centres, to the nearest image. */
void se3di_particles_wrap(const se3di_particles *set, double d[3]);
/* The same, with the velocity of the one relative to the other: of that image. */
void se3di_particles_nearest(const se3di_particles *set, double d[3], double v[3]);
/* Into the period along those axes that have one. */
void se3di_particles_come_home(const se3di_particles *set, double x[3]);

#endif
