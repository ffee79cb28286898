/* SPDX-License-Identifier: BSD-3-Clause */
/* A cylinder along z. */
#include "contact/shape/shape.h"

#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define CAP_COSINE  0.9 /* a cylinder seen along less than this shows its side */
#define CAP_CORNERS 8

static const se3di_dimension dimensions[] = {
    {"length", offsetof(se3d_shape_def, length), offsetof(se3di_shape, half_length), 0.5, 1, 0},
    {"radius", offsetof(se3d_shape_def, radius), offsetof(se3di_shape, radius), 1.0, 1, 0},
    {.name = NULL}};

static double bound_cylinder(const se3di_shape *s)
{
    return se3di_hypot(s->half_length, s->radius);
}

static double size_cylinder(const se3di_shape *s)
{
    return fmin(s->radius, s->half_length);
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

static void support_cylinder(const se3di_shape *s, const double d[3], double out[3])
{
    double rho = se3di_hypot(d[0], d[1]);
    out[0] = rho > 0.0 ? s->radius * d[0] / rho : 0.0;
    out[1] = rho > 0.0 ? s->radius * d[1] / rho : 0.0;
    out[2] = d[2] < 0.0 ? -s->half_length : s->half_length;
}

static void face_cap(const se3di_solid *solid, const double d[3], se3di_face *face)
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
        se3di_solid_to_ground(solid, local, face->corner[k]);
    }
}

static void face_cylinder(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    if (fabs(d[2]) > CAP_COSINE) {
        face_cap(solid, d, face);
    } else {
        se3di_face_set_line(solid, d, solid->shape->radius, face);
    }
}

static int bend_cylinder(const se3di_shape *s, const double local[3], double u[3], double r[2])
{
    double rho = se3di_hypot(local[0], local[1]);
    double above = fabs(local[2]) - s->half_length;
    if (rho <= s->radius) { /* on a cap, or from inside */
        return 0;
    }
    if (above > 0.0) {
        double lean = se3di_hypot(rho - s->radius, above);
        u[0] = -local[1] / rho;
        u[1] = local[0] / rho;
        u[2] = 0.0;
        r[0] = s->radius * lean / (rho - s->radius);
        r[1] = 0.0;
    } else {
        u[0] = u[1] = 0.0;
        u[2] = 1.0;
        r[1] = s->radius;
    }
    return 1;
}

const se3di_shape_class se3di_shape_class_cylinder = {
    .name = "cylinder",
    .flats = SE3DI_AXES_Z,
    .lines = SE3DI_AXES_Z,
    .dimensions = dimensions,
    .bound = bound_cylinder,
    .size = size_cylinder,
    .nearest = nearest_cylinder,
    .support = support_cylinder,
    .face = face_cylinder,
    .bend = bend_cylinder,
};
