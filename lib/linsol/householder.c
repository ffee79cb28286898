/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/householder.h"

#include <math.h>

/* Below this part of a square, a length that was brought up to date is measured anew. */
static const double worn = 1.5e-8;

/* In eight partial sums. */
static double dot(const double *a, const double *b, size_t n)
{
    double sum[8] = {0.0};
    size_t i = 0;
    for (; i + 8 <= n; i += 8) {
        for (size_t k = 0; k < 8; ++k) {
            sum[k] += a[i + k] * b[i + k];
        }
    }
    for (size_t k = 0; i + k < n; ++k) {
        sum[k] += a[i + k] * b[i + k];
    }
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}

double se3di_householder_reflect(size_t n, double *column)
{
    double rest = dot(column + 1, column + 1, n - 1), first = column[0];
    if (!(rest > 0.0)) {
        return 0.0;
    }
    double beta = -copysign(sqrt(first * first + rest), first), by = first - beta;
    for (size_t i = 1; i < n; ++i) {
        column[i] /= by;
    }
    column[0] = beta;
    return (beta - first) / beta;
}

/* x -= tau v v^T x, v = (1, v[1 ..)), where v[1 + i] are zeros for i below `from`, a multiple of
 * eight, and from `to` on: a sum without these is the same to the bit. */
static inline void mirror_part(size_t from, size_t to, double tau, const double *restrict v,
                               double *restrict x)
{
    const double f = tau * (x[0] + dot(v + 1 + from, x + 1 + from, to - from));
    if (f == 0.0) {
        return; /* most pairs of columns of a sparse matrix, at first */
    }
    x[0] -= f;
    for (size_t i = from; i < to; ++i) {
        x[1 + i] -= f * v[1 + i];
    }
}

void se3di_householder_mirror(size_t n, double tau, const double *v, double *x)
{
    mirror_part(0, n - 1, tau, v, x);
}

void se3di_householder(size_t rows, size_t columns, double *A, double *tau)
{
    for (size_t k = 0; k < rows && k < columns; ++k) {
        double *column = A + k * rows + k;
        tau[k] = se3di_householder_reflect(rows - k, column);
        for (size_t j = k + 1; j < columns; ++j) {
            se3di_householder_mirror(rows - k, tau[k], column, A + j * rows + k);
        }
    }
}

static void swap_columns(size_t rows, double *a, double *b)
{
    for (size_t i = 0; i < rows; ++i) {
        double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

/* The length of a column below its first entry, from that of all: now, and when last measured. */
static void shorten(size_t n, const double *column, double *now, double *measured)
{
    double part = fabs(column[0]) / *now, left = (1.0 + part) * (1.0 - part);
    double since = *now / *measured;
    if (left * since * since > worn) {
        *now *= sqrt(left);
        return;
    }
    *now = *measured = sqrt(dot(column + 1, column + 1, n - 1));
}

void se3di_householder_pivoted(size_t rows, size_t columns, double *A, int32_t *pivot, double *tau,
                               double *work)
{
    double *now = work, *measured = work + columns;
    for (size_t j = 0; j < columns; ++j) {
        pivot[j] = (int32_t)j;
        now[j] = measured[j] = sqrt(dot(A + j * rows, A + j * rows, rows));
    }
    for (size_t k = 0; k < rows && k < columns; ++k) {
        size_t best = k;
        for (size_t j = k + 1; j < columns; ++j) {
            best = now[j] > now[best] ? j : best;
        }
        if (best != k) {
            int32_t kept = pivot[k];
            pivot[k] = pivot[best];
            pivot[best] = kept;
            now[best] = now[k];
            measured[best] = measured[k];
            swap_columns(rows, A + k * rows, A + best * rows);
        }
        double *column = A + k * rows + k;
        tau[k] = se3di_householder_reflect(rows - k, column);
        size_t from = 0, to = rows - k - 1;
        while (to > 0 && column[to] == 0.0) {
            --to;
        }
        while (from < to && column[1 + from] == 0.0) {
            ++from;
        }
        from -= from % 8;
        for (size_t j = k + 1; j < columns; ++j) {
            mirror_part(from, to, tau[k], column, A + j * rows + k);
            if (now[j] > 0.0) {
                shorten(rows - k, A + j * rows + k, &now[j], &measured[j]);
            }
        }
    }
}

void se3di_householder_apply(size_t rows, size_t count, const double *A, const double *tau,
                             double *x)
{
    for (size_t k = count; k-- > 0;) {
        se3di_householder_mirror(rows - k, tau[k], A + k * rows + k, x + k);
    }
}

void se3di_householder_apply_transposed(size_t rows, size_t count, const double *A,
                                        const double *tau, double *x)
{
    for (size_t k = 0; k < count; ++k) {
        se3di_householder_mirror(rows - k, tau[k], A + k * rows + k, x + k);
    }
}
