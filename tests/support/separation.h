/* SPDX-License-Identifier: BSD-3-Clause */
/* How far two convex shapes overlap, found in other ways than the narrow phase does, and exactly.
 *
 * Along a direction n they overlap by h_i(n) + h_j(-n), h: the farthest along it. The least of all
 * directions is the depth. It is along one of these:
 *
 * - normals of faces and caps, products of two edges (the axis of a cylinder is one);
 * - with a cylinder, directions perpendicular to an edge or axis: the derivative has one sign on
 *   either side of a least value, so that bisection finds it to the last digit;
 * - for two rims any direction: descent, then Newton's method.
 *
 * Capsules and spheres are lines and points with a radius. */
#ifndef SE3D_TESTS_SEPARATION_H
#define SE3D_TESTS_SEPARATION_H

#include "check.h"
#include "contact/shape/triangles.h"
#include "math/vec3.h"

#define POLY_MOST 512

/* A shape in the ground frame: the hull of points, or a cylinder about its axis (no points), or an
 * ellipsoid (of which only its place is known), with a radius about it. Directions of faces look
 * both ways. */
typedef struct poly {
    int points, faces, edges, is_cylinder;
    double radius; /* about it */
    double point[POLY_MOST][3], face[POLY_MOST][3], edge[POLY_MOST][3];
    double x[3], z[3], rim, half; /* of a cylinder */
    int is_ellipsoid;
    double axes[9], semi[3];
} poly;

static inline void poly_place(const se3di_shape_pose *at, const double local[3], double out[3])
{
    se3di_mul(at->R, local, out);
    se3di_add(at->x, out, out);
}

static inline void poly_box(const se3di_shape *s, const se3di_shape_pose *at, poly *p)
{
    for (int k = 0; k < 8; ++k) {
        const double local[3] = {k & 1 ? s->half[0] : -s->half[0], k & 2 ? s->half[1] : -s->half[1],
                                 k & 4 ? s->half[2] : -s->half[2]};
        poly_place(at, local, p->point[p->points++]);
    }
    for (int a = 0; a < 3; ++a) {
        for (int c = 0; c < 3; ++c) {
            p->face[a][c] = p->edge[a][c] = at->R[3 * c + a];
        }
    }
    p->faces = p->edges = 3;
}

static inline void poly_hull(const se3di_shape *s, const se3di_shape_pose *at, poly *p)
{
    for (size_t k = 0; k < s->vertex_count; ++k) {
        poly_place(at, s->vertices + 3 * k, p->point[p->points++]);
    }
    for (size_t k = 0; k < s->triangle_count; ++k) {
        const uint32_t *t = s->triangles + 3 * k;
        double e[3][3];
        for (int c = 0; c < 3; ++c) {
            se3di_sub(p->point[t[(c + 1) % 3]], p->point[t[c]], e[c]);
            if (t[c] < t[(c + 1) % 3]) {
                se3di_copy(e[c], p->edge[p->edges++]);
            }
        }
        se3di_cross(e[0], e[1], p->face[p->faces++]);
    }
}

static inline void poly_of(const se3di_shape *s, const se3di_shape_pose *at, poly *p)
{
    p->points = p->faces = p->edges = p->is_cylinder = p->is_ellipsoid = 0;
    p->radius = 0.0;
    switch (s->kind) {
    case SE3DI_SHAPE_BOX:
        poly_box(s, at, p);
        break;
    case SE3DI_SHAPE_HULL:
        poly_hull(s, at, p);
        break;
    case SE3DI_SHAPE_CYLINDER:
        p->is_cylinder = 1;
        p->rim = s->radius;
        p->half = s->half_length;
        se3di_copy(at->x, p->x);
        for (int c = 0; c < 3; ++c) {
            p->face[0][c] = p->edge[0][c] = p->z[c] = at->R[3 * c + 2];
        }
        p->faces = p->edges = 1;
        break;
    case SE3DI_SHAPE_ELLIPSOID:
        p->is_ellipsoid = 1;
        memcpy(p->axes, at->R, sizeof p->axes);
        se3di_copy(s->half, p->semi);
        se3di_copy(at->x, p->x);
        break;
    default:
        p->radius = s->radius;
        p->points = s->kind == SE3DI_SHAPE_CAPSULE ? 2 : 1;
        p->edges = p->points - 1;
        for (int k = 0; k < p->points; ++k) {
            const double half = p->edges ? (k ? s->half_length : -s->half_length) : 0.0;
            const double local[3] = {0.0, 0.0, half};
            poly_place(at, local, p->point[k]);
        }
        se3di_sub(p->point[p->points - 1], p->point[0], p->edge[0]);
        break;
    }
}

static inline void poly_of_triangle(const double corner[3][3], poly *p)
{
    double n[3];
    p->points = p->edges = 3;
    p->faces = 4;
    p->is_cylinder = p->is_ellipsoid = 0;
    p->radius = 0.0;
    for (int k = 0; k < 3; ++k) {
        se3di_copy(corner[k], p->point[k]);
        se3di_sub(corner[(k + 1) % 3], corner[k], p->edge[k]);
    }
    se3di_cross(p->edge[0], p->edge[1], n);
    se3di_copy(n, p->face[0]);
    for (int k = 0; k < 3; ++k) {
        se3di_cross(p->edge[k], n, p->face[k + 1]);
    }
}

/* The farthest point along n, without the radius; returns how far. */
static inline double poly_reach(const poly *p, const double n[3], double at[3])
{
    if (p->is_cylinder) {
        const double along = se3di_dot(n, p->z);
        double side[3];
        se3di_copy(n, side);
        se3di_add_scaled(-along, p->z, side);
        se3di_add_scaled(-se3di_dot(side, p->z), p->z, side); /* what rounding left */
        const double size = se3di_norm(side);
        se3di_copy(p->x, at);
        se3di_add_scaled(along < 0.0 ? -p->half : p->half, p->z, at);
        se3di_add_scaled(size > 1e-15 ? p->rim / size : 0.0, side, at);
        return se3di_dot(at, n);
    }
    double most = -HUGE_VAL;
    int best = 0;
    for (int k = 0; k < p->points; ++k) {
        const double here = p->point[k][0] * n[0] + p->point[k][1] * n[1] + p->point[k][2] * n[2];
        best = here > most ? k : best;
        most = here > most ? here : most;
    }
    se3di_copy(p->point[best], at);
    return most;
}

/* The least overlap, its direction from a to b, and the next one in another direction. */
typedef struct depth {
    double least, next, n[3];
} depth;

/* How far the cores overlap along the unit n; `d`: the difference of their farthest points. */
static inline double overlap_along(const poly *a, const poly *b, const double n[3], double d[3])
{
    double back[3], on_a[3], on_b[3];
    se3di_scale(-1.0, n, back);
    poly_reach(a, n, on_a);
    poly_reach(b, back, on_b);
    se3di_sub(on_a, on_b, d);
    return se3di_dot(d, n);
}

static inline void depth_note(depth *d, double here, const double n[3])
{
    double turn[3];
    se3di_sub(n, d->n, turn);
    const int other = se3di_norm(turn) > 1e-5;
    if (here < d->least) {
        d->next = other ? d->least : d->next;
        d->least = here;
        se3di_copy(n, d->n);
    } else if (here < d->next && other) {
        d->next = here;
    }
}

static inline void depth_try(const poly *a, const poly *b, const double axis[3], depth *d)
{
    const double size = se3di_norm(axis);
    if (!(size > 1e-9)) {
        return;
    }
    for (int side = 0; side < 2; ++side) {
        double n[3], v[3];
        se3di_scale((side ? -1.0 : 1.0) / size, axis, n);
        const double here = overlap_along(a, b, n, v);
        depth_note(d, here, n);
    }
}

/* All directions perpendicular to an edge: the slope is that of n along the turn. */
static inline void depth_try_circle(const poly *a, const poly *b, const double edge[3], depth *d)
{
    enum { PARTS = 96 };
    double u[3], w[3], e[3], slope_before = 0.0;
    se3di_scale(1.0 / se3di_norm(edge), edge, e);
    se3di_perpendicular(e, u);
    se3di_cross(e, u, w);
    for (int k = 0; k <= PARTS; ++k) {
        double low = 6.283185307179586 * (k - 1) / PARTS, high = 6.283185307179586 * k / PARTS;
        double n[3], t[3], v[3], turn = high, slope = 0.0;
        for (int step = 0; step < 60; ++step) {
            se3di_scale(cos(turn), u, n);
            se3di_add_scaled(sin(turn), w, n);
            se3di_cross(e, n, t);
            (void)overlap_along(a, b, n, v);
            slope = se3di_dot(v, t);
            if (step == 0) {
                const double before = slope_before;
                slope_before = slope;
                if (k == 0 || !(before < 0.0 && slope >= 0.0)) {
                    break;
                }
            } else if (slope < 0.0) {
                low = turn;
            } else {
                high = turn;
            }
            turn = 0.5 * (low + high);
            if (step == 59) {
                depth_note(d, overlap_along(a, b, n, v), n);
            }
        }
    }
}

/* The part of the nearest points' difference perpendicular to n, along u and w. */
static inline void rim_residual(const poly *a, const poly *b, const double n[3], const double u[3],
                                const double w[3], const double x[2], double f[2], double m[3])
{
    double v[3];
    se3di_copy(n, m);
    se3di_add_scaled(x[0], u, m);
    se3di_add_scaled(x[1], w, m);
    se3di_scale(1.0 / se3di_norm(m), m, m);
    const double along = overlap_along(a, b, m, v);
    se3di_add_scaled(-along, m, v);
    f[0] = se3di_dot(v, u);
    f[1] = se3di_dot(v, w);
}

static inline void depth_polish_rims(const poly *a, const poly *b, double n[3])
{
    for (int step = 0; step < 12; ++step) {
        const double h = 1e-6, zero[2] = {0.0, 0.0}, along[2] = {h, 0.0}, across[2] = {0.0, h};
        double u[3], w[3], f[2], fu[2], fw[2], m[3];
        se3di_perpendicular(n, u);
        se3di_cross(n, u, w);
        rim_residual(a, b, n, u, w, zero, f, m);
        rim_residual(a, b, n, u, w, along, fu, m);
        rim_residual(a, b, n, u, w, across, fw, m);
        const double A[4] = {(fu[0] - f[0]) / h, (fw[0] - f[0]) / h, (fu[1] - f[1]) / h,
                             (fw[1] - f[1]) / h};
        const double det = A[0] * A[3] - A[1] * A[2];
        const double x[2] = {-(A[3] * f[0] - A[1] * f[1]) / det,
                             -(A[0] * f[1] - A[2] * f[0]) / det};
        if (!(fabs(x[0]) + fabs(x[1]) < 0.3)) {
            return;
        }
        rim_residual(a, b, n, u, w, x, f, m);
        se3di_copy(m, n);
    }
}

/* Two rims: the lowest of many directions, walked down and polished. */
static inline void depth_try_rims(const poly *a, const poly *b, depth *d)
{
    enum { SAMPLES = 300, STARTS = 5 };
    double best[STARTS], start[STARTS][3], v[3];
    for (int k = 0; k < STARTS; ++k) {
        best[k] = HUGE_VAL;
    }
    for (int k = 0; k < SAMPLES; ++k) {
        const double z = 1.0 - (2.0 * k + 1.0) / SAMPLES, rho = sqrt(1.0 - z * z);
        const double n[3] = {rho * cos(2.399963229728653 * k), rho * sin(2.399963229728653 * k), z};
        const double here = overlap_along(a, b, n, v);
        int worst = 0;
        for (int s = 1; s < STARTS; ++s) {
            worst = best[s] > best[worst] ? s : worst;
        }
        if (here < best[worst]) {
            best[worst] = here;
            se3di_copy(n, start[worst]);
        }
    }
    for (int s = 0; s < STARTS; ++s) {
        uint64_t seed = 77;
        double *n = start[s];
        for (double step = 0.1; step > 1e-5; step *= 0.7) {
            for (int k = 0; k < 8; ++k) {
                double m[3];
                for (int c = 0; c < 3; ++c) {
                    m[c] = n[c] + step * check_random(&seed);
                }
                se3di_scale(1.0 / se3di_norm(m), m, m);
                const double here = overlap_along(a, b, m, v);
                if (here < best[s]) {
                    best[s] = here;
                    se3di_copy(m, n);
                }
            }
        }
        depth_polish_rims(a, b, n);
        depth_note(d, overlap_along(a, b, n, v), n);
    }
}

/* Of the cores. Of what is farther apart than `enough` any axis that divides it. */
static inline depth depth_of_cores(const poly *a, const poly *b, double enough)
{
    depth d = {HUGE_VAL, HUGE_VAL, {0.0, 0.0, 0.0}};
    for (int k = 0; k < b->faces; ++k) {
        depth_try(a, b, b->face[k], &d);
    }
    for (int k = 0; k < a->faces; ++k) {
        depth_try(a, b, a->face[k], &d);
    }
    for (int k = 0; k < a->edges && !(d.least < -enough); ++k) {
        for (int c = 0; c < b->edges; ++c) {
            double axis[3];
            se3di_cross(a->edge[k], b->edge[c], axis);
            depth_try(a, b, axis, &d);
        }
    }
    for (int k = 0; k < a->edges && (a->is_cylinder || b->is_cylinder); ++k) {
        depth_try_circle(a, b, a->edge[k], &d);
    }
    for (int k = 0; k < b->edges && (a->is_cylinder || b->is_cylinder); ++k) {
        depth_try_circle(a, b, b->edge[k], &d);
    }
    if (!(d.least < -enough) && a->is_cylinder && b->is_cylinder) {
        depth_try_rims(a, b, &d);
    }
    return d;
}

/* ---- distances ---- */

/* Of two segments, with the points; each clamped in turn (Ericson 2005, section 5.1.9), and all
 * ends. */
static inline double segments_apart(const double a[2][3], const double b[2][3], double on_a[3],
                                    double on_b[3])
{
    double u[3], v[3], r[3], least = HUGE_VAL;
    se3di_sub(a[1], a[0], u);
    se3di_sub(b[1], b[0], v);
    se3di_sub(a[0], b[0], r);
    const double uu = se3di_dot(u, u), vv = se3di_dot(v, v), uv = se3di_dot(u, v),
                 ur = se3di_dot(u, r), vr = se3di_dot(v, r), det = uu * vv - uv * uv;
    for (int k = 0; k < 5; ++k) {
        double s = k == 0 ? (det > 0.0 ? (uv * vr - vv * ur) / det : 0.0) : k == 1 ? 0.0 : 1.0;
        double t = 0.0, p[3], q[3], d[3];
        if (k < 3) {
            s = fmin(1.0, fmax(0.0, s));
            t = vv > 0.0 ? fmin(1.0, fmax(0.0, (uv * s + vr) / vv)) : 0.0;
        } else {
            t = k == 3 ? 0.0 : 1.0;
            s = uu > 0.0 ? fmin(1.0, fmax(0.0, (uv * t - ur) / uu)) : 0.0;
        }
        se3di_copy(a[0], p);
        se3di_add_scaled(s, u, p);
        se3di_copy(b[0], q);
        se3di_add_scaled(t, v, q);
        se3di_sub(q, p, d);
        if (se3di_norm(d) < least) {
            least = se3di_norm(d);
            se3di_copy(p, on_a);
            se3di_copy(q, on_b);
        }
    }
    return least;
}

/* Of a segment (of one point where both are the same) and a triangle; 0 if it goes through. */
static inline double segment_triangle(const double a[2][3], const double corner[3][3],
                                      double on_a[3], double on_b[3])
{
    const double *const c[3] = {corner[0], corner[1], corner[2]};
    double least = HUGE_VAL, d[3], u[3], v[3], n[3], h[2];
    for (int k = 0; k < 2; ++k) {
        double at[3];
        const double here = sqrt(se3di_triangle_nearest(c, a[k], at, NULL));
        if (here < least) {
            least = here;
            se3di_copy(a[k], on_a);
            se3di_copy(at, on_b);
        }
    }
    for (int k = 0; k < 3; ++k) {
        double side[2][3], p[3] = {0.0}, q[3] = {0.0};
        se3di_copy(corner[k], side[0]);
        se3di_copy(corner[(k + 1) % 3], side[1]);
        const double here = segments_apart(a, (const double(*)[3])side, p, q);
        if (here < least) {
            least = here;
            se3di_copy(p, on_a);
            se3di_copy(q, on_b);
        }
    }
    se3di_sub(corner[1], corner[0], u);
    se3di_sub(corner[2], corner[0], v);
    se3di_cross(u, v, n);
    for (int k = 0; k < 2; ++k) {
        se3di_sub(a[k], corner[0], d);
        h[k] = se3di_dot(d, n);
    }
    if (h[0] * h[1] < 0.0) {
        double at[3], near[3];
        se3di_sub(a[1], a[0], d);
        se3di_copy(a[0], at);
        se3di_add_scaled(h[0] / (h[0] - h[1]), d, at);
        if (se3di_triangle_nearest(c, at, near, NULL) < 1e-24) {
            se3di_copy(at, on_a);
            se3di_copy(at, on_b);
            return 0.0;
        }
    }
    return least;
}

/* Of a segment and a solid that it does not meet: the distance function is convex along it, and
 * its slope has one sign on either side of the least value. */
static inline double segment_solid(const double a[2][3], const se3di_shape *s,
                                   const se3di_shape_pose *at, double normal[3])
{
    double low = 0.0, high = 1.0, u[3], distance = 0.0;
    se3di_sub(a[1], a[0], u);
    for (int k = 0; k < 62; ++k) {
        const double t = k == 0 ? 0.0 : k == 1 ? 1.0 : 0.5 * (low + high);
        double x[3], d[3], local[3], point[3], n[3];
        se3di_copy(a[0], x);
        se3di_add_scaled(t, u, x);
        se3di_sub(x, at->x, d);
        se3di_mul_transposed(at->R, d, local);
        se3di_shape_nearest(s, local, point, n, &distance);
        se3di_mul(at->R, n, normal); /* from the solid to the segment */
        const double slope = se3di_dot(normal, u);
        if ((k == 0 && slope >= 0.0) || (k == 1 && slope <= 0.0)) {
            return distance;
        }
        if (k > 1 && slope < 0.0) {
            low = t;
        } else if (k > 1) {
            high = t;
        }
    }
    return distance;
}

/* How deep i and j overlap, or minus the distance of what has a radius, and the direction from i to
 * j; minus infinity where the two are apart and neither has one. */
static inline double separation_of(const se3di_shape *i, const se3di_shape_pose *at_i,
                                   const se3di_shape *j, const se3di_shape_pose *at_j, double n[3])
{
    poly a, b;
    poly_of(i, at_i, &a);
    poly_of(j, at_j, &b);
    if (a.points > 0 && a.points < 3) {
        double line[2][3];
        se3di_copy(a.point[0], line[0]);
        se3di_copy(a.point[a.points - 1], line[1]);
        se3di_shape core = *j;
        core.radius -= b.radius;
        const double apart = segment_solid((const double(*)[3])line, &core, at_j, n);
        if (apart > 1e-9) {
            se3di_scale(-1.0, n, n);
            return a.radius + b.radius - apart;
        }
    } else if (b.points > 0 && b.points < 3) {
        const double least = separation_of(j, at_j, i, at_i, n);
        se3di_scale(-1.0, n, n);
        return least;
    }
    const depth d = depth_of_cores(&a, &b, 0.0);
    se3di_copy(d.n, n);
    return d.least > 0.0 && d.least < HUGE_VAL ? d.least + a.radius + b.radius : -HUGE_VAL;
}

/* Faces of a valley share the overlap of what has no core but a line: the sum of their pushes. */
static inline double separation_shared(const se3di_shape *solid, const se3di_manifold *m)
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t k = 0; se3di_shape_is(solid, SE3DI_SHAPE_IS_SWEPT) && k < m->count; ++k) {
        se3di_add_scaled(m->points[k].overlap, m->points[k].normal, sum);
    }
    return se3di_norm(sum);
}

#endif
