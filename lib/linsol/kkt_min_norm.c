/* SPDX-License-Identifier: BSD-3-Clause */
/* Multipliers of least norm from B l = b - H x, densely. The equations of each unknown are scaled
 * by H_cc^-1/2, which changes nothing if they are consistent.                docs/theory/kkt.md */
#include <math.h>
#include <string.h>

#include "linsol/kkt_internal.h"
#include "linsol/rank.h"

static void fill_matrix(const se3di_kkt *kkt, const double *B, double *A)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    size_t n = (size_t)p->body_size;
    for (size_t j = 0; j < p->joint_count; ++j) {
        for (int32_t e = p->joint_begin[j]; e < p->joint_begin[j + 1]; ++e) {
            size_t body = (size_t)p->joint_body[e];
            for (size_t r = 0; r < (size_t)p->joint_rows[j]; ++r) {
                const double *from = B + kkt->block_offset[e] + r * n;
                double *to = A + ((size_t)kkt->row_offset[j] + r) * kkt->layout.unknown_count;
                for (size_t c = 0; c < n; ++c) {
                    to[body * n + c] = from[c] * sqrt(kkt->mobility[body * KKT_LANES + c]);
                }
            }
        }
    }
}

se3d_status se3di_kkt_min_norm(se3di_kkt *kkt, const se3di_kkt_values *values, const double *b,
                               const double *x, double tolerance, double *l, int32_t *rank)
{
    size_t unknowns = kkt->layout.unknown_count, rows = kkt->layout.row_count;
    size_t n = (size_t)kkt->pattern.body_size;
    double *A = se3di_alloc(&kkt->allocator, unknowns * rows, sizeof(double));
    if (!A) {
        return SE3D_ERR_NO_MEMORY;
    }
    kkt->core->weigh(kkt, values);
    memset(kkt->correction_l, 0, rows * sizeof(double));
    kkt->core->residual(kkt, values, b, NULL, x, kkt->correction_l);
    for (size_t i = 0; i < unknowns; ++i) {
        kkt->residual_b[i] *= sqrt(kkt->mobility[i / n * KKT_LANES + i % n]);
    }
    fill_matrix(kkt, kkt->pattern.symmetric ? values->joint : values->joint_b, A);
    se3d_status status = se3di_rank_least_norm(&kkt->allocator, (int32_t)unknowns, (int32_t)rows, A,
                                               kkt->residual_b, tolerance, l, rank);
    se3di_free(&kkt->allocator, A, unknowns * rows, sizeof(double));
    return status;
}
