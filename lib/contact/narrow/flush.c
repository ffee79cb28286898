/* SPDX-License-Identifier: BSD-3-Clause */
/* A flat side of a solid, the cap of a cylinder or a face, that lies on a flat part of a closed
 * mesh, as the head of a bolt on a flange.
 *
 * If all of the mesh about the solid is at or below the plane of that part, the solid cannot touch
 * it elsewhere, and comes off it along the plane's normal: no way to a side counts, however short
 * it is beside a hole. What touches is known then: corners, or points of the rim, over the part,
 * and the ends of what of the part's outline is below the side.  docs/theory/body-contact.md */
#include "contact/narrow/internal.h"
#include "contact/narrow/mesh.h"
#include "contact/shape/mesh_tree.h"
#include "contact/shape/triangles.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define LEAN  1e-2  /* sine of the angle between cap and part at most */
#define DEEP  0.1   /* of the size: the deepest at most */
#define LEVEL 1e-6  /* of the size: what is in one plane */
#define SLACK 1e-4  /* of the extent: places that are one; a rim is over the part in spite of it */
#define WIDE  4.0   /* times the depth: so far from all sides there is a place at least */
#define STEEP 0.1   /* sine of the angle by which walls of the part fall off at least */
#define SLOW  0.995 /* about its cosine */
#define NEAR  512   /* triangles about the solid at most */
#define TRIES 4     /* directions in which a face is looked for */

/* All in the frame of the mesh. */
typedef struct cap {
    const se3di_mesh_meeting *m;
    double middle[3], out[3]; /* of the side; its outward normal */
    double n[3], height;      /* of the part; of the middle over it */
    double level, deepest;    /* of the side, below the part */
    double radius, extent;    /* of a cap, 0: a face; from the middle to the corners at most */
    double corner[SE3DI_FACE_CORNERS][3];
    uint32_t id[SE3DI_FACE_CORNERS];
    int corner_count, count, part_count;
    uint32_t all[NEAR], near[NEAR]; /* about the solid; of the part */
    uint8_t is_border[NEAR][3];     /* sides of these beyond which the part ends */
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

/* The same of a corner of a triangle. */
static double height_at(const cap *c, uint32_t triangle, uint32_t k)
{
    const se3di_shape *s = c->m->mesh->shape;
    return height_of(c, s->vertices + 3 * (size_t)s->triangles[3 * (size_t)triangle + k]);
}

static void note_near(void *ctx, uint32_t triangle)
{
    cap *c = ctx;
    const double *corner[3];
    int is_beside = 0;
    se3di_triangle_corners(c->m->mesh->shape, triangle, corner);
    for (int k = 0; k < 3; ++k) {
        const double *a = corner[0], *b = corner[1], *d = corner[2];
        const double low = c->m->low[k], high = c->m->high[k];
        is_beside = is_beside || (a[k] < low && b[k] < low && d[k] < low) ||
                    (a[k] > high && b[k] > high && d[k] > high);
    }
    if (!is_beside) {
        if (c->count < NEAR) {
            c->all[c->count] = triangle;
        }
        ++c->count;
    }
}

/* The highest plane below the side that looks at it. */
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

/* A place of both, unless it is there. */
static void add_place(cap *c, const double at[3], const double n[3], double overlap,
                      uint32_t feature)
{
    double d[3], x[3];
    se3di_solid_to_ground(c->m->mesh, at, x);
    for (uint32_t k = 0; k < c->m->manifold->count; ++k) {
        se3di_sub(c->m->manifold->points[k].point, x, d);
        if (se3di_norm(d) < SLACK * c->extent) {
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
            if (c->is_border[k][n] && se3di_triangle_nearest(ends, x, at, NULL) < margin * margin) {
                return 0;
            }
        }
    }
    return 1;
}

/* How far a place is within side k of a face. */
static double depth_in(const cap *c, int k, const double x[3])
{
    double along[3], inward[3], d[3];
    se3di_sub(c->corner[(k + 1) % c->corner_count], c->corner[k], along);
    se3di_cross(c->out, along, inward);
    se3di_sub(x, c->corner[k], d);
    return se3di_dot(d, inward) / se3di_norm(inward);
}

/* Whether a place is below the side, and so far from all of its border. */
static int is_below(const cap *c, const double x[3], double margin)
{
    double d[3];
    int below = 1;
    for (int k = 0; k < c->corner_count && below && !(c->radius > 0.0); ++k) {
        below = depth_in(c, k, x) > margin;
    }
    se3di_sub(x, c->middle, d);
    se3di_add_scaled(-se3di_dot(d, c->out), c->out, d);
    return below && (!(c->radius > 0.0) || se3di_norm(d) < c->radius - margin);
}

/* Whether the side and the part have a place in common that is farther from border and outline than
 * they are deep, so that they do not come apart to a side sooner: the middle, or one near a corner.
 */
static int are_wide(const cap *c)
{
    const double margin = WIDE * c->deepest + SLACK * c->extent;
    for (int k = 0; k <= c->corner_count; ++k) {
        double x[3];
        se3di_copy(c->middle, x);
        for (int a = 0; a < 3 && k < c->corner_count; ++a) {
            x[a] += (1.0 - 2.5 * margin / c->extent) * (c->corner[k][a] - c->middle[a]);
        }
        se3di_add_scaled(-height_of(c, x), c->n, x);
        if (is_below(c, x, margin) && is_within(c, x, margin)) {
            return 1;
        }
    }
    return 0;
}

/* Whether side and part have something in common at a place that is on the border of both. */
static int have_region(const cap *c, const double at[3])
{
    double u[3], w[3];
    int found = 0;
    se3di_perpendicular(c->n, u);
    se3di_cross(c->n, u, w);
    for (int k = 0; k < SE3DI_WAYS_ASIDE && !found; ++k) {
        double x[3], by[2];
        se3di_step_aside(k, 3.0 * SLACK * c->extent, by);
        se3di_copy(at, x);
        se3di_add_scaled(by[0], u, x);
        se3di_add_scaled(by[1], w, x);
        found = is_below(c, x, 0.0) && is_over(c, x, c->level);
    }
    return found;
}

/* Corners of the side, or points of its rim, that are over the part. */
static void touch_corners(cap *c)
{
    for (int k = 0; k < c->corner_count; ++k) {
        double x[3];
        const double height = height_of(c, c->corner[k]);
        se3di_copy(c->corner[k], x);
        se3di_add_scaled(-height, c->n, x);
        if (is_over(c, x, c->level) || (is_over(c, x, SLACK * c->extent) && have_region(c, x))) {
            add_place(c, x, c->n, -height, 8 * c->id[k] + se3di_mesh_way_of(c->n));
        }
    }
}

/* Which part of a line from a is below a cap: between two shares of the way. */
static void cut_by_rim(const cap *c, const double a[3], const double way[3], double share[2])
{
    double d[3], flat[3];
    se3di_sub(a, c->middle, d);
    se3di_add_scaled(-se3di_dot(d, c->out), c->out, d); /* in the plane of the cap */
    se3di_copy(way, flat);
    se3di_add_scaled(-se3di_dot(way, c->out), c->out, flat);
    const double A = se3di_dot(flat, flat), B = se3di_dot(flat, d);
    const double C = se3di_dot(d, d) - c->radius * c->radius, root = B * B - A * C;
    share[1] = root > 0.0 ? fmin(1.0, (-B + sqrt(root)) / A) : 0.0;
    share[0] = root > 0.0 ? fmax(0.0, (-B - sqrt(root)) / A) : 0.0;
}

/* The same of a face. */
static void cut_by_sides(const cap *c, const double a[3], const double way[3], double share[2])
{
    double b[3];
    se3di_add(a, way, b);
    share[0] = 0.0;
    share[1] = 1.0;
    for (int k = 0; k < c->corner_count; ++k) {
        const double from = depth_in(c, k, a), to = depth_in(c, k, b);
        if (from < 0.0 && to < 0.0) {
            share[1] = 0.0;
        } else if (from < 0.0) {
            share[0] = fmax(share[0], from / (from - to));
        } else if (to < 0.0) {
            share[1] = fmin(share[1], from / (from - to));
        }
    }
}

/* The ends of what of a side of the part is below that of the solid. */
static void touch_side(cap *c, uint32_t triangle, uint32_t side)
{
    const se3di_shape *s = c->m->mesh->shape;
    const double *a = se3di_mesh_corner(s, triangle, side);
    double way[3], d[3], up[3], share[2];
    se3di_sub(se3di_mesh_corner(s, triangle, side + 1), a, way);
    if (c->radius > 0.0) {
        cut_by_rim(c, a, way, share);
    } else {
        cut_by_sides(c, a, way, share);
    }
    if (!((share[1] - share[0]) * se3di_norm(way) > SLACK * c->extent)) {
        return;
    }
    se3di_sub(a, c->middle, d);
    se3di_scale(-1.0, c->out, up);
    for (uint32_t end = 0; end < 2; ++end) {
        double x[3];
        se3di_copy(a, x);
        se3di_add_scaled(share[end], way, x);
        add_place(c, x, up, se3di_dot(d, up) + share[end] * se3di_dot(way, up),
                  0x80000000u + 16 * (3 * triangle + side) + end);
    }
}

static void touch_part(cap *c)
{
    touch_corners(c);
    for (int k = 0; k < c->part_count; ++k) {
        for (uint32_t side = 0; side < 3; ++side) {
            if (c->is_border[k][side]) {
                touch_side(c, c->near[k], side);
            }
        }
    }
}

/* Whether the part is about a side of it as a convex one is: nothing of it is beyond. */
static int is_convex_at(const cap *c, uint32_t triangle, uint32_t side)
{
    const se3di_shape *s = c->m->mesh->shape;
    const double *a = se3di_mesh_corner(s, triangle, side);
    double way[3], outward[3], d[3];
    se3di_sub(se3di_mesh_corner(s, triangle, side + 1), a, way);
    se3di_cross(way, c->n, outward);
    se3di_scale((double)s->closed, outward, outward);
    for (int k = 0; k < c->part_count; ++k) {
        for (uint32_t n = 0; n < 3; ++n) {
            se3di_sub(se3di_mesh_corner(s, c->near[k], n), a, d);
            if (se3di_dot(d, outward) > SLACK * c->extent * se3di_norm(way)) {
                return 0;
            }
        }
    }
    return 1;
}

/* Whether there is a hole in the part, or a bay, below the side. */
static int has_hole(const cap *c)
{
    const se3di_shape *s = c->m->mesh->shape;
    for (int k = 0; k < c->part_count; ++k) {
        for (uint32_t side = 0; side < 3; ++side) {
            double way[3], share[2];
            const double *a = se3di_mesh_corner(s, c->near[k], side);
            if (!c->is_border[k][side]) {
                continue;
            }
            se3di_sub(se3di_mesh_corner(s, c->near[k], side + 1), a, way);
            cut_by_sides(c, a, way, share);
            if (share[1] > share[0] && !is_convex_at(c, c->near[k], side)) {
                return 1;
            }
        }
    }
    return 0;
}

/* ---- what is about the solid ---- */

/* Of the corners of a triangle, as bits, which are in the plane of the part; -1: one is not, but as
 * high as the side. */
static int find_level(const cap *c, uint32_t triangle)
{
    int level = 0;
    for (uint32_t k = 0; k < 3; ++k) {
        const double height = height_at(c, triangle, k);
        if (fabs(height) < c->level) {
            level |= 1 << k;
        } else if (height > fmin(0.0, -c->deepest - c->level)) {
            return -1;
        }
    }
    return level;
}

static int is_of_part(const cap *c, uint32_t triangle)
{
    return find_level(c, triangle) == 7;
}

static void keep_part(cap *c, uint32_t triangle)
{
    const uint32_t *beyond = se3di_mesh_beyond(c->m->mesh->shape) + 3 * (size_t)triangle;
    for (int side = 0; side < 3; ++side) {
        c->is_border[c->part_count][side] = (uint8_t)!is_of_part(c, beyond[side]);
    }
    c->near[c->part_count++] = triangle;
}

/* Whether a corner of the mesh, in the plane of the part, is of it or not about the solid. */
static int is_of_corners(const cap *c, uint32_t vertex)
{
    const se3di_shape *s = c->m->mesh->shape;
    const double *x = s->vertices + 3 * (size_t)vertex;
    for (int k = 0; k < c->part_count; ++k) {
        const uint32_t *own = s->triangles + 3 * (size_t)c->near[k];
        if (own[0] == vertex || own[1] == vertex || own[2] == vertex) {
            return 1;
        }
    }
    for (int k = 0; k < 3; ++k) {
        if (x[k] < c->m->low[k] || x[k] > c->m->high[k]) {
            return 1;
        }
    }
    return is_over(c, x, c->level); /* a mesh may have a corner several times */
}

/* Whether a side leads out of the plane of the part and falls off slowly, not in a steep wall. */
static int falls_slowly(const cap *c, uint32_t triangle, uint32_t side)
{
    const se3di_shape *s = c->m->mesh->shape;
    const uint32_t next = se3di_mesh_beyond(s)[3 * (size_t)triangle + side];
    double way[3], n[3], other[3];
    se3di_sub(se3di_mesh_corner(s, triangle, side + 1), se3di_mesh_corner(s, triangle, side), way);
    const double fall = se3di_dot(way, c->n);
    if (fall * fall > STEEP * STEEP * se3di_dot(way, way)) {
        return 0;
    }
    normal_of(c, triangle, n);
    normal_of(c, next, other);
    return se3di_dot(n, other) < SLOW || se3di_dot(n, c->n) > SLOW;
}

/* Whether a triangle that has corners in the plane of the part is where the part ends, and falls
 * off from there faster than the side, which leans, can. */
static int is_wall(const cap *c, uint32_t triangle)
{
    const se3di_shape *s = c->m->mesh->shape;
    const int level = find_level(c, triangle), is_tip = (level & (level - 1)) == 0;
    for (uint32_t k = 0; k < 3; ++k) {
        const int first = level >> k & 1, second = level >> (k + 1) % 3 & 1;
        const size_t at = 3 * (size_t)triangle + k;
        if ((first && second && !is_of_part(c, se3di_mesh_beyond(s)[at])) ||
            (first != second && falls_slowly(c, triangle, k)) ||
            (first && is_tip && !is_of_corners(c, s->triangles[at]))) {
            return 0;
        }
    }
    return 1;
}

/* Find the part's triangles. Returns whether nothing about the solid rises above the part, and
 * nothing else is as high as its side. */
static int keep_parts(cap *c)
{
    uint32_t walls[NEAR];
    int wall_count = 0;
    c->part_count = 0;
    for (int k = 0; k < c->count; ++k) {
        const int level = find_level(c, c->all[k]);
        if (level < 0) {
            return 0;
        }
        if (level == 7) {
            keep_part(c, c->all[k]);
        } else if (level > 0) {
            walls[wall_count++] = c->all[k];
        }
    }
    while (wall_count > 0 && is_wall(c, walls[wall_count - 1])) {
        --wall_count;
    }
    return wall_count == 0;
}

/* ---- the sides of a solid ---- */

static void place_rim(cap *c, int is_upper)
{
    const uint32_t first = is_upper ? 4 : 0;
    double rim[8][3], normal[3];
    se3di_mul(c->m->mesh->at->R, c->n, normal);
    (void)se3di_cylinder_rims(c->m->solid, normal, c->deepest, rim);
    c->corner_count = 4;
    for (uint32_t k = 0; k < 4; ++k) {
        c->id[k] = first + k;
        se3di_solid_to_local(c->m->mesh, rim[first + k], c->corner[k]);
    }
}

/* Whether nothing else than a part can touch. */
static int lies_flush(cap *c)
{
    return keep_parts(c) && (!(c->deepest > 0.0) || are_wide(c));
}

/* Find the part below a side, and how deep this is in it. */
static int find_deepest(cap *c)
{
    double lowest[3];
    if (!find_part(c)) {
        return 0;
    }
    (void)se3di_mesh_lowest(c->m, c->n, lowest);
    c->deepest = -height_of(c, lowest);
    return 1;
}

/* Whether a cap lies on a part of the mesh, or over it. */
static int lies_on_cap(cap *c, double end)
{
    const se3di_shape *s = c->m->solid->shape;
    double axis[3], x[3];
    se3di_solid_axis(c->m->solid, 2, axis);
    se3di_copy(c->m->solid->at->x, x);
    se3di_add_scaled(end * s->half_length, axis, x);
    se3di_solid_to_local(c->m->mesh, x, c->middle);
    se3di_scale(end, axis, axis);
    se3di_mul_transposed(c->m->mesh->at->R, axis, c->out);
    c->radius = c->extent = s->radius;
    if (!find_deepest(c)) {
        return 0;
    }
    place_rim(c, end > 0.0);
    return lies_flush(c);
}

/* Which corner of the shape is at a place, ground frame. */
static uint32_t find_corner(const se3di_solid *solid, const double x[3])
{
    const se3di_shape_class *kind = se3di_shape_class_of(solid->shape);
    double local[3], corner[3], d[3], least = HUGE_VAL;
    uint32_t nearest = 0;
    se3di_solid_to_local(solid, x, local);
    for (uint32_t k = 0; kind->corner(solid->shape, k, corner); ++k) {
        se3di_sub(local, corner, d);
        if (se3di_dot(d, d) < least) {
            least = se3di_dot(d, d);
            nearest = k;
        }
    }
    return nearest;
}

/* The same of the face that looks against n best. On a part that is convex there what is exact for
 * convex pieces finds it, too. */
static int lies_on_face(cap *c, const double n[3])
{
    const se3di_solid *solid = c->m->solid;
    double down[3];
    se3di_face face;
    se3di_mul(c->m->mesh->at->R, n, down);
    se3di_scale(-1.0, down, down);
    se3di_face_find(solid, down, &face);
    if (face.count < 3 || face.count == SE3DI_FACE_CORNERS) {
        return 0;
    }
    memset(c->middle, 0, sizeof c->middle);
    c->corner_count = face.count;
    for (int k = 0; k < face.count; ++k) {
        c->id[k] = find_corner(solid, face.corner[k]);
        se3di_solid_to_local(c->m->mesh, face.corner[k], c->corner[k]);
        se3di_add_scaled(1.0 / face.count, c->corner[k], c->middle);
    }
    c->radius = c->extent = 0.0;
    for (int k = 0; k < face.count; ++k) {
        double d[3];
        se3di_sub(c->corner[k], c->middle, d);
        c->extent = fmax(c->extent, se3di_norm(d));
    }
    se3di_mul_transposed(c->m->mesh->at->R, face.normal, c->out);
    return find_deepest(c) && lies_flush(c) && has_hole(c);
}

/* In the directions of the triangles about the solid that it is not deep in. */
static int lies_on_some_face(cap *c)
{
    double tried[TRIES][3];
    int tries = 0;
    for (int t = 0; t < c->count && tries < TRIES; ++t) {
        double n[3], lowest[3], d[3];
        int is_new = 1;
        normal_of(c, c->all[t], n);
        for (int k = 0; k < tries; ++k) {
            is_new = is_new && !(se3di_dot(tried[k], n) > 1.0 - LEAN * LEAN);
        }
        (void)se3di_mesh_lowest(c->m, n, lowest);
        se3di_sub(lowest, se3di_mesh_corner(c->m->mesh->shape, c->all[t], 0), d);
        if (is_new && fabs(se3di_dot(d, n)) < DEEP * c->m->size) {
            if (lies_on_face(c, n)) {
                return 1;
            }
            se3di_copy(n, tried[tries++]);
        }
    }
    return 0;
}

int se3di_narrow_flush(const se3di_mesh_meeting *m)
{
    const int has_rims = se3di_solid_has_rims(m->solid);
    const int has_corners = se3di_shape_class_of(m->solid->shape)->corner != NULL;
    cap c;
    if (!(has_rims || has_corners) || m->mesh->shape->closed == 0) {
        return 0;
    }
    c.m = m;
    c.level = LEVEL * m->size;
    c.count = 0;
    se3di_mesh_visit_box(m->mesh->shape, m->low, m->high, note_near, &c);
    if (c.count > NEAR ||
        !(has_rims ? lies_on_cap(&c, -1.0) || lies_on_cap(&c, 1.0) : lies_on_some_face(&c))) {
        return 0;
    }
    if (c.deepest > 0.0) {
        touch_part(&c);
    }
    se3di_manifold_separate(m->manifold, m->mesh->at->R);
    return 1;
}
