/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers with their derivatives by eight others: a formula that is written with them has exact
 * derivatives. */
#ifndef SE3DI_DUAL_H
#define SE3DI_DUAL_H

#include "math/elementary.h"

#include <math.h>

#define SE3DI_DUALS 8

typedef struct se3di_dual {
    double v;
    double d[SE3DI_DUALS];
} se3di_dual;

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

static inline se3di_dual se3di_dual_add(se3di_dual x, se3di_dual y)
{
    return se3di_dual_chain2(x.v + y.v, 1.0, x, 1.0, y);
}

static inline se3di_dual se3di_dual_sub(se3di_dual x, se3di_dual y)
{
    return se3di_dual_chain2(x.v - y.v, 1.0, x, -1.0, y);
}

static inline se3di_dual se3di_dual_mul(se3di_dual x, se3di_dual y)
{
    return se3di_dual_chain2(x.v * y.v, y.v, x, x.v, y);
}

static inline se3di_dual se3di_dual_div(se3di_dual x, se3di_dual y)
{
    const double f = x.v / y.v;
    return se3di_dual_chain2(f, 1.0 / y.v, x, -f / y.v, y);
}

/* a + b x */
static inline se3di_dual se3di_dual_line(double a, double b, se3di_dual x)
{
    return se3di_dual_chain(a + b * x.v, b, x);
}

static inline se3di_dual se3di_dual_scale(double b, se3di_dual x)
{
    return se3di_dual_chain(b * x.v, b, x);
}

/* a + b x + c x^2 */
static inline se3di_dual se3di_dual_square(double a, double b, double c, se3di_dual x)
{
    return se3di_dual_chain(a + (b + c * x.v) * x.v, b + 2.0 * c * x.v, x);
}

/* |x|, at 0 without a slope */
static inline se3di_dual se3di_dual_abs(se3di_dual x)
{
    return se3di_dual_chain(fabs(x.v), x.v > 0.0 ? 1.0 : x.v < 0.0 ? -1.0 : 0.0, x);
}

/* At 0 without a slope. */
static inline se3di_dual se3di_dual_sqrt(se3di_dual x)
{
    const double root = sqrt(x.v);
    return se3di_dual_chain(root, root > 0.0 ? 0.5 / root : 0.0, x);
}

static inline se3di_dual se3di_dual_sin(se3di_dual x)
{
    double sine, cosine;
    se3di_sincos(x.v, &sine, &cosine);
    return se3di_dual_chain(sine, cosine, x);
}

static inline se3di_dual se3di_dual_cos(se3di_dual x)
{
    double sine, cosine;
    se3di_sincos(x.v, &sine, &cosine);
    return se3di_dual_chain(cosine, -sine, x);
}

static inline se3di_dual se3di_dual_atan(se3di_dual x)
{
    return se3di_dual_chain(se3di_atan(x.v), 1.0 / (1.0 + x.v * x.v), x);
}

static inline se3di_dual se3di_dual_exp(se3di_dual x)
{
    const double f = se3di_exp(x.v);
    return se3di_dual_chain(f, f, x);
}

#endif
