/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers with their derivatives by nine others: a formula that is written with them has exact
 * derivatives. And the same without: where values are all that is wanted, such a formula that is
 * compiled once more gives them, to the bit. */
#ifndef SE3DI_DUAL_H
#define SE3DI_DUAL_H

#include "math/elementary.h"
#include "math/over.h"
#include "math/quick.h"

#include <math.h>

#define SE3DI_DUALS 9

typedef struct se3di_dual {
    double v;
    double d[SE3DI_DUALS];
} se3di_dual;

typedef struct se3di_value {
    double v;
} se3di_value;

static inline se3di_dual se3di_dual_of(double value)
{
    return (se3di_dual){.v = value};
}

/* The number of which the derivatives are taken, times `slope`. */
static inline se3di_dual se3di_dual_seed(double value, int number, double slope)
{
    se3di_dual x = {.v = value};
    x.d[number] = slope;
    return x;
}

/* f(x) with the slope f'(x) */
static inline se3di_dual se3di_dual_chain(double f, double slope, se3di_dual x)
{
    x.v = f;
    for (int k = 0; k < SE3DI_DUALS; ++k) {
        x.d[k] *= slope;
    }
    return x;
}

/* f(x, y) with the slopes f_x and f_y */
static inline se3di_dual se3di_dual_chain2(double f, double f_x, se3di_dual x, double f_y,
                                           se3di_dual y)
{
    x.v = f;
    for (int k = 0; k < SE3DI_DUALS; ++k) {
        x.d[k] = f_x * x.d[k] + f_y * y.d[k];
    }
    return x;
}

#define DUAL     se3di_dual
#define OF(name) se3di_dual_##name
#include "math/dual.inc"
#undef DUAL
#undef OF

/* ---- values alone ---- */

static inline se3di_value se3di_value_of(double value)
{
    return (se3di_value){value};
}

static inline se3di_value se3di_value_seed(double value, int number, double slope)
{
    (void)number;
    (void)slope;
    return (se3di_value){value};
}

static inline se3di_value se3di_value_chain(double f, double slope, se3di_value x)
{
    (void)slope;
    x.v = f;
    return x;
}

static inline se3di_value se3di_value_chain2(double f, double f_x, se3di_value x, double f_y,
                                             se3di_value y)
{
    (void)f_x;
    (void)f_y;
    (void)y;
    x.v = f;
    return x;
}

#define DUAL     se3di_value
#define OF(name) se3di_value_##name
#include "math/dual.inc"
#undef DUAL
#undef OF

#endif
