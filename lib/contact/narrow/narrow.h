/* SPDX-License-Identifier: BSD-3-Clause */
/* Two shapes with their poses: where and how deep they touch. docs/theory/body-contact.md
 *
 * The normal points from the first shape to the second. Overlaps change continuously with the
 * poses. The point of a pair of round shapes is half way between the two surfaces; on a plane, and
 * of a sphere and another kind of shape, it is on the surface of that shape. */
#ifndef SE3DI_CONTACT_NARROW_H
#define SE3DI_CONTACT_NARROW_H

#include "contact/shape/shape.h"

#define SE3DI_MANIFOLD_POINTS 16

typedef struct se3di_contact_point {
    double point[3];  /* ground frame */
    double normal[3]; /* from the first shape to the second, ground frame */
    double overlap;   /* > 0 */
    double share;     /* where the point is from the surface of i (0) to that of j (1) */
    uint32_t feature; /* the same for the same parts of the shapes from step to step */
    uint32_t reserved;
    se3di_bend bend_i, bend_j;
} se3di_contact_point;

typedef struct se3di_manifold {
    uint32_t count;
    uint32_t reserved;
    se3di_contact_point points[SE3DI_MANIFOLD_POINTS + 1]; /* the last: one too many */
} se3di_manifold;

/* Whether there is contact between two shapes of these kinds; not between two planes, or two
 * surfaces of which none is closed, convex or in convex pieces. */
int se3di_narrow_is_known(const se3di_shape *i, const se3di_shape *j);

/* The points where shapes i and j touch; none if they are apart, or their pair is not known. */
void se3di_narrow_find(const se3di_shape *i, const se3di_shape_pose *at_i, const se3di_shape *j,
                       const se3di_shape_pose *at_j, se3di_manifold *manifold);

/* How far two shapes are apart at least, 0 if they touch, and the direction from i to j in which
 * they are (zero: not known, as for meshes). */
double se3di_narrow_gap(const se3di_shape *i, const se3di_shape_pose *at_i, const se3di_shape *j,
                        const se3di_shape_pose *at_j, double normal[3]);

/* Whether a mesh is farther than a distance from the sphere about the other one, which takes less
 * than to find the gap; 0 also of pairs without a mesh. */
int se3di_narrow_is_beyond(const se3di_shape *i, const se3di_shape_pose *at_i, const se3di_shape *j,
                           const se3di_shape_pose *at_j, double distance);

#endif
