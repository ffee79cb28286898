/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers as bytes that are the same on every machine: 64-bit words, least byte first. One function
 * for each kind of number goes both ways, so that reader and writer cannot differ; what is written
 * is only looked at. Both libraries have these functions: they link apart. */
#ifndef SE3DI_BASE_CODER_H
#define SE3DI_BASE_CODER_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* One way through the bytes: measuring (`out` and `in` NULL), writing or reading. */
typedef struct se3di_coder {
    unsigned char *out;
    const unsigned char *in;
    size_t at, size; /* what does not fit is counted only */
    int failed;      /* reading: the bytes end too early, or a number is out of its range */
} se3di_coder;

#define SE3DI_CODER_WORD 8 /* bytes */

static inline void se3di_code_word(se3di_coder *c, uint64_t *word)
{
    if (c->at > c->size || c->size - c->at < SE3DI_CODER_WORD) {
        c->failed = 1;
        *word = c->in ? 0 : *word;
    } else if (c->in) {
        *word = 0;
        for (int k = 0; k < SE3DI_CODER_WORD; ++k) {
            *word |= (uint64_t)c->in[c->at + (size_t)k] << (8 * k);
        }
    } else if (c->out) {
        for (int k = 0; k < SE3DI_CODER_WORD; ++k) {
            c->out[c->at + (size_t)k] = (unsigned char)(*word >> (8 * k));
        }
    }
    c->at += SE3DI_CODER_WORD;
}

static inline void se3di_code_numbers(se3di_coder *c, double *values, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        uint64_t word;
        memcpy(&word, values + k, sizeof word);
        se3di_code_word(c, &word);
        if (c->in) {
            memcpy(values + k, &word, sizeof word);
        }
    }
}

static inline void se3di_code_uint32(se3di_coder *c, uint32_t *value)
{
    uint64_t word = *value;
    se3di_code_word(c, &word);
    c->failed |= word > UINT32_MAX;
    if (c->in) {
        *value = (uint32_t)word;
    }
}

static inline void se3di_code_int32(se3di_coder *c, int32_t *value)
{
    uint32_t word = (uint32_t)*value;
    se3di_code_uint32(c, &word);
    if (c->in) {
        *value = (int32_t)word;
    }
}

static inline void se3di_code_size(se3di_coder *c, size_t *size)
{
    uint64_t word = *size;
    se3di_code_word(c, &word);
    c->failed |= word > SIZE_MAX;
    if (c->in) {
        *size = (size_t)word;
    }
}

/* Two in a word. */
static inline void se3di_code_indices(se3di_coder *c, uint32_t *values, size_t count)
{
    for (size_t k = 0; k < count; k += 2) {
        const int two = k + 1 < count;
        uint64_t word = values[k] | (two ? (uint64_t)values[k + 1] << 32 : 0);
        se3di_code_word(c, &word);
        if (c->in) {
            values[k] = (uint32_t)word;
            values[two ? k + 1 : k] = (uint32_t)(two ? word >> 32 : word);
        }
    }
}

/* 0 or 1. */
static inline void se3di_code_flag(se3di_coder *c, int32_t *flag)
{
    se3di_code_int32(c, flag);
    c->failed |= *flag != 0 && *flag != 1;
}

/* The length of an array whose elements take a `part` of a word at least; what the bytes that are
 * left cannot hold has failed, and is 0. */
static inline void se3di_code_count(se3di_coder *c, size_t *count, double part)
{
    uint64_t word = *count;
    se3di_code_word(c, &word);
    const size_t rest = c->in && c->at < c->size ? (c->size - c->at) / SE3DI_CODER_WORD : 0;
    if (c->in && (c->failed || (double)word * part > (double)rest)) {
        c->failed = 1;
        word = 0;
    }
    if (c->in) {
        *count = (size_t)word;
    }
}

#endif
