/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run needs before its first step. */
#ifndef SE3DI_ANALYSIS_RUN_PREPARE_H
#define SE3DI_ANALYSIS_RUN_PREPARE_H

#include "analysis/run.h"

/* Before a call of one step of given length, or of a run. */
void se3di_run_choose_for_call(se3di_run *run, int is_step);
void se3di_run_use_method(se3di_run *run, const se3di_integrator *method);
/* The method of `auto` for motions that are not stiff. */
const se3di_integrator *se3di_run_find_explicit(const se3di_run *run);
/* auto: many bodies are at each other, which convex is for, or have been. */
int se3di_run_is_crowded(const se3di_run *run);
/* The motion is to follow from constraints and drivers alone. */
int se3di_run_is_driven(const se3di_run *run);
/* Build what the model's structure decides. */
se3d_status se3di_run_build(se3di_run *run);

#endif
