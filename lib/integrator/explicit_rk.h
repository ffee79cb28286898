/* SPDX-License-Identifier: BSD-3-Clause */
/* Explicit Runge-Kutta methods with step control and dense output, on index 1: accelerations from
 * the KKT system, then, after every accepted step, projection of positions and velocities onto
 * their constraints.
 *
 *     y = (r, p, v, w) of every free body,   y' = (v, 1/2 G(p)^T w, a, wdot),   p is normalised
 *     K_i = y'(t + c_i h, y + h sum_j a_ij K_j),   y_1 = y + h sum_i b_i K_i
 *
 * The method keeps its own forward state (t_1, y_1, y'_1) in the model's history, up to one step
 * ahead of the model's time: outputs are interpolated, projected and given consistent
 * accelerations, and never change the steps. Interpolation, s = (t - t_0)/h:
 *
 *     y(t) = y_0 + s (F_0 + (1 - s)(F_1 + s (F_2 + (1 - s)(F_3 + s (...)))))
 *     F_0 = y_1 - y_0,  F_1 = h y'_0 - F_0,  F_2 = 2 F_0 - h (y'_0 + y'_1),  F_3.. = h sum d_i K_i
 *
 * (Hairer, Norsett, Wanner 1993, sec. II.6 and II.10.)  docs/theory/explicit-runge-kutta.md */
#ifndef SE3DI_EXPLICIT_RK_H
#define SE3DI_EXPLICIT_RK_H

#include "integrator/integrator.h"

#define SE3DI_RK_MAX       16 /* stages, those of dense output included */
#define SE3DI_RK_DENSE_MAX 4

typedef struct se3di_rk_tableau {
    int stages;     /* of a step; the derivative at its end is K[stages] */
    int total;      /* with K[stages] and the extra stages of dense output */
    int order;      /* of the error estimate's root: err^(-1/order) */
    double stable;  /* |h lambda| from which the step is held by stability */
    int uses_end;   /* the error estimate uses K[stages] */
    int dense_rows; /* rows of d */
    const double (*a)[SE3DI_RK_MAX];
    const double *c;
    const double *error;  /* difference of two formulas */
    const double *error3; /* a second one of order 3 (dop853), or NULL */
    const double (*d)[SE3DI_RK_MAX];
} se3di_rk_tableau;

size_t se3di_rk_history_count(const se3di_assembly *assembly);
size_t se3di_rk_work_count(const se3di_assembly *assembly);
/* Functions of the table of methods, for those that have a tableau. */
se3d_status se3di_rk_start(se3di_integration *integration, double h);
se3d_status se3di_rk_renew(se3di_integration *integration);
/* One step of length h without error control. */
se3d_status se3di_rk_step(se3di_integration *integration, double h);
/* To t_end with step control. */
se3d_status se3di_rk_run(se3di_integration *integration, double t_end);
/* For the table of a method, see integrator.h. */
se3d_status se3di_rk_advance(se3di_integration *integration, double t_end);
void se3di_rk_interpolate(const se3di_integration *integration, double t, double *y);
int se3di_rk_is_held(const se3di_integration *integration);

/* What the entries of all of them in the table of methods have, beside their own `tableau`. */
/* Local errors are a part of the tolerance, and no smaller than rounding allows. */
#define SE3DI_RK_PART  0.03
#define SE3DI_RK_LEAST 2e-13
#define SE3DI_RK_REACH (SE3DI_RK_LEAST / SE3DI_RK_PART)

#define SE3DI_RK_METHOD                                                                            \
    .history_count = se3di_rk_history_count, .work_count = se3di_rk_work_count,                    \
    .start = se3di_rk_start, .renew = se3di_rk_renew, .step = se3di_rk_step, .run = se3di_rk_run,  \
    .advance = se3di_rk_advance, .interpolate = se3di_rk_interpolate, .tableau = &tableau,         \
    .is_explicit = 1, .reach = SE3DI_RK_REACH

#endif
