/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables as HDF5: an array for each column, of its name. Rows are written as CSV while a model
 * runs, so that what is there can be read and gone on with; at the end the arrays are made of it.
 */
#ifndef SE3D_IO_TABLE_HDF5_H
#define SE3D_IO_TABLE_HDF5_H

#include <stdbool.h>
#include <stdint.h>

#include "se3d/base.h"

/* Columns that are not numbers with a fraction: bit k is column k. */
typedef struct se3di_table_columns {
    uint64_t texts, integers;
} se3di_table_columns;

/* Make the file of the table in `csv`, which stays; compressed if `compression` is not 0. @return
 * false: errno says why; nothing is left. */
bool se3di_table_convert(const char *csv, const char *path, const se3di_table_columns *columns,
                         int compression, const se3d_allocator *allocator);

#endif
