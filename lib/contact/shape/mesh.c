/* SPDX-License-Identifier: BSD-3-Clause */
/* Triangles in a tree of boxes, and how a sphere touches them.
 *
 * The distance to the mesh has a minimum where the sphere touches. A triangle's nearest point is
 * such a minimum unless it lies on another triangle that comes nearer: then the way down leads
 * there. So triangles are visited from the nearest on, and one whose point lies on an earlier one
 * is left out: on the edge between coplanar triangles a sphere has one contact, in a corner as many
 * as there are faces, on a convex edge or vertex one.                      docs/theory/shapes.md */
#include "contact/shape/mesh.h"

#include "contact/shape/grid.h"
#include "contact/shape/mesh_tree.h"
#include "contact/shape/pieces.h"
#include "contact/shape/triangles.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define LEAF_SIZE       SE3DI_MESH_LEAF
#define STACK_SIZE      64    /* median splits: the depth is at most 32 */
#define CANDIDATES      128   /* triangles within reach of one sphere that are told apart */
#define AT_EDGE         1e-6  /* of its length: a triangle is at the middle of an edge */
#define COPLANAR        0.999 /* cosine of the angle of triangles that are one */
#define TOLD            4     /* bits of an edge */
#define ON_TRIANGLE     1e-8  /* of the radius: a point is on a triangle */
#define FLAT            1e-9  /* of the size: a vertex is in the plane of a face */
#define CONVEX_MOST     1000  /* triangles; more are found faster by the tree */
#define SLENDER         1e-6  /* twice the area over the square of a long side */
#define NEARLY_COPLANAR 0.999 /* cosine of the angle of normals that are one contact */

typedef se3di_mesh_node mesh_node;
typedef se3di_mesh_facet facet;

typedef struct builder {
    const double *vertices;
    uint32_t *triangles;
    mesh_node *nodes;
    uint32_t node_count;
} builder;

static double middle(const builder *b, uint32_t triangle, int axis)
{
    const uint32_t *t = b->triangles + 3 * (size_t)triangle;
    return b->vertices[3 * (size_t)t[0] + (size_t)axis] +
           b->vertices[3 * (size_t)t[1] + (size_t)axis] +
           b->vertices[3 * (size_t)t[2] + (size_t)axis];
}

static void swap(builder *b, uint32_t i, uint32_t j)
{
    for (int k = 0; k < 3; ++k) {
        uint32_t here = b->triangles[3 * (size_t)i + (size_t)k];
        b->triangles[3 * (size_t)i + (size_t)k] = b->triangles[3 * (size_t)j + (size_t)k];
        b->triangles[3 * (size_t)j + (size_t)k] = here;
    }
}

/* Order [begin, end) such that the `half` smallest along the axis come first. */
static void split(builder *b, uint32_t begin, uint32_t end, uint32_t half, int axis)
{
    uint32_t target = begin + half;
    while (end - begin > 1) {
        double pivot = middle(b, begin + (end - begin) / 2, axis);
        uint32_t low = begin;
        uint32_t at = begin;
        uint32_t high = end;
        while (at < high) { /* smaller, equal, larger */
            double here = middle(b, at, axis);
            if (here < pivot) {
                swap(b, low++, at++);
            } else if (here > pivot) {
                swap(b, at, --high);
            } else {
                ++at;
            }
        }
        if (target < low) {
            end = low;
        } else if (target >= high) {
            begin = high;
        } else {
            return;
        }
    }
}

static void bound(const builder *b, uint32_t begin, uint32_t count, mesh_node *node)
{
    for (int a = 0; a < 3; ++a) {
        node->low[a] = HUGE_VAL;
        node->high[a] = -HUGE_VAL;
    }
    for (size_t k = 3 * (size_t)begin; k < 3 * ((size_t)begin + count); ++k) {
        const double *p = b->vertices + 3 * (size_t)b->triangles[k];
        for (int a = 0; a < 3; ++a) {
            node->low[a] = fmin(node->low[a], p[a]);
            node->high[a] = fmax(node->high[a], p[a]);
        }
    }
}

/* Recursion: the depth is the logarithm of the number of triangles. */
static void build(builder *b, uint32_t begin, uint32_t count)
{
    uint32_t at = b->node_count++;
    mesh_node node = {.begin = begin, .count = count};
    bound(b, begin, count, &node);
    b->nodes[at] = node;
    if (count <= LEAF_SIZE) {
        return;
    }
    int axis = 0;
    for (int a = 1; a < 3; ++a) {
        axis = node.high[a] - node.low[a] > node.high[axis] - node.low[axis] ? a : axis;
    }
    uint32_t half = count / 2;
    split(b, begin, begin + count, half, axis);
    build(b, begin, half);
    b->nodes[at].count = 0;
    b->nodes[at].right = b->node_count;
    build(b, begin + half, count - half);
}

static int has_area(const double *vertices, const uint32_t *triangle)
{
    double u[3], v[3], n[3];
    const double *a = vertices + 3 * (size_t)triangle[0];
    se3di_sub(vertices + 3 * (size_t)triangle[1], a, u);
    se3di_sub(vertices + 3 * (size_t)triangle[2], a, v);
    se3di_cross(u, v, n);
    return se3di_dot(n, n) > 0.0;
}

/* Its heights, the inverse lengths of what measures the parts in it; not of a triangle so slender
 * that those directions are uncertain. */
static void fill_heights(const double ab[3], const double ac[3], facet *f)
{
    double to_a[3], doubled[3];
    se3di_add(f->to_b, f->to_c, to_a);
    se3di_cross(ab, ac, doubled);
    const double longest = fmax(se3di_dot(ab, ab), se3di_dot(ac, ac));
    const int slender = se3di_norm(doubled) < SLENDER * longest;
    const double inverse[3] = {se3di_norm(f->to_b), se3di_norm(f->to_c), se3di_norm(to_a)};
    for (int k = 0; k < 3; ++k) { /* 0: beyond the range of numbers */
        f->heights[k] = slender || inverse[k] == 0.0 ? 0.0 : 1.0 / inverse[k];
    }
}

static void fill_facets(se3di_shape *s)
{
    for (size_t k = 0; k < s->triangle_count; ++k) {
        const double *corner[3];
        double ab[3], ac[3], normal[3];
        facet *f = se3di_mesh_facets(s) + k;
        se3di_triangle_corners(s, k, corner);
        se3di_copy(corner[0], f->a);
        se3di_sub(corner[1], corner[0], ab);
        se3di_sub(corner[2], corner[0], ac);
        se3di_cross(ab, ac, normal);
        const double square = se3di_dot(normal, normal);
        se3di_scale(1.0 / sqrt(square), normal, f->normal);
        se3di_cross(ac, normal, f->to_b);
        se3di_cross(normal, ab, f->to_c);
        se3di_scale(1.0 / square, f->to_b, f->to_b);
        se3di_scale(1.0 / square, f->to_c, f->to_c);
        fill_heights(ab, ac, f);
        memset(f->edges, 3, sizeof f->edges); /* not known */
    }
}

int se3di_mesh_edge_bulges(const se3di_shape *shape, uint32_t triangle, uint32_t side)
{
    const int outside = shape->closed > 0 ? 1 : shape->closed < 0 ? 2 : 3;
    return shape->rows > 0 || (se3di_mesh_facets(shape)[triangle].edges[side] & outside) != 0;
}

int se3di_mesh_edge_is_told(const se3di_shape *shape, uint32_t triangle, uint32_t side)
{
    return shape->rows == 0 && (se3di_mesh_facets(shape)[triangle].edges[side] & TOLD) != 0;
}

/* Which way the triangle beyond an edge leads. */
static void note_bend(se3di_shape *s, uint32_t triangle, uint32_t side, uint32_t beyond)
{
    facet *f = se3di_mesh_facets(s) + triangle;
    double least = 0.0, most = 0.0, size = 0.0;
    for (size_t k = 0; k < 3; ++k) {
        double d[3];
        se3di_sub(s->vertices + 3 * (size_t)s->triangles[3 * (size_t)beyond + k], f->a, d);
        least = fmin(least, se3di_dot(d, f->normal));
        most = fmax(most, se3di_dot(d, f->normal));
        size = fmax(size, se3di_norm(d));
    }
    f->edges[side] = (uint8_t)((least < -FLAT * size ? 1 : 0) | (most > FLAT * size ? 2 : 0));
    se3di_mesh_beyond(s)[3 * (size_t)triangle + side] = beyond;
}

static se3d_status find_sense(const se3d_allocator *allocator, se3di_shape *s);
static int32_t make_convex(se3di_shape *s);

static se3d_status fill(const se3d_allocator *allocator, const double *vertices,
                        const uint32_t *triangles, size_t triangle_count, se3di_shape *shape)
{
    uint32_t kept = (uint32_t)shape->triangle_count;
    memcpy(shape->vertices, vertices, 3 * shape->vertex_count * sizeof(double));
    for (size_t k = 0, to = 0; k < triangle_count; ++k) {
        if (has_area(vertices, triangles + 3 * k)) {
            memcpy(shape->triangles + 3 * to++, triangles + 3 * k, 3 * sizeof *triangles);
        }
    }
    size_t most = 2 * (size_t)kept;
    mesh_node *nodes = se3di_alloc(allocator, most, sizeof *nodes);
    if (!nodes) {
        return SE3D_ERR_NO_MEMORY;
    }
    builder b = {vertices, shape->triangles, nodes, 0};
    build(&b, 0, kept);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    const size_t bytes = b.node_count * sizeof *nodes + kept * SE3DI_MESH_BYTES;
    shape->tree = se3di_alloc(allocator, bytes, 1);
    if (shape->tree) {
        shape->tree_bytes = bytes;
        memcpy(shape->tree, nodes, b.node_count * sizeof *nodes);
        memset(se3di_mesh_beyond(shape), 0, 3 * (size_t)kept * sizeof(uint32_t));
        fill_facets(shape);
        status = find_sense(allocator, shape);
        shape->convex = make_convex(shape);
        status = status < 0 ? status : se3di_pieces_build(allocator, shape);
    }
    se3di_free(allocator, nodes, most, sizeof *nodes);
    return status;
}

se3d_status se3di_mesh_build(const se3d_allocator *allocator, const double *vertices,
                             size_t vertex_count, const uint32_t *triangles, size_t triangle_count,
                             se3di_shape *shape)
{
    size_t kept = 0;
    for (size_t k = 0; k < triangle_count; ++k) {
        kept += (size_t)has_area(vertices, triangles + 3 * k);
    }
    shape->tree = NULL;
    shape->tree_bytes = shape->vertex_count = shape->triangle_count = 0;
    shape->vertices = NULL;
    shape->triangles = NULL;
    if (kept == 0) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    shape->vertices = se3di_alloc(allocator, 3 * vertex_count, sizeof(double));
    shape->vertex_count = shape->vertices ? vertex_count : 0;
    shape->triangles = se3di_alloc(allocator, 3 * kept, sizeof *triangles);
    shape->triangle_count = shape->triangles ? kept : 0;
    se3d_status status = SE3D_ERR_NO_MEMORY;
    if (shape->vertices && shape->triangles) {
        status = fill(allocator, vertices, triangles, triangle_count, shape);
    }
    if (status < 0) {
        char *name = shape->name; /* the caller's */
        shape->name = NULL;
        se3di_shape_release(allocator, shape);
        shape->name = name;
    }
    return status;
}

/* The squared distance of a box. */
static double box_distance(const mesh_node *node, const double p[3])
{
    double sum = 0.0;
    for (int a = 0; a < 3; ++a) {
        const double below = node->low[a] - p[a], above = p[a] - node->high[a];
        double beyond = below > above ? below : above; /* fmax() is a call */
        beyond = beyond > 0.0 ? beyond : 0.0;
        sum += beyond * beyond;
    }
    return sum;
}

static double triangle_distance(const se3di_shape *s, uint32_t triangle, const double p[3],
                                double point[3])
{
    const double *corner[3];
    se3di_triangle_corners(s, triangle, corner);
    return se3di_triangle_nearest(corner, p, point, NULL);
}

/* The same of a heightfield, whose triangles are too many to keep more of them. */
static int cell_reaches(const se3di_shape *s, uint32_t triangle, const double p[3], double reach,
                        double point[3], double *square)
{
    const double *corner[3];
    double d[3], ab[3], ac[3], n[3];
    se3di_triangle_corners(s, triangle, corner);
    se3di_sub(corner[1], corner[0], ab);
    se3di_sub(corner[2], corner[0], ac);
    se3di_sub(p, corner[0], d);
    se3di_cross(ab, ac, n);
    const double height = se3di_dot(d, n);
    if (height * height > (1.0 + 1e-9) * reach * se3di_dot(n, n)) {
        return 0;
    }
    *square = se3di_triangle_nearest((const double *const *)corner, p, point, NULL);
    return *square < reach;
}

/* Whether a triangle is within reach, with its point and squared distance; of most its plane tells
 * it for a few operations, or the foot of the perpendicular is in it. */
static int reaches(const se3di_shape *s, uint32_t triangle, const double p[3], double reach,
                   double point[3], double *square)
{
    if (s->rows > 0) {
        return cell_reaches(s, triangle, p, reach, point, square);
    }
    const facet *f = se3di_mesh_facets(s) + triangle;
    double d[3];
    se3di_sub(p, f->a, d);
    const double height = se3di_dot(d, f->normal);
    if (height * height > (1.0 + 1e-9) * reach) {
        return 0;
    }
    const double b = se3di_dot(d, f->to_b), c = se3di_dot(d, f->to_c);
    if (b > 0.0 && c > 0.0 && b + c < 1.0) {
        se3di_copy(p, point);
        se3di_add_scaled(-height, f->normal, point);
        *square = height * height;
    } else {
        *square = triangle_distance(s, triangle, p, point);
    }
    return *square < reach;
}

int se3di_mesh_is_near(const se3di_shape *shape, const uint32_t *faces, size_t face_count,
                       const double local[3], double radius)
{
    double point[3], square;
    for (size_t k = 0; k < face_count; ++k) {
        if (reaches(shape, faces[k], local, radius * radius, point, &square)) {
            return 1;
        }
    }
    return 0;
}

int se3di_mesh_is_clear(const se3di_shape *shape, const double local[3], double radius)
{
    const mesh_node *nodes = shape->tree;
    uint32_t stack[STACK_SIZE] = {0};
    int depth = 1;
    const double reach = radius * radius;
    while (depth > 0) {
        const uint32_t at = stack[--depth];
        if (!(box_distance(&nodes[at], local) < reach)) {
            continue;
        }
        if (nodes[at].count == 0) {
            stack[depth++] = nodes[at].right;
            stack[depth++] = at + 1;
        }
        for (uint32_t k = nodes[at].begin; k < nodes[at].begin + nodes[at].count; ++k) {
            double point[3], square;
            if (reaches(shape, k, local, reach, point, &square)) {
                return 0;
            }
        }
    }
    return 1;
}

/* Not one of a heightfield: its plane alone is farther than a squared distance. */
static int is_plane_farther(const se3di_shape *s, uint32_t triangle, const double p[3],
                            double square)
{
    const facet *f = se3di_mesh_facets(s) + triangle;
    double d[3];
    se3di_sub(p, f->a, d);
    const double height = se3di_dot(d, f->normal);
    return height * height > (1.0 + 1e-9) * square;
}

size_t se3di_mesh_nearest(const se3di_shape *shape, const double local[3], double point[3],
                          double *distance)
{
    const mesh_node *nodes = shape->tree;
    uint32_t stack[STACK_SIZE] = {0};
    int depth = 1;
    double least = HUGE_VAL;
    size_t nearest = 0;
    while (depth > 0) {
        uint32_t at = stack[--depth];
        const mesh_node *node = &nodes[at];
        if (!(box_distance(node, local) < least)) {
            continue;
        }
        if (node->count == 0) { /* the nearer child on top */
            int first =
                box_distance(&nodes[at + 1], local) <= box_distance(&nodes[node->right], local);
            stack[depth++] = first ? node->right : at + 1;
            stack[depth++] = first ? at + 1 : node->right;
        }
        for (uint32_t k = node->begin; k < node->begin + node->count; ++k) {
            double here[3];
            if (shape->rows == 0 && is_plane_farther(shape, k, local, least)) {
                continue;
            }
            double square = triangle_distance(shape, k, local, here);
            if (square < least) {
                least = square;
                nearest = k;
                se3di_copy(here, point);
            }
        }
    }
    *distance = sqrt(least);
    return nearest;
}

typedef struct candidate {
    double point[3], square;
    uint32_t triangle, reserved;
} candidate;

/* Insert by distance; beyond the room the farthest is forgotten. */
static size_t insert(candidate *list, size_t count, const candidate *new)
{
    size_t at = count < CANDIDATES ? count : CANDIDATES - 1;
    if (count == CANDIDATES && !(new->square < list[at].square)) {
        return count;
    }
    for (; at > 0 && new->square < list[at - 1].square; --at) {
        list[at] = list[at - 1];
    }
    list[at] = *new;
    return count < CANDIDATES ? count + 1 : count;
}

/* In the order of the grid. */
static void visit_cells(const se3di_shape *s, const double local[3], double radius,
                        void (*visitor)(void *ctx, uint32_t triangle), void *ctx)
{
    se3di_grid_cells near;
    se3di_grid_find_cells(s, local, radius, &near);
    for (uint32_t i = near.row[0]; i < near.row[1]; ++i) {
        for (uint32_t j = near.column[0]; j < near.column[1]; ++j) {
            const uint32_t first = 2 * (i * (s->columns - 1) + j);
            if (se3di_grid_misses(s, i, j, local[2], radius)) {
                continue;
            }
            for (uint32_t k = first; k < first + 2; ++k) {
                double point[3], square;
                if (cell_reaches(s, k, local, radius * radius, point, &square)) {
                    visitor(ctx, k);
                }
            }
        }
    }
}

void se3di_mesh_visit(const se3di_shape *shape, const double local[3], double radius,
                      void (*visitor)(void *ctx, uint32_t triangle), void *ctx)
{
    const mesh_node *nodes = shape->tree;
    uint32_t stack[STACK_SIZE] = {0};
    int depth = 1;
    double reach = radius * radius;
    if (shape->rows > 0) {
        visit_cells(shape, local, radius, visitor, ctx);
        return;
    }
    while (depth > 0) {
        uint32_t at = stack[--depth];
        const mesh_node *node = &nodes[at];
        if (!(box_distance(node, local) < reach)) {
            continue;
        }
        if (node->count == 0) {
            stack[depth++] = node->right;
            stack[depth++] = at + 1;
        }
        for (uint32_t k = node->begin; k < node->begin + node->count; ++k) {
            double point[3], square;
            if (reaches(shape, k, local, reach, point, &square)) {
                visitor(ctx, k);
            }
        }
    }
}

/* A segment, and what its boxes are looked at by. */
typedef struct segment {
    const double *from, *to;
    double way[3], inverse[3]; /* 1/way, 0 if it does not go */
    double slack;
} segment;

static segment segment_of(const double from[3], const double to[3])
{
    segment s = {.from = from, .to = to};
    se3di_sub(to, from, s.way);
    for (int a = 0; a < 3; ++a) {
        s.inverse[a] = fabs(s.way[a]) > 0.0 ? 1.0 / s.way[a] : 0.0;
    }
    s.slack = ON_TRIANGLE * se3di_norm(s.way);
    return s;
}

/* Whether a segment meets a box, larger by a little. */
static int meets_box(const mesh_node *node, const segment *s)
{
    double low = 0.0, high = 1.0;
    for (int a = 0; a < 3; ++a) {
        const double near = node->low[a] - s->slack - s->from[a];
        const double far = node->high[a] + s->slack - s->from[a];
        if (!(fabs(s->way[a]) > 0.0)) {
            if (near > 0.0 || far < 0.0) {
                return 0;
            }
            continue;
        }
        const int turned = s->inverse[a] < 0.0;
        const double in = (turned ? far : near) * s->inverse[a];
        const double out = (turned ? near : far) * s->inverse[a];
        low = in > low ? in : low; /* fmax() is a call */
        high = out < high ? out : high;
    }
    return low <= high;
}

/* Both ends are on one side of its plane, by more than rounding; not of a heightfield. */
static int is_passed_by(const se3di_shape *s, uint32_t triangle, const segment *way)
{
    const facet *f = se3di_mesh_facets(s) + triangle;
    double from[3], to[3];
    se3di_sub(way->from, f->a, from);
    se3di_sub(way->to, f->a, to);
    const double before = se3di_dot(from, f->normal), after = se3di_dot(to, f->normal);
    const double rounding =
        1e-12 * (fabs(from[0]) + fabs(from[1]) + fabs(from[2]) + fabs(before - after));
    return (before > rounding && after > rounding) || (before < -rounding && after < -rounding);
}

/* Also on its sides, so that nothing slips through between two; after which share of the way. */
static int crosses_triangle(const se3di_shape *s, uint32_t triangle, const double from[3],
                            const double to[3], double slack, double *share)
{
    const double *a = s->vertices + 3 * (size_t)s->triangles[3 * (size_t)triangle];
    const double *b = s->vertices + 3 * (size_t)s->triangles[3 * (size_t)triangle + 1];
    const double *c = s->vertices + 3 * (size_t)s->triangles[3 * (size_t)triangle + 2];
    double u[3], v[3], n[3], d[3], x[3], at[3];
    se3di_sub(b, a, u);
    se3di_sub(c, a, v);
    se3di_cross(u, v, n);
    se3di_sub(from, a, d);
    double before = se3di_dot(d, n);
    se3di_sub(to, a, d);
    double after = se3di_dot(d, n);
    if (!(before * after <= 0.0 && fabs(before - after) > 0.0)) {
        return 0;
    }
    se3di_sub(to, from, d);
    se3di_copy(from, x);
    *share = before / (before - after);
    se3di_add_scaled(*share, d, x);
    return triangle_distance(s, triangle, x, at) <= slack * slack;
}

size_t se3di_mesh_find_cuts(const se3di_shape *shape, const double from[3], const double to[3],
                            size_t capacity, se3di_mesh_cut *cuts)
{
    const mesh_node *nodes = shape->tree;
    uint32_t stack[STACK_SIZE] = {0};
    int depth = 1;
    size_t count = 0;
    const segment way = segment_of(from, to);
    while (depth > 0) {
        uint32_t at = stack[--depth];
        const mesh_node *node = &nodes[at];
        if (!meets_box(node, &way)) {
            continue;
        }
        if (node->count == 0) {
            stack[depth++] = node->right;
            stack[depth++] = at + 1;
        }
        for (uint32_t k = node->begin; k < node->begin + node->count; ++k) {
            double share;
            if ((shape->rows == 0 && is_passed_by(shape, k, &way)) ||
                !crosses_triangle(shape, k, from, to, way.slack, &share)) {
                continue;
            }
            if (count == capacity) {
                return count;
            }
            size_t place = count++;
            for (; place > 0 && cuts[place - 1].share > share; --place) {
                cuts[place] = cuts[place - 1];
            }
            cuts[place] = (se3di_mesh_cut){share, k, 0};
        }
    }
    return count;
}

int se3di_mesh_crosses(const se3di_shape *shape, const double from[3], const double to[3])
{
    se3di_mesh_cut cut;
    return se3di_mesh_find_cuts(shape, from, to, 1, &cut) > 0;
}

/* The nodes of a tree that are still to be looked at. */
typedef struct box_walk {
    uint32_t stack[STACK_SIZE];
    int depth;
} box_walk;

/* The next leaf that meets a box; NULL: none more. */
static const mesh_node *next_leaf(const mesh_node *nodes, const double low[3], const double high[3],
                                  box_walk *walk)
{
    while (walk->depth > 0) {
        const uint32_t at = walk->stack[--walk->depth];
        const mesh_node *node = &nodes[at];
        int meets = 1;
        for (int a = 0; a < 3; ++a) {
            meets = meets && node->low[a] <= high[a] && node->high[a] >= low[a];
        }
        if (meets && node->count > 0) {
            return node;
        }
        if (meets) {
            walk->stack[walk->depth++] = node->right;
            walk->stack[walk->depth++] = at + 1;
        }
    }
    return NULL;
}

int se3di_mesh_meets_box(const se3di_shape *shape, const double low[3], const double high[3])
{
    box_walk walk = {{0}, 1};
    return next_leaf(shape->tree, low, high, &walk) != NULL;
}

void se3di_mesh_visit_box(const se3di_shape *shape, const double low[3], const double high[3],
                          void (*visitor)(void *ctx, uint32_t triangle), void *ctx)
{
    box_walk walk = {{0}, 1};
    const mesh_node *leaf;
    while ((leaf = next_leaf(shape->tree, low, high, &walk)) != NULL) {
        for (uint32_t k = leaf->begin; k < leaf->begin + leaf->count; ++k) {
            visitor(ctx, k);
        }
    }
}

typedef struct edge_search {
    const se3di_shape *shape;
    const double *from, *to;
    uint32_t *piece; /* of each triangle another one of its piece, or itself */
    uint32_t triangle, beyond;
    int same, opposite;
} edge_search;

static int is_at(const double *a, const double *b)
{
    return !(fabs(a[0] - b[0]) > 0.0 || fabs(a[1] - b[1]) > 0.0 || fabs(a[2] - b[2]) > 0.0);
}

static uint32_t piece_of(uint32_t *piece, uint32_t triangle)
{
    while (piece[triangle] != triangle) {
        piece[triangle] = piece[piece[triangle]];
        triangle = piece[triangle];
    }
    return triangle;
}

static void count_edge(void *ctx, uint32_t triangle)
{
    edge_search *e = ctx;
    for (uint32_t k = 0; k < 3 && triangle != e->triangle; ++k) {
        const uint32_t *t = e->shape->triangles + 3 * (size_t)triangle;
        const double *a = e->shape->vertices + 3 * (size_t)t[k];
        const double *b = e->shape->vertices + 3 * (size_t)t[(k + 1) % 3];
        const int opposite = is_at(a, e->to) && is_at(b, e->from);
        e->same += is_at(a, e->from) && is_at(b, e->to);
        e->opposite += opposite;
        if (opposite) {
            e->beyond = triangle;
            e->piece[piece_of(e->piece, triangle)] = piece_of(e->piece, e->triangle);
        }
    }
}

static int is_one_piece(uint32_t *piece, size_t count)
{
    for (uint32_t k = 1; k < count; ++k) {
        if (piece_of(piece, k) != piece_of(piece, 0)) {
            return 0;
        }
    }
    return 1;
}

/* If no edge is passed twice one way, triangles of one piece have one sense; if every edge is
 * passed once each way, it is that of the volume. */
static void judge_edges(se3di_shape *s, uint32_t *piece)
{
    double volume = 0.0;
    int closed = 1;
    for (uint32_t k = 0; k < 3 * s->triangle_count; ++k) {
        const uint32_t *t = s->triangles + k / 3 * 3;
        edge_search e = {.shape = s, .piece = piece, .triangle = k / 3};
        double middle[3], d[3], n[3];
        e.from = s->vertices + 3 * (size_t)t[k % 3];
        e.to = s->vertices + 3 * (size_t)t[(k + 1) % 3];
        se3di_add(e.from, e.to, middle);
        se3di_scale(0.5, middle, middle);
        se3di_sub(e.to, e.from, d);
        se3di_mesh_visit(s, middle, ON_TRIANGLE * se3di_norm(d), count_edge, &e);
        if (e.same != 0 || e.opposite > 1) {
            return;
        }
        closed = closed && e.opposite == 1;
        if (e.opposite == 1) {
            note_bend(s, k / 3, k % 3, e.beyond);
        }
        se3di_cross(e.from, e.to, n);
        volume += k % 3 == 0 ? se3di_dot(n, s->vertices + 3 * (size_t)t[2]) : 0.0;
    }
    s->oriented = is_one_piece(piece, s->triangle_count);
    s->closed = !closed ? 0 : volume > 0.0 ? 1 : volume < 0.0 ? -1 : 0;
}

typedef struct told_search {
    const se3di_shape *shape;
    uint32_t triangle;
    int told;
} told_search;

static void middle_of(const se3di_shape *s, uint32_t triangle, double middle[3])
{
    const double *corner[3];
    se3di_triangle_corners(s, triangle, corner);
    se3di_add(corner[0], corner[1], middle);
    se3di_add(middle, corner[2], middle);
    se3di_scale(1.0 / 3.0, middle, middle);
}

/* Whether the middle of a triangle is below another one, seen from outside. */
static int is_below(const se3di_shape *s, uint32_t triangle, uint32_t other)
{
    const facet *f = se3di_mesh_facets(s) + other;
    double d[3];
    middle_of(s, triangle, d);
    se3di_sub(d, f->a, d);
    return s->closed * se3di_dot(d, f->normal) < 0.0;
}

/* Of an open one what holds from both of its sides. */
static void meet_told(void *ctx, uint32_t other)
{
    told_search *t = ctx;
    const se3di_shape *s = t->shape;
    const facet *own = se3di_mesh_facets(s) + t->triangle;
    const facet *next = se3di_mesh_facets(s) + other;
    if (other != t->triangle) {
        const int sides = s->closed != 0 || s->oriented;
        t->told = t->told || other < t->triangle ||
                  (sides && se3di_dot(own->normal, next->normal) > COPLANAR) ||
                  (s->closed != 0 && !is_below(s, other, t->triangle) &&
                   !is_below(s, t->triangle, other));
    }
}

static void note_told(se3di_shape *s)
{
    for (uint32_t k = 0; k < 3 * s->triangle_count; ++k) {
        const uint32_t *t = s->triangles + k / 3 * 3;
        const double *from = s->vertices + 3 * (size_t)t[k % 3];
        const double *to = s->vertices + 3 * (size_t)t[(k + 1) % 3];
        told_search search = {.shape = s, .triangle = k / 3};
        double middle[3], d[3];
        se3di_add(from, to, middle);
        se3di_scale(0.5, middle, middle);
        se3di_sub(to, from, d);
        se3di_mesh_visit(s, middle, AT_EDGE * se3di_norm(d), meet_told, &search);
        se3di_mesh_facets(s)[k / 3].edges[k % 3] |= (uint8_t)(search.told ? TOLD : 0);
    }
}

static se3d_status find_sense(const se3d_allocator *allocator, se3di_shape *s)
{
    uint32_t *piece = se3di_alloc(allocator, s->triangle_count, sizeof *piece);
    if (!piece) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (uint32_t k = 0; k < s->triangle_count; ++k) {
        piece[k] = k;
    }
    s->closed = s->oriented = 0;
    judge_edges(s, piece);
    note_told(s);
    se3di_mesh_note_outermost(s);
    se3di_free(allocator, piece, s->triangle_count, sizeof *piece);
    return SE3D_OK;
}

/* No vertex is above a face. */
static int is_convex(const se3di_shape *s)
{
    double size = 0.0;
    for (size_t k = 0; k < s->vertex_count; ++k) {
        size = fmax(size, se3di_norm(s->vertices + 3 * k));
    }
    for (size_t k = 0; k < s->triangle_count; ++k) {
        const double *a = s->vertices + 3 * (size_t)s->triangles[3 * k];
        double u[3], v[3], n[3];
        se3di_sub(s->vertices + 3 * (size_t)s->triangles[3 * k + 1], a, u);
        se3di_sub(s->vertices + 3 * (size_t)s->triangles[3 * k + 2], a, v);
        se3di_cross(u, v, n);
        const double slack = FLAT * size * se3di_norm(n);
        for (size_t c = 0; c < s->vertex_count; ++c) {
            se3di_sub(s->vertices + 3 * c, a, u);
            if (s->closed * se3di_dot(u, n) > slack) {
                return 0;
            }
        }
    }
    return 1;
}

/* A convex one is a hull, with triangles that are counter-clockwise from outside. */
static int32_t make_convex(se3di_shape *s)
{
    if (s->closed == 0 || s->triangle_count > CONVEX_MOST || !is_convex(s)) {
        return 0;
    }
    for (size_t k = 0; k < s->triangle_count && s->closed < 0; ++k) {
        const uint32_t second = s->triangles[3 * k + 1];
        s->triangles[3 * k + 1] = s->triangles[3 * k + 2];
        s->triangles[3 * k + 2] = second;
        uint8_t *edges = se3di_mesh_facets(s)[k].edges; /* of its sides in their order */
        const uint8_t first = edges[0];
        edges[0] = edges[2];
        edges[2] = first;
        uint32_t *beyond = se3di_mesh_beyond(s) + 3 * k;
        const uint32_t last = beyond[2];
        beyond[2] = beyond[0];
        beyond[0] = last;
    }
    s->closed = 1;
    return 1;
}

typedef struct gathering {
    const se3di_shape *shape;
    const double *local;
    candidate *list;
    size_t count;
} gathering;

static void gather_triangle(void *ctx, uint32_t triangle)
{
    gathering *g = ctx;
    candidate here = {.triangle = triangle};
    here.square = triangle_distance(g->shape, triangle, g->local, here.point);
    g->count = insert(g->list, g->count, &here);
}

/* The triangles within the radius, the nearest first. */
static size_t gather(const se3di_shape *s, const double local[3], double radius, candidate *list)
{
    gathering g = {s, local, list, 0};
    se3di_mesh_visit(s, local, radius, gather_triangle, &g);
    return g.count;
}

/* The point of candidate k lies on a triangle before it. */
static int leads_on(const se3di_shape *s, const candidate *list, size_t k, double tolerance)
{
    for (size_t other = 0; other < k; ++other) {
        double point[3], square;
        if (reaches(s, list[other].triangle, list[k].point, tolerance * tolerance, point,
                    &square)) {
            return 1;
        }
    }
    return 0;
}

/* Of the triangles within the radius, the nearest first, those that are contacts. */
static size_t choose_contacts(const se3di_shape *shape, const candidate *list, size_t found,
                              const double local[3], double radius, size_t capacity,
                              se3di_touch *touch)
{
    size_t count = 0;
    for (size_t k = 0; k < found && count < capacity; ++k) {
        if (leads_on(shape, list, k, ON_TRIANGLE * radius)) {
            continue;
        }
        se3di_touch *t = &touch[count];
        se3di_copy(list[k].point, t->point);
        t->distance = sqrt(list[k].square);
        se3di_sub(local, t->point, t->normal);
        if (!(t->distance > 0.0)) {
            continue; /* the centre is on the surface: no side is the right one */
        }
        se3di_scale(1.0 / t->distance, t->normal, t->normal);
        int again = 0;
        for (size_t other = 0; other < count; ++other) {
            again = again || se3di_dot(touch[other].normal, t->normal) > NEARLY_COPLANAR;
        }
        count += again ? 0 : 1;
    }
    return count;
}

size_t se3di_mesh_contacts(const se3di_shape *shape, const double local[3], double radius,
                           size_t capacity, se3di_touch *touch)
{
    candidate list[CANDIDATES];
    const size_t found = gather(shape, local, radius, list);
    return choose_contacts(shape, list, found, local, radius, capacity, touch);
}

size_t se3di_mesh_contacts_among(const se3di_shape *shape, const uint32_t *faces, size_t face_count,
                                 const double local[3], double radius, size_t capacity,
                                 se3di_touch *touch)
{
    candidate list[CANDIDATES];
    size_t found = 0;
    for (size_t k = 0; k < face_count; ++k) {
        candidate here = {.triangle = faces[k]};
        if (reaches(shape, faces[k], local, radius * radius, here.point, &here.square)) {
            found = insert(list, found, &here);
        }
    }
    return choose_contacts(shape, list, found, local, radius, capacity, touch);
}

static se3d_status define_mesh(const se3d_shape_def *def, const se3d_allocator *allocator,
                               se3di_shape *shape, se3di_error *error)
{
    SE3DI_TRY(se3di_vertices_define(def, shape, error));
    SE3DI_TRY(se3di_shape_check_array(def->triangles, "triangles", error));
    if (def->triangle_count < 1 || def->triangle_count > UINT32_MAX / 16) {
        return se3di_error_set_of(error, "triangle_count", SE3D_ERR_INVALID_ARGUMENT,
                                  " = %zu, must be at least 1 and at most %u", def->triangle_count,
                                  UINT32_MAX / 16);
    }
    for (size_t k = 0; k < 3 * def->triangle_count; ++k) {
        if (def->triangles[k] >= def->vertex_count) {
            return se3di_error_set(error, SE3D_ERR_INVALID_ARGUMENT,
                                   "triangles[%zu] = %u, must be less than vertex_count = %zu", k,
                                   def->triangles[k], def->vertex_count);
        }
    }
    se3d_status status = se3di_mesh_build(allocator, def->vertices, def->vertex_count,
                                          def->triangles, def->triangle_count, shape);
    if (status == SE3D_ERR_INVALID_ARGUMENT) {
        return se3di_error_set(error, status, "none of the %zu triangles has an area",
                               def->triangle_count);
    }
    return status < 0 ? se3di_error_set(error, status, "no memory for a mesh") : SE3D_OK;
}

void se3di_mesh_nearest_point(const se3di_shape *s, const double local[3], double point[3],
                              double normal[3], double *distance)
{
    size_t triangle = se3di_mesh_nearest(s, local, point, distance);
    if (*distance > 0.0) {
        se3di_sub(local, point, normal);
        se3di_scale(1.0 / *distance, normal, normal);
    } else {
        const double *corner[3];
        se3di_triangle_corners(s, triangle, corner);
        se3di_triangle_normal(corner, normal);
    }
}

const se3di_shape_class se3di_shape_class_mesh = {
    .name = "mesh",
    .define = define_mesh,
    .bound = se3di_vertices_bound,
    .size = se3di_vertices_size,
    .nearest = se3di_mesh_nearest_point,
    .support = se3di_vertices_support,
};
