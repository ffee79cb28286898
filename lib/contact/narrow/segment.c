/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether a flat or round side of a solid parts it from a line or a triangle: most of those of a
 * mesh near a solid are, and this costs less than a walk. */
#include "contact/narrow/internal.h"
#include "contact/shape/triangles.h"
#include "math/vec3.h"

#include <math.h>

/* The square of the distance of the line from the z axis. */
static double square_across(const double a[3], const double b[3])
{
    const double way[2] = {b[0] - a[0], b[1] - a[1]};
    const double square = way[0] * way[0] + way[1] * way[1];
    const double share = square > 0.0 ? -(a[0] * way[0] + a[1] * way[1]) / square : 0.0;
    const double t = share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
    const double x = a[0] + t * way[0], y = a[1] + t * way[1];
    return x * x + y * y;
}

/* Whether all of some points are beyond one end of an axis. */
static int are_beyond(const double (*x)[3], int count, int axis, double limit)
{
    int above = 1, below = 1;
    for (int k = 0; k < count; ++k) {
        above = above && x[k][axis] > limit;
        below = below && x[k][axis] < -limit;
    }
    return above || below;
}

static int are_before_face(const se3di_shape *s, const double (*x)[3], int count, double distance)
{
    for (size_t k = 0; k < s->triangle_count; ++k) {
        double n[3];
        const double limit = se3di_face_plane(s, k, n) + distance;
        int before = 1;
        for (int c = 0; c < count && before; ++c) {
            before = se3di_dot(n, x[c]) > limit;
        }
        if (before) {
            return 1;
        }
    }
    return 0;
}

static double turn_about_axis(const double a[3], const double b[3])
{
    return a[0] * b[1] - a[1] * b[0];
}

/* Whether a line, or a triangle, is farther from the z axis than a distance. */
static int are_across(const double (*x)[3], int count, double distance)
{
    int left = 0, right = 0;
    for (int k = 0; k < (count == 2 ? 1 : count); ++k) {
        const double *a = x[k], *b = x[(k + 1) % count];
        if (!(square_across(a, b) > distance * distance)) {
            return 0;
        }
        left += turn_about_axis(a, b) > 0.0;
        right += turn_about_axis(a, b) < 0.0;
    }
    return count == 2 || (left > 0 && right > 0); /* the axis is not within */
}

static int parts(const se3di_shape *s, const double (*x)[3], int count, double distance)
{
    if (s->kind == SE3DI_SHAPE_HULL) {
        return are_before_face(s, x, count, distance);
    }
    if (s->kind == SE3DI_SHAPE_BOX) {
        int apart = 0;
        for (int k = 0; k < 3; ++k) {
            apart |= are_beyond(x, count, k, s->half[k] + distance);
        }
        return apart;
    }
    return s->kind == SE3DI_SHAPE_CYLINDER && (are_beyond(x, count, 2, s->half_length + distance) ||
                                               are_across(x, count, s->radius + distance));
}

int se3di_side_parts(const se3di_solid *solid, const double from[3], const double to[3],
                     double distance)
{
    double x[2][3];
    se3di_solid_to_local(solid, from, x[0]);
    se3di_solid_to_local(solid, to, x[1]);
    return parts(solid->shape, (const double(*)[3])x, 2, distance);
}

int se3di_side_parts_triangle(const se3di_shape *s, const double corner[3][3], double distance)
{
    return parts(s, corner, 3, distance);
}
