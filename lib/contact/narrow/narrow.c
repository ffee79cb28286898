/* SPDX-License-Identifier: BSD-3-Clause */
/* Which pair goes where; spheres against everything. */
#include "contact/narrow/narrow.h"

#include "contact/narrow/internal.h"
#include "contact/shape/mesh.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define ROUNDING 1e-9 /* of a distance */

void se3di_narrow_sphere(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    const int is_ball = se3di_shape_is(j->shape, SE3DI_SHAPE_IS_BALL);
    double local[3], at[3], outward[3], point[3], normal[3], distance;
    se3di_solid_to_local(j, i->at->x, local);
    se3di_shape_nearest(j->shape, local, at, outward, &distance);
    double overlap = i->shape->radius - distance;
    if (!(overlap > 0.0)) {
        return;
    }
    se3di_mul(j->at->R, outward, normal);
    se3di_scale(-1.0, normal, normal);
    se3di_copy(i->at->x, point);
    double arm = is_ball ? distance + 0.5 * overlap : distance;
    se3di_add_scaled(arm, normal, point);
    se3di_contact_point *p = se3di_manifold_add(manifold, point, normal, overlap, 0);
    p->bend_i.r[0] = p->bend_i.r[1] = i->shape->radius;
    se3di_solid_bend(j, local, &p->bend_j);
    p->share = is_ball ? 0.5 : 1.0;
}

static double sphere_gap(const se3di_solid *i, const se3di_solid *j, double normal[3])
{
    double local[3], at[3], outward[3], distance;
    se3di_solid_to_local(j, i->at->x, local);
    se3di_shape_nearest(j->shape, local, at, outward, &distance);
    se3di_mul(j->at->R, outward, normal);
    se3di_scale(-1.0, normal, normal);
    return distance - i->shape->radius;
}

static double plane_gap(const se3di_solid *i, const se3di_solid *plane, double normal[3])
{
    double n[3], lowest[3], d[3];
    se3di_solid_axis(plane, 2, n);
    se3di_scale(-1.0, n, normal);
    se3di_core_support(i, normal, lowest);
    se3di_sub(lowest, plane->at->x, d);
    return se3di_dot(d, n) - se3di_core_radius(i->shape);
}

/* Of the sphere about the solid. */
static double mesh_gap(const se3di_solid *i, const se3di_solid *mesh, double normal[3])
{
    double local[3], at[3], outward[3], distance;
    memset(normal, 0, 3 * sizeof *normal);
    se3di_solid_to_local(mesh, i->at->x, local);
    se3di_shape_nearest(mesh->shape, local, at, outward, &distance);
    return distance - i->shape->bound;
}

static double convex_gap(const se3di_solid *i, const se3di_solid *j, double normal[3])
{
    double on_i[3], on_j[3];
    return -se3di_convex_least(i, j, HUGE_VAL, normal, on_i, on_j);
}

/* What shapes are to each other, in the order in which they are the first of a pair. */
typedef enum group { BALL, CONVEX, SURFACE, HALF_SPACE, GROUPS } group;

static group group_of(const se3di_shape *shape)
{
    return se3di_shape_is(shape, SE3DI_SHAPE_IS_BALL)         ? BALL
           : se3di_shape_is(shape, SE3DI_SHAPE_IS_SURFACE)    ? SURFACE
           : se3di_shape_is(shape, SE3DI_SHAPE_IS_HALF_SPACE) ? HALF_SPACE
                                                              : CONVEX;
}

typedef void (*finder)(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold);
typedef double (*measurer)(const se3di_solid *i, const se3di_solid *j, double normal[3]);

typedef struct pair {
    finder find;
    measurer gap;
} pair;

/* What serves all kinds; two half spaces have no contact. */
static const pair general[GROUPS][GROUPS] = {
    [BALL] = {[BALL] = {se3di_narrow_sphere, sphere_gap},
              [CONVEX] = {se3di_narrow_sphere, sphere_gap},
              [SURFACE] = {se3di_narrow_mesh, mesh_gap},
              [HALF_SPACE] = {se3di_narrow_sphere, sphere_gap}},
    [CONVEX] = {[CONVEX] = {se3di_narrow_convex, convex_gap},
                [SURFACE] = {se3di_narrow_mesh, mesh_gap},
                [HALF_SPACE] = {se3di_plane_convex, plane_gap}},
    [SURFACE] = {[SURFACE] = {se3di_narrow_meshes, se3di_narrow_meshes_gap},
                 [HALF_SPACE] = {se3di_plane_mesh, plane_gap}},
};

/* Pairs of kinds that have something better, or more points. */
static const finder special[SE3DI_SHAPE_COUNT][SE3DI_SHAPE_COUNT] = {
    [SE3DI_SHAPE_BOX] =
        {[SE3DI_SHAPE_BOX] = se3di_narrow_boxes, [SE3DI_SHAPE_PLANE] = se3di_plane_corners},
    [SE3DI_SHAPE_CAPSULE] = {[SE3DI_SHAPE_PLANE] = se3di_plane_capsule},
    [SE3DI_SHAPE_CYLINDER] = {[SE3DI_SHAPE_PLANE] = se3di_plane_cylinder},
    [SE3DI_SHAPE_HULL] = {[SE3DI_SHAPE_PLANE] = se3di_plane_corners},
    [SE3DI_SHAPE_ELLIPSOID] = {[SE3DI_SHAPE_PLANE] = se3di_plane_smooth},
};

/* A mesh that is convex is the hull of its vertices, but for spheres and planes. */
static const se3di_shape *as_hull(const se3di_shape *shape, const se3di_shape *other,
                                  se3di_shape *hull)
{
    if (!se3di_shape_is(shape, SE3DI_SHAPE_IS_SURFACE) || !shape->convex ||
        se3di_shape_is(other, SE3DI_SHAPE_IS_BALL | SE3DI_SHAPE_IS_HALF_SPACE)) {
        return shape;
    }
    *hull = *shape;
    hull->kind = SE3DI_SHAPE_HULL;
    return hull;
}

/* Of two surfaces one must be closed, convex or in convex pieces. */
int se3di_narrow_is_known(const se3di_shape *i, const se3di_shape *j)
{
    const group a = group_of(i), b = group_of(j);
    if (a == SURFACE && b == SURFACE) {
        return i->closed != 0 || j->closed != 0 || i->convex || j->convex ||
               i->piece_count + j->piece_count > 0;
    }
    return general[a][b].find || general[b][a].find;
}

/* Two solids in the order of the tables. */
typedef struct ordered {
    se3di_shape hull_i, hull_j; /* in place of meshes that are convex */
    se3di_solid first, second;
    int is_turned;
} ordered;

static void put_in_order(ordered *two, const se3di_shape *i, const se3di_shape_pose *at_i,
                         const se3di_shape *j, const se3di_shape_pose *at_j)
{
    const se3di_solid a = {as_hull(i, j, &two->hull_i), at_i};
    const se3di_solid b = {as_hull(j, i, &two->hull_j), at_j};
    two->is_turned = group_of(a.shape) > group_of(b.shape);
    two->first = two->is_turned ? b : a;
    two->second = two->is_turned ? a : b;
}

static const pair *pair_of(const ordered *two)
{
    return &general[group_of(two->first.shape)][group_of(two->second.shape)];
}

void se3di_narrow_find(const se3di_shape *i, const se3di_shape_pose *at_i, const se3di_shape *j,
                       const se3di_shape_pose *at_j, se3di_manifold *manifold)
{
    ordered two;
    put_in_order(&two, i, at_i, j, at_j);
    const finder own = special[two.first.shape->kind][two.second.shape->kind];
    const finder find = own ? own : pair_of(&two)->find;
    manifold->count = 0;
    manifold->reserved = 0;
    if (find) {
        find(&two.first, &two.second, manifold);
    }
    if (two.is_turned) {
        se3di_manifold_mirror(manifold);
    }
}

double se3di_narrow_gap(const se3di_shape *i, const se3di_shape_pose *at_i, const se3di_shape *j,
                        const se3di_shape_pose *at_j, double normal[3])
{
    ordered two;
    put_in_order(&two, i, at_i, j, at_j);
    const measurer measure = se3di_narrow_is_known(i, j) ? pair_of(&two)->gap : NULL;
    double gap = 0.0;
    memset(normal, 0, 3 * sizeof *normal);
    if (measure) {
        gap = measure(&two.first, &two.second, normal);
    }
    if (two.is_turned) {
        se3di_scale(-1.0, normal, normal);
    }
    return fmax(gap, 0.0);
}

static void note_any(void *ctx, uint32_t triangle)
{
    (void)triangle;
    *(int *)ctx = 1;
}

int se3di_narrow_is_beyond(const se3di_shape *i, const se3di_shape_pose *at_i, const se3di_shape *j,
                           const se3di_shape_pose *at_j, double distance)
{
    ordered two;
    double local[3];
    int met = 0;
    put_in_order(&two, i, at_i, j, at_j);
    if (group_of(two.second.shape) != SURFACE || group_of(two.first.shape) == SURFACE) {
        return 0;
    }
    const double radius = two.first.shape->bound + distance;
    se3di_solid_to_local(&two.second, two.first.at->x, local);
    se3di_mesh_visit(two.second.shape, local, radius * (1.0 + ROUNDING), note_any, &met);
    return !met;
}
