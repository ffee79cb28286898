/* SPDX-License-Identifier: BSD-3-Clause */
/* Seventeen digits of a number, correctly rounded: v = m 2^e, and v 10^p with p such that 17 digits
 * are before the point is
 *
 *     a 2^e' * T_p 2^t,   a: m with its first bit at the top,   T_p = floor(10^p / 2^t), 128 bits
 *
 * of which 192 bits are computed. Of their first 128 the product is too small by less than two
 * units, so that the first 64 bits behind the point, 4 and more of those before it left out, are
 * off by one at most: only where they are within that of a half they do not tell how to round, and
 * then printf is asked. */
#include "io/base/digits.h"

#include <math.h>
#include <string.h>

#include "io/base/digits_table.h"

enum { DIGITS = 17, ROOM = 16 };

typedef struct wide {
    uint64_t high, low;
} wide;

static wide multiply(uint64_t a, uint64_t b)
{
#if defined(__SIZEOF_INT128__)
    __extension__ typedef unsigned __int128 widest;
    const widest product = (widest)a * b;
    return (wide){(uint64_t)(product >> 64), (uint64_t)product};
#else
    const uint64_t mask = 0xFFFFFFFFu, a0 = a & mask, a1 = a >> 32, b0 = b & mask, b1 = b >> 32;
    const uint64_t low = a0 * b0, middle = a1 * b0 + (low >> 32);
    const uint64_t other = a0 * b1 + (middle & mask);
    return (wide){a1 * b1 + (middle >> 32) + (other >> 32), (other << 32) | (low & mask)};
#endif
}

/* floor(x / 2^bits) of a number that may be negative */
static int shift_down(int x, int bits)
{
    return x >= 0 ? x >> bits : -((-x + (1 << bits) - 1) >> bits);
}

/* The place of the first bit of a number that is not 0, 0 ... 63. */
static int first_bit(uint64_t x)
{
#if defined(__GNUC__)
    return 63 - __builtin_clzll(x);
#else
    int place = 0;
    for (int half = 32; half > 0; half /= 2) {
        if (x >> half) {
            x >>= half;
            place += half;
        }
    }
    return place;
#endif
}

/* v 10^p with v = m 2^e: the bits before the point, and the first 64 behind it. */
static uint64_t scale(uint64_t m, int e, int p, uint64_t *fraction)
{
    const uint64_t *power = powers[p - SE3DI_POWER_FIRST];
    const int by = 63 - first_bit(m), t = shift_down(p * 1741647, 19) - 127; /* log2(10) 2^19 */
    const uint64_t a = m << by;
    const int shift = -(e - by + t) - 128;
    wide product = multiply(a, power[0]);
    const uint64_t rest = multiply(a, power[1]).high;
    product.low += rest;
    product.high += product.low < rest;
    *fraction = product.high << (64 - shift) | product.low >> shift;
    return product.high >> shift;
}

bool se3di_digits_of(double value, uint64_t *digits, int *exponent)
{
    const uint64_t most = 100000000000000000u, half = (uint64_t)1 << 63;
    uint64_t bits, fraction = 0, q = most;
    memcpy(&bits, &value, sizeof bits);
    const int field = (int)(bits >> 52 & 0x7FF);
    const uint64_t tail = bits & (((uint64_t)1 << 52) - 1);
    const uint64_t m = field > 0 ? tail | (uint64_t)1 << 52 : tail;
    const int e = (field > 0 ? field : 1) - 1075;
    if (m == 0 || field == 0x7FF) {
        return false;
    }
    int X =
        shift_down((e + first_bit(m)) * 78913, 18) - 1; /* log10(2) 2^18 = 78913.2: at most it */
    while (q >= most) {
        ++X;
        q = scale(m, e, DIGITS - 1 - X, &fraction);
    }
    if (fraction - half + 2 <= 4) {
        return false;
    }
    q += fraction >> 63;
    *exponent = q == most ? X + 1 : X;
    *digits = q == most ? most / 10 : q;
    return true;
}

/* Two digits. */
static void write_pair(uint32_t pair, char *text)
{
    static const char pairs[] = "00010203040506070809101112131415161718192021222324"
                                "25262728293031323334353637383940414243444546474849"
                                "50515253545556575859606162636465666768697071727374"
                                "75767778798081828384858687888990919293949596979899";
    memcpy(text, pairs + 2 * pair, 2);
}

/* Eight digits. */
static void write_eight(uint32_t x, char *text)
{
    const uint32_t first = x / 10000, last = x % 10000;
    write_pair(first / 100, text);
    write_pair(first % 100, text + 2);
    write_pair(last / 100, text + 4);
    write_pair(last % 100, text + 6);
}

/* The digits as a text, with zeros behind; @return how many there are without those at the end */
static int write_digits(uint64_t q, char text[DIGITS + ROOM])
{
    int count = DIGITS;
    const uint64_t first = q / 100000000;
    write_eight((uint32_t)(q % 100000000), text + 9);
    write_eight((uint32_t)(first % 100000000), text + 1);
    text[0] = (char)('0' + first / 100000000);
    memset(text + DIGITS, '0', ROOM);
    while (count > 1 && text[count - 1] == '0') {
        --count;
    }
    return count;
}

/* As many as are needed and some more, in pieces of known size: they are overwritten. */
static void put(char *to, const char *digits)
{
    memcpy(to, digits, ROOM);
}

static char *put_exponent(char *to, int exponent)
{
    const int size = exponent < 0 ? -exponent : exponent;
    *to++ = 'e';
    *to++ = exponent < 0 ? '-' : '+';
    if (size >= 100) {
        *to++ = (char)('0' + size / 100);
    }
    *to++ = (char)('0' + size / 10 % 10);
    *to++ = (char)('0' + size % 10);
    return to;
}

size_t se3di_digits_format(double value, char *text)
{
    char digits[DIGITS + ROOM], *to = text;
    uint64_t q;
    int exponent;
    if (value == 0.0) {
        strcpy(text, signbit(value) ? "-0" : "0");
        return strlen(text);
    }
    if (!se3di_digits_of(value, &q, &exponent)) {
        return 0;
    }
    const int count = write_digits(q, digits), whole = exponent + 1;
    if (value < 0.0) {
        *to++ = '-';
    }
    if (exponent < -4 || exponent >= DIGITS) {
        to[0] = digits[0];
        to[1] = '.';
        put(to + 2, digits + 1);
        to = put_exponent(to + (count > 1 ? count + 1 : 1), exponent);
    } else if (whole <= 0) {
        memcpy(to, "0.000", 5);
        to += 2 - whole;
        put(to, digits);
        to[ROOM] = digits[ROOM];
        to += count;
    } else {
        put(to, digits);
        to[ROOM] = digits[ROOM];
        to += whole;
        if (count > whole) {
            *to = '.';
            put(to + 1, digits + whole);
            to += 1 + count - whole;
        }
    }
    *to = '\0';
    return (size_t)(to - text);
}
