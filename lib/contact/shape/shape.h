/* SPDX-License-Identifier: BSD-3-Clause */
/* Geometry of shapes, in their own frames: one class for each kind (SE3DI_SHAPE_LIST), which its
 * file defines.                                                          docs/theory/shapes.md */
#ifndef SE3DI_CONTACT_SHAPE_H
#define SE3DI_CONTACT_SHAPE_H

#include "model/model.h"
#include "se3d/shape.h"

#include <stddef.h>

/* Pose and velocity of a shape, ground frame. */
typedef struct se3di_shape_pose {
    double x[3], R[9]; /* origin; shape -> ground */
    double c[3];       /* centre of mass of its body */
    double v[3], w[3]; /* of its body: velocity at c, angular velocity */
    double u[3];       /* velocity of its surface on the body at c, */
    double spin[3];    /* and angular velocity; 0 if that is at rest */
    int moves;         /* whether it is not */
} se3di_shape_pose;

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

/* How a surface itself bends where it is touched: moving on by a length l along `u` turns its
 * normal by l / r[0], along n x u by l / r[1]. 0: a corner or edge; infinite: flat. */
typedef struct se3di_bend {
    double u[3]; /* unit, perpendicular to the normal */
    double r[2];
} se3di_bend;

/* A length in a definition, or three that follow each other; all must be > 0. */
typedef struct se3di_dimension {
    const char *name; /* of the member of se3d_shape_def; NULL: no more */
    size_t from, to;  /* offsets in se3d_shape_def, se3di_shape */
    double factor;
    uint32_t count;
    uint32_t may_be_zero;
} se3di_dimension;

/* Directions of the shape's axes, by bits: 1 x, 2 y, 4 z. */
#define SE3DI_AXES_NONE 0u
#define SE3DI_AXES_Z    4u
#define SE3DI_AXES_ALL  7u

/* What a kind of shape is. Left out (NULL, 0): the general answer that is named. */
typedef struct se3di_shape_class {
    const char *name;
    uint32_t flats; /* its axes that have a flat face at both ends */
    uint32_t lines; /* its axes along which there are straight lines on its surface */
    /* The lengths that its definition has, in the order in which they are checked; NULL: none. */
    const se3di_dimension *dimensions;
    /* The rest of the definition, or NULL. Arrays of the shape are allocated and its own.
     * @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY (a message in `error`) */
    se3d_status (*define)(const se3d_shape_def *def, const se3d_allocator *allocator,
                          se3di_shape *shape, se3di_error *error);
    /* The radius about the origin that holds it; infinite for a half space. */
    double (*bound)(const se3di_shape *shape);
    /* By how much it may be compressed at the most, see se3di_shape_contact_size. */
    double (*size)(const se3di_shape *shape);
    /* See se3di_shape_nearest. */
    void (*nearest)(const se3di_shape *shape, const double local[3], double point[3],
                    double normal[3], double *distance);
    /* The point of the core farthest along d, shape frame. NULL: the origin. */
    void (*support)(const se3di_shape *shape, const double d[3], double out[3]);
    /* How the point farthest along the unit n moves as n turns by u, perpendicular to it, of what
     * is smooth; shape frame. */
    void (*turn)(const se3di_shape *shape, const double n[3], const double u[3], double out[3]);
    /* The part that looks along d (shape frame) best, in the ground frame. NULL: a point. */
    void (*face)(const se3di_solid *solid, const double d[3], se3di_face *face);
    /* Its corner k, shape frame; 0: there is none. NULL: it has no corners. */
    int (*corner)(const se3di_shape *shape, uint32_t k, double out[3]);
    /* How its surface bends at `local`, the place nearest to a sphere: `u` (shape frame) and radii.
     * 0: u does not matter. NULL: it is flat. */
    int (*bend)(const se3di_shape *shape, const double local[3], double u[3], double r[2]);
} se3di_shape_class;

#define SE3DI_SHAPE_DECLARE(KIND, name, traits)                                                    \
    extern const se3di_shape_class se3di_shape_class_##name;
SE3DI_SHAPE_LIST(SE3DI_SHAPE_DECLARE)
#undef SE3DI_SHAPE_DECLARE

const se3di_shape_class *se3di_shape_class_of(const se3di_shape *shape);

/* Read what distinguishes the kind from a definition and compute the bound. Arrays of the shape are
 * its own then (se3di_shape_release). @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY */
se3d_status se3di_shape_define(const se3d_shape_def *def, const se3d_allocator *allocator,
                               se3di_shape *shape, se3di_error *error);

/* Whether its surface moves on its body. */
int se3di_surface_moves(const se3di_shape *shape);
/* Its velocity on its body at a point `r` from the body's centre, ground frame, and its spin. */
void se3di_surface_velocity(const se3di_shape *shape, const double A[9], const double r[3],
                            double velocity[3], double spin[3]);
void se3di_shape_place(const se3di_shape *shape, const se3di_frame *frame, se3di_shape_pose *pose);
void se3di_solid_to_ground(const se3di_solid *solid, const double local[3], double out[3]);
void se3di_solid_to_local(const se3di_solid *solid, const double x[3], double local[3]);
/* Its axis a in the ground frame. */
static inline void se3di_solid_axis(const se3di_solid *solid, int a, double out[3])
{
    out[0] = solid->at->R[a];
    out[1] = solid->at->R[3 + a];
    out[2] = solid->at->R[6 + a];
}

/* The radius about the origin that holds the shape; infinite for a plane. */
double se3di_shape_bound(const se3di_shape *shape);

/* How its surface bends at the place that is nearest to `local`, shape frame; `bend` is that of
 * what is flat before. */
void se3di_solid_bend(const se3di_solid *solid, const double local[3], se3di_bend *bend);

/* The radius of curvature where shapes touch, for R* of the laws: of round shapes their radius,
 * infinite for others. */
double se3di_shape_contact_radius(const se3di_shape *shape);

/* By how much a shape may be compressed at the most: a radius, or half of what is least. Infinite
 * for a plane. */
double se3di_shape_contact_size(const se3di_shape *shape);

/* The radius about its core (point or line) that is added to a shape; 0 if it has no core. */
double se3di_core_radius(const se3di_shape *shape);
/* The point of the core (of the whole shape if it has none) farthest along d. */
void se3di_core_support(const se3di_solid *solid, const double d[3], double point[3]);
/* The part of the shape that looks along d best. */
void se3di_face_find(const se3di_solid *solid, const double d[3], se3di_face *face);
/* The direction (unit, along the shape's x and y) from a cylinder's axis to the first of the points
 * that stand for the rim of a cap. The cap looks along d (shape frame), its lowest place is `deep`.
 * As long as all of the cap is deep they stay on the body, but for what they turn as it leans: four
 * or more points all around push alike wherever they are. Else the first is the lowest place. */
void se3di_cap_lean(const se3di_shape *s, const double d[3], double deep, double lean[2]);
/* By how much the deepest of four such points is less deep than the lowest place; d in the ground
 * frame. 0 for what has no rim. */
double se3di_cap_bulge(const se3di_solid *solid, const double d[3], double deep);
/* The cap that looks along d (ground frame) as a face with corners so placed. */
void se3di_cap_find(const se3di_solid *solid, const double d[3], double deep, se3di_face *face);
/* That of a shape with straight sides along z which have this radius: a line. */
void se3di_face_set_line(const se3di_solid *solid, const double d[3], double radius,
                         se3di_face *face);

/* The point of the surface nearest to `local`, the outward unit normal there and the signed
 * distance, negative inside: local = point + distance * normal. A mesh is a surface with two
 * sides: its distance is never negative. Shape frame. */
void se3di_shape_nearest(const se3di_shape *shape, const double local[3], double point[3],
                         double normal[3], double *distance);
/* The same of a ball about a point of a core. */
void se3di_shape_nearest_swept(const double core[3], double radius, const double local[3],
                               double point[3], double normal[3], double *distance);

#endif
