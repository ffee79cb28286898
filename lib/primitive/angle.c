/* SPDX-License-Identifier: BSD-3-Clause */
/* ANGLE: the angle from a_i to a_j about the axis b_i is prescribed.
 *
 *     Phi     = theta = atan2(s, c),  c = f.h,  s = g.h,  q = c^2 + s^2
 *               f = A_i a_i,  g = A_i (b_i x a_i),  h = A_j a_j       (c and s are DP1)
 *     With the complex logarithm rho + i theta = log(c + i s), rho = log(q)/2, and the vectors of
 *     body i  m = (c (b_i x a_i) - s a_i)/q  and  n = (c a_i + s (b_i x a_i))/q  held fixed:
 *     theta_q = Jacobian of DP1(m, a_j)             rho_q = Jacobian of DP1(n, a_j)
 *     gamma   = gamma of DP1(m, a_j) + 2 (theta_q qdot) (rho_q qdot)
 *     theta_qq = curvature of DP1(m, a_j) - theta_q^T rho_q - rho_q^T theta_q
 *     in both formulations.
 *
 * Removes one rotational degree of freedom, at every angle; degenerate only if a_j is parallel
 * to b_i (q = 0): all functions are NaN there.  docs/theory/angle.md */
#include "math/elementary.h"
#include "math/over.h"
#include "primitive/dot.h"
#include "primitive/table.h"

typedef struct angle_vectors {
    double m[3], n[3]; /* body i; NaN if q = 0 */
} angle_vectors;

/* c and s of the head. */
static inline void cosine_and_sine(const se3di_term *t, const se3di_frame *i, const se3di_frame *j,
                                   double g[3], double cs[2])
{
    double h[3];
    double local[3]; /* A_i^T h */
    se3di_cross(t->b_i, t->a_i, g);
    se3di_mul(j->A, t->a_j, h);
    se3di_mul_transposed(i->A, h, local);
    cs[0] = se3di_dot(t->a_i, local);
    cs[1] = se3di_dot(g, local);
}

static inline angle_vectors vectors_of(const se3di_term *t, const se3di_frame *i,
                                       const se3di_frame *j)
{
    double g[3];
    double cs[2];
    cosine_and_sine(t, i, j, g, cs);
    const double q = cs[0] * cs[0] + cs[1] * cs[1];
    angle_vectors x;
    for (int k = 0; k < 3; ++k) {
        x.m[k] = se3di_over(cs[0] * g[k] - cs[1] * t->a_i[k], q);
        x.n[k] = se3di_over(cs[0] * t->a_i[k] + cs[1] * g[k], q);
    }
    return x;
}

double se3di_primitive_angle_value(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    double g[3];
    double cs[2];
    cosine_and_sine(t, i, j, g, cs);
    if (cs[0] * cs[0] + cs[1] * cs[1] == 0.0) {
        return (double)NAN;
    }
    return se3di_atan2(cs[1] + 0.0, cs[0]); /* + 0.0: s = -0 is at pi, not -pi */
}

static SE3DI_EITHER void jacobian(se3di_way way, SE3DI_ON_TERM, double *phi_i, double *phi_j)
{
    const angle_vectors x = vectors_of(t, i, j);
    for (int k = 0; k < 3; ++k) {
        phi_i[k] = phi_j[k] = 0.0;
    }
    se3di_dot_gradient(way, i, x.m, j, t->a_j, phi_i + 3, phi_j + 3);
}

static SE3DI_EITHER double gamma_of(se3di_way way, SE3DI_ON_TERM)
{
    const angle_vectors x = vectors_of(t, i, j);
    return se3di_dot_gamma(way, i, x.m, j, t->a_j) +
           2.0 * se3di_dot_rate(way, i, x.m, j, t->a_j) * se3di_dot_rate(way, i, x.n, j, t->a_j);
}

/* H -= lambda (theta_q^T rho_q + rho_q^T theta_q), where theta_q and rho_q hold the `half`
 * rotational entries of body i and then those of body j; H has n columns, 3 of translation before
 * each half. */
static inline void add_rank_two(double *H, int n, double lambda, const double *theta_q,
                                const double *rho_q, int half)
{
    for (int r = 0; r < 2 * half; ++r) {
        double *row = H + n * (r < half ? 3 + r : 6 + r);
        const double a = lambda * theta_q[r];
        const double b = lambda * rho_q[r];
        for (int c = 0; c < half; ++c) {
            row[3 + c] -= a * rho_q[c] + b * theta_q[c];
            row[6 + half + c] -= a * rho_q[half + c] + b * theta_q[half + c];
        }
    }
}

static SE3DI_EITHER void curvature(se3di_way way, SE3DI_ON_TERM, double lambda, double *H)
{
    const int m = se3di_turns(way);
    const angle_vectors x = vectors_of(t, i, j);
    double theta_q[8];
    double rho_q[8];
    se3di_dot_gradient(way, i, x.m, j, t->a_j, theta_q, theta_q + m);
    se3di_dot_gradient(way, i, x.n, j, t->a_j, rho_q, rho_q + m);
    se3di_dot_curvature(way, i, x.m, j, t->a_j, lambda, H);
    add_rank_two(H, se3di_columns(way), lambda, theta_q, rho_q, m);
}

SE3DI_PRIMITIVE_JACOBIANS(angle, jacobian)
SE3DI_PRIMITIVE_GAMMAS(angle, gamma_of)
SE3DI_PRIMITIVE_CURVATURES(angle, curvature)
