/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints that broke, and contact. */
#ifndef SE3DI_CONTACT_PARTED_H
#define SE3DI_CONTACT_PARTED_H

#include "model/model.h"

/* Mark the broken joints whose bodies do not overlap at the present state: from now on these may
 * touch. At a pin the two overlap when it breaks, and are not thrown apart by that. */
void se3di_joints_part(se3di_model *model);

#endif
