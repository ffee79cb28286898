/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether a flat or round side of a solid parts it from a line: most edges of a mesh near a solid
 * are, and this costs less than a walk. */
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

static int is_beyond(double a, double b, double limit)
{
    return (a > limit && b > limit) || (a < -limit && b < -limit);
}

static int is_before_face(const se3di_shape *s, const double a[3], const double b[3],
                          double distance)
{
    for (size_t k = 0; k < s->triangle_count; ++k) {
        double n[3];
        const double limit = se3di_face_plane(s, k, n) + distance;
        if (se3di_dot(n, a) > limit && se3di_dot(n, b) > limit) {
            return 1;
        }
    }
    return 0;
}

int se3di_side_parts(const se3di_solid *solid, const double from[3], const double to[3],
                     double distance)
{
    const se3di_shape *s = solid->shape;
    double a[3], b[3];
    se3di_solid_to_local(solid, from, a);
    se3di_solid_to_local(solid, to, b);
    if (s->kind == SE3DI_SHAPE_HULL) {
        return is_before_face(s, a, b, distance);
    }
    if (s->kind == SE3DI_SHAPE_BOX) {
        int apart = 0;
        for (int k = 0; k < 3; ++k) {
            apart |= is_beyond(a[k], b[k], s->half[k] + distance);
        }
        return apart;
    }
    if (s->kind == SE3DI_SHAPE_CYLINDER) {
        const double radius = s->radius + distance;
        return is_beyond(a[2], b[2], s->half_length + distance) ||
               square_across(a, b) > radius * radius;
    }
    return 0;
}
