/* SPDX-License-Identifier: BSD-3-Clause */
/* No step goes past a time at which a prescribed rate jumps: it ends just before, where
 * integration->at_kink makes methods come back, and the run goes on behind it. */
#ifndef SE3DI_KINK_STEP_H
#define SE3DI_KINK_STEP_H

#include "integrator/integrator.h"

/* A step from t of at most h, which ends at *end if that is where a kink is, with a look so far
 * `ahead` (at least h): if a kink is not much further than h, two equal steps lead there. At a
 * kink, to rounding: 0, and integration->at_kink. */
double se3di_kink_step(se3di_integration *integration, double t, double h, double ahead,
                       double *end);

#endif
