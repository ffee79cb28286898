/* SPDX-License-Identifier: BSD-3-Clause */
/* The algebra of (A_i a_i).(A_j a_j), shared by DP1 and ANGLE; formulas in dp1.c. */
#ifndef SE3DI_PRIMITIVE_DOT_H
#define SE3DI_PRIMITIVE_DOT_H

#include "primitive/kernel.h"

static inline double se3di_dot_value(const se3di_frame *i, const double a_i[3],
                                     const se3di_frame *j, const double a_j[3])
{
    double u[3];
    double v[3];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    return se3di_dot(u, v);
}

/* Rotational parts only: 3 or 4 numbers each. */
static SE3DI_EITHER void se3di_dot_gradient(se3di_way way, const se3di_frame *i,
                                            const double a_i[3], const se3di_frame *j,
                                            const double a_j[3], double *phi_i, double *phi_j)
{
    double u[3];
    double v[3];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_gradient(way, i, a_i, v, phi_i);
    se3di_gradient(way, j, a_j, u, phi_j);
}

/* Both directions in the ground frame, and their rates. */
typedef struct se3di_dot_motion {
    double u[3], v[3], udot[3], vdot[3];
} se3di_dot_motion;

static SE3DI_EITHER void se3di_dot_move(se3di_way way, const se3di_frame *i, const double a_i[3],
                                        const se3di_frame *j, const double a_j[3],
                                        se3di_dot_motion *m)
{
    se3di_mul(i->A, a_i, m->u);
    se3di_mul(j->A, a_j, m->v);
    se3di_rate(way, i, a_i, m->udot);
    se3di_rate(way, j, a_j, m->vdot);
}

static SE3DI_EITHER double se3di_dot_rate(se3di_way way, const se3di_frame *i, const double a_i[3],
                                          const se3di_frame *j, const double a_j[3])
{
    se3di_dot_motion m;
    se3di_dot_move(way, i, a_i, j, a_j, &m);
    return se3di_dot(m.udot, m.v) + se3di_dot(m.u, m.vdot);
}

static SE3DI_EITHER double se3di_dot_gamma(se3di_way way, const se3di_frame *i, const double a_i[3],
                                           const se3di_frame *j, const double a_j[3])
{
    se3di_dot_motion m;
    double u_term[3];
    double v_term[3];
    se3di_dot_move(way, i, a_i, j, a_j, &m);
    se3di_velocity_term(way, i, a_i, u_term);
    se3di_velocity_term(way, j, a_j, v_term);
    return -se3di_dot(m.v, u_term) - se3di_dot(m.u, v_term) - 2.0 * se3di_dot(m.udot, m.vdot);
}

static SE3DI_EITHER void se3di_dot_curvature(se3di_way way, const se3di_frame *i,
                                             const double a_i[3], const se3di_frame *j,
                                             const double a_j[3], double lambda, double *H)
{
    const int n = se3di_columns(way), m = se3di_turns(way);
    double *H_ii = se3di_block(H, n, SE3DI_ROTATION_I, SE3DI_ROTATION_I);
    double *H_jj = se3di_block(H, n, se3di_rotation_j(way), se3di_rotation_j(way));
    double *H_ij = se3di_block(H, n, SE3DI_ROTATION_I, se3di_rotation_j(way));
    double *H_ji = se3di_block(H, n, se3di_rotation_j(way), SE3DI_ROTATION_I);
    double u[3];
    double v[3];
    double D_i[12];
    double D_j[12];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_derivative(way, i, a_i, D_i);
    se3di_derivative(way, j, a_j, D_j);
    se3di_add_curvature(way, H_ii, i, lambda, a_i, v);
    se3di_add_curvature(way, H_jj, j, lambda, a_j, u);
    se3di_block_add_product(H_ij, n, lambda, D_i, m, D_j, m);
    se3di_block_add_product(H_ji, n, lambda, D_j, m, D_i, m);
}

#endif
