/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/eigen.h"

#include <lapacke.h>
#include <math.h>

static int all_finite(const double *A, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (!isfinite(A[k])) {
            return 0;
        }
    }
    return 1;
}

se3d_status se3di_symmetric_eigen(const se3d_allocator *allocator, int32_t n, double *A, double *w)
{
    double query = 0.0;
    if (n == 0) {
        return SE3D_OK;
    }
    if (!all_finite(A, (size_t)n * (size_t)n)) {
        return SE3D_ERR_NOT_FINITE;
    }
    (void)LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', n, A, n, w, &query, -1);
    lapack_int size = (lapack_int)query;
    double *work = se3di_alloc(allocator, (size_t)size, sizeof *work);
    if (!work) {
        return SE3D_ERR_NO_MEMORY;
    }
    lapack_int result = LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', n, A, n, w, work, size);
    se3di_free(allocator, work, (size_t)size, sizeof *work);
    return result == 0 ? SE3D_OK : SE3D_ERR_NO_CONVERGENCE;
}

static void transpose(int32_t n, double *A)
{
    for (int32_t r = 0; r < n; ++r) {
        for (int32_t c = 0; c < r; ++c) {
            double kept = A[(size_t)r * (size_t)n + (size_t)c];
            A[(size_t)r * (size_t)n + (size_t)c] = A[(size_t)c * (size_t)n + (size_t)r];
            A[(size_t)c * (size_t)n + (size_t)r] = kept;
        }
    }
}

se3d_status se3di_general_eigen(const se3d_allocator *allocator, int32_t n, double *A, double *B,
                                double *re, double *im, double *V)
{
    double query = 0.0;
    if (n == 0) {
        return SE3D_OK;
    }
    if (!all_finite(A, (size_t)n * (size_t)n) || !all_finite(B, (size_t)n * (size_t)n)) {
        return SE3D_ERR_NOT_FINITE;
    }
    transpose(n, A);
    transpose(n, B);
    (void)LAPACKE_dggev_work(LAPACK_COL_MAJOR, 'N', 'V', n, A, n, B, n, re, im, &query, NULL, 1, V,
                             n, &query, -1);
    size_t size = (size_t)query + (size_t)n;
    double *work = se3di_alloc(allocator, size, sizeof *work); /* beta first */
    if (!work) {
        return SE3D_ERR_NO_MEMORY;
    }
    lapack_int result = LAPACKE_dggev_work(LAPACK_COL_MAJOR, 'N', 'V', n, A, n, B, n, re, im, work,
                                           NULL, 1, V, n, work + n, (lapack_int)(size - (size_t)n));
    for (int32_t k = 0; k < n; ++k) {
        re[k] /= work[k];
        im[k] = fabs(im[k]) > 0.0 ? im[k] / work[k] : 0.0;
    }
    se3di_free(allocator, work, size, sizeof *work);
    return result == 0 ? SE3D_OK : SE3D_ERR_NO_CONVERGENCE;
}
