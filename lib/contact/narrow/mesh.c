/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids on surfaces of triangles: closed ones have an outside, open ones two sides, of which that
 * counts where the solid's centre is.
 *
 * Corners of the solid touch the triangles that they are behind, wherever these meet: a floor of
 * triangles in one plane is that plane. Behind an edge that bulges towards the solid only the face
 * that is nearest counts. Edges of the mesh that bulge touch the solid as lines do. Round ends
 * touch as spheres do.                                          docs/theory/body-contact.md */
#include "contact/narrow/mesh.h"

#include "contact/shape/triangles.h"
#include "math/vec3.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define TOUCHES  SE3DI_MESH_SIDES
#define BESIDE   0.2 /* of the solid's size: an edge that a solid is past may be what it rests on */
#define COPLANAR SE3DI_MESH_COPLANAR
#define SAME     SE3DI_MESH_SAME
#define ACROSS   1e-10 /* cosine of a way from an edge that is perpendicular to it */
#define PLANE    1e-9  /* of the size, rad: faces in one */

typedef se3di_mesh_face face;
typedef se3di_mesh_meeting meeting;
typedef se3di_mesh_edge edge;

const double *se3di_mesh_corner(const se3di_shape *s, uint32_t triangle, uint32_t k)
{
    return s->vertices + 3 * (size_t)s->triangles[3 * (size_t)triangle + k % 3];
}

int se3di_mesh_face_of(const meeting *m, uint32_t triangle, face *f)
{
    const se3di_shape *s = m->mesh->shape;
    double u[3], v[3];
    se3di_copy(se3di_mesh_corner(s, triangle, 0), f->corner);
    se3di_sub(se3di_mesh_corner(s, triangle, 1), f->corner, u);
    se3di_sub(se3di_mesh_corner(s, triangle, 2), f->corner, v);
    se3di_cross(u, v, f->n);
    se3di_scale(1.0 / se3di_norm(f->n), f->n, f->n);
    se3di_add(u, v, f->middle);
    se3di_scale(1.0 / 3.0, f->middle, f->middle);
    se3di_add(f->middle, f->corner, f->middle);
    se3di_sub(m->center, f->corner, u);
    if (m->sense ? m->sense < 0 : se3di_dot(u, f->n) < 0.0) {
        se3di_scale(-1.0, f->n, f->n);
    }
    return !(se3di_dot(u, f->n) < 0.0);
}

se3di_contact_point *se3di_mesh_add(const meeting *m, const double at[3], const double n[3],
                                    double overlap, double radius, uint32_t feature)
{
    double point[3], normal[3], d[3];
    se3di_solid_to_ground(m->mesh, at, point);
    se3di_mul(m->mesh->at->R, n, normal);
    se3di_scale(-1.0, normal, normal);
    for (uint32_t k = 0; k < m->manifold->count; ++k) {
        se3di_contact_point *p = &m->manifold->points[k];
        se3di_sub(p->point, point, d);
        if (!(se3di_norm(d) < SAME * m->size && se3di_dot(p->normal, normal) > COPLANAR)) {
            continue;
        }
        if (radius > 0.0 && overlap > p->overlap) { /* a line's end; the line is nearer */
            se3di_copy(normal, p->normal);
            p->overlap = overlap;
        }
        return NULL;
    }
    if (m->filter && !m->filter->keeps(m->filter->ctx, point, normal, overlap)) {
        return NULL;
    }
    se3di_contact_point *p = se3di_manifold_add(m->manifold, point, normal, overlap, feature);
    p->share = 1.0;
    p->bend_i.r[0] = p->bend_i.r[1] = radius;
    return p;
}

typedef struct corner_faces {
    const meeting *m;
    double x[3]; /* the corner, mesh frame */
    double depth[TOUCHES];
    face list[TOUCHES];
    int count;
    int hollow; /* faces that it is beyond the end of count, too */
    int beyond; /* there are such faces */
} corner_faces;

/* Whether two unit normals are those of one plane. */
static int are_same(const double a[3], const double b[3])
{
    double turn[3];
    se3di_sub(a, b, turn);
    return se3di_norm(turn) < SAME;
}

/* Keep a face unless it is in one plane with another, or behind the bulge that both are part of. */
static void keep_face(corner_faces *c, const face *f, double depth)
{
    int at = c->count;
    for (int k = 0; k < c->count; ++k) {
        const face *other = &c->list[k];
        int one = are_same(other->n, f->n);
        int bulge =
            se3di_mesh_height(f, other->middle) < 0.0 && se3di_mesh_height(other, f->middle) < 0.0;
        if (one || bulge) {
            if (!(depth < c->depth[k])) {
                return;
            }
            at = k;
        }
    }
    if (at < TOUCHES) {
        c->list[at] = *f;
        c->depth[at] = depth;
        c->count += at == c->count;
    }
}

/* A place beyond the end of a face, where another one stands up that the corner is behind too. */
typedef struct hollow {
    const meeting *m;
    const face *own;
    const double *x;
    int found;
} hollow;

static void meet_wall(void *ctx, uint32_t triangle)
{
    hollow *h = ctx;
    face other;
    if (!se3di_mesh_face_of(h->m, triangle, &other)) {
        return;
    }
    double least = SAME * h->m->size;
    h->found = h->found || (se3di_mesh_height(h->own, other.middle) > least &&
                            se3di_mesh_height(&other, h->own->middle) > least &&
                            se3di_mesh_height(&other, h->x) < 0.0);
}

se3di_shape se3di_mesh_flat(const meeting *m, uint32_t triangle, double corners[9])
{
    static const uint32_t whole[3] = {0, 1, 2};
    for (uint32_t k = 0; k < 3; ++k) {
        se3di_copy(se3di_mesh_corner(m->mesh->shape, triangle, k), corners + 3 * (size_t)k);
    }
    return (se3di_shape){.kind = SE3DI_SHAPE_HULL,
                         .bound = m->mesh->shape->bound,
                         .vertices = corners,
                         .triangles = (uint32_t *)(uintptr_t)whole,
                         .vertex_count = 3,
                         .triangle_count = 1};
}

/* Whether a side of the solid shows that it does not come near a triangle. */
static int is_parted(const meeting *m, uint32_t triangle)
{
    double corner[3][3];
    for (uint32_t k = 0; k < 3; ++k) {
        se3di_mul(m->R, se3di_mesh_corner(m->mesh->shape, triangle, k), corner[k]);
        se3di_add(corner[k], m->x, corner[k]);
    }
    return se3di_side_parts_triangle(m->solid->shape, (const double(*)[3])corner,
                                     se3di_core_radius(m->solid->shape) + SAME * m->size);
}

int se3di_mesh_overlaps(const meeting *m, uint32_t triangle)
{
    double corners[9];
    if (is_parted(m, triangle)) {
        return 0;
    }
    const se3di_shape flat = se3di_mesh_flat(m, triangle, corners);
    const se3di_solid other = {&flat, m->mesh->at};
    return !se3di_convex_are_apart(m->solid, &other, se3di_core_radius(m->solid->shape));
}

/* A face counts for what is over it; beyond its end where another one stands up there, if the solid
 * overlaps it: what is behind the planes of both is in a hollow between the two. */
static void meet_corner(void *ctx, uint32_t triangle)
{
    corner_faces *c = ctx;
    const meeting *m = c->m;
    const double *corner[3];
    face f;
    double foot[3], at[3];
    int in_front = se3di_mesh_face_of(m, triangle, &f);
    double height = se3di_mesh_height(&f, c->x);
    if (!(in_front && height < SAME * m->size && -height < m->size)) {
        return;
    }
    for (uint32_t k = 0; k < 3; ++k) {
        corner[k] = se3di_mesh_corner(m->mesh->shape, triangle, k);
    }
    se3di_copy(c->x, foot);
    se3di_add_scaled(-height, f.n, foot);
    if (se3di_triangle_nearest(corner, foot, at, NULL) > SAME * SAME * m->size * m->size) {
        c->beyond = 1;
        if (!c->hollow) {
            return;
        }
        hollow h = {m, &f, c->x, 0};
        se3di_mesh_visit(m->mesh->shape, at, SAME * m->size, meet_wall, &h);
        if (!h.found || !se3di_mesh_overlaps(m, triangle)) {
            return;
        }
    }
    keep_face(c, &f, -height);
}

/* Whether the place of a face that a corner is over is seen from the solid's centre: that is where
 * the corner went in. */
static int has_way_in(const corner_faces *c)
{
    for (int k = 0; k < c->count; ++k) {
        double at[3];
        se3di_copy(c->x, at);
        se3di_add_scaled(c->depth[k] + SAME * c->m->size, c->list[k].n, at);
        if (!se3di_mesh_crosses(c->m->mesh->shape, c->m->center, at)) {
            return 1;
        }
    }
    return 0;
}

/* Whether the solid overlaps a triangle in the plane of a face near a corner of it. */
typedef struct plane_met {
    const meeting *m;
    const face *own;
    int found;
} plane_met;

static void meet_plane(void *ctx, uint32_t triangle)
{
    plane_met *p = ctx;
    face f;
    if (!p->found && se3di_mesh_face_of(p->m, triangle, &f) &&
        se3di_dot(f.n, p->own->n) > COPLANAR &&
        fabs(se3di_mesh_height(p->own, f.middle)) < p->m->size) {
        p->found = se3di_mesh_overlaps(p->m, triangle);
    }
}

/* Of several faces that a corner is behind those count that the solid overlaps: others are across
 * the body that the corner is in. The least deep one is where it went in. */
static int is_met(const corner_faces *c, int k)
{
    int least = 0;
    for (int other = 1; other < c->count; ++other) {
        least = c->depth[other] < c->depth[least] ? other : least;
    }
    plane_met here = {c->m, &c->list[k], k == least};
    if (!here.found) {
        se3di_mesh_visit(c->m->mesh->shape, c->x, c->m->size, meet_plane, &here);
    }
    return here.found;
}

/* Of the places where a surface bends each face that is about has its own: of faces that are nearly
 * in one plane the deepest counts. */
static int is_deepest(const meeting *m, const double n[3], double depth, uint32_t feature)
{
    se3di_manifold *manifold = m->manifold;
    double normal[3];
    se3di_mul(m->mesh->at->R, n, normal);
    for (uint32_t k = 0; k < manifold->count; ++k) {
        const se3di_contact_point *p = &manifold->points[k];
        if (p->feature / 8 == feature && -se3di_dot(p->normal, normal) > COPLANAR) {
            if (!(depth > p->overlap)) {
                return 0;
            }
            manifold->points[k] = manifold->points[--manifold->count];
            --k;
        }
    }
    return 1;
}

/* The face, nearly in a plane or any (NULL), that a place is deepest in; -1: none. */
static int find_deepest(double (*n)[3], int count, const double *depth, const double plane[3])
{
    int found = -1;
    for (int k = 0; k < count; ++k) {
        if (depth[k] > 0.0 && (!plane || se3di_dot(n[k], plane) > COPLANAR) &&
            (found < 0 || depth[k] > depth[found])) {
            found = k;
        }
    }
    return found;
}

static void add_corner(const meeting *m, const corner_faces *c, int k, double depth,
                       const se3di_bend *bend, uint32_t feature)
{
    const double *n = c->list[k].n;
    double at[3];
    se3di_copy(c->x, at);
    se3di_add_scaled(c->depth[k], n, at);
    se3di_contact_point *p =
        se3di_mesh_add(m, at, n, depth, 0.0, 8 * feature + se3di_mesh_way_of(n));
    if (p && bend) {
        p->bend_i = *bend;
    }
}

/* A corner of the solid, ground frame, or a place where its surface bends; `only`: on faces of this
 * normal (mesh frame), or NULL. */
static void touch_corner(const meeting *m, const double x[3], const se3di_bend *bend,
                         const double *only, uint32_t feature)
{
    corner_faces c = {.m = m};
    se3di_solid_to_local(m->mesh, x, c.x);
    se3di_mesh_visit(m->mesh->shape, c.x, m->size, meet_corner, &c);
    if (c.beyond && !has_way_in(&c)) {
        c.hollow = 1;
        c.count = 0;
        se3di_mesh_visit(m->mesh->shape, c.x, m->size, meet_corner, &c);
    }
    if (c.count > 0 && !se3di_mesh_crosses(m->mesh->shape, m->center, c.x)) {
        return; /* behind planes of faces, but not behind the surface */
    }
    int met[TOUCHES], count = 0;
    double n[TOUCHES][3], depth[TOUCHES];
    for (int k = 0; k < c.count; ++k) {
        if (c.depth[k] > 0.0 && is_met(&c, k)) { /* else it only keeps others from counting */
            se3di_copy(c.list[k].n, n[count]);
            depth[count] = c.depth[k];
            met[count++] = k;
        }
    }
    se3di_mesh_share_corner((const double(*)[3])n, (uint32_t)count, depth);
    for (int k = 0; !only && (k = find_deepest(n, count, depth, NULL)) >= 0; depth[k] = 0.0) {
        add_corner(m, &c, met[k], depth[k], NULL, feature); /* the deepest keeps its name */
    }
    const int one = only ? find_deepest(n, count, depth, only) : -1;
    if (one >= 0 && is_deepest(m, n[one], c.depth[met[one]], feature)) {
        add_corner(m, &c, met[one], c.depth[met[one]], bend, feature);
    }
}

/* A ball of the solid, ground frame. */
static void touch_ball(const meeting *m, const double x[3], double radius, uint32_t feature)
{
    se3di_touch touches[SE3DI_MESH_TOUCHES];
    double local[3], depth[SE3DI_MESH_TOUCHES];
    se3di_solid_to_local(m->mesh, x, local);
    const size_t count =
        se3di_mesh_contacts(m->mesh->shape, local, radius, SE3DI_MESH_TOUCHES, touches);
    se3di_mesh_share_valley(touches, (uint32_t)count, radius, depth);
    for (size_t k = 0; k < count; ++k) {
        const se3di_touch *t = &touches[k];
        if (depth[k] > 0.0) {
            se3di_mesh_add(m, t->point, t->normal, depth[k], radius,
                           8 * feature + se3di_mesh_way_of(t->normal));
        }
    }
}

/* Another triangle at the middle of an edge. */
static void meet_neighbour(void *ctx, uint32_t triangle)
{
    edge *e = ctx;
    face own, other;
    if (triangle == e->triangle) {
        return;
    }
    (void)se3di_mesh_face_of(e->m, e->triangle, &own);
    (void)se3di_mesh_face_of(e->m, triangle, &other);
    int continues = se3di_dot(own.n, other.n) > COPLANAR;
    int bulges =
        se3di_mesh_height(&own, other.middle) < 0.0 || se3di_mesh_height(&other, own.middle) < 0.0;
    e->is_flat = e->is_flat || continues || !bulges || triangle < e->triangle;
    e->is_border = 0;
    e->other = other;
    e->beyond = triangle;
}

/* A direction away from an edge: whether it leads out between its faces, not through them. */
typedef struct wedge {
    const edge *e;
    const double *n;
    int open;
} wedge;

static void meet_wedge(void *ctx, uint32_t triangle)
{
    wedge *w = ctx;
    double along[3], inward[3];
    face f;
    (void)se3di_mesh_face_of(w->e->m, triangle, &f);
    se3di_sub(w->e->b, w->e->a, along);
    se3di_sub(f.middle, w->e->middle, inward);
    se3di_add_scaled(-se3di_dot(inward, along) / se3di_dot(along, along), along, inward);
    const double least = SE3DI_MESH_OUT * (se3di_norm(along) + se3di_norm(inward));
    w->open = w->open && se3di_dot(w->n, inward) < least;
}

/* An edge as a line without thickness. */
static double place_edge(const edge *e, se3di_shape *line, se3di_shape_pose *at)
{
    const se3di_shape_pose *mesh = e->m->mesh->at;
    double z[3], u[3], w[3];
    se3di_sub(e->b, e->a, z);
    double length = se3di_norm(z);
    *line = (se3di_shape){.kind = SE3DI_SHAPE_CAPSULE, .half_length = 0.5 * length};
    line->bound = line->half_length;
    se3di_scale(1.0 / length, z, z);
    se3di_perpendicular(z, u);
    se3di_cross(z, u, w);
    const double local[9] = {u[0], w[0], z[0], u[1], w[1], z[1], u[2], w[2], z[2]};
    *at = *mesh;
    se3di_mat_mul(mesh->R, local, at->R);
    se3di_mul(mesh->R, e->middle, at->x);
    se3di_add(at->x, mesh->x, at->x);
    return length;
}

int se3di_mesh_leads_out(const edge *e, const double n[3])
{
    double local[3], along[3];
    se3di_mul_transposed(e->m->mesh->at->R, n, local);
    wedge w = {e, local, 1};
    se3di_sub(e->b, e->a, along);
    se3di_mesh_visit(e->m->mesh->shape, e->middle, SAME * se3di_norm(along), meet_wedge, &w);
    return w.open;
}

/* Contacts with the edge as a line, by ways that lead out (where pieces do not tell which these
 * are); if they lead over its end, also from there. A round end leaves along a way that is
 * perpendicular but for what its search leaves. */
static void add_lines(meeting *m, const se3di_manifold *lines, const edge *e, uint32_t feature)
{
    se3di_mesh_way way = {.feature = feature, .triangle = e->triangle, .beyond = e->beyond};
    double along[3];
    se3di_sub(e->b, e->a, along);
    const double radius = se3di_core_radius(m->solid->shape);
    const double least = radius > 0.0 ? SAME : ACROSS;
    for (uint32_t k = 0; k < lines->count; ++k) {
        double here[3], back[3], n[3];
        se3di_scale(-1.0, lines->points[k].normal, back);
        se3di_mul_transposed(m->mesh->at->R, back, n);
        const double over = se3di_dot(n, along) / se3di_norm(along);
        const int ends = fabs(over) > least;
        if (m->has_pieces || (se3di_mesh_leads_out(e, back) &&
                              (!ends || se3di_mesh_leads_off(m, over > 0.0 ? e->b : e->a, n)))) {
            se3di_solid_to_local(m->mesh, lines->points[k].point, here);
            se3di_add_scaled(0.5 * lines->points[k].overlap, n, here); /* on the edge */
            se3di_mesh_add(m, here, n, lines->points[k].overlap, radius, feature + k);
            if (lines->points[k].overlap > way.depth) {
                way.depth = lines->points[k].overlap;
                se3di_copy(n, way.n);
                se3di_copy(here, way.at);
            }
        }
    }
    if (radius > 0.0) {
        return; /* one round end touches it: no way off for the other */
    }
    (void)se3di_mesh_face_of(m, e->triangle, &way.face);
    se3di_mesh_note(m, &way);
}

/* The ball about the solid does not come near the edge. */
static int is_far(const meeting *m, const edge *e)
{
    double u[3], d[3];
    se3di_sub(e->b, e->a, u);
    se3di_sub(m->origin, e->a, d);
    const double t = se3di_dot(d, u) / se3di_dot(u, u);
    se3di_add_scaled(-fmax(0.0, fmin(1.0, t)), u, d);
    return se3di_norm(d) > m->solid->shape->bound + BESIDE * m->size;
}

/* What is cheaper comes first: most edges are apart from the solid. */
static void touch_edge(meeting *m, edge *e, uint32_t feature)
{
    se3di_shape line;
    se3di_shape_pose at;
    const se3di_solid segment = {&line, &at};
    double from[3], to[3];
    if (is_far(m, e)) {
        return;
    }
    const double radius = se3di_core_radius(m->solid->shape);
    const double apart = radius + (m->has_pieces ? 0.0 : BESIDE * m->size);
    se3di_solid_to_ground(m->mesh, e->a, from);
    se3di_solid_to_ground(m->mesh, e->b, to);
    if (se3di_side_parts(m->solid, from, to, fmax(apart, SAME * m->size))) {
        return;
    }
    const double length = place_edge(e, &line, &at);
    const int is_tried = m->has_pieces && m->solid->shape->triangles; /* it costs as little */
    if (!is_tried && se3di_convex_are_apart(m->solid, &segment, apart)) {
        return;
    }
    if (!m->has_pieces) { /* else no more than what is known of the edge is asked */
        se3di_mesh_visit(m->mesh->shape, e->middle, SAME * length, meet_neighbour, e);
        if (e->is_flat) {
            return;
        }
    }
    se3di_manifold lines = {.count = 0};
    se3di_narrow_convex(m->solid, &segment, &lines);
    if (lines.count > 0) {
        add_lines(m, &lines, e, feature);
    }
    if (!m->has_pieces) {
        se3di_mesh_find_ways_off_edge(m, e);
    }
}

static void meet_edges(void *ctx, uint32_t triangle)
{
    meeting *m = ctx;
    double low[3];
    face f;
    (void)se3di_mesh_face_of(m, triangle, &f);
    const double radius = se3di_mesh_lowest(m, f.n, low);
    if (!(se3di_mesh_height(&f, low) < radius)) {
        return; /* all of it is in front */
    }
    const se3di_shape *s = m->mesh->shape;
    for (uint32_t k = 0; k < 3; ++k) {
        if (se3di_mesh_edge_is_told(s, triangle, k) ||
            (s->closed != 0 && !se3di_mesh_edge_bulges(s, triangle, k))) {
            continue;
        }
        edge e = {.m = m,
                  .a = se3di_mesh_corner(s, triangle, k),
                  .b = se3di_mesh_corner(s, triangle, k + 1),
                  .triangle = triangle,
                  .beyond = triangle,
                  .is_border = 1};
        se3di_add(e.a, e.b, e.middle);
        se3di_scale(0.5, e.middle, e.middle);
        touch_edge(m, &e, 0x80000000u + 16 * (3 * triangle + k));
    }
    if (!m->has_pieces) {
        se3di_mesh_find_ways(m, triangle);
    }
}

static void touch_corners(const meeting *m)
{
    const se3di_shape *s = m->solid->shape;
    const se3di_shape_class *kind = se3di_shape_class_of(s);
    double local[3], x[3];
    for (uint32_t k = 0; kind->corner && kind->corner(s, k, local); ++k) {
        se3di_solid_to_ground(m->solid, local, x);
        touch_corner(m, x, NULL, NULL, k);
    }
}

static void touch_ends(const meeting *m)
{
    const se3di_shape *s = m->solid->shape;
    const int is_ball = se3di_shape_is(s, SE3DI_SHAPE_IS_BALL);
    double axis[3], x[3];
    se3di_solid_axis(m->solid, 2, axis);
    for (uint32_t end = 0; end < (is_ball ? 1u : 2u); ++end) {
        se3di_copy(m->solid->at->x, x);
        se3di_add_scaled(is_ball ? 0.0 : end ? s->half_length : -s->half_length, axis, x);
        touch_ball(m, x, s->radius, end);
    }
}

/* What is known of the plane of a face; NULL: there are too many. */
static se3di_mesh_plane *plane_of(meeting *m, const face *f)
{
    for (int k = 0; k < m->plane_count; ++k) {
        se3di_mesh_plane *plane = &m->planes[k];
        double turn[3];
        se3di_sub(plane->face.n, f->n, turn);
        if (se3di_dot(turn, turn) < PLANE * PLANE &&
            fabs(se3di_mesh_height(f, plane->face.corner)) < PLANE * m->size) {
            return plane;
        }
    }
    if (m->plane_count == SE3DI_MESH_PLANES) {
        return NULL;
    }
    se3di_mesh_plane *plane = &m->planes[m->plane_count++];
    *plane = (se3di_mesh_plane){*f, 0};
    return plane;
}

/* The points of the rims that are lowest on a face, as on a plane: those of other faces in it are
 * the same. */
static void meet_rims(void *ctx, uint32_t triangle)
{
    meeting *m = ctx;
    const double *corner[3];
    double normal[3], rim[8][3], low[3];
    face f;
    if (!se3di_mesh_face_of(m, triangle, &f)) {
        return;
    }
    for (uint32_t k = 0; k < 3; ++k) {
        corner[k] = se3di_mesh_corner(m->mesh->shape, triangle, k);
    }
    se3di_mul(m->mesh->at->R, f.n, normal);
    (void)se3di_mesh_lowest(m, f.n, low);
    se3di_bend bend;
    const double tilt = se3di_cylinder_rims(m->solid, normal, -se3di_mesh_height(&f, low), rim);
    const int bends = se3di_rim_bend(m->solid, normal, tilt, &bend);
    se3di_mesh_plane *plane = plane_of(m, &f);
    for (uint32_t k = 0; k < 8; ++k) {
        double x[3], at[3];
        if (plane && plane->looked >> k & 1u) {
            continue;
        }
        se3di_solid_to_local(m->mesh, rim[k], x);
        double height = se3di_mesh_height(&f, x);
        se3di_add_scaled(-height, f.n, x);
        if (height < 0.0 && -height < m->size &&
            se3di_triangle_nearest(corner, x, at, NULL) < m->size * m->size) {
            touch_corner(m, rim[k], bends && k % 4 == 0 ? &bend : NULL, f.n, k);
            if (plane) {
                plane->looked |= UINT64_C(1) << k;
            }
        }
    }
}

/* The point of what is smooth that is lowest on a face, over it or one nearly in its plane. */
static void meet_lowest(void *ctx, uint32_t triangle)
{
    const meeting *m = ctx;
    const double *corner[3];
    double low[3], foot[3], at[3], x[3], local[3];
    se3di_bend bend;
    face f;
    if (!se3di_mesh_face_of(m, triangle, &f)) {
        return;
    }
    (void)se3di_mesh_lowest(m, f.n, low);
    const double height = se3di_mesh_height(&f, low);
    for (uint32_t k = 0; k < 3; ++k) {
        corner[k] = se3di_mesh_corner(m->mesh->shape, triangle, k);
    }
    se3di_copy(low, foot);
    se3di_add_scaled(-height, f.n, foot);
    if (height < 0.0 && -height < m->size &&
        se3di_triangle_nearest(corner, foot, at, NULL) < m->size * m->size) {
        se3di_solid_to_ground(m->mesh, low, x);
        se3di_solid_to_local(m->solid, x, local);
        se3di_solid_bend(m->solid, local, &bend);
        touch_corner(m, x, &bend, f.n, 0);
    }
}

/* A triangle that a solid cuts through if none of its corners and no edge of the mesh that
 * bulges touch (sharp ones, in hollows): pushed apart as convex shapes are. */
static void meet_rest(void *ctx, uint32_t triangle)
{
    const meeting *m = ctx;
    double corners[9], n[3], back[3], on_i[3], on_j[3];
    const se3di_shape flat = se3di_mesh_flat(m, triangle, corners);
    const se3di_solid other = {&flat, m->mesh->at};
    face f;
    if (!se3di_mesh_face_of(m, triangle, &f) || !se3di_mesh_overlaps(m, triangle)) {
        return;
    }
    const double overlap = se3di_convex_least(m->solid, &other, 0.0, n, on_i, on_j);
    if (!(overlap > 0.0)) {
        return;
    }
    se3di_mul_transposed(m->mesh->at->R, n, back);
    se3di_scale(-1.0, back, back);
    if (!(se3di_dot(back, f.n) < 0.0)) {
        se3di_solid_to_local(m->mesh, on_j, on_j);
        se3di_mesh_add(m, on_j, back, overlap, se3di_core_radius(m->solid->shape),
                       0x40000000u + triangle);
    }
}

/* If that leads through the surface everywhere, off the face. */
static void meet_through(void *ctx, uint32_t triangle)
{
    const meeting *m = ctx;
    double corners[9], lowest[3], n[3], on_i[3], on_j[3];
    const se3di_shape flat = se3di_mesh_flat(m, triangle, corners);
    const se3di_solid other = {&flat, m->mesh->at};
    face f;
    if (!se3di_mesh_face_of(m, triangle, &f) || !se3di_mesh_overlaps(m, triangle)) {
        return;
    }
    const double radius = se3di_mesh_lowest(m, f.n, lowest);
    const double depth = radius - se3di_mesh_height(&f, lowest);
    if (depth > 0.0 && se3di_convex_least(m->solid, &other, 0.0, n, on_i, on_j) > 0.0) {
        se3di_add_scaled(depth - radius, f.n, lowest);
        se3di_mesh_add(m, lowest, f.n, depth, radius, 0x40000000u + triangle);
    }
}

/* The side of an open surface that the solid's centre is on is that of the nearest place of it; on
 * an edge that of the face which is seen best from the centre. */
typedef struct side {
    const meeting *m;
    const double *at;
    double best;
    int sense;
} side;

static void meet_side(void *ctx, uint32_t triangle)
{
    side *s = ctx;
    face f;
    double d[3];
    (void)se3di_mesh_face_of(s->m, triangle, &f); /* turned to the centre, as sense is 0 */
    const double *a = se3di_mesh_corner(s->m->mesh->shape, triangle, 0);
    double u[3], v[3], n[3];
    se3di_sub(se3di_mesh_corner(s->m->mesh->shape, triangle, 1), a, u);
    se3di_sub(se3di_mesh_corner(s->m->mesh->shape, triangle, 2), a, v);
    se3di_cross(u, v, n);
    se3di_sub(s->m->center, s->at, d);
    if (fabs(se3di_dot(d, f.n)) > s->best) {
        s->best = fabs(se3di_dot(d, f.n));
        s->sense = se3di_dot(d, n) > 0.0 ? 1 : -1;
    }
}

static void find_side(meeting *m)
{
    const se3di_shape *s = m->mesh->shape;
    double at[3], distance;
    m->sense = s->closed;
    if (s->closed == 0 && s->oriented) {
        side here = {m, at, 0.0, 0};
        (void)se3di_mesh_nearest(s, m->center, at, &distance);
        se3di_mesh_visit(s, at, SAME * m->size, meet_side, &here);
        m->sense = here.sense;
    }
}

/* Hulls may have their origin anywhere. */
static void find_center(meeting *m)
{
    const se3di_shape *s = m->solid->shape;
    double mean[3] = {0.0, 0.0, 0.0}, x[3];
    for (size_t k = 0; k < s->vertex_count; ++k) {
        se3di_add_scaled(1.0 / (double)s->vertex_count, s->vertices + 3 * k, mean);
    }
    se3di_solid_to_ground(m->solid, mean, x);
    se3di_solid_to_local(m->mesh, x, m->center);
    se3di_solid_to_local(m->mesh, m->solid->at->x, m->origin);
}

static void begin(meeting *m, const se3di_solid *i, const se3di_solid *mesh,
                  se3di_manifold *manifold)
{
    const se3di_shape *s = i->shape;
    memset(m, 0, offsetof(meeting, ways));
    m->solid = i;
    m->mesh = mesh;
    m->manifold = manifold;
    m->size = se3di_shape_contact_size(s);
    m->has_pieces = mesh->shape->piece_count > 0 && !se3di_shape_is(s, SE3DI_SHAPE_IS_SWEPT);
    find_center(m);
    se3di_mat_mul_transposed(m->solid->at->R, m->mesh->at->R, m->R);
    se3di_solid_to_local(m->solid, m->mesh->at->x, m->x);
}

typedef struct any_met {
    const meeting *m;
    int met;
} any_met;

static void meet_any(void *ctx, uint32_t triangle)
{
    any_met *a = ctx;
    a->met = a->met || !is_parted(a->m, triangle);
}

static void find_box(meeting *m)
{
    for (int k = 0; k < 3; ++k) {
        double n[3] = {0.0, 0.0, 0.0}, at[3];
        n[k] = 1.0;
        m->low[k] = -se3di_mesh_lowest(m, n, at) - SAME * m->size;
        m->low[k] += at[k];
        n[k] = -1.0;
        m->high[k] = se3di_mesh_lowest(m, n, at) + SAME * m->size;
        m->high[k] += at[k];
    }
}

/* Whether the solid's middle is. */
static int is_in_piece(const meeting *m)
{
    const se3di_shape *s = m->mesh->shape;
    int found = 0;
    for (size_t k = 0; k < s->piece_count && m->has_pieces && !found; ++k) {
        found = se3di_piece_holds(&s->pieces[k], m->center, SAME * m->size);
    }
    return found;
}

/* Whether the solid is off every triangle about it, and pieces do not hold it. */
static int is_clear(const meeting *m)
{
    any_met all = {m, 0};
    se3di_mesh_visit_box(m->mesh->shape, m->low, m->high, meet_any, &all);
    return !all.met && !is_in_piece(m);
}

static void find_parts(meeting *m)
{
    const se3di_shape *s = m->solid->shape, *mesh = m->mesh->shape;
    if (se3di_shape_is(s, SE3DI_SHAPE_IS_SWEPT)) {
        touch_ends(m);
    } else if (se3di_shape_is(s, SE3DI_SHAPE_HAS_RIMS)) {
        se3di_mesh_visit(mesh, m->origin, s->bound, meet_rims, m);
    } else if (se3di_shape_is(s, SE3DI_SHAPE_IS_SMOOTH)) {
        se3di_mesh_visit(mesh, m->origin, s->bound, meet_lowest, m);
    } else {
        touch_corners(m);
    }
    if (!se3di_shape_is(s, SE3DI_SHAPE_IS_BALL)) {
        se3di_mesh_visit(mesh, m->origin, s->bound, meet_edges, m);
    }
}

void se3di_mesh_find(const se3di_solid *i, const se3di_solid *mesh, const se3di_mesh_filter *filter,
                     se3di_manifold *manifold)
{
    meeting m;
    begin(&m, i, mesh, manifold);
    find_side(&m);
    m.filter = filter;
    find_parts(&m);
}

static void find_whole(const se3di_solid *i, size_t part, const se3di_solid *mesh,
                       const se3di_mesh_filter *filter, se3di_manifold *manifold)
{
    (void)part;
    se3di_mesh_find(i, mesh, filter, manifold);
}

/* By its rims, corners and edges a solid other than a ball is held; else what is left counts. */
static void find_rest(meeting *m)
{
    const se3di_shape *mesh = m->mesh->shape;
    const double bound = m->solid->shape->bound;
    if (!m->has_pieces) {
        se3di_mesh_add_ways(m);
    }
    if (m->manifold->count == 0) {
        se3di_mesh_visit(mesh, m->origin, bound, meet_rest, m);
        if (m->manifold->count > 0 && !m->has_pieces) {
            se3di_mesh_add_ways(m); /* off what is about it */
        }
    }
    if (m->manifold->count == 0) {
        se3di_mesh_visit(mesh, m->origin, bound, meet_through, m);
    }
}

void se3di_narrow_mesh(const se3di_solid *i, const se3di_solid *mesh, se3di_manifold *manifold)
{
    meeting m;
    begin(&m, i, mesh, manifold);
    const int has_facets = mesh->shape->rows == 0; /* a heightfield has none */
    find_box(&m);
    if (se3di_narrow_level(&m) || (has_facets && is_clear(&m))) {
        return;
    }
    find_side(&m);
    if (has_facets && se3di_narrow_flush(&m)) {
        return;
    }
    if (!m.has_pieces) {
        find_parts(&m);
    } else if (!se3di_narrow_judge(i, mesh, manifold, find_whole)) {
        return; /* it overlaps none of them */
    }
    if (!se3di_shape_is(i->shape, SE3DI_SHAPE_IS_BALL)) {
        find_rest(&m);
    }
    se3di_manifold_separate(manifold, mesh->at->R);
}

#define WAYS 8 /* directions in the plane in which vertices are chosen */

/* Of the vertices below a plane the deepest, and those farthest to all sides. */
void se3di_plane_mesh(const se3di_solid *mesh, const se3di_solid *plane, se3di_manifold *manifold)
{
    static const double turn[WAYS][2] = {{1.0, 0.0},  {0.7, 0.7},   {0.0, 1.0},  {-0.7, 0.7},
                                         {-1.0, 0.0}, {-0.7, -0.7}, {0.0, -1.0}, {0.7, -0.7}};
    const se3di_shape *s = mesh->shape;
    double n[3], local_n[3], u[3], w[3], base[3], best[WAYS + 1];
    uint32_t chosen[WAYS + 1];
    meeting m = {.solid = mesh, .mesh = mesh, .size = s->bound, .manifold = manifold};
    se3di_solid_axis(plane, 2, n);
    se3di_mul_transposed(mesh->at->R, n, local_n);
    se3di_solid_to_local(mesh, plane->at->x, base);
    se3di_perpendicular(local_n, u);
    se3di_cross(local_n, u, w);
    for (int k = 0; k <= WAYS; ++k) {
        best[k] = -HUGE_VAL;
    }
    for (uint32_t v = 0; v < s->vertex_count; ++v) {
        double d[3];
        se3di_sub(s->vertices + 3 * (size_t)v, base, d);
        double depth = -se3di_dot(d, local_n);
        for (int k = 0; k <= WAYS && depth > 0.0; ++k) {
            double score =
                k == WAYS ? depth : turn[k][0] * se3di_dot(d, u) + turn[k][1] * se3di_dot(d, w);
            if (score > best[k] + SAME * s->bound * (k < WAYS)) {
                best[k] = score;
                chosen[k] = v;
            }
        }
    }
    for (int k = 0; k <= WAYS && best[k] > -HUGE_VAL; ++k) {
        double d[3], at[3];
        se3di_sub(s->vertices + 3 * (size_t)chosen[k], base, d);
        double depth = -se3di_dot(d, local_n);
        se3di_copy(s->vertices + 3 * (size_t)chosen[k], at);
        se3di_add_scaled(depth, local_n, at);
        se3di_mesh_add(&m, at, local_n, depth, 0.0, chosen[k]);
    }
}
