/* SPDX-License-Identifier: BSD-3-Clause */
/* A cap of a cylinder that lies on a flat part of a closed mesh, as the head of a bolt on a flange.
 *
 * If all of the mesh about the cylinder is at or below the plane of that part, the cylinder cannot
 * touch it elsewhere, and comes off it along the plane's normal: no way to a side counts, however
 * short it is beside a hole. What touches is known then: points of the rim over the part, and the
 * ends of what of the part's outline is below the cap.           docs/theory/body-contact.md */
#include "contact/narrow/internal.h"
#include "contact/narrow/mesh.h"
#include "contact/shape/mesh_tree.h"
#include "contact/shape/triangles.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define LEAN  1e-2 /* sine of the angle between cap and part at most */
#define DEEP  0.1  /* of the size: the deepest at most */
#define LEVEL 1e-6 /* of the size: what is in one plane */
#define SLACK 1e-4 /* of the radius: places that are one; a rim is over the part in spite of it */
#define WIDE  4.0  /* times the depth: so far from all sides there is a place at least */
#define NEAR  512  /* triangles about the cylinder at most */

/* All in the frame of the mesh. */
typedef struct cap {
    const se3di_mesh_meeting *m;
    double low[3], high[3];   /* the box of the cylinder */
    double middle[3], out[3]; /* of the cap; its outward normal */
    double n[3], height;      /* of the part; of the middle over it */
    double level, deepest;    /* of its rim, below the part */
    double rim[4][3];
    uint32_t first; /* of its points, of those of both rims */
    int count, part_count;
    uint32_t all[NEAR], near[NEAR]; /* about the cylinder; of the part */
} cap;

static void normal_of(const cap *c, uint32_t triangle, double n[3])
{
    const se3di_shape *s = c->m->mesh->shape;
    se3di_scale((double)s->closed, se3di_mesh_facets(s)[triangle].normal, n);
}

/* Over the plane of the part. */
static double height_of(const cap *c, const double x[3])
{
    double d[3];
    se3di_sub(x, c->middle, d);
    return c->height + se3di_dot(d, c->n);
}

static void note_near(void *ctx, uint32_t triangle)
{
    cap *c = ctx;
    const double *corner[3];
    int is_beside = 0;
    se3di_triangle_corners(c->m->mesh->shape, triangle, corner);
    for (int k = 0; k < 3; ++k) {
        const double *a = corner[0], *b = corner[1], *d = corner[2];
        is_beside = is_beside || (a[k] < c->low[k] && b[k] < c->low[k] && d[k] < c->low[k]) ||
                    (a[k] > c->high[k] && b[k] > c->high[k] && d[k] > c->high[k]);
    }
    if (!is_beside) {
        if (c->count < NEAR) {
            c->all[c->count] = triangle;
        }
        ++c->count;
    }
}

/* The highest plane below the cap that looks at it. */
static int find_part(cap *c)
{
    int found = 0;
    for (int k = 0; k < c->count; ++k) {
        double n[3], d[3], turn[3];
        normal_of(c, c->all[k], n);
        se3di_add(n, c->out, turn);
        se3di_sub(c->middle, se3di_mesh_corner(c->m->mesh->shape, c->all[k], 0), d);
        const double height = se3di_dot(d, n);
        if (se3di_norm(turn) < LEAN && fabs(height) < DEEP * c->m->size &&
            (!found || height < c->height)) {
            found = 1;
            c->height = height;
            se3di_copy(n, c->n);
        }
    }
    return found;
}

/* Whether nothing about the cylinder rises above the part, and nothing else is as high as its cap. */
static int is_highest(const cap *c)
{
    for (int t = 0; t < c->count; ++t) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (uint32_t k = 0; k < 3; ++k) {
            const double height = height_of(c, se3di_mesh_corner(c->m->mesh->shape, c->all[t], k));
            low = fmin(low, height);
            high = fmax(high, height);
        }
        if (high > c->level || (low < -c->level && low > -c->deepest - c->level)) {
            return 0;
        }
    }
    return 1;
}

static int is_of_part(const cap *c, uint32_t triangle)
{
    for (uint32_t k = 0; k < 3; ++k) {
        if (!(fabs(height_of(c, se3di_mesh_corner(c->m->mesh->shape, triangle, k))) < c->level)) {
            return 0;
        }
    }
    return 1;
}

/* A place of both, unless it is there. */
static void add_place(cap *c, const double at[3], const double n[3], double overlap,
                      uint32_t feature)
{
    double d[3], x[3];
    se3di_solid_to_ground(c->m->mesh, at, x);
    for (uint32_t k = 0; k < c->m->manifold->count; ++k) {
        se3di_sub(c->m->manifold->points[k].point, x, d);
        if (se3di_norm(d) < SLACK * c->m->solid->shape->radius) {
            return;
        }
    }
    if (overlap > 0.0) {
        se3di_mesh_add(c->m, at, n, overlap, 0.0, feature);
    }
}

/* Whether a place in the plane is over the part, or beyond its outline by less than the slack. */
static int is_over(const cap *c, const double x[3], double slack)
{
    int over = 0;
    for (int k = 0; k < c->part_count && !over; ++k) {
        const double *corner[3];
        double at[3];
        se3di_triangle_corners(c->m->mesh->shape, c->near[k], corner);
        over = se3di_triangle_nearest(corner, x, at, NULL) < slack * slack;
    }
    return over;
}

/* Whether a place of the part is farther from the part's outline. */
static int is_within(const cap *c, const double x[3], double margin)
{
    const se3di_shape *s = c->m->mesh->shape;
    if (!is_over(c, x, c->level)) {
        return 0;
    }
    for (int k = 0; k < c->part_count; ++k) {
        for (uint32_t n = 0; n < 3; ++n) {
            const double *ends[3];
            double at[3];
            ends[0] = se3di_mesh_corner(s, c->near[k], n);
            ends[1] = ends[2] = se3di_mesh_corner(s, c->near[k], n + 1);
            if (!se3di_mesh_edge_is_level(s, c->near[k], n) &&
                se3di_triangle_nearest(ends, x, at, NULL) < margin * margin) {
                return 0;
            }
        }
    }
    return 1;
}

/* Whether the cap and the part have a place in common that is farther from rim and outline than
 * they are deep, so that they do not come apart to a side sooner: the middle, or one near a point
 * of the rim. */
static int are_wide(const cap *c)
{
    const double radius = c->m->solid->shape->radius;
    const double margin = WIDE * c->deepest + SLACK * radius;
    for (int k = 0; k < 5; ++k) {
        double x[3];
        se3di_copy(c->middle, x);
        for (int a = 0; a < 3 && k < 4; ++a) {
            x[a] += (1.0 - margin / radius) * (c->rim[k][a] - c->middle[a]);
        }
        se3di_add_scaled(-height_of(c, x), c->n, x);
        if (is_within(c, x, margin)) {
            return 1;
        }
    }
    return 0;
}

/* Whether the place of the rim that is lowest is over the part. */
static int has_lowest(const cap *c)
{
    double down[3], x[3];
    se3di_scale(-1.0, c->n, down);
    se3di_add_scaled(se3di_dot(c->n, c->out), c->out, down);
    const double size = se3di_norm(down);
    se3di_copy(c->middle, x);
    se3di_add_scaled(size > 0.0 ? c->m->solid->shape->radius / size : 0.0, down, x);
    se3di_add_scaled(-height_of(c, x), c->n, x);
    return is_over(c, x, c->level);
}

/* The point of the rim that is next to its lowest place, and tells how deep that is; 4: none. */
static int find_lowest(const cap *c)
{
    int lowest = 0;
    for (int k = 1; k < 4; ++k) {
        lowest = height_of(c, c->rim[k]) < height_of(c, c->rim[lowest]) ? k : lowest;
    }
    return has_lowest(c) ? lowest : 4;
}

/* The points of the cap's rim that are over the part. */
static void touch_rim(cap *c)
{
    const double slack = SLACK * c->m->solid->shape->radius;
    const int lowest = find_lowest(c);
    for (int k = 0; k < 4; ++k) {
        double x[3];
        const double height = height_of(c, c->rim[k]);
        se3di_copy(c->rim[k], x);
        se3di_add_scaled(-height, c->n, x);
        if (is_over(c, x, slack)) {
            add_place(c, x, c->n, k == lowest ? c->deepest : -height,
                      8 * (c->first + (uint32_t)k) + se3di_mesh_way_of(c->n));
        }
    }
}

/* The ends of what of a side is below the cap. */
static void touch_side(cap *c, uint32_t triangle, uint32_t side)
{
    const se3di_shape *s = c->m->mesh->shape;
    const double *a = se3di_mesh_corner(s, triangle, side);
    const double radius = c->m->solid->shape->radius;
    double way[3], d[3], up[3];
    se3di_sub(se3di_mesh_corner(s, triangle, side + 1), a, way);
    se3di_sub(a, c->middle, d);
    se3di_scale(-1.0, c->out, up);
    const double depth = se3di_dot(d, up), rise = se3di_dot(way, up);
    se3di_add_scaled(-depth, up, d); /* in the plane of the cap */
    double flat[3];
    se3di_copy(way, flat);
    se3di_add_scaled(-rise, up, flat);
    const double A = se3di_dot(flat, flat), B = se3di_dot(flat, d);
    const double C = se3di_dot(d, d) - radius * radius, root = B * B - A * C;
    if (!(root > 0.0)) {
        return;
    }
    const double from = fmax(0.0, (-B - sqrt(root)) / A), to = fmin(1.0, (-B + sqrt(root)) / A);
    if (!((to - from) * sqrt(A) > SLACK * radius)) {
        return;
    }
    for (uint32_t end = 0; end < 2; ++end) {
        double x[3];
        const double share = end ? to : from;
        se3di_copy(a, x);
        se3di_add_scaled(share, way, x);
        add_place(c, x, up, depth + share * rise, 0x80000000u + 16 * (3 * triangle + side) + end);
    }
}

static void touch_part(cap *c)
{
    touch_rim(c);
    for (int k = 0; k < c->part_count; ++k) {
        for (uint32_t side = 0; side < 3; ++side) {
            if (!se3di_mesh_edge_is_level(c->m->mesh->shape, c->near[k], side)) {
                touch_side(c, c->near[k], side);
            }
        }
    }
}

static void keep_part(cap *c)
{
    c->part_count = 0;
    for (int k = 0; k < c->count; ++k) {
        if (is_of_part(c, c->all[k])) {
            c->near[c->part_count++] = c->all[k];
        }
    }
}

static void place_rim(cap *c, int is_upper)
{
    double rim[8][3], normal[3];
    se3di_mul(c->m->mesh->at->R, c->n, normal);
    const double tilt = se3di_cylinder_rims(c->m->solid, normal, rim);
    c->first = is_upper ? 4 : 0;
    c->deepest = tilt * c->m->solid->shape->radius - c->height;
    for (int k = 0; k < 4; ++k) {
        se3di_solid_to_local(c->m->mesh, rim[c->first + (uint32_t)k], c->rim[k]);
    }
}

/* Whether the cap at one end lies on a part of the mesh, or over it. */
static int lies_flush(cap *c, double end)
{
    double axis[3], x[3];
    se3di_solid_axis(c->m->solid, 2, axis);
    se3di_copy(c->m->solid->at->x, x);
    se3di_add_scaled(end * c->m->solid->shape->half_length, axis, x);
    se3di_solid_to_local(c->m->mesh, x, c->middle);
    se3di_scale(end, axis, axis);
    se3di_mul_transposed(c->m->mesh->at->R, axis, c->out);
    if (!find_part(c)) {
        return 0;
    }
    place_rim(c, end > 0.0);
    if (!is_highest(c)) {
        return 0;
    }
    keep_part(c);
    return !(c->deepest > 0.0) || are_wide(c);
}

int se3di_narrow_flush(const se3di_mesh_meeting *m)
{
    cap c;
    if (!se3di_solid_has_rims(m->solid) || m->mesh->shape->closed == 0) {
        return 0;
    }
    c.m = m;
    c.level = LEVEL * m->size;
    c.count = 0;
    se3di_mesh_box_of(m, c.low, c.high);
    se3di_mesh_visit_box(m->mesh->shape, c.low, c.high, note_near, &c);
    for (int end = -1; end < 2 && c.count <= NEAR; end += 2) {
        if (lies_flush(&c, (double)end)) {
            if (c.deepest > 0.0) {
                touch_part(&c);
            }
            se3di_manifold_separate(m->manifold, m->mesh->at->R);
            return 1;
        }
    }
    return 0;
}
