/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes: surfaces of triangles with two sides, found through a tree of boxes.
 *                                                                          docs/theory/shapes.md */
#ifndef SE3DI_CONTACT_MESH_H
#define SE3DI_CONTACT_MESH_H

#include "model/model.h"

#define SE3DI_MESH_OUTLINE_MOST 16384 /* vertices of meshes of which outlines are looked for */

/* A place where a sphere touches: a point of the surface, shape frame. */
typedef struct se3di_touch {
    double point[3], normal[3]; /* the normal points to the sphere's centre */
    double distance;            /* of the centre */
} se3di_touch;

/* Fill vertices, triangles (without those that have no area, in the order of the tree) and tree of
 * the shape; they are the caller's, see se3di_shape_release.
 * @return OK, NO_MEMORY, INVALID_ARGUMENT (no triangle has an area). */
se3d_status se3di_mesh_build(const se3d_allocator *allocator, const double *vertices,
                             size_t vertex_count, const uint32_t *triangles, size_t triangle_count,
                             se3di_shape *shape);

/* The nearest triangle; its point and distance. */
size_t se3di_mesh_nearest(const se3di_shape *shape, const double local[3], double point[3],
                          double *distance);

/* The same as se3di_shape_nearest. */
void se3di_mesh_nearest_point(const se3di_shape *shape, const double local[3], double point[3],
                              double normal[3], double *distance);

/* All separate contacts of a sphere, the nearest first, at most `capacity`: one where neighbours
 * are in a plane or nearly so, also on their common edge. Returns their number. */
size_t se3di_mesh_contacts(const se3di_shape *shape, const double local[3], double radius,
                           size_t capacity, se3di_touch *touch);

/* The same if all triangles within the radius are among these, in the order of the tree. */
size_t se3di_mesh_contacts_among(const se3di_shape *shape, const uint32_t *faces, size_t face_count,
                                 const double local[3], double radius, size_t capacity,
                                 se3di_touch *touch);
/* Whether one of these triangles is nearer than the radius. */
int se3di_mesh_is_near(const se3di_shape *shape, const uint32_t *faces, size_t face_count,
                       const double local[3], double radius);

/* Whether no triangle is nearer to a point than the radius. */
int se3di_mesh_is_clear(const se3di_shape *shape, const double local[3], double radius);

/* Visit all triangles nearer to a point than the radius, in the order of the tree. */
void se3di_mesh_visit(const se3di_shape *shape, const double local[3], double radius,
                      void (*visitor)(void *ctx, uint32_t triangle), void *ctx);

/* Visit all triangles that reach into a box along the axes, and some beside it. */
void se3di_mesh_visit_box(const se3di_shape *shape, const double low[3], const double high[3],
                          void (*visitor)(void *ctx, uint32_t triangle), void *ctx);

/* Whether the segment between two points meets the surface. */
int se3di_mesh_crosses(const se3di_shape *shape, const double from[3], const double to[3]);

/* A place at which a segment passes through the surface. */
typedef struct se3di_mesh_cut {
    double share; /* of the way */
    uint32_t triangle, reserved;
} se3di_mesh_cut;
/* All such places in their order, at most `capacity`: those on a side are on both triangles.
 * Returns their number. */
size_t se3di_mesh_find_cuts(const se3di_shape *shape, const double from[3], const double to[3],
                            size_t capacity, se3di_mesh_cut *cuts);

/* Whether the surface bulges at an edge of a triangle; of open ones also if it bends inward. */
int se3di_mesh_edge_bulges(const se3di_shape *shape, uint32_t triangle, uint32_t side);
/* Whether an edge of a mesh need not be looked at from this triangle: it is about flat, or the
 * triangle beyond it, which comes first, tells of it. */
int se3di_mesh_edge_is_told(const se3di_shape *shape, uint32_t triangle, uint32_t side);
/* Whether nothing of a closed mesh is beyond the plane of a triangle, as far as is known: of meshes
 * of more vertices than outlines are looked for all triangles count as such. */
int se3di_mesh_is_outermost(const se3di_shape *shape, uint32_t triangle);
/* Find that out; its sense is known. */
void se3di_mesh_note_outermost(se3di_shape *shape);

/* Whether triangles may be within a box along the axes. */
int se3di_mesh_meets_box(const se3di_shape *shape, const double low[3], const double high[3]);

#endif
