/* SPDX-License-Identifier: BSD-3-Clause */
/* The dense reference of the KKT solver: one LU with pivoting of [H B; C -E], and the rank of C by
 * QR with column pivoting of its rows scaled to unit length.  docs/theory/kkt.md */
#include <math.h>
#include <string.h>

#include "linsol/dense.h"
#include "linsol/householder.h"
#include "linsol/kkt_internal.h"

se3d_status se3di_kkt_dense_create(se3di_kkt *kkt)
{
    size_t n = kkt->layout.unknown_count, m = kkt->layout.row_count, total = n + m;
    if (total > 40000) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    kkt->dense = se3di_kkt_take_aligned(kkt, total * total);
    kkt->dense_work = se3di_kkt_take_aligned(kkt, total);
    kkt->dense_pivot = se3di_kkt_take(kkt, total, sizeof(int32_t));
    kkt->rank_matrix = se3di_kkt_take_aligned(kkt, n * m);
    kkt->rank_tau = se3di_kkt_take_aligned(kkt, total);
    kkt->rank_pivot = se3di_kkt_take(kkt, m, sizeof(int32_t));
    kkt->rank_work = se3di_kkt_take_aligned(kkt, 2 * m);
    kkt->cost = (double)total * (double)total * (double)total / 3.0;
    return kkt->out_of_memory ? SE3D_ERR_NO_MEMORY : SE3D_OK;
}

/* A[row.., column..] = block or, turned, its transpose. */
static void put_block(double *A, size_t total, const double *block, int32_t rows, int32_t columns,
                      bool turned)
{
    for (int32_t r = 0; r < rows; ++r) {
        for (int32_t c = 0; c < columns; ++c) {
            size_t i = (size_t)(turned ? c : r), j = (size_t)(turned ? r : c);
            A[i * total + j] = block[r * columns + c];
        }
    }
}

static void put_bodies(se3di_kkt *kkt, const se3di_kkt_values *v, size_t total)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    int32_t n = p->body_size;
    size_t block = (size_t)(n * n);
    for (size_t i = 0; i < p->body_count; ++i) {
        double *A = kkt->dense + i * (size_t)n * (total + 1);
        put_block(A, total, v->body + i * block, n, n, false);
    }
    for (size_t e = 0; e < p->coupling_count; ++e) {
        size_t i = (size_t)(p->coupling[2 * e] * n), j = (size_t)(p->coupling[2 * e + 1] * n);
        const double *lower = p->symmetric ? v->coupling_upper : v->coupling_lower;
        put_block(kkt->dense + i * total + j, total, v->coupling_upper + e * block, n, n, false);
        put_block(kkt->dense + j * total + i, total, lower + e * block, n, n, p->symmetric);
    }
}

static void put_joints(se3di_kkt *kkt, const se3di_kkt_values *v, size_t total)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    const double *B = p->symmetric ? v->joint : v->joint_b;
    int32_t n = p->body_size;
    for (size_t j = 0; j < p->joint_count; ++j) {
        size_t row = kkt->layout.unknown_count + (size_t)kkt->row_offset[j];
        for (int32_t e = p->joint_begin[j]; e < p->joint_begin[j + 1]; ++e) {
            size_t column = (size_t)(p->joint_body[e] * n), at = kkt->block_offset[e];
            put_block(kkt->dense + row * total + column, total, v->joint + at, p->joint_rows[j], n,
                      false);
            put_block(kkt->dense + column * total + row, total, B + at, p->joint_rows[j], n, true);
        }
        for (size_t r = 0; r < (size_t)p->joint_rows[j]; ++r) {
            bool is_bound = p->joint_begin[j + 1] > p->joint_begin[j];
            double e = kkt->e[(size_t)kkt->row_offset[j] + r];
            kkt->dense[(row + r) * (total + 1)] = is_bound ? -e : -1.0;
        }
    }
}

/* Columns of unit length from the rows of the joints with bodies; returns how many are not zero. */
static int32_t collect_rows(se3di_kkt *kkt)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    size_t n = kkt->layout.unknown_count, total = n + kkt->layout.row_count;
    int32_t used = 0;
    for (size_t j = 0; j < p->joint_count; ++j) {
        int32_t begin = kkt->row_offset[j], end = kkt->row_offset[j + 1];
        if (p->joint_begin[j + 1] == p->joint_begin[j]) {
            end = begin;
        }
        for (int32_t r = begin; r < end; ++r) {
            const double *row = kkt->dense + (n + (size_t)r) * total;
            double *column = kkt->rank_matrix + (size_t)used * n, norm = 0.0;
            for (size_t c = 0; c < n; ++c) {
                norm += row[c] * row[c];
            }
            for (size_t c = 0; c < n && norm > 0.0; ++c) {
                column[c] = row[c] / sqrt(norm);
            }
            kkt->dependent_rows += !(norm > 0.0);
            used += norm > 0.0;
        }
    }
    return used;
}

/* Rows of C that depend on the others. */
static void find_rank(se3di_kkt *kkt)
{
    size_t n = kkt->layout.unknown_count;
    int32_t used = collect_rows(kkt);
    se3di_householder_pivoted(n, (size_t)used, kkt->rank_matrix, kkt->rank_pivot, kkt->rank_tau,
                              kkt->rank_work);
    for (int32_t k = 0; k < used; ++k) {
        size_t at = (size_t)k * (n + 1);
        double d = (size_t)k < n ? fabs(kkt->rank_matrix[at]) : 0.0;
        kkt->min_pivot = d * d < kkt->min_pivot ? d * d : kkt->min_pivot;
        if (d < 3e-7) { /* squared: 1e-13, as for the pivots of the structured kind */
            ++kkt->dependent_rows;
        } else if (d < 1e-3) {
            ++kkt->near_dependent;
            kkt->min_sigma = d * d < kkt->min_sigma ? d * d : kkt->min_sigma;
        }
    }
}

void se3di_kkt_dense_factor(se3di_kkt *kkt, const se3di_kkt_values *values)
{
    size_t total = kkt->layout.unknown_count + kkt->layout.row_count;
    memset(kkt->dense, 0, total * total * sizeof(double));
    put_bodies(kkt, values, total);
    put_joints(kkt, values, total);
    if (kkt->layout.row_count > 0) {
        find_rank(kkt);
    }
    if (total > 0) {
        kkt->finite =
            se3di_dense_lu_factor((int32_t)total, kkt->dense, kkt->dense_pivot) == SE3D_OK;
    }
}

void se3di_kkt_dense_solve(se3di_kkt *kkt, const double *b, const double *c, double *x, double *l)
{
    size_t n = kkt->layout.unknown_count, m = kkt->layout.row_count;
    double *z = kkt->dense_work;
    for (size_t i = 0; i < n; ++i) {
        z[i] = b ? b[i] : 0.0;
    }
    for (size_t j = 0; j < kkt->pattern.joint_count; ++j) {
        bool is_bound = kkt->pattern.joint_begin[j + 1] > kkt->pattern.joint_begin[j];
        for (int32_t i = kkt->row_offset[j]; i < kkt->row_offset[j + 1]; ++i) {
            z[n + (size_t)i] = c && is_bound ? c[i] : 0.0;
        }
    }
    if (n + m > 0) {
        se3di_dense_lu_solve((int32_t)(n + m), kkt->dense, kkt->dense_pivot, z);
    }
    if (n > 0) {
        memcpy(x, z, n * sizeof(double));
    }
    if (m > 0) {
        memcpy(l, z + n, m * sizeof(double));
    }
}
