/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes on planes: half spaces without end. */
#include "contact/narrow/internal.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define RIM_TILT 1e-2 /* sine of the tilt above which a rim bends about its lowest point */

typedef struct half_space {
    const double *x; /* on it */
    double n[3];     /* outward */
} half_space;

static half_space half_space_of(const se3di_solid *plane)
{
    half_space half = {.x = plane->at->x};
    se3di_solid_axis(plane, 2, half.n);
    return half;
}

static double height_of(const half_space *plane, const double x[3])
{
    double d[3];
    se3di_sub(x, plane->x, d);
    return se3di_dot(d, plane->n);
}

/* A point of i at a height over the plane j. */
static se3di_contact_point *touch_at(const half_space *plane, const double x[3], double height,
                                     double radius, uint32_t feature, se3di_manifold *manifold)
{
    double point[3], normal[3];
    se3di_copy(x, point);
    se3di_add_scaled(-height, plane->n, point);
    se3di_scale(-1.0, plane->n, normal);
    se3di_contact_point *p = se3di_manifold_add(manifold, point, normal, radius - height, feature);
    p->share = 1.0;
    p->bend_i.r[0] = p->bend_i.r[1] = radius;
    return p;
}

/* A point of i with the radius about it, if it is below the plane j. */
static se3di_contact_point *touch_plane(const half_space *plane, const double x[3], double radius,
                                        uint32_t feature, se3di_manifold *manifold)
{
    const double height = height_of(plane, x);
    return height < radius ? touch_at(plane, x, height, radius, feature, manifold) : NULL;
}

/* Corners lower than `below`, as if none of them were higher than `highest`. Returns the height of
 * the lowest. */
static double touch_corners(const half_space *plane, const se3di_solid *i, double below,
                            double highest, se3di_manifold *manifold)
{
    const se3di_shape_class *kind = se3di_shape_class_of(i->shape);
    double local[3], x[3], lowest = HUGE_VAL;
    for (uint32_t k = 0; kind->corner(i->shape, k, local); ++k) {
        se3di_solid_to_ground(i, local, x);
        const double height = height_of(plane, x);
        lowest = fmin(lowest, height);
        if (height < below) {
            touch_at(plane, x, fmin(height, highest), 0.0, k, manifold);
        }
    }
    return lowest;
}

void se3di_plane_corners(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    const half_space plane = half_space_of(j);
    const double rounding = se3di_narrow_rounding(i->at->x, i->shape->bound);
    const double lowest = touch_corners(&plane, i, 0.0, HUGE_VAL, manifold);
    if (lowest < 0.0 && lowest > -rounding) {
        manifold->count = 0;
        (void)touch_corners(&plane, i, rounding, lowest, manifold);
    }
}

void se3di_plane_capsule(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    const half_space plane = half_space_of(j);
    double axis[3], x[3];
    se3di_solid_axis(i, 2, axis);
    for (uint32_t end = 0; end < 2; ++end) {
        se3di_copy(i->at->x, x);
        se3di_add_scaled(end ? i->shape->half_length : -i->shape->half_length, axis, x);
        touch_plane(&plane, x, i->shape->radius, end, manifold);
    }
}

double se3di_cylinder_rims(const se3di_solid *i, const double normal[3], double deep,
                           double rim[8][3])
{
    double down[3], lean[2];
    se3di_mul_transposed(i->at->R, normal, down);
    se3di_scale(-1.0, down, down);
    se3di_cap_lean(i->shape, down, deep, lean);
    for (uint32_t k = 0; k < 8; ++k) {
        const double turn = k & 1u ? -i->shape->radius : i->shape->radius;
        const double local[3] = {turn * (k & 2u ? -lean[1] : lean[0]),
                                 turn * (k & 2u ? lean[0] : lean[1]),
                                 k & 4u ? i->shape->half_length : -i->shape->half_length};
        se3di_solid_to_ground(i, local, rim[k]);
    }
    return se3di_hypot(down[0], down[1]);
}

int se3di_rim_bend(const se3di_solid *i, const double normal[3], double tilt, se3di_bend *bend)
{
    double axis[3], side[3];
    if (!(tilt > RIM_TILT)) {
        return 0;
    }
    se3di_solid_axis(i, 2, axis);
    se3di_cross(normal, axis, side);
    se3di_scale(1.0 / se3di_norm(side), side, side);
    se3di_bend_set(bend, side, i->shape->radius / tilt, 0.0);
    return 1;
}

void se3di_plane_cylinder(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    const half_space plane = half_space_of(j);
    double rim[8][3], down[3], lowest[3];
    se3di_bend bend;
    se3di_scale(-1.0, plane.n, down);
    se3di_core_support(i, down, lowest);
    const double tilt = se3di_cylinder_rims(i, plane.n, -height_of(&plane, lowest), rim);
    const int bends = se3di_rim_bend(i, plane.n, tilt, &bend);
    for (uint32_t k = 0; k < 8; ++k) {
        se3di_contact_point *p = touch_plane(&plane, rim[k], 0.0, k, manifold);
        if (p && k % 4 == 0 && bends) {
            p->bend_i = bend;
        }
    }
}

void se3di_plane_convex(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    const half_space plane = half_space_of(j);
    double down[3], lowest[3];
    se3di_scale(-1.0, plane.n, down);
    se3di_core_support(i, down, lowest);
    touch_plane(&plane, lowest, se3di_core_radius(i->shape), 0, manifold);
}

void se3di_plane_smooth(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    const half_space plane = half_space_of(j);
    double down[3], lowest[3], local[3];
    se3di_scale(-1.0, plane.n, down);
    se3di_core_support(i, down, lowest);
    se3di_contact_point *p = touch_plane(&plane, lowest, 0.0, 0, manifold);
    if (p) {
        se3di_solid_to_local(i, lowest, local);
        se3di_solid_bend(i, local, &p->bend_i);
    }
}
