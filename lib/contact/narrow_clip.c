/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of faces and lines: what looks at a face is cut off at its sides, and its corners behind
 * the face are the points of contact, each with its own overlap. */
#include "contact/narrow_internal.h"

#include "math/vec3.h"

#include <math.h>

#define CUT_CORNERS  (2 * SE3DI_FACE_CORNERS)
#define SLACK        1e-6  /* of the face's size: corners beyond a side by less are not cut off */
#define PARALLEL     1e-2  /* sine below which two lines touch in two points */
#define FACE_COSINE  0.985 /* faces leaning by less than 10 degrees from the normal */
#define FLAT_COSINE  0.9999995 /* what is round about its core touches a face so nearly square */
#define OTHER_FACTOR 0.98      /* overlap below which the second box's face, */
#define EDGE_FACTOR  0.9       /* or two edges, are preferred to a face */

typedef struct cut {
    int count;
    double corner[CUT_CORNERS][3];
    uint32_t id[CUT_CORNERS];
} cut;

static void cut_add(cut *to, const double x[3], uint32_t id)
{
    if (to->count < CUT_CORNERS) {
        se3di_copy(x, to->corner[to->count]);
        to->id[to->count++] = id;
    }
}

/* What of `from` is on the inner side (n . x <= level + slack) of one side of the face. */
static void cut_side(const cut *from, const double n[3], double level, double slack, uint32_t side,
                     cut *to)
{
    to->count = 0;
    for (int k = 0; k < from->count; ++k) {
        int next = (k + 1) % from->count;
        const double *a = from->corner[k];
        const double *b = from->corner[next];
        double high_a = se3di_dot(n, a) - level;
        double high_b = se3di_dot(n, b) - level;
        if (high_a <= slack) {
            cut_add(to, a, from->id[k]);
        }
        int crosses = (high_a <= slack) != (high_b <= slack);
        if (crosses && (from->count > 2 || k == 0)) {
            double x[3];
            double t = fmin(1.0, fmax(0.0, high_a / (high_a - high_b)));
            se3di_sub(b, a, x);
            se3di_scale(t, x, x);
            se3di_add(a, x, x);
            uint32_t low = from->id[k] < from->id[next] ? from->id[k] : from->id[next];
            uint32_t high = from->id[k] < from->id[next] ? from->id[next] : from->id[k];
            cut_add(to, x, 64u + ((low * 61u + high) * 17u + side) % 960u);
        }
    }
}

static double face_size(const se3di_face *face)
{
    double most = 0.0;
    for (int k = 1; k < face->count; ++k) {
        double d[3];
        se3di_sub(face->corner[k], face->corner[0], d);
        most = fmax(most, se3di_norm(d));
    }
    return most;
}

static void bend_incident(const se3di_face *incident, double radius, se3di_bend *bend)
{
    double u[3];
    bend->r[0] = bend->r[1] = radius;
    if (incident->count == 2) {
        se3di_sub(incident->corner[1], incident->corner[0], u);
        double size = se3di_norm(u);
        if (size > 0.0) {
            se3di_scale(1.0 / size, u, bend->u);
        }
    }
}

void se3di_narrow_clip(const se3di_face *reference, const se3di_face *incident, double radius,
                       int flip, se3di_manifold *manifold)
{
    cut a = {.count = 0}, b;
    cut *from = &a, *to = &b;
    double slack = SLACK * face_size(reference);
    for (int k = 0; k < incident->count; ++k) {
        cut_add(from, incident->corner[k], (uint32_t)k);
    }
    for (int k = 0; k < reference->count && from->count > 0; ++k) {
        const double *p = reference->corner[k];
        double side[3], n[3];
        se3di_sub(reference->corner[(k + 1) % reference->count], p, side);
        se3di_cross(side, reference->normal, n);
        double size = se3di_norm(n);
        if (!(size > 0.0)) {
            continue;
        }
        se3di_scale(1.0 / size, n, n);
        cut_side(from, n, se3di_dot(n, p), slack, (uint32_t)k, to);
        cut *other = from;
        from = to;
        to = other;
    }
    uint32_t faces = (reference->id * 8191u + incident->id) * 2u + (uint32_t)(flip != 0);
    for (int k = 0; k < from->count; ++k) {
        double d[3], point[3], normal[3];
        se3di_sub(reference->corner[0], from->corner[k], d);
        double overlap = se3di_dot(d, reference->normal) + radius;
        if (!(overlap > 0.0)) {
            continue;
        }
        se3di_copy(from->corner[k], point);
        se3di_add_scaled(0.5 * overlap - radius, reference->normal, point);
        se3di_scale(flip ? -1.0 : 1.0, reference->normal, normal);
        se3di_contact_point *p =
            se3di_manifold_add(manifold, point, normal, overlap, faces * 1024u + from->id[k]);
        bend_incident(incident, radius, flip ? &p->bend_i : &p->bend_j);
    }
}

static void axis_of(const se3di_solid *solid, int a, double out[3])
{
    out[0] = solid->at->R[a];
    out[1] = solid->at->R[3 + a];
    out[2] = solid->at->R[6 + a];
}

/* Half the extent of a box along n. */
static double extent(const se3di_solid *box, const double n[3])
{
    double local[3];
    se3di_mul_transposed(box->at->R, n, local);
    return fabs(local[0]) * box->shape->half[0] + fabs(local[1]) * box->shape->half[1] +
           fabs(local[2]) * box->shape->half[2];
}

typedef struct separation {
    double depth; /* least translation along n */
    double n[3];  /* from i to j */
    int a, b;     /* axes */
} separation;

/* The overlap along an axis; the least one is kept. */
static void try_axis(const se3di_solid *i, const se3di_solid *j, const double axis[3], int a, int b,
                     separation *best)
{
    double d[3];
    se3di_sub(j->at->x, i->at->x, d);
    double along = se3di_dot(d, axis);
    double depth = extent(i, axis) + extent(j, axis) - fabs(along);
    if (depth < best->depth) {
        best->depth = depth;
        best->a = a;
        best->b = b;
        se3di_scale(along < 0.0 ? -1.0 : 1.0, axis, best->n);
    }
}

/* The middle of the edge along axis a that is farthest along n. */
static void edge_middle(const se3di_solid *box, const double n[3], int a, double out[3])
{
    se3di_copy(box->at->x, out);
    for (int c = 0; c < 3; ++c) {
        double axis[3];
        axis_of(box, c, axis);
        double side = se3di_dot(axis, n) < 0.0 ? -1.0 : 1.0;
        se3di_add_scaled(c == a ? 0.0 : side * box->shape->half[c], axis, out);
    }
}

/* Parameters of the nearest points of two lines p + s u, q + t w (unit, not parallel). */
static void nearest_of_lines(const double p[3], const double u[3], const double q[3],
                             const double w[3], double *s, double *t)
{
    double d[3];
    se3di_sub(q, p, d);
    double c = se3di_dot(u, w);
    double du = se3di_dot(d, u);
    double dw = se3di_dot(d, w);
    double square = fmax(1.0 - c * c, 1e-300);
    *s = (du - c * dw) / square;
    *t = (c * du - dw) / square;
}

static void edges_touch(const se3di_solid *i, const se3di_solid *j, const separation *best,
                        se3di_manifold *manifold)
{
    double p[3], q[3], u[3], w[3], back[3], point[3], s, t;
    se3di_scale(-1.0, best->n, back);
    edge_middle(i, best->n, best->a, p);
    edge_middle(j, back, best->b, q);
    axis_of(i, best->a, u);
    axis_of(j, best->b, w);
    nearest_of_lines(p, u, q, w, &s, &t);
    se3di_add_scaled(s, u, p);
    se3di_add_scaled(t, w, q);
    se3di_add(p, q, point);
    se3di_scale(0.5, point, point);
    se3di_contact_point *c = se3di_manifold_add(manifold, point, best->n, best->depth,
                                                0x40000000u + (uint32_t)(3 * best->a + best->b));
    se3di_bend_set(&c->bend_i, u, HUGE_VAL, 0.0);
    se3di_bend_set(&c->bend_j, w, HUGE_VAL, 0.0);
}

static void faces_touch(const se3di_solid *i, const se3di_solid *j, const double n[3], int flip,
                        se3di_manifold *manifold)
{
    se3di_face reference, incident;
    double back[3];
    se3di_scale(-1.0, n, back);
    se3di_face_find(flip ? j : i, flip ? back : n, &reference);
    se3di_face_find(flip ? i : j, flip ? n : back, &incident);
    se3di_narrow_clip(&reference, &incident, se3di_core_radius(flip ? i->shape : j->shape), flip,
                      manifold);
}

/* Separating axes: three faces of each, nine pairs of edges. */
void se3di_narrow_boxes(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    separation face_i = {.depth = HUGE_VAL}, face_j = face_i, edge = face_i;
    for (int a = 0; a < 3; ++a) {
        double u[3], w[3], axis[3];
        axis_of(i, a, u);
        try_axis(i, j, u, a, 0, &face_i);
        axis_of(j, a, w);
        try_axis(i, j, w, 0, a, &face_j);
        for (int b = 0; b < 3; ++b) {
            axis_of(j, b, w);
            se3di_cross(u, w, axis);
            double size = se3di_norm(axis);
            if (size > 1e-6) {
                se3di_scale(1.0 / size, axis, axis);
                try_axis(i, j, axis, a, b, &edge);
            }
        }
    }
    double least = fmin(face_i.depth, face_j.depth);
    if (!(least > 0.0) || !(edge.depth > 0.0)) {
        return;
    }
    if (edge.depth < EDGE_FACTOR * least) {
        edges_touch(i, j, &edge, manifold);
        return;
    }
    int flip = face_j.depth < OTHER_FACTOR * face_i.depth;
    faces_touch(i, j, flip ? face_j.n : face_i.n, flip, manifold);
}

/* Two lines with radii: a point of each, if they are near enough. */
static void points_touch(const double p[3], const double q[3], const double radius[2],
                         const double fallback[3], uint32_t feature, se3di_manifold *manifold)
{
    double n[3], point[3];
    se3di_sub(q, p, n);
    double distance = se3di_norm(n);
    double overlap = radius[0] + radius[1] - distance;
    if (!(overlap > 0.0)) {
        return;
    }
    if (distance > 0.0) {
        se3di_scale(1.0 / distance, n, n);
    } else {
        se3di_copy(fallback, n);
    }
    se3di_copy(p, point);
    se3di_add_scaled(radius[0] - 0.5 * overlap, n, point);
    se3di_contact_point *c = se3di_manifold_add(manifold, point, n, overlap, feature);
    c->bend_i.r[0] = c->bend_i.r[1] = radius[0];
    c->bend_j.r[0] = c->bend_j.r[1] = radius[1];
}

static double clamp(double x, double half)
{
    return fmax(-half, fmin(half, x));
}

/* The nearest points of two segments (Ericson 2005, section 5.1.9): parameters s and t. */
static void nearest_of_segments(const double p[3], const double u[3], double half_p,
                                const double q[3], const double w[3], double half_q, double *s,
                                double *t)
{
    double d[3];
    se3di_sub(q, p, d);
    double c = se3di_dot(u, w);
    nearest_of_lines(p, u, q, w, s, t);
    if (1.0 - c * c < 1e-12) {
        *s = se3di_dot(d, u);
    }
    *s = clamp(*s, half_p);
    *t = clamp(c * *s - se3di_dot(d, w), half_q);
    *s = clamp(se3di_dot(d, u) + c * *t, half_p);
}

static void bend_line(const se3di_solid *solid, double at, const double u[3], se3di_bend *bend)
{
    if (fabs(at) < solid->shape->half_length) {
        se3di_bend_set(bend, u, HUGE_VAL, bend->r[1]);
    }
}

/* Whether the surface about that point of the axis is that of a capsule. */
static int is_round(const se3di_solid *solid, double at)
{
    return solid->shape->kind != SE3DI_SHAPE_CYLINDER || fabs(at) < solid->shape->half_length;
}

/* The places of contact along two axes: one, or the two ends of the common part of nearly parallel
 * ones. Returns their number. */
static int axes_meet(const se3di_solid *i, const se3di_solid *j, const double u[3],
                     const double w[3], double s[2], double t[2])
{
    double d[3], across[3];
    se3di_cross(u, w, across);
    se3di_sub(j->at->x, i->at->x, d);
    double middle = se3di_dot(d, u);
    double low = fmax(-i->shape->half_length, middle - j->shape->half_length);
    double high = fmin(i->shape->half_length, middle + j->shape->half_length);
    if (!(se3di_norm(across) < PARALLEL && high > low)) {
        nearest_of_segments(i->at->x, u, i->shape->half_length, j->at->x, w, j->shape->half_length,
                            &s[0], &t[0]);
        return 1;
    }
    for (int k = 0; k < 2; ++k) {
        s[k] = k ? high : low;
        t[k] = clamp(se3di_dot(u, w) * s[k] - se3di_dot(d, w), j->shape->half_length);
    }
    return 2;
}

int se3di_narrow_capsules(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    const double radius[2] = {i->shape->radius, j->shape->radius};
    double u[3], w[3], across[3], s[2], t[2];
    axis_of(i, 2, u);
    axis_of(j, 2, w);
    int count = axes_meet(i, j, u, w, s, t);
    if (count == 1 && !(is_round(i, s[0]) && is_round(j, t[0]))) {
        return 0;
    }
    se3di_cross(u, w, across);
    double sine = se3di_norm(across);
    if (!(sine > 1e-6)) {
        se3di_perpendicular(u, across);
    } else {
        se3di_scale(1.0 / sine, across, across);
    }
    for (int k = 0; k < count; ++k) {
        double p[3], q[3];
        se3di_copy(i->at->x, p);
        se3di_copy(j->at->x, q);
        se3di_add_scaled(s[k], u, p);
        se3di_add_scaled(t[k], w, q);
        uint32_t before = manifold->count;
        points_touch(p, q, radius, across, count > 1 ? (uint32_t)k + 1u : 0u, manifold);
        if (manifold->count > before) {
            se3di_contact_point *c = &manifold->points[before];
            bend_line(i, s[k], u, &c->bend_i);
            bend_line(j, t[k], w, &c->bend_j);
        }
    }
    return 1;
}

/* A deepest pair of points if there is no face. */
static void cores_touch(const se3di_solid *i, const se3di_solid *j, const double n[3],
                        const double on_i[3], const double on_j[3], double overlap,
                        se3di_manifold *manifold)
{
    double p[3], q[3], point[3];
    double radius[2] = {se3di_core_radius(i->shape), se3di_core_radius(j->shape)};
    se3di_copy(on_i, p);
    se3di_copy(on_j, q);
    se3di_add_scaled(radius[0], n, p);
    se3di_add_scaled(-radius[1], n, q);
    se3di_add(p, q, point);
    se3di_scale(0.5, point, point);
    (void)se3di_manifold_add(manifold, point, n, overlap, 0);
}

/* How deep the cores overlap along the normal of a face that looks nearly along n; infinite if
 * it does not. sign: 1 for a face of i, -1 for one of j. */
static double depth_on(const se3di_face *face, const double n[3], const se3di_solid *i,
                       const se3di_solid *j, double sign)
{
    double along[3], back[3], on_i[3], on_j[3], d[3];
    if (face->count <= 2 || !(se3di_dot(face->normal, n) > FACE_COSINE)) {
        return HUGE_VAL;
    }
    se3di_scale(sign, face->normal, along);
    se3di_scale(-1.0, along, back);
    se3di_core_support(i, along, on_i);
    se3di_core_support(j, back, on_j);
    se3di_sub(on_i, on_j, d);
    return se3di_dot(d, along);
}

void se3di_narrow_convex(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    double n[3], back[3], on_i[3], on_j[3];
    se3di_face face_i, face_j;
    double radius = se3di_core_radius(i->shape) + se3di_core_radius(j->shape);
    double overlap = radius + se3di_convex_distance(i, j, n, on_i, on_j);
    if (!(overlap > 0.0)) {
        return;
    }
    se3di_scale(-1.0, n, back);
    se3di_face_find(i, n, &face_i);
    se3di_face_find(j, back, &face_j);
    double depth_i = depth_on(&face_i, n, i, j, 1.0) + radius;
    double depth_j = depth_on(&face_j, back, i, j, -1.0) + radius;
    if (overlap < radius) { /* the cores are apart: n is the way between their nearest points */
        depth_i = se3di_dot(face_i.normal, n) > FLAT_COSINE ? depth_i : HUGE_VAL;
        depth_j = se3di_dot(face_j.normal, back) > FLAT_COSINE ? depth_j : HUGE_VAL;
    }
    int edges_i = overlap < EDGE_FACTOR * depth_i;
    int edges_j = overlap < EDGE_FACTOR * depth_j;
    if (!edges_i && !(depth_j < OTHER_FACTOR * depth_i)) {
        se3di_narrow_clip(&face_i, &face_j, radius, 0, manifold);
    } else if (!edges_j) {
        se3di_narrow_clip(&face_j, &face_i, radius, 1, manifold);
    } else if (face_i.count == 2 && face_j.count == 2 && se3di_narrow_capsules(i, j, manifold)) {
        return;
    }
    double deepest = 0.0;
    for (uint32_t k = 0; k < manifold->count; ++k) {
        deepest = fmax(deepest, manifold->points[k].overlap);
    }
    if (!(deepest > (overlap < radius ? 0.999 : 0.5) * overlap)) {
        manifold->count = 0;
        cores_touch(i, j, n, on_i, on_j, overlap, manifold);
    }
}
