/* SPDX-License-Identifier: BSD-3-Clause */
/* Random numbers, splitmix64 (Steele, Lea, Flood 2014). */
#ifndef SE3DI_MATH_RANDOM_H
#define SE3DI_MATH_RANDOM_H

#include <stdint.h>

/* Bits each of which depends on all of z. */
static inline uint64_t se3di_random_mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/* The next number of [0, 1), of the 2^53 that are equally far apart there. */
static inline double se3di_random_draw(uint64_t *state)
{
    *state += UINT64_C(0x9E3779B97F4A7C15);
    return (double)(se3di_random_mix(*state) >> 11) * 0x1p-53;
}

#endif
