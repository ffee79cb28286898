/* SPDX-License-Identifier: BSD-3-Clause */
/* Overlap or distance of two convex shapes with the radii about their cores. Of the line of a
 * capsule that is apart from the other core the distance is convex along the line, and its slope,
 * n . u, has one sign on either side of the nearest point. */
#include "contact/narrow/bracket.h"
#include "contact/narrow/internal.h"
#include "math/vec3.h"

#include <math.h>

#define APART 1e-9 /* of the size: cores that are */

/* The distance of a point from a core, and the direction to it. */
static double distance_from(const se3di_solid *solid, const double x[3], double n[3], double at[3])
{
    se3di_shape core = *solid->shape;
    double local[3], point[3], normal[3], distance;
    core.radius -= se3di_core_radius(solid->shape);
    se3di_solid_to_local(solid, x, local);
    se3di_shape_nearest(&core, local, point, normal, &distance);
    se3di_mul(solid->at->R, normal, n);
    se3di_copy(x, at);
    se3di_add_scaled(-distance, n, at);
    return distance;
}

/* At a place of a line: the distance of the core of j, and its slope along the line. */
static double line_look(const se3di_solid *line, const se3di_solid *j, double t, double n[3],
                        double on_line[3], double on_j[3], double *slope)
{
    double u[3], from[3];
    se3di_solid_axis(line, 2, u);
    se3di_copy(line->at->x, on_line);
    se3di_add_scaled(t, u, on_line);
    const double distance = distance_from(j, on_line, from, on_j);
    se3di_scale(-1.0, from, n);
    *slope = se3di_dot(from, u);
    return distance;
}

/* Of the line of a capsule from the core of j: the least distance, <= 0 if they meet. */
static double line_distance(const se3di_solid *line, const se3di_solid *j, double n[3],
                            double on_line[3], double on_j[3])
{
    const double half = line->shape->half_length;
    se3di_bracket b = {.low = -half, .high = half, .width = 2.0 * half};
    double slope, distance = line_look(line, j, b.low, n, on_line, on_j, &b.slope_low);
    if (b.slope_low >= 0.0) {
        return distance;
    }
    distance = line_look(line, j, b.high, n, on_line, on_j, &b.slope_high);
    if (b.slope_high <= 0.0) {
        return distance;
    }
    while (se3di_bracket_look(&b)) {
        distance = line_look(line, j, b.next, n, on_line, on_j, &slope);
        if (!se3di_bracket_take(&b, slope)) {
            break;
        }
    }
    return distance;
}

/* A bound of the distance of two cores: that of the planes across the way between their centres. */
static double gap_between(const se3di_solid *i, const se3di_solid *j)
{
    double n[3], back[3], on_i[3], on_j[3], d[3];
    se3di_sub(j->at->x, i->at->x, n);
    const double size = se3di_norm(n);
    if (!(size > 0.0)) {
        return 0.0;
    }
    se3di_scale(1.0 / size, n, n);
    se3di_scale(-1.0, n, back);
    se3di_core_support(i, n, on_i);
    se3di_core_support(j, back, on_j);
    se3di_sub(on_j, on_i, d);
    return se3di_dot(d, n);
}

double se3di_convex_least(const se3di_solid *i, const se3di_solid *j, double far, double n[3],
                          double on_i[3], double on_j[3])
{
    const double radius = se3di_core_radius(i->shape) + se3di_core_radius(j->shape);
    const double apart = APART * (i->shape->bound + j->shape->bound);
    if (far < HUGE_VAL && (se3di_solid_is_line(i) || se3di_solid_is_line(j))) {
        const double gap = gap_between(i, j);
        if (gap > radius + far + apart) {
            return radius - gap;
        }
    }
    if (se3di_solid_is_line(i) && !j->shape->triangles) {
        const double distance = line_distance(i, j, n, on_i, on_j);
        if (distance > apart) {
            return radius - distance;
        }
    } else if (se3di_solid_is_line(j) && !i->shape->triangles) {
        const double distance = line_distance(j, i, n, on_j, on_i);
        if (distance > apart) {
            se3di_scale(-1.0, n, n);
            return radius - distance;
        }
    }
    return radius + se3di_convex_distance(i, j, radius + far, n, on_i, on_j);
}
