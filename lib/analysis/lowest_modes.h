/* SPDX-License-Identifier: BSD-3-Clause */
/* The lowest modes of a large model at rest without damping, by blocks of bodies: nothing is dense
 * but vectors, one for each mode and some more.
 *
 *     K x + Phi_q^T l = mu M x,  Phi_q x = 0        s^2 = -mu
 *
 * K is the symmetric part of the tangent. Lanczos' method finds the largest theta = 1 / (mu -
 * sigma) of the operator that takes x to the solution y of
 *
 *     [K - sigma M  Phi_q^T] [y]   [M x]
 *     [Phi_q        0      ] [l] = [0  ]
 *
 * which the KKT solver factors once for a shift sigma < 0. The solver's count of negative freedoms
 * on both sides of what was found says whether all are there.  docs/theory/modes.md */
#ifndef SE3DI_LOWEST_MODES_H
#define SE3DI_LOWEST_MODES_H

#include "analysis/eigen_modes.h"
#include "nonlinear/equations.h"

/* Find the `count` lowest modes of a system at the present state, whose accelerations are solved:
 * the shapes y are vectors over the unknowns (displacement in the ground frame, rotation in the
 * body's). *found is 0 if this is no case for it: the model is small for so many modes, moves, has
 * damping, unsymmetric stiffness, or what was found cannot be proved to be all. On failure or if
 * nothing is found nothing is held. @return OK, NO_MEMORY, NOT_FINITE, SINGULAR, CALLBACK */
se3d_status se3di_lowest_modes_find(se3di_equations *equations, double t, size_t count,
                                    se3di_eigen *eigen, int32_t *freedoms, int32_t *found);

#endif
