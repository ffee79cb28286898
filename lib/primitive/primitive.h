/* SPDX-License-Identifier: BSD-3-Clause */
/* Constraint primitives: scalar functions of the poses of two bodies, each with the same functions.
 *
 * A term is one primitive with its data. A constraint equation (model/) is
 *
 *     Phi = sum_k coefficient_k * value(term_k) - f(t)
 *
 * so that everything here is free of time: nu and the time part of gamma are added by the equation.
 *
 * Jacobians, per body:
 *
 *     r-omega: 6 numbers, [d/dr (ground frame), d/dtheta (virtual rotation in the body frame)]
 *     r-p:     7 numbers, [d/dr, d/dp], the B-matrix form (p counted as four independent numbers)
 *
 * gamma: the right-hand side of Phi_q qddot = gamma for f = 0, minus the velocity terms; r-omega
 * with qddot = (a, wdot in the body frame), r-p with (a, pddot).
 *
 * curvature: the derivative of Phi_q^T lambda with respect to q, *added* to H (12 x 12 or 14 x 14,
 * row-major, order body i, body j). In r-omega it is the derivative of the body-frame torque with
 * respect to the body-frame virtual rotations A -> A exp(tilde(dtheta)), in general not symmetric.
 */
#ifndef SE3DI_PRIMITIVE_H
#define SE3DI_PRIMITIVE_H

#include "model/term.h"

typedef struct se3di_primitive {
    const char *name; /* "dp1" */
    double (*value)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j);
    void (*jacobian_romega)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                            double phi_i[6], double phi_j[6]);
    void (*jacobian_rp)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                        double phi_i[7], double phi_j[7]);
    double (*gamma_romega)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j);
    double (*gamma_rp)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j);
    void (*curvature_romega)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                             double lambda, double H[144]);
    void (*curvature_rp)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                         double lambda, double H[196]);
} se3di_primitive;

/* The table, indexed by se3di_primitive_type. Values and Jacobians ignore `coefficient`. */
extern const se3di_primitive se3di_primitives[SE3DI_PRIMITIVE_COUNT];

#endif
