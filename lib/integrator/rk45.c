/* SPDX-License-Identifier: BSD-3-Clause */
/* rk45: the 7-stage method of order 5 with error estimate of order 4 of Dormand and Prince (1980),
 * with the dense output of order 4 of Hairer, Norsett and Wanner (1993, sec. II.6).
 * docs/theory/explicit-runge-kutta.md */
#include "integrator/explicit_rk.h"

static const double a[SE3DI_RK_MAX][SE3DI_RK_MAX] = {
    [1] = {1.0 / 5.0},
    [2] = {3.0 / 40.0, 9.0 / 40.0},
    [3] = {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    [4] = {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    [5] = {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    [6] = {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
};
static const double c[SE3DI_RK_MAX] = {0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0};
static const double e[SE3DI_RK_MAX] = {
    71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
    -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};
static const double d[1][SE3DI_RK_MAX] = {
    {-12715105075.0 / 11282082432.0, 0.0, 87487479700.0 / 32700410799.0,
     -10690763975.0 / 1880347072.0, 701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0,
     69997945.0 / 29380423.0},
};

static const se3di_rk_tableau tableau = {
    .stages = 6,
    .total = 7,
    .order = 5,
    .stable = 3.25,
    .uses_end = 1,
    .dense_rows = 1,
    .a = a,
    .c = c,
    .error = e,
    .error3 = NULL,
    .d = d,
};

const se3di_integrator se3di_integrator_rk45 = {
    .name = "rk45",
    .tag = SE3D_METHOD_RK45,
    SE3DI_RK_METHOD(&tableau),
    .is_held = se3di_explicit_is_held,
    .orders = 1u << 5,
};
