/* SPDX-License-Identifier: BSD-3-Clause */
/* Seventeen digits of a number, correctly rounded: v = m 2^e, and v 10^p with p such that 17 digits
 * are before the point is
 *
 *     m 10^r * T_k 2^t,   p = 16 k + r,   T_k = floor(10^(16 k) / 2^t), 128 bits
 *
 * of which 256 bits are computed. The product is too small by less than a unit of its first 128
 * bits, so that the first 64 bits behind the point are off by one at most: only where they are
 * within that of a half they do not tell how to round, and then printf is asked. */
#include "io/base/digits.h"

#include <math.h>
#include <string.h>

enum { FIRST = -19, STEP = 16, DIGITS = 17, ROOM = 16 };

/* T_k, the first 64 bits and the others, k = FIRST ... */
static const uint64_t powers[][2] = {
    {0x8C71DCD9BA0B4925u, 0x9FF0C08B7F1D0B14u}, /* 1e-304 */
    {0x9BECCE62836AC577u, 0x4EE367F9430AEC32u}, /* 1e-288 */
    {0xAD1C8EAB5EE43B66u, 0xDA3243650005EECFu}, /* 1e-272 */
    {0xC0314325637A1939u, 0xFA911155FEFB5308u}, /* 1e-256 */
    {0xD5605FCDCF32E1D6u, 0xFB1E4A9A90880A64u}, /* 1e-240 */
    {0xECE53CEC4A314EBDu, 0xA4F8BF5635246428u}, /* 1e-224 */
    {0x8380DEA93DA4BC60u, 0x4247CB9E59F71E6Du}, /* 1e-208 */
    {0x91FF83775423CC06u, 0x7B6306A34627DDCFu}, /* 1e-192 */
    {0xA21727DB38CB002Fu, 0xB8ADA00E5A506A7Cu}, /* 1e-176 */
    {0xB3F4E093DB73A093u, 0x59ED216765690F56u}, /* 1e-160 */
    {0xC7CABA6E7C5382C8u, 0xFE64A52EE96B8FC0u}, /* 1e-144 */
    {0xDDD0467C64BCE4A0u, 0xAC7CB3F6D05DDBDEu}, /* 1e-128 */
    {0xF64335BCF065D37Du, 0x4D4617B5FF4A16D5u}, /* 1e-112 */
    {0x88B402F7FD75539Bu, 0x11DBCB0218EBB414u}, /* 1e-96 */
    {0x97C560BA6B0919A5u, 0xDCCD879FC967D41Au}, /* 1e-80 */
    {0xA87FEA27A539E9A5u, 0x3F2398D747B36224u}, /* 1e-64 */
    {0xBB127C53B17EC159u, 0x5560C018580D5D52u}, /* 1e-48 */
    {0xCFB11EAD453994BAu, 0x67DE18EDA5814AF2u}, /* 1e-32 */
    {0xE69594BEC44DE15Bu, 0x4C2EBE687989A9B3u}, /* 1e-16 */
    {0x8000000000000000u, 0x0000000000000000u}, /* 1e0 */
    {0x8E1BC9BF04000000u, 0x0000000000000000u}, /* 1e16 */
    {0x9DC5ADA82B70B59Du, 0xF020000000000000u}, /* 1e32 */
    {0xAF298D050E4395D6u, 0x9670B12B7F410000u}, /* 1e48 */
    {0xC2781F49FFCFA6D5u, 0x3CBF6B71C76B25FBu}, /* 1e64 */
    {0xD7E77A8F87DAF7FBu, 0xDC33745EC97BE906u}, /* 1e80 */
    {0xEFB3AB16C59B14A2u, 0xC5CFE94EF3EA101Eu}, /* 1e96 */
    {0x850FADC09923329Eu, 0x03E2CF6BC604DDB0u}, /* 1e112 */
    {0x93BA47C980E98CDFu, 0xC66F336C36B10137u}, /* 1e128 */
    {0xA402B9C5A8D3A6E7u, 0x5F16206C9C6209A6u}, /* 1e144 */
    {0xB616A12B7FE617AAu, 0x577B986B314D6009u}, /* 1e160 */
    {0xCA28A291859BBF93u, 0x7D7B8F7503CFDCFEu}, /* 1e176 */
    {0xE070F78D3927556Au, 0x85BBE253F47B1417u}, /* 1e192 */
    {0xF92E0C3537826145u, 0xA7709A56CCDF8A82u}, /* 1e208 */
    {0x8A5296FFE33CC92Fu, 0x82BD6B70D99AAA6Fu}, /* 1e224 */
    {0x9991A6F3D6BF1765u, 0xACCA6DA1E0A8EF29u}, /* 1e240 */
    {0xAA7EEBFB9DF9DE8Du, 0xDDBB901B98FEEAB7u}, /* 1e256 */
    {0xBD49D14AA79DBC82u, 0x4B2D8644D8A74E18u}, /* 1e272 */
    {0xD226FC195C6A2F8Cu, 0x73832EEC6FFF3111u}, /* 1e288 */
    {0xE950DF20247C83FDu, 0x47C6B82EF32A2069u}, /* 1e304 */
    {0x81842F29F2CCE375u, 0xE6A1158300D46640u}, /* 1e320 */
    {0x8FCAC257558EE4E6u, 0x213A4F0AA5E8A7B1u}, /* 1e336 */
};

/* 10^r */
static const uint64_t small[STEP] = {1u,
                                     10u,
                                     100u,
                                     1000u,
                                     10000u,
                                     100000u,
                                     1000000u,
                                     10000000u,
                                     100000000u,
                                     1000000000u,
                                     10000000000u,
                                     100000000000u,
                                     1000000000000u,
                                     10000000000000u,
                                     100000000000000u,
                                     1000000000000000u};

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

/* The first 128 of the 256 bits of a b. */
static wide multiply_wide(wide a, const uint64_t b[2])
{
    const wide top = multiply(a.high, b[0]), cross = multiply(a.high, b[1]);
    const wide other = multiply(a.low, b[0]), bottom = multiply(a.low, b[1]);
    uint64_t third = bottom.high, carry = 0;
    third += cross.low;
    carry += third < cross.low;
    third += other.low;
    carry += third < other.low;
    wide sum = {top.high, top.low};
    const uint64_t parts[3] = {cross.high, other.high, carry};
    for (int k = 0; k < 3; ++k) {
        sum.low += parts[k];
        sum.high += sum.low < parts[k];
    }
    return sum;
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

/* Shift a up to its last bit; *by: how far. */
static wide normalise(wide a, int *by)
{
    *by = 0;
    if (a.high == 0) {
        a = (wide){a.low, 0};
        *by = 64;
    }
    const int rest = 63 - first_bit(a.high);
    *by += rest;
    return rest == 0 ? a : (wide){a.high << rest | a.low >> (64 - rest), a.low << rest};
}

/* v 10^p with v = m 2^e: the bits before the point, and the first 64 behind it. */
static uint64_t scale(uint64_t m, int e, int p, uint64_t *fraction)
{
    const int k = shift_down(p, 4), n = STEP * k;
    int by;
    const wide a = normalise(multiply(m, small[p - n]), &by);
    const wide product = multiply_wide(a, powers[k - FIRST]);
    const int t = shift_down(n * 217706, 16) - 127; /* of T_k: log2(10) 2^16 = 217705.9 */
    const int shift = -(e - by + t) - 192;
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
