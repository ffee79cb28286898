/* SPDX-License-Identifier: BSD-3-Clause */
/* The least overlap of a cylinder and another solid on its cap, and of two side by side, without a
 * polytope.
 *
 * Caps: let one overlap the point q of the other that is farthest along -n by d > 0, n its normal,
 * q be r from its axis, R the radius, p = R - r > 0, t = d/p <= 1. The two overlap along a unit at
 * the angle a from n by d cos a + p sin a or more, which is less than d only within 2 atan(t) of
 * -n. With e the overlap along -n, of the other cap, and s how far the point of the other farthest
 * along n is from the axis, it is e cos b + min(R - s, 0) sin b or more at b from -n. So no
 * direction has less than d if
 *
 *     e (1 - t^2) + 2 t min(R - s, 0) >= d (1 + t^2).
 *
 * Sides: let P and Q be places of the axes c, d, at least m from their ends, e the way from P to Q,
 * R, S the radii. With x the larger of |n . c|, |n . d| the two overlap along a unit n by
 *
 *     h(n) >= m x + (R + S) sqrt(1 - x^2) - n . e.
 *
 * Axes that cross: let P, Q be nearest to each other and g = R + S - |e|. As n . e is at most
 * |e| sqrt(1 - x^2), h(n) >= m x + g sqrt(1 - x^2), which is g at least if m >= g > 0. The least
 * overlap is g, along e.
 *
 * Axes that are nearly parallel: let P, Q be in the middle of what they have in common. The least
 * overlap near e is found as any other (least.c): k above g. Let t be the angle of n and e, and u
 * the larger of |e . c|, |e . d|, so that n . e <= |e| sqrt(1 - x^2) + u x. No other is less where
 *
 *     |e| (1 - cos t) >= k            if x <= m/(R + S),
 *     (m - u) x >= k + max(g, 0) x^2  for any x.
 *                                                             docs/theory/body-contact.md */
#include "contact/narrow/internal.h"
#include "math/vec3.h"

#include <math.h>

#define ASKEW 1e-3  /* sine; axes that are less nearly parallel cross somewhere */
#define NEAR  0.015 /* rad; what is found so near e is the least there */
#define FALL  (0.5 * NEAR * NEAR * (1.0 - NEAR * NEAR / 12.0)) /* below 1 - cos NEAR */

typedef struct axes {
    const se3di_solid *i, *j;
    double c[3], d[3];    /* unit */
    double margin, reach; /* m, R + S */
    double p[3], q[3], e[3];
} axes;

/* Returns 0 if a place is not beside the other cylinder. */
static int set_places(axes *a, double s, double t)
{
    a->margin = fmin(a->i->shape->half_length - fabs(s), a->j->shape->half_length - fabs(t));
    se3di_copy(a->i->at->x, a->p);
    se3di_add_scaled(s, a->c, a->p);
    se3di_copy(a->j->at->x, a->q);
    se3di_add_scaled(t, a->d, a->q);
    se3di_sub(a->q, a->p, a->e);
    return a->margin > 0.0;
}

static void touch_sides(const axes *a, const double n[3], double on_i[3], double on_j[3])
{
    se3di_copy(a->p, on_i);
    se3di_add_scaled(a->i->shape->radius, n, on_i);
    se3di_copy(a->q, on_j);
    se3di_add_scaled(-a->j->shape->radius, n, on_j);
}

/* Returns 0 if it is not known. */
static double overlap_crossing(axes *a, const double D[3], const double product[3], double sine,
                               double n[3], double on_i[3], double on_j[3])
{
    const double turn = se3di_dot(a->c, a->d), square = sine * sine;
    const double along_c = se3di_dot(D, a->c), along_d = se3di_dot(D, a->d);
    const double gap = se3di_dot(D, product) / sine;
    const double overlap = a->reach - fabs(gap);
    if (!(overlap > 0.0) ||
        !set_places(a, (along_c - turn * along_d) / square, (turn * along_c - along_d) / square) ||
        !(a->margin >= overlap)) {
        return 0.0;
    }
    se3di_scale((gap < 0.0 ? -1.0 : 1.0) / sine, product, n);
    touch_sides(a, n, on_i, on_j);
    return overlap;
}

/* Whether nothing that is not near e is less. */
static int is_least(const axes *a, double overlap, double size)
{
    const double across = fmax(fabs(se3di_dot(a->e, a->c)), fabs(se3di_dot(a->e, a->d)));
    const double g = a->reach - size, k = overlap - g;
    const double from = a->margin / a->reach, slope = a->margin - across, bend = fmax(g, 0.0);
    /* the second is concave in x: it holds between two places where it does */
    return size * FALL >= k &&
           (from >= 1.0 || (slope * from >= k + bend * from * from && slope >= k + bend));
}

static double overlap_along(axes *a, const double D[3], double n[3], double on_i[3], double on_j[3])
{
    const double turn = se3di_dot(a->c, a->d), along = se3di_dot(D, a->c);
    const double half = a->i->shape->half_length, other = a->j->shape->half_length * fabs(turn);
    const double low = fmax(-half, along - other), high = fmin(half, along + other);
    const double s = 0.5 * (low + high);
    double way[3], off[3], overlap = HUGE_VAL;
    if (!(high > low) || !set_places(a, s, s * turn - se3di_dot(D, a->d))) {
        return 0.0;
    }
    const double size = se3di_norm(a->e);
    if (!(size > 0.0 && a->reach > size)) {
        return 0.0;
    }
    se3di_scale(1.0 / size, a->e, way);
    se3di_copy(way, n);
    touch_sides(a, n, on_i, on_j);
    if (!se3di_convex_polish(a->i, a->j, n, on_i, on_j, &overlap) || !(overlap > 0.0)) {
        return 0.0;
    }
    se3di_sub(n, way, off);
    return se3di_norm(off) < NEAR && is_least(a, overlap, size) ? overlap : 0.0;
}

typedef struct cap {
    double n[3], q[3]; /* its normal, outward; the point of the other */
    double overlap;
} cap;

/* How far a point is from the axis. */
static double find_arm(const se3di_solid *solid, const double axis[3], const double x[3])
{
    double d[3], along[3];
    se3di_sub(x, solid->at->x, d);
    se3di_scale(se3di_dot(d, axis), axis, along);
    se3di_sub(d, along, d);
    return se3di_norm(d);
}

/* How far the two overlap along a normal of the first, and the point of the other that does. */
static double reach_of(const se3di_solid *solid, const se3di_solid *other, const double n[3],
                       double q[3])
{
    double back[3], p[3], d[3];
    se3di_scale(-1.0, n, back);
    se3di_core_support(solid, n, p);
    se3di_core_support(other, back, q);
    se3di_sub(p, q, d);
    return se3di_dot(d, n);
}

/* The cap of a cylinder on the side of another solid. Returns whether the two overlap along its
 * normal, and along no other direction by less, for certain. */
static int look_at_cap(const se3di_solid *solid, const se3di_solid *other, cap *c)
{
    double axis[3], D[3], back[3], far[3];
    se3di_solid_axis(solid, 2, axis);
    se3di_sub(other->at->x, solid->at->x, D);
    se3di_scale((se3di_dot(D, axis) < 0.0 ? -1.0 : 1.0) / se3di_norm(axis), axis, c->n);
    c->overlap = reach_of(solid, other, c->n, c->q);
    const double inside = solid->shape->radius - find_arm(solid, c->n, c->q);
    if (!(c->overlap > 0.0 && inside > c->overlap)) {
        return 0;
    }
    se3di_scale(-1.0, c->n, back);
    const double behind = reach_of(solid, other, back, far);
    const double beside = fmin(solid->shape->radius - find_arm(solid, c->n, far), 0.0);
    const double t = c->overlap / inside;
    return behind * (1.0 - t * t) + 2.0 * t * beside >= c->overlap * (1.0 + t * t);
}

double se3di_caps_overlap(const se3di_solid *i, const se3di_solid *j, double n[3], double on_i[3],
                          double on_j[3])
{
    for (int k = 0; k < 2; ++k) {
        const se3di_solid *one = k ? j : i, *other = k ? i : j;
        cap c;
        if (se3di_solid_has_rims(one) && look_at_cap(one, other, &c)) {
            se3di_scale(k ? -1.0 : 1.0, c.n, n);
            se3di_copy(c.q, k ? on_i : on_j);
            se3di_copy(c.q, k ? on_j : on_i);
            se3di_add_scaled(c.overlap, c.n, k ? on_j : on_i);
            return c.overlap;
        }
    }
    return 0.0;
}

double se3di_cylinders_overlap(const se3di_solid *i, const se3di_solid *j, double n[3],
                               double on_i[3], double on_j[3])
{
    axes a = {.i = i, .j = j, .reach = i->shape->radius + j->shape->radius};
    double D[3], product[3];
    se3di_solid_axis(i, 2, a.c);
    se3di_solid_axis(j, 2, a.d);
    se3di_sub(j->at->x, i->at->x, D);
    se3di_cross(a.c, a.d, product);
    const double sine = se3di_norm(product);
    const double crossing =
        sine > ASKEW ? overlap_crossing(&a, D, product, sine, n, on_i, on_j) : 0.0;
    const double known = crossing > 0.0 ? crossing : se3di_caps_overlap(i, j, n, on_i, on_j);
    return known > 0.0 || sine > ASKEW ? known : overlap_along(&a, D, n, on_i, on_j);
}
