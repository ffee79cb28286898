/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction in the step of rattle and verlet: rigid stick and slip, decided for all elements
 * together, twice a step. With W_jk the acceleration of the coordinate j by a unit force on the
 * coordinate k, through bodies and constraints,
 *
 *     velocities      u_1 = u - h/2 W n       |n_k| <= F_k; inside u_1 = 0, at +-F_k u_1 has its
 *     accelerations   a   = a_free - W n      sign; the same for those that stick, n = +-F_c else
 *
 * by projected Gauss-Seidel. The limits follow the load, which is iterated by the caller.
 * docs/theory/friction.md */
#ifndef SE3DI_LIE_FRICTION_H
#define SE3DI_LIE_FRICTION_H

#include "nonlinear/equations.h"

typedef struct se3di_lie_friction {
    se3di_equations *equations;
    uint32_t count; /* friction elements */
    uint32_t reserved;
    double *n;     /* [count]: force against the coordinate */
    double *mode;  /* [count]: -1, 0 (sticks), +1 */
    double *free;  /* [count]: without friction */
    double *limit; /* [count] */
    double *load;  /* [count]: of the last velocities */
    double *Q;     /* [count * 16]: generalised forces of a unit on bodies i and j */
    double *W;     /* [count * count] */
    double *history;
} se3di_lie_friction;

/* Of the history: n of each element, exactly (the elements' own memory of it is an anchor some
 * nanometres away, which rounding makes a creep). */
size_t se3di_lie_friction_history_count(const se3di_model *model);
void se3di_lie_friction_start(const se3di_model *model, double *history);

size_t se3di_lie_friction_work_count(const se3di_model *model);
/* On `work` and the history. */
se3di_lie_friction se3di_lie_friction_begin(se3di_equations *equations, double *work,
                                            double *history);
/* At the start of a step: n and modes as they are; the elements are silenced, so that forces are
 * evaluated without them. */
void se3di_lie_friction_take(se3di_lie_friction *f);
/* Their wrenches into assembly->wrench. */
void se3di_lie_friction_add_wrenches(const se3di_lie_friction *f);
/* At new positions with their equations factored: W. */
se3d_status se3di_lie_friction_prepare(se3di_lie_friction *f);
/* n from velocities without friction. */
void se3di_lie_friction_solve_velocities(se3di_lie_friction *f, double h);
/* Accelerations and multipliers of the model from equations->b, c, which are without friction; n
 * and loads with them. @return OK, NO_CONVERGENCE (it jams), or what the solution returns */
se3d_status se3di_lie_friction_solve_accelerations(se3di_lie_friction *f);
/* How much loads differ from those that the velocities were found with, relative to the largest. */
double se3di_lie_friction_change(const se3di_lie_friction *f);
/* The elements remember what was found. */
void se3di_lie_friction_accept(const se3di_lie_friction *f);

#endif
