/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids on closed meshes that convex pieces make up: which contacts are ways out.
 *
 * Off a convex piece a solid comes by the least translation, which two convex shapes have exactly.
 * It is a way out of the mesh if the solid, moved by it, is off all other pieces, too, near a place
 * where it leaves the surface: not if that place is a cut, where the body goes on. In a hollow the
 * ways of two pieces are taken together if neither makes the other superfluous.
 *
 * Corners, edges and rims show where there is contact; but of a thin plate that a solid goes into
 * from above they also show the faces that it is behind at the sides. So what is not along a way
 * out of a piece does not count, and no contact is deeper than that way. What they do not show of a
 * way out is added.                                            docs/theory/body-contact.md */
#include "contact/narrow/mesh.h"
#include "contact/shape/pieces.h"
#include "math/larger.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define WAYS_MOST   128
#define POINTS_MOST 64
#define ALONG       0.985 /* cosine: a contact is along a way */
#define LEAN        1.02  /* by how much it may be deeper then */
#define NEAR_DEPTHS 10.0  /* near a place: depths */
#define NEAR_LEAST  1e-5  /* the same: of a piece, at least and at most */
#define NEAR_MOST   1e-1
#define WITHIN      1e-2 /* of that: so far within a piece the other one is in it */
#define EXACT       1e-9 /* of the size: depths that are one */
#define ALIKE       1e-4 /* rad: ways that are about the same */
#define SHALLOWER   0.05 /* of a way's depth: by how much a contact that shows it may be */
#define FEATURE     0xa0000000u

/* How a piece of the one (all of it if it is convex) comes off a piece of the other. */
typedef struct way {
    const se3di_shape *own, *piece;
    se3di_shape_pose at, of;
    int is_out;
    uint32_t place_count;
    double depth, n[3];                      /* into the piece, ground frame */
    double places[SE3DI_MANIFOLD_POINTS][3]; /* of the surface, at which it leaves */
} way;

typedef struct ways {
    const se3di_solid *i, *mesh;
    double size;
    int count;
    uint32_t point_count;
    way list[WAYS_MOST];                         /* of those that overlap */
    se3di_contact_point points[POINTS_MOST + 1]; /* all contacts */
    se3di_manifold touched;                      /* of one */
} ways;

/* Whether what moves, by `by`, is off what of a piece is near x, but for its border. */
static int is_off(const way *w, const double by[3], const double x[3], double depth)
{
    const double share = fmin(NEAR_MOST, fmax(NEAR_LEAST, NEAR_DEPTHS * depth / w->piece->bound));
    se3di_shape_pose moved = w->at, small = w->of;
    double d[3];
    se3di_add(moved.x, by, moved.x);
    se3di_sub(w->of.x, x, d);
    se3di_copy(x, small.x);
    se3di_add_scaled(share, d, small.x);
    for (int k = 0; k < 9; ++k) {
        small.R[k] *= share * (1.0 - WITHIN);
    }
    const se3di_solid solid = {w->own, &moved}, part = {w->piece, &small};
    const double radius = se3di_core_radius(w->own);
    return se3di_convex_are_parted(&solid, &part, w->n, radius) ||
           se3di_convex_are_apart(&solid, &part, radius);
}

/* Whether a place (the mesh's frame) is on the piece of a way, to the depth of that. */
static int is_on(const ways *all, const way *w, const double local[3])
{
    return se3di_piece_holds(w->piece, local, w->depth + EXACT * all->size);
}

/* Whether a place where it leaves is on the surface of the mesh. */
static int is_open(const ways *all, int k, const double x[3])
{
    const way *own = &all->list[k];
    const se3di_shape *pieces = all->mesh->shape->pieces;
    se3di_piece_view view[SE3DI_PIECES_MOST];
    unsigned char is_known[SE3DI_PIECES_MOST] = {0};
    double local[3], by[3], both[3], other_by[3];
    se3di_solid_to_local(all->mesh, x, local);
    se3di_scale(-own->depth, own->n, by);
    for (int c = 0; c < all->count; ++c) {
        const way *other = &all->list[c];
        const double slack = se3di_raised(other->depth, own->depth);
        const size_t piece = (size_t)(other->piece - pieces);
        if (!is_known[piece]) { /* many ways are off the same piece */
            se3di_piece_look(other->piece, local, &view[piece]);
            is_known[piece] = 1;
        }
        if (c == k || !se3di_piece_is_at(other->piece, &view[piece], slack) ||
            is_off(other, by, x, own->depth)) {
            continue;
        }
        se3di_scale(-other->depth, other->n, other_by);
        se3di_add(by, other_by, both);
        if (!is_off(other, both, x, own->depth) || is_off(own, other_by, x, own->depth)) {
            return 0;
        }
    }
    return 1;
}

static void touch(ways *all, const way *w)
{
    const se3di_solid own = {w->own, &w->at}, piece = {w->piece, &w->of};
    all->touched.count = 0;
    se3di_narrow_convex(&own, &piece, &all->touched);
}

/* The part of a shape; the shape itself if it is convex. */
static const se3di_shape *place_part(const se3di_solid *solid, size_t k, se3di_shape_pose *at)
{
    const se3di_shape *s = solid->shape;
    *at = *solid->at;
    if (s->piece_count == 0) {
        return s;
    }
    se3di_solid_to_ground(solid, s->pieces[k].x, at->x);
    return &s->pieces[k];
}

static void note_places(const ways *all, way *w)
{
    w->place_count = all->touched.count;
    for (uint32_t c = 0; c < w->place_count; ++c) {
        se3di_copy(all->touched.points[c].point, w->places[c]);
        se3di_add_scaled(-0.5 * all->touched.points[c].overlap, w->n, w->places[c]);
    }
}

static void find_overlap(ways *all, size_t a, size_t b)
{
    way *w = &all->list[all->count];
    double d[3];
    w->own = place_part(all->i, a, &w->at);
    w->piece = place_part(all->mesh, b, &w->of);
    w->is_out = 0;
    w->depth = 0.0;
    se3di_sub(w->of.x, w->at.x, d);
    const se3di_solid own = {w->own, &w->at}, piece = {w->piece, &w->of};
    if (!(se3di_norm(d) < w->piece->bound + w->own->bound) ||
        se3di_convex_are_apart(&own, &piece, se3di_core_radius(w->own))) {
        return;
    }
    touch(all, w);
    for (uint32_t c = 0; c < all->touched.count; ++c) {
        if (all->touched.points[c].overlap > w->depth) {
            w->depth = all->touched.points[c].overlap;
            se3di_copy(all->touched.points[c].normal, w->n);
        }
    }
    all->count += w->depth > 0.0;
    note_places(all, w);
}

static void find_overlaps(ways *all)
{
    const size_t parts = all->i->shape->piece_count;
    for (size_t a = 0; a < (parts > 0 ? parts : 1); ++a) {
        for (size_t b = 0; b < all->mesh->shape->piece_count && all->count < WAYS_MOST; ++b) {
            find_overlap(all, a, b);
        }
    }
}

/* Returns how many there are. */
static int find_ways_out(ways *all)
{
    int found = 0;
    for (int k = 0; k < all->count; ++k) {
        way *w = &all->list[k];
        w->is_out = all->count == 1;
        for (uint32_t c = 0; c < w->place_count && !w->is_out; ++c) {
            w->is_out = is_open(all, k, w->places[c]);
        }
        found += w->is_out;
    }
    return found;
}

/* How deep a contact may be at most: as the ways out of the pieces that it is on are, or as any if
 * none of those has one. 0: it leads into the mesh. */
static double find_limit(const ways *all, const double point[3], const double normal[3],
                         double overlap)
{
    double local[3], here = 0.0, anywhere = 0.0;
    se3di_solid_to_local(all->mesh, point, local);
    for (int k = 0; k < all->count; ++k) {
        const way *w = &all->list[k];
        if (w->is_out && w->depth > here && se3di_dot(w->n, normal) > ALONG &&
            overlap < LEAN * w->depth + EXACT * all->size) {
            anywhere = fmax(anywhere, w->depth);
            here = is_on(all, w, local) ? w->depth : here;
        }
    }
    if (here > 0.0 || !(anywhere > 0.0)) {
        return here;
    }
    for (int k = 0; k < all->count; ++k) {
        if (all->list[k].is_out && is_on(all, &all->list[k], local)) {
            return 0.0;
        }
    }
    return anywhere;
}

static int keeps(const void *ctx, const double point[3], const double normal[3], double overlap)
{
    return find_limit(ctx, point, normal, overlap) > 0.0;
}

static void add_point(ways *all, const se3di_contact_point *p)
{
    all->points[all->point_count] = *p;
    all->point_count = se3di_contact_points_thin(all->points, all->point_count + 1, POINTS_MOST);
}

/* Whether a contact is along a way, or hardly leans from it and is about as deep on the same piece:
 * pieces of faces that lie on each other come apart by as many ways, which differ by little, and
 * each is as good as all others. */
static int is_shown_by(const ways *all, const way *w, const se3di_contact_point *c)
{
    double turn[3], local[3];
    se3di_sub(c->normal, w->n, turn);
    const double angle = se3di_norm(turn);
    if (angle < SE3DI_MESH_SAME) {
        return 1;
    }
    if (!(angle < ALIKE && c->overlap > (1.0 - SHALLOWER) * w->depth)) {
        return 0;
    }
    se3di_solid_to_local(all->mesh, c->point, local);
    return is_on(all, w, local);
}

/* The way out of piece k as the deepest contact along it; if there is none, added. */
static void show(ways *all, int k)
{
    const way *w = &all->list[k];
    const double slack = EXACT * all->size, depth = w->depth;
    se3di_contact_point *deepest = NULL;
    for (uint32_t c = 0; c < all->point_count; ++c) {
        se3di_contact_point *at = &all->points[c];
        if ((!deepest || at->overlap > deepest->overlap) && is_shown_by(all, w, at)) {
            deepest = at;
        }
    }
    if (deepest && deepest->overlap > depth - fmax(slack, SHALLOWER * depth)) {
        if (deepest->overlap < depth + slack) {
            se3di_copy(w->n, deepest->normal);
            deepest->overlap = depth;
        }
        return;
    }
    touch(all, w);
    for (uint32_t c = 0; c < all->touched.count; ++c) {
        const se3di_contact_point *from = &all->touched.points[c];
        if (!(from->overlap < depth)) {
            se3di_contact_point to;
            se3di_contact_point_set(&to, from->point, w->n, w->depth, FEATURE + (uint32_t)k);
            se3di_add_scaled(-0.5 * w->depth, w->n, to.point); /* on the mesh */
            to.share = 1.0;
            to.bend_i = from->bend_i;
            to.bend_j = from->bend_j;
            add_point(all, &to);
            return;
        }
    }
}

static int overlaps_any(const ways *all, const se3di_shape *part)
{
    int k = 0;
    while (k < all->count && all->list[k].own != part) {
        ++k;
    }
    return k < all->count || all->count == WAYS_MOST;
}

/* The contacts of one part, but for those that lead into the mesh: there may be many. */
static void add_part(ways *all, size_t part, se3di_part_finder find, int has_way_out)
{
    const se3di_shape *s = all->i->shape;
    const int in_pieces = s->piece_count > 0;
    const double slack = SE3DI_MESH_SAME * s->bound;
    se3di_manifold own = {.count = 0};
    if (!overlaps_any(all, in_pieces ? &s->pieces[part] : s)) {
        return;
    }
    const se3di_mesh_filter filter = {keeps, all};
    find(all->i, part, all->mesh, has_way_out ? &filter : NULL, &own);
    for (uint32_t k = 0; k < own.count; ++k) {
        se3di_contact_point *c = &own.points[k];
        if (in_pieces && se3di_contact_points_have(all->points, all->point_count, c, slack)) {
            continue;
        }
        c->overlap = has_way_out
                         ? fmin(c->overlap, find_limit(all, c->point, c->normal, c->overlap))
                         : c->overlap;
        if (c->overlap > 0.0) {
            add_point(all, c);
        }
    }
}

/* Of all the points those go first that others stand for, when it is known which show ways out. */
int se3di_narrow_judge(const se3di_solid *i, const se3di_solid *mesh, se3di_manifold *manifold,
                       se3di_part_finder find)
{
    ways all;
    all.i = i;
    all.mesh = mesh;
    all.size = se3di_shape_contact_size(i->shape);
    all.count = 0;
    all.point_count = 0;
    find_overlaps(&all);
    const int has_way_out = find_ways_out(&all) > 0;
    const size_t parts = i->shape->piece_count;
    for (size_t k = 0; k < (parts > 0 ? parts : 1) && all.count > 0; ++k) {
        add_part(&all, k, find, has_way_out);
    }
    for (int k = 0; k < all.count; ++k) {
        if (all.list[k].is_out) {
            show(&all, k);
        }
    }
    manifold->count = se3di_contact_points_thin(all.points, all.point_count, SE3DI_MANIFOLD_POINTS);
    memcpy(manifold->points, all.points, manifold->count * sizeof *all.points);
    return all.count > 0;
}
