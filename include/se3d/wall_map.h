/* SPDX-License-Identifier: BSD-3-Clause */
/* What particles do to each patch of a surface: the triangles of a mesh or heightfield, or the
 * patches of a funnel, which rings and 24 sectors part. Equations: docs/theory/averages.md.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_WALL_MAP_H
#define SE3D_WALL_MAP_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The numbers of a patch, by the place of the first one; vectors are in the frame of the body of
 * the shape. @since 0.1 */
typedef enum se3d_wall_value {
    SE3D_WALL_PLACE = 0,    /* 3: the middle of the patch [m] */
    SE3D_WALL_AREA = 3,     /* of it [m^2] */
    SE3D_WALL_PRESSURE = 4, /* normal forces on its area [Pa], positive where particles press */
    SE3D_WALL_SHEAR = 5,    /* 3: what else they do to it, on its area [Pa] */
    SE3D_WALL_SLIDING = 8, /* normal forces, as they press, times the speeds at which particles slip
                             * over them, on its area: Archard's wear grows by that [W/m^2] */
    SE3D_WALL_VALUES = 9,  /* of a patch */
    SE3D_WALL_CORNERS = 12 /* numbers of its corners */
} se3d_wall_value;

/* Get the forces of the last step on the patches of a mesh, heightfield or funnel. The order of
 * triangles is that of the library, the same as long as the shape lives; those of a mesh without an
 * area are left out. Patches of a funnel follow each other around, from -z up. A contact counts for
 * the patch that its point is on, of an edge for one of the two. Contacts are those of
 * se3d_particles_get_contacts.
 * @param[in] shape     a mesh, a heightfield or a funnel
 * @param[in] capacity  numbers that `values` has room for
 * @param[out] values   [count] SE3D_WALL_VALUES of each patch, of those that there is room for;
 *                      NULL if capacity is 0
 * @param[out] count    numbers of all patches
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (the shape is no surface), STATE (the system is
 *         gone; from within a callback).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_wall_map(const se3d_particles *particles, se3d_shape shape,
                                                 size_t capacity, double *values, size_t *count);

/* Get the corners of the patches, in the same order.
 * @param[in] shape     a mesh, a heightfield or a funnel
 * @param[in] capacity  numbers that `corners` has room for
 * @param[out] corners  [count] SE3D_WALL_CORNERS of each patch, of those that there is room for:
 *                      four points, of a triangle the last one twice [m], frame of the body of the
 *                      shape; NULL if capacity is 0
 * @param[out] count    numbers of all patches
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (the shape is no surface), STATE (the system is
 *         gone; from within a callback).
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_get_wall_corners(const se3d_particles *particles,
                                                     se3d_shape shape, size_t capacity,
                                                     double *corners, size_t *count);

#ifdef __cplusplus
}
#endif
#endif
