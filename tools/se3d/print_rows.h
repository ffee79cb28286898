/* SPDX-License-Identifier: BSD-3-Clause */
/* `se3d run --print`: rows of one file of the results on standard output. */
#ifndef SE3D_PROGRAM_PRINT_ROWS_H
#define SE3D_PROGRAM_PRINT_ROWS_H

#include "options.h"

/* The file of `output` that --print asks for. @return NULL after a message: there is none. */
const char *print_rows_find(const options *o, const se3d_model *model);
/* Print a file of the results. @return an exit code, after a message if it cannot be read. */
int print_rows(const char *folder, const char *file);

#endif
