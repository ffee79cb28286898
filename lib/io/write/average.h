/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields of the particles on a grid, or what they do to the patches of a wall, averaged over the
 * rows of a window of time. */
#ifndef SE3D_IO_AVERAGE_H
#define SE3D_IO_AVERAGE_H

#include "io/channel/output.h"
#include "io/write/csv.h"
#include "se3d/wall_map.h"

typedef struct se3di_average_sum {
    se3d_model *model;
    const se3d_field_grid *grid; /* NULL: of the patches of `wall` */
    se3d_shape wall;
    double *values; /* [cells * width] of one time, */
    double *sums;   /* and of all so far: of fields with momentum and its flux for the means */
    size_t cells;   /* or patches */
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
/* Write a row for each cell, x fastest, or for each patch; none if nothing was added. */
void se3di_average_write(se3di_average_sum *average, se3di_csv *csv);
/* The means of a cell or patch, of which there are rows. */
void se3di_average_get_means(const se3di_average_sum *average, size_t cell, double *values);
/* Write them as .vtp (of a wall), .vti (of fields) or .vtkhdf; zeros if nothing was added.
 * @return false: errno says why. */
bool se3di_average_write_vtk(const se3di_average_sum *average, const char *path, int compression);

#endif
