/* SPDX-License-Identifier: BSD-3-Clause */
/* Tokens of an expression, and the one way to report an error in it. */
#ifndef SE3DI_EXPRESSION_LEXER_H
#define SE3DI_EXPRESSION_LEXER_H

#include "se3d/expression.h"

typedef enum se3di_token_kind {
    SE3DI_TOKEN_END = 0,
    SE3DI_TOKEN_NUMBER = 1,
    SE3DI_TOKEN_NAME = 2,
    SE3DI_TOKEN_COMPARISON = 3,
    SE3DI_TOKEN_MARK = 4 /* one of + - * / ^ ( ) , */
} se3di_token_kind;

typedef struct se3di_token {
    se3di_token_kind kind;
    char mark;         /* of a SE3DI_TOKEN_MARK, else 0 */
    const char *start; /* in the text */
    size_t length;
    double number; /* of a SE3DI_TOKEN_NUMBER */
} se3di_token;

typedef struct se3di_lexer {
    const char *text;             /* all of it */
    const char *at;               /* what comes after `token` */
    se3di_token token;            /* the present one */
    se3d_expression_error *error; /* may be NULL */
} se3di_lexer;

/* Advance to the next token. */
se3d_status se3di_lexer_next(se3di_lexer *lexer);

/* True for the names that identifiers may have. */
int se3di_lexer_is_identifier(const char *name);

/* Write a token for a message: 'sin', or "the end of the text". Long ones are cut. */
#define SE3DI_TOKEN_TEXT_SIZE 48
void se3di_token_describe(const se3di_token *token, char text[SE3DI_TOKEN_TEXT_SIZE]);

/* Record a message for the place `at` in the text (NULL: the definition is to blame, column 0) and
 * return `status`. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
se3d_status
se3di_lexer_fail(const se3di_lexer *lexer, se3d_status status, const char *at, const char *format,
                 ...);

#endif
