/* SPDX-License-Identifier: BSD-3-Clause */
/* What is told of an analysis that was run. */
#ifndef SE3D_IO_RUN_RECORD_H
#define SE3D_IO_RUN_RECORD_H

#include "io/run/runner.h"

/* A copy that lives as long as the run; "" without memory. */
const char *se3di_run_copy_text(se3di_runner *r, const char *text);
/* What the solver did, for the summary. */
void se3di_run_record(se3di_runner *r, const se3di_analysis_entry *entry, double cpu_time,
                      se3d_run_analysis *done);

#endif
