/* SPDX-License-Identifier: BSD-3-Clause */
/* Stiff forces along lines that turn within a step of radau. One matrix serves its three stages,
 * and knows the line g^ of one of them: a force n = k x along the line g_i of another stage makes,
 * of what is missing of x, a push k x (g_i - g^) across the line, which that matrix takes for a
 * motion. So an iteration multiplies errors by h^2 k (h w)^2 / m, w the rate at which the line
 * turns, and diverges if forces are stiff.
 *
 * Therefore n^ takes part as a multiplier does, with the row x(q) - n^/k = 0: of Newton's method
 * for q and n^, the latter eliminated by the row, remains
 *
 *     -n^ g_i - (n - n^) g^    in place of    -n g_i
 *
 * in the residual: what a force is out of balance by acts along the line that the matrix knows. The
 * impulses along g^ that a correction has found, L_i = h (W (n - n^))_i + c k g^ y_i + c d g^ u_i,
 * make the change of n^ as those of constraints make that of multipliers. In the limit n^ = n.
 * docs/theory/radau.md */
#ifndef SE3DI_RADAU_LINES_H
#define SE3DI_RADAU_LINES_H

#include "integrator/radau.h"

size_t se3di_radau_lines_count(const se3di_model *model); /* doubles of m->lines */

/* Before the first iteration, from the predicted stages: which forces are stiff, their lines at the
 * second stage, and n^ as at the start of the step. */
se3d_status se3di_radau_lines_begin(se3di_radau *m);
/* The state of a stage is set, and b holds the generalised forces of its elements: those of stiff
 * ones as above. */
se3d_status se3di_radau_lines_apply(se3di_radau *m, int stage, double t, double *b);
/* What n exceeds n^ by at the second stage, for the Newton matrix; NULL: no force is stiff. */
const double *se3di_radau_lines_excess(const se3di_radau *m);
/* n^ follows the transformed corrections in m->u and m->uq. */
void se3di_radau_lines_correct(se3di_radau *m, double W[SE3DI_RADAU_STAGES][SE3DI_RADAU_STAGES]);

#endif
