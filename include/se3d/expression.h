/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions: text such as "pi/4*cos(2*t)", evaluated with exact derivatives.
 *
 * The grammar, the functions and what they mean at kinks: docs/model-file/expressions.md.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_EXPRESSION_H
#define SE3D_EXPRESSION_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Limits: an expression that exceeds one is rejected with SE3D_ERR_EXPRESSION. */
#define SE3D_EXPRESSION_TEXT_MAX     4096 /* characters */
#define SE3D_EXPRESSION_DEPTH_MAX    64   /* parentheses, calls and '^' inside each other */
#define SE3D_EXPRESSION_VARIABLE_MAX 16

/* A named constant. Its value is compiled in. @since 0.1 */
typedef struct se3d_expression_symbol {
    const char *name; /* letters, digits and '_', not beginning with a digit, not reserved */
    double value;     /* finite [any unit] */
} se3d_expression_symbol;

/* The place and the reason of an error in a text. @since 0.1 */
typedef struct se3d_expression_error {
    size_t column;     /* 1-based, in the text; 0 if the text is not to blame */
    char message[256]; /* names the offending token and what is allowed */
} se3d_expression_error;

/* The definition of an expression. Everything is copied: only the functions and the context of the
 * allocator must live as long as the expression. @since 0.1 */
typedef struct se3d_expression_def {
    size_t struct_size;                    /* set by se3d_expression_def_default */
    const char *text;                      /* required; at most SE3D_EXPRESSION_TEXT_MAX long */
    const char *const *variables;          /* [variable_count] names; variable 0 is the time */
    size_t variable_count;                 /* <= SE3D_EXPRESSION_VARIABLE_MAX; default 0 */
    const se3d_expression_symbol *symbols; /* [symbol_count]; of equal names the first counts */
    size_t symbol_count;                   /* default 0 */
    const se3d_allocator *allocator;       /* NULL: malloc and free */
} se3d_expression_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_expression_def_default. @since 0.1 */
SE3D_API void se3d_expression_def_init(se3d_expression_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_expression_def se3d_expression_def_default(void)
{
    se3d_expression_def def;
    se3d_expression_def_init(&def, sizeof def);
    return def;
}

/* Compile a text. Constant parts are computed here.
 * @param[out] error  filled on failure, emptied on success; may be NULL
 * @return OK, EXPRESSION (text), NULL, INVALID_ARGUMENT (definition), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_expression_create(const se3d_expression_def *def, se3d_expression **out,
                                            se3d_expression_error *error);

/* Destroy an expression; NULL is fine. @since 0.1 */
SE3D_API void se3d_expression_destroy(se3d_expression *expression);

/* Evaluate f(x). Allocates nothing.
 * @param[in] x       [variable_count], finite; may be NULL if there are no variables
 * @param[out] value  f(x) [any unit]
 * @return OK, NOT_FINITE (the result is not finite; it is written all the same), INVALID_ARGUMENT
 *         (an x is not finite; NaN is written), NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_expression_eval(const se3d_expression *expression, const double *x,
                                          double *value);

/* Evaluate f, df/dt and d2f/dt2 exactly; t is variable 0, the other variables are held. Allocates
 * nothing.
 * @param[in] x     [variable_count], as in se3d_expression_eval
 * @param[out] jet  [3] f, df/dt, d2f/dt2 [any unit, per s], in no frame; the derivatives are 0 if
 *                  there are no variables
 * @return as se3d_expression_eval, for the three results together.
 * @since 0.1 */
SE3D_API se3d_status se3d_expression_eval_time(const se3d_expression *expression, const double *x,
                                               double jet[3]);

/* Evaluate f and its exact first derivatives with respect to all variables. Allocates nothing.
 * @param[in] x          [variable_count], as in se3d_expression_eval
 * @param[out] value     f(x) [any unit]
 * @param[out] gradient  [variable_count] df/dx_k; may be NULL if there are no variables
 * @return as se3d_expression_eval, for all results together.
 * @since 0.1 */
SE3D_API se3d_status se3d_expression_eval_gradient(const se3d_expression *expression,
                                                   const double *x, double *value,
                                                   double *gradient);

/* Tell whether the expression was reduced to one number. @return 1 if so, else 0, also for NULL.
 * @since 0.1 */
SE3D_API int se3d_expression_is_constant(const se3d_expression *expression);

/* Get the text that an expression was compiled from. @return the text, owned by the expression;
 * "" for NULL. @since 0.1 */
SE3D_API const char *se3d_expression_get_text(const se3d_expression *expression);

/* Write an expression in standard form, with other names of its variables: what is compiled from
 * the text gives the same bits. Constants and parameters are numbers there, and what has been
 * computed from them.
 * @param[in] variables  [variable_count] names, or anything else that stands for a variable; may be
 *                       NULL if there are no variables
 * @param[out] text      [capacity] ends with a zero byte; NULL: only *length is told
 * @param[in] capacity   of `text`
 * @param[out] length    of the whole text, without the zero byte
 * @return OK, NULL, INVALID_ARGUMENT (capacity; the text is cut), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_expression_write(const se3d_expression *expression,
                                           const char *const *variables, char *text,
                                           size_t capacity, size_t *length);

#ifdef __cplusplus
}
#endif
#endif
