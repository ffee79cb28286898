/* SPDX-License-Identifier: BSD-3-Clause */
/* The step of a search for an equilibrium: with the unbalanced forces rho on the constraints,
 *
 *     [K + s W + F + P   C^T] [dq     ]   [rho]
 *     [C                 0  ] [dlambda] = [0  ]        K = d(Phi_q^T lambda - Q)/dq
 *
 * sparse, in the pattern of bodies, joints and couplings. W weighs a body by its mass (and mass
 * times radius squared for turns), s is the damping; F is 1e-9 of a body's own stiffness, so that
 * freedoms that nothing holds do not make the matrix singular. P = C^T diag(p) C, as stiff as the
 * bodies, does nothing along steps on the constraints; with it bodies that only joints hold have
 * blocks that can be factored. The symmetric part is factored too: by Sylvester's law of inertia
 * its pivots tell how many freedoms have negative curvature. docs/theory/equilibrium.md
 */
#ifndef SE3DI_STATIC_NEWTON_H
#define SE3DI_STATIC_NEWTON_H

#include "assembly/tangent.h"
#include "linsol/kkt.h"
#include "nonlinear/equations.h"

/* What a body's translations are weighed by, and with radius^2 its turns. */
typedef struct se3di_static_weight {
    double mass;
    double stiffness; /* of K, and of its forces over the radius */
    double radius2;
} se3di_static_weight;

typedef struct se3di_static_newton {
    se3di_equations *equations;
    se3di_tangent tangent; /* K; D, M: bodies' blocks of the symmetric part, and of all of it */
    se3di_kkt *symmetric, *full;
    size_t pair_count;
    size_t pair_capacity;
    int32_t *pairs;        /* [2 * pairs] i < j: couplings of K, and bodies of a joint */
    int32_t *coupling_at;  /* [couplings] their pairs */
    double *penalty;       /* P: bodies [free bodies * 36], */
    double *penalty_upper; /* pairs [pairs * 36] */
    double *upper, *full_upper, *full_lower; /* [pairs * 36] what is factored */
    double *unit;                            /* [free bodies * 36] */
    double *zero;                            /* [unknowns] accelerations */
    double *reaction;                        /* [rows] */
    se3di_static_weight *weights;            /* [free bodies] */
    double rate2;                            /* the largest stiffness / mass [1/s^2] */
    double floor;                            /* added to blocks, of a body's own stiffness */
    double force;                            /* the largest stiffness times radius [N] */
} se3di_static_newton;

/* For equations in r-omega. On failure nothing is held. @return OK, NO_MEMORY */
se3d_status se3di_static_newton_init(se3di_static_newton *newton, se3di_equations *equations);
void se3di_static_newton_destroy(se3di_static_newton *newton);

/* The forces that the constraints do not balance [unknowns] (of least 2-norm), and the multipliers
 * [rows], at the present state, whose applied forces are `load`. Exact if rows are dependent or
 * nearly so only if `careful`.
 * @return OK, INFO_REDUNDANT, NO_MEMORY, NOT_FINITE, SINGULAR */
se3d_status se3di_static_newton_balance(se3di_static_newton *newton, const double *load,
                                        double *rho, double *lambda, int careful);
/* K and the weights, at the present state; `is_convex`: of K what has no negative curvature
 * (assembly/convex.h). */
se3d_status se3di_static_newton_eval(se3di_static_newton *newton, double t, const double *load,
                                     const double *lambda, int is_convex);
/* Factor the symmetric part with damping s >= 0; *negative: freedoms of negative curvature.
 * @return OK, or SINGULAR, NOT_FINITE if another s may do */
se3d_status se3di_static_newton_factor(se3di_static_newton *newton, double s, int32_t *negative);
/* Whether every freedom has positive curvature, beyond rounding. What was factored is lost. */
int se3di_static_newton_is_strict(se3di_static_newton *newton);
/* dq for rho, and c of the constraints (NULL: 0), with the damping last factored by; dlambda is
 * `reaction`, with what P makes of c. */
se3d_status se3di_static_newton_solve(se3di_static_newton *newton, const double *rho,
                                      const double *c, double *dq);
/* dq . (s W + F) dq */
double se3di_static_newton_measure(const se3di_static_newton *newton, double s, const double *dq);

#endif
