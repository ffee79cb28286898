/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/dense.h"

#include <lapacke.h>
#include <math.h>
#include <stdbool.h>

static void swap_rows(int32_t n, double *a, double *b)
{
    for (int32_t c = 0; c < n; ++c) {
        double t = a[c];
        a[c] = b[c];
        b[c] = t;
    }
}

static se3d_status lu_small(int32_t n, double *A, int32_t *pivot)
{
    for (int32_t r = 0; r < n; ++r) {
        int32_t best = r;
        for (int32_t q = r + 1; q < n; ++q) {
            best = fabs(A[q * n + r]) > fabs(A[best * n + r]) ? q : best;
        }
        pivot[r] = best;
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
        for (int32_t q = r + 1; q < n; ++q) {
            double f = A[q * n + r] / d;
            A[q * n + r] = f;
            for (int32_t c = r + 1; c < n; ++c) {
                A[q * n + c] -= f * A[r * n + c];
            }
        }
    }
    return SE3D_OK;
}

se3d_status se3di_dense_lu_factor(int32_t n, double *A, int32_t *pivot)
{
    if (n < SE3DI_DENSE_SMALL) {
        return lu_small(n, A, pivot);
    }
    /* The row-major A is A^T to LAPACK; the solve undoes that. */
    lapack_int result = LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, A, n, pivot);
    for (int32_t i = 0; i < n; ++i) {
        if (!isfinite(A[(size_t)i * (size_t)n + (size_t)i])) {
            return SE3D_ERR_NOT_FINITE;
        }
    }
    return result > 0 ? SE3D_ERR_SINGULAR : SE3D_OK;
}

void se3di_dense_lu_solve(int32_t n, const double *A, const int32_t *pivot, double *b)
{
    if (n >= SE3DI_DENSE_SMALL) {
        (void)LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', n, 1, A, n, pivot, b, n);
        return;
    }
    for (int32_t r = 0; r < n; ++r) {
        double t = b[pivot[r]];
        b[pivot[r]] = b[r];
        b[r] = t;
    }
    for (int32_t r = 0; r < n; ++r) {
        for (int32_t c = 0; c < r; ++c) {
            b[r] -= A[r * n + c] * b[c];
        }
    }
    for (int32_t r = n - 1; r >= 0; --r) {
        for (int32_t c = r + 1; c < n; ++c) {
            b[r] -= A[r * n + c] * b[c];
        }
        b[r] /= A[r * n + r];
    }
}

se3d_status se3di_dense_cholesky_factor(int32_t n, double *A)
{
    if (n >= SE3DI_DENSE_SMALL) { /* the lower triangle is the upper one to LAPACK */
        lapack_int result = LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', n, A, n);
        bool is_fine = result == 0;
        for (int32_t i = 0; i < n; ++i) {
            is_fine = is_fine && isfinite(A[(size_t)i * (size_t)n + (size_t)i]);
        }
        return is_fine ? SE3D_OK : SE3D_ERR_SINGULAR;
    }
    for (int32_t r = 0; r < n; ++r) {
        for (int32_t c = 0; c <= r; ++c) {
            double sum = A[r * n + c];
            for (int32_t k = 0; k < c; ++k) {
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

void se3di_dense_cholesky_solve(int32_t n, const double *L, double *b)
{
    if (n >= SE3DI_DENSE_SMALL) {
        (void)LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'U', n, 1, L, n, b, n);
        return;
    }
    for (int32_t r = 0; r < n; ++r) {
        for (int32_t c = 0; c < r; ++c) {
            b[r] -= L[r * n + c] * b[c];
        }
        b[r] /= L[r * n + r];
    }
    for (int32_t r = n - 1; r >= 0; --r) {
        b[r] /= L[r * n + r];
        for (int32_t c = 0; c < r; ++c) {
            b[c] -= L[r * n + c] * b[r];
        }
    }
}

se3d_status se3di_dense_ldl_factor(int32_t n, double *A)
{
    for (int32_t r = 0; r < n; ++r) {
        for (int32_t c = 0; c <= r; ++c) {
            double sum = A[r * n + c];
            for (int32_t k = 0; k < c; ++k) {
                sum -= A[r * n + k] * A[c * n + k] * A[k * n + k];
            }
            A[r * n + c] = c < r ? sum / A[c * n + c] : sum;
        }
        double d = A[r * n + r];
        if (!isfinite(d) || !(fabs(d) > 0.0)) {
            return SE3D_ERR_SINGULAR;
        }
    }
    return SE3D_OK;
}

void se3di_dense_ldl_solve(int32_t n, const double *A, double *b)
{
    for (int32_t r = 0; r < n; ++r) {
        for (int32_t c = 0; c < r; ++c) {
            b[r] -= A[r * n + c] * b[c];
        }
    }
    for (int32_t r = n - 1; r >= 0; --r) {
        b[r] /= A[r * n + r];
        for (int32_t k = r + 1; k < n; ++k) {
            b[r] -= A[k * n + r] * b[k];
        }
    }
}
