/* SPDX-License-Identifier: BSD-3-Clause */
/* Euler parameters and rotation kernels: the formulas are in the header.  docs/theory/rotations.md
 */
#include "math/quaternion.h"

#include "math/elementary.h"
#include "math/vec3.h"

/* Below this |theta|^2 the quotients of the exponential map's tangent lose digits and their power
 * series are used; with eight terms these are exact to rounding there. */
#define SERIES_LIMIT 0.25

static inline double polynomial(const double coefficients[8], double x)
{
    double sum = coefficients[7];
    for (int k = 6; k >= 0; --k) {
        sum = sum * x + coefficients[k];
    }
    return sum;
}

/* sin(t/2)/t and cos(t/2) with x = t^2 */
static void half_angle(double x, double *sinc, double *cosine)
{
    if (x < 1e-4) {
        *sinc = 0.5 - x * (1.0 / 48.0 - x * (1.0 / 3840.0));
        *cosine = 1.0 - x * (1.0 / 8.0 - x * (1.0 / 384.0 - x * (1.0 / 46080.0)));
        return;
    }
    const double t = sqrt(x);
    double sine;
    se3di_sincos(0.5 * t, &sine, cosine);
    *sinc = sine / t;
}

/* (t - sin t)/t^3 with x = t^2 */
static double sine_defect(double x)
{
    static const double series[8] = {
        1.0 / 6.0,        -1.0 / 120.0,        1.0 / 5040.0,          -1.0 / 362880.0,
        1.0 / 39916800.0, -1.0 / 6227020800.0, 1.0 / 1307674368000.0, -1.0 / 355687428096000.0};
    if (x < SERIES_LIMIT) {
        return polynomial(series, x);
    }
    const double t = sqrt(x);
    return (t - se3di_sin(t)) / (x * t);
}

/* (1 - (t/2) cot(t/2))/t^2 with x = t^2; the series' coefficients are |B_2k|/(2k)! */
static double cotangent_defect(double x)
{
    static const double series[8] = {1.0 / 12.0,          1.0 / 720.0,
                                     1.0 / 30240.0,       1.0 / 1209600.0,
                                     1.0 / 47900160.0,    691.0 / 1307674368000.0,
                                     1.0 / 74724249600.0, 3617.0 / 10670622842880000.0};
    if (x < SERIES_LIMIT) {
        return polynomial(series, x);
    }
    const double half = 0.5 * sqrt(x);
    double sine, cosine;
    se3di_sincos(half, &sine, &cosine);
    return (1.0 - half * cosine / sine) / x;
}

/* out = I + first tilde(theta) + second tilde(theta)^2 */
static void rotation_polynomial(const double theta[3], double first, double second, double out[9])
{
    const double diagonal = 1.0 - second * se3di_dot(theta, theta);
    se3di_tilde(theta, out);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            out[3 * r + c] = first * out[3 * r + c] + second * theta[r] * theta[c];
        }
        out[4 * r] += diagonal;
    }
}

void se3di_quat_from_matrix(const double A[9], double p[4])
{
    /* 4 e_k^2; dividing by the largest component keeps all digits (Shepperd's choice). */
    const double square[4] = {1.0 + A[0] + A[4] + A[8], 1.0 + A[0] - A[4] - A[8],
                              1.0 - A[0] + A[4] - A[8], 1.0 - A[0] - A[4] + A[8]};
    /* The symmetric matrix 4 e_k e_l. */
    const double product[4][4] = {
        {square[0], A[7] - A[5], A[2] - A[6], A[3] - A[1]},
        {A[7] - A[5], square[1], A[1] + A[3], A[2] + A[6]},
        {A[2] - A[6], A[1] + A[3], square[2], A[5] + A[7]},
        {A[3] - A[1], A[2] + A[6], A[5] + A[7], square[3]},
    };
    int largest = 0;
    for (int k = 1; k < 4; ++k) {
        if (square[k] > square[largest]) {
            largest = k;
        }
    }
    const double sign = product[largest][0] < 0.0 ? -1.0 : 1.0;
    double q[4];
    for (int k = 0; k < 4; ++k) {
        q[k] = sign * product[largest][k];
    }
    (void)se3di_quat_normalize(q, p);
}

void se3di_quat_from_axis_angle(const double axis[3], double angle, double p[4])
{
    double s;
    se3di_sincos(0.5 * angle, &s, &p[0]);
    p[1] = s * axis[0];
    p[2] = s * axis[1];
    p[3] = s * axis[2];
}

void se3di_quat_rotate(const double p[4], const double theta[3], double out[4])
{
    const double x = se3di_dot(theta, theta);
    double s, cosine;
    half_angle(x, &s, &cosine);
    const double turn[4] = {cosine, s * theta[0], s * theta[1], s * theta[2]};
    se3di_quat_mul(p, turn, out);
}

void se3di_quat_log(const double p[4], const double q[4], double theta[3])
{
    const double inverse[4] = {p[0], -p[1], -p[2], -p[3]};
    double turn[4];
    se3di_quat_mul(inverse, q, turn);
    const double sign = turn[0] < 0.0 ? -1.0 : 1.0; /* the shorter way round */
    const double sine = se3di_norm(turn + 1);
    const double cosine = fabs(turn[0]);
    const double factor = sine > 0.0 ? 2.0 * se3di_atan2(sine, cosine) / sine : 2.0 / cosine;
    se3di_scale(sign * factor, turn + 1, theta);
}

void se3di_quat_acceleration(const double p[4], const double w[3], const double wdot[3],
                             double pddot[4])
{
    const double quarter = 0.25 * se3di_dot(w, w);
    se3di_g_transposed_mul(p, wdot, pddot);
    for (int k = 0; k < 4; ++k) {
        pddot[k] = 0.5 * pddot[k] - quarter * p[k];
    }
}

void se3di_k_matrix(const double a[3], const double y[3], double K[16])
{
    const double ay = se3di_dot(a, y);
    double n[3];
    se3di_cross(a, y, n);
    K[0] = 2.0 * ay;
    for (int r = 0; r < 3; ++r) {
        K[1 + r] = 2.0 * n[r];
        K[4 * (r + 1)] = 2.0 * n[r];
        for (int c = 0; c < 3; ++c) {
            K[4 * (r + 1) + 1 + c] = 2.0 * (a[r] * y[c] + y[r] * a[c]);
        }
        K[5 * (r + 1)] -= 2.0 * ay;
    }
}

void se3di_exp_tangent(const double theta[3], double T[9])
{
    const double x = se3di_dot(theta, theta);
    double s, cosine;
    half_angle(x, &s, &cosine);
    rotation_polynomial(theta, -2.0 * s * s, sine_defect(x), T); /* 1 - cos t = 2 sin^2(t/2) */
}

void se3di_exp_tangent_inverse(const double theta[3], double Tinv[9])
{
    rotation_polynomial(theta, 0.5, cotangent_defect(se3di_dot(theta, theta)), Tinv);
}
