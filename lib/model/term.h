/* SPDX-License-Identifier: BSD-3-Clause */
/* The data of a constraint primitive: the frames of two bodies and what is fixed on them. The
 * functions of the primitives are in primitive/. */
#ifndef SE3DI_MODEL_TERM_H
#define SE3DI_MODEL_TERM_H

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

/* X(TYPE, name): lib/primitive/<name>.c has the functions of each.
 *
 *     dp1      a_i . a_j
 *     dp2      a_i . d_ij
 *     d        d_ij . d_ij
 *     cd       c . d_ij, c in the ground frame
 *     angle    angle from a_i to a_j about b_i (right-handed), in (-pi, pi]
 *     triple   d_ij . (a_i x a_j)                                       */
#define SE3DI_PRIMITIVE_LIST(X)                                                                    \
    X(DP1, dp1)                                                                                    \
    X(DP2, dp2)                                                                                    \
    X(D, d)                                                                                        \
    X(CD, cd)                                                                                      \
    X(ANGLE, angle)                                                                                \
    X(TRIPLE, triple)

typedef enum se3di_primitive_type {
#define SE3DI_PRIMITIVE_ENUM(TYPE, name) SE3DI_PRIMITIVE_##TYPE,
    SE3DI_PRIMITIVE_LIST(SE3DI_PRIMITIVE_ENUM)
#undef SE3DI_PRIMITIVE_ENUM
        SE3DI_PRIMITIVE_COUNT
} se3di_primitive_type;

typedef struct se3di_term {
    int32_t type;            /* se3di_primitive_type */
    int32_t angle;           /* ANGLE: index of the turn counter (model), -1: none */
    uint32_t body_i, body_j; /* dense indices, 0 = ground */
    double coefficient;      /* factor of this term in its equation */
    double a_i[3], a_j[3];   /* directions, body frames (ANGLE: unit) */
    double b_i[3];           /* ANGLE: unit axis on body i, perpendicular to a_i */
    double s_i[3], s_j[3];   /* points, body frames [m] */
    double c[3];             /* CD: direction, ground frame */
} se3di_term;

#endif
