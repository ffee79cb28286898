/* SPDX-License-Identifier: BSD-3-Clause */
/* A capsule: a line along z with a radius about it. */
#include "contact/shape/shape.h"

#include <math.h>

static const se3di_dimension dimensions[] = {
    {"length", offsetof(se3d_shape_def, length), offsetof(se3di_shape, half_length), 0.5, 1, 1},
    {"radius", offsetof(se3d_shape_def, radius), offsetof(se3di_shape, radius), 1.0, 1, 0},
    {.name = NULL}};

static double bound_capsule(const se3di_shape *s)
{
    return s->half_length + s->radius;
}

static double size_capsule(const se3di_shape *s)
{
    return s->radius;
}

static void nearest_capsule(const se3di_shape *s, const double local[3], double point[3],
                            double normal[3], double *distance)
{
    const double core[3] = {0.0, 0.0, fmax(-s->half_length, fmin(s->half_length, local[2]))};
    se3di_shape_nearest_swept(core, s->radius, local, point, normal, distance);
}

static void support_capsule(const se3di_shape *s, const double d[3], double out[3])
{
    out[0] = out[1] = 0.0;
    out[2] = d[2] < 0.0 ? -s->half_length : s->half_length;
}

static void face_capsule(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    se3di_face_set_line(solid, d, 0.0, face);
}

static int bend_capsule(const se3di_shape *s, const double local[3], double u[3], double r[2])
{
    const int is_side = fabs(local[2]) < s->half_length;
    u[0] = u[1] = 0.0;
    u[2] = 1.0;
    r[0] = is_side ? HUGE_VAL : s->radius;
    r[1] = s->radius;
    return is_side;
}

const se3di_shape_class se3di_shape_class_capsule = {
    .name = "capsule",
    .lines = SE3DI_AXES_Z,
    .dimensions = dimensions,
    .bound = bound_capsule,
    .size = size_capsule,
    .nearest = nearest_capsule,
    .support = support_capsule,
    .face = face_capsule,
    .bend = bend_capsule,
};
