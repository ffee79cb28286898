/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions: text such as "pi/4*cos(2*t)", evaluated with exact derivatives.
 *
 * The grammar, the functions and what they mean at kinks: docs/model-file/expressions.md. */
#ifndef SE3D_EXPRESSION_H
#define SE3D_EXPRESSION_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Limits: an expression that exceeds one is rejected with SE3D_ERR_EXPRESSION. */
#define SE3D_EXPRESSION_TEXT_MAX     4096 /* characters */
#define SE3D_EXPRESSION_DEPTH_MAX    64   /* parentheses, calls and '^' inside each other */
#define SE3D_EXPRESSION_VARIABLE_MAX 4

/* A named constant. Its value is compiled in. @since 0.1 */
typedef struct se3d_expression_symbol {
    const char *name; /* letters, digits and '_', not beginning with a digit, not reserved */
    double value;     /* finite */
} se3d_expression_symbol;

/* Where and why a text was rejected. @since 0.1 */
typedef struct se3d_expression_error {
    size_t column;     /* 1-based, in the text; 0 where the text is not to blame */
    char message[256]; /* names the offending token and what is allowed */
} se3d_expression_error;

/* What to compile. Everything is copied: nothing needs to outlive the call, but the functions and
 * the context of the allocator, which must live as long as the expression. @since 0.1 */
typedef struct se3d_expression_def {
    size_t struct_size;                    /* set by se3d_expression_def_default */
    const char *text;                      /* required; at most SE3D_EXPRESSION_TEXT_MAX long */
    const char *const *variables;          /* [variable_count] names; variable 0 is the time */
    size_t variable_count;                 /* <= SE3D_EXPRESSION_VARIABLE_MAX; default 0 */
    const se3d_expression_symbol *symbols; /* [symbol_count]; of equal names the first counts */
    size_t symbol_count;                   /* default 0 */
    const se3d_allocator *allocator;       /* NULL: malloc and free */
} se3d_expression_def;

/* Write the default definition into `size` bytes at `def`; see se3d_expression_def_default.
 * NULL is ignored. Safe. @since 0.1 */
SE3D_API void se3d_expression_def_init(se3d_expression_def *def, size_t size);

/* Return the default definition: no text, no variables, no symbols, malloc. @since 0.1 */
static inline se3d_expression_def se3d_expression_def_default(void)
{
    se3d_expression_def def;
    se3d_expression_def_init(&def, sizeof def);
    return def;
}

/* Compile a text. Constant parts are computed here.
 *
 * @param[in]  def    what to compile
 * @param[out] out    the expression, to be given to se3d_expression_destroy; NULL on failure
 * @param[out] error  filled on failure, emptied on success; may be NULL
 * @return SE3D_OK; SE3D_ERR_EXPRESSION (text), SE3D_ERR_NULL, SE3D_ERR_INVALID_ARGUMENT
 *         (definition), SE3D_ERR_NO_MEMORY
 * Safe. @since 0.1 */
SE3D_API se3d_status se3d_expression_create(const se3d_expression_def *def, se3d_expression **out,
                                            se3d_expression_error *error);

/* Destroy an expression; NULL is fine. Exclusive. @since 0.1 */
SE3D_API void se3d_expression_destroy(se3d_expression *expression);

/* Evaluate f(x).
 *
 * @param[in]  x      [variable_count], finite; may be NULL where there are no variables
 * @param[out] value  f(x)
 * @return SE3D_OK; SE3D_ERR_NOT_FINITE where the result is not finite (it is written all the same);
 *         SE3D_ERR_INVALID_ARGUMENT where an x is not finite (NaN is written); SE3D_ERR_NULL
 * Allocates nothing. Reader. @since 0.1 */
SE3D_API se3d_status se3d_expression_eval(const se3d_expression *expression, const double *x,
                                          double *value);

/* Evaluate f, df/dt and d2f/dt2, exactly, where t is variable 0 and the other variables are held.
 *
 * @param[in]  x    [variable_count], as in se3d_expression_eval
 * @param[out] jet  [3]: f, df/dt, d2f/dt2; the derivatives are 0 where there are no variables
 * @return as se3d_expression_eval, for the three results together
 * Allocates nothing. Reader. @since 0.1 */
SE3D_API se3d_status se3d_expression_eval_time(const se3d_expression *expression, const double *x,
                                               double jet[3]);

/* Evaluate f and its exact first derivatives with respect to all variables.
 *
 * @param[in]  x         [variable_count], as in se3d_expression_eval
 * @param[out] value     f(x)
 * @param[out] gradient  [variable_count]: df/dx_k; may be NULL where there are no variables
 * @return as se3d_expression_eval, for all results together
 * Allocates nothing. Reader. @since 0.1 */
SE3D_API se3d_status se3d_expression_eval_gradient(const se3d_expression *expression,
                                                   const double *x, double *value,
                                                   double *gradient);

/* Return 1 where the expression was reduced to one number, else 0 (also for NULL).
 * Reader. @since 0.1 */
SE3D_API int se3d_expression_is_constant(const se3d_expression *expression);

/* Return the text it was compiled from, owned by the expression; "" for NULL.
 * Reader. @since 0.1 */
SE3D_API const char *se3d_expression_get_text(const se3d_expression *expression);

#ifdef __cplusplus
}
#endif
#endif
