/* SPDX-License-Identifier: BSD-3-Clause */
/* Drivers whose value is a function of the time and of signals of positions.
 * docs/theory/signals.md */
#ifndef SE3DI_FORCE_DRIVER_LAW_H
#define SE3DI_FORCE_DRIVER_LAW_H

#include "primitive/user.h"

/* The coordinate of a joint follows a function, by dense index. Its bodies are those of the joint,
 * which are i and j, and those of the signals, each once.
 * @return 1; 0: they are more than SE3DI_NODE_BODIES_MAX */
int se3di_driver_law_draft(const se3di_model *model, uint32_t joint, int32_t coordinate,
                           int32_t function, const char *name, se3di_draft *draft);

/* What drivers that follow functions of signals have in common: the row on the coordinate, and the
 * bodies of a signal. @return 0: they are too many */
void se3di_driver_law_begin(const se3di_model *model, uint32_t joint, int32_t coordinate,
                            int32_t function, const char *name, se3di_draft *draft);
int se3di_driver_law_add_bodies(const se3di_model *model, const se3di_signal *signal,
                                se3di_draft *draft);

/* The prescribed value at the time and positions of the model.
 * @return OK, NOT_FINITE, SINGULAR: the points of a length coincide */
se3d_status se3di_driver_law_value(const se3di_model *model, const se3di_constraint *constraint,
                                   double *value);

#endif
