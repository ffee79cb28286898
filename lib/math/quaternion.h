/* SPDX-License-Identifier: BSD-3-Clause */
/* Euler parameters p = (e0, e1, e2, e3), scalar first, and the rotation kernels A, B, E, G of Haug
 * (1989) and the ME751 notes; exponential map and its tangent.  docs/theory/rotations.md
 *
 *     A(p)   = (e0^2 - e.e) I + 2 e e^T + 2 e0 tilde(e)          body -> ground for |p| = 1
 *     G(p)   = [-e, -tilde(e) + e0 I]            w = 2 G pdot  (w in the body frame)
 *     E(p)   = [-e,  tilde(e) + e0 I]            A = E G^T
 *     B(p,a) = 2 [(e0 I + tilde(e)) a,  e a^T - (e0 I + tilde(e)) tilde(a)]     d(A a) = B(p,a) dp
 *     K(a,y) = 2 [a.y, (a x y)^T; a x y, a y^T + y a^T - (a.y) I]
 *              B(p,a)^T y = K(a,y) p
 *
 * A is homogeneous of degree 2 in p, so that B(p,a) p = 2 A a for any p. */
#ifndef SE3DI_MATH_QUATERNION_H
#define SE3DI_MATH_QUATERNION_H

#include "math/vec3.h"

/* For any p; a rotation if |p| = 1. */
static inline void se3di_quat_to_matrix(const double p[4], double A[9])
{
    const double s00 = p[0] * p[0];
    const double s11 = p[1] * p[1];
    const double s22 = p[2] * p[2];
    const double s33 = p[3] * p[3];
    A[0] = s00 + s11 - s22 - s33;
    A[1] = 2.0 * (p[1] * p[2] - p[0] * p[3]);
    A[2] = 2.0 * (p[1] * p[3] + p[0] * p[2]);
    A[3] = 2.0 * (p[1] * p[2] + p[0] * p[3]);
    A[4] = s00 - s11 + s22 - s33;
    A[5] = 2.0 * (p[2] * p[3] - p[0] * p[1]);
    A[6] = 2.0 * (p[1] * p[3] - p[0] * p[2]);
    A[7] = 2.0 * (p[2] * p[3] + p[0] * p[1]);
    A[8] = s00 - s11 - s22 + s33;
}

/* Euler parameters with e0 >= 0 of the rotation matrix A. */
void se3di_quat_from_matrix(const double A[9], double p[4]);

/* p of a turn by `angle` about the unit vector `axis`. */
void se3di_quat_from_axis_angle(const double axis[3], double angle, double p[4]);

/* out = p q (apply q first); aliasing allowed. */
static inline void se3di_quat_mul(const double p[4], const double q[4], double out[4])
{
    const double product[4] = {
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] + p[2] * q[0] + p[3] * q[1] - p[1] * q[3],
        p[0] * q[3] + p[3] * q[0] + p[1] * q[2] - p[2] * q[1],
    };
    for (int k = 0; k < 4; ++k) {
        out[k] = product[k];
    }
}

/* The turn back, for |p| = 1. */
static inline void se3di_quat_inverse(const double p[4], double out[4])
{
    out[0] = p[0];
    se3di_scale(-1.0, p + 1, out + 1);
}

/* out = A(p) a, for |p| = 1. */
static inline void se3di_quat_turn(const double p[4], const double a[3], double out[3])
{
    double once[3], twice[3];
    se3di_cross(p + 1, a, once);
    se3di_cross(p + 1, once, twice);
    for (int k = 0; k < 3; ++k) {
        out[k] = a[k] + 2.0 * (p[0] * once[k] + twice[k]);
    }
}

/* p / |p|; aliasing allowed. Returns |p|. */
static inline double se3di_quat_normalize(const double p[4], double out[4])
{
    const double norm = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    for (int k = 0; k < 4; ++k) {
        out[k] = p[k] / norm;
    }
    return norm;
}

/* p exp(theta): turn by the rotation vector `theta` of the body frame; aliasing allowed. */
void se3di_quat_rotate(const double p[4], const double theta[3], double out[4]);

/* The rotation vector theta (body frame of p, |theta| <= pi) with q = +-p exp(theta). */
void se3di_quat_log(const double p[4], const double q[4], double theta[3]);

/* out = G(p)^T y and out = G(p) x */
static inline void se3di_g_transposed_mul(const double p[4], const double y[3], double out[4])
{
    out[0] = -p[1] * y[0] - p[2] * y[1] - p[3] * y[2];
    out[1] = p[0] * y[0] - p[3] * y[1] + p[2] * y[2];
    out[2] = p[0] * y[1] - p[1] * y[2] + p[3] * y[0];
    out[3] = p[0] * y[2] - p[2] * y[0] + p[1] * y[1];
}

static inline void se3di_g_mul(const double p[4], const double x[4], double out[3])
{
    out[0] = p[0] * x[1] - p[1] * x[0] + p[3] * x[2] - p[2] * x[3];
    out[1] = p[0] * x[2] - p[2] * x[0] + p[1] * x[3] - p[3] * x[1];
    out[2] = p[0] * x[3] - p[3] * x[0] + p[2] * x[1] - p[1] * x[2];
}

/* pdot = 1/2 G(p)^T w */
static inline void se3di_quat_rate(const double p[4], const double w[3], double pdot[4])
{
    se3di_g_transposed_mul(p, w, pdot);
    for (int k = 0; k < 4; ++k) {
        pdot[k] *= 0.5;
    }
}

/* w = 2 G(p) pdot */
static inline void se3di_quat_angular_velocity(const double p[4], const double pdot[4], double w[3])
{
    se3di_g_mul(p, pdot, w);
    se3di_scale(2.0, w, w);
}

/* pddot = 1/2 G(p)^T wdot - 1/4 (w.w) p, for |p| = 1 */
void se3di_quat_acceleration(const double p[4], const double w[3], const double wdot[3],
                             double pddot[4]);

/* out = B(p,a) x = 2 [x0 (e0 a + e x a) + e (a.x) - e0 (a x x) - e x (a x x)], x = (x0, x) */
static inline void se3di_b_mul(const double p[4], const double a[3], const double x[4],
                               double out[3])
{
    const double along = se3di_dot(a, x + 1);
    double u[3]; /* x0 a - a x x */
    se3di_cross(x + 1, a, u);
    se3di_add_scaled(x[0], a, u);
    double turned[3];
    se3di_cross(p + 1, u, turned);
    for (int k = 0; k < 3; ++k) {
        out[k] = 2.0 * (p[0] * u[k] + turned[k] + along * p[k + 1]);
    }
}

/* out = B(p,a)^T y = K(a,y) p, term by term */
static inline void se3di_b_transposed_mul(const double p[4], const double a[3], const double y[3],
                                          double out[4])
{
    const double ay = se3di_dot(a, y);
    const double ey = se3di_dot(p + 1, y);
    const double ea = se3di_dot(p + 1, a);
    double n[3];
    se3di_cross(a, y, n);
    out[0] = 2.0 * (ay * p[0] + se3di_dot(n, p + 1));
    for (int k = 0; k < 3; ++k) {
        out[k + 1] = 2.0 * (p[0] * n[k] + a[k] * ey + y[k] * ea - ay * p[k + 1]);
    }
}

/* The full matrices, row-major: B 3 x 4, K 4 x 4, G 3 x 4. */
static inline void se3di_b_matrix(const double p[4], const double a[3], double B[12])
{
    const double ea = se3di_dot(p + 1, a);
    double turned[3];
    double tilde[9];
    se3di_cross(p + 1, a, turned);
    se3di_tilde(a, tilde);
    for (int r = 0; r < 3; ++r) {
        B[4 * r] = 2.0 * (p[0] * a[r] + turned[r]);
        for (int c = 0; c < 3; ++c) {
            /* tilde(e) tilde(a) = a e^T - (e.a) I */
            B[4 * r + 1 + c] = 2.0 * (p[r + 1] * a[c] - a[r] * p[c + 1] - p[0] * tilde[3 * r + c]);
        }
        B[4 * r + 1 + r] += 2.0 * ea;
    }
}

void se3di_k_matrix(const double a[3], const double y[3], double K[16]);

static inline void se3di_g_matrix(const double p[4], double G[12])
{
    const double rows[12] = {-p[1], p[0], p[3],  -p[2], -p[2], -p[3],
                             p[0],  p[1], -p[3], p[2],  -p[1], p[0]};
    for (int k = 0; k < 12; ++k) {
        G[k] = rows[k];
    }
}

/* Tangent of the exponential map, T(theta) (3 x 3): if R = exp(tilde(theta(s))), the body-frame
 * rate is T(theta) dtheta/ds.  T = I - (1-cos)/|th|^2 tilde + (|th|-sin)/|th|^3 tilde^2; series
 * near zero. */
void se3di_exp_tangent(const double theta[3], double T[9]);
void se3di_exp_tangent_inverse(const double theta[3], double Tinv[9]);

#endif
