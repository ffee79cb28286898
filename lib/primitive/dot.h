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

/* Rotational parts only: phi_i[3], phi_j[3]. */
static inline void se3di_dot_gradient_romega(const se3di_frame *i, const double a_i[3],
                                             const se3di_frame *j, const double a_j[3],
                                             double phi_i[3], double phi_j[3])
{
    double u[3];
    double v[3];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_romega_gradient(i, a_i, v, phi_i);
    se3di_romega_gradient(j, a_j, u, phi_j);
}

/* Rotational parts only: phi_i[4], phi_j[4]. */
static inline void se3di_dot_gradient_rp(const se3di_frame *i, const double a_i[3],
                                         const se3di_frame *j, const double a_j[3], double phi_i[4],
                                         double phi_j[4])
{
    double u[3];
    double v[3];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_rp_gradient(i, a_i, v, phi_i);
    se3di_rp_gradient(j, a_j, u, phi_j);
}

static inline double se3di_dot_rate_romega(const se3di_frame *i, const double a_i[3],
                                           const se3di_frame *j, const double a_j[3])
{
    double u[3];
    double v[3];
    double udot[3];
    double vdot[3];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_romega_rate(i, a_i, udot);
    se3di_romega_rate(j, a_j, vdot);
    return se3di_dot(udot, v) + se3di_dot(u, vdot);
}

static inline double se3di_dot_rate_rp(const se3di_frame *i, const double a_i[3],
                                       const se3di_frame *j, const double a_j[3])
{
    double u[3];
    double v[3];
    double udot[3];
    double vdot[3];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_rp_rate(i, a_i, udot);
    se3di_rp_rate(j, a_j, vdot);
    return se3di_dot(udot, v) + se3di_dot(u, vdot);
}

static inline double se3di_dot_gamma_romega(const se3di_frame *i, const double a_i[3],
                                            const se3di_frame *j, const double a_j[3])
{
    double u[3];
    double v[3];
    double udot[3];
    double vdot[3];
    double u_term[3];
    double v_term[3];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_romega_rate(i, a_i, udot);
    se3di_romega_rate(j, a_j, vdot);
    se3di_romega_velocity_term(i, a_i, u_term);
    se3di_romega_velocity_term(j, a_j, v_term);
    return -se3di_dot(v, u_term) - se3di_dot(u, v_term) - 2.0 * se3di_dot(udot, vdot);
}

static inline double se3di_dot_gamma_rp(const se3di_frame *i, const double a_i[3],
                                        const se3di_frame *j, const double a_j[3])
{
    double u[3];
    double v[3];
    double udot[3];
    double vdot[3];
    double u_term[3];
    double v_term[3];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_rp_rate(i, a_i, udot);
    se3di_rp_rate(j, a_j, vdot);
    se3di_rp_velocity_term(i, a_i, u_term);
    se3di_rp_velocity_term(j, a_j, v_term);
    return -se3di_dot(v, u_term) - se3di_dot(u, v_term) - 2.0 * se3di_dot(udot, vdot);
}

static inline void se3di_dot_curvature_romega(const se3di_frame *i, const double a_i[3],
                                              const se3di_frame *j, const double a_j[3],
                                              double lambda, double H[144])
{
    enum { N = SE3DI_ROMEGA_TOTAL, I = SE3DI_ROTATION_I, J = SE3DI_ROTATION_J_ROMEGA };
    double u[3];
    double v[3];
    double D_i[9];
    double D_j[9];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_romega_derivative(i, a_i, D_i);
    se3di_romega_derivative(j, a_j, D_j);
    se3di_romega_add_curvature(se3di_block(H, N, I, I), i, lambda, a_i, v);
    se3di_romega_add_curvature(se3di_block(H, N, J, J), j, lambda, a_j, u);
    se3di_block_add_product(se3di_block(H, N, I, J), N, lambda, D_i, 3, D_j, 3);
    se3di_block_add_product(se3di_block(H, N, J, I), N, lambda, D_j, 3, D_i, 3);
}

static inline void se3di_dot_curvature_rp(const se3di_frame *i, const double a_i[3],
                                          const se3di_frame *j, const double a_j[3], double lambda,
                                          double H[196])
{
    enum { N = SE3DI_RP_TOTAL, I = SE3DI_ROTATION_I, J = SE3DI_ROTATION_J_RP };
    double u[3];
    double v[3];
    double D_i[12];
    double D_j[12];
    se3di_mul(i->A, a_i, u);
    se3di_mul(j->A, a_j, v);
    se3di_rp_derivative(i, a_i, D_i);
    se3di_rp_derivative(j, a_j, D_j);
    se3di_rp_add_curvature(se3di_block(H, N, I, I), lambda, a_i, v);
    se3di_rp_add_curvature(se3di_block(H, N, J, J), lambda, a_j, u);
    se3di_block_add_product(se3di_block(H, N, I, J), N, lambda, D_i, 4, D_j, 4);
    se3di_block_add_product(se3di_block(H, N, J, I), N, lambda, D_j, 4, D_i, 4);
}

#endif
