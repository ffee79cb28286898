/* SPDX-License-Identifier: BSD-3-Clause */
/* Explicit Runge-Kutta methods:
 *
 *     y = (r, p, v, w) of every free body,   y' = (v, 1/2 G(p)^T w, a, wdot),   p is normalised
 *     K_i = y'(t + c_i h, y + h sum_j a_ij K_j),   y_1 = y + h sum_i b_i K_i
 *
 * Interpolation, s = (t - t_0)/h:
 *
 *     y(t) = y_0 + s (F_0 + (1 - s)(F_1 + s (F_2 + (1 - s)(F_3 + s (...)))))
 *     F_0 = y_1 - y_0,  F_1 = h y'_0 - F_0,  F_2 = 2 F_0 - h (y'_0 + y'_1),  F_3.. = h sum d_i K_i
 *
 * (Hairer, Norsett, Wanner 1993, sec. II.6 and II.10.)  docs/theory/explicit-runge-kutta.md */
#ifndef SE3DI_EXPLICIT_RK_H
#define SE3DI_EXPLICIT_RK_H

#include "integrator/explicit_step.h"

#define SE3DI_RK_MAX       16 /* stages, those of dense output included */
#define SE3DI_RK_DENSE_MAX 4

typedef struct se3di_rk_tableau {
    int stages;     /* of a step; the derivative at its end is K[stages] */
    int total;      /* with K[stages] and the extra stages of dense output */
    int order;      /* of the error estimate's root: err^(-1/order) */
    double stable;  /* |h lambda| from which the step is held by stability */
    int uses_end;   /* the error estimate uses K[stages] */
    double second;  /* weight of the second estimate for the next step, h^5/120 of the fifth
                       derivative of the motion; 0: there is none */
    int dense_rows; /* rows of d */
    const double (*a)[SE3DI_RK_MAX];
    const double *c;
    const double *error;  /* difference of two formulas */
    const double *error3; /* a second one of order 3 (dop853), or NULL */
    const double (*d)[SE3DI_RK_MAX];
    const double (*free)[SE3DI_RK_MAX]; /* rows of d without extra stages, an order less; or NULL */
    double free_error;                  /* the part of the last of them that is their error */
} se3di_rk_tableau;

extern const se3di_explicit_class se3di_rk_class;

/* What the entries of all of them in the table of methods have; `table` points to their own. */
#define SE3DI_RK_METHOD(table)                                                                     \
    SE3DI_EXPLICIT_METHOD, .explicit_class = &se3di_rk_class, .tableau = (table)

#endif
