/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of the public layer share about constraints: joint coordinates as terms, and the
 * last step of every creation. */
#ifndef SE3DI_SYSTEM_COORDINATE_H
#define SE3DI_SYSTEM_COORDINATE_H

#include "system/system_internal.h"

/* The term of a joint coordinate (se3d_joint_coordinate), coefficient 1, angles with their turn
 * counter. Returns 0 if the constraint has no such coordinate. */
int se3di_coordinate_term(const se3di_model *model, uint32_t joint, int32_t coordinate,
                          se3di_term *term);
/* The same; records a message that says what the joint has. `what` names the place. */
se3d_status se3di_check_coordinate(se3d_system *system, const char *what, uint32_t joint,
                                   int32_t coordinate, se3di_term *term);

/* body_i and body_j are not the same body. */
se3d_status se3di_check_distinct(se3d_system *system, const uint32_t bodies[2]);

/* If there is no function of time, `value` is finite. */
se3d_status se3di_check_prescribed(se3d_system *system, double value, int32_t function);

/* {f, f_t, f_tt} of an equation at the present time. */
se3d_status se3di_row_prescribed(const se3di_model *model, const se3di_row *row, double jet[3]);

/* What a constraint does to one body: force and moment about the centre of mass, ground frame. */
void se3di_constraint_wrench(const se3di_model *model, const se3di_constraint *constraint,
                             uint32_t body, double force[3], double torque[3]);

/* Add a validated draft to the model and return its handle. */
se3d_status se3di_constraint_add(se3d_system *system, const se3di_draft *draft,
                                 se3d_constraint *constraint);

#endif
