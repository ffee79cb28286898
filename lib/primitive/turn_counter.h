/* SPDX-License-Identifier: BSD-3-Clause */
/* Values of terms at the state of a model; joint angles that count turns. */
#ifndef SE3DI_PRIMITIVE_TURN_COUNTER_H
#define SE3DI_PRIMITIVE_TURN_COUNTER_H

#include "model/model.h"

/* Value of a term with its coefficient; angles are unwrapped by their turn counter. */
double se3di_term_value(const se3di_model *model, const se3di_term *term);
/* Phi of an equation whose function of time is f. */
double se3di_row_violation(const se3di_model *model, const se3di_row *row, double f);
/* Joint angle of a turn counter at the present frames, nearest to its last accepted one. */
double se3di_angle_value(const se3di_model *model, uint32_t angle);
/* A state was accepted: take its joint angles, and note what rows that are left out are off by. */
void se3di_angles_accept(se3di_model *model);

#endif
