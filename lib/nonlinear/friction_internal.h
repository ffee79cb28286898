/* SPDX-License-Identifier: BSD-3-Clause */
/* What the parts of the friction system share: units and responses (friction_system.c), forces of
 * given modes (friction_newton.c), the choice of modes (friction_decide.c). */
#ifndef SE3DI_FRICTION_INTERNAL_H
#define SE3DI_FRICTION_INTERNAL_H

#include "force/friction.h"
#include "force/measure.h"
#include "nonlinear/equations.h"

static inline se3di_force *se3di_friction_element(const se3di_equations *equations, uint32_t k)
{
    return &equations->assembly.model->forces[equations->friction.element[k]];
}

/* Of b, c in the equations, which are factored: the unknowns, the solution without them and by a
 * unit of each. */
se3d_status se3di_friction_respond(se3di_equations *equations);
/* The whole solution under n, what the elements know of it, and what is held given from now on. */
void se3di_friction_combine(se3di_equations *equations);

/* The velocities that make what holds stand still. @return whether any had to change */
int se3di_friction_arrest(se3di_equations *equations);

/* The load of the unknown u under n; `slope` (or NULL): to all n. */
double se3di_friction_eval_load(const se3di_equations *equations, uint32_t u, double *slope);
/* A force that has no leverage on its own coordinate cannot hold it. */
int se3di_friction_has_leverage(const se3di_equations *equations, uint32_t u);
/* J x = f, x into f, by elimination with pivots; what cannot be told is zero. */
void se3di_friction_solve_dense(se3di_friction_system *s);
/* How several that hold one freedom share it: friction.share. */
void se3di_friction_weigh(se3di_equations *equations);
/* n of the unknowns, in the modes of the elements. @return whether there is a solution */
int se3di_friction_solve_forces(se3di_equations *equations);

#endif
