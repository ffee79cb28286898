/* SPDX-License-Identifier: BSD-3-Clause */
/* Random mechanisms for the KKT solver, and an allocator that fails when asked to. */
#ifndef SE3D_TEST_LINSOL_H
#define SE3D_TEST_LINSOL_H

#include <stdlib.h>

#include "check.h"
#include "linsol/kkt.h"

/* An allocator that counts, fails once from call `fail_at` on, and knows what is out. */
typedef struct counter {
    size_t calls, fail_at;
    long bytes;
} counter;

static void *counted_alloc(void *ctx, size_t size)
{
    counter *c = ctx;
    if (++c->calls >= c->fail_at) {
        return NULL;
    }
    c->bytes += (long)size;
    return malloc(size);
}

static void *counted_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    counter *c = ctx;
    if (++c->calls >= c->fail_at) {
        return NULL;
    }
    c->bytes += (long)new_size - (long)old_size;
    return realloc(memory, new_size);
}

static void counted_free(void *ctx, void *memory, size_t size)
{
    counter *c = ctx;
    c->bytes -= (long)size;
    free(memory);
}

static counter memory_counter = {0, SIZE_MAX, 0};
static const se3d_allocator memory = {counted_alloc, counted_realloc, counted_free,
                                      &memory_counter};

/* ---- random mechanisms ---- */

enum { MAX_BODIES = 64, MAX_JOINTS = 160, MAX_ENTRIES = 400, MAX_COUPLINGS = 64 };

typedef struct mechanism {
    se3di_kkt_pattern pattern;
    int32_t rows[MAX_JOINTS], begin[MAX_JOINTS + 1], body_of[MAX_ENTRIES];
    int32_t coupling[2 * MAX_COUPLINGS];
    double body[MAX_BODIES * 64], upper[MAX_COUPLINGS * 64], lower[MAX_COUPLINGS * 64];
    double joint[MAX_ENTRIES * 64 * 8], joint_b[MAX_ENTRIES * 64 * 8];
    double b[MAX_BODIES * 8], c[MAX_JOINTS * 64], x[MAX_BODIES * 8], l[MAX_JOINTS * 64];
    double exact_x[MAX_BODIES * 8], exact_l[MAX_JOINTS * 64];
    se3di_kkt_values values;
    size_t unknowns, row_count;
    uint64_t seed;
} mechanism;

static void start(mechanism *s, size_t bodies, int32_t n, bool symmetric, uint64_t seed)
{
    memset(s, 0, sizeof *s);
    s->pattern = (se3di_kkt_pattern){.body_count = bodies,
                                     .joint_rows = s->rows,
                                     .joint_begin = s->begin,
                                     .joint_body = s->body_of,
                                     .coupling = s->coupling,
                                     .body_size = n,
                                     .symmetric = symmetric};
    s->values = (se3di_kkt_values){.body = s->body,
                                   .coupling_upper = s->upper,
                                   .coupling_lower = s->lower,
                                   .joint = s->joint,
                                   .joint_b = s->joint_b};
    s->seed = seed * UINT64_C(2654435761) + 88172645463325252;
}

static double uniform(mechanism *s)
{
    return check_random(&s->seed);
}

static void add_joint(mechanism *s, int32_t rows, int32_t i, int32_t j)
{
    size_t at = s->pattern.joint_count++;
    int32_t end = s->begin[at];
    s->rows[at] = rows;
    if (i >= 0) {
        s->body_of[end++] = i;
    }
    if (j >= 0) {
        s->body_of[end++] = j;
    }
    s->begin[at + 1] = end;
}

static void add_coupling(mechanism *s, int32_t i, int32_t j)
{
    size_t at = s->pattern.coupling_count++;
    s->coupling[2 * at] = i;
    s->coupling[2 * at + 1] = j;
}

/* Body i hangs on a body before it, or on the ground. */
static void add_tree(mechanism *s, int32_t rows)
{
    for (int32_t i = 0; i < (int32_t)s->pattern.body_count; ++i) {
        int32_t parent = (int32_t)(fabs(uniform(s)) * (double)(i + 1)) - 1;
        add_joint(s, rows > 0 ? rows : 1 + (int32_t)(fabs(uniform(s)) * 6.0), parent, i);
    }
}

static void add_chain(mechanism *s, int32_t rows)
{
    for (int32_t i = 0; i < (int32_t)s->pattern.body_count; ++i) {
        add_joint(s, rows, i - 1, i);
    }
}

/* SPD of size k, with the scales of masses and inertias. */
static void fill_definite(mechanism *s, int32_t k, int32_t n, double size, double *H)
{
    double F[64];
    for (int32_t i = 0; i < k * k; ++i) {
        F[i] = uniform(s);
    }
    for (int32_t r = 0; r < k; ++r) {
        for (int32_t c = 0; c < k; ++c) {
            double sum = r == c ? 1.0 : 0.0;
            for (int32_t i = 0; i < k; ++i) {
                sum += F[r * k + i] * F[c * k + i];
            }
            H[r * n + c] = size * sum;
        }
    }
}

/* [diag(mass), 4 G^T J G] and p, singular along p as in r-p. */
static void fill_euler(mechanism *s, double *H)
{
    double p[4], G[12], norm = 0.0, mass = 1.0 + fabs(uniform(s));
    for (int32_t i = 0; i < 4; ++i) {
        p[i] = uniform(s);
        norm += p[i] * p[i];
    }
    for (int32_t i = 0; i < 4; ++i) {
        p[i] /= sqrt(norm);
    }
    const double rows[12] = {-p[1], p[0], p[3],  -p[2], -p[2], -p[3],
                             p[0],  p[1], -p[3], p[2],  -p[1], p[0]};
    memcpy(G, rows, sizeof G);
    for (int32_t r = 0; r < 3; ++r) {
        H[r * 8 + r] = mass;
    }
    for (int32_t r = 0; r < 4; ++r) {
        H[(r + 3) * 8 + 7] = H[7 * 8 + r + 3] = p[r];
        for (int32_t c = 0; c < 4; ++c) {
            for (int32_t k = 0; k < 3; ++k) {
                H[(r + 3) * 8 + c + 3] += (0.2 + 0.1 * k) * 4.0 * G[4 * k + r] * G[4 * k + c];
            }
        }
    }
}

static void fill_bodies(mechanism *s)
{
    const int32_t n = s->pattern.body_size;
    for (size_t i = 0; i < s->pattern.body_count; ++i) {
        double *H = s->body + i * (size_t)(n * n);
        if (s->pattern.body_kind == SE3DI_KKT_BODY_MASS) {
            H[0] = H[7] = H[14] = 1.0 + fabs(uniform(s));
            fill_definite(s, 3, 6, 0.1, H + 21);
        } else if (n == 8) {
            fill_euler(s, H);
        } else {
            fill_definite(s, n, n, 1.0, H);
        }
        for (int32_t e = 0; e < n * n && !s->pattern.symmetric; ++e) {
            H[e] += 0.2 * uniform(s);
        }
    }
}

static void fill_couplings(mechanism *s)
{
    const int32_t n = s->pattern.body_size, used = n == 8 ? 7 : n;
    for (size_t e = 0; e < s->pattern.coupling_count; ++e) {
        for (int32_t r = 0; r < used; ++r) {
            for (int32_t c = 0; c < used; ++c) {
                s->upper[e * (size_t)(n * n) + (size_t)(r * n + c)] = 0.05 * uniform(s);
                s->lower[e * (size_t)(n * n) + (size_t)(r * n + c)] = 0.05 * uniform(s);
            }
        }
    }
}

static void fill_joints(mechanism *s)
{
    const int32_t n = s->pattern.body_size;
    size_t at = 0;
    for (size_t j = 0; j < s->pattern.joint_count; ++j) {
        s->row_count += (size_t)s->rows[j];
        for (int32_t e = s->begin[j] * s->rows[j]; e < s->begin[j + 1] * s->rows[j]; ++e) {
            for (int32_t c = 0; c < n; ++c, ++at) {
                int32_t r = e % s->rows[j];
                bool is_last = e / s->rows[j] == s->begin[j + 1] - 1; /* full rank on the last */
                s->joint[at] = 0.4 * uniform(s) + (is_last && (r == c || r == c + n) ? 1.0 : 0.0);
                s->joint[at] = n == 8 && c == 7 ? 0.0 : s->joint[at];
                s->joint_b[at] = s->joint[at];
                if (!s->pattern.symmetric) {
                    s->joint_b[at] += 0.05 * uniform(s);
                }
            }
        }
    }
}

/* r += [H B; C 0] (x, l), from the definition. */
static void multiply(const mechanism *s, const double *x, const double *l, double *rb, double *rc)
{
    const size_t n = (size_t)s->pattern.body_size;
    for (size_t i = 0; i < s->pattern.body_count; ++i) {
        for (size_t r = 0; r < n; ++r) {
            for (size_t c = 0; c < n; ++c) {
                double h = s->body[(i * n + r) * n + c];
                rb[i * n + r] += h * x[i * n + c];
            }
        }
    }
    for (size_t e = 0; e < s->pattern.coupling_count; ++e) {
        size_t i = (size_t)s->coupling[2 * e] * n, j = (size_t)s->coupling[2 * e + 1] * n;
        for (size_t r = 0; r < n; ++r) {
            for (size_t c = 0; c < n; ++c) {
                double low = s->pattern.symmetric ? s->upper[(e * n + c) * n + r]
                                                  : s->lower[(e * n + r) * n + c];
                rb[i + r] += s->upper[(e * n + r) * n + c] * x[j + c];
                rb[j + r] += low * x[i + c];
            }
        }
    }
    size_t at = 0, row = 0;
    for (size_t j = 0; j < s->pattern.joint_count; row += (size_t)s->rows[j++]) {
        for (int32_t e = s->begin[j]; e < s->begin[j + 1]; ++e) {
            size_t body = (size_t)s->body_of[e] * n;
            for (size_t r = 0; r < (size_t)s->rows[j]; ++r) {
                for (size_t c = 0; c < n; ++c, ++at) {
                    rc[row + r] += s->joint[at] * x[body + c];
                    rb[body + c] += s->joint_b[at] * l[row + r];
                }
            }
        }
    }
}

/* A right-hand side with a known solution. */
static void fill_right_side(mechanism *s)
{
    s->unknowns = s->pattern.body_count * (size_t)s->pattern.body_size;
    size_t row = 0;
    for (size_t i = 0; i < s->unknowns; ++i) {
        s->exact_x[i] = uniform(s);
    }
    for (size_t j = 0; j < s->pattern.joint_count; ++j) {
        for (int32_t r = 0; r < s->rows[j]; ++r) {
            s->exact_l[row++] = s->begin[j + 1] > s->begin[j] ? uniform(s) : 0.0;
        }
    }
    multiply(s, s->exact_x, s->exact_l, s->b, s->c);
}

static void fill(mechanism *s)
{
    fill_bodies(s);
    fill_couplings(s);
    fill_joints(s);
    fill_right_side(s);
}

#endif
