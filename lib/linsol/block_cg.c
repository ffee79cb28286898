/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients on 6 x 6 blocks (Hestenes, Stiefel 1952), preconditioned by D-ILU (Pommerell
 * 1992) with inverses of the blocks D. */
#include "linsol/block_cg.h"

#include "linsol/block_cg_core.h"

#include <math.h>
#include <string.h>

#define N       SE3DI_CG_SIZE
#define VECTORS 4 /* of unknowns */

void se3di_block_cg_destroy(se3di_block_cg *cg, const se3d_allocator *allocator)
{
    se3di_free(allocator, cg->work, cg->capacity, sizeof *cg->work);
    cg->work = NULL;
    cg->capacity = 0;
}

se3d_status se3di_block_cg_reserve(se3di_block_cg *cg, const se3d_allocator *allocator,
                                   size_t count, size_t pair_count)
{
    const se3di_block_cg_core *avx2 = se3di_block_cg_core_avx2();
    cg->core = avx2 ? avx2 : se3di_block_cg_core_portable();
    return se3di_array_reserve_at(allocator, &cg->work, &cg->capacity,
                                  (N * N + VECTORS * N) * count + N * N * pair_count,
                                  sizeof *cg->work);
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

/* out += B^T v */
static inline void add_turned(const double *B, const double *v, double *out)
{
    double sum[N] = {0.0};
    for (int r = 0; r < N; ++r) {
        for (int k = 0; k < N; ++k) {
            sum[k] += B[N * r + k] * v[r];
        }
    }
    for (int k = 0; k < N; ++k) {
        out[k] += sum[k];
    }
}

void se3di_block_cg_add_product(const se3di_block_matrix *A, const double *x, double *out)
{
    for (size_t i = 0; i < A->count; ++i) {
        add_block(A->diagonal + N * N * i, x + N * i, out + N * i);
    }
    for (size_t k = 0; k < A->pair_count; ++k) {
        const size_t i = se3di_cg_first(A, k), j = se3di_cg_second(A, k);
        const double *B = A->coupling + N * N * k;
        add_block(B, x + N * j, out + N * i);
        add_turned(B, x + N * i, out + N * j);
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

/* The transposes, behind D^-1 and the vectors. */
static double *turned_of(const se3di_block_cg *cg, const se3di_block_matrix *A)
{
    return cg->work + (N * N + VECTORS * N) * A->count;
}

void se3di_block_cg_factor(se3di_block_cg *cg, const se3di_block_matrix *A)
{
    cg->core->factor(A, cg->work, turned_of(cg, A));
}

void se3di_block_cg_renew(se3di_block_cg *cg, const se3di_block_matrix *A)
{
    double *to = turned_of(cg, A);
    for (size_t k = 0; k < A->pair_count; ++k, to += N * N) {
        const double *B = A->coupling + N * N * k;
        for (int r = 0; r < N; ++r) {
            for (int c = 0; c < N; ++c) {
                to[N * r + c] = B[N * c + r];
            }
        }
    }
}

int se3di_block_cg_solve(se3di_block_cg *cg, const se3di_block_matrix *A, const double *b,
                         double share, int most, double *x)
{
    const size_t n = N * A->count;
    const double *inverse = cg->work, *turned = turned_of(cg, A);
    double *r = cg->work + N * n, *z = r + n, *p = z + n, *Ap = p + n;
    memset(x, 0, n * sizeof *x);
    memcpy(r, b, n * sizeof *r);
    cg->core->apply(A, inverse, turned, r, z);
    memcpy(p, z, n * sizeof *p);
    double size = dot(r, z, n);
    const double end = share * share * size;
    int count = 0;
    while (count < most && size > end && size > 0.0) {
        cg->core->multiply(A, turned, p, Ap);
        const double step = size / dot(p, Ap, n), before = size;
        for (size_t k = 0; k < n; ++k) {
            x[k] += step * p[k];
            r[k] -= step * Ap[k];
        }
        ++count;
        cg->core->apply(A, inverse, turned, r, z);
        size = dot(r, z, n);
        for (size_t k = 0; k < n; ++k) {
            p[k] = z[k] + size / before * p[k];
        }
    }
    return count;
}
