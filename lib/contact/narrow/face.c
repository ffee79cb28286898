/* SPDX-License-Identifier: BSD-3-Clause */
/* Supports and faces of convex shapes. A capsule is a line with a radius about it, the others are
 * what they are. */
#include "contact/narrow/internal.h"

#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define CAP_COSINE  0.9 /* a cylinder seen along less than this shows its side */
#define CAP_CORNERS 8

double se3di_core_radius(const se3di_shape *shape)
{
    return shape->kind == SE3DI_SHAPE_SPHERE || shape->kind == SE3DI_SHAPE_CAPSULE ? shape->radius
                                                                                   : 0.0;
}

static void to_ground(const se3di_solid *solid, const double local[3], double out[3])
{
    se3di_mul(solid->at->R, local, out);
    se3di_add(solid->at->x, out, out);
}

static uint32_t highest_vertex(const se3di_shape *s, const double d[3])
{
    uint32_t best = 0;
    double most = -HUGE_VAL;
    for (uint32_t k = 0; k < s->vertex_count; ++k) {
        double height = se3di_dot(s->vertices + 3 * (size_t)k, d);
        if (height > most) {
            most = height;
            best = k;
        }
    }
    return best;
}

static void local_support(const se3di_shape *s, const double d[3], double out[3])
{
    double rho = se3di_hypot(d[0], d[1]);
    out[0] = out[1] = out[2] = 0.0;
    switch (s->kind) {
    case SE3DI_SHAPE_BOX:
        for (int a = 0; a < 3; ++a) {
            out[a] = d[a] < 0.0 ? -s->half[a] : s->half[a];
        }
        break;
    case SE3DI_SHAPE_CYLINDER:
        out[0] = rho > 0.0 ? s->radius * d[0] / rho : 0.0;
        out[1] = rho > 0.0 ? s->radius * d[1] / rho : 0.0;
        out[2] = d[2] < 0.0 ? -s->half_length : s->half_length;
        break;
    case SE3DI_SHAPE_CAPSULE:
        out[2] = d[2] < 0.0 ? -s->half_length : s->half_length;
        break;
    case SE3DI_SHAPE_HULL:
    case SE3DI_SHAPE_MESH:
        se3di_copy(s->vertices + 3 * (size_t)highest_vertex(s, d), out);
        break;
    default:
        break;
    }
}

void se3di_core_support(const se3di_solid *solid, const double d[3], double point[3])
{
    double local_d[3], local[3];
    se3di_mul_transposed(solid->at->R, d, local_d);
    local_support(solid->shape, local_d, local);
    to_ground(solid, local, point);
}

static void box_face(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    static const double turn[4][2] = {{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}};
    const double *half = solid->shape->half;
    int a = fabs(d[0]) >= fabs(d[1]) ? 0 : 1;
    a = fabs(d[2]) > fabs(d[a]) ? 2 : a;
    int b = (a + 1) % 3;
    int c = (a + 2) % 3;
    double sign = d[a] < 0.0 ? -1.0 : 1.0;
    double n[3] = {0.0, 0.0, 0.0};
    n[a] = sign;
    se3di_mul(solid->at->R, n, face->normal);
    face->count = 4;
    face->id = (uint32_t)(2 * a + (sign < 0.0));
    for (int k = 0; k < 4; ++k) {
        double local[3];
        local[a] = sign * half[a];
        local[b] = turn[k][0] * half[b];
        local[c] = sign * turn[k][1] * half[c];
        to_ground(solid, local, face->corner[k]);
    }
}

static void cylinder_cap(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    static const double cosine[CAP_CORNERS] = {
        1.0,  0.70710678118654752,  0.0, -0.70710678118654752,
        -1.0, -0.70710678118654752, 0.0, 0.70710678118654752};
    const se3di_shape *s = solid->shape;
    double sign = d[2] < 0.0 ? -1.0 : 1.0;
    double tilt = se3di_hypot(d[0], d[1]);
    double bias = tilt < 1e-2 ? 1e-4 * (1.0 - tilt / 1e-2) : 0.0; /* as on planes */
    double lean[2] = {d[0] + bias, d[1]};
    double size = se3di_hypot(lean[0], lean[1]);
    double x = size > 0.0 ? lean[0] / size : 1.0;
    double y = size > 0.0 ? lean[1] / size : 0.0;
    double n[3] = {0.0, 0.0, sign};
    se3di_mul(solid->at->R, n, face->normal);
    face->count = CAP_CORNERS;
    face->id = sign < 0.0;
    for (int k = 0; k < CAP_CORNERS; ++k) {
        double c = cosine[k];
        double w = sign * cosine[(k + 6) % CAP_CORNERS]; /* the sine */
        double local[3] = {s->radius * (c * x - w * y), s->radius * (c * y + w * x),
                           sign * s->half_length};
        to_ground(solid, local, face->corner[k]);
    }
}

/* A line on the side of a cylinder, or that of a capsule. */
static void side_line(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    const se3di_shape *s = solid->shape;
    double rho = se3di_hypot(d[0], d[1]);
    double radius = s->kind == SE3DI_SHAPE_CYLINDER && rho > 0.0 ? s->radius / rho : 0.0;
    double n[3] = {rho > 0.0 ? d[0] / rho : 1.0, rho > 0.0 ? d[1] / rho : 0.0, 0.0};
    se3di_mul(solid->at->R, n, face->normal);
    face->count = 2;
    face->id = 2;
    for (int k = 0; k < 2; ++k) {
        double local[3] = {radius * d[0], radius * d[1], k ? s->half_length : -s->half_length};
        to_ground(solid, local, face->corner[k]);
    }
}

static void triangle_normal(const se3di_shape *s, size_t triangle, double n[3])
{
    const double *corner[3];
    double ab[3], ac[3];
    for (size_t k = 0; k < 3; ++k) {
        corner[k] = s->vertices + 3 * (size_t)s->triangles[3 * triangle + k];
    }
    se3di_sub(corner[1], corner[0], ab);
    se3di_sub(corner[2], corner[0], ac);
    se3di_cross(ab, ac, n);
    double size = se3di_norm(n);
    se3di_scale(size > 0.0 ? 1.0 / size : 0.0, n, n);
}

/* The plane of a face: two directions in it, and its middle. */
typedef struct face_plane {
    const se3di_shape *s;
    double u[3], w[3], center[3], n[3], level, slack;
} face_plane;

static int is_new(const face_plane *plane, uint32_t vertex, const uint32_t *list, int count)
{
    const double *x = plane->s->vertices + 3 * (size_t)vertex;
    for (int k = 0; k < count; ++k) {
        double d[3];
        se3di_sub(plane->s->vertices + 3 * (size_t)list[k], x, d);
        if (!(se3di_norm(d) > plane->slack)) {
            return 0;
        }
    }
    return 1;
}

/* Insert a corner of the polygon about the middle by its angle from u. */
static void insert_corner(const face_plane *plane, uint32_t vertex, uint32_t *list, double *angle,
                          int *count)
{
    double d[3];
    se3di_sub(plane->s->vertices + 3 * (size_t)vertex, plane->center, d);
    double turn = se3di_atan2(se3di_dot(d, plane->w), se3di_dot(d, plane->u));
    int at = *count;
    for (; at > 0 && angle[at - 1] > turn; --at) {
        angle[at] = angle[at - 1];
        list[at] = list[at - 1];
    }
    angle[at] = turn;
    list[at] = vertex;
    ++*count;
}

/* Whether the polygon turns left at its corner k. */
static int is_corner(const face_plane *plane, const uint32_t *list, int count, int k)
{
    const double *v = plane->s->vertices;
    const double *x = v + 3 * (size_t)list[k];
    double before[3], after[3], turn[3];
    se3di_sub(x, v + 3 * (size_t)list[(k + count - 1) % count], before);
    se3di_sub(v + 3 * (size_t)list[(k + 1) % count], x, after);
    se3di_cross(before, after, turn);
    return se3di_dot(turn, plane->n) > plane->slack * plane->s->bound;
}

/* Vertices within the face and on its sides are no corners of it. */
static void drop_inner(const face_plane *plane, uint32_t *list, int *count)
{
    for (int k = 0; *count > 3 && k < *count; ++k) {
        if (!is_corner(plane, list, *count, k)) {
            for (int c = k; c + 1 < *count; ++c) {
                list[c] = list[c + 1];
            }
            --*count;
            k = -1; /* all again */
        }
    }
}

static int is_on(const face_plane *plane, uint32_t vertex)
{
    return se3di_dot(plane->s->vertices + 3 * (size_t)vertex, plane->n) >
           plane->level - plane->slack;
}

/* Of more corners than there is room for those that are farthest to all sides. */
static void insert_farthest(const face_plane *plane, uint32_t *list, double *angle, int *count)
{
    *count = 0;
    for (int k = 0; k < SE3DI_FACE_CORNERS; ++k) {
        const double turn = 6.283185307179586 * k / SE3DI_FACE_CORNERS;
        double way[3], most = -HUGE_VAL;
        uint32_t best = 0;
        se3di_scale(se3di_cos(turn), plane->u, way);
        se3di_add_scaled(se3di_sin(turn), plane->w, way);
        for (uint32_t v = 0; v < plane->s->vertex_count; ++v) {
            const double far = se3di_dot(plane->s->vertices + 3 * (size_t)v, way);
            if (far > most + plane->slack && is_on(plane, v)) {
                most = far;
                best = v;
            }
        }
        if (is_new(plane, best, list, *count)) {
            insert_corner(plane, best, list, angle, count);
        }
    }
}

/* All vertices in the plane of the triangle that looks along d best. */
static void hull_face(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    const se3di_shape *s = solid->shape;
    double n[3] = {0.0, 0.0, 1.0}, best = -HUGE_VAL;
    size_t triangle = 0;
    for (size_t k = 0; k < s->triangle_count; ++k) {
        double here[3];
        triangle_normal(s, k, here);
        if (se3di_dot(here, d) > best + 1e-9) { /* of equal ones the first */
            best = se3di_dot(here, d);
            triangle = k;
            se3di_copy(here, n);
        }
    }
    face_plane plane = {.s = s, .slack = 1e-9 * s->bound};
    plane.level = se3di_dot(s->vertices + 3 * (size_t)s->triangles[3 * triangle], n);
    uint32_t list[SE3DI_FACE_CORNERS];
    double angle[SE3DI_FACE_CORNERS];
    for (size_t k = 0; k < 3; ++k) {
        se3di_add_scaled(1.0 / 3.0, s->vertices + 3 * (size_t)s->triangles[3 * triangle + k],
                         plane.center);
    }
    se3di_copy(n, plane.n);
    se3di_perpendicular(n, plane.u);
    se3di_cross(n, plane.u, plane.w);
    face->count = 0;
    for (uint32_t k = 0; k < s->vertex_count; ++k) {
        if (!is_on(&plane, k) || !is_new(&plane, k, list, face->count)) {
            continue;
        }
        if (face->count == SE3DI_FACE_CORNERS) {
            insert_farthest(&plane, list, angle, &face->count);
            break;
        }
        insert_corner(&plane, k, list, angle, &face->count);
    }
    drop_inner(&plane, list, &face->count);
    face->id = (uint32_t)triangle;
    se3di_mul(solid->at->R, n, face->normal);
    for (int k = 0; k < face->count; ++k) {
        to_ground(solid, s->vertices + 3 * (size_t)list[k], face->corner[k]);
    }
}

void se3di_face_find(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    double local[3];
    se3di_mul_transposed(solid->at->R, d, local);
    switch (solid->shape->kind) {
    case SE3DI_SHAPE_BOX:
        box_face(solid, local, face);
        return;
    case SE3DI_SHAPE_HULL:
        hull_face(solid, local, face);
        return;
    case SE3DI_SHAPE_CYLINDER:
        if (fabs(local[2]) > CAP_COSINE) {
            cylinder_cap(solid, local, face);
            return;
        }
        side_line(solid, local, face);
        return;
    default:
        side_line(solid, local, face);
        return;
    }
}
