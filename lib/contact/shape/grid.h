/* SPDX-License-Identifier: BSD-3-Clause */
/* The cells of a heightfield, found by their places.                     docs/theory/shapes.md */
#ifndef SE3DI_CONTACT_GRID_H
#define SE3DI_CONTACT_GRID_H

#include "model/model.h"

/* Cells of the grid: rows and columns from begin on, before end. */
typedef struct se3di_grid_cells {
    uint32_t row[2], column[2];
} se3di_grid_cells;

/* The cells that a ball is over or under. */
void se3di_grid_find_cells(const se3di_shape *shape, const double local[3], double radius,
                           se3di_grid_cells *cells);

/* Whether all of a cell is farther above or below a place than the radius. The triangles of cell k
 * (row * (columns - 1) + column) are 2 k and 2 k + 1. */
static inline int se3di_grid_misses(const se3di_shape *s, uint32_t row, uint32_t column, double z,
                                    double radius)
{
    const double *a = s->vertices + 3 * ((size_t)row * s->columns + column);
    const double *b = a + 3 * (size_t)s->columns;
    const double from = z - radius, to = z + radius;
    return (a[2] > to && a[5] > to && b[2] > to && b[5] > to) ||
           (a[2] < from && a[5] < from && b[2] < from && b[5] < from);
}

#endif
