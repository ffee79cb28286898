/* SPDX-License-Identifier: BSD-3-Clause */
/* Special cases and the choice between the two phases. */
#include "math/elementary.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "math/elementary_fast.h"

static const double smallest_normal = 0x1p-1022;

/* Both tables give the same bits. */
static inline const se3di_fast *fast(void)
{
#if defined(SE3DI_FAST_CHOICE)
    return __builtin_cpu_supports("fma") ? &se3di_fast_fused : &se3di_fast_plain;
#else
    return &se3di_fast_plain;
#endif
}

/* ---- exponential and logarithm ---- */

double se3di_exp(double x)
{
    double out;
    if (fabs(x) < 700.0) {
        return fast()->exp(x, &out) ? out : se3di_big_exp(x);
    }
    if (isnan(x)) {
        return x;
    }
    if (x > 710.0) {
        return HUGE_VAL;
    }
    return x < -746.0 ? 0.0 : se3di_big_exp(x);
}

/* Of what log10, log and log1p make of arguments outside their domain or at its end. */
static double log_special(double x)
{
    if (isnan(x) || x > 1.0) {
        return x;
    }
    return x < 0.0 ? (double)NAN : -HUGE_VAL;
}

double se3di_log(double x)
{
    double out;
    if (!(x > 0.0 && x < HUGE_VAL)) {
        return log_special(x);
    }
    if (x == 1.0) {
        return 0.0;
    }
    return x >= smallest_normal && fast()->log(x, &out) ? out : se3di_big_log(x);
}

double se3di_log10(double x)
{
    double out;
    if (!(x > 0.0 && x < HUGE_VAL)) {
        return log_special(x);
    }
    if (x == 1.0) {
        return 0.0;
    }
    return x >= smallest_normal && fast()->log10(x, &out) ? out : se3di_big_log10(x);
}

double se3di_log1p(double x)
{
    double out;
    if (fabs(x) < 0x1p-54) {
        return x;
    }
    if (!(x > -1.0 && x < HUGE_VAL)) {
        return log_special(x < 0.0 ? x + 1.0 : x);
    }
    return fast()->log1p(x, &out) ? out : se3di_big_log1p(x);
}

/* 0: not an integer, 1: odd, 2: even */
static int parity(double y)
{
    if (fabs(y) >= 0x1p53) {
        return 2;
    }
    if (floor(y) != y) {
        return 0;
    }
    return fabs(fmod(y, 2.0)) > 0.5 ? 1 : 2;
}

/* x or y infinite, NaN or 0; or x = 1. */
static double pow_special(double x, double y)
{
    if (y == 0.0 || x == 1.0) {
        return 1.0;
    }
    if (isnan(x) || isnan(y)) {
        return x + y;
    }
    if (isinf(y)) {
        double size = fabs(x);
        if (size == 1.0) {
            return 1.0;
        }
        return (size > 1.0) == (y > 0.0) ? HUGE_VAL : 0.0;
    }
    double out = (x == 0.0) == (y > 0.0) ? 0.0 : HUGE_VAL; /* x is 0 or infinite */
    return signbit(x) && parity(y) == 1 ? -out : out;
}

double se3di_pow(double x, double y)
{
    double out, sign = 1.0, size = fabs(x);
    if (!(size > 0.0 && size < HUGE_VAL && fabs(y) < HUGE_VAL) || y == 0.0 || x == 1.0) {
        return pow_special(x, y);
    }
    if (x < 0.0) {
        int kind = parity(y);
        if (kind == 0) {
            return (double)NAN;
        }
        sign = kind == 1 ? -1.0 : 1.0;
    }
    if (size == 1.0) {
        return sign;
    }
    if (size < smallest_normal || !fast()->pow(size, y, &out)) {
        out = se3di_big_pow(size, y);
    }
    return sign * out;
}

/* ---- sine, cosine, tangent ---- */

/* Beyond this the first phase needs the reduced argument. */
static const double reduced_from = 200000.0;

void se3di_sincos(double x, double *sine, double *cosine)
{
    double out[2], exact[2];
    if (fabs(x) < 0x1p-27) { /* x - x^3/6 and 1 - x^2/2 round to these */
        *sine = x;
        *cosine = 1.0;
        return;
    }
    if (!(fabs(x) < HUGE_VAL)) {
        *sine = *cosine = x - x;
        return;
    }
    int done = fast()->sincos(x, NULL, out);
    if (done == 0) {
        se3di_reduced reduced;
        se3di_big_reduce(x, &reduced);
        done = fast()->sincos(x, &reduced, out);
    }
    if (done != 3) {
        se3di_big_sincos(x, exact);
    }
    *sine = done & 1 ? out[0] : exact[0];
    *cosine = done & 2 ? out[1] : exact[1];
}

double se3di_sin(double x)
{
    double sine, cosine;
    se3di_sincos(x, &sine, &cosine);
    return sine;
}

double se3di_cos(double x)
{
    double sine, cosine;
    se3di_sincos(x, &sine, &cosine);
    return cosine;
}

double se3di_tan(double x)
{
    double out;
    se3di_reduced reduced;
    if (fabs(x) < 0x1p-27) {
        return x;
    }
    if (!(fabs(x) < HUGE_VAL)) {
        return x - x;
    }
    if (fabs(x) < reduced_from && fast()->tan(x, NULL, &out)) {
        return out;
    }
    se3di_big_reduce(x, &reduced);
    return fast()->tan(x, &reduced, &out) ? out : se3di_big_tan(x);
}

/* ---- arc functions ---- */

/* y or x 0, infinite or NaN */
static double atan2_special(double y, double x)
{
    const double pi = 3.14159265358979311600;
    double out;
    if (isnan(x) || isnan(y)) {
        return x + y;
    }
    if (y == 0.0) {
        out = signbit(x) ? pi : 0.0;
    } else if (isinf(x)) {
        double quarter = x > 0.0 ? 0.25 * pi : 2.35619449019234483700;
        out = isinf(y) ? quarter : x > 0.0 ? 0.0 : pi;
    } else { /* x = 0, or y infinite */
        out = 0.5 * pi;
    }
    return copysign(out, y);
}

/* y/x less a third of its cube, 2^-54 x <= y < 2^-30 x, as it is of joints at rest but for
 * rounding, whose quotients are often next to a tie: how far from it, exactly, decides. 0 if not
 * even that does. */
static int small_angle(double y, double x, double *out)
{
    const double q = y / x, cube = q * q * q / 3.0;
    const double before = q * (1.0 - 0x1p-53);                     /* the double before q */
    const double beyond = -fma(-q, x, y) - 0.5 * (q - before) * x; /* the tie, times x */
    const double past = beyond / x + cube;
    *out = past > 0.0 ? before : q;
    return fabs(past) > 0x1p-40 * cube;
}

double se3di_atan2(double y, double x)
{
    double out, u = fabs(y), v = fabs(x);
    if (!(u > 0.0 && v > 0.0 && u < HUGE_VAL && v < HUGE_VAL)) {
        return atan2_special(y, x);
    }
    if (x > 0.0 && u < 0x1p-54 * v && fabs(y / x) > 0x1p-1000) {
        return y / x; /* no quotient is as near to a tie as the cube is small: 2^-107 of it */
    }
    const int is_usual = u > 0x1p-400 && v > 0x1p-400 && u < 0x1p400 && v < 0x1p400;
    if (is_usual && x > 0.0 && u < 0x1p-30 * v && u > 0x1p-55 * v && small_angle(u, v, &out)) {
        return copysign(out, y);
    }
    return is_usual && fast()->atan2(y, x, &out) ? out : se3di_big_atan2(y, x);
}

double se3di_atan(double x)
{
    return fabs(x) < 0x1p-27 ? x : se3di_atan2(x, 1.0);
}

double se3di_asin(double x)
{
    double out;
    if (fabs(x) < 0x1p-27) {
        return x;
    }
    if (!(fabs(x) <= 1.0)) {
        return isnan(x) ? x : (double)NAN;
    }
    return fast()->asin(x, &out) ? out : se3di_big_asin(x);
}

double se3di_acos(double x)
{
    double out;
    if (!(fabs(x) <= 1.0)) {
        return isnan(x) ? x : (double)NAN;
    }
    if (x == 1.0) {
        return 0.0;
    }
    return fast()->acos(x, &out) ? out : se3di_big_acos(x);
}

/* ---- hyperbolic functions ---- */

double se3di_sinh(double x)
{
    double out;
    if (fabs(x) < 0x1p-27 || isnan(x)) {
        return x;
    }
    if (fabs(x) > 711.0) {
        return copysign(HUGE_VAL, x);
    }
    return fabs(x) < 700.0 && fast()->sinh(x, &out) ? out : se3di_big_sinh(x);
}

double se3di_cosh(double x)
{
    double out;
    if (isnan(x)) {
        return x;
    }
    if (fabs(x) > 711.0) {
        return HUGE_VAL;
    }
    return fabs(x) < 700.0 && fast()->cosh(x, &out) ? out : se3di_big_cosh(x);
}

double se3di_tanh(double x)
{
    double out;
    if (fabs(x) < 0x1p-27 || isnan(x)) {
        return x;
    }
    if (fabs(x) > 22.0) {
        return copysign(1.0, x);
    }
    return fast()->tanh(x, &out) ? out : se3di_big_tanh(x);
}

/* ---- roots ---- */

double se3di_hypot(double x, double y)
{
    double u = fabs(x), v = fabs(y), out;
    if (isinf(x) || isinf(y)) {
        return HUGE_VAL;
    }
    if (isnan(x) || isnan(y)) {
        return x + y;
    }
    double large = u > v ? u : v, small = u > v ? v : u;
    if (small == 0.0) {
        return large;
    }
    if (small > 0x1p-400 && large < 0x1p400 && fast()->hypot(large, small, &out)) {
        return out;
    }
    return se3di_big_hypot(large, small);
}
