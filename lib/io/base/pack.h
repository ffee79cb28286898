/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers and texts as bytes that are the same on every machine: words of 64 bits, least byte
 * first. One function for each kind goes both ways, so that reader and writer cannot differ; what
 * is written is only looked at. */
#ifndef SE3D_IO_PACK_H
#define SE3D_IO_PACK_H

#include "io/base/pool.h"

/* One way through the bytes: measuring (`out` and `in` NULL), writing or reading. */
typedef struct se3di_pack {
    unsigned char *out;
    const unsigned char *in;
    size_t at, size;    /* what does not fit is counted only */
    se3di_iopool *pool; /* of texts and arrays that are read */
    bool failed;        /* reading: the bytes end too early or make no sense */
} se3di_pack;

void se3di_pack_word(se3di_pack *pack, uint64_t *word);
void se3di_pack_size(se3di_pack *pack, size_t *size);
void se3di_pack_int(se3di_pack *pack, int32_t *value);
void se3di_pack_flag(se3di_pack *pack, bool *flag);
void se3di_pack_numbers(se3di_pack *pack, double *values, size_t count);
/* Bytes as they are; reading: where they lie, without a copy. */
void se3di_pack_bytes(se3di_pack *pack, const unsigned char **bytes, size_t *size);
/* A text with its length; reading: a copy in the pool. NULL becomes "". */
void se3di_pack_text(se3di_pack *pack, const char **text);
/* The length of an array whose elements take a word at least; what cannot be there has failed. */
void se3di_pack_count(se3di_pack *pack, size_t *count);

#endif
