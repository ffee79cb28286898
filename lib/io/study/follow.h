/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives by models beside the one that is run, whose states follow that of the run at each of
 * its rows (se3d_solver_follow): one run, whatever the number of steps. */
#ifndef SE3D_IO_STUDY_FOLLOW_H
#define SE3D_IO_STUDY_FOLLOW_H

#include "io/study/study.h"

/* Take the measures at the point, and their derivatives there, as se3di_study_differentiate does.
 * @param[out] done  false: the study has no such derivatives, only `measures` may be filled
 * @return as se3di_study_run: of the run at the point; but for NO_MEMORY and INTERRUPTED those of
 *         failures only if `done` */
se3d_status se3di_study_follow(se3d_study *study, const se3di_study_point *point, double *measures,
                               double *derivatives, double *errors, bool *done,
                               se3d_model_error *error);

#endif
