/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions: expressions, callbacks, natural cubic splines, constants; integrals of them.  docs/theory/functions.md */
#include "model/function.h"

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

/* Second derivatives m of the natural spline: the tridiagonal system
 *     h_{k-1} m_{k-1} + 2 (h_{k-1} + h_k) m_k + h_k m_{k+1} = 6 (s_k - s_{k-1}),  m_0 = m_{n-1} = 0
 */
void se3di_spline_build(const double *x, const double *y, size_t n, double *m, double *scratch)
{
    m[0] = 0.0;
    m[n - 1] = 0.0;
    scratch[0] = 0.0;
    for (size_t k = 1; k + 1 < n; ++k) {
        double before = x[k] - x[k - 1];
        double after = x[k + 1] - x[k];
        double pivot = 2.0 * (before + after) - before * scratch[k - 1];
        double right = 6.0 * ((y[k + 1] - y[k]) / after - (y[k] - y[k - 1]) / before);
        scratch[k] = after / pivot;
        m[k] = (right - before * m[k - 1]) / pivot;
    }
    for (size_t k = n - 1; k-- > 1;) {
        m[k] -= scratch[k] * m[k + 1];
    }
}

size_t se3di_spline_find(const double *x, size_t n, double u)
{
    size_t low = 0;
    size_t high = n - 1;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (x[middle] <= u) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static void spline_eval(const se3di_function *function, double u, double jet[3])
{
    size_t n = function->table_count;
    const double *x = function->table;
    const double *y = x + n;
    const double *m = y + n;
    size_t k = se3di_spline_find(x, n, u);
    double h = x[k + 1] - x[k];
    double inside = fmin(fmax(u, x[0]), x[n - 1]);
    double a = (x[k + 1] - inside) / h;
    double b = (inside - x[k]) / h;
    jet[0] = a * y[k] + b * y[k + 1] +
             ((a * a * a - a) * m[k] + (b * b * b - b) * m[k + 1]) * h * h / 6.0;
    jet[1] = (y[k + 1] - y[k]) / h +
             ((1.0 - 3.0 * a * a) * m[k] + (3.0 * b * b - 1.0) * m[k + 1]) * h / 6.0;
    jet[2] = a * m[k] + b * m[k + 1];
    if (u < x[0] || u > x[n - 1]) {
        jet[0] += jet[1] * (u - inside);
        jet[2] = 0.0;
    }
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
        if (status < 0) {
            return SE3D_ERR_CALLBACK;
        }
    } else if (function->table) {
        spline_eval(function, x[0], jet);
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
