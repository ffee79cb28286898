/* SPDX-License-Identifier: BSD-3-Clause */
/* A box about its centre. */
#include "contact/shape/shape.h"

#include "math/vec3.h"

#include <math.h>

static const se3di_dimension dimensions[] = {
    {"size", offsetof(se3d_shape_def, size), offsetof(se3di_shape, half), 0.5, 3, 0},
    {.name = NULL}};

static double bound_box(const se3di_shape *s)
{
    return se3di_norm(s->half);
}

static double size_box(const se3di_shape *s)
{
    return fmin(s->half[0], fmin(s->half[1], s->half[2]));
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

static void support_box(const se3di_shape *s, const double d[3], double out[3])
{
    for (int a = 0; a < 3; ++a) {
        out[a] = d[a] < 0.0 ? -s->half[a] : s->half[a];
    }
}

static int corner_box(const se3di_shape *s, uint32_t k, double out[3])
{
    for (uint32_t a = 0; a < 3; ++a) {
        out[a] = (k >> a & 1u) ? s->half[a] : -s->half[a];
    }
    return k < 8;
}

static void face_box(const se3di_solid *solid, const double d[3], se3di_face *face)
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
        se3di_solid_to_ground(solid, local, face->corner[k]);
    }
}

/* Flat, or an edge, or a corner. */
static int bend_box(const se3di_shape *s, const double local[3], double u[3], double r[2])
{
    int outside[3], beyond = 0;
    for (int a = 0; a < 3; ++a) {
        outside[a] = fabs(local[a]) > s->half[a];
        beyond += outside[a];
    }
    if (beyond < 2) {
        return 0;
    }
    for (int a = 0; a < 3; ++a) {
        u[a] = outside[a] ? 0.0 : 1.0;
    }
    r[1] = 0.0;
    if (beyond == 3) {
        r[0] = 0.0;
        return 0;
    }
    return 1;
}

const se3di_shape_class se3di_shape_class_box = {
    .name = "box",
    .flats = SE3DI_AXES_ALL,
    .lines = SE3DI_AXES_ALL,
    .dimensions = dimensions,
    .bound = bound_box,
    .size = size_box,
    .nearest = nearest_box,
    .support = support_box,
    .face = face_box,
    .corner = corner_box,
    .bend = bend_box,
};
