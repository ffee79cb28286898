/* SPDX-License-Identifier: BSD-3-Clause */
/* Surfaces of triangles, where others touched them: a step looks at the same places several times
 * (for forces, for their work, for what is remembered), and what does not move stays as it is. */
#ifndef SE3DI_CONTACT_MET_H
#define SE3DI_CONTACT_MET_H

#include "contact/narrow/narrow.h"
#include "model/model.h"

/* Room for what will be kept, if a shape of the model is a surface. @return OK, NO_MEMORY */
se3d_status se3di_met_reserve(se3di_model *model);
/* Whether there is room for this pair, and it has a surface. */
int se3di_met_is_kept(const se3di_model *model, const uint32_t pair[2]);
/* Copy what is known of two shapes at exactly these places. @return 0: nothing is */
int se3di_met_find(const se3di_model *model, const uint32_t pair[2], const se3di_shape_pose at[2],
                   se3di_manifold *manifold);
/* Keep it, if one of the two is a surface and there is room. */
void se3di_met_keep(se3di_model *model, const uint32_t pair[2], const se3di_shape_pose at[2],
                    const se3di_manifold *manifold);

#endif
