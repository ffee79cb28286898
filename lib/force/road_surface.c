/* SPDX-License-Identifier: BSD-3-Clause */
/* Heights of roads that are maps of points, with their slopes and curvatures.
 *
 * Grid: in each cell a bicubic polynomial, product of Catmull-Rom curves: with p_-1 ... p_2 around
 * 0 <= u < 1,
 *
 *     p(u) = p_0 + u (p_1 - p_-1)/2 + u^2 (p_-1 - 5 p_0/2 + 2 p_1 - p_2/2)
 *                + u^3 (3 (p_0 - p_1) + p_2 - p_-1)/2
 *
 * through all points, with continuous slopes; beyond the border points go on straight within half a
 * curve, and the surface level. Mesh: the highest triangle above or below the point, and the plane
 * z = 0 beside all.                                             docs/theory/road.md */
#include "force/road.h"

#include <math.h>
#include <string.h>

#define STEEP 1e-9 /* area of a triangle seen from above, over its own: less is a wall */
#define BRIM  1e-9 /* part of a triangle's size that counts as still on it */

/* ---- Grid ----------------------------------------------------------------------------------*/

/* Weights of four points in value, slope and curvature at u of a cell. */
static void weigh(double u, double w[3][4])
{
    const double v = u * u, c = v * u;
    const double value[4] = {0.5 * (-u + 2.0 * v - c), 0.5 * (2.0 - 5.0 * v + 3.0 * c),
                             0.5 * (u + 4.0 * v - 3.0 * c), 0.5 * (c - v)};
    const double slope[4] = {0.5 * (-1.0 + 4.0 * u - 3.0 * v), 0.5 * (9.0 * v - 10.0 * u),
                             0.5 * (1.0 + 8.0 * u - 9.0 * v), 0.5 * (3.0 * v - 2.0 * u)};
    const double bend[4] = {2.0 - 3.0 * u, 9.0 * u - 5.0, 4.0 - 9.0 * u, 3.0 * u - 1.0};
    memcpy(w[0], value, sizeof value);
    memcpy(w[1], slope, sizeof slope);
    memcpy(w[2], bend, sizeof bend);
}

/* The cell of a coordinate, and the weights there by the coordinate; level outside. */
typedef struct place {
    size_t cell;
    double w[3][4];
} place;

static void find_place(double x, double width, size_t count, place *at)
{
    const double last = (double)(count - 1), u = x / width;
    if (!(u > 0.0 && u < last)) {
        memset(at->w, 0, sizeof at->w);
        at->cell = u < 1.0 ? 0 : count - 2;
        at->w[0][u < 1.0 ? 1 : 2] = 1.0;
        return;
    }
    at->cell = (size_t)u;
    weigh(u - (double)at->cell, at->w);
    for (int k = 0; k < 4; ++k) {
        at->w[1][k] /= width;
        at->w[2][k] /= width * width;
    }
}

/* Point `index` - 1 of a row or column; those beyond its ends go on straight. */
static double extend(const double *values, size_t stride, size_t count, size_t index)
{
    if (index == 0) {
        return 2.0 * values[0] - values[stride];
    }
    if (index > count) {
        return 2.0 * values[(count - 1) * stride] - values[(count - 2) * stride];
    }
    return values[(index - 1) * stride];
}

static double sum4(const double w[4], const double p[4])
{
    return w[0] * p[0] + w[1] * p[1] + w[2] * p[2] + w[3] * p[3];
}

static void eval_grid(const se3di_road *road, double x, double y, se3di_road_height *height)
{
    place u, v;
    double corner[4][4], along[3][4]; /* [row][column]; derivative by x of each row */
    find_place(x + 0.5 * (double)(road->columns - 1) * road->cell[0], road->cell[0], road->columns,
               &u);
    find_place(y + 0.5 * (double)(road->rows - 1) * road->cell[1], road->cell[1], road->rows, &v);
    for (size_t c = 0; c < 4; ++c) {
        double column[4]; /* at rows v.cell ... v.cell + 1, and one to each side */
        for (size_t r = 0; r < 4; ++r) {
            const size_t row = v.cell + r; /* counts from 1 */
            const size_t inside = row == 0 ? 1 : row > road->rows ? road->rows : row;
            column[r] =
                extend(road->heights + (inside - 1) * road->columns, 1, road->columns, u.cell + c);
        }
        if (v.cell == 0) {
            column[0] = 2.0 * column[1] - column[2];
        }
        if (v.cell + 3 > road->rows) {
            column[3] = 2.0 * column[2] - column[1];
        }
        for (size_t r = 0; r < 4; ++r) {
            corner[r][c] = column[r];
        }
    }
    for (int d = 0; d < 3; ++d) {
        for (int r = 0; r < 4; ++r) {
            along[d][r] = sum4(u.w[d], corner[r]);
        }
    }
    height->h = sum4(v.w[0], along[0]);
    height->x = sum4(v.w[0], along[1]);
    height->y = sum4(v.w[1], along[0]);
    height->xx = sum4(v.w[0], along[2]);
    height->xy = sum4(v.w[1], along[1]);
    height->yy = sum4(v.w[2], along[0]);
}

/* ---- Mesh ----------------------------------------------------------------------------------*/

/* Whether a triangle is over the point; then its height there and slopes. */
static int eval_triangle(const se3di_road *road, size_t triangle, double x, double y,
                         double plane[3])
{
    const uint32_t *corner = road->triangles + 3 * triangle;
    const double *p = road->points + 3 * (size_t)corner[0];
    const double *q = road->points + 3 * (size_t)corner[1];
    const double *r = road->points + 3 * (size_t)corner[2];
    const double a[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    const double b[3] = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
    const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    if (!(fabs(n[2]) > STEEP * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]))) {
        return 0;
    }
    const double e[2] = {x - p[0], y - p[1]};
    const double s = (e[0] * b[1] - e[1] * b[0]) / n[2], t = (a[0] * e[1] - a[1] * e[0]) / n[2];
    if (s < -BRIM || t < -BRIM || s + t > 1.0 + BRIM) {
        return 0;
    }
    plane[1] = -n[0] / n[2];
    plane[2] = -n[1] / n[2];
    plane[0] = p[2] + plane[1] * e[0] + plane[2] * e[1];
    return 1;
}

static void eval_mesh(const se3di_road *road, double x, double y, se3di_road_height *height)
{
    size_t bin[2];
    const double at[2] = {x, y};
    int found = 0;
    for (int axis = 0; axis < 2; ++axis) {
        if (at[axis] < road->low[axis] || at[axis] > road->outside[axis]) {
            return;
        }
        const double u = (at[axis] - road->low[axis]) * road->bin_of[axis];
        bin[axis] = (size_t)fmin(u, (double)(road->bins[axis] - 1));
    }
    const uint32_t *first = road->first + bin[1] * road->bins[0] + bin[0];
    for (uint32_t k = first[0]; k < first[1]; ++k) {
        double plane[3];
        if (eval_triangle(road, road->listed[k], x, y, plane) && (!found || plane[0] > height->h)) {
            height->h = plane[0];
            height->x = plane[1];
            height->y = plane[2];
            found = 1;
        }
    }
}

void se3di_road_eval_surface(const se3di_road *road, const double at[3], se3di_road_height *height)
{
    if (road->kind == SE3DI_ROAD_GRID) {
        eval_grid(road, at[1], at[2], height);
    } else {
        eval_mesh(road, at[1], at[2], height);
    }
}
