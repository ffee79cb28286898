/* SPDX-License-Identifier: BSD-3-Clause */
/* Random numbers by counting: number (index, stream) of a seed is a function of the three, so that
 * any sample can be made alone, on any machine. */
#ifndef SE3D_IO_STUDY_RANDOM_H
#define SE3D_IO_STUDY_RANDOM_H

#include <stdint.h>

/* Philox 4x32 with 10 rounds. */
void se3di_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]);

/* What numbers are used for: each has its own. */
typedef enum se3di_random_use {
    SE3DI_RANDOM_DRAW = 0,
    SE3DI_RANDOM_ORDER = 1, /* of the strata of a Latin hypercube */
    SE3DI_RANDOM_SHIFT = 2  /* of Sobol's points */
} se3di_random_use;

/* 64 random bits. `stream` is below 2^24. */
uint64_t se3di_random_bits(uint64_t seed, se3di_random_use use, uint32_t stream, uint64_t index);
/* The middle of one of 2^52 equal parts of (0, 1). */
double se3di_random_uniform(uint64_t bits);
/* The place of `index` in a random order of 0 ... count - 1; count > 0. */
uint64_t se3di_random_place(uint64_t seed, uint32_t stream, uint64_t count, uint64_t index);

#endif
