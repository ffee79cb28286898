/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives by models beside the one that is run, whose states follow that of the run at each of
 * its rows (se3d_solver_follow): one run, whatever the number of parameters and steps. */
#ifndef SE3D_IO_STUDY_FOLLOW_H
#define SE3D_IO_STUDY_FOLLOW_H

#include "io/study/study.h"

/* Take the measures at a point, and their derivatives there with respect to several parameters, as
 * se3di_study_differentiate does.
 * @param[in] points     [count], of the same values
 * @param[out] measures  those of a run at the point, if `has_run`
 * @param[out] done      [count] false: there are no such derivatives with respect to this one
 * @return as se3di_study_run: of the run at the point if `has_run`, else OK, NO_MEMORY or
 *         INTERRUPTED */
se3d_status se3di_study_follow(se3d_study *study, const se3di_study_point *points, size_t count,
                               double *measures, bool *done, bool *has_run,
                               se3d_model_error *error);

#endif
