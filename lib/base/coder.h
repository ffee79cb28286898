/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers as bytes that are the same on every machine: 64-bit words, least byte first. One function
 * for each kind of number goes both ways, so that reader and writer cannot differ; what is written
 * is only looked at. */
#ifndef SE3DI_BASE_CODER_H
#define SE3DI_BASE_CODER_H

#include <stddef.h>
#include <stdint.h>

/* One way through the bytes: measuring (`out` and `in` NULL), writing or reading. */
typedef struct se3di_coder {
    unsigned char *out;
    const unsigned char *in;
    size_t at, size; /* what does not fit is counted only */
    int failed;      /* reading: the bytes end too early, or a number is out of its range */
} se3di_coder;

void se3di_code_word(se3di_coder *coder, uint64_t *word);
void se3di_code_numbers(se3di_coder *coder, double *values, size_t count);
void se3di_code_int32(se3di_coder *coder, int32_t *value);
void se3di_code_uint32(se3di_coder *coder, uint32_t *value);
/* Two in a word. */
void se3di_code_indices(se3di_coder *coder, uint32_t *values, size_t count);
/* 0 or 1. */
void se3di_code_flag(se3di_coder *coder, int32_t *flag);
/* The length of an array whose elements take a `part` of a word at least; what the bytes that are
 * left cannot hold has failed, and is 0. */
void se3di_code_count(se3di_coder *coder, size_t *count, double part);

#endif
