/* SPDX-License-Identifier: BSD-3-Clause */
#include "math/symmetric.h"

#include <math.h>
#include <string.h>

#define SWEEPS 12

/* Rows r and s of X turned by (cosine, sine). */
static void turn_rows(int n, double *X, int r, int s, const double turn[2])
{
    for (int k = 0; k < n; ++k) {
        const double x = X[n * r + k];
        const double y = X[n * s + k];
        X[n * r + k] = turn[0] * x - turn[1] * y;
        X[n * s + k] = turn[1] * x + turn[0] * y;
    }
}

static void turn_columns(int n, double *X, int r, int s, const double turn[2])
{
    for (int k = 0; k < n; ++k) {
        const double x = X[n * k + r];
        const double y = X[n * k + s];
        X[n * k + r] = turn[0] * x - turn[1] * y;
        X[n * k + s] = turn[1] * x + turn[0] * y;
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
    const double t = copysign(1.0, zeta) / (fabs(zeta) + hypot(zeta, 1.0));
    const double cosine = 1.0 / hypot(t, 1.0);
    const double turn[2] = {cosine, t * cosine};
    turn_rows(n, M, r, s, turn);
    turn_columns(n, M, r, s, turn);
    turn_rows(n, V, r, s, turn);
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
