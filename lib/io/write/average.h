/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields of the particles on a grid, or what they do to the triangles of a mesh, averaged over the
 * rows of a window of time. */
#ifndef SE3D_IO_AVERAGE_H
#define SE3D_IO_AVERAGE_H

#include "io/channel/output.h"
#include "io/write/csv.h"
#include "se3d/wall_map.h"

typedef struct se3di_average_sum {
    se3d_model *model;
    const se3d_field_grid *grid; /* NULL: of the triangles of `wall` */
    se3d_shape wall;
    double *values; /* [cells * width] of one time, */
    double *sums;   /* and of all so far: of fields with momentum and its flux for the means */
    size_t cells;   /* or triangles */
    size_t width;   /* SE3D_FIELD_VALUES or SE3D_WALL_VALUES */
    double time;    /* of the last row */
    uint64_t rows;
} se3di_average_sum;

/* @return NULL: out of memory */
se3di_average_sum *se3di_average_create(se3d_model *model, se3di_iopool *pool,
                                        const se3di_output_entry *entry);
/* Add what is now; once a time. */
se3d_status se3di_average_add(se3di_average_sum *average, double time);
/* What is known so far. */
void se3di_average_pack(se3di_average_sum *average, se3di_coder *coder);
/* The columns of the file. */
size_t se3di_average_count_columns(const se3di_average_sum *average);
const char *se3di_average_get_column(const se3di_average_sum *average, size_t k);
/* Write a row for each cell, x fastest, or for each triangle; none if nothing was added. */
void se3di_average_write(se3di_average_sum *average, se3di_csv *csv);

#endif
