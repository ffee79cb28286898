/* SPDX-License-Identifier: BSD-3-Clause */
/* Points of contact of two convex shapes, along the direction in which they come apart first.
 *
 * All points of a pair have that normal, and their overlaps are measured along it: those of flat
 * parts that lean little from it where the other part is cut off at the sides. Only those of two
 * round sides, or of one and an edge, at the ends of what they have in common, have their own.
 * Directions that differ little, as those of two faces that lie on each other and of their edges,
 * so give nearly the same points, and the least overlap is never left for another one. */
#include "contact/narrow/internal.h"
#include "math/vec3.h"

#include <math.h>

#define FACE_COSINE 0.985 /* faces leaning by less than 10 degrees from the normal */
#define PARALLEL    1e-2  /* sine below which two lines touch in two points */
#define LOSS        0.5   /* of the overlap: by how much it is less at these if the lines cross */
#define SAME        2e-15 /* of the size: depths that are one; faces come before edges then */
#define EXACT       1e-9  /* the normal is that of a face */
#define LIFT        1e-5  /* of the size: by how much points of a round rim are too shallow */
#define SKEW        1e-8  /* sine; edges that are more nearly parallel have no product */
#define CERTAIN     1e-12 /* of the size: boxes that are apart by more are */
#define ASKEW       0.999 /* cosine; edges that are so, or less parallel have a product */
#define WITNESS     0x20000001u
#define EDGE        4u /* features of the points on an edge are its number times this, and more */
#define EDGES       0x40000000u /* features of edges, by their axes */

/* How two shapes come apart. */
typedef struct parting {
    const se3di_solid *i, *j;
    double n[3]; /* from i to j */
    double depth, radius;
    double on_i[3], on_j[3]; /* the points of the cores that are farthest in each other */
    int edges;               /* of two boxes: the axes of the edges, or -1 */
    int axis_i, axis_j;
} parting;

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
        se3di_solid_axis(box, c, axis);
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

/* How the surface of a shape with an axis bends where its side is touched, or its round end. */
static void bend_side(const se3di_solid *solid, const double n[3], se3di_bend *bend)
{
    const se3di_shape *s = solid->shape;
    double u[3];
    if (se3di_shape_class_of(s)->lines != SE3DI_AXES_Z) {
        return;
    }
    se3di_solid_axis(solid, 2, u);
    if (fabs(se3di_dot(u, n)) < EXACT) {
        se3di_bend_set(bend, u, HUGE_VAL, s->radius);
    } else if (se3di_shape_is(s, SE3DI_SHAPE_IS_SWEPT)) {
        bend->r[0] = bend->r[1] = s->radius;
    }
}

/* One is smooth: how the other bends at what is nearest to a place beyond its surface, an edge or a
 * corner too, and the smooth one at its own. */
static void bend_beyond(const se3di_solid *solid, const double surface[3], const double out[3],
                        se3di_bend *bend)
{
    double x[3], local[3];
    se3di_copy(surface, x);
    if (!se3di_solid_is_smooth(solid)) {
        se3di_add_scaled(solid->shape->bound, out, x);
    }
    se3di_solid_to_local(solid, x, local);
    se3di_solid_bend(solid, local, bend);
}

/* The one point where there is neither a face nor a line. */
static void point_touches(const parting *p, uint32_t feature, se3di_manifold *manifold)
{
    double a[3], b[3], point[3];
    se3di_copy(p->on_i, a);
    se3di_copy(p->on_j, b);
    se3di_add_scaled(se3di_core_radius(p->i->shape), p->n, a);
    se3di_add_scaled(-se3di_core_radius(p->j->shape), p->n, b);
    se3di_add(a, b, point);
    se3di_scale(0.5, point, point);
    se3di_contact_point *c = se3di_manifold_add(manifold, point, p->n, p->depth, feature);
    if (p->edges) {
        double u[3], w[3];
        c->feature += EDGES + (uint32_t)(3 * p->axis_i + p->axis_j);
        se3di_solid_axis(p->i, p->axis_i, u);
        se3di_solid_axis(p->j, p->axis_j, w);
        se3di_bend_set(&c->bend_i, u, HUGE_VAL, 0.0);
        se3di_bend_set(&c->bend_j, w, HUGE_VAL, 0.0);
        return;
    }
    if (se3di_solid_is_smooth(p->i) || se3di_solid_is_smooth(p->j)) {
        double back[3];
        se3di_scale(-1.0, p->n, back);
        bend_beyond(p->i, a, p->n, &c->bend_i);
        bend_beyond(p->j, b, back, &c->bend_j);
        return;
    }
    bend_side(p->i, p->n, &c->bend_i);
    bend_side(p->j, p->n, &c->bend_j);
}

/* Two lines that touch along what they have in common: axes of round sides, or one and an edge. */
typedef struct lines {
    double a[3], b[3];     /* their beginnings */
    double u[3], w[3];     /* unit */
    double long_a, long_b; /* lengths */
    double r_a, r_b;       /* radii, of an edge 0 */
    uint32_t feature;      /* which edge it is, 0: none */
    double low, high;      /* what they have in common, along a */
    double from, to;       /* where b begins and ends, seen along a */
} lines;

static double axis_of(const se3di_solid *solid, double begin[3], double u[3])
{
    const double half = solid->shape->half_length;
    se3di_solid_axis(solid, 2, u);
    se3di_copy(solid->at->x, begin);
    se3di_add_scaled(-half, u, begin);
    return 2.0 * half;
}

/* The edge of a face that is farthest along n. */
static double edge_of(const se3di_face *face, const double n[3], double begin[3], double u[3],
                      uint32_t *feature)
{
    double farthest = -HUGE_VAL;
    int edge = 0;
    for (int k = 0; k < face->count; ++k) {
        const double *next = face->corner[(k + 1) % face->count];
        const double along = se3di_dot(face->corner[k], n) + se3di_dot(next, n);
        edge = along > farthest ? k : edge;
        farthest = fmax(along, farthest);
    }
    se3di_copy(face->corner[edge], begin);
    se3di_sub(face->corner[(edge + 1) % face->count], begin, u);
    const double length = se3di_norm(u);
    se3di_scale(length > 0.0 ? 1.0 / length : 0.0, u, u);
    *feature = EDGE * (1u + face->id * SE3DI_FACE_CORNERS + (uint32_t)edge);
    return length;
}

/* The lines of a round side and of another one, or of an edge that n is across. Returns 0 if there
 * are none. */
static int find_lines(const parting *p, const se3di_face *face_i, const se3di_face *face_j,
                      lines *l)
{
    const int is_axis_i = face_i->count == 2, is_axis_j = face_j->count == 2;
    const se3di_solid *other = is_axis_i ? p->j : p->i;
    const int is_edge = (is_axis_i ? face_j : face_i)->count > 2 && !se3di_solid_has_rims(other);
    if (!(is_axis_i || is_axis_j) || !(is_edge || (is_axis_i && is_axis_j))) {
        return 0;
    }
    double back[3];
    se3di_scale(-1.0, p->n, back);
    l->feature = 0;
    l->r_a = is_axis_i ? p->i->shape->radius : 0.0;
    l->r_b = is_axis_j ? p->j->shape->radius : 0.0;
    l->long_a =
        is_axis_i ? axis_of(p->i, l->a, l->u) : edge_of(face_i, p->n, l->a, l->u, &l->feature);
    l->long_b =
        is_axis_j ? axis_of(p->j, l->b, l->w) : edge_of(face_j, back, l->b, l->w, &l->feature);
    return 1;
}

/* Returns 0 if they cross at an angle, or lie end to end. If they cross nearly parallel, the
 * overlap falls off to either side. */
static int lines_meet(const parting *p, lines *l)
{
    double across[3], d[3];
    se3di_cross(l->u, l->w, across);
    if (!(se3di_norm(across) < PARALLEL && fabs(se3di_dot(l->u, p->n)) < PARALLEL)) {
        return 0;
    }
    se3di_sub(l->b, l->a, d);
    l->from = se3di_dot(d, l->u);
    l->to = l->from + l->long_b * se3di_dot(l->w, l->u);
    const double round = l->r_a + l->r_b;
    const double turn = fabs(se3di_dot(across, p->n));
    const double far = sqrt(2.0 * LOSS * p->depth * round);
    l->low = fmax(0.0, fmin(l->from, l->to));
    l->high = fmin(l->long_a, fmax(l->from, l->to));
    const int meet = l->high > l->low;
    if (far < turn * l->long_a) {
        se3di_sub(p->on_i, l->a, d);
        l->low = fmax(l->low, se3di_dot(d, l->u) - far / turn);
        l->high = fmin(l->high, se3di_dot(d, l->u) + far / turn);
    }
    return meet && l->high > l->low;
}

/* The foot of a place on a line. */
static void foot_on(const double begin[3], const double u[3], const double x[3], double foot[3])
{
    double d[3];
    se3di_sub(x, begin, d);
    se3di_copy(begin, foot);
    se3di_add_scaled(se3di_dot(d, u), u, foot);
}

/* A place of the one line, `t` along a, and its foot on the other: of an end of b that on a. */
static void find_pair(const lines *l, double t, double on_a[3], double on_b[3])
{
    if (t == l->from || t == l->to) {
        se3di_copy(l->b, on_b);
        se3di_add_scaled(t == l->from ? 0.0 : l->long_b, l->w, on_b);
        foot_on(l->a, l->u, on_b, on_a);
    } else {
        se3di_copy(l->a, on_a);
        se3di_add_scaled(t, l->u, on_a);
        foot_on(l->b, l->w, on_a, on_b);
    }
}

static void bend_along(const double axis[3], double radius, const double n[3], se3di_bend *bend)
{
    double u[3];
    se3di_copy(axis, u);
    se3di_add_scaled(-se3di_dot(axis, n), n, u);
    se3di_scale(1.0 / se3di_norm(u), u, u);
    se3di_bend_set(bend, u, HUGE_VAL, radius);
}

/* Both points have normals of their own, from axis to axis. The least translation of two that are
 * parallel but for little has the normal of the one end or of the other: logs that lie on each
 * other would be pushed to and fro, and not come to rest. The deeper one is as deep as the two. */
static void lines_touch(const parting *p, const lines *l, se3di_manifold *manifold)
{
    double x[2][3], n[2][3], overlap[2];
    for (int k = 0; k < 2; ++k) {
        double q[3];
        find_pair(l, k ? l->high : l->low, x[k], q);
        se3di_sub(q, x[k], n[k]);
        const double distance = se3di_norm(n[k]);
        if (!(se3di_dot(n[k], p->n) > FACE_COSINE * distance)) {
            return;
        }
        se3di_scale(1.0 / distance, n[k], n[k]);
        overlap[k] = l->r_a + l->r_b - distance;
    }
    const double more = p->depth - fmax(overlap[0], overlap[1]);
    for (uint32_t k = 0; k < 2; ++k) {
        overlap[k] += more;
        if (overlap[k] > 0.0) {
            se3di_add_scaled(l->r_a - 0.5 * overlap[k], n[k], x[k]);
            se3di_contact_point *c =
                se3di_manifold_add(manifold, x[k], n[k], overlap[k], l->feature + k + 1u);
            bend_along(l->u, l->r_a, n[k], &c->bend_i);
            bend_along(l->w, l->r_b, n[k], &c->bend_j);
        }
    }
}

/* Points of a face's sides turn with the shape whose normal it is. */
static void bend_points(const parting *p, const se3di_face *face_i, const se3di_face *face_j,
                        se3di_manifold *manifold)
{
    double turn[3];
    se3di_sub(face_i->normal, p->n, turn);
    const int of_i = face_i->count > 2 && se3di_norm(turn) < EXACT;
    se3di_add(face_j->normal, p->n, turn);
    const int of_j = face_j->count > 2 && se3di_norm(turn) < EXACT;
    for (uint32_t k = 0; k < manifold->count && (of_i || of_j); ++k) {
        static const double flat = HUGE_VAL;
        se3di_contact_point *c = &manifold->points[k];
        se3di_bend *own = of_i ? &c->bend_i : &c->bend_j;
        own->r[0] = own->r[1] = flat;
        se3di_face_bend(of_i ? face_j : face_i, p->radius, of_i ? &c->bend_j : &c->bend_i);
    }
}

/* How much less far the corners of a face reach than the solid: those that stand for a rim. */
static double bulge_of(const se3di_solid *solid, const double n[3], const se3di_face *face)
{
    double farthest[3], d[3], least = HUGE_VAL;
    if (!se3di_solid_has_rims(solid) || face->count < 3) {
        return 0.0;
    }
    se3di_core_support(solid, n, farthest);
    for (int k = 0; k < face->count; ++k) {
        se3di_sub(farthest, face->corner[k], d);
        least = fmin(least, se3di_dot(d, n));
    }
    return fmax(least, 0.0);
}

/* No point is deeper than the two are, and one is as deep, but for bulges. */
static void complete(const parting *p, double bulge, se3di_manifold *manifold)
{
    const double size = p->i->shape->bound + p->j->shape->bound;
    double deepest = 0.0;
    for (uint32_t k = 0; k < manifold->count; ++k) {
        se3di_contact_point *c = &manifold->points[k];
        c->overlap = fmin(c->overlap, p->depth);
        deepest = fmax(deepest, c->overlap + bulge);
    }
    const double gap = fmax(p->depth - deepest, 0.0);
    if (manifold->count == 0 || gap > LIFT * size) {
        point_touches(p, manifold->count > 0 ? WITNESS : 0, manifold);
        return;
    }
    for (uint32_t k = 0; k < manifold->count; ++k) {
        manifold->points[k].overlap += gap;
    }
}

/* The part of a solid that looks along n best; a cap as it lies at the depth of the two. */
static void find_face(const parting *p, const se3di_solid *solid, const double n[3],
                      se3di_face *face)
{
    se3di_face_find(solid, n, face);
    if (se3di_solid_has_rims(solid) && face->count > 2) {
        se3di_cap_find(solid, n, p->depth, face);
    }
}

static void touch(const parting *p, se3di_manifold *manifold)
{
    se3di_face face_i, face_j;
    double back[3];
    lines both;
    if (se3di_solid_is_smooth(p->i) || se3di_solid_is_smooth(p->j)) {
        point_touches(p, 0, manifold);
        return;
    }
    se3di_scale(-1.0, p->n, back);
    find_face(p, p->i, p->n, &face_i);
    find_face(p, p->j, back, &face_j);
    const int flat_i = face_i.count > 2 && se3di_dot(face_i.normal, p->n) > FACE_COSINE;
    const int flat_j = face_j.count > 2 && se3di_dot(face_j.normal, back) > FACE_COSINE;
    if (flat_i) {
        se3di_narrow_clip(&face_i, &face_j, p->n, p->radius, p->depth, 0, manifold);
    } else if (flat_j) {
        se3di_narrow_clip(&face_j, &face_i, back, p->radius, p->depth, 1, manifold);
    } else if (find_lines(p, &face_i, &face_j, &both) && lines_meet(p, &both)) {
        lines_touch(p, &both, manifold);
    }
    if (flat_i || flat_j) {
        bend_points(p, &face_i, &face_j, manifold);
    }
    complete(p, bulge_of(p->i, p->n, &face_i) + bulge_of(p->j, back, &face_j), manifold);
}

/* The nearest points of the edges that cross. */
static void find_crossing(const separation *best, parting *p)
{
    double u[3], w[3], back[3], s, t;
    se3di_scale(-1.0, p->n, back);
    edge_middle(p->i, p->n, best->a, p->on_i);
    edge_middle(p->j, back, best->b, p->on_j);
    se3di_solid_axis(p->i, best->a, u);
    se3di_solid_axis(p->j, best->b, w);
    nearest_of_lines(p->on_i, u, p->on_j, w, &s, &t);
    se3di_add_scaled(s, u, p->on_i);
    se3di_add_scaled(t, w, p->on_j);
    p->edges = 1;
    p->axis_i = best->a;
    p->axis_j = best->b;
}

/* Of a face: the lowest corner of the other box. */
static void find_corner(int of_j, parting *p)
{
    double back[3];
    se3di_scale(-1.0, p->n, back);
    if (of_j) {
        se3di_core_support(p->i, p->n, p->on_i);
        se3di_copy(p->on_i, p->on_j);
        se3di_add_scaled(-p->depth, p->n, p->on_j);
    } else {
        se3di_core_support(p->j, back, p->on_j);
        se3di_copy(p->on_j, p->on_i);
        se3di_add_scaled(p->depth, p->n, p->on_i);
    }
}

/* What the boxes' own axes are to each other: R_ab = u_a . w_b, and the way between the centres in
 * the frames of both. */
typedef struct frames {
    double R[3][3], size[3][3]; /* size: |R_ab| */
    double along_i[3], along_j[3];
} frames;

static void compare_frames(const se3di_solid *i, const se3di_solid *j, frames *f)
{
    double d[3];
    se3di_sub(j->at->x, i->at->x, d);
    se3di_mul_transposed(i->at->R, d, f->along_i);
    se3di_mul_transposed(j->at->R, d, f->along_j);
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
            const double *u = i->at->R + a, *w = j->at->R + b;
            f->R[a][b] = u[0] * w[0] + u[3] * w[3] + u[6] * w[6];
            f->size[a][b] = fabs(f->R[a][b]);
        }
    }
}

/* Whether two boxes are apart for certain, quickly: along a face's normal or a product of edges by
 * more than rounding. */
static int are_boxes_apart(const se3di_solid *i, const se3di_solid *j)
{
    const double *p = i->shape->half, *q = j->shape->half;
    const double slack = CERTAIN * (i->shape->bound + j->shape->bound);
    frames f;
    compare_frames(i, j, &f);
    for (int a = 0; a < 3; ++a) {
        const double *s = f.size[a];
        const double reach_i = p[a] + q[0] * s[0] + q[1] * s[1] + q[2] * s[2];
        const double reach_j =
            q[a] + p[0] * f.size[0][a] + p[1] * f.size[1][a] + p[2] * f.size[2][a];
        if (fabs(f.along_i[a]) > reach_i + slack || fabs(f.along_j[a]) > reach_j + slack) {
            return 1;
        }
    }
    for (int a = 0; a < 3; ++a) {
        const int a1 = (a + 1) % 3, a2 = (a + 2) % 3;
        for (int b = 0; b < 3; ++b) {
            const int b1 = (b + 1) % 3, b2 = (b + 2) % 3;
            const double along = f.along_i[a2] * f.R[a1][b] - f.along_i[a1] * f.R[a2][b];
            const double reach = p[a1] * f.size[a2][b] + p[a2] * f.size[a1][b] +
                                 q[b1] * f.size[a][b2] + q[b2] * f.size[a][b1];
            if (f.size[a][b] < ASKEW && fabs(along) > reach + slack) {
                return 1;
            }
        }
    }
    return 0;
}

/* Separating axes: three faces of each, nine pairs of edges. */
void se3di_narrow_boxes(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    if (are_boxes_apart(i, j)) {
        return;
    }
    separation face_i = {.depth = HUGE_VAL}, face_j = face_i, edge = face_i;
    for (int a = 0; a < 3; ++a) {
        double u[3], w[3], axis[3];
        se3di_solid_axis(i, a, u);
        try_axis(i, j, u, a, 0, &face_i);
        se3di_solid_axis(j, a, w);
        try_axis(i, j, w, 0, a, &face_j);
        for (int b = 0; b < 3; ++b) {
            se3di_solid_axis(j, b, w);
            se3di_cross(u, w, axis);
            double size = se3di_norm(axis);
            if (size > SKEW) {
                se3di_scale(1.0 / size, axis, axis);
                try_axis(i, j, axis, a, b, &edge);
            }
        }
    }
    const double same = SAME * (i->shape->bound + j->shape->bound);
    const int of_j = face_j.depth < face_i.depth - same;
    const separation *least = of_j ? &face_j : &face_i;
    const int edges = edge.depth < least->depth - same;
    least = edges ? &edge : least;
    if (!(least->depth > 0.0)) {
        return;
    }
    parting p = {.i = i, .j = j, .depth = least->depth};
    se3di_copy(least->n, p.n);
    if (edges) {
        find_crossing(least, &p);
    } else {
        find_corner(of_j, &p);
    }
    touch(&p, manifold);
}

void se3di_narrow_convex(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    parting p = {.i = i, .j = j};
    p.radius = se3di_core_radius(i->shape) + se3di_core_radius(j->shape);
    p.depth = se3di_convex_least(i, j, 0.0, p.n, p.on_i, p.on_j);
    if (p.depth > 0.0) {
        touch(&p, manifold);
    }
}
