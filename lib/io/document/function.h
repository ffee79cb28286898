/* SPDX-License-Identifier: BSD-3-Clause */
/* Values that may be functions: expressions and tables. */
#ifndef SE3D_IO_FUNCTION_H
#define SE3D_IO_FUNCTION_H

#include "io/document/reader.h"

/* A number, or a function of `variables` (NULL at the end, the first is the time): then *function
 * is not null. */
bool se3di_read_function(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                         double *value, se3d_function *function);

/* A number, or an expression in `variables` (NULL at the end), which is the caller's: then
 * *expression is not NULL. */
bool se3di_read_expression(se3di_reader *reader, const se3di_node *node,
                           const char *const *variables, double *value,
                           se3d_expression **expression);

/* The integral over the time of a number, which *value gets, or a function of it, from `start` at
 * t = 0. */
bool se3di_read_rate(se3di_reader *reader, const se3di_node *node, double start, double *value,
                     bool *is_number, se3d_function *function);

#endif
