/* SPDX-License-Identifier: BSD-3-Clause */
/* What `se3d study` does beside samples: the best parameters, by methods of NLopt. */
#ifndef SE3D_TOOL_STUDY_OPTIMIZE_H
#define SE3D_TOOL_STUDY_OPTIMIZE_H

#include "options.h"
#include "se3d/study.h"

/* Seek what `optimize` of the study says and write optimize.csv into `folder`, a line for each
 * evaluation; derivatives are taken by `jobs` processes. @return the exit code, after a message if
 * it failed. */
int study_optimize(const options *o, se3d_study *study, size_t jobs, const char *folder);

#endif
