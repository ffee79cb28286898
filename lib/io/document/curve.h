/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables: curves through points that the model lists, or that a CSV file holds. */
#ifndef SE3D_IO_CURVE_H
#define SE3D_IO_CURVE_H

#include "io/document/reader.h"

extern const se3di_object se3di_object_spline;

/* Take the table that a map says, of `variable` (its name, which decides the unit), into `def`. Its
 * numbers are in memory of the reader's pool. */
bool se3di_read_curve(se3di_reader *reader, const se3di_node *node, const char *variable,
                      se3d_function_def *def);

#endif
