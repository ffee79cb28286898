/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows that are redundant but for the digits of their data, as in a planar loop of 3-D joints whose
 * axes are 4e-6 rad off: they would lock the mechanism, or pull at it in directions that are noise.
 * They are found once, when a run starts, and left out of the equations from then on.
 * docs/theory/redundancy.md */
#ifndef SE3DI_RANKS_H
#define SE3DI_RANKS_H

#include "nonlinear/equations.h"

/* Decide which rows of the model are left out, at t, unless that is known. The state stays.
 * @return OK, or NO_MEMORY, CALLBACK, INTERRUPTED with a message; nothing is decided then. */
se3d_status se3di_ranks_decide(se3di_equations *equations, double t);

/* "a.dp1_x (off by 2.1e-07), ..." of the rows left out, at the present state. */
void se3di_ranks_describe(const se3di_model *model, char *text, size_t size);

#endif
