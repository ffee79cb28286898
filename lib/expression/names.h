/* SPDX-License-Identifier: BSD-3-Clause */
/* What a name in an expression stands for, and what a misspelt one may have meant. */
#ifndef SE3DI_EXPRESSION_NAMES_H
#define SE3DI_EXPRESSION_NAMES_H

#include "expression/lexer.h"

typedef enum se3di_name_kind {
    SE3DI_NAME_UNKNOWN = 0,
    SE3DI_NAME_VARIABLE = 1,
    SE3DI_NAME_NUMBER = 2 /* a symbol or a built-in constant */
} se3di_name_kind;

typedef struct se3di_name {
    se3di_name_kind kind;
    size_t index; /* of a variable */
    double value; /* of a number */
} se3di_name;

/* Check the names and values of a definition (the text apart). */
se3d_status se3di_names_check(const se3d_expression_def *def, const se3di_lexer *lexer);

/* Look up a name that is not a function. */
se3di_name se3di_name_find(const se3d_expression_def *def, const char *name, size_t length);

/* Report the present token as an unknown name or function, with a suggestion if one is near. */
se3d_status se3di_name_fail(const se3d_expression_def *def, const se3di_lexer *lexer,
                            const se3di_token *token, int is_function);

#endif
