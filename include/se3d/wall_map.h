/* SPDX-License-Identifier: BSD-3-Clause */
/* What particles do to each triangle of a mesh. Equations: docs/theory/averages.md.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_WALL_MAP_H
#define SE3D_WALL_MAP_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The numbers of a triangle, by the place of the first one; vectors are in the frame of the body of
 * the shape. @since 0.1 */
typedef enum se3d_wall_value {
    SE3D_WALL_PLACE = 0,    /* 3: the middle of the triangle [m] */
    SE3D_WALL_AREA = 3,     /* of it [m^2] */
    SE3D_WALL_PRESSURE = 4, /* normal forces on its area [Pa], positive where particles press */
    SE3D_WALL_SHEAR = 5,    /* 3: what else they do to it, on its area [Pa] */
    SE3D_WALL_SLIDING = 8, /* normal forces, as they press, times the speeds at which particles slip
                             * over them, on its area: Archard's wear grows by that [W/m^2] */
    SE3D_WALL_VALUES = 9   /* of a triangle */
} se3d_wall_value;

/* Get the forces of the last step on the triangles of a mesh. Their order is that of the library,
 * the same as long as the shape lives; triangles without an area are left out. A contact counts for
 * the triangle that its point is on, of an edge for one of the two. Contacts are those of
 * se3d_particles_get_contacts.
 * @param[in] shape     a mesh
 * @param[in] capacity  numbers that `values` has room for
 * @param[out] values   [count] SE3D_WALL_VALUES of each triangle, of those that there is room for;
 *                      NULL if capacity is 0
 * @param[out] count    numbers of all triangles
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (the shape is no mesh), STATE (the system is
 *         gone; from within a callback).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_wall_map(const se3d_particles *particles, se3d_shape shape,
                                                 size_t capacity, double *values, size_t *count);

#ifdef __cplusplus
}
#endif
#endif
