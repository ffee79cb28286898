/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef SE3DI_MODES_FOLLOW_H
#define SE3DI_MODES_FOLLOW_H

#include "analysis/modes.h"

/* Eigenvalues that the modes of another model have in this one at its present state, by their
 * two-sided Rayleigh quotients: their error is of second order in what the models differ by, so
 * that derivatives with respect to data are exact. NaN: a mode is no smooth function of the data,
 * as its eigenvalue is 0 or not a single one.
 * @param[out] re  [modes->eigen.count]
 * @param[out] im  [modes->eigen.count]
 * @return OK, STATE (another number of bodies or freedoms), UNSUPPORTED (modes without matrices),
 *         or what linearising fails with. docs/theory/modes.md */
se3d_status se3di_modes_follow(const se3di_modes *modes, se3di_model *model, se3di_error *error,
                               double *re, double *im);

#endif
