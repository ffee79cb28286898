/* SPDX-License-Identifier: BSD-3-Clause */
/* Philox: ten rounds of multiplications and exclusive ors turn a counter and a key into bits that
 * pass all tests of randomness. J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, Parallel random
 * numbers: as easy as 1, 2, 3, SC 2011, section 4.2:
 *
 *     (hi0, lo0) = M0 c0,  (hi1, lo1) = M1 c2
 *     c <- (hi1 ^ c1 ^ k0, lo1, hi0 ^ c3 ^ k1, lo0),   k <- k + W
 *
 * A random order is a Feistel network on the smallest power of four that holds it; what falls out
 * of it goes through again, until it is in (docs/theory/studies.md). */
#include "io/study/random.h"

enum { ROUNDS = 10, FEISTEL_ROUNDS = 6 };

void se3di_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4])
{
    uint32_t c0 = counter[0], c1 = counter[1], c2 = counter[2], c3 = counter[3];
    uint32_t k0 = key[0], k1 = key[1];
    for (int round = 0; round < ROUNDS; ++round) {
        const uint64_t product0 = UINT64_C(0xD2511F53) * c0;
        const uint64_t product1 = UINT64_C(0xCD9E8D57) * c2;
        c0 = (uint32_t)(product1 >> 32) ^ c1 ^ k0;
        c2 = (uint32_t)(product0 >> 32) ^ c3 ^ k1;
        c1 = (uint32_t)product1;
        c3 = (uint32_t)product0;
        k0 += UINT32_C(0x9E3779B9);
        k1 += UINT32_C(0xBB67AE85);
    }
    out[0] = c0;
    out[1] = c1;
    out[2] = c2;
    out[3] = c3;
}

uint64_t se3di_random_bits(uint64_t seed, se3di_random_use use, uint32_t stream, uint64_t index)
{
    const uint32_t counter[4] = {(uint32_t)index, (uint32_t)(index >> 32), stream, (uint32_t)use};
    const uint32_t key[2] = {(uint32_t)seed, (uint32_t)(seed >> 32)};
    uint32_t out[4];
    se3di_philox(counter, key, out);
    return (uint64_t)out[1] << 32 | out[0];
}

double se3di_random_uniform(uint64_t bits)
{
    return ((double)(bits >> 12) + 0.5) * 0x1p-52;
}

/* One pass: two halves of `half` bits each, mixed in turn. */
static uint64_t mix(uint64_t seed, uint32_t stream, unsigned half, uint64_t value)
{
    const uint64_t mask = (UINT64_C(1) << half) - 1;
    uint64_t left = value >> half;
    uint64_t right = value & mask;
    for (uint32_t round = 0; round < FEISTEL_ROUNDS; ++round) {
        const uint64_t bits =
            se3di_random_bits(seed, SE3DI_RANDOM_ORDER, stream | round << 24, right);
        const uint64_t next = left ^ (bits & mask);
        left = right;
        right = next;
    }
    return left << half | right;
}

uint64_t se3di_random_place(uint64_t seed, uint32_t stream, uint64_t count, uint64_t index)
{
    unsigned half = 1;
    while (half < 31 && UINT64_C(1) << (2 * half) < count) {
        ++half;
    }
    do {
        index = mix(seed, stream, half, index);
    } while (index >= count);
    return index;
}
