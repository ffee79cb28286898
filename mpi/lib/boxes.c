/* SPDX-License-Identifier: BSD-3-Clause */
/* Recursive bisection: the processes are halved, and space is cut across the longest side of what
 * is in it, so that the weights are as the numbers of processes. The cut lies between two points,
 * so that every point is clearly on one side.                                        docs/mpi.md */
#include "boxes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int boxes_create(boxes *b, int count)
{
    memset(b, 0, sizeof *b);
    b->count = count;
    b->cuts = calloc(2 * (size_t)count, sizeof *b->cuts);
    b->box = calloc((size_t)count, sizeof *b->box);
    if (!b->cuts || !b->box) {
        boxes_destroy(b);
        return 0;
    }
    return 1;
}

void boxes_destroy(boxes *b)
{
    free(b->cuts);
    free(b->box);
    b->cuts = NULL;
    b->box = NULL;
}

static int compare(const boxes_point *a, const boxes_point *b, int axis)
{
    if (a->x[axis] < b->x[axis] || a->x[axis] > b->x[axis]) {
        return a->x[axis] < b->x[axis] ? -1 : 1;
    }
    return a->number < b->number ? -1 : a->number > b->number;
}

static int compare_x(const void *a, const void *b)
{
    return compare(a, b, 0);
}

static int compare_y(const void *a, const void *b)
{
    return compare(a, b, 1);
}

static int compare_z(const void *a, const void *b)
{
    return compare(a, b, 2);
}

static int longest_axis(const boxes_point *points, size_t count)
{
    int axis = 0;
    double longest = -1.0;
    for (int a = 0; a < 3; ++a) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (size_t k = 0; k < count; ++k) {
            low = fmin(low, points[k].x[a]);
            high = fmax(high, points[k].x[a]);
        }
        if (high - low > longest) {
            longest = high - low;
            axis = a;
        }
    }
    return axis;
}

/* How many of the points, in order, have the share of the weight that is nearest to `part`. */
static size_t find_cut(const boxes_point *points, size_t count, double part)
{
    double total = 0.0, before = 0.0;
    for (size_t k = 0; k < count; ++k) {
        total += points[k].weight;
    }
    size_t k = 0;
    while (k < count && before + 0.5 * points[k].weight < part * total) {
        before += points[k++].weight;
    }
    return k;
}

/* Processes [first, first + ranks) share `all`; returns the number of the cut. */
static int divide(boxes *b, const boxes_box *all, int first, int ranks, boxes_point *points,
                  size_t count)
{
    static int (*const by[3])(const void *, const void *) = {compare_x, compare_y, compare_z};
    const int here = b->cut_count++;
    if (ranks == 1) {
        b->cuts[here] = (boxes_cut){.axis = -1, .low = first};
        b->box[first] = *all;
        return here;
    }
    const int axis = longest_axis(points, count), half = ranks / 2;
    qsort(points, count, sizeof *points, by[axis]);
    const size_t k = find_cut(points, count, (double)half / ranks);
    double at = fmax(-1e300, all->lower[axis]); /* if there is nothing to divide */
    if (k > 0) {
        at = k < count ? 0.5 * (points[k - 1].x[axis] + points[k].x[axis]) : points[k - 1].x[axis];
    }
    size_t low = k;
    while (low > 0 && !(points[low - 1].x[axis] < at)) {
        --low;
    }
    boxes_box parts[2] = {*all, *all};
    parts[0].upper[axis] = parts[1].lower[axis] = at;
    const int below = divide(b, &parts[0], first, half, points, low);
    const int above = divide(b, &parts[1], first + half, ranks - half, points + low, count - low);
    b->cuts[here] = (boxes_cut){at, axis, below, above};
    return here;
}

void boxes_divide(boxes *b, const boxes_box *all, boxes_point *points, size_t count)
{
    b->cut_count = 0;
    (void)divide(b, all, 0, b->count, points, count);
}

int boxes_find(const boxes *b, const double x[3])
{
    const boxes_cut *cut = b->cuts;
    while (cut->axis >= 0) {
        cut = &b->cuts[x[cut->axis] < cut->at ? cut->low : cut->high];
    }
    return cut->low;
}

/* Between two ranges; negative if they overlap. */
static double gap(double low, double high, double from, double to)
{
    return fmax(from - high, low - to);
}

double boxes_distance2(const boxes *b, const double lower[3], const double upper[3], int box)
{
    double sum = 0.0;
    for (int a = 0; a < 3; ++a) {
        const double from = b->box[box].lower[a], to = b->box[box].upper[a];
        double least = gap(lower[a], upper[a], from, to);
        for (int side = -1; b->period[a] > 0.0 && side <= 1; side += 2) {
            const double shift = side * b->period[a];
            least = fmin(least, gap(lower[a] + shift, upper[a] + shift, from, to));
        }
        sum += least > 0.0 ? least * least : 0.0;
    }
    return sum;
}
