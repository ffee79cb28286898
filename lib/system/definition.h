/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files share that give definitions back. Readers: they record no message. */
#ifndef SE3DI_SYSTEM_DEFINITION_H
#define SE3DI_SYSTEM_DEFINITION_H

#include "system/system_internal.h"

/* Public handles of dense indices; null for those below 0. */
se3d_body se3di_body_handle(const se3di_model *model, uint32_t body);
se3d_constraint se3di_constraint_handle(const se3di_model *model, int32_t constraint);
se3d_force se3di_force_handle(const se3di_model *model, int32_t force);
se3d_function se3di_function_handle(const se3di_model *model, int32_t function);
se3d_material se3di_material_handle(const se3di_model *model, int32_t material);
se3d_road se3di_road_handle(const se3di_model *model, int32_t road);
se3d_wheel se3di_wheel_handle(const se3di_model *model, int32_t wheel);

/* The type is that of a joint between two bodies. */
int se3di_is_joint_type(const char *type);
/* The angle of a definition with a second reference direction: at creation the joint has this one
 * again, turns included. */
double se3di_angle_origin(const se3di_model *model, uint32_t angle);

#endif
