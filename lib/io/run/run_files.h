/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of results while a model runs. */
#ifndef SE3D_IO_RUN_FILES_H
#define SE3D_IO_RUN_FILES_H

#include "io/run/runner.h"

se3d_status se3di_files_fail(se3di_runner *r, se3d_status status, const char *text);
/* What a run cannot begin with; what was there of one that is gone on with stays. */
void se3di_files_give_up(const se3di_runner *r, se3di_csv *csv);
/* Whether the rows of this analysis are what the watch wants. */
bool se3di_files_is_watched(const se3di_runner *r);
/* The time of row `number` of a file. */
double se3di_files_row_time(const se3di_output_file *file, double number, double start,
                            double duration);
/* The rows that follow are of the present state. */
void se3di_files_begin_rows(se3di_runner *r);
se3d_status se3di_files_sample(se3di_runner *r, se3di_output_file *file, double time);
/* The time of the day [s]. */
double se3di_files_time_of_day(void);
/* Whoever watches the files sees what there is, about once a second. */
void se3di_files_flush(se3di_runner *r);
/* Complete every file, also after a failure: the rows so far are kept. The first failure is
 * reported. */
se3d_status se3di_files_close_all(se3di_runner *r, se3d_status status);
/* Take rows away that other files were made of; only who goes on with a run needs them. */
void se3di_files_tidy(const se3di_runner *r);
/* What is there of a run that is gone on with, and the files. */
se3d_status se3di_files_begin(se3di_runner *r);

#endif
