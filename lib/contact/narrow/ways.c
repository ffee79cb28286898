/* SPDX-License-Identifier: BSD-3-Clause */
/* The least ways by which a solid comes off a surface of triangles.
 *
 * Off a convex piece a solid comes by the least translation, whose direction is one of
 *
 *   face     a face's normal; the solid's lowest point is over the face
 *   edge     perpendicular to an edge, between the normals of its faces, where the reach of the
 *            solid as a function of the angle is least: two edges that cross, or an edge and a rim;
 *            the place is on both
 *   corner   the normal of a face of the solid, from a corner of the mesh, between its faces
 *
 * for all other least values of the reach are not over their own place. Of the ways off one piece
 * (faces each behind the other) only the least counts. What corners of the solid and edges of the
 * mesh have shown already is not said again.                 docs/theory/body-contact.md */
#include "contact/narrow/mesh.h"
#include "contact/shape/mesh.h"
#include "contact/shape/triangles.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define PARTS    12 /* of the angle between two faces */
#define HALVINGS 60
#define EQUAL    1e-9        /* of the size: depths that are one */
#define INWARD   1e-3        /* of the way to the middle of a face */
#define FEATURE  0xc0000000u /* of ways: not those of corners, edges and triangles */

double se3di_mesh_lowest(const se3di_mesh_meeting *m, const double n[3], double at[3])
{
    double down[3], point[3];
    const double radius = se3di_core_radius(m->solid->shape);
    se3di_mul(m->mesh->at->R, n, down);
    se3di_scale(-1.0, down, down);
    se3di_core_support(m->solid, down, point);
    se3di_solid_to_local(m->mesh, point, at);
    return radius;
}

void se3di_mesh_note(se3di_mesh_meeting *m, const se3di_mesh_way *way)
{
    int at = m->way_count;
    if (!(way->depth > 0.0 && way->depth < m->size)) {
        return;
    }
    if (at == SE3DI_MESH_WAYS) { /* the deepest gives way */
        at = 0;
        for (int k = 1; k < SE3DI_MESH_WAYS; ++k) {
            at = m->ways[k].depth > m->ways[at].depth ? k : at;
        }
        if (!(way->depth < m->ways[at].depth)) {
            return;
        }
    }
    m->ways[at] = *way;
    m->way_count += at == m->way_count;
}

/* ---- off faces ---- */

static void find_off_face(se3di_mesh_meeting *m, const se3di_mesh_face *f, uint32_t triangle)
{
    const double *corner[3];
    se3di_mesh_way way = {
        .feature = FEATURE + 4 * triangle, .face = *f, .triangle = triangle, .beyond = triangle};
    double low[3], near[3];
    const double radius = se3di_mesh_lowest(m, f->n, low);
    se3di_copy(f->n, way.n);
    way.depth = radius - se3di_mesh_height(f, low);
    se3di_copy(low, way.at);
    se3di_add_scaled(way.depth - radius, f->n, way.at);
    if (!(way.depth > 0.0 && way.depth < m->size)) {
        return;
    }
    for (uint32_t k = 0; k < 3; ++k) {
        corner[k] = se3di_mesh_corner(m->mesh->shape, triangle, k);
    }
    const double least = SE3DI_MESH_SAME * m->size;
    se3di_add_scaled(-radius, f->n, low);
    if (se3di_triangle_nearest(corner, way.at, near, NULL) < least * least &&
        se3di_mesh_crosses(m->mesh->shape, m->center, low)) {
        se3di_mesh_note(m, &way);
    }
}

/* ---- off corners ---- */

typedef struct fan {
    const se3di_mesh_meeting *m;
    const double *x, *n;
    int open;
} fan;

static void meet_fan(void *ctx, uint32_t triangle)
{
    fan *f = ctx;
    for (uint32_t k = 0; k < 3; ++k) {
        double d[3];
        se3di_sub(se3di_mesh_corner(f->m->mesh->shape, triangle, k), f->x, d);
        const double least = SE3DI_MESH_OUT * (f->m->size + se3di_norm(d));
        f->open = f->open && !(se3di_dot(d, f->n) > least);
    }
}

int se3di_mesh_leads_off(const se3di_mesh_meeting *m, const double x[3], const double n[3])
{
    fan f = {m, x, n, 1};
    se3di_mesh_visit(m->mesh->shape, x, SE3DI_MESH_SAME * m->size, meet_fan, &f);
    return f.open;
}

/* The corner x of the mesh leaves the solid along its outward normal `out` (ground frame). */
static void try_corner(se3di_mesh_meeting *m, const double x[3], const double out[3],
                       se3di_mesh_way *way)
{
    double at[3];
    se3di_mul_transposed(m->mesh->at->R, out, way->n);
    se3di_scale(-1.0, way->n, way->n);
    const double radius = se3di_mesh_lowest(m, way->n, at);
    se3di_sub(x, at, at);
    way->depth = se3di_dot(at, way->n) + radius;
    if (!(way->depth > 0.0 && way->depth < m->size)) {
        return;
    }
    if (se3di_mesh_leads_off(m, x, way->n)) {
        se3di_mesh_note(m, way);
    }
}

static void try_hull_faces(se3di_mesh_meeting *m, const double x[3], se3di_mesh_way *way)
{
    const se3di_shape *s = m->solid->shape;
    for (uint32_t k = 0; k < s->triangle_count; ++k) {
        double u[3], v[3], local[3], out[3];
        se3di_sub(se3di_mesh_corner(s, k, 1), se3di_mesh_corner(s, k, 0), u);
        se3di_sub(se3di_mesh_corner(s, k, 2), se3di_mesh_corner(s, k, 0), v);
        se3di_cross(u, v, local);
        const double size = se3di_norm(local);
        se3di_scale(size > 0.0 ? 1.0 / size : 0.0, local, local);
        se3di_mul(m->solid->at->R, local, out);
        if (size > 0.0) {
            try_corner(m, x, out, way);
        }
    }
}

static void find_off_corner(se3di_mesh_meeting *m, const double x[3], se3di_mesh_way *way)
{
    const se3di_solid *solid = m->solid;
    double ground[3], local[3], point[3], normal[3], distance;
    se3di_solid_to_ground(m->mesh, x, ground);
    se3di_solid_to_local(solid, ground, local);
    se3di_shape_nearest(solid->shape, local, point, normal, &distance);
    if (!(distance < 0.0)) {
        return;
    }
    se3di_copy(x, way->at);
    if (solid->shape->triangles) {
        try_hull_faces(m, x, way);
        return;
    }
    if (se3di_shape_is(solid->shape, SE3DI_SHAPE_IS_SMOOTH)) {
        double out[3];
        se3di_mul(solid->at->R, normal, out);
        try_corner(m, x, out, way);
        return;
    }
    const uint32_t flats = se3di_shape_class_of(solid->shape)->flats;
    for (int k = 0; k < 6; ++k) { /* of a cylinder the caps, and its side there */
        const double sign = k & 1 ? -1.0 : 1.0;
        double out[3];
        for (int c = 0; c < 3; ++c) {
            out[c] = sign * solid->at->R[3 * c + k / 2];
        }
        if (flats >> k / 2 & 1u) {
            try_corner(m, x, out, way);
        }
    }
    const double side[3] = {local[0], local[1], 0.0};
    const double size = se3di_norm(side);
    if (se3di_shape_is(solid->shape, SE3DI_SHAPE_HAS_RIMS) && size > 0.0) {
        double out[3];
        se3di_mul(solid->at->R, side, out);
        se3di_scale(1.0 / size, out, out);
        try_corner(m, x, out, way);
    }
}

void se3di_mesh_find_ways(se3di_mesh_meeting *m, uint32_t triangle)
{
    se3di_mesh_face f;
    if (se3di_shape_is(m->solid->shape, SE3DI_SHAPE_IS_SWEPT) ||
        !se3di_mesh_face_of(m, triangle, &f)) {
        return;
    }
    find_off_face(m, &f, triangle);
    for (uint32_t k = 0; k < 3; ++k) {
        se3di_mesh_way way = {.feature = FEATURE + 4 * triangle + 1 + k,
                              .face = f,
                              .triangle = triangle,
                              .beyond = triangle};
        find_off_corner(m, se3di_mesh_corner(m->mesh->shape, triangle, k), &way);
    }
}

/* ---- off edges ---- */

/* The directions perpendicular to an edge, by their angle from the normal of its face; how far the
 * solid reaches below the edge along them, and the slope of that. */
typedef struct arc {
    se3di_mesh_meeting *m;
    const se3di_mesh_edge *e;
    double along[3], n0[3], out[3]; /* unit: the edge, the normal, away from the face */
    double length, end;
} arc;

typedef struct reach {
    double angle, slope, depth, n[3], low[3];
} reach;

static void eval_reach(const arc *a, double angle, reach *r)
{
    const double c = se3di_cos(angle), s = se3di_sin(angle);
    double turn[3], d[3];
    r->angle = angle;
    se3di_scale(c, a->n0, r->n);
    se3di_add_scaled(s, a->out, r->n);
    se3di_scale(c, a->out, turn);
    se3di_add_scaled(-s, a->n0, turn);
    const double radius = se3di_mesh_lowest(a->m, r->n, r->low);
    se3di_sub(a->e->a, r->low, d);
    r->depth = se3di_dot(d, r->n) + radius;
    r->slope = se3di_dot(d, turn);
}

/* The angle between two at which the slope changes from down to up: there the lowest edge passes
 * over that of the mesh. */
static void find_least(const arc *a, reach low, reach high, uint32_t feature)
{
    for (int k = 0; k < HALVINGS; ++k) {
        reach middle;
        eval_reach(a, 0.5 * (low.angle + high.angle), &middle);
        if (!(low.angle < middle.angle && middle.angle < high.angle)) {
            break;
        }
        if (middle.slope < 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    se3di_mesh_way way = {.depth = high.depth,
                          .feature = feature,
                          .triangle = a->e->triangle,
                          .beyond = a->e->beyond};
    double place[3], d[3];
    const double share = low.slope < high.slope ? low.slope / (low.slope - high.slope) : 0.0;
    se3di_sub(high.low, low.low, d);
    se3di_copy(low.low, place);
    se3di_add_scaled(share, d, place);
    se3di_sub(place, a->e->a, d);
    const double t = se3di_dot(d, a->along), slack = SE3DI_MESH_SAME * a->m->size;
    if (t < -slack || t > a->length + slack) {
        return;
    }
    se3di_copy(high.n, way.n);
    se3di_copy(a->e->a, way.at);
    se3di_add_scaled(t, a->along, way.at);
    double ground[3];
    se3di_mul(a->m->mesh->at->R, way.n, ground);
    if (se3di_mesh_leads_out(a->e, ground) &&
        se3di_mesh_crosses(a->m->mesh->shape, a->m->center, place)) {
        (void)se3di_mesh_face_of(a->m, a->e->triangle, &way.face);
        se3di_mesh_note(a->m, &way);
    }
}

void se3di_mesh_find_ways_off_edge(se3di_mesh_meeting *m, const se3di_mesh_edge *e)
{
    arc a = {.m = m, .e = e};
    se3di_mesh_face own;
    reach before, here;
    if (se3di_shape_is(m->solid->shape, SE3DI_SHAPE_IS_SWEPT)) {
        return;
    }
    (void)se3di_mesh_face_of(m, e->triangle, &own);
    se3di_sub(e->b, e->a, a.along);
    a.length = se3di_norm(a.along);
    se3di_scale(1.0 / a.length, a.along, a.along);
    se3di_copy(own.n, a.n0);
    se3di_cross(a.along, a.n0, a.out);
    double d[3];
    se3di_sub(own.middle, e->a, d);
    se3di_scale(se3di_dot(d, a.out) > 0.0 ? -1.0 : 1.0, a.out, a.out);
    a.end = e->is_border ? 3.141592653589793
                         : se3di_atan2(se3di_dot(e->other.n, a.out), se3di_dot(e->other.n, a.n0));
    eval_reach(&a, a.end, &here);
    eval_reach(&a, 0.0, &before);
    if (!(before.depth > 0.0 && here.depth > 0.0)) {
        return; /* all of the solid is in front of a face */
    }
    for (int k = 1; k <= PARTS && a.end > 0.0; ++k) {
        eval_reach(&a, a.end * k / PARTS, &here);
        if (before.slope < 0.0 && here.slope >= 0.0) {
            find_least(&a, before, here, FEATURE + 0x20000000u + 4 * e->triangle);
        }
        before = here;
    }
}

/* ---- which count ---- */

/* Faces of one convex piece: each behind the other, and what is between their places, too. */
static int are_one(const se3di_mesh_meeting *m, const se3di_mesh_face *f, const double at_f[3],
                   const se3di_mesh_face *g, const double at_g[3])
{
    const int flat = se3di_dot(f->n, g->n) > SE3DI_MESH_COPLANAR;
    if (!flat &&
        !(se3di_mesh_height(f, g->middle) < 0.0 && se3di_mesh_height(g, f->middle) < 0.0)) {
        return 0;
    }
    double middle[3], d[3];
    se3di_sub(at_g, at_f, d);
    if (se3di_norm(d) < SE3DI_MESH_SAME * m->size) {
        return 1;
    }
    se3di_copy(at_f, middle);
    se3di_add_scaled(0.5, d, middle);
    for (int k = 0; k < 3; ++k) { /* off an edge that both are on, it may be sharp */
        middle[k] += INWARD * (0.5 * (f->middle[k] + g->middle[k]) - middle[k]);
    }
    se3di_add_scaled(-SE3DI_MESH_SAME * m->size, f->n, middle);
    se3di_add_scaled(-SE3DI_MESH_SAME * m->size, g->n, middle);
    return se3di_mesh_crosses(m->mesh->shape, m->center, middle);
}

static int is_least(const se3di_mesh_meeting *m, int k)
{
    const se3di_mesh_way *way = &m->ways[k];
    for (int other = 0; other < m->way_count; ++other) {
        const se3di_mesh_way *sooner = &m->ways[other];
        const double less = way->depth - sooner->depth;
        if (other != k && (less > 0.0 || (!(less < 0.0) && other < k)) &&
            are_one(m, &way->face, way->at, &sooner->face, sooner->at)) {
            return 0;
        }
    }
    return 1;
}

static int is_round(const se3di_mesh_meeting *m)
{
    return se3di_shape_is(m->solid->shape, SE3DI_SHAPE_IS_ROUND);
}

/* How far a contact is from the place of a way. */
static double apart(const se3di_mesh_meeting *m, const se3di_mesh_way *way,
                    const se3di_contact_point *p)
{
    double place[3], d[3];
    se3di_solid_to_local(m->mesh, p->point, place);
    se3di_sub(place, way->at, d);
    return se3di_norm(d);
}

/* Whether a contact is at the place of a way, or near it on a round side, and as deep, off a face
 * that is all but in one plane with that of the way. */
static int is_beside(const se3di_mesh_meeting *m, const se3di_mesh_way *way, double depth,
                     const se3di_contact_point *p, double turn)
{
    const double slack = SE3DI_MESH_SAME * m->size + 2.0 * turn * depth;
    return turn * turn < 2.0 * (1.0 - SE3DI_MESH_COPLANAR) && p->overlap > depth - slack &&
           apart(m, way, p) < (is_round(m) ? m->size : slack);
}

/* A contact that is this way but for rounding becomes it, and so does that of a round side whose
 * lowest place on a face nearly in one plane was taken; points of a rim are less deep by their
 * bulge. */
static int is_shown(const se3di_mesh_meeting *m, const se3di_mesh_way *way)
{
    const double slack = EQUAL * m->size;
    const double less = (1.0 - SE3DI_MESH_COPLANAR) * m->size; /* of a round side */
    se3di_contact_point *deepest = NULL, *near = NULL;
    double ground[3];
    int beside = 0;
    se3di_mul(m->mesh->at->R, way->n, ground);
    se3di_scale(-1.0, ground, ground);
    const double depth = way->depth - se3di_cap_bulge(m->solid, ground, way->depth);
    for (uint32_t k = 0; k < m->manifold->count; ++k) {
        se3di_contact_point *p = &m->manifold->points[k];
        double turn[3];
        se3di_sub(p->normal, ground, turn);
        beside = beside || is_beside(m, way, depth, p, se3di_norm(turn));
        if (!(se3di_norm(turn) < SE3DI_MESH_SAME)) {
            continue;
        }
        deepest = !deepest || p->overlap > deepest->overlap ? p : deepest;
        if (is_round(m) && apart(m, way, p) < m->size) {
            near = !near || p->overlap > near->overlap ? p : near;
        }
    }
    if (!deepest || !(deepest->overlap > depth - slack)) {
        if (!near || !(near->overlap > depth - less)) {
            return beside;
        }
        deepest = near;
    }
    if (deepest->overlap < depth + slack) {
        se3di_copy(ground, deepest->normal);
        deepest->overlap = depth;
    }
    return 1;
}

/* Whether a contact is with the piece that a way leads off. */
static int is_of_piece(const se3di_mesh_meeting *m, const se3di_mesh_way *way,
                       const se3di_contact_point *p)
{
    se3di_mesh_face f;
    double d[3];
    se3di_solid_to_local(m->mesh, p->point, f.corner);
    se3di_copy(f.corner, f.middle);
    se3di_mul_transposed(m->mesh->at->R, p->normal, d);
    se3di_scale(-1.0, d, f.n);
    return are_one(m, &way->face, way->at, &f, f.corner);
}

/* No contact with a piece is deeper than its least way. */
static void limit(const se3di_mesh_meeting *m, const se3di_mesh_way *way)
{
    for (uint32_t k = 0; k < m->manifold->count; ++k) {
        se3di_contact_point *p = &m->manifold->points[k];
        if (p->overlap > way->depth && is_of_piece(m, way, p)) {
            p->overlap = way->depth;
        }
    }
}

/* Whether all that touches is of the piece that a way leads off, and none is as deep: a sharp solid
 * may be beneath the place that it leaves last and overlap only what is about it. */
static int is_beyond_all(const se3di_mesh_meeting *m, const se3di_mesh_way *way)
{
    for (uint32_t k = 0; k < m->manifold->count; ++k) {
        const se3di_contact_point *p = &m->manifold->points[k];
        if (!(p->overlap < way->depth && is_of_piece(m, way, p))) {
            return 0;
        }
    }
    return m->manifold->count > 0;
}

/* Off parts of the surface that the solid overlaps: a face, or one of those at an edge. All stay
 * while nothing is known to touch. */
static int keep_met(se3di_mesh_meeting *m)
{
    int kept = 0;
    for (int k = 0; k < m->way_count; ++k) {
        const se3di_mesh_way way = m->ways[k];
        if (se3di_mesh_overlaps(m, way.triangle) ||
            (way.beyond != way.triangle && se3di_mesh_overlaps(m, way.beyond)) ||
            is_beyond_all(m, &way)) {
            m->ways[kept++] = way;
        }
    }
    m->way_count = kept > 0 || m->manifold->count > 0 ? kept : m->way_count;
    return kept > 0;
}

void se3di_mesh_add_ways(se3di_mesh_meeting *m)
{
    int least[SE3DI_MESH_WAYS];
    if (!keep_met(m)) {
        return;
    }
    for (int k = 0; k < m->way_count; ++k) {
        least[k] = is_least(m, k);
        if (least[k] && !is_shown(m, &m->ways[k])) {
            const se3di_mesh_way *way = &m->ways[k];
            se3di_mesh_add(m, way->at, way->n, way->depth, se3di_core_radius(m->solid->shape),
                           way->feature);
        }
    }
    for (int k = 0; k < m->way_count; ++k) {
        if (least[k]) {
            limit(m, &m->ways[k]);
        }
    }
}
