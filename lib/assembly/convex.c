/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/convex.h"

#include "math/symmetric.h"

#include <math.h>
#include <string.h>

/* What makes turns as stiff as translations: absolute values are not of mixed units. */
static double balance_units(int n, const double *A)
{
    double translation = 0.0;
    double rotation = 0.0;
    for (int k = 0; k < n; ++k) {
        double *largest = k % 6 < 3 ? &translation : &rotation;
        *largest = fmax(*largest, fabs(A[(n + 1) * k]));
    }
    return translation > 0.0 && rotation > 0.0 ? sqrt(rotation / translation) : 1.0;
}

static void scale_turns(int n, double *A, double scale)
{
    for (int k = 0; k < n * n; ++k) {
        A[k] *= (k / n % 6 < 3 ? 1.0 : scale) * (k % n % 6 < 3 ? 1.0 : scale);
    }
}

static void make_absolute(int n, double *A)
{
    const double radius = balance_units(n, A);
    scale_turns(n, A, 1.0 / radius);
    se3di_symmetric_abs(n, A);
    scale_turns(n, A, radius);
}

/* |[0 B; B^T 0]| without its couplings, which are zero: sqrt(B B^T) and sqrt(B^T B). */
static void add_coupling(const double *B, double *K_i, double *K_j)
{
    double A[144] = {0.0};
    for (int k = 0; k < 36; ++k) {
        A[12 * (k / 6) + 6 + k % 6] = A[12 * (6 + k % 6) + k / 6] = B[k];
    }
    se3di_symmetric_abs(12, A);
    for (int k = 0; k < 36; ++k) {
        K_i[k] += A[12 * (k / 6) + k % 6];
        K_j[k] += A[12 * (6 + k / 6) + 6 + k % 6];
    }
}

void se3di_convex_blocks(se3di_tangent *tangent)
{
    for (size_t k = 0; k < tangent->assembly->body_count; ++k) {
        make_absolute(6, tangent->K + 36 * k);
    }
    for (size_t k = 0; k < tangent->coupling_count; ++k) {
        double *upper = tangent->K_upper + 36 * k;
        double *lower = tangent->K_lower + 36 * k;
        double B[36], size = 0.0;
        for (int e = 0; e < 36; ++e) {
            B[e] = 0.5 * (upper[e] + lower[6 * (e % 6) + e / 6]);
            size += fabs(B[e]);
        }
        if (size > 0.0) {
            add_coupling(B, tangent->K + 36 * (size_t)tangent->coupling[2 * k],
                         tangent->K + 36 * (size_t)tangent->coupling[2 * k + 1]);
        }
        memset(upper, 0, 36 * sizeof *upper);
        memset(lower, 0, 36 * sizeof *lower);
    }
}

void se3di_convex_load(const int is_free[2], const double *K, double *convex)
{
    for (int k = 0; k < 144; ++k) {
        convex[k] = is_free[k / 72] && is_free[k % 12 / 6] ? -K[k] : 0.0;
    }
    make_absolute(12, convex);
    for (int k = 0; k < 144; ++k) {
        convex[k] = -convex[k];
    }
}
