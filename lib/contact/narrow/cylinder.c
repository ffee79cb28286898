/* SPDX-License-Identifier: BSD-3-Clause */
/* The least overlap of a box with a cylinder, and of either with the line of a capsule, to rounding
 * and without a search that could end elsewhere.
 *
 * In the frame of the box (half sides a; of a line: 0, 0, l) let c be the axis of the cylinder, d
 * its centre, R and H its radius and half length (of a line R = 0). Along a unit n the two overlap
 * by
 *
 *     h(n) = sum a_k |n_k| + H |n . c| + R |n x c| - n . d .
 *
 * The ball about the origin in the difference of the two touches its boundary where h is least, at
 * a place where the boundary has one normal. This is
 *
 *     face, cap    e_k, c
 *     crossing     e_k x c
 *     corner       on a straight side of the cylinder: from the corner to the axis, seen along c
 *     edge         on a rim: perpendicular to e_k. Seen along e_k the rims are ellipses with half
 *                  axes R and R s, s = |e_k . c|. The directions between those of the faces, of the
 *                  axis and across it have one corner, one rim and a quarter of its ellipse; there
 *                  h has one least value at the most: the one root of its slope, or, for a centre
 *                  in the quarter beyond the long half axis, that of two roots which is nearer to
 *                  that axis; a direction between the two is known.
 *
 * Two that are apart are so along one of these, or from a corner to the nearest place of a rim.
 *                                                             docs/theory/body-contact.md */
#include "contact/narrow/bracket.h"
#include "contact/narrow/internal.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define TIE     1e-15  /* of the size: of equal directions the first */
#define NEAR    1e-6   /* rad; directions that may be as good as equal where h is flat */
#define SHORT   1e-4   /* sine; an edge seen along less is about a corner */
#define SKEW    1e-9   /* sine; lines that are more nearly parallel have no product */
#define NO_SKEW 1e-140 /* all lines have one */

/* What touches along a direction: the farthest place of the one, or two lines. */
typedef enum touching { OF_BLOCK, OF_CYLINDER, OF_LINES } touching;

/* All in the frame of the block: a box or a line. */
typedef struct search {
    const se3di_shape *block, *cylinder;
    double half[3];       /* of the block */
    double c[3], d[3];    /* axis and centre of the cylinder */
    double radius, along; /* of the cylinder: 0 of a line; half its length */
    double tie;
    double skew; /* sine; lines that are more nearly parallel have no product */
    double least, n[3];
    touching what;
    int edge; /* of the block, of two lines */
} search;

/* h(n) of a unit n. */
static double overlap_along(const search *s, const double n[3])
{
    double across[3], sum = s->along * fabs(se3di_dot(n, s->c)) - se3di_dot(n, s->d);
    for (int k = 0; k < 3; ++k) {
        sum += s->half[k] * fabs(n[k]);
    }
    if (s->radius > 0.0) {
        se3di_cross(n, s->c, across);
        sum += s->radius * se3di_norm(across);
    }
    return sum;
}

/* Keep a direction along which the overlap is less by more than `by`. */
static void try_unit(search *s, const double n[3], double by, touching what, int edge)
{
    const double here = overlap_along(s, n);
    if (here < s->least - by) {
        s->least = here;
        s->what = what;
        s->edge = edge;
        se3di_copy(n, s->n);
    }
}

/* The end of a range is not least if there is a least overlap `within`, however little less. */
static void try_near(search *s, const double n[3], int within, touching what, int edge)
{
    double turn[3];
    se3di_sub(n, s->n, turn);
    const int is_near = se3di_dot(turn, turn) < NEAR * NEAR;
    try_unit(s, n, within && is_near ? -s->tie : s->tie, what, edge);
}

/* A direction of any length and either sign: that towards the cylinder. */
static void try_axis(search *s, const double axis[3], touching what, int edge)
{
    const double size = se3di_norm(axis);
    double n[3];
    se3di_scale((se3di_dot(axis, s->d) < 0.0 ? -1.0 : 1.0) / size, axis, n);
    try_unit(s, n, s->tie, what, edge);
}

static const double unit[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};

static void try_flats(search *s)
{
    for (int k = 0; k < 3; ++k) {
        if (s->half[(k + 1) % 3] > 0.0 && s->half[(k + 2) % 3] > 0.0) {
            try_axis(s, unit[k], OF_CYLINDER, k);
        }
    }
    if (s->radius > 0.0) {
        try_axis(s, s->c, OF_BLOCK, 0);
    }
}

/* From the place of an edge that is nearest to the axis, seen along it: its end, or, of an edge
 * that is seen so short that its product is none, any. `product` tells which of four edges. */
static void try_nearest(search *s, int k, const double product[3], double square)
{
    const double side = se3di_dot(product, s->d) < 0.0 ? -1.0 : 1.0;
    double x[3], n[3], t = 0.0;
    for (int a = 0; a < 3; ++a) {
        const double sign = a == k ? 0.0 : side * product[a] < 0.0 ? -1.0 : 1.0;
        x[a] = sign * s->half[a] - s->d[a];
    }
    if (square > 0.0) { /* x . (e - (e . c) c), without the cancellation of short ones */
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const double across = x[k] * square - s->c[k] * (x[a] * s->c[a] + x[b] * s->c[b]);
        t = fmax(-s->half[k], fmin(s->half[k], -across / square));
    }
    const int is_short = !(square > SHORT * SHORT), is_end = !(fabs(t) < s->half[k]);
    if (!is_short && !is_end) {
        return;
    }
    x[k] += t;
    se3di_copy(x, n);
    se3di_add_scaled(-se3di_dot(x, s->c), s->c, n);
    const double far = se3di_norm(n);
    if (far > 0.0) {
        se3di_scale(-1.0 / far, n, n);
        try_near(s, n, is_short, is_end ? OF_BLOCK : OF_LINES, k);
    }
}

/* Edges on the straight sides of the cylinder. */
static void try_edges(search *s)
{
    for (int k = 0; k < 3; ++k) {
        double product[3];
        if (!(s->half[k] > 0.0)) {
            continue;
        }
        se3di_cross(unit[k], s->c, product);
        const double square = se3di_dot(product, product);
        if (square > s->skew * s->skew) {
            try_axis(s, product, OF_LINES, k);
        }
        if (s->radius > 0.0) {
            try_nearest(s, k, product, square);
        }
    }
}

/* Corner `which` as seen from the centre of the cylinder; 0: there are no more. */
static int corner(const search *s, unsigned which, double x[3])
{
    const unsigned first = s->half[0] > 0.0 ? 0u : 2u; /* a line has two */
    if (which >= (first ? 2u : 8u)) {
        return 0;
    }
    for (unsigned k = 0; k < 3; ++k) {
        const double sign = k >= first && (which >> (k - first) & 1u) ? 1.0 : -1.0;
        x[k] = sign * s->half[k] - s->d[k];
    }
    return 1;
}

/* Corners that are outside the rims: in front of a cap and beside the cylinder. */
static void try_corners(search *s)
{
    double x[3], n[3];
    for (unsigned which = 0; corner(s, which, x); ++which) {
        const double height = se3di_dot(x, s->c), above = fabs(height) - s->along;
        if (!(above > 0.0)) {
            continue;
        }
        se3di_add_scaled(-height, s->c, x);
        const double far = se3di_norm(x), beyond = far - s->radius;
        if (beyond > 0.0) {
            se3di_scale(-beyond / far, x, n);
            se3di_add_scaled(height < 0.0 ? above : -above, s->c, n);
            se3di_scale(1.0 / se3di_norm(n), n, n);
            try_unit(s, n, s->tie, OF_BLOCK, 0);
        }
    }
}

/* ---- an edge on a rim, seen along the edge ---- */

typedef struct shadow {
    double half[2], c[2], d[2]; /* of the box; along and to the cylinder */
    double size;                /* of c */
    double s;                   /* |e . c| */
    double radius, along;
} shadow;

/* Directions between two ends, in which the box shows one corner, the cylinder a quarter of a rim.
 */
typedef struct quarter {
    double from[2], to[2];
    double q[2];      /* the corner and the rim's middle: h = q . n + R sqrt(s^2 + p^2) */
    double rim, side; /* signs of n . c and of p = n x c */
} quarter;

/* h'(n). If the rim is seen as a line its end changes at p = 0: it is that of the quarter. */
static double slope(const shadow *w, const quarter *q, const double n[2])
{
    const double p = n[0] * w->c[1] - n[1] * w->c[0];
    const double size = sqrt(w->s * w->s + p * p);
    const double share = size > 0.0 ? p / size : q->side;
    return q->q[1] * n[0] - q->q[0] * n[1] - w->radius * share * (n[0] * w->c[0] + n[1] * w->c[1]);
}

static double cross2(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

static void unit2(const double a[2], double n[2])
{
    const double size = sqrt(a[0] * a[0] + a[1] * a[1]);
    n[0] = a[0] / size;
    n[1] = a[1] / size;
}

/* Seen from the middle of the ellipse the centre is in the next quarter, beyond the long half axis
 * (there x0 > 0, y0 < 0 along the half axes of this one): there may be two roots, on either side of
 * (cbrt(x0 s^2), cbrt(-y0)). Returns the slope there, 0 if that is not in the quarter. */
static double look_between(const shadow *w, const quarter *q, double n[2])
{
    const double x0 = -q->side * (q->q[0] * w->c[1] - q->q[1] * w->c[0]) / w->size;
    const double y0 = -q->rim * (q->q[0] * w->c[0] + q->q[1] * w->c[1]) / w->size;
    if (!(x0 > 0.0 && y0 < 0.0 && w->s > 0.0)) {
        return 0.0;
    }
    const double x = q->side * se3di_pow(x0 * w->s * w->s, 1.0 / 3.0);
    const double y = q->rim * se3di_pow(-y0, 1.0 / 3.0);
    const double m[2] = {x * w->c[1] + y * w->c[0], y * w->c[1] - x * w->c[0]};
    unit2(m, n);
    return cross2(q->from, n) > 0.0 && cross2(n, q->to) > 0.0 ? slope(w, q, n) : 0.0;
}

/* The direction in a quarter along which the overlap is least; 0: there is none. */
static int find_least(const shadow *w, const quarter *q, double n[2])
{
    const double *from = q->from, *to = q->to;
    double middle[2];
    se3di_bracket b = {.high = 1.0, .width = 1.0};
    b.slope_low = slope(w, q, from);
    b.slope_high = slope(w, q, to);
    if (b.slope_low * b.slope_high > 0.0) {
        const double between = look_between(w, q, middle);
        if (b.slope_low > 0.0) {
            from = middle;
            b.slope_low = between;
        } else {
            to = middle;
            b.slope_high = between;
        }
    }
    if (!(b.slope_low < 0.0 && b.slope_high > 0.0)) {
        return 0;
    }
    while (se3di_bracket_look(&b)) {
        const double m[2] = {from[0] + b.next * (to[0] - from[0]),
                             from[1] + b.next * (to[1] - from[1])};
        unit2(m, n);
        if (!se3di_bracket_take(&b, slope(w, q, n))) {
            break;
        }
    }
    return 1;
}

static void try_shadow(search *s, const shadow *w, int edge, const double mirror[2])
{
    /* signs of n[0], n[1], n . c, n x c between the eight directions below */
    static const double sign[8][4] = {{1.0, 1.0, 1.0, 1.0},     {1.0, 1.0, 1.0, -1.0},
                                      {-1.0, 1.0, 1.0, -1.0},   {-1.0, 1.0, -1.0, -1.0},
                                      {-1.0, -1.0, -1.0, -1.0}, {-1.0, -1.0, -1.0, 1.0},
                                      {1.0, -1.0, -1.0, 1.0},   {1.0, -1.0, 1.0, 1.0}};
    const double x = w->size > 0.0 ? w->c[0] / w->size : 1.0;
    const double y = w->size > 0.0 ? w->c[1] / w->size : 0.0;
    const double end[9][2] = {{1.0, 0.0}, {x, y},      {0.0, 1.0}, {-y, x},   {-1.0, 0.0},
                              {-x, -y},   {0.0, -1.0}, {y, -x},    {1.0, 0.0}};
    for (int k = 0; k < 8; ++k) {
        quarter q = {.rim = sign[k][2], .side = sign[k][3]};
        double n[2] = {0.0, 0.0};
        for (int a = 0; a < 2; ++a) {
            q.from[a] = end[k][a];
            q.to[a] = end[k + 1][a];
            q.q[a] = sign[k][a] * w->half[a] + q.rim * w->along * w->c[a] - w->d[a];
        }
        if (cross2(q.from, q.to) > 0.0 && find_least(w, &q, n)) {
            double way[3];
            way[edge] = 0.0;
            way[(edge + 1) % 3] = mirror[0] * n[0];
            way[(edge + 2) % 3] = mirror[1] * n[1];
            try_near(s, way, 1, OF_CYLINDER, edge);
        }
    }
}

/* Mirrored so that the axis is between the first two directions. */
static void try_rims(search *s, int edge)
{
    shadow w = {.s = fabs(s->c[edge]), .radius = s->radius, .along = s->along};
    double mirror[2];
    for (int a = 0; a < 2; ++a) {
        const int k = (edge + 1 + a) % 3;
        mirror[a] = s->c[k] < 0.0 ? -1.0 : 1.0;
        w.half[a] = s->half[k];
        w.c[a] = fabs(s->c[k]);
        w.d[a] = mirror[a] * s->d[k];
    }
    w.size = sqrt(w.c[0] * w.c[0] + w.c[1] * w.c[1]);
    try_shadow(s, &w, edge, mirror);
}

/* ---- ---- */

/* The middle of the line on the side of the cylinder that looks along -n; returns 0 if a cap does.
 */
static int find_side(const search *s, double q[3])
{
    double side[3];
    se3di_copy(s->n, side);
    se3di_add_scaled(-se3di_dot(s->n, s->c), s->c, side);
    const double size = se3di_norm(side);
    se3di_copy(s->d, q);
    se3di_add_scaled(size > 0.0 ? -s->radius / size : 0.0, side, q);
    return size > SKEW;
}

/* Whether no direction has a lesser overlap because none has one of the line on the side of the
 * cylinder that is deepest, whose directions are faces and products alone: what lies on a face or
 * across an edge. A product of nearly parallel lines is that of a line that is the same but for
 * rounding. */
static int is_least_of_line(const search *s)
{
    search line = *s;
    line.radius = 0.0;
    line.skew = NO_SKEW;
    line.least = HUGE_VAL;
    if (!find_side(s, line.d)) {
        return 0;
    }
    try_flats(&line);
    try_edges(&line);
    return !(line.least < s->least - s->tie);
}

/* The place where an edge of the block and a straight side of the cylinder cross, on the part of
 * the edge that is beside the side. */
static void touch_lines(const search *s, const double p[3], const double q[3], double at[3])
{
    const double half = s->half[s->edge], turn = s->c[s->edge];
    const double square = 1.0 - turn * turn, reach = fabs(turn) * s->along;
    double d[3];
    se3di_sub(q, p, d);
    const double along = d[s->edge];
    double t = along;
    if (square > SKEW * SKEW) {
        t = (along - turn * se3di_dot(d, s->c)) / square;
    }
    t = fmax(along - reach, fmin(along + reach, t));
    se3di_copy(p, at);
    at[s->edge] = fmax(-half, fmin(half, t));
}

/* The places of the two that are farthest in each other, in the frame of the block. */
static void find_places(const search *s, double on_block[3], double on_cylinder[3])
{
    double p[3], q[3];
    const double up = se3di_dot(s->n, s->c) < 0.0 ? 1.0 : -1.0; /* it looks along -n */
    for (int k = 0; k < 3; ++k) {
        p[k] = s->n[k] < 0.0 ? -s->half[k] : s->half[k];
    }
    (void)find_side(s, q);
    if (s->what == OF_LINES) {
        p[s->edge] = 0.0;
        touch_lines(s, p, q, on_block);
    } else if (s->what == OF_BLOCK) {
        se3di_copy(p, on_block);
    } else {
        se3di_copy(q, on_cylinder);
        se3di_add_scaled(up * s->along, s->c, on_cylinder);
        se3di_copy(on_cylinder, on_block);
        se3di_add_scaled(s->least, s->n, on_block);
        return;
    }
    se3di_copy(on_block, on_cylinder);
    se3di_add_scaled(-s->least, s->n, on_cylinder);
}

double se3di_cylinder_overlap(const se3di_solid *block, const se3di_solid *cylinder, double n[3],
                              double on_block[3], double on_cylinder[3])
{
    const int is_line = se3di_shape_is(block->shape, SE3DI_SHAPE_IS_SWEPT);
    search s = {.block = block->shape,
                .cylinder = cylinder->shape,
                .along = cylinder->shape->half_length,
                .tie = TIE * (block->shape->bound + cylinder->shape->bound),
                .skew = SKEW,
                .least = HUGE_VAL};
    double axis[3], arm[3], a[3], b[3];
    s.radius = cylinder->shape->radius - se3di_core_radius(cylinder->shape);
    for (int k = 0; k < 3; ++k) {
        s.half[k] = is_line ? 0.0 : block->shape->half[k];
    }
    s.half[2] = is_line ? block->shape->half_length : s.half[2];
    se3di_solid_axis(cylinder, 2, axis);
    se3di_mul_transposed(block->at->R, axis, s.c);
    se3di_sub(cylinder->at->x, block->at->x, arm);
    se3di_mul_transposed(block->at->R, arm, s.d);
    try_flats(&s);
    try_edges(&s);
    if (s.radius > 0.0 && s.least > 0.0 && !is_least_of_line(&s)) {
        try_corners(&s);
        for (int k = 0; k < 3 && s.least > 0.0; ++k) {
            if (s.half[k] > 0.0) {
                try_rims(&s, k);
            }
        }
    }
    if (s.least > 0.0) {
        find_places(&s, a, b);
        se3di_mul(block->at->R, s.n, n);
        se3di_solid_to_ground(block, a, on_block);
        se3di_solid_to_ground(block, b, on_cylinder);
    }
    return s.least;
}
