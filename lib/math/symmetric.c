/* SPDX-License-Identifier: BSD-3-Clause */
#include "math/symmetric.h"
#include "math/elementary.h"

#include <math.h>
#include <string.h>

#define SWEEPS 12

/* The vectors x and y of n components, `stride` apart, turned by (cosine, sine). */
static void turn_vectors(int n, int stride, double *x, double *y, const double turn[2])
{
    for (int k = 0; k < n * stride; k += stride) {
        const double before = x[k];
        x[k] = turn[0] * before - turn[1] * y[k];
        y[k] = turn[1] * before + turn[0] * y[k];
    }
}

/* Element (r, s) of M turned away; the rows of V follow. */
static void rotate_away(int n, double *M, double *V, int r, int s)
{
    const double off = M[n * r + s];
    if (!(fabs(off) > 0.0)) {
        return;
    }
    /* tangent of the smaller angle: t^2 + 2 zeta t - 1 = 0 */
    const double zeta = (M[n * s + s] - M[n * r + r]) / (2.0 * off);
    const double t = copysign(1.0, zeta) / (fabs(zeta) + se3di_hypot(zeta, 1.0));
    const double cosine = 1.0 / se3di_hypot(t, 1.0);
    const double turn[2] = {cosine, t * cosine};
    turn_vectors(n, 1, M + n * r, M + n * s, turn);
    turn_vectors(n, n, M + r, M + s, turn);
    turn_vectors(n, 1, V + n * r, V + n * s, turn);
}

static double off_diagonal(int n, const double *M)
{
    double sum = 0.0;
    for (int r = 0; r < n; ++r) {
        for (int c = 0; c < r; ++c) {
            sum += fabs(M[n * r + c]);
        }
    }
    return sum;
}

void se3di_symmetric_abs(int n, double *A)
{
    double M[SE3DI_SYMMETRIC_MAX * SE3DI_SYMMETRIC_MAX];
    double V[SE3DI_SYMMETRIC_MAX * SE3DI_SYMMETRIC_MAX] = {0.0};
    double size = 0.0;
    for (int k = 0; k < n * n; ++k) {
        M[k] = 0.5 * (A[k] + A[n * (k % n) + k / n]);
        size += fabs(M[k]);
    }
    for (int k = 0; k < n; ++k) {
        V[n * k + k] = 1.0;
    }
    /* unreached: so many sweeps, as it converges quadratically */
    for (int sweep = 0; sweep < SWEEPS && off_diagonal(n, M) > 1e-15 * size; ++sweep) {
        for (int r = 0; r < n; ++r) {
            for (int s = r + 1; s < n; ++s) {
                rotate_away(n, M, V, r, s);
            }
        }
    }
    for (int k = 0; k < n * n; ++k) {
        A[k] = 0.0;
        for (int e = 0; e < n; ++e) {
            A[k] += fabs(M[n * e + e]) * V[n * e + k / n] * V[n * e + k % n];
        }
    }
}
