/* SPDX-License-Identifier: BSD-3-Clause */
/* The second phase of the elementary functions, with numbers of 384 bits: series for the
 * exponential, sine and cosine; iterations with them for logarithm and arc tangent.
 *                                                                  docs/theory/elementary.md */
#include <math.h>
#include <string.h>

#include "math/big.h"
#include "math/big_tables.h"
#include "math/elementary_fast.h"

typedef se3di_big big;

#define ADD(a, b)    se3di_big_add(&(a), &(b))
#define SUB(a, b)    se3di_big_subtract(&(a), &(b))
#define MUL(a, b)    se3di_big_multiply(&(a), &(b))
#define DIV(a, b)    se3di_big_divide(&(a), &(b))
#define SHIFT(a, by) se3di_big_shift(&(a), by)

/* ---- exponential and logarithm ---- */

#define HALVINGS 12

/* |x| < 2^20 */
static big exponential(const big *x)
{
    const big ln2 = se3di_big_of_words(ln2_words, 12);
    double k = rint(se3di_big_round(x) * 1.4426950408889634);
    big whole = se3di_big_from(k), r = MUL(whole, ln2);
    r = SUB(*x, r);
    r = SHIFT(r, -HALVINGS);
    big term = se3di_big_from(1.0), out = term;
    for (uint32_t n = 1; n < 32 && !se3di_big_is_zero(&term); ++n) {
        term = MUL(term, r);
        term = se3di_big_divide_by(&term, n);
        out = ADD(out, term);
    }
    for (int n = 0; n < HALVINGS; ++n) {
        out = MUL(out, out);
    }
    return SHIFT(out, (int64_t)k);
}

/* log(m) to 2^-40 of it; 0.7 < m < 1.5 */
static double rough_log(const big *m)
{
    const big one = se3di_big_from(1.0);
    big below = ADD(*m, one), above = SUB(*m, one);
    double t = se3di_big_round(&above) / se3di_big_round(&below), s = t * t;
    double sum = 1.0 / 15.0;
    for (int n = 13; n > 0; n -= 2) {
        sum = 1.0 / n + s * sum;
    }
    return 2.0 * t * sum;
}

/* x > 0. y += 2 (x - e^y)/(x + e^y): errors of 2^-40, 2^-120, 2^-360. */
static big logarithm(const big *x)
{
    const big ln2 = se3di_big_of_words(ln2_words, 12);
    big m = SHIFT(*x, -x->exponent);
    if (m.w[0] < UINT32_C(0xb504f334)) { /* sqrt(1/2) */
        m.exponent = 1;
    }
    big e = se3di_big_from((double)(x->exponent - m.exponent)), y = se3di_big_from(rough_log(&m));
    for (int k = 0; k < 2; ++k) {
        big value = exponential(&y), above = SUB(m, value), below = ADD(m, value);
        big step = DIV(above, below);
        step = SHIFT(step, 1);
        y = ADD(y, step);
    }
    e = MUL(e, ln2);
    return ADD(e, y);
}

double se3di_big_exp(double x)
{
    big a = se3di_big_from(x);
    a = exponential(&a);
    return se3di_big_round(&a);
}

double se3di_big_log(double x)
{
    big a = se3di_big_from(x);
    a = logarithm(&a);
    return se3di_big_round(&a);
}

double se3di_big_log10(double x)
{
    big a = se3di_big_from(x), ten = se3di_big_from(10.0);
    a = logarithm(&a);
    ten = logarithm(&ten);
    a = DIV(a, ten);
    return se3di_big_round(&a);
}

double se3di_big_log1p(double x)
{
    const big one = se3di_big_from(1.0);
    big a = se3di_big_from(x);
    a = ADD(a, one);
    a = logarithm(&a);
    return se3di_big_round(&a);
}

double se3di_big_pow(double x, double y)
{
    big a = se3di_big_from(x), b = se3di_big_from(y);
    a = logarithm(&a);
    a = MUL(a, b);
    double size = se3di_big_round(&a);
    if (fabs(size) > 800.0) {
        return size > 0.0 ? HUGE_VAL : 0.0;
    }
    a = exponential(&a);
    return se3di_big_round(&a);
}

/* ---- sine and cosine ---- */

#define WINDOW 16 /* words of 2/pi */

/* |x| = (8 i + *whole + the result) with *whole < 8, in units of pi/2. Words of 2/pi whose product
 * with x is a multiple of 8 are left out. */
static big in_right_angles(double x, uint32_t *whole)
{
    uint32_t words[WINDOW + 3] = {0};
    int e;
    uint64_t m = (uint64_t)ldexp(frexp(fabs(x), &e), 53);
    e -= 53; /* |x| = m 2^e */
    int first = e > 3 ? (e - 3) / 32 : 0;
    const uint64_t part[2] = {m & UINT32_MAX, m >> 32};
    for (int p = 0; p < 2; ++p) { /* words[1 ..]: the product */
        uint64_t carry = 0;
        for (int k = WINDOW - 1; k >= 0; --k) {
            uint64_t t = part[p] * two_over_pi[first + k] + words[k + 3 - p] + carry;
            words[k + 3 - p] = (uint32_t)t;
            carry = t >> 32;
        }
        words[2 - p] = (uint32_t)carry;
    }
    int shift = 32 * (WINDOW + 3) - (32 * (first + WINDOW) - e) - 3; /* 3 bits before the point */
    for (int k = 0; k < WINDOW + 3; ++k) {
        int from = k + shift / 32;
        uint64_t high = from < WINDOW + 3 ? words[from] : 0;
        uint64_t low = from + 1 < WINDOW + 3 ? words[from + 1] : 0;
        words[k] = (uint32_t)((high << 32 | low) << shift % 32 >> 32);
    }
    *whole = words[0] >> 29;
    words[0] &= UINT32_C(0x1fffffff);
    big out = se3di_big_of_words(words, WINDOW + 3);
    return SHIFT(out, 3);
}

void se3di_big_reduce(double x, se3di_reduced *out)
{
    uint32_t whole;
    big part = in_right_angles(x, &whole);
    part = SHIFT(part, 6); /* in pi/128 */
    double steps = rint(se3di_big_round(&part));
    big k = se3di_big_from(steps), unit = se3di_big_of_words(quarter_pi_words, 12);
    part = SUB(part, k);
    unit = SHIFT(unit, -5);
    part = MUL(part, unit);
    double sign = x < 0.0 ? -1.0 : 1.0, high = se3di_big_round(&part);
    k = se3di_big_from(high);
    part = SUB(part, k);
    out->high = sign * high;
    out->low = sign * se3di_big_round(&part);
    out->n = (int)sign * (int)(64 * (int)whole + (int)steps);
}

/* |r| < 0.8 */
static void series(const big *r, big *sine, big *cosine)
{
    big term = se3di_big_from(1.0);
    *cosine = term;
    *sine = se3di_big_from(0.0);
    for (uint32_t n = 1; n < 80 && !se3di_big_is_zero(&term); ++n) {
        term = MUL(term, *r);
        term = se3di_big_divide_by(&term, n);
        term.sign = n % 2 == 0 ? -term.sign : term.sign; /* the next two get the other sign */
        if (n % 2 == 1) {
            *sine = ADD(*sine, term);
        } else {
            *cosine = ADD(*cosine, term);
        }
    }
}

static void sine_cosine(double x, big *sine, big *cosine)
{
    const big half = se3di_big_from(0.5), one = se3di_big_from(1.0);
    big unit = se3di_big_of_words(quarter_pi_words, 12), r = se3di_big_from(fabs(x)), s, c;
    uint32_t whole = 0;
    if (fabs(x) > 0.75) {
        r = in_right_angles(x, &whole);
        big over = SUB(r, half);
        if (over.sign > 0) {
            r = SUB(r, one);
            ++whole;
        }
        unit = SHIFT(unit, 1);
        r = MUL(r, unit);
    }
    series(&r, &s, &c);
    *sine = whole & 1 ? c : s;
    *cosine = whole & 1 ? s : c;
    sine->sign *= whole & 2 ? -1 : 1;
    cosine->sign *= (whole + 1) & 2 ? -1 : 1;
    sine->sign *= x < 0.0 ? -1 : 1;
}

void se3di_big_sincos(double x, double out[2])
{
    big s, c;
    sine_cosine(x, &s, &c);
    out[0] = se3di_big_round(&s);
    out[1] = se3di_big_round(&c);
}

double se3di_big_tan(double x)
{
    big s, c;
    sine_cosine(x, &s, &c);
    s = DIV(s, c);
    return se3di_big_round(&s);
}

/* ---- arc tangent ---- */

/* t - t^3/3 + t^5/5 */
static big small_atan(const big *t)
{
    big square = MUL(*t, *t), cube = MUL(square, *t), fifth = MUL(cube, square);
    cube = se3di_big_divide_by(&cube, 3);
    fifth = se3di_big_divide_by(&fifth, 5);
    big out = SUB(*t, cube);
    return ADD(out, fifth);
}

/* The angle of (x, y), 0 <= y <= x. a += atan((y cos a - x sin a)/(x cos a + y sin a)): errors of
 * 2^-7.6, 2^-53, 2^-370. */
static big angle_first(const big *y, const big *x)
{
    big t = DIV(*y, *x);
    if (se3di_big_is_zero(y) || t.exponent < -60) {
        return small_atan(&t);
    }
    double q = se3di_big_round(&t);
    big a = se3di_big_from(q / (1.0 + 0.28 * q * q)), s, c;
    for (int k = 0; k < 2; ++k) {
        series(&a, &s, &c);
        big yc = MUL(*y, c), xs = MUL(*x, s), xc = MUL(*x, c), ys = MUL(*y, s);
        big above = SUB(yc, xs), below = ADD(xc, ys);
        t = DIV(above, below);
        t = small_atan(&t);
        a = ADD(a, t);
    }
    return a;
}

static double angle(big y, big x)
{
    const big quarter = se3di_big_of_words(quarter_pi_words, 12);
    int32_t y_sign = y.sign, x_sign = x.sign;
    y.sign = x.sign = 1;
    big more = SUB(y, x), a;
    if (!se3di_big_is_zero(&more) && more.sign > 0) {
        big right = SHIFT(quarter, 1);
        a = angle_first(&x, &y);
        a = SUB(right, a);
    } else {
        a = angle_first(&y, &x);
    }
    if (x_sign < 0) {
        big half_turn = SHIFT(quarter, 2);
        a = SUB(half_turn, a);
    }
    a.sign *= y_sign;
    return se3di_big_round(&a);
}

double se3di_big_atan2(double y, double x)
{
    return angle(se3di_big_from(y), se3di_big_from(x));
}

static big other_leg(double x)
{
    const big one = se3di_big_from(1.0);
    big a = se3di_big_from(x);
    a = MUL(a, a);
    a = SUB(one, a);
    return se3di_big_root(&a);
}

double se3di_big_asin(double x)
{
    return angle(se3di_big_from(x), other_leg(x));
}

double se3di_big_acos(double x)
{
    return angle(other_leg(x), se3di_big_from(x));
}

/* ---- hyperbolic ---- */

/* e^x and e^-x */
static void both(double x, big *up, big *down)
{
    const big one = se3di_big_from(1.0);
    big a = se3di_big_from(x);
    *up = exponential(&a);
    *down = DIV(one, *up);
}

/* (e^x + sign e^-x)/2 */
static double half_sum(double x, int32_t sign)
{
    big up, down;
    both(x, &up, &down);
    up = sign < 0 ? SUB(up, down) : ADD(up, down);
    up = SHIFT(up, -1);
    return se3di_big_round(&up);
}

double se3di_big_sinh(double x)
{
    return half_sum(x, -1);
}

double se3di_big_cosh(double x)
{
    return half_sum(x, 1);
}

double se3di_big_tanh(double x)
{
    big up, down;
    both(x, &up, &down);
    big above = SUB(up, down), below = ADD(up, down);
    above = DIV(above, below);
    return se3di_big_round(&above);
}

/* ---- roots ---- */

double se3di_big_hypot(double x, double y)
{
    big a = se3di_big_from(x), b = se3di_big_from(y);
    a = MUL(a, a);
    b = MUL(b, b);
    a = ADD(a, b);
    a = se3di_big_root(&a);
    return se3di_big_round(&a);
}
