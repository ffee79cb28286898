/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex cells: what is behind several planes, as the loops of its faces. */
#ifndef SE3DI_CONTACT_CELL_H
#define SE3DI_CONTACT_CELL_H

#include "base/alloc.h"

#include <stdint.h>

typedef struct se3di_plane {
    double n[3], d; /* n . x = d; unit, outward */
} se3di_plane;

typedef struct se3di_cell {
    double *corners; /* [3 * corner_count], of one face after the other, counter-clockwise or not */
    uint32_t *ends;  /* [face_count]: of their corners */
    size_t corner_count, corner_capacity, face_count, face_capacity;
} se3di_cell;

void se3di_cell_destroy(const se3d_allocator *allocator, se3di_cell *cell);
/* A cube of half length `half` about `middle`. @return OK, NO_MEMORY */
se3d_status se3di_cell_begin(const se3d_allocator *allocator, const double middle[3], double half,
                             se3di_cell *cell);
/* Keep of `from` what is behind the plane, in `to`; nearer than `slack` is on it.
 * @return OK, NO_MEMORY */
se3d_status se3di_cell_cut(const se3d_allocator *allocator, const se3di_cell *from,
                           const se3di_plane *plane, double slack, se3di_cell *to);

#endif
