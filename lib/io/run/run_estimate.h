/* SPDX-License-Identifier: BSD-3-Clause */
/* The error of equal steps, which nothing controls: a copy of the system follows the run in steps
 * twice as long. What the two differ by at the rows that both come to is 2^p - 1 times the error
 * of the run, with the order p of the method.  docs/theory/estimates.md */
#ifndef SE3D_IO_RUN_ESTIMATE_H
#define SE3D_IO_RUN_ESTIMATE_H

#include "io/run/runner.h"

/* Begin to follow the dynamics that r->solver is about to run, if its steps are equal and wanted
 * to be estimated: r->estimate, NULL if nothing follows. @return OK, NO_MEMORY */
se3d_status se3di_estimate_begin(se3di_runner *r, const se3di_analysis_entry *entry);
/* The run has come to `time`, where it `ends` or not. @return OK, NO_MEMORY */
se3d_status se3di_estimate_meet(se3di_estimate *estimate, double time, bool ends);
/* What was found, into the record, with a warning to the log if it is much; nothing follows from
 * now on. */
void se3di_estimate_end(se3di_runner *r, se3d_run_analysis *done);
/* CPU time that it has taken so far [s]; fine with NULL. */
double se3di_estimate_get_time(const se3di_estimate *estimate);

#endif
