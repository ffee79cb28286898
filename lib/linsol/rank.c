/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/rank.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/error.h"
#include "linsol/householder.h"

static const double negligible = 1e-9; /* factors of a combination, relative to the largest */

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* ---- QR with column pivoting of C^T ---- */

typedef se3di_pivoted_qr pivoted_qr;

static void qr_destroy(const se3d_allocator *allocator, pivoted_qr *qr)
{
    size_t least = qr->rows < qr->columns ? qr->rows : qr->columns;
    se3di_free(allocator, qr->A, qr->rows * qr->columns, sizeof(double));
    se3di_free(allocator, qr->tau, least, sizeof(double));
    se3di_free(allocator, qr->scale, qr->rows, sizeof(double));
    se3di_free(allocator, qr->pivot, qr->rows, sizeof(int32_t));
    se3di_free(allocator, qr->work, 2 * qr->rows, sizeof(double));
    *qr = (pivoted_qr){0};
}

static se3d_status qr_create(const se3d_allocator *allocator, size_t rows, size_t columns,
                             pivoted_qr *qr)
{
    size_t least = rows < columns ? rows : columns;
    *qr = (pivoted_qr){.rows = rows, .columns = columns};
    qr->A = se3di_alloc(allocator, rows * columns, sizeof(double));
    qr->tau = se3di_alloc(allocator, least, sizeof(double));
    qr->scale = se3di_alloc(allocator, rows, sizeof(double));
    qr->pivot = se3di_alloc(allocator, rows, sizeof(int32_t));
    qr->work = se3di_alloc(allocator, 2 * rows, sizeof(double));
    if (!qr->A || !qr->tau || !qr->scale || !qr->pivot || !qr->work) {
        qr_destroy(allocator, qr);
        return SE3D_ERR_NO_MEMORY;
    }
    return SE3D_OK;
}

/* Scale the columns of A to unit length, factor; SE3D_ERR_NOT_FINITE if they are not finite. */
static se3d_status qr_factor(pivoted_qr *qr)
{
    for (size_t r = 0; r < qr->rows; ++r) {
        double *column = qr->A + r * qr->columns;
        double length = sqrt(dot(column, column, qr->columns));
        if (!isfinite(length)) {
            return SE3D_ERR_NOT_FINITE;
        }
        qr->scale[r] = length > 0.0 ? 1.0 / length : 1.0;
        for (size_t c = 0; c < qr->columns; ++c) {
            column[c] *= qr->scale[r];
        }
    }
    se3di_householder_pivoted(qr->columns, qr->rows, qr->A, qr->pivot, qr->tau, qr->work);
    return SE3D_OK;
}

static int32_t qr_rank(const pivoted_qr *qr, double tolerance, double *gap_low, double *gap_high)
{
    size_t least = qr->rows < qr->columns ? qr->rows : qr->columns, rank = 0;
    *gap_low = 1.0;
    *gap_high = 0.0;
    for (; rank < least; ++rank) {
        double d = fabs(qr->A[rank * (qr->columns + 1)]);
        if (!(d > tolerance)) {
            *gap_high = d;
            break;
        }
        *gap_low = d;
    }
    return (int32_t)rank;
}

/* ---- rows in order ---- */

typedef struct selection {
    const double *C;
    size_t columns;
    double *Q; /* rank x columns, orthonormal */
    double *R; /* [rows] for each accepted row, packed: C_i = sum_k R_ik Q_k */
    double *v;
    int32_t *accepted;
    size_t count;
} selection;

/* v = the part of row `r` that is orthogonal to Q, twice for accuracy; coefficients into R. Returns
 * its length relative to the row's. */
static double orthogonalise(const selection *s, size_t r, double *R)
{
    const double *row = s->C + r * s->columns;
    double length = sqrt(dot(row, row, s->columns));
    memcpy(s->v, row, s->columns * sizeof(double));
    memset(R, 0, (s->count + 1) * sizeof(double));
    for (int pass = 0; pass < 2; ++pass) {
        for (size_t k = 0; k < s->count; ++k) {
            const double *q = s->Q + k * s->columns;
            double f = dot(s->v, q, s->columns);
            R[k] += f;
            if (f == 0.0) {
                continue; /* rows without a body in common */
            }
            for (size_t c = 0; c < s->columns; ++c) {
                s->v[c] -= f * q[c];
            }
        }
    }
    R[s->count] = sqrt(dot(s->v, s->v, s->columns));
    return length > 0.0 ? R[s->count] / length : 0.0;
}

static double *row_of_r(const selection *s, size_t k)
{
    return s->R + k * (k + 1) / 2;
}

/* Accept rows in order above `threshold`. Returns how many; *least and *most are the smallest
 * accepted and the largest rejected relative length. At most `limit` rows. */
static size_t select_rows(selection *s, size_t rows, size_t limit, double threshold, double *least,
                          double *most)
{
    s->count = 0;
    *least = 1.0;
    *most = 0.0;
    for (size_t r = 0; r < rows; ++r) {
        double *R = row_of_r(s, s->count);
        double relative = orthogonalise(s, r, R);
        if (!(relative > threshold)) {
            *most = relative > *most ? relative : *most;
            continue;
        }
        *least = relative < *least ? relative : *least;
        if (s->count == limit) {
            return limit + 1;
        }
        for (size_t c = 0; c < s->columns; ++c) {
            s->Q[s->count * s->columns + c] = s->v[c] / R[s->count];
        }
        s->accepted[s->count++] = (int32_t)r;
    }
    return s->count;
}

/* Find a threshold at which exactly `rank` rows are accepted; fewer if there is none. */
static size_t select_rank(selection *s, size_t rows, size_t rank, double tolerance)
{
    double threshold = tolerance, least, most;
    size_t count = select_rows(s, rows, rank, threshold, &least, &most);
    for (int attempt = 0; attempt < 8 && count != rank; ++attempt) {
        threshold = count > rank ? least : 0.5 * most;
        count = select_rows(s, rows, rank, threshold, &least, &most);
    }
    return s->count;
}

/* Factors of a row with coefficients R[0 .. count): solve sum_i f_i R_ik = R_k. In place. */
static void solve_factors(const selection *s, size_t count, double *f)
{
    for (size_t i = count; i-- > 0;) {
        const double *R = row_of_r(s, i);
        f[i] /= R[i];
        for (size_t k = 0; k < i; ++k) {
            f[k] -= f[i] * R[k];
        }
    }
}

static se3d_status add_combination(const se3d_allocator *allocator, const selection *s,
                                   size_t count, const double *f, se3di_rank *result)
{
    size_t used = (size_t)result->combination_begin[result->redundant_count];
    double top = 0.0;
    size_t capacity = result->combination_capacity;
    void *rows = result->combination_row, *factors = result->combination;
    SE3DI_TRY(se3di_array_reserve(allocator, &rows, &capacity, used + count, sizeof(int32_t)));
    result->combination_row = rows;
    size_t same = result->combination_capacity;
    se3d_status status = se3di_array_reserve(allocator, &factors, &same, capacity, sizeof(double));
    result->combination = factors;
    if (status < 0) { /* give the first array its old size on record */
        se3di_free(allocator, result->combination_row, capacity, sizeof(int32_t));
        result->combination_row = NULL;
        return status;
    }
    if (same != capacity) { /* both grow by the same rule */
        return SE3D_ERR_NO_MEMORY;
    }
    result->combination_capacity = capacity;
    for (size_t i = 0; i < count; ++i) {
        top = fabs(f[i]) > top ? fabs(f[i]) : top;
    }
    for (size_t i = 0; i < count; ++i) {
        if (fabs(f[i]) > negligible * top) {
            result->combination_row[used] = s->accepted[i];
            result->combination[used++] = f[i];
        }
    }
    result->combination_begin[result->redundant_count + 1] = (int32_t)used;
    return SE3D_OK;
}

/* Every row that was not accepted: its combination of the accepted rows before it. */
static se3d_status name_redundant(const se3d_allocator *allocator, selection *s, size_t rows,
                                  double *f, se3di_rank *result)
{
    size_t total = s->count, next = 0;
    for (size_t r = 0; r < rows; ++r) {
        if (next < total && s->accepted[next] == (int32_t)r) {
            ++next;
            continue;
        }
        s->count = next;
        (void)orthogonalise(s, r, f);
        solve_factors(s, next, f);
        s->count = total;
        SE3DI_TRY(add_combination(allocator, s, next, f, result));
        result->redundant[result->redundant_count++] = (int32_t)r;
    }
    return SE3D_OK;
}

/* ---- freedoms ---- */

/* The last columns of the full Q span the null space of C. */
static void write_freedoms(const pivoted_qr *qr, int32_t reflectors, se3di_rank *result)
{
    size_t n = qr->columns, rank = (size_t)reflectors;
    for (size_t k = 0; k < (size_t)result->freedom_count; ++k) {
        result->freedom[k * n + rank + k] = 1.0;
        se3di_householder_apply(n, rank, qr->A, qr->tau, result->freedom + k * n);
    }
}

void se3di_rank_destroy(const se3d_allocator *allocator, se3di_rank *result)
{
    size_t rows = (size_t)result->row_count, columns = (size_t)result->column_count;
    se3di_free(allocator, result->independent, rows, sizeof(int32_t));
    se3di_free(allocator, result->redundant, rows, sizeof(int32_t));
    se3di_free(allocator, result->combination_begin, rows + 1, sizeof(int32_t));
    se3di_free(allocator, result->combination_row, result->combination_capacity, sizeof(int32_t));
    se3di_free(allocator, result->combination, result->combination_capacity, sizeof(double));
    se3di_free(allocator, result->freedom, (size_t)result->freedom_count * columns, sizeof(double));
    *result = (se3di_rank){0};
}

static se3d_status select_and_name(const se3d_allocator *allocator, const double *C,
                                   double tolerance, se3di_rank *result)
{
    size_t rows = (size_t)result->row_count, n = (size_t)result->column_count;
    size_t rank = (size_t)result->rank, packed = (rank + 1) * (rank + 2) / 2;
    double *Q = se3di_alloc(allocator, rank * n, sizeof(double));
    double *R = se3di_alloc(allocator, packed, sizeof(double));
    double *v = se3di_alloc(allocator, n + rows + 1, sizeof(double));
    se3d_status status = SE3D_ERR_NO_MEMORY;
    if (Q && R && v) {
        selection s = {.C = C, .columns = n, .Q = Q, .R = R, .v = v};
        s.accepted = result->independent;
        result->rank = (int32_t)select_rank(&s, rows, rank, tolerance);
        status = name_redundant(allocator, &s, rows, v + n, result);
    }
    se3di_free(allocator, Q, rank * n, sizeof(double));
    se3di_free(allocator, R, packed, sizeof(double));
    se3di_free(allocator, v, n + rows + 1, sizeof(double));
    return status;
}

/* All rows are independent. */
static void accept_all(se3di_rank *result)
{
    for (int32_t r = 0; r < result->row_count; ++r) {
        result->independent[r] = r;
    }
    memset(result->combination_begin, 0, ((size_t)result->row_count + 1) * sizeof(int32_t));
}

static se3d_status analyse(const se3d_allocator *allocator, const double *C, double tolerance,
                           pivoted_qr *qr, se3di_rank *result)
{
    size_t rows = qr->rows, n = qr->columns;
    if (rows * n > 0) {
        memcpy(qr->A, C, rows * n * sizeof(double));
    }
    SE3DI_TRY(qr_factor(qr));
    int32_t rank = qr_rank(qr, tolerance, &result->gap_low, &result->gap_high);
    result->rank = rank;
    result->independent = se3di_alloc(allocator, rows, sizeof(int32_t));
    result->redundant = se3di_alloc(allocator, rows, sizeof(int32_t));
    result->combination_begin = se3di_alloc(allocator, rows + 1, sizeof(int32_t));
    if (!result->independent || !result->redundant || !result->combination_begin) {
        return SE3D_ERR_NO_MEMORY;
    }
    if ((size_t)rank == rows) {
        accept_all(result);
    } else {
        SE3DI_TRY(select_and_name(allocator, C, tolerance, result));
    }
    int32_t freedoms = result->column_count - rank;
    result->freedom = se3di_alloc(allocator, (size_t)freedoms * n, sizeof(double));
    if (!result->freedom) {
        return SE3D_ERR_NO_MEMORY;
    }
    result->freedom_count = freedoms;
    write_freedoms(qr, rank, result);
    return result->redundant_count > 0 ? SE3D_INFO_REDUNDANT : SE3D_OK;
}

se3d_status se3di_rank_analyse(const se3d_allocator *allocator, int32_t rows, int32_t columns,
                               const double *C, double tolerance, se3di_rank *result)
{
    pivoted_qr qr;
    *result = (se3di_rank){.row_count = rows, .column_count = columns};
    se3d_status status = qr_create(allocator, (size_t)rows, (size_t)columns, &qr);
    if (status == SE3D_OK) {
        status = analyse(allocator, C, tolerance, &qr, result);
        qr_destroy(allocator, &qr);
    }
    if (status < 0) {
        se3di_rank_destroy(allocator, result);
    }
    return status;
}

/* ---- least norm ---- */

void se3di_least_norm_destroy(const se3d_allocator *allocator, se3di_least_norm *f)
{
    se3di_free(allocator, f->T, f->qr.rows * (size_t)f->rank, sizeof(double));
    se3di_free(allocator, f->tau, (size_t)f->rank, sizeof(double));
    qr_destroy(allocator, &f->qr);
    *f = (se3di_least_norm){0};
}

/* T = (R1 P^T D^-1)^T, columns x r, of full rank; T = Q2 R2. */
static se3d_status factor_again(const se3d_allocator *allocator, se3di_least_norm *f)
{
    const pivoted_qr *qr = &f->qr;
    const size_t n = qr->rows, r1 = (size_t)f->rank;
    f->T = se3di_alloc(allocator, n * r1, sizeof(double));
    f->tau = se3di_alloc(allocator, r1, sizeof(double));
    if (!f->T || !f->tau) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t k = 0; k < n; ++k) {
        size_t column = (size_t)qr->pivot[k];
        for (size_t r = 0; r < r1; ++r) {
            f->T[r * n + column] = r <= k ? qr->A[k * qr->columns + r] / qr->scale[column] : 0.0;
        }
    }
    se3di_householder(n, r1, f->T, f->tau);
    return SE3D_OK;
}

se3d_status se3di_least_norm_factor(const se3d_allocator *allocator, int32_t rows, int32_t columns,
                                    const double *A, double tolerance, se3di_least_norm *f)
{
    const size_t n = (size_t)columns, m = (size_t)rows;
    double low, high;
    *f = (se3di_least_norm){0};
    SE3DI_TRY(qr_create(allocator, n, m, &f->qr));
    if (n * m > 0) {
        memcpy(f->qr.A, A, n * m * sizeof(double));
    }
    se3d_status status = qr_factor(&f->qr);
    f->rank = status < 0 ? 0 : qr_rank(&f->qr, tolerance, &low, &high);
    if (status >= 0 && f->rank > 0 && f->rank < columns) {
        status = factor_again(allocator, f);
    }
    if (status < 0) {
        se3di_least_norm_destroy(allocator, f);
    }
    return status;
}

/* R P^T D^-1 l = g of full rank: the solution is unique. */
static void solve_unique(const pivoted_qr *qr, double *g, double *l)
{
    for (size_t k = qr->rows; k-- > 0;) {
        const double *column = qr->A + k * qr->columns;
        const size_t at = (size_t)qr->pivot[k];
        g[k] /= column[k];
        for (size_t r = 0; r < k; ++r) {
            g[r] -= column[r] * g[k];
        }
        l[at] = qr->scale[at] * g[k];
    }
}

void se3di_least_norm_solve(const se3di_least_norm *f, double *g, double *l)
{
    const pivoted_qr *qr = &f->qr;
    const size_t n = qr->rows, r1 = (size_t)f->rank;
    const size_t least = n < qr->columns ? n : qr->columns;
    memset(l, 0, n * sizeof(double));
    if (r1 == 0) {
        return;
    }
    se3di_householder_apply_transposed(qr->columns, least, qr->A, qr->tau, g);
    if (!f->T) {
        solve_unique(qr, g, l);
        return;
    }
    for (size_t r = 0; r < r1; ++r) { /* R2^T l = g */
        l[r] = (g[r] - dot(f->T + r * n, l, r)) / f->T[r * n + r];
    }
    se3di_householder_apply(n, r1, f->T, f->tau, l);
}

se3d_status se3di_rank_least_norm(const se3d_allocator *allocator, int32_t rows, int32_t columns,
                                  double *A, double *g, double tolerance, double *l, int32_t *rank)
{
    se3di_least_norm f;
    memset(l, 0, (size_t)columns * sizeof(double));
    const se3d_status status = se3di_least_norm_factor(allocator, rows, columns, A, tolerance, &f);
    if (status >= 0) {
        se3di_least_norm_solve(&f, g, l);
    }
    if (rank) {
        *rank = f.rank;
    }
    se3di_least_norm_destroy(allocator, &f);
    return status;
}
