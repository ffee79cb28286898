/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/eigen_modes.h"

#include "base/error.h"
#include "linsol/dense.h"
#include "linsol/eigen.h"
#include "math/elementary.h"

#include <math.h>
#include <string.h>

static double largest(const double *A, size_t count)
{
    double size = 0.0;
    for (size_t k = 0; k < count; ++k) {
        size = fmax(size, fabs(A[k]));
    }
    return size;
}

static int is_conservative(size_t f, const double *D, const double *K)
{
    double size = largest(K, f * f);
    double skew = 0.0;
    for (size_t r = 0; r < f; ++r) {
        for (size_t c = 0; c < r; ++c) {
            skew = fmax(skew, fabs(K[r * f + c] - K[c * f + r]));
        }
    }
    return !(largest(D, f * f) > 0.0) && skew <= 1e-11 * size;
}

void se3di_eigen_add(se3di_eigen *e, double re, double im, const double *y_re, const double *y_im)
{
    size_t f = (size_t)e->f;
    size_t k = (size_t)e->count++;
    while (k > 0 && se3di_hypot(e->re[k - 1], e->im[k - 1]) > se3di_hypot(re, im)) {
        e->re[k] = e->re[k - 1];
        e->im[k] = e->im[k - 1];
        memcpy(e->y_re + k * f, e->y_re + (k - 1) * f, f * sizeof *y_re);
        memcpy(e->y_im + k * f, e->y_im + (k - 1) * f, f * sizeof *y_re);
        --k;
    }
    e->re[k] = re;
    e->im[k] = im;
    memcpy(e->y_re + k * f, y_re, f * sizeof *y_re);
    memset(e->y_im + k * f, 0, f * sizeof *y_re);
    if (y_im) {
        memcpy(e->y_im + k * f, y_im, f * sizeof *y_re);
    }
}

/* X <- L^-1 X on the columns of a row-major X [f f]. */
static void solve_lower(size_t f, const double *L, double *X)
{
    for (size_t r = 0; r < f; ++r) {
        for (size_t k = 0; k < r; ++k) {
            for (size_t c = 0; c < f; ++c) {
                X[r * f + c] -= L[r * f + k] * X[k * f + c];
            }
        }
        for (size_t c = 0; c < f; ++c) {
            X[r * f + c] /= L[r * f + r];
        }
    }
}

static void transpose(size_t f, double *X)
{
    for (size_t r = 0; r < f; ++r) {
        for (size_t c = 0; c < r; ++c) {
            double kept = X[r * f + c];
            X[r * f + c] = X[c * f + r];
            X[c * f + r] = kept;
        }
    }
}

/* x <- L^-T x */
static void solve_upper(size_t f, const double *L, double *x)
{
    for (size_t r = f; r-- > 0;) {
        for (size_t k = r + 1; k < f; ++k) {
            x[r] -= L[k * f + r] * x[k];
        }
        x[r] /= L[r * f + r];
    }
}

/* X <- L^-1 X L^-T */
static void reduce(size_t f, const double *L, double *X)
{
    solve_lower(f, L, X);
    transpose(f, X);
    solve_lower(f, L, X);
    transpose(f, X);
}

/* s^2 = -mu: L^-1 K L^-T v = mu v with M = L L^T, y = L^-T v. */
static se3d_status solve_conservative(const se3d_allocator *allocator, const double *L,
                                      const double *K, double *work, se3di_eigen *e)
{
    size_t f = (size_t)e->f;
    double *S = work;
    double *mu = work + f * f;
    memcpy(S, K, f * f * sizeof *S);
    reduce(f, L, S);
    SE3DI_TRY(se3di_symmetric_eigen(allocator, e->f, S, mu));
    double noise = 4e-16 * (double)f * fmax(fabs(mu[0]), fabs(mu[f - 1]));
    for (size_t k = 0; k < f; ++k) {
        double *y = S + k * f;
        solve_upper(f, L, y);
        double root = fabs(mu[k]) > noise ? sqrt(fabs(mu[k])) : 0.0;
        if (mu[k] < -noise) {
            se3di_eigen_add(e, -root, 0.0, y, NULL);
            se3di_eigen_add(e, root, 0.0, y, NULL);
        } else {
            se3di_eigen_add(e, 0.0, root, y, NULL);
        }
    }
    return SE3D_OK;
}

/* With M = L L^T, y = L^-T p and p' = w q, w the size of the frequencies:
 *
 *     [0                  w I          ] [p]     [p]
 *     [-L^-1 K L^-T / w  -L^-1 D L^-T  ] [q] = s [q] */
static void fill_state_matrix(size_t f, const double *D, const double *K, double *A)
{
    double w = sqrt(largest(K, f * f));
    w = w > 0.0 ? w : fmax(largest(D, f * f), 1e-300);
    for (size_t r = 0; r < f; ++r) {
        double *upper = A + r * 2 * f;
        double *lower = A + (f + r) * 2 * f;
        memset(upper, 0, 2 * f * sizeof *upper);
        upper[f + r] = w;
        for (size_t c = 0; c < f; ++c) {
            lower[c] = -K[r * f + c] / w;
            lower[f + c] = -D[r * f + c];
        }
    }
}

static se3d_status solve_damped(const se3d_allocator *allocator, const double *L, const double *D,
                                const double *K, double *work, se3di_eigen *e)
{
    size_t f = (size_t)e->f;
    double *D_reduced = work;
    double *K_reduced = work + f * f;
    double *A = work + 2 * f * f;
    double *V = A + 4 * f * f;
    double *re = V + 4 * f * f;
    double *im = re + 2 * f;
    memcpy(D_reduced, D, f * f * sizeof *D);
    memcpy(K_reduced, K, f * f * sizeof *K);
    reduce(f, L, D_reduced);
    reduce(f, L, K_reduced);
    fill_state_matrix(f, D_reduced, K_reduced, A);
    SE3DI_TRY(se3di_general_eigen(allocator, 2 * e->f, A, re, im, V));
    for (size_t k = 0; k < 2 * f; ++k) {
        double *y_im = im[k] > 0.0 ? V + (k + 1) * 2 * f : NULL;
        if (!isfinite(re[k]) || !isfinite(im[k]) || im[k] < 0.0) {
            continue;
        }
        solve_upper(f, L, V + k * 2 * f);
        if (y_im) {
            solve_upper(f, L, y_im);
        }
        se3di_eigen_add(e, re[k], im[k], V + k * 2 * f, y_im);
    }
    return SE3D_OK;
}

/* M = L L^T, zeros above the diagonal of L. */
static se3d_status factor_mass(int32_t freedoms, const double *M, double *L)
{
    size_t f = (size_t)freedoms;
    memcpy(L, M, f * f * sizeof *L);
    SE3DI_TRY(se3di_dense_cholesky_factor(freedoms, L));
    for (size_t r = 0; r < f; ++r) {
        memset(L + r * f + r + 1, 0, (f - r - 1) * sizeof *L);
    }
    return SE3D_OK;
}

static size_t memory_of(const se3di_eigen *e)
{
    return 2 * (size_t)e->room * (1 + (size_t)e->f);
}

void se3di_eigen_destroy(const se3d_allocator *allocator, se3di_eigen *e)
{
    se3di_free(allocator, e->re, memory_of(e), sizeof(double));
    memset(e, 0, sizeof *e);
}

se3d_status se3di_eigen_reserve(const se3d_allocator *allocator, int32_t f, int32_t room,
                                se3di_eigen *e)
{
    const size_t count = (size_t)room;
    *e = (se3di_eigen){.f = f, .room = room};
    e->re = se3di_alloc(allocator, memory_of(e), sizeof *e->re);
    if (!e->re) {
        memset(e, 0, sizeof *e);
        return SE3D_ERR_NO_MEMORY;
    }
    e->im = e->re + count;
    e->y_re = e->im + count;
    e->y_im = e->y_re + count * (size_t)f;
    return SE3D_OK;
}

se3d_status se3di_eigen_solve(const se3d_allocator *allocator, int32_t freedoms, const double *M,
                              const double *D, const double *K, se3di_eigen *e)
{
    size_t f = (size_t)freedoms;
    *e = (se3di_eigen){.f = freedoms};
    if (f == 0) {
        return SE3D_OK;
    }
    size_t work_count = 11 * f * f + 4 * f;
    double *work = se3di_alloc(allocator, work_count, sizeof *work);
    se3d_status status = se3di_eigen_reserve(allocator, freedoms, 2 * freedoms, e);
    status = status >= 0 && work ? factor_mass(e->f, M, work) : SE3D_ERR_NO_MEMORY;
    if (status >= 0) {
        status = is_conservative(f, D, K) ? solve_conservative(allocator, work, K, work + f * f, e)
                                          : solve_damped(allocator, work, D, K, work + f * f, e);
    }
    se3di_free(allocator, work, work_count, sizeof *work);
    if (status < 0) {
        se3di_eigen_destroy(allocator, e);
    }
    return status;
}
