/* SPDX-License-Identifier: BSD-3-Clause */
/* Roads on their bodies. Data only; what tyres make of them is in force/road.h. */
#ifndef SE3DI_MODEL_ROAD_H
#define SE3DI_MODEL_ROAD_H

#include "base/alloc.h"

#include <stdint.h>

typedef enum se3di_road_kind {
    SE3DI_ROAD_PLANE = 0,
    SE3DI_ROAD_FUNCTION = 1,
    SE3DI_ROAD_GRID = 2,
    SE3DI_ROAD_MESH = 3
} se3di_road_kind;

typedef struct se3di_road {
    char *name;
    uint32_t body, users;
    int32_t kind;     /* se3di_road_kind */
    int32_t function; /* height over (t, x, y), dense; -1: none */
    double point[3];  /* origin, frame of the body */
    double axes[9];   /* rows: forward, left, up; frame of the body */
    double *heights;  /* grid [rows * columns], by rows of equal y; NULL: none */
    size_t columns, rows;
    double cell[2]; /* along x and y */
    double *points; /* mesh [3 * point_count]; NULL: none */
    size_t point_count;
    uint32_t *triangles; /* [3 * triangle_count] */
    size_t triangle_count;
    uint32_t *first;  /* [bins[0] * bins[1] + 1]: where the list of a bin begins */
    uint32_t *listed; /* [listed_count] triangles that may be over a bin */
    size_t listed_count;
    size_t bins[2];    /* along x and y */
    double low[2];     /* corner of the bins */
    double bin_of[2];  /* bins per length */
    double outside[2]; /* the other corner */
} se3di_road;

/* `road` is a bitwise copy of another: replace what it points to, but for its name, by its own
 * copies. On failure it owns nothing. NO_MEMORY. */
se3d_status se3di_road_own(const se3d_allocator *allocator, se3di_road *road);
void se3di_road_release(const se3d_allocator *allocator, se3di_road *road);
/* Sort the triangles of a mesh, which it owns, into bins. NO_MEMORY. */
se3d_status se3di_road_sort(const se3d_allocator *allocator, se3di_road *road);

#endif
