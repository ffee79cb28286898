/* SPDX-License-Identifier: BSD-3-Clause */
/* What hulls and meshes share: vertices and triangles. */
#ifndef SE3DI_CONTACT_TRIANGLES_H
#define SE3DI_CONTACT_TRIANGLES_H

#include "contact/shape/shape.h"
#include "math/vec3.h"

/* The point of a triangle nearest to p; its barycentric coordinates to `weights` (zero on the far
 * side of an edge or vertex) or NULL. Returns the squared distance. */
double se3di_triangle_nearest(const double *const corner[3], const double p[3], double point[3],
                              double weights[3]);
static inline void se3di_triangle_corners(const se3di_shape *shape, size_t triangle,
                                          const double *corner[3])
{
    for (size_t k = 0; k < 3; ++k) {
        corner[k] = shape->vertices + 3 * (size_t)shape->triangles[3 * triangle + k];
    }
}

/* A normal, counter-clockwise, as long as twice the area. */
static inline void se3di_triangle_span(const double *const corner[3], double normal[3])
{
    double u[3], v[3];
    se3di_sub(corner[1], corner[0], u);
    se3di_sub(corner[2], corner[0], v);
    se3di_cross(u, v, normal);
}

/* The unit normal, counter-clockwise; zero of a triangle without area. */
void se3di_triangle_normal(const double *const corner[3], double normal[3]);

/* The plane of a face of a hull, n.x = offset: its outward unit normal; returns the offset. */
static inline double se3di_face_plane(const se3di_shape *shape, size_t triangle, double n[3])
{
    const double *corner[3];
    if (shape->planes) {
        se3di_copy(shape->planes + 4 * triangle, n);
        return shape->planes[4 * triangle + 3];
    }
    se3di_triangle_corners(shape, triangle, corner);
    se3di_triangle_normal(corner, n);
    return se3di_dot(n, corner[0]);
}

double se3di_vertices_bound(const se3di_shape *shape);
double se3di_vertices_size(const se3di_shape *shape);
void se3di_vertices_support(const se3di_shape *shape, const double d[3], double out[3]);
/* Check the vertices of a definition and refer to them. @return OK, NULL, INVALID_ARGUMENT */
se3d_status se3di_vertices_define(const se3d_shape_def *def, se3di_shape *shape,
                                  se3di_error *error);
/* `pointer` is not NULL. */
se3d_status se3di_shape_check_array(const void *pointer, const char *name, se3di_error *error);

#endif
