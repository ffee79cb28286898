/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that are light beside what they are joined to. Eliminated first, a body of 1e-12 of the
 * others' inertia fills the complement of its rows with numbers of 1e12 times those that hold the
 * others, and what it carries from one of these to the other is lost in their rounding. With s H
 * in place of the H of such a body (s: until no row has more than 1e4 times as much of it as of
 * another body) the factors are good, and refinement with the true H does the rest: it gains the
 * ratio of the inertia that was added to that of the motion, if the body is held by heavier ones.
 * If it moves by itself that ratio is 1, and the true H is factored after all.
 * docs/theory/kkt.md */
#include "linsol/kkt_internal.h"

#include <math.h>
#include <string.h>

#define RANGE 1e4  /* of the parts that bodies have in the weight of a row */
#define SAME  1.01 /* less is no more of a raise */
#define LIGHT 1e3  /* and of their mobilities, below which no row has more, but for its levers */

/* The part of the body of entry `e` in the weight of row r of joint j. */
static double part_of(const se3di_kkt *kkt, const se3di_kkt_values *v, int32_t e, size_t r)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    const size_t n = (size_t)p->body_size, at = kkt->block_offset[e] + r * n;
    const double *C = v->joint + at, *B = (p->symmetric ? v->joint : v->joint_b) + at;
    const double *mobility = kkt->mobility + (size_t)p->joint_body[e] * KKT_LANES;
    double sum = 0.0;
    for (size_t c = 0; c < n; ++c) {
        sum += fabs(C[c] * B[c]) * mobility[c];
    }
    return sum;
}

/* `factor` of the bodies of a row, which is raised to what the row asks for: whether it was. */
static bool raise_by_row(const se3di_kkt *kkt, const se3di_kkt_values *v, size_t j, size_t r,
                         double *factor)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    double least = HUGE_VAL; /* of the bodies as they are by now */
    bool raises = false;
    for (int32_t e = p->joint_begin[j]; e < p->joint_begin[j + 1]; ++e) {
        const double part = part_of(kkt, v, e, r) / factor[p->joint_body[e]];
        least = part > 0.0 && part < least ? part : least;
    }
    for (int32_t e = p->joint_begin[j]; e < p->joint_begin[j + 1]; ++e) {
        const double wanted = part_of(kkt, v, e, r) / RANGE;
        double *own = &factor[p->joint_body[e]];
        if (wanted > least * *own) {
            raises = raises || wanted > SAME * least * *own;
            *own = wanted / least;
        }
    }
    return raises;
}

/* All rows, whatever their order: a light body is beside others that are. */
static void raise_all(const se3di_kkt *kkt, const se3di_kkt_values *values, double *factor)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    bool raises = true;
    for (size_t pass = 0; raises && pass <= p->body_count; ++pass) {
        raises = false;
        for (size_t j = 0; j < p->joint_count; ++j) {
            for (int32_t r = 0; r < p->joint_rows[j]; ++r) {
                raises = raise_by_row(kkt, values, j, (size_t)r, factor) || raises;
            }
        }
    }
}

bool se3di_kkt_has_light(const se3di_kkt *kkt)
{
    const size_t bodies = kkt->pattern.body_count;
    for (size_t c = 0; c < 6 && c < (size_t)kkt->pattern.body_size; ++c) {
        double least = HUGE_VAL, most = 0.0;
        for (size_t i = 0; i < bodies; ++i) {
            const double mobility = kkt->mobility[i * KKT_LANES + c];
            least = mobility > 0.0 && mobility < least ? mobility : least;
            most = mobility > most ? mobility : most;
        }
        if (most > LIGHT * least) {
            return true;
        }
    }
    return false;
}

bool se3di_kkt_raise(se3di_kkt *kkt, const se3di_kkt_values *values, se3di_kkt_values *raised)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    const int32_t n = p->body_size, inertias = n == 8 ? 7 : n; /* not |p| = 1 */
    double *factor = kkt->raise;
    bool any = false;
    for (size_t i = 0; i < p->body_count; ++i) {
        factor[i] = 1.0;
    }
    raise_all(kkt, values, factor);
    for (size_t i = 0; i < p->body_count; ++i) {
        const size_t at = i * (size_t)(n * n);
        any = any || factor[i] > 1.0;
        for (int32_t k = 0; k < n * n; ++k) {
            const bool scales = k / n < inertias && k % n < inertias;
            kkt->raised[at + (size_t)k] = values->body[at + (size_t)k] * (scales ? factor[i] : 1.0);
        }
    }
    *raised = *values;
    raised->body = kkt->raised;
    return any && isfinite(factor[0]);
}
