/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/householder.h"

#include "linsol/mirrors.h"

#include <math.h>

/* Below this part of a square, a length that was brought up to date is measured anew. */
static const double worn = 1.5e-8;

static const se3di_mirrors *find_mirrors(void)
{
    const se3di_mirrors *avx2 = se3di_mirrors_avx2();
    return avx2 ? avx2 : se3di_mirrors_portable();
}

static double reflect(const se3di_mirrors *mirrors, size_t n, double *column)
{
    double rest = mirrors->dot(column + 1, column + 1, n - 1), first = column[0];
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

double se3di_householder_reflect(size_t n, double *column)
{
    return reflect(find_mirrors(), n, column);
}

void se3di_householder_mirror(size_t n, double tau, const double *v, double *x)
{
    find_mirrors()->mirror(0, n - 1, tau, v, x);
}

void se3di_householder(size_t rows, size_t columns, double *A, double *tau)
{
    const se3di_mirrors *mirrors = find_mirrors();
    for (size_t k = 0; k < rows && k < columns; ++k) {
        double *column = A + k * rows + k;
        tau[k] = reflect(mirrors, rows - k, column);
        for (size_t j = k + 1; j < columns; ++j) {
            mirrors->mirror(0, rows - k - 1, tau[k], column, A + j * rows + k);
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
static void shorten(const se3di_mirrors *mirrors, size_t n, const double *column, double *now,
                    double *measured)
{
    double part = fabs(column[0]) / *now, left = (1.0 + part) * (1.0 - part);
    double since = *now / *measured;
    if (left * since * since > worn) {
        *now *= sqrt(left);
        return;
    }
    *now = *measured = sqrt(mirrors->dot(column + 1, column + 1, n - 1));
}

void se3di_householder_pivoted(size_t rows, size_t columns, double *A, int32_t *pivot, double *tau,
                               double *work)
{
    const se3di_mirrors *mirrors = find_mirrors();
    double *now = work, *measured = work + columns;
    for (size_t j = 0; j < columns; ++j) {
        pivot[j] = (int32_t)j;
        now[j] = measured[j] = sqrt(mirrors->dot(A + j * rows, A + j * rows, rows));
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
        tau[k] = reflect(mirrors, rows - k, column);
        size_t from = 0, to = rows - k - 1;
        while (to > 0 && column[to] == 0.0) {
            --to;
        }
        while (from < to && column[1 + from] == 0.0) {
            ++from;
        }
        from -= from % 8;
        for (size_t j = k + 1; j < columns; ++j) {
            mirrors->mirror(from, to, tau[k], column, A + j * rows + k);
            if (now[j] > 0.0) {
                shorten(mirrors, rows - k, A + j * rows + k, &now[j], &measured[j]);
            }
        }
    }
}

void se3di_householder_apply(size_t rows, size_t count, const double *A, const double *tau,
                             double *x)
{
    const se3di_mirrors *mirrors = find_mirrors();
    for (size_t k = count; k-- > 0;) {
        mirrors->mirror(0, rows - k - 1, tau[k], A + k * rows + k, x + k);
    }
}

void se3di_householder_apply_transposed(size_t rows, size_t count, const double *A,
                                        const double *tau, double *x)
{
    const se3di_mirrors *mirrors = find_mirrors();
    for (size_t k = 0; k < count; ++k) {
        mirrors->mirror(0, rows - k - 1, tau[k], A + k * rows + k, x + k);
    }
}
