/* SPDX-License-Identifier: BSD-3-Clause */
/* Dense eigenvalue problems: residuals, orthogonality, known spectra and matrices on which the
 * iterations are known to stall. */
#include "check.h"

#include "linsol/eigen.h"

#define SIZE_MAX_TESTED 80

static uint64_t seed = 1;

static double largest(size_t count, const double *A)
{
    double size = 0.0;
    for (size_t k = 0; k < count; ++k) {
        size = fmax(size, fabs(A[k]));
    }
    return size;
}

static double A[SIZE_MAX_TESTED * SIZE_MAX_TESTED];
static double V[SIZE_MAX_TESTED * SIZE_MAX_TESTED];
static double work[SIZE_MAX_TESTED * SIZE_MAX_TESTED];
static double re[SIZE_MAX_TESTED];
static double im[SIZE_MAX_TESTED];

/* max |A v - w v| over |A|, and max |V V^T - I| */
static void check_symmetric(int32_t n, double tolerance)
{
    se3d_allocator allocator = se3di_alloc_default();
    memcpy(V, A, (size_t)(n * n) * sizeof *V);
    CHECK(se3di_symmetric_eigen(&allocator, n, V, re) == SE3D_OK);
    double size = largest((size_t)(n * n), A);
    double residual = 0.0;
    double skewness = 0.0;
    for (int32_t k = 0; k < n; ++k) {
        CHECK(k == 0 || re[k] >= re[k - 1]);
        for (int32_t r = 0; r < n; ++r) {
            double sum = -re[k] * V[k * n + r];
            double dot = r == k ? -1.0 : 0.0;
            for (int32_t c = 0; c < n; ++c) {
                sum += A[r * n + c] * V[k * n + c];
                dot += V[k * n + c] * V[r * n + c];
            }
            residual = fmax(residual, fabs(sum));
            skewness = fmax(skewness, fabs(dot));
        }
    }
    CHECK(residual <= tolerance * size);
    CHECK(skewness <= tolerance);
}

static void symmetric_matrices_have_small_residuals(void)
{
    for (int32_t n = 1; n <= SIZE_MAX_TESTED; n += n < 12 ? 1 : 17) {
        for (int kind = 0; kind < 6; ++kind) {
            for (int32_t r = 0; r < n; ++r) {
                for (int32_t c = 0; c <= r; ++c) {
                    double x = check_random(&seed);
                    x = kind == 1 ? x * pow(10.0, -(r + c) / 4.0) : x; /* graded */
                    x = kind == 2 ? x * 1e-200 : kind == 3 ? x * 1e200 : x;
                    x = kind == 4 ? (r == c ? 3.0 : 0.0) : x;        /* one eigenvalue */
                    x = kind == 5 ? (double)((r + 1) * (c + 1)) : x; /* of rank 1 */
                    A[r * n + c] = x;
                    A[c * n + r] = x;
                }
            }
            check_symmetric(n, 4e-15 * (double)n);
        }
    }
}

/* -1, 2, -1: w_k = 2 - 2 cos(k pi / (n + 1)); zeros; Wilkinson's W21+, whose pairs agree to 1e-14.
 */
static void symmetric_matrices_have_their_known_eigenvalues(void)
{
    int32_t n = 50;
    memset(A, 0, sizeof A);
    check_symmetric(n, 1e-15);
    for (int32_t k = 0; k < n; ++k) {
        A[k * n + k] = 2.0;
        if (k > 0) {
            A[k * n + k - 1] = A[(k - 1) * n + k] = -1.0;
        }
    }
    check_symmetric(n, 1e-14);
    for (int32_t k = 0; k < n; ++k) {
        CHECK_NEAR(re[k], 2.0 - 2.0 * cos((k + 1) * 3.14159265358979323846 / (n + 1)), 1e-14);
    }
    n = 21;
    memset(A, 0, sizeof A);
    for (int32_t k = 0; k < n; ++k) {
        A[k * n + k] = fabs(k - 10.0);
        if (k > 0) {
            A[k * n + k - 1] = A[(k - 1) * n + k] = 1.0;
        }
    }
    check_symmetric(n, 1e-14);
    CHECK_NEAR(re[20], 10.746194182903393, 1e-13);
    CHECK_NEAR(re[19], 10.746194182903322, 1e-13);
    CHECK_NEAR(re[0], -1.1254415221199847, 1e-13);
}

/* max |A v - s v| over |A|; the sum of the eigenvalues is the trace */
static void check_general(int32_t n, double tolerance)
{
    se3d_allocator allocator = se3di_alloc_default();
    memcpy(work, A, (size_t)(n * n) * sizeof *work);
    CHECK(se3di_general_eigen(&allocator, n, work, re, im, V) == SE3D_OK);
    double size = largest((size_t)(n * n), A);
    double residual = 0.0;
    double trace = 0.0;
    for (int32_t k = 0; k < n; ++k) {
        const double *x = V + k * n;
        const double *y = im[k] > 0.0 ? x + n : NULL;
        double norm = 0.0;
        trace += A[k * n + k] - re[k];
        CHECK(isfinite(re[k]) && isfinite(im[k]));
        if (im[k] < 0.0) {
            CHECK(k > 0 && re[k - 1] == re[k] && im[k - 1] == -im[k]);
            continue;
        }
        for (int32_t r = 0; r < n; ++r) {
            double a = -re[k] * x[r] + (y ? im[k] * y[r] : 0.0);
            double b = y ? -re[k] * y[r] - im[k] * x[r] : 0.0;
            for (int32_t c = 0; c < n; ++c) {
                a += A[r * n + c] * x[c];
                b += y ? A[r * n + c] * y[c] : 0.0;
            }
            residual = fmax(residual, fabs(a) + fabs(b));
            norm = fmax(norm, fabs(x[r]) + (y ? fabs(y[r]) : 0.0));
        }
        CHECK_NEAR(norm, 1.0, 1e-15);
    }
    CHECK(residual <= tolerance * size);
    CHECK(fabs(trace) <= tolerance * size);
}

static void general_matrices_have_small_residuals(void)
{
    for (int32_t n = 1; n <= SIZE_MAX_TESTED; n += n < 12 ? 1 : 17) {
        for (int kind = 0; kind < 8; ++kind) {
            for (int32_t k = 0; k < n * n; ++k) {
                int32_t r = k / n;
                int32_t c = k % n;
                double x = check_random(&seed);
                x = kind == 1 ? (r > c ? x : r < c ? -x : 0.0) : x;
                x = kind == 2 ? x * 1e-200 : kind == 3 ? x * 1e200 : x;
                x = kind == 4 ? (double)(c == (r + 1) % n)
                              : x; /* unit circle; stalls plain shifts */
                x = kind == 5 ? (r == c ? 2.0 : c == r + 1 ? 1.0 : 0.0) : x; /* a Jordan block */
                x = kind == 6 ? x * pow(10.0, (r - c) / 8.0) : x;            /* badly scaled */
                x = kind == 7 ? 0.0 : x;
                A[k] = x;
            }
            check_general(n, 2e-14 * (double)n);
        }
    }
}

/* The companion matrix of (s + 1)(s + 2) .. (s + 6)(s^2 + 4)(s^2 + 2 s + 10), and one whose blocks
 * of two lie under each other. */
static void general_matrices_have_their_known_eigenvalues(void)
{
    double p[11] = {1.0};
    int32_t n = 0;
    for (; n < 6; ++n) {
        for (int32_t k = n + 1; k > 0; --k) {
            p[k] += (n + 1.0) * p[k - 1];
        }
    }
    const double pairs[2][2] = {{0.0, 4.0}, {2.0, 10.0}};
    for (int32_t j = 0; j < 2; ++j, n += 2) {
        for (int32_t k = n + 2; k > 0; --k) {
            p[k] += pairs[j][0] * p[k - 1] + (k > 1 ? pairs[j][1] * p[k - 2] : 0.0);
        }
    }
    memset(A, 0, sizeof A);
    for (int32_t k = 0; k < n; ++k) {
        A[k] = -p[k + 1];
        if (k > 0) {
            A[k * n + k - 1] = 1.0;
        }
    }
    check_general(n, 1e-13);
    const double expected[8][2] = {{-1, 0}, {-2, 0}, {-3, 0}, {-4, 0},
                                   {-5, 0}, {-6, 0}, {0, 2},  {-1, 3}};
    for (int32_t j = 0; j < 8; ++j) {
        double nearest = 1.0;
        for (int32_t k = 0; k < n; ++k) {
            nearest = fmin(nearest, hypot(re[k] - expected[j][0], im[k] - expected[j][1]));
        }
        CHECK(nearest < 1e-9);
    }
}

static void *no_memory(void *context, size_t size)
{
    (void)context;
    (void)size;
    return NULL;
}

static void bad_matrices_are_refused(void)
{
    se3d_allocator allocator = se3di_alloc_default();
    const double bad[2] = {(double)NAN, HUGE_VAL};
    for (int j = 0; j < 2; ++j) {
        for (int32_t k = 0; k < 9; ++k) {
            A[k] = k == 6 ? bad[j] : 1.0 + k;
        }
        memcpy(work, A, 9 * sizeof *A);
        CHECK(se3di_symmetric_eigen(&allocator, 3, work, re) == SE3D_ERR_NOT_FINITE);
        CHECK(se3di_general_eigen(&allocator, 3, A, re, im, V) == SE3D_ERR_NOT_FINITE);
    }
    A[6] = 1.0;
    allocator.alloc = no_memory;
    CHECK(se3di_symmetric_eigen(&allocator, 3, A, re) == SE3D_ERR_NO_MEMORY);
    CHECK(se3di_general_eigen(&allocator, 3, A, re, im, V) == SE3D_ERR_NO_MEMORY);
    CHECK(se3di_symmetric_eigen(&allocator, 0, A, re) == SE3D_OK);
    CHECK(se3di_general_eigen(&allocator, 0, A, re, im, V) == SE3D_OK);
}

int main(void)
{
    RUN(symmetric_matrices_have_small_residuals);
    RUN(symmetric_matrices_have_their_known_eigenvalues);
    RUN(general_matrices_have_small_residuals);
    RUN(general_matrices_have_their_known_eigenvalues);
    RUN(bad_matrices_are_refused);
    return check_finish();
}
