/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the public layer share about constraints: joint coordinates as terms, and the
 * last step of every creation. */
#ifndef SE3DI_SYSTEM_COORDINATE_H
#define SE3DI_SYSTEM_COORDINATE_H

#include "system/system_internal.h"

/* The term of a joint coordinate; records a message that says what the joint has. `what` names the
 * place. */
se3d_status se3di_check_coordinate(se3d_system *system, const char *what, uint32_t joint,
                                   int32_t coordinate, se3di_term *term);

/* body_i and body_j are not the same body. */
se3d_status se3di_check_distinct(se3d_system *system, const uint32_t bodies[2]);

/* If there is no function of time, `value` is finite. */
se3d_status se3di_check_prescribed(se3d_system *system, double value, int32_t function);

/* The joint coordinates of a system outlive it, empty. */
void se3di_coordinates_orphan(se3d_system *system);

/* Add a validated draft to the model and return its handle. */
se3d_status se3di_constraint_add(se3d_system *system, const se3di_draft *draft,
                                 se3d_constraint *constraint);

#endif
