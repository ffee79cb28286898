/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/eigen.h"
#include "linsol/householder.h"
#include "math/elementary.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define STEPS_MAX 60 /* QR steps an eigenvalue; two or three are usual */

/* The lower triangle of the symmetric A [count count], columns n apart, becomes H A H with
 * H = I - tau v v^T. p[count] is work */
static void reflect_both_sides(size_t n, size_t count, double *A, const double *v, double tau,
                               double *p)
{
    double overlap = 0.0;
    memset(p, 0, count * sizeof *p);
    for (size_t c = 0; c < count; ++c) { /* p = A v */
        const double *a = A + c * n;
        double dot = a[c] * v[c];
        for (size_t i = c + 1; i < count; ++i) {
            p[i] += a[i] * v[c];
            dot += a[i] * v[i];
        }
        p[c] += dot;
    }
    for (size_t i = 0; i < count; ++i) {
        p[i] *= tau;
        overlap += p[i] * v[i];
    }
    for (size_t i = 0; i < count; ++i) {
        p[i] -= .5 * tau * overlap * v[i];
    }
    for (size_t c = 0; c < count; ++c) {
        double *a = A + c * n;
        for (size_t i = c; i < count; ++i) {
            a[i] -= v[i] * p[c] + p[i] * v[c];
        }
    }
}

/* A (column-major, lower triangle) = Q T Q^T with diagonal d and subdiagonal e of T. Column k of A
 * keeps v of its reflection, which acts on the rows k + 1 .. */
static void reduce_to_tridiagonal(size_t n, double *A, double *d, double *e, double *tau,
                                  double *work)
{
    for (size_t k = 0; k + 1 < n; ++k) {
        double *v = A + k * n + k + 1;
        d[k] = A[k * n + k];
        tau[k] = se3di_householder_reflect(n - k - 1, v);
        e[k] = v[0];
        v[0] = 1.0;
        reflect_both_sides(n, n - k - 1, A + (k + 1) * n + k + 1, v, tau[k], work);
    }
    d[n - 1] = A[n * n - 1];
}

/* Overwrite the reflections by Q, from the last to the first: column k of A is free by then. */
static void form_q(size_t n, double *A, const double *tau)
{
    memset(A + (n - 1) * n, 0, n * sizeof *A);
    A[n * n - 1] = 1.0;
    for (size_t k = n - 1; k-- > 0;) {
        double *v = A + k * n;
        for (size_t c = k + 1; c < n; ++c) {
            se3di_householder_mirror(n - k - 1, tau[k], v + k + 1, A + c * n + k + 1);
        }
        memset(v, 0, n * sizeof *v);
        v[k] = 1.0;
    }
}

static void rotate_columns(size_t n, double *a, double *b, double c, double s)
{
    for (size_t i = 0; i < n; ++i) {
        double kept = a[i];
        a[i] = c * kept + s * b[i];
        b[i] = c * b[i] - s * kept;
    }
}

/* One implicit QR step on the unreduced block first .. last. */
static void step_tridiagonal(size_t n, size_t first, size_t last, double *d, double *e, double *Q)
{
    double half = .5 * (d[last - 1] - d[last]);
    double root = se3di_hypot(half, e[last - 1]);
    double divisor = half + (half < 0.0 ? -root : root);
    double shift = d[last] - (divisor != 0.0 ? e[last - 1] / divisor * e[last - 1] : 0.0);
    double x = d[first] - shift;
    double z = e[first];
    for (size_t k = first; k < last; ++k) {
        double r = se3di_hypot(x, z);
        double c = r > 0.0 ? x / r : 1.0;
        double s = r > 0.0 ? z / r : 0.0;
        if (k > first) {
            e[k - 1] = r;
        }
        double turn = s * (d[k + 1] - d[k]) + 2.0 * c * e[k]; /* so that the trace is kept */
        double moved = s * turn;
        e[k] = c * turn - e[k];
        d[k] += moved;
        d[k + 1] -= moved;
        x = e[k];
        if (k + 1 < last) {
            z = s * e[k + 1];
            e[k + 1] *= c;
        }
        rotate_columns(n, Q + k * n, Q + (k + 1) * n, c, s);
    }
}

static se3d_status diagonalise(size_t n, double *d, double *e, double *Q)
{
    int32_t steps = 0;
    for (size_t last = n - 1; last > 0;) {
        size_t first = last;
        while (first > 0 &&
               fabs(e[first - 1]) > .5 * DBL_EPSILON * (fabs(d[first - 1]) + fabs(d[first]))) {
            --first;
        }
        if (first == last) {
            --last;
            steps = 0;
        } else if (++steps > STEPS_MAX) {
            return SE3D_ERR_NO_CONVERGENCE;
        } else {
            step_tridiagonal(n, first, last, d, e, Q);
        }
    }
    return SE3D_OK;
}

static void sort_ascending(size_t n, double *w, double *Q)
{
    for (size_t k = 0; k + 1 < n; ++k) {
        size_t least = k;
        for (size_t j = k + 1; j < n; ++j) {
            least = w[j] < w[least] ? j : least;
        }
        if (least != k) {
            double kept = w[k];
            w[k] = w[least];
            w[least] = kept;
            for (size_t i = 0; i < n; ++i) {
                kept = Q[k * n + i];
                Q[k * n + i] = Q[least * n + i];
                Q[least * n + i] = kept;
            }
        }
    }
}

/* Bring the numbers near one, so that products neither overflow nor vanish. @return the power of
 * two taken out, 1 for a zero matrix, -1 if a number is not finite */
static double scale_symmetric(size_t n, double *A)
{
    double size = 0.0;
    for (size_t c = 0; c < n; ++c) {
        for (size_t r = c; r < n; ++r) {
            if (!isfinite(A[c * n + r])) {
                return -1.0;
            }
            size = fmax(size, fabs(A[c * n + r]));
        }
    }
    int exponent = 0;
    (void)frexp(size, &exponent);
    exponent = exponent < -1000 ? -1000 : exponent > 1000 ? 1000 : exponent;
    double scale = ldexp(1.0, exponent);
    for (size_t k = 0; k < n * n; ++k) {
        A[k] /= scale;
    }
    return scale;
}

se3d_status se3di_symmetric_eigen(const se3d_allocator *allocator, int32_t n, double *A, double *w)
{
    size_t count = (size_t)n;
    if (n == 0) {
        return SE3D_OK;
    }
    for (size_t c = 0; c < count;
         ++c) { /* column-major: the lower triangle of the rows, mirrored */
        for (size_t r = c + 1; r < count; ++r) {
            A[c * count + r] = A[r * count + c];
        }
    }
    double scale = scale_symmetric(count, A);
    if (scale < 0.0) {
        return SE3D_ERR_NOT_FINITE;
    }
    double *work = se3di_alloc(allocator, 3 * count, sizeof *work);
    if (!work) {
        return SE3D_ERR_NO_MEMORY;
    }
    double *e = work;
    double *tau = work + count;
    reduce_to_tridiagonal(count, A, w, e, tau, work + 2 * count);
    form_q(count, A, tau);
    se3d_status status = diagonalise(count, w, e, A);
    sort_ascending(count, w, A);
    for (size_t k = 0; k < count; ++k) {
        w[k] *= scale;
    }
    se3di_free(allocator, work, 3 * count, sizeof *work);
    return status;
}
