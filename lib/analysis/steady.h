/* SPDX-License-Identifier: BSD-3-Clause */
/* Axes in which small motions about the present one have constant coefficients. */
#ifndef SE3DI_STEADY_H
#define SE3DI_STEADY_H

#include "analysis/linearise.h"

/* Linearise at the present state in the axes of the bodies, if the motion is steady in them; else
 * with bodies that spin in a joint in the axes of what carries them; else in axes that do not turn.
 * The state stays. @return OK, STATE if the coefficients are constant in none of these, or what
 * fails */
se3d_status se3di_steady_linearise(se3di_linear *linear, double t);

#endif
