/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions with vectors and units: the one place in which numbers and points of a model file
 * are evaluated, with their dimensions. What has neither is left to the compiler of the core. */
#ifndef SE3D_IO_AMOUNT_H
#define SE3D_IO_AMOUNT_H

#include "io/document/reader.h"
#include "io/document/scope.h"

/* The next name at or behind `text` that may be a parameter's or point's: no unit of a number and
 * no component. @return NULL: none */
const char *se3di_amount_next_name(const char *text, size_t *length);
/* Whether a text has vectors, points or units, or its file is not in SI units. */
bool se3di_amount_is_needed(const se3di_reader *reader, const char *text);
/* Evaluate the text of `node`; `variables` (NULL at the end; NULL: none) remain in the texts of the
 * result. Its unit is as written, not yet that of a key. */
bool se3di_amount_eval(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                       se3di_amount *result);
/* The row of the key that a node stands under, at any depth; NULL: none. */
const struct se3di_key *se3di_amount_find_key(const se3di_node *node);
/* The unit of a key, one of several (from 0). @return false: it takes any, or no number */
bool se3di_amount_find_unit(const struct se3di_key *row, int alternative, se3di_measure *unit);
/* Give the quantity of `node` the dimension that the key of `key` asks for: what has no unit is in
 * that of the file; another dimension is an error. The result is in the unit of the key. */
bool se3di_amount_take(se3di_reader *reader, const se3di_node *node, const se3di_node *key,
                       se3di_amount *q);
/* What has no unit is in that of the file for its own dimension; the result is in SI units. */
bool se3di_amount_take_plain(se3di_reader *reader, const se3di_node *node, se3di_amount *q);
/* The same for the dimension of a variable, in SI units. */
bool se3di_amount_take_variable(se3di_reader *reader, const se3di_node *node, const char *variable,
                                se3di_amount *q);

#endif
