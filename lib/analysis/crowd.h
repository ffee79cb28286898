/* SPDX-License-Identifier: BSD-3-Clause */
/* Many bodies that touch: what `auto` looks at, and what methods are not made for. */
#ifndef SE3DI_ANALYSIS_CROWD_H
#define SE3DI_ANALYSIS_CROWD_H

#include "model/model.h"

/* Method convex knows the contacts of the model, and there is nothing else that it would be less
 * exact for: constraints, force elements, states, gravity that changes. */
int se3di_crowd_suits(const se3di_model *model);
/* So many free bodies have shapes that may touch that following each contact takes long. */
int se3di_crowd_is_large(const se3di_model *model);

#endif
