/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of points of a pair. */
#include "contact/narrow/internal.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

void se3di_bend_set(se3di_bend *bend, const double u[3], double along, double across)
{
    se3di_copy(u, bend->u);
    bend->r[0] = along;
    bend->r[1] = across;
}

#define TIE   1e-2        /* gaps that are one but for this: the first of them */
#define APART 0x01000000u /* features that shapes give are below */

/* How far two points are apart; another normal counts as much as the extent of all. */
static double gap_between(const se3di_contact_point *a, const se3di_contact_point *b, double extent)
{
    double d[3], n[3];
    se3di_sub(a->point, b->point, d);
    se3di_sub(a->normal, b->normal, n);
    return se3di_dot(d, d) + extent * se3di_dot(n, n);
}

/* Of two, one that is far less deep, or else the same of them whatever their depths are: a choice
 * by depth would be another after every step, as what is chosen is pushed out. */
static uint32_t loser_of(const se3di_contact_point *points, uint32_t a, uint32_t b)
{
    const se3di_contact_point *p = &points[a], *q = &points[b];
    if (p->overlap < 0.5 * q->overlap || q->overlap < 0.5 * p->overlap) {
        return p->overlap < q->overlap ? a : b;
    }
    return p->feature > q->feature ? a : b;
}

/* Of points that are too many: which of them the others stand for best. */
static uint32_t find_spare(const se3di_contact_point *points, uint32_t count)
{
    uint32_t pair[2] = {0, 1};
    double extent = 0.0, least = HUGE_VAL;
    for (uint32_t k = 1; k < count; ++k) {
        extent = fmax(extent, gap_between(&points[0], &points[k], 0.0));
    }
    for (uint32_t a = 0; a + 1 < count; ++a) {
        for (uint32_t b = a + 1; b < count; ++b) {
            const double gap = gap_between(&points[a], &points[b], extent);
            if (gap < (1.0 - TIE) * least) {
                least = gap;
                pair[0] = a;
                pair[1] = b;
            }
        }
    }
    return loser_of(points, pair[0], pair[1]);
}

void se3di_contact_point_set(se3di_contact_point *p, const double point[3], const double normal[3],
                             double overlap, uint32_t feature)
{
    static const se3di_bend flat = {{0.0, 0.0, 0.0}, {HUGE_VAL, HUGE_VAL}};
    se3di_copy(point, p->point);
    se3di_copy(normal, p->normal);
    p->overlap = overlap;
    p->share = 0.5;
    p->feature = feature;
    p->reserved = 0;
    p->bend_i = p->bend_j = flat;
    se3di_perpendicular(normal, p->bend_i.u);
    se3di_copy(p->bend_i.u, p->bend_j.u);
}

uint32_t se3di_contact_points_thin(se3di_contact_point *points, uint32_t count, uint32_t most)
{
    for (; count > most; --count) {
        const uint32_t spare = find_spare(points, count);
        memmove(points + spare, points + spare + 1, (count - spare - 1) * sizeof *points);
    }
    return count;
}

se3di_contact_point *se3di_manifold_add(se3di_manifold *manifold, const double point[3],
                                        const double normal[3], double overlap, uint32_t feature)
{
    se3di_contact_point *p = &manifold->points[manifold->count];
    se3di_contact_point_set(p, point, normal, overlap, feature);
    if (manifold->count < SE3DI_MANIFOLD_POINTS) {
        ++manifold->count;
        return p;
    }
    const uint32_t spare = find_spare(manifold->points, SE3DI_MANIFOLD_POINTS + 1);
    if (spare < SE3DI_MANIFOLD_POINTS) {
        manifold->points[spare] = *p;
    }
    return &manifold->points[spare];
}

void se3di_manifold_mirror(se3di_manifold *manifold)
{
    for (uint32_t k = 0; k < manifold->count; ++k) {
        se3di_contact_point *p = &manifold->points[k];
        se3di_bend bend = p->bend_i;
        se3di_scale(-1.0, p->normal, p->normal);
        p->share = 1.0 - p->share;
        p->bend_i = p->bend_j;
        p->bend_j = bend;
    }
}

/* The cell of a direction among some 250: of its other two components over its largest. */
static uint32_t way_among(const double n[3])
{
    const int a = fabs(n[2]) > fmax(fabs(n[0]), fabs(n[1])) ? 2 : fabs(n[0]) > fabs(n[1]) ? 0 : 1;
    const double size = fabs(n[a]) > 0.0 ? fabs(n[a]) : 1.0;
    const double x = n[(a + 1) % 3] / size, y = n[(a + 2) % 3] / size;
    const uint32_t column = (uint32_t)fmin(7.5 * (1.0 + fmax(x, -1.0)), 14.0);
    const uint32_t row = (uint32_t)fmin(7.5 * (1.0 + fmax(y, -1.0)), 14.0);
    return 15 * row + column;
}

/* One of several keeps its feature, the others are told apart by where their normals look in the
 * frame R: by what stays, as their order in the list does not. */
static void separate_ways(se3di_manifold *manifold, const double R[9])
{
    uint32_t way[SE3DI_MANIFOLD_POINTS], feature[SE3DI_MANIFOLD_POINTS];
    double n[3];
    for (uint32_t k = 0; k < manifold->count; ++k) {
        se3di_mul_transposed(R, manifold->points[k].normal, n);
        way[k] = way_among(n);
        feature[k] = manifold->points[k].feature;
    }
    for (uint32_t k = 0; k < manifold->count; ++k) {
        int is_first = 1;
        for (uint32_t other = 0; is_first && other < manifold->count; ++other) {
            is_first = feature[other] != feature[k] || way[other] >= way[k];
        }
        manifold->points[k].feature += is_first ? 0u : APART * (1u + way[k]);
    }
}

void se3di_manifold_separate(se3di_manifold *manifold, const double R[9])
{
    separate_ways(manifold, R);
    for (uint32_t k = 1; k < manifold->count; ++k) {
        for (uint32_t other = 0; other < k; ++other) {
            if (manifold->points[other].feature == manifold->points[k].feature) {
                manifold->points[k].feature += APART;
                other = UINT32_MAX; /* all again */
            }
        }
    }
}
