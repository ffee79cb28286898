/* SPDX-License-Identifier: BSD-3-Clause */
/* Points listed in a CSV file. */
#ifndef SE3D_IO_POINT_TABLE_H
#define SE3D_IO_POINT_TABLE_H

#include "io/document/reader.h"

/* The points of the file that `point_table` names, as a map like that of `points`; NULL: none. */
bool se3di_read_point_table(se3di_reader *reader, const se3di_node *root, const se3di_node **map);

/* Cut a cell off at *at, a row of a CSV file, without blanks and quotes around it. @return NULL:
 * the row has ended. */
char *se3di_table_next_cell(char **at);

#endif
