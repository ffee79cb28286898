/* SPDX-License-Identifier: BSD-3-Clause */
#include "contact/shape/triangles.h"

#include "math/vec3.h"

#include <math.h>
#include <string.h>

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
    if (inside) { /* more exactly along the normal, which matters if p is near */
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

void se3di_triangle_normal(const double *const corner[3], double normal[3])
{
    se3di_triangle_span(corner, normal);
    double length = se3di_norm(normal);
    se3di_scale(length > 0.0 ? 1.0 / length : 0.0, normal, normal);
}

double se3di_vertices_bound(const se3di_shape *shape)
{
    double most = 0.0;
    for (size_t k = 0; k < shape->vertex_count; ++k) {
        most = fmax(most, se3di_norm(shape->vertices + 3 * k));
    }
    return most;
}

double se3di_vertices_size(const se3di_shape *shape)
{
    return 0.5 * shape->bound;
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

void se3di_vertices_support(const se3di_shape *shape, const double d[3], double out[3])
{
    se3di_copy(shape->vertices + 3 * (size_t)highest_vertex(shape, d), out);
}

se3d_status se3di_shape_check_array(const void *pointer, const char *name, se3di_error *error)
{
    return pointer ? SE3D_OK : se3di_error_set_of(error, name, SE3D_ERR_NULL, " is NULL");
}

se3d_status se3di_vertices_define(const se3d_shape_def *def, se3di_shape *shape, se3di_error *error)
{
    SE3DI_TRY(se3di_shape_check_array(def->vertices, "vertices", error));
    if (def->vertex_count < 3 || def->vertex_count > UINT32_MAX / 16) {
        return se3di_error_set_of(error, "vertex_count", SE3D_ERR_INVALID_ARGUMENT,
                                  " = %zu, must be at least 3 and at most %u", def->vertex_count,
                                  UINT32_MAX / 16);
    }
    for (size_t k = 0; k < 3 * def->vertex_count; ++k) {
        if (!isfinite(def->vertices[k])) {
            return se3di_error_set(error, SE3D_ERR_INVALID_ARGUMENT,
                                   "vertices[%zu] = %g m, must be finite", k, def->vertices[k]);
        }
    }
    memcpy(&shape->vertices, &def->vertices, sizeof shape->vertices); /* copied by the model */
    shape->vertex_count = def->vertex_count;
    return SE3D_OK;
}
