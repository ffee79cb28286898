/* SPDX-License-Identifier: BSD-3-Clause */
/* The exact Newton matrix of an implicit step, with its linear solver: for a step whose unknown
 * vdot moves positions by x(vdot) and velocities by v(vdot),
 *
 *     H = (M + (dv/dvdot) D) T^-1 + (dx/dvdot) K
 *     [H C^T; C 0] [z; l] = [b; c],    dvdot = T^-1 z
 *
 * with M, D, K of assembly/tangent.h and T the tangent of the exponential map at the rotation of
 * the step (r-omega; I in r-p): a change dx of the step turns the body by T dx. If constraints
 * enter by velocities, Phi_q qdot = nu, their rows are instead
 *
 *     C T^-1 + (dx/dvdot / dv/dvdot) d(Phi_q qdot)/dq
 *
 * docs/theory/tangent.md */
#ifndef SE3DI_NEWTON_H
#define SE3DI_NEWTON_H

#include "assembly/tangent.h"
#include "linsol/kkt.h"
#include "nonlinear/equations.h"

/* What a test asks for: every iteration of an implicit step factors anew, so that convergence is
 * quadratic if the matrix is exact; the sizes of the corrections are kept. */
typedef struct se3di_newton_trace {
    double size[16];
    int32_t count;
    int32_t reserved;
} se3di_newton_trace;

typedef struct se3di_newton {
    se3di_equations *equations;
    se3di_tangent tangent;
    se3di_kkt *kkt;
    double *Tinv;    /* [free bodies * 9], r-omega */
    double *rows;    /* as C: of constraints that enter by velocities */
    double *columns; /* as C: what multipliers do to the bodies, by loading friction too */
    double *memory;  /* [forces * SE3DI_FORCE_STATES]: what force elements remembered */
    size_t force_count;
    int32_t has_rows;          /* the last factorisation took `rows` */
    int32_t has_columns;       /* and `columns` */
    se3di_newton_trace *trace; /* NULL: not wanted */
} se3di_newton;

typedef struct se3di_newton_weights {
    double velocity; /* dv/dvdot */
    double position; /* dx/dvdot */
} se3di_newton_weights;

/* On failure nothing is held. */
se3d_status se3di_newton_init(se3di_newton *newton, se3di_equations *equations);
void se3di_newton_destroy(se3di_newton *newton);

/* Evaluate and factor at the state of the model, whose constraint Jacobian is in the assembly.
 * `step` [unknowns]: displacement of the step. */
se3d_status se3di_newton_factor(se3di_newton *newton, double t, const double *vdot,
                                const double *lambda, const double *step,
                                const se3di_newton_weights *weights);
/* The same for constraints of velocities. Unknowns (v, w) only. */
se3d_status se3di_newton_factor_velocities(se3di_newton *newton, double t, const double *vdot,
                                           const double *lambda, const double *step,
                                           const se3di_newton_weights *weights);
/* Those, if a body has turned on the way of the step, at the
 * weight c = dv/dvdot, by (I - c/2 Omega(w))^-1; dx/dvdot = c^2. Unknowns (v, w) only. */
se3d_status se3di_newton_factor_rates(se3di_newton *newton, double t, const double *vdot,
                                      const double *lambda, double c);
/* Solve for equations->b, ->c into equations->x (dvdot) and ->l. */
se3d_status se3di_newton_solve(se3di_newton *newton);
/* The same, into ->x a displacement: T dvdot. */
se3d_status se3di_newton_solve_displacement(se3di_newton *newton);
/* out += H x, in displacements */
void se3di_newton_add_matrix(const se3di_newton *newton, const double *x, double *out);
/* x <- T^-1 x */
void se3di_newton_turn(const se3di_newton *newton, double *x);
/* out += scale (rows y - C T^-1 y), with the rows of se3di_newton_factor_velocities: what a
 * displacement y does to Phi_q qdot, times (dx/dvdot) / (dv/dvdot). */
void se3di_newton_add_gradient(const se3di_newton *newton, double scale, const double *y,
                               double *out);

/* Note the size of a correction. @return whether there is a trace */
int se3di_newton_note(const se3di_newton *newton, double size);

#endif
