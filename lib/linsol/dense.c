/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/dense.h"

#include <math.h>
#include <stddef.h>

#include "base/error.h"

/* Columns that are eliminated before the others are brought up to date, so that what is read again
 * and again stays in the cache. Each entry sees the same operations in the same order. */
#define PANEL 48

static void swap_rows(size_t n, double *a, double *b)
{
    for (size_t c = 0; c < n; ++c) {
        double t = a[c];
        a[c] = b[c];
        b[c] = t;
    }
}

/* Columns [begin, end), below and in row `begin` and on. */
static se3d_status factor_panel(size_t n, size_t begin, size_t end, double *A, int32_t *pivot)
{
    for (size_t r = begin; r < end; ++r) {
        size_t best = r;
        for (size_t q = r + 1; q < n; ++q) {
            best = fabs(A[q * n + r]) > fabs(A[best * n + r]) ? q : best;
        }
        pivot[r] = (int32_t)best;
        if (best != r) {
            swap_rows(n, A + r * n, A + best * n);
        }
        double d = A[r * n + r];
        if (!isfinite(d)) {
            return SE3D_ERR_NOT_FINITE;
        }
        if (!(fabs(d) > 0.0)) {
            return SE3D_ERR_SINGULAR;
        }
        for (size_t q = r + 1; q < n; ++q) {
            double f = A[q * n + r] / d;
            A[q * n + r] = f;
            for (size_t c = r + 1; c < end; ++c) {
                A[q * n + c] -= f * A[r * n + c];
            }
        }
    }
    return SE3D_OK;
}

/* The columns from `end` on. */
static void update_rest(size_t n, size_t begin, size_t end, double *A)
{
    for (size_t q = begin + 1; q < n; ++q) {
        double *row = A + q * n;
        for (size_t r = begin; r < end && r < q; ++r) {
            const double f = row[r], *above = A + r * n;
            for (size_t c = end; c < n; ++c) {
                row[c] -= f * above[c];
            }
        }
    }
}

se3d_status se3di_dense_lu_factor(int32_t unknowns, double *A, int32_t *pivot)
{
    const size_t n = (size_t)unknowns;
    for (size_t begin = 0; begin < n; begin += PANEL) {
        const size_t end = begin + PANEL < n ? begin + PANEL : n;
        SE3DI_TRY(factor_panel(n, begin, end, A, pivot));
        update_rest(n, begin, end, A);
    }
    return SE3D_OK;
}

void se3di_dense_lu_solve(int32_t unknowns, const double *A, const int32_t *pivot, double *b)
{
    const size_t n = (size_t)unknowns;
    for (size_t r = 0; r < n; ++r) {
        double t = b[pivot[r]];
        b[pivot[r]] = b[r];
        b[r] = t;
    }
    for (size_t r = 0; r < n; ++r) {
        for (size_t c = 0; c < r; ++c) {
            b[r] -= A[r * n + c] * b[c];
        }
    }
    for (size_t r = n; r-- > 0;) {
        for (size_t c = r + 1; c < n; ++c) {
            b[r] -= A[r * n + c] * b[c];
        }
        b[r] /= A[r * n + r];
    }
}

se3d_status se3di_dense_cholesky_factor(int32_t unknowns, double *A)
{
    const size_t n = (size_t)unknowns;
    for (size_t r = 0; r < n; ++r) {
        for (size_t c = 0; c <= r; ++c) {
            double sum = A[r * n + c];
            for (size_t k = 0; k < c; ++k) {
                sum -= A[r * n + k] * A[c * n + k];
            }
            if (c < r) {
                A[r * n + c] = sum / A[c * n + c];
            } else if (sum > 0.0 && isfinite(sum)) {
                A[r * n + r] = sqrt(sum);
            } else {
                return SE3D_ERR_SINGULAR;
            }
        }
    }
    return SE3D_OK;
}
