/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions, for the layers above: the public interface and what only the library may do. */
#ifndef SE3DI_EXPRESSION_EXPRESSION_H
#define SE3DI_EXPRESSION_EXPRESSION_H

#include "base/alloc.h"
#include "se3d/expression.h"

/* Deep copy with another allocator. On failure *out is NULL. */
se3d_status se3di_expression_clone(const se3d_expression *expression,
                                   const se3d_allocator *allocator, se3d_expression **out);

/* Whether it reads some variable whose bit is in the mask. */
int se3di_expression_reads(const se3d_expression *expression, unsigned mask);

/* Number of variables it was compiled for. */
size_t se3di_expression_variable_count(const se3d_expression *expression);

/* Values at points side by side, x [variables][SE3DI_EXPRESSION_POINTS], the same bits as of each.
 * @return OK, INVALID_ARGUMENT, NOT_FINITE: of some point, as of se3d_expression_eval() */
#define SE3DI_EXPRESSION_POINTS 8
se3d_status se3di_expression_eval_points(const se3d_expression *expression, const double *x,
                                         double values[SE3DI_EXPRESSION_POINTS]);

/* f and its first and second derivative along a direction: its components of the variables whose
 * bits are in the mask, 0 of the others. What is not finite stays so. */
void se3di_expression_eval_along(const se3d_expression *expression, const double *x,
                                 const double *direction, unsigned mask, double jet[3]);

/* Whether it has derivatives wherever it has a value, for certain: no |x|, condition or root. */
int se3di_expression_is_smooth(const se3d_expression *expression);

/* Whether it has no jump, for certain: no condition, comparison, sign, rounding or remainder. The
 * angle of atan2 jumps where it is half a turn. */
int se3di_expression_is_continuous(const se3d_expression *expression);

/* Whether it is finite wherever its variables are, but for numbers that grow without bound. */
int se3di_expression_is_total(const se3d_expression *expression);

#endif
