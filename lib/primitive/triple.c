/* SPDX-License-Identifier: BSD-3-Clause */
/* TRIPLE: the distance of two points along the common normal of a direction on body i and a
 * direction on body j is prescribed.
 *
 *     Phi     = d.(u x v),  u = A_i a_i,  v = A_j a_j,  d = r_j + A_j s_j - r_i - A_i s_i
 *     with the cofactors  n = u x v,  y = v x d,  z = d x u  (of d, u, v), g(a, y) the gradient of
 *     (A a).y with respect to the rotation (kernel.h):
 *     phi_i   = [-n, g_i(a_i, y) - g_i(s_i, n)]       phi_j = [n, g_j(a_j, z) + g_j(s_j, n)]
 *     gamma   = - n.d'' - y.u'' - z.v'' - 2 [d.(udot x vdot) + ddot.(udot x v + u x vdot)]
 *     u'', v'', d'': velocity parts, as in dp1.c and dp2.c
 *
 * Removes one degree of freedom; degenerate if u and v are parallel and d = 0.
 * docs/theory/triple.md */
#include "primitive/kernel.h"
#include "primitive/table.h"

typedef struct vectors {
    double u[3], v[3], d[3];
    double n[3], y[3], z[3]; /* cofactors of d, u, v */
} vectors;

static vectors vectors_of(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    vectors x;
    se3di_mul(i->A, t->a_i, x.u);
    se3di_mul(j->A, t->a_j, x.v);
    se3di_term_distance(t, i, j, x.d);
    se3di_cross(x.u, x.v, x.n);
    se3di_cross(x.v, x.d, x.y);
    se3di_cross(x.d, x.u, x.z);
    return x;
}

double se3di_primitive_triple_value(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    vectors x = vectors_of(t, i, j);
    return se3di_dot(x.d, x.n);
}

void se3di_primitive_triple_jacobian_romega(const se3di_term *t, const se3di_frame *i,
                                            const se3di_frame *j, double phi_i[6], double phi_j[6])
{
    vectors x = vectors_of(t, i, j);
    double arm[3];
    se3di_copy(x.n, phi_j);
    se3di_scale(-1.0, x.n, phi_i);
    se3di_romega_gradient(i, t->a_i, x.y, phi_i + 3);
    se3di_romega_gradient(i, t->s_i, x.n, arm);
    se3di_sub(phi_i + 3, arm, phi_i + 3);
    se3di_romega_gradient(j, t->a_j, x.z, phi_j + 3);
    se3di_romega_gradient(j, t->s_j, x.n, arm);
    se3di_add(phi_j + 3, arm, phi_j + 3);
}

void se3di_primitive_triple_jacobian_rp(const se3di_term *t, const se3di_frame *i,
                                        const se3di_frame *j, double phi_i[7], double phi_j[7])
{
    vectors x = vectors_of(t, i, j);
    double arm_i[4];
    double arm_j[4];
    se3di_copy(x.n, phi_j);
    se3di_scale(-1.0, x.n, phi_i);
    se3di_rp_gradient(i, t->a_i, x.y, phi_i + 3);
    se3di_rp_gradient(i, t->s_i, x.n, arm_i);
    se3di_rp_gradient(j, t->a_j, x.z, phi_j + 3);
    se3di_rp_gradient(j, t->s_j, x.n, arm_j);
    for (int k = 0; k < 4; ++k) {
        phi_i[3 + k] -= arm_i[k];
        phi_j[3 + k] += arm_j[k];
    }
}

/* Rates and velocity parts of u, v, d. */
typedef struct motion {
    double udot[3], vdot[3], ddot[3];
    double u_term[3], v_term[3], d_term[3];
} motion;

static double gamma_of(const vectors *x, const motion *m)
{
    double both[3];
    double left[3];
    double right[3];
    se3di_cross(m->udot, m->vdot, both);
    se3di_cross(m->udot, x->v, left);
    se3di_cross(x->u, m->vdot, right);
    return -se3di_dot(x->n, m->d_term) - se3di_dot(x->y, m->u_term) - se3di_dot(x->z, m->v_term) -
           2.0 * (se3di_dot(x->d, both) + se3di_dot(m->ddot, left) + se3di_dot(m->ddot, right));
}

double se3di_primitive_triple_gamma_romega(const se3di_term *t, const se3di_frame *i,
                                           const se3di_frame *j)
{
    vectors x = vectors_of(t, i, j);
    motion m;
    se3di_romega_rate(i, t->a_i, m.udot);
    se3di_romega_rate(j, t->a_j, m.vdot);
    se3di_romega_distance_rate(t, i, j, m.ddot);
    se3di_romega_velocity_term(i, t->a_i, m.u_term);
    se3di_romega_velocity_term(j, t->a_j, m.v_term);
    se3di_romega_distance_velocity_term(t, i, j, m.d_term);
    return gamma_of(&x, &m);
}

double se3di_primitive_triple_gamma_rp(const se3di_term *t, const se3di_frame *i,
                                       const se3di_frame *j)
{
    vectors x = vectors_of(t, i, j);
    motion m;
    se3di_rp_rate(i, t->a_i, m.udot);
    se3di_rp_rate(j, t->a_j, m.vdot);
    se3di_rp_distance_rate(t, i, j, m.ddot);
    se3di_rp_velocity_term(i, t->a_i, m.u_term);
    se3di_rp_velocity_term(j, t->a_j, m.v_term);
    se3di_rp_distance_velocity_term(t, i, j, m.d_term);
    return gamma_of(&x, &m);
}

/* out = tilde(w) X, X 3 x columns */
static void cross_columns(const double w[3], const double *X, int columns, double *out)
{
    for (int c = 0; c < columns; ++c) {
        const double x[3] = {X[c], X[columns + c], X[2 * columns + c]};
        double y[3];
        se3di_cross(w, x, y);
        out[c] = y[0];
        out[columns + c] = y[1];
        out[2 * columns + c] = y[2];
    }
}

/* The products of the derivatives U (3 x m, columns from i), V (3 x m, columns from j) and D (3 x
 * n) of u, v, d:  y = v x d, z = d x u, n = u x v give
 *     U^T (tilde(v) D - tilde(d) V) + V^T (tilde(d) U - tilde(u) D) + D^T (tilde(u) V - tilde(v) U)
 */
static void add_products(const vectors *x, double lambda, const double *U, const double *V, int m,
                         const double *D, int n, double *H)
{
    const int i = SE3DI_ROTATION_I;
    const int j = n / 2 + SE3DI_ROTATION_I;
    double vD[3 * SE3DI_RP_TOTAL];
    double uD[3 * SE3DI_RP_TOTAL];
    double dU[12];
    double dV[12];
    double vU[12];
    double uV[12];
    cross_columns(x->v, D, n, vD);
    cross_columns(x->u, D, n, uD);
    cross_columns(x->d, U, m, dU);
    cross_columns(x->d, V, m, dV);
    cross_columns(x->v, U, m, vU);
    cross_columns(x->u, V, m, uV);
    se3di_block_add_product(se3di_block(H, n, i, 0), n, lambda, U, m, vD, n);
    se3di_block_add_product(se3di_block(H, n, i, j), n, -lambda, U, m, dV, m);
    se3di_block_add_product(se3di_block(H, n, j, i), n, lambda, V, m, dU, m);
    se3di_block_add_product(se3di_block(H, n, j, 0), n, -lambda, V, m, uD, n);
    se3di_block_add_product(se3di_block(H, n, 0, j), n, lambda, D, n, uV, m);
    se3di_block_add_product(se3di_block(H, n, 0, i), n, -lambda, D, n, vU, m);
}

void se3di_primitive_triple_curvature_romega(const se3di_term *t, const se3di_frame *i,
                                             const se3di_frame *j, double lambda, double H[144])
{
    enum { N = SE3DI_ROMEGA_TOTAL, I = SE3DI_ROTATION_I, J = SE3DI_ROTATION_J_ROMEGA };
    vectors x = vectors_of(t, i, j);
    double U[9];
    double V[9];
    double D[3 * N];
    se3di_romega_derivative(i, t->a_i, U);
    se3di_romega_derivative(j, t->a_j, V);
    se3di_romega_distance_derivative(t, i, j, D);
    add_products(&x, lambda, U, V, 3, D, N, H);
    se3di_romega_add_curvature(se3di_block(H, N, I, I), i, lambda, t->a_i, x.y);
    se3di_romega_add_curvature(se3di_block(H, N, I, I), i, -lambda, t->s_i, x.n);
    se3di_romega_add_curvature(se3di_block(H, N, J, J), j, lambda, t->a_j, x.z);
    se3di_romega_add_curvature(se3di_block(H, N, J, J), j, lambda, t->s_j, x.n);
}

void se3di_primitive_triple_curvature_rp(const se3di_term *t, const se3di_frame *i,
                                         const se3di_frame *j, double lambda, double H[196])
{
    enum { N = SE3DI_RP_TOTAL, I = SE3DI_ROTATION_I, J = SE3DI_ROTATION_J_RP };
    vectors x = vectors_of(t, i, j);
    double U[12];
    double V[12];
    double D[3 * N];
    se3di_rp_derivative(i, t->a_i, U);
    se3di_rp_derivative(j, t->a_j, V);
    se3di_rp_distance_derivative(t, i, j, D);
    add_products(&x, lambda, U, V, 4, D, N, H);
    se3di_rp_add_curvature(se3di_block(H, N, I, I), lambda, t->a_i, x.y);
    se3di_rp_add_curvature(se3di_block(H, N, I, I), -lambda, t->s_i, x.n);
    se3di_rp_add_curvature(se3di_block(H, N, J, J), lambda, t->a_j, x.z);
    se3di_rp_add_curvature(se3di_block(H, N, J, J), lambda, t->s_j, x.n);
}
