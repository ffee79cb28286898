/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients on 6 x 6 blocks (Hestenes, Stiefel 1952), preconditioned by D-ILU (Pommerell
 * 1992) with inverses of the blocks D. */
#include "linsol/block_cg.h"

#include <math.h>
#include <string.h>

#define N       6
#define VECTORS 4    /* of unknowns */
#define LEAST   1e-6 /* of the diagonal of A_jj: pivots of a D_j that is clearly positive */

void se3di_block_cg_destroy(se3di_block_cg *cg, const se3d_allocator *allocator)
{
    se3di_free(allocator, cg->work, cg->capacity, sizeof *cg->work);
    cg->work = NULL;
    cg->capacity = 0;
}

se3d_status se3di_block_cg_reserve(se3di_block_cg *cg, const se3d_allocator *allocator,
                                   size_t count)
{
    void *work = cg->work;
    const se3d_status status = se3di_array_reserve(allocator, &work, &cg->capacity,
                                                   (N * N + VECTORS * N) * count, sizeof *cg->work);
    cg->work = work;
    return status;
}

static inline size_t first_of(const se3di_block_matrix *A, size_t pair)
{
    return (size_t)(A->pairs[2 * pair] - A->first);
}

static inline size_t second_of(const se3di_block_matrix *A, size_t pair)
{
    return (size_t)(A->pairs[2 * pair + 1] - A->first);
}

/* out += B v */
static inline void add_block(const double *B, const double *v, double *out)
{
    for (int r = 0; r < N; ++r) {
        double sum = B[N * r] * v[0];
        for (int k = 1; k < N; ++k) {
            sum += B[N * r + k] * v[k];
        }
        out[r] += sum;
    }
}

/* out -= B^T v */
static inline void subtract_turned(const double *B, const double *v, double *out)
{
    double sum[N] = {0.0};
    for (int r = 0; r < N; ++r) {
        for (int k = 0; k < N; ++k) {
            sum[k] += B[N * r + k] * v[r];
        }
    }
    for (int k = 0; k < N; ++k) {
        out[k] -= sum[k];
    }
}

void se3di_block_cg_add_product(const se3di_block_matrix *A, const double *x, double *out)
{
    for (size_t i = 0; i < A->count; ++i) {
        add_block(A->diagonal + N * N * i, x + N * i, out + N * i);
    }
    for (size_t k = 0; k < A->pair_count; ++k) {
        const size_t i = first_of(A, k), j = second_of(A, k);
        const double *B = A->coupling + N * N * k;
        double turned[N] = {0.0};
        add_block(B, x + N * j, out + N * i);
        subtract_turned(B, x + N * i, turned);
        for (size_t r = 0; r < N; ++r) {
            out[N * j + r] -= turned[r];
        }
    }
}

/* The inverse of a symmetric block, by its lower half; 0: it is not clearly positive beside `own`.
 */
static int invert(const double *block, const double *own, double *inverse)
{
    double L[N][N], X[N][N];
    for (int r = 0; r < N; ++r) {
        for (int k = 0; k <= r; ++k) {
            double sum = block[N * r + k];
            for (int e = 0; e < k; ++e) {
                sum -= L[r][e] * L[k][e];
            }
            if (k < r) {
                L[r][k] = sum * X[k][k];
                continue;
            }
            if (!(sum > LEAST * own[(N + 1) * r])) {
                return 0;
            }
            L[r][r] = sqrt(sum);
            X[r][r] = 1.0 / L[r][r];
        }
    }
    for (int c = 0; c < N; ++c) { /* X = L^-1 */
        for (int r = c + 1; r < N; ++r) {
            double sum = 0.0;
            for (int e = c; e < r; ++e) {
                sum -= L[r][e] * X[e][c];
            }
            X[r][c] = sum * X[r][r];
        }
    }
    for (int r = 0; r < N; ++r) {
        for (int c = 0; c <= r; ++c) {
            double sum = 0.0;
            for (int e = r; e < N; ++e) {
                sum += X[e][r] * X[e][c];
            }
            inverse[N * r + c] = inverse[N * c + r] = sum;
        }
    }
    return 1;
}

/* D_j -= A_ij^T D_i^-1 A_ij */
static void eliminate(const double *B, const double *inverse, double *D)
{
    double T[N * N];
    for (int r = 0; r < N; ++r) {
        for (int c = 0; c < N; ++c) {
            double sum = 0.0;
            for (int e = 0; e < N; ++e) {
                sum += inverse[N * r + e] * B[N * e + c];
            }
            T[N * r + c] = sum;
        }
    }
    for (int r = 0; r < N; ++r) {
        for (int c = 0; c <= r; ++c) {
            double sum = 0.0;
            for (int e = 0; e < N; ++e) {
                sum += B[N * e + r] * T[N * e + c];
            }
            D[N * r + c] -= sum;
        }
    }
}

/* D^-1 */
static void precondition(const se3di_block_matrix *A, double *inverse)
{
    memcpy(inverse, A->diagonal, N * N * A->count * sizeof *inverse);
    size_t pair = 0;
    for (size_t i = 0; i < A->count; ++i) {
        const double *own = A->diagonal + N * N * i;
        double *D = inverse + N * N * i, out[N * N] = {0.0};
        if (!invert(D, own, out)) {
            (void)invert(own, own, out);
        }
        memcpy(D, out, sizeof out);
        for (; pair < A->pair_count && first_of(A, pair) == i; ++pair) {
            const size_t j = second_of(A, pair);
            eliminate(A->coupling + N * N * pair, D, inverse + N * N * j);
        }
    }
}

/* z = P^-1 r */
static void apply(const se3di_block_matrix *A, const double *inverse, const double *r, double *z)
{
    size_t pair = 0;
    memcpy(z, r, N * A->count * sizeof *z);
    for (size_t i = 0; i < A->count; ++i) {
        double y[N] = {0.0};
        add_block(inverse + N * N * i, z + N * i, y);
        memcpy(z + N * i, y, sizeof y);
        for (; pair < A->pair_count && first_of(A, pair) == i; ++pair) {
            const size_t j = second_of(A, pair);
            subtract_turned(A->coupling + N * N * pair, y, z + N * j);
        }
    }
    for (size_t i = A->count; i-- > 0;) {
        double sum[N] = {0.0}, less[N] = {0.0};
        const size_t end = pair;
        for (; pair > 0 && first_of(A, pair - 1) == i; --pair) {
            const size_t j = second_of(A, pair - 1);
            add_block(A->coupling + N * N * (pair - 1), z + N * j, sum);
        }
        if (pair < end) {
            add_block(inverse + N * N * i, sum, less);
            for (size_t k = 0; k < N; ++k) {
                z[N * i + k] -= less[k];
            }
        }
    }
}

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

int se3di_block_cg_solve(se3di_block_cg *cg, const se3di_block_matrix *A, const double *b,
                         double share, int most, double *x)
{
    const size_t n = N * A->count;
    double *inverse = cg->work, *r = inverse + N * n, *z = r + n, *p = z + n, *Ap = p + n;
    precondition(A, inverse);
    memset(x, 0, n * sizeof *x);
    memcpy(r, b, n * sizeof *r);
    apply(A, inverse, r, z);
    memcpy(p, z, n * sizeof *p);
    double size = dot(r, z, n);
    const double end = share * share * size;
    int count = 0;
    while (count < most && size > end && size > 0.0) {
        memset(Ap, 0, n * sizeof *Ap);
        se3di_block_cg_add_product(A, p, Ap);
        const double step = size / dot(p, Ap, n), before = size;
        for (size_t k = 0; k < n; ++k) {
            x[k] += step * p[k];
            r[k] -= step * Ap[k];
        }
        ++count;
        apply(A, inverse, r, z);
        size = dot(r, z, n);
        for (size_t k = 0; k < n; ++k) {
            p[k] = z[k] + size / before * p[k];
        }
    }
    return count;
}
