/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers, which are expressions over the parameters, vectors and orientations. */
#ifndef SE3D_IO_VALUE_H
#define SE3D_IO_VALUE_H

#include "io/document/reader.h"

extern const se3di_object se3di_object_orientation;

bool se3di_read_number(se3di_reader *reader, const se3di_node *node, se3di_range range,
                       double *value);
/* The number under `key`, left alone if there is none. */
bool se3di_read_key_number(se3di_reader *reader, const se3di_node *map, const char *key,
                           se3di_range range, double *value);
/* A coefficient of restitution, 0.01 to 1, left alone if there is none. */
bool se3di_read_key_restitution(se3di_reader *reader, const se3di_node *map, double *value);
/* A whole number from `least` to `largest`. */
bool se3di_read_count(se3di_reader *reader, const se3di_node *node, double least, double largest,
                      double *value);
/* The same from 0 on under `key`, left alone if there is none. */
bool se3di_read_key_count(se3di_reader *reader, const se3di_node *map, const char *key,
                          double largest, double *value);
bool se3di_read_vector(se3di_reader *reader, const se3di_node *node, size_t size, double *value);
bool se3di_read_key_vector(se3di_reader *reader, const se3di_node *map, const char *key,
                           double value[3]);
/* As above, and not the zero vector. */
bool se3di_read_key_direction(se3di_reader *reader, const se3di_node *map, const char *key,
                              double value[3]);
/* The Euler parameters under `orientation`, left alone if there is none. */
bool se3di_read_key_orientation(se3di_reader *reader, const se3di_node *map, double p[4]);
/* The Euler parameters that a map says; NULL: left alone. */
bool se3di_read_orientation(se3di_reader *reader, const se3di_node *node, double p[4]);

/* Compile the text of `node`; def->symbols NULL: the parameters. */
bool se3di_read_compile(se3di_reader *reader, const se3di_node *node, se3d_expression_def *def,
                        se3d_expression **expression);
/* The value of an expression that is constant, whatever its variables; finite. */
bool se3di_read_constant(se3di_reader *reader, const se3di_node *node,
                         const se3d_expression *expression, double *value);
/* A number that was read lies in a range, and not beyond what mechanics can do with. */
bool se3di_check_number(se3di_reader *reader, const se3di_node *node, se3di_range range,
                        double value);
/* Two numbers: of a variable and what a function under `key` gives for it; variable NULL: of `key`
 * and a number. */
bool se3di_read_pair_of(se3di_reader *reader, const se3di_node *node, const char *variable,
                        const se3di_node *key, double pair[2]);
/* The text of `node` stands for an expression: it is not empty, "nan" and so on. */
bool se3di_check_expression(se3di_reader *reader, const se3di_node *node);
/* What the text of `node` is, with its unit. */
bool se3di_read_amount(se3di_reader *reader, const se3di_node *node, se3di_amount *value);

#endif
