/* SPDX-License-Identifier: BSD-3-Clause */
/* Rotations between the ways in which a file can say them. */
#include "io/base/rotation.h"

#include <math.h>

#include "io/base/elementary.h"

double se3di_rotation_matrix_error(const double A[9])
{
    double error = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const double dot = A[i] * A[j] + A[3 + i] * A[3 + j] + A[6 + i] * A[6 + j];
            error = fmax(error, fabs(dot - (i == j ? 1.0 : 0.0)));
        }
    }
    return error;
}

double se3di_rotation_matrix_determinant(const double A[9])
{
    return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
           A[2] * (A[3] * A[7] - A[4] * A[6]);
}

static void normalize(double p[4])
{
    const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    for (int k = 0; k < 4; ++k) {
        p[k] /= length;
    }
}

/* 4 e_a e_b are sums and differences of entries; the largest e is found from the trace or the
 * diagonal, so that nothing is divided by a small number. e0 >= 0 comes out where e0 is largest. */
void se3di_rotation_from_matrix(const double A[9], double p[4])
{
    const double square[4] = {1.0 + A[0] + A[4] + A[8], 1.0 + A[0] - A[4] - A[8],
                              1.0 - A[0] + A[4] - A[8], 1.0 - A[0] - A[4] + A[8]};
    int largest = 0;
    for (int k = 1; k < 4; ++k) {
        largest = square[k] > square[largest] ? k : largest;
    }
    const double x[3] = {A[7] - A[5], A[2] - A[6], A[3] - A[1]}; /* 4 e0 e_k */
    const double xy = A[1] + A[3];
    const double xz = A[2] + A[6];
    const double yz = A[5] + A[7];
    const double rows[4][4] = {{square[0], x[0], x[1], x[2]},
                               {x[0], square[1], xy, xz},
                               {x[1], xy, square[2], yz},
                               {x[2], xz, yz, square[3]}};
    for (int k = 0; k < 4; ++k) {
        p[k] = rows[largest][k];
    }
    normalize(p);
    if (p[0] < 0.0) {
        for (int k = 0; k < 4; ++k) {
            p[k] = -p[k];
        }
    }
}

void se3di_rotation_from_axis(const double axis[3], double angle, double p[4])
{
    const double length = io_hypot(io_hypot(axis[0], axis[1]), axis[2]);
    const double s = io_sin(0.5 * angle) / length;
    p[0] = io_cos(0.5 * angle);
    for (int k = 0; k < 3; ++k) {
        p[k + 1] = s * axis[k];
    }
    normalize(p);
}

/* r = a b as quaternions. */
static void multiply(const double a[4], const double b[4], double r[4])
{
    r[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    r[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    r[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    r[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

void se3di_rotation_from_rpy(const double angles[3], double p[4])
{
    static const double axes[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    double turns[3][4];
    double zy[4];
    for (int k = 0; k < 3; ++k) {
        se3di_rotation_from_axis(axes[k], angles[k], turns[k]);
    }
    multiply(turns[2], turns[1], zy);
    multiply(zy, turns[0], p);
    normalize(p);
}

void se3di_rotation_to_matrix(const double p[4], double A[9])
{
    const double e0 = p[0];
    const double e1 = p[1];
    const double e2 = p[2];
    const double e3 = p[3];
    A[0] = 2.0 * (e0 * e0 + e1 * e1) - 1.0;
    A[1] = 2.0 * (e1 * e2 - e0 * e3);
    A[2] = 2.0 * (e1 * e3 + e0 * e2);
    A[3] = 2.0 * (e1 * e2 + e0 * e3);
    A[4] = 2.0 * (e0 * e0 + e2 * e2) - 1.0;
    A[5] = 2.0 * (e2 * e3 - e0 * e1);
    A[6] = 2.0 * (e1 * e3 - e0 * e2);
    A[7] = 2.0 * (e2 * e3 + e0 * e1);
    A[8] = 2.0 * (e0 * e0 + e3 * e3) - 1.0;
}

void se3di_rotation_apply_inverse(const double p[4], const double u[3], double v[3])
{
    double A[9];
    se3di_rotation_to_matrix(p, A);
    for (int k = 0; k < 3; ++k) {
        v[k] = A[k] * u[0] + A[3 + k] * u[1] + A[6 + k] * u[2];
    }
}
