/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives for a search whose parameters are shared out among processes: a part of what
 * se3d_study_eval_unknowns does. */
#ifndef SE3D_IO_STUDY_DERIVE_H
#define SE3D_IO_STUDY_DERIVE_H

#include "se3d/study.h"

/* Some of the parameters that are sought, one after another. */
typedef struct se3di_study_part {
    size_t first, count;
} se3di_study_part;

/* Take the measures at `values`, and the derivatives of all of them with respect to these
 * parameters, by one run if models can follow it: the same bits as se3d_study_eval_unknowns gives,
 * however the parameters are shared out.
 * @param[out] derivatives  [part.count][measures], NaN: there is none, or the run has failed
 * @return as se3d_study_eval_unknowns */
se3d_status se3di_study_eval_part(se3d_study *study, se3di_study_part part, const double *values,
                                  double *measures, double *derivatives, se3d_model_error *error);

#endif
