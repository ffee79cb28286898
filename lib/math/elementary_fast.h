/* SPDX-License-Identifier: BSD-3-Clause */
/* The two phases of the elementary functions; see elementary.h for what to call.
 *                                                                  docs/theory/elementary.md */
#ifndef SE3DI_MATH_ELEMENTARY_FAST_H
#define SE3DI_MATH_ELEMENTARY_FAST_H

/* x = n pi/128 + high + low */
typedef struct se3di_reduced {
    double high, low;
    int n;
} se3di_reduced;

/* First phase, of arguments without special cases: 1, or 0 if it cannot round. `sincos` returns
 * bit 0 for the sine in out[0] and bit 1 for the cosine in out[1]. */
typedef struct se3di_fast {
    int (*exp)(double x, double *out);
    int (*log)(double x, double *out);
    int (*log10)(double x, double *out);
    int (*log1p)(double x, double *out);
    int (*pow)(double x, double y, double *out);
    int (*sincos)(double x, const se3di_reduced *given, double out[2]);
    int (*tan)(double x, const se3di_reduced *given, double *out);
    int (*atan2)(double y, double x, double *out);
    int (*asin)(double x, double *out);
    int (*acos)(double x, double *out);
    int (*sinh)(double x, double *out);
    int (*cosh)(double x, double *out);
    int (*tanh)(double x, double *out);
    int (*hypot)(double x, double y, double *out);
} se3di_fast;

extern const se3di_fast se3di_fast_plain;
#if defined(__x86_64__) && defined(__GNUC__)
#define SE3DI_FAST_CHOICE
extern const se3di_fast se3di_fast_fused; /* for machines with FMA */
#endif

/* Second phase: of any finite argument in the domain, rounded to nearest. */
double se3di_big_exp(double x);
double se3di_big_log(double x);
double se3di_big_log10(double x);
double se3di_big_log1p(double x);
double se3di_big_pow(double x, double y); /* x > 0 */
void se3di_big_sincos(double x, double out[2]);
double se3di_big_tan(double x);
double se3di_big_atan2(double y, double x);
double se3di_big_asin(double x);
double se3di_big_acos(double x);
double se3di_big_sinh(double x);
double se3di_big_cosh(double x);
double se3di_big_tanh(double x);
double se3di_big_hypot(double x, double y);
void se3di_big_reduce(double x, se3di_reduced *out);

#endif
