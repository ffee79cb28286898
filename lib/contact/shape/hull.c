/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex hulls, point by point: the faces that see a new point give way to a cone from the edge
 * around them to the point. Points nearer to a face than rounding are on it. */
#include "contact/shape/hull.h"

#include "math/vec3.h"

#include <float.h>
#include <math.h>

typedef struct hull_face {
    uint32_t corner[3];
    double normal[3], offset;
} hull_face;

typedef struct hull_edge {
    uint32_t from, to;
} hull_edge;

typedef struct hull {
    const se3d_allocator *allocator;
    const double *points;
    size_t count;
    double tolerance;
    double inside[3];
    hull_face *faces;
    size_t face_count, face_capacity;
    hull_edge *edges; /* around the faces that see */
    size_t edge_count, edge_capacity;
} hull;

static const double *point_of(const hull *h, uint32_t k)
{
    return h->points + 3 * (size_t)k;
}

static se3d_status add_face(hull *h, uint32_t a, uint32_t b, uint32_t c)
{
    void *memory = h->faces;
    se3d_status status = se3di_array_reserve(h->allocator, &memory, &h->face_capacity,
                                             h->face_count + 1, sizeof *h->faces);
    h->faces = memory;
    SE3DI_TRY(status);
    double u[3], v[3], n[3], d[3];
    se3di_sub(point_of(h, b), point_of(h, a), u);
    se3di_sub(point_of(h, c), point_of(h, a), v);
    se3di_cross(u, v, n);
    double length = se3di_norm(n);
    se3di_scale(length > 0.0 ? 1.0 / length : 0.0, n, n);
    se3di_sub(h->inside, point_of(h, a), d);
    int flip = se3di_dot(n, d) > 0.0;
    se3di_scale(flip ? -1.0 : 1.0, n, n);
    hull_face *face = &h->faces[h->face_count++];
    *face = (hull_face){.corner = {a, flip ? c : b, flip ? b : c}};
    se3di_copy(n, face->normal);
    face->offset = se3di_dot(n, point_of(h, a));
    return SE3D_OK;
}

static double height(const hull_face *face, const double p[3])
{
    return se3di_dot(face->normal, p) - face->offset;
}

/* Keep an edge unless its opposite is there: then both are between faces that see. */
static se3d_status toggle_edge(hull *h, uint32_t from, uint32_t to)
{
    for (size_t k = 0; k < h->edge_count; ++k) {
        if (h->edges[k].from == to && h->edges[k].to == from) {
            h->edges[k] = h->edges[--h->edge_count];
            return SE3D_OK;
        }
    }
    void *memory = h->edges;
    se3d_status status = se3di_array_reserve(h->allocator, &memory, &h->edge_capacity,
                                             h->edge_count + 1, sizeof *h->edges);
    h->edges = memory;
    SE3DI_TRY(status);
    h->edges[h->edge_count++] = (hull_edge){from, to};
    return SE3D_OK;
}

static se3d_status add_point(hull *h, uint32_t point)
{
    h->edge_count = 0;
    size_t kept = 0;
    for (size_t k = 0; k < h->face_count; ++k) {
        const hull_face face = h->faces[k];
        if (!(height(&face, point_of(h, point)) > h->tolerance)) {
            h->faces[kept++] = face;
            continue;
        }
        for (int e = 0; e < 3; ++e) {
            SE3DI_TRY(toggle_edge(h, face.corner[e], face.corner[(e + 1) % 3]));
        }
    }
    h->face_count = kept;
    for (size_t k = 0; k < h->edge_count; ++k) {
        SE3DI_TRY(add_face(h, h->edges[k].from, h->edges[k].to, point));
    }
    return SE3D_OK;
}

/* What is farthest from the points chosen so far: from a point, a line, a plane. */
static double spread(const hull *h, const uint32_t *chosen, int dimension, const double p[3])
{
    double d[3], u[3], v[3], n[3];
    const double *origin = point_of(h, chosen[0]);
    se3di_sub(p, origin, d);
    if (dimension == 0) {
        return se3di_norm(d);
    }
    se3di_sub(point_of(h, chosen[1]), origin, u);
    if (dimension == 1) {
        se3di_cross(u, d, n);
        return se3di_norm(n) / se3di_norm(u);
    }
    se3di_sub(point_of(h, chosen[2]), origin, v);
    se3di_cross(u, v, n);
    return fabs(se3di_dot(n, d)) / se3di_norm(n);
}

/* Four points that span a tetrahedron. */
static se3d_status start(hull *h)
{
    uint32_t chosen[4] = {0, 0, 0, 0};
    double extent = 0.0;
    for (int dimension = 0; dimension < 3; ++dimension) {
        double most = 0.0;
        for (uint32_t k = 0; k < h->count; ++k) {
            double here = spread(h, chosen, dimension, point_of(h, k));
            if (here > most) {
                most = here;
                chosen[dimension + 1] = k;
            }
        }
        extent = dimension == 0 ? most : extent;
        if (!(most > 1e-9 * extent)) {
            return SE3D_ERR_INVALID_ARGUMENT;
        }
    }
    for (int k = 0; k < 4; ++k) {
        se3di_add_scaled(0.25, point_of(h, chosen[k]), h->inside);
    }
    h->tolerance = 64.0 * DBL_EPSILON * (extent + se3di_norm(point_of(h, 0)));
    for (int k = 0; k < 4; ++k) {
        SE3DI_TRY(add_face(h, chosen[k], chosen[(k + 1) % 4], chosen[(k + 2) % 4]));
    }
    return SE3D_OK;
}

/* The corners that are used, in the order of the points. */
static se3d_status write_shape(const hull *h, se3di_shape *shape)
{
    const se3d_allocator *a = h->allocator;
    uint32_t *number = se3di_alloc(a, h->count, sizeof *number);
    uint32_t used = 0;
    if (!number) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t k = 0; k < 3 * h->face_count; ++k) {
        number[h->faces[k / 3].corner[k % 3]] = 1;
    }
    for (size_t k = 0; k < h->count; ++k) {
        used += number[k];
    }
    shape->vertices = se3di_alloc(a, 3 * (size_t)used, sizeof(double));
    shape->triangles = se3di_alloc(a, 3 * h->face_count, sizeof(uint32_t));
    if (shape->vertices) {
        shape->vertex_count = used;
    }
    if (shape->triangles) {
        shape->triangle_count = h->face_count;
    }
    uint32_t next = 0;
    for (uint32_t k = 0; k < h->count && shape->vertices; ++k) {
        if (number[k]) {
            se3di_copy(point_of(h, k), shape->vertices + 3 * (size_t)next);
            number[k] = next++;
        }
    }
    for (size_t k = 0; k < 3 * shape->triangle_count; ++k) {
        shape->triangles[k] = number[h->faces[k / 3].corner[k % 3]];
    }
    se3di_free(a, number, h->count, sizeof *number);
    return shape->vertices && shape->triangles ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

se3d_status se3di_hull_build(const se3d_allocator *allocator, const double *points, size_t count,
                             se3di_shape *shape)
{
    hull h = {.allocator = allocator, .points = points, .count = count};
    shape->vertices = NULL;
    shape->triangles = NULL;
    shape->vertex_count = shape->triangle_count = 0;
    se3d_status status = start(&h);
    for (uint32_t k = 0; k < count && status == SE3D_OK; ++k) {
        status = add_point(&h, k);
    }
    if (status == SE3D_OK) {
        status = write_shape(&h, shape);
    }
    se3di_free(allocator, h.faces, h.face_capacity, sizeof *h.faces);
    se3di_free(allocator, h.edges, h.edge_capacity, sizeof *h.edges);
    if (status < 0) {
        char *name = shape->name;
        shape->name = NULL;
        se3di_shape_release(allocator, shape);
        shape->name = name;
    }
    return status;
}
