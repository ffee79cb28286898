/* SPDX-License-Identifier: BSD-3-Clause */
/* Broad phase: pairs of shapes near enough for a closer look. */
#ifndef SE3DI_CONTACT_BROAD_H
#define SE3DI_CONTACT_BROAD_H

#include "model/model.h"

/* Visit the pairs i < j whose bounds overlap, in ascending order. */
typedef se3d_status (*se3di_pair_visitor)(void *ctx, uint32_t i, uint32_t j);
se3d_status se3di_broad_visit(const se3di_model *model, se3di_pair_visitor visitor, void *ctx);

/* How far apart two shapes are at least, by their bounds; negative if these overlap. */
double se3di_shapes_gap_bound(const se3di_model *model, uint32_t i, uint32_t j);

/* How far apart they are, 0 if they touch, and the direction from i to j of that. */
double se3di_shapes_gap(const se3di_model *model, uint32_t i, uint32_t j, double normal[3]);

/* Whether they are farther apart than that, if one is a mesh and it is seen at once. */
int se3di_shapes_are_beyond(const se3di_model *model, uint32_t i, uint32_t j, double distance);

/* Renew the list of pairs if the shapes have moved too far since it was made. On failure it is
 * void, and visits look at all pairs. @return OK, NO_MEMORY */
se3d_status se3di_broad_update(se3di_model *model);

#endif
