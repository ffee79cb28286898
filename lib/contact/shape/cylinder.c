/* SPDX-License-Identifier: BSD-3-Clause */
/* A cylinder along z. */
#include "contact/shape/shape.h"

#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define CAP_COSINE  0.9 /* a cylinder seen along less than this shows its side */
#define CAP_CORNERS 8
#define DIAGONAL    0.70710678118654752
#define UPRIGHT     4e-4 /* twice the sine of the tilt above which a cap's corners follow it */

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

void se3di_cap_lean(const se3di_shape *s, const double d[3], double deep, double lean[2])
{
    const double rise = s->radius * se3di_hypot(d[0], d[1]); /* of the rim over the middle */
    const double stay = DIAGONAL * fmax(fmin(deep, UPRIGHT * s->radius) - 2.0 * rise, 0.0);
    const double x = s->radius * d[0] + stay, y = s->radius * d[1] + stay;
    const double size = se3di_hypot(x, y);
    lean[0] = size > 0.0 ? x / size : DIAGONAL;
    lean[1] = size > 0.0 ? y / size : DIAGONAL;
}

double se3di_cap_bulge(const se3di_solid *solid, const double d[3], double deep)
{
    double local[3], lean[2];
    if (!se3di_shape_is(solid->shape, SE3DI_SHAPE_HAS_RIMS)) {
        return 0.0;
    }
    se3di_mul_transposed(solid->at->R, d, local);
    se3di_cap_lean(solid->shape, local, deep, lean);
    const double along = fabs(local[0] * lean[0] + local[1] * lean[1]);
    const double across = fabs(local[1] * lean[0] - local[0] * lean[1]);
    const double less = se3di_hypot(local[0], local[1]) - fmax(along, across);
    return solid->shape->radius * fmax(less, 0.0);
}

static void face_cap(const se3di_solid *solid, const double d[3], double deep, se3di_face *face)
{
    static const double cosine[CAP_CORNERS] = {1.0,  DIAGONAL,  0.0, -DIAGONAL,
                                               -1.0, -DIAGONAL, 0.0, DIAGONAL};
    const se3di_shape *s = solid->shape;
    double lean[2];
    se3di_cap_lean(s, d, deep, lean);
    const double sign = d[2] < 0.0 ? -1.0 : 1.0;
    const double n[3] = {0.0, 0.0, sign};
    se3di_mul(solid->at->R, n, face->normal);
    face->count = CAP_CORNERS;
    face->id = sign < 0.0;
    for (int k = 0; k < CAP_CORNERS; ++k) {
        const double c = cosine[k];
        const double w = sign * cosine[(k + 6) % CAP_CORNERS]; /* the sine */
        const double local[3] = {s->radius * (c * lean[0] - w * lean[1]),
                                 s->radius * (c * lean[1] + w * lean[0]), sign * s->half_length};
        se3di_solid_to_ground(solid, local, face->corner[k]);
    }
}

void se3di_cap_find(const se3di_solid *solid, const double d[3], double deep, se3di_face *face)
{
    double local[3];
    se3di_mul_transposed(solid->at->R, d, local);
    face_cap(solid, local, deep, face);
}

static void face_cylinder(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    if (fabs(d[2]) > CAP_COSINE) {
        face_cap(solid, d, 0.0, face);
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
