/* SPDX-License-Identifier: BSD-3-Clause */
/* Geometry of shapes, in their own frames.                                docs/theory/shapes.md */
#ifndef SE3DI_CONTACT_SHAPE_H
#define SE3DI_CONTACT_SHAPE_H

#include "model/model.h"

/* Pose and velocity of a shape, ground frame. */
typedef struct se3di_shape_pose {
    double x[3], R[9];       /* origin; shape -> ground */
    double v[3], w[3], c[3]; /* of its body: velocity, angular velocity; centre of mass */
} se3di_shape_pose;

void se3di_shape_place(const se3di_shape *shape, const se3di_frame *frame, se3di_shape_pose *pose);

/* The radius about the origin that holds the shape; infinite for a plane. */
double se3di_shape_bound(const se3di_shape *shape);

/* The point of the surface nearest to `local`, the outward unit normal there and the signed
 * distance, negative inside: local = point + distance * normal. A mesh is a surface with two
 * sides: its distance is never negative. Shape frame. */
void se3di_shape_nearest(const se3di_shape *shape, const double local[3], double point[3],
                         double normal[3], double *distance);

/* The point of a triangle nearest to p; its barycentric coordinates to `weights` (zero on the far
 * side of an edge or vertex) or NULL. Returns the squared distance. */
double se3di_triangle_nearest(const double *const corner[3], const double p[3], double point[3],
                              double weights[3]);

#endif
