/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives for a search whose parameters are shared out among processes: a part of what
 * se3d_study_eval_unknowns does. */
#ifndef SE3D_IO_STUDY_DERIVE_H
#define SE3D_IO_STUDY_DERIVE_H

#include "se3d/study.h"

/* Take the measures at `values`, and the derivatives of all of them with respect to one parameter
 * that is sought: the same as se3d_study_eval_unknowns gives.
 * @return OK, NO_MEMORY, INTERRUPTED */
se3d_status se3di_study_derive_unknown(se3d_study *study, size_t index, const double *values,
                                       double *measures, double *derivatives);

#endif
