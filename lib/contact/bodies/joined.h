/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints and contact. */
#ifndef SE3DI_CONTACT_JOINED_H
#define SE3DI_CONTACT_JOINED_H

#include "model/model.h"

/* Whether this constraint does. */
int se3di_joint_keeps_apart(const se3di_model *model, const se3di_constraint *c,
                            const se3di_shape *a, const se3di_shape *b);
/* Whether a constraint keeps two shapes from touching: one between their bodies; with a fixed body
 * only if the shapes overlap at the joint, or it leaves no freedom. */
int se3di_shapes_are_joined(const se3di_model *model, uint32_t a, uint32_t b);
/* Of many pairs the same, sooner: once the constraints have been gathered by their bodies, as long
 * as there are no others. @return OK, NO_MEMORY */
se3d_status se3di_joints_gather(se3di_model *model);
int se3di_joints_keep_apart(const se3di_model *model, uint32_t a, uint32_t b);

#endif
