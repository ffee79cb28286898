/* SPDX-License-Identifier: BSD-3-Clause */
/* Which pair goes where; spheres and planes against everything. */
#include "contact/narrow/narrow.h"

#include "contact/narrow/internal.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define RIM_BIAS 1e-4 /* turn of a rim's points towards the shape's x axis, standing upright */
#define RIM_TILT 1e-2 /* sine of the tilt above which there is none */

void se3di_bend_set(se3di_bend *bend, const double u[3], double along, double across)
{
    se3di_copy(u, bend->u);
    bend->r[0] = along;
    bend->r[1] = across;
}

static uint32_t shallowest(const se3di_manifold *manifold)
{
    uint32_t least = 0;
    for (uint32_t k = 1; k < manifold->count; ++k) {
        least = manifold->points[k].overlap < manifold->points[least].overlap ? k : least;
    }
    return least;
}

se3di_contact_point *se3di_manifold_add(se3di_manifold *manifold, const double point[3],
                                        const double normal[3], double overlap, uint32_t feature)
{
    static const se3di_bend flat = {{0.0, 0.0, 0.0}, {HUGE_VAL, HUGE_VAL}};
    uint32_t at = manifold->count;
    if (at < SE3DI_MANIFOLD_POINTS) {
        ++manifold->count;
    } else {
        at = shallowest(manifold);
    }
    se3di_contact_point *p = &manifold->points[at];
    se3di_copy(point, p->point);
    se3di_copy(normal, p->normal);
    p->overlap = overlap;
    p->share = 0.5;
    p->feature = feature;
    p->reserved = 0;
    p->bend_i = p->bend_j = flat;
    se3di_perpendicular(normal, p->bend_i.u);
    se3di_copy(p->bend_i.u, p->bend_j.u);
    return p;
}

/* How the surface of a shape bends at `local`, the place nearest to a sphere. */
static void bend_at(const se3di_solid *solid, const double local[3], se3di_bend *bend)
{
    const se3di_shape *s = solid->shape;
    double u[3] = {0.0, 0.0, 1.0};
    int outside[3], beyond = 0;
    switch (s->kind) {
    case SE3DI_SHAPE_SPHERE:
        bend->r[0] = bend->r[1] = s->radius;
        return;
    case SE3DI_SHAPE_CAPSULE:
        bend->r[0] = fabs(local[2]) < s->half_length ? HUGE_VAL : s->radius;
        bend->r[1] = s->radius;
        break;
    case SE3DI_SHAPE_CYLINDER: {
        double rho = se3di_hypot(local[0], local[1]);
        int cap = fabs(local[2]) > s->half_length;
        if (rho <= s->radius) { /* on a cap, or from inside */
            return;
        }
        if (cap) {
            double lean = se3di_hypot(rho - s->radius, fabs(local[2]) - s->half_length);
            u[0] = -local[1] / rho;
            u[1] = local[0] / rho;
            u[2] = 0.0;
            bend->r[0] = s->radius * lean / (rho - s->radius);
            bend->r[1] = 0.0;
        } else {
            bend->r[1] = s->radius;
        }
        break;
    }
    case SE3DI_SHAPE_BOX:
        for (int a = 0; a < 3; ++a) {
            outside[a] = fabs(local[a]) > s->half[a];
            beyond += outside[a];
        }
        if (beyond < 2) {
            return;
        }
        u[0] = outside[0] ? 0.0 : 1.0;
        u[1] = outside[1] ? 0.0 : 1.0;
        u[2] = outside[2] ? 0.0 : 1.0;
        bend->r[1] = 0.0;
        if (beyond == 3) {
            bend->r[0] = 0.0;
            return;
        }
        break;
    default:
        return;
    }
    se3di_mul(solid->at->R, u, bend->u);
}

static void sphere_any(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    double d[3], local[3], at[3], outward[3], point[3], normal[3], distance;
    se3di_sub(i->at->x, j->at->x, d);
    se3di_mul_transposed(j->at->R, d, local);
    se3di_shape_nearest(j->shape, local, at, outward, &distance);
    double overlap = i->shape->radius - distance;
    if (!(overlap > 0.0)) {
        return;
    }
    se3di_mul(j->at->R, outward, normal);
    se3di_scale(-1.0, normal, normal);
    se3di_copy(i->at->x, point);
    double arm = j->shape->kind == SE3DI_SHAPE_SPHERE ? distance + 0.5 * overlap : distance;
    se3di_add_scaled(arm, normal, point);
    se3di_contact_point *p = se3di_manifold_add(manifold, point, normal, overlap, 0);
    p->bend_i.r[0] = p->bend_i.r[1] = i->shape->radius;
    bend_at(j, local, &p->bend_j);
    p->share = 1.0;
    if (j->shape->kind == SE3DI_SHAPE_SPHERE) {
        p->share = 0.5;
    }
}

typedef struct half_space {
    const double *x; /* on it */
    double n[3];     /* outward */
} half_space;

/* A point of i with the radius about it, if it is below the plane j. */
static se3di_contact_point *touch_plane(const half_space *plane, const double x[3], double radius,
                                        uint32_t feature, se3di_manifold *manifold)
{
    double d[3], point[3], normal[3];
    se3di_sub(x, plane->x, d);
    double height = se3di_dot(d, plane->n);
    if (!(height < radius)) {
        return NULL;
    }
    se3di_copy(x, point);
    se3di_add_scaled(-height, plane->n, point);
    se3di_scale(-1.0, plane->n, normal);
    se3di_contact_point *p = se3di_manifold_add(manifold, point, normal, radius - height, feature);
    p->share = 1.0;
    p->bend_i.r[0] = p->bend_i.r[1] = radius;
    return p;
}

static void corner_of(const se3di_solid *box, uint32_t k, double x[3])
{
    double local[3];
    for (uint32_t a = 0; a < 3; ++a) {
        local[a] = (k >> a & 1u) ? box->shape->half[a] : -box->shape->half[a];
    }
    se3di_mul(box->at->R, local, x);
    se3di_add(box->at->x, x, x);
}

static void axis_of(const se3di_solid *solid, int a, double out[3])
{
    out[0] = solid->at->R[a];
    out[1] = solid->at->R[3 + a];
    out[2] = solid->at->R[6 + a];
}

static void capsule_plane(const se3di_solid *i, const half_space *plane, se3di_manifold *manifold)
{
    double axis[3], x[3];
    axis_of(i, 2, axis);
    for (uint32_t end = 0; end < 2; ++end) {
        se3di_copy(i->at->x, x);
        se3di_add_scaled(end ? i->shape->half_length : -i->shape->half_length, axis, x);
        touch_plane(plane, x, i->shape->radius, end, manifold);
    }
}

/* The direction in which a rim is lowest. Upright it has none: it then leans to the shape's x axis,
 * so that its points stay where they are on the body. */
static double rim_direction(const se3di_solid *i, const double normal[3], const double axis[3],
                            double out[3])
{
    double x[3];
    se3di_scale(-1.0, normal, out);
    se3di_add_scaled(-se3di_dot(out, axis), axis, out);
    double tilt = se3di_norm(out);
    double bias = tilt < RIM_TILT ? RIM_BIAS * (1.0 - tilt / RIM_TILT) : 0.0;
    axis_of(i, 0, x);
    se3di_add_scaled(bias, x, out);
    double size = se3di_norm(out);
    if (size > 0.0) {
        se3di_scale(1.0 / size, out, out);
    } else {
        se3di_copy(x, out);
    }
    return tilt;
}

double se3di_cylinder_rims(const se3di_solid *i, const double normal[3], double rim[8][3])
{
    double axis[3], low[3], side[3];
    axis_of(i, 2, axis);
    double tilt = rim_direction(i, normal, axis, low);
    se3di_cross(axis, low, side);
    for (uint32_t k = 0; k < 8; ++k) {
        double turn = k & 1u ? -i->shape->radius : i->shape->radius;
        se3di_copy(i->at->x, rim[k]);
        se3di_add_scaled(k & 4u ? i->shape->half_length : -i->shape->half_length, axis, rim[k]);
        se3di_add_scaled(turn, k & 2u ? side : low, rim[k]);
    }
    return tilt;
}

static void cylinder_plane(const se3di_solid *i, const half_space *plane, se3di_manifold *manifold)
{
    double rim[8][3], axis[3], side[3];
    double tilt = se3di_cylinder_rims(i, plane->n, rim);
    axis_of(i, 2, axis);
    se3di_cross(plane->n, axis, side);
    for (uint32_t k = 0; k < 8; ++k) {
        se3di_contact_point *p = touch_plane(plane, rim[k], 0.0, k, manifold);
        if (p && k % 4 == 0 && tilt > RIM_TILT) {
            se3di_scale(1.0 / se3di_norm(side), side, side);
            se3di_bend_set(&p->bend_i, side, i->shape->radius / tilt, 0.0);
        }
    }
}

static void any_plane(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    half_space plane = {.x = j->at->x};
    axis_of(j, 2, plane.n);
    double x[3];
    switch (i->shape->kind) {
    case SE3DI_SHAPE_BOX:
        for (uint32_t k = 0; k < 8; ++k) {
            corner_of(i, k, x);
            touch_plane(&plane, x, 0.0, k, manifold);
        }
        break;
    case SE3DI_SHAPE_CAPSULE:
        capsule_plane(i, &plane, manifold);
        break;
    case SE3DI_SHAPE_CYLINDER:
        cylinder_plane(i, &plane, manifold);
        break;
    case SE3DI_SHAPE_HULL:
        for (size_t k = 0; k < i->shape->vertex_count; ++k) {
            se3di_mul(i->at->R, i->shape->vertices + 3 * k, x);
            se3di_add(i->at->x, x, x);
            touch_plane(&plane, x, 0.0, (uint32_t)k, manifold);
        }
        break;
    case SE3DI_SHAPE_MESH:
        se3di_narrow_mesh_plane(i, plane.x, plane.n, manifold);
        break;
    default:
        break;
    }
}

static void mirror(se3di_manifold *manifold)
{
    for (uint32_t k = 0; k < manifold->count; ++k) {
        se3di_contact_point *p = &manifold->points[k];
        se3di_bend bend = p->bend_i;
        se3di_scale(-1.0, p->normal, p->normal);
        p->share = 1.0 - p->share;
        p->bend_i = p->bend_j;
        p->bend_j = bend;
    }
}

static void dispatch(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    int32_t a = i->shape->kind;
    int32_t b = j->shape->kind;
    if (b == SE3DI_SHAPE_PLANE && a != SE3DI_SHAPE_SPHERE) {
        any_plane(i, j, manifold);
    } else if (b == SE3DI_SHAPE_MESH) {
        se3di_narrow_mesh(i, j, manifold);
    } else if (a == SE3DI_SHAPE_SPHERE) {
        sphere_any(i, j, manifold);
    } else if (a == SE3DI_SHAPE_BOX && b == SE3DI_SHAPE_BOX) {
        se3di_narrow_boxes(i, j, manifold);
    } else {
        se3di_narrow_convex(i, j, manifold);
    }
}

/* A mesh that is convex is the hull of its vertices, but for spheres. */
static const se3di_shape *as_hull(const se3di_shape *shape, const se3di_shape *other,
                                  se3di_shape *hull)
{
    const int flat = other->kind == SE3DI_SHAPE_SPHERE || other->kind == SE3DI_SHAPE_PLANE;
    if (shape->kind != SE3DI_SHAPE_MESH || !shape->convex || flat) {
        return shape;
    }
    *hull = *shape;
    hull->kind = SE3DI_SHAPE_HULL;
    return hull;
}

/* Spheres first, then solids, meshes and planes. */
static int rank_of(const se3di_shape *shape)
{
    return shape->kind == SE3DI_SHAPE_SPHERE  ? 0
           : shape->kind == SE3DI_SHAPE_MESH  ? 2
           : shape->kind == SE3DI_SHAPE_PLANE ? 3
                                              : 1;
}

void se3di_narrow_find(const se3di_shape *i, const se3di_shape_pose *at_i, const se3di_shape *j,
                       const se3di_shape_pose *at_j, se3di_manifold *manifold)
{
    se3di_shape hull_i, hull_j;
    se3di_solid a = {as_hull(i, j, &hull_i), at_i};
    se3di_solid b = {as_hull(j, i, &hull_j), at_j};
    manifold->count = 0;
    manifold->reserved = 0;
    int rank_i = rank_of(a.shape);
    int rank_j = rank_of(b.shape);
    if (rank_i > 1 && rank_i == rank_j) {
        return; /* two planes, two meshes */
    }
    if (rank_i > rank_j) {
        dispatch(&b, &a, manifold);
        mirror(manifold);
    } else {
        dispatch(&a, &b, manifold);
    }
}

static double sphere_gap(const se3di_solid *i, const se3di_solid *j, double normal[3])
{
    double d[3], local[3], at[3], outward[3], distance;
    se3di_sub(i->at->x, j->at->x, d);
    se3di_mul_transposed(j->at->R, d, local);
    se3di_shape_nearest(j->shape, local, at, outward, &distance);
    se3di_mul(j->at->R, outward, normal);
    se3di_scale(-1.0, normal, normal);
    return distance - i->shape->radius;
}

static double plane_gap(const se3di_solid *i, const se3di_solid *plane, double normal[3])
{
    double n[3], lowest[3], d[3];
    axis_of(plane, 2, n);
    se3di_scale(-1.0, n, normal);
    se3di_core_support(i, normal, lowest);
    se3di_sub(lowest, plane->at->x, d);
    return se3di_dot(d, n) - se3di_core_radius(i->shape);
}

/* Of the sphere about the solid. */
static double mesh_gap(const se3di_solid *i, const se3di_solid *mesh, double normal[3])
{
    double d[3], local[3], at[3], outward[3], distance;
    memset(normal, 0, 3 * sizeof *normal);
    se3di_sub(i->at->x, mesh->at->x, d);
    se3di_mul_transposed(mesh->at->R, d, local);
    se3di_shape_nearest(mesh->shape, local, at, outward, &distance);
    return distance - i->shape->bound;
}

static double gap_of(const se3di_solid *i, const se3di_solid *j, double normal[3])
{
    double on_i[3], on_j[3];
    memset(normal, 0, 3 * sizeof *normal);
    if (i->shape->kind == SE3DI_SHAPE_PLANE) {
        return 0.0;
    }
    if (i->shape->kind == SE3DI_SHAPE_MESH) {
        return plane_gap(i, j, normal);
    }
    if (j->shape->kind == SE3DI_SHAPE_MESH) {
        return mesh_gap(i, j, normal);
    }
    if (i->shape->kind == SE3DI_SHAPE_SPHERE) {
        return sphere_gap(i, j, normal);
    }
    if (j->shape->kind == SE3DI_SHAPE_PLANE) {
        return plane_gap(i, j, normal);
    }
    return -se3di_convex_least(i, j, normal, on_i, on_j);
}

double se3di_narrow_gap(const se3di_shape *i, const se3di_shape_pose *at_i, const se3di_shape *j,
                        const se3di_shape_pose *at_j, double normal[3])
{
    se3di_shape hull_i, hull_j;
    se3di_solid a = {as_hull(i, j, &hull_i), at_i};
    se3di_solid b = {as_hull(j, i, &hull_j), at_j};
    double gap;
    if (rank_of(a.shape) > rank_of(b.shape)) {
        gap = gap_of(&b, &a, normal);
        se3di_scale(-1.0, normal, normal);
    } else {
        gap = gap_of(&a, &b, normal);
    }
    return fmax(gap, 0.0);
}
