/* SPDX-License-Identifier: BSD-3-Clause */
/* Euler normalisation; formulas in the header.  docs/theory/euler-normalisation.md */
#include "primitive/euler_norm.h"

double se3di_euler_norm_value(const double p[4])
{
    return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3] - 1.0;
}

double se3di_euler_norm_gamma(const double pdot[4])
{
    return -2.0 * (pdot[0] * pdot[0] + pdot[1] * pdot[1] + pdot[2] * pdot[2] + pdot[3] * pdot[3]);
}
