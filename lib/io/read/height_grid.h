/* SPDX-License-Identifier: BSD-3-Clause */
/* Heights over a grid: rows of numbers in the model, in a CSV file, or of an expression. */
#ifndef SE3D_IO_HEIGHT_GRID_H
#define SE3D_IO_HEIGHT_GRID_H

#include "io/document/reader.h"

typedef struct se3di_height_grid {
    double *heights; /* [row_count * column_count], row by row [m] */
    size_t row_count, column_count;
} se3di_height_grid;

/* A list of two rows of numbers or more, of equal lengths. */
bool se3di_read_grid_rows(se3di_reader *reader, const se3di_node *list, se3di_height_grid *grid);
/* The CSV file that a key of a map names, a row a line, in the length unit of the model file; lines
 * that are empty or begin with '#' are passed over. */
bool se3di_read_grid_file(se3di_reader *reader, const se3di_node *map, const char *key,
                          se3di_height_grid *grid);
/* An expression in x and y at the places of a grid about the origin; its counts are given. */
bool se3di_read_grid_function(se3di_reader *reader, const se3di_node *node, const double spacing[2],
                              se3di_height_grid *grid);

#endif
