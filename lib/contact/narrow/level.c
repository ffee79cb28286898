/* SPDX-License-Identifier: BSD-3-Clause */
/* A solid on triangles that lie in one plane, all that reach into the box about it: a part of a
 * floor. If none of them ends within the box, the plane touches it as they do, and with the points
 * of a plane: those of other triangles, neighbours and ways off them need not be looked for.
 *                                                                docs/theory/body-contact.md */
#include "contact/narrow/mesh.h"
#include "contact/shape/mesh_tree.h"
#include "contact/shape/triangles.h"
#include "math/vec3.h"

#include <math.h>
#include <stddef.h>

#define FLAT 1e-9 /* of the size: what is in one plane */
#define DEEP 0.1  /* of the size: the deepest at most */
#define BENT 3    /* bits of an edge: the next triangle leads out of the plane, or there is none */

typedef void (*plane_finder)(const se3di_solid *i, const se3di_solid *plane,
                             se3di_manifold *manifold);

/* All in the frame of the mesh. */
typedef struct level {
    const se3di_mesh_meeting *m;
    se3di_mesh_face face; /* whose plane it is; its middle is not known */
    double sense;         /* of the triangles seen from there: 1 counter-clockwise, else -1 */
    double below;         /* how deep the solid is */
    double way[3];        /* where it passes the plane between its lowest point and its centre */
    int count;
    int is_over; /* a triangle is there */
    int is_none; /* they are no such floor */
} level;

static plane_finder finder_of(const se3di_solid *solid)
{
    return se3di_solid_has_rims(solid)                          ? se3di_plane_cylinder
           : se3di_shape_class_of(solid->shape)->corner != NULL ? se3di_plane_corners
           : se3di_solid_is_smooth(solid)                       ? se3di_plane_smooth
           : se3di_solid_is_line(solid)                         ? se3di_plane_capsule
                                                                : NULL;
}

/* All corners are below the box, or all above it, along an axis. */
static int is_beside(const se3di_mesh_meeting *m, const double *const corner[], int count)
{
    for (int k = 0; k < 3; ++k) {
        int low = 1, high = 1;
        for (int c = 0; c < count; ++c) {
            low = low && corner[c][k] < m->low[k];
            high = high && corner[c][k] > m->high[k];
        }
        if (low || high) {
            return 1;
        }
    }
    return 0;
}

/* The plane of the first triangle, and where the solid is in it. */
static void set_plane(level *l, const double *const corner[3])
{
    const se3di_mesh_meeting *m = l->m;
    const double radius = se3di_core_radius(m->solid->shape);
    double down[3], point[3], low[3];
    se3di_triangle_span(corner, l->face.n);
    const double size = se3di_norm(l->face.n);
    for (int k = 0; k < 3; ++k) { /* not times 1/size: along an axis it is that to the bit */
        l->face.n[k] = size > 0.0 ? l->face.n[k] / size : 0.0;
    }
    se3di_copy(corner[0], l->face.corner);
    const int is_back = m->mesh->shape->closed ? m->mesh->shape->closed < 0
                                               : se3di_mesh_height(&l->face, m->center) < 0.0;
    l->sense = is_back ? -1.0 : 1.0;
    se3di_scale(l->sense, l->face.n, l->face.n);
    se3di_mul(m->mesh->at->R, l->face.n, down);
    se3di_scale(-1.0, down, down);
    se3di_core_support(m->solid, down, point);
    se3di_solid_to_local(m->mesh, point, low);
    se3di_add_scaled(-radius, l->face.n, low);
    l->below = -se3di_mesh_height(&l->face, low);
    const double above = se3di_mesh_height(&l->face, m->center);
    l->is_none = !(above > 0.0 && l->below < DEEP * m->size);
    if (!l->is_none && l->below > 0.0) {
        double up[3];
        se3di_sub(m->center, low, up);
        se3di_copy(low, l->way);
        se3di_add_scaled(l->below / (l->below + above), up, l->way);
    }
}

/* Whether the triangle ends within the box at a side, or leads out of the plane there. */
static int ends(const level *l, uint32_t triangle, const double *const corner[3])
{
    const se3di_shape *s = l->m->mesh->shape;
    for (int k = 0; k < 3 && s->rows == 0; ++k) {
        const double *const side[2] = {corner[k], corner[(k + 1) % 3]};
        if ((se3di_mesh_facets(s)[triangle].edges[k] & BENT) != 0 && !is_beside(l->m, side, 2)) {
            return 1;
        }
    }
    return 0;
}

static void meet_level(void *ctx, uint32_t triangle)
{
    level *l = ctx;
    const double *corner[3];
    double span[3], at[3];
    se3di_triangle_corners(l->m->mesh->shape, triangle, corner);
    if (l->is_none || is_beside(l->m, corner, 3)) {
        return;
    }
    if (l->count++ == 0) {
        set_plane(l, corner);
    }
    const double least = FLAT * l->m->size;
    for (int k = 0; k < 3; ++k) {
        l->is_none = l->is_none || !(fabs(se3di_mesh_height(&l->face, corner[k])) < least);
    }
    se3di_triangle_span(corner, span);
    l->is_none =
        l->is_none || !(l->sense * se3di_dot(span, l->face.n) > 0.0) || ends(l, triangle, corner);
    l->is_over = l->is_over || (!l->is_none && l->below > 0.0 &&
                                se3di_triangle_nearest(corner, l->way, at, NULL) < least * least);
}

/* A heightfield ends with its grid. */
static int is_within_grid(const se3di_mesh_meeting *m)
{
    const se3di_shape *s = m->mesh->shape;
    const double x = 0.5 * (s->columns - 1.0) * s->spacing[0];
    const double y = 0.5 * (s->rows - 1.0) * s->spacing[1];
    return m->low[0] > -x && m->high[0] < x && m->low[1] > -y && m->high[1] < y;
}

/* Points are told apart as those on triangles are. Returns 0 if one of them is beyond the box. */
static int name_points(const level *l)
{
    se3di_manifold *manifold = l->m->manifold;
    const uint32_t way = se3di_mesh_way_of(l->face.n);
    for (uint32_t k = 0; k < manifold->count; ++k) {
        se3di_contact_point *p = &manifold->points[k];
        double at[3];
        se3di_solid_to_local(l->m->mesh, p->point, at);
        const double *const corner[1] = {at};
        if (is_beside(l->m, corner, 1)) {
            manifold->count = 0;
            return 0;
        }
        p->feature = 8 * p->feature + way;
    }
    return 1;
}

int se3di_narrow_level(const se3di_mesh_meeting *m)
{
    const plane_finder find = finder_of(m->solid);
    const se3di_shape half_space = {.kind = SE3DI_SHAPE_PLANE};
    level l = {.m = m};
    double n[3], u[3], w[3];
    if (!find || (m->mesh->shape->rows > 0 && !is_within_grid(m))) {
        return 0;
    }
    se3di_mesh_visit_box(m->mesh->shape, m->low, m->high, meet_level, &l);
    if (l.count == 0 || l.is_none) {
        return 0;
    }
    if (!(l.below > 0.0)) {
        return 1;
    }
    if (!l.is_over) {
        return 0;
    }
    se3di_mul(m->mesh->at->R, l.face.n, n);
    se3di_perpendicular(n, u);
    se3di_cross(n, u, w);
    se3di_shape_pose at = {.R = {u[0], w[0], n[0], u[1], w[1], n[1], u[2], w[2], n[2]}};
    se3di_solid_to_ground(m->mesh, l.face.corner, at.x);
    const se3di_solid plane = {&half_space, &at};
    find(m->solid, &plane, m->manifold);
    return name_points(&l);
}
