/* SPDX-License-Identifier: BSD-3-Clause */
/* Rank analysis, least norm, and the small dense factorisations. */
#include <stdlib.h>

#include "check.h"
#include "linsol/dense.h"
#include "linsol/rank.h"

enum { ROWS = 30, COLUMNS = 24 };

static size_t calls, fail_at = SIZE_MAX;
static long bytes;

static void *counted_alloc(void *ctx, size_t size)
{
    (void)ctx;
    if (++calls >= fail_at) {
        return NULL;
    }
    bytes += (long)size;
    return malloc(size);
}

static void *counted_realloc(void *ctx, void *old, size_t old_size, size_t new_size)
{
    (void)ctx;
    if (++calls >= fail_at) {
        return NULL;
    }
    bytes += (long)new_size - (long)old_size;
    return realloc(old, new_size);
}

static void counted_free(void *ctx, void *old, size_t size)
{
    (void)ctx;
    bytes -= (long)size;
    free(old);
}

static const se3d_allocator memory = {counted_alloc, counted_realloc, counted_free, NULL};

static void fill_random(double *C, size_t count, uint64_t seed)
{
    for (size_t i = 0; i < count; ++i) {
        C[i] = check_random(&seed);
    }
}

/* Row `to` = sum of two other rows with factors. */
static void combine(double *C, size_t to, size_t a, double fa, size_t b, double fb)
{
    for (size_t c = 0; c < COLUMNS; ++c) {
        C[to * COLUMNS + c] = fa * C[a * COLUMNS + c] + fb * C[b * COLUMNS + c];
    }
}

static void later_duplicates_are_named_with_their_combination(void)
{
    double C[20 * COLUMNS];
    se3di_rank rank;
    fill_random(C, sizeof C / sizeof *C, 77);
    combine(C, 5, 2, 3.0, 4, 0.0);
    combine(C, 11, 0, 1.0, 7, -2.0);
    combine(C, 19, 5, 0.5, 9, 1.0); /* of a redundant row: named by the independent ones */
    memset(C + 15 * COLUMNS, 0, COLUMNS * sizeof(double));
    CHECK(se3di_rank_analyse(&memory, 20, COLUMNS, C, 1e-8, &rank) == SE3D_INFO_REDUNDANT);
    CHECK(rank.rank == 16 && rank.redundant_count == 4 && rank.freedom_count == COLUMNS - 16);
    const int32_t redundant[4] = {5, 11, 15, 19}, begin[5] = {0, 1, 3, 3, 5};
    const int32_t rows[5] = {2, 0, 7, 2, 9};
    const double factors[5] = {3.0, 1.0, -2.0, 1.5, 1.0};
    for (int k = 0; k < 4 && rank.redundant_count == 4; ++k) {
        CHECK(rank.redundant[k] == redundant[k]);
        CHECK(rank.combination_begin[k + 1] == begin[k + 1]);
    }
    for (int k = 0; k < 5 && rank.combination_begin[4] == 5; ++k) {
        CHECK(rank.combination_row[k] == rows[k]);
        CHECK_NEAR(rank.combination[k], factors[k], 1e-12);
    }
    CHECK(rank.independent[5] == 6);
    CHECK(rank.gap_low > 1e-4 && rank.gap_high < 1e-14);
    se3di_rank_destroy(&memory, &rank);
    CHECK(bytes == 0);
}

static void freedoms_are_orthonormal_and_annihilated(void)
{
    double C[10 * COLUMNS];
    se3di_rank rank;
    fill_random(C, sizeof C / sizeof *C, 5);
    combine(C, 9, 1, 1.0, 3, 1.0);
    CHECK(se3di_rank_analyse(&memory, 10, COLUMNS, C, 1e-8, &rank) == SE3D_INFO_REDUNDANT);
    CHECK(rank.freedom_count == COLUMNS - 9);
    for (int32_t k = 0; k < rank.freedom_count; ++k) {
        const double *v = rank.freedom + (size_t)k * COLUMNS;
        for (size_t r = 0; r < 10; ++r) {
            double sum = 0.0;
            for (size_t c = 0; c < COLUMNS; ++c) {
                sum += C[r * COLUMNS + c] * v[c];
            }
            CHECK_NEAR(sum, 0.0, 1e-14);
        }
        for (int32_t i = 0; i <= k; ++i) {
            double sum = 0.0;
            for (size_t c = 0; c < COLUMNS; ++c) {
                sum += rank.freedom[(size_t)i * COLUMNS + c] * v[c];
            }
            CHECK_NEAR(sum, i == k ? 1.0 : 0.0, 1e-14);
        }
    }
    se3di_rank_destroy(&memory, &rank);
}

static void more_rows_than_columns_and_empty_systems_are_analysed(void)
{
    double C[ROWS * COLUMNS];
    se3di_rank rank;
    fill_random(C, sizeof C / sizeof *C, 6);
    CHECK(se3di_rank_analyse(&memory, ROWS, COLUMNS, C, 1e-8, &rank) == SE3D_INFO_REDUNDANT);
    CHECK(rank.rank == COLUMNS && rank.redundant_count == ROWS - COLUMNS);
    CHECK(rank.redundant_count > 0 && rank.redundant[0] == COLUMNS);
    CHECK(rank.freedom_count == 0);
    se3di_rank_destroy(&memory, &rank);
    CHECK(se3di_rank_analyse(&memory, 0, 6, C, 1e-8, &rank) == SE3D_OK);
    CHECK(rank.rank == 0 && rank.freedom_count == 6 && rank.freedom[7] == 1.0);
    se3di_rank_destroy(&memory, &rank);
    CHECK(se3di_rank_analyse(&memory, 3, 0, C, 1e-8, &rank) == SE3D_INFO_REDUNDANT);
    CHECK(rank.rank == 0 && rank.redundant_count == 3);
    se3di_rank_destroy(&memory, &rank);
    C[4] = (double)NAN;
    CHECK(se3di_rank_analyse(&memory, 2, 6, C, 1e-8, &rank) == SE3D_ERR_NOT_FINITE);
    CHECK(bytes == 0);
}

static void tolerance_decides_what_is_dependent(void)
{
    double C[8 * COLUMNS];
    se3di_rank rank;
    fill_random(C, sizeof C / sizeof *C, 8);
    combine(C, 6, 1, 1.0, 3, 1.0);
    for (size_t c = 0; c < COLUMNS; ++c) {
        C[6 * COLUMNS + c] += 1e-5 * C[7 * COLUMNS + c];
    }
    CHECK(se3di_rank_analyse(&memory, 7, COLUMNS, C, 1e-8, &rank) == SE3D_OK);
    CHECK(rank.rank == 7);
    se3di_rank_destroy(&memory, &rank);
    CHECK(se3di_rank_analyse(&memory, 7, COLUMNS, C, 1e-3, &rank) == SE3D_INFO_REDUNDANT);
    CHECK(rank.rank == 6 && rank.redundant[0] == 6);
    se3di_rank_destroy(&memory, &rank);
}

static void a_failing_allocation_leaves_nothing_behind(void)
{
    double C[8 * COLUMNS];
    fill_random(C, sizeof C / sizeof *C, 8);
    combine(C, 6, 1, 1.0, 3, 1.0);
    combine(C, 7, 1, 1.0, 4, 1.0);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    size_t at = 1;
    for (; status == SE3D_ERR_NO_MEMORY && at < 100; ++at) {
        se3di_rank rank;
        calls = 0;
        fail_at = at;
        status = se3di_rank_analyse(&memory, 8, COLUMNS, C, 1e-8, &rank);
        CHECK(status == SE3D_INFO_REDUNDANT || !rank.freedom);
        se3di_rank_destroy(&memory, &rank);
        CHECK(bytes == 0);
    }
    fail_at = SIZE_MAX;
    CHECK(status == SE3D_INFO_REDUNDANT && at > 10);
}

/* A (rows x columns, column-major) of rank 5: l is orthogonal to the null space of A. */
static void least_norm_solution_is_exact_and_orthogonal_to_the_null_space(void)
{
    enum { M = 9, N = 7 };
    double A[M * N], copy[M * N], g[M] = {0}, l[N], exact[N], n1[N] = {0}, n2[N] = {0};
    uint64_t seed = 3;
    fill_random(A, M * N, 9);
    for (size_t r = 0; r < M;
         ++r) { /* column 5 = 2 column 1, column 6 = 100 (column 0 - column 2) */
        A[5 * M + r] = 2.0 * A[M + r];
        A[6 * M + r] = 100.0 * (A[r] - A[2 * M + r]);
    }
    n1[1] = 2.0 / sqrt(5.0);
    n1[5] = -1.0 / sqrt(5.0);
    n2[0] = 100.0 / sqrt(20001.0);
    n2[2] = -100.0 / sqrt(20001.0);
    n2[6] = -1.0 / sqrt(20001.0);
    for (size_t k = 0; k < N; ++k) {
        exact[k] = check_random(&seed);
    }
    double p1 = 0.0, p2 = 0.0;
    for (size_t k = 0; k < N; ++k) {
        p1 += exact[k] * n1[k];
        p2 += exact[k] * n2[k];
    }
    for (size_t k = 0; k < N; ++k) {
        exact[k] -= p1 * n1[k] + p2 * n2[k];
        for (size_t r = 0; r < M; ++r) {
            g[r] += A[k * M + r] * exact[k];
        }
    }
    int32_t rank = 0;
    memcpy(copy, A, sizeof A);
    CHECK(se3di_rank_least_norm(&memory, M, N, copy, g, 1e-10, l, &rank) == SE3D_OK);
    CHECK(rank == 5);
    for (size_t k = 0; k < N; ++k) {
        CHECK_NEAR(l[k], exact[k], 1e-13);
    }
}

/* More equations than unknowns, of full rank and consistent: the solution is the one they have. */
static void unique_solutions_are_found(void)
{
    enum { M = 7, N = 4 };
    static const double wanted[N] = {0.5, -2.0, 3.0, 0.25};
    double A[M * N], g[M] = {0.0}, l[N];
    int32_t rank = 0;
    fill_random(A, (size_t)M * N, 11);
    for (int c = 0; c < N; ++c) {
        for (int r = 0; r < M; ++r) {
            A[c * M + r] *= 1.0 + c; /* columns of other lengths are taken in another order */
            g[r] += A[c * M + r] * wanted[c];
        }
    }
    CHECK(se3di_rank_least_norm(&memory, M, N, A, g, 1e-10, l, &rank) == SE3D_OK);
    CHECK(rank == N);
    for (int c = 0; c < N; ++c) {
        CHECK_NEAR(l[c], wanted[c], 1e-13);
    }
}

/* b <- (L L^T)^-1 b */
static void solve_cholesky(size_t n, const double *L, double *b)
{
    for (size_t r = 0; r < n; ++r) {
        for (size_t c = 0; c < r; ++c) {
            b[r] -= L[r * n + c] * b[c];
        }
        b[r] /= L[r * n + r];
    }
    for (size_t r = n; r-- > 0;) {
        b[r] /= L[r * n + r];
        for (size_t c = 0; c < r; ++c) {
            b[c] -= L[r * n + c] * b[r];
        }
    }
}

/* A x = b for small and large sizes. */
static void small_and_large_factorisations_solve(void)
{
    enum { MOST = 80 };
    static double A[MOST * MOST], S[MOST * MOST], F[MOST * MOST], b[MOST], x[MOST];
    int32_t pivot[MOST];
    const int32_t sizes[] = {1, 2, 6, 63, 64, 80};
    for (size_t k = 0; k < 6; ++k) {
        size_t n = (size_t)sizes[k];
        fill_random(A, n * n, 1 + k);
        fill_random(x, n, 50 + k);
        for (size_t r = 0; r < n; ++r) {
            for (size_t c = 0; c < n; ++c) {
                double sum = r == c ? 1.0 : 0.0;
                for (size_t i = 0; i < n; ++i) {
                    sum += A[r * n + i] * A[c * n + i];
                }
                S[r * n + c] = sum;
            }
        }
        for (int kind = 0; kind < 2; ++kind) { /* LU of A + 2, Cholesky of S */
            memcpy(F, kind == 0 ? A : S, n * n * sizeof(double));
            for (size_t r = 0; r < n; ++r) {
                F[r * n + r] += kind == 0 ? 2.0 : 0.0;
                b[r] = 0.0;
            }
            for (size_t r = 0; r < n; ++r) {
                for (size_t c = 0; c < n; ++c) {
                    b[r] += F[r * n + c] * x[c];
                }
            }
            if (kind == 0) {
                CHECK(se3di_dense_lu_factor((int32_t)n, F, pivot) == SE3D_OK);
                se3di_dense_lu_solve((int32_t)n, F, pivot, b);
            } else {
                CHECK(se3di_dense_cholesky_factor((int32_t)n, F) == SE3D_OK);
                solve_cholesky(n, F, b);
            }
            for (size_t r = 0; r < n; ++r) {
                CHECK_NEAR(b[r], x[r], 1e-11);
            }
        }
    }
}

static void singular_matrices_are_refused(void)
{
    for (int32_t n = 2; n <= 70; n += 68) {
        static double Z[70 * 70];
        int32_t pivot[70];
        memset(Z, 0, sizeof Z);
        CHECK(se3di_dense_lu_factor(n, Z, pivot) == SE3D_ERR_SINGULAR);
        CHECK(se3di_dense_cholesky_factor(n, Z) == SE3D_ERR_SINGULAR);
        Z[0] = (double)NAN;
        CHECK(se3di_dense_lu_factor(n, Z, pivot) == SE3D_ERR_NOT_FINITE);
        CHECK(se3di_dense_cholesky_factor(n, Z) == SE3D_ERR_SINGULAR);
    }
}

int main(void)
{
    RUN(later_duplicates_are_named_with_their_combination);
    RUN(freedoms_are_orthonormal_and_annihilated);
    RUN(more_rows_than_columns_and_empty_systems_are_analysed);
    RUN(tolerance_decides_what_is_dependent);
    RUN(a_failing_allocation_leaves_nothing_behind);
    RUN(least_norm_solution_is_exact_and_orthogonal_to_the_null_space);
    RUN(unique_solutions_are_found);
    RUN(small_and_large_factorisations_solve);
    RUN(singular_matrices_are_refused);
    return check_finish();
}
