/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of constraints at the present state of the model, one at a time: what a caller asks
 * of them. Runs evaluate all of them at once (assembly/). */
#ifndef SE3DI_JOINT_EQUATION_H
#define SE3DI_JOINT_EQUATION_H

#include "model/model.h"

/* The term of a joint coordinate (se3d_joint_coordinate), coefficient 1, angles with their turn
 * counter. Returns 0 if the constraint has no such coordinate. */
int se3di_coordinate_term(const se3di_model *model, uint32_t joint, int32_t coordinate,
                          se3di_term *term);
/* {value, rate, acceleration} of a term of coefficient 1 at the present motion; with `count` 2 the
 * third is 0, and no acceleration is read. */
void se3di_term_motion(const se3di_model *model, const se3di_term *term, int count,
                       double motion[3]);

/* {f, f_t, f_tt} of an equation at the present time. */
se3d_status se3di_row_prescribed(const se3di_model *model, const se3di_row *row, double jet[3]);
/* {phi, nu, gamma} of equation r of a constraint. */
se3d_status se3di_equation_eval(const se3di_model *model, const se3di_constraint *constraint,
                                uint32_t r, se3d_formulation formulation, double result[3]);
/* Its Jacobian with respect to one body: 3 + 3 (r-omega) or 3 + 4 (r-p) numbers. */
se3d_status se3di_equation_jacobian(const se3di_model *model, const se3di_constraint *constraint,
                                    uint32_t r, se3d_formulation formulation, uint32_t body,
                                    double out[7]);

/* What it does to its body in `slot`: {force, torque about `point`}, ground frame; NULL: the joint
 * point on body j.
 *
 *     F   = -Phi_r^T lambda                 force on the body, ground frame
 *     n   = -Phi_pi^T lambda                moment about its centre of mass, body frame
 *     T_P = A n + (r - P) x F               torque about the point P, ground frame
 *
 * docs/theory/reactions.md */
void se3di_constraint_reaction(const se3di_model *model, const se3di_constraint *constraint,
                               size_t slot, const double *point, double wrench[6]);

/* The largest |Phi|, |Phi_q qdot - nu| and |Phi_q qddot - gamma| of all equations, in r-omega. */
se3d_status se3di_violation_measure(const se3di_model *model, double violation[3]);

#endif
