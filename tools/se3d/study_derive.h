/* SPDX-License-Identifier: BSD-3-Clause */
/* What `se3d study` does beside samples: derivatives of measures. */
#ifndef SE3D_TOOL_STUDY_DERIVE_H
#define SE3D_TOOL_STUDY_DERIVE_H

#include "options.h"
#include "se3d/study.h"

/* Write sensitivities.csv into `folder`, a line for each measure and parameter; `jobs` processes
 * share the parameters out. @return the exit code, after a message if it failed. */
int study_derive(const options *o, se3d_study *study, size_t jobs, const char *folder);

#endif
