/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files on solids and surfaces of triangles share. */
#ifndef SE3DI_CONTACT_NARROW_MESH_H
#define SE3DI_CONTACT_NARROW_MESH_H

#include "contact/narrow/internal.h"
#include "contact/shape/mesh.h"
#include "math/vec3.h"

#include <math.h>

#define SE3DI_MESH_COPLANAR 0.999 /* cosine of the angle of faces that are one */
#define SE3DI_MESH_SAME     1e-6  /* of the solid's size: points that are one */
#define SE3DI_MESH_OUT      1e-12 /* a direction that leads into a face by less leads out */
#define SE3DI_MESH_WAYS     24
#define SE3DI_MESH_TOUCHES  16 /* faces that one ball touches */
#define SE3DI_MESH_SIDES    4  /* faces that one corner touches */
#define SE3DI_MESH_PLANES   8  /* of faces, that are told apart */

/* All in the frame of the mesh. */
typedef struct se3di_mesh_face {
    double n[3], corner[3], middle[3]; /* unit, towards the solid's centre */
} se3di_mesh_face;

/* A way by which the solid comes off a part of the surface, and off no other sooner. */
typedef struct se3di_mesh_way {
    double n[3], depth, at[3]; /* to the solid; the place of the surface that is left last */
    se3di_mesh_face face;      /* that has the place */
    uint32_t feature;
    uint32_t triangle, beyond; /* of the place */
    uint32_t reserved;
} se3di_mesh_way;

/* Of a plane in which faces lie the points of rims that have been looked at: a bit for each. */
typedef struct se3di_mesh_plane {
    se3di_mesh_face face;
    uint64_t looked;
} se3di_mesh_plane;

typedef struct se3di_mesh_meeting {
    const se3di_solid *solid, *mesh;
    double origin[3];       /* of the solid */
    double center[3];       /* a point within it */
    double R[9], x[3];      /* from the frame of the mesh to the solid's */
    double low[3], high[3]; /* along the mesh's axes: a box that holds the solid, but for rounding;
                               if it is looked for in what is about it */
    double size;
    int sense; /* of the triangles: 1 counter-clockwise seen from the solid, -1 clockwise, 0: each
                  for itself */
    int way_count;
    int has_pieces; /* which tell the ways off it */
    int plane_count;
    se3di_manifold *manifold;
    const struct se3di_mesh_filter *filter; /* NULL: all contacts are kept */
    se3di_mesh_way ways[SE3DI_MESH_WAYS];
    se3di_mesh_plane planes[SE3DI_MESH_PLANES];
} se3di_mesh_meeting;

/* Which contacts are kept: there may be many others, which must not take their places. */
typedef struct se3di_mesh_filter {
    int (*keeps)(const void *ctx, const double point[3], const double normal[3], double overlap);
    const void *ctx;
} se3di_mesh_filter;

typedef struct se3di_mesh_edge {
    const se3di_mesh_meeting *m;
    const double *a, *b; /* its ends */
    double middle[3];
    uint32_t triangle, beyond; /* the same at a border */
    int is_flat;               /* or bulges away, or is another triangle's */
    int is_border;
    se3di_mesh_face other; /* beyond it, if it is no border */
} se3di_mesh_edge;

/* How deep a ball is on each of the faces that it touches, at most SE3DI_MESH_TOUCHES, so that the
 * depth of each grows from zero as the ball turns into a valley. May be negative: not at all. */
void se3di_mesh_share_valley(const se3di_touch *touch, uint32_t count, double radius,
                             double *depth);
/* The same of a corner that is behind `count` <= SE3DI_MESH_SIDES faces by `depth`: of the least
 * way off all of them what is along each normal. */
void se3di_mesh_share_corner(const double (*n)[3], uint32_t count, double *depth);
const double *se3di_mesh_corner(const se3di_shape *s, uint32_t triangle, uint32_t k);
/* Returns 0 if the solid's centre is behind it: only closed meshes have a behind. */
int se3di_mesh_face_of(const se3di_mesh_meeting *m, uint32_t triangle, se3di_mesh_face *f);
static inline double se3di_mesh_height(const se3di_mesh_face *f, const double x[3])
{
    double d[3];
    se3di_sub(x, f->corner, d);
    return se3di_dot(d, f->n);
}

/* Which way a normal looks: the same while it turns little. */
static inline uint32_t se3di_mesh_way_of(const double n[3])
{
    uint32_t a = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
    a = fabs(n[2]) > fabs(n[a]) ? 2 : a;
    return 2 * a + (n[a] < 0.0);
}

/* The lowest point of the solid's core along the unit n; returns how far its surface is below. */
double se3di_mesh_lowest(const se3di_mesh_meeting *m, const double n[3], double at[3]);
/* A triangle as a solid of its own, with room for its corners; whether the solid overlaps it. */
se3di_shape se3di_mesh_flat(const se3di_mesh_meeting *m, uint32_t triangle, double corners[9]);
int se3di_mesh_overlaps(const se3di_mesh_meeting *m, uint32_t triangle);
/* Whether a direction leads out between the faces at an edge, not through them. */
int se3di_mesh_leads_out(const se3di_mesh_edge *e, const double n[3]);
/* The same at a corner of the mesh; n in its frame. */
int se3di_mesh_leads_off(const se3di_mesh_meeting *m, const double x[3], const double n[3]);
/* A contact at a place of the surface, if there is none yet: NULL if there is. */
se3di_contact_point *se3di_mesh_add(const se3di_mesh_meeting *m, const double at[3],
                                    const double n[3], double overlap, double radius,
                                    uint32_t feature);

/* Keep a way if it is among the least deep. */
void se3di_mesh_note(se3di_mesh_meeting *m, const se3di_mesh_way *way);
/* Note the ways off a face; off its corners; off an edge that bulges. */
void se3di_mesh_find_ways(se3di_mesh_meeting *m, uint32_t triangle);
void se3di_mesh_find_ways_off_edge(se3di_mesh_meeting *m, const se3di_mesh_edge *e);
/* Of each part of the surface that bulges the least way, if no contact is as deep there. */
void se3di_mesh_add_ways(se3di_mesh_meeting *m);

/* Whether x (the mesh's frame) is within a piece or, by the slack, on its surface. */
int se3di_piece_holds(const se3di_shape *piece, const double x[3], double slack);
/* The same of one place and several slacks. */
typedef struct se3di_piece_view {
    double square, height; /* of its distance from the origin; over the face that it is most over */
} se3di_piece_view;
void se3di_piece_look(const se3di_shape *piece, const double x[3], se3di_piece_view *view);
int se3di_piece_is_at(const se3di_shape *piece, const se3di_piece_view *view, double slack);
/* The places where corners, round ends and edges touch. */
void se3di_mesh_find(const se3di_solid *i, const se3di_solid *mesh, const se3di_mesh_filter *filter,
                     se3di_manifold *manifold);
/* Contacts of one part of a shape, all of it if it has no pieces, with a mesh. */
typedef void (*se3di_part_finder)(const se3di_solid *i, size_t part, const se3di_solid *mesh,
                                  const se3di_mesh_filter *filter, se3di_manifold *manifold);
/* Of the contacts that `find` finds of the parts of i that overlap pieces of a mesh keep those that
 * are ways out of the pieces, and add what is missing. Returns 0 if none overlap. */
int se3di_narrow_judge(const se3di_solid *i, const se3di_solid *mesh, se3di_manifold *manifold,
                       se3di_part_finder find);
/* A step of about a length in a plane, in one of some directions all around, along no axis. */
#define SE3DI_WAYS_ASIDE 8
void se3di_step_aside(int way, double length, double by[2]);
/* A solid of which a flat side, a cap or a face, lies on a flat part of a closed mesh that nothing
 * about it rises above, or over it. Returns 0 if none does. */
int se3di_narrow_flush(const se3di_mesh_meeting *m);
/* Any solid but a ball, of whose surroundings `low` and `high` are known, where all triangles in
 * them are in one plane and none ends there: what touches is found as on that plane. Returns 0 if
 * they are not. */
int se3di_narrow_level(const se3di_mesh_meeting *m);
/* Two closed meshes that touch only where flat parts of them lie on each other, or do not touch
 * there. Returns 0 if they may touch elsewhere. */
int se3di_narrow_outlines(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold);
/* Whether one of some contacts is this one. */
int se3di_contact_points_have(const se3di_contact_point *points, uint32_t count,
                              const se3di_contact_point *p, double slack);

#endif
