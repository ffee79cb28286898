/* SPDX-License-Identifier: BSD-3-Clause */
#include "contact/shape/grid.h"

#include <math.h>

/* Along one side: from the place of the first vertex, in steps. */
static void find_range(double from, double to, double spacing, uint32_t lines, uint32_t range[2])
{
    const double middle = 0.5 * (double)(lines - 1), last = (double)(lines - 1);
    const double low = floor(from / spacing + middle), high = floor(to / spacing + middle) + 1.0;
    range[0] = (uint32_t)fmax(0.0, fmin(low, last));
    range[1] = (uint32_t)fmax(0.0, fmin(high, last));
}

void se3di_grid_find_cells(const se3di_shape *s, const double local[3], double radius,
                           se3di_grid_cells *cells)
{
    /* by a little more: places of vertices are rounded */
    const double reach = radius + 1e-9 * (s->spacing[0] + s->spacing[1]);
    find_range(local[0] - reach, local[0] + reach, s->spacing[0], s->columns, cells->column);
    find_range(local[1] - reach, local[1] + reach, s->spacing[1], s->rows, cells->row);
}
