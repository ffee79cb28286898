/* SPDX-License-Identifier: BSD-3-Clause */
/* Constraint primitives: scalar functions of the poses of two bodies, each with the same functions.
 *
 * A term is one primitive with its data. A constraint equation (model/) is
 *
 *     Phi = sum_k coefficient_k * value(term_k) - f(t)
 *
 * so that everything here is free of time: nu and the time part of gamma are added by the equation.
 *
 * Jacobians, per body:
 *     r-omega: 6 numbers, [d/dr (ground frame), d/dtheta (virtual rotation in the body frame)]
 *     r-p:     7 numbers, [d/dr, d/dp], the B-matrix form (p counted as four independent numbers)
 * gamma: the right-hand side of  Phi_q qddot = gamma  for f = 0: minus the velocity terms; r-omega
 * with qddot = (a, wdot in the body frame), r-p with (a, pddot). curvature: the derivative of
 * Phi_q^T lambda with respect to q, *added* to H (12 x 12 or 14 x 14, row-major, order body i, body
 * j). In r-omega the derivative of the body-frame torque with respect to the body-frame virtual
 * rotations A -> A exp(tilde(dtheta)): in general not symmetric. */
#ifndef SE3DI_PRIMITIVE_H
#define SE3DI_PRIMITIVE_H

#include <stdint.h>

/* Position-level and velocity-level state of a body, with what follows from it. */
typedef struct se3di_frame {
    double r[3];    /* centre of mass, ground frame [m] */
    double p[4];    /* Euler parameters */
    double A[9];    /* body -> ground, row-major, A(p) */
    double v[3];    /* velocity of the centre of mass, ground frame [m/s] */
    double w[3];    /* angular velocity, body frame [rad/s] */
    double pdot[4]; /* 1/2 G(p)^T w */
} se3di_frame;

typedef enum se3di_primitive_type {
    SE3DI_PRIMITIVE_DP1 = 0,   /* a_i . a_j */
    SE3DI_PRIMITIVE_DP2 = 1,   /* a_i . d_ij */
    SE3DI_PRIMITIVE_D = 2,     /* d_ij . d_ij */
    SE3DI_PRIMITIVE_CD = 3,    /* c . d_ij, c in the ground frame */
    SE3DI_PRIMITIVE_ANGLE = 4, /* angle from a_i to a_j about b_i (right-handed), in (-pi, pi] */
    SE3DI_PRIMITIVE_COUNT = 5
} se3di_primitive_type;

typedef struct se3di_term {
    int32_t type;            /* se3di_primitive_type */
    int32_t angle;           /* ANGLE: index of the turn counter (model), -1: none */
    uint32_t body_i, body_j; /* dense indices, 0 = ground */
    double coefficient;      /* factor of this term in its equation */
    double a_i[3], a_j[3];   /* directions, body frames (ANGLE: unit) */
    double b_i[3];           /* ANGLE: unit axis on body i, square to a_i */
    double s_i[3], s_j[3];   /* points, body frames [m] */
    double c[3];             /* CD: direction, ground frame */
} se3di_term;

typedef struct se3di_primitive {
    const char *name; /* "dp1" */
    double (*value)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j);
    void (*jacobian_romega)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                            double phi_i[6], double phi_j[6]);
    void (*jacobian_rp)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                        double phi_i[7], double phi_j[7]);
    double (*gamma_romega)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j);
    double (*gamma_rp)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j);
    void (*curvature_romega)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                             double lambda, double H[144]);
    void (*curvature_rp)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                         double lambda, double H[196]);
} se3di_primitive;

/* The table, indexed by se3di_primitive_type. Values and Jacobians ignore `coefficient`. */
extern const se3di_primitive se3di_primitives[SE3DI_PRIMITIVE_COUNT];

#endif
