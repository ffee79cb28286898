/* SPDX-License-Identifier: BSD-3-Clause */
/* User-defined constraints: equations without terms, whose values a callback computes, or the
 * class of a driver whose value is a function of signals.
 *
 *     Phi(q, t),  Phi_q (r-omega),  nu = -Phi_t,
 *     gamma = -(Phi_q qdot)_q qdot - 2 Phi_qt qdot - Phi_tt
 *
 * The callback knows r-omega only. With Phi_p = 2 Phi_pi G(p) and
 * pddot = 1/2 G^T wdot - 1/4 (w.w) p it follows that Phi_p pddot = Phi_pi wdot, so that gamma is
 * the same number in r-p.
 * docs/theory/user-constraints.md */
#ifndef SE3DI_USER_H
#define SE3DI_USER_H

#include "model/model.h"

/* What is wanted of a callback. */
enum { SE3DI_USER_PHI = 1, SE3DI_USER_JACOBIAN = 2, SE3DI_USER_NU = 4, SE3DI_USER_GAMMA = 8 };

typedef struct se3di_user_values {
    double phi[SE3D_USER_EQUATIONS_MAX];
    double nu[SE3D_USER_EQUATIONS_MAX];
    double gamma[SE3D_USER_EQUATIONS_MAX];
    double jacobian[SE3D_USER_EQUATIONS_MAX * SE3D_USER_BODIES_MAX * 6]; /* as the callback's */
} se3di_user_values;

/* How one equation that is a function of signals is computed, see se3di_user_eval and
 * se3di_user_curvature; signals are of the layers below. All that they fill is zero before, and
 * tested for finite numbers after: H, and as `row` [n] the Jacobian. */
typedef struct se3di_user_class {
    se3d_status (*eval)(const se3di_model *model, const se3di_constraint *constraint, double t,
                        int wanted, se3di_user_values *values);
    se3d_status (*curvature)(const se3di_model *model, const se3di_constraint *constraint, double t,
                             double lambda, double *H, double *row);
} se3di_user_class;

/* Whether its equations are not made of terms. */
static inline int se3di_is_user(const se3di_constraint *constraint)
{
    return constraint->callback != NULL || constraint->law_class != NULL;
}

/* Bodies that the callback sees; the first of them is bodies[user_first]. */
static inline uint32_t se3di_user_body_count(const se3di_constraint *constraint)
{
    return constraint->body_count - constraint->user_first;
}

/* Row of the callback's Jacobian: equation r, body of the callback's k; [6]. */
static inline const double *se3di_user_row(const se3di_constraint *constraint,
                                           const se3di_user_values *values, uint32_t r, uint32_t k)
{
    return values->jacobian + 6 * (size_t)(r * se3di_user_body_count(constraint) + k);
}

/* At the present state. */
se3d_status se3di_user_eval(const se3di_model *model, const se3di_constraint *constraint, double t,
                            int wanted, se3di_user_values *values);

/* The derivative of Phi_pi^T lambda and Phi_r^T lambda to (dr, dtheta) of the bodies, by central
 * differences of the Jacobian if it is a callback's: H [n * n], g [n] = Phi_q^T lambda,
 * n = 6 * bodies. */
se3d_status se3di_user_curvature(const se3di_model *model, const se3di_constraint *constraint,
                                 double t, const double *lambda, double *H, double *g);

#endif
