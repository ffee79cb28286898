/* SPDX-License-Identifier: BSD-3-Clause */
/* A plane z = 0 with all that is below it. */
#include "contact/shape/shape.h"

#include "math/direction.h"
#include "math/vec3.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* A frame whose third axis is the unit vector n: columns of A. */
static void frame_about(const double n[3], double A[9])
{
    double s[3], t[3];
    se3di_perpendicular(n, s);
    se3di_cross(n, s, t);
    for (int a = 0; a < 3; ++a) {
        A[3 * a] = s[a];
        A[3 * a + 1] = t[a];
        A[3 * a + 2] = n[a];
    }
}

/* Euler parameters leave rounding where the normal has no part. It would push the particles of a
 * model in 2D out of their plane, where a bed that is pressed buckles. */
static void round_normal(double A[9])
{
    const double rounding = 4.0 * DBL_EPSILON;
    for (int a = 0; a < 3; ++a) {
        A[3 * a + 2] = fabs(A[3 * a + 2]) < rounding ? 0.0 : A[3 * a + 2];
    }
}

/* The normal of the definition is in the body frame, as is the shape's orientation. */
static se3d_status define_plane(const se3d_shape_def *def, const se3d_allocator *allocator,
                                se3di_shape *shape, se3di_error *error)
{
    const double none[3] = {0.0, 0.0, 0.0};
    (void)allocator;
    if (memcmp(def->normal, none, sizeof none) != 0) {
        double normal[3];
        SE3DI_TRY(se3di_direction_read("normal", def->normal, normal, error));
        frame_about(normal, shape->A);
        memset(shape->p, 0, sizeof shape->p); /* the normal says it */
    }
    round_normal(shape->A);
    return SE3D_OK;
}

static double endless(const se3di_shape *s)
{
    (void)s;
    return HUGE_VAL;
}

static void nearest_plane(const se3di_shape *s, const double local[3], double point[3],
                          double normal[3], double *distance)
{
    (void)s;
    point[0] = local[0];
    point[1] = local[1];
    point[2] = normal[0] = normal[1] = 0.0;
    normal[2] = 1.0;
    *distance = local[2];
}

const se3di_shape_class se3di_shape_class_plane = {
    .name = "plane",
    .define = define_plane,
    .bound = endless,
    .size = endless,
    .nearest = nearest_plane,
};
