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

static SE3DI_EITHER void jacobian(se3di_way way, SE3DI_ON_TERM, double *phi_i, double *phi_j)
{
    vectors x = vectors_of(t, i, j);
    double arm_i[4];
    double arm_j[4];
    se3di_copy(x.n, phi_j);
    se3di_scale(-1.0, x.n, phi_i);
    se3di_gradient(way, i, t->a_i, x.y, phi_i + 3);
    se3di_gradient(way, i, t->s_i, x.n, arm_i);
    se3di_gradient(way, j, t->a_j, x.z, phi_j + 3);
    se3di_gradient(way, j, t->s_j, x.n, arm_j);
    for (int k = 0; k < se3di_turns(way); ++k) {
        phi_i[3 + k] -= arm_i[k];
        phi_j[3 + k] += arm_j[k];
    }
}

/* Rates and velocity parts of u, v, d. */
typedef struct motion {
    double udot[3], vdot[3], ddot[3];
    double u_term[3], v_term[3], d_term[3];
} motion;

static double gamma_by(const vectors *x, const motion *m)
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

static SE3DI_EITHER double gamma_of(se3di_way way, SE3DI_ON_TERM)
{
    vectors x = vectors_of(t, i, j);
    motion m;
    se3di_rate(way, i, t->a_i, m.udot);
    se3di_rate(way, j, t->a_j, m.vdot);
    se3di_distance_rate(way, t, i, j, m.ddot);
    se3di_velocity_term(way, i, t->a_i, m.u_term);
    se3di_velocity_term(way, j, t->a_j, m.v_term);
    se3di_distance_velocity_term(way, t, i, j, m.d_term);
    return gamma_by(&x, &m);
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
    double vD[3 * SE3DI_TERM_TOTAL];
    double uD[3 * SE3DI_TERM_TOTAL];
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

static SE3DI_EITHER void curvature(se3di_way way, SE3DI_ON_TERM, double lambda, double *H)
{
    const int n = se3di_columns(way), I = SE3DI_ROTATION_I, J = se3di_rotation_j(way);
    vectors x = vectors_of(t, i, j);
    double U[12];
    double V[12];
    double D[3 * SE3DI_TERM_TOTAL];
    se3di_derivative(way, i, t->a_i, U);
    se3di_derivative(way, j, t->a_j, V);
    se3di_distance_derivative(way, t, i, j, D);
    add_products(&x, lambda, U, V, se3di_turns(way), D, n, H);
    se3di_add_curvature(way, se3di_block(H, n, I, I), i, lambda, t->a_i, x.y);
    se3di_add_curvature(way, se3di_block(H, n, I, I), i, -lambda, t->s_i, x.n);
    se3di_add_curvature(way, se3di_block(H, n, J, J), j, lambda, t->a_j, x.z);
    se3di_add_curvature(way, se3di_block(H, n, J, J), j, lambda, t->s_j, x.n);
}

SE3DI_PRIMITIVE_JACOBIANS(triple, jacobian)
SE3DI_PRIMITIVE_GAMMAS(triple, gamma_of)
SE3DI_PRIMITIVE_CURVATURES(triple, curvature)
