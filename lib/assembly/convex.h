/* SPDX-License-Identifier: BSD-3-Clause */
/* Stiffness without negative curvature: that of every force element, and of the constraints on
 * every body, in its absolute value. Newton steps with it lead downhill far from an equilibrium,
 * and if nothing has negative curvature it is nearly the stiffness itself (Teran, Sifakis,
 * Irving and Fedkiw 2005). In r-omega.
 * docs/theory/equilibrium.md */
#ifndef SE3DI_ASSEMBLY_CONVEX_H
#define SE3DI_ASSEMBLY_CONVEX_H

#include "assembly/tangent.h"

/* K of the bodies: |K|, and of the couplings their absolute value on both bodies instead. */
void se3di_convex_blocks(se3di_tangent *tangent);
/* K [12 12], minus the stiffness of what acts on two bodies, of which those with is_free 0 do not
 * move. */
void se3di_convex_load(const int is_free[2], const double *K, double *convex);

#endif
