/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions: expressions, callbacks, tables, constants; integrals of them.
 * docs/theory/functions.md */
#include "model/function.h"

#include "base/floats.h"
#include "expression/expression.h"
#include "model/integral.h"

#include <math.h>
#include <string.h>

void se3di_function_release(const se3d_allocator *allocator, se3di_function *function)
{
    se3d_expression_destroy(function->expression);
    se3di_free(allocator, function->table, 3 * function->table_count, sizeof *function->table);
    se3di_free(allocator, function->signals, function->signal_count, sizeof *function->signals);
    se3di_integral_release(allocator, function->integral);
    function->signals = NULL;
    function->integral = NULL;
    function->expression = NULL;
    function->table = NULL;
}

se3d_status se3di_function_own(const se3d_allocator *allocator, se3di_function *function)
{
    const se3d_expression *expression = function->expression;
    const double *table = function->table;
    const se3di_signal *signals = function->signals;
    const se3di_integral *integral = function->integral;
    function->integral = NULL;
    function->expression = NULL;
    function->table = NULL;
    function->signals = NULL;
    if (expression) {
        SE3DI_TRY(se3di_expression_clone(expression, allocator, &function->expression));
    }
    if (table) {
        function->table = se3di_alloc(allocator, 3 * function->table_count, sizeof *table);
        if (!function->table) {
            return SE3D_ERR_NO_MEMORY;
        }
        memcpy(function->table, table, 3 * function->table_count * sizeof *table);
    }
    if (signals) {
        function->signals = se3di_alloc(allocator, function->signal_count, sizeof *signals);
        if (!function->signals) {
            return SE3D_ERR_NO_MEMORY;
        }
        memcpy(function->signals, signals, function->signal_count * sizeof *signals);
    }
    return integral ? se3di_integral_clone(allocator, integral, &function->integral) : SE3D_OK;
}

static se3d_status expression_eval(const se3di_function *function, const double *x, double jet[3],
                                   double *gradient)
{
    se3d_status status = se3d_expression_eval_time(function->expression, x, jet);
    if (gradient && status >= 0) {
        double value;
        status = se3d_expression_eval_gradient(function->expression, x, &value, gradient);
    }
    return status;
}

static se3d_status eval_content(const se3di_function *function, const double *x, double jet[3],
                                double *gradient)
{
    if (gradient) {
        memset(gradient, 0, function->variable_count * sizeof *gradient);
    }
    if (function->expression) {
        return expression_eval(function, x, jet, gradient);
    }
    if (function->callback) {
        se3d_status status = function->callback(function->ctx, x, jet, gradient);
        se3di_floats_resume();
        if (status < 0) {
            return SE3D_ERR_CALLBACK;
        }
    } else if (function->table) {
        const se3di_spline table = se3di_function_table(function);
        se3di_spline_eval(&table, x[0], jet);
        if (gradient) {
            gradient[0] = jet[1];
        }
    } else {
        jet[0] = function->constant;
        jet[1] = jet[2] = 0.0;
    }
    return isfinite(jet[0]) && isfinite(jet[1]) && isfinite(jet[2]) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3di_function_eval(const se3di_function *function, const double *x, double jet[3],
                                double *gradient)
{
    const se3d_status status = eval_content(function, x, jet, gradient);
    if (!function->integral) {
        return status;
    }
    jet[2] = jet[1];
    jet[1] = jet[0];
    if (!se3di_integral_eval(function, x[0], &jet[0])) {
        jet[0] = (double)NAN;
        return status < 0 ? status : SE3D_ERR_NOT_FINITE;
    }
    if (gradient) {
        gradient[0] = jet[1];
    }
    return status;
}
