/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/spline.h"

#include <math.h>

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

void se3di_spline_eval(const double *x, size_t n, double u, double jet[3])
{
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
