/* SPDX-License-Identifier: BSD-3-Clause */
/* FNV-1a, 64 bits: the determinism hash of a state, and of what a model was read from. */
#ifndef SE3DI_BASE_HASH_H
#define SE3DI_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define SE3DI_HASH_START UINT64_C(14695981039346656037)

static inline uint64_t se3di_hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t k = 0; k < size; ++k) {
        hash = (hash ^ bytes[k]) * UINT64_C(1099511628211);
    }
    return hash;
}

/* The bytes of a word, least first, so that the hash is the same on every machine. */
static inline uint64_t se3di_hash_word(uint64_t hash, uint64_t word)
{
    for (int k = 0; k < 64; k += 8) {
        hash = (hash ^ (word >> k & 255)) * UINT64_C(1099511628211);
    }
    return hash;
}

static inline uint64_t se3di_hash_numbers(uint64_t hash, const double *values, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        uint64_t word;
        memcpy(&word, &values[k], sizeof word);
        hash = se3di_hash_word(hash, word);
    }
    return hash;
}

#endif
