/* SPDX-License-Identifier: BSD-3-Clause */
/* How far a method may step where a stop is met, or is about to be. docs/theory/stop.md */
#ifndef SE3DI_PACE_STOP_H
#define SE3DI_PACE_STOP_H

#include "contact/bodies/pace.h"

/* The longest step from the last accepted state, at most h, that no impact on a stop asks to be
 * shorter. */
double se3di_stops_pace(const se3di_model *model, se3di_pace_kind kind, double h);
/* Whether a step of h that was asked for follows the impacts on stops.
 * @return OK, STEP_SIZE (the message names the stop) */
se3d_status se3di_stops_check_step(const se3di_model *model, se3di_pace_kind kind, double h,
                                   se3di_error *error);

#endif
