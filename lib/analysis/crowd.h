/* SPDX-License-Identifier: BSD-3-Clause */
/* Many bodies that touch: what `auto` looks at, and what methods are not made for. */
#ifndef SE3DI_ANALYSIS_CROWD_H
#define SE3DI_ANALYSIS_CROWD_H

#include "model/model.h"

/* Method convex knows all that the model has, and is as exact for it as for its contacts: no
 * states, no gravity that changes, no elements that are contacts themselves. */
int se3di_crowd_may_touch(const se3di_model *model);
/* There is nothing beside contacts that it would be less exact for: no constraints and elements. */
int se3di_crowd_suits(const se3di_model *model);
/* Steps of h are short beside spins and the oscillations of springs and dampers, no impact gives
 * back nearly all, and no element is the user's own. */
int se3di_crowd_bears(const se3di_model *model, double h);
/* A mesh may touch something of another body that has more than one point of contact with it. */
int se3di_crowd_has_mesh(const se3di_model *model);
/* At least so many free bodies have shapes that may touch. */
int se3di_crowd_has(const se3di_model *model, size_t least);

#endif
