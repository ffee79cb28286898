/* SPDX-License-Identifier: BSD-3-Clause */
/* Text -> bytecode, by recursive descent. */
#ifndef SE3DI_EXPRESSION_PARSER_H
#define SE3DI_EXPRESSION_PARSER_H

#include "expression/program.h"
#include "se3d/expression.h"

/* Append the code of def->text (a checked definition) to `program`. `error` may be NULL. */
se3d_status se3di_expression_parse(const se3d_expression_def *def, se3di_program *program,
                                   se3d_expression_error *error);

#endif
