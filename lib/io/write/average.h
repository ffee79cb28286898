/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields of the particles on a grid, averaged over the rows of a window of time. */
#ifndef SE3D_IO_AVERAGE_H
#define SE3D_IO_AVERAGE_H

#include "io/channel/output.h"
#include "io/write/csv.h"

enum { SE3DI_AVERAGE_COLUMNS = 21 };

typedef struct se3di_average_sum {
    se3d_model *model;
    const se3d_field_grid *grid;
    double *values; /* [cells * SE3D_FIELD_VALUES] of one time, */
    double *sums;   /* and of all so far: with momentum and its flux in place of the means */
    size_t cells;
    double time; /* of the last row */
    uint64_t rows;
} se3di_average_sum;

/* @return NULL: out of memory */
se3di_average_sum *se3di_average_create(se3d_model *model, se3di_iopool *pool,
                                        const se3di_output_entry *entry);
/* Add the fields as they are now; once a time. */
se3d_status se3di_average_add(se3di_average_sum *average, double time);
/* What is known so far. */
void se3di_average_pack(se3di_average_sum *average, se3di_coder *coder);
/* The name of a column of the file. */
const char *se3di_average_get_column(size_t k);
/* Write a row for each cell, x fastest; none if nothing was added. */
void se3di_average_write(se3di_average_sum *average, se3di_csv *csv);

#endif
