/* SPDX-License-Identifier: BSD-3-Clause */
/* A sphere: a point with a radius about it. */
#include "contact/shape/shape.h"

#include "math/vec3.h"

static const se3di_dimension dimensions[] = {
    {"radius", offsetof(se3d_shape_def, radius), offsetof(se3di_shape, radius), 1.0, 1, 0},
    {.name = NULL}};

static double radius_of(const se3di_shape *s)
{
    return s->radius;
}

static void nearest_sphere(const se3di_shape *s, const double local[3], double point[3],
                           double normal[3], double *distance)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    se3di_shape_nearest_swept(origin, s->radius, local, point, normal, distance);
}

static int bend_sphere(const se3di_shape *s, const double local[3], double u[3], double r[2])
{
    (void)local;
    (void)u;
    r[0] = r[1] = s->radius;
    return 0;
}

const se3di_shape_class se3di_shape_class_sphere = {
    .name = "sphere",
    .dimensions = dimensions,
    .bound = radius_of,
    .size = radius_of,
    .nearest = nearest_sphere,
    .bend = bend_sphere,
};
