/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/coder.h"

#include <string.h>

#define WORD 8 /* bytes */

void se3di_code_word(se3di_coder *c, uint64_t *word)
{
    if (c->at > c->size || c->size - c->at < WORD) {
        c->failed = 1;
        *word = c->in ? 0 : *word;
    } else if (c->in) {
        *word = 0;
        for (int k = 0; k < WORD; ++k) {
            *word |= (uint64_t)c->in[c->at + (size_t)k] << (8 * k);
        }
    } else if (c->out) {
        for (int k = 0; k < WORD; ++k) {
            c->out[c->at + (size_t)k] = (unsigned char)(*word >> (8 * k));
        }
    }
    c->at += WORD;
}

void se3di_code_numbers(se3di_coder *c, double *values, size_t count)
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

void se3di_code_uint32(se3di_coder *c, uint32_t *value)
{
    uint64_t word = *value;
    se3di_code_word(c, &word);
    c->failed |= word > UINT32_MAX;
    if (c->in) {
        *value = (uint32_t)word;
    }
}

void se3di_code_int32(se3di_coder *c, int32_t *value)
{
    uint32_t word = (uint32_t)*value;
    se3di_code_uint32(c, &word);
    if (c->in) {
        *value = (int32_t)word;
    }
}

void se3di_code_indices(se3di_coder *c, uint32_t *values, size_t count)
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

void se3di_code_flag(se3di_coder *c, int32_t *flag)
{
    se3di_code_int32(c, flag);
    c->failed |= *flag != 0 && *flag != 1;
}

void se3di_code_count(se3di_coder *c, size_t *count, double part)
{
    uint64_t word = *count;
    se3di_code_word(c, &word);
    const size_t rest = c->in && c->at < c->size ? (c->size - c->at) / WORD : 0;
    if (c->in && (c->failed || (double)word * part > (double)rest)) {
        c->failed = 1;
        word = 0;
    }
    if (c->in) {
        *count = (size_t)word;
    }
}
