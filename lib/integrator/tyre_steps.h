/* SPDX-License-Identifier: BSD-3-Clause */
/* The places within a step at which tyres leave their roads or meet them: their forces jump or have
 * a kink there. A step ends just before, and a short one leads across. docs/theory/tyre.md */
#ifndef SE3DI_TYRE_STEPS_H
#define SE3DI_TYRE_STEPS_H

#include "model/model.h"

/* Numbers of a tyre at an end of a step. */
#define SE3DI_TYRE_NOTES 4

int se3di_tyres_are_there(const se3di_model *model);
/* At the present state: notes [elements * SE3DI_TYRE_NOTES]. @return as se3di_force_eval */
se3d_status se3di_tyres_note(const se3di_model *model, double t, double *notes);
/* The part of a step of h, with the notes of its ends, after which a shorter one ends; 0: each tyre
 * is as it was. */
double se3di_tyres_find_part(const se3di_model *model, double h, const double *begin,
                             const double *end);
/* Whether a step of h, that part of the one that was too long, was to lead across a change and has
 * not: the long one has told nothing of where tyres change. */
int se3di_tyres_miss(const se3di_model *model, double part, double h, const double *begin,
                     const double *end);

#endif
