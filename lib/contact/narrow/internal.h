/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the narrow phase share. */
#ifndef SE3DI_CONTACT_NARROW_INTERNAL_H
#define SE3DI_CONTACT_NARROW_INTERNAL_H

#include "contact/narrow/narrow.h"
#include "math/vec3.h"

#include <float.h>

static inline int se3di_solid_has_rims(const se3di_solid *solid)
{
    return se3di_shape_is(solid->shape, SE3DI_SHAPE_HAS_RIMS);
}

static inline int se3di_solid_is_smooth(const se3di_solid *solid)
{
    return se3di_shape_is(solid->shape, SE3DI_SHAPE_IS_SMOOTH);
}

/* The core is one. */
static inline int se3di_solid_is_line(const se3di_solid *solid)
{
    return se3di_shape_is(solid->shape, SE3DI_SHAPE_IS_SWEPT) &&
           !se3di_shape_is(solid->shape, SE3DI_SHAPE_IS_BALL);
}

/* Append a point; if the manifold is full, one of the two that are nearest to each other gives way,
 * this one perhaps. */
se3di_contact_point *se3di_manifold_add(se3di_manifold *manifold, const double point[3],
                                        const double normal[3], double overlap, uint32_t feature);
/* A point between two flat surfaces. */
void se3di_contact_point_set(se3di_contact_point *p, const double point[3], const double normal[3],
                             double overlap, uint32_t feature);
/* Of points that are more than `most` one after the other that is near another one goes. Returns
 * how many there are then. */
uint32_t se3di_contact_points_thin(se3di_contact_point *points, uint32_t count, uint32_t most);
/* As if the other shape came first. */
void se3di_manifold_mirror(se3di_manifold *manifold);
/* Points are told apart by their features: change those that several have, by their normals in the
 * frame R of one of the bodies. */
void se3di_manifold_separate(se3di_manifold *manifold, const double R[9]);
void se3di_bend_set(se3di_bend *bend, const double u[3], double along, double across);

/* Two convex shapes: the normal from i to j along which the least translation of j (the overlap)
 * separates the cores, negative: their distance; and the nearest points of the cores. Of cores that
 * are farther apart than `far` >= 0 only a bound of it beyond `far` is found. */
double se3di_convex_distance(const se3di_solid *i, const se3di_solid *j, double far,
                             double normal[3], double on_i[3], double on_j[3]);

/* Whether a side of a solid shows that it is apart from a line by more than a distance; if not, it
 * may be. */
int se3di_side_parts(const se3di_solid *solid, const double from[3], const double to[3],
                     double distance);
/* The same of a triangle, in the frame of the shape. */
int se3di_side_parts_triangle(const se3di_shape *s, const double corner[3][3], double distance);
/* Whether the cores of two are apart by more than a distance. */
int se3di_convex_are_apart(const se3di_solid *i, const se3di_solid *j, double distance);
/* Whether the planes across a unit direction, from i to j, part them so; if not, others may. */
int se3di_convex_are_parted(const se3di_solid *i, const se3di_solid *j, const double n[3],
                            double distance);

/* How far a box, or the line of a capsule, overlaps a cylinder, or such a line (not two lines), the
 * normal from the first to the second, and the places that are farthest in each other. <= 0: the
 * box and the cylinder are apart, and no more is set; a line and a box may be apart in spite of an
 * overlap. */
double se3di_cylinder_overlap(const se3di_solid *block, const se3di_solid *cylinder, double n[3],
                              double on_block[3], double on_cylinder[3]);

/* How far a cylinder and any other solid, of which one touches a cap of the other, overlap, as
 * above; 0: it is not known so. */
double se3di_caps_overlap(const se3di_solid *i, const se3di_solid *j, double n[3], double on_i[3],
                          double on_j[3]);
/* The same of two cylinders, which may also lie side by side or cross. */
double se3di_cylinders_overlap(const se3di_solid *i, const se3di_solid *j, double n[3],
                               double on_i[3], double on_j[3]);

/* Replace a direction that is near the one of the least overlap, the points of the cores that are
 * farthest in each other and the overlap by those to rounding. Returns whether there is one. */
int se3di_convex_polish(const se3di_solid *i, const se3di_solid *j, double n[3], double a[3],
                        double b[3], double *overlap);

/* The same to rounding and with the radii about the cores: the overlap, negative: the distance. */
double se3di_convex_least(const se3di_solid *i, const se3di_solid *j, double far, double normal[3],
                          double on_i[3], double on_j[3]);

void se3di_narrow_sphere(const se3di_solid *sphere, const se3di_solid *j, se3di_manifold *manifold);
void se3di_narrow_boxes(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold);
void se3di_narrow_convex(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold);
/* A solid on a mesh. */
void se3di_narrow_mesh(const se3di_solid *i, const se3di_solid *mesh, se3di_manifold *manifold);
/* Two surfaces, of which at least one is closed, by their triangles. */
void se3di_narrow_surfaces(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold);
/* The same, with convex pieces or without. */
void se3di_narrow_meshes(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold);
double se3di_narrow_meshes_gap(const se3di_solid *i, const se3di_solid *j, double normal[3]);
/* On a plane: the corners of a shape that has some; a capsule; a cylinder; of any other convex
 * shape the lowest point, of a smooth one with how it bends there; a mesh. */
void se3di_plane_corners(const se3di_solid *i, const se3di_solid *plane, se3di_manifold *manifold);
void se3di_plane_capsule(const se3di_solid *i, const se3di_solid *plane, se3di_manifold *manifold);
void se3di_plane_cylinder(const se3di_solid *i, const se3di_solid *plane, se3di_manifold *manifold);
void se3di_plane_convex(const se3di_solid *i, const se3di_solid *plane, se3di_manifold *manifold);
void se3di_plane_smooth(const se3di_solid *i, const se3di_solid *plane, se3di_manifold *manifold);
void se3di_plane_mesh(const se3di_solid *mesh, const se3di_solid *plane, se3di_manifold *manifold);
/* Four points of each rim of a cylinder whose lowest place is so deep in a face with this normal:
 * the lowest one, that across it, and at right angles; on a cap that is deep all around they are
 * turned (se3di_cap_lean). Returns the sine of the tilt. */
double se3di_cylinder_rims(const se3di_solid *i, const double normal[3], double deep,
                           double rim[8][3]);
/* How the surface bends at the lowest point of each (0 and 4), which wanders along the rim as the
 * cylinder rolls; 0: it stands on its cap. */
int se3di_rim_bend(const se3di_solid *i, const double normal[3], double tilt, se3di_bend *bend);
/* Contact of the face `reference` (of i; `flip`: of j) with what of the other looks at it, with
 * overlaps along the unit `along`, outward from the face. The two are `depth` deep. */
void se3di_narrow_clip(const se3di_face *reference, const se3di_face *incident,
                       const double along[3], double radius, double depth, int flip,
                       se3di_manifold *manifold);
/* What rounding may make of the height of a corner over a face: where two flat parts begin to touch
 * and are not deeper than this, all corners that are within it are as deep. Else three of four may
 * be the first, and what falls flat would turn. */
static inline double se3di_narrow_rounding(const double place[3], double size)
{
    return 64.0 * DBL_EPSILON * (size + se3di_norm(place));
}
/* How a part of a surface bends that is touched at its corners, or as a line. */
void se3di_face_bend(const se3di_face *incident, double radius, se3di_bend *bend);

#endif
