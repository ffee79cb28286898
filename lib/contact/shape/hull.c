/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex hulls, point by point: the faces that see a new point give way to a cone from the edge
 * around them to the point. Points nearer to a face than rounding are on it. */
#include "contact/shape/hull.h"

#include "contact/shape/triangles.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <float.h>
#include <math.h>

#define VERTICES_MAX 10000

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

void se3di_hull_set_planes(se3di_shape *shape)
{
    for (size_t k = 0; k < shape->triangle_count; ++k) {
        const double *corner[3];
        se3di_triangle_corners(shape, k, corner);
        se3di_triangle_normal(corner, shape->planes + 4 * k);
        shape->planes[4 * k + 3] = se3di_dot(shape->planes + 4 * k, corner[0]);
    }
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
    shape->planes = se3di_alloc(a, 4 * h->face_count, sizeof(double));
    if (shape->triangles && shape->planes) {
        shape->triangle_count = h->face_count;
    } else {
        se3di_free(a, shape->triangles, 3 * h->face_count, sizeof(uint32_t));
        se3di_free(a, shape->planes, 4 * h->face_count, sizeof(double));
        shape->triangles = NULL;
        shape->planes = NULL;
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
    if (!shape->vertices || !shape->triangles) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3di_hull_set_planes(shape);
    return SE3D_OK;
}

se3d_status se3di_hull_build(const se3d_allocator *allocator, const double *points, size_t count,
                             se3di_shape *shape)
{
    hull h = {.allocator = allocator, .points = points, .count = count};
    shape->vertices = NULL;
    shape->triangles = NULL;
    shape->planes = NULL;
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

/* The hull's corners and faces replace the given points; the arrays are the shape's own. */
static se3d_status define_hull(const se3d_shape_def *def, const se3d_allocator *allocator,
                               se3di_shape *shape, se3di_error *error)
{
    SE3DI_TRY(se3di_vertices_define(def, shape, error));
    if (def->vertex_count > VERTICES_MAX) {
        return se3di_error_set_of(error, "vertex_count", SE3D_ERR_INVALID_ARGUMENT,
                                  " = %zu of a hull, must be at most %d", def->vertex_count,
                                  VERTICES_MAX);
    }
    se3d_status status = se3di_hull_build(allocator, def->vertices, def->vertex_count, shape);
    if (status == SE3D_ERR_INVALID_ARGUMENT) {
        return se3di_error_set(error, status,
                               "the %zu vertices of the hull lie in one plane, must span a volume",
                               def->vertex_count);
    }
    return status < 0 ? se3di_error_set(error, status, "no memory for a hull") : SE3D_OK;
}

/* Of all triangles. */
static void nearest_triangle(const se3di_shape *s, const double local[3], double point[3],
                             double *distance)
{
    double least = HUGE_VAL;
    for (size_t k = 0; k < s->triangle_count; ++k) {
        const double *corner[3];
        double here[3];
        se3di_triangle_corners(s, k, corner);
        double square = se3di_triangle_nearest(corner, local, here, NULL);
        if (square < least) {
            least = square;
            se3di_copy(here, point);
        }
    }
    *distance = sqrt(least);
}

static void nearest_hull(const se3di_shape *s, const double local[3], double point[3],
                         double normal[3], double *distance)
{
    double depth = -HUGE_VAL; /* above the plane of the face that is seen best */
    double outward[3] = {0.0, 0.0, 1.0};
    for (size_t k = 0; k < s->triangle_count; ++k) {
        double n[3];
        const double offset = se3di_face_plane(s, k, n), height = se3di_dot(local, n) - offset;
        if (height > depth) {
            depth = height;
            se3di_copy(n, outward);
        }
    }
    if (depth > 0.0) {
        nearest_triangle(s, local, point, distance);
        if (*distance > 1e-12 * s->bound) {
            se3di_sub(local, point, normal);
            se3di_scale(1.0 / *distance, normal, normal);
            return;
        }
    }
    *distance = depth;
    se3di_copy(outward, normal);
    se3di_copy(local, point);
    se3di_add_scaled(-depth, outward, point);
}

static int corner_hull(const se3di_shape *s, uint32_t k, double out[3])
{
    if (k >= s->vertex_count) {
        return 0;
    }
    se3di_copy(s->vertices + 3 * (size_t)k, out);
    return 1;
}

/* The plane of a face: two directions in it, and its middle. */
typedef struct face_plane {
    const se3di_shape *s;
    double u[3], w[3], center[3], n[3], level, slack;
} face_plane;

static int is_new(const face_plane *plane, uint32_t vertex, const uint32_t *list, int count)
{
    const double *x = plane->s->vertices + 3 * (size_t)vertex;
    for (int k = 0; k < count; ++k) {
        double d[3];
        se3di_sub(plane->s->vertices + 3 * (size_t)list[k], x, d);
        if (!(se3di_norm(d) > plane->slack)) {
            return 0;
        }
    }
    return 1;
}

/* Insert a corner of the polygon about the middle by its angle from u. */
static void insert_corner(const face_plane *plane, uint32_t vertex, uint32_t *list, double *angle,
                          int *count)
{
    double d[3];
    se3di_sub(plane->s->vertices + 3 * (size_t)vertex, plane->center, d);
    double turn = se3di_atan2(se3di_dot(d, plane->w), se3di_dot(d, plane->u));
    int at = *count;
    for (; at > 0 && angle[at - 1] > turn; --at) {
        angle[at] = angle[at - 1];
        list[at] = list[at - 1];
    }
    angle[at] = turn;
    list[at] = vertex;
    ++*count;
}

/* Whether the polygon turns left at its corner k. */
static int is_corner(const face_plane *plane, const uint32_t *list, int count, int k)
{
    const double *v = plane->s->vertices;
    const double *x = v + 3 * (size_t)list[k];
    double before[3], after[3], turn[3];
    se3di_sub(x, v + 3 * (size_t)list[(k + count - 1) % count], before);
    se3di_sub(v + 3 * (size_t)list[(k + 1) % count], x, after);
    se3di_cross(before, after, turn);
    return se3di_dot(turn, plane->n) > plane->slack * plane->s->bound;
}

/* Vertices within the face and on its sides are no corners of it. */
static void drop_inner(const face_plane *plane, uint32_t *list, int *count)
{
    for (int k = 0; *count > 3 && k < *count; ++k) {
        if (!is_corner(plane, list, *count, k)) {
            for (int c = k; c + 1 < *count; ++c) {
                list[c] = list[c + 1];
            }
            --*count;
            k = -1; /* all again */
        }
    }
}

static int is_on(const face_plane *plane, uint32_t vertex)
{
    return se3di_dot(plane->s->vertices + 3 * (size_t)vertex, plane->n) >
           plane->level - plane->slack;
}

/* Of more corners than there is room for those that are farthest to all sides. */
static void insert_farthest(const face_plane *plane, uint32_t *list, double *angle, int *count)
{
    *count = 0;
    for (int k = 0; k < SE3DI_FACE_CORNERS; ++k) {
        const double turn = 6.283185307179586 * k / SE3DI_FACE_CORNERS;
        double way[3], most = -HUGE_VAL;
        uint32_t best = 0;
        se3di_scale(se3di_cos(turn), plane->u, way);
        se3di_add_scaled(se3di_sin(turn), plane->w, way);
        for (uint32_t v = 0; v < plane->s->vertex_count; ++v) {
            const double far = se3di_dot(plane->s->vertices + 3 * (size_t)v, way);
            if (far > most + plane->slack && is_on(plane, v)) {
                most = far;
                best = v;
            }
        }
        if (is_new(plane, best, list, *count)) {
            insert_corner(plane, best, list, angle, count);
        }
    }
}

/* All vertices in the plane of the triangle that looks along d best. */
static void face_hull(const se3di_solid *solid, const double d[3], se3di_face *face)
{
    const se3di_shape *s = solid->shape;
    double n[3] = {0.0, 0.0, 1.0}, best = -HUGE_VAL;
    size_t triangle = 0;
    for (size_t k = 0; k < s->triangle_count; ++k) {
        double here[3];
        (void)se3di_face_plane(s, k, here);
        if (se3di_dot(here, d) > best + 1e-9) { /* of equal ones the first */
            best = se3di_dot(here, d);
            triangle = k;
            se3di_copy(here, n);
        }
    }
    face_plane plane = {.s = s, .slack = 1e-9 * s->bound};
    plane.level = se3di_dot(s->vertices + 3 * (size_t)s->triangles[3 * triangle], n);
    uint32_t list[SE3DI_FACE_CORNERS];
    double angle[SE3DI_FACE_CORNERS];
    for (size_t k = 0; k < 3; ++k) {
        se3di_add_scaled(1.0 / 3.0, s->vertices + 3 * (size_t)s->triangles[3 * triangle + k],
                         plane.center);
    }
    se3di_copy(n, plane.n);
    se3di_perpendicular(n, plane.u);
    se3di_cross(n, plane.u, plane.w);
    face->count = 0;
    for (uint32_t k = 0; k < s->vertex_count; ++k) {
        if (!is_on(&plane, k) || !is_new(&plane, k, list, face->count)) {
            continue;
        }
        if (face->count == SE3DI_FACE_CORNERS) {
            insert_farthest(&plane, list, angle, &face->count);
            break;
        }
        insert_corner(&plane, k, list, angle, &face->count);
    }
    drop_inner(&plane, list, &face->count);
    face->id = (uint32_t)triangle;
    se3di_mul(solid->at->R, n, face->normal);
    for (int k = 0; k < face->count; ++k) {
        se3di_solid_to_ground(solid, s->vertices + 3 * (size_t)list[k], face->corner[k]);
    }
}

const se3di_shape_class se3di_shape_class_hull = {
    .name = "hull",
    .define = define_hull,
    .bound = se3di_vertices_bound,
    .size = se3di_vertices_size,
    .nearest = nearest_hull,
    .support = se3di_vertices_support,
    .face = face_hull,
    .corner = corner_hull,
};
