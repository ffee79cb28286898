/* SPDX-License-Identifier: BSD-3-Clause */
/* Damage to texts and to bytes, for tests of readers. */
#ifndef SE3D_TESTS_DAMAGE_H
#define SE3D_TESTS_DAMAGE_H

#include "check.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* A number from 0 to count - 1. */
static inline size_t damage_pick(uint64_t *seed, size_t count)
{
    const double r = 0.5 * (check_random(seed) + 1.0);
    return (size_t)(r * (double)count) % count;
}

/* Damage a text in place at one point, by its own pieces, `pieces` of its language or bytes.
 * @return its new length, 1 to `room` */
static inline size_t damage_text(char *text, size_t length, size_t room, const char *const *pieces,
                                 size_t piece_count, uint64_t *seed)
{
    const size_t at = damage_pick(seed, length), other = damage_pick(seed, length);
    const size_t span = 1 + damage_pick(seed, 40), rest = length - (at > other ? at : other);
    const char *piece = pieces[damage_pick(seed, piece_count)];
    const size_t size = strlen(piece);
    switch (damage_pick(seed, 6)) {
    case 0: /* one byte changed */
        text[at] = (char)damage_pick(seed, 256);
        return length;
    case 1: /* a piece removed */
        if (length - at <= span) {
            return at > 0 ? at : 1;
        }
        memmove(text + at, text + at + span, length - at - span);
        return length - span;
    case 2: /* a piece put in */
        if (length + size > room) {
            return length;
        }
        memmove(text + at + size, text + at, length - at);
        memcpy(text + at, piece, size);
        return length + size;
    case 3: /* a piece over this place */
        memcpy(text + at, piece, size < length - at ? size : length - at);
        return length;
    case 4: /* one from elsewhere */
        memmove(text + at, text + other, span < rest ? span : rest);
        return length;
    default: /* cut off */
        return at > 0 ? at : 1;
    }
}

/* Words that counts, indices and numbers of a state are not: 0, 1, NaN, 5.0, and near the ends of
 * the integers. */
static const uint64_t damage_words[] = {0,
                                        1,
                                        UINT64_C(0x7FF8000000000000),
                                        UINT64_C(0x4014000000000000),
                                        UINT64_C(0x43E0000000000000),
                                        UINT64_C(0x7FFFFFFF),
                                        UINT64_C(0xFFFFFFFF),
                                        UINT64_MAX};
enum { DAMAGE_WORDS = sizeof damage_words / sizeof *damage_words };

/* Word `word` at the place `at` of the bytes, little-endian. */
static inline void damage_write(unsigned char *bytes, size_t at, uint64_t word)
{
    for (int k = 0; k < 8; ++k) {
        bytes[at + (size_t)k] = (unsigned char)(word >> (8 * k));
    }
}

#endif
