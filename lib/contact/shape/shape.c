/* SPDX-License-Identifier: BSD-3-Clause */
/* The nearest point of each kind of shape.
 *
 * Outside, the nearest point is where a projection onto the solid ends; inside, it is on the
 * nearest face. The normal is the direction of local - point, turned outwards, and where the two
 * coincide that of the surface.                                           docs/theory/shapes.md */
#include "contact/shape/shape.h"

#include "contact/shape/mesh.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

void se3di_shape_place(const se3di_shape *shape, const se3di_frame *frame, se3di_shape_pose *pose)
{
    se3di_mul(frame->A, shape->x, pose->x);
    se3di_add(frame->r, pose->x, pose->x);
    se3di_mat_mul(frame->A, shape->A, pose->R);
    se3di_copy(frame->v, pose->v);
    se3di_mul(frame->A, frame->w, pose->w);
    se3di_copy(frame->r, pose->c);
}

double se3di_shape_bound(const se3di_shape *shape)
{
    double most = 0.0;
    switch (shape->kind) {
    case SE3DI_SHAPE_SPHERE:
        return shape->radius;
    case SE3DI_SHAPE_BOX:
        return se3di_norm(shape->half);
    case SE3DI_SHAPE_CAPSULE:
        return shape->half_length + shape->radius;
    case SE3DI_SHAPE_CYLINDER:
        return se3di_hypot(shape->half_length, shape->radius);
    case SE3DI_SHAPE_PLANE:
        return HUGE_VAL;
    default:
        for (size_t k = 0; k < shape->vertex_count; ++k) {
            most = fmax(most, se3di_norm(shape->vertices + 3 * k));
        }
        return most;
    }
}

/* Complete the answer from a core point and the radius of the ball that is swept along the core. */
static void round_off(const double core[3], double radius, const double local[3], double point[3],
                      double normal[3], double *distance)
{
    double d[3];
    se3di_sub(local, core, d);
    double length = se3di_norm(d);
    if (length > 0.0) {
        se3di_scale(1.0 / length, d, normal);
    } else {
        normal[0] = 1.0;
        normal[1] = normal[2] = 0.0;
    }
    *distance = length - radius;
    se3di_copy(core, point);
    se3di_add_scaled(radius, normal, point);
}

static void nearest_capsule(const se3di_shape *s, const double local[3], double point[3],
                            double normal[3], double *distance)
{
    const double core[3] = {0.0, 0.0, fmax(-s->half_length, fmin(s->half_length, local[2]))};
    round_off(core, s->radius, local, point, normal, distance);
}

static void nearest_box(const se3di_shape *s, const double local[3], double point[3],
                        double normal[3], double *distance)
{
    double depth = -HUGE_VAL; /* to the nearest face, <= 0 inside */
    int face = 0;
    for (int a = 0; a < 3; ++a) {
        double beyond = fabs(local[a]) - s->half[a];
        point[a] = fmax(-s->half[a], fmin(s->half[a], local[a]));
        face = beyond > depth ? a : face;
        depth = fmax(depth, beyond);
    }
    if (depth > 0.0) {
        se3di_sub(local, point, normal);
        *distance = se3di_norm(normal);
        se3di_scale(1.0 / *distance, normal, normal);
        return;
    }
    normal[0] = normal[1] = normal[2] = 0.0;
    normal[face] = local[face] < 0.0 ? -1.0 : 1.0;
    point[face] = normal[face] * s->half[face];
    *distance = depth;
}

static void nearest_cylinder(const se3di_shape *s, const double local[3], double point[3],
                             double normal[3], double *distance)
{
    double rho = se3di_hypot(local[0], local[1]);
    const double out[2] = {rho > 0.0 ? local[0] / rho : 1.0, rho > 0.0 ? local[1] / rho : 0.0};
    double up = local[2] < 0.0 ? -1.0 : 1.0;
    double side = rho - s->radius;
    double cap = fabs(local[2]) - s->half_length;
    double at = fmin(rho, s->radius); /* of the point: radius and height */
    double height = fmin(fabs(local[2]), s->half_length);
    double n[2];
    if (side > 0.0 || cap > 0.0) {
        *distance = se3di_hypot(fmax(side, 0.0), fmax(cap, 0.0));
        n[0] = fmax(side, 0.0) / *distance;
        n[1] = fmax(cap, 0.0) / *distance;
    } else {
        int round = side > cap;
        n[0] = round ? 1.0 : 0.0;
        n[1] = round ? 0.0 : 1.0;
        at = round ? s->radius : at;
        height = round ? height : s->half_length;
        *distance = round ? side : cap;
    }
    point[0] = at * out[0];
    point[1] = at * out[1];
    point[2] = up * height;
    normal[0] = n[0] * out[0];
    normal[1] = n[0] * out[1];
    normal[2] = n[1] * up;
}

/* The parameter in [0, 1] of the point of a segment nearest to the origin. */
static double along(const double a[3], const double b[3])
{
    double ab[3];
    se3di_sub(b, a, ab);
    double square = se3di_dot(ab, ab);
    double t = square > 0.0 ? -se3di_dot(a, ab) / square : 0.0;
    t = t < 1.0 ? t : 1.0; /* fmin() is a call */
    return t > 0.0 ? t : 0.0;
}

/* Barycentric coordinates of the point of the sides of a triangle nearest to the origin. */
static void find_on_sides(double q[3][3], double w[3])
{
    double least = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
        const double *a = q[k];
        const double *b = q[(k + 1) % 3];
        double t = along(a, b);
        double d[3] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                       a[2] + t * (b[2] - a[2])};
        if (se3di_dot(d, d) < least) {
            least = se3di_dot(d, d);
            w[k] = 1.0 - t;
            w[(k + 1) % 3] = t;
            w[(k + 2) % 3] = 0.0;
        }
    }
}

/* Inside the triangle's prism the foot of the perpendicular; elsewhere the nearest of its sides. */
double se3di_triangle_nearest(const double *const corner[3], const double p[3], double point[3],
                              double weights[3])
{
    double q[3][3], ab[3], ac[3], normal[3], w[3];
    for (int k = 0; k < 3; ++k) {
        se3di_sub(corner[k], p, q[k]);
    }
    se3di_sub(q[1], q[0], ab);
    se3di_sub(q[2], q[0], ac);
    se3di_cross(ab, ac, normal);
    double square = se3di_dot(normal, normal);
    int inside = square > 0.0;
    for (int k = 0; k < 3; ++k) {
        double c[3];
        se3di_cross(q[(k + 1) % 3], q[(k + 2) % 3], c);
        w[k] = se3di_dot(c, normal);
        inside = inside && w[k] > 0.0;
    }
    double d[3] = {0.0, 0.0, 0.0};
    if (inside) { /* more exactly along the normal, which matters where p is near */
        se3di_scale(se3di_dot(q[0], normal) / square, normal, d);
    } else {
        find_on_sides(q, w);
        for (int k = 0; k < 3; ++k) {
            se3di_add_scaled(w[k], q[k], d);
        }
    }
    if (weights) {
        se3di_scale(inside ? 1.0 / (w[0] + w[1] + w[2]) : 1.0, w, weights);
    }
    se3di_add(p, d, point);
    return se3di_dot(d, d);
}

static void corners_of(const se3di_shape *s, size_t triangle, const double *corner[3])
{
    for (int k = 0; k < 3; ++k) {
        corner[k] = s->vertices + 3 * (size_t)s->triangles[3 * triangle + (size_t)k];
    }
}

static void face_normal(const double *const corner[3], double normal[3])
{
    double ab[3], ac[3];
    se3di_sub(corner[1], corner[0], ab);
    se3di_sub(corner[2], corner[0], ac);
    se3di_cross(ab, ac, normal);
    double length = se3di_norm(normal);
    se3di_scale(length > 0.0 ? 1.0 / length : 0.0, normal, normal);
}

/* Of all triangles. */
static void nearest_triangle(const se3di_shape *s, const double local[3], double point[3],
                             double *distance)
{
    double least = HUGE_VAL;
    for (size_t k = 0; k < s->triangle_count; ++k) {
        const double *corner[3];
        double here[3];
        corners_of(s, k, corner);
        double square = se3di_triangle_nearest(corner, local, here, NULL);
        if (square < least) {
            least = square;
            se3di_copy(here, point);
        }
    }
    *distance = sqrt(least);
}

static void nearest_mesh(const se3di_shape *s, const double local[3], double point[3],
                         double normal[3], double *distance)
{
    size_t triangle = se3di_mesh_nearest(s, local, point, distance);
    if (*distance > 0.0) {
        se3di_sub(local, point, normal);
        se3di_scale(1.0 / *distance, normal, normal);
    } else {
        const double *corner[3];
        corners_of(s, triangle, corner);
        face_normal(corner, normal);
    }
}

static void nearest_hull(const se3di_shape *s, const double local[3], double point[3],
                         double normal[3], double *distance)
{
    double depth = -HUGE_VAL; /* above the plane of the face that is seen best */
    double outward[3] = {0.0, 0.0, 1.0};
    for (size_t k = 0; k < s->triangle_count; ++k) {
        const double *corner[3];
        double n[3], d[3];
        corners_of(s, k, corner);
        face_normal(corner, n);
        se3di_sub(local, corner[0], d);
        double height = se3di_dot(d, n);
        if (height > depth) {
            depth = height;
            se3di_copy(n, outward);
        }
    }
    if (depth > 0.0) {
        nearest_triangle(s, local, point, distance);
        if (*distance > 1e-12 * s->bound) {
            se3di_sub(local, point, normal);
            se3di_scale(1.0 / *distance, normal, normal);
            return;
        }
    }
    *distance = depth;
    se3di_copy(outward, normal);
    se3di_copy(local, point);
    se3di_add_scaled(-depth, outward, point);
}

void se3di_shape_nearest(const se3di_shape *shape, const double local[3], double point[3],
                         double normal[3], double *distance)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    switch (shape->kind) {
    case SE3DI_SHAPE_SPHERE:
        round_off(origin, shape->radius, local, point, normal, distance);
        return;
    case SE3DI_SHAPE_BOX:
        nearest_box(shape, local, point, normal, distance);
        return;
    case SE3DI_SHAPE_CAPSULE:
        nearest_capsule(shape, local, point, normal, distance);
        return;
    case SE3DI_SHAPE_CYLINDER:
        nearest_cylinder(shape, local, point, normal, distance);
        return;
    case SE3DI_SHAPE_PLANE:
        point[0] = local[0];
        point[1] = local[1];
        point[2] = normal[0] = normal[1] = 0.0;
        normal[2] = 1.0;
        *distance = local[2];
        return;
    case SE3DI_SHAPE_MESH:
        nearest_mesh(shape, local, point, normal, distance);
        return;
    default:
        nearest_hull(shape, local, point, normal, distance);
        return;
    }
}
