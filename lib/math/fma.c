/* SPDX-License-Identifier: BSD-3-Clause */
/* The product of two mantissas has 106 bits and is kept whole in 128, top bit at TOP; what the
 * smaller term loses when it is shifted to the larger one's exponent is remembered in the last
 * bit. That bit is far below the place of rounding: terms whose exponents differ by two or more
 * lose at most one leading bit when they cancel, and nearer ones lose nothing in the shift. */
#include "math/fma.h"

#include <stdint.h>

#define TOP      125   /* leaves room for the carry of a sum */
#define LEAST    -1074 /* exponent of the last bit of a subnormal number */
#define MANTISSA 53

/* (high 2^64 + low) 2^exponent */
typedef struct wide {
    uint64_t high, low;
    int exponent;
} wide;

static int top_of(const wide *x)
{
    uint64_t word = x->high ? x->high : x->low;
    int bit = x->high ? 64 : 0;
    for (int step = 32; step > 0; step /= 2) {
        if (word >> step) {
            word >>= step;
            bit += step;
        }
    }
    return bit;
}

static void shift_left(wide *x, int count) /* 0 < count < 128 */
{
    if (count >= 64) {
        x->high = x->low << (count - 64);
        x->low = 0;
    } else {
        x->high = x->high << count | x->low >> (64 - count);
        x->low <<= count;
    }
    x->exponent -= count;
}

/* What falls off is remembered in the last bit. */
static void shift_right(wide *x, int count)
{
    uint64_t lost = 0;
    x->exponent += count;
    if (count > 127) {
        lost = x->high | x->low;
        x->high = x->low = 0;
    } else if (count >= 64) {
        lost = x->low | (count > 64 ? x->high << (128 - count) : 0);
        x->low = x->high >> (count - 64);
        x->high = 0;
    } else if (count > 0) {
        lost = x->low << (64 - count);
        x->low = x->low >> count | x->high << (64 - count);
        x->high >>= count;
    }
    x->low |= lost != 0;
}

static wide mantissa_of(double x)
{
    wide out = {0};
    const double part = frexp(fabs(x), &out.exponent);
    out.low = (uint64_t)ldexp(part, MANTISSA);
    out.exponent -= MANTISSA;
    return out;
}

static wide product_of(const wide *a, const wide *b)
{
    const uint64_t half = UINT32_MAX, al = a->low & half, ah = a->low >> 32, bl = b->low & half,
                   bh = b->low >> 32;
    const uint64_t low = al * bl, middle = ah * bl + (low >> 32), other = al * bh + (middle & half);
    return (wide){ah * bh + (middle >> 32) + (other >> 32), other << 32 | (low & half),
                  a->exponent + b->exponent};
}

static int is_less(const wide *a, const wide *b)
{
    return a->high != b->high ? a->high < b->high : a->low < b->low;
}

/* a + b or a - b, at the same exponent, a not less. */
static wide sum_of(const wide *a, const wide *b, int differ)
{
    wide out = *a;
    if (differ) {
        out.low = a->low - b->low;
        out.high = a->high - b->high - (a->low < b->low);
    } else {
        out.low = a->low + b->low;
        out.high = a->high + b->high + (out.low < a->low);
    }
    return out;
}

/* To the nearest, of two the even one. */
static double round_off(wide x)
{
    int drop = top_of(&x) + 1 - MANTISSA;
    if (x.exponent + drop < LEAST) {
        drop = LEAST - x.exponent;
    }
    if (drop <= 1) { /* so that the half and what is below it are apart */
        const int more = 2 - drop;
        shift_left(&x, more);
        drop += more;
    }
    shift_right(&x, drop - 2);
    const uint64_t rest = x.low & 3, kept = x.low >> 2;
    const uint64_t up = rest > 2 || (rest == 2 && (kept & 1));
    return ldexp((double)(kept + up), x.exponent + 2);
}

double se3di_fma_by_integers(double a, double b, double c)
{
    if (!isfinite(a) || !isfinite(b) || a == 0.0 || b == 0.0) {
        return a * b + c;
    }
    if (!isfinite(c) || c == 0.0) {
        return isfinite(c) ? a * b : c; /* a b may overflow */
    }
    const int below = (signbit(a) != 0) != (signbit(b) != 0), negative = signbit(c) != 0;
    const wide x = mantissa_of(a), y = mantissa_of(b);
    wide product = product_of(&x, &y), term = mantissa_of(c);
    shift_left(&product, TOP - top_of(&product));
    shift_left(&term, TOP - top_of(&term));
    wide *small = product.exponent < term.exponent ? &product : &term;
    const wide *large = small == &product ? &term : &product;
    shift_right(small, large->exponent - small->exponent);
    const int is_term = is_less(&product, &term);
    const wide sum = is_term ? sum_of(&term, &product, below != negative)
                             : sum_of(&product, &term, below != negative);
    if (sum.high == 0 && sum.low == 0) {
        return 0.0;
    }
    const double size = round_off(sum);
    return (is_term ? negative : below) ? -size : size;
}
