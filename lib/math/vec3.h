/* SPDX-License-Identifier: BSD-3-Clause */
/* Vectors of three and 3 x 3 matrices (row-major, double[9]); pure functions. Outputs may not alias
 * inputs unless a function says so. */
#ifndef SE3DI_MATH_VEC3_H
#define SE3DI_MATH_VEC3_H

#include <math.h>

static inline double se3di_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void se3di_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double se3di_norm(const double a[3])
{
    return sqrt(se3di_dot(a, a));
}

static inline void se3di_copy(const double a[3], double out[3])
{
    out[0] = a[0];
    out[1] = a[1];
    out[2] = a[2];
}

/* out = a + b; aliasing allowed. */
static inline void se3di_add(const double a[3], const double b[3], double out[3])
{
    out[0] = a[0] + b[0];
    out[1] = a[1] + b[1];
    out[2] = a[2] + b[2];
}

/* out = a - b; aliasing allowed. */
static inline void se3di_sub(const double a[3], const double b[3], double out[3])
{
    out[0] = a[0] - b[0];
    out[1] = a[1] - b[1];
    out[2] = a[2] - b[2];
}

/* out = s a; aliasing allowed. */
static inline void se3di_scale(double s, const double a[3], double out[3])
{
    out[0] = s * a[0];
    out[1] = s * a[1];
    out[2] = s * a[2];
}

/* out += s a */
static inline void se3di_add_scaled(double s, const double a[3], double out[3])
{
    out[0] += s * a[0];
    out[1] += s * a[1];
    out[2] += s * a[2];
}

/* out = A a */
static inline void se3di_mul(const double A[9], const double a[3], double out[3])
{
    out[0] = A[0] * a[0] + A[1] * a[1] + A[2] * a[2];
    out[1] = A[3] * a[0] + A[4] * a[1] + A[5] * a[2];
    out[2] = A[6] * a[0] + A[7] * a[1] + A[8] * a[2];
}

/* out = A^T a */
static inline void se3di_mul_transposed(const double A[9], const double a[3], double out[3])
{
    out[0] = A[0] * a[0] + A[3] * a[1] + A[6] * a[2];
    out[1] = A[1] * a[0] + A[4] * a[1] + A[7] * a[2];
    out[2] = A[2] * a[0] + A[5] * a[1] + A[8] * a[2];
}

/* out = A B */
static inline void se3di_mat_mul(const double A[9], const double B[9], double out[9])
{
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            out[3 * r + c] = A[3 * r] * B[c] + A[3 * r + 1] * B[3 + c] + A[3 * r + 2] * B[6 + c];
        }
    }
}

/* out = A^T B */
static inline void se3di_mat_mul_transposed(const double A[9], const double B[9], double out[9])
{
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            out[3 * r + c] = A[r] * B[c] + A[3 + r] * B[3 + c] + A[6 + r] * B[6 + c];
        }
    }
}

/* x = A^-1 b, A row-major. */
static inline void se3di_solve3(const double A[9], const double b[3], double x[3])
{
    double c0[3], c1[3], c2[3];
    const double r0[3] = {A[0], A[3], A[6]}, r1[3] = {A[1], A[4], A[7]}, r2[3] = {A[2], A[5], A[8]};
    se3di_cross(r1, r2, c0);
    se3di_cross(r2, r0, c1);
    se3di_cross(r0, r1, c2);
    const double scale = 1.0 / se3di_dot(r0, c0);
    const double solution[3] = {scale * se3di_dot(c0, b), scale * se3di_dot(c1, b),
                                scale * se3di_dot(c2, b)};
    se3di_copy(solution, x);
}

/* The cross product matrix: tilde(a) b = a x b. */
static inline void se3di_tilde(const double a[3], double out[9])
{
    out[0] = 0.0;
    out[1] = -a[2];
    out[2] = a[1];
    out[3] = a[2];
    out[4] = 0.0;
    out[5] = -a[0];
    out[6] = -a[1];
    out[7] = a[0];
    out[8] = 0.0;
}

/* A unit vector perpendicular to the unit vector `axis`: the ground axis least along it, made
 * orthogonal. */
static inline void se3di_perpendicular(const double axis[3], double out[3])
{
    int least = 0;
    for (int k = 1; k < 3; ++k) {
        if (fabs(axis[k]) < fabs(axis[least])) {
            least = k;
        }
    }
    double e[3] = {0.0, 0.0, 0.0};
    e[least] = 1.0;
    se3di_add_scaled(-axis[least], axis, e);
    se3di_scale(1.0 / se3di_norm(e), e, out);
}

/* The unit vector along a finite one of any size; aliasing allowed. Returns 0 if it is zero. */
static inline int se3di_unit(const double a[3], double out[3])
{
    const double largest = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
    if (!(largest >= 1e-150)) {
        return 0;
    }
    double scaled[3];
    se3di_scale(1.0 / largest, a, scaled);
    se3di_scale(1.0 / se3di_norm(scaled), scaled, out);
    return 1;
}

/* Whether the length is 1 to rounding. What is so is kept as it is where directions and Euler
 * parameters are read: what was made a unit vector once stays the same to the bit when it is given
 * again. */
static inline int se3di_is_unit(const double *values, int count)
{
    double square = 0.0;
    for (int k = 0; k < count; ++k) {
        square += values[k] * values[k];
    }
    return fabs(square - 1.0) <= 0x1p-49;
}

static inline int se3di_is_finite(const double *values, int count)
{
    for (int k = 0; k < count; ++k) {
        if (!isfinite(values[k])) {
            return 0;
        }
    }
    return 1;
}

#endif
