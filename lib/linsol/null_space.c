/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/null_space.h"

#include "base/error.h"
#include "linsol/householder.h"

#include <math.h>
#include <string.h>

#define PIVOT_SHARE 0.5 /* of the largest, for a pivot of fewer bodies */

/* A velocity of the bodies [first, first + count), of unit length. */
typedef struct freedom {
    double *x; /* [6 capacity]; of capacity 1 in the pool */
    size_t first, count, capacity;
} freedom;

typedef struct search {
    const se3d_allocator *allocator;
    const se3di_null_space_pattern *pattern;
    const double *C;
    freedom *freedoms; /* [6 bodies], the first `live` are left */
    double *pool;      /* [36 bodies] */
    size_t live;
    size_t *touched;    /* [6 bodies] freedoms of the present joint, */
    size_t touch_count; /* how many are left of them */
    size_t rows_max;
    double
        *G; /* [6 bodies * rows_max]: row r of the joint by touched freedom t at t rows_max + r */
    double *length; /* [rows_max] of the rows of the joint, -1: done */
} search;

static void release(search *s)
{
    size_t n = 6 * s->pattern->body_count;
    for (size_t k = 0; s->freedoms && k < n; ++k) {
        if (s->freedoms[k].capacity > 1) {
            se3di_free(s->allocator, s->freedoms[k].x, 6 * s->freedoms[k].capacity, sizeof(double));
        }
    }
    se3di_free(s->allocator, s->freedoms, n, sizeof *s->freedoms);
    se3di_free(s->allocator, s->pool, 6 * n, sizeof *s->pool);
    se3di_free(s->allocator, s->touched, n, sizeof *s->touched);
    se3di_free(s->allocator, s->G, n * s->rows_max, sizeof *s->G);
    se3di_free(s->allocator, s->length, s->rows_max, sizeof *s->length);
}

/* Every body is free. */
static se3d_status begin(search *s)
{
    size_t n = 6 * s->pattern->body_count;
    for (size_t k = 0; k < s->pattern->joint_count; ++k) {
        size_t rows = (size_t)s->pattern->joint_rows[k];
        s->rows_max = rows > s->rows_max ? rows : s->rows_max;
    }
    s->freedoms = se3di_alloc(s->allocator, n, sizeof *s->freedoms);
    s->pool = se3di_alloc(s->allocator, 6 * n, sizeof *s->pool);
    s->touched = se3di_alloc(s->allocator, n, sizeof *s->touched);
    s->G = se3di_alloc(s->allocator, n * s->rows_max, sizeof *s->G);
    s->length = se3di_alloc(s->allocator, s->rows_max, sizeof *s->length);
    if (s->freedoms) {
        memset(s->freedoms, 0, n * sizeof *s->freedoms);
    }
    if (!s->freedoms || !s->pool || !s->touched || !s->G || !s->length) {
        return SE3D_ERR_NO_MEMORY;
    }
    memset(s->pool, 0, 6 * n * sizeof *s->pool);
    for (size_t k = 0; k < n; ++k) {
        s->freedoms[k] = (freedom){s->pool + 6 * k, k / 6, 1, 1};
        s->freedoms[k].x[k % 6] = 1.0;
    }
    s->live = n;
    return SE3D_OK;
}

/* Let the freedom reach over [first, end) too. */
static se3d_status widen(const se3d_allocator *allocator, freedom *z, size_t first, size_t end)
{
    size_t old_end = z->first + z->count;
    first = first < z->first ? first : z->first;
    end = end > old_end ? end : old_end;
    size_t count = end - first;
    size_t shift = 6 * (z->first - first);
    if (count > z->capacity) {
        size_t capacity = count + count / 2 + 4;
        double *x = se3di_alloc(allocator, 6 * capacity, sizeof *x);
        if (!x) {
            return SE3D_ERR_NO_MEMORY;
        }
        memcpy(x + shift, z->x, 6 * z->count * sizeof *x);
        if (z->capacity > 1) {
            se3di_free(allocator, z->x, 6 * z->capacity, sizeof *x);
        }
        z->x = x;
        z->capacity = capacity;
    } else if (shift > 0) {
        memmove(z->x + shift, z->x, 6 * z->count * sizeof *z->x);
    }
    memset(z->x, 0, shift * sizeof *z->x);
    memset(z->x + shift + 6 * z->count, 0, 6 * (end - old_end) * sizeof *z->x);
    z->first = first;
    z->count = count;
    return SE3D_OK;
}

/* What a joint's rows are along a freedom. Returns whether any is not zero. */
static int eval_rows(const search *s, size_t joint, const freedom *z, double *g)
{
    const se3di_null_space_pattern *p = s->pattern;
    size_t rows = (size_t)p->joint_rows[joint];
    int any = 0;
    memset(g, 0, rows * sizeof *g);
    for (int32_t b = p->joint_begin[joint]; b < p->joint_begin[joint + 1]; ++b) {
        size_t body = (size_t)p->joint_body[b];
        if (body < z->first || body >= z->first + z->count) {
            continue;
        }
        const double *x = z->x + 6 * (body - z->first);
        const double *block = s->C + p->block_offset[b];
        for (size_t r = 0; r < rows; ++r) {
            for (size_t c = 0; c < 6; ++c) {
                g[r] += block[6 * r + c] * x[c];
            }
            any |= fabs(g[r]) > 0.0;
        }
    }
    return any;
}

static se3d_status measure_rows(const search *s, size_t joint)
{
    const se3di_null_space_pattern *p = s->pattern;
    for (size_t r = 0; r < (size_t)p->joint_rows[joint]; ++r) {
        double sum = 0.0;
        for (int32_t b = p->joint_begin[joint]; b < p->joint_begin[joint + 1]; ++b) {
            const double *row = s->C + p->block_offset[b] + 6 * r;
            for (size_t c = 0; c < 6; ++c) {
                sum += row[c] * row[c];
            }
        }
        if (!isfinite(sum)) {
            return SE3D_ERR_NOT_FINITE;
        }
        s->length[r] = sqrt(sum);
    }
    return SE3D_OK;
}

static void find_touched(search *s, size_t joint)
{
    s->touch_count = 0;
    for (size_t k = 0; k < s->live; ++k) {
        if (eval_rows(s, joint, &s->freedoms[k], s->G + s->touch_count * s->rows_max)) {
            s->touched[s->touch_count++] = k;
        }
    }
}

/* The row and the touched freedom to give up; returns 0 if the rows left are dependent. */
static int find_pivot(const search *s, size_t rows, double tolerance, size_t *row, size_t *pivot)
{
    double best = 0.0;
    size_t fewest = SIZE_MAX;
    for (int pass = 0; pass < 2; ++pass) { /* the largest, then the shortest of the large */
        for (size_t t = 0; t < s->touch_count; ++t) {
            size_t count = s->freedoms[s->touched[t]].count;
            for (size_t r = 0; r < rows; ++r) {
                double size =
                    s->length[r] > 0.0 ? fabs(s->G[t * s->rows_max + r]) / s->length[r] : 0.0;
                if (pass == 0) {
                    best = fmax(best, size);
                } else if (size >= PIVOT_SHARE * best && count < fewest) {
                    fewest = count;
                    *row = r;
                    *pivot = t;
                }
            }
        }
        if (!(best > tolerance)) {
            return 0;
        }
    }
    return 1;
}

/* Give up touched freedom `pivot` for `row`: no other has a part in the row then. */
static se3d_status eliminate(search *s, size_t rows, size_t row, size_t pivot)
{
    const double *gp = s->G + pivot * s->rows_max;
    const freedom *p = &s->freedoms[s->touched[pivot]];
    for (size_t t = 0; t < s->touch_count; ++t) {
        double *g = s->G + t * s->rows_max;
        double factor = g[row] / gp[row];
        if (t == pivot || !(fabs(factor) > 0.0)) {
            continue;
        }
        freedom *z = &s->freedoms[s->touched[t]];
        SE3DI_TRY(widen(s->allocator, z, p->first, p->first + p->count));
        double *x = z->x + 6 * (p->first - z->first);
        for (size_t k = 0; k < 6 * p->count; ++k) {
            x[k] -= factor * p->x[k];
        }
        for (size_t r = 0; r < rows; ++r) {
            g[r] -= factor * gp[r];
        }
    }
    return SE3D_OK;
}

/* The pivot leaves: the last live freedom and the last touched one take its places. */
static void drop(search *s, size_t pivot)
{
    size_t gone = s->touched[pivot];
    size_t last = --s->live;
    freedom kept = s->freedoms[gone];
    s->freedoms[gone] = s->freedoms[last];
    s->freedoms[last] = kept; /* for release */
    --s->touch_count;
    for (size_t t = 0; t <= s->touch_count; ++t) {
        s->touched[t] = s->touched[t] == last ? gone : s->touched[t];
    }
    s->touched[pivot] = s->touched[s->touch_count];
    memcpy(s->G + pivot * s->rows_max, s->G + s->touch_count * s->rows_max,
           s->rows_max * sizeof *s->G);
}

static se3d_status normalise(const search *s)
{
    for (size_t t = 0; t < s->touch_count; ++t) {
        freedom *z = &s->freedoms[s->touched[t]];
        double sum = 0.0;
        for (size_t k = 0; k < 6 * z->count; ++k) {
            sum += z->x[k] * z->x[k];
        }
        if (!isfinite(sum)) {
            return SE3D_ERR_NOT_FINITE;
        }
        double scale = sum > 0.0 ? 1.0 / sqrt(sum) : 1.0;
        for (size_t k = 0; k < 6 * z->count; ++k) {
            z->x[k] *= scale;
        }
    }
    return SE3D_OK;
}

/* What the freedoms left have of each row, relative to its length; -1: one was given up for it. */
static void note_rest(const search *s, size_t rows, double *rest)
{
    for (size_t r = 0; r < rows; ++r) {
        rest[r] = s->length[r] < 0.0 ? -1.0 : 0.0;
        for (size_t t = 0; t < s->touch_count && s->length[r] > 0.0; ++t) {
            rest[r] = fmax(rest[r], fabs(s->G[t * s->rows_max + r]) / s->length[r]);
        }
    }
}

static se3d_status apply_joint(search *s, size_t joint, double tolerance, int32_t *dependent,
                               double *rest)
{
    size_t rows = (size_t)s->pattern->joint_rows[joint];
    size_t row = 0;
    size_t pivot = 0;
    size_t done = 0;
    SE3DI_TRY(measure_rows(s, joint));
    find_touched(s, joint);
    for (; done < rows && find_pivot(s, rows, tolerance, &row, &pivot); ++done) {
        SE3DI_TRY(eliminate(s, rows, row, pivot));
        s->length[row] = -1.0;
        drop(s, pivot);
    }
    if (rest) {
        note_rest(s, rows, rest);
    }
    *dependent += (int32_t)(rows - done);
    return normalise(s);
}

static se3d_status write_basis(const search *s, double **Z)
{
    size_t n = 6 * s->pattern->body_count;
    if (s->live == 0) {
        return SE3D_OK;
    }
    *Z = se3di_alloc(s->allocator, s->live * n, sizeof **Z);
    if (!*Z) {
        return SE3D_ERR_NO_MEMORY;
    }
    memset(*Z, 0, s->live * n * sizeof **Z);
    for (size_t k = 0; k < s->live; ++k) {
        const freedom *z = &s->freedoms[k];
        memcpy(*Z + k * n + 6 * z->first, z->x, 6 * z->count * sizeof **Z);
    }
    return SE3D_OK;
}

se3d_status se3di_null_space_find(const se3d_allocator *allocator,
                                  const se3di_null_space_pattern *pattern, const double *C,
                                  double tolerance, double **Z, int32_t *freedoms,
                                  int32_t *dependent, double *rest)
{
    search s = {.allocator = allocator, .pattern = pattern, .C = C, .rows_max = 1};
    *Z = NULL;
    *freedoms = *dependent = 0;
    se3d_status status = begin(&s);
    for (size_t k = 0; k < pattern->joint_count && status >= 0; ++k) {
        status = apply_joint(&s, k, tolerance, dependent, rest);
        rest = rest ? rest + pattern->joint_rows[k] : NULL;
    }
    if (status >= 0) {
        status = write_basis(&s, Z);
        *freedoms = (int32_t)s.live;
    }
    release(&s);
    return status;
}

se3d_status se3di_null_space_orthonormalise(const se3d_allocator *allocator, int32_t freedoms,
                                            int32_t n, double *Z)
{
    size_t columns = (size_t)freedoms, rows = (size_t)n;
    if (freedoms == 0) {
        return SE3D_OK;
    }
    double *Q = se3di_alloc(allocator, (rows + 1) * columns, sizeof *Q);
    if (!Q) {
        return SE3D_ERR_NO_MEMORY;
    }
    double *tau = Q + rows * columns; /* column by column Z is n x freedoms, Z = Q R */
    memcpy(Q, Z, rows * columns * sizeof *Q);
    se3di_householder(rows, columns, Q, tau);
    memset(Z, 0, rows * columns * sizeof *Z);
    for (size_t k = 0; k < columns; ++k) {
        Z[k * rows + k] = 1.0;
        se3di_householder_apply(rows, columns, Q, tau, Z + k * rows);
    }
    se3di_free(allocator, Q, (rows + 1) * columns, sizeof *Q);
    return SE3D_OK;
}
