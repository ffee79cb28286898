/* SPDX-License-Identifier: BSD-3-Clause */
/* What roads own: heights of a grid, triangles of a mesh, and bins by which those over a point are
 * found. */
#include "model/road.h"

#include <math.h>
#include <string.h>

#define BINS_MAX   1024 /* along one axis */
#define LISTED_MAX 16   /* bins of a triangle, on average */

typedef struct part {
    void **data;
    size_t count, size;
} part;

enum { PARTS = 5 };

static void list_parts(se3di_road *road, part parts[PARTS])
{
    const size_t bins = road->first ? road->bins[0] * road->bins[1] + 1 : 0;
    parts[0] = (part){(void **)&road->heights, road->rows * road->columns, sizeof *road->heights};
    parts[1] = (part){(void **)&road->points, 3 * road->point_count, sizeof *road->points};
    parts[2] = (part){(void **)&road->triangles, 3 * road->triangle_count, sizeof *road->triangles};
    parts[3] = (part){(void **)&road->first, bins, sizeof *road->first};
    parts[4] = (part){(void **)&road->listed, road->listed_count, sizeof *road->listed};
}

void se3di_road_release(const se3d_allocator *allocator, se3di_road *road)
{
    part parts[PARTS];
    list_parts(road, parts);
    for (int k = 0; k < PARTS; ++k) {
        if (*parts[k].data) {
            se3di_free(allocator, *parts[k].data, parts[k].count, parts[k].size);
        }
        *parts[k].data = NULL;
    }
}

se3d_status se3di_road_own(const se3d_allocator *allocator, se3di_road *road)
{
    se3di_road original = *road;
    part from[PARTS], to[PARTS];
    list_parts(&original, from);
    list_parts(road, to);
    for (int k = 0; k < PARTS; ++k) {
        *to[k].data = NULL;
    }
    for (int k = 0; k < PARTS; ++k) {
        if (!*from[k].data || from[k].count == 0) {
            continue;
        }
        *to[k].data = se3di_alloc(allocator, from[k].count, from[k].size);
        if (!*to[k].data) {
            for (int done = 0; done < k; ++done) {
                if (*to[done].data) {
                    se3di_free(allocator, *to[done].data, to[done].count, to[done].size);
                    *to[done].data = NULL;
                }
            }
            return SE3D_ERR_NO_MEMORY;
        }
        memcpy(*to[k].data, *from[k].data, from[k].count * from[k].size);
    }
    return SE3D_OK;
}

/* ---- Bins ----------------------------------------------------------------------------------*/

static size_t bin_at(const se3di_road *road, size_t axis, double x)
{
    const double at = (x - road->low[axis]) * road->bin_of[axis];
    return at > 0.0 ? (size_t)fmin(at, (double)(road->bins[axis] - 1)) : 0;
}

/* The bins that the box around a triangle is over: first and last along x, along y. */
static void find_span(const se3di_road *road, size_t triangle, size_t span[4])
{
    const uint32_t *corner = road->triangles + 3 * triangle;
    for (size_t axis = 0; axis < 2; ++axis) {
        double low = road->points[3 * corner[0] + axis], high = low;
        for (size_t k = 1; k < 3; ++k) {
            low = fmin(low, road->points[3 * corner[k] + axis]);
            high = fmax(high, road->points[3 * corner[k] + axis]);
        }
        span[2 * axis] = bin_at(road, axis, low);
        span[2 * axis + 1] = bin_at(road, axis, high);
    }
}

static void place_bins(se3di_road *road, double wanted)
{
    for (size_t axis = 0; axis < 2; ++axis) {
        double low = road->points[axis], high = low;
        for (size_t k = 1; k < road->point_count; ++k) {
            low = fmin(low, road->points[3 * k + axis]);
            high = fmax(high, road->points[3 * k + axis]);
        }
        const double width = high - low, scale = wanted / width;
        road->bins[axis] = width > 0.0 && isfinite(scale) ? (size_t)wanted : 1;
        road->low[axis] = low;
        road->outside[axis] = high;
        road->bin_of[axis] = road->bins[axis] > 1 ? scale : 0.0;
    }
}

static size_t count_listed(const se3di_road *road)
{
    size_t count = 0;
    for (size_t t = 0; t < road->triangle_count; ++t) {
        size_t span[4];
        find_span(road, t, span);
        count += (span[1] - span[0] + 1) * (span[3] - span[2] + 1);
    }
    return count;
}

/* As many as there are triangles, fewer where these are wide. */
static void choose_bins(se3di_road *road)
{
    double wanted = fmin(ceil(sqrt((double)road->triangle_count)), BINS_MAX);
    place_bins(road, wanted);
    while (wanted > 1.0 && count_listed(road) > LISTED_MAX * road->triangle_count) {
        wanted = ceil(0.5 * wanted);
        place_bins(road, wanted);
    }
}

/* Count (lists NULL) or list the triangles of every bin; `first` moves on while it lists. */
static void fill_bins(const se3di_road *road, uint32_t *first, uint32_t *lists)
{
    for (size_t t = 0; t < road->triangle_count; ++t) {
        size_t span[4];
        find_span(road, t, span);
        for (size_t y = span[2]; y <= span[3]; ++y) {
            for (size_t x = span[0]; x <= span[1]; ++x) {
                uint32_t *at = &first[y * road->bins[0] + x];
                if (lists) {
                    lists[*at] = (uint32_t)t;
                }
                ++*at;
            }
        }
    }
}

se3d_status se3di_road_sort(const se3d_allocator *allocator, se3di_road *road)
{
    choose_bins(road);
    const size_t count = road->bins[0] * road->bins[1];
    road->first = se3di_alloc(allocator, count + 1, sizeof *road->first);
    if (!road->first) {
        return SE3D_ERR_NO_MEMORY;
    }
    memset(road->first, 0, (count + 1) * sizeof *road->first);
    fill_bins(road, road->first + 1, NULL); /* counts, then sums: where each list ends */
    for (size_t k = 1; k <= count; ++k) {
        road->first[k] += road->first[k - 1];
    }
    road->listed_count = road->first[count];
    road->listed = se3di_alloc(allocator, road->listed_count, sizeof *road->listed);
    if (!road->listed) {
        return SE3D_ERR_NO_MEMORY; /* the caller releases what there is */
    }
    fill_bins(road, road->first, road->listed); /* each is now where the next one begins */
    memmove(road->first + 1, road->first, count * sizeof *road->first);
    road->first[0] = 0;
    return SE3D_OK;
}
