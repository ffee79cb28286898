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

/* Returns 0 where the solid's centre is behind it: only closed meshes have a behind. */
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

/* A contact at a place of the mesh's surface, where there is none yet. */
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

/* A corner of the solid, ground frame. */
static void touch_corner(const meeting *m, const double x[3], uint32_t feature)
{
    corner_faces c = {.m = m};
    to_mesh(m->mesh, x, c.x);
    se3di_mesh_visit(m->mesh->shape, c.x, m->size, meet_corner, &c);
    for (int k = 0; k < c.count; ++k) {
        double at[3];
        if (!(c.depth[k] > 0.0)) {
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

static void touch_edge(edge *e, uint32_t feature)
{
    const meeting *m = e->m;
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
    se3di_manifold lines = {.count = 0};
    if (!e->is_flat) {
        se3di_narrow_convex(m->solid, &segment, &lines);
    }
    for (uint32_t k = 0; k < lines.count; ++k) {
        double here[3], back[3];
        to_mesh(m->mesh, lines.points[k].point, here);
        se3di_mul_transposed(m->mesh->at->R, lines.points[k].normal, back);
        se3di_scale(-1.0, back, back);
        add(m, here, back, lines.points[k].overlap, radius, feature + k);
    }
}

static void meet_edges(void *ctx, uint32_t triangle)
{
    const meeting *m = ctx;
    const se3di_shape *s = m->mesh->shape;
    for (uint32_t k = 0; k < 3; ++k) {
        edge e = {m, corner_of(s, triangle, k), corner_of(s, triangle, k + 1), {0.0}, triangle, 0};
        se3di_add(e.a, e.b, e.middle);
        se3di_scale(0.5, e.middle, e.middle);
        touch_edge(&e, 0x80000000u + 16 * (3 * triangle + k));
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
        touch_corner(m, x, k);
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

/* The points of the rims that are lowest on the nearest face, as on a plane. */
static void touch_rims(const meeting *m)
{
    double point[3], distance, n[3], normal[3], rim[8][3];
    uint32_t triangle = (uint32_t)se3di_mesh_nearest(m->mesh->shape, m->center, point, &distance);
    face f;
    (void)face_of(m, triangle, &f);
    se3di_copy(f.n, n);
    se3di_mul(m->mesh->at->R, n, normal);
    se3di_cylinder_rims(m->solid, normal, rim);
    for (uint32_t k = 0; k < 8; ++k) {
        touch_corner(m, rim[k], k);
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
    meeting m = {.solid = i, .mesh = mesh, .manifold = manifold};
    m.size = s->kind == SE3DI_SHAPE_BOX        ? fmin(s->half[0], fmin(s->half[1], s->half[2]))
             : s->kind == SE3DI_SHAPE_HULL     ? 0.5 * s->bound
             : s->kind == SE3DI_SHAPE_CYLINDER ? fmin(s->radius, s->half_length)
                                               : s->radius;
    find_center(&m);
    if (s->kind == SE3DI_SHAPE_SPHERE || s->kind == SE3DI_SHAPE_CAPSULE) {
        touch_ends(&m);
    } else if (s->kind == SE3DI_SHAPE_CYLINDER) {
        touch_rims(&m);
    } else {
        touch_corners(&m);
    }
    if (s->kind != SE3DI_SHAPE_SPHERE) {
        se3di_mesh_visit(mesh->shape, m.origin, s->bound, meet_edges, &m);
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
