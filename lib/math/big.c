/* SPDX-License-Identifier: BSD-3-Clause */
#include "math/big.h"

#include <math.h>
#include <string.h>

#define WORDS SE3DI_BIG_WORDS
#define WIDE  (2 * WORDS)

static const se3di_big zero = {.sign = 1};

int se3di_big_is_zero(const se3di_big *a)
{
    return a->w[0] == 0;
}

/* The leading words of `words` without zeros in front; 0.words 2^exponent. */
static se3di_big normal(const uint32_t *words, int count, int sign, int64_t exponent)
{
    se3di_big out = {.sign = sign, .exponent = exponent};
    int first = 0, shift = 0;
    while (first < count && words[first] == 0) {
        ++first;
    }
    if (first == count) {
        return zero;
    }
    while (!(words[first] << shift & UINT32_C(0x80000000))) {
        ++shift;
    }
    for (int k = 0; k < WORDS; ++k) {
        uint64_t high = first + k < count ? words[first + k] : 0;
        uint64_t low = first + k + 1 < count ? words[first + k + 1] : 0;
        out.w[k] = (uint32_t)((high << 32 | low) << shift >> 32);
    }
    out.exponent -= 32 * first + shift;
    return out;
}

se3di_big se3di_big_of_words(const uint32_t *words, int count)
{
    return normal(words, count, 1, 0);
}

se3di_big se3di_big_from(double x)
{
    int exponent;
    double m = frexp(fabs(x), &exponent);
    uint64_t bits = (uint64_t)ldexp(m, 53);
    const uint32_t words[2] = {(uint32_t)(bits >> 21), (uint32_t)(bits << 11)};
    return normal(words, 2, x < 0.0 ? -1 : 1, exponent);
}

se3di_big se3di_big_shift(const se3di_big *a, int64_t by)
{
    se3di_big out = *a;
    if (!se3di_big_is_zero(a)) {
        out.exponent += by;
    }
    return out;
}

/* w shifted to the right by `by` bits, into one word more. */
static void shifted(const se3di_big *a, int64_t by, uint32_t out[WORDS + 1])
{
    memset(out, 0, (WORDS + 1) * sizeof *out);
    if (by >= 32 * (WORDS + 1)) {
        return;
    }
    int words = (int)(by / 32), bits = (int)(by % 32);
    for (int k = 0; k < WORDS; ++k) {
        uint64_t both = (uint64_t)a->w[k] << 32 >> bits;
        if (k + words <= WORDS) {
            out[k + words] |= (uint32_t)(both >> 32);
        }
        if (k + words + 1 <= WORDS) {
            out[k + words + 1] |= (uint32_t)both;
        }
    }
}

static int compare_size(const se3di_big *a, const se3di_big *b)
{
    if (a->exponent != b->exponent) {
        return a->exponent > b->exponent ? 1 : -1;
    }
    for (int k = 0; k < WORDS; ++k) {
        if (a->w[k] != b->w[k]) {
            return a->w[k] > b->w[k] ? 1 : -1;
        }
    }
    return 0;
}

/* |a| >= |b| > 0 */
static se3di_big combine(const se3di_big *a, const se3di_big *b)
{
    uint32_t other[WORDS + 1], out[WORDS + 2] = {0};
    int64_t carry = 0;
    shifted(b, a->exponent - b->exponent, other);
    for (int k = WORDS; k >= 0; --k) {
        int64_t mine = k < WORDS ? a->w[k] : 0;
        int64_t sum = a->sign == b->sign ? mine + other[k] + carry : mine - other[k] + carry;
        out[k + 1] = (uint32_t)((uint64_t)sum & UINT32_MAX);
        carry = sum < 0 ? -1 : sum > (int64_t)UINT32_MAX;
    }
    out[0] = (uint32_t)carry;
    return normal(out, WORDS + 2, a->sign, a->exponent + 32);
}

se3di_big se3di_big_add(const se3di_big *a, const se3di_big *b)
{
    if (se3di_big_is_zero(a)) {
        return *b;
    }
    if (se3di_big_is_zero(b)) {
        return *a;
    }
    return compare_size(a, b) >= 0 ? combine(a, b) : combine(b, a);
}

se3di_big se3di_big_subtract(const se3di_big *a, const se3di_big *b)
{
    se3di_big minus = *b;
    minus.sign = -minus.sign;
    return se3di_big_add(a, &minus);
}

se3di_big se3di_big_multiply(const se3di_big *a, const se3di_big *b)
{
    uint32_t out[WIDE] = {0};
    for (int i = WORDS - 1; i >= 0; --i) {
        uint64_t carry = 0;
        for (int j = WORDS - 1; j >= 0; --j) {
            uint64_t t = (uint64_t)a->w[i] * b->w[j] + out[i + j + 1] + carry;
            out[i + j + 1] = (uint32_t)t;
            carry = t >> 32;
        }
        out[i] = (uint32_t)carry;
    }
    return normal(out, WIDE, a->sign * b->sign, a->exponent + b->exponent);
}

se3di_big se3di_big_divide_by(const se3di_big *a, uint32_t b)
{
    uint32_t out[WORDS + 1];
    uint64_t rest = 0;
    for (int k = 0; k <= WORDS; ++k) {
        rest = rest << 32 | (k < WORDS ? a->w[k] : 0);
        out[k] = (uint32_t)(rest / b);
        rest %= b;
    }
    return normal(out, WORDS + 1, a->sign, a->exponent);
}

/* About 1 to 53 bits of a number, as it is in [1/2, 1). */
static double leading(const se3di_big *a)
{
    return ldexp((double)a->w[0], -32) + ldexp((double)(a->w[1] & UINT32_C(0xfffff800)), -64);
}

se3di_big se3di_big_divide(const se3di_big *a, const se3di_big *b)
{
    const se3di_big two = se3di_big_from(2.0);
    se3di_big unit = *b, out = se3di_big_from(1.0 / leading(b));
    unit.sign = 1;
    unit.exponent = 0;
    for (int k = 0; k < 3; ++k) { /* 1/b: y (2 - b y) */
        se3di_big t = se3di_big_multiply(&unit, &out);
        t = se3di_big_subtract(&two, &t);
        out = se3di_big_multiply(&out, &t);
    }
    out.sign = b->sign;
    out.exponent -= b->exponent;
    return se3di_big_multiply(a, &out);
}

se3di_big se3di_big_root(const se3di_big *a)
{
    if (se3di_big_is_zero(a)) {
        return zero;
    }
    int64_t half = a->exponent >= 0 ? a->exponent / 2 : -((1 - a->exponent) / 2);
    se3di_big unit = *a;
    unit.exponent -= 2 * half; /* 0 or 1 */
    se3di_big out = se3di_big_from(sqrt(ldexp(leading(a), (int)unit.exponent)));
    for (int k = 0; k < 3; ++k) {
        se3di_big t = se3di_big_divide(&unit, &out);
        t = se3di_big_add(&t, &out);
        out = se3di_big_shift(&t, -1);
    }
    return se3di_big_shift(&out, half);
}

/* ---- rounding ---- */

/* Half of the last of `words` words is added, the others go. */
static se3di_big rounded(const se3di_big *a, int words)
{
    se3di_big out = *a;
    uint64_t carry = a->w[words] >> 31;
    memset(out.w + words, 0, sizeof out.w - (size_t)words * sizeof out.w[0]);
    for (int k = words - 1; k >= 0; --k) {
        carry += out.w[k];
        out.w[k] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry) {
        out.w[0] = UINT32_C(0x80000000);
        ++out.exponent;
    }
    return out;
}

double se3di_big_round(const se3di_big *a)
{
    if (se3di_big_is_zero(a)) {
        return 0.0;
    }
    se3di_big x = rounded(a, 8);
    int64_t bits = x.exponent + 1074 < 53 ? x.exponent + 1074 : 53;
    if (x.exponent > 1024) {
        return x.sign * HUGE_VAL;
    }
    if (bits < 0) {
        return x.sign * 0.0;
    }
    uint64_t top = (uint64_t)x.w[0] << 32 | x.w[1], low = 0;
    for (int k = 2; k < WORDS; ++k) {
        low |= x.w[k];
    }
    uint64_t kept = bits > 0 ? top >> (64 - bits) : 0;
    uint64_t rest = top << bits, half = UINT64_C(1) << 63;
    if (rest > half || (rest == half && (low || (kept & 1)))) {
        ++kept;
    }
    return x.sign * ldexp((double)kept, (int)(x.exponent - bits));
}
