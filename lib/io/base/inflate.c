/* SPDX-License-Identifier: BSD-3-Clause */
/* RFC 1951: blocks of stored bytes, or of literals and of copies from what was unpacked before, by
 * canonical Huffman codes, whose lengths are fixed or precede the block. A code is read bit by bit:
 * `first` is the first code of a length, `counts` how many there are. */
#include "io/base/inflate.h"

#include <string.h>

enum { BITS_MAX = 15, LITERALS = 288, DISTANCES = 30, END = 256, LENGTHS = 29, ORDER = 19 };

typedef struct unpacking {
    const unsigned char *in;
    size_t in_size, in_at;
    unsigned char *out;
    size_t out_size, out_at;
    uint32_t held; /* bits that are read but not used */
    int held_count;
    bool failed;
} unpacking;

typedef struct code {
    uint16_t counts[BITS_MAX + 1]; /* codes of each length */
    uint16_t symbols[LITERALS];    /* in the order of their codes */
} code;

static uint32_t take_bits(unpacking *u, int count)
{
    while (u->held_count < count && !u->failed) {
        u->failed = u->in_at >= u->in_size;
        u->held |= u->failed ? 0 : (uint32_t)u->in[u->in_at++] << u->held_count;
        u->held_count += 8;
    }
    const uint32_t bits = u->held & ((UINT32_C(1) << count) - 1);
    u->held >>= count;
    u->held_count -= count;
    return u->failed ? 0 : bits;
}

/* The code of symbols with these lengths, 0: not there. @return false: there are more codes than
 * bits, or fewer and more than one. */
static bool make_code(code *c, const uint8_t *lengths, size_t count)
{
    uint16_t at[BITS_MAX + 1] = {0};
    int32_t left = 1;
    size_t used = 0;
    memset(c, 0, sizeof *c);
    for (size_t k = 0; k < count; ++k) {
        ++c->counts[lengths[k]];
    }
    for (int bits = 1; bits <= BITS_MAX; ++bits) {
        left = 2 * left - c->counts[bits];
        used += c->counts[bits];
        if (left < 0) {
            return false;
        }
        at[bits] = (uint16_t)(bits == 1 ? 0 : at[bits - 1] + c->counts[bits - 1]);
    }
    for (size_t k = 0; k < count; ++k) {
        if (lengths[k]) {
            c->symbols[at[lengths[k]]++] = (uint16_t)k;
        }
    }
    c->counts[0] = 0;
    return left == 0 || used <= 1;
}

static uint32_t take_symbol(unpacking *u, const code *c)
{
    int32_t value = 0, first = 0, index = 0;
    for (int bits = 1; bits <= BITS_MAX && !u->failed; ++bits) {
        value |= (int32_t)take_bits(u, 1);
        const int32_t count = c->counts[bits];
        if (value - first < count) {
            return c->symbols[index + value - first];
        }
        index += count;
        first = (first + count) << 1;
        value <<= 1;
    }
    u->failed = true;
    return END;
}

static void put_copy(unpacking *u, size_t length, size_t distance)
{
    if (distance > u->out_at || length > u->out_size - u->out_at) {
        u->failed = true;
        return;
    }
    for (size_t k = 0; k < length; ++k, ++u->out_at) { /* it may overlap what it makes */
        u->out[u->out_at] = u->out[u->out_at - distance];
    }
}

/* What a symbol above END begins: its length, then the distance. */
static void take_copy(unpacking *u, uint32_t symbol, const code *distances)
{
    static const uint16_t lengths[LENGTHS] = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                              15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                              67, 83, 99, 115, 131, 163, 195, 227, 258};
    static const uint8_t more_length[LENGTHS] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                                 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
    static const uint16_t far[DISTANCES] = {
        1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
        193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577};
    const uint32_t l = symbol - END - 1;
    if (l >= LENGTHS) {
        u->failed = true;
        return;
    }
    const size_t length = lengths[l] + take_bits(u, more_length[l]);
    const uint32_t d = take_symbol(u, distances);
    if (u->failed || d >= DISTANCES) {
        u->failed = true;
        return;
    }
    const size_t distance = far[d] + take_bits(u, d < 2 ? 0 : (int)(d / 2 - 1));
    if (!u->failed) {
        put_copy(u, length, distance);
    }
}

static void take_block(unpacking *u, const code *literals, const code *distances)
{
    while (!u->failed) {
        const uint32_t symbol = take_symbol(u, literals);
        if (u->failed || symbol == END) {
            return;
        }
        if (symbol > END) {
            take_copy(u, symbol, distances);
        } else if (u->out_at < u->out_size) {
            u->out[u->out_at++] = (unsigned char)symbol;
        } else {
            u->failed = true;
        }
    }
}

static void take_stored(unpacking *u)
{
    u->held = 0;
    u->held_count = 0;
    if (u->in_size - u->in_at < 4) {
        u->failed = true;
        return;
    }
    const unsigned char *p = u->in + u->in_at;
    const size_t length = (size_t)p[0] | (size_t)p[1] << 8;
    u->in_at += 4;
    if ((length ^ ((size_t)p[2] | (size_t)p[3] << 8)) != 0xffff || length > u->in_size - u->in_at ||
        length > u->out_size - u->out_at) {
        u->failed = true;
        return;
    }
    if (length > 0) {
        memcpy(u->out + u->out_at, u->in + u->in_at, length);
    }
    u->in_at += length;
    u->out_at += length;
}

static void take_fixed(unpacking *u)
{
    uint8_t lengths[LITERALS];
    code literals, distances;
    for (size_t k = 0; k < LITERALS; ++k) {
        lengths[k] = k < 144 ? 8 : k < 256 ? 9 : k < 280 ? 7 : 8;
    }
    (void)make_code(&literals, lengths, LITERALS);
    memset(lengths, 5, DISTANCES + 2);
    (void)make_code(&distances, lengths, DISTANCES + 2);
    take_block(u, &literals, &distances);
}

/* Lengths of codes, which are packed themselves: 16 repeats the one before, 17 and 18 are zeros. */
static void take_lengths(unpacking *u, const code *packed, uint8_t *lengths, size_t count)
{
    for (size_t k = 0; k < count && !u->failed;) {
        const uint32_t symbol = take_symbol(u, packed);
        size_t times = 1;
        uint8_t length = (uint8_t)symbol;
        if (symbol == 16) {
            u->failed = u->failed || k == 0;
            length = k > 0 ? lengths[k - 1] : 0;
            times = 3 + take_bits(u, 2);
        } else if (symbol > 16) {
            length = 0;
            times = symbol == 17 ? 3 + take_bits(u, 3) : 11 + take_bits(u, 7);
        }
        u->failed = u->failed || times > count - k;
        for (size_t i = 0; i < times && !u->failed; ++i) {
            lengths[k++] = length;
        }
    }
}

static void take_own(unpacking *u)
{
    static const uint8_t order[ORDER] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                         11, 4,  12, 3, 13, 2, 14, 1, 15};
    uint8_t lengths[LITERALS + DISTANCES + 2] = {0};
    code literals, distances;
    const size_t n = 257 + take_bits(u, 5);
    const size_t m = 1 + take_bits(u, 5);
    const size_t packed = 4 + take_bits(u, 4);
    for (size_t k = 0; k < packed; ++k) {
        lengths[order[k]] = (uint8_t)take_bits(u, 3);
    }
    if (u->failed || n > LITERALS - 2 || m > DISTANCES || !make_code(&literals, lengths, ORDER)) {
        u->failed = true;
        return;
    }
    memset(lengths, 0, sizeof lengths);
    take_lengths(u, &literals, lengths, n + m);
    u->failed = u->failed || lengths[END] == 0 || !make_code(&literals, lengths, n) ||
                !make_code(&distances, lengths + n, m);
    take_block(u, &literals, &distances);
}

bool se3di_inflate(const unsigned char *packed, size_t packed_size, unsigned char *bytes,
                   size_t size)
{
    unpacking u = {.in = packed, .in_size = packed_size, .out = bytes, .out_size = size};
    for (bool is_last = false; !is_last && !u.failed;) {
        is_last = take_bits(&u, 1) != 0;
        const uint32_t kind = take_bits(&u, 2);
        if (u.failed || kind > 2) {
            return false;
        }
        (kind == 0 ? take_stored : kind == 1 ? take_fixed : take_own)(&u);
    }
    return !u.failed && u.out_at == size && u.in_at == packed_size;
}

uint32_t se3di_crc32(const unsigned char *bytes, size_t size)
{
    uint32_t table[256];
    uint32_t crc = 0xffffffffU;
    for (uint32_t k = 0; k < 256; ++k) {
        uint32_t c = k;
        for (int bit = 0; bit < 8; ++bit) {
            c = c & 1U ? 0xedb88320U ^ c >> 1 : c >> 1;
        }
        table[k] = c;
    }
    for (size_t k = 0; k < size; ++k) {
        crc = table[(crc ^ bytes[k]) & 0xffU] ^ crc >> 8;
    }
    return crc ^ 0xffffffffU;
}
