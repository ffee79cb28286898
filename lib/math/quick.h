/* SPDX-License-Identifier: BSD-3-Clause */
/* Elementary functions in one phase, within one unit of the last place or 2^-53: for laws whose
 * formulas are fits of measurements. Plain arithmetic in a fixed order, the same bits everywhere,
 * at a quarter of the cost of the correctly rounded ones.          docs/theory/elementary.md */
#ifndef SE3DI_MATH_QUICK_H
#define SE3DI_MATH_QUICK_H

double se3di_quick_atan(double x);
void se3di_quick_sincos(double x, double *sine, double *cosine);

#endif
