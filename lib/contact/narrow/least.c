/* SPDX-License-Identifier: BSD-3-Clause */
/* The least translation that separates two convex shapes, to rounding.
 *
 * For polyhedra and lines the walk and the polytope of convex.c end exactly. Against round shapes
 * they come near, and what follows is exact:
 *
 * - Cylinders that overlap: h(n) = h_i(n) + h_j(-n) is least at a face or cap, at a product of an
 *   edge with the axis, on the circle of directions perpendicular to an edge (or to the axis) where
 *   its slope changes its sign, or, of two rims, where the nearest points v = a - b lie along n:
 *
 *       (v - (n.v) n) = 0,   Newton:  U^T (dv/dn - (n.v) 1) U x = -U^T v.
 *
 * - A smooth shape and any: the same equation, or the circle of an edge, or a face, also apart.
 *   Those near the polytope's direction are tried, the least is taken. */
#include "contact/narrow/bracket.h"
#include "contact/narrow/internal.h"
#include "math/elementary.h"
#include "math/over.h"
#include "math/vec3.h"

#include <math.h>

#define NEAR    3e-2  /* rad; the polytope's direction is that good */
#define TIE     1e-15 /* of the size: of equal directions the first */
#define CORNER  1e-3  /* of the size: a slope on either side of a corner of the overlap */
#define LOOSE   1e-11 /* of the size: by how much the polytope's own may be less */
#define EDGES   12
#define SLIGHT  1e-4 /* sine; lines that are more nearly parallel cross nowhere in particular */
#define SKEW    1e-9 /* sine; edges that are more nearly parallel have no product */
#define NEWTONS 30
#define SHORTER 20
#define LAST    1e-6  /* rad; steps so small are taken as they are */
#define DONE    1e-12 /* rad; the step after is below rounding */
#define FLAT    1e-6  /* of the size: a curvature below which the overlap is not convex */

/* Of a solid the edges that are nearly perpendicular to a direction, unit, and the squares of their
 * distances from the place of contact. */
typedef struct near_edges {
    int count;
    double edge[EDGES][3], square[EDGES];
} near_edges;

typedef struct search {
    const se3di_solid *i, *j;
    double size;
    double about[3]; /* near which */
    double least, n[3];
    double a[3], b[3]; /* the points of the two that are farthest in each other */
    near_edges of_i, of_j;
} search;

/* h(n); v: the difference of the farthest points. */
static double overlap_along(const search *s, const double n[3], double v[3])
{
    double back[3], on_i[3], on_j[3];
    se3di_scale(-1.0, n, back);
    se3di_core_support(s->i, n, on_i);
    se3di_core_support(s->j, back, on_j);
    se3di_sub(on_i, on_j, v);
    return se3di_dot(v, n);
}

/* Returns whether the overlap along it is less than all before. */
static int try_direction(search *s, const double direction[3])
{
    const double size = se3di_norm(direction);
    if (!(size > 0.0)) {
        return 0;
    }
    double n[3], turn[3], v[3];
    const double sign = se3di_dot(direction, s->about) < 0.0 ? -1.0 : 1.0;
    se3di_scale(sign / size, direction, n);
    se3di_sub(n, s->about, turn);
    if (se3di_norm(turn) > NEAR) {
        return 0;
    }
    const double here = overlap_along(s, n, v);
    if (!(here < s->least - TIE * s->size)) {
        return 0;
    }
    s->least = here;
    se3di_copy(n, s->n);
    return 1;
}

/* A face or line of the one, of j or of i, is touched at the lowest point of the other. */
static void touch_lowest(search *s, int of_j)
{
    double back[3];
    se3di_scale(-1.0, s->n, back);
    if (of_j) {
        se3di_core_support(s->i, s->n, s->a);
        se3di_copy(s->a, s->b);
        se3di_add_scaled(-s->least, s->n, s->b);
    } else {
        se3di_core_support(s->j, back, s->b);
        se3di_copy(s->b, s->a);
        se3di_add_scaled(s->least, s->n, s->a);
    }
}

/* Two lines through the lowest points of the two touch where they cross. */
static void touch_crossing(search *s, const double e[3], const double f[3])
{
    double back[3], p[3], q[3], d[3], across[3], moment[3];
    se3di_cross(e, f, across);
    const double square = se3di_dot(across, across);
    if (square < SLIGHT * SLIGHT) {
        return; /* about parallel: the points that were found before */
    }
    se3di_scale(-1.0, s->n, back);
    se3di_core_support(s->i, s->n, p);
    se3di_core_support(s->j, back, q);
    se3di_sub(q, p, d);
    se3di_cross(d, f, moment);
    se3di_add_scaled(se3di_dot(moment, across) / square, e, p);
    se3di_copy(p, s->a);
    se3di_copy(p, s->b);
    se3di_add_scaled(-s->least, s->n, s->b);
}

/* Of many the nearest are kept. */
static void add_edge(near_edges *list, const double about[3], const double e[3], double square)
{
    const double size = se3di_norm(e);
    if (!(size > 0.0 && fabs(se3di_dot(e, about)) < NEAR * size)) {
        return;
    }
    int at = list->count;
    if (at == EDGES) {
        at = 0;
        for (int k = 1; k < EDGES; ++k) {
            at = list->square[k] > list->square[at] ? k : at;
        }
        if (!(square < list->square[at])) {
            return;
        }
    }
    se3di_scale(1.0 / size, e, list->edge[at]);
    list->square[at] = square;
    list->count += at == list->count;
}

/* Sides of the faces that are about as far along `way` as anything of the hull; x: the place of
 * contact. */
static void add_hull_edges(const se3di_solid *solid, const double way[3], const double x[3],
                           near_edges *list)
{
    const se3di_shape *shape = solid->shape;
    double local[3], at[3], arm[3], most = -HUGE_VAL;
    se3di_mul_transposed(solid->at->R, way, local);
    se3di_sub(x, solid->at->x, arm);
    se3di_mul_transposed(solid->at->R, arm, at);
    for (size_t k = 0; k < shape->vertex_count; ++k) {
        most = fmax(most, se3di_dot(shape->vertices + 3 * k, local));
    }
    for (size_t k = 0; k < 3 * shape->triangle_count; ++k) {
        const uint32_t *t = shape->triangles + k / 3 * 3;
        const double *a = shape->vertices + 3 * (size_t)t[k % 3];
        const double *b = shape->vertices + 3 * (size_t)t[(k + 1) % 3];
        const double level = most - NEAR * shape->bound;
        double d[3], e[3], from[3];
        if (t[k % 3] < t[(k + 1) % 3] && se3di_dot(a, local) > level &&
            se3di_dot(b, local) > level) {
            se3di_sub(b, a, d);
            se3di_sub(at, a, from);
            const double share = se3di_dot(from, d) / se3di_dot(d, d);
            se3di_add_scaled(-fmin(1.0, fmax(0.0, share)), d, from);
            se3di_mul(solid->at->R, d, e);
            add_edge(list, way, e, se3di_dot(from, from));
        }
    }
}

static void add_edges(const search *s, const se3di_solid *solid, double sign, const double x[3],
                      near_edges *list)
{
    const uint32_t lines = se3di_shape_class_of(solid->shape)->lines;
    double axis[3], way[3];
    se3di_scale(sign, s->about, way);
    list->count = 0;
    if (solid->shape->triangles) {
        add_hull_edges(solid, way, x, list);
    }
    for (int a = 0; a < 3; ++a) {
        if (lines >> a & 1u) {
            se3di_solid_axis(solid, a, axis);
            add_edge(list, way, axis, 0.0);
        }
    }
}

/* Perpendicular to both edges, also if these are nearly parallel. */
static void try_product(search *s, const double e[3], const double f[3])
{
    double n[3];
    se3di_cross(e, f, n);
    const double size = se3di_norm(n);
    if (size > SKEW) {
        se3di_scale(1.0 / size, n, n);
        se3di_add_scaled(-se3di_dot(n, f), f, n);
        if (try_direction(s, n)) {
            touch_crossing(s, e, f);
        }
    }
}

/* The directions perpendicular to an edge, n = c u + t w by the sine t of the angle from u, in a
 * bracket; v_low, v_high: the differences of the farthest points at its ends. */
typedef struct circle {
    double u[3], w[3], n[3]; /* n: of the last look */
    double overlap;          /* along that */
    double v_low[3], v_high[3];
    se3di_bracket bracket;
} circle;

/* Returns the slope. */
static double look_along(const search *s, circle *c, double turn, double v[3])
{
    const double cosine = sqrt(1.0 - turn * turn);
    double along[3];
    se3di_scale(cosine, c->u, c->n);
    se3di_add_scaled(turn, c->w, c->n);
    se3di_scale(cosine, c->w, along);
    se3di_add_scaled(-turn, c->u, along);
    c->overlap = overlap_along(s, c->n, v);
    return se3di_dot(v, along);
}

/* Look at the next direction; returns 0 if there is none after it. */
static int step_along(const search *s, circle *c)
{
    double v[3];
    const double slope = look_along(s, c, c->bracket.next, v);
    if (!se3di_bracket_take(&c->bracket, slope)) {
        return 0;
    }
    se3di_copy(v, slope < 0.0 ? c->v_low : c->v_high);
    return 1;
}

/* No overlap is less than along what was found farthest, h(n) >= v.n: the direction in which both
 * ends bound it alike, and the bound there. Between two corners it is the least. 0: there is none
 * between the ends. */
static int find_bound(circle *c, double *bound)
{
    double d[3], n[3];
    se3di_sub(c->v_low, c->v_high, d);
    const double across = se3di_dot(d, c->w), along = -se3di_dot(d, c->u);
    const double size = sqrt(across * across + along * along);
    if (!(size > 0.0)) {
        return 0;
    }
    const double turn = (across < 0.0 ? -along : along) / size;
    se3di_scale(sqrt(1.0 - turn * turn), c->u, n);
    se3di_add_scaled(turn, c->w, n);
    *bound = fmin(se3di_dot(c->v_low, n), se3di_dot(c->v_high, n));
    c->bracket.next = turn;
    return c->bracket.low < turn && turn < c->bracket.high;
}

/* Whether the overlap along the last look is the bound, and the slope jumps there, so that no other
 * direction within 1e-12 is the place. */
static int is_corner(const search *s, const circle *c, double bound)
{
    double e[3], along[3];
    se3di_cross(c->u, c->w, e); /* w = e x u: e again, and w of n */
    se3di_cross(e, c->n, along);
    return !(c->overlap - bound > TIE * s->size) &&
           -se3di_dot(c->v_low, along) > CORNER * s->size &&
           se3di_dot(c->v_high, along) > CORNER * s->size;
}

/* The place where the slope changes its sign on the directions perpendicular to an edge. Left as
 * soon as it cannot be less than what is known: a solid that stands on a face has many edges near
 * its normal, none of which is a way off. */
static void try_circle(search *s, const double e[3], int of_j)
{
    circle c = {.bracket = {.low = -NEAR, .high = NEAR, .width = 2.0 * NEAR}};
    se3di_bracket *b = &c.bracket;
    se3di_copy(s->about, c.u);
    se3di_add_scaled(-se3di_dot(c.u, e), e, c.u);
    se3di_scale(1.0 / se3di_norm(c.u), c.u, c.u);
    se3di_cross(e, c.u, c.w);
    b->slope_low = look_along(s, &c, b->low, c.v_low);
    b->slope_high = look_along(s, &c, b->high, c.v_high);
    if (!(b->slope_low < 0.0 && b->slope_high > 0.0)) {
        return;
    }
    for (;;) {
        double bound;
        if (find_bound(&c, &bound)) {
            /* The bound falls up to that direction only where it is not negative. */
            if (bound > 0.0 && !(bound < s->least - TIE * s->size)) {
                return;
            }
            if (!step_along(s, &c) || is_corner(s, &c, bound)) {
                break;
            }
        }
        if (!se3di_bracket_look(b) || !step_along(s, &c)) {
            break;
        }
    }
    if (try_direction(s, c.n)) {
        touch_lowest(s, of_j);
    }
}

/* Add what a rim moves by as n turns along u: R/|s| (u - (u.z) z - (u.s) s), s the unit part of n
 * perpendicular to the axis. */
static void add_rim_rate(const se3di_solid *solid, const double n[3], const double u[3],
                         double out[3])
{
    double z[3], side[3];
    se3di_solid_axis(solid, 2, z);
    se3di_copy(n, side);
    se3di_add_scaled(-se3di_dot(n, z), z, side);
    const double size = se3di_norm(side);
    if (size > 0.0) {
        se3di_scale(1.0 / size, side, side);
        const double rate = solid->shape->radius / size;
        se3di_add_scaled(rate, u, out);
        se3di_add_scaled(-rate * se3di_dot(u, z), z, out);
        se3di_add_scaled(-rate * se3di_dot(u, side), side, out);
    }
}

/* Of corners nothing. */
static void add_turn_rate(const se3di_solid *solid, const double n[3], const double u[3],
                          double out[3])
{
    const se3di_shape_class *kind = se3di_shape_class_of(solid->shape);
    double own_n[3], own_u[3], own[3], rate[3];
    if (se3di_solid_has_rims(solid)) {
        add_rim_rate(solid, n, u, out);
    } else if (kind->turn) {
        se3di_mul_transposed(solid->at->R, n, own_n);
        se3di_mul_transposed(solid->at->R, u, own_u);
        kind->turn(solid->shape, own_n, own_u, own);
        se3di_mul(solid->at->R, own, rate);
        se3di_add(out, rate, out);
    }
}

/* The step towards the least overlap in the plane of u: Newton's where the overlap is convex,
 * turned to where it falls where it is not. */
static void turn_step(const search *s, const double n[3], double step[3])
{
    double u[2][3], v[3], A[2][2], f[2];
    const double along = overlap_along(s, n, v);
    se3di_perpendicular(n, u[0]);
    se3di_cross(n, u[0], u[1]);
    for (int c = 0; c < 2; ++c) {
        double rate[3] = {0.0, 0.0, 0.0};
        add_turn_rate(s->i, n, u[c], rate);
        add_turn_rate(s->j, n, u[c], rate);
        for (int r = 0; r < 2; ++r) {
            A[r][c] = se3di_dot(rate, u[r]) - (r == c ? along : 0.0);
        }
        f[c] = -se3di_dot(v, u[c]);
    }
    const double cross = 0.5 * (A[0][1] + A[1][0]);
    const double mean = 0.5 * (A[0][0] + A[1][1]);
    const double half = 0.5 * (A[0][0] - A[1][1]);
    const double least = mean - sqrt(half * half + cross * cross);
    const double raise = least > FLAT * s->size ? 0.0 : FLAT * s->size - least;
    const double det = (A[0][0] + raise) * (A[1][1] + raise) - cross * cross;
    se3di_scale(se3di_over((A[1][1] + raise) * f[0] - cross * f[1], det), u[0], step);
    se3di_add_scaled(se3di_over((A[0][0] + raise) * f[1] - cross * f[0], det), u[1], step);
}

/* Newton's method, with steps that are shortened until the overlap is less. */
static void try_rims(search *s)
{
    double n[3], v[3];
    se3di_copy(s->about, n);
    double here = overlap_along(s, n, v);
    for (int k = 0; k < NEWTONS; ++k) {
        double step[3], next[3], then = HUGE_VAL;
        turn_step(s, n, step);
        const double size = se3di_norm(step);
        if (!(size > 0.0)) {
            break;
        }
        double share = fmin(1.0, NEAR / size);
        for (int c = 0; c < SHORTER && !(then < here); ++c, share *= 0.5) {
            se3di_copy(n, next);
            se3di_add_scaled(share, step, next);
            se3di_scale(1.0 / se3di_norm(next), next, next);
            then = overlap_along(s, next, v);
            if (size < LAST) {
                break; /* rounding decides which is less */
            }
        }
        if (!(then < here) && size >= LAST) {
            break;
        }
        se3di_copy(next, n);
        here = then;
        if (size < DONE) {
            break;
        }
    }
    if (try_direction(s, n)) {
        touch_lowest(s, se3di_solid_is_smooth(s->i)); /* its lowest point is one */
    }
}

/* Faces and caps. */
static void try_faces(search *s)
{
    se3di_face face;
    double back[3];
    se3di_scale(-1.0, s->about, back);
    se3di_face_find(s->i, s->about, &face);
    if (face.count > 2 && try_direction(s, face.normal)) {
        touch_lowest(s, 0);
    }
    se3di_face_find(s->j, back, &face);
    if (face.count > 2 && try_direction(s, face.normal)) {
        touch_lowest(s, 1);
    }
}

int se3di_convex_polish(const se3di_solid *i, const se3di_solid *j, double n[3], double a[3],
                        double b[3], double *overlap)
{
    search s = {.i = i, .j = j, .size = i->shape->bound + j->shape->bound, .least = HUGE_VAL};
    se3di_copy(n, s.about);
    se3di_copy(a, s.a);
    se3di_copy(b, s.b);
    try_faces(&s);
    add_edges(&s, i, 1.0, a, &s.of_i);
    add_edges(&s, j, -1.0, b, &s.of_j);
    for (int k = 0; k < s.of_i.count; ++k) {
        for (int c = 0; c < s.of_j.count; ++c) {
            try_product(&s, s.of_i.edge[k], s.of_j.edge[c]);
        }
    }
    const int smooth = se3di_solid_is_smooth(i) || se3di_solid_is_smooth(j);
    const int is_round = smooth || se3di_solid_has_rims(i) || se3di_solid_has_rims(j);
    for (int k = 0; k < s.of_i.count && is_round; ++k) {
        try_circle(&s, s.of_i.edge[k], 0);
    }
    for (int k = 0; k < s.of_j.count && is_round; ++k) {
        try_circle(&s, s.of_j.edge[k], 1);
    }
    if (smooth || (se3di_solid_has_rims(i) && se3di_solid_has_rims(j))) {
        try_rims(&s);
    }
    if (!(s.least < HUGE_VAL) || *overlap < s.least - LOOSE * s.size) {
        return 0;
    }
    se3di_copy(s.n, n);
    se3di_copy(s.a, a);
    se3di_copy(s.b, b);
    *overlap = s.least;
    return 1;
}
