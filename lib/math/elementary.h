/* SPDX-License-Identifier: BSD-3-Clause */
/* The elementary functions, each the double nearest to the exact value (ties to even), with the
 * special cases of C11, annex F: the same bits from every compiler, library and processor, which
 * libm does not promise. They set no errno.                        docs/theory/elementary.md */
#ifndef SE3DI_MATH_ELEMENTARY_H
#define SE3DI_MATH_ELEMENTARY_H

double se3di_exp(double x);
double se3di_log(double x);
double se3di_log10(double x);
double se3di_log1p(double x);
double se3di_pow(double x, double y);
double se3di_sin(double x);
double se3di_cos(double x);
void se3di_sincos(double x, double *sine, double *cosine);
double se3di_tan(double x);
double se3di_asin(double x);
double se3di_acos(double x);
double se3di_atan(double x);
double se3di_atan2(double y, double x);
double se3di_sinh(double x);
double se3di_cosh(double x);
double se3di_tanh(double x);
double se3di_hypot(double x, double y);

#endif
