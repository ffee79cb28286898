/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the narrow phase share. */
#ifndef SE3DI_CONTACT_NARROW_INTERNAL_H
#define SE3DI_CONTACT_NARROW_INTERNAL_H

#include "contact/narrow/narrow.h"

/* A shape where it is. */
typedef struct se3di_solid {
    const se3di_shape *shape;
    const se3di_shape_pose *at;
} se3di_solid;

/* A flat part of a surface, seen from outside counter-clockwise; of one or two corners: a point or
 * an edge. */
#define SE3DI_FACE_CORNERS 16
typedef struct se3di_face {
    int count;
    uint32_t id;                          /* which part of the shape */
    double normal[3];                     /* outward; of edges the direction that was asked for */
    double corner[SE3DI_FACE_CORNERS][3]; /* ground frame */
} se3di_face;

/* Append a point; if the manifold is full the shallowest gives way. */
se3di_contact_point *se3di_manifold_add(se3di_manifold *manifold, const double point[3],
                                        const double normal[3], double overlap, uint32_t feature);
void se3di_bend_set(se3di_bend *bend, const double u[3], double along, double across);

/* The radius about its core (point or line) that is added to a shape; 0 if it has no core. */
double se3di_core_radius(const se3di_shape *shape);
/* The point of the core (of the whole shape if it has none) farthest along d. */
void se3di_core_support(const se3di_solid *solid, const double d[3], double point[3]);
/* The part of the shape that looks along d best. */
void se3di_face_find(const se3di_solid *solid, const double d[3], se3di_face *face);

/* Two convex shapes: the normal from i to j along which the least translation of j (the overlap)
 * separates the cores, negative: their distance; and the nearest points of the cores. */
double se3di_convex_distance(const se3di_solid *i, const se3di_solid *j, double normal[3],
                             double on_i[3], double on_j[3]);

/* The same to rounding and with the radii about the cores: the overlap, negative: the distance. */
double se3di_convex_least(const se3di_solid *i, const se3di_solid *j, double normal[3],
                          double on_i[3], double on_j[3]);

void se3di_narrow_boxes(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold);
void se3di_narrow_convex(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold);
/* A solid on a mesh; a mesh on the half space at x with the outward normal n. */
void se3di_narrow_mesh(const se3di_solid *i, const se3di_solid *mesh, se3di_manifold *manifold);
void se3di_narrow_mesh_plane(const se3di_solid *mesh, const double x[3], const double n[3],
                             se3di_manifold *manifold);
/* Four points of each rim of a cylinder: the lowest one towards a face with this normal, and at
 * right angles. Returns the sine of the tilt. */
double se3di_cylinder_rims(const se3di_solid *i, const double normal[3], double rim[8][3]);
/* Contact of the face `reference` (of i; `flip`: of j) with what of the other looks at it, with
 * overlaps along the unit `along`, outward from the face. */
void se3di_narrow_clip(const se3di_face *reference, const se3di_face *incident,
                       const double along[3], double radius, int flip, se3di_manifold *manifold);
/* How a part of a surface bends that is touched at its corners, or as a line. */
void se3di_face_bend(const se3di_face *incident, double radius, se3di_bend *bend);

#endif
