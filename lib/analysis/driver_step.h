/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of kinematics that smooth drivers allow: within a step a prescribed value stays near the
 * parabola that positions are predicted by. If it does not, as in the middle of tanh(1e4 (t -
 * 1)), the end of the step is far from the prediction and the positions need not be found. */
#ifndef SE3DI_ANALYSIS_DRIVER_STEP_H
#define SE3DI_ANALYSIS_DRIVER_STEP_H

#include "nonlinear/equations.h"

/* `h`, or a part of it [s] at whose end no prescribed value is far from its parabola; the part is
 * not shorter than times are resolved. From the model's time. */
double se3di_driver_step(const se3di_equations *equations, double h);

#endif
