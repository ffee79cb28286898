/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids on surfaces of triangles: closed ones have an outside, open ones two sides, of which that
 * counts where the solid's centre is.
 *
 * Corners of the solid touch the triangles that they are behind, wherever these meet: a floor of
 * triangles in one plane is that plane. Behind an edge that bulges towards the solid only the face
 * that is nearest counts. Edges of the mesh that bulge touch the solid as lines do. Round ends
 * touch as spheres do.                                          docs/theory/body-contact.md */
#include "contact/mesh.h"
#include "contact/narrow_internal.h"
#include "math/vec3.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define TOUCHES  4     /* faces that one corner touches */
#define COPLANAR 0.999 /* cosine of the angle of faces that are one */
#define SAME     1e-6  /* of the solid's size: points that are one */

typedef struct face {
    double n[3], corner[3], middle[3]; /* unit, towards the solid's centre */
} face;

typedef struct meeting {
    const se3di_solid *solid, *mesh;
    double origin[3]; /* of the solid, mesh frame */
    double center[3]; /* a point within it, mesh frame */
    double size;
    se3di_manifold *manifold;
    double parting; /* the least way out of edges where the least of all leads through faces */
    se3di_manifold parted;
} meeting;

static void to_mesh(const se3di_solid *mesh, const double x[3], double local[3])
{
    double d[3];
    se3di_sub(x, mesh->at->x, d);
    se3di_mul_transposed(mesh->at->R, d, local);
}

static const double *corner_of(const se3di_shape *s, uint32_t triangle, uint32_t k)
{
    return s->vertices + 3 * (size_t)s->triangles[3 * (size_t)triangle + k % 3];
}

/* Returns 0 if the solid's centre is behind it: only closed meshes have a behind. */
static int face_of(const meeting *m, uint32_t triangle, face *f)
{
    const se3di_shape *s = m->mesh->shape;
    double u[3], v[3];
    se3di_copy(corner_of(s, triangle, 0), f->corner);
    se3di_sub(corner_of(s, triangle, 1), f->corner, u);
    se3di_sub(corner_of(s, triangle, 2), f->corner, v);
    se3di_cross(u, v, f->n);
    se3di_scale(1.0 / se3di_norm(f->n), f->n, f->n);
    se3di_add(u, v, f->middle);
    se3di_scale(1.0 / 3.0, f->middle, f->middle);
    se3di_add(f->middle, f->corner, f->middle);
    se3di_sub(m->center, f->corner, u);
    int closed = m->mesh->shape->closed;
    if (closed ? closed < 0 : se3di_dot(u, f->n) < 0.0) {
        se3di_scale(-1.0, f->n, f->n);
    }
    return !(se3di_dot(u, f->n) < 0.0);
}

static double height_over(const face *f, const double x[3])
{
    double d[3];
    se3di_sub(x, f->corner, d);
    return se3di_dot(d, f->n);
}

/* Which way a normal looks: the same while it turns little. */
static uint32_t way_of(const double n[3])
{
    uint32_t a = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
    a = fabs(n[2]) > fabs(n[a]) ? 2 : a;
    return 2 * a + (n[a] < 0.0);
}

/* A contact at a place of the mesh's surface, if there is none yet. */
static void add(const meeting *m, const double at[3], const double n[3], double overlap,
                double radius, uint32_t feature)
{
    double point[3], normal[3], d[3];
    se3di_mul(m->mesh->at->R, at, point);
    se3di_add(point, m->mesh->at->x, point);
    se3di_mul(m->mesh->at->R, n, normal);
    se3di_scale(-1.0, normal, normal);
    for (uint32_t k = 0; k < m->manifold->count; ++k) {
        const se3di_contact_point *p = &m->manifold->points[k];
        se3di_sub(p->point, point, d);
        if (se3di_norm(d) < SAME * m->size && se3di_dot(p->normal, normal) > COPLANAR) {
            return;
        }
    }
    se3di_contact_point *p = se3di_manifold_add(m->manifold, point, normal, overlap, feature);
    p->share = 1.0;
    p->bend_i.r[0] = p->bend_i.r[1] = radius;
}

typedef struct corner_faces {
    const meeting *m;
    double x[3]; /* the corner, mesh frame */
    double depth[TOUCHES];
    face list[TOUCHES];
    int count;
} corner_faces;

/* Keep a face unless it is one with another, or behind the bulge that both are part of. */
static void keep_face(corner_faces *c, const face *f, double depth)
{
    int at = c->count;
    for (int k = 0; k < c->count; ++k) {
        const face *other = &c->list[k];
        int one = se3di_dot(other->n, f->n) > COPLANAR;
        int bulge = height_over(f, other->middle) < 0.0 && height_over(other, f->middle) < 0.0;
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
    if (!face_of(h->m, triangle, &other)) {
        return;
    }
    double least = SAME * h->m->size;
    h->found = h->found ||
               (height_over(h->own, other.middle) > least &&
                height_over(&other, h->own->middle) > least && height_over(&other, h->x) < 0.0);
}

static void meet_corner(void *ctx, uint32_t triangle)
{
    corner_faces *c = ctx;
    const meeting *m = c->m;
    const double *corner[3];
    face f;
    double foot[3], at[3];
    int in_front = face_of(m, triangle, &f);
    double height = height_over(&f, c->x);
    if (!(in_front && height < SAME * m->size && -height < m->size)) {
        return;
    }
    for (uint32_t k = 0; k < 3; ++k) {
        corner[k] = corner_of(m->mesh->shape, triangle, k);
    }
    se3di_copy(c->x, foot);
    se3di_add_scaled(-height, f.n, foot);
    if (se3di_triangle_nearest(corner, foot, at, NULL) > SAME * SAME * m->size * m->size) {
        hollow h = {m, &f, c->x, 0};
        se3di_mesh_visit(m->mesh->shape, at, SAME * m->size, meet_wall, &h);
        if (!h.found) {
            return;
        }
    }
    keep_face(c, &f, -height);
}

/* A corner of the solid, ground frame; `only`: on faces of this normal (mesh frame), or NULL. */
static void touch_corner(const meeting *m, const double x[3], const double *only, uint32_t feature)
{
    corner_faces c = {.m = m};
    to_mesh(m->mesh, x, c.x);
    se3di_mesh_visit(m->mesh->shape, c.x, m->size, meet_corner, &c);
    if (c.count > 0 && !se3di_mesh_crosses(m->mesh->shape, m->center, c.x)) {
        return; /* behind planes of faces, but not behind the surface */
    }
    for (int k = 0; k < c.count; ++k) {
        double at[3];
        if (!(c.depth[k] > 0.0) || (only && se3di_dot(c.list[k].n, only) < COPLANAR)) {
            continue; /* it only keeps others from counting */
        }
        se3di_copy(c.x, at);
        se3di_add_scaled(c.depth[k], c.list[k].n, at);
        add(m, at, c.list[k].n, c.depth[k], 0.0, 8 * feature + way_of(c.list[k].n));
    }
}

/* A ball of the solid, ground frame. */
static void touch_ball(const meeting *m, const double x[3], double radius, uint32_t feature)
{
    se3di_touch touches[TOUCHES];
    double local[3];
    to_mesh(m->mesh, x, local);
    size_t count = se3di_mesh_contacts(m->mesh->shape, local, radius, TOUCHES, touches);
    for (size_t k = 0; k < count; ++k) {
        const se3di_touch *t = &touches[k];
        add(m, t->point, t->normal, radius - t->distance, radius, 8 * feature + way_of(t->normal));
    }
}

typedef struct edge {
    const meeting *m;
    const double *a, *b; /* its ends */
    double middle[3];
    uint32_t triangle;
    int is_flat; /* or bulges away, or is another triangle's */
} edge;

/* Another triangle at the middle of an edge. */
static void meet_neighbour(void *ctx, uint32_t triangle)
{
    edge *e = ctx;
    face own, other;
    if (triangle == e->triangle) {
        return;
    }
    (void)face_of(e->m, e->triangle, &own);
    (void)face_of(e->m, triangle, &other);
    int continues = se3di_dot(own.n, other.n) > COPLANAR;
    int bulges = height_over(&own, other.middle) < 0.0 || height_over(&other, own.middle) < 0.0;
    e->is_flat = e->is_flat || continues || !bulges || triangle < e->triangle;
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
    (void)face_of(w->e->m, triangle, &f);
    se3di_sub(w->e->b, w->e->a, along);
    se3di_sub(f.middle, w->e->middle, inward);
    se3di_add_scaled(-se3di_dot(inward, along) / se3di_dot(along, along), along, inward);
    w->open = w->open && se3di_dot(w->n, inward) < SAME * se3di_norm(inward);
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

static int leads_out(const edge *e, const double n[3])
{
    double local[3], along[3];
    se3di_mul_transposed(e->m->mesh->at->R, n, local);
    wedge w = {e, local, 1};
    se3di_sub(e->b, e->a, along);
    se3di_mesh_visit(e->m->mesh->shape, e->middle, SAME * se3di_norm(along), meet_wedge, &w);
    return w.open;
}

/* What solid and edge touch by if they part along n, from the edge to the solid. */
typedef struct parting {
    const edge *e;
    const se3di_solid *segment;
    double depth, n[3];
    double lowest[3]; /* of the solid */
    double along[3];  /* of its edge; zero: a face */
} parting;

static void try_parting(parting *p, const double way[3], const double along[3])
{
    const double size = se3di_norm(way);
    double n[3], back[3], high[3], low[3], d[3];
    if (!(size > SAME * se3di_norm(along))) {
        return; /* parallel edges */
    }
    se3di_scale(1.0 / size, way, n);
    se3di_scale(-1.0, n, back);
    se3di_core_support(p->segment, n, high);
    se3di_core_support(p->e->m->solid, back, low);
    se3di_sub(high, low, d);
    const double depth = se3di_dot(d, n);
    if (depth > 0.0 && depth < p->depth && leads_out(p->e, n)) {
        p->depth = depth;
        se3di_copy(n, p->n);
        se3di_copy(low, p->lowest);
        se3di_copy(along, p->along);
    }
}

static void try_edge(parting *p, const double along[3])
{
    const double *R = p->segment->at->R;
    const double line[3] = {R[2], R[5], R[8]};
    double way[3], back[3];
    se3di_cross(along, line, way);
    se3di_scale(-1.0, way, back);
    try_parting(p, way, along);
    try_parting(p, back, along);
}

static void try_box(parting *p)
{
    static const double none[3] = {0.0, 0.0, 0.0};
    const double *R = p->e->m->solid->at->R;
    for (int k = 0; k < 3; ++k) {
        const double axis[3] = {R[k], R[3 + k], R[6 + k]};
        double back[3];
        se3di_scale(-1.0, axis, back);
        try_parting(p, axis, none);
        try_parting(p, back, none);
        try_edge(p, axis);
    }
}

static void try_hull(parting *p)
{
    static const double none[3] = {0.0, 0.0, 0.0};
    const se3di_solid *solid = p->e->m->solid;
    for (uint32_t k = 0; k < solid->shape->triangle_count; ++k) {
        double side[3][3], inward[3];
        for (uint32_t c = 0; c < 3; ++c) {
            double d[3];
            se3di_sub(corner_of(solid->shape, k, c + 1), corner_of(solid->shape, k, c), d);
            se3di_mul(solid->at->R, d, side[c]);
            try_edge(p, side[c]);
        }
        se3di_cross(side[1], side[0], inward);
        try_parting(p, inward, none);
    }
}

/* The point where two edges pass, on that of the mesh; returns 0 if one passes beyond its end. */
static int edges_pass(const parting *p, double at[3])
{
    const double *R = p->segment->at->R;
    const double line[3] = {R[2], R[5], R[8]};
    double d[3], across[3];
    se3di_cross(p->along, p->n, across); /* in the plane of both, perpendicular to the edge */
    se3di_sub(p->lowest, p->segment->at->x, d);
    const double t = se3di_dot(d, across) / se3di_dot(line, across);
    se3di_copy(p->segment->at->x, at);
    se3di_add_scaled(t, line, at);
    return fabs(t) <= p->segment->shape->half_length;
}

/* A box or hull that is least deep in the edge where this leads through the faces beside it: the
 * least way out between them. */
static void part_from_edge(meeting *m, const edge *e, const se3di_solid *segment)
{
    const se3di_solid *solid = m->solid;
    parting p = {.e = e, .segment = segment, .depth = m->parting};
    double back[3], at[3];
    if (solid->shape->kind == SE3DI_SHAPE_BOX) {
        try_box(&p);
    } else if (solid->shape->kind == SE3DI_SHAPE_HULL) {
        try_hull(&p);
    }
    const int is_face = !(se3di_norm(p.along) > 0.0);
    if (!(p.depth < m->parting) || !(is_face || edges_pass(&p, at))) {
        return;
    }
    m->parting = p.depth;
    m->parted.count = 0;
    se3di_scale(-1.0, p.n, back);
    if (is_face) {
        se3di_face side, flat;
        se3di_face_find(solid, back, &side);
        se3di_face_find(segment, p.n, &flat);
        se3di_narrow_clip(&side, &flat, side.normal, 0.0, 0, &m->parted);
    } else {
        (void)se3di_manifold_add(&m->parted, at, back, p.depth, 0);
    }
}

/* All contacts with lines. */
static void add_lines(const meeting *m, const se3di_manifold *lines, const edge *e,
                      uint32_t feature)
{
    for (uint32_t k = 0; k < lines->count; ++k) {
        double here[3], back[3], n[3];
        se3di_scale(-1.0, lines->points[k].normal, back);
        if (!e || leads_out(e, back)) {
            to_mesh(m->mesh, lines->points[k].point, here);
            se3di_mul_transposed(m->mesh->at->R, back, n);
            add(m, here, n, lines->points[k].overlap, se3di_core_radius(m->solid->shape),
                feature + k);
        }
    }
}

static void touch_edge(meeting *m, edge *e, uint32_t feature)
{
    double n[3], on_i[3], on_j[3];
    se3di_shape line;
    se3di_shape_pose at;
    se3di_solid segment = {&line, &at};
    double length = place_edge(e, &line, &at);
    double radius = se3di_core_radius(m->solid->shape);
    if (!(se3di_convex_distance(m->solid, &segment, n, on_i, on_j) + radius > 0.0)) {
        return;
    }
    se3di_mesh_visit(m->mesh->shape, e->middle, SAME * length, meet_neighbour, e);
    if (e->is_flat) {
        return;
    }
    const uint32_t before = m->manifold->count;
    se3di_manifold lines = {.count = 0};
    se3di_narrow_convex(m->solid, &segment, &lines);
    add_lines(m, &lines, e, feature);
    if (m->manifold->count == before) {
        part_from_edge(m, e, &segment);
    }
}

static void meet_edges(void *ctx, uint32_t triangle)
{
    meeting *m = ctx;
    const se3di_shape *s = m->mesh->shape;
    for (uint32_t k = 0; k < 3; ++k) {
        edge e = {m, corner_of(s, triangle, k), corner_of(s, triangle, k + 1), {0.0}, triangle, 0};
        se3di_add(e.a, e.b, e.middle);
        se3di_scale(0.5, e.middle, e.middle);
        touch_edge(m, &e, 0x80000000u + 16 * (3 * triangle + k));
    }
}

static void touch_corners(const meeting *m)
{
    const se3di_shape *s = m->solid->shape;
    double local[3], x[3];
    uint32_t count = s->kind == SE3DI_SHAPE_HULL ? (uint32_t)s->vertex_count : 8;
    for (uint32_t k = 0; k < count; ++k) {
        if (s->kind == SE3DI_SHAPE_HULL) {
            se3di_copy(s->vertices + 3 * (size_t)k, local);
        } else {
            for (uint32_t a = 0; a < 3; ++a) {
                local[a] = k >> a & 1u ? s->half[a] : -s->half[a];
            }
        }
        se3di_mul(m->solid->at->R, local, x);
        se3di_add(m->solid->at->x, x, x);
        touch_corner(m, x, NULL, k);
    }
}

static void touch_ends(const meeting *m)
{
    const se3di_shape *s = m->solid->shape;
    const double *R = m->solid->at->R;
    double axis[3] = {R[2], R[5], R[8]}, x[3];
    for (uint32_t end = 0; end < (s->kind == SE3DI_SHAPE_SPHERE ? 1u : 2u); ++end) {
        se3di_copy(m->solid->at->x, x);
        se3di_add_scaled(s->kind == SE3DI_SHAPE_SPHERE ? 0.0
                         : end                         ? s->half_length
                                                       : -s->half_length,
                         axis, x);
        touch_ball(m, x, s->radius, end);
    }
}

/* The points of the rims that are lowest on a face, as on a plane. */
static void meet_rims(void *ctx, uint32_t triangle)
{
    const meeting *m = ctx;
    const double *corner[3];
    double normal[3], rim[8][3];
    face f;
    if (!face_of(m, triangle, &f)) {
        return;
    }
    for (uint32_t k = 0; k < 3; ++k) {
        corner[k] = corner_of(m->mesh->shape, triangle, k);
    }
    se3di_mul(m->mesh->at->R, f.n, normal);
    se3di_cylinder_rims(m->solid, normal, rim);
    for (uint32_t k = 0; k < 8; ++k) {
        double x[3], at[3];
        to_mesh(m->mesh, rim[k], x);
        double height = height_over(&f, x);
        se3di_add_scaled(-height, f.n, x);
        if (height < 0.0 && -height < m->size &&
            se3di_triangle_nearest(corner, x, at, NULL) < m->size * m->size) {
            touch_corner(m, rim[k], f.n, k);
        }
    }
}

/* A triangle that a solid cuts through if none of its corners and no edge of the mesh that
 * bulges touch (sharp ones, in hollows): pushed apart as convex shapes are, but not through the
 * surface. */
static void meet_rest(void *ctx, uint32_t triangle)
{
    static const uint32_t whole[3] = {0, 1, 2};
    const meeting *m = ctx;
    double corners[9], down[3], lowest[3], n[3], back[3], on_i[3], on_j[3];
    face f;
    if (!face_of(m, triangle, &f)) {
        return;
    }
    se3di_mul(m->mesh->at->R, f.n, down);
    se3di_scale(-1.0, down, down);
    se3di_core_support(m->solid, down, lowest);
    to_mesh(m->mesh, lowest, lowest);
    const double radius = se3di_core_radius(m->solid->shape);
    double depth = radius - height_over(&f, lowest);
    if (!(depth > 0.0)) {
        return; /* all of it is in front */
    }
    for (uint32_t k = 0; k < 3; ++k) {
        se3di_copy(corner_of(m->mesh->shape, triangle, k), corners + 3 * (size_t)k);
    }
    const se3di_shape flat = {.kind = SE3DI_SHAPE_HULL,
                              .bound = m->mesh->shape->bound,
                              .vertices = corners,
                              .triangles = (uint32_t *)(uintptr_t)whole,
                              .vertex_count = 3,
                              .triangle_count = 1};
    const se3di_solid other = {&flat, m->mesh->at};
    double overlap = se3di_convex_distance(m->solid, &other, n, on_i, on_j) + radius;
    if (!(overlap > 0.0)) {
        return;
    }
    to_mesh(m->mesh, on_j, on_j);
    se3di_mul_transposed(m->mesh->at->R, n, back);
    se3di_scale(-1.0, back, back);
    if (se3di_dot(back, f.n) < 0.0) {
        add(m, on_j, f.n, depth, radius, 0x40000000u + triangle);
    } else {
        add(m, on_j, back, overlap, radius, 0x40000000u + triangle);
    }
}

/* Points are told apart by their features. */
static void separate_features(se3di_manifold *manifold)
{
    for (uint32_t k = 1; k < manifold->count; ++k) {
        for (uint32_t other = 0; other < k; ++other) {
            if (manifold->points[other].feature == manifold->points[k].feature) {
                manifold->points[k].feature += 0x01000000u;
                other = UINT32_MAX; /* all again */
            }
        }
    }
}

/* Hulls may have their origin anywhere. */
static void find_center(meeting *m)
{
    const se3di_shape *s = m->solid->shape;
    double mean[3] = {0.0, 0.0, 0.0}, x[3];
    for (size_t k = 0; k < s->vertex_count && s->kind == SE3DI_SHAPE_HULL; ++k) {
        se3di_add_scaled(1.0 / (double)s->vertex_count, s->vertices + 3 * k, mean);
    }
    se3di_mul(m->solid->at->R, mean, x);
    se3di_add(x, m->solid->at->x, x);
    to_mesh(m->mesh, x, m->center);
    to_mesh(m->mesh, m->solid->at->x, m->origin);
}

void se3di_narrow_mesh(const se3di_solid *i, const se3di_solid *mesh, se3di_manifold *manifold)
{
    const se3di_shape *s = i->shape;
    meeting m;
    memset(&m, 0, offsetof(meeting, parted));
    m.solid = i;
    m.mesh = mesh;
    m.manifold = manifold;
    m.parted.count = 0;
    m.size = s->kind == SE3DI_SHAPE_BOX        ? fmin(s->half[0], fmin(s->half[1], s->half[2]))
             : s->kind == SE3DI_SHAPE_HULL     ? 0.5 * s->bound
             : s->kind == SE3DI_SHAPE_CYLINDER ? fmin(s->radius, s->half_length)
                                               : s->radius;
    m.parting = m.size;
    find_center(&m);
    if (s->kind == SE3DI_SHAPE_SPHERE || s->kind == SE3DI_SHAPE_CAPSULE) {
        touch_ends(&m);
    } else if (s->kind == SE3DI_SHAPE_CYLINDER) {
        se3di_mesh_visit(mesh->shape, m.origin, s->bound, meet_rims, &m);
    } else {
        touch_corners(&m);
    }
    if (s->kind != SE3DI_SHAPE_SPHERE) {
        se3di_mesh_visit(mesh->shape, m.origin, s->bound, meet_edges, &m);
        if (manifold->count == 0) {
            add_lines(&m, &m.parted, NULL, 0x80000008u);
        }
        if (manifold->count == 0) {
            se3di_mesh_visit(mesh->shape, m.origin, s->bound, meet_rest, &m);
        }
        separate_features(manifold);
    }
}

#define WAYS 8 /* directions in the plane in which vertices are chosen */

/* Of the vertices below a plane the deepest, and those farthest to all sides. */
void se3di_narrow_mesh_plane(const se3di_solid *mesh, const double x[3], const double n[3],
                             se3di_manifold *manifold)
{
    static const double turn[WAYS][2] = {{1.0, 0.0},  {0.7, 0.7},   {0.0, 1.0},  {-0.7, 0.7},
                                         {-1.0, 0.0}, {-0.7, -0.7}, {0.0, -1.0}, {0.7, -0.7}};
    const se3di_shape *s = mesh->shape;
    double local_n[3], u[3], w[3], base[3], best[WAYS + 1];
    uint32_t chosen[WAYS + 1];
    meeting m = {.solid = mesh, .mesh = mesh, .size = s->bound, .manifold = manifold};
    se3di_mul_transposed(mesh->at->R, n, local_n);
    to_mesh(mesh, x, base);
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
        add(&m, at, local_n, depth, 0.0, chosen[k]);
    }
}
