/* SPDX-License-Identifier: BSD-3-Clause */
/* Given shapes in a sketch: the edges of a box, the rims of a cylinder, and what bounds all else as
 * it is seen, which is the convex hull of its points in the plane (Andrew's monotone chain). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/write/sketch_view.h"

typedef struct shape {
    FILE *file; /* NULL: nothing is drawn */
    const se3di_sketch_view *view;
    const double *pose;
    const se3di_part *part;
    double *low, *high; /* [2] */
} shape;

/* A point of the part's mesh as it is seen. */
static se3di_spot spot_of(const shape *s, const double point[3])
{
    double placed[SE3DI_POSE];
    double at[3];
    memcpy(placed, s->part->position, sizeof s->part->position);
    memcpy(placed + 3, s->part->orientation, sizeof s->part->orientation);
    for (int i = 0; i < 3; ++i) {
        at[i] = s->part->scale[i] * point[i];
    }
    se3di_drawing_to_ground(placed, at, at);
    se3di_drawing_to_ground(s->pose, at, at);
    const se3di_spot spot = se3di_sketch_project(s->view, at);
    s->low[0] = fmin(s->low[0], spot.x);
    s->low[1] = fmin(s->low[1], spot.y);
    s->high[0] = fmax(s->high[0], spot.x);
    s->high[1] = fmax(s->high[1], spot.y);
    return spot;
}

static void put_box(const shape *s)
{
    se3di_spot corners[8];
    for (int k = 0; k < 8; ++k) {
        const double point[3] = {k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5};
        corners[k] = spot_of(s, point);
    }
    for (int k = 0; s->file && k < 8; ++k) {
        for (int way = 1; way < 8; way *= 2) {
            if (!(k & way)) {
                se3di_svg_line(s->file, "outline", corners[k], corners[k | way]);
            }
        }
    }
}

static int by_place(const void *a, const void *b)
{
    const se3di_spot *p = a;
    const se3di_spot *q = b;
    return p->x < q->x ? -1 : p->x > q->x ? 1 : (p->y > q->y) - (p->y < q->y);
}

/* Whether c lies to the left of the way from a to b, seen with y upwards. */
static bool turns(se3di_spot a, se3di_spot b, se3di_spot c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0;
}

/* The corners of the convex hull of sorted points, to hull[2 * count]. @return how many. */
static size_t find_hull(const se3di_spot *points, size_t count, se3di_spot *hull)
{
    size_t used = 0;
    size_t least = 2;
    for (size_t k = 0; k < 2 * count; ++k) { /* there along the lower side, back along the upper */
        const se3di_spot p = points[k < count ? k : 2 * count - 1 - k];
        if (k == count) {
            least = used + 1;
        }
        while (used >= least && !turns(hull[used - 2], hull[used - 1], p)) {
            --used;
        }
        hull[used++] = p;
    }
    return used - 1; /* the first one again */
}

/* `points` [3 * count] of a mesh. */
static bool put_bounds(const shape *s, const double *points, size_t count, se3di_iopool *pool)
{
    se3di_spot *spots = se3di_iopool_array(pool, count, sizeof *spots);
    se3di_spot *hull = se3di_iopool_array(pool, 2 * count, sizeof *hull);
    if (!spots || !hull) {
        return false;
    }
    for (size_t k = 0; k < count; ++k) {
        spots[k] = spot_of(s, points + 3 * k);
    }
    if (s->file && count > 2) {
        qsort(spots, count, sizeof *spots, by_place);
        se3di_svg_path(s->file, "outline", hull, find_hull(spots, count, hull), true);
    }
    return true;
}

/* The circles in which its side ends. */
static void put_rims(const shape *s, const se3di_unit_mesh *unit)
{
    se3di_spot rim[SE3DI_UNIT_VERTICES_MAX];
    for (int end = 0; s->file && end < 2; ++end) {
        size_t count = 0;
        for (size_t k = 0; k < unit->points_count; ++k) {
            if (fabs(unit->normals[3 * k + 2]) < 0.5 && (unit->points[3 * k + 2] > 0.0) == end) {
                rim[count++] = spot_of(s, unit->points + 3 * k);
            }
        }
        se3di_svg_path(s->file, "outline", rim, count, true);
    }
}

bool se3di_sketch_put_shape(FILE *file, const se3di_sketch_view *view, const double *pose,
                            const se3di_part *part, se3di_iopool *pool, double low[2],
                            double high[2])
{
    const shape s = {file, view, pose, part, low, high};
    if (part->mesh) {
        return put_bounds(&s, part->mesh->points, part->mesh->point_count, pool);
    }
    if (part->unit == SE3DI_UNIT_BOX) {
        put_box(&s);
        return true;
    }
    se3di_unit_mesh *unit = se3di_iopool_alloc(pool, sizeof *unit);
    if (!unit) {
        return false;
    }
    se3di_unit_mesh_make(unit, part->unit);
    if (part->unit == SE3DI_UNIT_CYLINDER) {
        put_rims(&s, unit);
    }
    return put_bounds(&s, unit->points, unit->points_count, pool);
}
