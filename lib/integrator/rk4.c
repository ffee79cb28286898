/* SPDX-License-Identifier: BSD-3-Clause */
/* rk4: the classical method of order 4 of Kutta (1901). The derivative at the end of the step,
 * which begins the next one, gives an error estimate for nothing: the weights (1/6, 1/3, 1/3, 0,
 * 1/6) of the four stages and the end meet all conditions of order 3 and one of those of order 4
 * not, so that
 *
 *     error = h/6 (K_4 - K_5)
 *
 * In a motion of one freedom it passes through zero while the error does not (a pendulum at rest
 * with its arm horizontal): the choice of steps counts with the fifth derivative of the motion over
 * two steps, too.
 *
 * Dense output: the cubic through both ends and their derivatives.
 * docs/theory/explicit-runge-kutta.md */
#include "integrator/explicit_rk.h"

static const double a[SE3DI_RK_MAX][SE3DI_RK_MAX] = {
    [1] = {0.5},
    [2] = {0.0, 0.5},
    [3] = {0.0, 0.0, 1.0},
    [4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0},
};
static const double c[SE3DI_RK_MAX] = {0.0, 0.5, 0.5, 1.0, 1.0};
static const double e[SE3DI_RK_MAX] = {0.0, 0.0, 0.0, 1.0 / 6.0, -1.0 / 6.0};

static const se3di_rk_tableau tableau = {
    .stages = 4,
    .total = 5,
    .order = 4,
    .uses_end = 1,
    .second = 1.0,
    .dense_rows = 0,
    .a = a,
    .c = c,
    .error = e,
    .error3 = NULL,
    .d = NULL,
};

const se3di_integrator se3di_integrator_rk4 = {
    .name = "rk4",
    .tag = SE3D_METHOD_RK4,
    SE3DI_RK_METHOD(&tableau),
    .orders = 1u << 4,
};
