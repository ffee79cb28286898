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

void se3di_quat_to_matrix(const double p[4], double A[9]);

/* Euler parameters with e0 >= 0 of the rotation matrix A. */
void se3di_quat_from_matrix(const double A[9], double p[4]);

/* p of a turn by `angle` about the unit vector `axis`. */
void se3di_quat_from_axis_angle(const double axis[3], double angle, double p[4]);

/* out = p q (apply q first); aliasing allowed. */
void se3di_quat_mul(const double p[4], const double q[4], double out[4]);

/* p / |p|; aliasing allowed. Returns |p|. */
double se3di_quat_normalize(const double p[4], double out[4]);

/* p exp(theta): turn by the rotation vector `theta` of the body frame; aliasing allowed. */
void se3di_quat_rotate(const double p[4], const double theta[3], double out[4]);

/* The rotation vector theta (body frame of p, |theta| <= pi) with q = +-p exp(theta). */
void se3di_quat_log(const double p[4], const double q[4], double theta[3]);

/* pdot = 1/2 G(p)^T w */
void se3di_quat_rate(const double p[4], const double w[3], double pdot[4]);

/* w = 2 G(p) pdot */
void se3di_quat_angular_velocity(const double p[4], const double pdot[4], double w[3]);

/* pddot = 1/2 G(p)^T wdot - 1/4 (w.w) p, for |p| = 1 */
void se3di_quat_acceleration(const double p[4], const double w[3], const double wdot[3],
                             double pddot[4]);

/* out = G(p)^T y and out = G(p) x */
void se3di_g_transposed_mul(const double p[4], const double y[3], double out[4]);
void se3di_g_mul(const double p[4], const double x[4], double out[3]);

/* out = B(p,a) x */
void se3di_b_mul(const double p[4], const double a[3], const double x[4], double out[3]);

/* out = B(p,a)^T y = K(a,y) p */
void se3di_b_transposed_mul(const double p[4], const double a[3], const double y[3], double out[4]);

/* The full matrices, row-major: B 3 x 4, K 4 x 4, G 3 x 4. */
void se3di_b_matrix(const double p[4], const double a[3], double B[12]);
void se3di_k_matrix(const double a[3], const double y[3], double K[16]);
void se3di_g_matrix(const double p[4], double G[12]);

/* Tangent of the exponential map, T(theta) (3 x 3): if R = exp(tilde(theta(s))), the body-frame
 * rate is T(theta) dtheta/ds.  T = I - (1-cos)/|th|^2 tilde + (|th|-sin)/|th|^3 tilde^2; series
 * near zero. */
void se3di_exp_tangent(const double theta[3], double T[9]);
void se3di_exp_tangent_inverse(const double theta[3], double Tinv[9]);

#endif
