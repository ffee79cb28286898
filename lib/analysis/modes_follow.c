/* SPDX-License-Identifier: BSD-3-Clause */
/* With P(s) = s^2 M + s D + K of a model, P(s) x = 0 and w^H P(s) = 0, and Mh, Dh, Kh of another
 * one whose data differ by h, s(h) is the root next to s of
 *
 *     w^H (s(h)^2 Mh + s(h) Dh + Kh) x = 0
 *
 * where w and x are the vectors of the first model, taken over to the freedoms of the second one:
 * Zh Z^T x, as the rows of Z are orthonormal. Their own change counts in second order only, since
 * P x and w^H P vanish, so
 *
 *     ds/dh = -w^H (s^2 M' + s D' + K') x / w^H (2 s M + D) x
 *
 * If M, D, K are symmetric w is the conjugate of x.  docs/theory/modes.md */
#include "analysis/modes_follow.h"

#include "analysis/steady.h"
#include "linsol/dense.h"
#include "math/elementary.h"

#include <math.h>
#include <string.h>

#define SINGLE    1e-6  /* of the modulus: as near as another eigenvalue may be */
#define STILL     1e-7  /* of the largest modulus: less may be a free motion */
#define SYMMETRIC 1e-13 /* of the largest entry */
#define BESIDE    1e-9  /* of an eigenvalue: where its left vector is sought */
#define NEWTON    50    /* steps at most */

typedef struct complex_number {
    double re, im;
} complex_number;

/* Arrays of one following. */
typedef struct workspace {
    const se3di_modes *from;
    se3di_linear linear; /* of the other model */
    size_t f, n, count;  /* count: numbers of `memory` */
    int32_t *pivot;      /* [2 f] */
    double *memory;
    double *P;        /* [2 f 2 f] */
    double *left;     /* [2 f], real parts first, as all below */
    double *whole[2]; /* [2 n] w and x over all coordinates */
    double *taken[2]; /* [2 f] w and x over the freedoms of the other model */
    int32_t is_symmetric;
    int32_t reserved;
} workspace;

static complex_number multiply(complex_number a, complex_number b)
{
    return (complex_number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static complex_number add(complex_number a, complex_number b)
{
    return (complex_number){a.re + b.re, a.im + b.im};
}

/* a / b, b not 0 */
static complex_number divide(complex_number a, complex_number b)
{
    const double size = se3di_hypot(b.re, b.im);
    const complex_number unit = {b.re / size, -b.im / size};
    const complex_number turned = multiply(a, unit);
    return (complex_number){turned.re / size, turned.im / size};
}

/* w^H X x */
static complex_number eval_form(size_t f, const double *X, const double *w, const double *x)
{
    complex_number sum = {0.0, 0.0};
    for (size_t r = 0; r < f; ++r) {
        double re = 0.0, im = 0.0;
        for (size_t c = 0; c < f; ++c) {
            re += X[r * f + c] * x[c];
            im += X[r * f + c] * x[f + c];
        }
        sum.re += w[r] * re + w[f + r] * im;
        sum.im += w[r] * im - w[f + r] * re;
    }
    return sum;
}

static int is_symmetric(size_t f, const double *X)
{
    double size = 0.0, skew = 0.0;
    for (size_t r = 0; r < f; ++r) {
        for (size_t c = 0; c <= r; ++c) {
            size = fmax(size, fmax(fabs(X[r * f + c]), fabs(X[c * f + r])));
            skew = fmax(skew, fabs(X[r * f + c] - X[c * f + r]));
        }
    }
    return skew <= SYMMETRIC * size;
}

/* P(s)^H as a real matrix. */
static void fill_adjoint(const se3di_modes *m, complex_number s, double *P)
{
    const size_t f = m->f;
    const complex_number square = multiply(s, s);
    for (size_t r = 0; r < f; ++r) {
        for (size_t c = 0; c < f; ++c) {
            const size_t e = c * f + r;
            const double re = square.re * m->M[e] + s.re * m->D[e] + m->K[e];
            const double im = -(square.im * m->M[e] + s.im * m->D[e]);
            P[r * 2 * f + c] = P[(f + r) * 2 * f + f + c] = re;
            P[r * 2 * f + f + c] = -im;
            P[(f + r) * 2 * f + c] = im;
        }
    }
}

static void normalise(double *x, size_t count)
{
    double most = 0.0;
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(x[k]));
    }
    for (size_t k = 0; k < count && most > 0.0; ++k) {
        x[k] /= most;
    }
}

/* w of mode k, by inverse iteration beside its eigenvalue. */
static se3d_status find_left(workspace *w, size_t k, const double *x)
{
    const se3di_modes *m = w->from;
    const size_t f = w->f;
    const complex_number s = {m->eigen.re[k], m->eigen.im[k]};
    const double shift = BESIDE * se3di_hypot(s.re, s.im);
    memcpy(w->left, x, 2 * f * sizeof *x);
    if (w->is_symmetric) {
        for (size_t r = 0; r < f; ++r) {
            w->left[f + r] = -x[f + r];
        }
        return SE3D_OK;
    }
    fill_adjoint(m, (complex_number){s.re + shift, s.im + 0.5 * shift}, w->P);
    SE3DI_TRY(se3di_dense_lu_factor((int32_t)(2 * f), w->P, w->pivot));
    for (int step = 0; step < 4; ++step) {
        se3di_dense_lu_solve((int32_t)(2 * f), w->P, w->pivot, w->left);
        normalise(w->left, 2 * f);
    }
    return SE3D_OK;
}

/* A vector over the freedoms of the first model as one over those of the second. */
static void take_over(const workspace *w, const double *y, double *whole, double *taken)
{
    const size_t f = w->f, n = w->n;
    memset(whole, 0, 2 * n * sizeof *whole);
    for (size_t part = 0; part < 2; ++part) {
        for (size_t r = 0; r < f; ++r) {
            for (size_t c = 0; c < n; ++c) {
                whole[part * n + c] += w->from->Z[r * n + c] * y[part * f + r];
            }
        }
        for (size_t r = 0; r < f; ++r) {
            double sum = 0.0;
            for (size_t c = 0; c < n; ++c) {
                sum += w->linear.Z[r * n + c] * whole[part * n + c];
            }
            taken[part * f + r] = sum;
        }
    }
}

/* The root of a s^2 + b s + c next to s; false: there is none that is single. */
static int find_root(complex_number a, complex_number b, complex_number c, complex_number *s)
{
    double before = HUGE_VAL;
    for (int step = 0; step < NEWTON; ++step) {
        const complex_number slope = add(multiply((complex_number){2.0 * a.re, 2.0 * a.im}, *s), b);
        const complex_number rest = add(multiply(add(multiply(a, *s), b), *s), c);
        if (!(se3di_hypot(slope.re, slope.im) > 0.0)) {
            return 0;
        }
        const complex_number change = divide(rest, slope);
        const double length = se3di_hypot(change.re, change.im);
        if (!(length < before)) {
            return isfinite(length);
        }
        s->re -= change.re;
        s->im -= change.im;
        before = length;
    }
    return 0;
}

/* Whether an eigenvalue is a single one that is not 0. */
static int is_single(const se3di_eigen *e, size_t k)
{
    const size_t count = (size_t)e->count;
    const double size = se3di_hypot(e->re[k], e->im[k]);
    int single = size > STILL * se3di_hypot(e->re[count - 1], e->im[count - 1]);
    for (size_t i = 0; i < count && single; ++i) {
        single = i == k || se3di_hypot(e->re[i] - e->re[k], e->im[i] - e->im[k]) > SINGLE * size;
    }
    return single;
}

static void follow_mode(workspace *w, size_t k, complex_number *s)
{
    const se3di_eigen *e = &w->from->eigen;
    const size_t f = w->f;
    double *x = w->taken[1]; /* over the freedoms of the first model, then of the second */
    *s = (complex_number){e->re[k], e->im[k]};
    memcpy(x, e->y_re + k * f, f * sizeof *x);
    memcpy(x + f, e->y_im + k * f, f * sizeof *x);
    const int is_real = !(fabs(e->im[k]) > 0.0);
    int good = is_single(e, k) && find_left(w, k, x) >= 0;
    if (good) {
        take_over(w, x, w->whole[1], w->taken[1]);
        take_over(w, w->left, w->whole[0], w->taken[0]);
        good = find_root(eval_form(f, w->linear.Mr, w->taken[0], w->taken[1]),
                         eval_form(f, w->linear.Dr, w->taken[0], w->taken[1]),
                         eval_form(f, w->linear.Kr, w->taken[0], w->taken[1]), s);
    }
    if (!good) {
        *s = (complex_number){(double)NAN, (double)NAN};
    } else if (is_real) {
        s->im = 0.0;
    }
}

static se3d_status allocate(workspace *w, const se3d_allocator *allocator)
{
    const size_t f = w->f, n = w->n;
    w->count = 4 * f * f + 6 * f + 4 * n;
    w->memory = se3di_alloc(allocator, w->count, sizeof *w->memory);
    w->pivot = se3di_alloc(allocator, 2 * f, sizeof *w->pivot);
    if (!w->memory || !w->pivot) {
        return SE3D_ERR_NO_MEMORY;
    }
    w->P = w->memory;
    w->left = w->P + 4 * f * f;
    w->taken[0] = w->left + 2 * f;
    w->taken[1] = w->taken[0] + 2 * f;
    w->whole[0] = w->taken[1] + 2 * f;
    w->whole[1] = w->whole[0] + 2 * n;
    return SE3D_OK;
}

static se3d_status follow_all(workspace *w, double *re, double *im)
{
    const se3di_modes *m = w->from;
    const se3d_allocator *allocator = &w->linear.equations->assembly.model->allocator;
    if ((size_t)w->linear.freedoms != w->f) {
        return se3di_error_set(w->linear.equations->error, SE3D_ERR_STATE,
                               "the system has %d freedoms, its modes are to follow those of %zu",
                               (int)w->linear.freedoms, w->f);
    }
    se3d_status status = allocate(w, allocator);
    w->is_symmetric =
        is_symmetric(w->f, m->M) && is_symmetric(w->f, m->D) && is_symmetric(w->f, m->K);
    for (size_t k = 0; k < (size_t)m->eigen.count && status >= 0; ++k) {
        complex_number s;
        follow_mode(w, k, &s);
        re[k] = s.re;
        im[k] = s.im;
    }
    se3di_free(allocator, w->memory, w->count, sizeof *w->memory);
    se3di_free(allocator, w->pivot, 2 * w->f, sizeof *w->pivot);
    return status < 0 ? se3di_error_set(w->linear.equations->error, status, "no memory for modes")
                      : SE3D_OK;
}

se3d_status se3di_modes_follow(const se3di_modes *modes, se3di_model *model, se3di_error *error,
                               double *re, double *im)
{
    se3di_equations equations;
    workspace w = {.from = modes, .f = modes->f, .n = modes->n};
    if (modes->is_sparse) {
        return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                               "the lowest modes of a large model have no matrices, in which "
                               "others could follow them");
    }
    SE3DI_TRY(se3di_equations_init(&equations, model, &se3di_formulation_romega, 0, error));
    se3di_error_clear(error);
    se3d_status status = se3di_modes_prepare(&equations);
    if (status >= 0 && equations.assembly.unknown_count != modes->n) {
        status = se3di_error_set(error, SE3D_ERR_STATE,
                                 "the system has %zu bodies that move, its modes are to follow "
                                 "those of %zu",
                                 (size_t)equations.assembly.unknown_count / 6, modes->n / 6);
    }
    if (status >= 0) {
        status = se3di_linear_init(&w.linear, &equations);
    }
    if (status >= 0) {
        status = se3di_steady_linearise(&w.linear, model->time);
        status = status < 0 ? status : follow_all(&w, re, im);
        se3di_linear_destroy(&w.linear);
    }
    se3di_equations_destroy(&equations);
    return status;
}
