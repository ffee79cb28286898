/* SPDX-License-Identifier: BSD-3-Clause */
/* Two surfaces of triangles of which at least one is closed: edges and vertices of the one within
 * the other, and the other way round, by the signed distance from the triangles themselves.
 *
 * An edge is cut where it passes through the other surface. What is within touches where it is
 * deepest: at its ends if these are vertices, between them, or, where it passes over an edge of the
 * other, along the normal of both edges. A place is pushed out to the nearest place of the other's
 * surface to which its own surface looks: corners of a tooth in the plane of the other's side leave
 * by the flank, not by that side.                                docs/theory/body-contact.md */
#include "contact/narrow/internal.h"
#include "contact/narrow/mesh.h"
#include "contact/shape/mesh.h"
#include "contact/shape/mesh_tree.h"
#include "contact/shape/triangles.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define LIMIT      0.01  /* of the size: how deep contacts are looked for; */
#define LIMIT_MOST 0.2   /* and if some are deeper than half of that */
#define SAME       1e-9  /* of a length: places that are one, */
#define ROUNDED    1e-7  /* and if they were found in two ways */
#define FLAT       1e-12 /* of the square of its length: an edge in a plane does not touch */
#define LEAN       0.3   /* cosine: its own surface leads no more than this into the other one */
#define MORE       1.01  /* times farther: what takes the place of another, not by rounding */
#define FOLDED     0.1   /* mean of normals: faces back to back */
#define SHALLOW    0.1   /* of the deepest: places that count the less */
#define CUTS       16    /* through the other surface, of one edge */
#define CANDIDATES 128
#define DIRECTIONS 48 /* of edges from one vertex */
#define STACK      64
#define KNOWN      16384 /* vertices of which is remembered that they are outside */
#define FACE_NONE  UINT32_MAX
#define VERTEX     0x40000000u /* features: vertices, not edges; */
#define SECOND     0x80000000u /* of the second of the two */

typedef struct place {
    double point[3], normal[3]; /* on the other's surface; outward, the other's frame */
    double own[3];              /* the place that touches */
    double along[3];            /* edge; 0: a vertex */
    double across[3];           /* edge of the other that it passes over; 0: none, */
    double corner[3];           /* and a place on that */
    double depth;
    uint32_t feature, reserved;
} place;

typedef struct search {
    const se3di_solid *own, *other;
    double R[9], x[3]; /* own frame -> that of the other */
    double size, limit, deepest;
    int sense; /* of the other's triangles, as se3di_shape.closed */
    int is_second;
    size_t count;
    place list[CANDIDATES];
    uint64_t outside[KNOWN / 64]; /* bits: vertices of edges that no cut parts from there */
} search;

/* What is about a place of its own surface: the directions that lead on along this. */
typedef struct surroundings {
    const search *s;
    double at[3]; /* own frame */
    double reach;
    double directions[DIRECTIONS][3]; /* unit, the other's frame */
    int count, reserved;
} surroundings;

typedef struct edge {
    double a[3], b[3], way[3], length; /* the other's frame */
    uint32_t triangle, side;
    uint32_t first, reserved; /* of its triangles */
    surroundings around;
} edge;

static void carry(const search *s, const double local[3], double out[3])
{
    se3di_mul(s->R, local, out);
    se3di_add(out, s->x, out);
}

static void normal_of(const search *s, uint32_t triangle, double n[3])
{
    const double *corner[3];
    se3di_triangle_corners(s->other->shape, triangle, corner);
    se3di_triangle_normal(corner, n);
    se3di_scale((double)s->sense, n, n);
}

/* Of the faces at a place the one that is seen best from d tells the side. */
typedef struct seen {
    const search *s;
    const double *d;
    double best;
} seen;

static void see_face(void *ctx, uint32_t triangle)
{
    seen *look = ctx;
    double n[3];
    normal_of(look->s, triangle, n);
    const double height = se3di_dot(n, look->d);
    look->best = fabs(height) > fabs(look->best) ? height : look->best;
}

/* The signed distance of x from the other's surface, negative within; the nearest place of it and
 * the outward direction. */
static double distance_of(const search *s, const double x[3], double at[3], double n[3])
{
    double d[3], distance;
    const uint32_t triangle = (uint32_t)se3di_mesh_nearest(s->other->shape, x, at, &distance);
    se3di_sub(x, at, d);
    normal_of(s, triangle, n);
    double height = se3di_dot(n, d);
    if (fabs(height) < (1.0 - SAME) * distance) {
        seen look = {s, d, height};
        se3di_mesh_visit(s->other->shape, at, SAME * s->size, see_face, &look);
        height = look.best;
    }
    if (distance > SAME * SAME * s->size) {
        se3di_scale((height < 0.0 ? -1.0 : 1.0) / distance, d, n);
    }
    return height < 0.0 ? -distance : distance;
}

/* The sum of the normals of the faces at a place. */
typedef struct outward {
    const search *s;
    double sum[3];
    int count, reserved;
} outward;

static void add_normal(void *ctx, uint32_t triangle)
{
    outward *o = ctx;
    double n[3];
    normal_of(o->s, triangle, n);
    se3di_add(o->sum, n, o->sum);
    ++o->count;
}

/* Beyond the border of an open surface there is nothing to be within: from a place below it, the
 * nearest one of the surface being `at`, the mean of the normals there leads past it. */
static int is_beside(const search *s, const double x[3], const double at[3], double distance)
{
    outward o = {.s = s};
    double to[3];
    if (s->other->shape->closed != 0) {
        return 0;
    }
    se3di_mesh_visit(s->other->shape, at, SAME * s->size, add_normal, &o);
    const double mean = se3di_norm(o.sum) / (double)(o.count > 0 ? o.count : 1);
    if (!(mean > FOLDED)) {
        return 0;
    }
    se3di_copy(x, to);
    se3di_add_scaled((2.0 * distance + SAME * s->size) / (mean * se3di_norm(o.sum)), o.sum, to);
    return !se3di_mesh_crosses(s->other->shape, x, to);
}

/* How deep x is, at most: negative if it is not within. */
static double depth_of(const search *s, const double x[3], double at[3], double n[3])
{
    const double depth = -distance_of(s, x, at, n);
    return depth > 0.0 && is_beside(s, x, at, depth) ? -depth : depth;
}

static int looks_out(const surroundings *around, const double n[3])
{
    for (int k = 0; k < around->count; ++k) {
        if (se3di_dot(around->directions[k], n) < -LEAN) {
            return 0;
        }
    }
    return 1;
}

/* The nearest place of the other's surface that a place within looks out to. */
typedef struct way_out {
    const search *s;
    const surroundings *around;
    const double *x;
    double least, at[3], n[3];
} way_out;

static void try_face(void *ctx, uint32_t triangle)
{
    way_out *w = ctx;
    const double *corner[3];
    double at[3], n[3], d[3];
    se3di_triangle_corners(w->s->other->shape, triangle, corner);
    const double distance = sqrt(se3di_triangle_nearest(corner, w->x, at, NULL));
    normal_of(w->s, triangle, n);
    se3di_sub(at, w->x, d);
    if (!(distance < w->least) || se3di_dot(d, n) < 0.0) {
        return;
    }
    if (distance > SAME * w->s->size) {
        se3di_scale(1.0 / distance, d, d);
        if (se3di_dot(d, n) < 1.0 - SE3DI_MESH_COPLANAR) {
            return;
        }
        se3di_copy(d, n);
    }
    if (looks_out(w->around, n)) {
        w->least = distance;
        se3di_copy(at, w->at);
        se3di_copy(n, w->n);
    }
}

/* How deep x is; 0: it is not within, or looks out nowhere. */
static double find_way(search *s, const surroundings *around, const double x[3], double at[3],
                       double n[3])
{
    const double depth = depth_of(s, x, at, n);
    s->deepest = fmax(s->deepest, depth);
    if (-depth > SAME * SAME * s->size || depth > s->limit) {
        return 0.0;
    }
    if (depth > 0.0 && looks_out(around, n)) {
        return depth;
    }
    way_out w = {.s = s, .around = around, .x = x, .least = s->limit};
    se3di_mesh_visit(s->other->shape, x, s->limit, try_face, &w);
    se3di_copy(w.at, at);
    se3di_copy(w.n, n);
    return w.least < s->limit ? w.least : 0.0;
}

/* Keep a place; if there is no room the shallowest gives way. */
static void keep(search *s, const place *new)
{
    size_t to = s->count;
    for (size_t k = 0; k < s->count; ++k) {
        double d[3];
        se3di_sub(s->list[k].own, new->own, d);
        if (se3di_norm(d) < SAME * s->size &&
            se3di_dot(s->list[k].normal, new->normal) > SE3DI_MESH_COPLANAR) {
            return;
        }
    }
    if (to == CANDIDATES) {
        to = 0;
        for (size_t k = 1; k < s->count; ++k) {
            to = s->list[k].depth < s->list[to].depth ? k : to;
        }
        if (!(new->depth > s->list[to].depth)) {
            return;
        }
    }
    s->list[to] = *new;
    s->count += to == s->count;
}

static void add_direction(surroundings *around, const double own[3])
{
    double d[3];
    const double length = se3di_norm(own);
    if (around->count < DIRECTIONS && length > 0.0) {
        se3di_mul(around->s->R, own, d);
        se3di_scale(1.0 / length, d, around->directions[around->count++]);
    }
}

/* The edges from a vertex. */
static void add_corner(void *ctx, uint32_t triangle)
{
    surroundings *around = ctx;
    const se3di_shape *own = around->s->own->shape;
    for (uint32_t k = 0; k < 3; ++k) {
        const double *corner = se3di_mesh_corner(own, triangle, k);
        double d[3];
        se3di_sub(corner, around->at, d);
        if (se3di_norm(d) > around->reach) {
            add_direction(around, d);
        }
    }
}

/* Returns its depth. */
static double touch_vertex(search *s, const edge *e, int end)
{
    const se3di_shape *own = s->own->shape;
    const uint32_t vertex = own->triangles[3 * e->triangle + (e->side + (uint32_t)end) % 3];
    surroundings around = {.s = s, .reach = SAME * e->length};
    place p = {.feature = VERTEX | (s->is_second ? SECOND : 0u) | vertex};
    se3di_copy(own->vertices + 3 * (size_t)vertex, around.at);
    se3di_mesh_visit(own, around.at, around.reach, add_corner, &around);
    se3di_copy(end ? e->b : e->a, p.own);
    p.depth = find_way(s, &around, p.own, p.point, p.normal);
    if (p.depth > 0.0) {
        keep(s, &p);
    }
    return p.depth;
}

/* The faces at an edge. */
static void add_face(void *ctx, uint32_t triangle)
{
    edge *e = ctx;
    surroundings *around = &e->around;
    const se3di_shape *own = around->s->own->shape;
    const double *a = se3di_mesh_corner(own, e->triangle, e->side);
    double along[3], d[3];
    se3di_sub(se3di_mesh_corner(own, e->triangle, e->side + 1), a, along);
    double far[3] = {0.0, 0.0, 0.0}, most = 0.0;
    for (uint32_t k = 0; k < 3; ++k) {
        se3di_sub(se3di_mesh_corner(own, triangle, k), a, d);
        se3di_add_scaled(-se3di_dot(d, along) / se3di_dot(along, along), along, d);
        if (se3di_norm(d) > most) {
            most = se3di_norm(d);
            se3di_copy(d, far);
        }
    }
    e->first = triangle < e->triangle ? triangle : e->first;
    add_direction(around, far);
}

/* An edge of a closed surface is passed once in each direction: one triangle looks at it. */
static int is_passed(const search *s, const edge *e)
{
    const double *a = se3di_mesh_corner(s->own->shape, e->triangle, e->side);
    const double *b = se3di_mesh_corner(s->own->shape, e->triangle, e->side + 1);
    for (int k = 0; k < 3; ++k) {
        if (a[k] < b[k] || a[k] > b[k]) {
            return s->own->shape->closed == 0 || a[k] < b[k];
        }
    }
    return 0;
}

/* What is about it; whether the edge bulges and, of an open surface, is this triangle's to look at.
 */
static int is_own(search *s, edge *e)
{
    double sum[3];
    const int is_closed = s->own->shape->closed != 0;
    e->around.s = s;
    e->around.reach = SAME * e->length;
    e->around.count = 0;
    const se3di_shape *own = s->own->shape;
    se3di_add(se3di_mesh_corner(own, e->triangle, e->side),
              se3di_mesh_corner(own, e->triangle, e->side + 1), e->around.at);
    se3di_scale(0.5, e->around.at, e->around.at);
    e->first = e->triangle;
    se3di_mesh_visit(own, e->around.at, e->around.reach, add_face, e);
    if ((!is_closed && e->first != e->triangle) || e->around.count != 2) {
        return is_closed || e->first == e->triangle;
    }
    se3di_add(e->around.directions[0], e->around.directions[1], sum);
    return se3di_dot(sum, sum) > FLAT;
}

static void point_at(const edge *e, double share, double x[3])
{
    se3di_copy(e->a, x);
    se3di_add_scaled(share, e->way, x);
}

/* A part of an edge that is within, from one cut (or end) to the other. */
typedef struct part {
    se3di_mesh_cut ends[2];
} part;

/* Over an edge of the other surface, between the faces that it comes in and goes out by: along the
 * normal of both edges. Returns 0 if there is no such edge. */
static int touch_crossing(const search *s, const edge *e, const part *within, place *p)
{
    double n[2][3], along[3], middle[3], corner[3], at[3], distance;
    if (within->ends[0].triangle == FACE_NONE || within->ends[1].triangle == FACE_NONE) {
        return 0;
    }
    normal_of(s, within->ends[0].triangle, n[0]);
    normal_of(s, within->ends[1].triangle, n[1]);
    const double into = -se3di_dot(n[0], e->way), out = se3di_dot(n[1], e->way);
    const double bulge = 1.0 + se3di_dot(n[0], n[1]);
    se3di_cross(n[0], n[1], along);
    se3di_cross(e->way, along, p->normal);
    const double size = se3di_norm(p->normal);
    if (!(into > 0.0 && out > 0.0 && bulge > SAME && size > SAME * e->length)) {
        return 0;
    }
    const double from = within->ends[0].share, to = within->ends[1].share;
    const double share = (into * from + out * to) / (into + out), depth = into * (share - from);
    se3di_add(n[0], n[1], middle);
    se3di_scale((se3di_dot(p->normal, middle) < 0.0 ? -1.0 : 1.0) / size, p->normal, p->normal);
    point_at(e, share, p->own);
    se3di_copy(p->own, corner);
    se3di_add_scaled(depth / bulge, middle, corner);
    (void)se3di_mesh_nearest(s->other->shape, corner, at, &distance);
    se3di_copy(along, p->across);
    se3di_copy(corner, p->corner);
    p->depth = depth * se3di_dot(p->normal, middle) / bulge;
    se3di_copy(p->own, p->point);
    se3di_add_scaled(p->depth, p->normal, p->point);
    return distance < SAME * s->size && p->depth > 0.0 && looks_out(&e->around, p->normal);
}

static void touch_part(search *s, const edge *e, const part *within)
{
    const double from = within->ends[0].share, to = within->ends[1].share;
    place p = {.feature = (s->is_second ? SECOND : 0u) | (3 * e->triangle + e->side)};
    double ends = 0.0;
    if (from < SAME) {
        ends += touch_vertex(s, e, 0);
    }
    if (to > 1.0 - SAME) {
        ends += touch_vertex(s, e, 1);
    }
    se3di_copy(e->way, p.along);
    if (!touch_crossing(s, e, within, &p)) {
        memset(p.across, 0, sizeof p.across);
        point_at(e, 0.5 * (from + to), p.own);
        p.depth = find_way(s, &e->around, p.own, p.point, p.normal);
    }
    if (p.depth > (0.5 + SAME) * ends) { /* else the ends tell all */
        keep(s, &p);
    }
}

/* An edge without cuts is outside of a closed surface as far as one of its ends is. */
static int is_outside(const search *s, const edge *e)
{
    for (uint32_t k = 0; k < 2; ++k) {
        const uint32_t at = s->own->shape->triangles[3 * e->triangle + (e->side + k) % 3];
        if (at < KNOWN && (s->outside[at / 64] >> at % 64 & 1u)) {
            return 1;
        }
    }
    return 0;
}

static void note_outside(search *s, const edge *e)
{
    for (uint32_t k = 0; k < 2 && s->other->shape->closed != 0; ++k) {
        const uint32_t at = s->own->shape->triangles[3 * e->triangle + (e->side + k) % 3];
        if (at < KNOWN) {
            s->outside[at / 64] |= (uint64_t)1 << at % 64;
        }
    }
}

/* Whether an edge without cuts is off the other surface, or too deep. */
static int is_off(search *s, const edge *e, const double middle[3])
{
    double at[3], n[3];
    if (is_outside(s, e)) {
        note_outside(s, e);
        return 1;
    }
    if (se3di_mesh_is_clear(s->other->shape, middle, s->limit)) {
        return 1;
    }
    const double depth = depth_of(s, middle, at, n);
    if (depth < -SAME * s->size) {
        note_outside(s, e);
    }
    return !(depth > 0.0);
}

/* Of the parts between its cuts those that are within. */
static void cut_edge(search *s, edge *e)
{
    se3di_mesh_cut cuts[CUTS + 2];
    cuts[0] = (se3di_mesh_cut){0.0, FACE_NONE, 0};
    const size_t count = 1 + se3di_mesh_find_cuts(s->other->shape, e->a, e->b, CUTS, cuts + 1);
    int known = 0;
    cuts[count] = (se3di_mesh_cut){1.0, FACE_NONE, 0};
    for (size_t k = 0; k < count; ++k) {
        double middle[3], at[3], n[3];
        const part between = {{cuts[k], cuts[k + 1]}};
        if (!(cuts[k + 1].share - cuts[k].share > SAME)) {
            continue;
        }
        point_at(e, 0.5 * (cuts[k].share + cuts[k + 1].share), middle);
        if (count == 1 ? is_off(s, e, middle) : !(depth_of(s, middle, at, n) > 0.0)) {
            continue;
        }
        if (!known && !is_own(s, e)) {
            return;
        }
        known = 1;
        touch_part(s, e, &between);
    }
}

static void meet_edge(search *s, uint32_t triangle, uint32_t side)
{
    const se3di_shape *own = s->own->shape;
    edge e;
    double low[3], high[3];
    e.triangle = triangle;
    e.side = side;
    if (!se3di_mesh_edge_bulges(own, triangle, side) || !is_passed(s, &e)) {
        return;
    }
    carry(s, se3di_mesh_corner(own, triangle, side), e.a);
    carry(s, se3di_mesh_corner(own, triangle, side + 1), e.b);
    for (int k = 0; k < 3; ++k) {
        low[k] = fmin(e.a[k], e.b[k]) - s->limit;
        high[k] = fmax(e.a[k], e.b[k]) + s->limit;
    }
    se3di_sub(e.b, e.a, e.way);
    e.length = se3di_norm(e.way);
    if (se3di_mesh_meets_box(s->other->shape, low, high)) {
        cut_edge(s, &e);
    }
}

/* A box of the tree about its own triangles, as a box in the other's frame. */
static int is_near(const search *s, const se3di_mesh_node *node)
{
    double middle[3], half[3], x[3], low[3], high[3];
    for (int k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (node->low[k] + node->high[k]);
        half[k] = 0.5 * (node->high[k] - node->low[k]);
    }
    carry(s, middle, x);
    for (int k = 0; k < 3; ++k) {
        const double *row = s->R + 3 * k;
        const double reach =
            fabs(row[0]) * half[0] + fabs(row[1]) * half[1] + fabs(row[2]) * half[2] + s->limit;
        low[k] = x[k] - reach;
        high[k] = x[k] + reach;
    }
    return se3di_mesh_meets_box(s->other->shape, low, high);
}

/* All of its own edges that come near the other surface. */
static void meet_edges(search *s)
{
    const se3di_mesh_node *nodes = s->own->shape->tree;
    uint32_t stack[STACK] = {0};
    int depth = 1;
    while (depth > 0) {
        const uint32_t at = stack[--depth];
        if (!is_near(s, &nodes[at])) {
            continue;
        }
        if (nodes[at].count == 0) {
            stack[depth++] = nodes[at].right;
            stack[depth++] = at + 1;
        }
        for (uint32_t k = nodes[at].begin; k < nodes[at].begin + nodes[at].count; ++k) {
            for (uint32_t side = 0; side < 3; ++side) {
                meet_edge(s, k, side);
            }
        }
    }
}

/* The surface is bent about an edge, if there is one. */
static void set_edge(const se3di_shape_pose *at, const double along[3], const double n[3],
                     se3di_bend *bend)
{
    double u[3];
    se3di_mul(at->R, along, u);
    se3di_add_scaled(-se3di_dot(u, n), n, u);
    const double length = se3di_norm(u);
    if (length > SAME * se3di_norm(along)) {
        se3di_scale(1.0 / length, u, u);
        se3di_bend_set(bend, u, HUGE_VAL, 0.0);
    }
}

static void add_point(const search *s, const place *p, se3di_manifold *manifold)
{
    const se3di_shape_pose *at = s->other->at;
    double middle[3], x[3], n[3];
    se3di_add(p->own, p->point, middle);
    se3di_scale(0.5, middle, middle);
    se3di_mul(at->R, middle, x);
    se3di_add(x, at->x, x);
    se3di_mul(at->R, p->normal, n);
    se3di_scale(s->is_second ? 1.0 : -1.0, n, n);
    se3di_contact_point *point = se3di_manifold_add(manifold, x, n, p->depth, p->feature);
    se3di_bend *const own = s->is_second ? &point->bend_j : &point->bend_i;
    own->r[0] = own->r[1] = 0.0;
    set_edge(at, p->along, n, own);
    set_edge(at, p->across, n, s->is_second ? &point->bend_i : &point->bend_j);
}

static size_t find_deepest(const search *s)
{
    size_t deepest = 0;
    for (size_t k = 1; k < s->count; ++k) {
        deepest = s->list[k].depth > s->list[deepest].depth ? k : deepest;
    }
    return deepest;
}

/* How far a place is from those that are chosen; from the middle of all if there are none. */
static double farness(const search *s, const uint8_t *chosen, size_t k, const double middle[3])
{
    double least = HUGE_VAL, d[3];
    for (size_t other = 0; other < s->count; ++other) {
        if (chosen[other]) {
            se3di_sub(s->list[k].own, s->list[other].own, d);
            least = fmin(least, se3di_norm(d));
        }
    }
    se3di_sub(s->list[k].own, middle, d);
    return least < HUGE_VAL ? least : se3di_norm(d);
}

/* The place farthest from the others of those that are not shallow, by more than rounding. */
static size_t find_next(const search *s, const uint8_t *chosen, const double middle[3],
                        double enough)
{
    size_t best = CANDIDATES;
    double most = 0.0;
    for (size_t k = 0; k < s->count; ++k) {
        const double share = fmin(1.0, s->list[k].depth / enough);
        const double value = chosen[k] ? 0.0 : share * farness(s, chosen, k, middle);
        if (value > MORE * most) {
            most = value;
            best = k;
        }
    }
    return best;
}

/* Of too many places those that hold the two best, chosen by where they are: a choice by depth
 * would be another after every step, as what is chosen is pushed out. */
static void choose(const search *s, size_t room, se3di_manifold *manifold)
{
    uint8_t chosen[CANDIDATES] = {0};
    double middle[3] = {0.0, 0.0, 0.0};
    const size_t deepest = find_deepest(s);
    for (size_t k = 0; k < s->count; ++k) {
        se3di_add_scaled(1.0 / (double)s->count, s->list[k].own, middle);
        chosen[k] = s->count <= room;
    }
    for (size_t n = 0; n < room && s->count > room; ++n) {
        const size_t best = find_next(s, chosen, middle, SHALLOW * s->list[deepest].depth);
        if (best < CANDIDATES) {
            chosen[best] = 1;
        }
    }
    for (size_t k = 0; k < s->count; ++k) {
        if (chosen[k]) {
            add_point(s, &s->list[k], manifold);
        }
    }
}

/* Of an open surface the side counts that the middle of what touches it is on. */
static void find_sense(search *s)
{
    const se3di_shape *own = s->own->shape;
    double mean[3] = {0.0, 0.0, 0.0}, x[3], at[3], n[3];
    s->sense = s->other->shape->closed;
    if (s->sense == 0 && s->other->shape->oriented) {
        for (size_t k = 0; k < own->vertex_count; ++k) {
            se3di_add_scaled(1.0 / (double)own->vertex_count, own->vertices + 3 * k, mean);
        }
        carry(s, mean, x);
        s->sense = 1;
        s->sense = distance_of(s, x, at, n) < 0.0 ? -1 : 1;
    }
}

/* Edges and vertices of one of the two within the other. */
static void search_in(search *s, const se3di_solid *own, const se3di_solid *other, int is_second)
{
    s->own = own;
    s->other = other;
    s->is_second = is_second;
    memset(s->outside, 0, sizeof s->outside);
    s->count = 0;
    se3di_solid_to_local(other, own->at->x, s->x);
    se3di_mat_mul_transposed(other->at->R, own->at->R, s->R);
    find_sense(s);
    s->deepest = 0.0;
    if (s->sense != 0) {
        meet_edges(s);
    }
}

static void look(const se3di_solid *i, const se3di_solid *j, double limit, search both[2])
{
    const double size =
        fmin(se3di_shape_contact_size(i->shape), se3di_shape_contact_size(j->shape));
    for (int k = 0; k < 2; ++k) {
        both[k].size = size;
        both[k].limit = limit * size;
        search_in(&both[k], k ? j : i, k ? i : j, k);
    }
}

/* Whether x lies on the line through a place of it. */
static int is_on_line(const double at[3], const double way[3], const double x[3], double slack)
{
    double d[3], off[3];
    se3di_sub(x, at, d);
    se3di_cross(way, d, off);
    return se3di_norm(off) < slack * se3di_norm(way);
}

/* Whether two edges that pass over each other are found from both sides: each has the place of the
 * other on it. */
static int is_same_crossing(const search *s, const place *p, const search *t, const place *q)
{
    double x[3], own[3], way[3];
    if (!(se3di_norm(p->across) > 0.0 && se3di_norm(q->across) > 0.0)) {
        return 0;
    }
    /* the edge of p in the frame of its own mesh, which is that of t's other */
    se3di_sub(p->own, s->x, x);
    se3di_mul_transposed(s->R, x, own);
    se3di_mul_transposed(s->R, p->along, way);
    if (!is_on_line(own, way, q->corner, ROUNDED * s->size)) {
        return 0;
    }
    se3di_sub(q->own, t->x, x);
    se3di_mul_transposed(t->R, x, own);
    se3di_mul_transposed(t->R, q->along, way);
    return is_on_line(own, way, p->corner, ROUNDED * s->size);
}

/* What both have found is left to the first. */
static void drop_doubles(const search *first, search *second)
{
    size_t to = 0;
    for (size_t k = 0; k < second->count; ++k) {
        int is_known = 0;
        for (size_t n = 0; n < first->count && !is_known; ++n) {
            is_known = is_same_crossing(first, &first->list[n], second, &second->list[k]);
        }
        if (!is_known) {
            second->list[to++] = second->list[k];
        }
    }
    second->count = to;
}

void se3di_narrow_surfaces(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    search both[2];
    if (i->shape->closed == 0 && j->shape->closed == 0) {
        return; /* neither has an inside */
    }
    look(i, j, LIMIT, both);
    if (fmax(both[0].deepest, both[1].deepest) > 0.5 * both[0].limit) {
        look(i, j, LIMIT_MOST, both);
    }
    drop_doubles(&both[0], &both[1]);
    const size_t half = SE3DI_MANIFOLD_POINTS / 2, all = SE3DI_MANIFOLD_POINTS;
    const size_t second = both[0].count < half ? all - both[0].count : half;
    choose(&both[0], both[1].count < half ? all - both[1].count : half, manifold);
    choose(&both[1], second, manifold);
    se3di_manifold_separate(manifold, i->at->R);
}
