/* SPDX-License-Identifier: BSD-3-Clause */
/* Flat parts of two closed meshes that lie on each other, as flanges do.
 *
 * If all of one mesh but for a part of it is outside of the plane of a part of the other, and the
 * other way round, the two touch in nothing else. What the outlines of the parts have in common
 * tells it: corners of each that are over the other, and places where their sides cross, each as
 * deep as the planes are there. Corners beyond a side by less than the slack are over the part, so
 * that outlines on each other do not come and go by rounding.   docs/theory/body-contact.md */
#include "contact/narrow/internal.h"
#include "contact/narrow/mesh.h"
#include "contact/shape/mesh_tree.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define LEAN    1e-2 /* sine of the angle between the parts at most */
#define DEEP    0.1  /* of the size: the deepest at most */
#define LEVEL   1e-6 /* of the size: what is in one plane */
#define SLACK   1e-4 /* of the extent: places that are one */
#define FACING  0.9  /* cosine: a triangle of the part, not one on its edge */
#define WIDE    4.0  /* times the depth: so far from all sides there is a place at least */
#define SIDES   512  /* of an outline */
#define CHUNK   8    /* of them with a box */
#define PLACES  512
#define STACK   128
#define TRIES   4           /* pairs of planes that are looked at */
#define VISITS  400         /* pairs of boxes in which they are looked for */
#define SHALLOW 0.1         /* of the deepest: places that count the less */
#define MORE    1.01        /* times farther: what takes the place of another, not by rounding */
#define CORNER  0x40000000u /* features: corners, not crossings; */
#define SECOND  0x80000000u /* of the second of the two */

typedef struct side {
    double a[2], b[2];
    uint32_t corner, id;
} side;

typedef struct box {
    double low[2], high[2];
} box;

/* A flat part: its plane in the frame of the second mesh, its outline in that of the plane. */
typedef struct outline {
    const se3di_solid *solid;
    double n[3], at[3];
    size_t count;
    side list[SIDES];
    box boxes[SIDES / CHUNK];
    uint64_t is_in[SE3DI_MESH_OUTLINE_MOST / 64];  /* bits: vertices in the plane; */
    uint64_t is_own[SE3DI_MESH_OUTLINE_MOST / 64]; /* of the part */
} outline;

typedef struct place {
    double x[2], depth, along[2], across[2]; /* sides that cross; 0: a corner */
    uint32_t feature;
    int owner; /* of the corner */
} place;

typedef struct pair {
    outline part[2];
    double R[9], x[3]; /* frame of the first mesh -> that of the second */
    double u[3], w[3], size, slack;
    double deepest[2]; /* corner of each, below the plane of the other */
    size_t count;
    place list[PLACES];
} pair;

static void carry(const pair *p, int which, const double local[3], double out[3])
{
    if (which) {
        se3di_copy(local, out);
        return;
    }
    se3di_mul(p->R, local, out);
    se3di_add(out, p->x, out);
}

static void normal_of(const pair *p, int which, uint32_t triangle, double n[3])
{
    const se3di_shape *s = p->part[which].solid->shape;
    double local[3];
    se3di_scale((double)s->closed, se3di_mesh_facets(s)[triangle].normal, local);
    if (which) {
        se3di_copy(local, n);
    } else {
        se3di_mul(p->R, local, n);
    }
}

static double height_of(const outline *o, const double x[3])
{
    double d[3];
    se3di_sub(x, o->at, d);
    return se3di_dot(d, o->n);
}

/* ---- the two planes ---- */

/* Whether what is of one mesh below the plane of the other is in its own plane, and not deep. */
static int is_beyond(pair *p, int which)
{
    double lowest = 0.0;
    const outline *own = &p->part[which], *other = &p->part[!which];
    const se3di_shape *s = own->solid->shape;
    for (size_t k = 0; k < s->vertex_count; ++k) {
        double x[3];
        carry(p, which, s->vertices + 3 * k, x);
        const double height = height_of(other, x);
        lowest = fmin(lowest, height);
        if (height < 0.0 &&
            !(height > -DEEP * p->size && fabs(height_of(own, x)) < LEVEL * p->size)) {
            return 0;
        }
    }
    p->deepest[which] = -lowest;
    return 1;
}

/* Whether two triangles look at each other and are near; their planes then are those of the parts.
 */
static int are_facing(pair *p, uint32_t first, uint32_t second)
{
    double turn[3];
    outline *a = &p->part[0], *b = &p->part[1];
    normal_of(p, 0, first, a->n);
    normal_of(p, 1, second, b->n);
    se3di_add(a->n, b->n, turn);
    if (!(se3di_dot(turn, turn) < LEAN * LEAN)) {
        return 0;
    }
    carry(p, 0, se3di_mesh_corner(a->solid->shape, first, 0), a->at);
    se3di_copy(se3di_mesh_corner(b->solid->shape, second, 0), b->at);
    return fabs(height_of(b, a->at)) < DEEP * p->size;
}

static int are_near(const pair *p, const se3di_mesh_node *a, const se3di_mesh_node *b)
{
    double middle[3], half[3], x[3];
    for (int k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (a->low[k] + a->high[k]);
        half[k] = 0.5 * (a->high[k] - a->low[k]);
    }
    carry(p, 0, middle, x);
    for (int k = 0; k < 3; ++k) {
        const double *row = p->R + 3 * k;
        const double reach = fabs(row[0]) * half[0] + fabs(row[1]) * half[1] +
                             fabs(row[2]) * half[2] + LEVEL * p->size;
        if (x[k] - reach > b->high[k] || x[k] + reach < b->low[k]) {
            return 0;
        }
    }
    return 1;
}

/* Returns whether the leaves have such planes; counts pairs of planes that fail. */
static int try_leaves(pair *p, const se3di_mesh_node *a, const se3di_mesh_node *b, int *tries)
{
    for (uint32_t k = a->begin; k < a->begin + a->count; ++k) {
        const int may_face = se3di_mesh_is_outermost(p->part[0].solid->shape, k);
        for (uint32_t n = b->begin; n < b->begin + b->count && may_face && *tries < TRIES; ++n) {
            if (se3di_mesh_is_outermost(p->part[1].solid->shape, n) && are_facing(p, k, n)) {
                if (is_beyond(p, 0) && is_beyond(p, 1)) {
                    return 1;
                }
                ++*tries;
            }
        }
    }
    return 0;
}

static int find_planes(pair *p)
{
    const se3di_mesh_node *a = p->part[0].solid->shape->tree, *b = p->part[1].solid->shape->tree;
    uint32_t stack[STACK][2] = {{0, 0}};
    int depth = 1, tries = 0, visits = 0;
    while (depth > 0 && depth + 4 < STACK && tries < TRIES && visits++ < VISITS) {
        const uint32_t i = stack[--depth][0], j = stack[depth][1];
        if (!are_near(p, &a[i], &b[j])) {
            continue;
        }
        if (a[i].count > 0 && b[j].count > 0) {
            if (try_leaves(p, &a[i], &b[j], &tries)) {
                return 1;
            }
            continue;
        }
        for (int k = 0; k < 2; ++k) { /* the two of the one, or of the other if that is a leaf */
            const int is_first = a[i].count == 0;
            stack[depth][0] = is_first ? (k ? i + 1 : a[i].right) : i;
            stack[depth++][1] = is_first ? j : (k ? j + 1 : b[j].right);
        }
    }
    return 0;
}

/* ---- the outlines ---- */

static void flatten(const pair *p, const double x[3], double flat[2])
{
    double d[3];
    se3di_sub(x, p->part[1].at, d);
    flat[0] = se3di_dot(d, p->u);
    flat[1] = se3di_dot(d, p->w);
}

static void note_vertices(pair *p, int which)
{
    outline *o = &p->part[which];
    const se3di_shape *s = o->solid->shape;
    memset(o->is_in, 0, (s->vertex_count + 63) / 64 * sizeof *o->is_in);
    for (size_t k = 0; k < s->vertex_count; ++k) {
        double x[3];
        carry(p, which, s->vertices + 3 * k, x);
        if (fabs(height_of(o, x)) < LEVEL * p->size) {
            o->is_in[k / 64] |= (uint64_t)1 << k % 64;
        }
    }
}

static void widen(box *b, const double x[2])
{
    for (int k = 0; k < 2; ++k) {
        b->low[k] = fmin(b->low[k], x[k]);
        b->high[k] = fmax(b->high[k], x[k]);
    }
}

static void add_side(const pair *p, outline *o, uint32_t triangle, uint32_t edge)
{
    const se3di_shape *s = o->solid->shape;
    const int which = o == &p->part[1];
    side *new = &o->list[o->count];
    box *b = &o->boxes[o->count / CHUNK];
    double x[3];
    if (o->count % CHUNK == 0) {
        *b = (box){{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    }
    carry(p, which, se3di_mesh_corner(s, triangle, edge), x);
    flatten(p, x, new->a);
    carry(p, which, se3di_mesh_corner(s, triangle, edge + 1), x);
    flatten(p, x, new->b);
    new->corner = s->triangles[3 * (size_t)triangle + edge];
    new->id = 3 * triangle + edge;
    widen(b, new->a);
    widen(b, new->b);
    ++o->count;
}

static int has_bit(const uint64_t *bits, uint32_t k)
{
    return (int)(bits[k / 64] >> k % 64 & 1u);
}

/* Which corners of a triangle are in the plane, as bits. */
static int find_level(const outline *o, uint32_t triangle)
{
    const uint32_t *v = o->solid->shape->triangles + 3 * (size_t)triangle;
    return has_bit(o->is_in, v[0]) | has_bit(o->is_in, v[1]) << 1 | has_bit(o->is_in, v[2]) << 2;
}

static int is_of_part(const pair *p, int which, uint32_t triangle)
{
    const outline *o = &p->part[which];
    double n[3];
    if (find_level(o, triangle) != 7) {
        return 0;
    }
    normal_of(p, which, triangle, n);
    return se3di_dot(n, o->n) > FACING;
}

/* Sides beyond which the mesh goes on off the part: of triangles that are of it or not, not of
 * planes that are the same or not, so that the outline is closed. Returns 0 if there are too many.
 */
static int find_outline(pair *p, int which)
{
    outline *o = &p->part[which];
    const se3di_shape *s = o->solid->shape;
    note_vertices(p, which);
    memset(o->is_own, 0, (s->vertex_count + 63) / 64 * sizeof *o->is_own);
    o->count = 0;
    for (uint32_t t = 0; t < s->triangle_count; ++t) {
        if (!is_of_part(p, which, t)) {
            continue;
        }
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t own = s->triangles[3 * (size_t)t + k];
            o->is_own[own / 64] |= (uint64_t)1 << own % 64;
            if (is_of_part(p, which, se3di_mesh_beyond(s)[3 * (size_t)t + k])) {
                continue;
            }
            if (o->count == SIDES) {
                return 0;
            }
            add_side(p, o, t, k);
        }
    }
    return 1;
}

/* ---- what they have in common ---- */

static double cross2(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

static void sub2(const double a[2], const double b[2], double out[2])
{
    out[0] = a[0] - b[0];
    out[1] = a[1] - b[1];
}

static double length2(const double a[2])
{
    return sqrt(a[0] * a[0] + a[1] * a[1]);
}

static int are_one(const double a[2], const double b[2], double slack)
{
    double d[2];
    sub2(a, b, d);
    return d[0] * d[0] + d[1] * d[1] < slack * slack;
}

enum { INSIDE = 1, AT_SIDE, AT_CORNER };

/* Whether x is at a side (0: not at all). */
static int is_at(const side *s, const double x[2], double slack)
{
    double way[2], d[2];
    if (are_one(s->a, x, slack) || are_one(s->b, x, slack)) {
        return AT_CORNER;
    }
    sub2(s->b, s->a, way);
    sub2(x, s->a, d);
    const double square = way[0] * way[0] + way[1] * way[1];
    const double share = way[0] * d[0] + way[1] * d[1], off = cross2(way, d);
    return share > 0.0 && share < square && off * off < slack * slack * square ? AT_SIDE : 0;
}

/* Whether x is over a part, and how (0: not at all). */
static int is_over(const outline *o, const double x[2], double slack)
{
    int inside = 0, at = 0;
    for (size_t k = 0; k < o->count; ++k) {
        const side *s = &o->list[k];
        const box *b = &o->boxes[k / CHUNK];
        if (k % CHUNK == 0 &&
            (x[1] < b->low[1] - slack || x[1] > b->high[1] + slack || x[0] < b->low[0] - slack)) {
            k += CHUNK - 1; /* none of these is at x, or left of it */
            continue;
        }
        if ((s->a[1] > x[1] + slack && s->b[1] > x[1] + slack) ||
            (s->a[1] < x[1] - slack && s->b[1] < x[1] - slack)) {
            continue;
        }
        if ((s->a[1] > x[1]) != (s->b[1] > x[1])) {
            const double share = (x[1] - s->a[1]) / (s->b[1] - s->a[1]);
            inside ^= s->a[0] + share * (s->b[0] - s->a[0]) < x[0];
        }
        if (x[0] < b->high[0] + slack) {
            const int here = is_at(s, x, slack);
            at = here > at ? here : at;
        }
    }
    return at > 0 ? at : inside ? INSIDE : 0;
}

/* From the plane of the second part to the frame of its mesh. */
static void raise(const pair *p, const double flat[2], double x[3])
{
    se3di_copy(p->part[1].at, x);
    se3di_add_scaled(flat[0], p->u, x);
    se3di_add_scaled(flat[1], p->w, x);
}

/* How deep a corner of one part is below the other, at most as deep as it takes to part the two.
 * Sides that cross are taken as of the first part. */
static double depth_of(const pair *p, const place *at)
{
    const outline *a = &p->part[0], *b = &p->part[1];
    double x[3];
    raise(p, at->x, x);
    const double height = height_of(a, x);
    const double depth = at->owner ? -height : height / se3di_dot(a->n, b->n);
    return fmin(depth, fmin(p->deepest[0], p->deepest[1]));
}

static void keep(pair *p, const place *new)
{
    const double depth = depth_of(p, new);
    if (depth > 0.0) {
        if (p->count < PLACES) {
            p->list[p->count] = *new;
            p->list[p->count].depth = depth;
        }
        ++p->count;
    }
}

void se3di_step_aside(int way, double length, double by[2])
{
    static const double ways[SE3DI_WAYS_ASIDE][2] = {{1.0, 0.1},  {0.7, 0.8},   {-0.1, 1.0},
                                                     {-0.8, 0.7}, {-1.0, -0.1}, {-0.7, -0.8},
                                                     {0.1, -1.0}, {0.8, -0.7}};
    by[0] = length * ways[way][0];
    by[1] = length * ways[way][1];
}

static void step_from(const double from[2], int way, double length, double x[2])
{
    se3di_step_aside(way, length, x);
    x[0] += from[0];
    x[1] += from[1];
}

/* Whether the parts have something in common at a place that is on the outline of both. */
static int have_region(const pair *p, const double x[2])
{
    for (int way = 0; way < SE3DI_WAYS_ASIDE; ++way) {
        double at[2];
        step_from(x, way, 3.0 * p->slack, at);
        if (is_over(&p->part[0], at, 0.0) && is_over(&p->part[1], at, 0.0)) {
            return 1;
        }
    }
    return 0;
}

static void find_corners(pair *p, int which)
{
    const outline *own = &p->part[which];
    for (size_t k = 0; k < own->count; ++k) {
        const side *s = &own->list[k];
        const place new = {.x = {s->a[0], s->a[1]},
                           .feature = CORNER | (which ? SECOND : 0u) | s->corner,
                           .owner = which};
        const int over = is_over(&p->part[!which], s->a, p->slack);
        if (over == INSIDE || (over == AT_SIDE && have_region(p, s->a)) ||
            (over == AT_CORNER && !which && have_region(p, s->a))) { /* of two the first */
            keep(p, &new);
        }
    }
}

static void meet_sides(pair *p, const side *e, const side *f)
{
    double way_e[2], way_f[2], d[2];
    sub2(e->b, e->a, way_e);
    sub2(f->b, f->a, way_f);
    sub2(f->a, e->a, d);
    const double turn = cross2(way_e, way_f);
    const double longer = fmax(length2(way_e), length2(way_f));
    if (!(fabs(turn) > p->slack * longer)) {
        return; /* along each other: their corners tell it */
    }
    const double share = cross2(d, way_f) / turn, other = cross2(d, way_e) / turn;
    if (!(share > 0.0 && share < 1.0 && other > 0.0 && other < 1.0)) {
        return;
    }
    const place new = {.x = {e->a[0] + share * way_e[0], e->a[1] + share * way_e[1]},
                       .along = {way_e[0], way_e[1]},
                       .across = {way_f[0], way_f[1]},
                       .feature = (e->id * 8191u + f->id) & (CORNER - 1u)};
    if (!are_one(new.x, e->a, p->slack) && !are_one(new.x, e->b, p->slack) &&
        !are_one(new.x, f->a, p->slack) && !are_one(new.x, f->b, p->slack)) {
        keep(p, &new);
    }
}

static void find_crossings(pair *p)
{
    const outline *a = &p->part[0], *b = &p->part[1];
    for (size_t k = 0; k < a->count; ++k) {
        const side *e = &a->list[k];
        const box own = {{fmin(e->a[0], e->b[0]), fmin(e->a[1], e->b[1])},
                         {fmax(e->a[0], e->b[0]), fmax(e->a[1], e->b[1])}};
        for (size_t n = 0; n < b->count; ++n) {
            const box *other = &b->boxes[n / CHUNK];
            if (n % CHUNK == 0 && (other->low[0] > own.high[0] || other->high[0] < own.low[0] ||
                                   other->low[1] > own.high[1] || other->high[1] < own.low[1])) {
                n += CHUNK - 1;
                continue;
            }
            meet_sides(p, e, &b->list[n]);
        }
    }
}

/* Whether a triangle has in the plane only what is of the part, not a ridge or a tip of its own. */
static int ends_part(const pair *p, int which, uint32_t triangle)
{
    const outline *o = &p->part[which];
    const se3di_shape *s = o->solid->shape;
    const int level = find_level(o, triangle);
    for (uint32_t k = 0; k < 3 && level > 0 && level < 7; ++k) {
        const size_t at = 3 * (size_t)triangle + k;
        const int first = level >> k & 1, second = level >> (k + 1) % 3 & 1;
        double x[3], flat[2];
        if (first && second && find_level(o, se3di_mesh_beyond(s)[at]) < 7) {
            return 0;
        }
        if (first && !has_bit(o->is_own, s->triangles[at])) { /* or that corner is there twice */
            carry(p, which, se3di_mesh_corner(s, triangle, k), x);
            flatten(p, x, flat);
            if (!is_over(o, flat, p->slack)) {
                return 0;
            }
        }
    }
    return 1;
}

static int is_whole(const pair *p, int which)
{
    const size_t count = p->part[which].solid->shape->triangle_count;
    uint32_t k = 0;
    while (k < count && ends_part(p, which, k)) {
        ++k;
    }
    return k == count;
}

/* Whether x is over a part and no side of it is nearer. */
static int is_within(const outline *o, const double x[2], double margin)
{
    int within = is_over(o, x, 0.0);
    for (size_t k = 0; k < o->count && within; ++k) {
        within = !is_at(&o->list[k], x, margin);
    }
    return within;
}

/* Whether the parts have a place in common that is farther from all sides than they are deep, so
 * that they do not come apart to a side sooner: beside one of those that are known. */
static int are_wide(const pair *p)
{
    const double margin = WIDE * fmin(p->deepest[0], p->deepest[1]) + p->slack;
    for (size_t k = 0; k < p->count; ++k) {
        for (int way = 0; way < SE3DI_WAYS_ASIDE; ++way) {
            double x[2];
            step_from(p->list[k].x, way, 3.0 * margin, x);
            if (is_within(&p->part[0], x, margin) && is_within(&p->part[1], x, margin)) {
                return 1;
            }
        }
    }
    return 0;
}

/* ---- which are told ---- */

static void set_edge(const pair *p, const double way[2], se3di_bend *bend)
{
    const double length = length2(way);
    double u[3], ground[3];
    se3di_scale(way[0] / length, p->u, u);
    se3di_add_scaled(way[1] / length, p->w, u);
    se3di_mul(p->part[1].solid->at->R, u, ground);
    se3di_bend_set(bend, ground, HUGE_VAL, 0.0);
}

static void add_point(const pair *p, const place *at, se3di_manifold *manifold)
{
    const outline *a = &p->part[0], *b = &p->part[1];
    double x[3], point[3], along[3], normal[3];
    raise(p, at->x, x);
    se3di_add_scaled(-0.5 * at->depth, b->n, x);
    se3di_solid_to_ground(b->solid, x, point);
    se3di_scale(at->owner ? 1.0 : -1.0, at->owner ? a->n : b->n, along);
    se3di_mul(b->solid->at->R, along, normal);
    se3di_contact_point *to = se3di_manifold_add(manifold, point, normal, at->depth, at->feature);
    if (at->feature & CORNER) {
        se3di_bend *const own = at->owner ? &to->bend_j : &to->bend_i;
        own->r[0] = own->r[1] = 0.0;
    } else {
        set_edge(p, at->along, &to->bend_i);
        set_edge(p, at->across, &to->bend_j);
    }
}

/* Of too many places those farthest from each other, whatever their depths are: a choice by depth
 * would be another after every step. */
static void choose(const pair *p, se3di_manifold *manifold)
{
    double far[PLACES], middle[2] = {0.0, 0.0}, deepest = 0.0;
    for (size_t k = 0; k < p->count; ++k) {
        middle[0] += p->list[k].x[0] / (double)p->count;
        middle[1] += p->list[k].x[1] / (double)p->count;
        deepest = fmax(deepest, p->list[k].depth);
    }
    for (size_t k = 0; k < p->count; ++k) {
        double d[2];
        sub2(p->list[k].x, middle, d);
        far[k] = p->slack + length2(d);
    }
    for (size_t n = 0; n < SE3DI_MANIFOLD_POINTS && n < p->count; ++n) {
        size_t best = 0;
        double most = 0.0;
        for (size_t k = 0; k < p->count; ++k) {
            const double value = far[k] * fmin(1.0, p->list[k].depth / (SHALLOW * deepest));
            if (value > MORE * most) {
                most = value;
                best = k;
            }
        }
        if (!(most > 0.0)) {
            return;
        }
        add_point(p, &p->list[best], manifold);
        for (size_t k = 0; k < p->count; ++k) {
            double d[2];
            sub2(p->list[k].x, p->list[best].x, d);
            const double gap = length2(d);
            far[k] = n == 0 ? gap : fmin(far[k], gap);
        }
    }
}

static void begin(pair *p, const se3di_solid *i, const se3di_solid *j)
{
    p->part[0].solid = i;
    p->part[1].solid = j;
    p->size = fmin(se3di_shape_contact_size(i->shape), se3di_shape_contact_size(j->shape));
    p->slack = SLACK * fmin(i->shape->bound, j->shape->bound);
    p->count = 0;
    se3di_solid_to_local(j, i->at->x, p->x);
    se3di_mat_mul_transposed(j->at->R, i->at->R, p->R);
}

int se3di_narrow_outlines(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    pair p;
    if (i->shape->closed == 0 || j->shape->closed == 0 ||
        i->shape->vertex_count > SE3DI_MESH_OUTLINE_MOST ||
        j->shape->vertex_count > SE3DI_MESH_OUTLINE_MOST) {
        return 0;
    }
    begin(&p, i, j);
    if (!find_planes(&p)) {
        return 0;
    }
    if (!(p.deepest[0] > 0.0 && p.deepest[1] > 0.0)) {
        return 1; /* a plane parts them */
    }
    se3di_perpendicular(p.part[1].n, p.u);
    se3di_cross(p.part[1].n, p.u, p.w);
    if (!find_outline(&p, 0) || !find_outline(&p, 1) || !is_whole(&p, 0) || !is_whole(&p, 1)) {
        return 0;
    }
    find_corners(&p, 0);
    find_corners(&p, 1);
    find_crossings(&p);
    if (p.count > PLACES || !are_wide(&p)) {
        return 0;
    }
    choose(&p, manifold);
    return 1;
}
