/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts of analysis/run.c: how runs end. */
#ifndef SE3DI_ANALYSIS_RUN_END_H
#define SE3DI_ANALYSIS_RUN_END_H

#include "analysis/run.h"

/* Who writes the history: the method in the formulation. */
static inline uint64_t se3di_run_get_history_tag(const se3di_run *run)
{
    return SE3DI_HISTORY_TAGS * run->integration.method->tag + (uint64_t)run->formulation->id;
}

/* A run to t_end has failed: the message says why, and the model comes back to the last accepted
 * state. @return the status */
se3d_status se3di_run_fail(se3di_run *run, se3d_status status, double t_end);

/* The log is told if the tolerance that is asked for is smaller than what the method reaches. */
void se3di_run_tell_reach(se3di_run *run);
/* ... if joint coordinates are asked for and the method does not integrate them. */
void se3di_run_tell_bodies(se3di_run *run);
/* The log is told of the step of a method that controls no error, if none was given. */
void se3di_run_tell_step(se3di_run *run);
/* The log is told that a method follows each contact of many bodies. */
void se3di_run_tell_crowd(se3di_run *run);
/* The log is told that iterations limit the steps of a method. */
void se3di_run_tell_held(se3di_run *run);
/* The log is told which force element vibrates so fast that the steps are short, if one does: the
 * call under way began at `begin` [s], after `steps` of the run. */
void se3di_run_tell_shaken(se3di_run *run, double begin, uint64_t steps);
/* What was found of redundant equations goes to the log. @return OK, INFO_REDUNDANT */
se3d_status se3di_run_inform(se3di_run *run);

#endif
